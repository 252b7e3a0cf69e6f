"""Variables of the FMU of a rotor."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fmu.bearing.model import BearingModel
from fmu.bearing.places import rest_states
from fmu.bearing.variables import (
    BEARING_HEADERS,
    FORCES,
    OUTSIDE,
    PARAMETERS,
    RATES,
    bearing_sources,
    bearing_spec,
)
from fmu.contact_spec import checked_name, contact_spec, source_text
from fmu.lead import HELD_PARALLEL, ROTOR, force_lead_for
from fmu.rotor import dampers
from fmu.rotor.laws import shown, tunable
from fmu.rotor.model import RotorModel, Station
from fmu.rotor.tables import rotor_macros, rotor_tables
from fmu.spec import ModelSpec, Variable, VariableList
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.rotor.supports import kind_of

_Floats = NDArray[np.float64]

SOURCES = (
    "core.c", "core_step.c", "model_rotor.c", "rotor.c", "rotor_supports.c", "rotor_rest.c", "rotor_step.c",
    "linear_equations.c",
)  # fmt: skip
HEADERS = "core.h", "model.h", "rotor.h", "support.h", "linear_equations.h"
LEAST_INNER_STEP = 1e-6  # of the default: below it, importers repeat what is refused without end
EXCHANGE_TOLERANCE = 1e-8  # an orbit is some thousandths of the approach; 1e-6 of that is a tenth of it
MOST_INDICATORS = 64  # bits of a number in core.h
FILLED = 0.1  # of the clearance of a damper, a usual vibration


def rotor_spec(model: RotorModel, model_name: str | None = None, force_lead: float | None = None) -> ModelSpec:
    """Specification of the FMU of a rotor.

    Raises
    ------
    InputError
        A name that is empty, too long or not printable, or another lead.
    """
    made = _Variables(model)
    between = force_lead_for(HELD_PARALLEL) if model.out else 0.0
    made.fill(between if force_lead is None else force_lead)
    more = [("bearing_support.c", *bearing_sources(model.bearings)), ("bearing_support.h", *BEARING_HEADERS)]
    more = more if model.bearings else [(), ()]
    if model.dampers:
        more = [(*more[0], *dampers.SOURCES), (*more[1], *dampers.HEADERS)]
    return ModelSpec(
        name=checked_name("Rotor" if model_name is None else model_name),
        description=_description(model),
        sources=(*SOURCES, *more[0]),
        headers=(*HEADERS, *more[1]),
        variables=tuple(made.variables),
        notes=_notes(model, made.specs),
        macros=rotor_macros(model, made),
        tables=rotor_tables(model, made),
        step=model.inner_step if model.inside or not model.bearings_out else 1e-5,
        tolerance=EXCHANGE_TOLERANCE,
        plain_steps=bool(model.bearings),
        indicators=tuple(made.indicators) if len(made.indicators) <= MOST_INDICATORS else (),
        flanges=tuple(made.flanges),
    )


def node_name(name: str) -> str:
    """Name of a node as part of a variable's: letters, digits and underscores."""
    text = re.sub(r"\W", "_", name, flags=re.ASCII)
    return text if text[:1].isalpha() else f"node_{text}"


def force_rows(model: RotorModel) -> _Floats:
    """Where each input force acts, and how, shape (forces, N)."""
    rows = [np.eye(model.rotor.size)[place] for _, _, place in model.points]
    for station in model.out:
        sign = -station.count if station.is_contact else 1.0
        rows += list(sign * station.mount.rows(model.rotor.size))
    return np.array(rows).reshape(-1, model.rotor.size)


