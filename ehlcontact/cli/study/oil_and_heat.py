"""Bearings of a study with their layer of oil and with heat: results as a table and CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.study.loads import ring_load
from ehlcontact.cli.study.machine import carrier_of
from ehlcontact.cli.study.shared_entries import supply_and_heat, tilt_of
from ehlcontact.errors import ConvergenceError, InputError
from reduced_models.bearing.kinematics import RPM_TO_HZ
from reduced_models.bearing.oil_and_heat import oil_and_heat

if TYPE_CHECKING:
    from ehlcontact.cli.study.schema import Study
    from reduced_models.bearing.oil_and_heat import OilAndHeat

BAND, FREQUENCIES = (0.2, 50.0), 13  # over the frequency of the shaft: K and C of the figure
SAME_LOAD = 1e-6  # of the largest component: loads of equal bearings that share a result
NOT_OF_THE_BEARING = "name", "position_mm", "facing", "journal_mass"  # entries of a support


def run_oil_and_heat(study: Study) -> dict[str, OilAndHeat | str]:
    """The bearing or pair at each support with heat and with its layer, or why it is not computed; by the support.

    Empty where neither is asked for. Supports of one kind under one load share a result.
    """
    asked = study.operation
    supply, thermal = supply_and_heat(asked, "operation", study.lubricant)
    if supply is None and thermal is None:
        return {}
    speed = study.speed_rpm
    found: dict[str, OilAndHeat | str] = {}
    known: list[tuple[Any, Any, OilAndHeat | str]] = []  # kinds of support, loads and results
    for k, (name, one) in enumerate(zip(study.names, study.support, strict=True)):
        load, kind = ring_load(study, k), one.model_copy(update=dict.fromkeys(NOT_OF_THE_BEARING))
        near = SAME_LOAD * float(np.abs(load).max())
        for other, beside, result in known:
            if other == kind and beside.shape == load.shape and np.allclose(beside, load, rtol=0.0, atol=near):
                found[name] = result
        if name not in found:
            found[name] = _answer(study, k, load, speed, supply, thermal)
            known.append((kind, load, found[name]))
    return found


def _answer(study: Study, k: int, load: Any, speed: float, supply: Any, thermal: Any) -> OilAndHeat | str:
    """Of one support."""
    try:
        return oil_and_heat(
            carrier_of(study, k),
            load,
            speed_rpm=speed,
            supply=supply,
            thermal=thermal,
            tilt=tilt_of(study.operation),
            band=speed * RPM_TO_HZ * np.geomspace(*BAND, FREQUENCIES),
        )
    except (ConvergenceError, InputError) as error:
        return str(error)


def columns(found: OilAndHeat) -> tuple[list[str], list[list[str]]]:
    """Heads and rows of a table of text, a column for each condition, with error bars where there are any."""
    heads, rows = ["", *found.conditions], []
    for words, unit, values in found.rows:
        bars = found.bars.get(words, {})
        shown = [
            f"{numeral(value, 4)} ±{numeral(bars[key], 2)}" if key in bars else numeral(value, 4)
            for key, value in values.items()
        ]
        rows.append([f"{words}{f' [{unit}]' if unit else ''}", *shown])
    return heads, rows


def skf_words(found: OilAndHeat) -> str:
    """Torque by SKF's model in words; empty where there is none."""
    if found.skf is None:
        return ""
    rolling, sliding = found.skf
    parts = {"rolling": rolling, "sliding": sliding, "together": rolling + sliding}
    words = ", ".join(f"{name} {numeral(1e3 * one, 4)}" for name, one in parts.items())
    return f"SKF's model: {words} N mm, with its own factors of heat and supply"


def csv_text(results: Iterable[OilAndHeat]) -> str:
    """All rows as CSV, at every speed, with all digits; SKF's moments beside the computed ones."""
    results = list(results)
    names = list(dict.fromkeys(key for one in results for key in one.conditions))
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    barred = names if any(one.error_bars for one in results) else []
    writer.writerow(["speed_rpm", "quantity", "unit", *names, "SKF", *(f"{name}, error bar" for name in barred)])
    for one in results:
        skf = dict(zip(("rolling torque", "sliding torque"), one.skf or (), strict=False))
        for words, unit, values in one.rows:
            beside = skf.get(words)
            row = [values.get(name, "") for name in names] + ["" if beside is None else 1e3 * beside]
            bars = [one.bars.get(words, {}).get(name, "") for name in barred]
            writer.writerow([one.state.speed_rpm, words, unit, *row, *bars])
    return stream.getvalue()
