"""One mass on one reduced contact: eq. 7 of Nonato and Cavalca (2010) with the element as the force."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import solve_ivp

from ehlcontact import Status
from ehlcontact.checks import require_choice, require_finite, require_positive
from ehlcontact.errors import ConvergenceError, InputError
from reduced_models.elements.base import ContactElement
from reduced_models.elements.film_element import FilmContact
from reduced_models.elements.memoryless import MemorylessContact
from reduced_models.elements.validity import frequency_of

METHODS = ("Radau", "BDF", "LSODA", "DOP853", "RK45", "RK23")
_IMPLICIT = ("Radau", "BDF", "LSODA")

Load = float | ArrayLike | Callable[[float], float]


@dataclass(frozen=True, eq=False)
class OscillatorResult:
    """Histories at the times T, each of shape (N,), in the units of the element."""

    T: NDArray[np.float64]
    approach: NDArray[np.float64]
    rate: NDArray[np.float64]
    force: NDArray[np.float64]
    load: NDArray[np.float64]
    evaluations: int
    status: Status


def simulate_oscillator(
    element: ContactElement,
    T: ArrayLike,
    *,
    omega_n: float | None,
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
        It warns, once, where the motion leaves its validity box. With an element in SI, T is in s and
        ``omega_n = 1/sqrt(mass)``. A film memory starts from rest at `u0`, in continuous time; the element's own
        state is not touched.
    T : array_like, shape (N,)
        Increasing times of the result; the first is the start. No step is longer than the widest gap between
        them, so a load that T resolves is not stepped over.
    omega_n : float or None
        None leaves inertia out: the rate follows from F(u, u') = load, which needs a damper and a load > 0.
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
        Times, load, tolerance or method that cannot be used; no inertia and no damper.
    ConvergenceError
        The integration broke off; ``result`` holds the times it reached.
    """
    require_choice("method", method, METHODS)
    rtol = require_positive("rtol", rtol)
    times = _times(T)
    applied = _load(load, times)
    start = [require_finite("u0", u0)]
    size = max(abs(float(element.high)), abs(u0))
    atol = [rtol * size]
    square = None
    if omega_n is not None:
        square = require_positive("omega_n", omega_n) ** 2
        start.append(require_finite("v0", v0))
        # Rate of an oscillation as large as the motion, on the secant stiffness.
        speed = np.sqrt(square * abs(float(element.spring(size))) / size) * size
        atol.append(rtol * speed)
    options: dict[str, Any] = {}
    if isinstance(element, FilmContact):
        rates = _film(element, applied, square)
        start += [0.0] * element.state_count
        atol += [rtol] * element.state_count
    elif isinstance(element, MemorylessContact):
        if square is None:
            element.rate_at(start[0], 1.0)  # needs a damper
        rates, jacobian = (
            _quasi_static(element, applied) if square is None else _inertial(element, applied, square)
        )
        options = {"jac": jacobian} if method in _IMPLICIT else {}
    else:
        raise InputError("element", type(element).__name__, "a contact element")
    solution = solve_ivp(
        rates,
        (times[0], times[-1]),
        start,
        method=method,
        t_eval=times,
        rtol=rtol,
        atol=atol,
        max_step=float(np.diff(times).max()),
        **options,
    )
    ended = solution.success and bool(np.all(np.isfinite(solution.y)))
    status = Status.CONVERGED if ended else Status.FAILED
    result = _result(element, solution, rates, applied, omega_n is not None, status)
    if not result.status.ok:
        reached = float(result.T[-1]) if result.T.size else float(times[0])
        raise ConvergenceError(f"oscillator broke off at T = {reached:g}: {solution.message}", result)
    omega = frequency_of(result.approach, result.rate)
    element.warn_outside(result.approach, result.rate, omega, result.force)
    return result


def _film(element: FilmContact, applied: Callable[[float], float], square: float | None) -> Callable:
    """Approach, rate where there is inertia, and the states of the film."""

    def inertial(time: float, y: NDArray[np.float64]) -> NDArray[np.float64]:
        force, states = element.state_rates(y[2:], float(y[0]), float(y[1]))
        return np.array([y[1], square * (applied(time) - force), *states])  # type: ignore[operator]

    def quasi_static(time: float, y: NDArray[np.float64]) -> NDArray[np.float64]:
        v = element.rate_at(y[1:], float(y[0]), _pressing(applied, time))
        return np.array([v, *element.state_rates(y[1:], float(y[0]), v)[1]])

    return quasi_static if square is None else inertial


def _pressing(applied: Callable[[float], float], time: float) -> float:
    f = applied(time)
    if f <= 0.0:
        raise InputError(f"load at T = {time:g}", f, "> 0 for a motion without inertia")
    return f


def _inertial(
    element: MemorylessContact, applied: Callable[[float], float], square: float
) -> tuple[Callable, Callable]:
    def rates(time: float, y: NDArray[np.float64]) -> list[float]:
        u, v = float(y[0]), float(y[1])
        return [v, square * (applied(time) - float(element.force(u, v)))]

    def jacobian(time: float, y: NDArray[np.float64]) -> list[list[float]]:
        u, v = float(y[0]), float(y[1])
        return [
            [0.0, 1.0],
            [-square * float(element.stiffness(u, v)), -square * float(element.damping(u, v))],
        ]

    return rates, jacobian


def _quasi_static(element: MemorylessContact, applied: Callable[[float], float]) -> tuple[Callable, Callable]:
    def rates(time: float, y: NDArray[np.float64]) -> list[float]:
        return [element.rate_at(float(y[0]), _pressing(applied, time))]

    def jacobian(time: float, y: NDArray[np.float64]) -> list[list[float]]:
        u = float(y[0])
        v = rates(time, y)[0]
        # On F(u, v) = load: dv/du = -F_u/F_v.
        return [[-element.stiffness(u, v) / element.damping(u, v)]]

    return rates, jacobian


def _times(T: ArrayLike) -> NDArray[np.float64]:
    times = np.array(T, dtype=np.float64)
    if times.ndim != 1 or times.size < 2:
        raise InputError("shape of T", times.shape, "one-dimensional with at least 2 times")
    if not np.all(np.isfinite(times)) or np.any(np.diff(times) <= 0.0):
        raise InputError("T", "not finite or not increasing", "finite and strictly increasing")
    return times


def _load(load: Load, times: NDArray[np.float64]) -> Callable[[float], float]:
    if callable(load):
        return lambda time: require_finite(f"load at T = {time:g}", load(time))
    values = np.asarray(load, dtype=np.float64)
    if not np.all(np.isfinite(values)):
        raise InputError("load", "not finite", "finite")
    if values.ndim == 0:
        constant = float(values)
        return lambda time: constant
    if values.shape != times.shape:
        raise InputError("shape of load", values.shape, f"that of T, {times.shape}")
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
    if isinstance(element, MemorylessContact):
        force = np.asarray(element.force(y[0], rate), dtype=np.float64)
    elif isinstance(element, FilmContact):
        states = y[2 if inertia else 1 :].T
        force = np.array([element.state_rates(*at)[0] for at in zip(states, y[0], rate, strict=True)])
    return OscillatorResult(T, y[0], rate, force, load, int(solution.nfev), status)