class _Variables(VariableList):
    """The variables of a rotor, numbered as they are made, and where those of each kind begin."""

    def __init__(self, model: RotorModel) -> None:
        super().__init__()
        self.model = model
        bearings = iter(model.bearings)
        self.specs = [_spec_of(station, bearings) for station in model.inside]
        self.first: dict[str, int] = {}
        self.outputs_at: list[int] = []  # of each support inside: its first output, validity flag, parameter
        self.outside_at: list[int] = []
        self.settings_at: list[tuple[int, ...]] = []
        self.indicators: list[tuple[str, str]] = []
        self.flanges: list[tuple[str, str, tuple[str, str, str]]] = []
        self.rows = force_rows(model)
        self.states = self._state_names()
        load = float(np.abs(model.rotor.load).max())
        self.force = load if load > 0.0 else 1.0
        self.length, self.rate = self._sizes()

    def fill(self, lead: float) -> None:
        """All of them."""
        self._inputs()
        self._states()
        self._derivatives()
        self._motions()
        self._supports()
        self._parameters(lead)

    # ---- sizes and names

    def _sizes(self) -> tuple[float, float]:
        """Nominal displacement and velocity."""
        model = self.model
        if model.bearings or model.bearings_out:
            return 1e-5, 1e-3
        K = model.rotor.matrices(0.0)[2]
        stiffness = float(np.abs(np.diag(K)).max())
        bend = self.force / stiffness if stiffness > 0.0 else 1e-5
        eccentric = max(
            (abs(u.amount) / float(np.diag(model.rotor.mass).max()) for u in model.rotor.unbalances), default=0.0
        )
        clear = (FILLED * damper.clearance for damper in model.dampers)
        length = max(bend, eccentric, *(element.validity.approach[1] for element in model.elements), *clear, 0.0)
        return length, length * max(model.fastest, model.speed * RPM_TO_RAD_S)

    def _state_names(self) -> dict[int, tuple[str, str]]:
        """Displacement and rate of each degree of freedom: of the first node that names it, else by number."""
        names = {k: (f"q[{k}]", f"velocity[{k}]") for k in range(self.model.rotor.size)}
        for node, direction, place in reversed(self.model.points):
            names[place] = f"{node_name(node)}.{direction}", f"{node_name(node)}.{RATES[direction]}"
        return names

    # ---- inputs

    def _inputs(self) -> None:
        model = self.model
        for node, direction, _ in model.points:
            name = f"{node_name(node)}.{FORCES[direction]}"
            self._force(name, direction, f"on {node}, {direction}, beside the load", 0.0)
        for station in model.out:
            if station.is_contact:
                text = "Force of the contact, positive = repulsive"
                start = float(model.force(station)[0])
                self.add(
                    f"{station.label}.force",
                    "input",
                    "continuous",
                    text,
                    unit="N",
                    start=start,
                    nominal=self.force,
                )
                continue
            for direction, start in zip(station.mount.directions, model.force(station).tolist(), strict=True):
                self._force(
                    f"{station.label}.{FORCES[direction]}", direction, f"of {station.name} on its ring", start
                )
        self.first["FORCES"] = len(self.variables)
        for u, unbalance in enumerate(model.rotor.unbalances, start=1):
            self.add(
                f"unbalance[{u}]", "input", "continuous", "Unbalance: mass times eccentricity",
                unit="kg.m", start=float(unbalance.amount), nominal=1e-4,
            )  # fmt: skip
        self.first["DRIVE"] = len(self.variables)
        self._turning()

    def _force(self, name: str, direction: str, text: str, start: float) -> None:
        tilt = direction.startswith("tilt")
        self.add(
            name, "input", "continuous", f"{'Moment' if tilt else 'Force'} {text}",
            unit="N.m" if tilt else "N", start=start, nominal=1.0 if tilt else self.force,
        )  # fmt: skip

    def _turning(self) -> None:
        model, start = self.model, self.model.speed * RPM_TO_RAD_S
        if model.inertia is None:
            rate = "angular_acceleration"
            text = "Speed of the shaft about z, reached at the end of a step"
            if model.elements:
                text += "; films of contacts inside stay those of the speed that they were made for"
            self.add(
                "speed", "input", "continuous", text, unit="rad/s", start=start, nominal=100.0, rate=rate,
                minimum=0.0 if model.bearings else None,
            )  # fmt: skip
            text = (
                "Rate of the speed, for the tangential force of unbalances in model exchange; steps have their own"
            )
            self.add(rate, "input", "continuous", text, unit="rad/s2", start=0.0, nominal=100.0)
            return
        text = "Torque of the motor about z"
        self.add("torque", "input", "continuous", text, unit="N.m", start=0.0, nominal=1.0)
        for station in model.bearings_out:
            text = f"Torque that {station.name} takes from the shaft, against its turning"
            self.add(
                f"{station.label}.rolling_torque", "input", "continuous", text,
                unit="N.m", start=0.0, nominal=1e-2,
            )  # fmt: skip

    # ---- states and derivatives

    def _states(self) -> None:
        self.first["MOTION"] = len(self.variables)
        places = {k: (node, direction) for node, direction, k in reversed(self.model.points)}
        for moving, starts in enumerate(self.model.motion):
            for k, start in enumerate(starts.tolist()):
                node, direction = places.get(k, (f"degree of freedom {k}", ""))
                tilt = direction.startswith("tilt")
                unit, nominal = ("rad", 10.0 * self.length) if tilt else ("m", self.length)
                name = self.states[k][moving]
                self.add(
                    name, "output" if k in places else "local", "continuous",
                    f"{'Rate' if moving else 'Displacement'} of {node}, {direction}".rstrip(", "),
                    unit=f"{unit}/s" if moving else unit, start=start,
                    nominal=nominal * (self.rate / self.length if moving else 1.0),
                    depends=(name,) if k in places else (),
                )  # fmt: skip
        text = "Angle of the shaft about z, from x towards y"
        self.add("angle", "output", "continuous", text, unit="rad", start=0.0, nominal=1.0, depends=("angle",))
        if self.model.inertia is not None:
            self.add(
                "speed", "output", "continuous", "Speed of the shaft about z", unit="rad/s",
                start=self.model.speed * RPM_TO_RAD_S, nominal=100.0, depends=("speed",),
                minimum=0.0 if self.model.bearings else None,
            )  # fmt: skip
        for station, spec in zip(self.model.inside, self.specs, strict=True):
            guesses = self._guesses(station, spec)
            for state in spec.states:
                follows = tuple(self._start_names(station, spec, state)) if state.start is None else ()
                text = f"{state.description} ({station.name})"
                self.add(
                    f"{station.label}.{state.name}", "local", "continuous", text,
                    unit=state.unit, start=state.start, nominal=state.nominal, follows=follows,
                    guess=guesses.get(state.name),
                )  # fmt: skip

    def _guesses(self, station: Station, spec: ModelSpec) -> dict[str, float | None]:
        """States of a bearing at rest, by name, where the rotor starts; of a contact they have start values."""
        if not station.is_bearing:
            return {}
        bearing = self.model.bearings[self.model.bearings_inside.index(station)]
        states = rest_states(bearing, self.model.speed, station.mount.cage_angle, self.model.ring(station))
        return {state.name: value for state, value in zip(spec.states, states, strict=True)}

    def _start_names(self, station: Station, spec: ModelSpec, state: Variable) -> list[str]:
        """Parameters of a support that a state at the start follows; the place of the rotor does too."""
        known = {one.name for one in tunable(spec)}
        return [f"{station.label}.{name}" for name in state.follows if name in known]

    def _derivatives(self) -> None:
        model = self.model
        size = model.rotor.size
        pattern, applied = self._pattern()
        films = self._film_names()
        turning = ("speed", "angular_acceleration") if model.inertia is None else ("speed", "torque")
        drags = tuple(f"{station.label}.rolling_torque" for station in model.bearings_out) * (
            model.inertia is not None
        )
        everything = tuple(name for pair in self.states.values() for name in pair)
        for k in range(size):
            self.derivative(self.states[k][0], self._unit(k, 1), (self.states[k][1],))
        for k in range(size):
            moved = tuple(name for i in np.flatnonzero(pattern[k]) for name in self.states[int(i)])
            spun = model.inertia is not None and bool(model.rotor.unbalances)
            depends = (*(everything if spun else moved), *applied[k])
            if spun or self._is_turned(k):
                depends += (
                    "angle",
                    *turning,
                    *drags,
                    *(f"unbalance[{u + 1}]" for u in range(len(model.rotor.unbalances))),
                )
            elif model.rotor.gyroscopic[k].any():
                depends += ("speed",)
            reached = self._reached(k)
            depends += tuple(name for i, names in enumerate(films) if spun or reached[i] for name in names)
            if spun:
                depends += tuple(v.name for v in self.variables if v.causality == "input")
            self.derivative(self.states[k][1], self._unit(k, 2), tuple(dict.fromkeys(depends)))
        self.derivative("angle", "rad/s", ("speed",))
        if model.inertia is not None:
            inputs = tuple(v.name for v in self.variables if v.causality == "input")
            depends = (*everything, "angle", "speed", *inputs, *(name for names in films for name in names))
            self.derivative("speed", "rad/s2", tuple(dict.fromkeys(depends)))
        for station, spec in zip(model.inside, self.specs, strict=True):
            for rate in spec.derivatives:
                depends = self._of_support(station, spec, rate.depends)
                self.derivative(f"{station.label}.{rate.derivative_of}", rate.unit, depends)

    def _unit(self, k: int, order: int) -> str:
        name = self.states[k][0]
        angular = name.rpartition(".")[2].startswith("tilt")
        return {1: "rad/s" if angular else "m/s", 2: "rad/s2" if angular else "m/s2"}[order]

    def _pattern(self) -> tuple[NDArray[np.bool_], list[tuple[str, ...]]]:
        """Which displacements, and which input forces, each acceleration depends on."""
        model = self.model
        M, C, K = model.rotor.matrices(1.0)
        rows = [station.mount.rows(model.rotor.size) for station in model.inside]
        coupled = (C != 0.0) | (K != 0.0)
        for row in rows:
            at = (row != 0.0).astype(float)
            coupled |= (at.T @ np.ones((len(at), len(at))) @ at) > 0.0
        inverse = (np.abs(np.linalg.inv(M)) > 1e-14 * np.abs(np.linalg.inv(M)).max()).astype(float)
        pattern = (inverse @ coupled.astype(float)) > 0.0
        names: list[list[str]] = [[] for _ in range(model.rotor.size)]
        for name, row in zip((v.name for v in self.variables), self.rows, strict=False):
            for k in np.flatnonzero(inverse @ (row != 0.0)):
                names[int(k)].append(name)
        return pattern, [tuple(one) for one in names]

    def _is_turned(self, k: int) -> bool:
        inverse = np.linalg.inv(self.model.rotor.mass)[k]
        return any(
            place is not None and inverse[place] != 0.0
            for u in self.model.rotor.unbalances
            for place in (u.x, u.y)
        )

    def _film_names(self) -> list[tuple[str, ...]]:
        return [
            tuple(f"{station.label}.{state.name}" for state in spec.states) + tuple(self._speed_of(station))
            for station, spec in zip(self.model.inside, self.specs, strict=True)
        ]

    @staticmethod
    def _speed_of(station: Station) -> tuple[str, ...]:
        return ("speed",) if station.is_bearing else ()

    def _reached(self, k: int) -> list[bool]:
        """Whether the force of each support inside accelerates a degree of freedom."""
        inverse = np.linalg.inv(self.model.rotor.mass)[k]
        return [bool((station.mount.rows(self.model.rotor.size) @ inverse).any()) for station in self.model.inside]

    def _of_support(self, station: Station, spec: ModelSpec, depends: tuple[str, ...]) -> tuple[str, ...]:
        """Names of what a variable of a support depends on, as the rotor has them."""
        rows = station.mount.rows(self.model.rotor.size)
        motion: dict[str, tuple[str, ...]] = {"speed": ("speed",)}
        directions = ("approach",) if station.is_contact else station.mount.directions
        rates = {"approach": "rate"} | RATES
        for direction, row in zip(directions, rows, strict=True):
            at = np.flatnonzero(row)
            motion[direction] = tuple(self.states[int(i)][0] for i in at)
            motion[rates[direction]] = tuple(self.states[int(i)][1] for i in at)
        states = {state.name for state in spec.states}
        names = [
            name
            for one in depends
            for name in motion.get(one, (f"{station.label}.{one}",) if one in states else ())
        ]
        return tuple(dict.fromkeys(names))

    # ---- outputs

    def _motions(self) -> None:
        """Motions of the supports, inside before outside, and their rates."""
        stations = (*self.model.inside, *self.model.out)
        for moving in (False, True):
            self.first["RATE" if moving else "PLACE"] = len(self.variables)
            for station in stations:
                rows = station.mount.rows(self.model.rotor.size)
                names = ("approach",) if station.is_contact else station.mount.directions
                for direction, row in zip(names, rows, strict=True):
                    self._motion(station, direction, row, moving)
        for station in self.model.out:
            for direction in ("approach",) if station.is_contact else station.mount.directions:
                rate, force = ("rate", "force") if station.is_contact else (RATES[direction], FORCES[direction])
                label = station.label
                self.flanges.append(
                    (
                        f"{label}_{direction}".replace("[", "_").replace("]", ""),
                        f"{station.name}, {direction}: motion and rate out, force in",
                        (f"{label}.{direction}", f"{label}.{rate}", f"{label}.{force}"),
                    )
                )
        for node, direction, _ in self.model.points:
            name = node_name(node)
            self.flanges.append(
                (
                    f"{name}_{direction}",
                    f"{name} along {direction}: displacement and rate out, force in",
                    (
                        self.states_of(node, direction)[0],
                        self.states_of(node, direction)[1],
                        f"{name}.{FORCES[direction]}",
                    ),
                )
            )

    def states_of(self, node: str, direction: str) -> tuple[str, str]:
        """States of a named degree of freedom."""
        return self.states[self.model.rotor.nodes[node][direction]]

    def _motion(self, station: Station, direction: str, row: _Floats, moving: bool) -> None:
        tilt = direction.startswith("tilt")
        unit, nominal = ("rad", 10.0 * self.length) if tilt else ("m", self.length)
        rate = "rate" if direction == "approach" else RATES[direction]
        self.add(
            f"{station.label}.{rate if moving else direction}", "output", "continuous",
            f"{'Rate' if moving else 'Displacement'} of {station.name}, {direction}",
            unit=f"{unit}/s" if moving else unit,
            nominal=nominal * (self.rate / self.length if moving else 1.0),
            depends=tuple(self.states[int(k)][moving] for k in np.flatnonzero(row)),
        )  # fmt: skip

    def _supports(self) -> None:
        model = self.model
        for station, spec in zip(model.inside, self.specs, strict=True):
            self.outputs_at.append(len(self.variables))
            for output in shown(spec):
                if output.name == OUTSIDE:
                    self.outside_at.append(len(self.variables))
                depends = self._of_support(station, spec, output.depends)
                self.variables.append(
                    replace(
                        output,
                        name=f"{station.label}.{output.name}",
                        value_reference=len(self.variables),
                        causality="output",
                        description=f"{output.description} ({station.name})",
                        depends=depends,
                    )
                )
            self.indicators += [
                (f"{station.label}.{name}", self._like(station, like)) for name, like in spec.indicators
            ]
        if model.inside:
            text = "True where a support inside is outside the box of its data or tables"
            depends = tuple(
                dict.fromkeys(
                    name
                    for station, spec in zip(model.inside, self.specs, strict=True)
                    for output in shown(spec)
                    if output.name == OUTSIDE
                    for name in self._of_support(station, spec, output.depends)
                )
            )
            self.add(OUTSIDE, "output", "discrete", text, type="Boolean", depends=depends)

    @staticmethod
    def _like(station: Station, like: str) -> str:
        """A variable of the rotor that depends on the same as that of a support."""
        name = like.removeprefix("der(").removesuffix(")")
        return f"der({station.label}.{name})" if like.startswith("der(") else f"{station.label}.{name}"

    def _parameters(self, lead: float) -> None:
        model = self.model
        self.lead(ROTOR, lead)
        self.add(
            "inner_step", "parameter", "fixed", "Longest step inside one of co-simulation, which is cut evenly",
            unit="s", start=model.inner_step, minimum=LEAST_INNER_STEP * model.inner_step,
        )  # fmt: skip
        self.first["PARAMETER"] = len(self.variables)
        for own in model.parameters:
            more: dict[str, Any] = {} if own.signed else {"minimum": 0.0}
            self.add(own.name, "parameter", "fixed", own.text, unit=own.unit, start=own.value, **more)
        if model.inertia is not None:
            self.add(
                "inertia", "parameter", "fixed", "Polar moment of inertia of all that turns",
                unit="kg.m2", start=float(model.inertia), minimum=0.0,
            )  # fmt: skip
        for station, spec in zip(model.inside, self.specs, strict=True):
            at = dict.fromkeys(PARAMETERS, -1)
            for one in tunable(spec):
                at[one.name] = len(self.variables)
                start = station.mount.cage_angle if one.name == "cage_angle_start" else one.start
                self.add(
                    f"{station.label}.{one.name}", "parameter", "fixed", one.description,
                    unit=one.unit, start=start, minimum=one.minimum, maximum=one.maximum,
                )  # fmt: skip
            self.settings_at.append(tuple(at.values()))


