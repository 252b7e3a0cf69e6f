"""`TrackSurface`: features of a bearing that pass one of its contacts, as the surface of a full film."""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign, pi
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from reduced_models.bearing.features import BallDiameter, BallWaviness, Feature, RaceWaviness
from reduced_models.bearing.height_tables import features_on, heights_along, track_radius
from reduced_models.bearing.race import RACES

if TYPE_CHECKING:
    from reduced_models.bearing.ball_bearing import BallBearing

_Floats = NDArray[np.float64]

FEWEST_NODES = 4.0  # to a wave, as `simulate` asks of a rough surface


@dataclass(frozen=True)
class Track:
    """Features of one track: those of a race, or of a ball.

    Attributes
    ----------
    features : tuple of Feature
    radius : float
        In m.
    angle : float
        Of the contact on the track at T = 0 [rad].
    rate : float
        Of that angle, per unit of T [rad].
    """

    features: tuple[Feature, ...]
    radius: float
    angle: float
    rate: float


@dataclass(frozen=True)
class TrackSurface:
    """Height added to the gap of a contact, in dry approaches, over X, Y and T (`ehlcontact.simulate`).

    Attributes
    ----------
    tracks : tuple of Track
    axis, approach : float
        Semi-axis a along the track, and dry approach, the units of X and of heights [m].
    """

    tracks: tuple[Track, ...]
    axis: float
    approach: float

    def __call__(self, X: _Floats, Y: _Floats, T: float) -> _Floats:
        """Height at time T; what passes the centre later is at smaller X."""
        raised = 0.0 * (X + Y)
        for track in self.tracks:
            ahead = copysign(self.axis / track.radius, track.rate)
            theta = track.angle + track.rate * T - ahead * X
            raised = raised + heights_along(track.features, track.radius, theta)
        return -raised / self.approach

    def require_resolved(self, mesh: float) -> None:
        """Raise `InputError` for waves with fewer than `FEWEST_NODES` nodes of a mesh along X, in semi-axes."""
        for track in self.tracks:
            most = int(2.0 * pi * track.radius / (self.axis * FEWEST_NODES * mesh))
            for one in track.features:
                if isinstance(one, RaceWaviness | BallWaviness) and one.waves > most:
                    allowed = f"at most {most} in a full film, {FEWEST_NODES:g} nodes to a wave: raise n"
                    raise InputError("waves", one.waves, allowed)


def tracks_at(
    bearing: BallBearing, k: int, race: str, angles: tuple[float, float], rates: tuple[float, float]
) -> tuple[Track, ...]:
    """Tracks with features that meet in the contact of ball `k` with a race, planar.

    Parameters
    ----------
    bearing : BallBearing
    k : int
    race : {"inner", "outer"}
    angles, rates : (float, float)
        Of that ball about the shaft, and of the shaft [rad], and their rates per unit of T.
    """
    inner = race == RACES[0]
    (ball, shaft), (ball_rate, shaft_rate) = angles, rates
    rings = bearing.ring_speeds
    turns, ring = rings.sense * bearing.orders.bsf_order, rings.inner if inner else rings.outer
    found = (
        (features_on(bearing, race=race), track_radius(bearing, race),
         ball - ring * shaft, ball_rate - ring * shaft_rate),
        (features_on(bearing, ball=k), 0.5 * bearing.ball_diameter,
         turns * shaft + (0.0 if inner else pi), turns * shaft_rate),
    )  # fmt: skip
    tracks = (Track(tuple(_with_height(own)), *place) for own, *place in found)
    return tuple(track for track in tracks if track.features)


def _with_height(features: list[Feature]) -> list[Feature]:
    """Features without diameters, which displace a whole ball."""
    return [one for one in features if not isinstance(one, BallDiameter)]
