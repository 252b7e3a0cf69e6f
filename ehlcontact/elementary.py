"""Exponential and logarithm by polynomials, for floats and for `lanes`: those of libm take one number at a time.

Both without branches, correct to 2 units in the last place (`tests/ehlcontact/test_elementary.py`).
"""

import math

from ehlcontact.jit import jit_called_node
from ehlcontact.lanes import exponent, larger, mantissa, power_of_two, smaller, where_positive

LOG2_E = 1.4426950408889634
LN2_HIGH, LN2_LOW = 0.6931471803691238, 1.9082149292705877e-10  # ln 2; the first with zeros behind its 33rd bit
ROUNDING = 6755399441055744.0  # 1.5 2^52: numbers beside it have no fraction
LEAST, MOST = -708.0, 709.0  # arguments whose exponentials are normal numbers
ROOT_HALF = 1.4142135623730951


@jit_called_node
def exponential(x):
    """e^x; e^-708 = 3e-308 below -708, e^709 above 709."""
    x = smaller(MOST, larger(LEAST, x))  # in this order NaN stays
    whole = x * LOG2_E + ROUNDING
    k = whole - ROUNDING
    r = (x - k * LN2_HIGH) - k * LN2_LOW
    # Taylor's series: |r| < 0.3466, so the next term is below 1e-17
    s = r * (1.0 / 6227020800.0) + 1.0 / 479001600.0
    s = s * r + 1.0 / 39916800.0
    s = s * r + 1.0 / 3628800.0
    s = s * r + 1.0 / 362880.0
    s = s * r + 1.0 / 40320.0
    s = s * r + 1.0 / 5040.0
    s = s * r + 1.0 / 720.0
    s = s * r + 1.0 / 120.0
    s = s * r + 1.0 / 24.0
    s = s * r + 1.0 / 6.0
    s = s * r + 0.5
    s = s * r + 1.0
    return (s * r + 1.0) * power_of_two(whole)


@jit_called_node
def logarithm(x):
    """Natural logarithm of a normal number above 0."""
    m, e = mantissa(x), exponent(x) - 4503599627371519.0  # 2^52 + 1023
    above = m - ROOT_HALF
    m = where_positive(above, 0.5 * m, m)  # from 0.707 to 1.414
    e = where_positive(above, e + 1.0, e)
    f = m - 1.0
    s = f / (2.0 + f)
    q = s * s
    # 2 artanh(s): |s| < 0.1716, so the next term is below 1e-18
    t = q * (2.0 / 21.0) + 2.0 / 19.0
    t = t * q + 2.0 / 17.0
    t = t * q + 2.0 / 15.0
    t = t * q + 2.0 / 13.0
    t = t * q + 2.0 / 11.0
    t = t * q + 2.0 / 9.0
    t = t * q + 2.0 / 7.0
    t = t * q + 2.0 / 5.0
    t = t * q + 2.0 / 3.0
    return e * LN2_HIGH + (2.0 * s + (s * q * t + e * LN2_LOW))


if not hasattr(exponential, "py_func"):  # NUMBA_DISABLE_JIT: the functions above are for compiled kernels only
    exponential, logarithm = math.exp, math.log
