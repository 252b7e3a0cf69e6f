"""Waves on a surface: against dense matrices, runs in time, the dry limit, and finer grids."""

from math import pi

import numpy as np
import pytest
from balls import OF_6205
from programs import script

from ehlcontact import (
    Geometry,
    Grid,
    InputError,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    PrescribedApproach,
    TimeSteps,
    excitation,
    impedance,
    read,
    save,
    simulate,
    solve_steady,
)
from ehlcontact.linearised_film import held
from ehlcontact.solver.kernels.linearise import dense_jacobian, linearise
from ehlcontact.solver.linearised_contact import LinearisedContact

POINT = MoesPoint(200, 10, 0.5)


def dense_force(film, omega, k):
    """G by dense matrices and central differences of the operator itself, with the waves added to the film."""
    level, n = held(film).finest, film.n
    nodes, f = np.flatnonzero(level.P > 0.0), level.fields
    J, number, parts = np.empty((nodes.size, nodes.size + 1)), np.empty(level.P.size, dtype=np.int64), []
    for c_t in (0.0, 1.0):
        level.c_t = c_t
        linearise(f.P, f.flow, level.stencil, c_t, 1.0, f.p_coef, f.h_coef)
        dense_jacobian(nodes, f.p_coef, f.h_coef, level.deflection.kernel, number, J)
        parts.append(J[:, :-1].copy())
    matrix = parts[0] + 1j * omega * (parts[1] - parts[0])
    g, rho, step = -np.exp(-1j * k * level.X) * np.ones_like(level.P), f.flow.rho.copy(), 1e-5

    def operator(c_t, height):
        level.c_t, level.film_shift = c_t, height
        return -level.update(film.approach).ravel()[nodes]  # the right-hand side is 0

    def slope(c_t):
        both = [(operator(c_t, step * part), operator(c_t, -step * part)) for part in (g.real, g.imag)]
        found = [(plus - minus) / (2.0 * step) for plus, minus in both]
        return found[0] + 1j * found[1]

    by_waves = slope(0.0) + 1j * omega * (slope(1.0) - slope(0.0))
    Dg = np.zeros_like(g)
    Dg[:, 2:-1] = (2.0 * g[:, 3:] + 3.0 * g[:, 2:-1] - 6.0 * g[:, 1:-2] + g[:, :-3]) * n / 6.0
    Dg[:, 1] = (g[:, 2] - g[:, 0]) * n / 2.0
    by_waves += (rho * (Dg / (level.X[-1] - level.X[0]) + 1j * k * g)).ravel()[nodes]
    return level.force_weights.ravel()[nodes] @ np.linalg.solve(matrix, -by_waves)


@pytest.mark.parametrize("speed", [1.0, 1.3])
def test_equals_dense_matrices_and_differences_of_the_operator(steady, speed):
    film, omega = steady(200, 10, 0.5, 32), np.array([0.2, 3.0])
    G, residual, _ = LinearisedContact(held(film)).force_of_waves(omega, omega / speed)
    expected = np.array([dense_force(film, w, w / speed) for w in omega])
    assert np.abs(G - expected).max() < 1e-5 and (residual < 1e-5).all()


@pytest.mark.long
def test_waves_of_a_thick_elliptic_film():
    """Force over height times |Z|: values of an independent program, .008 and .029 where the halves cancel."""
    result = excitation(POINT, wavelength=[16.0, 8.0, 4.0, 2.0], grid=Grid(n=96))
    assert result.contact_filter[:3] == pytest.approx([0.952, 0.826, 0.495], rel=0.03)
    assert result.contact_filter[3] < 0.04
    Z = impedance(POINT, Omega=result.omega, grid=Grid(n=96)).value
    np.testing.assert_allclose(result.contact_filter, np.abs(result.value / Z), rtol=1e-6)
    np.testing.assert_allclose(result.wavelength * result.omega, 2.0 * pi)


