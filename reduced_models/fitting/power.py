"""Variable projection for the power law: K, F0 and C are linear, only n and u0 are searched for."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, least_squares, minimize_scalar

from reduced_models.fitting.least_squares import linear_fit

_Floats = NDArray[np.float64]
EXPONENTS = (1.0, 8.0)  # bounds of n; at 1 the power law is a line and u0 and F0 say the same
STARTS = (1.25, 1.5, 2.0, 3.0)
CLOSEST = 0.995  # largest share of the reach u + u0 that the record may come down by
HERTZ = 1.5
FLAT = 1.01  # rms, relative to the best, that counts as fitting as well


def fit_power_law(u: _Floats, v: _Floats, f: _Floats) -> tuple[dict[str, float], _Floats, _Floats, float]:
    """Fit f = K (u + u0)^n + F0 + C u', all of shape (N,).

    Golub and Pereyra's variable projection: for every (n, u0) the best K, F0 and C follow from linear least
    squares, so that the search has two unknowns. Instead of u0 it uses q = spread/(centre + u0), the curvature
    that the record sees.

    A small vibration shows value, slope and curvature of the spring and hardly more, so that there is a long flat
    valley in n. Of the exponents that fit as well (to 1 % of the rms) the one nearest to Hertz's 3/2 is taken.

    Returns
    -------
    parameters : dict
        K, n, u0, F0, C.
    fitted : array, shape (N,)
    covariance : array, shape (5, 5)
        From the Jacobian at the solution, as if the residuals were independent.
    condition : float
        Of the column-scaled Jacobian.

    Raises
    ------
    InputError
        No more samples than parameters, or a record that varies too little; it names the columns.
    """
    # Refuses what no power law could tell apart: a record without curvature or without rate.
    linear_fit({"1": np.ones_like(u), "approach": u, "approach^2": u**2, "rate": v}, f)
    centre, spread = float(np.mean(u)), float(np.std(u))
    w = (u - centre) / spread
    highest = CLOSEST / -float(w.min())

    def columns(x: _Floats) -> _Floats:
        n, q = x
        return np.column_stack([((1.0 + q * w) ** n - 1.0) / (n * q), np.ones_like(w), v / np.abs(v).max()])

    def residuals(x: _Floats) -> _Floats:
        A = columns(x)
        return A @ np.linalg.lstsq(A, f, rcond=None)[0] - f

    curvatures = (1e-4 * highest, highest)
    bounds = tuple(zip(EXPONENTS, curvatures, strict=True))
    start = min(0.5 * highest, spread / abs(centre)) if centre != 0.0 else 0.5 * highest
    tries = [
        least_squares(residuals, (n, start), bounds=bounds, x_scale=(1.0, highest), xtol=1e-12, ftol=1e-14)
        for n in STARTS
    ]
    best = min(tries, key=lambda tried: tried.cost)

    def best_curvature(n: float) -> tuple[float, float]:
        """Curvature that goes with the exponent, and the rms error."""

        def rms(q: float) -> float:
            return float(np.sqrt(np.mean(residuals(np.array([n, q])) ** 2)))

        found = minimize_scalar(rms, bounds=curvatures, method="bounded", options={"xatol": 1e-10 * highest})
        return float(found.x), float(found.fun)

    n, q = (float(value) for value in best.x)
    allowed = FLAT * float(np.sqrt(2.0 * best.cost / f.size))

    def excess(exponent: float) -> float:
        return best_curvature(exponent)[1] - allowed

    if excess(HERTZ) <= 0.0:
        n, q = HERTZ, best_curvature(HERTZ)[0]
    elif excess(n) < 0.0:
        n = float(brentq(excess, HERTZ, n, xtol=1e-6))
        q = best_curvature(n)[0]
    a, b, c = np.linalg.lstsq(columns(np.array([n, q])), f, rcond=None)[0]
    u0 = spread / q - centre
    K = float(a) / (n * q) * (q / spread) ** n
    parameters = {
        "K": K,
        "n": n,
        "u0": u0,
        "F0": float(b) - float(a) / (n * q),
        "C": float(c) / float(np.abs(v).max()),
    }
    reach = u + u0
    part = reach**n
    fitted = K * part + parameters["F0"] + parameters["C"] * v
    jacobian = {
        "dF/dK": part,
        "dF/dn": K * part * np.log(reach),
        "dF/du0": K * n * part / reach,
        "dF/dF0": np.ones_like(u),
        "dF/dC": v,
    }
    # At the solution the Gauss-Newton step is zero; its matrix holds the covariance and the condition.
    step = linear_fit(jacobian, f - fitted)
    return parameters, fitted, step.covariance, step.condition
