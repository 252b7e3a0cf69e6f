"""Features of balls and races, as inputs: waviness, defects, unequal balls.

Heights are positive out of the surface. `height_tables` has them over the angle, as a contact meets them,
`film_heights` in runs in oil.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import (
    parts,
    require_choice,
    require_finite,
    require_instance,
    require_integer,
    require_names,
)
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import InputError
from ehlcontact.summary import Summary
from reduced_models.bearing.race import RACES

_Floats = NDArray[np.float64]

MOST_TURNS = 4.0 * pi  # rad, of a phase: more are degrees
ONE_TURN = 2.0 * pi  # rad, of a place: more are degrees
MOST_WAVES = 100_000  # around a race or a ball


@fields_take(amplitude=parts.HEIGHT, phase="rad")
@dataclass(frozen=True, kw_only=True)
class RaceWaviness(Summary):
    """Waves around a race: ``amplitude cos(waves theta - phase)``, theta from the x axis with the shaft at 0.

    Parameters
    ----------
    race : {"inner", "outer"}
    waves : int
        Around the race. 1 is an eccentric race, 2 an oval one.
    amplitude : float
        In m.
    phase : float
        In rad.

    Raises
    ------
    InputError
        An unknown race, less than one wave, an amplitude that is not positive, a phase in degrees. The bearing
        refuses an amplitude of more than 0.01 of a ball's diameter.
    """

    race: str
    waves: int
    amplitude: float
    phase: float = 0.0

    def __post_init__(self) -> None:
        require_choice("race", self.race, RACES)
        _require_waves(self)


@fields_take(amplitude=parts.HEIGHT, phase="rad")
@dataclass(frozen=True, kw_only=True)
class BallWaviness(Summary):
    """Waves around a ball in the plane of its rolling: ``amplitude cos(waves theta - phase)`` at the inner race.

    Parameters
    ----------
    ball : int
        From 0, which is the ball at the cage angle.
    waves : int
        Around the ball. Odd ones move it between the races: both contacts meet them with opposite signs.
    amplitude : float
        In m.
    phase : float
        In rad.

    Raises
    ------
    InputError
        As `RaceWaviness`; a ball below 0.
    """

    ball: int
    waves: int
    amplitude: float
    phase: float = 0.0

    def __post_init__(self) -> None:
        require_integer("ball", self.ball, "a whole number >= 0", 0)
        _require_waves(self)


@fields_take(excess=parts.EXCESS)
@dataclass(frozen=True, kw_only=True)
class BallDiameter(Summary):
    """A ball that is larger than the others, or smaller.

    Parameters
    ----------
    ball : int
        From 0, which is the ball at the cage angle.
    excess : float
        Of its diameter [m].

    Raises
    ------
    InputError
        A ball below 0, an excess that is not finite. The bearing refuses more than 0.01 of its diameter.
    """

    ball: int
    excess: float

    def __post_init__(self) -> None:
        require_integer("ball", self.ball, "a whole number >= 0", 0)


@fields_take(angle="rad", length=parts.TRACK, depth=parts.HEIGHT, edge=parts.EDGE)
@dataclass(frozen=True, kw_only=True)
class Spall(Summary):
    """A pit across the whole track of a race or a ball, of constant depth between its edges.

    Where features overlap, their heights add up: two pits at one place are as deep as both together.

    Parameters
    ----------
    race : {"inner", "outer"}, optional
        The race that has it; else the ball.
    ball : int, optional
        From 0, which is the ball at the cage angle.
    angle : float
        Of its middle [rad]: on a race from the x axis, with the shaft at 0; on a ball in the plane of its
        rolling, from the contact with the inner race with the shaft at 0.
    length : float
        Along the track, both edges included [m].
    depth : float
        In m.
    edge : float
        Length of the slope at either end [m]; 0 is a step.

    Raises
    ------
    InputError
        Neither or both of race and ball; lengths that are not positive, edges longer than half of it, an angle in
        degrees. The bearing refuses what is longer than its track, or deeper than a ball's radius.
    """

    race: str | None = None
    ball: int | None = None
    angle: float
    length: float
    depth: float
    edge: float = 0.0

    def __post_init__(self) -> None:
        _require_place(self)
        if self.edge > 0.5 * self.length:
            raise InputError("edge", self.edge, f"at most half of the length, {0.5 * self.length:g} m")

    @takes(x=parts.ANY)
    def height(self, x: _Floats) -> _Floats:
        """Height [m] at distances x [m] from its middle along the track."""
        inside = 0.5 * self.length - np.abs(x)
        if self.edge == 0.0:
            return np.where(inside >= 0.0, -self.depth, 0.0)
        return -self.depth * np.clip(inside / self.edge, 0.0, 1.0)


@fields_take(angle="rad", length=parts.TRACK, depth=parts.HEIGHT, rim=parts.RIM)
@dataclass(frozen=True, kw_only=True)
class Indentation(Summary):
    """A dent that a hard particle has left: a smooth pit with raised rims, across the whole track.

    ``-depth cos^2(pi x/length)`` within the length, and rims ``rim sin^2(2 pi x/length)`` half as long beside it.

    Parameters
    ----------
    race, ball, angle
        As of a `Spall`.
    length : float
        Of the pit along the track, without its rims [m].
    depth : float
        In m.
    rim : float
        Height of the rims [m].

    Raises
    ------
    InputError
        As `Spall`; a rim below 0. The bearing refuses one above 0.01 of a ball's diameter.
    """

    race: str | None = None
    ball: int | None = None
    angle: float
    length: float
    depth: float
    rim: float = 0.0

    def __post_init__(self) -> None:
        _require_place(self)

    @takes(x=parts.ANY)
    def height(self, x: _Floats) -> _Floats:
        """Height [m] at distances x [m] from its middle along the track."""
        at = np.abs(x) / self.length
        pit = -self.depth * np.cos(pi * at) ** 2
        return np.where(at <= 0.5, pit, np.where(at <= 1.0, self.rim * np.sin(2.0 * pi * at) ** 2, 0.0))


Waves = RaceWaviness | BallWaviness
Defect = Spall | Indentation
Feature = Waves | Defect | BallDiameter
FEATURES = "RaceWaviness, BallWaviness, BallDiameter, Spall or Indentation"


def usual_waviness(amplitude: float, waves: int, seed: int) -> list[RaceWaviness]:
    """Waviness of both races as new bearings have it: n waves are an n-th as high as one, their phases random.

    So all waves move the ring equally fast, as the velocities of new bearings in the three bands of ISO 15242 are
    of one size.

    Parameters
    ----------
    amplitude : float
        Of one wave around a race [m].
    waves : int
        Largest number of waves around a race; the smallest is 2, an oval race.
    seed : int
        Of the phases.
    """
    phase = np.random.default_rng(seed).uniform(0.0, 2.0 * pi, (len(RACES), max(waves - 1, 0)))
    return [
        RaceWaviness(race=race, waves=n, amplitude=amplitude / n, phase=float(phase[j, n - 2]))
        for j, race in enumerate(RACES)
        for n in range(2, waves + 1)
    ]


_KINDS: dict[str, type[Any]] = {
    kind.__name__: kind for kind in (RaceWaviness, BallWaviness, BallDiameter, Spall, Indentation)
}


def features_from(entries: object) -> list[Feature]:
    """Rebuild features from `feature_entries`; raises `InputError` for what is none."""
    require_instance("features", entries, list, "a list of objects")
    found = []
    for k, one in enumerate(entries):  # type: ignore[var-annotated, arg-type]
        require_instance(f"features[{k}]", one, dict, "an object")
        kind = _KINDS[require_choice(f"features[{k}].kind", one.get("kind"), tuple(_KINDS))]
        given = {name: value for name, value in one.items() if name != "kind"}
        require_names(given, list(kind.__dataclass_fields__), f"features[{k}].")
        found.append(kind(**given))
    return found


def feature_entries(features: tuple[Feature, ...]) -> list[dict[str, Any]]:
    """All features with their arguments, ready for JSON."""
    return [{"kind": type(one).__name__, **asdict(one)} for one in features]


def _require_place(feature: Defect) -> None:
    if (feature.race is None) == (feature.ball is None):
        given = "neither" if feature.race is None else "both"
        raise InputError("race, ball", given, 'one of them: race="inner" or "outer", or the number of a ball')
    if feature.race is not None:
        require_choice("race", feature.race, RACES)
    else:
        require_integer("ball", feature.ball, "a whole number >= 0", 0)
    if not abs(require_finite("angle", feature.angle)) <= ONE_TURN:
        raise InputError("angle", feature.angle, f"between {-ONE_TURN:.4g} and {ONE_TURN:.4g} rad (in degrees?)")


def _require_waves(feature: Waves) -> None:
    if require_integer("waves", feature.waves, f"a whole number from 1 to {MOST_WAVES}", 1) > MOST_WAVES:
        raise InputError("waves", feature.waves, f"a whole number from 1 to {MOST_WAVES}")
    if not abs(require_finite("phase", feature.phase)) <= MOST_TURNS:
        raise InputError("phase", feature.phase, f"between {-MOST_TURNS:.3g} and {MOST_TURNS:.3g} rad")
