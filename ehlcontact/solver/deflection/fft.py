"""Elastic deflection by zero-padded fast Fourier transforms, O(N log N) and exact to rounding."""

from __future__ import annotations

import numpy as np
import scipy

from ehlcontact.lanes import LANES
from ehlcontact.process.threads import CALLING_THREAD
from ehlcontact.solver.deflection.coefficients import Array, influence_coefficients
from ehlcontact.solver.kernels import fourier


class FastFourier:
    """The convolution by fast transforms (`kernels.fourier`).

    Parameters as in `make_deflection`. Periods 4 ny and 2 nx keep images out of the domain, because pressure
    vanishes on the border nodes. Along Y the even sequence has 2 ny + 1 frequencies; along X each of them is
    transformed, multiplied and transformed back at once. Threads take blocks of sixteen lines, which are the same
    for any number of them. A grid with fewer columns than that is widened.
    """

    def __init__(self, nx: int, ny: int, hx: float, hy: float, kappa: float) -> None:
        self.nx, self.ny = nx, ny
        self._width = max(nx, fourier.PAIR - 1)
        kernel = influence_coefficients(self._width + 1, 2 * ny + 1, hx, hy, kappa)
        self.kernel = kernel[:, : nx + 1]
        self._along, self._across = fourier.new_plan(self._width, 2), fourier.new_plan(ny, 4)
        self._columns, self._lines = (self._width + 1) // fourier.PAIR, -(-len(kernel) // fourier.PAIR)
        self._rows = np.zeros((self._lines * fourier.PAIR, self._width + 1))
        self._spectrum = self._factors(kernel)
        self.team = CALLING_THREAD

    def _factors(self, kernel: Array) -> Array:
        """Factors of the transforms of pairs of lines, as `fourier.along_lines` takes them."""
        spectrum = scipy.fft.dctn(kernel, type=1)
        spectrum *= 0.5 / (8 * self._width * self.ny)
        lines = np.zeros_like(self._rows)
        np.take(spectrum, fourier.order(self.ny), axis=0, out=lines[: len(spectrum)], mode="clip")
        one, two = np.swapaxes(lines.reshape(self._lines, 2, LANES, -1), 0, 1)
        factors = np.empty((self._lines, self._width + 1, 2, LANES))
        np.add(one, two, out=np.swapaxes(factors[:, :, 0], 1, 2))
        np.subtract(one, two, out=np.swapaxes(factors[:, :, 1], 1, 2))
        return factors.reshape(-1, fourier.PAIR)

    def __call__(self, P: Array) -> Array:
        """Deflection of the pressure `P`, shape (ny + 1, nx + 1), zero on the outer border nodes."""
        if self._width > self.nx:
            P = np.pad(P, ((0, 0), (0, self._width - self.nx)))
        P = np.require(P, requirements=("C", "W"))  # one type for the kernels
        W, rows, run = np.empty(P.shape), self._rows, self.team.run
        rows[2 * self.ny + 1 :] = 0.0  # lines that only fill a block: else they keep rounding of the last call
        run(fourier.across_lines, self._columns, P, rows, self._across, least=1)
        run(fourier.along_lines, self._lines, rows, self._spectrum, self._along, least=1)
        run(fourier.back_across_lines, self._columns, rows, W, self._across, least=1)
        return W if self._width == self.nx else W[:, : self.nx + 1].copy()
