"""Variables and C text of the FMU of a Jeffcott rotor."""

from __future__ import annotations

import math

import numpy as np

from fmu.c_headers import c_double, c_table
from fmu.contact_spec import checked_name, contact_spec, source_text
from fmu.contact_variables import ALLOWED_ERROR
from fmu.jeffcott.laws import law_tables, numbers_of_laws
from fmu.jeffcott.model import STEPS_PER_PERIOD, JeffcottModel
from fmu.lead import HELD_PARALLEL, ROTOR, force_lead_for
from fmu.spec import ModelSpec, VariableList

BODIES = ("disc", "journal")
LEAST_INNER_STEP = 1e-6  # of the default: below it, importers repeat what is refused without end
EXCHANGE_TOLERANCE = 1e-8  # an orbit is some thousandths of the approach; 1e-6 of that is a tenth of it
_FORCES = {"journal": "Further force on the journal", "disc": "Further force on the disc"}


def jeffcott_spec(
    model: JeffcottModel, model_name: str | None = None, force_lead: float | None = None
) -> ModelSpec:
    """Specification of a rotor's FMU.

    Parameters
    ----------
    model : JeffcottModel
    model_name : str, optional
        Name of the model; the class of the rotor by default.
    force_lead : float, optional
        Start value of the parameter, 0 to 1 communication steps. By default 1/2 between FMUs of contacts, whose
        forces are those of the middle of a step, and 0 with the contacts inside.

    Raises
    ------
    InputError
        A name that is empty, too long or not printable.
    """
    name = checked_name(type(model.rotor).__name__ if model_name is None else model_name)
    made = _Variables(model, force_lead)
    made.fill()
    closed = bool(model.elements)
    mounts = range(1, len(model.rotor.mounts) + 1)
    body = "rotor_contacts.c" if closed else "rotor_free.c"
    words = (
        f"closed with {len(mounts)} contact{'s' * (len(mounts) != 1)} in each bearing"
        if closed
        else "its contacts outside"
    )
    return ModelSpec(
        name=name,
        description=f"Jeffcott rotor, {words}; SI units{source_text(model.elements)}",
        sources=("core.c", "core_step.c", "model_rotor.c", "rotor_step.c", body),
        headers=("core.h", "model.h", "rotor.h", *(("contact_law.h",) if closed else ())),
        variables=tuple(made.variables),
        notes=_notes(model),
        macros=_macros(model, made),
        tables={"rotor_data.h": _data(model), **(law_tables(model.elements) if closed else {})},
        step=model.inner_step,
        tolerance=EXCHANGE_TOLERANCE,
        indicators=tuple((f"contact_indicator[{i}]", f"force[{i}]") for i in mounts) if closed else (),
        flanges=()
        if closed
        else tuple(
            (
                f"contact_{i}",
                "Where a contact sits: its approach and rate out, its force in",
                (f"approach[{i}]", f"rate[{i}]", f"force[{i}]"),
            )
            for i in mounts
        ),
    )


