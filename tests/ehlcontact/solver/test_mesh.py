"""Regions and grids chosen from the film to be expected; `tests/golden/golden.json` has what is chosen where."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ehlcontact import (
    ConvergenceError,
    Domain,
    FreeVibration,
    Grid,
    InputError,
    KeepSettings,
    MoesPoint,
    RunSettings,
    TimeSteps,
    TransientContact,
    impedance,
    simulate,
    solve_steady,
)
from ehlcontact.film_formulas import LIGHT_BLEND, LIGHT_LOAD
from ehlcontact.solver import domain as d
from ehlcontact.solver import grid_rules
from ehlcontact.solver import mesh_choice as m
from ehlcontact.solver.domain import check_intervals
from ehlcontact.solver.error_estimate import ErrorEstimate
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.mesh_choice import Purpose, mesh_for
from ehlcontact.status import Status


def test_default_is_the_documented_region():
    assert Domain().as_tuple() == (-4.5, 1.5, 3.0)


@pytest.mark.parametrize("load", [0.2, 1.0, 1.2])
def test_usual_loads_need_no_wider_region(load):
    assert Domain.for_load(load) == Domain()


def test_region_grows_with_the_hertz_ellipse():
    wide = Domain.for_load(8.0)  # ellipse twice as large
    assert wide.x_in == pytest.approx(-5.5)
    assert wide.x_out == pytest.approx(4.5)
    assert wide.y_max == pytest.approx(5.0)
    assert wide.x_out > 2.0 * Domain().x_out / 1.5  # the outlet still lies beyond the ellipse


@pytest.mark.parametrize("n", [16, 64, 2048, 48, np.int64(32)])
def test_good_grid(n):
    assert check_intervals(n) == n


BOX = [
    (5, 0, 5.0),
    (5, 25, 0.08),
    (200, 10, 0.5),
    (2900, 19, 0.11),
    (1000, 5, 1.0),
    (30000, 0, 0.08),
    (500, 3, 2.0),
]


@pytest.mark.parametrize("counts", [m.DOUBLED, m.STEPPED])
def test_all_counts_are_allowed_and_have_hierarchies(counts):
    for n in counts:
        check_intervals(n)
        halved = n
        while halved % 2 == 0 and halved >= 32:
            halved //= 2
        assert halved < 32, n


@pytest.mark.parametrize(("M", "L", "kappa"), BOX)
def test_steady_mesh_resolves_the_inlet_or_is_the_finest(M, L, kappa):
    point, rule = MoesPoint(M, L, kappa), m.FINENESS[Purpose.FILM]
    mesh = mesh_for(point, Purpose.FILM)
    share = m.MESH_OF_THIN_SIDES if grid_rules.has_thin_sides(point) else rule.share
    wanted = min(share * point.inlet_width, m.LARGEST_MESH)
    finer = replace(mesh, n=2 * mesh.n).nodes
    assert mesh.size <= wanted or finer > rule.largest
    assert mesh.nodes <= rule.largest
    if kappa <= grid_rules.SIDE_LOBES:
        assert mesh.n == 128 or 2.0 * mesh.size > wanted  # no finer than needed
    else:
        fine = (m.FINE_THIN_SIDES if grid_rules.has_thin_sides(point) else m.FINE_SIDES) * point.inlet_width
        assert mesh.size <= fine or finer > m.AFFORDABLE_GRID


def test_region_closes_in_on_thin_films():
    assert mesh_for(MoesPoint(2900, 19, 0.11), Purpose.FILM).domain == Domain()
    near = mesh_for(MoesPoint(30000, 0, 0.3), Purpose.FILM)
    assert near.domain == m.NEAR_DOMAIN == Domain.near()
    assert not grid_rules.has_thin_sides(MoesPoint(200, 10, 3.0))
    assert grid_rules.has_thin_sides(MoesPoint(7333, 2.6, 3.0))
    assert mesh_for(MoesPoint(7333, 2.6, 3.0), Purpose.FILM).domain == m.NEAREST_DOMAIN


@pytest.mark.slow
@pytest.mark.parametrize(
    ("M", "L", "kappa"), [(1625, 6.82, 4.73), (3786, 5.9, 2.74), (12834, 3.2, 1.09), (4861.8, 1.884, 3.6985)]
)
def test_side_lobes_of_long_contacts(M, L, kappa):
    """Films of 1e-4 dry approaches in the side lobes, long axis along rolling, unattended."""
    result = solve_steady(MoesPoint(M, L, kappa))
    assert result.status == "converged"
    assert 0.0 < result.h_min < 0.3 * result.h_central


@pytest.mark.parametrize("purpose", Purpose)
@pytest.mark.parametrize(("M", "L", "kappa"), BOX)
def test_what_is_given_is_kept(M, L, kappa, purpose):
    domain, point = Domain(-3.0, 1.4, 2.0), MoesPoint(M, L, kappa)
    if purpose not in m.FINENESS and point.inlet_width < 0.025:
        point = MoesPoint(200, 10, 0.5)
    assert mesh_for(point, purpose, grid=Grid(domain=domain)).domain == domain
    assert mesh_for(point, purpose, grid=Grid(n=48)).n == 48
    assert mesh_for(point, purpose, grid=Grid(n=48, domain=domain)) == Mesh(48, domain, point.kappa)


@pytest.mark.parametrize("purpose", Purpose)
def test_what_cannot_be_is_named(purpose):
    with pytest.raises(InputError, match=r"^n = 50: must be a multiple of 16"):
        mesh_for(MoesPoint(200, 10, 0.5), purpose, grid=Grid(n=50))
    with pytest.raises(InputError, match=r"^domain = 'tuple': must be a Domain"):
        mesh_for(MoesPoint(200, 10, 0.5), purpose, grid=Grid(domain=(-3.0, 1.4, 2.0)))


def test_meshes_of_moving_films_follow_the_inlet():
    for purpose in (Purpose.DAMPING, Purpose.RUN, Purpose.CONTACT):
        rule = m.FINENESS[purpose]
        assert mesh_for(MoesPoint(200, 10, 0.5), purpose).n == rule.counts[0]
        for M, L, kappa in BOX:
            point = MoesPoint(M, L, kappa)
            mesh = mesh_for(point, purpose, grid=Grid(domain=Domain()))
            resolved = mesh.size <= min(rule.share * point.inlet_width, m.LARGEST_MESH)
            following = next((k for k in rule.counts if k > mesh.n), None)
            assert resolved or following is None or Mesh(following, Domain(), kappa).nodes > rule.largest


def test_no_remedy_for_what_was_asked_for_or_is_done():
    point, mesh = MoesPoint(200, 10, 0.5), Mesh(128, Domain(), 0.5)
    for purpose in m.FINENESS:
        assert m.remedy(mesh, Status.CONVERGED, point, purpose) is None
        assert m.remedy(mesh, Status.INTERRUPTED, point, purpose) is None
        assert m.remedy(mesh, Status.OUT_OF_DOMAIN, point, purpose, grid=Grid(domain=Domain())) is None
    for status in (*m.REFINED, Status.OUT_OF_DOMAIN):
        assert m.remedy(mesh, status, point, grid=Grid(n=128)) is None
        assert m.remedy(mesh, status, point) is not None
    assert m.remedy(Mesh(2048, Domain(), point.kappa), Status.UNRESOLVED, point) is None


POOR = ErrorEstimate(approach=1e-5, h_central_relative=1e-3, h_min_relative=0.5)


@pytest.mark.parametrize(
    ("M", "L", "kappa"), [(4862, 1.9, 3.7), (14082, 2.8, 2.5), (1351, 3.5, 4.7), (16188, 1, 1.7)]
)
def test_lines_lie_close_where_side_lobes_are_not_resolved(M, L, kappa):
    """In grids that are affordable; whose lines are closer than those of the mesh that failed; once."""
    point = MoesPoint(M, L, kappa)
    first = mesh_for(point, Purpose.FILM)
    close = m.remedy(first, Status.UNRESOLVED, point)
    assert first.y_refinement == 1 < close.y_refinement and close.domain == first.domain
    assert close.n * close.y_refinement >= 2 * first.n or close.n * close.y_refinement == 2 * 1024
    assert close.nodes <= m.FINENESS[Purpose.FILM].largest
    assert close.nodes == pytest.approx(Mesh(close.n, close.domain, kappa).nodes * close.y_refinement)
    finer = m.remedy(close, Status.CONVERGED, point, error=POOR)
    assert finer is None or finer == replace(close, n=2 * close.n)
    # a film that is solved, but not its smallest: lines before more nodes than are affordable
    finest = Mesh(2048, first.domain, kappa)
    assert m.remedy(finest, Status.CONVERGED, point, error=POOR) == close


@pytest.mark.parametrize(("M", "L", "kappa"), [(9355, 0.72, 3.7), (18419, 2.64, 4.2), (25667, 3.2, 2.3)])
@pytest.mark.parametrize("status", m.REFINED)
def test_one_more_grid_is_tried_after_the_finest_that_is_affordable(M, L, kappa, status):
    """With four lines for a node, beyond what a film is tried on at first; never for one that is solved."""
    point = MoesPoint(M, L, kappa)
    mesh = m._with_close_lines(m.NEAREST_DOMAIN, point)
    assert not m.is_last(mesh)
    assert m.remedy(mesh, Status.CONVERGED, point, error=POOR) is None
    last = m.remedy(mesh, status, point)
    assert last is not None and m.is_last(last)
    assert last == Mesh(2048, mesh.domain, kappa, m.CLOSE_LINES) and last.nodes <= m.LAST_GRID
    assert m.remedy(last, status, point) is None


def test_the_last_grid_has_to_fit_into_memory(monkeypatch):
    point = MoesPoint(9355, 0.72, 3.7)
    mesh = m._with_close_lines(m.NEAREST_DOMAIN, point)
    monkeypatch.setattr(Mesh, "fits", lambda mesh, *_: mesh.nodes < m.FINENESS[Purpose.FILM].largest)
    assert m.remedy(mesh, Status.UNRESOLVED, point) is None


@pytest.mark.parametrize(("M", "L", "kappa"), [(30000, 0, 0.3), (12834, 3.2, 1.0), (200, 10, 0.5)])
def test_contacts_that_are_not_long_keep_their_lines(M, L, kappa):
    point = MoesPoint(M, L, kappa)
    mesh = mesh_for(point, Purpose.FILM)
    for status, error in ((Status.UNRESOLVED, None), (Status.STAGNATED, None), (Status.CONVERGED, POOR)):
        follows = m.remedy(mesh, status, point, error=error)
        assert follows is None or follows.y_refinement == 1


@pytest.mark.parametrize("purpose", [Purpose.DAMPING, Purpose.RUN, Purpose.CONTACT])
def test_spikes_of_stiff_oil_have_their_mesh_where_the_film_moves(purpose):
    """Not a thick film, which has none, and not a steady one, which is judged by its own estimate."""
    stiff, less, thick = (MoesPoint(*at) for at in ((1000, 24, 0.2), (1000, 20, 0.2), (5, 25, 0.08)))
    assert mesh_for(stiff, purpose).size <= m.SPIKE_MESH < mesh_for(less, purpose, grid=Grid(n=96)).size
    assert mesh_for(thick, purpose).size > m.SPIKE_MESH
    assert mesh_for(stiff, Purpose.FILM).n == mesh_for(less, Purpose.FILM).n == 128


@pytest.mark.slow
def test_damping_of_stiff_oil_at_the_resonance_of_its_film_within_a_few_per_cent():
    """On 80 intervals, which its inlet asks for, it is 25 % too large."""
    point = MoesPoint(1000, 24, 0.2)
    default, fine, coarse = (impedance(point, Omega=[5.0], grid=Grid(n=n)).damping[0] for n in (None, 192, 80))
    assert default == pytest.approx(fine, rel=0.03)
    assert coarse > 1.15 * fine


def test_impedance_tells_the_grid_it_chose():
    assert impedance(MoesPoint(200, 10, 0.5), Omega=[0.0]).film.n == 80
    assert impedance(MoesPoint(200, 10, 0.5), Omega=[0.0], grid=Grid(n=48)).film.n == 48


@pytest.mark.slow
def test_damping_of_a_thin_film_within_a_few_per_cent():
    """A deep groove at 1 kN on the chosen grid against one of half the mesh size."""
    point, omega = MoesPoint(2900, 19, 0.11), [0.05, 0.25, 1.0, 3.14, 6.28]
    chosen = impedance(point, Omega=omega)
    finer = impedance(point, Omega=omega, grid=Grid(n=2 * chosen.film.n))
    assert np.abs(chosen.damping / finer.damping - 1.0).max() < 0.05
    assert np.abs(chosen.stiffness / finer.stiffness - 1.0).max() < 0.005


@pytest.mark.parametrize("kappa", [0.05, 0.3, 1.0])
def test_default_region_grows_without_a_kink(kappa):
    """Exactly the documented one for heavy loads; extents and their slopes over ln N are continuous below."""

    def extents(log_load):
        return np.log(np.abs(Domain.for_point(MoesPoint(np.exp(log_load) / unit, 5.0, kappa)).as_tuple()))

    unit = MoesPoint(1.0, 5.0, kappa).load_number
    highest = np.log(LIGHT_LOAD * LIGHT_BLEND)
    for log_load in (highest + 1e-9, highest + 0.1, highest + 5.0):
        assert Domain.for_point(MoesPoint(np.exp(log_load) / unit, 5.0, kappa)) == Domain()
    at = np.arange(np.log(0.5), highest + 0.5, 0.01)
    slopes = np.diff([extents(log_load) for log_load in at], axis=0) / 0.01
    power = d.LIGHT_GROWTH * np.array([1.0, d.LIGHT_SIDES_GROWTH, d.LIGHT_SIDES_GROWTH])
    np.testing.assert_allclose(slopes[0], -power, rtol=1e-9)
    assert np.all(np.abs(np.diff(slopes, axis=0)) < 0.03 * power)  # a corner would change them by all of it
    assert np.all(np.diff(slopes, axis=0) > -1e-9)


LIGHT = MoesPoint(6.0748, 2.7586, 0.08827)


def widened(domain):
    return Domain(*(m.DOMAIN_GROWTH * end for end in domain.as_tuple()))


@pytest.fixture
def tight(monkeypatch):
    """A default region that pressure reaches beyond: none is known that the real one does not hold."""
    monkeypatch.setattr(d, "LIGHT_SIDES_GROWTH", 0.8)


@pytest.mark.long
@pytest.mark.usefixtures("tight")
def test_every_solve_widens_its_region_alike():
    """The film at rest decides; of what is left open, all solvers take the same."""
    film = solve_steady(LIGHT, grid=Grid(n=128), throw=False)
    assert film.status is Status.OUT_OF_DOMAIN  # a given n is judged as it is
    wide = solve_steady(LIGHT, refine=False).domain
    assert wide == widened(Domain.for_point(LIGHT))
    motion = FreeVibration(Omega_n=5.13)
    run = simulate(LIGHT, motion, grid=Grid(n=128), time=TimeSteps(until=0.05, dt=0.025))
    contact = TransientContact(LIGHT, grid=Grid(n=128))
    response = impedance(LIGHT, Omega=1.0, grid=Grid(n=128))
    assert run.domain == contact.domain == response.film.domain == wide
    assert run.static_approach == pytest.approx(contact.static_approach, abs=1e-6)
    given = Domain.for_point(LIGHT)
    assert (
        simulate(
            LIGHT, motion, grid=Grid(n=128, domain=given), time=TimeSteps(until=0.05), run=RunSettings(throw=False)
        ).status
        is Status.OUT_OF_DOMAIN
    )
    with pytest.raises(ConvergenceError, match="out_of_domain"):
        TransientContact(LIGHT, grid=Grid(n=128, domain=given))


@pytest.mark.usefixtures("tight")
def test_a_run_on_a_widened_region_goes_on(tmp_path):
    """A restart leaves the region open as the run did, and finds that of the checkpoint."""
    motion, path = FreeVibration(Omega_n=5.13), tmp_path / "run.h5"
    simulate(
        LIGHT, motion, grid=Grid(n=128), time=TimeSteps(until=0.05, dt=0.025), keep=KeepSettings(checkpoint=path)
    )
    whole = simulate(LIGHT, motion, grid=Grid(n=128), time=TimeSteps(until=0.1, dt=0.025))
    rest = simulate(
        LIGHT, motion, grid=Grid(n=128), time=TimeSteps(until=0.1, dt=0.025), keep=KeepSettings(restart=path)
    )
    np.testing.assert_array_equal(rest.approach, whole.approach)
    assert rest.domain == whole.domain != Domain.for_point(LIGHT)
    with pytest.raises(InputError, match="domain"):
        simulate(
            LIGHT,
            motion,
            grid=Grid(n=128, domain=Domain()),
            time=TimeSteps(until=0.1, dt=0.025),
            keep=KeepSettings(restart=path),
        )


def test_a_run_that_leaves_its_region_begins_again(monkeypatch):
    """At rest the film stays inside here, and leaves with the first step."""
    monkeypatch.setattr(d, "LIGHT_SIDES_GROWTH", 0.5)
    point, motion = MoesPoint(5.5, 4.0, 0.15), FreeVibration(Omega_n=5.13)
    inside = solve_steady(point, refine=False).domain
    given = simulate(
        point, motion, grid=Grid(n=64, domain=inside), time=TimeSteps(until=0.2), run=RunSettings(throw=False)
    )
    assert given.status is Status.OUT_OF_DOMAIN and given.t[-1] > 0.0
    run = simulate(point, motion, grid=Grid(n=64), time=TimeSteps(until=0.2))
    assert run.domain == widened(inside) and run.t[-1] == 0.2


@pytest.mark.parametrize("kappa", [0.05, 0.5, 4.0])
@pytest.mark.parametrize("N", [0.5, 2.0, 5.0])
def test_default_region_holds_the_pressure_of_light_loads(kappa, N):
    point = MoesPoint(N / MoesPoint(1.0, 0.0, kappa).load_number, 5.0, kappa)
    assert solve_steady(point, grid=Grid(n=128), method="multigrid").status is Status.CONVERGED


def test_widened_ends_with_what_was_given():
    given = Domain(-3.0, 1.4, 2.0)
    first = Mesh(64, given, LIGHT.kappa)
    assert list(m.wider_meshes(LIGHT, Purpose.RUN, Grid(n=64, domain=given))) == [first]
    regions = [mesh.domain for mesh in m.wider_meshes(LIGHT, Purpose.RUN)]
    assert regions[0] == Domain.for_point(LIGHT) and regions[1] == widened(regions[0])
    assert len(regions) == m.LARGEST_ATTEMPTS


def test_the_note_on_the_solver_has_the_numbers_of_the_code():
    """`docs/notes/solver.md`, "Lengths that are inputs"."""
    page = (Path(__file__).parents[3] / "docs" / "notes" / "solver.md").read_text(encoding="utf-8")
    text = " ".join(page[page.index("## Lengths that are inputs") :].split())
    near, nearest, limits = m.NEAR_DOMAIN, m.NEAREST_DOMAIN, m.ACCURACY
    for said in (
        f"of {m.FINENESS[Purpose.FILM].share:g} of it at first",
        f"{m.FINE_SIDES:g} or {m.FINE_THIN_SIDES:g} where side lobes are thinner",
        f"kappa above {grid_rules.SIDE_LOBES:g}; {m.MESH_OF_THIN_SIDES:g} of very",
        f"{m.LARGEST_MESH:g} semi-axes at most",
        f"above {limits.approach:g} dry approaches, {100 * limits.h_central_relative:g} % of the central or "
        f"{100 * limits.h_min_relative:g} % of the smallest film",
        f"[{near.x_in:g}, {near.x_out:g}] x [-{near.y_max:g}, {near.y_max:g}]",
        f"[{nearest.x_in:g}, {nearest.x_out:g}] x [-{nearest.y_max:g}, {nearest.y_max:g}]",
        f"below Wijnant's load number N = {LIGHT_LOAD / LIGHT_BLEND:g} the inlet with ({LIGHT_LOAD:g}/N)^"
        f"{d.LIGHT_GROWTH:g}, up to {d.MOST_LIGHT_GROWTH:g} times, outlet and sides with the power "
        f"{d.LIGHT_SIDES_GROWTH:g} of that, and gently from N = {LIGHT_LOAD * LIGHT_BLEND:g} on",
        f"Default [{Domain().x_in:g}, {Domain().x_out:g}] x [-{Domain().y_max:g}, {Domain().y_max:g}]",
    ):
        assert said in text, said
    thirds = {m.FINENESS[p].share for p in (Purpose.DAMPING, Purpose.RUN, Purpose.CONTACT)}
    assert "a third for damping and motion" in text and thirds == {1.0 / 3.0}
