"""A bearing with flooded isothermal films, with heat, and with a layer of oil on its surfaces, beside each other.

Each is the bearing with `BallBearing.thermal` and `BallBearing.supply`, from the tables of the atlas. With both,
heat thins the film and the layer is over what is left of it:

    value = heated value * value(layer/s)/flooded value,    s = heated central film over the flooded one.

On request, both contacts of the most loaded ball are solved as well, under its load with flooded films. R is the
ratio of a solved value to the flooded one, T the same of these contacts in the tables: of films and moments race
by race, of K and C with both contacts in series. The bearing then has

    value = tabled value * R/T,    C = tabled C + flooded C * (R - T), because C may be zero.

Where the tables do not have the bearing, it has value = flooded value * R: preload and the loads of all balls are
then those of flooded films.

Of a set of bearings films are those of the one with the most loaded ball, K, C and torques those of the set.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact import Heat, OilLayer, OperatingPoint, impedance
from ehlcontact.checks import parts, require_instance
from ehlcontact.checks.kinds import Callback
from ehlcontact.checks.quantity import takes
from ehlcontact.conditions import Conditions
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.lubricant import TractionLaw
from ehlcontact.status import Status
from ehlcontact.summary import Summary
from ehlcontact.supply import THICKEST
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.bearing.kinematics import RPM_TO_HZ, rolling_torque
from reduced_models.bearing.race import RACES, shared_atlas
from reduced_models.bearing.set_result import SetState
from reduced_models.bearing.sliding import USUAL_LAW, friction_at, race_at, require_oil
from reduced_models.bearing.table_bars import TableBars, table_bars

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

FLOODED, HEAT, LAYER, BOTH = "flooded, isothermal", "with heat", "with the layer", "with both"
HIGH = 500.0  # Hz, beside the frequency of the shaft
SHOWN = 2  # frequencies of tables and notes: these two
AXIAL, RADIAL = 2, 1  # of the degrees of freedom of a ring


class SolvedBall(NamedTuple):
    """Films of both contacts of a ball, over units of their points, and its impedance, both contacts in series.

    Shapes (2,), inner and outer race, and (k,), the frequencies.
    """

    h_central: _Floats
    h_min: _Floats
    moment: _Floats
    impedance: _Complex

    def over(self, other: SolvedBall) -> Ratios:
        """Values of this ball over those of another one."""
        Z, Y = self.impedance, other.impedance
        central, smallest, moment = (one / two for one, two in zip(self[:3], other[:3], strict=True))
        return Ratios(central, smallest, moment, Z.real / Y.real, Z.imag / Y.imag)


class Ratios(NamedTuple):
    """Films, moments, K and C under a condition over those of flooded isothermal films."""

    h_central: _Floats
    h_min: _Floats
    moment: _Floats
    stiffness: _Floats
    damping: _Floats

    def times(self, other: Ratios) -> Ratios:
        """Both together."""
        return Ratios(*(getattr(self, name) * getattr(other, name) for name in self._fields))


@dataclass(frozen=True, eq=False, kw_only=True)
class Condition:
    """A bearing, or a set of them, under one condition.

    Attributes
    ----------
    h_central, h_min : ndarray, shape (balls, 2)
        Films at inner and outer race [m]; of a set those of the bearing with the most loaded ball.
    lambda_ratio : ndarray, shape (balls, 2), or None
        Smallest film over composite roughness; None where no roughness is given.
    stiffness, damping : ndarray, shape (k, n)
        K [N/m] and C [N s/m] at the frequencies, in x, y and, of a bearing with contact angles, z.
    rolling, sliding : float
        Torque of the films and of sliding in the contacts [N m].
    """

    h_central: _Floats
    h_min: _Floats
    lambda_ratio: _Floats | None
    stiffness: _Floats
    damping: _Floats
    rolling: float
    sliding: float

    def times(self, other: Condition, over: Condition) -> Condition:
        """Values times those of another condition over those of a third."""
        values: dict[str, Any] = {
            name: None if one is None else one * getattr(other, name) / getattr(over, name)
            for name, one in vars(self).items()
        }
        return Condition(**values)


@dataclass(frozen=True, eq=False, kw_only=True)
class OilAndHeat(Summary):
    """A bearing, or a set of them, under several conditions of oil and heat.

    Attributes
    ----------
    at_rest : BearingState or SetState
        With flooded isothermal films.
    hz : ndarray, shape (k,)
        Frequencies of small vibrations: that of the shaft, 500 Hz, and those of a band where it was given.
    conditions : dict of str to Condition
        By name, those that were asked for.
    refused : dict of str to str
        Those that were asked for and have no film, and why.
    solved : bool
        Whether contacts of the most loaded ball were solved, and not all is from tables.
    beyond_tables : str
        Why the tables do not have it, so that loads of the balls are those of flooded films; empty where they do.
    error_bars : dict of str to TableBars
        Half widths of the error bars of conditions from tables; without entries where contacts were solved.
    """

    at_rest: BearingState | SetState
    hz: _Floats
    conditions: Mapping[str, Condition]
    refused: Mapping[str, str]
    solved: bool
    error_bars: Mapping[str, TableBars] = field(default_factory=dict)
    beyond_tables: str = ""

    @property
    def bearing(self) -> int:
        """Index of the bearing with the most loaded ball; 0 of a single one."""
        return _heaviest_of(_states(self.at_rest))

    @property
    def state(self) -> BearingState:
        """State of that bearing."""
        return _states(self.at_rest)[self.bearing]

    @property
    def skf(self) -> tuple[float, float] | None:
        """Rolling and sliding moment by SKF's model [N m], of a set in sum; None where it has no constants."""
        found = [(one.skf_rolling, one.skf_sliding) for one in _states(self.at_rest)]
        rolling, sliding = ([one for one in column if one is not None] for column in zip(*found, strict=True))
        return (sum(rolling), sum(sliding)) if len(rolling) == len(sliding) == len(found) else None

    @property
    def rows(self) -> list[tuple[str, str, dict[str, float]]]:
        """Quantity, unit and values by condition, of the most loaded ball and of the bearing."""
        found = []
        for words, unit, size, name, place in self._quantities:
            values = {key: getattr(one, name) for key, one in self.conditions.items()}
            if all(value is not None for value in values.values()):
                found.append((words, unit, {key: float(value[place]) / size for key, value in values.items()}))
        for name in ("rolling", "sliding"):
            shown = {key: 1e3 * float(getattr(one, name)) for key, one in self.conditions.items()}
            found.append((f"{name} torque", "N mm", shown))
        both = {key: 1e3 * (one.rolling + one.sliding) for key, one in self.conditions.items()}
        return [*found, ("torque", "N mm", both)]

    @property
    def bars(self) -> dict[str, dict[str, float]]:
        """Half widths of the error bars of `rows`, by quantity and condition; what has none is left out."""
        found: dict[str, dict[str, float]] = {}
        for words, _, size, name, place in self._quantities:
            for key, one in self.error_bars.items():
                if (bars := getattr(one, name, None)) is not None:
                    found.setdefault(words, {})[key] = float(bars[place[-bars.ndim :]]) / size
        return found

    @property
    def _quantities(self) -> list[tuple[str, str, float, str, tuple[int, int]]]:
        """Words, unit and its size, attribute and place of films of the most loaded ball, and of K and C."""
        ball, several = self.state.heaviest, len(self.ways) > 1
        films = [
            (f"{words}, {race}", unit, size, name, (ball, column))
            for name, words, unit, size in FILMS
            for column, race in enumerate(RACES)
        ]
        return films + [
            (f"{name}{f' {words}' if several else ''}, {hz:.4g} Hz", unit, size, name, (k, way))
            for k, hz in enumerate(self.hz[:SHOWN].tolist())
            for name, unit, size in SMALL
            for words, way in self.ways.items()
        ]

    @property
    def ways(self) -> dict[str, int]:
        """Directions of K and C that rows have, by their words."""
        load = self.at_rest.load
        along = {"along the load": RADIAL} if np.any(load[:2]) else {}
        return along | ({"axially": AXIAL} if load.size > AXIAL else {})

    @property
    def notes(self) -> list[str]:
        """What these numbers do not say, one line each."""
        lines = ["Films, K and C are those of all balls, from tables of solved contacts."]
        if self.error_bars:
            lines[0] += " Their error bars are those of the most loaded ball's contacts."
        if self.solved and not self.beyond_tables:
            lines = [
                "Films, K and C are those of all balls from tables, changed by what the solved contacts of the "
                "most loaded ball differ from its tabled ones."
            ]
        if self.beyond_tables:
            lines = [
                "K and C are those of flooded films times a ratio, of the solved contacts of the most loaded "
                f"ball, because the tables do not have this bearing ({self.beyond_tables}).",
                "So K is without the change of preload as films get thinner, and without that of lightly loaded "
                "balls: with preload, and of pairs, K can be over 10 % too high.",
            ]
        elif LAYER in self.conditions:
            lines.append(
                "C with a layer is that of tabled contacts, other C that of elements: up to 5 % apart for equal "
                "films."
            )
        if isinstance(self.at_rest, SetState):
            where = f"bearing {self.bearing}, facing {self.at_rest.facings[self.bearing]}"
            lines.append(f"The most loaded ball is that of {where}; K, C and torques are those of all bearings.")
        if BOTH in self.conditions:
            lines.append(
                "With both is a product: heat thins the flooded film, and the same oil is more of that film."
            )
        without = [
            f"{key} at {hz:.4g} Hz"
            for key, one in self.conditions.items()
            for k, hz in enumerate(self.hz[:SHOWN].tolist())
            if (one.damping[k, list(self.ways.values())] < 0.0).any()
        ]
        if without:
            lines.append(
                f"Damping below 0 ({', '.join(without)}): at low frequencies films add energy to vibrations."
            )
        return lines + [f"{key.capitalize()}: {reason}" for key, reason in self.refused.items()]

    def _summary_lines(self) -> list[str]:
        ball, words = self.state.heaviest, []
        for key, one in self.conditions.items():
            film, C = 1e6 * one.h_central[ball].min(), one.damping[0, next(iter(self.ways.values()))]
            torque = 1e3 * (one.rolling + one.sliding)
            words.append(f"{key}: film {film:.3g} µm, damping {C:.4g} N s/m, torque {torque:.4g} N mm")
        return [f"{self.at_rest.name or 'ball bearing'} at {self.state.speed_rpm:.5g} rev/min", *words[:4]]

    def to_dict(self) -> dict[str, Any]:
        """Everything but the state, ready for JSON, in SI."""
        names = "h_central", "h_min", "lambda_ratio", "stiffness", "damping", "rolling", "sliding"
        rolling, sliding = self.skf or (None, None)
        return {
            **(
                {
                    "error_bars": {
                        key: {name: _plain(value) for name, value in vars(one).items()}
                        for key, one in self.error_bars.items()
                    }
                }
                if self.error_bars
                else {}
            ),
            **({"bearing": self.bearing} if isinstance(self.at_rest, SetState) else {}),
            "hz": self.hz.tolist(),
            "conditions": {
                key: {name: _plain(getattr(one, name)) for name in names} for key, one in self.conditions.items()
            },
            "refused": dict(self.refused),
            "solved": self.solved,
            **({"beyond_tables": self.beyond_tables} if self.beyond_tables else {}),
            "skf_rolling": rolling,
            "skf_sliding": sliding,
            "notes": self.notes,
        }


