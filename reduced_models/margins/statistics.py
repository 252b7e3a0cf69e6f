"""Intervals from samples, and rank correlations, each with its own statistical error.

Errors are those of N independent samples, which quasi-random ones of a few inputs do not exceed.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

_Floats = NDArray[np.float64]

SHARE = 0.95  # of all machines in an interval
SURE = 0.95  # confidence of statements about intervals
LEAST = 8  # samples that have a number, below which it has no interval


class Interval(NamedTuple):
    """Interval that contains a share of all machines, from the samples that have the number.

    Attributes
    ----------
    low, median, high : float
    low_ends, high_ends : (float or None, float or None)
        Between which the true ends lie with 95 % confidence, by order statistics; None where no sample is as far
        out.
    contains : (float, float)
        Share of all machines in the interval, with 95 % confidence.
    share : float
        Of all machines that it contains on average: .95, less where samples are few.
    known : int
        Samples that have the number.
    """

    low: float
    median: float
    high: float
    low_ends: tuple[float | None, float | None]
    high_ends: tuple[float | None, float | None]
    contains: tuple[float, float]
    share: float
    known: int


def interval_of(values: _Floats, share: float = SHARE) -> Interval | None:
    """Interval of the finite ones of values, shape (n,); None of fewer than `LEAST`.

    Its ends are order statistics of rank r and n + 1 - r, r = (1 - share)/2 (n + 1): on average it contains the
    share. Where r is below 1 it is from the smallest to the largest sample, and contains less. What it contains
    has a beta distribution of n + 1 - 2 r and 2 r (Wilks 1941); ranks of the ends are binomial.
    """
    x = np.sort(values[np.isfinite(values)])
    if x.size < LEAST:
        return None
    tail, n = 0.5 * (1.0 - share), int(x.size)
    low, median, high = (float(one) for one in np.quantile(x, (tail, 0.5, 1.0 - tail), method="weibull"))
    r = max(tail * (n + 1), 1.0)
    unsure = 0.5 * (1.0 - SURE)
    contains = scipy.stats.beta.ppf((unsure, 1.0 - unsure), n + 1 - 2.0 * r, 2.0 * r)

    def ends(part: float) -> tuple[float | None, float | None]:
        first, last = (int(rank) for rank in scipy.stats.binom.ppf((unsure, 1.0 - unsure), n, part))
        return (float(x[first - 1]) if first else None, float(x[last]) if last < n else None)

    both = float(contains[0]), float(contains[1])
    return Interval(low, median, high, ends(tail), ends(1.0 - tail), both, 1.0 - 2.0 * r / (n + 1), n)


class Influence(NamedTuple):
    """How inputs move a number.

    Attributes
    ----------
    correlation, error : ndarray, shape (inputs,)
        Rank correlation (Spearman) with each input, and its standard error.
    explained : float
        Share of the variance of the ranks of the number that those of the inputs explain together by a linear
        regression. Well below 1 an input moves it both ways, or inputs act together: its scatter shows it.
    """

    correlation: _Floats
    error: _Floats
    explained: float


def influence_of(inputs: _Floats, values: _Floats) -> Influence | None:
    """Influence of inputs, shape (n, d), on the finite ones of values, shape (n,).

    The standard error is (1 - r^2) sqrt((1 + r^2/2)/(n - 3)), by Fisher's z with the variance of Bonett and Wright
    (2000); strong correlations are surer than that. None where fewer than `LEAST` have a value, or all the same.
    """
    known = np.isfinite(values)
    x, y = inputs[known], values[known]
    n = y.size
    if n < LEAST or np.ptp(y) == 0.0:
        return None
    ranks = np.column_stack([_ranks(column) for column in (*x.T, y)])
    X, Y = ranks[:, :-1], ranks[:, -1]
    r = np.clip(X.T @ Y, -1.0, 1.0)
    error = (1.0 - r * r) * np.sqrt((1.0 + 0.5 * r * r) / (n - 3))
    rest = Y - X @ np.linalg.lstsq(X, Y, rcond=None)[0]
    return Influence(r, error, float(1.0 - rest @ rest))


def _ranks(column: _Floats) -> _Floats:
    """Ranks about their mean, of length 1; 0 of a column without a range."""
    ranks = scipy.stats.rankdata(column)
    ranks -= ranks.mean()
    length = sqrt(float(ranks @ ranks))
    return np.asarray(ranks / length if length else ranks)
