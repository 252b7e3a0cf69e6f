"""Settledness of constructed histories, and of rotors on elements."""

from dataclasses import replace

import numpy as np
import pytest
from rotor_twins import SCALES, C, K, omega_of, one_mass, run_of

from ehlcontact import InputError
from reduced_models import SpringContact
from reduced_models.rotor.baselines import dry_contact
from reduced_models.rotor.settling import QUIET, run_until_settled, settling

STEPS = 40


def history(transient, revolutions=4, drift=0.0):
    """Journal of a rotor at 3000 rpm: 1 um at 1x, and a part that falls by the factor `transient` per turn."""
    t = np.arange(revolutions * STEPS + 1) * 0.02 / STEPS
    turn = t / 0.02
    y = np.sin(2.0 * np.pi * turn) + 0.5 * transient**turn * np.sin(2.0 * np.pi * 3.3 * turn) + drift * turn
    plane = np.column_stack([np.zeros_like(y), 1e-6 * y])
    column = (50.0 + y)[:, None]
    moving = {"displacement": plane, "velocity": plane, "names": ("disc x", "disc y"), "places": np.array([0, 1])}
    return run_of(t, column, column, column, **moving)


def test_periodic_motion_is_settled_at_once():
    found = settling(history(0.0))
    assert len(found.changes) == 3 and found.settled
    assert found.changes[2] < 1e-10 and found.to_dict()["settled"] is True
    assert settling(history(0.0, drift=1e-3)).changes[-1] == pytest.approx(1e-3 * np.sqrt(2.0), rel=0.01)


def test_where_a_transient_ends():
    """A tenth per turn: the changes fall by ten each, and the run counts as settled from the first below 1 %."""
    found = settling(history(0.1, revolutions=6))
    ratios = np.array(found.changes[1:]) / found.changes[:-1]
    assert ratios == pytest.approx(0.1, rel=0.15)  # 3.3 turns are not whole, so that the phase has a say
    first = next(k for k, change in enumerate(found.changes) if change <= 0.01)
    assert found.settled_from == first > 0 and found.last_change == found.changes[-1]
    assert settling(history(0.1, revolutions=6), limit=1e-9).settled_from is None


def test_a_run_that_does_not_settle():
    found = settling(history(1.0))
    assert not found.settled and found.settled_from is None and found.last_change > 0.1
    grows = settling(history(0.0, drift=0.1))
    assert not grows.settled
    assert settling(history(0.0, revolutions=1)).last_change is None
    assert not settling(history(0.0, revolutions=1)).settled


def test_settled_again_after_a_disturbance():
    """Only what follows the last disturbance counts."""
    run = history(0.0, revolutions=6)
    force = run.force.copy()
    force[3 * STEPS + 5] += 2.0
    found = settling(replace(run, force=force))
    assert found.changes[0] < 0.01 < found.changes[2] and found.settled_from == 4


def test_part_of_a_run():
    run = history(0.0)
    part = run.part(STEPS, 2 * STEPS, keep_time=False)
    assert part.t.size == STEPS + 1 and part.t[0] == 0.0
    assert np.array_equal(part.force, run.force[STEPS : 2 * STEPS + 1])
    assert run.part(STEPS).t[0] == run.t[STEPS]


@pytest.mark.parametrize("damping", [0.0, C])
def test_elements_turn_until_they_have_settled(damping):
    """From rest, not from the orbit: the shaft's damping alone takes many revolutions, and gets them."""
    element = SpringContact.linear(K, damping, low=1e-8, high=1e-4, units="SI")
    rotor = one_mass(disc_mass=1.5, journal_mass=0.5, shaft_stiffness=2e8, shaft_damping=100.0).on([element])
    start = rotor.equilibrium(), np.zeros(2)
    run = run_until_settled(rotor, steps=STEPS, revolutions=2, start=start, tolerance=1e-10)
    assert run.t.size == 2 * STEPS + 1 and run.t[0] == 0.0
    assert settling(run).last_change <= QUIET
    swing = 4e-5 * omega_of(rotor) ** 2 / (2.0 * K)
    assert np.ptp(run.journal[:, 1]) / 2.0 == pytest.approx(swing, rel=0.02)


def test_settling_needs_whole_revolutions():
    run = history(0.0)
    with pytest.raises(InputError, match="steps per revolution"):
        settling(replace(run, t=run.t * 1.01))
    with pytest.raises(InputError, match="turning"):
        settling(replace(run, speed_rpm=0.0 * run.t))
    rotor = one_mass().on([dry_contact(SCALES)])
    with pytest.raises(InputError, match="steps"):
        run_until_settled(rotor, steps=4, revolutions=2, start=np.zeros((2, 2)))
    with pytest.raises(InputError, match=r"speed_rpm = 0: must be > 0"):
        run_until_settled(replace(rotor, speed_rpm=0), steps=40, revolutions=2, start=np.zeros((2, 2)))


def test_the_signal_that_settles_last_decides():
    """A force that drifts beside displacements that repeat: one of four signals that move."""
    still = history(0.0)
    drifting = replace(still, force=still.force + 0.01 * still.t[:, None] / 0.02)
    expected = 0.01 * np.sqrt(2.0)  # over the standard deviation of a wave of amplitude 1
    assert settling(drifting).changes == pytest.approx([expected] * 3, rel=0.01)
