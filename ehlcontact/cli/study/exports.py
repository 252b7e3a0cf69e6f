"""What a study leaves for other programs: FMUs of elements, of the bearing or the rotor; scripts."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ehlcontact.binaries import choose
from ehlcontact.cli.study.loads import load_alone, places_of_bearings
from ehlcontact.cli.study.machine import bearing_of, carrier_of, rotor_of, support_field
from ehlcontact.cli.study.scripts import python_text, require_ross, ross_text, support_load, variables_of
from ehlcontact.cli.study.shared_entries import supply_and_heat
from ehlcontact.errors import InputError
from ehlcontact.files import write_text
from reduced_models import BallBearing, BearingSet, Rotor, bearing_matrices
from reduced_models.bearing.freedoms import facing_signs
from reduced_models.elements.validity import frequency_text
from reduced_models.rotor.matrix_text import ENDINGS, WHOLE

if TYPE_CHECKING:
    from ehlcontact.cli.study.schema import Study
    from fmu.models import FmuModel

FMU, PYTHON, ROSS = "machine.fmu", "machine.py", "machine_ross.py"


def require_export(study: Study) -> None:
    """Raise `InputError` for entries of [export] that contradict each other or the machine."""
    asked = study.export
    if asked is None:
        return
    if not asked.fmu:
        for name in ("outside", "inertia", "top_rpm"):
            if value := getattr(asked, name):
                shown = list(value) if isinstance(value, tuple) else value
                raise InputError(f"export.{name}", shown, "left out without export.fmu")
    if not (asked.fmu or asked.python or asked.ross or asked.matrices) and study.contact is None:
        raise InputError("export.fmu", False, "true; or export.python, export.ross or export.matrices")
    if asked.matrices and set(asked.matrices) <= set(WHOLE):
        for name, usual in (("matrix_units", "m"), ("shaft_along", "z")):
            if (value := getattr(asked, name)) != usual:
                raise InputError(f"export.{name}", value, "left out without export.matrices for a program")
    if asked.fmu and study.shaft is None:
        for name in ("outside", "inertia"):
            if value := getattr(asked, name):
                raise InputError(f"export.{name}", value, "left out without [shaft]: the FMU is a bearing's")
        _require_one_bearing(study)
    for name in asked.outside:
        study.index(name, "export.outside")
    if asked.top_rpm is not None and asked.top_rpm < study.speed_rpm:
        allowed = f"at least the speed of the study, {study.speed_rpm:g} rev/min"
        raise InputError("export.top_rpm", asked.top_rpm, allowed)
    if asked.platforms:
        try:
            choose(asked.platforms, asked.fmi)
        except InputError as error:
            raise InputError("export.platforms", error.value, error.allowed) from None
    if asked.ross:
        require_ross(study)
    if asked.fmu and study.shaft is not None:
        carriers_with_films(study)


def _require_one_bearing(study: Study) -> None:
    """Raise `InputError` for what an FMU of a bearing alone does not have."""
    if study.support[0].pair is not None:
        allowed = "left out: the FMU is that of one bearing; with [shaft] a rotor with pairs has one"
        raise InputError("support.pair", study.support[0].pair, allowed)
    for name in ("tilt_x_mrad", "tilt_y_mrad"):
        if (tilt := getattr(study.operation, name)) is not None:
            raise InputError(f"operation.{name}", tilt, "left out: tilts are inputs of the FMU")


def rotor_with_films(study: Study) -> Rotor:
    """The rotor of a machine, its bearings with the layer of oil and the heat of [operation].

    Raises
    ------
    InputError
        As `rotor_of`; a pair with a layer or heat.
    """
    return rotor_of(study, carriers=carriers_with_films(study))


def carriers_with_films(study: Study) -> list[BallBearing | BearingSet]:
    """What stands at each support, with the layer of oil and the heat of [operation].

    Raises
    ------
    InputError
        A pair with a layer or heat.
    """
    supply, thermal = supply_and_heat(study.operation, "operation", study.lubricant)
    count = len(study.support)
    if supply is None and thermal is None:
        return [carrier_of(study, k) for k in range(count)]
    for k, one in enumerate(study.support):
        if one.pair is not None:
            allowed = "left out with a layer of oil or heat, for an FMU"
            raise InputError(support_field(study, k, "pair"), one.pair, allowed)
    return [replace(bearing_of(study, k), supply=supply, thermal=thermal) for k in range(count)]


def write_exports(study: Study, folder: Path) -> dict[str, Any]:
    """Write what [export] asks for; what each file is, or why it is not there under ``error``.

    Returns
    -------
    dict
        By "fmu", "python" and "ross", those that are asked for, each with its ``file``; under "matrices" a list of
        these with the ``program`` and the ``support`` of each.
    """
    asked = study.export
    made: dict[str, Any] = {}
    if asked is None:
        return {}
    if asked.fmu:
        made["fmu"] = _machine_fmu(study, folder / FMU)
    for name, wanted, file, text in (
        ("python", asked.python, PYTHON, python_text),
        ("ross", asked.ross, ROSS, ross_text),
    ):
        if wanted:
            write_text(folder / file, text(study), "file")
            made[name] = {"file": file}
    if asked.matrices:
        made["matrices"] = _write_matrices(study, folder)
    return made


def _write_matrices(study: Study, folder: Path) -> list[dict[str, str]]:
    """Stiffness and damping of what stands at every support, at the speed, under its load there.

    Nodes are 1, 2, ... in the order of the supports.
    """
    asked, made = study.export, []
    assert asked is not None
    facings = dict.fromkeys(range(len(study.support)), "+z")
    if study.shaft is not None:
        facings |= {
            k: one.facing for k, one in zip(places_of_bearings(study), rotor_of(study).bearings, strict=True)
        }
    for k, (name, word) in enumerate(zip(study.names, variables_of(study.names), strict=True)):
        carrier = carrier_of(study, k)
        facing = "+z" if isinstance(carrier, BearingSet) else facings[k]
        load = np.array(support_load(study, k))
        table = bearing_matrices(carrier, load * facing_signs(facing)[: load.size], study.speed_rpm, facing=facing)
        for program in asked.matrices:
            file = f"{word}_{'matrices' if program in WHOLE else program.replace('-', '_')}.{ENDINGS[program]}"
            options: dict[str, Any] = (
                {}
                if program in WHOLE
                else {"node": k + 1, "units": asked.matrix_units, "shaft_along": asked.shaft_along}
            )
            write_text(folder / file, table.text(program, **options), "file")
            made.append({"file": file, "program": program, "support": name})
    return made


def export_fmu(element: Any, path: Path, study: Study | None = None) -> dict[str, Any]:
    """Export an SI element as ``path``, as [export] of the study has it, and verify it.

    With the largest steps of each way of coupling under ``steps``, and the frequencies that it is for. What went
    wrong, whatever it is, stands under ``error``.
    """
    from fmu.models import fmu_model
    from fmu.steps import step_advice

    band = element.omega_range
    entry: dict[str, Any] = {
        "kind": element.kind,
        "element_states": element.state_count,
        "frequencies": None if band is None else frequency_text(band, element.units),
        "steps": {},
    }

    def model() -> FmuModel:
        entry["steps"] = {way: {"step": step, "why": why} for way, step, why in step_advice(element)}
        return fmu_model(element, model_name=path.stem)

    return _verified(model, path, study, entry)


def _verified(model: Any, path: Path, study: Study | None, entry: dict[str, Any]) -> dict[str, Any]:
    """Export what `model` makes; `entry` with what the verification found, or with the error."""
    from fmu import VerificationError
    from fmu.export import export_model

    asked = None if study is None else study.export
    fmi, platforms = (2, ()) if asked is None else (asked.fmi, asked.platforms)
    entry |= {"file": path.name, "passes": False, "fmi": fmi}
    try:
        entry["platforms"] = [one.name for one in choose(platforms or None, fmi)]
        _, found = export_model(model(), path, fmi=fmi, platforms=platforms or None, overwrite=True)
    except Exception as error:  # the rest of the study is worth having without an FMU
        found = error.found if isinstance(error, VerificationError) else None
        entry["error"] = " ".join(str(error).split()) or type(error).__name__
    return entry | (found.to_dict() if found is not None else {})


def _machine_fmu(study: Study, path: Path) -> dict[str, Any]:
    """FMU of the rotor, or of the bearing alone, at the speed of the study and up to the highest of [export]."""
    asked = study.export
    assert asked is not None
    speeds = sorted({study.speed_rpm, asked.top_rpm or study.speed_rpm})
    entry: dict[str, Any] = {"speeds_rpm": speeds, "supports_inside": [], "supports_outside": list(asked.outside)}

    def model() -> FmuModel:
        names = [study.support[0].label] if study.shaft is None else study.names
        entry["supports_inside"] = [name for name in names if name not in asked.outside]
        made = machine_model(study, speeds, outside=asked.outside, inertia=asked.inertia, model_name=path.stem)
        if study.shaft is not None:
            entry["inner_step"] = made.source.inner_step
        return made

    return _verified(model, path, study, entry)


def machine_model(
    study: Study,
    speeds_rpm: Sequence[float],
    *,
    outside: Collection[str] = (),
    inertia: float | None = None,
    **keywords: Any,
) -> FmuModel:
    """Model of the FMU of the rotor of a study, or of its bearing alone, at rest under its load.

    Parameters
    ----------
    study : Study
    speeds_rpm : sequence of float
        For which bearings have tables [rev/min].
    outside : collection of str
        Names of the supports whose forces are inputs.
    inertia : float, optional
        Polar, of all that turns [kg m2].
    **keywords
        Of `fmu.models.fmu_model`.

    Raises
    ------
    InputError
        A pair or tilts of a bearing alone, a pair with a layer or heat; what `fmu.export` refuses.
    """
    from fmu.models import fmu_model

    asked = "electric" in study.model_fields_set and study.oil is not None
    electric: dict[str, Any] = {"permittivity": study.electric.permittivity} if asked else {}
    if study.shaft is None:
        _require_one_bearing(study)
        (bearing,) = carriers_with_films(study)
        return fmu_model(bearing, speeds_rpm=speeds_rpm, load=load_alone(study), **electric, **keywords)
    rotor, places = rotor_with_films(study), places_of_bearings(study)
    names = zip(rotor.ball_bearing_names, places, strict=True)
    out = [name for name, k in names if study.names[k] in outside]
    speeds = speeds_rpm if len(out) < len(places) else None
    turning: dict[str, Any] = {"speed_rpm": study.speed_rpm, "inertia": inertia}
    if speeds is not None:
        turning |= electric
    return fmu_model(rotor, outside=out, speeds_rpm=speeds, **turning, **keywords)
