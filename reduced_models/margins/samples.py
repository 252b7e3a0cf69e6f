"""`sample_of`: what is kept of one machine: its numbers and critical speeds, or why it has none."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import isfinite, log
from typing import Any, NamedTuple

import numpy as np
import scipy

from ehlcontact.errors import ConvergenceError, InputError
from reduced_models.rotor.machine_numbers import QUANTITIES, damping_ratio
from reduced_models.rotor.machine_state import MachineState

OF_CRITICAL = "critical_rpm", "critical_damping"  # numbers of each critical speed


class Sample(NamedTuple):
    """One machine, ready for JSON.

    Attributes
    ----------
    values : list of float
        Of the inputs.
    numbers : dict
        Of the machine by name; None where it has none.
    critical : list of [speed, damping ratio, whirl]
        Critical speeds [rev/min] that an unbalance excites, rising.
    failure : str
        What could not be answered, and why; empty where all was.
    beyond : str
        What of it is beyond the data, in words; empty where nothing is.
    """

    values: list[float]
    numbers: dict[str, float | None]
    critical: list[list[float]]
    failure: str = ""
    beyond: str = ""


def sample_of(values: Sequence[float], answer: Callable[[], Any]) -> Sample:
    """The sample of a machine: `answer` gives its `MachineState`, its numbers by name, or why there is neither.

    An `InputError` or a `ConvergenceError` of it is a failure of this sample.
    """
    inputs = [float(value) for value in values]
    try:
        found = answer()
        if isinstance(found, str):
            return Sample(inputs, {}, [], found)
        if isinstance(found, MachineState):
            numbers, critical, failure = found.numbers, critical_of(found), "; ".join(found.failed)
            states = (state for support in found.supports for _, state in support.bearings)
            beyond = "; ".join(state.reservation for state in states if state.reservation)
        else:
            numbers, critical, failure, beyond = dict(require_numbers(found)), [], "", ""
    except (ConvergenceError, InputError) as error:
        return Sample(inputs, {}, [], str(error))
    return Sample(inputs, {name: _finite(value) for name, value in numbers.items()}, critical, failure, beyond)


def require_numbers(found: Any) -> Mapping[str, float | None]:
    """Numbers by name; raises `TypeError` for anything else that a function gives."""
    plain = isinstance(found, Mapping) and all(
        isinstance(name, str) and (value is None or isinstance(value, int | float | np.number))
        for name, value in found.items()
    )
    if not plain:
        raise TypeError(f"build gave a {type(found).__name__}: a MachineState is expected, or numbers by name")
    return {name: None if value is None else float(value) for name, value in found.items()}


def _finite(value: float | None) -> float | None:
    return None if value is None or not isfinite(value) else float(value)


def critical_of(machine: MachineState) -> list[list[float]]:
    """Critical speeds that an unbalance excites: speed [rev/min], damping ratio, whirl."""
    excited = (one for one in machine.critical_speeds if machine.is_excited(one))
    return [[one.speed_rpm, damping_ratio(one), one.whirl] for one in excited]


def matched(
    samples: Sequence[Sample], nominal: Sample
) -> tuple[list[dict[str, float | None]], dict[str, float | None]]:
    """Numbers of all samples and of the nominal machine, critical speeds among them by the modes that they are of.

    The machine with the most critical speeds gives their number, the nominal one where it has as many. Those of
    the others are assigned to its own, so that ratios of speeds and differences of whirl together are smallest.
    """
    reference = max([nominal, *samples], key=lambda one: len(one.critical)).critical

    def numbers(one: Sample) -> dict[str, float | None]:
        if not reference:
            return dict(one.numbers)
        found = {name: value for name, value in one.numbers.items() if name not in OF_CRITICAL}
        cost = [
            [abs(log(own[0] / other[0])) + abs(own[2] - other[2]) for own in one.critical] for other in reference
        ]
        places: dict[int, int] = {}
        if one.critical:
            rows, columns = scipy.optimize.linear_sum_assignment(cost)
            places = dict(zip(rows.tolist(), columns.tolist(), strict=True))
        for k in range(len(reference)):
            speed, damping, _ = one.critical[places[k]] if k in places else (None, None, None)
            found |= dict(zip(critical_names(k), (speed, damping), strict=True))
        return found

    return [numbers(one) for one in samples], numbers(nominal)


def critical_names(k: int) -> tuple[str, ...]:
    """Names of the numbers of a critical speed, by its place among them."""
    return tuple(f"{name}_{k + 1}" if k else name for name in OF_CRITICAL)


def words_of(name: str) -> tuple[str, str]:
    """A number in words, and its unit; the name itself of what a user's function gives."""
    base, _, number = name.rpartition("_")
    if name not in QUANTITIES and base in OF_CRITICAL and number.isdigit():
        own = QUANTITIES[base]
        return f"{own.words} {number}", own.unit
    return QUANTITIES[name] if name in QUANTITIES else (name.replace("_", " "), "")
