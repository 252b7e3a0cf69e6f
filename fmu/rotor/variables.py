"""Variables, C tables and bearings of the FMU of a rotor with its ball bearings."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fmu.bearing.tables import bearing_table, state_size, work_size
from fmu.bearing.variables import BEARING_HEADERS, BEARING_SOURCES, FORCES, RATES, bearing_spec
from fmu.c_headers import c_double, c_table
from fmu.contact_spec import checked_name
from fmu.contact_variables import ALLOWED_ERROR
from fmu.lead import ROTOR
from fmu.rotor.model import RotorModel
from fmu.shaft.variables import SCALES, node_name
from fmu.spec import ModelSpec, Variable, VariableList
from reduced_models.bearing.kinematics import RPM_TO_RAD_S

LEAST_INNER_STEP = 1e-3  # of the default
SHOWN = (
    "force_",
    "moment_",
    "largest_",
    "smallest_",
    "rolling_",
    "outside_",
)  # outputs of a bearing that the rotor has
PARAMETERS = ("clearance", "offset", "cage_angle_start", "film")  # `BearingSettings`, in that order
ALL = "outside_validity"


def rotor_spec(model: RotorModel, model_name: str | None = None, force_lead: float | None = None) -> ModelSpec:
    """Specification of the FMU of a rotor with its ball bearings.

    Raises
    ------
    InputError
        A name that is empty, too long or not printable, or another lead.
    """
    specs = [bearing_spec(bearing) for bearing in model.bearings]
    made = _Variables(model, specs)
    made.fill(0.0 if force_lead is None else force_lead)
    laws = _laws(model, made)
    return ModelSpec(
        name=checked_name("Rotor" if model_name is None else model_name),
        description=f"Rotor of {model.rotor.size} degrees of freedom on {len(specs)} ball bearings; SI units"
        + _left_out(model),
        sources=("core.c", "core_step.c", "model_whole_rotor.c", "linear_equations.c", *BEARING_SOURCES),
        headers=("core.h", "model.h", "linear_equations.h", *BEARING_HEADERS),
        variables=tuple(made.variables),
        notes=_notes(model, specs),
        macros=_macros(model, made, specs),
        tables={"rotor_data.h": _data(model), **laws},
        step=model.inner_step,
        exchange=False,
        indicators=(),
        flanges=tuple(
            (
                f"{node}_{name}",
                f"{node} along {name}: displacement and rate out, force in",
                (f"{node}.{name}", f"{node}.{RATES[name]}", f"{node}.{FORCES[name]}"),
            )
            for node, name, _ in _points(model)
        ),
    )


def _left_out(model: RotorModel) -> str:
    """Damping below zero of starved bearings, in words."""
    words = [(b, bearing.damping_left_out) for b, bearing in enumerate(model.bearings, start=1)]
    return "".join(f"; bearing {b}: {said}" for b, said in words if said)


def _points(model: RotorModel) -> Iterator[tuple[str, str, int]]:
    for node, name, place in model.shaft.points:
        yield node_name(node), name, place


class _Variables(VariableList):
    """The variables of a rotor, numbered as they are made."""

    def __init__(self, model: RotorModel, specs: list[ModelSpec]) -> None:
        super().__init__()
        self.model, self.specs = model, specs
        self.first: dict[str, int] = {}
        self.shown_at: list[int] = []  # first output of each bearing
        self.outside_at: list[int] = []
        self.settings_at: list[tuple[int, ...]] = []  # of `PARAMETERS` of each bearing, -1 for none
        self.points = tuple(_points(model))

    def fill(self, lead: float) -> None:
        """All of them."""
        self._inputs()
        for moving in (False, True):
            self._motions(moving)
        self._bearings()
        self._parameters(lead)

    def _inputs(self) -> None:
        model = self.model
        for node, name, _ in self.points:
            tilt = name.startswith("tilt")
            text = f"{'Moment' if tilt else 'Force'} on {node}, {name}, beside the load"
            self.add(
                f"{node}.{FORCES[name]}", "input", "continuous", text,
                unit="N.m" if tilt else "N", start=0.0, nominal=1.0 if tilt else 100.0,
            )  # fmt: skip
        self.first["UNBALANCE"] = len(self.variables)
        for u, unbalance in enumerate(model.rotor.unbalances, start=1):
            self.add(
                f"unbalance[{u}]", "input", "continuous", "Unbalance: mass times eccentricity",
                unit="kg.m", start=float(unbalance.amount), nominal=1e-4,
            )  # fmt: skip
        self.first["DRIVE"] = len(self.variables)
        if model.inertia is None:
            self.add(
                "speed", "input", "continuous", "Speed of the shaft about z, reached at the end of a step",
                unit="rad/s", start=model.shaft.speed_rpm * RPM_TO_RAD_S, nominal=100.0, minimum=0.0,
            )  # fmt: skip
        else:
            text = "Torque of the motor about z"
            self.add("torque", "input", "continuous", text, unit="N.m", start=0.0, nominal=1.0)

    def _motions(self, moving: bool) -> None:
        rings = [
            (f"bearing[{b}]", name) for b, mount in enumerate(self.model.stations, 1) for name in mount.directions
        ]
        self.first["VELOCITY" if moving else "PLACE"] = len(self.variables)
        for what, name in [*((node, name) for node, name, _ in self.points), *rings]:
            unit, nominal = ("rad", 1e-4) if name.startswith("tilt") else ("m", 1e-5)
            self.add(
                f"{what}.{RATES[name] if moving else name}", "output", "continuous",
                f"{'Rate' if moving else 'Displacement'} of {what}, {name}",
                unit=f"{unit}/s" if moving else unit, nominal=100.0 * nominal if moving else nominal,
            )  # fmt: skip

    def _bearings(self) -> None:
        for b, spec in enumerate(self.specs, start=1):
            self.shown_at.append(len(self.variables))
            for one in _shown(spec):
                if one.name == ALL:
                    self.outside_at.append(len(self.variables))
                self.add(
                    f"bearing[{b}].{one.name}", "output", one.variability, one.description,
                    type=one.type, unit=one.unit, nominal=one.nominal, minimum=one.minimum,
                )  # fmt: skip
        self.add("angle", "output", "continuous", "Angle of the shaft about z", unit="rad", nominal=1.0)
        if self.model.inertia is not None:
            self.add(
                "speed", "output", "continuous", "Speed of the shaft about z", unit="rad/s", nominal=100.0,
                depends=("speed_start",),
            )  # fmt: skip
        self.add(ALL, "output", "discrete", "True where a bearing is outside its tables", type="Boolean")

    def _parameters(self, lead: float) -> None:
        model = self.model
        self.lead(ROTOR, lead)
        self.add(
            "inner_step", "parameter", "fixed", "Longest step inside one of co-simulation, which is cut evenly",
            unit="s", start=model.inner_step, minimum=LEAST_INNER_STEP * model.inner_step,
        )  # fmt: skip
        for name, text in SCALES.items():
            self.add(name, "parameter", "fixed", text, unit="1", start=1.0, minimum=0.0)
        if model.inertia is not None:
            self.add(
                "inertia", "parameter", "fixed", "Polar moment of inertia of all that turns, times mass_scale",
                unit="kg.m2", start=float(model.inertia), minimum=0.0,
            )  # fmt: skip
            self.add(
                "speed_start", "parameter", "fixed", "Speed of the shaft at the start",
                unit="rad/s", start=model.shaft.speed_rpm * RPM_TO_RAD_S, minimum=0.0,
            )  # fmt: skip
        for b, (mount, spec) in enumerate(zip(model.stations, self.specs, strict=True), start=1):
            at = dict.fromkeys(PARAMETERS, -1)
            for one in _parameters(spec):
                name = one.name
                at[name] = len(self.variables)
                start = mount.cage_angle if name == "cage_angle_start" else one.start
                self.add(
                    f"bearing[{b}].{name}", "parameter", "fixed", one.description,
                    unit=one.unit, start=start, minimum=one.minimum, maximum=one.maximum,
                )  # fmt: skip
            self.settings_at.append(tuple(at.values()))


def _shown(spec: ModelSpec) -> list[Variable]:
    return [one for one in spec.outputs if one.name.startswith(SHOWN)]


def _parameters(spec: ModelSpec) -> list[Variable]:
    return [one for one in spec.variables if one.name in PARAMETERS]


def _laws(model: RotorModel, made: _Variables) -> dict[str, str]:
    """``rotor_laws.h``: the bearings that differ, which is where, and where its numbers stand."""
    texts: dict[str, str] = {}
    names = []
    for bearing in model.bearings:
        text = bearing_table(bearing, "NAME")
        names.append(texts.setdefault(text, f"bearing_{len(texts) + 1}"))
    tables = {
        "law_numbers": np.cumsum([0, *(state_size(bearing) for bearing in model.bearings)]).tolist()[:-1],
        "law_work": np.cumsum([0, *(work_size(bearing) for bearing in model.bearings)]).tolist()[:-1],
        "law_shown_at": made.shown_at,
        "law_outside": made.outside_at,
    }
    settings = ", ".join(f"{{{', '.join(map(str, row))}}}" for row in made.settings_at)
    lines = [
        "/* Generated by ehlcontact: the bearings, where their numbers and their outputs stand. */",
        *(text.replace("NAME", name) for text, name in texts.items()),
        f"static const Bearing *const law_of[BEARINGS] = {{{', '.join(f'&{name}' for name in names)}}};",
        *(f"static const int {name}[BEARINGS] = {{{', '.join(map(str, at))}}};" for name, at in tables.items()),
        f"static const int law_settings[BEARINGS][{len(PARAMETERS)}] = {{{settings}}};",
        "",
    ]
    return {"rotor_laws.h": "\n".join(lines)}


def _data(model: RotorModel) -> str:
    rotor = model.rotor
    M, C, K = rotor.matrices(0.0)
    points, ties, _ = rotor.geometry
    q, _ = model.shaft.motion
    phases = [unbalance.phase for unbalance in rotor.unbalances] or [0.0]
    at = [(u.x, u.y) for u in rotor.unbalances] or [(None, None)]
    tables = {
        "mass_matrix": M,
        "mass_inverse": np.linalg.inv(M),
        "damping_matrix": C,
        "gyroscopic_matrix": rotor.gyroscopic,
        "stiffness_matrix": K,
        "load": rotor.load,
        "points": points,
        "ties": ties,
        "ring_shift": model.shaft.shifts[: len(ties)],
        "rest": q,
        "unbalance_phase": np.array(phases),
    }
    pairs = ", ".join("{" + ", ".join("-1" if k is None else str(k) for k in pair) + "}" for pair in at)
    shown = ", ".join(str(place) for _, _, place in model.shaft.points) or "0"
    lines = [
        "/* Generated by ehlcontact: matrices, points at which bearings act, and the place at rest. */",
        *(c_table(*one) for one in tables.items()),
        f"static const int unbalance_at[][2] = {{{pairs}}};",
        f"static const int shown[] = {{{shown}}};",
        "",
    ]
    return "\n".join(lines)


def _macros(model: RotorModel, made: _Variables, specs: list[ModelSpec]) -> dict[str, str]:
    size, (points, ties, _) = model.rotor.size, model.rotor.geometry
    counts = {
        "FREEDOMS": size,
        "POINTS": len(points),
        "MOTIONS": len(ties),
        "BEARINGS": len(specs),
        "SHOWN": len(made.points),
        "UNBALANCES": len(model.rotor.unbalances),
        "HAS_TORQUE": int(model.inertia is not None),
        "REACHED": made.first["DRIVE"] if model.inertia is None else "(-1)",
        "HAS_GYROSCOPIC": int(model.rotor.gyroscopic.any()),
        "LAW_WORK": sum(work_size(bearing) for bearing in model.bearings),
        "MOST_BALLS": max(bearing.bearing.balls for bearing in model.bearings),
        "N_CACHE": 4 * size + 4 * len(points) + 8 + sum(state_size(bearing) for bearing in model.bearings),
        **{f"FIRST_{name}": at for name, at in made.first.items()},
    }
    numbers = {"DEFAULT_TOLERANCE": ALLOWED_ERROR, "LEAST_INNER_STEP": LEAST_INNER_STEP * model.inner_step}
    return (
        {k: str(v) for k, v in counts.items()} | {k: c_double(v) for k, v in numbers.items()} | dict(ROTOR.macros)
    )


def _notes(model: RotorModel, specs: list[ModelSpec]) -> tuple[tuple[str, str], ...]:
    turns = "its speed is an input" if model.inertia is None else "the torque of its motor decides on its speed"
    lines = [("Rotor", f"{model.rotor.size} degrees of freedom; turns about z, from x towards y; {turns}")]
    for b, spec in enumerate(specs, start=1):
        lines += [(f"Bearing {b}: {label}", text) for label, text in spec.notes]
    return tuple(lines)
