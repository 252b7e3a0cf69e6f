"""``ehlcontact export``: elements, bearings and rotors as FMUs; systems of these."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ehlcontact.checks import require_positive
from ehlcontact.cli import options as o
from ehlcontact.cli.output import USAGE, check_new, complain
from ehlcontact.cli.progress import progress
from ehlcontact.cli.rows import Row, summary_lines
from ehlcontact.cli.toml import read_toml
from ehlcontact.errors import InputError
from ehlcontact.store import read

if TYPE_CHECKING:
    from fmu.models import FmuModel
    from fmu.system.check import SystemVerification
    from fmu.system.parts import RotorSystem
    from fmu.verification import Verification
    from reduced_models import Rotor

NAMES = {  # of the library, and the options
    "model_name": "--name",
    "platforms": "--platform",
    "path": "--output",
    "lead": "--lead",
    "inertia": "--inertia",
    "speed_rpm": "--top-rpm",
    "speeds_rpm": "--top-rpm",
}
WAYS = {"inside": ".fmu", "outside": ".fmu", "wired": ".ssp"}  # of --bearings: ending of the file


@o.grouped
def export(
    out: o.Output,
    file: Annotated[
        Path,
        typer.Argument(
            metavar="ELEMENT.json|BEARING.toml|STUDY.toml",
            help="Element saved by `fit` or `element`; a bearing, as `bearing` takes it, between its lowest and"
            " highest speed; or a study, whose rotor is exported with its contacts.",
        ),
    ],
    output: Annotated[
        Path,
        typer.Option(
            "--output",
            "-o",
            metavar="X.fmu|X.ssp",
            help="FMU to write; of a study also a system archive (SSP) of rotor and contacts, each its FMU.",
        ),
    ],
    contact: Annotated[
        Path | None,
        typer.Option(
            "--contact",
            metavar="ELEMENT.json",
            help="Of a study: the element in every contact of its rotor; the atlas's, for any load, by default.",
        ),
    ] = None,
    lead: Annotated[
        float | None,
        typer.Option(
            "--lead",
            metavar="STEPS",
            help="Time from the inputs of a contact to its force, 0 to 2 communication steps: 1.5, the default,"
            " for masses that hold the force and step beside the FMU; 0.5 where they step first; see"
            " docs/coupling.md.",
        ),
    ] = None,
    bearings: Annotated[
        str | None,
        typer.Option(
            "--bearings",
            metavar="inside|outside|wired",
            help="Of a study with [shaft]: its rotor on its bearings, which are inside its FMU, outside"
            " (their forces are inputs), or each an FMU, wired in a system archive (SSP).",
        ),
    ] = None,
    inertia: Annotated[
        float | None,
        typer.Option(
            "--inertia",
            metavar="KG_M2",
            help="Polar moment of inertia of all that turns with the shaft: the torque of the motor is an input of"
            " --bearings; without it the speed is.",
        ),
    ] = None,
    top_rpm: Annotated[
        float | None,
        typer.Option(
            "--top-rpm",
            metavar="REV/MIN",
            help="Highest speed that bearings inside or wired have tables for; by default the speed of the study.",
        ),
    ] = None,
    fmi: Annotated[int, typer.Option("--fmi", help="FMI version, 2 or 3.")] = 2,
    name: Annotated[str | None, typer.Option("--name", help="Model name.")] = None,
    platform: Annotated[
        list[str] | None,
        typer.Option(
            "--platform",
            metavar="NAME",
            help="Binary for x86_64-linux, x86_64-windows, x86_64-darwin, aarch64-darwin, in FMI 3 also"
            " aarch64-linux, or `all`; may be repeated. This machine's by default.",
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the file if there is one.")] = False,
) -> None:
    """Export a contact, a bearing, or the rotor of a study as an FMU or a system of FMUs, once it is verified."""
    if fmi not in (2, 3):
        raise InputError("--fmi", fmi, "2 or 3")
    toml = file.suffix.lower() == ".toml"
    bearing = toml and not set(read_toml(str(file), "file")) & {"shaft", "contact", "full_films"}
    study = toml and not bearing
    if contact is not None and (not study or bearings is not None):
        raise InputError("--contact", str(contact), "left out, but for a study (.toml) with a rotor on contacts")
    _check_bearings(output, study, bearings, inertia=inertia, top_rpm=top_rpm)
    if not study and output.suffix.lower() == ".ssp":
        allowed = "a file name ending in .fmu: a system (.ssp) is made of a study (.toml) with a rotor"
        raise InputError("--output", str(output), allowed)
    if lead is not None and study and output.suffix.lower() == ".fmu":
        inside = (
            "the bearings are no part of it"
            if bearings == "outside"
            else "the contacts of this rotor are inside its FMU"
        )
        raise InputError("--lead", lead, f"left out: {inside}")
    out.check(file, contact, beside={"--output": (output, (".fmu", ".ssp") if study else (".fmu",))})
    check_new("--output", output, force)
    from ehlcontact.binaries import choose
    from fmu import BuildError, VerificationError
    from fmu.export import export_model
    from fmu.system.export import export_verified_system

    system = output.suffix.lower() == ".ssp"
    keywords = {name: value for name, value in (("model_name", name), ("lead", lead)) if value is not None}
    own = {} if system else keywords  # of the model; else of the system
    exported: Any
    with o.called(**NAMES, element=str(file), model=str(file)):
        try:
            if bearings is not None:
                exported = _on_bearings(file, bearings, inertia, top_rpm, own)
            elif study:
                exported = _on_contacts(file, contact, system=system, named=own)
            else:
                exported = _bearing_of(file, own) if bearing else _element_of(file, own)
            with progress("compiling") as told:
                built = [one.name for one in choose(platform or None, fmi)]
                given: dict[str, Any] = {"fmi": fmi, "platforms": platform or None, "overwrite": force}
                write: Any = export_verified_system if system else export_model
                _, found = write(exported, output, **given, progress=told, **(keywords if system else {}))
        except (BuildError, VerificationError) as error:
            complain(f"no {'system' if system else 'FMU'} was written: {error}")
            raise typer.Exit(USAGE) from None
    document = {
        "system" if system else "fmu": str(output),
        "fmi": f"{fmi}.0",
        "units": "SI" if toml else exported.source.units,
        "platforms": built,
        **({"passes": None} if found is None else found.to_dict()),
    }
    uses = "co-simulation alone" if system else "co-simulation and model exchange"
    rows = [
        ("model", "", getattr(exported, "spec", exported).description),
        *_kinds(exported),
        ("FMI", f"{fmi}.0", uses),
        ("binaries", str(len(built)), ", ".join(built)),
        *_steps(exported, found),
        *_verified(found),
    ]
    out.deliver(document, (str(output), rows))


def _check_bearings(output: Path, study: bool, bearings: str | None, **values: float | None) -> None:
    """Options of rotors on whole bearings: of a study alone, with a file of its kind."""
    given = {f"--{name.replace('_', '-')}": value for name, value in values.items() if value is not None}
    if bearings is None:
        for option, value in given.items():
            raise InputError(option, value, "left out, but with --bearings")
        return
    if bearings not in WAYS:
        raise InputError("--bearings", bearings, "inside, outside or wired")
    if not study:
        raise InputError("--bearings", "another file", "given with a study (.toml) that has [shaft]")
    if output.suffix.lower() != WAYS[bearings]:
        allowed = f"a file name ending in {WAYS[bearings]}, for --bearings {bearings}"
        raise InputError("--output", str(output), allowed)
    if bearings == "outside" and "--top-rpm" in given:
        raise InputError("--top-rpm", given["--top-rpm"], "left out: the bearings are no part of the FMU")
    for name, value in given.items():
        require_positive(name, value)


def _element_of(file: Path, keywords: dict[str, Any]) -> FmuModel:
    """A contact element from a file."""
    from fmu.models import fmu_model
    from reduced_models.elements.base import ContactElement

    element: Any = read(file, ContactElement)
    return fmu_model(element, **keywords)


def _bearing_of(file: Path, keywords: dict[str, Any]) -> FmuModel:
    """The bearing of a study without a shaft, from its lowest to its highest speed, at rest under its load."""
    from ehlcontact.cli.study.bearing import load_job
    from ehlcontact.cli.study.exports import machine_model

    job = load_job(str(file), {})
    with job.called():
        return machine_model(job.study, sorted({job.speeds[0], job.speeds[-1]}), **keywords)


def _on_contacts(
    file: Path, contact: Path | None, *, system: bool, named: dict[str, Any]
) -> FmuModel | RotorSystem:
    """The rotor of a study, closed with an element from a file, or from the atlas."""
    from fmu.models import fmu_model
    from fmu.system.parts import RotorSystem

    rotor, element, place = _rotor_and_element(file, contact)
    rotor = rotor.on([element.copy()] * len(rotor.contacts))
    with o.called(contacts=place):
        made = RotorSystem.of(rotor) if system else fmu_model(rotor, **named)
    rotor.check_contacts()
    return made


def _rotor_and_element(file: Path, contact: Path | None) -> tuple[Rotor, Any, str]:
    """The rotor of a study, an element in SI, and where the latter is from."""
    from ehlcontact.cli.study.rotor import build_rotor
    from ehlcontact.cli.study.schema import load_study
    from reduced_models.atlas.atlas import Atlas
    from reduced_models.elements.base import ContactElement

    study = load_study(file)
    if study.full_films is None:
        raise InputError(
            "file",
            str(file),
            "a study with [full_films], whose rotor stands on contacts; a machine by --bearings inside",
        )
    rotor = build_rotor(study)
    if contact is None:
        with o.called(point=str(file)):
            return rotor, Atlas().element(study.point), str(file)
    element: Any = read(contact, ContactElement)
    if element.units != "SI":
        with o.called(scales="--contact"):
            element = element.to_si(study.point.scales)
    if others := element.design_point.differences(study.point):
        raise InputError("--contact", str(contact), f"an element of the study's contact: {', '.join(others)}")
    return rotor, element, "--contact"


def _on_bearings(
    file: Path, bearings: str, inertia: float | None, top_rpm: float | None, named: dict[str, Any]
) -> FmuModel | RotorSystem:
    """The rotor of a study on its whole bearings, at its speed, at rest under the load on them."""
    from ehlcontact.cli.study.exports import machine_model, rotor_with_films
    from ehlcontact.cli.study.schema import load_study
    from fmu.system.parts import RotorSystem

    study = load_study(file)
    if study.shaft is None:
        raise InputError("file", str(file), "a study with a table [shaft], for --bearings")
    top = study.speed_rpm if top_rpm is None else top_rpm
    if top < study.speed_rpm:
        allowed = f"at least the speed of the study, {study.speed_rpm:g} rev/min"
        raise InputError("--top-rpm", top, allowed)
    speeds = sorted({study.speed_rpm, top})
    if bearings == "wired":
        turning: dict[str, Any] = {"speed_rpm": study.speed_rpm, "inertia": inertia}
        return RotorSystem.of(rotor_with_films(study), speeds_rpm=speeds, **turning)
    outside = study.names if bearings == "outside" else ()
    return machine_model(study, speeds, outside=outside, inertia=inertia, **named)


def _kinds(model: FmuModel | RotorSystem) -> list[Row]:
    """Elements of contacts that an FMU computes, or that are wired in a system."""
    made = getattr(model, "made", None)
    elements = getattr(model, "elements", ()) if made is None else [one.contact for one in made.rotor.contacts]
    kinds = sorted({element.kind for element in elements})
    return [("contacts", str(len(elements)), ", ".join(kinds))] if kinds else []


def _steps(model: FmuModel | RotorSystem, found: Any) -> list[Row]:
    """Steps of a co-simulation."""
    from fmu.steps import step_advice
    from reduced_models.elements.base import ContactElement

    source, spec = getattr(model, "source", None), getattr(model, "spec", None)
    if isinstance(source, ContactElement):
        return step_advice(source)  # type: ignore[arg-type]
    step = getattr(found, "step", None) if spec is None else spec.step
    how = "of the default experiment, and within a step of the master; how long one may be: docs/coupling.md"
    return [] if step is None else [("step", f"{step:g} s", how)]


def _verified(found: Verification | SystemVerification | None) -> list[Row]:
    """What the verification found."""
    if found is None:
        return [("verified", "no", "this machine can run no such FMU")]
    first, *others = summary_lines(found)
    return [("verified", "yes" if found.passes else "no", first), *(("", "", line) for line in others)]
