"""A layer that passes a linearised starved film: beside steady films, beside impedance, and fed back in time."""

import numpy as np
import pytest

from ehlcontact import Domain, Grid, MoesPoint, OilLayer, TransientContact, impedance, solve_steady
from ehlcontact.layer_response import layer_response
from ehlcontact.linearised_film import held, linearised
from ehlcontact.lubricant import density
from ehlcontact.solver.passing_layer import passing_layer

CIRCLE, WIDE = MoesPoint(20, 10, 1.0), MoesPoint(120, 10, 0.12)
GRIDS = {CIRCLE: Grid(32, Domain(-4.5, 1.5, 3.0)), WIDE: Grid(96, Domain(-6.0, 1.5, 3.0))}
SLOW = 1e-4


def film_of(point, layer, **given):
    return solve_steady(point, grid=GRIDS[point], supply=OilLayer(H=layer), tol=1e-9, max_cycles=80, **given)


def layer_at(point):
    """The layer that the flooded film lets through: r = 1."""
    flooded = solve_steady(point, grid=GRIDS[point], tol=1e-8)
    return flooded.h_central * float(density(1.0, point.law)[0])


def on_track(behind, Y):
    """Mean over the half width of the contact."""
    inside = Y <= 1.0
    return np.trapezoid(behind[..., inside], Y[inside]) / Y[inside][-1]


@pytest.mark.parametrize("point", [CIRCLE, pytest.param(WIDE, marks=pytest.mark.long)], ids=str)
def test_slow_changes_are_those_of_steady_films(point):
    layer = layer_at(point)
    film = film_of(point, layer)
    found = passing_layer(linearised(film, held(film)), SLOW, 1e-7)
    for k, (step, given) in enumerate(
        (
            (1e-4, [(layer, film.approach - 1e-4), (layer, film.approach + 1e-4)]),
            (1e-3 * layer, [(0.999 * layer, film.approach), (1.001 * layer, film.approach)]),
        )
    ):
        less, more = (film_of(point, at, approach=u) for at, u in given)
        force = (held(more).finest.force() - held(less).finest.force()) / (2.0 * step)
        behind = (more.layer_behind - less.layer_behind) / (2.0 * step)
        assert found.force[k].real == pytest.approx(force, rel=2e-3)
        np.testing.assert_allclose(found.behind[k].real, behind, atol=0.02 * np.abs(behind).max())


def test_what_enters_leaves_or_is_stored():
    film = film_of(CIRCLE, layer_at(CIRCLE))
    contact = linearised(film, held(film))
    found, faster = (passing_layer(contact, w, 1e-8) for w in (SLOW, 10.0 * SLOW))
    weights = np.where(np.arange(film.y.size) > 0, 1.0, 0.5)[:-1] * np.diff(film.y)[0]
    for k, enters in enumerate((0.0, 1.0)):
        kept = [weights @ (enters - one.behind[k][:-1]) for one in (found, faster)]
        assert abs(kept[0].real) < 1e-5
        assert kept[1].imag == pytest.approx(10.0 * kept[0].imag, rel=1e-3)  # what is stored


def test_force_by_the_approach_is_the_impedance():
    layer = layer_at(CIRCLE)
    film, answer = (
        film_of(CIRCLE, layer),
        impedance(CIRCLE, Omega=[0.05, 1.0], grid=GRIDS[CIRCLE], supply=OilLayer(H=layer)),
    )
    contact = linearised(film, held(film))
    for w, K, C in zip((0.05, 1.0), answer.stiffness, answer.damping, strict=True):
        Z = passing_layer(contact, w, 1e-7).force[0]
        assert Z.real == pytest.approx(K, rel=1e-3) and Z.imag / w == pytest.approx(C, abs=2e-4)


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
    at = passing_layer(linearised(film, held(film)), omega, 1e-7)
    B, A = (on_track(one, film.y) for one in at.behind)
    E = np.exp(-1j * omega * delay)
    T = 2.0 * np.pi / omega / steps * np.arange(1, steps * periods + 1)

    def shaken(beyond):
        contact = TransientContact(CIRCLE, grid=GRIDS[CIRCLE], supply=OilLayer(H=layer), tol=1e-7)
        contact._film._beyond = beyond
        approach = contact.static_approach + size * np.sin(omega * T)
        force = np.array([contact.advance(T[0], u) for u in approach])[-steps:]
        return 2j / steps * np.sum(force * np.exp(-1j * omega * T[-steps:])) / size

    fixed, followed = shaken(None), shaken(Returned(film, delay))
    expected = at.force[1] * E * B / (1.0 - E * A)
    assert abs(fixed - at.force[0]) < 0.05 * abs(expected)
    assert abs(followed - fixed - expected) < 0.06 * abs(expected)


@pytest.mark.long
def test_what_a_wide_contact_passes_on():
    """Half of a change of the layer; what its store takes from the damping is missing behind it.

    (120, 10, .12), r = 1: three other programs have C = -.97 at Omega = .02; half of a change is passed on.
    """
    found = layer_response(
        WIDE, Omega=[0.0, 0.02], supply=OilLayer(over_flooded=1.0), grid=Grid(128, Domain(-6.0, 1.5, 3.0))
    )
    C = found.force_by_approach.imag / [1e-4, 0.02]
    passed, force = found.behind_by_layer[0].real, found.force_by_layer[0].real
    assert passed == pytest.approx(0.50, abs=0.01)
    assert C[1] == pytest.approx(-0.95, rel=0.03)
    missing = (found.behind_by_approach[0] / 1e-4).imag
    assert missing == pytest.approx(passed * C[0] / force, rel=0.15)  # one store: -a G/f
