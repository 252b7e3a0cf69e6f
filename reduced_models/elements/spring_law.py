"""Law of the elements without memory, compiled: a spring beside a damper.

    F = (f(u) + d(u, u'))_+
    f = K1 u + K2 u^2 + K3 u^3 + K (u + u0)^n + F0    on [low, high]
    d = s(u) (C1 u' + C2 u'^2 + C3 u'^3 + B4 u u')

Outside [low, high] a fitted spring is meaningless (tension, negative stiffness), so it goes on as a dry Hertz
contact would: A (u - o)^(3/2), joined with equal value and slope. The damper fades out below `low` with the
spring, s from 1 to 0. Beyond the largest rate the powers of the rate, and outside [low, high] the mixed term,
level off with a continuous slope, so that far away only a viscous damper C1 + B4 u is left.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from ehlcontact.jit import jit_exact
from reduced_models.elements.validity import LARGEST

ADVICE = "(fit again over a wider range of approach, or with the linear model)"


# A law is an array of numbers, by the names of its entries: 0.2 us to hand to a kernel; a NamedTuple takes 1.4.
NAMES = (
    "low", "high", "K1", "K2", "K3", "K", "n", "u0", "F0", "C1", "C2", "C3", "B4",
    "rate",  # the largest, beyond which powers of the rate level off
    "o_low", "A_low", "o_high", "A_high",  # origins and factors of the ends, which `joined` adds
)  # fmt: skip
LOW, HIGH, K1, K2, K3, K, N, U0, F0, C1, C2, C3, B4, RATE, O_LOW, A_LOW, O_HIGH, A_HIGH = range(len(NAMES))


def spring_law(**coefficients: float) -> NDArray[np.float64]:
    """Law of these coefficients, shape (18,), its ends not joined: 0 for an absent term, no largest rate."""
    absent = dict.fromkeys(NAMES, 0.0) | {"rate": math.inf}
    return np.array([(absent | coefficients)[name] for name in NAMES])


@jit_exact
def inside(u, law):
    """Force and tangent of the spring between the ends."""
    force = u * (law[K1] + u * (law[K2] + u * law[K3]))
    slope = law[K1] + u * (2.0 * law[K2] + u * 3.0 * law[K3])
    if law[K] == 0.0:
        return force, slope
    reach = u + law[U0]
    power = law[K] * reach ** law[N]
    return force + power + law[F0], slope + law[N] * power / reach


@jit_exact
def hertz(reach, factor):
    """Force and tangent of ``factor reach^(3/2)``, zero at and below reach 0."""
    if reach <= 0.0:
        return 0.0, 0.0
    root = np.sqrt(reach)
    return factor * reach * root, 1.5 * factor * root


@jit_exact
def fade(u, low, o_low):
    """Share of the damper at approach `u` and its derivative: 1 from `low` upwards, 0 where the spring ends."""
    if u >= low:
        return 1.0, 0.0
    width = low - o_low
    s = (u - o_low) / width
    if s <= 0.0:
        return 0.0, 0.0
    return s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s) / width


@jit_exact
def saturate(x, low, high, reach):
    """`x` and slope 1 on [low, high]; beyond, it comes to rest within `reach` with a continuous slope."""
    if x > high:
        t = np.tanh((x - high) / reach)
        return high + reach * t, 1.0 - t * t
    if x < low:
        t = np.tanh((low - x) / reach)
        return low - reach * t, 1.0 - t * t
    return x, 1.0


@jit_exact
def spring(u, law):
    """Force and tangent of the spring at approach `u`."""
    if u > law[HIGH]:
        return hertz(u - law[O_HIGH], law[A_HIGH])
    if u < law[LOW]:
        return hertz(u - law[O_LOW], law[A_LOW])
    return inside(u, law)


@jit_exact
def damper(u, v, law):
    """Force of the damper and its derivatives with respect to `u` and `v`."""
    s, ds = fade(u, law[LOW], law[O_LOW])
    if s == 0.0:
        return 0.0, 0.0, 0.0
    if law[C2] == 0.0 and law[C3] == 0.0 and law[B4] == 0.0:  # most are; and 0 inf is no force, however fast
        return law[C1] * s * v, law[C1] * ds * v, law[C1] * s
    level, du = saturate(u, law[LOW], law[HIGH], 0.5 * (law[HIGH] - law[LOW]))
    w, dw = saturate(v, -law[RATE], law[RATE], law[RATE])
    c = law[C1] + law[B4] * level
    # Beyond the largest rate the powers follow their tangent there, along the levelled rate.
    edge = min(max(v, -law[RATE]), law[RATE])
    slope = 2.0 * law[C2] * edge + 3.0 * law[C3] * edge * edge
    powers = edge * edge * (law[C2] + law[C3] * edge) + slope * (w - edge)
    force = c * v + powers
    return s * force, ds * force + s * law[B4] * du * v, s * (c + slope * dw)


@jit_exact
def contact(u, v, law):
    """Force, dF/du and dF/dv at approach `u` and rate `v`; all zero where the force would pull."""
    f, k = spring(u, law)
    d, d_u, d_v = damper(u, v, law)
    force = f + d
    if force <= 0.0:
        return 0.0, 0.0, 0.0
    return force, k + d_u, d_v


@jit_exact
def fill_contact(u, v, law, out):
    """Write force, dF/du and dF/dv at every point, shape (3, n)."""
    for i in range(u.size):
        out[0, i], out[1, i], out[2, i] = contact(u[i], v[i], law)


@jit_exact
def fill_parts(u, law, out):
    """Write spring force and damping coefficient at zero rate, shape (2, n)."""
    for i in range(u.size):
        out[0, i] = spring(u[i], law)[0]
        out[1, i] = damper(u[i], 0.0, law)[2]


def joined(law: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the law with its ends, which continue the spring beyond low and high.

    Raises
    ------
    InputError
        A force or tangent that is not positive at an end, where no Hertz-like continuation exists, or one whose
        coefficients are beyond floating-point numbers.
    """
    ends: dict[str, float] = {}
    for name in ("low", "high"):
        u = float(law[NAMES.index(name)])
        force, slope = inside(u, law)
        if not force > 0.0:
            raise InputError(f"spring force at {name}", force, f"> 0 {ADVICE}")
        if not slope > 0.0:
            raise InputError(f"spring tangent at {name}", slope, f"> 0 {ADVICE}")
        reach = 1.5 * force / slope
        try:
            factor = force / reach**1.5
        except ArithmeticError:  # overflow, or a division by what has become zero
            factor = math.nan
        fits = force <= LARGEST and slope <= LARGEST and math.isfinite(u - reach)
        if not (fits and 0.0 < factor < math.inf):
            values = f"force {force:g}, tangent {slope:g}"
            raise InputError(f"spring at {name}", values, "smaller or larger (the units may be wrong)")
        ends |= {f"o_{name}": u - reach, f"A_{name}": factor}
    whole = law.copy()
    whole[O_LOW:] = list(ends.values())
    return whole


