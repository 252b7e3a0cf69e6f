"""Step and tolerance that a run takes by itself, and what is said of coarse ones."""

from dataclasses import replace
from math import inf, pi

import numpy as np
import pytest
from argument_groups import grouped

from ehlcontact import (
    Dent,
    FreeVibration,
    Grid,
    HarmonicLoad,
    InputError,
    MoesPoint,
    PrescribedApproach,
    PrescribedLoad,
    RampLoad,
    Roughness,
    TimeSteps,
    TransverseRidge,
    Waviness,
    read,
    save,
    simulate,
)
from ehlcontact.status import Status
from ehlcontact.transient.bodies import LONGEST_ABRUPT, LONGEST_SMOOTH
from ehlcontact.transient.features import require_surface
from ehlcontact.transient.settings import StepPlan
from ehlcontact.transient.time_step import (
    DEFAULT_TOL,
    FEWEST_STEPS,
    SMALLEST_TOL,
    STEPS_PER_WAVE,
    coarse_step_note,
    coarse_tolerance_note,
    default_fixed_step,
    default_tol,
)

POINT = MoesPoint(200, 10, 0.5)
COARSE = [0.0, 1.0, 2.0, 3.0, 4.0]
BENT = PrescribedLoad(COARSE, [1.0, 1.3, 1.0, 1.3, 1.0])
REST = PrescribedLoad(np.linspace(0.0, 3.0, 4), np.ones(4))
MESH = 0.05


@pytest.mark.parametrize(
    ("motion", "step"),
    [
        (HarmonicLoad(Omega=pi), 2.0 / 80),
        (HarmonicLoad(Omega=0.01), LONGEST_SMOOTH),
        (FreeVibration(Omega_n=0.01), LONGEST_SMOOTH),
        (BENT, LONGEST_ABRUPT),
        (PrescribedApproach(COARSE, [0.9, 1.0, 0.9, 1.0, 0.9]), LONGEST_ABRUPT),
        (RampLoad(2.0, 0.5, Omega_n=0.1), LONGEST_ABRUPT),
        (PrescribedLoad(np.linspace(0.0, 1.0, 101), np.linspace(1.0, 2.0, 101)), 0.01),  # the table is finer
    ],
)
def test_no_step_is_longer_than_the_film_allows(motion, step):
    assert default_fixed_step(motion, None, MESH) == pytest.approx(step)


@pytest.mark.parametrize(
    ("surface", "step"),
    [
        (Dent(0.1, 0.3), 0.03),
        (Dent(0.1, 0.3, speed=2.0), 0.015),
        (Dent(0.1, 0.3, speed=0.0), LONGEST_ABRUPT),  # at rest: nothing passes
        (Dent(0.1, 9.0), LONGEST_ABRUPT),
        (TransverseRidge(0.1, 0.8), 0.8 / STEPS_PER_WAVE),
        (Waviness(0.01, 0.4, speed=0.5), 0.8 / STEPS_PER_WAVE),
        (Roughness.synthetic(0.01, 2.0, 1.5, speed=2.0), MESH / 2.0),  # waves of all lengths: a node a step
        (Roughness.synthetic(0.01, 2.0, 1.5, speed=0.0), LONGEST_ABRUPT),
        (lambda X, Y, T: 0.0 * X, MESH),
    ],
)
def test_features_shorten_it(surface, step):
    assert default_fixed_step(REST, surface, MESH) == pytest.approx(step)
    assert default_fixed_step(HarmonicLoad(Omega=30.0), surface, MESH) == pytest.approx(
        min(step, 2.0 * pi / 30.0 / 80)
    )


def test_what_is_given_stays_and_an_early_end_is_met():
    assert StepPlan.of(BENT, TimeSteps(dt=1.0), longest=0.1).dT == 1.0
    assert StepPlan.of(BENT, TimeSteps(until=0.02), longest=0.1).dT == 0.02
    # steps under control of the error begin as the table says: a stop is a stop, and the film is looked at
    controlled = TimeSteps(local_error=1e-3)
    assert StepPlan.of(BENT, controlled, longest=0.1) == StepPlan.of(BENT, controlled)


