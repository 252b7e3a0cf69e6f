"""Variable projection for the power law: K, F0 and C1 are linear unknowns, n and u0 are searched."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from reduced_models.fitting.least_squares import linear_fit

_Floats = NDArray[np.float64]

EXPONENTS = (1.0, 8.0)  # bounds of n; at 1 the power law is a line and u0 and F0 say the same
EXPONENT_STARTS = (1.25, 1.5, 2.0, 3.0)  # the best of the minima found from them is taken
HERTZ_EXPONENT = 1.5  # of the dry contact, to which n tends where the record leaves it open
AS_GOOD = 1.01  # rms, relative to the best, that counts as fitting as well
LARGEST_DIP = 0.995  # share of the reach u + u0 that the record may come down by, or the law would end inside it
SMALLEST_CURVATURE = 1e-4  # share of the largest one, below which the law is a line


def fit_power_law(u: _Floats, v: _Floats, f: _Floats) -> tuple[dict[str, float], _Floats, _Floats, float]:
    """Fit f = K (u + u0)^n + F0 + C1 u', all of shape (N,).

    Golub and Pereyra's variable projection: for every (n, u0) the best K, F0 and C1 follow from linear least
    squares, so that the search has two unknowns. Instead of u0 it uses q = spread/(centre + u0), the curvature
    that the record sees.

    A small vibration shows value, slope and curvature of the spring and hardly more, so that there is a long flat
    valley in n. Of the exponents that fit as well (to 1 % of the rms) the one nearest to Hertz's 3/2 is taken.

    Returns
    -------
    parameters : dict
        K, n, u0, F0, C1.
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
    # Raises InputError for a record without curvature or rate, which leaves the parameters open.
    linear_fit({"1": np.ones_like(u), "approach": u, "approach^2": u**2, "rate": v}, f)
    record = _Projected.of(u, v, f)
    best, rms = record.search()
    parameters = record.parameters(*record.nearest_to_hertz(best, AS_GOOD * rms))
    K, n, u0 = (parameters[name] for name in ("K", "n", "u0"))
    reach = u + u0
    part = reach**n
    fitted = K * part + parameters["F0"] + parameters["C1"] * v
    jacobian = {
        "dF/dK": part,
        "dF/dn": K * part * np.log(reach),
        "dF/du0": K * n * part / reach,
        "dF/dF0": np.ones_like(u),
        "dF/dC1": v,
    }
    # At the solution the Gauss-Newton step is zero; its matrix holds the covariance and the condition.
    step = linear_fit(jacobian, f - fitted)
    return parameters, fitted, step.covariance, step.condition


@dataclass(frozen=True, eq=False)
class _Projected:
    """Residuals of a record as a function of n and q, with K, F0 and C1 projected out."""

    w: _Floats  # approach from its centre, in its spread
    v: _Floats  # rate over the fastest
    f: _Floats
    centre: float
    spread: float
    fastest: float

    @classmethod
    def of(cls, u: _Floats, v: _Floats, f: _Floats) -> _Projected:
        centre, spread, fastest = float(np.mean(u)), float(np.std(u)), float(np.abs(v).max())
        return cls((u - centre) / spread, v / fastest, f, centre, spread, fastest)

    @property
    def curvatures(self) -> tuple[float, float]:
        """Bounds of q."""
        highest = LARGEST_DIP / -float(self.w.min())
        return SMALLEST_CURVATURE * highest, highest

    def columns(self, x: _Floats) -> _Floats:
        """Columns of K, F0 and C1, up to factors, at (n, q)."""
        n, q = x
        return np.column_stack([((1.0 + q * self.w) ** n - 1.0) / (n * q), np.ones_like(self.w), self.v])

    def residuals(self, x: _Floats) -> _Floats:
        """Of the best coefficients at (n, q)."""
        A = self.columns(x)
        return np.asarray(A @ np.linalg.lstsq(A, self.f, rcond=None)[0] - self.f)

    def search(self) -> tuple[_Floats, float]:
        """Best (n, q) and its rms error."""
        lowest, highest = self.curvatures
        start = min(0.5 * highest, self.spread / abs(self.centre)) if self.centre != 0.0 else 0.5 * highest
        tries = [
            scipy.optimize.least_squares(
                self.residuals,
                (n, start),
                bounds=tuple(zip(EXPONENTS, (lowest, highest), strict=True)),
                x_scale=(1.0, highest),
                xtol=1e-12,
                ftol=1e-14,
            )
            for n in EXPONENT_STARTS
        ]
        best = min(tries, key=lambda tried: tried.cost)
        return best.x, float(np.sqrt(2.0 * best.cost / self.f.size))

    def best_curvature(self, n: float) -> tuple[float, float]:
        """Curvature that goes with the exponent, and the rms error."""
        lowest, highest = self.curvatures

        def rms(q: float) -> float:
            return float(np.sqrt(np.mean(self.residuals(np.array([n, q])) ** 2)))

        options = {"xatol": 1e-10 * highest}
        minimum = scipy.optimize.minimize_scalar(rms, bounds=(lowest, highest), method="bounded", options=options)
        return float(minimum.x), float(minimum.fun)

    def nearest_to_hertz(self, best: _Floats, allowed: float) -> tuple[float, float]:
        """(n, q) nearest to Hertz's exponent whose rms error is at most `allowed`."""

        def excess(exponent: float) -> float:
            return self.best_curvature(exponent)[1] - allowed

        n, q = (float(value) for value in best)
        if excess(HERTZ_EXPONENT) <= 0.0:
            return HERTZ_EXPONENT, self.best_curvature(HERTZ_EXPONENT)[0]
        if excess(n) < 0.0:
            n = float(scipy.optimize.brentq(excess, HERTZ_EXPONENT, n, xtol=1e-6))
            return n, self.best_curvature(n)[0]
        return n, q

    def parameters(self, n: float, q: float) -> dict[str, float]:
        """K, n, u0, F0 and C1 in the units of the record."""
        a, b, c = np.linalg.lstsq(self.columns(np.array([n, q])), self.f, rcond=None)[0]
        return {
            "K": float(a) / (n * q) * (q / self.spread) ** n,
            "n": n,
            "u0": self.spread / q - self.centre,
            "F0": float(b) - float(a) / (n * q),
            "C1": float(c) / self.fastest,
        }
