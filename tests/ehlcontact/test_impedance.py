"""Linearised contact: against a full solve at one frequency, and against the motion in time."""

from math import pi

import numpy as np
import pytest
from balls import OF_6205

from ehlcontact import Domain, Grid, InputError, Lubricant, MoesPoint, OperatingPoint, impedance, read, save
from ehlcontact.linearised_film import held
from ehlcontact.solver import linearised_contact
from ehlcontact.solver.error_estimate import NOISE, response_error
from ehlcontact.solver.kernels.linearise import dense_jacobian, linearise
from ehlcontact.solver.linearised_contact import LinearisedContact
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.mesh_choice import NEAR_DOMAIN, Purpose, damping_mesh, mesh_for
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.steady import solve_steady
from ehlcontact.transient.transient_contact import TransientContact

POINT = MoesPoint(200, 10, 0.5)


OMEGA = np.array([0.0, 0.25, pi, 4.0 * pi, 30.0])


def dense(contact, film, n):
    """J and B of a linearised contact as matrices, by the kernel that the coarse grids use."""
    level = Multigrid(POINT, Mesh(n, film.domain, POINT.kappa)).finest
    level.P[...] = film.p.T
    level.update_film(film.approach)
    level.update_residual()
    m, f = contact.nodes.size, level.fields
    matrices = []
    for c_t in (0.0, 1.0):
        linearise(f.P, f.flow, level.stencil, c_t, 1.0, f.p_coef, f.h_coef)
        J, number = np.empty((m, m + 1)), np.empty(f.P.size, dtype=np.int64)
        dense_jacobian(contact.nodes, f.p_coef, f.h_coef, level.deflection.kernel, number, J)
        matrices.append(J)
    steady, unit = matrices
    return steady, unit - steady


@pytest.mark.parametrize("n", [48, pytest.param(64, marks=pytest.mark.slow)])
def test_equals_the_dense_complex_solve(steady, n):
    film = steady(200, 10, 0.5, n)
    contact = LinearisedContact(held(film))
    J, B = dense(contact, film, n)
    np.testing.assert_allclose(contact.j, J[:, -1], atol=1e-12 * np.abs(J[:, -1]).max())
    np.testing.assert_allclose(contact.b, B[:, -1], atol=1e-12 * np.abs(J[:, -1]).max())
    result = impedance(POINT, Omega=OMEGA, grid=Grid(n=n))
    assert (result.residual < 1e-5).all()
    for k, w in enumerate(np.maximum(OMEGA, 1e-4)):
        matrix = J + 1j * w * B
        exact = contact.weights @ np.linalg.solve(matrix[:, :-1], -matrix[:, -1])
        assert result.stiffness[k] == pytest.approx(exact.real, rel=1e-4)
        assert result.damping[k] == pytest.approx(exact.imag / w, rel=5e-4)


def test_products_are_those_of_the_dense_matrices(steady):
    film = steady(200, 10, 0.5, 48)
    contact = LinearisedContact(held(film))
    x = np.random.default_rng(5).normal(size=contact.nodes.size)
    for got, matrix in zip(contact.products(x), dense(contact, film, 48), strict=True):
        expected = matrix[:, :-1] @ x
        np.testing.assert_allclose(got, expected, atol=1e-7 * np.abs(expected).max())


def test_many_frequencies_share_the_solves(steady, monkeypatch):
    """Forty frequencies between 0 and 30 need no more than fifteen solves: the space answers for the others."""
    film = steady(200, 10, 0.5, 48)
    contact = LinearisedContact(held(film))
    solved = []
    solve = contact.solve
    monkeypatch.setattr(contact, "solve", lambda w, *rest: solved.append(w) or solve(w, *rest))
    residual = contact.respond(np.linspace(0.01, 30.0, 40), 1e-4).residual
    assert (residual < 1e-4).all()
    assert len(solved) <= 15


@pytest.mark.slow
def test_fine_grid_is_within_reach(steady):
    """At n = 128 both tolerances agree: C is as accurate as said."""
    film = steady(200, 10, 0.5, 128)
    contact = LinearisedContact(held(film))
    omega = np.maximum(OMEGA, 1e-4)
    Z, tight = (contact.respond(omega, tolerance)[0] for tolerance in (1e-5, 1e-7))
    np.testing.assert_allclose(Z.real, tight.real, rtol=1e-4)
    np.testing.assert_allclose(Z.imag, tight.imag, rtol=5e-4)


