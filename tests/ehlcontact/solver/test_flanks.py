"""Relaxation along the steep flanks: where it works, with which film, and what it leaves alone."""

import numpy as np
import oracles
import pytest

from ehlcontact import MoesPoint
from ehlcontact.solver.kernels import flanks
from ehlcontact.solver.kernels.relax import NEAR

SOLVED, FELT = flanks.SOLVED, flanks.FELT


def jit_and_python(kernel):
    return pytest.mark.parametrize("kernel", [kernel, kernel.py_func], ids=["jit", "python"])


def fronts(P, eps):
    """Nodes before a jump of the Poiseuille coefficient, under pressure on both sides of it."""
    ny, nx = P.shape[0] - 1, P.shape[1] - 1
    for j in range(ny):
        for i in range(1, nx):
            for other in ((j, i + 1), (j + 1, i)):
                ratio = eps[other] / eps[j, i]
                if P[j, i] > 0.0 and P[other] > 0.0 and max(ratio, 1.0 / ratio) > flanks.JUMP:
                    yield j, i


def distance(j, i, front):
    """Nodes between (j, i) and the two beside a front, diagonals counting as one."""
    return max(j - front[0] - 1, front[0] - j, i - front[1] - 1, front[1] - i)


@jit_and_python(flanks.mark_front)
@pytest.mark.parametrize(("j", "i"), [(0, 12), (1, 3), (11, 14), (6, 22), (5, 24)])
@pytest.mark.parametrize("step", [(0, 1), (1, 0)], ids=["along", "across"])
@pytest.mark.parametrize("jump", [1.01 * flanks.JUMP, 0.99 / flanks.JUMP, 0.99 * flanks.JUMP])
def test_marks_around_one_jump(kernel, j, i, step, jump):
    """Of the Poiseuille coefficient along X or Y, up or down; none where it is no jump, or beside cavitation."""
    P, eps, marks = np.full((13, 26), 0.5), np.ones((13, 26)), np.full((13, 26), 9, dtype=np.uint8)
    P[-1] = P[:, [0, -1]] = 0.0
    eps[j + step[0] :, i + step[1] :] = jump
    eps[j + 1 :, :] = jump if step == (1, 0) else 1.0
    P[:, i + 3 :] = P[:, : i - 1] = 0.0
    kernel(0, 12, P, eps, marks)
    all_fronts = list(fronts(P, eps))
    for jj in range(12):
        for ii in range(1, 25):
            nearest = min((distance(jj, ii, front) for front in all_fronts), default=99)
            assert marks[jj, ii] == (SOLVED if nearest <= 2 else FELT if nearest <= 2 + NEAR else 0), (jj, ii)
    assert (marks[-1] == 0).all()
    assert (marks[:, [0, -1]] == 0).all()


@jit_and_python(flanks.mark_front)
def test_marks_of_a_rough_level(level, kernel):
    eps = level.fields.flow.eps
    kernel(0, level.ny, level.P, eps, level.marks)
    all_fronts = list(fronts(level.P, eps))
    assert len(all_fronts) > 5
    for j in range(level.ny):
        for i in range(1, level.nx):
            nearest = min(distance(j, i, front) for front in all_fronts)
            assert level.marks[j, i] == (SOLVED if nearest <= 2 else FELT if nearest <= 2 + NEAR else 0), (j, i)


@jit_and_python(flanks.mark_front)
@pytest.mark.parametrize(("first", "last"), [(0, 4), (3, 5), (6, 12), (10, 16)])
def test_marks_of_a_block(make_level, point, kernel, first, last):
    """Nodes of its own lines near a front, whichever line that is on, and all that feel those."""
    level = make_level(point, nx=24, ny=16)
    eps, marks = level.fields.flow.eps, np.full(level.P.shape, 9, dtype=np.uint8)
    kernel(first, last, level.P, eps, marks)
    all_fronts = list(fronts(level.P, eps))
    solved = np.zeros(level.P.shape, dtype=bool)
    for j in range(first, last):
        for i in range(1, level.nx):
            solved[j, i] = min(distance(j, i, front) for front in all_fronts) <= 2
    assert solved.any()
    for j in range(level.ny):
        for i in range(1, level.nx):
            felt = solved[max(j - NEAR, 0) : j + NEAR + 1, max(i - NEAR, 0) : i + NEAR + 1].any()
            inside = max(first - NEAR, 0) <= j <= min(last + NEAR, level.ny)
            assert marks[j, i] == ((SOLVED if solved[j, i] else FELT if felt else 0) if inside else 9), (j, i)


