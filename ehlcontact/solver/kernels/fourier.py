"""Convolution of half domains by fast Fourier transforms, of sixteen real lines at once.

A work array holds complex numbers as lines of sixteen: the real parts of eight transforms, then the imaginary
ones. Eight of sixteen real lines are the real parts of complex ones, the other eight their imaginary parts.

Sequences are zero-padded to c times their n numbers, c = 2 along X and 4 along Y. That needs no transform of c n
numbers: frequencies ``c q + m`` are the transform of n numbers, of the sequence times ``w^(m j)`` with
w = exp(-2 pi i/(c n)). Stockham's stages of radix 4 and of primes sort by themselves (Van Loan, Computational
Frameworks for the Fast Fourier Transform, 1992, sect. 1.7).
"""

from typing import Any, NamedTuple

import numpy as np

from ehlcontact.jit import inner, jit, jit_loop, jit_node, plain
from ehlcontact.lanes import LANES, at, eight, put, put_transposed
from ehlcontact.solver.kernels.relax import aligned

PAIR = 2 * LANES  # real lines side by side
# First columns of real parts, forwards and backwards; with a type: kernels are compiled for each plain constant.
FORWARDS, BACKWARDS = np.int64(0), np.int64(LANES)
START, FORTH = np.int64(0), np.int64(1)


class Plan(NamedTuple):
    """Transforms of n numbers, zero-padded to c n."""

    n: int
    padding: int  # c
    radices: Any  # whose product is n
    turns: Any  # (c n, 2): cosine and sine of -2 pi k/(c n)


def new_plan(n: int, padding: int) -> Plan:
    """Return the plan of transforms of n numbers zero-padded to `padding` n."""
    angle = 2.0 * np.pi / (padding * n) * np.arange(padding * n)
    return Plan(n, padding, radices(n), np.stack([np.cos(angle), -np.sin(angle)], axis=1))


def radices(n: int) -> np.ndarray:
    """Factors of n: fours first, then primes."""
    found = []
    for factor in (4, *range(2, n + 1)):
        while n % factor == 0:
            found.append(factor)
            n //= factor
    return np.array(found, np.int64)


def order(n: int) -> np.ndarray:
    """Frequencies as `across_lines` writes them, as numbers 0 to 2 n of the cosine transform."""
    found = np.concatenate([4 * np.arange(plain(frequencies)(m, n)) + m for m in (0, 2, 1)])
    return np.where(found <= 2 * n, found, 4 * n - found)


