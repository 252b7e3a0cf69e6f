"""Features on the surfaces of a starved contact: no oil is lost, and much oil is a flooded inlet."""

import numpy as np
import pytest
from oil_march import march

from ehlcontact import (
    Domain,
    Grid,
    Heat,
    Lubricant,
    MoesPoint,
    OilLayer,
    OperatingPoint,
    PrescribedLoad,
    SpeedHistory,
    TimeSteps,
    TransverseRidge,
    simulate,
)
from ehlcontact.solver.mesh import Mesh
from ehlcontact.transient.transient_film import TransientFilm

CIRCLE = MoesPoint(20, 10, 1)
NEAR, LONG, BOTH_WAYS = Domain(-3.0, 1.5, 2.25), Domain(-7.5, 1.5, 4.5), Domain(-3.0, 3.0, 2.25)
RIDGE = TransverseRidge(0.1, 1.0, -2.5)
HELD = PrescribedLoad([0.0, 1.0, 2.0, 100.0], [1.0, 1.0, 1.0, 1.0])


def marched(layer, surface, steps=80, n=48):
    """Central film after steps of .05, and the largest loss of oil in one."""
    film = TransientFilm(CIRCLE, Mesh(n, NEAR, 1.0), 1e-8, supply=lambda Y: np.full(Y.shape, layer))
    films = []
    kept = film.advance

    def advance(*given):
        step = kept(*given)
        films.append(film.level.central_film())
        return step

    film.advance = advance
    loss, _ = march(film, np.ones(steps + 1), 0.05, layer, surface)
    return np.array(films), loss


@pytest.mark.long
def test_no_oil_is_lost_under_a_ridge():
    """Within 1e-8 of the flow in every step; behind the ridge the film is what it was."""
    films, loss = marched(0.3, RIDGE)
    assert loss < 1e-8
    assert films.max() > 1.05 * films[0] and films.min() < 0.85 * films[0]
    assert films[-1] == pytest.approx(films[0], rel=0.02)


@pytest.mark.long
def test_a_deep_ridge_keeps_its_height():
    """Twice the nodes move the range of the film by less than a tenth; differences alone would halve it."""
    coarse, fine = (marched(0.3, RIDGE, n=n)[0] for n in (48, 96))
    assert np.ptp(coarse) == pytest.approx(np.ptp(fine), rel=0.1)


@pytest.mark.long
def test_much_oil_is_a_flooded_inlet():
    """What a ridge changes of film and approach."""
    given = {"grid": Grid(96, LONG), "surface": RIDGE, "time": TimeSteps(until=4.0, dt=0.05, tol=1e-5)}
    flooded, much = (simulate(CIRCLE, HELD, **given, **some) for some in ({}, {"supply": OilLayer(H=2.8)}))
    for name in ("h_central", "approach"):
        changes = [getattr(run, name) - getattr(run, name)[0] for run in (flooded, much)]
        assert np.abs(changes[1] - changes[0]).max() < 0.01 * np.abs(changes[0]).max()


@pytest.mark.long
def test_a_ridge_comes_back_with_its_oil():
    """The surfaces stop while it is in the contact, and roll back: the film is the mirror image ahead of it."""
    back = SpeedHistory([0.0, 1.0, 2.0, 4.0], [1.0, 1.0, -1.0, -1.0])
    given = {"grid": Grid(64, BOTH_WAYS), "speed": back, "surface": TransverseRidge(0.1, 1.0, -1.5)}
    run = simulate(CIRCLE, HELD, supply=OilLayer(H=0.3), **given, time=TimeSteps(until=3.0, dt=0.05, tol=1e-4))
    assert run.status.ok and 0.5 < run.h_central.min() / run.h_central[0] < 0.8


@pytest.mark.long
def test_with_heat_energy_is_closed():
    oil = Lubricant.iso_vg(68, temperature=50.0)
    ball = OperatingPoint.ball_bearing(
        oil, ball_diameter=7.94e-3, pitch_diameter=38.5e-3, conformity=0.52, speed_rpm=3000, load=60.0
    )
    time = TimeSteps(until=4.0 * ball.scales.time, dt=0.05 * ball.scales.time, tol=1e-4)
    given = {"grid": Grid(64), "supply": OilLayer(over_flooded=0.6), "time": time}
    surface = TransverseRidge(0.05, 1.0, -2.0)
    cold, warm = (simulate(ball, HELD, surface=surface, **given, thermal=some) for some in (None, Heat()))
    assert warm.heat_balance.max() < 1e-6
    np.testing.assert_allclose(warm.h_central, cold.h_central, rtol=5e-3)