def _spec_of(station: Station, bearings: Iterator[BearingModel]) -> ModelSpec:
    """Variables of a support inside; `bearings` has the model of the next ball bearing."""
    if station.is_contact:
        return contact_spec(station.mount.contact)
    return dampers.damper_spec(station.mount.damper) if station.is_damper else bearing_spec(next(bearings))


def _description(model: RotorModel) -> str:
    contacts, bearings, films = (
        sum(station.kind == kind for station in model.inside) for kind in ("contact", "bearing", "damper")
    )
    words = [
        *([f"{contacts} contact{'s' * (contacts != 1)} inside"] if contacts else []),
        *([f"{bearings} ball bearing{'s' * (bearings != 1)} inside"] if bearings else []),
        *([f"{films} squeeze film damper{'s' * (films != 1)} inside"] if films else []),
        *([f"{len(model.out)} support{'s' * (len(model.out) != 1)} outside"] if model.out else []),
    ]
    name = f"Rotor of {model.rotor.size} degrees of freedom"
    left_out = [
        (station.name, one.damping_left_out)
        for station, one in zip(model.bearings_inside, model.bearings, strict=True)
    ]
    more = "".join(f"; {name}: {said}" for name, said in left_out if said)
    return f"{name}, {', '.join(words)}; SI units{source_text(model.elements)}{more}"


def _notes(model: RotorModel, specs: list[ModelSpec]) -> tuple[tuple[str, str], ...]:
    turns = "its speed is an input" if model.inertia is None else "the torque of its motor decides on its speed"
    lines = [("Rotor", f"{model.rotor.size} degrees of freedom; turns about z, from x towards y; {turns}")]
    for station in model.stations:
        if station.is_contact:
            angle = math.degrees(station.mount.angle)
            text = f"approach = n . q + offset, n at {angle:g} degrees, offset {station.shift[0]:g} m"
            text += f", {station.count:g} times" if station.count > 1 else ""
        else:
            text = f"{kind_of(station.mount.bearing)}, {', '.join(station.mount.directions)}"
        lines.append((station.label, f"{text}; {'inside' if station.inside else 'outside'}"))
    for station, spec in zip(model.inside, specs, strict=True):
        lines += [(f"{station.label}: {label}", text) for label, text in spec.notes]
    return tuple(lines)
