"""Every quantity of a run, or of a full contact, in SI: what their ``.si`` gives, where the point is one in SI."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import pi
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.results.layout import Layout
from ehlcontact.results.si import View, error_in_si, require_scales
from ehlcontact.solver.accuracy import ErrorEstimate

if TYPE_CHECKING:  # they import this module
    from ehlcontact.transient.full_contact import FullContact
    from ehlcontact.transient.result import SimulationResult

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SimulationSI(View):
    """A `SimulationResult` in SI; entry 0 is the initial state at t = 0.

    Attributes
    ----------
    t : ndarray, shape (steps + 1,)
        Times [s].
    approach, rate, acceleration : ndarray, shape (steps + 1,)
        Mutual approach [m], and its derivatives [m/s], [m/s^2].
    force, load : ndarray, shape (steps + 1,)
        Of the film, and applied [N].
    h_central, h_min : ndarray, shape (steps + 1,)
        Film in the centre, and the smallest [m].
    x, y : ndarray, shape (nx + 1,), (ny + 1,)
        Places along rolling and across, y >= 0 [m].
    h_midplane, p_midplane : ndarray, shape (steps + 1, nx + 1)
        Film [m] and pressure [Pa] along y = 0.
    snapshot_t : ndarray, shape (k,)
        Times of the whole fields kept [s].
    snapshot_h, snapshot_p : ndarray, shape (k, nx + 1, ny + 1)
        Film [m] and pressure [Pa].
    static_approach : float
        At rest under the static load [m].
    static_load : float
        That load [N].
    mass : float or None
        Of the bodies [kg]; None for a motion without inertia.
    omega, hz : float or None
        Frequency of the load [rad/s], [Hz], where it is harmonic.
    film_error : ErrorEstimate or None
        That of the result, its approach in m; films relative as there.
    """

    t: Array
    approach: Array
    rate: Array
    acceleration: Array
    force: Array
    load: Array
    h_central: Array
    h_min: Array
    x: Array
    y: Array
    h_midplane: Array
    p_midplane: Array
    snapshot_t: Array
    snapshot_h: Array
    snapshot_p: Array
    static_approach: float
    static_load: float
    mass: float | None
    omega: float | None
    hz: float | None
    film_error: ErrorEstimate | None

    LAYOUT: ClassVar[Layout] = Layout(
        rows="t",
        panels=("force load", "approach", "h_central h_min", "h_midplane"),
        quantities={
            "t": ("s", "t"),
            "approach": ("m", "t"),
            "rate": ("m/s", "t"),
            "acceleration": ("m/s2", "t"),
            "force": ("N", "t"),
            "load": ("N", "t"),
            "h_central": ("m", "t"),
            "h_min": ("m", "t"),
            "x": ("m", "x"),
            "y": ("m", "y"),
            "h_midplane": ("m", "t x"),
            "p_midplane": ("Pa", "t x"),
            "snapshot_t": ("s", "snapshot_t"),
            "snapshot_h": ("m", "snapshot_t x y"),
            "snapshot_p": ("Pa", "snapshot_t x y"),
            "static_approach": ("m", ""),
            "static_load": ("N", ""),
            "mass": ("kg", ""),
            "omega": ("rad/s", ""),
            "hz": ("Hz", ""),
        },
    )

    @classmethod
    def of(cls, result: SimulationResult) -> Self:
        """View of a result; raises `InputError` if its point is dimensionless."""
        s = require_scales(result.scales)
        Omega, Omega_n = (getattr(result.motion, name, None) for name in ("Omega", "Omega_n"))
        omega = None if Omega is None else Omega / s.time
        return cls(
            t=result.T * s.time,
            approach=result.approach * s.length,
            rate=result.rate * s.rate,
            acceleration=result.acceleration * (s.rate / s.time),
            force=result.force * s.force,
            load=result.load * s.force,
            h_central=result.h_central * s.length,
            h_min=result.h_min * s.length,
            x=result.X * s.a,
            y=result.Y * s.b,
            h_midplane=result.h_midplane * s.length,
            p_midplane=result.p_midplane * s.pressure,
            snapshot_t=result.snapshot_T * s.time,
            snapshot_h=result.snapshot_H * s.length,
            snapshot_p=result.snapshot_P * s.pressure,
            static_approach=result.static_approach * s.length,
            static_load=s.force,
            mass=None if Omega_n is None else s.stiffness * (s.time / Omega_n) ** 2,
            omega=omega,
            hz=None if omega is None else omega / (2.0 * pi),
            film_error=error_in_si(result.film_error, s),
        )

    def summary(self) -> dict[str, Any]:
        """Its histories, for JSON."""
        arrays = ("t", "approach", "rate", "force", "load", "h_central", "h_min")
        numbers = ("static_approach", "static_load", "mass", "omega", "hz")
        found = {name: getattr(self, name).tolist() for name in arrays}
        error = None if self.film_error is None else asdict(self.film_error)
        return found | {name: getattr(self, name) for name in numbers} | {"film_error": error}


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactSI:
    """A `FullContact` in SI, as it is at the moment.

    Attributes
    ----------
    force : float
        Of the film [N].
    static_approach : float
        At rest under the static load [m].
    h_central, h_min : float
        Film in the centre, and the smallest [m].
    """

    force: float
    static_approach: float
    h_central: float
    h_min: float

    @classmethod
    def of(cls, contact: FullContact) -> Self:
        """View of a contact; raises `InputError` if its point is dimensionless."""
        s = require_scales(contact.scales)
        return cls(
            force=contact.force * s.force,
            static_approach=contact.static_approach * s.length,
            h_central=contact.h_central * s.length,
            h_min=contact.h_min * s.length,
        )