# Name, words, unit and its size.
FILMS = (
    ("h_central", "central film", "µm", 1e-6),
    ("h_min", "smallest film", "µm", 1e-6),
    ("lambda_ratio", "lambda", "", 1.0),
)
SMALL = (("stiffness", "N/µm", 1e6), ("damping", "N s/m", 1.0))


@takes(band=parts.NATURAL, callback=Callback("done, of, words"))
def oil_and_heat(
    bearing: Any,
    load: ArrayLike,
    *,
    speed_rpm: float,
    supply: OilLayer | None = None,
    thermal: Heat | None = None,
    tilt: ArrayLike | None = None,
    law: TractionLaw = USUAL_LAW,
    band: ArrayLike = (),
    solve: bool = False,
    callback: Callable[[int, int, str], object] = lambda done, total, words: None,
) -> OilAndHeat:
    """Films, K, C and torque of a bearing, flooded and isothermal, with heat, with a layer, with both.

    Parameters
    ----------
    bearing : BallBearing or BearingSet
    load, tilt
        As of its `equilibrium`.
    speed_rpm : float
        Of the shaft [rev/min].
    supply : OilLayer, optional
        Layer that reaches every contact, uniform; the conditions with it are left out without it.
    thermal : Heat, optional
        Likewise of heat.
    law : TractionLaw
        Of sliding.
    band : array_like, shape (k,)
        Further frequencies of K and C [Hz].
    solve : bool
        Solve the contacts of the most loaded ball, and correct the tables by them. Where the tables do not have
        the bearing they are solved in any case, and `OilAndHeat.beyond_tables` says why.
    callback : callable
        Called before every solve with those done, their number, and what is solved.

    Raises
    ------
    InputError
        A dry bearing; a most loaded ball with less load than the atlas has; an oil without the data of heat.
    ConvergenceError
        Of flooded films that are solved. Other films that do not converge are in `OilAndHeat.refused`.
    """
    for one in _bearings(bearing):
        require_instance("bearing", one, BallBearing, "a BallBearing, or a BearingSet")
        require_oil(one, law)
        if one.supply is not None:
            raise InputError(
                "bearing.supply", "an OilLayer", "left out of the bearing: `supply` here is that layer"
            )
        if one.thermal is not None:
            raise InputError("bearing.thermal", "a Heat", "left out of the bearing: `thermal` here is that heat")
    under: dict[str, Any] = {"speed_rpm": speed_rpm, "tilt": tilt}
    at_rest = bearing.equilibrium(load, **under)
    states = _states(at_rest)
    most = _heaviest_of(states)
    hz = np.array([at_rest.speed_rpm * RPM_TO_HZ, HIGH, *np.ravel(band).tolist()])
    points = [_point(_bearings(bearing)[most], states[most], column) for column in range(len(RACES))]
    given = Conditions.of(supply=supply, thermal=thermal)
    given.at(points[0])  # which names data that are missing

    def tabulated(**one: Any) -> Condition:
        variant = _with(bearing, **one)
        found = _states(variant.equilibrium(load, **under))
        return _tabulated(_bearings(variant), found, most, variant.coefficients(load, hz=hz, **under), law)

    small, beyond = bearing.coefficients(load, hz=hz, **under), ""
    flooded = _tabulated(_bearings(bearing), states, most, small, law)
    try:
        tables = _from_tables(flooded, tabulated, states[most].heaviest, given)
        if not solve:
            bars = _bars(_bearings(bearing)[most], states[most], hz, tables, given)
            return OilAndHeat(at_rest=at_rest, hz=hz, conditions=tables, refused={}, solved=False, error_bars=bars)
        tabled, _ = _ratios(points, partial(_tabled_contact, _bearings(bearing)[most].atlas, hz), given)
    except InputError as error:
        beyond = str(error)
    solved, refused = _ratios(points, partial(_solved_contact, hz), given, callback)
    times = partial(_times, _bearings(bearing), states, flooded, law)
    if beyond:
        made = {key: times(one) for key, one in solved.items()}
    else:
        made = {key: _corrected(tables[key], times, one, tabled[key]) for key, one in solved.items()}
    made[FLOODED] = flooded
    return OilAndHeat(at_rest=at_rest, hz=hz, conditions=made, refused=refused, solved=True, beyond_tables=beyond)


