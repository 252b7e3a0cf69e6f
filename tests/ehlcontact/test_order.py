"""Order of accuracy: observed orders of every approximation, none of them a value."""

from itertools import pairwise
from math import log2, pi

import numpy as np
import pytest

from ehlcontact import (
    Domain,
    FreeVibration,
    Grid,
    HarmonicLoad,
    MoesPoint,
    PrescribedApproach,
    RampLoad,
    TimeSteps,
    simulate,
    solve_steady,
)
from ehlcontact.solver.level import Level
from ehlcontact.solver.mesh import Mesh
from ehlcontact.transient.record import History
from ehlcontact.transient.run import Run
from ehlcontact.transient.transient_film import TransientFilm

POINT = MoesPoint(200, 10, 0.5)
RAMP = RampLoad(1.3, 2.0, Omega_n=5.13)  # its corner lies beyond the end


def orders(errors):
    return np.log2(np.array(errors[:-1]) / np.array(errors[1:]))


def test_reynolds_operator_is_second_order():
    """Against the differential operator on smooth fields (Barus, incompressible), differentiated by hand."""
    point = MoesPoint(20, 5, 0.6, viscosity="barus", density="incompressible")
    errors = []
    for n in (32, 64, 128):
        level = Level(point, Domain(-2.0, 2.0, 2.0), n, n // 2)
        X, Y = np.meshgrid(level.X, level.Y)
        P, H = 0.3 + 0.2 * np.cos(X) * np.cos(Y), 0.5 + 0.1 * np.sin(X) * np.cos(Y)
        P_x, P_y = -0.2 * np.sin(X) * np.cos(Y), -0.2 * np.cos(X) * np.sin(Y)
        P_xx = P_yy = -0.2 * np.cos(X) * np.cos(Y)
        H_x, H_y = 0.1 * np.cos(X) * np.cos(Y), -0.1 * np.sin(X) * np.sin(Y)
        eps = H**3 * np.exp(-point.alpha_bar * P) / point.lam
        eps_x = eps * (3.0 * H_x / H - point.alpha_bar * P_x)
        eps_y = eps * (3.0 * H_y / H - point.alpha_bar * P_y)
        exact = eps_x * P_x + eps * P_xx + point.kappa**2 * (eps_y * P_y + eps * P_yy) - H_x - 0.8 * H
        f = level.fields
        f.P[...], f.H[...] = P, H
        level.c_t = 0.8
        level.update_residual()
        inner = (slice(0, -1), slice(n // 4, -1))  # the wedge is first order on the first line only
        errors.append(np.abs(-level.r - exact)[inner].max())
    assert (orders(errors) > 1.9).all()


@pytest.mark.parametrize("kappa", [0.2, 1.0])
def test_deflection_of_hertz_pressure(kappa):
    """Second order inside, away from the edge; the singular edge lowers it a little as grids align with it."""
    errors = []
    for n in (32, 64, 128):
        level = Level(MoesPoint(20, 5, kappa), Domain(-1.6, 1.6, 1.6), n, n // 2)
        level.set_dry_hertz()
        level.update_film(1.0)
        r = np.hypot(*np.meshgrid(level.X, level.Y))
        errors.append(np.abs(level.H[r < 0.8]).max())
    assert (orders(errors) > 1.8).all()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("M", "L", "kappa"), [(200, 10, 1.0), (200, 10, 0.5), (500, 15, 0.12), (58.07, 4.62, 1.0)]
)
def test_steady_film_is_second_order(steady, M, L, kappa):
    """Errors of approach and central film against n = 512 fall with order 1.8 or more from n = 64 to 256.

    Over two halvings together, and only errors that are not yet below 0.05 % on the coarse grid: their sign
    changes with the grid, so they have no order.
    """
    limit = steady(M, L, kappa, 512)
    for name in ("approach", "h_central"):
        coarse, fine = (abs(getattr(steady(M, L, kappa, n), name) - getattr(limit, name)) for n in (64, 256))
        assert 0.5 * log2(coarse / fine) >= 1.8 or coarse < 5e-4 * getattr(limit, name), name


NOT_YET = pytest.mark.xfail(
    strict=True,
    reason="1.5: the film is 1.8 % too thin at n = 64, 0.8 % too thick at 128 and 0.2 % at 256; the error comes "
    "from the flank of the pressure beside the side lobe, two cells wide at 128; near second order from 384 on",
)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("M", "L", "kappa"),
    [
        (200, 10, 1.0),
        pytest.param(200, 10, 0.5, marks=NOT_YET),
        (500, 15, 0.12),
        (58.07, 4.62, 1.0),
    ],
)
def test_smallest_film_is_second_order(steady, M, L, kappa):
    """Its error against n = 512 falls with order 1.8 or more from n = 64 to 256, over two halvings together."""
    limit = steady(M, L, kappa, 512).h_min
    coarse, fine = (abs(steady(M, L, kappa, n).h_min - limit) for n in (64, 256))
    assert 0.5 * log2(coarse / fine) >= 1.8


def test_time_steps_are_second_order():
    """u and force at fixed T of a free vibration, Delta T halved three times."""
    motion = FreeVibration(Omega_n=5.13)
    ends = []
    for steps in (20, 40, 80, 160):
        until = motion.period
        record = simulate(POINT, motion, grid=Grid(n=32), time=TimeSteps(until=until, dt=until / steps, tol=1e-7))
        assert record.steps == steps
        ends.append((record.approach[-1], record.force[-1]))
    differences = np.abs(np.diff(ends, axis=0))
    assert (np.log2(differences[:-1] / differences[1:]) >= 1.8).all()


@pytest.mark.slow
@pytest.mark.parametrize(
    "motion", [FreeVibration(Omega_n=5.13), HarmonicLoad(Omega=2.0 * pi), RAMP], ids=lambda m: m.kind
)
def test_uneven_time_steps_are_second_order(motion):
    """u, rate and force over the record, with steps that vary smoothly by a factor of four, halved three times."""
    until, histories = 1.2, []
    for steps in (48, 96, 192, 384):
        s = np.linspace(0.0, 1.0, steps + 1)
        T = until * (s - 0.6 * np.sin(2.0 * pi * s) / (2.0 * pi))
        run = Run(
            TransientFilm(POINT, Mesh(32, Domain(), POINT.kappa), 1e-6),
            motion,
            None,
            History(()),
            None,
            lambda run: None,
        )
        assert run.start().ok
        for before, after in pairwise(T):
            entry = run.advance(after, after - before)
            assert entry.step.status.ok
            run.keep(entry)
        columns = run.history.record(run.film.level).by_name()
        names = ("approach", "rate", "force") if motion.Omega_n else ("approach",)
        histories.append(np.array([columns[name][:: steps // 24] for name in names]))
    errors = np.abs(np.diff(histories, axis=0)).max(axis=-1)
    assert (np.log2(errors[:-1] / errors[1:]) >= 1.8).all()


@pytest.mark.long
def test_squeeze_term_is_second_order():
    """Film and force under a given smooth approach: without the motion equation, whose error would hide it."""
    u = solve_steady(POINT, grid=Grid(n=32), tol=1e-7).approach
    T = np.linspace(0.0, 1.25, 1001)
    motion = PrescribedApproach(T, u + 0.08 * np.sin(pi * T) ** 4)
    ends = []
    for steps in (50, 100, 200):
        record = simulate(POINT, motion, grid=Grid(n=32), time=TimeSteps(until=1.25, dt=1.25 / steps, tol=1e-8))
        ends.append((record.force[-1], record.h_midplane[-1, np.abs(record.x) < 1.0]))
    (force0, film0), (force1, film1), (force2, film2) = ends
    assert log2(abs((force0 - force1) / (force1 - force2))) >= 1.8
    assert log2(np.linalg.norm(film0 - film1) / np.linalg.norm(film1 - film2)) >= 1.8


def wave_speed(n):
    """Speed of a film bump made by a short approach, by the lag of best correlation between two times."""
    u = solve_steady(POINT, grid=Grid(n=n)).approach
    T = np.linspace(0.0, 2.0, 81)
    bump = 0.03 * np.where(T < 0.8, np.sin(np.pi * T / 0.8) ** 2, 0.0)
    record = simulate(POINT, PrescribedApproach(T, u + bump), grid=Grid(n=n))
    change = record.h_midplane - record.h_midplane[0]
    before, after = (change[int(np.argmin(np.abs(record.t - t)))] for t in (0.95, 1.35))
    X = np.linspace(-0.6, 0.35, 200)
    lags = np.linspace(0.2, 0.6, 401)
    seen = np.interp(X, record.x, before)
    match = [np.corrcoef(seen, np.interp(X + lag, record.x, after))[0, 1] for lag in lags]
    assert max(match) > 0.99
    return lags[int(np.argmax(match))] / 0.4


@pytest.mark.long
def test_film_travels_at_the_speed_of_the_surfaces():
    """dX/dT = 1, whatever the pressure, already on a coarse grid: the wedge term hardly disperses."""
    assert [wave_speed(n) for n in (64, 128)] == pytest.approx([1.0, 1.0], abs=0.01)
