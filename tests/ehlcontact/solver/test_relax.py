"""Line relaxation: band solver, distribution, the linear system of a line, and what a sweep does."""

import numpy as np
import oracles
import pytest

from ehlcontact import Domain, MoesPoint
from ehlcontact.lanes import LANES
from ehlcontact.solver.kernels import relax
from ehlcontact.solver.kernels.linearise import linearise, neighbour
from ehlcontact.solver.level import Level

LOWER, UPPER, NEAR, PAD = relax.BAND_LOWER, relax.BAND_UPPER, relax.NEAR, relax.PAD


def relax_segments(level, rhs, *segments):
    """Solve segments of lines of a level and return all changes."""
    work = relax.line_work(level.nx + 1)
    for array in (work[0][relax.FILM_MARGIN : -relax.FILM_MARGIN], *work[1:]):
        array[...] = 1e6  # left over from other lines; the margins stay zero
    relax.relax_segments(np.array(segments), level.fields, rhs, level.stencil, level.c_t, level.near, work)
    return level.fields.w.copy()


def relax_line(level, j, rhs, start=1, stop=None):
    """Solve a line of a level, by default all of it, and return its changes."""
    return relax_segments(level, rhs, (j, start, stop or level.nx))[j]


@pytest.mark.parametrize("m", [1, 2, 3, 4, 5, 17, 60])
def test_solve_bands(m):
    """Eight systems side by side, each against a dense solve."""
    rng = np.random.default_rng(m)
    A = np.zeros((LANES, m, m))
    band, b = np.full((m + PAD, relax.BAND, LANES), np.nan), np.full((m + PAD, LANES), np.nan)
    b[:m] = rng.normal(size=(m, LANES))
    for r in range(m):
        for c in range(r - LOWER, r + UPPER + 1):  # columns before the first and after the last are not read
            entries = rng.normal(size=LANES) + (8.0 if r == c else 0.0)
            band[r, LOWER + c - r] = entries
            if 0 <= c < m:
                A[:, r, c] = entries
    expected = np.linalg.solve(A, b[:m].T[..., None])[..., 0].T
    relax.solve_bands(band.reshape(m + PAD, -1), b, m)
    np.testing.assert_allclose(b[:m], expected, rtol=1e-11, atol=1e-13)
    assert not b[m:].any()  # nothing grows beyond the last row


@pytest.mark.parametrize("c_t", [0.0, 1.3])
@pytest.mark.parametrize("lines", [(0, 8), (2, 5)])
def test_distribution_weights(level, point, c_t, lines):
    f, theta = level.fields, np.full_like(level.P, np.nan)
    exponent = np.random.default_rng(2).uniform(-2, 3, f.P.shape)  # both sides of the switch
    eps = f.flow.eps
    eps[...] = level.hx**2 * 10.0**exponent
    f.flow.along[:, :-1] = np.vectorize(oracles.flow_mean)(eps[:, :-1], eps[:, 1:])
    f.flow.across[:-1] = np.vectorize(oracles.flow_mean)(eps[:-1], eps[1:])
    relax.distribution_weights(*lines, f.P, f.flow, level.stencil, c_t, theta)
    inner = [(j, i) for j in range(*lines) for i in range(1, level.nx)]
    expected = [oracles.distribution_weight(eps, j, i, level.hx, level.hy, point.kappa, c_t) for j, i in inner]
    dry = [f.P[k] == 0.0 for k in inner]  # have nothing that could be taken back
    assert 0 < sum(dry) < len(inner)
    expected = np.where(dry, 0.0, expected)
    np.testing.assert_allclose([theta[k] for k in inner], expected, rtol=1e-10, atol=1e-300)
    assert min(expected) < 0.1
    assert max(expected) > 0.9
    assert np.count_nonzero(np.isfinite(theta)) == len(inner)