def _bearings(one: Any) -> tuple[Any, ...]:
    """The bearings of a set, or the one alone."""
    return tuple(getattr(one, "bearings", (one,)))


def _states(at_rest: BearingState | SetState) -> tuple[BearingState, ...]:
    return at_rest.bearings if isinstance(at_rest, SetState) else (at_rest,)


def _heaviest_of(states: Sequence[BearingState]) -> int:
    """Index of the bearing with the most loaded ball."""
    return int(np.argmax([one.force[one.heaviest, 0] for one in states]))


def _with(one: Any, **given: Any) -> Any:
    """A bearing, or all of a set, with other arguments."""
    if hasattr(one, "bearings"):
        return replace(one, bearings=[replace(single, **given) for single in one.bearings])
    return replace(one, **given)


def _from_tables(
    flooded: Condition,
    tabulated: Callable[..., Condition],
    heaviest: int,
    given: Conditions,
) -> dict[str, Condition]:
    """The conditions that are asked for, each of the bearing as a whole."""
    made = {FLOODED: flooded}
    if given.heat is not None:
        made[HEAT] = tabulated(thermal=given.heat)
    if given.supply is not None:
        made[LAYER] = tabulated(supply=given.supply)
    if given.supply is not None and given.heat is not None:
        share = float((made[HEAT].h_central / flooded.h_central)[heaviest].mean())
        made[BOTH] = made[HEAT].times(tabulated(supply=_over(given.supply, share)), flooded)
    return made


