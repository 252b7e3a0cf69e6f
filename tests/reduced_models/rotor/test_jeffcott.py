"""Rotor parameters, mounts, static equilibrium."""

import numpy as np
import pytest

from ehlcontact.errors import ConvergenceError, InputError
from reduced_models import ContactMount, JeffcottRotor
from reduced_models.rotor.modes import RotorMode

BODY = {"disc_mass": 20.0, "journal_mass": 1.0, "shaft_stiffness": 2e7}


def test_matrices_are_the_equations_at_the_head_of_the_module():
    rotor = JeffcottRotor.vee(half_angle=0.5, **BODY, shaft_damping=30.0, disc_damping=4.0)
    M, C, K = rotor.matrices()
    np.testing.assert_array_equal(np.diag(M), [20.0, 20.0, 1.0, 1.0])
    q = np.array([1.0, 2.0, -3.0, 5.0])
    np.testing.assert_allclose(K @ q, 2e7 * np.array([4.0, -3.0, -4.0, 3.0]))
    np.testing.assert_allclose(C @ q, 30.0 * np.array([4.0, -3.0, -4.0, 3.0]) + 4.0 * np.array([1.0, 2.0, 0, 0]))


def test_unbalance_turns_with_the_speed():
    rotor = JeffcottRotor.vee(half_angle=0.5, **BODY, unbalance=1e-4, speed_rpm=3000.0, gravity=(0, 0))
    w = rotor.omega
    assert w == pytest.approx(100 * np.pi)
    np.testing.assert_allclose(rotor.applied_force(0.25 * 2 * np.pi / w), [0, 1e-4 * w * w, 0, 0], atol=1e-9)


def test_vertical_rotor_has_one_axis_and_stands_on_its_contact(contact):
    rotor = JeffcottRotor.vertical(**BODY, load=(0.0, -800.0), offset=1e-6)
    state = rotor.static_equilibrium([contact])
    (force,) = rotor.static_forces()
    assert force == pytest.approx(21.0 * 9.81 + 800.0)
    assert contact.force(float(rotor.approaches(state.journal)[0]), 0.0) == pytest.approx(force, rel=1e-11)
    assert state.disc[1] - state.journal[1] == pytest.approx(-(20 * 9.81 + 800) / 2e7)
    assert state.journal[0] == state.disc[0] == 0.0


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
@pytest.mark.parametrize("side", [0.0, 300.0])
@pytest.mark.parametrize("offset", [0.0, 2e-5, -3e-5])
def test_vee_equilibrium_balances_every_direction(contact, side, offset):
    rotor = JeffcottRotor.vee(half_angle=0.6, offset=offset, **BODY, load=(side, -1500.0))
    state = rotor.static_equilibrium([contact, contact])
    forces = [contact.force(float(u), 0.0) for u in rotor.approaches(state.journal)]
    np.testing.assert_allclose(forces, rotor.static_forces(), rtol=1e-9)
    np.testing.assert_allclose(2 * rotor.normals.T @ forces, rotor.static_load, rtol=1e-9, atol=1e-7)


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
def test_five_contacts_some_open(contact):
    mounts = [ContactMount(a) for a in np.linspace(-np.pi, np.pi, 5, endpoint=False)]
    rotor = JeffcottRotor(mounts=mounts, **BODY, load=(50.0, -400.0))
    state = rotor.static_equilibrium([contact] * 5)
    u = rotor.approaches(state.journal)
    forces = np.array([contact.force(float(x), 0.0) for x in u])
    np.testing.assert_allclose(2 * rotor.normals.T @ forces, rotor.static_load, rtol=1e-9, atol=1e-7)
    assert (forces == 0.0).any()
    with pytest.raises(InputError, match="independent"):
        rotor.static_forces()


def test_state_at_given_approaches():
    rotor = JeffcottRotor.vee(half_angle=0.6, **BODY)
    state = rotor.state_at([3e-6, 4e-6])
    np.testing.assert_allclose(rotor.approaches(state.journal), [3e-6, 4e-6], rtol=1e-12)
    three = JeffcottRotor(mounts=[ContactMount(a) for a in (-2.0, -1.5, -1.0)], **BODY)
    with pytest.raises(InputError, match="reachable"):
        three.state_at([1e-6, 5e-6, 1e-6])
    with pytest.raises(InputError, match="length of approaches = 1: must be 2"):
        rotor.state_at([1e-6])


def test_load_away_from_every_contact_is_not_held(contact):
    rotor = JeffcottRotor.vertical(**BODY, load=(0.0, 1000.0))
    with pytest.raises(ConvergenceError, match="do not hold"):
        rotor.static_equilibrium([contact])
    with pytest.raises(InputError, match="pushing"):
        rotor.static_forces()


def test_side_load_on_one_contact_is_not_held(contact):
    rotor = JeffcottRotor(mounts=[ContactMount(-np.pi / 2)], **BODY, load=(100.0, -500.0))
    with pytest.raises(ConvergenceError, match="do not hold"):
        rotor.static_equilibrium([contact])


def test_static_needs_static_laws_one_each_and_a_load(contact, maxwell):
    rotor = JeffcottRotor.vertical(**BODY)
    with pytest.raises(InputError, match="without static law"):
        rotor.static_equilibrium([maxwell(1.0, 1.0, 1.0)])
    with pytest.raises(InputError, match="one per mount"):
        rotor.static_equilibrium([contact, contact])
    with pytest.raises(InputError, match="static load"):
        JeffcottRotor.vertical(**BODY, gravity=(0, 0)).static_equilibrium([contact])


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"disc_mass": 0.0}, "disc_mass"),
        ({"journal_mass": -1.0}, "journal_mass"),
        ({"shaft_stiffness": np.inf}, "shaft_stiffness"),
        ({"unbalance": -1.0}, "unbalance"),
        ({"gravity": (0.0, np.nan)}, "gravity[1]"),
        ({"load": 5.0}, "shape of load"),
        ({"bearings": 0}, "bearings"),
        ({"directions": "x"}, "directions"),
    ],
)
def test_bad_rotors_are_named(changes, field):
    with pytest.raises(InputError) as caught:
        JeffcottRotor.vertical(**(BODY | changes))
    assert caught.value.field == field


def test_bad_mounts():
    with pytest.raises(InputError, match="radians"):
        ContactMount(-90.0)
    with pytest.raises(InputError, match="offset"):
        ContactMount(0.0, np.nan)
    with pytest.raises(InputError, match="mounts"):
        JeffcottRotor(mounts=(), **BODY)
    with pytest.raises(InputError, match="half_angle"):
        JeffcottRotor.vee(half_angle=2.0, **BODY)


def test_a_node_that_is_not_there_is_no_attribute():
    mode = RotorMode(-1.0 + 100.0j, np.ones(2, complex), 0.0, 0.5, ("hub x", "hub y"), np.array([0, 1]))
    assert not hasattr(mode, "disc") and not hasattr(mode, "journal")
    with pytest.raises(InputError, match="one of hub"):
        mode.node("disc")
