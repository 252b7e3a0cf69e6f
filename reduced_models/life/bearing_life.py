"""`BearingLife`: rating life of one bearing from the loads of all balls, beside that of the catalogue formula.

ISO/TS 16281, point contacts. A race has the dynamic equivalent load of a ball from the loads Q of all balls, with
the exponent 3 where the race turns against the load and 10/3 where it stands still,

    Q_ei = mean(Q^3)^(1/3),    Q_ee = mean(Q^(10/3))^(3/10),

and with the loads Q_ci, Q_ce of a million turns (`load_ratings.rated_loads`) the basic reference rating life is

    L10r = ((Q_ci/Q_ei)^(-10/3) + (Q_ce/Q_ee)^(-10/3))^(-9/10)    million turns.

The modified one is Lnmr = a1 a_ISO L10r, with the reference load C/L10r^(1/3) in a_ISO (`life_modification`).
Loads of balls are those of the equilibrium: with contact angles, clearance, tilts, and centrifugal force at the
outer race.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, inf, isfinite, nan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import parts
from ehlcontact.errors import InputError
from ehlcontact.summary import Summary
from reduced_models.life import life_modification as factors
from reduced_models.life.equivalent_load import dynamic_load, static_load
from reduced_models.life.internal_geometry import InternalGeometry
from reduced_models.life.load_ratings import RATED_PRESSURE, LoadRatings, rated_loads

_Floats = NDArray[np.float64]

TURNING, STANDING = (
    3.0,
    10.0 / 3.0,
)  # exponents of a race that turns against the load, and of one that stands still
LIFE_POWER, RACE_POWER, SLOPE = 3.0, 10.0 / 3.0, 10.0 / 9.0  # of load; of the load of a ball; Weibull slope
PER_HOUR = 60e-6  # million turns per hour and rev/min
HEAVY = 0.5  # of C: largest load of the standard
SKID_SHARE = 0.01  # of C: least load of a ball bearing where SKF has no constants
FAST = 1e6  # mm/min: speed times mean diameter from which the standard's bearings no longer run as they are rated
FULL = 1.0  # lambda below which surfaces touch
MISALIGNED = 3e-3  # rad: about the largest tilt that catalogues allow a deep-groove bearing


@dataclass(frozen=True, kw_only=True)
class BallLoads:
    """Loads of the balls of a bearing as life needs them.

    Attributes
    ----------
    speed_rpm : float
        Of the shaft [rev/min].
    radial, axial : float
        Load on the ring [N].
    inner, outer : float
        Dynamic equivalent load of a ball at both races [N].
    largest : (float, float)
        Largest load of a ball at both races [N].
    lambda_ratio : float or None
        Least film over roughness of the most loaded ball; None where it is not known.
    tilt : float
        Misalignment of the rings [rad].
    """

    speed_rpm: float
    radial: float
    axial: float
    inner: float
    outer: float
    largest: tuple[float, float]
    lambda_ratio: float | None = None
    tilt: float = 0.0

    @classmethod
    def at_rest(
        cls,
        force: _Floats,
        load: _Floats,
        speed_rpm: float,
        lambda_ratio: float | None = None,
        tilt: float = 0.0,
        ring_speeds: tuple[float, float] = (1.0, 0.0),
    ) -> BallLoads:
        """Of balls under `force`, shape (balls, 2) [N], and a load that stands still, shape (2,) or (5,) [N]."""
        pressed = np.maximum(force, 0.0)
        powers = exponents(ring_speeds)
        return cls(
            speed_rpm=speed_rpm,
            radial=hypot(float(load[0]), float(load[1])),
            axial=abs(float(load[2])) if load.size > 2 else 0.0,
            inner=power_mean(pressed[:, 0], powers[0]),
            outer=power_mean(pressed[:, 1], powers[1]),
            largest=(float(pressed[:, 0].max()), float(pressed[:, 1].max())),
            lambda_ratio=lambda_ratio,
            tilt=tilt,
        )


@dataclass(frozen=True, kw_only=True)
class BearingLife(Summary):
    """Rating life of a ball bearing.

    Attributes
    ----------
    geometry : InternalGeometry
    ratings : LoadRatings
        C, C0, Cu with their sources.
    loads : BallLoads
    contamination : float, str or None
        Factor or class; None: no modified life.
    reliability : float
        Of the modified life [%].
    kinematic_viscosity : float or None
        Of the oil [m2/s]; None of a dry bearing.
    given_ratio : float or None
        Viscosity ratio in place of that of the oil.
    """

    geometry: InternalGeometry
    ratings: LoadRatings
    loads: BallLoads
    contamination: float | str | None = None
    reliability: float = factors.BASIC_RELIABILITY
    kinematic_viscosity: float | None = None
    given_ratio: float | None = None

    def _summary_lines(self) -> list[str]:
        c, source = self.ratings.dynamic, self.ratings.dynamic_source
        name = self.geometry.name or "ball bearing"
        lines = [
            f"{name}, L10r {_in_words(self.l10r)} million turns{self._hours_words()}",
            f"C {1e-3 * c:.4g} kN {source}, reference load {self.reference_load:.4g} N; "
            f"by P = {self.equivalent_load:.4g} N: L10 {_in_words(self.l10)} million turns",
        ]
        modified = self._modified_words()
        lines += [modified] if modified else []
        safety = (
            f"static safety {_in_words(self.static_safety)}, by contact pressure {_in_words(self.pressure_safety)}"
        )
        lines.append(f"{safety}; n dm {self.speed_factor:.3g} mm/min, least load {self.least_load:.3g} N")
        return lines + ([f"not covered: {self.not_covered[0]}"] if self.not_covered else [])

    def _hours_words(self) -> str:
        return "" if self.l10rh is None else f", {_in_words(self.l10rh)} h at {self.loads.speed_rpm:.5g} rev/min"

    def _modified_words(self) -> str:
        if self.lnmrh is None and self.lnmrh_film is None:
            return ""
        rows = ("nu/nu1", self.viscosity_ratio, self.lnmrh), ("the film", self.film_ratio, self.lnmrh_film)
        found = [
            f"{_in_words(life)} h with kappa {ratio:.3g} of {of}" for of, ratio, life in rows if life is not None
        ]
        return f"modified, {self.reliability:g} %: {' and '.join(found)}"

    @property
    def q_ci(self) -> float:
        """Load of a ball under which the inner race has a life of a million turns [N]."""
        return rated_loads(self.geometry, self.ratings.dynamic)[0]

    @property
    def q_ce(self) -> float:
        """Load of a ball under which the outer race has a life of a million turns [N]."""
        return rated_loads(self.geometry, self.ratings.dynamic)[1]

    @property
    def q_ei(self) -> float:
        """Dynamic equivalent load of a ball at the inner race [N]."""
        return self.loads.inner

    @property
    def q_ee(self) -> float:
        """Dynamic equivalent load of a ball at the outer race [N]."""
        return self.loads.outer

    @property
    def l10r(self) -> float:
        """Basic reference rating life [million turns]; infinite without load."""
        damage = (self.q_ei / self.q_ci) ** RACE_POWER + (self.q_ee / self.q_ce) ** RACE_POWER
        return float(damage ** (-1.0 / SLOPE)) if damage > 0.0 else inf

    @property
    def l10rh(self) -> float | None:
        """Basic reference rating life at the speed [h]; None at rest."""
        return self._hours(self.l10r)

    @property
    def reference_load(self) -> float:
        """Dynamic equivalent reference load P_ref [N]: the one that has this life by the catalogue formula."""
        return self.ratings.dynamic / self.l10r ** (1.0 / LIFE_POWER) if isfinite(self.l10r) else 0.0

    @property
    def equivalent_load(self) -> float:
        """Dynamic equivalent load P of the catalogue formula, with X and Y [N]."""
        g = self.geometry
        return dynamic_load(
            self.loads.radial,
            self.loads.axial,
            contact_angle=g.contact_angle,
            balls=g.balls,
            ball_diameter=g.ball_diameter,
        )

    @property
    def l10(self) -> float:
        """Basic rating life (C/P)^3 of the catalogue formula [million turns]; infinite without load."""
        return basic_life(self.ratings.dynamic, self.equivalent_load)

    @property
    def l10h(self) -> float | None:
        """Basic rating life of the catalogue formula at the speed [h]; None at rest."""
        return self._hours(self.l10)

    @property
    def reference_viscosity(self) -> float | None:
        """Viscosity nu1 that the speed needs [m2/s]; None at rest."""
        speed = self.loads.speed_rpm
        return factors.reference_viscosity(speed, self.geometry.pitch_diameter) if speed > 0.0 else None

    @property
    def viscosity_ratio(self) -> float | None:
        """Viscosity ratio kappa = nu/nu1; None of a dry bearing, and at rest."""
        if self.given_ratio is not None:
            return self.given_ratio
        if self.kinematic_viscosity is None or self.reference_viscosity is None:
            return None
        return self.kinematic_viscosity / self.reference_viscosity

    @property
    def film_ratio(self) -> float | None:
        """Viscosity ratio that the solved film stands for, Lambda^1.3; None where no roughness is given."""
        ratio = self.loads.lambda_ratio
        return None if ratio is None else factors.film_ratio(ratio)

    @property
    def a1(self) -> float:
        """Factor of the reliability."""
        return factors.reliability_factor(self.reliability)

    @property
    def a_iso(self) -> float | None:
        """Life modification factor with nu/nu1; None without contamination, or outside the standard."""
        return self._modification(self.viscosity_ratio)

    @property
    def a_iso_film(self) -> float | None:
        """Life modification factor with the viscosity ratio of the film."""
        return self._modification(self.film_ratio)

    @property
    def lnmr(self) -> float | None:
        """Modified reference rating life with nu/nu1 [million turns]; None where `a_iso` is."""
        return None if self.a_iso is None else self.a1 * self.a_iso * self.l10r

    @property
    def lnmrh(self) -> float | None:
        """The same at the speed [h]."""
        return self._hours(self.lnmr)

    @property
    def lnmr_film(self) -> float | None:
        """Modified reference rating life with the viscosity ratio of the film [million turns]."""
        return None if self.a_iso_film is None else self.a1 * self.a_iso_film * self.l10r

    @property
    def lnmrh_film(self) -> float | None:
        """The same at the speed [h]."""
        return self._hours(self.lnmr_film)

    def contamination_factor(self, viscosity_ratio: float) -> float | None:
        """Factor ec at a viscosity ratio; None where no contamination is given."""
        if self.contamination is None:
            return None
        ratio = min(viscosity_ratio, factors.MOST_RATIO)
        return factors.contamination_factor(self.contamination, ratio, self.geometry.pitch_diameter)

    @property
    def static_safety(self) -> float:
        """C0 over the equivalent static load P0 with X0 and Y0; infinite without load."""
        p0 = static_load(self.loads.radial, self.loads.axial, self.geometry.contact_angle)
        return self.ratings.static / p0 if p0 > 0.0 else inf

    @property
    def largest_pressure(self) -> float:
        """Largest Hertz pressure of all contacts [Pa]."""
        rows = zip(self.geometry.unit_pressures, self.loads.largest, strict=True)
        return max(unit * force ** (1.0 / 3.0) for unit, force in rows)

    @property
    def pressure_safety(self) -> float:
        """Static safety from the largest contact pressure: load under which it were 4.2 GPa, over its load."""
        return (RATED_PRESSURE / self.largest_pressure) ** 3 if self.largest_pressure > 0.0 else inf

    @property
    def speed_factor(self) -> float:
        """Speed times pitch diameter, n dm [mm/min]."""
        return 1e3 * self.loads.speed_rpm * self.geometry.pitch_diameter

    @property
    def least_load(self) -> float:
        """Load below which balls may skid [N]: by SKF's formula where it has the series, else 0.01 C."""
        least = self.geometry.least_load
        if least is None or self.kinematic_viscosity is None or self.loads.speed_rpm == 0.0:
            return SKID_SHARE * self.ratings.dynamic
        return least.at(self.loads.speed_rpm, self.kinematic_viscosity)

    @property
    def needs_axial_load(self) -> bool:
        """Whether the radial load is below SKF's least load, a radial one, and P with the axial load is not."""
        if self.geometry.least_load is None:
            return False
        return self.loads.radial < self.least_load <= self.equivalent_load

    @property
    def not_covered(self) -> tuple[str, ...]:
        """What the standards do not cover here, a text with its number each."""
        g, loads, ratio = self.geometry, self.loads, self.viscosity_ratio
        film, found = loads.lambda_ratio, []
        if self.reference_load > HEAVY * self.ratings.dynamic:
            found.append(f"load {self.reference_load:.3g} N above C/2: steel does not stay elastic")
        if self.pressure_safety < 1.0:
            found.append(f"contact pressure {1e-9 * self.largest_pressure:.3g} GPa above 4.2 GPa leaves marks")
        if g.is_hybrid:
            found.append("ceramic balls: ISO 281 is for steel on steel; ISO 20056 has hybrid bearings")
        if not g.flooded:
            found.append("starved films: nu/nu1 takes all the oil that a film needs; the ratio of the film has it")
        if film is not None and film < FULL:
            found.append(f"lambda {film:.3g} below 1: surfaces touch, so wear and not only fatigue ends the life")
        if ratio is not None and ratio < factors.LEAST_RATIO:
            found.append(f"viscosity ratio {ratio:.3g} below 0.1: no a_ISO in the standard")
        if 0.0 < self.equivalent_load < self.least_load:
            found.append(
                f"P {self.equivalent_load:.3g} N below the least load {self.least_load:.3g} N: balls may skid"
            )
        if self.speed_factor > FAST:
            found.append(f"n dm {self.speed_factor:.3g} mm/min above 1e6: heat, cage and lubrication set the life")
        if loads.tilt > MISALIGNED:
            found.append(
                f"misalignment {1e3 * loads.tilt:.3g} mrad above 3: in the loads of the balls, not in a_ISO"
            )
        return tuple(found)

    def to_dict(self) -> dict[str, Any]:
        """All numbers, SI but for lives in million turns and hours, ready for JSON; None for infinite ones."""
        names = (
            "q_ci", "q_ce", "q_ei", "q_ee", "l10r", "l10rh", "reference_load", "equivalent_load", "l10", "l10h",
            "reliability", "a1", "viscosity_ratio", "film_ratio", "a_iso", "a_iso_film", "lnmr", "lnmrh",
            "lnmr_film", "lnmrh_film", "static_safety", "largest_pressure", "pressure_safety", "speed_factor",
            "least_load", "kinematic_viscosity", "reference_viscosity",
        )  # fmt: skip
        ratios = self.viscosity_ratio, self.film_ratio
        contamination = [None if ratio is None else self.contamination_factor(ratio) for ratio in ratios]
        return {
            "name": self.geometry.name,
            "speed_rpm": self.loads.speed_rpm,
            "radial": self.loads.radial,
            "axial": self.loads.axial,
            "ratings": self.ratings.to_dict(),
            **{name: finite(getattr(self, name)) for name in names},
            "contamination": self.contamination,
            "contamination_factor": contamination[0],
            "contamination_factor_film": contamination[1],
            "not_covered": list(self.not_covered),
        }

    def _hours(self, turns: float | None) -> float | None:
        """Life at the speed [h] of one in million turns."""
        return None if turns is None else hours(turns, self.loads.speed_rpm)

    def _modification(self, ratio: float | None) -> float | None:
        if ratio is None or self.contamination is None or ratio < factors.LEAST_RATIO:
            return None
        share = (self.contamination_factor(ratio) or 0.0) * self.ratings.fatigue_limit
        limit = share / self.reference_load if self.reference_load > 0.0 else inf
        return factors.life_modification(min(ratio, factors.MOST_RATIO), limit)


