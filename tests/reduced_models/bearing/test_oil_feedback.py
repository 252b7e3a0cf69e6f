"""Layers that follow the passes of the balls before, where the feed of a bearing is held."""

from dataclasses import replace

import numpy as np
import pytest

from ehlcontact import InputError, Lubricant, OilLayer
from reduced_models import BallBearing, OilBalance
from reduced_models.bearing.fed_layer import FedLayer
from reduced_models.bearing.oil_feedback import OilFeedback, Passage, store_of
from reduced_models.bearing.ring_statics import equilibrium_under, linear_balls
from reduced_models.bearing.solved_balls import with_solved_contacts

OIL = Lubricant.iso_vg(68, temperature=50.0)
LOAD, RPM, DOWN = np.array([0.0, -1000.0]), 3000.0, -0.5 * np.pi
FLOODED = BallBearing.catalogue("6205", oil=OIL)


def balance(load=1000.0, feed=0.0, **returns):
    return OilBalance(bearing=FLOODED, load=(0.0, -load), speed_rpm=RPM, feed=feed, **returns)


def fed(ratio, **returns):
    """The layer of `ratio` flooded films, kept by its feed."""
    start = balance(**returns)
    return balance(feed=start.feed_for(ratio * start.full_layer), **returns)


@pytest.fixture(scope="module")
def at_r():
    return {r: replace(FLOODED, supply=fed(r).lasting_supply) for r in (1.0, 1.5)}


def feedback_of(bearing, load=LOAD):
    place = equilibrium_under(bearing, load, RPM, DOWN)
    solved = with_solved_contacts(bearing, RPM, linear_balls(bearing, RPM, [place]), [place])
    return OilFeedback.of(bearing, RPM, solved, [place])


@pytest.mark.long
@pytest.mark.parametrize("ratio", [1.0, 1.5])
def test_slow_motion_is_that_of_steady_bearings_with_the_feed_held(at_r, ratio):
    """Beside differences of equilibria, each on the layer that the same feed keeps under its load."""
    bearing, feed, step = at_r[ratio], fed(ratio).feed, 20.0

    def slope(layers):
        places = [
            replace(FLOODED, supply=OilLayer(layer)).equilibrium((0.0, -load), speed_rpm=RPM).displacement[1]
            for load, layer in layers.items()
        ]
        return 2.0 * step / (places[0] - places[1])

    loads = 1000.0 - step, 1000.0 + step
    held_layer = slope(dict.fromkeys(loads, bearing.supply.h))
    held_feed = slope({load: balance(load, feed).lasting_layer for load in loads})
    found = bearing.coefficients(LOAD, speed_rpm=RPM, cage_angle=DOWN, hz=1e-6).stiffness[0, 1, 1]
    beside = replace(bearing, supply=OilLayer(bearing.supply.h))
    fixed = beside.coefficients(LOAD, speed_rpm=RPM, cage_angle=DOWN, hz=1e-6).stiffness[0, 1, 1]
    assert fixed == pytest.approx(held_layer, rel=1e-4)
    assert held_feed < held_layer and found - fixed == pytest.approx(held_feed - held_layer, rel=0.02)