def _bars(
    bearing: Any,
    state: BearingState,
    hz: _Floats,
    made: Mapping[str, Condition],
    given: Conditions,
) -> dict[str, TableBars]:
    """Error bars under each condition, of the most loaded ball under its load with flooded films."""
    ball, found = state.heaviest, {}
    for key, one in made.items():
        layer, heat = given.supply if key in (LAYER, BOTH) else None, given.heat if key in (HEAT, BOTH) else None
        own = Conditions(layer, heat)
        races = [replace(race_at(bearing, state, ball, k), conditions=own) for k in range(len(RACES))]
        found[key] = table_bars(races, state.force[ball].tolist(), state.speed_rpm, hz, one.stiffness)
    return found


def _tabulated(
    bearings: Sequence[Any], states: Sequence[BearingState], most: int, small: Any, law: TractionLaw
) -> Condition:
    """Bearings as they are; `most` is the one with the most loaded ball."""
    damping, state = small.damping if small.signed_damping is None else small.signed_damping, states[most]
    assert state.h_central is not None and state.h_min is not None
    return Condition(
        h_central=state.h_central,
        h_min=state.h_min,
        lambda_ratio=state.lambda_ratio,
        stiffness=_diagonal(small.stiffness),
        damping=_diagonal(damping),
        rolling=sum(one.rolling_torque or 0.0 for one in states),
        sliding=_sliding(bearings, states, law),
    )


