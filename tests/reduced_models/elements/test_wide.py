"""Wide-range element: static curve from lift-off to overload, memory that follows the load, and full EHL."""

from dataclasses import replace
from math import inf, nan, pi

import numpy as np
import pytest

from ehlcontact import (
    ConvergenceError,
    Grid,
    InputError,
    MoesPoint,
    PrescribedLoad,
    impedance,
    simulate,
    solve_steady,
)
from reduced_models import FilmContact, OutsideValidityWarning, fit_memory, simulate_oscillator
from reduced_models.fitting.wide_range_fit import wide_range_contact, wide_range_from_solves

# Shape of M = 2900, L = 19, kappa = 0.11.
LOADS = np.array([0.005, 0.02, 0.1, 0.3, 1.0, 3.0])
FILM = np.array([0.0649, 0.0659, 0.0626, 0.0574, 0.0499, 0.0400])
TABLES = {
    "loads": tuple(LOADS),
    "approach": tuple(LOADS ** (2.0 / 3.0) - FILM),
    "gain_loads": (0.03, 0.3, 2.0),
    "gains": tuple(
        tuple(scale * g for g in (0.02, 0.01, 0.05, 0.2, 0.1, 0.1, 0.2)) for scale in (0.4, 0.11, 0.03)
    ),
    "inlet_saturation": 0.2,
    "lag_rate": 2.5,
    "inlet_rate": 20.0,
    "fast_rate": 60.0,
}


@pytest.fixture
def wide():
    return FilmContact.wide(**TABLES)


def test_static_curve_goes_through_its_table(wide):
    np.testing.assert_allclose(wide.spring(np.array(wide.approach)), wide.loads, rtol=1e-10)
    for F, u in zip(wide.loads, wide.approach, strict=True):
        assert wide.approach_at(F) == pytest.approx(u, abs=1e-10)
    assert (wide.low, wide.high) == (wide.approach[0], wide.approach[-1])
    assert wide.load_range == (0.005, 3.0)


def test_static_curve_rises_from_nothing_without_a_kink(wide):
    u = np.concatenate([-np.geomspace(1e3, 0.1, 400), np.linspace(-0.09, 4.0, 2000)])
    F = wide.spring(u)
    assert (F > 0.0).all() and (np.diff(F) > 0.0).all()
    for F, u in zip(wide.loads, wide.approach, strict=True):
        below, above = (wide.spring_tangent(u + s) for s in (-1e-7, 1e-7))
        assert above == pytest.approx(below, rel=1e-3), f"slope at load {F}"
    for u in (-1.0, -0.02, 0.05, 5.0):
        slope = (wide.spring(u + 1e-7) - wide.spring(u - 1e-7)) / 2e-7
        assert wide.spring_tangent(u) == pytest.approx(slope, rel=1e-4)


def test_impedance_interpolates_over_the_load(wide):
    """At a load of the table in the units of that load: K and C scale with F^(1/3) and F^(2/3)."""
    for F, gains in zip(wide.gain_loads, wide.gains, strict=True):
        own = F ** (1.0 / 3.0)
        C = 1.5 * float((wide.rates.basis([pi]) @ np.array(gains))[0].real)
        Z = wide.impedance(load=F, Omega=pi / own)
        assert Z.damping[0] == pytest.approx(C * own * own, rel=1e-9)
    between = [0.01 * wide.impedance(load=F, Omega=0.01).damping[0] / F ** (2.0 / 3.0) for F in (0.3, 0.7, 2.0)]
    assert between[0] > between[1] > between[2]


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
def test_surfaces_may_part_and_meet_again(wide):
    """Pulled apart fast and pressed together again: no pull, no spurious force, then the static one."""
    T = np.linspace(0.0, 6.0, 601)
    phase = pi * (np.clip((T - 1.0) / 0.5, 0.0, 1.0) + np.clip((T - 4.0) / 0.5, 0.0, 1.0))
    moving = ((T > 1.0) & (T < 1.5)) | ((T > 4.0) & (T < 4.5))
    u = -1.05 + 1.95 * np.cos(phase)
    v = np.where(moving, -1.95 * np.sin(phase) * pi / 0.5, 0.0)
    force = wide.drive(T, u, v)
    assert (force >= 0.0).all()
    apart = (T > 1.3) & (T < 3.99)
    assert force[apart].max() < 0.002 and force[apart].min() == 0.0
    assert force[(T > 3.5) & (T < 4.0)] == pytest.approx(wide.spring(-3.0), rel=1e-3)
    closing = (T > 4.3) & (T < 4.45)
    assert (force[closing] > wide.spring(u[closing])).all()
    assert wide.advance(1e6, 0.9, 0.0) == pytest.approx(wide.spring(0.9), rel=1e-5)


