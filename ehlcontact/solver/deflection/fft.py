"""Elastic deflection by zero-padded fast Fourier transforms, O(N log N) and exact to rounding."""

from __future__ import annotations

from math import pi

import numpy as np
import scipy

from ehlcontact.process.threads import CALLING_THREAD, Team
from ehlcontact.solver.deflection.coefficients import Array, influence_coefficients

BLOCK = 2**15  # numbers transformed at a time
MATRICES_UP_TO = 64  # intervals along X, for `MatrixTransforms`; from about 100 on fast ones cost less


class FastFourier:
    """The convolution by zero-padded transforms, on small grids written out as matrix products.

    Parameters as in `make_deflection`. Periods 4 ny and 2 nx keep images out of the domain, because pressure
    vanishes on the border nodes.
    """

    def __init__(self, nx: int, ny: int, hx: float, hy: float, kappa: float) -> None:
        self.nx, self.ny = nx, ny
        self.kernel = influence_coefficients(nx + 1, 2 * ny + 1, hx, hy, kappa)
        transforms = MatrixTransforms if nx <= MATRICES_UP_TO else FastTransforms
        self._transforms: MatrixTransforms | FastTransforms = transforms(self.kernel)
        self.team = CALLING_THREAD

    def __call__(self, P: Array) -> Array:
        """Deflection of the pressure `P`, shape (ny + 1, nx + 1), zero on the outer border nodes."""
        return self._transforms(P, self.team)


class FastTransforms:
    """Convolution of even fields with `kernel`, shape (2 ny + 1, nx + 1), by fast transforms.

    Along Y the even, zero-padded sequence of period 4 ny needs a cosine transform of 2 ny + 1 numbers. As
    pressure fills only the first ny of them and deflection is wanted there only, its even frequencies are a
    cosine transform of ny + 1 numbers and its odd ones a shifted one of ny. A block of lines at a time is
    transformed, so that it stays in cache; threads take whole blocks, which are the same for any number of them.
    """

    def __init__(self, kernel: Array) -> None:
        self._ny, self._nx = kernel.shape[0] // 2, kernel.shape[1] - 1
        spectrum = scipy.fft.dctn(kernel, type=1) / (4 * self._ny)
        self._spectrum = np.concatenate([spectrum[::2], spectrum[1::2]])  # even frequencies first
        self._lines, self._columns = (_blocks(*of) for of in (kernel.shape, kernel.shape[::-1]))

    def __call__(self, P: Array, team: Team = CALLING_THREAD) -> Array:
        """As `FastFourier`."""
        rows = np.empty((2 * self._ny + 1, self._nx + 1))
        W = np.empty_like(P)
        team.run(self._across, len(self._columns), P, rows, least=1)
        team.run(self._along, len(self._lines), rows, least=1)
        team.run(self._back_across, len(self._columns), rows, W, least=1)
        return W

    def _across(self, first: int, last: int, P: Array, rows: Array) -> None:
        ny = self._ny
        for block in self._columns[first:last]:
            rows[: ny + 1, block] = scipy.fft.dct(P[:, block], 1, axis=0)
            rows[ny + 1 :, block] = scipy.fft.dct(P[:ny, block], 3, axis=0)

    def _along(self, first: int, last: int, rows: Array) -> None:
        nx = self._nx
        for block in self._lines[first:last]:
            spectrum = scipy.fft.rfft(rows[block], 2 * nx, axis=1)
            spectrum *= self._spectrum[block]
            rows[block] = scipy.fft.irfft(spectrum, 2 * nx, axis=1, overwrite_x=True)[:, : nx + 1]

    def _back_across(self, first: int, last: int, rows: Array, W: Array) -> None:
        ny = self._ny
        for block in self._columns[first:last]:
            W[:, block] = scipy.fft.dct(rows[: ny + 1, block], 1, axis=0)
            W[:ny, block] += scipy.fft.dct(rows[ny + 1 :, block], 2, axis=0)  # zero at j = ny


def _blocks(count: int, length: int) -> list[slice]:
    """All of `count` lines of `length` numbers, in blocks."""
    step = max(8, BLOCK // length // 8 * 8)  # whole lines of cache, where lines are columns
    return [slice(first, first + step) for first in range(0, count, step)]


class MatrixTransforms:
    """The same with transforms written out as matrices: on small grids the calls of fast ones cost more."""

    def __init__(self, kernel: Array) -> None:
        ny, nx = kernel.shape[0] // 2, kernel.shape[1] - 1
        spectrum = scipy.fft.dctn(kernel, type=1)
        phase = pi / (2 * ny) * np.outer(np.arange(2 * ny + 1), np.arange(ny + 1))
        share = np.where(np.arange(2 * ny + 1) % (2 * ny) == 0, 1.0, 2.0)  # of frequencies that stand for two
        self._across = np.cos(phase) * np.where(np.arange(ny + 1) == 0, 1.0, 2.0)
        self._back_across = np.ascontiguousarray((np.cos(phase) * share[:, None]).T) / (4 * ny)
        phase = pi / nx * np.outer(np.arange(nx + 1), np.arange(nx + 1))
        self._along = np.concatenate([np.cos(phase), np.sin(phase)], axis=1)
        share = np.where(np.arange(nx + 1) % nx == 0, 1.0, 2.0)
        self._back_along = np.ascontiguousarray(self._along.T) / (2 * nx)
        self._spectrum = np.concatenate([spectrum * share, spectrum * share], axis=1)

    def __call__(self, P: Array, team: Team = CALLING_THREAD) -> Array:
        """As `FastFourier`; as small as the grid is, nothing is shared with the `team`."""
        return self._back_across @ (((self._across @ P @ self._along) * self._spectrum) @ self._back_along)
