"""Variables and C tables of the FMU of a shaft."""

from __future__ import annotations

import re

import numpy as np

from fmu.bearing.variables import FORCES, RATES
from fmu.c_headers import c_double, c_table
from fmu.contact_spec import checked_name
from fmu.contact_variables import ALLOWED_ERROR
from fmu.lead import HELD_PARALLEL, ROTOR, force_lead_for
from fmu.shaft.model import ShaftModel
from fmu.spec import ModelSpec, VariableList
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.rotor.speed_profile import turning_forces

STEP = 1e-5  # s, of the default experiment
RESOLVED = 0.5  # step times angular frequency up to which a mode vibrates; beyond, it follows its forces
SCALES = {
    "mass_scale": "Factor of masses and moments of inertia, of the gyroscopic ones too",
    "stiffness_scale": "Factor of the stiffness of the shaft, and of linear bearings",
    "damping_scale": "Factor of the damping of the shaft, and of linear bearings",
    "load_scale": "Factor of the constant load, weight for one",
}


def shaft_spec(model: ShaftModel, model_name: str | None = None, force_lead: float | None = None) -> ModelSpec:
    """Specification of the FMU of a shaft.

    Raises
    ------
    InputError
        A name that is empty, too long or not printable, or another lead.
    """
    made = _Variables(model)
    made.fill(force_lead_for(HELD_PARALLEL) if force_lead is None else force_lead)
    count = len(model.stations)
    return ModelSpec(
        name=checked_name("Shaft" if model_name is None else model_name),
        description=f"Shaft of {model.rotor.size} degrees of freedom between {count} bearings; SI units",
        sources=("core.c", "core_step.c", "model_shaft.c"),
        headers=("core.h", "model.h"),
        variables=tuple(made.variables),
        notes=_notes(model),
        macros=_macros(model, made),
        tables={"shaft_data.h": _data(model)},
        step=STEP,
        exchange=False,
        indicators=(),
        flanges=tuple(
            (
                f"bearing_{b}_{name}",
                f"Inner ring of bearing {b}, {name}: place and rate out, force or moment in",
                (f"bearing[{b}].{name}", f"bearing[{b}].{RATES[name]}", f"bearing[{b}].{FORCES[name]}"),
            )
            for b, mount in enumerate(model.stations, start=1)
            for name in mount.directions
        ),
    )


def node_name(name: str) -> str:
    """Name of a node as part of a variable's: letters, digits and underscores."""
    text = re.sub(r"\W", "_", name, flags=re.ASCII)
    return text if text[:1].isalpha() else f"node_{text}"


class _Variables(VariableList):
    """The variables of a shaft, numbered as they are made."""

    def __init__(self, model: ShaftModel) -> None:
        super().__init__()
        self.model = model
        self.first: dict[str, int] = {}

    def fill(self, lead: float) -> None:
        """All of them."""
        self._inputs()
        self._outputs()
        self._parameters(lead)

    def _inputs(self) -> None:
        for b, (mount, start) in enumerate(zip(self.model.stations, self.model.forces, strict=True), start=1):
            for name, force in zip(mount.directions, start.tolist(), strict=True):
                tilt = name.startswith("tilt")
                what = f"Moment about {name[-1]}" if tilt else f"Force along {name}"
                self.add(
                    f"bearing[{b}].{FORCES[name]}", "input", "continuous", f"{what} of bearing {b} on its ring",
                    unit="N.m" if tilt else "N", start=force, nominal=1.0 if tilt else 100.0,
                )  # fmt: skip
        self.first["UNBALANCE"] = len(self.variables)
        for u, unbalance in enumerate(self.model.rotor.unbalances, start=1):
            self.add(
                f"unbalance[{u}]", "input", "continuous", "Unbalance: mass times eccentricity",
                unit="kg.m", start=float(unbalance.amount), nominal=1e-4,
            )  # fmt: skip
        self.first["DRIVE"] = len(self.variables)
        if self.model.inertia is None:
            self.add(
                "speed", "input", "continuous", "Speed of the shaft about z, reached at the end of a step",
                unit="rad/s", start=self.model.speed_rpm * RPM_TO_RAD_S, nominal=100.0,
            )  # fmt: skip
            return
        text = "Torque of the motor about z"
        self.add("torque", "input", "continuous", text, unit="N.m", start=0.0, nominal=1.0)
        for b in range(1, len(self.model.stations) + 1):
            self.add(
                f"bearing[{b}].rolling_torque", "input", "continuous",
                f"Torque that bearing {b} takes from the shaft, against its turning",
                unit="N.m", start=0.0, nominal=1e-2,
            )  # fmt: skip

    def _outputs(self) -> None:
        model = self.model
        rings = [
            (f"bearing[{b}].", name, f"ring {b}")
            for b, mount in enumerate(model.stations, start=1)
            for name in mount.directions
        ]
        rings += [(f"{node_name(node)}.", name, node) for node, name, _ in model.points]
        for moving in (False, True):
            self.first["VELOCITY" if moving else "PLACE"] = len(self.variables)
            for before, name, what in rings:
                tilt = name.startswith("tilt")
                unit = "rad" if tilt else "m"
                nominal = 1e-4 if tilt else 1e-5
                self.add(
                    f"{before}{RATES[name] if moving else name}", "output", "continuous",
                    f"{'Rate' if moving else 'Displacement'} of {what}, {name}",
                    unit=f"{unit}/s" if moving else unit, nominal=100.0 * nominal if moving else nominal,
                )  # fmt: skip
        self.add("angle", "output", "continuous", "Angle of the shaft about z", unit="rad", nominal=1.0)
        if model.inertia is not None:
            self.add(
                "speed", "output", "continuous", "Speed of the shaft about z", unit="rad/s", nominal=100.0,
                depends=("speed_start",),
            )  # fmt: skip

    def _parameters(self, lead: float) -> None:
        self.lead(ROTOR, lead)
        for name, text in SCALES.items():
            self.add(name, "parameter", "fixed", text, unit="1", start=1.0, minimum=0.0)
        if self.model.inertia is not None:
            self.add(
                "inertia", "parameter", "fixed", "Polar moment of inertia of all that turns, times mass_scale",
                unit="kg.m2", start=float(self.model.inertia), minimum=0.0,
            )  # fmt: skip
            self.add(
                "speed_start", "parameter", "fixed", "Speed of the shaft at the start",
                unit="rad/s", start=self.model.speed_rpm * RPM_TO_RAD_S,
            )  # fmt: skip


