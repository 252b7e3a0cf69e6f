"""Rough surfaces: heights and spectrum, measured maps, what a run asks of them, the film over them."""

from dataclasses import replace
from itertools import pairwise
from math import log, pi

import numpy as np
import pytest
from argument_groups import grouped

from ehlcontact import (
    Domain,
    Geometry,
    InputError,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    PrescribedLoad,
    Roughness,
    simulate,
)
from ehlcontact.transient.features import surface_step

POINT = MoesPoint(200.0, 10.0, 1.0)
NEAR = Domain(-2.5, 1.5, 2.0)
MADE = {"rq": 0.01, "longest_wavelength": 0.5, "shortest_wavelength": 0.1, "length": 4.0, "width": 2.0}


@pytest.fixture(scope="module")
def made():
    return Roughness.synthetic(**MADE, seed=1)


def whole(rough):
    """Heights for both signs of Y, one period of each direction."""
    return np.concatenate([rough.heights, rough.heights[:, -2:0:-1]], axis=1)


def spectrum(rough):
    """Power of every wave, and its wave number per semi-axis a."""
    table = whole(rough)
    power = np.abs(np.fft.rfft2(table)) ** 2 / table.size**2
    along = np.fft.fftfreq(table.shape[0], rough.dx)
    across = rough.kappa * np.fft.rfftfreq(table.shape[1], rough.dy)
    return np.hypot(along[:, None], across), power


def at(rough, X, Y, T=0.0):
    """Height out of the surface on a grid."""
    return -rough(np.asarray(X, dtype=float)[None, :], np.asarray(Y, dtype=float)[:, None], T)


def test_made_heights_are_what_was_asked_for(made):
    table = whole(made)
    assert np.sqrt(np.mean(table**2)) == pytest.approx(0.01, rel=1e-12)
    assert abs(table.mean()) < 1e-15
    # Gaussian: the fourth moment of so many independent summits
    assert np.mean(table**4) / 0.01**4 == pytest.approx(3.0, abs=0.3)
    waves, power = spectrum(made)
    assert power[waves > 10.0 * (1.0 + 1e-9)].max() < 1e-20 < power[(waves > 9.0) & (waves < 10.0)].mean()
    # q^(-2 (1 + 0.8)) between 2 and 10 per semi-axis, flat below
    bands = [power[(waves > low) & (waves < low * 1.25)].mean() for low in (2.0, 4.0, 8.0)]
    for coarse, fine in pairwise(bands):
        assert log(coarse / fine, 2.0) == pytest.approx(3.6, abs=0.5)
    assert power[(waves > 0.0) & (waves < 1.2)].mean() == pytest.approx(
        power[(waves > 1.2) & (waves < 2.0)].mean(), rel=0.4
    )


def test_same_seed_same_surface(made):
    np.testing.assert_array_equal(Roughness.synthetic(**MADE, seed=1).heights, made.heights)
    other = Roughness.synthetic(**MADE, seed=2).heights
    assert abs(np.corrcoef(other.ravel(), made.heights.ravel())[0, 1]) < 0.2


@pytest.mark.parametrize("kappa", [0.25, 1.0])
def test_waves_are_as_long_across_as_along_in_metres(kappa):
    rough = Roughness.synthetic(0.01, 0.5, 0.1, length=8.0, width=4.0, seed=3, kappa=kappa)
    slope_along = np.diff(rough.heights, axis=0) / rough.dx
    slope_across = np.diff(rough.heights, axis=1) / (rough.dy / kappa)
    assert slope_across.std() == pytest.approx(slope_along.std(), rel=0.06)


def test_heights_on_samples_and_between(made):
    """The spline meets its samples, and between them the Fourier sum of the map, within 3e-4 of their rms."""
    behind = np.arange(40, 90)
    X = made.start - behind * made.dx
    np.testing.assert_allclose(at(made, X, [0.0, 3 * made.dy]), made.heights[-1 - behind][:, [0, 3]].T, atol=1e-15)
    table, X, Y = whole(made), np.linspace(-4.0, -3.2, 37) + 1e-3, np.linspace(0.0, 1.9, 41)
    rows, columns = (np.fft.fftfreq(size) * size for size in table.shape)
    place = (table.shape[0] - 1) - (made.start - X) / made.dx
    along = np.exp(2j * pi * np.outer(place, rows) / table.shape[0])
    across = np.exp(2j * pi * np.outer(Y / made.dy, columns) / table.shape[1])
    exact = np.real(along @ (np.fft.fft2(table) / table.size) @ across.T)
    np.testing.assert_allclose(at(made, X, Y), exact.T, atol=3e-4 * 0.01)


