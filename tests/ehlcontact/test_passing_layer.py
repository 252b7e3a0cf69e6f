"""A layer that passes a linearised starved film: beside steady films, beside impedance, and fed back in time."""

import numpy as np
import pytest

from ehlcontact import Domain, Grid, MoesPoint, OilLayer, TransientContact, response, solve_steady
from ehlcontact.linearised_film import held, linearised
from ehlcontact.lubricant import density
from ehlcontact.solver.passing_layer import on_track

CIRCLE, WIDE = MoesPoint(20, 10, 1.0), MoesPoint(120, 10, 0.12)
GRIDS = {CIRCLE: Grid(32, Domain(-4.5, 1.5, 3.0)), WIDE: Grid(96, Domain(-6.0, 1.5, 3.0))}
SLOW = 1e-4


def film_of(point, layer, **given):
    return solve_steady(point, grid=GRIDS[point], supply=OilLayer(H=layer), tol=1e-9, max_cycles=80, **given)


def layer_at(point):
    """The layer that the flooded film lets through: r = 1."""
    flooded = solve_steady(point, grid=GRIDS[point], tol=1e-8)
    return flooded.h_central * float(density(1.0, point.law)[0])


def by_both(contact, omega, tolerance=1e-7):
    """Forces, and layers behind, by the approach and by the layer ahead."""
    w = np.array([omega])
    found = contact.respond(w, tolerance), contact.force_of_layer(w)
    return [one.force[0] for one in found], [one.behind[0] for one in found]


@pytest.mark.parametrize("point", [CIRCLE, pytest.param(WIDE, marks=pytest.mark.long)], ids=str)
def test_slow_changes_are_those_of_steady_films(point):
    layer = layer_at(point)
    film = film_of(point, layer)
    forces, layers = by_both(linearised(film, held(film)), SLOW)
    for k, (step, given) in enumerate(
        (
            (1e-4, [(layer, film.approach - 1e-4), (layer, film.approach + 1e-4)]),
            (1e-3 * layer, [(0.999 * layer, film.approach), (1.001 * layer, film.approach)]),
        )
    ):
        less, more = (film_of(point, at, approach=u) for at, u in given)
        force = (held(more).finest.force() - held(less).finest.force()) / (2.0 * step)
        behind = (more.layer_behind - less.layer_behind) / (2.0 * step)
        assert forces[k].real == pytest.approx(force, rel=2e-3)
        np.testing.assert_allclose(layers[k].real, behind, atol=0.02 * np.abs(behind).max())


def test_what_enters_leaves_or_is_stored():
    film = film_of(CIRCLE, layer_at(CIRCLE))
    contact = linearised(film, held(film))
    (_, found), (_, faster) = (by_both(contact, w, 1e-8) for w in (SLOW, 10.0 * SLOW))
    weights = np.where(np.arange(film.y.size) > 0, 1.0, 0.5)[:-1] * np.diff(film.y)[0]
    for k, enters in enumerate((0.0, 1.0)):
        kept = [weights @ (enters - one[k][:-1]) for one in (found, faster)]
        assert abs(kept[0].real) < 1e-5
        assert kept[1].imag == pytest.approx(10.0 * kept[0].imag, rel=1e-3)  # what is stored


class Returned:
    """Oil ahead of a film: what left the track comes back later, as a change of the uniform layer at rest."""

    def __init__(self, film, delay):
        self.layer, self.Y, self.delay = film.layer, film.y, delay
        self.T, self.left, self.way = [0.0], [on_track(film.layer_behind, film.y)], 0.0

    def entering(self, way, turned):
        change = np.interp(way - self.delay, self.T, self.left) - self.left[0]
        return self.layer + change

    def moved(self, way, turned, leaving):
        self.T.append(way)
        self.left.append(on_track(leaving, self.Y))
        self.way = way
        return self


@pytest.mark.long
def test_a_contact_that_follows_its_own_passes_in_time():
    """That adds F E B/(1 - E A) to its impedance, with the responses A, B, F and E = exp(-i Omega delay)."""
    omega, delay, size, steps, periods = 0.3, 3.0, 2e-3, 120, 3
    layer = layer_at(CIRCLE)
    film = film_of(CIRCLE, layer)
    (Z, F), layers = by_both(linearised(film, held(film)), omega)
    B, A = (on_track(one, film.y) for one in layers)
    E = np.exp(-1j * omega * delay)
    T = 2.0 * np.pi / omega / steps * np.arange(1, steps * periods + 1)

    def shaken(beyond):
        contact = TransientContact(CIRCLE, grid=GRIDS[CIRCLE], supply=OilLayer(H=layer), tol=1e-7)
        contact._film._beyond = beyond
        approach = contact.static_approach + size * np.sin(omega * T)
        force = np.array([contact.advance(T[0], u) for u in approach])[-steps:]
        return 2j / steps * np.sum(force * np.exp(-1j * omega * T[-steps:])) / size

    fixed, followed = shaken(None), shaken(Returned(film, delay))
    expected = F * E * B / (1.0 - E * A)
    assert abs(fixed - Z) < 0.05 * abs(expected)
    assert abs(followed - fixed - expected) < 0.06 * abs(expected)


@pytest.mark.long
def test_what_a_wide_contact_passes_on():
    """Half of a change of the layer; what its store takes from the damping is missing behind it.

    (120, 10, .12), r = 1: three other programs have C = -.97 at Omega = .02; half of a change is passed on.
    """
    given = {"Omega": [0.0, 0.02], "supply": OilLayer(over_flooded=1.0), "grid": Grid(128, Domain(-6.0, 1.5, 3.0))}
    layer, approach = (response(WIDE, to=to, **given) for to in ("layer", "approach"))
    C, passed = approach.damping, layer.passed_share[0]
    assert passed == pytest.approx(0.50, abs=0.01)
    assert C[1] == pytest.approx(-0.95, rel=0.03)
    missing = approach.layer_behind[0].imag / 1e-4
    assert missing == pytest.approx(passed * C[0] / layer.in_phase[0], rel=0.15)  # one store: -a G/f
    np.testing.assert_array_equal(layer.impedance[1], approach.value[1])
