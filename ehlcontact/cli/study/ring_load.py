"""Moments and tilts of an inner ring, in the files of studies and of bearings."""

from __future__ import annotations

from typing import Any

from ehlcontact.errors import InputError


def moments_of(given: Any, section: str) -> tuple[float, ...]:
    """Moments about x and y [N m], under which the ring tilts freely; empty where none is given.

    Parameters
    ----------
    given : Section
        With ``moment_x``, ``moment_y``, ``tilt_x_mrad`` and ``tilt_y_mrad``.
    section : str
        Its name, for the message.

    Raises
    ------
    InputError
        Moments beside tilts at which the ring is held.
    """
    if given.moment_x is given.moment_y is None:
        return ()
    if tilt_of(given) is not None:
        name = "tilt_y_mrad" if given.tilt_x_mrad is None else "tilt_x_mrad"
        allowed = "left out beside moments, under which the inner ring tilts freely"
        raise InputError(f"{section}.{name}", getattr(given, name), allowed)
    return given.moment_x or 0.0, given.moment_y or 0.0


def tilt_of(given: Any) -> tuple[float, float] | None:
    """Tilts about x and y at which the ring is held [rad]; None where they are not given."""
    if given.tilt_x_mrad is given.tilt_y_mrad is None:
        return None
    return 1e-3 * (given.tilt_x_mrad or 0.0), 1e-3 * (given.tilt_y_mrad or 0.0)