def test_wavelengths_are_in_the_units_of_the_point():
    """Metres at an operating point, where semi-axes are refused, and semi-axes at its Moes point."""
    point = OperatingPoint(Geometry(3e-3, 60e-3), Lubricant(0.05, 2e-8), 200.0, 5.0)
    a, grid = point.scales.a, Grid(n=64)
    found = excitation(point, wavelength=[20.0 * a, 8.0 * a], speed=0.7, grid=grid)
    plain = excitation(point.moes, wavelength=[20.0, 8.0], speed=0.7, grid=grid)
    np.testing.assert_allclose(found.wavelength, [20.0 * a, 8.0 * a], rtol=1e-14, atol=0.0)
    np.testing.assert_allclose(found.contact_filter, plain.contact_filter, rtol=1e-12, atol=0.0)
    np.testing.assert_allclose(found.dimensionless.wavelength, plain.wavelength, rtol=1e-14, atol=0.0)
    for wavelength, words in (
        (8.0, r"at most 0\.179 m at an OperatingPoint \(given in semi-axes a\?\)"),
        (2e-6, r"at least 2\.81e-06 m, which is Omega = 200"),
        (1e-5, r"at least 3\.36e-05 m \(up to .* Hz\), 4 nodes of n = 64"),
    ):
        with pytest.raises(InputError, match=rf"^wavelength = {wavelength!r}: must be .*{words}"):
            excitation(point, wavelength=wavelength, grid=grid)


@pytest.mark.slow
def test_what_is_left_of_waves_as_long_as_the_contact_stands_on_finer_grids():
    """Both halves cancel at 2 a: what is left is the film's, and lies within the error bars of coarser grids."""
    waves = [16.0, 8.0, 4.0, 2.0, 1.0]
    coarse, fine, finest = (excitation(POINT, wavelength=waves, grid=Grid(n=n)) for n in (64, 128, 192))
    for result in (coarse, fine):
        assert (np.abs(result.value - finest.value) <= result.error_bars["amplitude"]).all()
    assert fine.contact_filter[3] == pytest.approx(finest.contact_filter[3], rel=0.05)
    assert 0.02 < finest.contact_filter[3] < 0.04


@pytest.mark.long
def test_errors_hold_against_a_finer_grid():
    coarse, fine = (excitation(POINT, Omega=[0.05, 0.5, 2.0, 5.0], grid=Grid(n=n)) for n in (48, 96))
    assert (np.abs(coarse.value - fine.value) <= coarse.error_bars["amplitude"]).all()
    assert (coarse.error_bars["amplitude"] < 0.12 * np.abs(fine.value[0])).all() and not fine.reservation
    assert "may be off by" in excitation(MoesPoint(5, 2, 0.5), Omega=2.0, grid=Grid(n=16)).reservation


def test_long_waves_are_an_approach():
    """G tends to Z, in both parts."""
    result, Z = (solve(POINT, Omega=[0.01, 0.05], grid=Grid(n=48)) for solve in (excitation, impedance))
    np.testing.assert_allclose(result.in_phase, Z.stiffness, rtol=2e-3)
    assert result.contact_filter == pytest.approx([1.0, 1.0], abs=1e-3)


@pytest.mark.long
def test_dry_limit():
    """Thin films: the mean of the waves weighted by 1/sqrt(1 - r^2), whatever the ellipse."""
    k = np.array([0.5, 1.0, 2.0, 4.0])
    found = excitation(MoesPoint(1500, 2, 0.5), Omega=k, grid=Grid(n=128)).in_phase
    np.testing.assert_allclose(found / found[0], np.sin(k) / k / (np.sin(0.5) / 0.5), atol=0.03)


def force_in_time(point, n, waves, amplitude, dT):
    """G from a run over all of these waves at once, the last period of the longest, after 8 units of time."""
    k, longest = 2.0 * pi / np.asarray(waves), max(waves)
    T = np.linspace(0.0, 8.0 + longest, 5)
    held_fast = PrescribedApproach(T, np.full(5, solve_steady(point, grid=Grid(n=n)).approach))
    run = simulate(
        point,
        held_fast,
        grid=Grid(n=n),
        time=TimeSteps(until=8.0 + longest, dt=dT, tol=1e-6),
        surface=lambda X, Y, T: -amplitude * sum(np.cos(one * (X - T)) for one in k) + 0.0 * Y,
    )
    last = slice(-round(longest / dT), None)
    turns = np.exp(-1j * np.outer(k, run.t[last]))
    return 2.0 / turns.shape[1] * turns @ run.force[last] / amplitude


