"""Other programs that load FMUs: each runs ours, in the loop of every tutorial, as fmpy does.

They are of the extra ``importers``; CI installs it where it can be had.
"""

import ctypes
import math
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

STEP = 0.01  # in units of 2a/u_sum
VALUES = ("approach", "rate", "force", "stiffness", "damping")


@contextmanager
def libcosimpy(path) -> Iterator[Callable]:
    """Open Simulation Platform, on the FMI library of Modelon."""
    pytest.importorskip("libcosimpy")
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    execution = CosimExecution.from_step_size(STEP * 1e9)  # nanoseconds
    slave = execution.add_local_slave(CosimLocalSlave(fmu_path=str(path), instance_name="contact"))
    manipulator, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
    assert execution.add_manipulator(manipulator) and execution.add_observer(observer)
    known = {variable.name.decode(): variable.reference for variable in execution.slave_variables(slave)}
    reference = [known[name] for name in VALUES]

    def advance(approach, rate):
        assert manipulator.slave_real_values(slave, reference[:2], [approach, rate])
        assert execution.step()
        return observer.last_real_values(slave, reference)

    yield advance


@contextmanager
def ecospy(path) -> Iterator[Callable]:
    """Ecos, on fmi4c; its library wants libtbb.so.12, of the system or of the package ``tbb``."""
    for library in (Path(sys.prefix) / "lib").glob("libtbb.so.12"):
        ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    try:
        from ecospy import EcosSimulation, EcosSimulationStructure
    except (ImportError, OSError) as error:
        pytest.skip(f"no ecospy ({error})")
    structure = EcosSimulationStructure()
    structure.add_model("contact", str(path))
    with EcosSimulation(structure=structure, step_size=STEP) as simulation:
        simulation.init()

        def advance(approach, rate):
            simulation.set_real("contact::approach", approach)
            simulation.set_real("contact::rate", rate)
            simulation.step()
            return [simulation.get_real(f"contact::{name}") for name in VALUES]

        yield advance
        simulation.terminate()


def mass_on(advance, steps=400):
    """A mass under its load, dropped on the contact: the motion, and what the FMU says of it."""
    u, v, mass, found = -0.6, 3.0, 0.04, []
    for _ in range(steps):
        found.append(advance(u, v))
        v += STEP * (1.0 - found[-1][2]) / mass
        u += STEP * v
    return found


@pytest.mark.parametrize("master", [libcosimpy, ecospy])
def test_the_loop_of_every_tutorial(fmus, slave, master):
    """Set, step, get: the same motion as by fmpy."""
    unit = slave("cubic")

    def advance_by_fmpy(approach, rate):
        unit.set(approach=approach, rate=rate)
        unit.step(STEP)
        return unit.get(*VALUES)

    expected = mass_on(advance_by_fmpy)
    assert min(row[2] for row in expected) == 0.0 < max(row[2] for row in expected)  # it bounces
    with master(fmus["cubic"]) as advance:
        found = mass_on(advance)
    worst = max(math.dist(one, other) for one, other in zip(found, expected, strict=True))
    assert worst <= 1e-9


def test_fmutool_has_nothing_to_say(fmus, kind):
    pytest.importorskip("fmu_manipulation_toolbox")
    program = Path(sys.executable).with_name("fmutool")
    line = [str(program), "-input", str(fmus[kind]), "-check"]
    done = subprocess.run(line, capture_output=True, text=True, check=False, timeout=120)
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    assert "compliant with FMI-2.0" in said and "No semantic error" in said
    assert "WARNING" not in said and "ERROR" not in said
