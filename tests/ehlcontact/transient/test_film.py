"""How a step begins: the state that the last ones predict."""

from math import pi
from unittest import mock

import numpy as np
import pytest

from ehlcontact import FreeVibration, Grid, HarmonicLoad, MoesPoint
from ehlcontact.solver.mesh_choice import Purpose, mesh_for
from ehlcontact.transient.record import History
from ehlcontact.transient.run import Run, march_fixed
from ehlcontact.transient.transient_film import TransientFilm, extrapolate

POINT = MoesPoint(200, 10, 0.5)
STEPS = (0.2, 0.35, 0.1)  # latest first


@pytest.mark.parametrize("order", [1, 2, 3])
def test_as_many_values_as_a_polynomial_needs_give_it(order):
    def value(t):
        return np.array([2.0, -1.0]) + sum(c * t**k for k, c in enumerate((-3.0, 1.5, 4.0)[:order], start=1))

    times = -np.cumsum(STEPS[:order])
    ahead = extrapolate(0.3, value(0.0), STEPS[:order], [value(t) for t in times])
    assert ahead == pytest.approx(value(0.3), rel=1e-13)
    alone = extrapolate(0.3, float(value(0.0)[0]), STEPS, [float(value(t)[0]) for t in times])
    assert alone == pytest.approx(ahead[0], rel=1e-13)


def starts_and_ends(motion, steps):
    """Approach that the first cycle of every step begins with, and that at its end."""
    film = TransientFilm(
        POINT, mesh_for(POINT, Purpose.RUN, grid=Grid(n=64), largest_load=motion.largest_load), 3e-3
    )
    run = Run(film, motion, None, History(()), None, lambda run: None)
    run.start()
    solve, found = film._solve, []

    def watched(balance, most):
        start = film.u
        step = solve(balance, most)
        found.append((start, film.u))
        return step

    with mock.patch.object(film, "_solve", watched):
        march_fixed(run, steps, motion.default_step)
    return np.transpose(found), [entry.step.cycles for entry in run.history.entries[1:]]


def test_a_load_alone_leaves_the_approach_to_the_past():
    (start, end), cycles = starts_and_ends(HarmonicLoad(Omega=2.0 * pi), 40)
    assert np.abs(start - end)[10:].max() < 1e-4 * np.ptp(end)  # by the last rate alone 6e-3
    assert np.mean(cycles[10:]) < 1.5


def test_bodies_with_inertia_say_where_they_go():
    (start, end), cycles = starts_and_ends(FreeVibration(Omega_n=5.13), 40)
    assert np.abs(start - end)[10:].max() < 3e-4 * np.ptp(end)
    assert np.mean(cycles[10:]) < 1.5