@pytest.mark.long
def test_agrees_with_a_run_in_time():
    waves = [8.0, 4.0, 2.0]
    G = excitation(POINT, wavelength=waves, grid=Grid(n=32)).value
    assert np.abs(force_in_time(POINT, 32, waves, 5e-4, 0.1) - G).max() < 0.03 * np.abs(G).max()


@pytest.mark.slow
@pytest.mark.parametrize(("M", "L", "kappa", "n"), [(200, 10, 0.5, 64), (20, 5, 1.0, 64), (500, 12, 0.2, 96)])
def test_agrees_with_runs_at_six_wavelengths(M, L, kappa, n):
    point, waves = MoesPoint(M, L, kappa), [16.0, 8.0, 16.0 / 3.0, 4.0, 3.2, 2.0]
    G = excitation(point, wavelength=waves, grid=Grid(n=n)).value
    assert np.abs(force_in_time(point, n, waves, 2e-4, 0.05) - G).max() < 0.03 * np.abs(G).max()


def test_grid_follows_the_shortest_wave():
    short, long = (excitation(MoesPoint(20, 5, 1.0), wavelength=length) for length in (0.9, 9.0))
    assert short.film.n > long.film.n


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            {"wavelength": 0.3, "grid": Grid(n=64)},
            r"wavelength = 0.3: .* at least 0.375 .*up to 16.8.* n = 64",
        ),
        ({"Omega": 20.0, "grid": Grid(n=64)}, "wavelength = 0.314: must be at least 0.375"),
        ({"wavelength": [1.0, -1.0]}, r"wavelength = -1.0: must be finite and at least 0.0314"),
        ({"wavelength": np.inf}, r"wavelength = inf: must be between -1e\+30 and 1e\+30"),
        ({"wavelength": []}, "wavelength = .*: must be a number"),
        ({"wavelength": 2.0, "Omega": 1.0}, "wavelength = 2.0: must be left out"),
        ({"Omega": 0.0}, "Omega = 0.0: must be > 0"),
        ({"Omega": 1.0, "speed": 0.0}, "speed = 0.0: must be "),
        ({"hz": 50.0}, "hz = 50.0: must be left out"),
        ({}, "frequency = None: must be given once"),
    ],
)
def test_bad_input_is_one_line(arguments, message):
    with pytest.raises(InputError, match=message):
        excitation(POINT, **arguments)


def test_in_si_and_in_files(tmp_path):
    point = OperatingPoint.ball_bearing(Lubricant(0.04, 2.2e-8), **OF_6205, speed_rpm=3000.0, load=30.0)
    result = excitation(point, hz=[500.0, 5000.0], grid=Grid(n=48))
    plain, unit = result.dimensionless, point.scales.stiffness
    np.testing.assert_allclose(result.hz, [500.0, 5000.0])
    np.testing.assert_allclose(result.wavelength, 0.5 * point.u_sum / result.hz)
    np.testing.assert_allclose(result.amplitude, np.abs(plain.value) * unit)
    np.testing.assert_allclose(result.error_bars["amplitude"], plain.error_bars["amplitude"] * unit)
    np.testing.assert_allclose(result.contact_filter, plain.contact_filter)
    with pytest.raises(InputError, match=r"^damping = 'waves': must be asked of a response to approach"):
        _ = result.damping
    again = read(save(result, tmp_path / "waves.h5"))
    assert again.to_dict() == result.to_dict() and again.point == point


def test_example_draws_filters(tmp_path, monkeypatch, capsys):
    example, path = script("examples/studies/contact_filter.py"), tmp_path / "filter.png"
    monkeypatch.setattr(example, "WAVES", np.array([2.0, 4.0, 8.0]))
    monkeypatch.setattr(example, "GRID", Grid(n=32))
    monkeypatch.setattr("sys.argv", ["contact_filter.py", str(path)])
    example.main()
    assert path.read_bytes().startswith(b"\x89PNG") and example.dry(4.0) == pytest.approx(2.0 / pi)
    assert capsys.readouterr().out.count("\n") == 4
