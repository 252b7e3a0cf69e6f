"""Elastic deflection by the direct sum, O(N^2): the reference for the other engines."""

from __future__ import annotations

import numpy as np

from ehlcontact.process.threads import CALLING_THREAD
from ehlcontact.solver.deflection.coefficients import Array, influence_coefficients
from ehlcontact.solver.kernels import mlmi as kernels


class DirectSum:
    """The convolution term by term, images at Y < 0 included. Parameters as in `make_deflection`.

    One scratch row is kept: an instance serves one thread at a time.
    """

    def __init__(self, nx: int, ny: int, hx: float, hy: float, kappa: float) -> None:
        self.nx, self.ny = nx, ny
        self.kernel = influence_coefficients(nx + 1, 2 * ny + 1, hx, hy, kappa)
        self.team = CALLING_THREAD
        self._row = np.zeros(2 * nx + 1)

    def __call__(self, P: Array) -> Array:
        """Deflection of the pressure `P`, shape (ny + 1, nx + 1)."""
        W = np.empty((self.ny + 1, self.nx + 1))
        kernels.direct_sum(P, self.kernel, self._row, W)
        return W
