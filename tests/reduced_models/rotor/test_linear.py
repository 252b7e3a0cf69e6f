"""Linear rotors against one mass on a spring, and against time integration."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from rotor_twins import MASS, POINT, C, K, carried, omega_of, one_mass, spring

from ehlcontact import Grid, InputError, MoesPoint, impedance
from reduced_models import (
    Atlas,
    LinearBearing,
    Shaft,
    SpringContact,
    Support,
    jeffcott_rotor,
    linearise,
    rotor_on_bearings,
    simulate_rotor,
)
from reduced_models.rotor.linear_contact import film_impedance, impedance_about


def test_mode_of_one_mass():
    mode = linearise(one_mass().on([spring])).modes()[0]
    zeta, natural = 2.0 * C / (2.0 * np.sqrt(2.0 * K * MASS)), np.sqrt(2.0 * K / MASS)
    damped = natural * np.sqrt(1.0 - zeta**2)
    assert mode.omega == pytest.approx(damped, rel=1e-5) and mode.hz == pytest.approx(
        damped / (2.0 * pi), rel=1e-5
    )
    assert mode.decrement == pytest.approx(2.0 * pi * zeta / np.sqrt(1.0 - zeta**2), rel=1e-4)
    assert mode.support_share == pytest.approx(1.0, abs=1e-4) and mode.vertical_share == 1.0
    assert mode.disc[1] == pytest.approx(mode.journal[1], rel=1e-4) and mode.disc[0] == 0.0


def test_response_of_one_mass():
    """Amplitude and phase of m e omega^2 sin(omega t) on one mass."""
    rotor, omega = one_mass(shaft_stiffness=1e16), np.array([50.0, 3000.0, 6400.0, 20000.0])
    q = linearise(rotor.on([spring])).unbalance_response(omega=omega).amplitude
    expected = 4e-5 * omega**2 * -1j / (2.0 * K + 2j * omega * C - MASS * omega**2)
    assert q.shape == (4, 2) and q[:, 1] == pytest.approx(expected, rel=1e-4)


def test_the_frequency_of_an_unbalance_has_its_unit():
    linear = linearise(one_mass().on([spring]))
    q = linear.unbalance_response(omega=2.0 * np.pi * 50.0).amplitude
    assert np.allclose(linear.unbalance_response(hz=50.0).amplitude, q, rtol=1e-12)
    assert np.allclose(linear.unbalance_response(rpm=[3000.0]).amplitude, q, rtol=1e-12)
    for given, line in (
        (((50.0,), {}), "^frequency = 50.0: must be named with its unit"),
        (((), {}), "^frequency = None: must be given once"),
        (((), {"Omega": 1.0}), "give omega, hz or rpm$"),
    ):
        with pytest.raises(InputError, match=line):
            linear.unbalance_response(*given[0], **given[1])


def test_shaft_and_contacts_share_the_strain_energy():
    """In series, each takes it in proportion to its flexibility where the journal weighs nothing."""
    mode = linearise(one_mass(shaft_stiffness=2e8).on([spring])).modes()[0]
    assert mode.support_share == pytest.approx(2e8 / (2e8 + 2.0 * K), rel=1e-3)


def test_a_mode_sees_the_impedance_of_its_own_frequency():
    """A contact whose damping falls with frequency: the decrement has that of the mode, not of slow motion."""

    def falling(omega):
        w = np.asarray(omega)
        return np.asarray(K + 1j * w * C / (1.0 + (w / 3000.0) ** 2), dtype=complex)

    mode = linearise(one_mass().on([falling])).modes()[0]
    constant = linearise(
        one_mass().on([lambda w: np.asarray(K + 1j * np.asarray(w) * C / (1 + (mode.omega / 3e3) ** 2))])
    )
    assert mode.eigenvalue == pytest.approx(constant.modes()[0].eigenvalue, rel=1e-9)
    assert mode.decrement < 0.2 * linearise(one_mass().on([spring])).modes()[0].decrement


def test_directions_of_a_vee():
    rotor = jeffcott_rotor(
        half_angle=0.35, disc_mass=2.0, journal_mass=0.3, shaft_stiffness=2e8, unbalance=4e-5, speed_rpm=3000
    )
    modes = linearise(rotor.on([spring, spring])).modes()
    assert len(modes) == 4 and [round(mode.vertical_share) for mode in modes[:2]] == [0, 1]
    stiffness = [4.0 * K * np.sin(0.35) ** 2, 4.0 * K * np.cos(0.35) ** 2]
    for mode, contacts in zip(modes, stiffness, strict=False):
        rigid = np.sqrt(contacts / 2.3)
        assert mode.omega < rigid and mode.support_share == pytest.approx(2e8 / (2e8 + contacts), rel=0.1)


def test_orbit_state_is_on_the_periodic_motion():
    """A linear contact that starts there has the same revolution at once, about its rest."""
    element = SpringContact.linear(K, C, low=1e-8, high=1e-4, units="SI")
    rotor = one_mass(disc_mass=1.5, journal_mass=0.5, shaft_stiffness=2e8)
    rest = rotor.on([element]).equilibrium()
    load = float(carried(rotor)[0])
    linear = linearise(rotor.on([impedance_about(element, load)]))
    run = simulate_rotor(
        rotor.on([element]),
        dt=0.02 / 400,
        until=0.04,
        start=linear.orbit(rest),
        tolerance=1e-12,
        rho_inf=1.0,
    )
    q = linear.unbalance_response(omega=omega_of(rotor)).amplitude[0, 0]
    expected = rest[0] + (q * np.exp(1j * omega_of(rotor) * run.t)).real
    assert np.abs(run.disc[:, 1] - expected).max() < 2e-3 * abs(q)


def test_film_impedance_follows_the_solve():
    response = impedance(POINT, Omega=[0.0, 0.005, 0.1, 1.0], grid=Grid(n=32))
    Z, s = film_impedance(response), POINT.scales
    at = Z(response.omega)
    assert at.real == pytest.approx(response.stiffness)
    assert at.imag == pytest.approx(response.omega * response.damping)
    beyond = Z(np.array([50.0 / s.time]))[0]
    assert beyond.real == pytest.approx(response.stiffness[-1])
    between = Z(np.array([0.5 / s.time]))[0].imag * s.time / 0.5
    assert response.damping[3] < between < response.damping[2]


def test_impedance_of_an_element_with_memory():
    element = Atlas().element(POINT, "memory")
    omega = np.array([300.0, 6000.0])
    assert np.array_equal(impedance_about(element, 48.7)(omega), element.impedance(omega=omega, load=48.7).value)


def test_refused():
    with pytest.raises(InputError, match="one per mount"):
        linearise(one_mass().on([spring, spring]))
    with pytest.raises(InputError, match="OperatingPoint"):
        film_impedance(impedance(MoesPoint(20, 5, 0.5), Omega=[0.0, 0.1], grid=Grid(n=32)))


def test_modes_on_elements_are_roots_with_the_memory_of_their_films():
    """Of the dynamic stiffness at the eigenvalue itself, beside the imaginary axis."""
    element = Atlas().wide(POINT, np.geomspace(0.2, 5.0, 8))
    rotor = jeffcott_rotor(
        half_angle=0.5, disc_mass=4.0, journal_mass=0.5, shaft_stiffness=5e7, shaft_damping=200.0, speed_rpm=3000.0
    )
    at = linearise(rotor.on([element, element.copy()]))
    modes = at.modes(None)
    assert len(modes) == 4 and at.stable
    for mode in modes:
        T, s = at.dynamic_stiffness(mode.eigenvalue), mode.eigenvalue
        assert np.abs(T @ mode.shape).max() < 1e-9 * np.abs(T).max()
        frozen = at.support_impedance(1j * s.imag)
        assert abs(s.real) > 1e-3 * s.imag and not np.allclose(at.support_impedance(s), frozen, rtol=1e-6)


def test_springs_of_housings_have_their_share_of_the_strain_energy():
    """Rigid shaft on springs in series, 3e7 on 1e7 N/m: energies are as compliances, 3/4 in the housings."""
    shaft = Shaft(length=0.1, diameter=0.1)
    supports = [
        Support(
            position=at,
            bearing=LinearBearing(3e7 * np.eye(2), np.zeros((2, 2))),
            housing_mass=1e-3,
            housing_stiffness=1e7,
        )
        for at in (0.0, 0.1)
    ]
    slow, *_ = linearise(rotor_on_bearings(shaft, supports=supports), 100.0).modes(1)
    assert slow.housing_share == pytest.approx(0.75, rel=0.01)
    grounded = [replace(one, housing_mass=None, housing_stiffness=None) for one in supports]
    stands, *_ = linearise(rotor_on_bearings(shaft, supports=grounded), 100.0).modes(1)
    assert stands.housing_share == 0.0
