"""One contact: bodies, oil, load and speed in SI, its Moes numbers, and the units and signs of the library.

* x along rolling, y across; Hertz semi-axes a, b; ``kappa = a/b`` (not the viscosity ratio of ISO 281).
* ``u_sum = u1 + u2``; 2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2.
* Moes, with Rx and u_sum: ``M = f/(E' Rx^2) (E' Rx/(eta0 u_sum))^(3/4)``,
  ``L = alpha E' (eta0 u_sum/(E' Rx))^(1/4)``.
* X = x/a, Y = y/b, P = p/p_h, H = h/delta_H with the dry approach delta_H = a^2 K/(2 R E),
  T = u_sum t/(2a): surfaces carry the film at dX/dT = 1.
* The mutual approach u (dry Hertz value 1) is positive when the bodies come closer.
* Force unit f0 (the static load), so stiffness unit f0/delta_H and damping unit (f0/delta_H)(2a/u_sum).

Nonato and Cavalca (2010), eqs. 1-5; their u_m is u_sum, and their H0 is -u in eq. 3 and u in eqs. 5-8.
The full table is in docs/notation.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from math import inf, pi, sqrt
from typing import ClassVar

from ehlcontact.checks import require_finite, require_nonnegative, require_positive, shown
from ehlcontact.checks.admissible_range import INPUTS, Given, require_admissible
from ehlcontact.checks.kinds import Object
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import InputError
from ehlcontact.film_formulas import expected_film, film_to_moes, load_number, moes_pressure
from ehlcontact.hertz import HertzContact, ellipse_ratio, hertz_contact, scaled_axis, shape_factor
from ehlcontact.jit import plain
from ehlcontact.lubricant import FluidLaw, Lubricant, log_viscosity
from ehlcontact.summary import Summary, contact_text, entries_of, quantity_text, wrapped


@fields_take(alpha="1/Pa", eta0="Pa s")
@dataclass(frozen=True, slots=True)
class MoesPoint(Summary):
    """Dimensionless operating point: Moes load M, Moes lubricant L, ellipse ratio kappa = a/b.

    ``alpha`` [1/Pa] and ``eta0`` [Pa s] do not follow from M and L but set the Hertz pressure, hence the
    compressibility and Roelands' departure from Barus. The defaults are Venner and Lubrecht's. L = 0 is the limit
    of small L, where that pressure goes to 0: the oil is incompressible and has the viscosity eta0 everywhere.

    Parameters
    ----------
    M, L, kappa : float
        Moes' numbers with Rx and the sum of the speeds; Hertz semi-axis along rolling over that across (not the
        viscosity ratio of ISO 281).
    alpha, eta0 : float
        Pressure-viscosity coefficient [1/Pa], viscosity at ambient pressure [Pa s].
    viscosity, density : str
        "roelands" or "barus", "dowson-higginson" or "incompressible".

    Raises
    ------
    InputError
        M, kappa, alpha or eta0 not finite and > 0, L negative, or an unknown law.
    """

    M: float
    L: float
    kappa: float
    alpha: float = 2.2e-8
    eta0: float = 0.04
    viscosity: str = "roelands"
    density: str = "dowson-higginson"

    def _summary_lines(self) -> list[str]:
        own = {"alpha": quantity_text(self.alpha, "1/Pa"), "eta0": quantity_text(self.eta0, "Pa s")}
        laws = f"{self.viscosity}, {self.density}"
        return [contact_text(self), f"{', '.join(f'{name} {text}' for name, text in own.items())}, {laws}"]

    def __post_init__(self) -> None:
        object.__setattr__(self, "M", require_positive("M", self.M))
        object.__setattr__(self, "L", require_nonnegative("L", self.L))
        object.__setattr__(self, "alpha", require_positive("alpha", self.alpha))
        object.__setattr__(self, "kappa", require_finite("kappa", self.kappa))
        if not 1e-2 <= self.kappa <= 1e2:
            raise InputError("kappa", self.kappa, "between 0.01 and 100")
        Lubricant(self.eta0, self.alpha, self.viscosity, self.density)  # raises on what it cannot take

    @property
    def scaled_axis(self) -> float:
        """A = a/(Rx U^(1/4)) with U = eta0 u_sum/(E' Rx)."""
        return scaled_axis(self.M, self.kappa)

    @property
    def lam(self) -> float:
        """Coefficient lambda of the Reynolds equation (eq. 2)."""
        return 16.0 * pi * shape_factor(self.kappa) ** 2 / (self.kappa * self.M * self.scaled_axis)

    @property
    def alpha_bar(self) -> float:
        """Alpha times the Hertz pressure."""
        return moes_pressure(self.M, self.L, self.kappa)

    @property
    def p_hertz(self) -> float:
        """Hertz pressure [Pa] that M, L and alpha imply; 0 at L = 0, its limit."""
        return self.alpha_bar / self.alpha

    @property
    def law(self) -> FluidLaw:
        """Viscosity and density laws in units of the Hertz pressure."""
        lubricant = Lubricant(self.eta0, self.alpha, self.viscosity, self.density)
        return lubricant.law(self.p_hertz, self.alpha_bar)

    @property
    def film_to_moes(self) -> float:
        """Factor from H to the Moes film (h/Rx) sqrt(E' Rx/(eta0 u_sum))."""
        return film_to_moes(self.M, self.kappa)

    @property
    def load_number(self) -> float:
        """Wijnant's load number N = sqrt(Rx/Ry) M: thick films below about 3, whatever kappa."""
        return load_number(self.M, self.kappa)

    @property
    def expected_film(self) -> float:
        """Published central film (Nijenbanning, Venner and Moes) in dry approaches."""
        return expected_film(self.M, self.L, self.kappa)

    @property
    def inlet_width(self) -> float:
        """Width of the zone where the pressure of the inlet rises to that of the dry contact, in semi-axes.

        The gap beside a dry contact opens like x^(3/2), and the film to be carried in is the central one.
        """
        return self.expected_film ** (2.0 / 3.0)

    @property
    def moes(self) -> MoesPoint:
        """The point itself: an `OperatingPoint` has its own."""
        return self

    @property
    def scales(self) -> Scales:
        """Units of its results, which have none: all 1."""
        return NO_UNITS

    def to_dict(self) -> dict[str, float | str]:
        """All fields, for storage."""
        return asdict(self)


@fields_take(radius_x="m", radius_y="m", e1="Pa", e2="Pa")
@dataclass(frozen=True, slots=True)
class Geometry(Summary):
    """Two bodies in point contact.

    Parameters
    ----------
    radius_x, radius_y : float
        Radii of relative curvature along rolling and across [m]; 1/radius is the sum of both curvatures.
    e1, nu1, e2, nu2 : float
        Young's modulus [Pa] and Poisson's ratio of each body; bearing steel by default.
    """

    radius_x: float
    radius_y: float
    e1: float = 2.06e11
    nu1: float = 0.3
    e2: float = 2.06e11
    nu2: float = 0.3

    def __post_init__(self) -> None:
        for name in ("radius_x", "radius_y", "e1", "e2"):
            object.__setattr__(self, name, require_positive(name, getattr(self, name)))
            INPUTS[name].require(name, getattr(self, name))
        for name in ("nu1", "nu2"):
            if not 0.0 <= require_nonnegative(name, getattr(self, name)) <= 0.5:
                raise InputError(name, getattr(self, name), "between 0 and 0.5")
        ellipse_ratio(self.radius_x, self.radius_y)

    @classmethod
    @takes(ball_diameter="m", pitch_diameter="m")
    def ball_bearing(
        cls,
        ball_diameter: float,
        pitch_diameter: float,
        conformity: float,
        race: str = "inner",
        **materials: float,
    ) -> Geometry:
        """Contact of a ball with a race at zero contact angle; diameters in m, conformity r_groove/D.

        Conformities of bearings are 0.505 to 0.60. Above 0.7 they are refused, with the value that another
        definition means: 1.04 as groove radius over ball radius is 0.52, and so is 0.9615, its inverse.

        Raises
        ------
        InputError
            A diameter or a conformity that no bearing has, pitch not above ball diameter, unknown race.
        """
        D = require_positive("ball_diameter", ball_diameter)
        dm = require_positive("pitch_diameter", pitch_diameter)
        INPUTS["ball_diameter"].require("ball_diameter", D)
        INPUTS["pitch_diameter"].require("pitch_diameter", dm)
        if dm <= D:
            raise InputError("pitch_diameter", dm, f"above ball_diameter = {D!r}")
        if not require_positive("conformity", conformity) > 0.5:
            raise InputError("conformity", conformity, "above 0.5 (a tighter groove pinches the ball)")
        INPUTS["conformity"].require("conformity", conformity)
        if race not in ("inner", "outer"):
            raise InputError("race", race, "one of inner, outer")
        along = 2.0 / D + 2.0 / (dm - D) if race == "inner" else 2.0 / D - 2.0 / (dm + D)
        return cls(1.0 / along, 1.0 / (2.0 / D - 1.0 / (conformity * D)), **materials)

    @classmethod
    @takes(ball_diameter="m")
    def ball_on_flat(cls, ball_diameter: float, **materials: float) -> Geometry:
        """Contact of a ball [m] with a flat, as on a ball-on-disc rig; the ball is the first body.

        A glass disc: ``Geometry.ball_on_flat(19.05e-3, e1=2.1e11, e2=7e10, nu2=0.21)``.

        Raises
        ------
        InputError
            A diameter that no ball has; an impossible material.
        """
        D = require_positive("ball_diameter", ball_diameter)
        INPUTS["ball_diameter"].require("ball_diameter", D)
        return cls(0.5 * D, 0.5 * D, **materials)

    @property
    def e_reduced(self) -> float:
        """E' with 2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2 [Pa]."""
        return 2.0 / ((1.0 - self.nu1**2) / self.e1 + (1.0 - self.nu2**2) / self.e2)

    @property
    def kappa(self) -> float:
        """Ellipse ratio a/b."""
        return ellipse_ratio(self.radius_x, self.radius_y)


@dataclass(frozen=True, slots=True)
class Scales(Summary):
    """SI values of the dimensionless units at an operating point.

    Attributes
    ----------
    force, length, time : float
        f0 [N]; dry approach delta_H, unit of u and H [m]; 2a/u_sum [s].
    a, b, pressure : float
        Semi-axes along rolling and across [m]; Hertz pressure [Pa].
    """

    FIELD_UNITS: ClassVar[Mapping[str, str]] = {
        "force": "N",
        "length": "m",
        "time": "s",
        "a": "m",
        "b": "m",
        "pressure": "Pa",
    }

    force: float
    length: float
    time: float
    a: float
    b: float
    pressure: float

    @property
    def stiffness(self) -> float:
        """f0/delta_H [N/m]."""
        return self.force / self.length

    @property
    def damping(self) -> float:
        """(f0/delta_H)(2a/u_sum) [N s/m]."""
        return self.force / self.length * self.time

    @property
    def moment(self) -> float:
        """f0 a [N m]."""
        return self.force * self.a

    @property
    def rate(self) -> float:
        """delta_H u_sum/(2a), unit of du/dT [m/s]."""
        return self.length / self.time

    @property
    def acceleration(self) -> float:
        """delta_H (u_sum/(2a))^2, unit of d2u/dT2 [m/s2]."""
        return self.length / self.time**2

    @property
    def mass(self) -> float:
        """(f0/delta_H)(2a/u_sum)^2, unit of a mass: it is 1/Omega_n^2 [kg]."""
        return self.stiffness * self.time**2

    @property
    def frequency(self) -> float:
        """u_sum/(2a), unit of Omega [rad/s]."""
        return 1.0 / self.time

    @property
    def hertz(self) -> float:
        """u_sum/(4 pi a): frequency at Omega = 1 [Hz]."""
        return 1.0 / (2.0 * pi * self.time)

    @property
    def surface_speed(self) -> float:
        """u_sum/2, mean speed of the surfaces [m/s]."""
        return self.a / self.time


NO_UNITS = Scales(1.0, 1.0, 1.0, 1.0, 1.0, 1.0)


OIL = Object(Lubricant, "a Lubricant")


@fields_take(geometry=Object(Geometry, "a Geometry"), lubricant=OIL, load="N", u_sum="m/s")
@dataclass(frozen=True, slots=True)
class OperatingPoint(Summary):
    """A contact in SI units; every solver takes it, or a `MoesPoint`.

    Parameters
    ----------
    geometry : Geometry
    lubricant : Lubricant
    load, u_sum : float
        Static load of the contact [N], sum of the surface speeds [m/s].

    Attributes
    ----------
    moes, scales : MoesPoint, Scales
        The same point without dimensions, and the way back.

    Raises
    ------
    InputError
        An input that is no rolling contact's, with a guess at the unit it was given in; an isoviscous oil
        (alpha = 0): give a `MoesPoint` with L = 0.
    """

    geometry: Geometry
    lubricant: Lubricant
    load: float
    u_sum: float
    moes: MoesPoint = field(init=False, repr=False)
    scales: Scales = field(init=False, repr=False)

    def _summary_lines(self) -> list[str]:
        return [contact_text(self), *wrapped(entries_of(self.geometry)), *wrapped(entries_of(self.lubricant))]

    def __post_init__(self) -> None:
        object.__setattr__(self, "load", require_positive("load", self.load))
        object.__setattr__(self, "u_sum", require_positive("u_sum", self.u_sum))
        geometry, oil = self.geometry, self.lubricant
        require_positive("alpha", oil.alpha)
        for name, value in {"eta0": oil.eta0, "alpha": oil.alpha, "load": self.load, "u_sum": self.u_sum}.items():
            INPUTS[name].require(name, value)
        e, rx = geometry.e_reduced, geometry.radius_x
        U = oil.eta0 * self.u_sum / (e * rx)
        hertz: HertzContact = hertz_contact(self.load, rx, geometry.radius_y, e)
        M = self.load / (e * rx * rx) * U**-0.75
        L = oil.alpha * e * U**0.25
        moes = MoesPoint(M, L, hertz.kappa, oil.alpha, oil.eta0, oil.viscosity, oil.density)
        object.__setattr__(self, "moes", moes)
        time = 2.0 * hertz.a / self.u_sum
        scales = Scales(self.load, hertz.approach, time, hertz.a, hertz.b, hertz.pressure)
        object.__setattr__(self, "scales", scales)

    @classmethod
    @takes(lubricant=OIL, ball_diameter="m", pitch_diameter="m", speed_rpm="rev/min", load="N")
    def ball_bearing(
        cls,
        lubricant: Lubricant,
        *,
        ball_diameter: float,
        pitch_diameter: float,
        conformity: float,
        speed_rpm: float,
        load: float,
        race: str = "inner",
        **materials: float,
    ) -> OperatingPoint:
        """Operating point of one ball on one race in pure rolling, the other race standing still.

        Parameters
        ----------
        ball_diameter, pitch_diameter : float
            In m.
        conformity : float
            Groove radius over ball diameter.
        speed_rpm : float
            Speed of one race relative to the other [rev/min].
        load : float
            Force on this ball [N]; `most_loaded_ball` has it for a radial load.
        """
        geometry = Geometry.ball_bearing(ball_diameter, pitch_diameter, conformity, race, **materials)
        INPUTS["speed_rpm"].require("speed_rpm", require_positive("speed_rpm", speed_rpm))
        omega = speed_rpm * pi / 30.0
        gamma = ball_diameter / pitch_diameter
        # Both surfaces roll at omega dm (1 - gamma^2)/4 seen from the contact, on either race.
        u_sum = omega * pitch_diameter * (1.0 - gamma * gamma) / 2.0
        return cls(geometry, lubricant, load, u_sum)

    @classmethod
    @takes(lubricant=OIL, ball_diameter="m", entrainment_speed="m/s", load="N")
    def ball_on_flat(
        cls,
        lubricant: Lubricant,
        *,
        ball_diameter: float,
        entrainment_speed: float,
        load: float,
        **materials: float,
    ) -> OperatingPoint:
        """Operating point of a ball rolling on a flat, as on a ball-on-disc rig.

        Parameters
        ----------
        ball_diameter : float
            In m.
        entrainment_speed : float
            Mean of both surface speeds [m/s]: half of `u_sum`.
        load : float
            In N.
        **materials
            ``e1``, ``nu1`` of the ball, ``e2``, ``nu2`` of the flat, as of `Geometry`; bearing steel by default.
        """
        geometry = Geometry.ball_on_flat(ball_diameter, **materials)
        speed = require_positive("entrainment_speed", entrainment_speed)
        INPUTS["entrainment_speed"].require("entrainment_speed", speed)
        return cls(geometry, lubricant, load, 2.0 * speed)

    def to_dict(self) -> dict[str, float | str]:
        """Load, speed, bodies and oil, and the Moes numbers that they make, ready for JSON."""
        body = {"radius_x": self.geometry.radius_x, "radius_y": self.geometry.radius_y}
        body["e_reduced"] = self.geometry.e_reduced
        return {"load": self.load, "u_sum": self.u_sum, **body, **self.moes.to_dict()}

    @takes(mass="kg")
    def Omega_n(self, mass: float) -> float:
        """Omega_n, dimensionless, of a mass [kg] on the contact: ``sqrt(8 f0 R E/(m u_sum^2 K))``, eq. 5."""
        s = self.scales
        return sqrt(s.force * s.time**2 / (require_positive("mass", mass) * s.length))


Point = MoesPoint | OperatingPoint
POINT = Object((MoesPoint, OperatingPoint), "a MoesPoint or an OperatingPoint")


def moes_point(point: Point) -> MoesPoint:
    """Return the dimensionless point of either kind of operating point."""
    if isinstance(point, MoesPoint):
        return point
    if isinstance(point, OperatingPoint):
        return point.moes
    raise InputError("point", shown(point), "a MoesPoint or an OperatingPoint")


def require_solvable(point: Point, largest_load: float = 1.0, given: Given | None = None) -> MoesPoint:
    """Return the dimensionless point, or raise `InputError` where it lies outside what the solvers are made for.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
    largest_load : float
        That the contact will have to carry; the static load is 1.
    given : mapping, optional
        What a user gave in place of the point's own inputs: the message guesses at a slip of unit in them.

    Raises
    ------
    InputError
        An input that is no rolling contact's; M, L, kappa or a pressure outside `checks.admissible_range`.
    """
    moes = moes_point(point)
    cases = {"": moes}
    if largest_load > 1.0:
        cases[" under the largest load"] = replace(moes, M=moes.M * largest_load)
    inputs = given if given is not None and isinstance(point, OperatingPoint) else _inputs(point)
    require_admissible({when: _range_numbers(case) for when, case in cases.items()}, inputs)
    return moes


def _inputs(point: Point) -> Given:
    """SI inputs of a point."""
    if isinstance(point, MoesPoint):
        values = {"alpha": point.alpha, "eta0": point.eta0}
    else:
        body, oil = point.geometry, point.lubricant
        values = {name: getattr(body, name) for name in ("radius_x", "radius_y", "e1", "e2")}
        values |= {"eta0": oil.eta0, "alpha": oil.alpha, "load": point.load, "u_sum": point.u_sum}
    return {name: (value, INPUTS[name]) for name, value in values.items()}


def _range_numbers(moes: MoesPoint) -> dict[str, float]:
    """What `require_admissible` looks at."""
    try:
        exponent = float(plain(log_viscosity)(1.0, moes.law)[0])
    except OverflowError:
        exponent = inf
    return {"M": moes.M, "L": moes.L, "kappa": moes.kappa, "p_hertz": moes.p_hertz, "log_viscosity": exponent}


def scales_of(point: Point) -> Scales | None:
    """SI scales of the point; None where it has none."""
    return point.scales if isinstance(point, OperatingPoint) else None