def test_grids_and_places_give_the_same(made):
    X, Y = np.linspace(-6.0, -2.0, 40), np.linspace(-1.0, 1.0, 11)
    grid = at(made, X, Y, 0.3)
    places = -made(*np.broadcast_arrays(X[None, :], Y[:, None]), 0.3)
    np.testing.assert_allclose(places, grid, atol=1e-16)
    np.testing.assert_allclose(grid, grid[::-1], atol=1e-15)  # even in Y
    assert float(made(X[5], Y[2], 0.3)) == pytest.approx(-grid[2, 5], abs=1e-16)


def test_it_enters_smoothly_and_moves_with_its_surface(made):
    X, Y = np.linspace(-3.0, 0.0, 301), [0.0, 0.7]
    slow = replace(made, speed=0.5)
    later = at(slow, X, Y, 2.0)
    assert not later[:, X >= -1.5].any() and np.abs(later[:, X < -1.75]).max() > 0.01
    np.testing.assert_allclose(at(slow, X + 0.5, Y, 3.0), later, atol=1e-14)
    # at the front neither height, slope nor curvature jumps: it rises as the cube
    near, nearer = (np.abs(at(slow, [-1.5 - d], Y, 2.0)).max() for d in (4e-3, 1e-3))
    assert near / nearer == pytest.approx(64.0, rel=0.25)


def test_period(made):
    np.testing.assert_allclose(at(made, [-12.3], [0.4]), at(made, [-8.3], [0.4]), atol=1e-14)
    np.testing.assert_allclose(at(made, [-8.3], [2.0 + 0.4]), at(made, [-8.3], [2.0 - 0.4]), atol=1e-14)


@pytest.mark.parametrize(("speed", "slip"), [(1.0, 0.0), (0.5, 0.5), (1.5, -0.5)])
def test_what_passing_film_sees(made, speed, slip):
    X, Y = np.linspace(-2.0, 1.0, 31), np.linspace(0.0, 1.0, 5)
    rough = replace(made, start=0.5, speed=speed)
    step = surface_step(rough, X, Y, 0.4, 0.1, 0.1)
    ahead, behind = (at(rough, X + d, Y, 0.4) for d in (1e-5, -1e-5))
    np.testing.assert_allclose(step.rate, -slip * (ahead - behind) / 2e-5, atol=2e-6)


def test_a_measured_map_is_levelled_and_smoothed():
    """The plane goes; of a wave as long as the cut-off half is left, of one half as long a sixteenth."""
    x, y = np.arange(801) * 0.01, np.arange(301) * 0.01
    plane = 0.3 + 0.2 * x[:, None] - 0.1 * y

    def left(wavelength):
        wave = np.cos(2.0 * pi * x / wavelength)[:, None] + 0.0 * y
        rough = Roughness.measured(plane + 1e-3 * wave, 0.01, 0.01, 0.2)
        assert abs(rough.heights.mean()) < 1e-5  # the plane has 0.3
        return np.ptp(rough.heights[200:600]) / 2e-3

    for wavelength, share in ((2.0, 2.0**-0.01), (0.2, 0.5), (0.1, 1.0 / 16.0)):
        assert left(wavelength) == pytest.approx(share, rel=0.02, abs=0.004)
    flat = Roughness.measured(plane + 1e-3 * np.cos(20.0 * y), 0.01, 0.01, 0.2).heights
    assert np.abs(flat).max() < 1.5e-3


def test_a_map_in_metres():
    point = OperatingPoint(Geometry(12.7e-3, 20e-3, e2=8e10, nu2=0.2), Lubricant(0.1), 20.0, 0.5)
    s, rng = point.scales, np.random.default_rng(5)
    table = rng.standard_normal((60, 40))
    metres = Roughness.measured(table * 1e-7, 2e-6, 2e-6, 1.2e-5, point=point, start=-s.a)
    same = Roughness.measured(
        table * 1e-7 / s.length, 2e-6 / s.a, 2e-6 / s.b, 1.2e-5 / s.a, kappa=s.a / s.b, start=-1.0
    )
    np.testing.assert_allclose(metres.heights, same.heights, rtol=1e-12)
    assert (metres.dx, metres.dy, metres.shortest_wavelength) == (2e-6 / s.a, 2e-6 / s.b, 1.2e-5 / s.a)
    assert metres.kappa == pytest.approx(point.moes.kappa, rel=1e-9)
    assert (metres.start, metres.made_at) == (-1.0, point)


