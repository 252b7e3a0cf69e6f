"""The cubic element as an FMU, beside the same formula as an FMU of pythonfmu: a step from C, and one under fmpy.

    python tests/benchmarks/fmu_python.py        # in an environment that has pythonfmu

Both run the usual loop: set approach and rate, doStep, get the force. Processor microseconds of a step, medians.
"""

from __future__ import annotations

import os
import shutil
import statistics
import subprocess
import sys
import sysconfig
import tempfile
from itertools import pairwise
from pathlib import Path

import fmpy
import numpy as np
from conv import Clock
from fmpy.fmi2 import FMU2Slave
from fmu_steps import (
    AMPLITUDE,
    MEAN,
    OUTPUTS,
    PERIODS,
    STEP,
    STEPS_PER_PERIOD,
    command,
    median_step,
    subject,
    timer,
)

from fmu import export_contact
from fmu.binaries import this_machine

SLOWER = 200  # times fewer periods for an FMU in Python
ROUNDS = 7  # of a period, under fmpy
HELD = 3  # input_meaning of an FMU that pythonfmu makes

MODEL = """
from pythonfmu import Fmi2Causality, Fmi2Slave, Real


class Python(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.approach, self.rate, self.force = 0.87, 0.0, 0.0
        for name, causality in (("approach", "input"), ("rate", "input"), ("force", "output")):
            self.register_variable(Real(name, causality=Fmi2Causality[causality]))

    def do_step(self, current_time, step_size):
        u, v = self.approach, self.rate
        if {low} <= u <= {high}:
            force = u * ({K1} + u * ({K2} + u * {K3}))
        elif u > {high}:
            force = {A_high} * (u - {o_high}) ** 1.5
        else:
            force = {A_low} * max(u - {o_low}, 0.0) ** 1.5
        share = min(max((u - {o_low}) / ({low} - {o_low}), 0.0), 1.0)
        self.force = max(0.0, force + {C1} * share * share * (3.0 - 2.0 * share) * v)
        return True
"""


def python_fmu(folder: Path) -> Path | None:
    """The FMU of pythonfmu; None where there is no such package."""
    places = [str(Path(sys.executable).parent), os.environ.get("PATH", "")]
    program = shutil.which("pythonfmu", path=os.pathsep.join(places))
    if program is None:
        return None
    element = subject("cubic")
    numbers = dict(element.parameters) | {"low": element.low, "high": element.high}
    for end in ("low", "high"):
        at = numbers[end]
        force, slope = float(element.spring(at)), float(element.spring_tangent(at))
        numbers[f"o_{end}"] = at - 1.5 * force / slope
        numbers[f"A_{end}"] = force / (at - numbers[f"o_{end}"]) ** 1.5
    source = folder / "python.py"
    source.write_text(MODEL.format(**{name: repr(float(value)) for name, value in numbers.items()}), "utf-8")
    subprocess.run([program, "build", "-f", source, "-d", folder], check=True, capture_output=True)
    return folder / "Python.fmu"


def loaded(fmu: Path, folder: Path) -> FMU2Slave:
    """A slave of fmpy, started."""
    fmpy.extract(str(fmu), unzipdir=str(folder))
    description = fmpy.read_model_description(str(folder))
    slave = FMU2Slave(
        guid=description.guid, unzipDirectory=str(folder), instanceName="timed",
        modelIdentifier=description.coSimulation.modelIdentifier,
    )  # fmt: skip
    slave.instantiate()
    for variable in description.modelVariables:
        if variable.name == "input_meaning":
            slave.setInteger([variable.valueReference], [HELD])
    slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    return slave


def under_fmpy(fmu: Path, folder: Path) -> tuple[float, np.ndarray]:
    """Microseconds of a step under fmpy, and the forces of a period."""
    slave = loaded(fmu, folder)
    t = STEP * np.arange(ROUNDS * STEPS_PER_PERIOD + 1)
    angle = 2.0 * np.pi * t / (STEP * STEPS_PER_PERIOD)
    rate = 2.0 * np.pi / (STEP * STEPS_PER_PERIOD)
    motion = np.column_stack([MEAN + AMPLITUDE * np.sin(angle), AMPLITUDE * rate * np.cos(angle)]).tolist()
    forces, spent = [], []
    for k, (now, after) in enumerate(pairwise(t.tolist())):
        with Clock() as clock:
            slave.setReal([0, 1], motion[k])
            slave.doStep(currentCommunicationPoint=now, communicationStepSize=after - now)
            forces += slave.getReal([2])
        spent.append(clock.cpu)
    slave.terminate()
    slave.freeInstance()
    return 1e6 * statistics.median(spent), np.array(forces)


def from_c(fmu: Path, folder: Path, program: Path, ours: bool) -> float:
    """Microseconds of a step from C."""
    description, machine = fmpy.read_model_description(str(fmu)), this_machine()
    assert machine is not None
    name = description.coSimulation.modelIdentifier
    library = folder / "binaries" / str(machine.fmi2) / f"{name}{machine.suffix}"
    reference = {v.name: v.valueReference for v in description.modelVariables}.get("input_meaning", -1)
    python = Path(sysconfig.get_config_var("LIBDIR")) / str(sysconfig.get_config_var("LDLIBRARY"))
    # pythonfmu leaves it to the importer to have a Python
    more = {} if ours else {"LD_PRELOAD": str(python), "PYTHONHOME": sys.base_prefix}
    line = command(
        program, library, description.guid, (folder / "resources").as_uri(), (HELD, reference, OUTPUTS["cubic"]),
        PERIODS["cubic"] // (1 if ours else SLOWER),
    )  # fmt: skip
    return float(median_step(line, more)["us"])


def compared(folder: Path) -> tuple[dict[str, dict[str, float]], float] | None:
    """Microseconds of a step by way and by FMU, and how far the forces differ; None without pythonfmu."""
    theirs = python_fmu(folder)
    if theirs is None:
        return None
    fmus = {"ours": export_contact(subject("cubic"), folder / "ours.fmu"), "pythonfmu": theirs}
    program = timer(folder)
    found: dict[str, dict[str, float]] = {"from C": {}, "under fmpy": {}}
    forces = {}
    for label, fmu in fmus.items():
        found["under fmpy"][label], forces[label] = under_fmpy(fmu, folder / label)
        found["from C"][label] = from_c(fmu, folder / label, program, label == "ours")
    return found, float(np.abs(forces["ours"] - forces["pythonfmu"]).max())


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory() as name:
        measured = compared(Path(name))
    if measured is None:
        sys.exit("pythonfmu is not installed here: pip install pythonfmu")
    found, gap = measured
    for way, us in found.items():
        ratio = us["pythonfmu"] / us["ours"]
        print(f"{way:10s} ours {us['ours']:8.3f} us, pythonfmu {us['pythonfmu']:8.3f} us, {ratio:.1f} times")
    share = 1.0 - found["from C"]["ours"] / found["under fmpy"]["ours"]
    print(f"{100 * share:.1f} % of our time under fmpy is fmpy's own; forces differ by {gap:.1e}")


if __name__ == "__main__":
    main()