class _Variables(VariableList):
    """The variables of a rotor, numbered as they are made."""

    def __init__(self, model: JeffcottModel, lead: float | None) -> None:
        super().__init__()
        self.model, self.rotor = model, model.rotor
        between_contacts = 0.0 if model.elements else force_lead_for(HELD_PARALLEL)
        self.start_of_lead = between_contacts if lead is None else lead
        self.axes = [("x", "y")[k] for k in model.rotor.axes]
        self.mounts = range(1, len(model.rotor.mounts) + 1)
        self.first: dict[str, int] = {}  # value references of the first of many
        load = float(np.abs(self.rotor.static_load).max())
        self.force = load if load > 0.0 else 1.0
        bend = self.force / self.rotor.shaft_stiffness
        eccentric = self.rotor.unbalance / self.rotor.disc_mass
        self.length = max(bend, eccentric, *(e.validity.approach[1] for e in model.elements), 0.0)
        omega = math.sqrt(self.rotor.shaft_stiffness / self.rotor.disc_mass)
        self.rate = self.length * max(omega, self.rotor.omega)

    def fill(self) -> None:
        """All of them."""
        for body, text in _FORCES.items():
            for axis in self.axes:
                self._input(f"{body}_force_{axis}", f"{text} along {axis}")
        if not self.model.elements:
            for i in self.mounts:
                self._input(
                    f"force[{i}]", f"Force of the contact at mount {i} of one bearing, positive = repulsive"
                )
        self._turning()
        self._states()
        self._derivatives()
        self._outputs()
        self._parameters()

    def _turning(self) -> None:
        rate = "angular_acceleration"
        text = "Unbalance of the disc: mass times eccentricity"
        self.add(
            "unbalance", "input", "continuous", text,
            unit="kg.m", start=float(self.rotor.unbalance), nominal=1e-4,
        )  # fmt: skip
        text = "Speed of the shaft; films of contacts inside stay those of the speed that they were made for"
        self.add(
            "speed", "input", "continuous", text,
            unit="rad/s", start=float(self.rotor.omega), nominal=100.0, rate=rate,
        )  # fmt: skip
        text = "Rate of the speed, for the tangential force of the unbalance"
        self.add(rate, "input", "continuous", text, unit="rad/s2", start=0.0, nominal=100.0)

    def _input(self, name: str, text: str) -> None:
        self.add(name, "input", "continuous", text, unit="N", start=0.0, nominal=self.force)

    def _motion(self) -> list[str]:
        """Positions, then velocities, in the order of `JeffcottRotor.matrices`."""
        return [f"{body}{what}_{axis}" for what in ("", "_velocity") for body in BODIES for axis in self.axes]

    def _films(self) -> list[tuple[int, ModelSpec]]:
        return [(i, contact_spec(e)) for i, e in zip(self.mounts, self.model.elements, strict=False)]

    def _states(self) -> None:
        self.first["STATE"] = len(self.variables)
        state = self.model.state
        starts = [
            getattr(state, f"{body}{what}")[k]
            for what in ("", "_velocity")
            for body in BODIES
            for k in self.rotor.axes
        ]
        for name, start in zip(self._motion(), starts, strict=True):
            moving = "velocity" in name
            what, body = "Velocity" if moving else "Position", name.split("_")[0]
            self.add(
                name, "output", "continuous", f"{what} of the {body} along {name[-1]}",
                unit="m/s" if moving else "m", start=float(start),
                nominal=self.rate if moving else self.length, depends=(name,),
            )  # fmt: skip
        text = "Angle of the unbalance from x towards y"
        self.add("angle", "output", "continuous", text, unit="rad", start=0.0, nominal=1.0, depends=("angle",))
        for i, spec in self._films():
            for v in spec.states:
                self.add(
                    f"contact[{i}].{v.name}", "local", "continuous", f"{v.description} (contact {i})",
                    unit=v.unit, start=v.start, nominal=v.nominal,
                )  # fmt: skip

    def _derivatives(self) -> None:
        contacts = self._contact_depends()
        for name in self._motion():
            body, axis = name.split("_")[0], name[-1]
            if "velocity" not in name:
                depends: tuple[str, ...] = (f"{body}_velocity_{axis}",)
            else:
                depends = tuple(f"{other}{what}_{axis}" for other in BODIES for what in ("", "_velocity"))
                depends += (f"{body}_force_{axis}",)
                if body == "disc":
                    depends += ("angle", "unbalance", "speed", "angular_acceleration")
                else:
                    depends += tuple(n for i in self.mounts for n in contacts[i]) if contacts else tuple(
                        f"force[{i}]" for i in self.mounts
                    )  # fmt: skip
            self.derivative(name, "m/s" if "velocity" not in name else "m/s2", tuple(dict.fromkeys(depends)))
        self.derivative("angle", "rad/s", ("speed",))
        moving = {
            what: tuple(f"journal{part}_{axis}" for axis in self.axes)
            for what, part in (("approach", ""), ("rate", "_velocity"))
        }
        for i, spec in self._films():
            for v in spec.derivatives:
                depends = tuple(m for name in v.depends for m in moving.get(name, (f"contact[{i}].{name}",)))
                self.derivative(f"contact[{i}].{v.derivative_of}", v.unit, depends)

    def _contact_depends(self) -> dict[int, tuple[str, ...]]:
        """States that the force of each contact inside depends on."""
        journal = tuple(f"journal{what}_{axis}" for what in ("", "_velocity") for axis in self.axes)
        return {i: (*journal, *(f"contact[{i}].{v.name}" for v in spec.states)) for i, spec in self._films()}

    def _outputs(self) -> None:
        depends = self._contact_depends()
        for i in depends:
            self.first.setdefault("FORCE", len(self.variables))
            self.add(
                f"force[{i}]", "output", "continuous",
                f"Force of contact {i} of one bearing, positive = repulsive",
                unit="N", minimum=0.0, nominal=self.force, depends=depends[i],
            )  # fmt: skip
        for name, what, unit, nominal, text in (
            ("approach", "", "m", self.length, "Mutual approach"),
            ("rate", "_velocity", "m/s", self.rate, "Rate of the approach"),
        ):
            self.first[name.upper()] = len(self.variables)
            for i in self.mounts:
                self.add(
                    f"{name}[{i}]", "output", "continuous", f"{text} at mount {i}",
                    unit=unit, nominal=nominal, depends=tuple(f"journal{what}_{axis}" for axis in self.axes),
                )  # fmt: skip
        if not depends:
            return
        journal = tuple(dict.fromkeys(name for names in depends.values() for name in names))
        text = "True where a contact is outside the box of its element by more than the margin"
        self.add("outside_validity", "output", "discrete", text, type="Boolean", depends=journal)
        self.first["OUTSIDE"] = len(self.variables)
        for i in depends:
            self.add(
                f"contact[{i}].outside_validity", "local", "discrete", f"Likewise of contact {i}", type="Boolean"
            )

    def _parameters(self) -> None:
        r = self.rotor
        self.lead(ROTOR, self.start_of_lead)
        self.add(
            "inner_step", "parameter", "fixed",
            "Longest step inside one of co-simulation, cut evenly; its start value follows a stiffer shaft",
            unit="s", start=self.model.inner_step, minimum=LEAST_INNER_STEP * self.model.inner_step,
        )  # fmt: skip
        for name, unit, text in (
            ("disc_mass", "kg", "Mass of the disc"),
            ("journal_mass", "kg", "Mass of both journals"),
            ("shaft_stiffness", "N/m", "Stiffness between disc and journal"),
            ("shaft_damping", "N.s/m", "Damping between disc and journal"),
            ("disc_damping", "N.s/m", "Damping from the disc to the ground"),
        ):
            self.add(name, "parameter", "fixed", text, unit=unit, start=float(getattr(r, name)), minimum=0.0)