def test_a_made_surface_in_metres():
    point = OperatingPoint(Geometry(12.7e-3, 20e-3, e2=8e10, nu2=0.2), Lubricant(0.1), 20.0, 0.5)
    s = point.scales
    metres = Roughness.synthetic(
        1e-8, 2e-4, 1e-4, length=6e-4, width=4e-4, point=point, start=-2e-4, front=3e-5, seed=3
    )
    same = Roughness.synthetic(
        1e-8 / s.length, 2e-4 / s.a, 1e-4 / s.a, length=6e-4 / s.a, width=4e-4 / s.b, kappa=s.a / s.b,
        start=-2e-4 / s.a, front=3e-5 / s.a, seed=3,
    )  # fmt: skip
    np.testing.assert_allclose(metres.heights, same.heights, rtol=1e-12, atol=0.0)
    assert (metres.dx, metres.start, metres.front) == (same.dx, same.start, same.front)
    rows, columns = Roughness.synthetic(1e-8, 2e-4, 1e-4, point=point).heights.shape
    assert (rows, columns) == Roughness.synthetic(1e-8, 2e-4 / s.a, 1e-4 / s.a, kappa=s.a / s.b).heights.shape
    for other in (replace(point, load=30.0), replace(point, load=30.0).moes):
        with pytest.raises(
            InputError, match=r"surface = 'made at another .* Roughness\.synthetic\(\.\.\., point=point"
        ):
            run_over(metres, point=other)
    with pytest.raises(InputError, match=r"^kappa = 2\.0: must be left out with a point"):
        Roughness.synthetic(1e-8, 2e-4, 1e-4, point=point, kappa=2.0)
    with pytest.raises(InputError, match=r"^point = .*MoesPoint.* a dimensionless one takes"):
        Roughness.measured(np.eye(8), 2e-6, 2e-6, 1.2e-5, point=point.moes)


def run_over(surface, n=64, until=0.5, point=POINT, **changes):
    options = {"n": n, "domain": NEAR, "until": until, "dt": 4.0 / n, "surface": surface, "threads": 1} | changes
    return simulate(point, PrescribedLoad(np.linspace(0.0, 4.0, 4), np.ones(4)), **grouped(**options))


def test_waves_that_the_mesh_does_not_show_are_refused(made):
    """The mesh is 0.0625 along and across."""
    with pytest.raises(
        InputError, match=r"^surface\.shortest_wavelength = 0\.1: must be at least 0\.25 semi-axes, 4 of the mesh"
    ):
        run_over(made)
    wide = replace(made, kappa=0.25, shortest_wavelength=0.3)  # across, the mesh is four times as long in metres
    refused = pytest.raises(
        InputError, match=r"^surface\.shortest_wavelength = 0\.3: must be at least 1 semi-axes"
    )
    with (
        refused,
        pytest.warns(RuntimeWarning, match="^kappa = 0.25 of the surface is not that of the contact, 1:"),
    ):
        run_over(wide)


def test_a_map_too_short_for_the_run_is_refused():
    table = np.random.default_rng(1).standard_normal((81, 61))
    rough = Roughness.measured(table, 0.05, 0.05, 0.3, start=-1.0)  # 4 long, 3 wide
    with pytest.raises(
        InputError, match=r"^length of surface\.heights = 4\.0: must be at least 4\.1, from x_in = -2\.5"
    ):
        run_over(rough, until=2.6)
    narrow = Roughness.measured(table[:, :31], 0.05, 0.05, 0.3, start=-1.0)
    with pytest.raises(InputError, match=r"^width of surface\.heights = 1\.5: must be at least y_max = 2"):
        run_over(narrow)


