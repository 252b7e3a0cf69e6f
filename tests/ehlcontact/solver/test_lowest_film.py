"""The smallest film between the nodes: surfaces whose minimum is known, order, guards, and who uses it."""

from math import cos, pi, sin

import numpy as np
import pytest

from ehlcontact import Grid, KeepSettings, MoesPoint, PrescribedLoad, TimeSteps, simulate
from ehlcontact.solver.lowest_film import cubic_at, lowest_film

LEAST = 0.08


def nodes(ny=12, nx=16):
    """Row and column of every node, in cells."""
    return np.meshgrid(np.arange(ny + 1.0), np.arange(nx + 1.0), indexing="ij")


@pytest.mark.parametrize("kernel", [cubic_at, cubic_at.py_func], ids=["jit", "python"])
def test_cubics_are_exact_for_cubics(kernel):
    rng = np.random.default_rng(9)
    c = rng.normal(size=(4, 4))
    row, column = nodes(8, 9)
    H = np.polynomial.polynomial.polyval2d(row, column, c)
    for t, s in rng.uniform(size=(10, 2)):
        exact = np.polynomial.polynomial.polyval2d(3.0 + t, 5.0 + s, c)
        assert kernel(H, 3, 5, t, s) == pytest.approx(exact, rel=1e-11)


@pytest.mark.parametrize("angle", [0.0, 0.3, pi / 4, 1.2, 2.5])
@pytest.mark.parametrize("place", [(5.0, 7.0), (5.2, 6.7), (4.5, 7.5), (6.35, 8.1)])
def test_exact_for_quadratics(angle, place):
    """Valleys aslant to the grid, ten times steeper across than along."""
    row, column = nodes()
    across = cos(angle) * (column - place[1]) + sin(angle) * (row - place[0])
    along = cos(angle) * (row - place[0]) - sin(angle) * (column - place[1])
    film, j, i = lowest_film(LEAST + 0.02 * across**2 + 0.002 * along**2)
    assert film == pytest.approx(LEAST, rel=1e-6)
    assert (j, i) == pytest.approx(place, abs=0.02)


@pytest.mark.parametrize("offset", [0.0, 0.3, 0.5, 0.8])
def test_on_the_symmetry_line(offset):
    row, column = nodes()
    film, j, i = lowest_film(LEAST + 0.01 * (column - 6.5 - offset) ** 2 + 0.03 * row**2)
    assert film == pytest.approx(LEAST, rel=1e-6)
    assert (j, i) == pytest.approx((0.0, 6.5 + offset), abs=2e-3)


def test_film_is_even_across_the_symmetry_line():
    """Half a field has the smallest film of the whole."""
    rng = np.random.default_rng(11)
    for _ in range(100):
        half = rng.uniform(0.5, 1.0, (9, 11))
        half[:2] -= 0.3  # thinnest at the line or beside it
        assert lowest_film(half)[0] == pytest.approx(lowest_film(np.vstack([half[:0:-1], half]))[0], rel=1e-6)


def worst_errors(h):
    """Error of the lowest node and of `lowest_film` on a grid of mesh h, the largest over places of the nodes."""
    errors = []
    for x0, y0 in np.random.default_rng(3).uniform(0.0, h, (40, 2)):
        y, x = np.meshgrid(y0 + np.arange(-1.0, 1.0, h), x0 + np.arange(-1.0, 1.0, h), indexing="ij")
        # a valley that bends around a circle as the side lobes do, lowest at (0, 0)
        r, phi = np.hypot(x - 1.6, y), np.arctan2(y, 1.6 - x)
        H = LEAST + 0.2 * (np.exp(r - 1.6) - (r - 1.6) - 1.0) + 0.02 * (1.0 - np.cos(phi))
        errors.append((H.min() - LEAST, abs(lowest_film(H)[0] - LEAST)))
    return np.max(errors, axis=0)


