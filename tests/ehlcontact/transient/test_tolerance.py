"""The tolerance of a run follows its motion, and one that is coarse for it says so."""

from math import inf, pi
from pathlib import Path

import numpy as np
import pytest
from argument_groups import grouped

from ehlcontact import (
    FreeVibration,
    Grid,
    HarmonicLoad,
    MoesPoint,
    PrescribedApproach,
    PrescribedLoad,
    RampLoad,
    TimeSteps,
    load,
    save,
    simulate,
)
from ehlcontact.transient.time_step import DEFAULT_TOL, SMALLEST_TOL, coarse_tolerance_note, default_tol

POINT = MoesPoint(200, 10, 0.5)
T = np.linspace(0.0, 4.0, 81)


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
        (PrescribedLoad(T, 1.2 + 0.01 * np.sin(pi * T)), 0.01),
        (PrescribedLoad(T, np.ones(T.size)), inf),
        (RampLoad(1.0, 1.0, Omega_n=2.0), inf),
        (PrescribedApproach(T, 0.87 + 0.001 * np.sin(pi * T)), inf),
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
    T = record.T[record.T > record.T[-1] - 2.0 * pi / Omega - 1e-9]
    basis = np.column_stack([np.exp(1j * Omega * T), np.exp(-1j * Omega * T), np.ones(T.size), T])
    u, f = (np.linalg.lstsq(basis, x[-T.size :] + 0j)[0][0] for x in (record.approach, record.force))
    return (f / u).imag / Omega


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
    again = load(save(given, tmp_path / "run.h5"))
    assert (again.tol, again.reservation) == (given.tol, given.reservation)
    assert again.reservation


def test_results_of_old_files_say_nothing_of_it():

    old = load(Path(__file__).parents[2] / "data" / "simulation.h5")
    assert old.tol is None
    assert old.reservation == ""
    assert old.to_dict()["tol"] is None
