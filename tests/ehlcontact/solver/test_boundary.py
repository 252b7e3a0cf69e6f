"""The cavitation-boundary passes."""

import numpy as np
import oracles
import pytest

from ehlcontact import MoesPoint
from ehlcontact.solver.kernels import boundary
from ehlcontact.solver.kernels.reynolds import operator_at, residual


@pytest.mark.parametrize("kernel", [boundary.mark_boundary, boundary.mark_boundary.py_func], ids=["jit", "python"])
def test_marks(kernel):
    """Against distances on the whole domain: all nodes within REACH of a change, none beyond REACH + 1."""
    P = np.zeros((13, 31))
    P[:5, 8:18] = 0.5
    P[:1, 14] = 0.0  # a hole on the symmetry line
    marks = np.full(P.shape, 7, dtype=np.uint8)
    kernel(P, marks)
    wet = oracles.mirrored(P) > 0.0
    changes = [
        node
        for r in range(1, wet.shape[0] - 1)
        for c in range(1, wet.shape[1] - 1)
        for node, other in (((r, c), (r, c + 1)), ((r, c), (r + 1, c)))
        if wet[node] != wet[other]
        for node in (node, other)
    ]
    for j in range(12):
        for i in range(1, 30):
            distance = min(max(abs(r - 12 - j), abs(c - i)) for r, c in changes)
            if distance <= boundary.REACH:
                assert marks[j, i] == boundary.MARKED, (j, i)
            elif distance > boundary.REACH + 1:
                assert marks[j, i] == 0, (j, i)
    assert (marks[:, [0, -1]] == 0).all()


@pytest.fixture(scope="module")
def solved(solve_by_newton):
    return solve_by_newton(MoesPoint(20, 5, 0.5))[0]


def passes(level, kernel):
    f = level.fields
    kernel(
        f.P,
        f.H,
        f.flow,
        level.rhs,
        level.law,
        level.stencil,
        level.c_t,
        level.near[0, 0],
        level.nodes,
        level.marks,
    )


KERNELS = [boundary.relax_boundary, boundary.relax_boundary.py_func]


@pytest.mark.parametrize("kernel", [boundary.update_marked, boundary.update_marked.py_func], ids=["jit", "python"])
def test_flow_at_marked_nodes_is_up_to_date(level, kernel):
    """The operator there, from stale flow and this update, equals that from a full one."""
    f = level.fields
    marks = np.zeros(f.P.shape, dtype=np.uint8)
    marks[0, 1:4] = marks[3:6, 8:10] = marks[-2, -2] = boundary.MARKED
    marked = [(j, i) for j, i in np.argwhere(marks)]
    f.P[f.P > 0.0] *= 1.3
    kernel(f.P, f.H, level.law, level.stencil, f.flow, marks)
    got = [operator_at.py_func(j, i, f.P, f.flow, level.stencil, level.c_t) for j, i in marked]
    level.update_residual()
    expected = [operator_at.py_func(j, i, f.P, f.flow, level.stencil, level.c_t) for j, i in marked]
    assert got == expected


@pytest.mark.parametrize("kernel", KERNELS, ids=["jit", "python"])
def test_solution_stays(solved, kernel):
    P = solved.P.copy()
    passes(solved, kernel)
    assert np.abs(solved.P - P).max() < 1e-9
    solved.P[...] = P


def test_disturbed_boundary_is_restored(solved):
    P, f = solved.P.copy(), solved.fields
    marks = np.zeros(P.shape, dtype=np.uint8)
    boundary.mark_boundary(P, marks)
    tiny = (marks == boundary.MARKED) & (P > 0.0) & (P < 1e-3)
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