def random_change(level, colour, seed=5):
    """Weights and small changes of the lines of one colour, where there is pressure; both fields of the level."""
    f, rng = level.fields, np.random.default_rng(seed)
    f.theta[:-1, 1:-1] = rng.uniform(size=(level.ny, level.nx - 1))
    f.w[:-1, 1:-1] = 1e-3 * rng.normal(size=(level.ny, level.nx - 1))
    f.w[f.P == 0.0] = 0.0
    f.w[2:4, 5:9] = 2e-3  # dry nodes that join the solve
    f.w[1 - colour :: 2] = (
        7.0  # of the lines of the other colour, solved before, and none of this sweep's business
    )


def deposits(level, colour):
    """What the lines of one colour and their images add to the whole domain, mirrored: (row, column), change."""
    theta, w, ny = oracles.mirrored(level.fields.theta), oracles.mirrored(level.fields.w), level.ny
    for row in range(1, 2 * ny):
        if (row - ny) % 2 == colour:
            for i in range(1, level.nx):
                parts = oracles.nodes_of_a_distributed_change(row, i, theta)
                yield (row, i), {node: w[row, i] * part for node, part in parts.items()}


@pytest.mark.parametrize("colour", [0, 1])
def test_apply_lines_to_the_pressure(level, colour):
    """Against the same change made on the whole domain, where a line and its image move together."""
    f = level.fields
    assert f.P[f.P > 0.0].min() > 4e-3  # no cell runs dry
    random_change(level, colour)
    full, ny = oracles.mirrored(f.P), level.ny
    wet = full > 0.0
    for node, parts in deposits(level, colour):
        for where, change in parts.items():
            if where == node or wet[where]:
                full[where] += change
    relax.apply_lines(0, ny, colour, f, level.near)
    np.testing.assert_allclose(f.P, full[ny:], rtol=0, atol=1e-14)


@pytest.mark.parametrize("colour", [0, 1])
def test_apply_lines_to_the_film(level, colour):
    """Near coefficients of the lines beside those still to be solved: none are, once the odd ones have been."""
    f, K = level.fields, level.deflection.kernel
    random_change(level, colour)
    expected = f.H.copy()
    for j in range(1, level.ny, 2) if colour == 0 else ():
        for (row, k), parts in deposits(level, colour):
            if abs(row - level.ny - j) == 1:
                for i in range(max(1, k - NEAR), min(level.nx, k + NEAR + 1)):
                    for (r, c), change in parts.items():
                        expected[j, i] += K[abs(r - level.ny - j), abs(c - i)] * change
    relax.apply_lines(0, level.ny, colour, f, level.near)
    np.testing.assert_allclose(f.H, expected, rtol=1e-13)


@pytest.mark.parametrize("colour", [0, 1])
def test_lines_in_parts_are_lines_at_once(level, colour):
    """Threads take parts of the lines: P and H must not depend on the parts."""
    f = level.fields
    random_change(level, colour)
    P, H = f.P.copy(), f.H.copy()
    relax.apply_lines(0, level.ny, colour, f, level.near)
    whole = f.P.copy(), f.H.copy()
    f.P[...], f.H[...] = P, H
    for first, last in ((5, level.ny), (0, 2), (2, 5)):
        relax.apply_lines(first, last, colour, f, level.near)
    np.testing.assert_array_equal((f.P, f.H), whole)


def test_no_pressure_below_zero(level):
    f = level.fields
    random_change(level, 0)
    f.w[:-1:2, 1:-1] = -5.0
    relax.apply_lines(0, level.ny, 0, f, level.near)
    assert f.P.min() == 0.0
    assert (f.P[::2] == 0.0).all()


@pytest.mark.parametrize("colour", [0, 1])
def test_relax_lines_solves_every_line_of_its_colour(level, colour):
    f = level.fields
    expected = np.full_like(f.P, 9.0)
    for j in range(colour, level.ny, 2):
        expected[j, 1:-1] = relax_line(level, j, level.rhs)[1:-1]
    f.w[...] = 9.0
    relax.relax_lines(0, 1, colour, f, level.rhs, level.stencil, level.c_t, level.near)
    np.testing.assert_array_equal(f.w, expected)


