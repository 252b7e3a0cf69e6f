"""`SqueezeFilmDamper`: a journal that does not turn in a film of oil, with the spring that centres it.

Reynolds' equation in closed form, of a short bearing (open ends) or a long one (sealed ends), for any motion of
the journal: the film has no memory, so that its force is that of displacement and velocity. ``csrc/damper.h`` has
the equations, docs/squeeze_film_dampers.md where they come from.
"""

from __future__ import annotations

import ctypes
from ctypes import byref, c_double, c_size_t
from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact import Lubricant
from ehlcontact.checks import as_numbers, parts, require_choice, require_flag, shown
from ehlcontact.checks.kinds import NAME
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.summary import Summary
from reduced_models import core
from reduced_models.rotor.linear_bearing import LinearBearing

_Floats = NDArray[np.float64]

SEALS = ("open", "sealed")
LONGEST = 10.0  # lengths over diameters
CONTACT = "touches its housing: the eccentricity ratio is {:.4g}"


class DamperStructure(ctypes.Structure):
    """`Damper` of ``damper.h``."""

    _fields_ = [(name, c_double) for name in ("clearance", "open", "sealed", "stiffness", "cavitates")]


class DamperForces(NamedTuple):
    """Forces of a rotor on a damper in k motions, and their slopes."""

    force: _Floats  # (..., 2) [N]
    stiffness: _Floats  # (..., 2, 2), by displacements [N/m]
    damping: _Floats  # (..., 2, 2), by velocities [N s/m]


