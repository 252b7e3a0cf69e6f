"""Film of the whole plane, profiles, fringes and film waves: identities, known answers, bad input."""

import numpy as np
import pytest

from ehlcontact import (
    FreeVibration,
    Geometry,
    Grid,
    HarmonicLoad,
    InputError,
    KeepSettings,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    PrescribedLoad,
    TimeSteps,
    simulate,
    solve_steady,
)
from ehlcontact.film import film_history, film_of, interferogram, track_wave
from ehlcontact.film.over_time import FilmWave, film_wave
from ehlcontact.film.plane import Film

STEEL_ON_GLASS = OperatingPoint(Geometry(12.7e-3, 20e-3, e2=8e10, nu2=0.2), Lubricant(0.1), 20.0, 0.5)

WAVE = MoesPoint(200.0, 10.0, 0.5)


@pytest.fixture(scope="module")
def steady():
    return solve_steady(STEEL_ON_GLASS, grid=Grid(n=64))


@pytest.fixture(scope="module")
def film(steady):
    return film_of(steady)


@pytest.fixture(scope="module")
def harmonic():
    return simulate(
        MoesPoint(200.0, 10.0, 0.5), HarmonicLoad(Omega=np.pi), grid=Grid(n=32), time=TimeSteps(until=1.0)
    )


def wedge(gap):
    """Film of the given gap [m] over x, the same for all y."""
    s = STEEL_ON_GLASS.scales
    x, y = np.linspace(-s.a, s.a, gap.size), np.linspace(-s.b, s.b, 9)
    h = np.repeat(gap[:, None], y.size, axis=1)
    return Film(STEEL_ON_GLASS, x, y, h, np.zeros_like(h))


def test_film_fills_the_plane(steady, film):
    assert film.h.shape == (steady.x.size, 2 * steady.y.size - 1) == film.p.shape
    np.testing.assert_array_equal(film.h, film.h[:, ::-1])
    np.testing.assert_array_equal(film.y, -film.y[::-1])
    np.testing.assert_array_equal(film.h[:, steady.y.size - 1 :], steady.h)
    # eq. 4 over the whole plane
    cell = (film.x[1] - film.x[0]) * (film.y[1] - film.y[0])
    assert film.p.sum() * cell == pytest.approx(STEEL_ON_GLASS.load, rel=1e-6)


