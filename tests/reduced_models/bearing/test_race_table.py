"""Tabulated laws against the elements that they are made of, and the atlas behind those."""

from dataclasses import replace
from math import inf

import numpy as np
import pytest
from core_races import CoreRace
from scipy.integrate import solve_ivp

from ehlcontact.errors import InputError
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.race import shared_atlas
from reduced_models.bearing.race_table import tabulate_race
from reduced_models.elements.film_law import static

SPEEDS = (1000.0, 3000.0, 9000.0)
APPROACH = 0  # of a contact, in its state


def exact(element, u):
    """g [m] and its slope by Newton's method."""
    _, g, slope = static(u / element.scales.length, element.law)
    return g * element.scales.length, slope


def contact(film, law):
    """The contact of the C core with this law."""
    return CoreRace(film.tables.balls(3000.0)._replace(inner=law, outer=law))


@pytest.mark.parametrize("race", ["inner", "outer"])
def test_the_table_is_the_curve(film, race):
    """From a gap of 3 mm to eight times the heaviest load of the atlas."""
    element = film.element(race, 3000.0)
    law, last = tabulate_race([element]), 0
    own, highest = contact(film, law), element.approach_at(8.0 * element.load_range[1])
    for u in np.concatenate([-np.geomspace(3e-3, 1e-9, 3000), np.linspace(0.0, highest, 3000)]):
        g, slope, last = own.curve(u, k=last)
        wanted, wanted_slope = exact(element, u)
        assert abs(g - wanted) < (1e-9 if u < 0.0 else 1e-10) * wanted
        assert abs(slope - wanted_slope) < 1e-6 * wanted_slope
    assert last == law.x.size - 2 or law.u[0, last + 1] > highest


def test_beyond_the_table_it_goes_on(film):
    law = tabulate_race([film.element("inner", 3000.0)])
    own = contact(film, law)
    for end, step in ((law.u[0, 0], -1e-12), (law.u[0, -1], 1e-12)):
        inside, outside = (own.curve(end + s) for s in (-step, step))
        assert outside[0] == pytest.approx(inside[0], rel=1e-6, abs=0.0)
    assert 0.0 < own.curve(2.0 * law.u[0, 0])[0] < law.cells[0, 0, 0, 0]
    far, farther = (own.curve(law.u[0, -1] + s)[0] for s in (1e-4, 2e-4))
    assert farther - far == pytest.approx(1e-4, rel=0.01, abs=0.0)


def test_an_element_of_all_loads_is_near_those_of_each(film):
    """Damping at rest against the atlas's own element about the load, stiffness against the atlas."""
    race, atlas = film.race("inner"), shared_atlas(None)
    whole = film.element("inner", 3000.0)
    for load in (10.0, 50.0, 200.0, 1000.0):
        own = atlas.element(race.point(load, 3000.0), "wide")
        ours, theirs = (e.impedance(load=load, hz=200.0).value[0] for e in (whole, own))
        assert ours.imag == pytest.approx(theirs.imag, rel=0.04)
        at = atlas.at(race.point(load, 3000.0))
        assert whole.approach_at(load) == pytest.approx(at.approach, abs=2e-9)
        assert ours.real == pytest.approx(at.stiffness[0], rel=0.12 if load < 30.0 else 0.02)


def test_elements_of_one_race_hold_all_its_loads(film):
    for speed in SPEEDS:
        low, high = film.race("outer").loads(speed)
        found = film.element("outer", speed).load_range
        np.testing.assert_allclose(found, (low, high), rtol=1e-6)


def row_at(balls, rpm):
    """Row of the tables at a speed, and weight of the next."""
    return CoreRace(balls).row(rpm * RPM_TO_RAD_S)


def test_at_its_own_speeds_a_law_of_many_is_that_of_one(film):
    many = film.tables.balls(SPEEDS)
    u = np.array([-5e-6, 0.0, 3e-6, 8e-6])
    for row, speed in enumerate(SPEEDS):
        assert sum(row_at(many, speed)) == row
        one = film.tables.balls(speed)
        for approach in u:
            ours = CoreRace(many).curve(approach, row_at(many, speed))[0]
            assert ours == pytest.approx(CoreRace(one).curve(approach)[0], rel=1e-9, abs=0.0)


