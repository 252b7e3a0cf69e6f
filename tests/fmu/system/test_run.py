"""System archives in the masters of others, as they are, beside `simulate_rotor`.

Ecos and the Open Simulation Platform are of the extra ``importers``.
"""

import numpy as np
import pytest
from other_masters import ecospy, libcosimpy, ours

from fmu.system.export import export_verified_system
from fmu.system.master import SystemRun
from fmu.system.parts import RotorSystem
from reduced_models import SpringContact, jeffcott_rotor, simulate_rotor

STEP, UNTIL = 5e-6, 0.02  # s: one turn
JOURNAL = ("journal.x", "journal.y")


def ecospy_with_its_parameter_set(*run):
    return ecospy(*run, "start")


def reference(system):
    """Journal of `simulate_rotor` in half the steps, at the times of the systems."""
    rotor = system.rotor.on([mount.contact.copy() for mount in system.rotor.contacts])
    return simulate_rotor(rotor, dt=0.5 * STEP, until=UNTIL, tolerance=1e-9).journal[::2]


@pytest.fixture(scope="module")
def python(system):
    """The reference, and its orbit."""
    fine = reference(system)
    return fine, np.ptp(fine, axis=0)


@pytest.fixture(scope="module")
def upright(system_3):
    """That of the rotor that moves in y only."""
    return reference(system_3)[:, 1:]


@pytest.mark.parametrize("master", [ours, ecospy, ecospy_with_its_parameter_set, libcosimpy])
def test_runs_as_it_is(system, python, master):
    """Journal within 0.1 % of its orbit, in either direction, at the default step."""
    expected, orbit = python
    found = master(system.path, STEP, round(UNTIL / STEP), "rotor", JOURNAL)
    assert orbit.min() > 0.0
    assert np.all(np.abs(found - expected[-len(found) :]) <= 1e-3 * orbit)


@pytest.mark.long
@pytest.mark.parametrize("master", [ours, ecospy])
def test_fmi_3(system_3, upright, master):
    found = master(system_3.path, STEP, round(UNTIL / STEP), "rotor", JOURNAL[1:])
    assert np.ptp(upright) > 0.0
    assert np.all(np.abs(found - upright) <= 1e-3 * np.ptp(upright))


def test_it_stands_still_without_unbalance(system, tmp_path):
    """What it starts from is an equilibrium of the FMUs, not only of the Python elements."""
    with SystemRun(system.path.read_bytes(), {"rotor": {"unbalance[1]": 0.0}}) as run:
        journal = run.run(STEP, 500, [("rotor", name) for name in JOURNAL])
    assert np.all(np.abs(journal - journal[0]) <= 1e-9 * np.abs(journal[0]).max())


@pytest.mark.parametrize("master", [ours, ecospy, libcosimpy])
def test_error_goes_down_with_the_step(system, python, master):
    """Of second order about, until the steps of the reference show."""
    expected, orbit = python
    errors = []
    for part in (0.5, 2.0):
        found = master(system.path, part * STEP, round(UNTIL / STEP / part), "rotor", JOURNAL)
        if part == 0.5:
            found, there = found[len(found) % 2 == 0 :: 2], expected
        else:
            there = expected[::2]
        errors.append(float((np.abs(found - there[-len(found) :]) / orbit).max()))
    assert errors[0] < 0.3 * errors[1]


@pytest.mark.long
def test_default_step_leaves_the_damping(tmp_path):
    """A journal on one contact that hardly damps, its disc held by a soft shaft: the decay of its vibration."""
    element = SpringContact.cubic(1e8, 0.0, 0.0, 5.0, 3e-6, 9e-6, units="SI")
    rotor = jeffcott_rotor(
        bearings=1, disc_mass=1e3, journal_mass=1.0, shaft_stiffness=1e4, gravity=(0.0, 0.0), load=(0.0, -500.0)
    )
    rotor = rotor.on([element])
    path, found = export_verified_system(RotorSystem.of(rotor), tmp_path / "x.ssp")
    (_, y), w = rotor.equilibrium(), 1e4  # rad/s
    with SystemRun(path.read_bytes(), {"rotor": {"journal.velocity_y": 1e-3 * abs(y) * w}}) as run:
        steps = round(20.0 * 2.0 * np.pi / w / found.step)
        rows = run.run(found.step, steps, [("rotor", "journal.y"), ("rotor", "journal.velocity_y")])
    swing = np.hypot(rows[:, 0] - y, rows[:, 1] / w)
    damping = -2.0 * np.polyfit(found.step * np.arange(swing.size), np.log(swing), 1)[0]
    assert damping == pytest.approx(element.C1, rel=0.05)


def test_default_step(system):
    """That of the archive, which the Open Simulation Platform takes."""
    assert RotorSystem.of(system.rotor).default_step() == STEP
    pytest.importorskip("libcosimpy")
    from libcosimpy.CosimExecution import CosimExecution

    execution = CosimExecution.from_ssp_file(str(system.path))
    assert execution.step()
    assert execution.status().current_time == round(STEP * 1e9)  # ns
