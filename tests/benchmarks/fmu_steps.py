"""Steps of FMUs, timed from C: fmi2SetReal of approach and rate, fmi2DoStep, fmi2GetReal, as in the usual loop."""

from __future__ import annotations

import os
import statistics
import subprocess
import tempfile
from collections.abc import Mapping
from pathlib import Path

from conv import Bracket, circumstances
from row_file import Row

from ehlcontact import MoesPoint
from ehlcontact.binaries import this_machine
from ehlcontact.binaries.compiler import compilers
from fmu.archive import content_guid, fmu_files
from fmu.contact_spec import contact_spec
from fmu.contact_variables import Element
from fmu.sources import standard_folder
from reduced_models import Atlas, SpringContact

# Motion about the place of the static load, over 2a/u_sum: u = 0.87 + 0.2 sin 2.5 T in steps of 0.02.
STEP, MEAN, AMPLITUDE, STEPS_PER_PERIOD = 0.02, 0.87, 0.2, 126
PERIODS = {"cubic": 20_000, "film": 2_000}  # of a repetition: a tenth of a second
OUTPUTS = {"cubic": 1, "film": 3}  # force; with its tangents
REPETITIONS = 21
MILLION = 10**6


def subject(kind: str) -> Element:
    """The element: the cubic one of Nonato and Cavalca (2010), table 3; one with a film memory of 14 lags."""
    if kind == "cubic":
        return SpringContact.cubic(K1=0.624, K2=0.750, K3=-0.174, C1=0.0130, low=0.75, high=1.0)
    return Atlas().element(MoesPoint(200, 10, 0.5), model="wide")


def fmu_steps(kind: str, lead: float) -> Row:
    """A million steps of an FMU, with that lead; ``us`` are processor microseconds of one."""
    with tempfile.TemporaryDirectory() as folder:
        timed = prepare(kind, lead, Path(folder))
        with Bracket() as bracket:
            row = median_step(timed)
        return bracket.ratios(row) | circumstances()


def prepare(kind: str, lead: float, folder: Path) -> list[str]:
    """The command that times an FMU, both compiled here."""
    machine, spec = this_machine(), contact_spec(subject(kind), kind)
    if machine is None:
        raise RuntimeError("FMUs are not built for this machine")
    files = fmu_files(spec, (machine,), 2)
    library = folder / f"{kind}{machine.suffix}"
    library.write_bytes(files[f"binaries/{machine.folder(2)}/{library.name}"])
    asked = (lead, spec["lead"].value_reference, OUTPUTS[kind])
    return command(timer(folder), library, content_guid(spec, 2), "", asked, PERIODS[kind])


def timer(folder: Path) -> Path:
    """The program that times, compiled into `folder`."""
    machine = this_machine()
    assert machine is not None
    program, source = folder / "fmu_steps", Path(__file__).with_suffix(".c")
    line = [*compilers(machine)[0].command, "-std=c99", "-O2", "-I", str(standard_folder()), str(source)]
    subprocess.run([*line, "-o", str(program), "-lm", "-ldl"], check=True)
    return program


def command(
    program: Path, library: Path, guid: str, resources: str, asked: tuple[float, int, int], periods: int
) -> list[str]:
    """Its command line; `asked`: lead, its value reference (-1 for none), number of outputs."""
    motion = (STEP, MEAN, AMPLITUDE, STEPS_PER_PERIOD, periods, REPETITIONS)
    return [str(program), str(library), guid, resources, *map(str, (*asked, *motion))]


def median_step(timed: list[str], more: Mapping[str, str] | None = None) -> Row:
    """Wall and processor seconds of a million steps, medians; `more` is added to the environment."""
    told = subprocess.run(timed, capture_output=True, text=True, check=True, env=os.environ | dict(more or {}))
    wall, cpu = zip(*(map(float, line.split()) for line in told.stdout.splitlines()), strict=True)
    spent = MILLION * statistics.median(cpu)
    return {"seconds": MILLION * statistics.median(wall), "cpu": spent, "us": spent}