def test_trapped_film_keeps_its_thickness_while_the_load_rises(wide):
    """Rows of gains in proportion to each other: what the chain holds adds the same film at every load."""
    states = np.array([0.0, 0.0, 0.02, 0.03, 0.01, 0.0])
    film = [
        wide.continuous(states, u, 0.0)[0] ** (2.0 / 3.0) - wide.spring(u) ** (2.0 / 3.0) for u in (0.01, 0.3, 1.5)
    ]
    assert film[0] > 0.01
    np.testing.assert_allclose(film, film[0], rtol=1e-6)


def test_gain_of_a_film_is_that_of_the_load_at_which_it_is_made(wide):
    """Closing fast from a light load leaves more film than the gains of the heavy load would make."""
    T = np.linspace(0.0, 0.4, 401)
    u = -0.05 + 1.0 * (0.5 - 0.5 * np.cos(pi * T / 0.4))
    v = 0.5 * pi / 0.4 * np.sin(pi * T / 0.4)
    one_load = replace(wide, gain_loads=(1.0,), gains=(tuple(wide.gains_at(0.0)),))
    ours, theirs = (element.drive(T, u, v)[-1] for element in (wide, one_load))
    assert ours > theirs + 0.02 > wide.spring(u[-1]) + 0.02


def closing(steps):
    """Times, approach and rate of a fast return from a light load, and of what follows."""
    T = np.linspace(0.0, 1.2, 12 * steps + 1)
    phase = pi * np.minimum(T, 0.4) / 0.4
    return T, 0.45 - 0.5 * np.cos(phase), 0.5 * pi / 0.4 * np.sin(phase)


def film_added(element, steps=40):
    """Film that motion has added at the end of the return, and a third of a transit later."""
    T, u, v = closing(steps)
    added = element.drive(T, u, v) ** (2.0 / 3.0) - element.spring(u) ** (2.0 / 3.0)
    return added[4 * steps], added[10 * steps]


def test_film_trapped_by_a_fast_return_fades_at_once(wide):
    """It fills the contact, where film made at the inlet alone has yet to cross it."""
    at_inlet = wide.copy()
    object.__setattr__(at_inlet, "law", wide.law._replace(rim=0.0))
    (early, late), (first, second) = film_added(wide), film_added(at_inlet)
    assert early > 1.2 * first and late / early < 0.9 * second / first


def test_steps_of_a_growing_contact_are_of_second_order_and_follow_continuous_time(wide):
    T, u, v = closing(640)
    states, h = np.zeros(wide.state_count), T[1]
    middle = [0.5 * (x[:-1] + x[1:]) for x in (u, v)]
    for k in range(T.size - 1):  # the midpoint rule
        half = states + 0.5 * h * wide.continuous(states, u[k], v[k])[1]
        states += h * wide.continuous(half, middle[0][k], middle[1][k])[1]
    force, found = wide.continuous(states, u[-1], v[-1])[0], []
    for steps in (20, 40, 80, 640):
        T, u, v = closing(steps)
        found.append(wide.drive(T, u, v)[-1])
    errors = np.abs(np.array(found) - force)
    assert errors[1] < 0.3 * errors[0] and errors[2] < 0.3 * errors[1] and errors[3] < 1e-5