HEIGHTS = np.random.default_rng(2).standard_normal((8, 8))
BAD = {
    "rq 0": (lambda: Roughness.synthetic(**MADE | {"rq": 0.0}), "rq = 0.0"),
    "rq negative": (lambda: Roughness.synthetic(**MADE | {"rq": -1.0}), "rq = -1.0"),
    "waves the wrong way round": (
        lambda: Roughness.synthetic(0.01, 0.1, 0.5),
        "shortest_wavelength = 0.5: must be below longest_wavelength",
    ),
    "map too small": (lambda: Roughness.synthetic(**MADE | {"length": 0.4}), "length = 0.4: must be at least 0.5"),
    "map too fine": (
        lambda: Roughness.synthetic(**MADE | {"shortest_wavelength": 1e-3}),
        "shortest_wavelength = 0.001: must be at least",
    ),
    "hurst": (lambda: Roughness.synthetic(**MADE, hurst=1.5), "hurst = 1.5: must be between 0 and 1"),
    "seed": (lambda: Roughness.synthetic(**MADE, seed=-1), "seed = -1"),
    "NaN": (
        lambda: Roughness(np.where(HEIGHTS > 1.0, np.nan, HEIGHTS), 0.1, 0.1, 0.5),
        f"heights = '{(HEIGHTS > 1.0).sum()} of 64 NaN or infinite'",
    ),
    "a line": (lambda: Roughness(HEIGHTS[0], 0.1, 0.1, 0.5), "heights = 'of shape (8,)'"),
    "words": (lambda: Roughness([["high"]], 0.1, 0.1, 0.5), "heights = 'list'"),
    "flat": (lambda: Roughness(0.0 * HEIGHTS, 0.1, 0.1, 0.5), "heights = 'all 0'"),
    "dx": (lambda: Roughness(HEIGHTS, 0.0, 0.1, 0.5), "dx = 0.0"),
    "below the samples": (
        lambda: Roughness(HEIGHTS, 0.1, 0.1, 0.15),
        "shortest_wavelength = 0.15: must be at least 0.2",
    ),
    "front": (lambda: Roughness(HEIGHTS, 0.1, 0.1, 0.5, front=0.0), "front = 0.0"),
    "speed": (lambda: Roughness(HEIGHTS, 0.1, 0.1, 0.5, speed=-1.0), "speed = -1.0"),
    "measured NaN": (lambda: Roughness.measured(HEIGHTS * np.nan, 0.1, 0.1, 0.5), "heights = '64 of 64"),
    "measured dy": (lambda: Roughness.measured(HEIGHTS, 0.1, -0.1, 0.5), "dy = -0.1"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_named(name):
    call, told = BAD[name]
    with pytest.raises(InputError) as refused:
        call()
    assert str(refused.value).startswith(told) and "\n" not in str(refused.value)


@pytest.fixture(scope="module")
def rough_runs():
    """Roughness of a tenth of the film, and of a twentieth, half-way through; 8 and 4 nodes to a wave."""
    rough = {
        "longest_wavelength": 0.6,
        "shortest_wavelength": 0.25,
        "length": 4.0,
        "width": 2.0,
        "seed": 4,
        "start": -1.25,
    }
    film = 0.0817
    return {
        "full": run_over(Roughness.synthetic(0.1 * film, **rough), 128, 1.25, snapshots=(1.0, 1.25)),
        "half": run_over(Roughness.synthetic(0.05 * film, **rough), 128, 1.25, snapshots=(1.25,)),
        "coarse": run_over(Roughness.synthetic(0.1 * film, **rough), 64, 1.25, snapshots=(1.25,)),
        "sliding": run_over(Roughness.synthetic(0.1 * film, speed=0.5, **rough), 128, 2.0, snapshots=(1.5, 2.0)),
    }


@pytest.mark.long
def test_every_step_over_roughness_converges(rough_runs):
    for run in rough_runs.values():
        assert run.status.ok and run.cycles.max() <= 4


@pytest.mark.long
def test_film_over_rolling_roughness_is_carried(rough_runs):
    """A quarter later the same deviation stands a quarter further on, and half the heights make half of it."""
    run, half = rough_runs["full"], rough_runs["half"]
    mesh, rest = run.x[1] - run.x[0], run.h_midplane[0]
    shift = round(0.25 / mesh)
    steps = run.h_midplane - rest
    before = steps[round(1.0 / mesh)]
    places = np.flatnonzero((run.x > -0.6) & (run.x < -0.3))
    now = steps[-1]
    assert np.std(before[places]) > 0.05 * np.interp(0.0, run.x, rest)
    assert np.corrcoef(before[places], now[places + shift])[0, 1] > 0.98
    assert np.std(now[places + shift]) == pytest.approx(np.std(before[places]), rel=0.15)
    halved = half.h_midplane[-1] - half.h_midplane[0]
    inside = np.abs(run.x + 0.4) < 0.4
    assert np.linalg.norm((now - 2.0 * halved)[inside]) < 0.1 * np.linalg.norm(now[inside])


@pytest.mark.long
def test_film_over_roughness_does_not_depend_on_the_grid(rough_runs):
    """Twice the grid moves the deviation by a fifth of itself: four nodes to the shortest wave tell its shape."""
    fine, coarse = rough_runs["full"], rough_runs["coarse"]
    inside = np.abs(coarse.x + 0.4) < 0.4
    now = (fine.h_midplane[-1] - fine.h_midplane[0])[::2][inside]
    then = (coarse.h_midplane[-1] - coarse.h_midplane[0])[inside]
    assert np.linalg.norm(now - then) < 0.25 * np.linalg.norm(now)
