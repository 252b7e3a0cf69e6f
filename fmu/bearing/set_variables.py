"""Variables of the FMU of a set of bearings: those of each bearing under its label, and forces on the shaft."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np

from fmu.bearing.model import Seat
from fmu.bearing.places import rest_states
from fmu.bearing.set_model import OUTER_RING, SetModel
from fmu.bearing.tables import SeatPlaces, bearing_data, bearing_macros
from fmu.bearing.trial import START
from fmu.bearing.variables import (
    BEARING_HEADERS,
    MOTIONS,
    OUTER_RINGS,
    OUTSIDE,
    PARAMETERS,
    RATES,
    STEP,
    RingVariables,
    bearing_sources,
    bearing_spec,
    flanges_of,
)
from fmu.c_headers import c_double
from fmu.contact_spec import checked_name
from fmu.contact_variables import ALLOWED_ERROR
from fmu.lead import CONTACT, HELD_PARALLEL
from fmu.spec import ModelSpec, Variable

MOST_INDICATORS = 64  # bits of a number in core.h
SHAFT = "the shaft at 0 {}"


def set_spec(model: SetModel, model_name: str | None = None, lead: float | None = None) -> ModelSpec:
    """Specification of the FMU of a set of bearings whose shaft is moved from outside.

    Raises
    ------
    InputError
        A name that is empty, too long or not printable, or another lead.
    """
    made = _SetVariables(model)
    made.fill(HELD_PARALLEL if lead is None else lead)
    bearings = model.bearings
    speeds = model.speeds
    span = f"{speeds[-1]:.6g} rev/min" if speeds.size == 1 else f"{speeds[0]:.6g} to {speeds[-1]:.6g} rev/min"
    left_out = f"; {model.damping_left_out}" if model.damping_left_out else ""
    title = f"set {bearings.name}".strip()
    macros = bearing_macros(
        model.seats, [len(spec.states) for spec in made.specs], len(model.directions), made.first_force
    )
    return ModelSpec(
        name=checked_name(f"BearingSet {bearings.name}".strip() if model_name is None else model_name),
        description=f"{title.capitalize()} of {len(model.seats)} ball bearings at {span}; SI units{left_out}",
        sources=(
            "core.c",
            "core_step.c",
            "model_bearing.c",
            *bearing_sources([seat.model for seat in model.seats]),
        ),
        headers=("core.h", "model.h", *BEARING_HEADERS),
        variables=tuple(made.variables),
        notes=_notes(model, made.specs),
        macros=macros | {"DEFAULT_TOLERANCE": c_double(ALLOWED_ERROR)} | dict(CONTACT.macros),
        tables={"bearing_data.h": bearing_data(model.seats, made.places, model.constant_force)},
        step=STEP,
        plain_steps=True,
        indicators=tuple(made.indicators) if len(made.indicators) <= MOST_INDICATORS else (),
        flanges=flanges_of(model.directions, "The shaft"),
    )


class _SetVariables(RingVariables):
    """The variables of a set, numbered as they are made; those of a bearing are those of its own FMU."""

    def __init__(self, model: SetModel) -> None:
        super().__init__()
        self.model = model
        specs = {id(seat.model): bearing_spec(seat.model) for seat in model.seats}
        self.specs = [specs[id(seat.model)] for seat in model.seats]
        self.rows = list(zip(model.seats, self.specs, strict=True))
        self.first_force = 0
        self.first: dict[str, list[int]] = {"output": [], "flags": [], "state": [], "ball": []}
        self.settings: list[tuple[int, ...]] = []
        self.indicators: list[tuple[str, str]] = []

    def fill(self, lead: float) -> None:
        """All of them."""
        self.motions(self.model, SHAFT)
        self._sums()
        self._outputs()
        self._states()
        for seat, spec in self.rows:
            for rate in spec.derivatives:
                assert rate.derivative_of is not None
                depends = self._names(seat, spec, rate.depends)
                self.derivative(f"{seat.label}{rate.derivative_of}", rate.unit, depends)
        self.lead(CONTACT, lead)
        self._parameters()
        self._balls()

    @property
    def places(self) -> list[SeatPlaces]:
        """Where the variables of each bearing are."""
        rows = zip(*self.first.values(), self.settings, strict=True)
        return [SeatPlaces(*row) for row in rows]

    @cached_property
    def _moving(self) -> tuple[str, ...]:
        return tuple(v.name for v in self.variables if v.causality == "input")

    def _names(self, seat: Seat, spec: ModelSpec, depends: tuple[str, ...]) -> tuple[str, ...]:
        """Names of what a variable of a bearing depends on, as the set has them."""
        motion: dict[str, tuple[str, ...]] = {"speed": ("speed",)}
        for name, row in zip(seat.model.directions, seat.rows, strict=True):
            given = [self.model.directions[k] for k in np.flatnonzero(row)]
            motion[name] = tuple(given)
            motion[RATES[name]] = tuple(RATES[each] for each in given)
        names = (each for name in depends for each in motion.get(name, (f"{seat.label}{name}",)))
        return tuple(dict.fromkeys(names))

    def _named(self, seat: Seat, spec: ModelSpec, variable: Variable) -> Variable:
        """A variable of a bearing as the set has it, the next in number."""
        return replace(
            variable,
            name=f"{seat.label}{variable.name}",
            value_reference=len(self.variables),
            description=f"{variable.description} ({seat.label.rstrip('.')})",
            depends=self._names(seat, spec, variable.depends),
            follows=self._names(seat, spec, variable.follows),
        )

    def _sums(self) -> None:
        """Forces on the shaft, and whether any bearing is outside its tables."""
        self.first_force = len(self.variables)
        for name in self.model.directions:
            own = MOTIONS[name]
            what = OUTER_RINGS if name == OUTER_RING else SHAFT
            depends = [
                self._names(seat, spec, spec[MOTIONS[direction].force].depends)
                for seat, spec in self.rows
                for direction, row in zip(seat.model.directions, seat.rows, strict=True)
                if row[self.model.directions.index(name)] != 0.0
            ]
            self.add(
                own.force, "output", "continuous", f"{own.effort} on {what.format(own.where)}",
                unit=own.force_unit, nominal=own.force_nominal,
                depends=tuple(dict.fromkeys(each for names in depends for each in names)),
            )  # fmt: skip
        flags = [self._names(seat, spec, spec[OUTSIDE].depends) for seat, spec in self.rows]
        self.add(
            OUTSIDE, "output", "discrete", "True where speed or loads leave the tables of a bearing",
            type="Boolean", depends=tuple(dict.fromkeys(each for names in flags for each in names)),
        )  # fmt: skip

    def _outputs(self) -> None:
        for seat, spec in self.rows:
            self.first["output"].append(len(self.variables))
            states = {state.name for state in spec.states}
            for output in spec.outputs:
                if output.name in states:
                    continue
                if output.name == OUTSIDE:
                    self.first["flags"].append(len(self.variables))
                self.variables.append(self._named(seat, spec, output))

    def _states(self) -> None:
        speed = float(self.model.speeds[-1])
        for seat, spec in self.rows:
            self.first["state"].append(len(self.variables))
            at_rest = rest_states(seat.model, speed, START, seat.ring(self.model.place))
            for state, guess in zip(spec.states, at_rest, strict=True):
                self.variables.append(replace(self._named(seat, spec, state), guess=guess))
            self.indicators += [(f"{seat.label}{name}", _like(seat, like)) for name, like in spec.indicators]

    def _parameters(self) -> None:
        for seat, spec in self.rows:
            at, known = dict.fromkeys(PARAMETERS, -1), {variable.name for variable in spec.variables}
            shift = dict(zip(seat.model.directions, seat.shift.tolist(), strict=True))
            for name in PARAMETERS:
                if name in known:
                    at[name] = len(self.variables)
                    own = self._named(seat, spec, spec[name])
                    self.variables.append(replace(own, start=shift["z"]) if name == "offset" else own)
            self.settings.append(tuple(at.values()))

    def _balls(self) -> None:
        for seat, spec in self.rows:
            self.first["ball"].append(len(self.variables))
            for variable in spec.variables[spec.derivatives[-1].value_reference + 1 :]:
                self.variables.append(self._named(seat, spec, variable))


def _like(seat: Seat, like: str) -> str:
    """A variable of the set that depends on what that of a bearing does."""
    name = like.removeprefix("der(").removesuffix(")")
    return f"der({seat.label}{name})" if like.startswith("der(") else f"{seat.label}{name}"


def _notes(model: SetModel, specs: list[ModelSpec]) -> tuple[tuple[str, str], ...]:
    bearings = model.bearings
    lines = [("Shaft", "rigid, without mass; its motion at 0 is given, forces and moments there are outputs")]
    if model.rotor.size > len(MOTIONS) - 1:
        lines.append(
            ("Spring", f"{bearings.spring:.6g} N on the outer rings of bearings that face {bearings.sprung}")
        )
    rows = zip(model.seats, bearings.facings, bearings.positions, bearings.offsets, strict=True)
    for (seat, facing, position, offset), spec in zip(rows, specs, strict=True):
        label = seat.label.rstrip(".")
        lines.append((label, f"faces {facing}, at {position:g} m, offset {offset:g} m along its facing"))
        lines += [(f"{label}: {name}", text) for name, text in spec.notes]
    return tuple(lines)
