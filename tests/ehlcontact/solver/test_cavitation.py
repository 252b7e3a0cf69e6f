"""The cavitation-boundary passes."""

import numpy as np
import pytest

from ehlcontact import MoesPoint
from ehlcontact.solver.kernels import cavitation as boundary
from ehlcontact.solver.kernels.linearise import NEIGHBOURS, neighbour
from ehlcontact.solver.kernels.reynolds import operator_at, residual

KERNELS = [boundary.relax_boundary, boundary.relax_boundary.py_func]


@pytest.mark.parametrize("kernel", [boundary.mark_boundary, boundary.mark_boundary.py_func], ids=["jit", "python"])
def test_marks(kernel):
    """Against distances from the node before a change: one less per node, none beyond reach of the next."""
    reach = 5
    P = np.zeros((13, 31))
    P[:5, 11:18] = 0.5
    P[:1, 14] = 0.0  # a hole on the symmetry line
    marks = np.full(P.shape, 7, dtype=np.uint8)
    kernel(0, 12, P, reach, marks)
    wet = P > 0.0
    changes = [
        (r, c)
        for r in range(12)
        for c in range(1, 30)
        for other in ((r, c + 1), (r + 1, c))
        if other[0] < 12 and other[1] < 30 and wet[r, c] != wet[other]
    ]
    for j in range(12):
        for i in range(1, 30):
            away = [max(abs(j - r), abs(i - c)) for r, c in changes]
            reached = [max(j - r - 1, r - j, i - c - 1, c - i) <= reach for r, c in changes]
            expected = max(1, reach + 1 - min(away)) if any(reached) else 0
            assert marks[j, i] == expected, (j, i)
    assert 0 in marks[:12, 1:30] and reach + 1 in marks
    assert (marks[:, [0, -1]] == 0).all()


@pytest.fixture(scope="module")
def solved(solve_by_newton):
    return solve_by_newton(MoesPoint(20, 5, 0.5))[0]


def passes(level, kernel, self_deflection=None):
    f = level.fields
    own = level.near[0, 0] if self_deflection is None else self_deflection
    marks = np.zeros(f.P.shape, dtype=np.int64)  # of bytes, Python's differences would overflow
    given = (level.supply_arrays, level.law, level.stencil, level.c_t, own, level.nodes, level.couplings, marks)
    kernel(0, level.ny, f.P, f.H, f.flow, *given)


@pytest.mark.parametrize("kernel", [boundary.update_marked, boundary.update_marked.py_func], ids=["jit", "python"])
def test_flow_at_marked_nodes_is_up_to_date(level, kernel):
    """The operator there, from stale flow and this update, equals that from a full one."""
    f = level.fields
    marks = np.zeros(f.P.shape, dtype=np.uint8)
    marks[0, 1:4] = marks[3:6, 8:10] = marks[-2, -2] = 1
    marks[4, 8] = boundary.MOST_REACH + 1
    marked = [(j, i) for j, i in np.argwhere(marks)]
    around = {neighbour.py_func(q, j, i) for j, i in marked for q in range(1, NEIGHBOURS)} - set(marked)
    f.P[f.P > 0.0] *= 1.3
    kernel(0, level.ny, f.P, f.H, level.law, level.stencil, f.flow, marks)
    assert {(j, i) for j, i in np.argwhere(marks == boundary.UPDATED)} == {k for k in around if k[1] >= 0}
    got = [operator_at(j, i, f.P, f.flow, level.stencil, level.c_t) for j, i in marked]
    level.update_residual()
    expected = [operator_at(j, i, f.P, f.flow, level.stencil, level.c_t) for j, i in marked]
    assert got == expected


@pytest.mark.parametrize("kernel", KERNELS, ids=["jit", "python"])
def test_solution_stays(solved, kernel):
    P = solved.P.copy()
    passes(solved, kernel)
    assert np.abs(solved.P - P).max() < 1e-9
    solved.P[...] = P


def least_flow(level, marks, self_deflection):
    """Flow that a node needs so that a frozen film is safe there: ten wedge, 300 squeeze terms, more far off."""
    away = np.maximum(1.0, (boundary.reach_of(level.nx) + 1.0 - marks) / 3.0)
    return (10.0 * 1.5 / level.hx + 300.0 * level.c_t) * self_deflection * away**3


