"""`BallBearing`: a deep-groove ball bearing in its plane, a film under every ball."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from math import hypot, inf, pi, sin
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact import Lubricant
from ehlcontact.checks import (
    as_column,
    as_numbers,
    require_finite,
    require_instance,
    require_integer,
    require_names,
    require_nonnegative,
    require_positive,
)
from ehlcontact.checks.admissible_range import INPUTS
from ehlcontact.checks.frequency import by_name, radians_per_second
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import InputError
from ehlcontact.store import stored
from ehlcontact.summary import Summary
from reduced_models.bearing.balls import Balls, SpeedState, speed_state
from reduced_models.bearing.catalogue import USUAL_CONFORMITY, catalogue_row
from reduced_models.bearing.clearance import clearance_of_class
from reduced_models.bearing.equilibrium import (
    RingEquilibrium,
    StaticBalls,
    angle_of,
    direction_of,
    radial_load,
    ring_equilibrium,
)
from reduced_models.bearing.kinematics import (
    HERTZ,
    RADIANS,
    DefectFrequencies,
    ball_mass,
    ball_swing,
    cage_ratio,
    rolling_radius,
)
from reduced_models.bearing.linear_balls import BearingCoefficients, SmallBalls
from reduced_models.bearing.loss import loss_of, require_loss_factor
from reduced_models.bearing.race import RACES, Race, assumptions_under, films_under, race_of, require_roughness
from reduced_models.bearing.race_table import tabulate_dry_race, tabulate_race
from reduced_models.bearing.state import BearingState
from reduced_models.elements.wide_range import WideRangeContact

_Floats = NDArray[np.float64]

LARGEST_PLAY = 0.05  # clearance or preload over ball diameter: five times what C5 or a heavy fit has
POSITIONS = 12  # of the cage over a ball passage for means: those of 6205 are within 1e-3 of those of 48


@stored("ball bearing")
@fields_take(
    ball_diameter="m", pitch_diameter="m", clearance="m", rq_ball="m", rq_race="m", film_limit="m",
    youngs_modulus="Pa", density="kg/m3",
)  # fmt: skip
@dataclass(frozen=True, kw_only=True)
class BallBearing(Summary):
    """Deep-groove ball bearing under radial load, the outer ring standing still. SI units, y upwards.

    Every ball has a contact with either race, each with a film and its memory; both carry the ball in series, the
    outer one its centrifugal force too. Rings are rigid, balls roll without slip at zero contact angle and, unless
    it is asked for, do not vibrate on their contacts themselves (for a 6205 that begins near 30 kHz).

    Parameters
    ----------
    balls : int
        At least 3.
    ball_diameter, pitch_diameter : float
        In m.
    conformity_inner, conformity_outer : float
        Groove radius over ball diameter.
    clearance : float
        Radial internal clearance, the play across the bearing [m]; below 0 it is preloaded by so much.
    oil : Lubricant, optional
        Flooded contacts, by the atlas. None is dry: Hertz' contacts without film or damping.
    rq_ball, rq_race : float, optional
        Roughness Rq [m], for the lambda ratio.
    film_limit : float, optional
        Gap [m] beyond which the film of an unloaded ball carries nothing. By default it is flooded there too, and
        its force falls slowly, like gap^-1/2.
    youngs_modulus, poisson_ratio, density : float
        Of balls and rings [Pa], [-], of balls [kg/m3].
    loss_factor : float
        Of rings and fits, for vibrations of 5 Hz to 5 kHz: what else than films damps, in linear answers and in
        time alike. It needs a measurement, and is nothing to hide a gap behind. See `reduced_models.bearing.loss`.
    ball_inertia : bool
        Balls have inertia towards the rings: in linear answers, and in runs whose steps are short enough for it.
    name : str
    atlas : str, optional
        File of an atlas; by default the one that comes with the library.

    Raises
    ------
    InputError
        What is no ball bearing: balls that overlap, a conformity of a half or less; a conformity or an oil that
        the atlas does not have.
    """

    balls: int
    ball_diameter: float
    pitch_diameter: float
    conformity_inner: float = USUAL_CONFORMITY
    conformity_outer: float = USUAL_CONFORMITY
    clearance: float = 0.0
    oil: Lubricant | None = None
    rq_ball: float | None = None
    rq_race: float | None = None
    film_limit: float | None = None
    youngs_modulus: float = 2.06e11
    poisson_ratio: float = 0.3
    density: float = 7800.0
    loss_factor: float = 0.0
    ball_inertia: bool = False
    name: str = ""
    atlas: str | None = None
    _known: dict[Any, Any] = field(init=False, repr=False, compare=False, default_factory=dict)

    def _summary_lines(self) -> list[str]:
        play = 1e6 * self.clearance
        lines = [
            f"{self.name or 'ball bearing'}, {self.balls} balls of {1e3 * self.ball_diameter:.4g} mm "
            f"on {1e3 * self.pitch_diameter:.4g} mm",
            f"conformity {self.conformity_inner:.4g} and {self.conformity_outer:.4g}, clearance {play:.4g} µm",
            "dry"
            if self.oil is None
            else f"oil of {self.oil.eta0:.4g} Pa s, alpha {1e9 * self.oil.alpha:.4g} 1/GPa, flooded",
        ]
        return [*lines, f"loss factor {self.loss_factor:.3g}"] if self.loss_factor else lines

    def __post_init__(self) -> None:
        require_integer("balls", self.balls, "a whole number >= 3", 3)
        if self.oil is not None:
            require_instance("oil", self.oil, Lubricant, "a Lubricant, as Lubricant.iso_vg(68, temperature=50.0)")
        for name, rq in (("rq_ball", self.rq_ball), ("rq_race", self.rq_race)):
            require_roughness(name, rq)
        if self.film_limit is not None:
            require_positive("film_limit", self.film_limit)
        require_positive("density", self.density)
        require_loss_factor(self.loss_factor)
        require_instance("ball_inertia", self.ball_inertia, bool, "True or False")
        races = {name: race_of(self, name) for name in RACES}
        self._known["races"] = races
        room = self.pitch_diameter * sin(pi / self.balls)
        if self.ball_diameter >= room:
            most = int(pi / np.arcsin(self.ball_diameter / self.pitch_diameter))
            raise InputError("balls", self.balls, f"at most {most} on this pitch circle: they overlap")
        play = LARGEST_PLAY * self.ball_diameter
        if isinstance(self.clearance, str):
            allowed = 'a number [m]; classes need a bore, as BallBearing.catalogue("6205", clearance="CN") has'
            raise InputError("clearance", self.clearance, allowed)
        if not abs(require_finite("clearance", self.clearance)) <= play:
            raise InputError("clearance", self.clearance, f"between {-play:.3g} and {play:.3g} m")
        if self.oil is not None:
            for race in races.values():
                race.require_in_atlas()

    @classmethod
    def catalogue(cls, name: str, **changes: Any) -> Self:
        """Bearing by its name, as ``BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))``.

        `reduced_models.bearing.catalogue` has the table, and where each row is from.

        Parameters
        ----------
        name : str
        **changes
            Any other argument of the bearing, or another value than that of the table. ``clearance`` may be a
            class, "C2", "CN", "C3" or "C4": the middle of its limits at the bore, before mounting.

        Raises
        ------
        InputError
            A name that is not in the table; it names the nearest. A class of clearance that is none, or a bearing
            whose bore is not known.
        """
        known, row = catalogue_row(name)
        if isinstance(changes.get("clearance"), str):
            changes["clearance"] = clearance_of_class(changes["clearance"], row.bore)
        dimensions = {"balls": row.balls, "ball_diameter": row.ball_diameter, "pitch_diameter": row.pitch_diameter}
        grooves = {"conformity_inner": row.conformity, "conformity_outer": row.conformity}
        return cls(**{"name": known, **dimensions, **grooves, **changes})

    @property
    def gamma(self) -> float:
        """Ball over pitch diameter."""
        return self.ball_diameter / self.pitch_diameter

    @property
    def orders(self) -> DefectFrequencies:
        """Defect frequencies per turn of the shaft."""
        return DefectFrequencies.of(self.balls, self.gamma)

    @takes(speed_rpm="rev/min")
    def frequencies(self, speed_rpm: float) -> DefectFrequencies:
        """Defect frequencies [Hz] at a speed of the shaft [rev/min]."""
        return DefectFrequencies.of(self.balls, self.gamma, require_nonnegative("speed_rpm", speed_rpm) * HERTZ)

    @property
    def roughness(self) -> float | None:
        """Composite roughness of ball and race [m]; None where none is given."""
        given = [rq for rq in (self.rq_ball, self.rq_race) if rq is not None]
        return hypot(*given) if given else None

    @property
    def highest_speed(self) -> float:
        """Speed [rev/min] up to which the atlas has films for it; infinite where it is dry."""
        return inf if self.oil is None else min(race.highest_speed for race in self._known["races"].values())

    def race(self, name: str) -> Race:
        """The contact with the "inner" or the "outer" race."""
        if name not in RACES:
            raise InputError("race", name, f"one of {', '.join(RACES)}")
        return self._known["races"][name]

    @takes(speed_rpm="rev/min")
    def element(self, race: str, speed_rpm: float) -> WideRangeContact:
        """Element of a ball's contact with one race [SI], for all loads that the atlas has at this speed."""
        contact, speed = self.race(race), self.speed(speed_rpm)
        if self.oil is None:
            raise InputError("oil", None, "given, for a film")
        if (race, speed) not in self._known:
            self._known[race, speed] = contact.element(speed)
        return self._known[race, speed]

    @takes(load="N", speed_rpm="rev/min", cage_angle="rad")
    def equilibrium(
        self, load: ArrayLike, *, speed_rpm: float = 0.0, cage_angle: float | None = None
    ) -> BearingState:
        """State at rest under a load on the shaft.

        Parameters
        ----------
        load : (float, float)
            Force on the inner ring (Fx, Fy) [N].
        speed_rpm : float
            Speed of the shaft [rev/min], for the films and the centrifugal force; 0 for a dry bearing only.
        cage_angle : float, optional
            Angle of the first ball from the x axis [rad]; by default it stands under the load.

        Raises
        ------
        InputError
            A load that is not radial, that does not seat the bearing or is beyond the atlas; a speed beyond it.
        """
        force, speed = radial_load(load), self.speed(speed_rpm)
        angle = direction_of(force) if cage_angle is None else angle_of(cage_angle)
        at = self._stand(force, speed, angle)
        return BearingState(
            name=self.name,
            load=force,
            speed_rpm=speed,
            cage_angle=angle,
            displacement=at.displacement,
            stiffness=at.stiffness,
            angles=np.asarray(angle + 2.0 * pi / self.balls * np.arange(self.balls)),
            force=at.force,
            approach=at.approach,
            **({} if self.oil is None else films_under(self, speed, at.force, at.approach)),
        )

    @takes(load="N", speed_rpm="rev/min", cage_angle="rad")
    @by_name(2)
    def coefficients(
        self,
        load: ArrayLike,
        *,
        speed_rpm: float = 0.0,
        cage_angle: float | None = None,
        omega: ArrayLike | None = None,
        hz: ArrayLike | None = None,
        rpm: ArrayLike | None = None,
    ) -> BearingCoefficients:
        """Stiffness and damping of a small vibration about rest under a load.

        Parameters
        ----------
        load : (float, float)
            Force on the inner ring [N].
        speed_rpm : float
            Speed of the shaft [rev/min].
        cage_angle : float, optional
            Of the first ball [rad]; by default the mean over a ball passage is given.
        omega, hz, rpm : float or sequence of float
            Frequency of the vibration, in exactly one of these.

        Returns
        -------
        BearingCoefficients
        """
        force, speed = radial_load(load), self.speed(speed_rpm)
        w = radians_per_second(None, omega=omega, hz=hz, rpm=rpm)
        standings = self.ring_equilibria(force, speed, cage_angle)
        balls = SmallBalls.of(self._kernel(speed), self._speed_state(speed), standings)
        matrices, forces = balls.coefficients(w), np.array([standing.force for standing in standings])
        outside = "" if self.oil is None else assumptions_under(self, speed, forces).headline
        return BearingCoefficients.of(force, speed, cage_angle, w, matrices, standings, outside)

    def ring_equilibria(
        self, load: ArrayLike, speed_rpm: float, cage_angle: float | None = None
    ) -> list[RingEquilibrium]:
        """The ring at rest under a load [N], at positions of the cage over a ball passage or at one [rad]."""
        force, speed = radial_load(load), self.speed(speed_rpm)
        first = direction_of(force) if cage_angle is None else angle_of(cage_angle)
        steps = np.arange(POSITIONS) / POSITIONS if cage_angle is None else np.zeros(1)
        angles = first + 2.0 * pi / self.balls * steps
        return [self._stand(force, speed, angle) for angle in angles.tolist()]

    @takes(load="N", speeds_rpm="rev/min")
    @by_name(2)
    def to_ross(
        self,
        node: int,
        *,
        speeds_rpm: ArrayLike,
        load: ArrayLike,
        omega: ArrayLike | None = None,
        hz: ArrayLike | None = None,
        rpm: ArrayLike | None = None,
        **options: Any,
    ) -> Any:
        """Stiffness and damping as a plain ``ross.BearingElement``, means over a ball passage.

        Parameters
        ----------
        node : int
        speeds_rpm : float or sequence of float
            Speeds of the shaft [rev/min], increasing. ROSS goes on beyond their ends, so they should cover the
            whole range; from four on the splines of ROSS 2 meet damping within 1 N s/m rms only, those of ROSS 3
            go through all points.
        load : float or (float, float)
            Force on the inner ring [N]; a number is a weight, in -y.
        omega, hz, rpm : float or sequence of float, optional
            Frequency of the whirl, the vibration. One frequency makes tables over the speed only. In ROSS 3
            several, increasing, are the second axis of the tables: by default 0, and 41 from 1 Hz to 10 kHz.
            ROSS 2 has no such axis; there the default is the frequency of the shaft at each speed.
        **options
            Of ``ross.BearingElement``, as ``tag`` or ``n_link``.

        Raises
        ------
        InputError
            ROSS is not installed; a load or a speed that the bearing does not take; several frequencies in ROSS 2.
        """
        from reduced_models.bearing.ross_bearing import bearing_element

        frequency = {"omega": omega, "hz": hz, "rpm": rpm}
        return bearing_element(self, node, speeds_rpm, load, frequency, **options)

    def _stand(self, load: _Floats, speed: float, angle: float) -> RingEquilibrium:
        standing = ring_equilibrium(self._static_balls(speed, angle), load)
        for name, most in zip(RACES, standing.force.max(axis=0).tolist(), strict=True):
            highest, end = self.race(name).heaviest(speed)
            if most > highest:
                what, value = ("load", load.tolist()) if load.any() else ("clearance", self.clearance)
                allowed = f"such that a ball carries at most {highest:.4g} N on the {name} race"
                raise InputError(what, value, f"{allowed}, {end} (here {most:.4g} N)")
        return standing

    def _static_balls(self, speed: float, angle: float) -> StaticBalls:
        """All balls at rest at a speed that the bearing takes, the first ball at `angle`."""
        return StaticBalls(self._kernel(speed), self._speed_state(speed), angle)

    def _speed_state(self, speed: float) -> SpeedState:
        """Films, cage and centrifugal force at a speed that the bearing takes, as the kernels have them."""
        return speed_state(self._kernel(speed), speed * RADIANS)

    def _kernel(self, speeds_rpm: ArrayLike) -> Balls:
        """Parameters of the compiled kernels (`reduced_models.bearing.balls`) over increasing speeds [rev/min].

        Between two speeds films grow as with the speed to the power of 0.67; outside them the kernels do not ask.
        """
        speeds = as_column("speeds_rpm", np.atleast_1d(as_numbers("speeds_rpm", speeds_rpm)), increasing=True)
        key = ("kernel", *speeds.tolist())
        if key not in self._known:
            self._known[key] = Balls(
                inner=self._law("inner", speeds),
                outer=self._law("outer", speeds),
                number=self.balls,
                half_clearance=0.5 * self.clearance,
                cage=cage_ratio(self.gamma),
                swing=ball_swing(self.ball_diameter, self.pitch_diameter, self.density),
                rolling=rolling_radius(self.pitch_diameter, self.gamma),
                speeds=speeds * RADIANS,
                loss=loss_of(self.loss_factor),
                inertia=ball_mass(self.ball_diameter, self.density) if self.ball_inertia else 0.0,
            )
        return self._known[key]

    def _law(self, race: str, speeds: _Floats) -> Any:
        if self.oil is None:
            return tabulate_dry_race(self.race(race).kn)
        limit = inf if self.film_limit is None else self.film_limit
        return tabulate_race([self.element(race, speed) for speed in speeds.tolist()], limit)

    def speed(self, speed_rpm: float) -> float:
        """The speed [rev/min] where the bearing can run at it; raises `InputError` where not."""
        speed = require_nonnegative("speed_rpm", speed_rpm)
        if self.oil is None:
            return speed
        if speed == 0.0:
            raise InputError("speed_rpm", speed, "> 0 for a bearing with oil: without rolling there is no film")
        INPUTS["speed_rpm"].require("speed_rpm", speed)
        if speed > self.highest_speed:
            allowed = f"at most {self.highest_speed:.5g}, where the atlas ends for this bearing and oil"
            raise InputError("speed_rpm", speed, allowed)
        return speed

    def to_dict(self) -> dict[str, Any]:
        """All arguments, ready for JSON."""
        found = {f.name: getattr(self, f.name) for f in fields(self) if f.init}
        return found | {"oil": None if self.oil is None else asdict(self.oil)}

    @classmethod
    def from_dict(cls, entries: Mapping[str, Any]) -> Self:
        """Rebuild a bearing from `to_dict`; raises `InputError` for entries that are missing, unknown or wrong."""
        oil = entries.get("oil")
        require_instance("oil", oil, dict | None, "an object, or null")
        require_names(entries, [f.name for f in fields(cls) if f.init])
        if oil is not None:
            require_names(oil, [f.name for f in fields(Lubricant)], "oil.")
        return cls(**{**entries, "oil": None if oil is None else Lubricant(**oil)})