def _data(model: ShaftModel) -> str:
    modes, (q, v) = model.modes, model.motion
    one = np.ones(1)
    _, at = turning_forces(model.rotor, one, one, one)
    inverse = modes.shapes.T @ model.rotor.mass
    phases = [unbalance.phase for unbalance in model.rotor.unbalances] or [0.0]
    tables = {
        "modal_stiffness": modes.stiffness,
        "modal_damping": modes.damping,
        "modal_gyroscopic": modes.gyroscopic,
        "modal_load": modes.load,
        "modal_start": np.concatenate([inverse @ q, inverse @ v]),
        "row_modes": model.rows @ modes.shapes,
        "row_shift": model.shifts,
        "unbalance_modes": at.T @ modes.shapes if at.size else np.zeros((2, modes.stiffness.size)),
        "unbalance_phase": np.array(phases),
    }
    return "\n".join(
        ["/* Generated by ehlcontact: the shaft in its modes. */", *(c_table(*one) for one in tables.items()), ""]
    )


def _macros(model: ShaftModel, made: _Variables) -> dict[str, str]:
    ports = sum(len(mount.directions) for mount in model.stations)
    counts = {
        "MODES": model.rotor.size,
        "PORTS": ports,
        "ROWS": len(model.rows),
        "UNBALANCES": len(model.rotor.unbalances),
        "BEARINGS": len(model.stations),
        "HAS_TORQUE": int(model.inertia is not None),
        "REACHED": made.first["DRIVE"] if model.inertia is None else "(-1)",
        "N_CACHE": 2 * model.rotor.size + 4,
        **{f"FIRST_{name}": at for name, at in made.first.items()},
    }
    numbers = {"DEFAULT_TOLERANCE": ALLOWED_ERROR, "RESOLVED": RESOLVED}
    return (
        {k: str(v) for k, v in counts.items()} | {k: c_double(v) for k, v in numbers.items()} | dict(ROTOR.macros)
    )


def _notes(model: ShaftModel) -> tuple[tuple[str, str], ...]:
    hz = np.sqrt(np.abs(model.modes.stiffness)) / (2.0 * np.pi)
    turns = (
        "its speed is an input"
        if model.inertia is None
        else f"torques decide on its speed, {model.inertia:g} kg m2"
    )
    return (
        ("Shaft", f"{hz.size} modes, without ball bearings at {', '.join(f'{one:.4g}' for one in hz[:8])} Hz"),
        ("Turns", f"about z, from x towards y; {turns}"),
        *(
            (f"Bearing {b}", f"{mount.bearing.name or 'ball bearing'}, {', '.join(mount.directions)}")
            for b, mount in enumerate(model.stations, start=1)
        ),
    )
