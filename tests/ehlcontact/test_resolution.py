"""Grids chosen from the film to be expected."""

import numpy as np
import pytest

from ehlcontact import Domain, MoesPoint, solve_steady
from ehlcontact.impedance import impedance
from ehlcontact.solver import resolution as r
from ehlcontact.solver.domain import check_intervals

BOX = [
    (5, 0, 5.0),
    (5, 25, 0.08),
    (200, 10, 0.5),
    (2900, 19, 0.11),
    (1000, 5, 1.0),
    (30000, 0, 0.08),
    (500, 3, 2.0),
]


@pytest.mark.parametrize("counts", [r.DOUBLED, r.STEPPED])
def test_all_counts_are_allowed_and_have_hierarchies(counts):
    for n in counts:
        check_intervals(n)
        halved = n
        while halved % 2 == 0 and halved >= 32:
            halved //= 2
        assert halved < 32, n


@pytest.mark.parametrize(("M", "L", "kappa"), BOX)
def test_steady_mesh_resolves_the_inlet_or_is_the_finest(M, L, kappa):
    point = MoesPoint(M, L, kappa)
    n, domain = r.automatic_mesh(point)
    mesh = (domain.x_out - domain.x_in) / n * max(1.0, kappa)
    share = r.MESH_OF_THIN_SIDES if r.thin_sides(point) else r.MESH_OF_INLET
    wanted = min(share * r.inlet_width(point), r.LARGEST_MESH)
    finer = r.nodes(2 * n, domain, kappa)
    assert mesh <= wanted or finer > r.LARGEST_GRID
    assert r.nodes(n, domain, kappa) <= r.LARGEST_GRID
    if kappa <= r.LONG:
        assert n == 128 or 2.0 * mesh > wanted  # no finer than needed
    else:
        fine = (r.FINE_THIN_SIDES if r.thin_sides(point) else r.FINE_SIDES) * r.inlet_width(point)
        assert mesh <= fine or finer > r.AFFORDABLE_GRID


def test_region_closes_in_on_thin_films():
    assert r.automatic_mesh(MoesPoint(2900, 19, 0.11))[1] == Domain()
    assert r.automatic_mesh(MoesPoint(30000, 0, 0.3))[1] == r.CLOSE
    assert not r.thin_sides(MoesPoint(200, 10, 3.0))
    assert r.thin_sides(MoesPoint(7333, 2.6, 3.0))
    assert r.automatic_mesh(MoesPoint(7333, 2.6, 3.0))[1] == r.TIGHT


@pytest.mark.slow
@pytest.mark.parametrize(("M", "L", "kappa"), [(1625, 6.82, 4.73), (3786, 5.9, 2.74), (12834, 3.2, 1.09)])
def test_side_lobes_of_long_contacts(M, L, kappa):
    """Films of 1e-4 dry approaches in the side lobes, long axis along rolling, unattended."""
    result = solve_steady(MoesPoint(M, L, kappa))
    assert result.status == "converged"
    assert 0.0 < result.h_min < 0.3 * result.h_central


@pytest.mark.parametrize(("M", "L", "kappa"), BOX)
def test_given_domain_is_kept(M, L, kappa):
    domain = Domain(-3.0, 1.4, 2.0)
    assert r.automatic_mesh(MoesPoint(M, L, kappa), domain)[1] == domain


def test_moving_intervals_follow_the_inlet():
    domain = Domain()
    assert r.moving_intervals(None, MoesPoint(200, 10, 0.5), domain, 80) == 80
    assert r.moving_intervals(None, MoesPoint(200, 10, 0.5), domain, 128) == 128
    for M, L, kappa in BOX:
        point = MoesPoint(M, L, kappa)
        n = r.moving_intervals(None, point, domain, 80)
        mesh = 6.0 / n * max(1.0, kappa)
        resolved = mesh <= min(r.MESH_OF_MOVING_INLET * r.inlet_width(point), r.LARGEST_MESH)
        following = next((k for k in r.STEPPED if k > n), None)
        assert resolved or following is None or r.nodes(following, domain, kappa) > r.LARGEST_MOVING_GRID


def test_impedance_tells_the_grid_it_chose():
    assert impedance(MoesPoint(200, 10, 0.5), [0.0]).n == 80
    assert impedance(MoesPoint(200, 10, 0.5), [0.0], n=48).n == 48


@pytest.mark.slow
def test_damping_of_a_thin_film_within_a_few_per_cent():
    """A deep groove at 1 kN on the chosen grid against one of half the mesh size."""
    point, omega = MoesPoint(2900, 19, 0.11), [0.05, 0.25, 1.0, 3.14, 6.28]
    chosen = impedance(point, omega)
    finer = impedance(point, omega, n=2 * chosen.n)
    assert np.abs(chosen.damping / finer.damping - 1.0).max() < 0.05
    assert np.abs(chosen.stiffness / finer.stiffness - 1.0).max() < 0.005