def test_tells_the_film_that_was_linearised(steady):
    film, result = steady(200, 10, 0.5, 48), impedance(POINT, Omega=[0.0], grid=Grid(n=48))
    told = result.film.approach, result.film.h_central, result.film.h_min
    # to rounding: impedance keeps BLAS on one thread, and LU factors of several round differently
    assert told == pytest.approx((film.approach, film.h_central, film.h_min), rel=1e-8)


def test_static_stiffness_is_the_slope_of_the_load_curve():
    u = solve_steady(POINT, grid=Grid(n=48), tol=1e-7).approach
    h = 2e-3
    force = [solve_steady(POINT, grid=Grid(n=48), approach=u + s * h, tol=1e-7).force for s in (-1, 1)]
    assert impedance(POINT, Omega=[0.0], grid=Grid(n=48)).stiffness[0] == pytest.approx(
        (force[1] - force[0]) / (2 * h), rel=2e-3
    )


FOUR = [pytest.param(w, marks=[] if w == pi else pytest.mark.slow) for w in (0.25, 0.5 * pi, pi, 2.0 * pi)]


@pytest.mark.parametrize("omega", FOUR)
def test_agrees_with_small_motion_in_time(steady, omega):
    """A small harmonic approach on the full contact, last period of three, first harmonic of the force."""
    n, amplitude, steps = 48, 2e-3, 160
    contact = TransientContact(POINT, grid=Grid(n=n), tol=1e-6)
    T = 2.0 * pi / omega * np.arange(1, 3 * steps + 1) / steps
    force = np.array([contact.advance(T[0], contact.static_approach + amplitude * np.sin(omega * t)) for t in T])
    last = slice(2 * steps, 3 * steps)
    c = 2.0 / steps / amplitude
    K = c * np.sum(force[last] * np.sin(omega * T[last]))
    C = c * np.sum(force[last] * np.cos(omega * T[last])) / omega
    result = impedance(POINT, Omega=[omega], grid=Grid(n=n))
    assert result.stiffness[0] == pytest.approx(K, rel=2e-3)
    assert result.damping[0] == pytest.approx(C, rel=0.02)


@pytest.mark.parametrize("values", [[], [-1.0], [float("nan")], [float("inf")], [201.0], ["fast"], [[1.0]]])
def test_bad_frequencies_are_named(values):
    with pytest.raises(InputError, match=r"^Omega = .*: must be "):
        impedance(POINT, Omega=values, grid=Grid(n=32))


def test_interrupted_start_gives_no_result(monkeypatch):
    """The film that Ctrl-C leaves is not converged: its linearisation would be no answer."""

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("ehlcontact.solver.multigrid.Multigrid.cycle", interrupted)
    with pytest.raises(KeyboardInterrupt):
        impedance(MoesPoint(200, 10, 0.5), Omega=[0.0, 1.0], grid=Grid(n=48))


@pytest.mark.long
def test_thin_film_on_the_region_of_its_steady_solve():
    point = MoesPoint(20000, 2, 0.2)
    assert (
        impedance(point, Omega=[1.0], grid=Grid(n=256)).film.domain
        == mesh_for(point, Purpose.FILM).domain
        == NEAR_DOMAIN
    )


def test_region_widens_at_light_load(monkeypatch):
    point = MoesPoint(7, 1, 0.08)
    assert (
        impedance(point, Omega=[1.0], grid=Grid(n=64)).film.domain == solve_steady(point, grid=Grid(n=64)).domain
    )
    # from a region that pressure fills: no default one does any more
    monkeypatch.setattr(Domain, "for_point", lambda *_: Domain())
    assert impedance(point, Omega=[1.0], grid=Grid(n=64)).film.domain.x_in < Domain().x_in


@pytest.mark.parametrize(
    "point",
    [pytest.param(POINT, marks=pytest.mark.long), pytest.param(MoesPoint(100, 12, 0.8), marks=pytest.mark.slow)],
)
def test_errors_hold_against_finer_grids(point):
    """Stiffness and damping on meshes about right lie within their bars of those on twice the intervals."""
    omega = [0.0, 0.05, 0.5, 1.0, 3.0, 10.0, 30.0]
    result, fine = (impedance(point, Omega=omega, grid=Grid(n=n)) for n in (64, 128))
    for name, bar in result.error_bars.items():
        values, exact = getattr(result, name), getattr(fine, name)
        assert (np.abs(values - exact) <= bar).all()
        assert (bar < 0.3 * np.abs(exact)).all()