@fields_take(
    length=parts.FILM_LAND, clearance=parts.CLEARANCE, radius=parts.BORE._replace(zero=False),
    diameter=parts.BORE._replace(zero=False), stiffness=parts.STIFFNESS_OR_NONE, leakage=parts.SHARE, name=NAME,
)  # fmt: skip
@dataclass(frozen=True, kw_only=True)
class SqueezeFilmDamper(Summary):
    """A squeeze film damper: a journal, kept from turning, in a film of oil, and a spring that centres it.

    The film carries no static force: without a spring here or beside it nothing holds the rotor.

    Parameters
    ----------
    length : float
        Of the film along the shaft [m].
    radius, diameter : float
        Of the journal [m]: one of both.
    clearance : float
        Radial, of the journal in the middle [m].
    viscosity : float or Lubricant
        Of the oil at the temperature of the film [Pa s]; of a lubricant that at its temperature.
    cavitation : bool
        The film ruptures where it is pulled apart, and the half of positive pressure acts (pi film); False: the
        oil carries tension, as under a high feed pressure (2 pi film).
    seals : {"open", "sealed"}
        Ends: open, where the oil leaves at ambient pressure (short bearing); or sealed, so that it flows around
        the journal alone (long bearing).
    leakage : float
        Of sealed ends, 0 to 1: share of the open film in the force, the rest being of the sealed one.
    groove : bool
        An open film fed by a circumferential groove in its middle: two films of half the length.
    stiffness : float
        Of a centring spring, squirrel cage or retainer beside the film [N/m]; 0: none.
    name : str

    Raises
    ------
    InputError
        No length, clearance, viscosity or radius; a value outside its range.
    """

    length: float = None  # type: ignore[assignment]
    clearance: float = None  # type: ignore[assignment]
    viscosity: Any = None
    radius: float | None = None
    diameter: float | None = None
    cavitation: bool = True
    seals: str = SEALS[0]
    leakage: float = 0.0
    groove: bool = False
    stiffness: float = 0.0
    name: str = ""

    def __post_init__(self) -> None:
        for name, what in (("length", "of the film"), ("clearance", "radial"), ("viscosity", "of the oil")):
            if getattr(self, name) is None:
                raise InputError(name, None, f"given: {what}; a squeeze film damper has a length and a clearance")
        if self.radius is None and self.diameter is None:
            raise InputError("diameter", None, "given, or radius: that of the journal")
        if self.radius is None:
            object.__setattr__(self, "radius", 0.5 * self._diameter)
        if self.diameter not in (None, 2.0 * self._radius):
            raise InputError(
                "diameter", self.diameter, f"left out beside radius = {self._radius:g} m, or twice that"
            )
        object.__setattr__(self, "diameter", 2.0 * self._radius)
        if isinstance(self.viscosity, Lubricant):
            object.__setattr__(self, "viscosity", self.viscosity.eta0)
        object.__setattr__(self, "viscosity", parts.DYNAMIC_VISCOSITY.take("viscosity", self.viscosity, True))
        for name in ("cavitation", "groove"):
            require_flag(name, getattr(self, name))
        require_choice("seals", self.seals, SEALS)
        if not self.clearance < 0.1 * self._radius:
            raise InputError(
                "clearance", self.clearance, f"below a tenth of the radius, {0.1 * self._radius:.4g} m"
            )
        if self.length > LONGEST * self._diameter:
            raise InputError(
                "length", self.length, f"at most {LONGEST:g} diameters, {LONGEST * self._diameter:.4g} m"
            )
        if self.seals == "open" and self.leakage != 0.0:
            raise InputError("leakage", self.leakage, 'left out without seals="sealed": open ends leak all')
        if self.seals == "sealed" and self.groove:
            raise InputError("groove", True, 'left out with seals="sealed": it is for films whose ends are open')

    def _summary_lines(self) -> list[str]:
        ends = "open ends" if self.seals == "open" else f"sealed ends, leakage {self.leakage:g}"
        film = "pi film" if self.cavitation else "2 pi film"
        spring = f"spring of {1e-6 * self.stiffness:.4g} N/µm" if self.stiffness else "no spring"
        size = f"{1e3 * self.length:.4g} mm long, diameter {1e3 * self._diameter:.4g} mm"
        return [
            f"{self.name or 'squeeze film damper'}, {size}, clearance {1e6 * self.clearance:.4g} µm",
            f"{1e3 * self.viscosity:.4g} mPa s, {ends}{', grooved' if self.groove else ''}, {film}, {spring}",
        ]

    @property
    def _radius(self) -> float:
        assert self.radius is not None
        return self.radius

    @property
    def _diameter(self) -> float:
        assert self.diameter is not None
        return self.diameter

    @property
    def structure(self) -> DamperStructure:
        """The damper in C."""
        leaks = 1.0 if self.seals == "open" else self.leakage
        lands = 0.25 if self.groove else 1.0  # two of half the length: 2 (1/2)^3
        short = lands * self.viscosity * self.length**3 * self._radius / self.clearance**3
        long = 12.0 * self.viscosity * self._radius**3 * self.length / self.clearance**3
        film = leaks * short, (1.0 - leaks) * long
        return DamperStructure(self.clearance, *film, self.stiffness, float(self.cavitation))

    def forces(self, displacement: ArrayLike, velocity: ArrayLike) -> DamperForces:
        """Forces of the rotor on film and spring, with exact slopes.

        Parameters
        ----------
        displacement, velocity : array_like, shape (..., 2)
            Of the journal against its housing, along x and y [m], [m/s]. Where less than a hundredth of the
            clearance is left, beyond it too, the film is that of such a gap.
        """
        q, v = as_numbers("displacement", displacement), as_numbers("velocity", velocity)
        for name, values in (("displacement", q), ("velocity", v)):
            if values.shape[-1:] != (2,) or not np.isfinite(values).all():
                raise InputError(name, shown(values), "finite, of shape (..., 2)")
        try:
            q, v = np.broadcast_arrays(q, v)
        except ValueError:
            raise InputError("shape of velocity", v.shape, f"as that of displacement, {q.shape}") from None
        q, v, shape = np.ascontiguousarray(q), np.ascontiguousarray(v), q.shape[:-1]
        force, stiffness, damping = (np.empty((*shape, *size)) for size in ((2,), (2, 2), (2, 2)))
        arrays = (array.ctypes.data_as(ctypes.c_void_p) for array in (q, v, force, stiffness, damping))
        damper_library().damper_forces(byref(self.structure), c_size_t(q.size // 2), *arrays)
        return DamperForces(force, stiffness, damping)

    def eccentricity(self, displacement: ArrayLike) -> _Floats:
        """Eccentricity ratios at displacements of shape (..., 2) [m]: 1 in contact."""
        q = as_numbers("displacement", displacement)
        if q.shape[-1:] != (2,):
            raise InputError("shape of displacement", q.shape, "(..., 2)")
        return np.asarray(np.linalg.norm(q, axis=-1) / self.clearance)

    @takes(eccentricity=parts.SHARE, omega=parts.ANY)
    def circular_orbit(self, eccentricity: float, omega: float) -> tuple[float, float]:
        """Stiffness [N/m], spring included, and damping [N s/m] of a circular orbit about the middle.

        Along the displacement and against the velocity, forces over these, with the journal at `eccentricity`
        times the clearance and the orbit at `omega` [rad/s].
        """
        if not 0.0 < eccentricity < 1.0:
            raise InputError("eccentricity", eccentricity, "above 0 and below 1")
        e = eccentricity * self.clearance
        force = self.forces((e, 0.0), (0.0, e * omega)).force
        at_rest = self.forces((e, 0.0), (0.0, e)).force
        return float(force[0] / e), float(at_rest[1] / e)

    def linear(self, displacement: ArrayLike = (0.0, 0.0)) -> LinearBearing:
        """The damper for small vibrations about a journal at rest at a displacement, shape (2,) [m].

        The stiffness is that of the spring. Of a film that cavitates the damping is half that of the whole film:
        the first harmonic of its force for any small vibration, exactly; its mean and even harmonics, which lift
        the journal by a part of its amplitude, are left out.
        """
        found = self.forces(displacement, (0.0, 0.0))
        if not float(self.eccentricity(displacement)) < 1.0:
            allowed = f"within the clearance, {self.clearance:g} m"
            raise InputError("displacement", shown(displacement), allowed)
        return LinearBearing(found.stiffness, found.damping, name=self.name or "squeeze film damper")


class DamperSteps:
    """One damper over the steps of a run; `gain` leads from displacement to rate in a step."""

    def __init__(self, damper: SqueezeFilmDamper, gain: float, name: str) -> None:
        self._damper, self._gain, self._name = damper, gain, name

    def begin(self, omega: float) -> None:
        """Begin a step: the film has no memory, and its journal does not turn."""

    def at(self, r: _Floats, rate: _Floats) -> tuple[_Floats, _Floats]:
        """Forces at the end of the step, and their slopes, shape (2, 2)."""
        found = self._damper.forces(r, rate)
        return found.force, found.stiffness + self._gain * found.damping

    def expected(self, r: _Floats, rate: _Floats) -> _Floats:
        """Slopes to be expected there."""
        return self.at(r, rate)[1]

    def accept(self, r: _Floats, rate: _Floats) -> None:
        """Raise `ConvergenceError` where the step ends in contact."""
        ratio = float(self._damper.eccentricity(r))
        if ratio >= 1.0:
            raise ConvergenceError(f"the journal of {self._name} {CONTACT.format(ratio)}", None)

    def rewind(self) -> None:
        """Nothing: there is no state."""


@cache
def damper_library() -> ctypes.CDLL:
    """The C core, its structure of dampers compared with that here."""
    library = core.library()
    library.damper_forces.restype = None
    library.damper_support.restype = None
    library.damper_size.restype = c_size_t
    assert library.damper_size() == ctypes.sizeof(DamperStructure), "structures of dampers differ in C"
    return library
