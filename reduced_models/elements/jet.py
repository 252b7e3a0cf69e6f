"""Values with two partial derivatives, for kernels: by approach u and rate v at the end of a step.

Forward differentiation: every operation below applies the chain rule, so that a formula written once gives the
force and both of its tangents.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from ehlcontact.jit import jit_exact


class Jet(NamedTuple):
    """Value x with its partial derivatives."""

    x: float
    u: float
    v: float


@jit_exact
def plus(a, b):
    """Sum of two jets."""
    return Jet(a.x + b.x, a.u + b.u, a.v + b.v)


@jit_exact
def minus(a, b):
    """Difference of two jets."""
    return Jet(a.x - b.x, a.u - b.u, a.v - b.v)


@jit_exact
def half(c, a):
    """Mean of a number and a jet."""
    return Jet(0.5 * (c + a.x), 0.5 * a.u, 0.5 * a.v)


@jit_exact
def times(a, b):
    """Product of two jets."""
    return Jet(a.x * b.x, a.u * b.x + a.x * b.u, a.v * b.x + a.x * b.v)


@jit_exact
def over(a, b):
    """Quotient of two jets."""
    x = a.x / b.x
    return Jet(x, (a.u - x * b.u) / b.x, (a.v - x * b.v) / b.x)


@jit_exact
def root(a):
    """Square root of a jet > 0."""
    x = sqrt(a.x)
    return Jet(x, 0.5 * a.u / x, 0.5 * a.v / x)


@jit_exact
def through(x, by, a):
    """A value `x` that depends on one jet, with slope `by`."""
    return Jet(x, by * a.u, by * a.v)


@jit_exact
def through3(x, by_a, a, by_b, b, by_c, c):
    """A value `x` that depends on three jets, with its slope along each."""
    return Jet(x, by_a * a.u + by_b * b.u + by_c * c.u, by_a * a.v + by_b * b.v + by_c * c.v)