def test_order_on_a_smooth_film():
    """The lowest node is second order at best; the cubics fourth."""
    errors = np.array([worst_errors(h) for h in (0.2, 0.1, 0.05)])
    node, between = np.log2(errors[0] / errors[2]) / 2.0
    assert node == pytest.approx(2.0, abs=0.3)
    assert between >= 3.6
    assert (errors[:, 1] < 0.05 * errors[:, 0]).all()


def test_valley_on_the_move():
    """Where the valley lies between the nodes hardly matters, and there are no jumps while it moves."""
    row, column = nodes(20, 24)
    films, lowest = [], []
    for shift in np.linspace(0.0, 3.0, 301):
        across = column - 8.0 - shift + 0.3 * (row - 9.0)
        H = LEAST * (1.0 + 0.03 * across**2 + 0.0003 * across**4 + 0.001 * (row - 9.3 - shift) ** 2)
        films.append(lowest_film(H)[0])
        lowest.append(H.min())
    assert np.ptp(films) < 0.2 * np.ptp(lowest)
    assert np.abs(np.diff(films)).max() < 0.2 * np.abs(np.diff(lowest)).max()


def test_never_above_the_lowest_node():
    rng = np.random.default_rng(5)
    for _ in range(300):
        H = rng.uniform(0.05, 1.0, (9, 11))
        film, j, i = lowest_film(H)
        assert 0.0 < film <= H.min()
        assert 0.0 <= j <= 8.0 and 0.0 <= i <= 10.0


def test_without_a_bottom():
    """Flat, or ever lower towards the border: no film that the nodes do not have."""
    assert lowest_film(np.full((9, 11), 0.3))[0] == pytest.approx(0.3, rel=1e-12)
    row, column = nodes(10, 12)
    saddle = 1.0 + 0.01 * (column - 6.0) ** 2 - 0.001 * row**2
    assert lowest_film(saddle) == (saddle.min(), 10.0, 6.0)


@pytest.mark.parametrize("place", [(6.3, 0.4), (6.3, 15.6), (11.6, 7.4), (12.0, 0.0)])
def test_on_the_border_it_is_the_node(place):
    row, column = nodes()
    H = LEAST + 0.01 * (row - place[0]) ** 2 + 0.01 * (column - place[1]) ** 2
    j, i = np.unravel_index(H.argmin(), H.shape)
    assert lowest_film(H) == (H.min(), j, i)


def test_no_film_is_not_made_up():
    """Overlap is told as the nodes have it; nodes with film never lead to a film without; NaN stays."""
    row, column = nodes()
    bowl = 0.01 * (row - 5.5) ** 2 + 0.01 * (column - 7.5) ** 2
    assert lowest_film(bowl - 0.1)[0] == bowl.min() - 0.1
    touching = bowl - 0.5 * bowl.min()  # positive at the nodes only
    assert lowest_film(touching)[0] == touching.min() > 0.0
    bowl[5, 8] = np.nan
    assert np.isnan(lowest_film(bowl)[0])
    bowl[5, 8] = np.inf
    assert lowest_film(bowl)[0] == bowl.min()


def test_films_of_results(steady):
    """Of steady films, and of records."""
    result = steady(200, 10, 0.5, 64)
    assert result.h_min == pytest.approx(lowest_film(result.h.T)[0], rel=1e-12)
    assert 0.95 * result.h.min() < result.h_min < result.h.min()
    times = [0.0, 0.1, 0.2]
    rest = PrescribedLoad(np.linspace(0.0, 1.0, 4), np.ones(4))
    run = simulate(
        MoesPoint(200, 10, 0.5),
        rest,
        grid=Grid(n=32),
        time=TimeSteps(until=0.2, dt=0.1),
        keep=KeepSettings(snapshots=times),
    )
    expected = [lowest_film(run.snapshot_h[k].T)[0] for k in range(3)]
    assert run.h_min == pytest.approx(expected, rel=1e-12)