def test_segments_side_by_side_are_those_by_themselves(make_level, point):
    """Of any length, wherever they begin, one without a node that joins among them; bit for bit."""
    level = make_level(point, nx=64, ny=24)
    f = level.fields
    f.P[9] = 0.0
    level.rhs[9] = 1e9
    level.update_residual()
    segments = [(1, 1, 64), (3, 1, 2), (3, 7, 9), (5, 50, 64), (7, 2, 40), (9, 20, 44), (11, 63, 64), (21, 12, 53)]
    alone = np.full_like(f.w, 3.0)
    for j, start, stop in segments:
        alone[j, start:stop] = relax_line(level, j, level.rhs, start, stop)[start:stop]
    assert not alone[9, 20:44].any()
    f.w[...] = 3.0
    np.testing.assert_array_equal(relax_segments(level, level.rhs, *segments), alone)


def line_matrix(level, j):
    """Response of N on line j to each distributed change of that line: exact in P, truncated in H.

    Of the next lines the film counts where it opens a way out, and where that is worth counting.
    """
    f, nx, ny, K = level.fields, level.nx, level.ny, level.deflection.kernel
    own = np.abs(f.p_coef[0] + f.h_coef[0] * K[0, 0])
    opening = np.minimum(f.h_coef, 0.0) * (K[1, 0] * np.minimum(f.h_coef[3:5], 0.0).sum(axis=0) < -0.003 * own)
    theta = oracles.mirrored(f.theta)
    A = np.zeros((nx - 1, nx - 1))
    for c in range(1, nx):
        dP, dH = np.zeros((2 * ny + 1, nx + 1)), np.zeros(nx + 1)
        for row in {ny + j, ny - j}:
            for node, part in oracles.nodes_of_a_distributed_change(row, c, theta).items():
                dP[node] += part
        for i in range(max(c - relax.ALONG, 0), min(c + relax.ALONG, nx) + 1):
            for node, part in oracles.nodes_of_a_distributed_change(ny + j, c, theta).items():
                dH[i] += K[abs(node[0] - ny - j), abs(node[1] - i)] * part
        for i in range(1, nx):
            for q in range(6):
                jq, iq = neighbour.py_func(q, j, i)
                r = ny + j + {3: -1, 4: 1}.get(q, 0)
                A[i - 1, c - 1] += f.p_coef[q, j, i] * dP[r, max(iq, 0)]
                if jq == j:
                    A[i - 1, c - 1] += f.h_coef[q, j, i] * dH[max(iq, 0)]
                elif abs(i - c) <= NEAR:
                    for node, part in oracles.nodes_of_a_distributed_change(ny + j, c, theta).items():
                        A[i - 1, c - 1] += opening[q, j, i] * K[abs(node[0] - r), abs(node[1] - i)] * part
    return A


@pytest.fixture(params=[(1, 16), (4, 11)], ids=["line", "segment"])
def nodes(request):
    """First node and node after the last of what is solved."""
    return request.param


@pytest.mark.parametrize(("pressure", "jumps"), [(0.5, 0.02), (0.01, 0.3)], ids=["stiff", "steep"])
@pytest.mark.parametrize("j", [0, 1, 2, 5])
def test_line_solves_its_linear_system(point, j, pressure, jumps, nodes):
    """Under pressure all along, w solves ``A w = residual`` within the limit on changes, and elsewhere stays."""
    level = Level(point, Domain(), 16, 8)
    f = level.fields
    f.P[:-1, 1:-1] = pressure + jumps * np.random.default_rng(7).uniform(size=(8, 15))
    level.update_film(0.4)
    level.c_t = 0.5
    level.update_residual()
    f.theta[:-1, 1:-1] = np.random.default_rng(9).uniform(size=(8, 15))
    linearise(f.P, f.flow, level.stencil, level.c_t, relax.FLOW_SLOPE, f.p_coef, f.h_coef)
    # a small right-hand side, so that no change is limited
    level.rhs += 1e-3 * np.random.default_rng(8).normal(size=f.P.shape) - level.r
    level.update_residual()
    f.w[...] = 3.0
    w = relax_line(level, j, level.rhs, *nodes)
    A = line_matrix(level, j)
    below = np.subtract.outer(np.arange(15), np.arange(15))
    A[(below > LOWER) | (-below > UPPER)] = 0.0
    inside = slice(nodes[0] - 1, nodes[1] - 1)
    expected = np.linalg.solve(A[inside, inside], level.r[j, 1:-1][inside])
    assert np.abs(expected).max() < relax.LARGEST_CHANGE
    np.testing.assert_allclose(w[slice(*nodes)], expected, rtol=1e-8, atol=1e-12)
    w[slice(*nodes)] = 3.0
    assert (w == 3.0).all()


