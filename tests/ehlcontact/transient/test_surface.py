"""Travelling features: shapes, their course over a time step, and that the film carries them undisturbed."""

import numpy as np
import pytest

from ehlcontact import (
    ConvergenceError,
    Dent,
    Grid,
    HarmonicLoad,
    InputError,
    MoesPoint,
    PrescribedLoad,
    TimeSteps,
    TransverseRidge,
    Waviness,
    simulate,
)
from ehlcontact.transient.surface import surface_height, surface_step

X, Y = np.linspace(-2.0, 1.0, 31), np.linspace(0.0, 1.0, 5)


def test_dent_and_its_rim():
    dent = Dent(2.0, 0.3, -1.0, kappa=0.5, speed=1.0)
    assert dent(np.array(-0.5), np.array(0.0), 0.5) == pytest.approx(2.0)
    # physical metric: y = Y b = Y a/kappa
    assert dent(np.array(-1.0), np.array(0.05), 0.0) == pytest.approx(dent(np.array(-0.9), np.array(0.0), 0.0))
    r = np.linspace(0.0, 0.6, 601)
    height = dent(r - 1.0, 0.0 * r, 0.0)
    assert height[r > 0.3001].max() < 0.0  # a rim stands out beyond the radius
    assert height.min() == pytest.approx(-0.0173 * 2.0, abs=2e-4) and r[height.argmin()] == pytest.approx(
        0.36, abs=2e-3
    )


@pytest.mark.parametrize(
    ("feature", "slip"),
    [
        (Dent(1.0, 0.4, -1.0, speed=1.0), 0.0),
        (Dent(1.0, 0.4, -1.0, speed=0.6), 0.4),
        (TransverseRidge(0.3, 0.8, -1.0, speed=1.5), -0.5),
        (Waviness(0.2, 0.7, 0.5, speed=1.0), 0.0),
    ],
)
def test_course_over_a_step(feature, slip):
    """Heights at both ends and before; film that moves at 1 sees the slope times the slip."""
    step = surface_step(feature, X, Y, 0.5, 0.1, 0.15)
    for height, T in ((step.height, 0.5), (step.before, 0.4), (step.earlier, 0.25)):
        np.testing.assert_allclose(height, surface_height(feature, X, Y, T), atol=1e-14)
    ahead, behind = (surface_height(feature, X + d, Y, 0.5) for d in (1e-5, -1e-5))
    np.testing.assert_allclose(step.rate, slip * (ahead - behind) / 2e-5, atol=1e-5)


def test_rest_before_the_start():
    """Features rest for T <= 0, so the first step knows no earlier course."""
    dent = Dent(1.0, 0.4, -1.0)
    step = surface_step(dent, X, Y, 0.1, 0.1, 0.0)
    np.testing.assert_array_equal(step.before, surface_height(dent, X, Y, 0.0))
    np.testing.assert_array_equal(step.earlier, step.before)
    assert surface_step(None, X, Y, 0.1, 0.1, 0.0) is None


def test_surface_that_cannot_be_used():
    with pytest.raises(InputError, match="returning shape"):
        surface_height(lambda X, Y, T: np.zeros(7), X, Y, 0.0)
    with pytest.raises(InputError, match="finite everywhere"):
        surface_height(lambda X, Y, T: np.nan * (X + Y), X, Y, 0.0)


def carry(depth, part):
    """Simulation of a dent that moves into the centre, in steps of `part` of a mesh size."""
    mesh = 6.0 / 64
    start = -20 * mesh
    return simulate(
        MoesPoint(58.07, 4.62, 1.0),
        PrescribedLoad(np.linspace(0.0, -start, 4), np.ones(4)),
        grid=Grid(n=64),
        time=TimeSteps(until=-start, dt=part * mesh),
        surface=Dent(depth, 0.3, start),
    )


@pytest.mark.parametrize(("depth", "largest"), [(0.1, 0.01), (1.0, 0.04)], ids=["as the film", "of ten films"])
def test_film_round_a_carried_dent(depth, largest):
    """The pocket arrives nearly as deep as made, its rim stays open, and halved steps hardly change the film.

    Plain differences of so steep a gap leave a source at the rim: halved steps then change the film by 2.4 % and
    18 % rms of the central film, and deeper dents eat it up.
    """
    run, finer = carry(depth, 1.0), carry(depth, 0.5)
    central = run.h_central[0]
    contact = np.abs(run.X) < 0.9
    outside = contact & (np.abs(run.X) > 0.36)
    for each in (run, finer):
        film = each.h_midplane[-1]
        assert 0.75 * depth < film[contact].max() - central < depth  # the bodies bulge a little into it
        assert run.X[contact][film[contact].argmax()] == pytest.approx(0.0, abs=1e-9)
        assert film[outside].min() > 0.3 * central
    change = (run.h_midplane[-1] - finer.h_midplane[-1])[outside]
    assert np.sqrt(np.mean(change**2)) < largest * central


def test_surface_must_be_even_in_y():
    with pytest.raises(InputError, match=r"^surface = .*even in Y"):
        simulate(
            MoesPoint(200, 10, 0.5),
            HarmonicLoad(Omega=3.0),
            grid=Grid(n=16),
            time=TimeSteps(until=0.1),
            surface=lambda X, Y, T: 0.01 * Y + 0.0 * X,
        )


@pytest.mark.parametrize(
    ("wavelength", "refused"), [(0.8, False), (0.4, True), (0.2, True), (0.1, True), (0.0942, True)]
)
def test_waviness_shorter_than_the_mesh_is_refused(wavelength, refused):
    """The mesh is 0.1875: 0.8 is four nodes to a wave, 0.4 two."""
    grid, wave = np.linspace(-4.5, 1.5, 33), Waviness(0.01, wavelength, start=0.0)
    if refused:
        with pytest.raises(InputError, match=r"^surface = .*between nodes.*mesh is 0\.188 along X: raise n"):
            surface_step(wave, grid, Y, 0.5, 0.1, 0.1)
    else:
        surface_step(wave, grid, Y, 0.5, 0.1, 0.1)


def test_dent_that_leaves_the_grid_is_resolved():
    """Its tail alone looks rough there; and a ridge narrower than the mesh does not hide on a node."""
    grid = np.linspace(-4.5, 1.5, 65)
    for T in np.arange(0.0, 12.0, 0.02):
        surface_step(Dent(0.03, 0.6, kappa=0.5), grid, Y, T, 0.02, 0.02)
    with pytest.raises(InputError, match="between nodes"):
        surface_step(TransverseRidge(0.01, 0.05, start=grid[40]), grid, Y, 0.0, 0.1, 0.1)


def test_step_of_a_surface_is_not_taken_for_a_short_wave():
    step = surface_step(lambda X, Y, T: 0.01 * (X > 0.23) + 0.0 * Y, X, Y, 0.5, 0.1, 0.1)
    assert step is not None
    np.testing.assert_array_equal(step.height, np.broadcast_to(0.01 * (X > 0.23), (Y.size, X.size)))


def test_surface_that_closes_the_gap_is_named():
    ridge = TransverseRidge(3.0, 0.4, start=0.0)
    with pytest.raises(ConvergenceError, match="surface stands out by 3"):
        simulate(
            MoesPoint(200, 10, 0.5),
            HarmonicLoad(Omega=3.0),
            grid=Grid(n=32),
            time=TimeSteps(until=0.1),
            surface=ridge,
        )
