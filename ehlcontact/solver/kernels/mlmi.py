"""Convolution on half domains: the direct sum, and one coarsening of multilevel multi-integration.

A coarsening acts along the rows of its arrays (axis 0); along X they are held transposed. Row ``origin + i``
of the lifted pressure `P` holds fine node i. Brandt and Lubrecht (1990); Venner and Lubrecht (2000), ch. 5.
"""

from typing import NamedTuple

import numpy as np

from ehlcontact.jit import jit

# Sixth-order interpolation half way between nodes at distances 1, 3, 5: exact for polynomials of degree 5.
W1, W3, W5 = 150.0 / 256.0, -25.0 / 256.0, 3.0 / 256.0


class Coarsening(NamedTuple):
    """Arrays and numbers of one coarsening; rows along the coarsened direction."""

    P: np.ndarray  # fine pressure with margins; `lift` puts the coarse pressure on its even rows
    D: np.ndarray  # correction kernel, by lag
    width: np.ndarray  # lags of each row of D within the neighbourhood
    coarse: np.ndarray  # deflection of the coarse pressure
    W: np.ndarray  # deflection at the fine nodes
    line: np.ndarray  # scratch
    origin: int  # row of fine node 0 in P
    margin: int  # first column of P that is a node
    first: int  # fine node on row 0 of W, even
    first_coarse: int  # coarse node on row 0 of coarse
    along_y: bool  # rows along Y: even about row `origin`; else even about column `margin`


@jit
def direct_sum(P, K, row, W):
    """Convolution of `P`, even about its line 0, with the influence coefficients `K`; `W` and `row` written."""
    n = P.shape[1] - 1
    for j in range(W.shape[0]):
        line = W[j]
        line[:] = 0.0
        for jp in range(P.shape[0]):
            for lag in range(n + 1):
                k = K[abs(j - jp), lag]
                if jp > 0:
                    k += K[j + jp, lag]
                row[n + lag] = k
                row[n - lag] = k
            for ip in range(n + 1):
                p, shifted = P[jp, ip], row[n - ip : 2 * n + 1 - ip]
                for i in range(n + 1):
                    line[i] += p * shifted[i]


@jit
def mirror(P, origin, margin, along_y):
    """Fill the margin of `P` that lies beyond the symmetry line."""
    if along_y:
        for i in range(1, origin + 1):
            P[origin - i] = P[origin + i]
    else:
        for i in range(P.shape[0]):
            for s in range(1, margin + 1):
                P[i, margin - s] = P[i, margin + s]


@jit
def add_halfway(a, b, d, e, f, g, out):
    """Add to `out` the value half way between rows a, b at distance 1, d, e at 3 and f, g at 5."""
    for s in range(out.size):
        out[s] += W1 * (a[s] + b[s]) + W3 * (d[s] + e[s]) + W5 * (f[s] + g[s])


@jit
def lift(c):
    """Replace the even rows of ``c.P`` by the coarse pressure, the transpose of interpolation; margins filled."""
    mirror(c.P, c.origin, c.margin, c.along_y)
    P, last = c.P, c.first + c.W.shape[0] - 1
    for J in range(c.first_coarse, c.first_coarse + c.coarse.shape[0]):
        r = c.origin + 2 * J
        if not c.first <= 2 * J <= last:  # beyond the fine nodes: from the previous call
            P[r] = 0.0
        add_halfway(P[r - 1], P[r + 1], P[r - 3], P[r + 3], P[r - 5], P[r + 5], P[r])
    if c.along_y:
        mirror(P, c.origin, c.margin, True)


@jit
def integrate(c):
    """Deflection of the fine pressure from that of the coarse one: ``c.W`` written.

    Even rows are taken over, odd rows interpolated; both are corrected by D where the kernel is not smooth.
    """
    for r in range(c.W.shape[0]):
        i = c.first + r
        if i % 2 == 0:
            c.W[r] = c.coarse[coarse_row(c, i)]
            correct(c, r, 1, 2)
        else:
            a, b = c.coarse[coarse_row(c, i - 1)], c.coarse[coarse_row(c, i + 1)]
            d, e = c.coarse[coarse_row(c, i - 3)], c.coarse[coarse_row(c, i + 3)]
            f, g = c.coarse[coarse_row(c, i - 5)], c.coarse[coarse_row(c, i + 5)]
            c.W[r] = 0.0
            add_halfway(a, b, d, e, f, g, c.W[r])
            correct(c, r, 0, 1)


@jit
def coarse_row(c, i):
    """Row of ``c.coarse`` for the even fine node i."""
    return abs(i // 2) if c.along_y else i // 2 - c.first_coarse


@jit
def correct(c, r, first, step):
    """Add to row r of ``c.W`` the correction D * P over the row lags `first`, `first` + `step`, ...

    Inner loops run over slices from 0: indices that might be negative would keep them from vectorising.
    """
    W, line, m = c.W[r], c.line, c.margin
    n = W.size
    centre = c.origin + c.first + r
    for k in range(first, c.D.shape[0], step):
        if k == 0:
            here = c.P[centre]
            for s in range(line.size):  # not line[:] = ...: it takes seconds to compile
                line[s] = here[s]
        else:
            before, after = c.P[centre - k], c.P[centre + k]
            for s in range(line.size):
                line[s] = before[s] + after[s]
        d = c.D[k, 0]
        here = line[m : m + n]
        for s in range(n):
            W[s] += d * here[s]
        for lag in range(1, c.width[k], 2):  # two lags at a time: fewer passes over W
            d, e = c.D[k, lag], c.D[k, lag + 1]
            left, right = line[m - lag : m - lag + n], line[m + lag : m + lag + n]
            left2, right2 = line[m - lag - 1 : m - lag - 1 + n], line[m + lag + 1 : m + lag + 1 + n]
            for s in range(n):
                W[s] += d * (left[s] + right[s]) + e * (left2[s] + right2[s])
