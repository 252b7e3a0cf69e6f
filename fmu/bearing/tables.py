"""A bearing as C text: grooves, races, films over load, losses, speeds.

A race in Python has 128 cubics between two nodes of its static curve. Here one polynomial stands for them: within
2e-13 of g a micrometre deep and beyond, and within 1e-9, as the cubics, where the surfaces part.
Where it is not within 1e-9, as where a layer of oil runs dry, there are more nodes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import log

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from fmu.bearing.model import BearingModel
from fmu.bearing.places import counted_from
from fmu.c_headers import c_double, c_table
from reduced_models.bearing.freedoms import FIVE
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.race import RACES
from reduced_models.bearing.race_table import CELLS, RaceForceTable
from reduced_models.elements.film_filters import DIRECT

_Floats = NDArray[np.float64]

DEGREE = 16  # of the polynomials at most; surfaces that press each other need 4 to 13
POINTS = 4  # of every cubic, to which they are fitted
NEGLIGIBLE, NEGLIGIBLE_IN_GAPS = 2e-14, 5e-11  # of g: last term of a polynomial; the cubics are 2e-10 off in gaps
MISFIT = 1e-9  # of g: what a polynomial may leave before its interval is halved
HALVINGS = 7  # down to one cubic
# Rounding for small files: a digit is in the binaries of five platforms and in the source. Rates keep 12 digits.
CURVE_UNIT, CURVE_UNIT_IN_GAPS = 2.0**-52, 2.0**-36  # of g, for the coefficients
DIRECT_UNIT, CHAIN_UNIT = 2.0**-45, 2.0**-42  # of a gain itself; of the largest gain of a chain at its node
FILM_NODES = 48  # loads of the films, even in their logarithm
FILM_UNIT = 2.0**-24  # of the logarithms of films: far below what lies between two loads
FARTHEST = 0.1  # of the ball diameter: largest displacement, which no ring in its bearing reaches
LARGEST_TILT = 0.1  # rad
# Sizes in numbers of the structures of ``bearing.h`` and ``ball.h``, which an FMU compares with its own
HEAD_NUMBERS, BALL_NUMBERS, FILM_NUMBERS = 10, 46, 7
STEP_NUMBERS, BALL_STEP_NUMBERS, FILTER_NUMBERS = 19, 69, 25


def bearing_table(model: BearingModel, name: str = "bearing") -> str:
    """C text of a bearing: its tables, and a ``static const Bearing`` of ``bearing.h`` that points to them.

    Parameters
    ----------
    model : BearingModel
    name : str
        Of the C variable; names of its tables begin with it.
    """
    bearing, balls = model.bearing, model.balls
    tables: dict[str, _Floats] = {"speeds": model.speeds * RPM_TO_RAD_S}
    if balls.loss.gains.size:
        tables |= {"filter_gains": balls.loss.gains, "filter_rates": balls.loss.rates}
    lines, races = [], []
    for race, law in zip(RACES, (balls.inner, balls.outer), strict=True):
        text, fields = _race(f"{name}_{race}", law)
        lines.append(text)
        races.append(fields)
    films = {"nodes": "0"}
    if bearing.oil is not None:
        (x, rows), radii = film_logarithms(model), [bearing.race(race).geometry.radius_x for race in RACES]
        tables["films"] = rows.ravel()
        films = {
            "nodes": str(FILM_NODES),
            "first": _numbers(x[:, 0]),
            "step": _numbers(x[:, 1] - x[:, 0]),
            "rolling_radius": _numbers(radii),
            "table": f"{name}_films",
            "roughness": c_double(bearing.roughness or 0.0),
        }
    fastest = float(model.speeds[-1])
    fields = {
        "directions": str(len(model.directions)),
        "direction": "{" + ", ".join(str(FIVE.index(direction)) for direction in model.directions) + "}",
        "balls": str(bearing.balls),
        "lags": str(lags_of(model)),
        "speeds": str(model.speeds.size),
        "filters": str(balls.loss.gains.size),
        "control": str(balls.grooves.control),
        "inertia": c_double(balls.inertia),
        "speed": f"{name}_speeds",
        "filter_gains": f"{name}_filter_gains" if balls.loss.gains.size else "NULL",
        "filter_rates": f"{name}_filter_rates" if balls.loss.gains.size else "NULL",
        "grooves": _fields(_grooves(model)),
        "race": "{" + ", ".join(_fields(race) for race in races) + "}",
        "films": _fields(films),
        "most_speed": c_double(fastest * RPM_TO_RAD_S),
        "most_load": _numbers([bearing.race(race).heaviest(fastest)[0] for race in RACES]),
        "largest_place": c_double(FARTHEST * bearing.ball_diameter),
        "largest_tilt": c_double(LARGEST_TILT),
        "origin": f"{name}_origin",
    }
    lines += [c_table(f"{name}_{part}", values) for part, values in tables.items()]
    origins = ", ".join(
        _fields({"place": _numbers(at["place"]), "across": c_double(float(at["across"]))})
        for at in counted_from(model)
    )
    lines.append(f"static const BallOrigin {name}_origin[] = {{{origins}}};")
    return "\n".join([*lines, f"static const Bearing {name} = {_fields(fields)};", ""])


def lags_of(model: BearingModel) -> int:
    """Lags of the chain of any film; 1 of a dry bearing, of whose films the state has room for all the same."""
    return max(law.gains.shape[2] - DIRECT for law in (model.balls.inner, model.balls.outer))


def state_size(model: BearingModel) -> int:
    """Numbers that a bearing remembers: ``bearing_state_size`` of ``bearing.h``."""
    balls, films = model.bearing.balls, FILM_NUMBERS + lags_of(model)
    return (
        HEAD_NUMBERS
        + balls * (BALL_NUMBERS + 2 * films)
        + (2 + model.balls.loss.gains.size) * len(model.directions)
    )


def work_size(model: BearingModel) -> int:
    """Numbers that a step of a bearing is kept in: ``bearing_work_size``."""
    return STEP_NUMBERS + model.bearing.balls * (BALL_STEP_NUMBERS + 2 * (FILTER_NUMBERS + 3 * lags_of(model)))


def _fields(values: Mapping[str, str]) -> str:
    """C text of a structure whose members have these names."""
    return "{" + ",\n    ".join(f".{name} = {value}" for name, value in values.items()) + "}"


def _numbers(values: Iterable[float]) -> str:
    return "{" + ", ".join(c_double(float(value)) for value in values) + "}"


def _race(name: str, law: RaceForceTable) -> tuple[str, dict[str, str]]:
    """C text of the tables of a race, and the members of its `Race`."""
    numbers = ("kn", "log_kn", "contact_length_factor", "lag_rate", "inlet_rate", "fast_rate", "cutoff_gap")
    fields = {number: c_double(float(getattr(law, number))) for number in numbers}
    fields["lags"] = str(law.gains.shape[2] - DIRECT)
    if law.x.size == 0:
        return "", fields | {"nodes": "0"}
    halved, place = _halved(law)
    fields["nodes"] = str(halved.x.size)
    curve, first = _curve(halved, place)
    gains, made = _rounded_gains(halved.gains), _rounded(halved.film_made, DIRECT_UNIT * halved.film_made)
    parts = {"x": halved.x, "u": halved.u, "curve": curve, "gains": gains, "made": made}
    lines = [c_table(f"{name}_{part}", values.reshape(-1)) for part, values in parts.items()]
    lines += [f"static const int {name}_first[] = {{{', '.join(map(str, first.tolist()))}}};"]
    return "\n".join(lines), fields | {part: f"{name}_{part}" for part in ("first", *parts)}


def _grooves(model: BearingModel) -> dict[str, str]:
    g = model.balls.grooves
    clearance = model.bearing.clearance if model.bearing.contact_angle is None else 0.0
    numbers = {
        "radial": g.radial,
        "axial": g.axial,
        "clearance": clearance,
        "circle": g.groove_circle,
        "inner_radius": g.radius,
        "ball": g.ball,
        "pitch": g.pitch,
        "mass": g.mass,
        "gyroscopic": g.gyroscopic,
        "cosine": g.cosine,
    }
    pairs = {
        "free_length": (g.inner, g.outer),
        "spin_moment": (g.inner_spin_moment, g.outer_spin_moment),
    }
    found = {name: c_double(float(value)) for name, value in numbers.items()}
    return found | {name: _numbers(pair) for name, pair in pairs.items()}


def _halved(law: RaceForceTable) -> tuple[RaceForceTable, NDArray[np.int64]]:
    """Law with more nodes where a polynomial does not follow the curve, as where a layer runs dry; its cubics.

    It is the same law: the curve is looked up by u, gains by x, straight between their nodes. The cubics of each
    interval, shape (n - 1, 2), are the first and the one behind the last of those of the row in `cells`.
    """
    place = CELLS * np.stack([np.arange(law.x.size - 1), np.arange(1, law.x.size)], axis=1)
    for _ in range(HALVINGS):
        g, terms = _fitted(law, place)
        left = np.abs(chebyshev.chebval(_along(), terms.T) / g - 1.0).max(axis=1)
        at = np.flatnonzero(left.reshape(len(law.u), -1).max(axis=0) > MISFIT)
        if at.size == 0:
            break
        middle = place[at].mean(axis=1).astype(int)
        place = np.insert(place, at + 1, np.stack([middle, place[at, 1]], axis=1), axis=0)
        place[at + np.arange(at.size), 1] = middle
        law = law._replace(
            x=_between(law.x, at, 0),
            u=_between(law.u, at, 1),
            gains=_between(law.gains, at, 1),
            film_made=_between(law.film_made, at, 1),
        )
    return law, place


def _between(values: _Floats, at: NDArray[np.int64], axis: int) -> _Floats:
    """Values at nodes, with the means over the intervals `at` between them."""
    means = 0.5 * (values.take(at, axis) + values.take(at + 1, axis))
    return np.insert(values, at + 1, means, axis=axis)


def _along() -> _Floats:
    """Points of an interval, -1 to 1."""
    return 2.0 * np.linspace(0.0, CELLS, POINTS * CELLS + 1) / CELLS - 1.0


def _fitted(law: RaceForceTable, place: NDArray[np.int64]) -> tuple[_Floats, _Floats]:
    """Curve at points of all intervals, and terms of the polynomials fitted to it; rows of speeds first."""
    cubics = law.cells.reshape(len(law.cells), -1, 4)
    at = place[:, :1] + np.diff(place, axis=1) * np.linspace(0.0, 1.0, POINTS * CELLS + 1)
    cell = np.minimum(at.astype(int), place[:, 1:] - 1)
    t = at - cell
    a, b, c, d = np.moveaxis(cubics[:, cell, :], -1, 0)
    g = (a + t * (b + t * (c + t * d))).reshape(-1, at.shape[1])
    return g, chebyshev.chebfit(_along(), g.T, DEGREE).T


def _curve(law: RaceForceTable, place: NDArray[np.int64]) -> tuple[_Floats, NDArray[np.int64]]:
    """Powers of s = -1 to 1 over every interval of every speed, and where those of each begin; the last one ends.

    A least-squares fit, with as many terms as are needed, two at least. Coefficients are rounded to `CURVE_UNIT`
    of g: those of high powers then have few digits. `place` is that of `_halved`.
    """
    g, terms = _fitted(law, place)
    gap = law.u[:, 1:].ravel() < 0.0
    negligible = np.where(gap, NEGLIGIBLE_IN_GAPS, NEGLIGIBLE) * g[:, 0]
    needed = np.abs(terms) > negligible[:, None]
    counts = np.maximum(DEGREE + 1 - np.argmax(needed[:, ::-1], axis=1), 2)
    units = np.where(gap, CURVE_UNIT_IN_GAPS, CURVE_UNIT) * g[:, 0]
    powers = [
        np.pad(_rounded(chebyshev.cheb2poly(row[:count]), unit), (0, count))[:count]  # numpy drops zeros
        for row, count, unit in zip(terms, counts.tolist(), units, strict=True)
    ]
    return np.concatenate(powers), np.append(0, np.cumsum(counts))


def _rounded_gains(gains: _Floats) -> _Floats:
    """Gains of nodes (speeds, n, DIRECT + lags), those of a chain rounded to the largest of its node."""
    direct, chain = np.split(gains, [DIRECT], axis=-1)
    chain = _rounded(chain, CHAIN_UNIT * np.abs(chain).max(axis=-1, keepdims=True, initial=0.0))
    return np.concatenate([_rounded(direct, DIRECT_UNIT * np.abs(direct)), chain], axis=-1)


def _rounded(values: _Floats, unit: _Floats) -> _Floats:
    """Values rounded to the largest powers of two that are not above `unit`; as they are where it is 0."""
    steps = 2.0 ** np.floor(np.log2(np.where(unit > 0.0, unit, np.finfo(float).tiny)))
    return np.where(unit > 0.0, steps * np.rint(values / steps), values)


def film_logarithms(model: BearingModel) -> tuple[_Floats, _Floats]:
    """Logarithms of loads (2, nodes), and of films and moment over them (2, speeds, 3, nodes); races first."""
    bearing = model.bearing
    loads_of, tables = [], []
    for name in RACES:
        race = bearing.race(name)
        ends = [(race.loads(speed)[0], race.heaviest(speed)[0]) for speed in model.speeds.tolist()]
        low, high = min(end[0] for end in ends), max(end[1] for end in ends)
        x = np.linspace(log(low), log(high), FILM_NODES)
        rows = []
        for speed, (least, most) in zip(model.speeds.tolist(), ends, strict=True):
            loads = np.clip(np.exp(x), least * (1.0 + 1e-9), most * (1.0 - 1e-9))
            logarithms = np.log(race.films(speed, loads, np.ones(loads.size)))
            rows.append(FILM_UNIT * np.rint(logarithms / FILM_UNIT))
        loads_of.append(x)
        tables.append(rows)
    return np.array(loads_of), np.array(tables)