@pytest.mark.parametrize("kernel", KERNELS, ids=["jit", "python"])
@pytest.mark.parametrize("c_t", [0.0, 0.2])
def test_only_where_flow_dominates(solved, kernel, c_t, monkeypatch):
    """Of a residual everywhere, the passes see marked nodes whose flow exceeds wedge and squeeze, no others."""
    far = kernel is boundary.relax_boundary.py_func  # on so coarse a grid only Python can be given a longer reach
    if far:
        monkeypatch.setattr(boundary, "reach_of", lambda nx: boundary.MOST_REACH)
    P, f, before = solved.P.copy(), solved.fields, solved.c_t
    marks = np.zeros(P.shape, dtype=np.uint8)
    boundary.mark_boundary(0, solved.ny, P, boundary.reach_of(solved.nx), marks)
    along, across = np.zeros_like(P), np.zeros_like(P)
    along[:, 1:-1] = solved.stencil.cx * (f.flow.along[:, :-2] + f.flow.along[:, 1:-1])
    across[1:-1] = solved.stencil.cy * (f.flow.across[:-2] + f.flow.across[1:-1])
    across[0] = solved.stencil.cy * 2.0 * f.flow.across[0]
    flow, own = along + across, 4.0 * solved.near[0, 0]
    solved.c_t = c_t
    expected = (marks > 0) & (flow > least_flow(solved, marks.astype(float), own))
    near = (marks > 0) & (flow > least_flow(solved, boundary.reach_of(solved.nx) + 1.0, own))
    assert 0 < np.count_nonzero(expected) < np.count_nonzero(marks)
    assert (np.count_nonzero(expected) < np.count_nonzero(near)) == far  # beyond NEAREST it takes more
    solved.rhs[...] = -1e3  # asks every node for pressure
    passes(solved, kernel, own)
    np.testing.assert_array_equal(solved.P != P, expected)
    solved.P[...], solved.rhs[...], solved.c_t = P, 0.0, before


def test_the_reach_grows_with_the_mesh():
    """Coarse corrections end some way before the boundary: the same way on a mesh twice as fine, up to a limit."""
    assert [boundary.reach_of(nx) for nx in (32, 128, 256, 512, 2048)] == [3, 3, 4, 8, 8]


def test_disturbed_boundary_is_restored(solved):
    P, f = solved.P.copy(), solved.fields
    marks = np.zeros(P.shape, dtype=np.uint8)
    boundary.mark_boundary(0, solved.ny, P, boundary.reach_of(solved.nx), marks)
    tiny = (marks > 0) & (P > 0.0) & (P < 1e-2)
    assert tiny.sum() > 3

    def left():  # at frozen film, which is all these passes see
        r = np.zeros_like(P)
        residual(f.P, f.flow, solved.stencil, 0.0, solved.rhs, r)
        return np.abs(r[tiny]).mean()

    solved.P[tiny] *= 1.5
    before = left()
    passes(solved, boundary.relax_boundary)
    assert left() < 0.3 * before
    assert (solved.P >= 0.0).all()
    solved.P[...] = P


def test_coupled_nodes_take_the_step_of_the_operator(solved):
    """Against ``P - (rhs - N)/own`` node by node, on the symmetry line too; not below zero."""
    P, f, s = solved.P.copy(), solved.fields, solved.stencil
    solved.rhs[...] = np.random.default_rng(4).uniform(-1.0, 1.0, P.shape)
    solved.update_residual()
    for j, i in [(0, 1), (0, 12), (1, 20), (7, 9), (solved.ny - 1, solved.nx - 1)]:
        own = boundary.total_flow(j, i, f.flow, s) + 3.0
        expected = P[j, i] - (solved.rhs[j, i] - operator_at(j, i, P, f.flow, s, 0.4)) / own
        boundary.couple(j, i, 2, f.flow, solved.rhs, s, 0.4, 3.0, solved.couplings)
        boundary.relax_coupled(j * (solved.nx + 1) + i, 2, solved.P, solved.couplings)
        assert solved.P[j, i] == pytest.approx(max(expected, 0.0), rel=1e-11, abs=1e-14)
        solved.P[...] = P
    solved.rhs[...] = 0.0
    solved.update_residual()
