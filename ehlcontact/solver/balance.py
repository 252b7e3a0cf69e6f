"""Equation for the mutual approach: load balance, given approach, or a Newmark step of the equation of motion."""

from __future__ import annotations

from typing import NamedTuple, Self


class Balance(NamedTuple):
    """``stiffness u + weight force = rhs``, for the approach u and the film force."""

    stiffness: float
    weight: float
    rhs: float

    @classmethod
    def of_load(cls, load: float = 1.0) -> Self:
        """The film carries `load` (eqs. 4 and 6)."""
        return cls(0.0, 1.0, load)

    @classmethod
    def of_approach(cls, u: float) -> Self:
        """The approach is `u`."""
        return cls(1.0, 0.0, u)

    @classmethod
    def newmark(cls, Omega_n: float, dT: float, load: float, predictor: float) -> Self:
        """One step of ``u''/Omega_n^2 + f = load`` (eq. 5) by Newmark's rule with beta = 1/4.

        There u = predictor + dT^2/4 u'' at the end of the step; `predictor` is what is known of u at its start.
        """
        stiffness = 4.0 / (Omega_n * dT) ** 2
        return cls(stiffness, 1.0, load + stiffness * predictor)

    def residual(self, u: float, force: float) -> float:
        """``rhs - stiffness u - weight force``."""
        return self.rhs - self.stiffness * u - self.weight * force

    def shifted(self, change: float) -> Self:
        """Return the same equation with `change` added to its right-hand side."""
        return self._replace(rhs=self.rhs + change)
