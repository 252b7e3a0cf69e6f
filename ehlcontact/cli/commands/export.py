"""``ehlcontact export``: an element, a bearing or a study's rotor as an FMU; that rotor as a system."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ehlcontact.cli import options as o
from ehlcontact.cli.output import USAGE, check_new, complain
from ehlcontact.cli.progress import progress
from ehlcontact.cli.rows import Row
from ehlcontact.cli.toml import read_toml
from ehlcontact.errors import InputError
from ehlcontact.store import load

if TYPE_CHECKING:
    from fmu import BearingModel, RotorModel, Verification
    from fmu.system.check import SystemVerification


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
    bearing = toml and "operation" in read_toml(str(file), "file")  # which no study has
    study = toml and not bearing
    if contact is not None and not study:
        raise InputError("--contact", str(contact), "left out, but for a study (.toml) with a rotor")
    if not study and output.suffix.lower() == ".ssp":
        allowed = "a file name ending in .fmu: a system (.ssp) is made of a study (.toml) with a rotor"
        raise InputError("--output", str(output), allowed)
    if lead is not None and study and output.suffix.lower() == ".fmu":
        raise InputError("--lead", lead, "left out: the contacts of this rotor are inside its FMU")
    out.check(file, contact, beside={"--output": (output, (".fmu", ".ssp") if study else (".fmu",))})
    check_new("--output", output, force)
    from fmu import BuildError, VerificationError
    from fmu.binaries import choose
    from reduced_models import ContactElement

    exported: Any = (
        _bearing_of(file) if bearing else _rotor_of(file, contact) if study else load(file, ContactElement)
    )
    system = output.suffix.lower() == ".ssp"
    try:
        names = {
            "model_name": "--name",
            "platforms": "--platform",
            "path": "--output",
            "lead": "--lead",
            "element": str(file),
        }
        with progress("compiling") as told, o.called(**names):
            built = [one.name for one in choose(platform or None, fmi)]
            _, found = _exporter(system)(
                exported,
                output,
                fmi=fmi,
                platforms=platform or None,
                overwrite=force,
                progress=told,
                **({} if name is None else {"model_name": name}),
                **({} if lead is None else {"lead": lead}),
            )
    except (BuildError, VerificationError) as error:
        complain(f"no {'system' if system else 'FMU'} was written: {error}")
        raise typer.Exit(USAGE) from None
    verdict = {"passes": None} if found is None else found.to_dict()
    document = {
        "system" if system else "fmu": str(output),
        "fmi": f"{fmi}.0",
        "units": "SI" if toml else exported.units,
        "platforms": built,
        **verdict,
    }
    alone = bearing and not exported.exchange
    uses = (
        "co-simulation alone: model exchange is of planar bearings"
        if alone
        else "co-simulation and model exchange"
    )
    version = "FMI", f"{fmi}.0", uses
    rows = [
        *_about(exported, system),
        version,
        ("binaries", str(len(built)), ", ".join(built)),
        *_advice(exported, found),
    ]
    out.deliver(document, (str(output), [*rows, *_rows(found, rotor=study)]))


def _exporter(system: bool) -> Any:
    """What writes such a file."""
    if system:
        from fmu.system.export import export_verified_system

        return export_verified_system
    from fmu.export import export_verified

    return export_verified


def _bearing_of(file: Path) -> BearingModel:
    """The bearing of a bearing file, from its lowest to its highest speed, at rest under its load."""
    from ehlcontact.cli.study.bearing import load_job
    from fmu import BearingModel

    job = load_job(str(file), {})
    if job.tilt is not None:
        allowed = "left out: tilts are inputs of the FMU"
        raise InputError("operation.tilt_x_mrad", 1e3 * job.tilt[0], allowed)
    speeds = sorted({job.speeds[0], job.speeds[-1]})
    with job.called():
        return BearingModel(job.bearing, speeds, job.load)


def _rotor_of(file: Path, contact: Path | None) -> RotorModel:
    """The rotor of a study, closed with an element from a file, or from the atlas."""
    from ehlcontact.cli.study.rotor import build_rotor
    from ehlcontact.cli.study.schema import load_study
    from fmu import RotorModel
    from reduced_models import ContactElement
    from reduced_models.atlas.atlas import Atlas

    study = load_study(file)
    if "rotor" not in study.model_fields_set:
        raise InputError("file", str(file), "a study with a rotor: it has no table [rotor]")
    rotor = build_rotor(study)
    if contact is not None:
        element: Any = load(contact, ContactElement)
        if element.units != "SI":
            with o.called(scales="--contact"):
                element = element.to_si(study.point.scales)
        if others := element.design_point.differences(study.point):
            raise InputError("--contact", str(contact), f"an element of the study's contact: {', '.join(others)}")
        place = "--contact"
    else:
        with o.called(point=str(file)):
            element = Atlas().element(study.point)
        place = str(file)
    with o.called(contacts=place):
        model = RotorModel(rotor, [element] * len(rotor.mounts))
    rotor.check([one.copy() for one in model.elements])
    return model


def _about(exported: Any, system: bool) -> list[Row]:
    """What it is."""
    from fmu import BearingModel, RotorModel

    if isinstance(exported, BearingModel):
        speeds = " to ".join(f"{speed:g}" for speed in sorted({exported.speeds[0], exported.speeds[-1]}))
        of = f"{exported.bearing.balls} balls; displacements {', '.join(exported.names)}"
        return [("bearing", exported.bearing.name, of), ("speed", f"{speeds} rpm", "of the tables of the films")]
    if not isinstance(exported, RotorModel):
        return [("element", exported.kind, exported.units)]
    rotor, kinds = exported.rotor, sorted({element.kind for element in exported.elements})
    where = f"bearings: {rotor.bearings}, contacts in each: {len(rotor.mounts)}; SI"
    return [
        ("rotor", f"{rotor.speed_rpm:g} rpm", where),
        ("contacts", ", ".join(kinds), "each an FMU, wired" if system else "inside; their forces are outputs"),
    ]


def _advice(exported: Any, found: Any) -> list[Row]:
    """Steps of a co-simulation."""
    step = getattr(found, "step", None)
    if step is not None:
        return [
            ("step", f"{step:g} s", "of the default experiment; longer ones damp more, and blow up in the end")
        ]
    from fmu import BearingModel, RotorModel
    from fmu.steps import step_advice

    if isinstance(exported, BearingModel):
        return [("step", "1e-05 s", "of the default experiment; how long one may be: docs/coupling.md")]
    if isinstance(exported, RotorModel):
        return [("inner step", f"{exported.inner_step:g} s", "steps of the master are cut into such ones")]
    return step_advice(exported)


def _rows(found: Verification | SystemVerification | None, *, rotor: bool) -> list[Row]:
    """What the verification found."""
    if found is None:
        return [("verified", "no", "this machine can run no such FMU")]
    from fmu.system.check import SystemVerification

    if isinstance(found, SystemVerification):
        return [
            ("findings", str(len(found.findings)), "against the schema of the standard; there should be none"),
            (
                "deviation",
                f"{found.deviation:.1e}",
                "of the journal from simulate_rotor, over its way after a load step",
            ),
            ("verified", "yes", "and every FMU by itself"),
        ]
    findings = ("findings", str(len(found.findings)), "of fmpy's validation; there should be none")
    if found.bearing:
        run = f"largest error of forces and moments, over those in Python; {found.states} steps"
        moved = "largest error of the states' rates in model exchange, over those in Python"
        rates = [("rates", f"{found.rates:.1e}", moved)] if found.rates else []
        return [findings, ("forces", f"{found.bearing:.1e}", run), *rates, ("verified", "yes", "")]
    if rotor:
        return [
            findings,
            ("motion", f"{found.motion:.1e}", f"largest error, over that of simulate_rotor; {found.states} steps"),
            ("equations", f"{found.exchange:.1e}", "largest error of accelerations and rates of films"),
            ("verified", "yes", ""),
        ]
    return [
        findings,
        ("force", f"{found.force:.1e}", f"largest error, over the Python element's; {found.states} states"),
        ("tangents", f"{found.tangents:.1e}", "likewise"),
        ("verified", "yes", ""),
    ]