def test_a_contact_that_shrinks_or_does_not_saturate_has_no_rim(wide, memory):
    T = np.linspace(0.0, 1.0, 51)
    u, v = 1.0 - 0.3 * T**2, -0.6 * T
    at_inlet = wide.copy()
    object.__setattr__(at_inlet, "law", wide.law._replace(rim=0.0))
    np.testing.assert_array_equal(wide.drive(T, u, v), at_inlet.drive(T, u, v))
    assert memory.law.rim == replace(wide, inlet_saturation=0.0).law.rim == 0.0 < wide.law.rim


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
def test_no_closed_cycle_creates_energy(wide):
    """Cycles of any size and speed, through lift-off or not, from rest back to the same approach at rest."""
    rng = np.random.default_rng(3)
    for _ in range(150):
        T = np.linspace(0.0, 10.0 ** rng.uniform(-0.5, 1.8), 1201)
        phase = T / T[-1]
        waves = sum(rng.normal() / j * np.sin(2.0 * pi * j * phase) for j in range(1, rng.integers(2, 7)))
        shape = np.sin(pi * phase) ** 2 * waves
        u = rng.uniform(-0.1, 1.3) + 10.0 ** rng.uniform(-2.0, 0.2) * shape / np.abs(shape).max()
        v = np.gradient(u, T, edge_order=2)
        power = wide.drive(T, u, v) * v
        assert np.trapezoid(power, T) > -1e-6 * np.trapezoid(np.abs(power), T)


def test_slow_cycle_dissipates_and_follows_the_static_curve(wide):
    T = np.linspace(0.0, 2000.0, 201)  # steps of 10: one turn of a rotor
    u = 0.75 - 0.7 * np.cos(2.0 * pi * T / 2000.0)
    v = 0.7 * 2.0 * pi / 2000.0 * np.sin(2.0 * pi * T / 2000.0)
    force = wide.drive(T, u, v)
    assert 0.0 < np.trapezoid(force, u) < 0.01
    np.testing.assert_allclose(force, wide.spring(u), atol=3e-3)


def test_oscillator_agrees_with_steps_at_every_load(wide):
    """Load from 0.3 to 2 and back, across the rows of the gains: continuous time against exact steps."""
    T = np.linspace(0.0, 12.0, 2401)
    load = 0.3 + 1.7 * np.exp(-((T - 5.0) ** 2))
    run = simulate_oscillator(wide, T, Omega_n=4.0, load=load, u0=wide.approach_at(0.3), rtol=1e-8)
    assert run.force.max() > 1.8
    assert np.abs(wide.drive(T, run.approach, run.rate) - run.force)[1:].max() < 2e-4


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"loads": (0.1, 0.05, 0.2, 0.3, 1.0, 3.0)}, r"loads\[1\]"),
        ({"loads": (0.0, 0.02, 0.1, 0.3, 1.0, 3.0)}, r"loads\[0\]"),
        ({"loads": LOADS[1:]}, "approach"),
        ({"loads": (1.0,), "approach": (0.9,)}, "loads"),
        ({"approach": (nan, 0.0, 0.1, 0.4, 0.9, 2.0)}, "approach"),
        ({"approach": (-0.04, 0.01, 0.15, 0.39, 1.2, 2.0)}, r"approach\[4\]"),
        ({"approach": (-0.04, 0.01, 0.15, 0.39, 0.38, 2.0)}, r"approach\[4\]"),
        ({"gain_loads": (0.03, 0.3)}, "gains"),
        ({"gain_loads": (0.0, 0.3, 2.0)}, "gain_loads"),
        ({"gains": ((0.1, 0.1, 0.1),) * 3}, "gains"),
        ({"gains": ((0.1, 0.1, 0.1, 0.1), (0.1, 0.1, 0.1), (0.1, 0.1, 0.1))}, "gains"),
        ({"gains": ((0.0, 0.0, 0.0, -0.1),) * 3}, "passive"),
        ({"fast_rate": -1.0}, "fast_rate"),
        ({"inlet_saturation": inf}, "inlet_saturation"),
        ({"units": "SI"}, "scales"),
    ],
)
def test_bad_tables_are_named(changes, message):
    with pytest.raises(InputError, match=message):
        FilmContact.wide(**(TABLES | changes))


