"""Features of balls and races that excite a bearing: heights positive out of the surface."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from ehlcontact.checks import require_choice, require_finite, require_integer, require_positive
from ehlcontact.checks.quantity import fields_take
from ehlcontact.errors import InputError
from reduced_models.bearing.race import RACES

MOST_TURNS = 4.0 * pi  # rad, of a phase: more are degrees
MOST_WAVES = 100_000  # around a race or a ball


@fields_take(amplitude="m", phase="rad")
@dataclass(frozen=True, kw_only=True)
class RaceWaviness:
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
        An unknown race, less than one wave, an amplitude that is not positive, a phase in degrees.
    """

    race: str
    waves: int
    amplitude: float
    phase: float = 0.0

    def __post_init__(self) -> None:
        require_choice("race", self.race, RACES)
        _require_waves(self)


@fields_take(amplitude="m", phase="rad")
@dataclass(frozen=True, kw_only=True)
class BallWaviness:
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


@fields_take(excess="m")
@dataclass(frozen=True, kw_only=True)
class BallDiameter:
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
        A ball below 0, an excess that is not finite.
    """

    ball: int
    excess: float

    def __post_init__(self) -> None:
        require_integer("ball", self.ball, "a whole number >= 0", 0)
        require_finite("excess", self.excess)


Feature = RaceWaviness | BallWaviness | BallDiameter


def _require_waves(feature: RaceWaviness | BallWaviness) -> None:
    if require_integer("waves", feature.waves, f"a whole number from 1 to {MOST_WAVES}", 1) > MOST_WAVES:
        raise InputError("waves", feature.waves, f"a whole number from 1 to {MOST_WAVES}")
    require_positive("amplitude", feature.amplitude)
    if not abs(require_finite("phase", feature.phase)) <= MOST_TURNS:
        raise InputError("phase", feature.phase, f"between {-MOST_TURNS:.3g} and {MOST_TURNS:.3g} rad")
