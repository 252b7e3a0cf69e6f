"""Variables and C sources of the FMU of a bearing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import log

import numpy as np

from fmu.bearing.model import BearingModel
from fmu.bearing.places import LOAD, rest_states, rolling_speed_sum
from fmu.bearing.set_model import OUTER_RING, SetModel
from fmu.bearing.tables import SeatPlaces, bearing_data, bearing_macros
from fmu.bearing.trial import START
from fmu.c_headers import c_double
from fmu.contact_spec import checked_name
from fmu.contact_variables import ALLOWED_ERROR
from fmu.lead import CONTACT, HELD_PARALLEL
from fmu.spec import ModelSpec, VariableList
from reduced_models import BallBearing
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.race import RACES
from reduced_models.elements.film_filters import DIRECT

STEP = 1e-5  # s, of the default experiment
SLOW = 1e-3  # m/s, for which the nominal values of states are
OUTER_RINGS = "the outer rings on the spring {}"
CAGE = "Angle of the first ball about z, from x towards y"
PLACES = ("w", "a")  # kinds of states that tell where a ball is


@dataclass(frozen=True)
class Motion:
    """A direction in which the inner ring moves: names, units and nominal values of its variables."""

    rate: str
    force: str
    where: str
    noun: str = "Displacement"
    effort: str = "Force"
    unit: str = "m"
    nominal: float = 1e-5
    force_unit: str = "N"
    force_nominal: float = 100.0


def _tilt(axis: str) -> Motion:
    where, kinds = f"about {axis}", ("Tilt", "Moment")
    return Motion(f"tilt_rate_{axis}", f"moment_{axis}", where, *kinds, "rad", 1e-4, "N.m", 1.0)


MOTIONS = (
    {axis: Motion(f"velocity_{axis}", f"force_{axis}", f"along {axis}") for axis in "xyz"}
    | {f"tilt_{axis}": _tilt(axis) for axis in "xy"}
    | {OUTER_RING: Motion("outer_ring.velocity_z", "outer_ring.force_z", "along z")}
)
FORCES = {name: motion.force for name, motion in MOTIONS.items()}
RATES = {name: motion.rate for name, motion in MOTIONS.items()}
PARAMETERS = "clearance", "offset", "cage_angle_start", "film"  # of a bearing, in the order of `BearingSettings`
OUTSIDE = "outside_validity"
# C sources of a bearing, inside a rotor too
BEARING_SOURCES = (
    "ball.c", "ball_search.c", "ball_steps.c", "ball_rest.c", "ball_rates.c", "bearing_outputs.c",
    "contact_rates.c", "race_contact.c", "film_filters.c", "surface_heights.c",
)  # fmt: skip
CAPACITANCE = "capacitance_table.c"  # with a permittivity
BEARING_HEADERS = (
    "bearing.h", "ball.h", "capacitance_table.h", "rolling.h", "contact_rates.h", "race_contact.h",
    "film_filters.h", "surface_heights.h", "dual.h",
)  # fmt: skip


def bearing_spec(model: BearingModel, model_name: str | None = None, lead: float | None = None) -> ModelSpec:
    """Specification of the FMU of a bearing.

    Raises
    ------
    InputError
        A name that is empty, too long or not printable, or another lead.
    """
    bearing, made = model.bearing, _Variables(model)
    made.fill(HELD_PARALLEL if lead is None else lead)
    speeds = model.speeds
    span = f"{speeds[-1]:.6g} rev/min" if speeds.size == 1 else f"{speeds[0]:.6g} to {speeds[-1]:.6g} rev/min"
    oil = "dry" if bearing.oil is None else "with oil"
    left_out = f"; {model.damping_left_out}" if model.damping_left_out else ""
    return ModelSpec(
        name=checked_name(f"BallBearing {bearing.name}".strip() if model_name is None else model_name),
        description=f"Ball bearing {bearing.name}, {bearing.balls} balls, {oil}, at {span}; SI units{left_out}",
        sources=("core.c", "core_step.c", "model_bearing.c", *bearing_sources([model])),
        headers=("core.h", "model.h", *BEARING_HEADERS),
        variables=tuple(made.variables),
        notes=_notes(model, span),
        macros=_macros(model, made),
        tables={"bearing_data.h": bearing_data(model.seats, [made.places], model.constant_force)},
        step=STEP,
        plain_steps=True,
        indicators=tuple(made.indicators),
        flanges=flanges_of(model.directions, "The inner ring"),
    )


def bearing_sources(models: Sequence[BearingModel]) -> tuple[str, ...]:
    """C sources of bearings."""
    return (*BEARING_SOURCES, *([CAPACITANCE] if any(one.permittivity is not None for one in models) else []))


def flanges_of(directions: Sequence[str], moved: str) -> tuple[tuple[str, str, tuple[str, str, str]], ...]:
    """Terminals of FMI 3.0 of what is moved: a displacement, its rate and its force each."""
    return tuple(
        (
            name.replace(".", "_"),
            f"{'Outer rings' if name == OUTER_RING else moved} {own.where}: {own.noun.lower()}, its rate, "
            f"{own.effort.lower()}",
            (name, own.rate, own.force),
        )
        for name, own in ((name, MOTIONS[name]) for name in directions)
    )


def speed_text(model: BearingModel | SetModel) -> str:
    """What the input "speed" is."""
    bearing = model.bearings.bearings[0] if isinstance(model, SetModel) else model.bearing
    if bearing.turning == "inner":
        return "Speed of the inner ring about z; the outer one stands still"
    if bearing.turning == "outer":
        return "Speed of the outer ring about z; the inner one stands still"
    inner, outer = bearing.ring_speeds
    return f"Speed of one ring against the other: {inner:.6g} of it inside, {outer:.6g} outside, about z"


class RingVariables(VariableList):
    """Inputs of the FMU of bearings."""

    def motions(self, model: BearingModel | SetModel, of: str) -> None:
        """Append places and rates of what is moved, with the speed of the shaft.

        `of` names what that is, with braces for where a displacement goes.
        """
        for name, start in zip(model.directions, model.place.tolist(), strict=True):
            own = MOTIONS[name]
            what = OUTER_RINGS if name == OUTER_RING else of
            self.add(
                name, "input", "continuous", f"{own.noun} of {what.format(own.where)}",
                unit=own.unit, start=start, nominal=own.nominal, rate=own.rate,
            )  # fmt: skip
        for name in model.directions:
            own = MOTIONS[name]
            self.add(
                own.rate, "input", "continuous", f"Rate of {name}",
                unit=f"{own.unit}/s", start=0.0, nominal=100.0 * own.nominal,
            )  # fmt: skip
        highest = float(model.speeds[-1] * RPM_TO_RAD_S)
        self.add(
            "speed", "input", "continuous", speed_text(model),
            unit="rad/s", start=highest, nominal=highest, minimum=0.0,
        )  # fmt: skip


class _Variables(RingVariables):
    """The variables of a bearing, numbered as they are made."""

    def __init__(self, model: BearingModel) -> None:
        super().__init__()
        self.model, self.bearing = model, model.bearing
        self.first_force = self.first_ball = 0
        self.indicators: list[tuple[str, str]] = []
        self.states = BallStates.of(model)

    def fill(self, lead: float) -> None:
        """All of them, in the order that ``bearing.h`` has."""
        self.motions(self.model, "the inner ring {}, against the outer ring")
        self._outputs()
        self._parameters(lead)
        self._states()
        self._balls()

    @property
    def places(self) -> SeatPlaces:
        """Where its variables are."""
        reference = {variable.name: variable.value_reference for variable in self.variables}
        settings = tuple(reference.get(name, -1) for name in PARAMETERS)
        return SeatPlaces(self.first_force, reference[OUTSIDE], reference["cage_angle"], self.first_ball, settings)

    def _outputs(self) -> None:
        depends = tuple(v.name for v in self.variables) + self._fixed + self.states.names
        self.first_force = len(self.variables)
        for of in (MOTIONS[name] for name in self.model.directions):
            text = f"{of.effort} on the inner ring {of.where}"
            self.add(
                of.force, "output", "continuous", text,
                unit=of.force_unit, nominal=of.force_nominal, depends=depends,
            )  # fmt: skip
        rows: list[tuple[str, str, float, float | None, str]] = [
            (f"largest_load_{race}", "N", 100.0, 0.0, f"Largest load of a ball on the {race} race")
            for race in RACES
        ]
        if self.bearing.oil is not None:
            text = "Torque that the films' rolling resistance takes from the inner ring"
            rows += [
                ("smallest_film", "m", 1e-7, None, f"Smallest film of all balls, of {_inlet(self.bearing)}"),
                ("rolling_torque", "N.m", 1e-2, None, text),
            ]
            if self.bearing.roughness:
                text = "Smallest film over the roughness of ball and race"
                rows.append(("smallest_lambda", "1", 1.0, None, text))
            if self.model.permittivity is not None:
                text = (
                    f"Capacitance between the rings, of oil with permittivity {self.model.permittivity:g}; 0 dry"
                )
                rows.append(("capacitance", "F", 1e-10, 0.0, text))
        for name, unit, nominal, minimum, text in rows:
            self.add(
                name, "output", "continuous", text, unit=unit, nominal=nominal, minimum=minimum, depends=depends,
            )  # fmt: skip
        for name, text in (
            ("outside_validity", "True where speed or loads leave the tables"),
            ("outside_speed", "True above the highest speed of the tables, whose films then hold"),
            ("outside_load", "True where a ball carries more than the tables have"),
        ):
            self.add(name, "output", "discrete", text, type="Boolean", depends=depends)

    @property
    def _fixed(self) -> tuple[str, ...]:
        """Parameters on which forces depend."""
        return (
            *(("clearance",) if self.bearing.contact_angle is None else ()),
            *(("offset",) if "z" in self.model.directions else ()),
            "cage_angle_start",
            "film",
        )

    def _states(self) -> None:
        """States and derivatives of the cage, of all balls and of the seat, as ``bearing.h`` has them."""
        fixed, given = self._fixed, tuple(v.name for v in self.variables if v.causality == "input")
        place, laws = (
            (*self.model.directions, "speed"),
            tuple(name for name in fixed if name != "cage_angle_start"),
        )
        at_rest = rest_states(self.model, float(self.model.speeds[-1]), START, self.model.place)
        guesses = dict(zip(self.states.names, at_rest, strict=True))
        self.add(
            "cage_angle", "output", "continuous", CAGE, unit="rad", nominal=1.0,
            depends=("cage_angle",), follows=("cage_angle_start",), guess=guesses["cage_angle"],
        )  # fmt: skip
        # the cage of balls at contact angles turns at a speed that depends on all balls, and all depend on it;
        # what depends on so many states may as well be said to depend on all of them: the list can be left out
        angular = self.model.angular
        all_balls = tuple(state.name for ball in self.states.balls for state in ball)
        forces = (*given, "cage_angle", *laws, *all_balls, *(self.states.seat if angular else ()))
        rates: list[tuple[str, str, tuple[str, ...]]] = [
            ("cage_angle", "rad/s", forces if angular else ("speed",))
        ]
        for ball in self.states.balls:
            own = tuple(state.name for state in ball)
            for state in ball:
                self.add(
                    state.name, "local", "continuous", state.text, unit=state.unit, nominal=state.nominal,
                    follows=(*place, *fixed) if state.kind in PLACES else (), guess=guesses[state.name],
                )  # fmt: skip
                if state.kind == "q":
                    places = (each.name for each in ball if each.kind in PLACES)
                    depends = (*place, "cage_angle", *laws, *places, *state.fed, state.name)
                elif state.kind in PLACES and state.fed:
                    depends = state.fed
                else:
                    depends = forces if angular else (*given, "cage_angle", *laws, *own)
                rates.append((state.name, f"{state.unit}/s", tuple(dict.fromkeys(depends))))
        for name, direction in self.states.seat.items():
            of = MOTIONS[direction]
            text = f"{of.effort} of the balls {of.where}, as a lag of the losses of rings and fits has it"
            self.add(
                name, "local", "continuous", text,
                unit=of.force_unit, nominal=of.force_nominal, follows=(*place, *fixed), guess=guesses[name],
            )  # fmt: skip
            rates.append((name, f"{of.force_unit}/s", tuple(dict.fromkeys((*forces, name)))))
        for name, unit, depends in rates:
            self.derivative(name, {"m/s/s": "m/s2"}.get(unit, unit), depends)
        contacts = RACES if self.bearing.ball_inertia else RACES[:1]
        for k, ball in enumerate(self.states.balls, start=1):
            like = next((f"der({state.name})" for state in ball if state.kind != "q" and not state.fed), "force_x")
            self.indicators += [(f"ball[{k}].contact_indicator_{race}", like) for race in contacts]

    def _parameters(self, lead: float) -> None:
        bearing = self.bearing
        self.lead(CONTACT, lead)
        if bearing.contact_angle is None:
            text = "Radial clearance, by which the inner ring moves from end to end"
            self.add("clearance", "parameter", "fixed", text, unit="m", start=bearing.clearance, nominal=1e-5)
        if "z" in self.model.directions:
            text = "Axial displacement added to z: preload by spacers, or growth of the shaft"
            self.add("offset", "parameter", "fixed", text, unit="m", start=0.0, nominal=1e-5)
        self.add(
            "cage_angle_start", "parameter", "fixed", "Angle of the first ball at the start", unit="rad",
            start=START,
        )  # fmt: skip
        self.add(
            "film", "parameter", "fixed", "1: with oil films; 0: dry", unit="1",
            start=0.0 if bearing.oil is None else 1.0, minimum=0.0, maximum=0.0 if bearing.oil is None else 1.0,
        )  # fmt: skip

    def _balls(self) -> None:
        """Loads, films and angles of all balls, in the order of `ball_outputs`."""
        self.first_ball = len(self.variables)
        entries = [("load", "N", "Load")]
        if self.bearing.oil is not None:
            entries += [("film", "m", "Central film"), ("smallest_film", "m", "Smallest film")]
        if self.model.angular:
            entries += [("contact_angle", "rad", "Contact angle")]
        for k in range(1, self.bearing.balls + 1):
            for race in RACES:
                for name, unit, text in entries:
                    self.add(
                        f"ball[{k}].{name}_{race}", "local", "continuous",
                        f"{text} of ball {k} at the {race} race", unit=unit,
                    )  # fmt: skip


@dataclass(frozen=True)
class BallState:
    """One state of a ball; `kind`: w, a and their rates v, v_a, or s, y, q of a film; `fed`: what feeds it."""

    name: str
    kind: str
    unit: str
    nominal: float
    text: str
    fed: tuple[str, ...] = ()


@dataclass(frozen=True)
class BallStates:
    """States of a bearing behind the angle of its cage: of every ball, and of the seat, with its direction."""

    balls: tuple[tuple[BallState, ...], ...]
    seat: dict[str, str]

    @classmethod
    def of(cls, model: BearingModel) -> BallStates:
        """Those of a bearing."""
        filters = range(1, 1 + model.balls.loss.gains.size)
        balls = tuple(tuple(_ball_states(model, k)) for k in range(1, model.bearing.balls + 1))
        return cls(balls, {f"seat_{name}[{k}]": name for k in filters for name in model.directions})

    @property
    def names(self) -> tuple[str, ...]:
        """All, in order."""
        return ("cage_angle", *(state.name for ball in self.balls for state in ball), *self.seat)


def _ball_states(model: BearingModel, k: int) -> Iterator[BallState]:
    bearing, balls = model.bearing, model.balls
    heavy, ball = bearing.ball_inertia, f"ball[{k}]"
    places = {"w": f"Approach of ball {k} and the outer race"}
    if model.angular:
        text = f"Place of ball {k} {{}} the line between both groove centres of a ring in the middle"
        places = {"w": text.format("along"), "a": text.format("across")}
    if bearing.oil is not None or heavy:
        rate_of = dict(zip(places, ("v", "v_a"), strict=False)) if heavy else {}
        for name, text in places.items():
            rate_name = (f"{ball}.{rate_of[name]}",) if heavy else ()
            yield BallState(f"{ball}.{name}", name, "m", 1e-6, text, rate_name)
        for name, rate in rate_of.items():
            yield BallState(f"{ball}.{rate}", rate, "m/s", 1e-3, f"Rate of {ball}.{name}")
    for race, law in zip(RACES, (balls.inner, balls.outer), strict=True):
        if law.x.size == 0:
            continue
        at = f"film of ball {k} at the {race} race"
        transit = law.contact_length_factor / (rolling_speed_sum(model) * model.speeds[-1] * RPM_TO_RAD_S)
        own = float(transit * (LOAD / law.kn) ** (1.0 / 3.0)) * SLOW
        made = float(own * np.interp(log(LOAD), law.x, law.film_made[-1]))
        s = f"{ball}.s_{race}"
        yield BallState(s, "s", "m", own, f"Inlet of the {at}")
        yield BallState(f"{ball}.y_{race}", "y", "m", own, f"Fast lag of the {at}")
        fed = s
        for j in range(1, law.gains.shape[2] - DIRECT + 1):
            name = f"{ball}.q_{race}[{j}]"
            yield BallState(name, "q", "m", made, f"Lag {j} of the chain of the {at}", (fed,))
            fed = name


def _macros(model: BearingModel, made: _Variables) -> dict[str, str]:
    counts = bearing_macros(model.seats, [len(made.states.names)], len(model.directions), made.first_force)
    return counts | {"DEFAULT_TOLERANCE": c_double(ALLOWED_ERROR)} | dict(CONTACT.macros)


def _inlet(bearing: BallBearing) -> str:
    if bearing.supply is None:
        return "a flooded inlet"
    if bearing.supply.h is not None:
        return f"a layer of {bearing.supply.h:.4g} m on both surfaces together"
    return f"a layer of {bearing.supply.over_flooded:.4g} times what the flooded isothermal film lets through"


def _notes(model: BearingModel, span: str) -> tuple[tuple[str, str], ...]:
    bearing = model.bearing
    lines = [
        ("Bearing", f"{bearing.balls} balls of {bearing.ball_diameter:g} m on {bearing.pitch_diameter:g} m"),
        ("Speeds", f"{span}; tables at {', '.join(f'{s:.6g}' for s in model.speeds)} rev/min"),
        ("Axes", "x and y across the shaft, z along it; tilts are small rotations about x and y"),
    ]  # fmt: skip
    if bearing.oil is not None:
        heat = "isothermal" if bearing.thermal is None else "that heat up"
        lines.append(
            ("Films", f"of {_inlet(bearing)}, {heat}; those of balls at contact angles by their rolling speeds")
        )
    if model.damping_left_out:
        lines.append(("Damping below zero", model.damping_left_out))
    return tuple(lines)