@pytest.mark.parametrize("film", [None, 1e-3, -1.0], ids=["as it is", "thin", "negative"])
@pytest.mark.parametrize("size", [1e-6, 1e2])
def test_too_large_changes_are_cut_all_alike(level, film, size):
    """The whole line, so that it stays distributed: to 0.3 of P, and to the film over its own deflection."""
    f, j = level.fields, 2
    f.P[:-1, 1:-1] += 0.05  # all under pressure, so that the linear system is the same for any residual
    level.update_residual()
    level.rhs[...] -= level.r  # a residual of zero
    pushed = 1e-5 * np.random.default_rng(8).normal(size=f.P.shape)
    unlimited = size / 1e-5 * relax_line(level, j, level.rhs + pushed)
    if film is not None:
        f.H[j, 4:9] = film  # by which changes are judged; the flow stays as it is
    w = relax_line(level, j, level.rhs + size / 1e-5 * pushed)
    by_film = np.abs(unlimited) * level.near[0, 0] / np.where(f.H[j] > 0.0, f.H[j], np.inf)
    factor = max(1.0, np.abs(unlimited).max() / 0.3, by_film.max())
    assert (factor > 1.0) == (size == 1e2)
    if size == 1e2 and film == 1e-3:
        assert by_film.max() == factor
    np.testing.assert_allclose(w, unlimited / factor, rtol=1e-4, atol=1e-6 * np.abs(w).max())


def test_dry_node_joins_only_if_its_residual_asks_for_pressure(level):
    f = level.fields
    level.rhs *= 30.0  # both signs of the residual
    level.update_residual()
    for j in range(level.ny):
        relax_line(level, j, level.rhs)
    inner = (slice(0, -1), slice(1, -1))
    dry, pushed_down = (f.P == 0.0)[inner], (level.r >= 0.0)[inner]
    assert (dry & pushed_down).any()
    assert (dry & ~pushed_down).any()
    assert (f.w[inner][dry & pushed_down] == 0.0).all()
    assert (f.w[inner][dry & ~pushed_down] != 0.0).all()


@pytest.mark.parametrize("kappa", [0.2, 1.0, 3.0])
def test_converged_film_is_a_fixed_point(solve_by_newton, kappa):
    """Relaxation must stand still on a solution: no term may differ between it and the residual."""
    level, u = solve_by_newton(MoesPoint(20, 8, kappa))
    P = level.P.copy()
    for _ in range(3):
        level.update(u)
        level.relax()
    assert np.abs(level.P - P).max() < 1e-9


def test_sweeps_smooth_a_rough_error(solve_by_newton):
    """Three sweeps take a checkerboard error of 1 % out of a converged film by more than 10x."""
    level, u = solve_by_newton(MoesPoint(20, 8, 0.5))
    P = level.P.copy()
    j, i = np.indices(P.shape)
    level.P[...] = P * (1.0 + 0.01 * (-1.0) ** (i + j))
    level.update(u)
    before = level.residual_norm()
    for _ in range(3):
        level.update(u)
        level.relax()
    level.update(u)
    assert level.residual_norm() < 0.1 * before
    assert (level.P >= 0.0).all()
