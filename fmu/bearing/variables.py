"""Variables and C sources of the FMU of a bearing."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from math import log

import numpy as np

from fmu.bearing.model import BearingModel
from fmu.bearing.places import LOAD, counted_from, rolling_speed_sum
from fmu.bearing.tables import FILM_NODES, film_tables, race_tables, seat_tables, speed_tables
from fmu.c_headers import c_double, c_table
from fmu.contact_spec import checked_name
from fmu.contact_variables import ALLOWED_ERROR
from fmu.lead import CONTACT, HELD_PARALLEL
from fmu.spec import ModelSpec, VariableList
from reduced_models import BallBearing
from reduced_models.bearing.freedoms import FIVE
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.loss import FILTERS
from reduced_models.bearing.race import RACES
from reduced_models.elements.film_curve import RIGID_SLOPE
from reduced_models.elements.film_filters import DIRECT, FEW

STEP = 1e-5  # s, of the default experiment
FARTHEST = 0.1  # of the ball diameter: largest displacement, which no ring in its bearing reaches
LARGEST_TILT = 0.1  # rad
SLOW = 1e-3  # m/s, for which the nominal values of states are
CAGE = "Angle of the first ball about z, from x towards y"

FORCES = {"x": "force_x", "y": "force_y", "z": "force_z", "tilt_x": "moment_x", "tilt_y": "moment_y"}
RATES = {
    "x": "velocity_x",
    "y": "velocity_y",
    "z": "velocity_z",
    "tilt_x": "tilt_rate_x",
    "tilt_y": "tilt_rate_y",
}
SOURCES = (
    "core.c", "core_step.c", "model_bearing.c", "balls.c", "race_contact.c", "contact_rates.c", "film_filters.c",
)  # fmt: skip
HEADERS = (
    "core.h", "model.h", "dual.h", "balls.h", "race_contact.h", "contact_rates.h", "continuous_time.h",
    "film_filters.h",
)  # fmt: skip
PLANAR_SOURCES = ("balls_planar.c", "continuous_planar.c")
ANGULAR_SOURCES = ("balls_angular.c", "contact_angles.c", "continuous_angular.c")


def bearing_spec(model: BearingModel, model_name: str | None = None, lead: float | None = None) -> ModelSpec:
    """Specification of the FMU of a bearing.

    Raises
    ------
    InputError
        A name that is empty, too long or not printable, or another lead.
    """
    bearing, made = model.bearing, _Variables(model)
    made.fill(HELD_PARALLEL if lead is None else lead)
    planar = len(model.names) == 2
    speeds = model.speeds
    span = f"{speeds[-1]:.6g} rev/min" if speeds.size == 1 else f"{speeds[0]:.6g} to {speeds[-1]:.6g} rev/min"
    oil = "dry" if bearing.oil is None else "with oil"
    left_out = f"; {model.damping_left_out}" if model.damping_left_out else ""
    return ModelSpec(
        name=checked_name(f"BallBearing {bearing.name}".strip() if model_name is None else model_name),
        description=f"Ball bearing {bearing.name}, {bearing.balls} balls, {oil}, at {span}; SI units{left_out}",
        sources=(*SOURCES, *(PLANAR_SOURCES if planar else ANGULAR_SOURCES)),
        headers=(*HEADERS, *(() if planar else ("contact_angles.h",))),
        variables=tuple(made.variables),
        notes=_notes(model, span),
        macros=_macros(model, made),
        tables={
            "bearing_races.h": race_tables(model),
            **({} if bearing.oil is None else {"bearing_films.h": film_tables(model)}),
            "bearing_seat.h": seat_tables(model),
            "bearing_speeds.h": speed_tables(model),
            "film_inverse.h": _inverse(_lags(model)),
        },
        step=STEP,
        plain_steps=True,
        indicators=tuple(made.indicators),
        flanges=tuple(
            (
                name,
                f"The inner ring about {name[-1]}: tilt, its rate, moment"
                if name.startswith("tilt")
                else f"The inner ring along {name}: place, velocity, force",
                (name, RATES[name], FORCES[name]),
            )
            for name in model.names
        ),
    )


class _Variables(VariableList):
    """The variables of a bearing, numbered as they are made."""

    def __init__(self, model: BearingModel) -> None:
        super().__init__()
        self.model, self.bearing, self.five = model, model.bearing, len(model.names) == len(FIVE)
        self.first_force = self.first_ball = self.per_ball = 0
        self.indicators: list[tuple[str, str]] = []
        self.states = BallStates.of(model)

    def fill(self, lead: float) -> None:
        """All of them."""
        self._inputs()
        self._outputs()
        self._parameters(lead)
        self._states()
        self._balls()

    def _inputs(self) -> None:
        for name, start in zip(self.model.names, self.model.place.tolist(), strict=True):
            tilt = name.startswith("tilt")
            text = (
                f"Tilt of the inner ring about {name[-1]}"
                if tilt
                else f"Displacement of the inner ring along {name}"
            )
            self.add(
                name, "input", "continuous", f"{text}, against the outer ring",
                unit="rad" if tilt else "m", start=start, nominal=1e-4 if tilt else 1e-5, rate=RATES[name],
            )  # fmt: skip
        for name in self.model.names:
            tilt = name.startswith("tilt")
            self.add(
                RATES[name], "input", "continuous", f"Rate of {name}",
                unit="rad/s" if tilt else "m/s", start=0.0, nominal=1e-2 if tilt else 1e-3,
            )  # fmt: skip
        highest = float(self.model.speeds[-1] * RPM_TO_RAD_S)
        self.add(
            "speed", "input", "continuous", "Speed of the inner ring about z; the outer one stands still",
            unit="rad/s", start=highest, nominal=highest, minimum=0.0,
        )  # fmt: skip

    def _outputs(self) -> None:
        depends = tuple(v.name for v in self.variables) + self._fixed + self.states.names
        self.first_force = len(self.variables)
        for name in self.model.names:
            tilt = name.startswith("tilt")
            text = (
                f"Moment on the inner ring about {name[-1]}" if tilt else f"Force on the inner ring along {name}"
            )
            self.add(
                FORCES[name], "output", "continuous", text,
                unit="N.m" if tilt else "N", nominal=1.0 if tilt else 100.0, depends=depends,
            )  # fmt: skip
        for race in ("inner", "outer"):
            text = f"Largest load of a ball on the {race} race"
            self.add(
                f"largest_load_{race}", "output", "continuous", text,
                unit="N", minimum=0.0, nominal=100.0, depends=depends,
            )  # fmt: skip
        if self.bearing.oil is not None:
            for name, unit, nominal, text in self._films():
                self.add(name, "output", "continuous", text, unit=unit, nominal=nominal, depends=depends)
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
            *(("offset",) if self.five else ()),
            "cage_angle_start",
            "film",
        )

    def _states(self) -> None:
        """States and derivatives of the cage, of all balls and of the seat, as `continuous_time.h` has them."""
        fixed, given = self._fixed, tuple(v.name for v in self.variables if v.causality == "input")
        place, laws = (*self.model.names, "speed"), tuple(name for name in fixed if name != "cage_angle_start")
        self.add(
            "cage_angle", "output", "continuous", CAGE, unit="rad", nominal=1.0,
            depends=("cage_angle",), follows=("cage_angle_start",),
        )  # fmt: skip
        # the cage of balls at contact angles turns at a speed that depends on all balls, and all depend on it;
        # what depends on so many states may as well be said to depend on all of them: the list can be left out
        all_balls = tuple(one.name for ball in self.states.balls for one in ball)
        forces = (*given, "cage_angle", *laws, *all_balls, *(self.states.seat if self.five else ()))
        rates: list[tuple[str, str, tuple[str, ...]]] = [
            ("cage_angle", "rad/s", forces if self.five else ("speed",))
        ]
        for ball in self.states.balls:
            for state in ball:
                follows = (*place, *fixed) if state.kind in ("w", "a") else ()
                self.add(
                    state.name, "local", "continuous", state.text, unit=state.unit, nominal=state.nominal,
                    follows=follows,
                )  # fmt: skip
                if state.kind == "q":
                    own = (one.name for one in ball if one.kind in ("w", "a"))
                    depends = (*place, "cage_angle", *laws, *own, *state.fed, state.name)
                elif state.kind == "w" and len(ball) > 1 and ball[1].kind == "v":
                    depends = (ball[1].name,)
                elif self.five:
                    depends = forces
                else:
                    depends = (*given, "cage_angle", *laws, *(one.name for one in ball))
                rates.append((state.name, f"{state.unit}/s", tuple(dict.fromkeys(depends))))
        for name, axis in self.states.seat.items():
            what, unit = (f"Moment of the balls about {axis[-1]}", "N.m") if axis.startswith("tilt") else (
                f"Force of the balls along {axis}", "N"
            )  # fmt: skip
            text = f"{what}, as a lag of the losses of rings and fits has it"
            nominal = 100.0 if unit == "N" else 1.0
            self.add(name, "local", "continuous", text, unit=unit, nominal=nominal, follows=(*place, *fixed))
            rates.append((name, f"{unit}/s", tuple(dict.fromkeys((*forces, name)))))
        for name, unit, depends in rates:
            self.derivative(name, {"m/s/s": "m/s2"}.get(unit, unit), depends)
        contacts = ("inner", "outer") if self.bearing.ball_inertia else ("inner",)
        for k, ball in enumerate(self.states.balls, start=1):
            like = next((f"der({one.name})" for one in ball if one.kind != "q"), "force_x")
            like = f"der({ball[1].name})" if len(ball) > 1 and ball[1].kind == "v" else like
            self.indicators += [(f"ball[{k}].contact_indicator_{race}", like) for race in contacts]

    def _films(self) -> list[tuple[str, str, float, str]]:
        found = [
            ("smallest_film", "m", 1e-7, f"Smallest film of all balls, of {_inlet(self.bearing)}"),
            ("rolling_torque", "N.m", 1e-2, "Torque that the films' rolling resistance takes from the inner ring"),
        ]
        if self.bearing.roughness:
            found.append(("smallest_lambda", "1", 1.0, "Smallest film over the roughness of ball and race"))
        return found

    def _parameters(self, lead: float) -> None:
        bearing = self.bearing
        self.lead(CONTACT, lead)
        if bearing.contact_angle is None:
            text = "Radial clearance, by which the inner ring moves from end to end"
            self.add("clearance", "parameter", "fixed", text, unit="m", start=bearing.clearance, nominal=1e-5)
        if self.five:
            text = "Axial displacement added to z: preload by spacers, or growth of the shaft"
            self.add("offset", "parameter", "fixed", text, unit="m", start=0.0, nominal=1e-5)
        self.add(
            "cage_angle_start", "parameter", "fixed", "Angle of the first ball at the start", unit="rad",
            start=-math.pi / 2.0,
        )  # fmt: skip
        self.add(
            "film", "parameter", "fixed", "1: with oil films; 0: dry", unit="1",
            start=0.0 if bearing.oil is None else 1.0, minimum=0.0, maximum=0.0 if bearing.oil is None else 1.0,
        )  # fmt: skip

    def _balls(self) -> None:
        """Loads, films and angles of all balls, in the order in which the C source writes them."""
        self.first_ball = len(self.variables)
        for k in range(1, self.bearing.balls + 1):
            for race in ("inner", "outer"):
                entries = [("load", "N", "Load")]
                if self.bearing.oil is not None:
                    entries += [("film", "m", "Central film"), ("smallest_film", "m", "Smallest film")]
                if self.five:
                    entries += [("contact_angle", "rad", "Contact angle")]
                for name, unit, text in entries:
                    self.add(
                        f"ball[{k}].{name}_{race}", "local", "continuous",
                        f"{text} of ball {k} at the {race} race", unit=unit,
                    )  # fmt: skip
        self.per_ball = (len(self.variables) - self.first_ball) // self.bearing.balls


@dataclass(frozen=True)
class BallState:
    """One state of a ball; `kind`: w, a, v of its place, s, y, q of a film; `fed`: names of what feeds it."""

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
        bearing, filters = model.bearing, range(1, 1 + FILTERS * bool(model.bearing.loss_factor))
        balls = tuple(tuple(_ball_states(model, k)) for k in range(1, bearing.balls + 1))
        return cls(balls, {f"seat_{axis}[{k}]": axis for k in filters for axis in model.names})

    @property
    def names(self) -> tuple[str, ...]:
        """All, in order."""
        return ("cage_angle", *(one.name for ball in self.balls for one in ball), *self.seat)


def _ball_states(model: BearingModel, k: int) -> Iterator[BallState]:
    bearing, balls, five = model.bearing, model.motion().balls, len(model.names) == len(FIVE)
    if five and bearing.oil is not None:
        text = f"Place of ball {k} {{}} the line between both groove centres of a ring in the middle"
        yield BallState(f"ball[{k}].w", "w", "m", 1e-6, text.format("along"))
        yield BallState(f"ball[{k}].a", "a", "m", 1e-6, text.format("across"))
    elif bearing.oil is not None or bearing.ball_inertia:
        yield BallState(f"ball[{k}].w", "w", "m", 1e-6, f"Approach of ball {k} and the outer race")
    if bearing.ball_inertia:
        yield BallState(f"ball[{k}].v", "v", "m/s", 1e-3, f"Rate of ball[{k}].w")
    for race, law in zip(RACES, (balls.inner, balls.outer), strict=True):
        if law.x.size == 0:
            continue
        at = f"film of ball {k} at the {race} race"
        transit = law.contact_length_factor / (rolling_speed_sum(model) * model.speeds[-1] * RPM_TO_RAD_S)
        own = float(transit * (LOAD / law.kn) ** (1.0 / 3.0)) * SLOW
        made = float(own * np.interp(log(LOAD), law.x, law.film_made[-1]))
        s = f"ball[{k}].s_{race}"
        yield BallState(s, "s", "m", own, f"Inlet of the {at}")
        yield BallState(f"ball[{k}].y_{race}", "y", "m", own, f"Fast lag of the {at}")
        fed = s
        for j in range(1, law.gains.shape[2] - DIRECT + 1):
            name = f"ball[{k}].q_{race}[{j}]"
            yield BallState(name, "q", "m", made, f"Lag {j} of the chain of the {at}", (fed,))
            fed = name


def _lags(model: BearingModel) -> int:
    balls = model.motion().balls
    return max(1, *(law.gains.shape[2] - DIRECT for law in (balls.inner, balls.outer)))


def _macros(model: BearingModel, made: _Variables) -> dict[str, str]:
    bearing, balls = model.bearing, model.motion().balls
    lags, five = _lags(model), made.five
    filters = FILTERS if bearing.loss_factor else 0
    places, freedoms = (2 if five else 1), len(model.names)
    ball = 2 * places + 2 + 4 + 4 + 2 + 2 + 2 + 2  # numbers of `Ball` in balls.h
    film = 6 + lags  # of `FilmState`
    remembered = 5 + bearing.balls * (ball + 2 * film) + (1 + filters) * freedoms
    counts = {
        "FREEDOMS": freedoms,
        "PLACES": places,
        "BALLS": bearing.balls,
        "LAGS": lags,
        "SEAT_FILTERS": filters,
        "SPEED_ROWS": model.speeds.size,
        "FILM_NODES": FILM_NODES,
        "HAS_FILMS": int(bearing.oil is not None),
        "HAS_ROUGHNESS": int(bool(bearing.roughness)),
        "HAS_CLEARANCE": int(bearing.contact_angle is None),
        "OWN_STATES": 2 if bearing.ball_inertia else places * int(bearing.oil is not None),
        "FILM_STATES": 2 + lags if bearing.oil is not None else 0,
        "N_CACHE": remembered,
        "FIRST_FORCE": made.first_force,
        "FIRST_BALL": made.first_ball,
        "PER_BALL": made.per_ball,
    }
    numbers = {
        "RIGID_SLOPE": RIGID_SLOPE,
        "FEW_LAGS": FEW,
        "CUTOFF_GAP": math.inf if bearing.cutoff_gap is None else bearing.cutoff_gap,
        "ROUGHNESS": bearing.roughness or 1.0,
        "MOST_SPEED": float(model.speeds[-1]) * RPM_TO_RAD_S,
        "LARGEST_PLACE": FARTHEST * bearing.ball_diameter,
        "LARGEST_TILT": LARGEST_TILT,
        "DEFAULT_TOLERANCE": ALLOWED_ERROR,
        "ROLLING_RADIUS": rolling_speed_sum(model),
    }
    if five:
        g, at = balls.grooves, counted_from(model)
        counts["RACE_CONTROL"] = g.control
        numbers |= {
            "FREE_RADIAL": g.radial + (0.5 * bearing.clearance if bearing.contact_angle is None else 0.0),
            "FREE_AXIAL": g.axial,
            "INNER_FREE_LENGTH": g.inner,
            "OUTER_FREE_LENGTH": g.outer,
            "GROOVE_CIRCLE": g.groove_circle,
            "GROOVE_RADIUS": g.radius,
            "BALL_DIAMETER": g.ball,
            "PITCH_DIAMETER": g.pitch,
            "BALL_MASS": g.mass,
            "GYROSCOPIC": g.gyroscopic,
            "INNER_SPIN_MOMENT": g.inner_spin_moment,
            "OUTER_SPIN_MOMENT": g.outer_spin_moment,
            "TABLE_COSINE": g.cosine,
            "PLACE_RADIAL": at.place[0, 0],
            "PLACE_AXIAL": at.place[0, 1],
            "ACROSS": at.across[0],
        }
    else:
        planar = bearing._kernel(model.speeds)
        numbers |= {
            "CAGE_RATIO": planar.cage,
            "CENTRIFUGAL_FACTOR": planar.centrifugal_factor,
            "BALL_INERTIA": planar.inertia,
        }
    return (
        {k: str(v) for k, v in counts.items()}
        | {k: c_double(float(v)) for k, v in numbers.items()}
        | dict(CONTACT.macros)
    )


def _inverse(lags: int) -> str:
    """``film_inverse.h`` of `film_filters.c`."""
    values = np.append(0.0, 1.0 / np.arange(1.0, lags + 4.0))
    return f"/* Generated by ehlcontact: 1/k, and 0 for k = 0. */\n{c_table('inverse', values)}\n"


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