@pytest.mark.long
@pytest.mark.parametrize("returns", [{}, {"returned": 0.6, "return_time": 0.02}])
def test_equations_are_those_of_the_whole_ring(returns):
    """All approaches and the layer as unknowns of one system, written out ball by ball."""
    bearing = replace(FLOODED, supply=fed(1.0, **returns).lasting_supply)
    one, omega = feedback_of(bearing), 2.0 * np.pi * np.array([3.0, 50.0, 400.0])
    found = one.impedance(1j * omega)
    balls, back_share = bearing.balls, returns.get("returned", 0.0)
    angles = DOWN + 2.0 * np.pi / balls * np.arange(balls)
    for k, s in enumerate(1j * omega):
        Z = np.moveaxis(np.asarray(one.balls.films.impedance(np.array([[[s]]]))), -2, 0)[:, 0, :]
        Z = Z.reshape(2, balls)
        a, b, f, D, T = one.passages
        H, R = 1.0 / (1.0 + s * T), back_share / (1.0 + s * returns.get("return_time", 0.0))
        carried = np.flatnonzero(Z[1])  # some by centrifugal force alone
        n = 2 * carried.size  # approaches of both contacts of each ball, then the layer
        A, rhs = np.zeros((n + 1, n + 1), complex), np.zeros((n + 1, 2), complex)
        passed = np.zeros(n + 1, complex)
        for i, ball in enumerate(carried):
            inner, outer = 2 * i, 2 * i + 1
            A[inner, inner] = 1.0
            if Z[0, ball]:
                A[inner, outer] = 1.0
                rhs[inner] = np.cos(angles[ball]), np.sin(angles[ball])
            A[outer, inner], A[outer, outer] = Z[0, ball], -Z[1, ball]
            A[outer, n] = f[0, ball] * H[0, ball] - f[1, ball] * H[1, ball]
            for column, unknown in enumerate((inner, outer)):
                at = column, ball
                # What arrives, of the layer and less by the approach, and what of it goes on
                arrives = H[at] * np.array([1.0, -s * D[at]])
                left = a[at] * arrives + np.array([0.0, b[at]])
                passed[[n, unknown]] += left + R * (arrives - left)
                passed[unknown] -= one.spread[at] / (1.0 + s * one.renewal[ball])
        passed[n] += 2 * (balls - carried.size)  # unloaded contacts pass everything
        later = np.exp(-s * one.delays) @ [0.25, 0.25, 0.5] / (2 * balls)
        A[n] = -later * passed
        A[n, n] += 1.0
        x = np.linalg.solve(A, rhs)
        still = A.copy()
        still[:, n], still[n] = 0.0, 0.0
        still[n, n] = 1.0
        fixed = np.linalg.solve(still, np.vstack([rhs[:n], np.zeros((1, 2))]))
        expected = np.zeros((2, 2), complex)
        for i, ball in enumerate(carried):
            with_oil = Z[0, ball] * x[2 * i] + f[0, ball] * H[0, ball] * x[n]
            expected += np.outer(rhs[2 * i], with_oil - Z[0, ball] * fixed[2 * i])
        np.testing.assert_allclose(found[k], expected, rtol=1e-5, atol=1e-5 * abs(expected).max())


def test_a_ring_that_closes_as_much_as_it_opens_keeps_its_layer():
    """Without load a preloaded ring loses as much oil on one side as it keeps on the other."""
    bearing = replace(FLOODED, clearance=-8e-6, supply=FedLayer(h=0.4e-6))
    one = feedback_of(bearing, np.zeros(2))
    s = 2j * np.pi * np.array([1.0, 50.0])
    assert np.abs(one.impedance(s)).max() < 1e-6 * np.abs(one.balls.impedance(s)).max()


def test_one_store_has_the_damping_of_the_contact(at_r):
    """Solves of the inner contact at r = 1: C = -.2325/(1 + (39.5 Omega)^2) (docs/notes/oil_supply.md)."""
    race = at_r[1.0].race("inner")
    starved = replace(race, conditions=replace(race.conditions, supply=OilLayer(over_flooded=1.0)))
    flooded = replace(race, conditions=replace(race.conditions, supply=None))
    answer, free = starved.answer(477.0, RPM), flooded.answer(477.0, RPM)
    G, T = store_of(answer, free)
    time = answer.point.scales.time
    assert T / time == pytest.approx(39.5, rel=0.25)
    slow = answer.omega * time <= 0.4
    C = answer.damping[slow]
    store = -G / (1.0 + (T * answer.omega[slow]) ** 2)
    film = free.impedance(omega=answer.omega[slow]).damping
    phi = np.linalg.lstsq(film[:, None], C - store, rcond=None)[0][0]
    assert 0.0 < phi < 1.0 and np.abs(C - store - phi * film).max() < 0.1 * np.abs(C).max()