def _data(model: JeffcottModel) -> str:
    tables = {
        "rotor_normals": model.rotor.normals,
        "rotor_offsets": model.rotor.offsets,
        "rotor_gravity": np.array(model.rotor.gravity)[list(model.rotor.axes)],
        "rotor_force": np.array(model.rotor.load)[list(model.rotor.axes)],
        "rotor_rest": model.rotor.motion(model.state)[0],
    }
    return "\n".join(
        [
            "/* Generated by ehlcontact: normals and offsets of the mounts; loads, and rest under them. */",
            *(c_table(name, values) for name, values in tables.items()),
            "",
        ]
    )


def _macros(model: JeffcottModel, made: _Variables) -> dict[str, str]:
    axes, freedoms = len(made.axes), 2 * len(made.axes)
    counts = {
        "AXES": axes,
        "STARTS_AT_REST": int(model.start is None),
        "N_MOUNTS": len(made.mounts),
        "REACHED": "VR_speed",
        "N_CACHE": 3 + 3 * freedoms + axes + numbers_of_laws(model.elements),
        **{f"FIRST_{name}": at for name, at in made.first.items() if name != "STATE"},
    }
    numbers = {
        "BEARINGS": float(model.rotor.bearings),
        "DEFAULT_TOLERANCE": ALLOWED_ERROR,
        "LEAST_INNER_STEP": LEAST_INNER_STEP * model.inner_step,
        "DEFAULT_INNER_STEP": model.inner_step,
        "SHAFT_STEP": 2.0 * math.pi / STEPS_PER_PERIOD,
    }
    return (
        {k: str(v) for k, v in counts.items()} | {k: c_double(v) for k, v in numbers.items()} | dict(ROTOR.macros)
    )


def _notes(model: JeffcottModel) -> tuple[tuple[str, str], ...]:
    r = model.rotor
    load = ", ".join(f"{force:.6g}" for force in r.static_load)
    lines = [("Rotor", f"{len(r.mounts)} contacts in each of {r.bearings} bearings, which move as one")]
    lines += [
        (
            f"Mount {i}",
            f"approach = n . journal + offset, n at {math.degrees(m.angle):g} degrees, offset {m.offset:g} m",
        )
        for i, m in enumerate(r.mounts, start=1)
    ]
    for i, element in enumerate(model.elements, start=1):
        lines += [(f"Contact {i}: {label}", text) for label, text in contact_spec(element).notes]
    return (*lines, ("Static load", f"{load} N along {' and '.join(('x', 'y')[k] for k in r.axes)}"))