def test_profiles_in_si(film):
    scales, across, along = STEEL_ON_GLASS.scales, film.across, film.along
    assert across.x[-1] == pytest.approx(3.0 * scales.b) and along.x[0] == pytest.approx(-4.5 * scales.a)
    np.testing.assert_array_equal(along.h, film.h[:, film.y.size // 2])
    np.testing.assert_array_equal(along.p, film.p[:, film.y.size // 2])


def test_midplanes_cross_in_the_centre(steady, film):
    along = np.interp(0.0, film.along.x, film.along.h)
    assert film.across.h[film.y.size // 2] == pytest.approx(along, rel=1e-12)
    assert along == pytest.approx(steady.h_central, rel=2e-3)


def test_horseshoe(steady, film):
    film, found = film.dimensionless, film.constriction.dimensionless
    assert found.minimum == pytest.approx(steady.dimensionless.h_min, rel=1e-12)
    near = np.abs(film.x[:, None] - found.x) < 0.1, np.abs(film.y - found.y) < 0.1
    assert found.minimum < film.h[near[0] & near[1]].min() < 1.03 * film.h.min()
    # side lobes, narrower than the exit, on the rim of the Hertz ellipse
    assert found.minimum <= found.side_film < found.central and found.minimum <= found.exit_film < found.central
    assert 0.7 < found.side_place < 1.1 and 0.7 < found.exit_place < 1.1
    assert found.ratio == pytest.approx(found.central / found.minimum) and found.ratio > 1.2


def test_fringes_of_a_wedge():
    """Bright where 2 n h is a whole number of wavelengths, dark half-way, and the other way round at phase pi."""
    wave, index = 600e-9, 1.5
    film = wedge(np.linspace(0.0, 2.0 * wave / (2.0 * index), 41))
    fringes = interferogram(film, wave, index)
    np.testing.assert_allclose(fringes.order[[0, 10, 20, 40], 0], [0.0, 0.5, 1.0, 2.0], atol=1e-12)
    np.testing.assert_allclose(fringes.intensity[[0, 10, 20, 30, 40], 3], [1.0, 0.0, 1.0, 0.0, 1.0], atol=1e-12)
    turned = interferogram(film, wave, index, np.pi)
    np.testing.assert_allclose(turned.intensity, 1.0 - fringes.intensity, atol=1e-12)
    np.testing.assert_allclose(turned.order, fringes.order + 0.5)
    assert fringes.resolved.all()
    assert not interferogram(film, wave / 12.0, index).resolved.any()


def test_fringes_of_a_contact(film):
    fringes = interferogram(film, 550e-9)
    assert fringes.intensity.shape == film.h.shape
    assert 0.0 <= fringes.intensity.min() and fringes.intensity.max() <= 1.0
    np.testing.assert_allclose(fringes.order, 3.0 * film.h / 550e-9)


def test_snapshots_of_a_simulation():
    unit = STEEL_ON_GLASS.scales.time
    run = simulate(
        STEEL_ON_GLASS,
        PrescribedLoad(np.linspace(0, 1, 4), np.ones(4)),
        grid=Grid(n=32),
        time=TimeSteps(until=0.4 * unit, dt=0.1 * unit),
        keep=KeepSettings(snapshots=[0.2 * unit, 0.4 * unit]),
    )
    np.testing.assert_array_equal(film_of(run).along.h, run.h_midplane[-1])
    np.testing.assert_array_equal(film_of(run, 0.2 * unit).along.p, run.p_midplane[2])
    history = film_history(run)
    assert history.point is STEEL_ON_GLASS
    for name in ("t", "h_min", "h_central"):
        np.testing.assert_array_equal(getattr(history, name), getattr(run, name))
    with pytest.raises(InputError, match=f"{0.2 * unit:g}, {0.4 * unit:g}"):
        film_of(run, 0.05 * unit)


def test_film_bad_input(steady, harmonic):
    with pytest.raises(InputError, match="steady film has no time"):
        film_of(steady, 1.0)
    with pytest.raises(InputError, match="kept no whole fields"):
        film_of(harmonic)
    with pytest.raises(InputError, match="SteadyResult"):
        film_of(steady.h)
    plain = film_of(solve_steady(MoesPoint(20.0, 5.0, 1.0), grid=Grid(n=32)))
    with pytest.raises(InputError, match="OperatingPoint"):
        interferogram(plain, 6e-7)
    film = film_of(steady)
    for arguments in ((0.0,), (-6e-7,), (6e-7, 0.0), (6e-7, 1.5, np.nan)):
        with pytest.raises(InputError):
            interferogram(film, *arguments)


@pytest.mark.parametrize("speed", [0.5, 1.0, 2.0, -1.0])
def test_tracking_a_known_wave(speed):
    X, T = np.linspace(-2.0, 1.5, 113), np.linspace(0.0, 6.0, 301)
    phase = X[None, :] - speed * T[:, None]
    track = track_wave(FilmWave(WAVE, X, T, np.sin(3.0 * phase) + 0.3 * np.cos(5.0 * phase)))
    assert track.speed == pytest.approx(speed, rel=5e-3)
    assert track.spread < 0.01
    np.testing.assert_allclose(track.delay, (track.x - track.x[0]) / speed, atol=0.02)


@pytest.mark.parametrize(
    "motion",
    [pytest.param(HarmonicLoad(Omega=np.pi), id="harmonic", marks=pytest.mark.slow), FreeVibration(Omega_n=5.13)],
)
def test_film_is_carried_at_the_mean_speed(motion):
    """Measured dX/dT is 1 in incompressible oil; in compressible oil a part of the film follows the pressure."""
    run = simulate(MoesPoint(200.0, 10.0, 0.5, density="incompressible"), motion, grid=Grid(n=64))
    wave = film_wave(run)
    assert wave.change.shape == (run.t.size, run.x.size)
    assert not wave.change[0].any()
    track = track_wave(wave)
    assert track.speed == pytest.approx(1.0, abs=0.005)
    assert track.spread < 0.01


def test_tracking_bad_input():
    X, T = np.linspace(-1.0, 1.0, 21), np.linspace(0.0, 4.0, 41)
    still = FilmWave(WAVE, X, T, np.zeros((41, 21)))
    with pytest.raises(InputError, match="at rest"):
        track_wave(still)
    for start, end in ((0.5, -0.5), (-2.0, 0.5), (0.0, 1.5)):
        with pytest.raises(InputError, match="in order within"):
            track_wave(still, start, end)
    with pytest.raises(InputError, match=r"at least 2\.4"):
        track_wave(FilmWave(WAVE, X, 0.5 * T, np.zeros((41, 21))))


def test_film_wave_of_a_steady_film_is_refused(steady):
    with pytest.raises(InputError, match=r"^run = 'SteadyResult'.*simulate"):
        film_wave(steady)


def test_wave_in_too_long_steps_is_refused():
    run = simulate(
        MoesPoint(200.0, 10.0, 0.5), HarmonicLoad(Omega=np.pi), grid=Grid(n=32), time=TimeSteps(until=4.0, dt=1.0)
    )
    with pytest.raises(InputError, match=r"^wave = 'a record of 4 steps': must be one in steps of 0.3 at most"):
        track_wave(film_wave(run))