@jit_and_python(flanks.segments)
@pytest.mark.parametrize("mark", [FELT, SOLVED])
def test_segments(kernel, mark):
    rng = np.random.default_rng(3)
    marks = np.zeros((9, 40), dtype=np.uint8)
    marks[:-1, 1:-1] = rng.integers(0, 3, size=(8, 38))
    marks[2] = 0
    marks[3, 1:-1] = SOLVED
    expected = []
    for j in range(1, 7):
        i = 0
        while i < 40:
            stop = i
            while marks[j, stop] >= mark:
                stop += 1
            if stop > i:
                expected.append([j, i, stop])
            i = stop + 1
    assert [3, 1, 39] in expected
    assert kernel(1, 7, marks, mark).tolist() == expected


def random_change(level):
    """Weights and changes at all interior nodes."""
    rng, shape = np.random.default_rng(5), (level.ny, level.nx - 1)
    level.fields.theta[:-1, 1:-1] = rng.uniform(size=shape)
    level.fields.w[:-1, 1:-1] = rng.normal(size=shape)
    return level.fields.theta, level.fields.w


def films_by_changes(kernel, level, colour):
    """What the changes of all lines of one colour add to a film of none."""
    H = np.zeros_like(level.H)
    whole = np.array([[j, 1, level.nx] for j in range(level.ny)])
    kernel(whole, colour, level.fields.theta, level.fields.w, level.near, H)
    return H


@jit_and_python(flanks.add_films)
@pytest.mark.parametrize("colour", [0, 1])
def test_near_film_of_all_changes(level, kernel, colour):
    """Term by term on the whole domain: those of the colour within NEAR, the images at Y < 0 among them."""
    theta, w = random_change(level)
    films = films_by_changes(kernel, level, colour)
    full_theta, full_w, ny, K = oracles.mirrored(theta), oracles.mirrored(w), level.ny, level.deflection.kernel
    for j in range(ny):
        for i in range(1, level.nx):
            expected = 0.0
            for row in range(max(ny + j - NEAR, 1), min(ny + j + NEAR, 2 * ny - 1) + 1):
                for k in range(max(i - NEAR, 1), min(i + NEAR, level.nx - 1) + 1):
                    if (row - ny) % 2 == colour:
                        parts = oracles.nodes_of_a_distributed_change(row, k, full_theta)
                        change = sum(K[abs(r - ny - j), abs(c - i)] * part for (r, c), part in parts.items())
                        expected += full_w[row, k] * change
            assert films[j, i] == pytest.approx(expected, rel=1e-11, abs=1e-13)


@jit_and_python(flanks.add_films)
@pytest.mark.parametrize(("target", "source"), [(0, 0), (0, 1), (0, 2), (1, 1), (4, 5), (5, 3)])
def test_near_film_is_the_deflection_of_the_change(make_level, point, kernel, target, source):
    """One distributed change and its image, against the dense sum; far images reach no near line."""
    level = make_level(point, nx=16, ny=24)
    theta, w = random_change(level)
    w[np.arange(25) != source] = 0.0
    w[:, np.arange(17) != 7] = 0.0
    full, ny = np.zeros((49, 17)), level.ny
    rows = {ny + source, ny - source} if source + target <= NEAR else {ny + source}
    for row in rows:
        for node, part in oracles.nodes_of_a_distributed_change(row, 7, oracles.mirrored(theta)).items():
            full[node] += w[source, 7] * part
    films = films_by_changes(kernel, level, source % 2)
    for i in range(5, 10):
        expected = sum(
            oracles.influence((i - c) * level.hx, (r - ny - target) * level.hy, level.hx, level.hy, point.kappa)
            * full[r, c]
            for r, c in np.argwhere(full)
        )
        assert films[target, i] == pytest.approx(expected, rel=1e-9, abs=1e-12)
    assert not films_by_changes(kernel, level, 1 - source % 2).any()


@pytest.fixture(scope="module")
def film(solve_by_newton):
    """A converged level with a front, its approach, and its pressure."""
    level, u = solve_by_newton(MoesPoint(20, 8, 0.5))
    flanks.mark_front(0, level.ny, level.P, level.fields.flow.eps, level.marks)
    assert 20 < np.count_nonzero(level.marks == SOLVED) < 0.5 * np.count_nonzero(level.P)
    return level, u, level.P.copy()


@pytest.fixture
def disturbed(film):
    """The same, the pressure at the front off by up to 2 %; and where it solves."""
    level, u, P = film
    solved = level.marks == SOLVED
    level.P[...] = P * (1.0 + 0.02 * solved * np.random.default_rng(4).uniform(-1.0, 1.0, P.shape))
    level.update(u)
    yield level, u
    level.P[...] = P
    level.update(u)


