"""Other programs that load FMUs: each runs ours, in the loop of every tutorial, as fmpy does.

They are of the extra ``importers``; CI installs it where it can be had.
"""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from other_masters import ecos

from fmu import export
from reduced_models import SpringContact

DEFAULT = 1.5  # lead
STEP = 0.01  # in units of 2a/u_sum
SPEED_OUTSIDE = pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
VALUES = ("approach", "rate", "force", "stiffness", "damping")


@contextmanager
def libcosimpy(path, step, inputs=VALUES[:2], outputs=VALUES) -> Iterator[Callable]:
    """Open Simulation Platform, on the FMI library of Modelon."""
    pytest.importorskip("libcosimpy")
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    execution = CosimExecution.from_step_size(round(step * 1e9))  # nanoseconds
    slave = execution.add_local_slave(CosimLocalSlave(fmu_path=str(path), instance_name="unit"))
    manipulator, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
    assert execution.add_manipulator(manipulator) and execution.add_observer(observer)
    known = {variable.name.decode(): variable.reference for variable in execution.slave_variables(slave)}

    def advance(*values):
        if inputs:
            assert manipulator.slave_real_values(slave, [known[name] for name in inputs], list(values))
        assert execution.step()
        return observer.last_real_values(slave, [known[name] for name in outputs])

    yield advance


@contextmanager
def ecospy(path, step, inputs=VALUES[:2], outputs=VALUES) -> Iterator[Callable]:
    program = ecos()
    structure = program.EcosSimulationStructure()
    structure.add_model("unit", str(path))
    with program.EcosSimulation(structure=structure, step_size=step) as simulation:
        simulation.init()

        def advance(*values):
            for name, value in zip(inputs, values, strict=True):
                simulation.set_real(f"unit::{name}", value)
            simulation.step()
            return [simulation.get_real(f"unit::{name}") for name in outputs]

        yield advance
        simulation.terminate()


@contextmanager
def by_fmpy(slave) -> Iterator[Callable]:
    def advance(approach, rate):
        slave.set(approach=approach, rate=rate)
        slave.step(STEP)
        return slave.get(*VALUES)

    yield advance


def mass_on(advance, steps=400):
    """A mass under its load, dropped on the contact: the motion, and what the FMU says of it."""
    u, v, mass, found = -0.6, 3.0, 0.04, []
    for _ in range(steps):
        found.append(advance(u, v))
        v += STEP * (1.0 - found[-1][2]) / mass
        u += STEP * v
    return found


@pytest.mark.parametrize("importer", [libcosimpy, ecospy])
def test_the_same_motion_as_by_fmpy(fmus, slave, importer):
    """Set, step, get, in contact and out of it."""
    with by_fmpy(slave("cubic", lead=DEFAULT)) as advance:
        expected = mass_on(advance)
    assert min(row[2] for row in expected) == 0.0 < max(row[2] for row in expected)  # it bounces
    with importer(fmus["cubic"], STEP) as advance:
        found = mass_on(advance)
    assert max(math.dist(one, other) for one, other in zip(found, expected, strict=True)) <= 1e-9


# A 6305 at 1 kN: the damping of C1 is what a loop must not lose
BALL = SpringContact.cubic(1.29e8, 0.0, 0.0, 44.0, 5e-6, 9e-6, units="SI")
MASS, LOAD = 10.0, 900.0  # kg, N


def damping_of_loop(advance, h, periods=40):
    """Damping [N s/m] of a mass on the FMU, and how its swing ends: mass and FMU step side by side.

    So the mass goes on by the force that the FMU had at the start of the step.
    """
    u0 = BALL.approach_at(LOAD)
    w = math.sqrt(BALL.spring_tangent(u0) / MASS)
    u, v, sizes = 0.999 * u0, 0.0, []
    force = BALL.force(u, v)
    for _ in range(round(periods * 2.0 * math.pi / w / h)):
        ahead = advance(u, v)[2]
        v += h * (LOAD - force) / MASS
        u += h * v
        force = ahead
        sizes.append(math.hypot(u - u0, v / w))
    return -2.0 * MASS * np.polyfit(h * np.arange(len(sizes)), np.log(sizes), 1)[0], sizes[-1] / sizes[0]


@pytest.mark.parametrize(("importer", "fmi"), [(libcosimpy, 2), (ecospy, 2), (ecospy, 3)])  # OSP knows no FMI 3
def test_the_loop_of_every_tutorial(tmp_path, importer, fmi):
    """Set, step, get, symplectic Euler: lead 1, set at export, keeps the damping at 1e-5 s; stable at 1e-4 s."""
    path = export(BALL, tmp_path / "ball.fmu", fmi=fmi, lead=1.0)
    with importer(path, 1e-5) as advance:
        damping, _ = damping_of_loop(advance, 1e-5)
    assert damping == pytest.approx(BALL.C1, rel=0.05)
    with importer(path, 1e-4) as advance:
        _, growth = damping_of_loop(advance, 1e-4)
    assert growth < 1.0


@SPEED_OUTSIDE
@pytest.mark.parametrize(("importer", "fmi"), [(libcosimpy, 2), (ecospy, 2), (ecospy, 3)])
def test_a_rotor_moves_as_by_fmpy(unit, instance, importer, fmi):
    """To the last bits of what each makes of the time."""
    names, step, steps = ("journal.x", "journal.y", "disc.x", "disc.y", "contact[1].force"), 1e-5, 200
    slave = instance("wide", fmi)
    slave.start()
    with importer(unit("wide", fmi).path, step, (), names) as advance:
        for _ in range(steps):
            slave.step(step)
            found = advance()
    assert found == pytest.approx(slave.get(*names), rel=1e-9, abs=1e-16)