@jit_node
def frequencies(m, n):
    """Number of frequencies 4 q + m that are kept: opposite ones are equal."""
    return n if m == 1 else (n + 2 - m // 2) // 2


@jit_node
def turn(turns, k):
    """Cosine and sine of w^k."""
    return at(turns, k, 0), at(turns, k, 1)


@jit_node
def turned(a, b, by):
    """The complex number a + i b, turned; or eight."""
    c, s = by
    return a * c - b * s, a * s + b * c


@jit_node
def complex_at(z, j, re):
    """Line j of the work array."""
    return at(z, j, eight(re)), at(z, j, eight(LANES - re))


@jit_node
def put_complex(z, j, re, number):
    """Line j of the work array from real and imaginary part."""
    put(z, j, eight(re), number[0])
    put(z, j, eight(LANES - re), number[1])


@jit_loop(inline="always")  # one caller: what it calls is optimised one time less
def four(z, source, target, part, s, turns, step, re):
    """One stage of radix 4, from line `source` on to line `target` on: Stockham's, which sorts by itself."""
    for p in range(part):
        k = p * s * step
        first, second, third = turn(turns, k), turn(turns, 2 * k), turn(turns, 3 * k)
        for q in range(s):
            j = source + q + s * p
            ar, ai = complex_at(z, j, re)
            br, bi = complex_at(z, j + s * part, re)
            cr, ci = complex_at(z, j + 2 * s * part, re)
            dr, di = complex_at(z, j + 3 * s * part, re)
            er, ei, fr, fi = ar + cr, ai + ci, ar - cr, ai - ci
            gr, gi, hr, hi = br + dr, bi + di, br - dr, bi - di
            j = target + q + 4 * s * p
            put_complex(z, j, re, (er + gr, ei + gi))
            put_complex(z, j + s, re, turned(fr + hi, fi - hr, first))
            put_complex(z, j + 2 * s, re, turned(er - gr, ei - gi, second))
            put_complex(z, j + 3 * s, re, turned(fr - hi, fi + hr, third))


@jit_loop(inline="always")  # likewise
def other(z, source, target, radix, part, s, turns, step, re):
    """One stage of any radix, term by term."""
    for p in range(part):
        for k in range(radix):
            by = turn(turns, k * p * s * step)
            for q in range(s):
                j = source + q + s * p
                a, b = complex_at(z, j, re)
                for m in range(1, radix):
                    c, d = complex_at(z, j + m * s * part, re)
                    c, d = turned(c, d, turn(turns, k * m % radix * part * s * step))
                    a, b = a + c, b + d
                put_complex(z, target + q + s * (radix * p + k), re, turned(a, b, by))


@inner
@jit_loop
def transform(z, begin, plan, re):
    """Transform the n lines from `begin` on, 0 or n, by way of the n others; returns where the result begins.

    With `re` 0 forwards; with 8, real and imaginary parts exchanged, backwards, without a factor.
    """
    s, rest = 1, plan.n
    for radix in plan.radices:
        rest //= radix
        target = plan.n - begin
        if radix == 4:
            four(z, begin, target, rest, s, plan.turns, plan.padding, re)
        else:
            other(z, begin, target, radix, rest, s, plan.turns, plan.padding, re)
        s *= radix
        begin = target
    return begin


@jit
def along_lines(first, last, rows, spectrum, plan):
    """Convolve sixteen lines of `rows` at a time along themselves; written in place, blocks `first` to `last` - 1.

    Two lines are one complex one with transform Z. With the transforms A and B of their kernels, real and even,
    the product is ``(A + B)/2 Z(k) + (A - B)/2 conj(Z(-k))``; line ``block (n + 1) + k`` of `spectrum` holds both
    factors.
    """
    n, lines = plan.n, np.int64(PAIR)
    z = aligned(3 * n + 1, lines)
    for block in range(first, last):
        for m in range(2):
            take_lines(z, rows, PAIR * block, m, plan)
            begin = transform(z, START, plan, FORWARDS)
            multiply(z, begin, spectrum, block * (n + 1), m, n)
            begin = transform(z, begin, plan, BACKWARDS)
            add_turned(z, begin, m, FORTH, plan)
        give_lines(z, rows, PAIR * block, n)


@jit_loop(inline="always")  # likewise
def take_lines(z, rows, line, m, plan):
    """Sixteen lines of `rows` times w^(m j) to the first n of the work array; number n is added to number 0."""
    for k in range(0, plan.n, LANES):
        j = min(k, plan.n - LANES)
        put_transposed(z, j, 0, rows, line, j)
        put_transposed(z, j, LANES, rows, line + LANES, j)
    for k in range(PAIR):
        put(z, 0, k, at(z, 0, k) + (1.0 - 2.0 * m) * at(rows, line + k, plan.n))  # w^(m n)
    if m > 0:
        for j in range(plan.n):
            a, b = complex_at(z, j, FORWARDS)
            put_complex(z, j, FORWARDS, turned(a, b, turn(plan.turns, m * j)))


@jit_loop(inline="always")  # likewise
def multiply(z, begin, spectrum, start, m, n):
    """Multiply frequencies 2 q + m, and those opposite, by the spectrum of the kernel."""
    for q in range((n - m) // 2 + 1):
        own, opposite = begin + q, begin + (n - q - m) % n
        same, crossed = complex_at(spectrum, start + 2 * q + m, FORWARDS)
        a, b = complex_at(z, own, FORWARDS)
        c, d = complex_at(z, opposite, FORWARDS)
        put_complex(z, own, FORWARDS, (same * a + crossed * c, same * b - crossed * d))
        put_complex(z, opposite, FORWARDS, (same * c + crossed * a, same * d - crossed * b))


@inner
@jit_loop
def add_turned(z, begin, m, way, plan):
    """Add the n lines from `begin` on, times w^(-m j), to the last n + 1; written where m is 0.

    Backwards, which is `way` -1 instead of 1, add them times w^(m j) from the last to the first.
    """
    n = plan.n
    for j in range(n + 1):
        a, b = complex_at(z, begin + (n + way * j) % n, FORWARDS)
        c, s = turn(plan.turns, m * j)
        a, b = turned(a, b, (c, -way * s))
        if m > 0:
            before, other = complex_at(z, 2 * n + j, FORWARDS)
            a, b = a + before, b + other
        put_complex(z, 2 * n + j, FORWARDS, (a, b))


@jit_loop(inline="always")  # likewise
def give_lines(z, rows, line, n):
    """Sixteen lines of `rows` from the last n + 1 of the work array."""
    for k in range(0, n + 1, LANES):
        j = min(k, n + 1 - LANES)
        put_transposed(rows, line, j, z, 2 * n + j, 0)
        put_transposed(rows, line + LANES, j, z, 2 * n + j, LANES)


@jit_node
def blocks_to(last, columns):
    """Blocks of columns up to `last`, and behind the last whole one what is left.

    That block begins inside the one before, whose columns are the other parts of complex numbers then and round
    otherwise: one thread does both, in this order.
    """
    return last + 1 if PAIR * last < columns < PAIR * (last + 1) else last


@jit
def across_lines(first, last, P, rows, plan):
    """Cosine transform of `P`, even about line 0 and zero from line n on, to the 2 n + 1 frequencies in `rows`.

    Their order is ``4 q``, ``4 q + 2``, ``4 q + 1``; frequency ``4 q + 3`` is ``-4 q - 3``. Sixteen columns at a
    time, whole blocks `first` to `last` - 1.
    """
    n, lines = plan.n, np.int64(PAIR)
    z = aligned(2 * n, lines)
    for block in range(first, blocks_to(last, P.shape[1])):
        column = min(PAIR * block, P.shape[1] - PAIR)
        row = 0
        for m in (0, 2, 1):
            fold_columns(z, P, column, m, plan)
            begin = transform(z, START, plan, FORWARDS)
            for q in range(frequencies(m, n)):
                put(rows, row, eight(column), at(z, begin + q, eight(0)))
                put(rows, row, eight(column + LANES), at(z, begin + q, eight(LANES)))
                row += 1


@jit_loop(inline="always")  # likewise
def fold_columns(z, P, column, m, plan):
    """Times w^(m j), columns and what their images bring: ``P_j + i^m P_(n - j)``."""
    n = plan.n
    put(z, 0, eight(0), at(P, 0, eight(column)))
    put(z, 0, eight(LANES), at(P, 0, eight(column + LANES)))
    for j in range(1, n):
        a, b = at(P, j, eight(column)), at(P, j, eight(column + LANES))
        c, d = at(P, n - j, eight(column)), at(P, n - j, eight(column + LANES))
        if m == 0:
            a, b = a + c, b + d
        elif m == 1:
            a, b = a - d, b + c
        else:
            a, b = a - c, b - d
        put_complex(z, j, FORWARDS, turned(a, b, turn(plan.turns, m * j)))


@jit
def back_across_lines(first, last, rows, W, plan):
    """The inverse of `across_lines`, times 4 n, on lines 0 to n; `W` written."""
    n, lines = plan.n, np.int64(PAIR)
    z = aligned(3 * n + 1, lines)
    for block in range(first, blocks_to(last, W.shape[1])):
        column = min(PAIR * block, W.shape[1] - PAIR)
        row = 0
        for m in (0, 2, 1):
            kept = frequencies(m, n)
            for q in range(kept):
                a, b = at(rows, row, eight(column)), at(rows, row, eight(column + LANES))
                put_complex(z, q, FORWARDS, (a, b))
                if m != 1:  # the opposite one
                    put_complex(z, (n - q - m // 2) % n, FORWARDS, (a, b))
                row += 1
            begin = transform(z, START, plan, BACKWARDS)
            add_turned(z, begin, m, FORTH, plan)
            if m == 1:  # the opposite ones
                add_turned(z, begin, m, -FORTH, plan)
        for j in range(n + 1):
            put(W, j, eight(column), at(z, 2 * n + j, eight(0)))
            put(W, j, eight(column + LANES), at(z, 2 * n + j, eight(LANES)))