def test_a_coarse_table_is_run_in_steps_that_show_the_film():
    found, fine, coarse = (
        simulate(POINT, BENT, grid=Grid(n=64), time=TimeSteps(dt=dT)) for dT in (None, 0.025, 1.0)
    )
    assert found.steps == 40 and coarse.steps == 4
    assert found.h_min.min() == pytest.approx(fine.h_min.min(), rel=5e-3)
    assert coarse.h_min.min() > 1.1 * fine.h_min.min()


@pytest.mark.long
def test_a_dent_passes_in_steps_that_show_it():
    found, fine = (
        simulate(POINT, REST, grid=Grid(n=64), time=TimeSteps(dt=dT), surface=Dent(0.1, 0.5, kappa=0.5))
        for dT in (None, 0.0125)
    )
    assert found.steps == 60
    assert found.h_central.max() == pytest.approx(fine.h_central.max(), rel=0.02)
    assert found.h_central.max() > 1.3 * found.h_central[0]


def test_few_steps_a_period_are_said_in_words():
    motion = HarmonicLoad(Omega=pi)
    few = simulate(POINT, motion, grid=Grid(n=64), time=TimeSteps(dt=0.2, until=2.0))
    assert few.reservation == (
        "the step is coarse: 10 to a period of the load; for damping take steps_per_period = 80"
    )
    assert few.reservation in repr(few) and few.to_dict()["reservation"] == few.reservation
    assert replace(few, status=Status.STAGNATED).reservation == ""
    for count in (FEWEST_STEPS - 1, FEWEST_STEPS, 80):
        assert bool(coarse_step_note(motion, np.arange(9) * 2.0 / count)) == (count < FEWEST_STEPS)
    assert coarse_step_note(FreeVibration(Omega_n=5.0), np.arange(9) * 1.0) == ""
    assert (
        coarse_step_note(motion, np.array([0.0, 0.1, 0.3, 0.5])) == ""
    )  # controlled: of the error that was asked for
    assert coarse_step_note(motion, np.array([0.0])) == ""


@pytest.mark.parametrize("surface", [Dent(0.01, 0.5), Roughness.synthetic(0.01, 2.0, 1.5)], ids=["dent", "rough"])
def test_a_feature_made_for_another_contact_is_warned_of(surface):
    """It would be an ellipse in metres; whoever wants that is not kept from it."""
    words = "^kappa = 1 of the surface is not that of the contact, 0.5: .* 2 times as long across as along"
    with pytest.warns(RuntimeWarning, match=words) as told:
        run = simulate(POINT, REST, grid=Grid(n=32), time=TimeSteps(until=0.1), surface=surface)
    assert run.status.ok and told[0].filename == __file__
    simulate(
        POINT, REST, grid=Grid(n=32), time=TimeSteps(until=0.1), surface=replace(surface, kappa=0.5003)
    )  # rounded


class Moving:
    def __call__(self, X, Y, T):
        return 0.0 * X


@pytest.mark.parametrize("surface", [None, Dent(0.1, 0.3), Moving(), lambda *places: 0.0, lambda X, Y, T=0.0: 0.0])
def test_surfaces_that_can_be_called(surface):
    require_surface(surface, POINT)


@pytest.mark.parametrize("surface", [lambda X, Y: 0.0 * X, Roughness, Dent, Moving, 1, "dent", np.zeros(3)])
def test_surfaces_that_cannot_are_one_line(surface):
    with pytest.raises(InputError, match=r"^surface = .*: must be a feature .*a function of X, Y and T, or None$"):
        simulate(POINT, REST, grid=Grid(n=16), surface=surface)


TIMES = np.linspace(0.0, 4.0, 81)