def test_film_that_half_the_intervals_do_not_show_still_has_an_error():
    """The film is negative on n = 64, so two grids tell the error; on 16 alone nothing is known."""
    point = MoesPoint(4266, 9, 0.205)
    result = impedance(point, Omega=[0.0, 3.0], grid=Grid(n=128))
    assert (result.error_bars["damping"] > 0.05 * result.damping).all()
    assert "nodes are 0.047 semi-axes apart, damping needs 0.025; C may be off by" in result.reservation
    alone = impedance(MoesPoint(5, 2, 0.5), Omega=[0.0], grid=Grid(n=16))
    assert alone.error_bars["damping"] == pytest.approx(np.abs(alone.damping))
    assert alone.reservation.endswith("C may be off by anything at omega 0")


def test_errors_of_two_and_three_meshes():
    """Errors of second order are stated twice too large; a part right by chance has the other's."""
    omega, exact, slope = np.array([0.5, 2.0]), np.array([2.0 + 1.0j, 3.0 + 4.0j]), np.array([0.3, 0.02j])
    found = [exact + slope * h * h for h in (0.1, 0.2, 0.4)]
    dK, dC = response_error(omega, found)
    K, C = NOISE[0] * found[0].real, NOISE[1] * found[0].imag / omega
    np.testing.assert_allclose(dK - K, [2 * 0.003, 2 * 0.0002], rtol=1e-12)
    np.testing.assert_allclose(dC - C, [2 * 0.003 * 0.5, 2 * 0.0001], rtol=1e-12)
    dK, dC = response_error(omega, found[:2])
    np.testing.assert_allclose(dK - K, [3 * 0.003, 3 * 0.0002], rtol=1e-12)
    np.testing.assert_allclose(response_error(omega, found[:1]), [found[0].real, found[0].imag / omega])


def test_in_si_and_in_files(tmp_path):
    oil = Lubricant(0.04, 2.2e-8)
    point = OperatingPoint.ball_bearing(oil, **OF_6205, speed_rpm=3000.0, load=30.0)
    result = impedance(point, hz=[0.0, 50.0], grid=Grid(n=48))
    s, plain = point.scales, result.dimensionless
    np.testing.assert_allclose(result.hz, [0.0, 50.0])
    for name in ("damping", "stiffness"):
        unit = getattr(s, name)
        np.testing.assert_allclose(getattr(result, name), getattr(plain, name) * unit)
        np.testing.assert_allclose(result.error_bars[name], plain.error_bars[name] * unit)
    np.testing.assert_allclose(result.value, result.stiffness + 1j * result.omega * result.damping)
    with pytest.raises(InputError, match=r"^hz = "):
        _ = plain.hz
    again = read(save(result, tmp_path / "k_and_c.h5"))
    assert again.to_dict() == result.to_dict() and again.point == point
    np.testing.assert_array_equal(again.value, result.value)


def test_factors_of_one_band_at_a_time_give_the_same(monkeypatch):
    """As on large grids, where those of all bands would not fit into memory."""
    every = impedance(POINT, Omega=OMEGA, grid=Grid(n=48))
    monkeypatch.setattr(linearised_contact, "MANY_NODES", 0)
    one = impedance(POINT, Omega=OMEGA, grid=Grid(n=48))
    np.testing.assert_allclose(one.stiffness, every.stiffness, rtol=1e-4)
    np.testing.assert_allclose(one.damping, every.damping, rtol=5e-4)


THIN = [MoesPoint(22776, 11.565, 0.34455), MoesPoint(13898, 7.84, 0.414)]


@pytest.mark.parametrize("point", THIN)
def test_thin_films_get_the_mesh_that_damping_needs(point):
    mesh = mesh_for(point, Purpose.DAMPING)
    assert mesh.n == 640 and mesh.size <= damping_mesh(point)


@pytest.mark.slow  # two minutes and 2.7 GB each
@pytest.mark.parametrize("point", THIN)
def test_thin_films_on_that_mesh(point):
    """On n = 320 C is several per cent high at Omega 0.05 and low at 3: its bar and reservation say so."""
    omega = [0.05, 3.0]
    result, coarse = impedance(point, Omega=omega), impedance(point, Omega=omega, grid=Grid(n=320))
    assert "semi-axes apart" in coarse.reservation and "semi-axes apart" not in result.reservation
    off = coarse.damping / result.damping - 1.0
    assert 0.04 < off[0] < 0.1 and -0.3 < off[1] < -0.05
    assert (np.abs(coarse.damping - result.damping) <= coarse.error_bars["damping"]).all()
    assert result.error_bars["damping"][0] < 0.5 * coarse.error_bars["damping"][0]