def _sliding(bearings: Sequence[Any], states: Sequence[BearingState], law: TractionLaw) -> float:
    """Sliding torque of all bearings [N m]."""
    pairs = zip(bearings, states, strict=True)
    return sum(friction_at(bearing, state, law, heat=False).sliding for bearing, state in pairs)


def _diagonal(matrices: _Floats) -> _Floats:
    """Of matrices over the frequencies: in x, y and z."""
    return np.einsum("kii->ki", matrices)[:, : AXIAL + 1]


def _point(bearing: Any, state: BearingState, column: int) -> OperatingPoint:
    """Contact of the most loaded ball with a race."""
    ball, race = state.heaviest, race_at(bearing, state, state.heaviest, column)
    load, least = float(state.force[ball, column]), race.loads(state.speed_rpm)[0]
    if load < least:
        raise InputError(
            "load", load, f"such that the most loaded ball carries at least {least:.3g} N, the least of the atlas"
        )
    found: OperatingPoint = race.point(load, state.speed_rpm)
    return found


_Contact = Callable[[OperatingPoint, Conditions], tuple[tuple[float, float, float], _Complex]]


def _solved_contact(
    hz: _Floats, point: OperatingPoint, conditions: Conditions
) -> tuple[tuple[float, float, float], _Complex]:
    """Central and smallest film [m] and moment [N m] of a contact, and its impedance [N/m]."""
    one = impedance(point, hz=hz, **conditions.keywords)
    film = one.film
    assert film is not None
    return (film.h_central, film.h_min, film.moment), one.stiffness + 2j * np.pi * hz * one.damping


def _tabled_contact(
    atlas: str | None, hz: _Floats, point: OperatingPoint, conditions: Conditions
) -> tuple[tuple[float, float, float], _Complex]:
    """The same from the tables."""
    one = shared_atlas(atlas).at(point, **conditions.keywords)
    small = one.impedance(hz=hz)
    return (one.h_central, one.h_min, one.moment), small.stiffness + 2j * np.pi * hz * small.damping