def life_of_bearing(
    geometry: InternalGeometry | None,
    loads: BallLoads,
    *,
    contamination: float | str | None = None,
    reliability: float = factors.BASIC_RELIABILITY,
    dynamic_rating: float | None = None,
    static_rating: float | None = None,
    fatigue_limit: float | None = None,
    kinematic_viscosity: float | None = None,
    viscosity_ratio: float | None = None,
) -> BearingLife:
    """Rating life of a bearing under loads of its balls.

    Parameters
    ----------
    geometry : InternalGeometry
    loads : BallLoads
    contamination : float or str, optional
        Contamination factor ec above 0 and at most 1, or a class: "high cleanliness", "normal cleanliness",
        "slight contamination", "severe contamination", "very severe contamination" of grease; "-/15/12" of an oil
        bath by ISO 4406, "-/15/12 filtered" with a filter inline. Without it there is no modified life.
    reliability : float
        Of the modified life, 90 to 99.95 %.
    dynamic_rating, static_rating : float, optional
        C and C0 [N]; by default of the catalogue where it has them, else from the geometry.
    fatigue_limit : float, optional
        Cu [N]; by default from C0.
    kinematic_viscosity : float, optional
        Of the oil [m2/s]; by default `kinematic_viscosity` of the bearing's oil.
    viscosity_ratio : float, optional
        nu/nu1, 0.1 to 4, in place of the one from the oil.

    Raises
    ------
    InputError
        Contamination beyond (0, 1], a reliability or a viscosity ratio outside the standard, a rating far from
        that of the geometry; a state without its geometry.
    """
    if geometry is None:
        raise InputError("state", "without its bearing", "one that `equilibrium` of a bearing made")
    nu = geometry.kinematic_viscosity
    if kinematic_viscosity is not None:
        nu = float(parts.VISCOSITY.take("kinematic_viscosity", kinematic_viscosity, True))
    return BearingLife(
        geometry=geometry,
        ratings=LoadRatings.of(
            geometry, dynamic=dynamic_rating, static=static_rating, fatigue_limit=fatigue_limit
        ),
        loads=loads,
        contamination=None if contamination is None else factors.require_contamination(contamination),
        reliability=factors.require_reliability(reliability),
        kinematic_viscosity=nu,
        given_ratio=None if viscosity_ratio is None else factors.require_viscosity_ratio(viscosity_ratio),
    )


def exponents(ring_speeds: tuple[float, float], load: float = 0.0) -> tuple[float, float]:
    """Exponents of both races, whose rings have these speeds, under a load that turns at another one."""
    inner, outer = (STANDING if speed == load else TURNING for speed in ring_speeds)
    return inner, outer


def power_mean(values: _Floats, power: float) -> float:
    """Mean of values >= 0 with a power."""
    return float(np.mean(values**power) ** (1.0 / power)) if values.size else nan


def basic_life(dynamic: float, load: float, power: float = LIFE_POWER) -> float:
    """Basic rating life (C/P)^3 [million turns], of roller bearings with the power 10/3; infinite without load."""
    return (dynamic / load) ** power if load > 0.0 else inf


def hours(turns: float, speed_rpm: float) -> float | None:
    """Hours of a life in million turns at a speed [rev/min]; None at rest."""
    return turns / (PER_HOUR * speed_rpm) if speed_rpm > 0.0 else None


def finite(value: float | None) -> float | None:
    """A number for JSON: None in place of an infinite one."""
    return value if value is not None and isfinite(value) else None


def _in_words(value: float | None) -> str:
    return "infinite" if value is None or not isfinite(value) else f"{value:.4g}"
