"""`spread`: an input of a machine as a range or a distribution; quasi-random draws of several inputs.

Draws are points of a Sobol sequence, scrambled with a seed (Owen 1995, Joe and Kuo 2008, as in `scipy.stats.qmc`):
of the first N points every input is spread evenly, and further points leave the first as they are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import ceil, isfinite, log2
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks.inputs import shown
from ehlcontact.errors import InputError

_Floats = NDArray[np.float64]

KINDS = {
    "uniform": ("low", "high"),
    "normal": ("mean", "standard deviation"),
    "triangular": ("low", "mode", "high"),
}
WITHIN = "within"  # ends at which a normal distribution is cut
MOST_SHOWN = 4  # numbers of a list in a message
LAST = 2.0**-31  # below which no draw of a share is, nor above 1 less this: half a step of the sequence
TAILS = 0.025, 0.975  # quantiles between which any distribution must have a length
ANY = (
    "a range [low, high], normal = [mean, standard deviation], also within = [low, high],"
    " or triangular = [low, mode, high]"
)


def spread(
    *,
    uniform: Sequence[float] | None = None,
    normal: Sequence[float] | None = None,
    triangular: Sequence[float] | None = None,
    within: Sequence[float] | None = None,
) -> Any:
    """An input that is not known exactly, as a frozen distribution of `scipy.stats`.

    Parameters
    ----------
    uniform : (float, float), optional
        Lowest and highest value, all between them equally likely; a pair of numbers stands for it.
    normal : (float, float), optional
        Mean and standard deviation.
    triangular : (float, float, float), optional
        Lowest, most likely and highest value.
    within : (float, float), optional
        Ends at which a normal distribution is cut.

    Raises
    ------
    InputError
        None of them or several; a low end that is not below the high one; a standard deviation of 0 or less; a
        mode beyond the ends.
    """
    kinds = {"uniform": uniform, "normal": normal, "triangular": triangular}
    given = {name: value for name, value in kinds.items() if value is not None}
    return spread_of("spread", {**given, **({} if within is None else {WITHIN: within})})


def spread_of(field: str, value: Any) -> Any:
    """The distribution of what an input is given as: a pair of numbers, a mapping for `spread`, or one of scipy.

    Raises
    ------
    InputError
        As `spread`, by the name of the input.
    """
    from scipy import stats

    if hasattr(value, "ppf"):
        low, high = (float(np.asarray(value.ppf(tail))) for tail in TAILS)
        if not (isfinite(low) and isfinite(high) and low < high):
            allowed = "a distribution with a length: its numbers are none of one, as a standard deviation below 0"
            raise InputError(field, shown(value), allowed)
        return value
    if not isinstance(value, Mapping):
        value = {"uniform": value}
    kinds = [name for name in KINDS if name in value]
    if len(kinds) != 1 or set(value) - {*KINDS, WITHIN}:
        raise InputError(field, _brief(value), ANY)
    (kind,) = kinds
    numbers = _numbers(field, value[kind], KINDS[kind])
    if WITHIN in value and kind != "normal":
        raise InputError(f"{field}.{WITHIN}", _brief(value[WITHIN]), f"left out beside {kind}, which has ends")
    if kind == "normal":
        mean, deviation = numbers
        if deviation <= 0.0:
            raise InputError(field, deviation, "a standard deviation above 0")
        if WITHIN not in value:
            return stats.norm(mean, deviation)
        low, high = _numbers(f"{field}.{WITHIN}", value[WITHIN], KINDS["uniform"])
        _require_rising(f"{field}.{WITHIN}", low, high)
        return stats.truncnorm((low - mean) / deviation, (high - mean) / deviation, mean, deviation)
    low, high = numbers[0], numbers[-1]
    _require_rising(field, low, high)
    if kind == "uniform":
        return stats.uniform(low, high - low)
    mode = numbers[1]
    if not low <= mode <= high:
        raise InputError(field, mode, f"a mode between its ends, {low:g} and {high:g}")
    return stats.triang((mode - low) / (high - low), low, high - low)


def _numbers(field: str, value: Any, names: Sequence[str]) -> list[float]:
    """Finite numbers, one for each name."""
    if not isinstance(value, Sequence) or isinstance(value, str) or len(value) != len(names):
        raise InputError(field, _brief(value), ANY if len(names) == len(KINDS["uniform"]) else ", ".join(names))
    for one in value:
        if isinstance(one, bool) or not isinstance(one, int | float | np.number) or not isfinite(one):
            raise InputError(field, shown(one), f"finite numbers: {', '.join(names)}")
    return [float(one) for one in value]


def _brief(value: Any) -> Any:
    """A value for a message: short lists and mappings as they are."""
    return value if isinstance(value, list | tuple | dict) and len(value) <= MOST_SHOWN else shown(value)


def _require_rising(field: str, low: float, high: float) -> None:
    if not low < high:
        raise InputError(field, [low, high], "a low end below the high one")


def draws(spreads: Sequence[Any], count: int, seed: int) -> _Floats:
    """Values of inputs, shape (count, inputs): the first points of a scrambled Sobol sequence."""
    from scipy.stats import qmc  # of all that is imported here it takes longest

    points = qmc.Sobol(len(spreads), seed=seed).random_base2(ceil(log2(max(count, 1))))[:count]
    shares = np.clip(points, LAST, 1.0 - LAST)
    return np.column_stack([np.asarray(one.ppf(shares[:, k]), float) for k, one in enumerate(spreads)])