def _ratios(
    points: list[OperatingPoint],
    contact: _Contact,
    given: Conditions,
    callback: Callable[[int, int, str], object] = lambda done, total, words: None,
) -> tuple[dict[str, Ratios], dict[str, str]]:
    """Ratios of the conditions that are asked for, of contacts found by `contact`, and why others have none."""
    supply, asked = given.supply, {HEAT: given.heat is not None, LAYER: given.supply is not None}
    asked[BOTH] = all(asked.values())
    steps = iter(range(total := 2 * (1 + sum(asked.values()))))

    def solve(words: str, heat: Heat | None, layers: list[OilLayer | None]) -> SolvedBall:
        found = []
        for race, point, layer in zip(RACES, points, layers, strict=True):
            callback(next(steps), total, f"{race} race, {words}")
            found.append(contact(point, Conditions(layer, heat)))
        films, Z = zip(*found, strict=True)
        central, smallest, moment = np.array(films).T
        return SolvedBall(central, smallest, moment, Z[0] * Z[1] / (Z[0] + Z[1]))

    flooded = solve(FLOODED, None, [None, None])
    made, refused = {FLOODED: flooded.over(flooded)}, {}
    for key in (name for name, wanted in asked.items() if wanted):
        if key == BOTH and HEAT in refused:
            refused[key] = f"no film {HEAT}"
            continue
        share = made[HEAT].h_central if key == BOTH else np.ones(len(RACES))
        layers = [None if key == HEAT or supply is None else _over(supply, one) for one in share.tolist()]
        try:
            found = solve(key, given.heat if key == HEAT else None, layers).over(flooded)
        except ConvergenceError as error:
            refused[key] = _reason(error)
            continue
        made[key] = found.times(made[HEAT]) if key == BOTH else found
    return made, refused


def _reason(error: ConvergenceError) -> str:
    """Why there is no film; the advice of a solve is about its grid, which nobody can choose here."""
    if getattr(error.result, "status", None) is Status.STARVED:
        return "the layer of oil is so thin that a film is zero: let more oil in"
    return str(error)


def _over(supply: OilLayer, share: float) -> OilLayer:
    """The layer in units of a film that is thinner by a share."""
    name = next(one for one in ("h", "over_flooded", "H") if getattr(supply, one) is not None)
    thickness = np.asarray(getattr(supply, name)) / share
    return replace(supply, **{name: np.minimum(thickness, THICKEST[name])})  # the thickest there can be is flooded


def _corrected(
    tabled: Condition, times: Callable[[Ratios], Condition], solved: Ratios, answers: Ratios
) -> Condition:
    """A tabled condition with ratios of solved contacts in place of those of the same contacts in the tables."""
    one = Ratios(*np.ones((len(solved), 1)))
    ratios = Ratios(*(getattr(solved, name) / getattr(answers, name) for name in solved._fields))
    flooded = times(one)
    damping = tabled.damping + flooded.damping * (solved.damping - answers.damping)[:, None]
    return replace(tabled.times(times(ratios), flooded), damping=damping)


def _times(
    bearings: Sequence[Any], states: Sequence[BearingState], flooded: Condition, law: TractionLaw, ratios: Ratios
) -> Condition:
    """Flooded bearings with their values times these ratios."""
    thin = [replace(one, h_central=np.asarray(one.h_central) * ratios.h_central) for one in states]
    return Condition(
        h_central=flooded.h_central * ratios.h_central,
        h_min=flooded.h_min * ratios.h_min,
        lambda_ratio=None if flooded.lambda_ratio is None else flooded.lambda_ratio * ratios.h_min,
        stiffness=flooded.stiffness * ratios.stiffness[:, None],
        damping=flooded.damping * ratios.damping[:, None],
        rolling=sum(_rolling(*row, ratios.moment) for row in zip(bearings, states, strict=True)),
        sliding=_sliding(bearings, thin, law),
    )


def _rolling(bearing: Any, state: BearingState, ratios: _Floats) -> float:
    """Rolling torque [N m] with the moments of both races times these ratios."""
    assert state.moment is not None and state.rolling_torque is not None
    unchanged, found = (
        rolling_torque(moment[:, 0], moment[:, 1], bearing.ball_diameter, bearing.pitch_diameter)
        for moment in (state.moment, state.moment * ratios)
    )  # as if balls had no contact angles
    return found if state.contact_angles is None else state.rolling_torque * found / unchanged


def _plain(value: Any) -> Any:
    return value.tolist() if isinstance(value, np.ndarray) else value
