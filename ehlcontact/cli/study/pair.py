"""Pairs of bearings, in the files of studies and of bearings."""

from __future__ import annotations

from ehlcontact.errors import InputError
from reduced_models import BallBearing, BearingSet


def pair_of(
    bearing: BallBearing,
    arrangement: str,
    *,
    preload: float | None = None,
    spring: float | None = None,
    distance_mm: float | None = None,
) -> BearingSet:
    """Two such bearings in an arrangement of `ehlcontact.cli.entries.Arrangement`.

    Raises
    ------
    InputError
        Bearings without a contact angle; a preload of bearings in tandem, or by offsets and by a spring.
    """
    words = arrangement.replace("-", " ")
    if bearing.free_angle == 0.0:
        allowed = "left out: bearings of a pair need a contact angle, as 7205 has one (or --contact-angle)"
        raise InputError("arrangement", arrangement, allowed)
    return BearingSet.pair(
        bearing,
        words,
        distance=None if distance_mm is None else 1e-3 * distance_mm,
        preload=preload,
        spring=spring,
        name=f"pair of {bearing.name or 'ball bearings'}, {words}",
    )
