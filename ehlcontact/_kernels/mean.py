"""Flow factor between two nodes, where it may change by orders of magnitude.

Along the inlet ln(eps) is nearly straight, so the value midway is the geometric mean; the arithmetic mean is
too large by cosh(x), with 2x the log ratio, and is what makes the classical scheme need fine grids. But with the
geometric mean the flow down a steep flank, P falling towards the outlet, stops answering to the upstream pressure
(x > 1), and relaxation there never settles. The mean used is ``g (1 + s^2/(2 + s))`` with the geometric mean g
and ``s = cosh(x) - 1``: geometric for neighbours that are alike (it differs by x^4/8), arithmetic for those far
apart, and a flow that always falls with the downstream pressure and rises with the upstream one.
"""

import math

from ehlcontact._kernels.jit import jit

TINY = 1e-290  # keeps 0/0 out where both flow factors underflow


@jit
def flow_mean(a, b):
    """Mean of two flow factors."""
    g = math.sqrt(a * b) + TINY
    s = 0.5 * (a + b) / g - 1.0
    return g * (1.0 + s * s / (2.0 + s))


@jit
def flow_mean_slopes(a, b):
    """Derivatives of `flow_mean` to ln(a) and ln(b)."""
    g = math.sqrt(a * b) + TINY
    s = 0.5 * (a + b) / g - 1.0
    even = 0.5 * g * (1.0 + s * s / (2.0 + s))
    odd = 0.25 * (a - b) * s * (4.0 + s) / ((2.0 + s) * (2.0 + s))
    return even + odd, even - odd
