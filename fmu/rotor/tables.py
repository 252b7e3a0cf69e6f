"""Constants and C tables of the FMU of a rotor."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fmu.c_headers import c_double, c_table
from fmu.contact_variables import ALLOWED_ERROR
from fmu.lead import ROTOR
from fmu.rotor.dampers import THIN
from fmu.rotor.laws import Law, law_names, laws_of
from fmu.rotor.model import STEPS_PER_PERIOD, RotorModel
from fmu.rotor.parameters import SUMS, constant_load

if TYPE_CHECKING:
    from fmu.rotor.variables import _Variables

_Floats = NDArray[np.float64]

LEAST = 1e-6, "a millionth of its default"
METHOD = 11  # weights of a step there
SHAFT = 7  # numbers of the shaft in the state: enum SHAFT_... of rotor.h
ON_BALLS = 1.0, 1e-10  # N, and share of the load: what rest may leave of an imbalance, with ball bearings
EXACT = 0.0, 4e-15
EMPTY = '""'  # a C string


def rotor_macros(model: RotorModel, made: _Variables) -> dict[str, str]:
    """Macros of config.h."""
    laws = laws_of(model, made.specs)
    size, geometry = model.rotor.size, model.geometry
    points, motions = len(geometry.points), len(geometry.normals)
    sums = bool(model.parameters[0].parts)
    forces = len(made.rows)
    indicators = len(made.indicators)
    counts: dict[str, Any] = {
        "FREEDOMS": size,
        "POINTS": points,
        "MOTIONS": motions,
        "SUPPORTS": len(model.inside),
        "HELD": len(model.held),
        "SHOWN": motions + sum(len(station.mount.directions) for station in model.out),
        "FORCES": forces,
        "NODE_FORCES": len(model.points),
        "UNBALANCES": len(model.rotor.unbalances),
        "PARAMETERS": len(model.parameters),
        "TERMS": sum(len(one.parts) for one in model.parameters),
        "DRAGS": len(model.bearings_out) if model.inertia is not None else 0,
        "HAS_TORQUE": int(model.inertia is not None),
        "HAS_SUMS": int(sums),
        "HAS_GYROSCOPIC": int(model.rotor.gyroscopic.any()),
        "STARTS_AT_REST": int(model.start is None),
        "FOLLOWS_SHAFT": int(not model.bearings and not model.bearings_out),
        "REACHED": made.first["DRIVE"] if model.inertia is None else "(-1)",
        "WORK": _work(model, laws),
        "N_CACHE": _cache(model, laws, sums),
        "INDICATORS": indicators,
        "PLAIN": int(bool(model.bearings)),
        **{f"FIRST_{name}": at for name, at in made.first.items() if name != "FORCES"},
    }
    floor, rested = ON_BALLS if model.bearings else EXACT
    trace = _trace(model)
    periods = math.sqrt(trace) / model.fastest if trace > 0.0 else 1.0
    numbers = {
        "DEFAULT_TOLERANCE": ALLOWED_ERROR,
        "LEAST_INNER_STEP": LEAST[0] * model.inner_step,
        "DEFAULT_INNER_STEP": model.inner_step,
        "SHAFT_STEP": 2.0 * math.pi / STEPS_PER_PERIOD * periods,
        "FLOOR": floor,
        "RESTED": rested,
    }
    return (
        {k: str(v) for k, v in counts.items()}
        | {k: c_double(v) for k, v in numbers.items()}
        | {"LEAST_TEXT": f'"{LEAST[1]}"'}
        | dict(ROTOR.macros)
    )


def _trace(model: RotorModel) -> float:
    """Sum of the squares of all frequencies of the rotor without its supports."""
    M, _, K = model.rotor.matrices(0.0)
    return float(np.trace(np.linalg.solve(M, K)))


def _work(model: RotorModel, laws: list[Law]) -> int:
    """Numbers of `rotor_work`."""
    n = model.rotor.size + len(model.held)
    p, m = len(model.geometry.points), len(model.geometry.normals)
    own = sum(law.work for law in laws)
    return own + 3 * m + 2 * m * m + 6 * n + 8 * p + 2 * p * p + n * n + n


def _cache(model: RotorModel, laws: list[Law], sums: bool) -> int:
    """Numbers of the cache: enumerators of model_rotor.c, and `rotor_layout`."""
    n, p = model.rotor.size, len(model.geometry.points)
    shaft = SHAFT + 2 * len(model.rotor.unbalances)
    step = 2 + METHOD + n * n + n + p * n + p * p
    state = 4 * n + 4 * p + shaft + step + sum(law.size for law in laws)
    return (3 * n * n + n) * sums + n * n + n + 3 + n + state


def rotor_tables(model: RotorModel, made: _Variables) -> dict[str, str]:
    """Generated files: ``rotor_data.h``, ``rotor_inside.h`` and a C file for each law of a support."""
    names, texts = law_names(model, laws_of(model, made.specs))
    contacts = {f"{name}.c": text for name, text in texts.items() if name.startswith("contact")}
    others = [text for name, text in texts.items() if not name.startswith("contact")]
    return {
        "rotor_data.h": _data(model, made),
        "rotor_inside.h": _inside(model, made, names, others),
        **contacts,
    }


def _table(name: str, values: Any) -> str:
    """A C table, of one zero where there is nothing."""
    array = np.asarray(values, np.float64)
    return c_table(name, array if array.size else np.zeros((1,) * array.ndim))


def _integers(name: str, values: list[int]) -> str:
    return f"static const int {name}[] = {{{', '.join(map(str, values)) or '0'}}};"


def _data(model: RotorModel, made: _Variables) -> str:
    rotor, geometry = model.rotor, model.geometry
    M, C, K = rotor.matrices(0.0)
    sums = bool(model.parameters[0].parts)
    none = np.zeros((1, 1))
    stations = (*model.inside, *model.out)
    rows = np.concatenate([station.mount.rows(rotor.size) for station in stations])
    forces = made.rows
    at = [int(np.flatnonzero(row)[0]) if (row == 1.0).sum() == 1 == (row != 0.0).sum() else -1 for row in forces]
    unbalances = rotor.unbalances
    tables = {
        "mass_matrix": none if sums else M,
        "damping_matrix": none if sums else C,
        "stiffness_matrix": none if sums else K,
        "gyroscopic_matrix": rotor.gyroscopic if rotor.gyroscopic.any() else none,
        "constant_load": constant_load(rotor),
        "points": np.concatenate([geometry.points, model.held]),
        "ties": geometry.normals.ravel(),
        "shift": np.concatenate([np.zeros(0), *(station.shift for station in model.inside)]),
        "count": geometry.counts,
        "unbalance_phase": [u.phase for u in unbalances],
        "rotor_start": model.motion[0],
        "shown_rows": rows,
        "shown_shift": np.concatenate([station.shift for station in stations]),
        "force_rows": forces,
    }
    pairs = [-1 if place is None else place for u in unbalances for place in (u.x, u.y)]
    lines = [
        "/* Generated by ehlcontact: matrices, points at which supports act, motions shown, and the start. */",
        *(_table(*one) for one in tables.items()),
        _integers("unbalance_at", pairs),
        _integers("force_at", at),
        _integers("parameter_positive", [int(one.positive) for one in model.parameters]),
        _integers("parameter_signed", [int(one.signed) for one in model.parameters]),
        "static const char *const parameter_reason[] = {"
        + ", ".join(f'"{one.reason}"' for one in model.parameters)
        + "};",
        *_terms(model, made),
        "",
    ]
    return "\n".join(lines)


def _terms(model: RotorModel, made: _Variables) -> list[str]:
    """What each parameter is multiplied with, and where the sum stands in the cache."""
    size = model.rotor.size
    values: list[_Floats] = []
    first, sizes, places, references = [], [], [], []
    for k, parameter in enumerate(model.parameters):
        for name, part in parameter.parts.items():
            first.append(sum(map(len, values)))
            values.append(part.ravel())
            sizes.append(part.size)
            places.append(SUMS.index(name) * size * size)
            references.append(made.first["PARAMETER"] + k)
    if not values:
        return []
    return [
        _table("terms", np.concatenate(values)),
        _integers("term_first", first),
        _integers("term_size", sizes),
        _integers("term_place", places),
        _integers("term_parameter", references),
    ]


def _inside(model: RotorModel, made: _Variables, names: list[str], others: list[str]) -> str:
    """``rotor_inside.h``: the supports inside, where their motions, outputs and parameters stand."""
    widths = [len(station.mount.directions) for station in model.inside]
    outside = {
        "contact": ("",),
        "damper": (f": {THIN}",),
        "bearing": (": speed above the tables;", ": a ball carries more than the tables have;"),
    }
    rows = [[f'"{station.label}{text}"' for text in outside[station.kind]] for station in model.inside]
    texts = [f"{{{', '.join([*row, EMPTY][:2])}}}" for row in rows]
    settings = [f"{{{', '.join(map(str, row))}}}" for row in made.settings_at]
    flags = [2 if station.is_bearing else 1 for station in model.inside]
    first_flags = [
        at + 1 if station.is_bearing else at for station, at in zip(model.inside, made.outside_at, strict=True)
    ]
    return "\n".join(
        [
            "/* Generated by ehlcontact: the supports inside; where motions, outputs and parameters stand. */",
            *(['#include "bearing_support.h"'] if model.bearings else []),
            *(['#include "damper.h"'] if model.dampers else []),
            *(f"extern const Support {name};" for name in dict.fromkeys(names) if name.startswith("contact")),
            *others,
            f"static const Support *const inside[] = {{{', '.join(f'&{name}' for name in names) or 'NULL'}}};",
            _integers("inside_first", np.cumsum([0, *widths])[:-1].tolist() if widths else []),
            _integers("outputs_at", made.outputs_at),
            _integers("outside_at", made.outside_at),
            _integers("flags_at", first_flags),
            _integers("outside_flags", flags),
            f"static const int settings_at[][4] = {{{', '.join(settings) or '{-1, -1, -1, -1}'}}};",
            f"static const char *const outside_text[][2] = {{{', '.join(texts) or '{NULL, NULL}'}}};",
            "",
        ]
    )