@pytest.mark.long
def test_coefficients_say_that_the_feed_is_held(at_r):
    bearing, hz = at_r[1.0], [10.0, 50.0, 500.0]
    found = bearing.coefficients(LOAD, speed_rpm=RPM, cage_angle=DOWN, hz=hz)
    fixed = replace(bearing, supply=OilLayer(bearing.supply.h)).coefficients(
        LOAD, speed_rpm=RPM, cage_angle=DOWN, hz=hz
    )
    assert "the feed is held" in str(found) and "the feed is held" in found.to_dict()["held_feed"]
    assert fixed.held_feed == "" and "held_feed" not in fixed.to_dict()
    np.testing.assert_array_equal(found.damping, fixed.damping)  # of elements
    C, C_fixed = (one.signed_damping[:, 1, 1] for one in (found, fixed))
    assert C_fixed[0] < C_fixed[1] < 0.0 and C[0] > 0.0  # slow motion: less oil comes from contacts that close
    assert 0.5 < C[1] / C_fixed[1] < 1.0  # at the frequency of the shaft
    again = BallBearing.from_dict(bearing.to_dict())
    assert again == bearing and again.supply == bearing.supply


@pytest.mark.long
def test_rings_that_lose_as_much_outweigh_damping_below_zero(at_r):
    given = {"speed_rpm": RPM, "cage_angle": DOWN, "hz": 50.0}
    found = at_r[1.0].coefficients(LOAD, **given)
    gained = -found.omega[0] * np.diagonal(found.signed_damping[0]) / np.diagonal(found.stiffness[0])
    needed = gained.max()
    assert 5e-4 < needed < 1e-2 and f"a loss factor above {needed:.2g} outweighs it" in str(found)
    for factor, sign in ((0.9, -1.0), (1.2, 1.0)):
        C = replace(at_r[1.0], loss_factor=factor * needed).coefficients(LOAD, **given).signed_damping[0]
        assert sign * np.linalg.eigvalsh(0.5 * (C + C.T)).min() > 0.0


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"over_flooded": 1.0}, "layer h"),
        ({"h": [1e-7, 2e-7], "y": [0.0, 1.0]}, "uniform"),
        ({"h": 1e-7, "returned": 1.0, "return_time": 1.0}, "below 1"),
        ({"h": 1e-7, "returned": 0.5}, "return_time"),
        ({"h": 1e-7, "returned": 2.0, "return_time": 1.0}, "returned"),
        ({"h": 1e-7, "sharpness": 0.1}, "sharpness"),
    ],
)
def test_layers_that_no_feed_keeps(given, words):
    with pytest.raises(InputError, match=words):
        FedLayer(**given)


@pytest.mark.long
def test_passages_of_unloaded_contacts_change_nothing(at_r):
    one = feedback_of(at_r[1.0])
    light = one.passages[0] == 1.0
    assert light.sum() >= 4 and not one.passages[1:, light].any()
    assert (one.passages[0][~light] < 1.0).all() and len(Passage._fields) == 7


@pytest.mark.long
def test_mean_delay_is_that_of_the_oil_balance(at_r):
    """Of its rate of passes: tracks of length l are passed by both contacts of all balls at half of u_sum."""
    u_sum = FLOODED.race("inner").speed_sum * RPM * np.pi / 30.0
    mean = feedback_of(at_r[1.0]).delays @ [0.25, 0.25, 0.5]
    assert mean == pytest.approx(balance().track_length / (2.0 * FLOODED.balls * u_sum))
    inner = 60.0 / RPM / FLOODED.orders.bpfi_order
    assert feedback_of(at_r[1.0]).delays[0] == pytest.approx(inner)
