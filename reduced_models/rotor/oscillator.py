"""One mass on one element: m u'' + F(u, u') = load, eq. 7 of Nonato and Cavalca (2010)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import (
    as_column,
    is_single,
    parts,
    require_choice,
    require_finite,
    require_instance,
    require_positive,
)
from ehlcontact.checks.frequency import Frequency, by_name
from ehlcontact.checks.kinds import Callback
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.quantities import FORCE, LENGTH, RATE, TIME
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.status import Status
from ehlcontact.summary import quantity_text
from reduced_models.elements.base import ContactElement
from reduced_models.elements.validity import frequency_of

_Floats = NDArray[np.float64]

METHODS = ("Radau", "BDF", "LSODA", "DOP853", "RK45", "RK23")
_IMPLICIT = ("Radau", "BDF", "LSODA")  # of them, those that take a Jacobian

Load = float | ArrayLike | Callable[[float], float]


@dataclass(frozen=True, eq=False)
class OscillatorResult(QuantityTable):
    """Histories in the units of the element, dimensionless or SI.

    Attributes
    ----------
    T : ndarray, shape (N,)
        Times, in 2a/u_sum or s.
    approach, rate : ndarray, shape (N,)
        Over the dry approach or in m, and the derivative to T.
    force, load : ndarray, shape (N,)
        Of the contact, and applied; over the static load or in N.
    evaluations : int
        Of the equations of motion.
    status : Status
    units : {"dimensionless", "SI"}
        Of the element, and so of the histories.
    """

    T: Annotated[_Floats, TIME.over("T")]
    approach: Annotated[_Floats, LENGTH.over("T")]
    rate: Annotated[_Floats, RATE.over("T")]
    force: Annotated[_Floats, FORCE.over("T")]
    load: Annotated[_Floats, FORCE.over("T")]
    evaluations: int
    status: Status
    units: str = "dimensionless"

    DISPLAY: ClassVar[Display] = Display(rows="T", panels=("force load", "approach", "rate"))

    def _in_si(self) -> bool:
        return self.units == "SI"

    def _summary_lines(self) -> list[str]:
        return [
            f"{self.status}, {self.T.size} times up to {quantity_text(self.T[-1], self._unit('T'))}, "
            f"{self.evaluations} evaluations",
            f"approach {self._amount('approach')}, force {self._amount('force')}",
        ]


@takes(rtol=parts.TOLERANCE)
@by_name(2, omega_n="Omega_n (dimensionless), or mass [kg] with an element in SI")
def simulate_oscillator(
    element: ContactElement,
    T: ArrayLike,
    *,
    Omega_n: float | None = None,
    mass: float | None = None,
    load: Load = 1.0,
    u0: float,
    v0: float = 0.0,
    method: str = "Radau",
    rtol: float = 1e-9,
) -> OscillatorResult:
    """Integrate (1/Omega_n^2) u'' + F(u, u') = load(T); without inertia, F(u, u') = load(T).

    Parameters
    ----------
    element : ContactElement
        It warns, once, where the motion leaves its validity box. A film memory starts from rest at `u0`, in
        continuous time; the element's own state is not touched.
    T : array_like, shape (N,)
        Increasing times of the result, in s with an element in SI; the first is the start. No step is longer than
        the widest gap between them, so a load that T resolves is not stepped over.
    Omega_n : float, optional
        Of the mass on a dimensionless element (eq. 5).
    mass : float, optional
        In kg, on an element in SI. Neither leaves inertia out: the rate follows from F(u, u') = load, which needs
        a damper and a load > 0.
    load : float, array_like of shape (N,) or callable
        An array holds the load at T, with straight lines between.
    u0, v0 : float
        Approach and rate at the start; `v0` has no meaning without inertia.
    method : str
        Of ``scipy.integrate.solve_ivp``. Radau is the default because a light mass or a weak damper is stiff;
        RK23 (Bogacki and Shampine) is the integrator of the paper.
    rtol : float
        Relative tolerance; the absolute one is `rtol` of the scale of the motion.

    Raises
    ------
    InputError
        Times, load, tolerance or method that cannot be used; no inertia and no damper; Omega_n for an element in
        SI, or a mass for a dimensionless one.
    ConvergenceError
        The integration broke off; ``result`` holds the times it reached.
    """
    require_choice("method", method, METHODS)
    rtol = require_positive("rtol", rtol)
    require_instance("element", element, ContactElement, "a contact element")
    times = as_column("T", T, least=2, increasing=True)
    applied = _load(load, times)
    start = [require_finite("u0", u0)]
    size = max(abs(float(element.high)), abs(u0))
    atol = [rtol * size]
    square = _inverse_mass(element, Omega_n, mass)
    if square is not None:
        start.append(require_finite("v0", v0))
        # Rate of an oscillation as large as the motion, on the secant stiffness.
        speed = np.sqrt(square * abs(float(element.spring(size))) / size) * size
        atol.append(rtol * speed)
    rates, jacobian = _quasi_static(element, applied) if square is None else _inertial(element, applied, square)
    exact = element.state_count == 0 and method in _IMPLICIT
    solution = scipy.integrate.solve_ivp(
        rates,
        (times[0], times[-1]),
        start + [0.0] * element.state_count,
        method=method,
        t_eval=times,
        rtol=rtol,
        atol=atol + [rtol] * element.state_count,
        max_step=float(np.diff(times).max()),
        **({"jac": jacobian} if exact else {}),
    )
    ended = solution.success and bool(np.all(np.isfinite(solution.y)))
    status = Status.CONVERGED if ended else Status.FAILED
    result = _result(element, solution, rates, applied, square is not None, status)
    if not result.status.ok:
        reached = float(result.T[-1]) if result.T.size else float(times[0])
        raise ConvergenceError(f"oscillator broke off at T = {reached:g}: {solution.message}", result)
    w = frequency_of(result.approach, result.rate)
    frequency: Frequency = {"omega": w} if element.units == "SI" else {"Omega": w}
    element.warn_outside(result.approach, result.rate, force=result.force, **frequency)
    return result


def _inverse_mass(element: ContactElement, Omega_n: float | None, mass: float | None) -> float | None:
    """Omega_n^2 or 1/mass, None without inertia."""
    if element.units == "SI":
        if Omega_n is not None:
            raise InputError("Omega_n", Omega_n, "left out with an element in SI: give its mass [kg]")
        return None if mass is None else 1.0 / require_positive("mass", mass)
    if mass is not None:
        raise InputError("mass", mass, "left out with a dimensionless element: give Omega_n")
    return None if Omega_n is None else require_positive("Omega_n", Omega_n) ** 2


def _inertial(element: Any, applied: Callable[[float], float], square: float) -> tuple[Callable, Callable]:
    """Rates of approach, rate and states; the Jacobian is that of an element without states."""

    def rates(time: float, y: _Floats) -> _Floats:
        force, states = element.continuous(y[2:], float(y[0]), float(y[1]))
        return np.array([y[1], square * (applied(time) - force), *states])

    def jacobian(time: float, y: _Floats) -> list[list[float]]:
        u, v = float(y[0]), float(y[1])
        return [
            [0.0, 1.0],
            [-square * float(element.stiffness(u, v)), -square * float(element.damping(u, v))],
        ]

    return rates, jacobian


def _quasi_static(element: Any, applied: Callable[[float], float]) -> tuple[Callable, Callable]:
    """Rates of approach and states; the Jacobian is that of an element without states."""

    def rates(time: float, y: _Floats) -> _Floats:
        u, f = float(y[0]), applied(time)
        if f <= 0.0:
            raise InputError(f"load at T = {time:g}", f, "> 0 for a motion without inertia")
        v = element.rate_under(y[1:], u, f)
        return np.array([v, *element.continuous(y[1:], u, v)[1]])

    def jacobian(time: float, y: _Floats) -> list[list[float]]:
        u, v = float(y[0]), float(rates(time, y)[0])
        # On F(u, v) = load: dv/du = -F_u/F_v.
        return [[-element.stiffness(u, v) / element.damping(u, v)]]

    return rates, jacobian


def _load(load: Load, times: _Floats) -> Callable[[float], float]:
    if callable(load):
        Callback("T").take("load", load, False)
        return lambda time: require_finite(f"load at T = {time:g}", load(time))
    if is_single(load):
        constant = float(as_column("load", np.atleast_1d(load))[0])
        return lambda time: constant
    values = as_column("load", load, size=times.size)
    return lambda time: float(np.interp(time, times, values))


def _result(
    element: ContactElement,
    solution: Any,
    rates: Callable,
    applied: Callable[[float], float],
    inertia: bool,
    status: Status,
) -> OscillatorResult:
    T = np.asarray(solution.t, dtype=np.float64)
    y = np.asarray(solution.y, dtype=np.float64).reshape(-1, T.size) if T.size else np.empty((2, 0))
    load = np.array([applied(time) for time in T])
    rate = y[1] if inertia else np.array([rates(time, y[:, i])[0] for i, time in enumerate(T)])
    states = y[2 if inertia else 1 :].T
    force = np.array([element.continuous(*at)[0] for at in zip(states, y[0], rate, strict=True)])
    return OscillatorResult(T, y[0], rate, force, load, int(solution.nfev), status, element.units)