@pytest.mark.long
def test_from_solves_meets_loads_it_was_not_made_of():
    point = MoesPoint(200, 10, 0.5)
    loads, unused = (0.05, 0.1, 0.25, 0.6, 1.0, 2.0), (0.16, 0.4, 1.5)
    wide = wide_range_from_solves(point, loads, memory_loads=(0.2, 1.0), lags=6, n=48)
    for F in unused:
        u = solve_steady(replace(point, M=200 * F), grid=Grid(n=48)).approach * F ** (2.0 / 3.0)
        assert wide.spring(u) == pytest.approx(F, rel=0.01)
    Z = impedance(point, Omega=[0.05, pi, 2.0 * pi], grid=Grid(n=48))
    ours = wide.impedance(Omega=Z.omega)
    np.testing.assert_allclose(ours.stiffness, Z.stiffness, rtol=0.02)
    assert ours.damping[0] == pytest.approx(Z.damping[0], rel=0.05)
    assert wide.source["point"]["M"] == 200 and wide.source["n"] == 48


def test_bad_solves():
    with pytest.raises(InputError, match=r"loads\[0\]"):
        wide_range_from_solves(MoesPoint(200, 10, 0.5), (0.0, 1.0), n=32)
    with pytest.raises(InputError, match="number of responses"):
        wide_range_contact((0.5, 1.0), (0.8, 0.87), (1.0,), [])
    with pytest.raises((InputError, ConvergenceError)):
        wide_range_from_solves(MoesPoint(200, 10, 0.5), (1e-9, 1.0), n=32)


@pytest.mark.slow
def test_a_6205_from_lift_off_to_overload():
    """Static curve against unused solves, and a load pulse from 5 % to 200 % and back against full EHL."""
    point = MoesPoint(2900, 19, 0.11)
    omegas = np.concatenate([[0.0], np.geomspace(0.03, 60.0, 24)])
    memory = fit_memory(impedance(point, Omega=omegas, grid=Grid(n=128)), lags=12).element
    wide = wide_range_from_solves(point, memory=memory, n=128)
    for F in (0.01 * 1.3, 0.025, 0.06, 0.12, 0.2, 0.45, 0.8, 1.3, 2.2, 2.7):
        u = solve_steady(replace(point, M=2900 * F), grid=Grid(n=128)).approach * F ** (2.0 / 3.0)
        assert wide.spring(u) == pytest.approx(F, rel=0.01)
    T = np.linspace(0.0, 12.0, 601)
    load = 0.05 + 1.95 * np.sin(pi * np.clip((T - 1.0) / 8.0, 0.0, 1.0)) ** 2
    run = simulate(point, PrescribedLoad(T, load), grid=Grid(n=128))
    error = wide.drive(run.t, run.approach, run.rate) - run.force
    rms = np.sqrt(np.mean(error**2)) / run.force.max()
    static = np.sqrt(np.mean((wide.spring(run.approach) - run.force) ** 2)) / run.force.max()
    assert rms < 0.006
    assert rms < 0.6 * static, "memory must be better than no memory"


def test_a_record_outside_the_box_warns_once(wide):
    t, still = np.array([0.0, 1.0, 2.0]), np.zeros(3)
    words = r"^FilmContact \(wide\) used outside .*force 4\.\S+ \(fitted"
    with pytest.warns(OutsideValidityWarning, match=words) as told:
        for _ in range(2):
            wide.drive(t, np.full(3, wide.approach_at(4.2)), still)
    assert len(told) == 1
    assert told[0].filename == __file__
