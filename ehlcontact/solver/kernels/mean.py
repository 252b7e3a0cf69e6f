"""Flow factor between two nodes, where it may change by orders of magnitude.

Along the inlet ln(eps) is nearly straight, so the value midway is the geometric mean; the arithmetic mean is
too large by cosh(x), with 2x the log ratio, and is what makes the classical scheme need fine grids. But with the
geometric mean the flow down a steep flank, P falling towards the outlet, stops answering to the upstream pressure
(x > 1), and relaxation there never settles. The mean used is ``g (1 + s^2/(2 + s))`` with the geometric mean g
and ``s = cosh(x) - 1``: geometric for neighbours that are alike (it differs by x^4/8), arithmetic for those far
apart, and a flow that always falls with the downstream pressure and rises with the upstream one.
"""

import math

from ehlcontact.jit import jit_node

TINY = 1e-290  # keeps 0/0 out where both flow factors underflow


@jit_node
def flow_mean(a, b):
    """Mean of two flow factors, and its skew: the derivatives to ln(a) and ln(b) are ``mean/2 +- skew``."""
    g = math.sqrt(a * b) + TINY
    s = 0.5 * (a + b) / g - 1.0
    share = 1.0 / (2.0 + s)
    return g * (1.0 + s * s * share), 0.25 * (a - b) * s * (4.0 + s) * share * share