@pytest.fixture(params=[16, 6], ids=["one block", "three blocks"])
def blocks(request, monkeypatch):
    """Lines of a block, of the sixteen that there are."""
    monkeypatch.setattr("ehlcontact.solver.level.BLOCK", request.param)


@pytest.mark.usefixtures("blocks")
def test_solution_is_a_fixed_point(film):
    level, u, P = film
    level.update(u)
    for _ in range(3):
        level.relax_flanks()
        level.update(u)
    assert np.abs(level.P - P).max() < 1e-9


@pytest.mark.usefixtures("blocks")
def test_residual_falls_along_the_front(disturbed):
    """By two thirds at least, and by ten in three times; the state afterwards is one of P and H together."""
    level, u = disturbed
    norms = []
    for _ in range(4):
        flanks.mark_front(0, level.ny, level.P, level.fields.flow.eps, level.marks)
        norms.append(np.abs(level.r[(level.marks == SOLVED) & (level.P > 0.0)]).mean())
        level.relax_flanks()
        level.update(u)
    assert norms[1] < norms[0] / 3.0
    assert norms[3] < norms[0] / 10.0
    assert (level.P >= 0.0).all()


def test_nothing_moves_beyond_what_feels_the_front(disturbed):
    level, _ = disturbed
    f = level.fields
    before = f.P.copy(), f.H.copy(), f.flow.eps.copy(), f.flow.along.copy(), f.flow.across.copy()
    level.relax_flanks()
    felt = level.marks > 0
    for old, new in zip(before[:3], (f.P, f.H, f.flow.eps), strict=True):
        assert (old == new)[~felt].all()
        assert (old != new)[felt].any()
    beside = felt.copy()
    beside[:, :-1] |= felt[:, 1:]
    assert (before[3] == f.flow.along)[~beside].all()
    beside = felt.copy()
    beside[:-1] |= felt[1:]
    assert (before[4] == f.flow.across)[~beside].all()


def island(make_level, point):
    """A level of even pressure and film, but for one place of thick film, away from symmetry line and border."""
    level = make_level(point, nx=24, ny=24)
    level.P[:-1, 1:-1] = 0.5
    level.H[...] = 0.1
    level.H[11:13, 12:14] = 0.2
    level.update_residual()
    level.rhs[...] = 0.01 * level.rhs - level.r
    return level


@pytest.mark.usefixtures("blocks")
@pytest.mark.parametrize("state", ["film", "island"])
def test_flow_and_weights_belong_to_the_state_left_behind(disturbed, make_level, point, state):
    """As if everything had been computed anew from P and H: at felt nodes, and on the faces around them."""
    level = disturbed[0] if state == "film" else island(make_level, point)
    f = level.fields
    level.relax_flanks()
    if state == "island":
        assert not level.marks[:4].any() and not level.marks[-4:].any() and (level.marks == FELT).any()
    local = [a.copy() for a in f.flow] + [f.theta.copy()]
    level.update_residual()
    level._weigh()
    for got, expected in zip(local, (*f.flow, f.theta), strict=True):
        np.testing.assert_allclose(got[:-1, 1:-1], expected[:-1, 1:-1], rtol=1e-12, atol=1e-300)


@pytest.mark.parametrize("passes", ["relax_flanks", "relax"])
def test_blocks_of_one_colour_do_not_feel_each_other(make_level, point, passes, monkeypatch):
    """Every number is the same, bit for bit, whichever of them comes first: so threads may share them."""

    class Backwards:
        def run(self, kernel, count, *args, least=4):
            for k in reversed(range(count)):
                kernel(k, k + 1, *args)

    states = []
    for team in (None, Backwards()):
        level = make_level(point, nx=512, ny=100)  # where boundaries reach farthest
        level.update_residual()
        if team is not None:
            monkeypatch.setattr(level, "team", team)
        before = level.P.copy()
        getattr(level, passes)()
        assert np.count_nonzero(level.P != before) > 1000
        f = level.fields
        states.append([a.copy() for a in (f.P, f.H, f.theta, *f.flow)])
    for one, other in zip(*states, strict=True):
        np.testing.assert_array_equal(one, other)


def test_a_level_without_fronts_is_left_alone(make_level, point):
    level = make_level(point)
    level.P[:-1, 1:-1] = 0.5
    level.H[...] = 0.1
    level.update_residual()
    P, H = level.P.copy(), level.H.copy()
    level.relax_flanks()
    np.testing.assert_array_equal((level.P, level.H), (P, H))