@pytest.mark.parametrize(
    ("motion", "size"),
    [
        (HarmonicLoad(Omega=pi, amplitude=0.02), 0.02),
        (HarmonicLoad(Omega=pi), 0.1),
        (FreeVibration(Omega_n=5.13), 0.1),
        (FreeVibration(Omega_n=0.7), 0.1),
        (FreeVibration(Omega_n=5.13, offset=-0.03), 0.03),
        (FreeVibration(Omega_n=2.0, offset=0.03, rate=0.04 * 1.5**0.5 * 2.0), 0.05),
        (RampLoad(0.96, 1.0, Omega_n=2.0), 0.04),
        (PrescribedLoad(TIMES, 1.2 + 0.01 * np.sin(pi * TIMES)), 0.01),
        (PrescribedLoad(TIMES, np.ones(TIMES.size)), inf),
        (RampLoad(1.0, 1.0, Omega_n=2.0), inf),
        (PrescribedApproach(TIMES, 0.87 + 0.001 * np.sin(pi * TIMES)), inf),
    ],
    ids=lambda x: getattr(x, "kind", x),
)
def test_size_of_a_motion_and_the_tolerance_it_gets(motion, size):
    assert motion.size == pytest.approx(size)
    expected = DEFAULT_TOL if size >= 0.1 else DEFAULT_TOL * size / 0.1
    assert default_tol(motion) == (expected if size >= 0.1 else pytest.approx(expected))
    assert coarse_tolerance_note(motion, default_tol(motion)) == ""


def test_tolerance_stays_above_rounding():
    faint = HarmonicLoad(Omega=pi, amplitude=1e-6)
    assert default_tol(faint) == SMALLEST_TOL
    assert "give tol = 3e-08" in coarse_tolerance_note(faint, SMALLEST_TOL)  # and what that leaves open is said


def damping(record, Omega):
    """C of the first harmonics of force and approach in the last period, beside which they may drift."""
    T = record.t[record.t > record.t[-1] - 2.0 * pi / Omega - 1e-9]
    basis = np.column_stack([np.exp(1j * Omega * T), np.exp(-1j * Omega * T), np.ones(T.size), T])
    u, f = (np.linalg.lstsq(basis, x[-T.size :] + 0j)[0][0] for x in (record.approach, record.force))
    return (f / u).imag / Omega


@pytest.mark.long
@pytest.mark.parametrize("amplitude", [0.01, 0.001])
def test_damping_of_small_loads_is_as_good_as_that_of_large_ones(amplitude):
    motion = HarmonicLoad(Omega=pi, amplitude=amplitude)
    found, closely = (simulate(POINT, motion, grid=Grid(n=32), time=TimeSteps(tol=tol)) for tol in (None, 1e-6))
    assert damping(found, pi) == pytest.approx(damping(closely, pi), rel=0.01)
    assert "tol" not in found.reservation
    if amplitude == 0.01:
        # Where steps are short the first cycle ends nearer than any tolerance asks; not so in twenty a period.
        coarse, closely = (
            simulate(POINT, motion, grid=Grid(n=32), time=TimeSteps(dt=0.1, tol=tol))
            for tol in (DEFAULT_TOL, 1e-6)
        )
        assert damping(coarse, pi) != pytest.approx(damping(closely, pi), rel=0.03)
        assert "to 1 % of it" in coarse.reservation
        assert coarse.reservation in repr(coarse)
        assert coarse.to_dict()["reservation"] == coarse.reservation


def test_given_tolerance_is_kept_and_stored(tmp_path):
    motion = HarmonicLoad(Omega=pi, amplitude=0.02)
    given, own, controlled = (
        simulate(POINT, motion, **grouped(n=32, until=0.1, **how))
        for how in (dict(tol=2e-3), {}, dict(local_error=1e-5))
    )
    assert (given.tol, own.tol, controlled.tol) == (2e-3, pytest.approx(6e-4), pytest.approx(3e-5))
    again = read(save(given, tmp_path / "run.h5"))
    assert (again.tol, again.reservation) == (given.tol, given.reservation)
    assert again.reservation