def test_between_speeds_films_grow_as_they_should(film):
    """Half way between two speeds of a law it is within 1 % of the law of that speed, and nowhere does it jump."""
    coarse, own = film.tables.balls((2500.0, 3500.0)), film.tables.balls(3000.0)
    for u in (2e-6, 5e-6, 8e-6):
        film_there = CoreRace(coarse).curve(u, row_at(coarse, 3000.0))[0] - u
        assert film_there == pytest.approx(CoreRace(own).curve(u)[0] - u, rel=0.01)
    many = film.tables.balls(SPEEDS)
    below, above = (row_at(many, 3000.0 * (1.0 + s)) for s in (-1e-9, 1e-9))
    assert below[0] == 0 and above[0] == 1
    pressed = []
    for row in (below, above):
        held = CoreRace(many)
        held.state[APPROACH] = 5e-6
        held.prepare(transit(many), 2e-5, row)
        force = held.force(5.1e-6, 3e-3)
        pressed.append((force.force, force.stiffness, force.damping))
    np.testing.assert_allclose(pressed[0], pressed[1], rtol=1e-6)


def transit(balls):
    """Time scale 2a/u_sum of the inner contact over sqrt(g), at 3000 rev/min."""
    g = balls.grooves
    u_sum = 0.5 * g.pitch * (1.0 - (g.ball / g.pitch) ** 2) * 3000.0 * RPM_TO_RAD_S
    return balls.inner.contact_length_factor / u_sum


def race_forces(contact, transit, u, v, dt):
    """Force at the end of every step from rest at u[0], by the reduced filters of a race."""
    contact.state[:], forces = 0.0, []
    contact.state[APPROACH] = u[0]
    for place, rate in zip(u[1:], v[1:], strict=True):
        contact.prepare(transit, dt)
        forces.append(contact.force(place, rate).force)
        contact.accept(place, rate)
    return np.array(forces)


def test_reduced_filters_converge_to_the_law_in_continuous_time(film):
    """Of second order, over a return of half the approach. The law is `film_rates`, integrated to 1e-9."""
    element = film.element("inner", 3000.0)
    scales, law = element.scales, tabulate_race([element])
    own, transit = contact(film, law), law.contact_length_factor * scales.time / (2.0 * scales.a)
    start, swing, omega, end = (
        element.approach_at(100.0),
        0.25 * element.approach_at(100.0),
        1.5 / scales.time,
        6.0,
    )

    def motion(t):
        return start - swing * (1.0 - np.cos(omega * t)), -swing * omega * np.sin(omega * t)

    def rates(t, states):
        return element.continuous(states, *motion(t))[1]

    span = end * scales.time
    still = np.zeros(element.state_count)
    solved = solve_ivp(rates, (0.0, span), still, "LSODA", rtol=1e-9, atol=1e-12, dense_output=True)
    errors = []
    for steps in (60, 120, 240):
        t = np.linspace(0.0, span, steps + 1)
        u, v = motion(t)
        force = race_forces(own, transit, u, v, t[1])
        wanted = [element.continuous(solved.sol(time), *motion(time))[0] for time in t[1:]]
        errors.append(np.abs(force - wanted).max() / np.ptp(wanted))
    assert np.ptp(wanted) > 50.0 and errors[-1] < 1e-3
    assert errors[0] > 3.0 * errors[1] > 9.0 * errors[2]


def test_films_that_squeeze_are_refused(film):
    with pytest.raises(InputError, match=r"inlet_saturation = 0.2: must be 0"):
        tabulate_race([replace(film.element("inner", 3000.0), inlet_saturation=0.2)])


def test_fading(film):
    def cutoff(u, gap):
        return contact(film, film.tables.law("inner", [3000.0])._replace(cutoff_gap=gap)).cutoff(u)

    assert cutoff(-1.0, inf) == (1.0, 0.0)
    assert cutoff(-0.4e-6, 1e-6) == (1.0, 0.0)
    assert cutoff(-1.1e-6, 1e-6) == (0.0, 0.0)
    for u in (-0.6e-6, -0.9e-6):
        share, slope = cutoff(u, 1e-6)
        assert 0.0 < share < 1.0
        ends = [cutoff(u + step, 1e-6)[0] for step in (1e-12, -1e-12)]
        assert slope == pytest.approx((ends[0] - ends[1]) / 2e-12, rel=1e-5)