def require_rising(law: NDArray[np.float64]) -> None:
    """Raise `InputError` where a cubic that rises at both ends falls in between."""
    low, high, k2, k3 = law[[LOW, HIGH, K2, K3]].tolist()
    if k3 <= 0.0:  # the tangent is a line, or highest in the middle
        return
    lowest = -k2 / (3.0 * k3)  # where the tangent is lowest
    if low < lowest < high:
        slope = inside(lowest, law)[1]
        if not slope > 0.0:
            raise InputError(f"spring tangent at approach {lowest:.4g}", slope, f"> 0 {ADVICE}")


def require_dissipation(law: NDArray[np.float64]) -> None:
    """Raise `InputError` where a damper feeds energy into a cycle somewhere in the box or beyond it."""
    # Even powers of the rate cancel over a cycle; what remains is linear in u and in u'^2: look at corners.
    low, high, c1, c3, b4, rate = law[[LOW, HIGH, C1, C3, B4, RATE]].tolist()
    reach = 0.5 * (high - low)
    cubed = c3 * rate**2 if c3 != 0.0 else 0.0
    for u in (low - reach, high + reach):
        for more in (0.0, cubed):
            damping = c1 + b4 * u + more
            if not damping >= 0.0:
                raise InputError(
                    f"cycle damping C1 + B4 u + C3 rate^2 at u = {u:.4g}", damping, ">= 0 (fit the cubic model)"
                )
