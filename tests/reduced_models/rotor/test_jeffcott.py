"""Jeffcott rotors by their parameters, contacts in their mounts, static equilibrium on contacts."""

import numpy as np
import pytest
from rotor_twins import carried

from ehlcontact.errors import ConvergenceError, InputError
from reduced_models import ContactMount, Rotor, jeffcott_rotor
from reduced_models.rotor.modes import RotorMode
from reduced_models.rotor.speed_profile import shaft_course

BODY = {"disc_mass": 20.0, "journal_mass": 1.0, "shaft_stiffness": 2e7}


def balance(rotor, forces):
    """What is left of load and shaft with these forces of the contacts."""
    counts = np.array([mount.count for mount in rotor.contacts])
    return rotor.load - rotor.support_rows.T @ (counts * forces)


def forces_at(rotor, q):
    return np.array(
        [mount.contact.force(float(u), 0.0) for mount, u in zip(rotor.contacts, rotor.approaches(q), strict=True)]
    )


def test_matrices_are_the_equations_at_the_head_of_the_module():
    rotor = jeffcott_rotor(half_angle=0.5, **BODY, shaft_damping=30.0, disc_damping=4.0)
    assert isinstance(rotor, Rotor)
    M, C, K = rotor.matrices(0.0)
    np.testing.assert_array_equal(np.diag(M), [20.0, 20.0, 1.0, 1.0])
    q = np.array([1.0, 2.0, -3.0, 5.0])
    np.testing.assert_allclose(K @ q, 2e7 * np.array([4.0, -3.0, -4.0, 3.0]))
    np.testing.assert_allclose(C @ q, 30.0 * np.array([4.0, -3.0, -4.0, 3.0]) + 4.0 * np.array([1.0, 2.0, 0, 0]))
    np.testing.assert_allclose(rotor.load, -9.81 * np.array([0.0, 20.0, 0.0, 1.0]))
    assert [own.name for own in rotor.parameters] == [*BODY, "shaft_damping", "disc_damping"]


def test_unbalance_turns_with_the_speed():
    rotor = jeffcott_rotor(half_angle=0.5, **BODY, unbalance=1e-4, speed_rpm=3000.0, gravity=(0, 0))
    w = 100 * np.pi
    course = shaft_course(rotor, rotor.speed_rpm, np.array([0.0, 0.25 * 2 * np.pi / w]))
    np.testing.assert_allclose((course.at @ course.turning.T).T[1], [0, 1e-4 * w * w, 0, 0], atol=1e-9)


def test_vertical_rotor_has_one_axis_and_stands_on_its_contact(contact):
    rotor = jeffcott_rotor(bearings=1, **BODY, load=(0.0, -800.0), offset=1e-6).on([contact])
    assert rotor.nodes == {"disc": {"y": 0}, "journal": {"y": 1}}
    disc, journal = q = rotor.equilibrium()
    (force,) = forces_at(rotor, q)
    assert force == pytest.approx(21.0 * 9.81 + 800.0, rel=1e-11)
    assert disc - journal == pytest.approx(-(20 * 9.81 + 800) / 2e7)


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
@pytest.mark.parametrize("side", [0.0, 300.0])
@pytest.mark.parametrize("offset", [0.0, 2e-5, -3e-5])
def test_vee_equilibrium_balances_every_direction(contact, side, offset):
    rotor = jeffcott_rotor(half_angle=0.6, offset=offset, **BODY, load=(side, -1500.0)).on([contact, contact])
    q = rotor.equilibrium()
    forces = forces_at(rotor, q)
    np.testing.assert_allclose(forces, carried(rotor), rtol=1e-9)
    np.testing.assert_allclose(balance(rotor, forces), rotor.stiffness @ q, rtol=1e-9, atol=1e-7)


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
def test_five_contacts_some_open(contact):
    mounts = [ContactMount(a, contact=contact) for a in np.linspace(-np.pi, np.pi, 5, endpoint=False)]
    rotor = jeffcott_rotor(mounts=mounts, **BODY, load=(50.0, -400.0))
    q = rotor.equilibrium()
    forces = forces_at(rotor, q)
    np.testing.assert_allclose(balance(rotor, forces), rotor.stiffness @ q, rtol=1e-9, atol=1e-7)
    assert (forces == 0.0).any()


def test_rest_at_given_approaches():
    rotor = jeffcott_rotor(half_angle=0.6, **BODY)
    q = rotor.rest_at([3e-6, 4e-6])
    np.testing.assert_allclose(rotor.approaches(q), [3e-6, 4e-6], rtol=1e-12)
    np.testing.assert_allclose((rotor.stiffness @ q)[:2], rotor.load[:2], rtol=1e-9, atol=1e-9)
    three = jeffcott_rotor(mounts=[ContactMount(a) for a in (-2.0, -1.5, -1.0)], **BODY)
    with pytest.raises(InputError, match="reachable"):
        three.rest_at([1e-6, 5e-6, 1e-6])
    with pytest.raises(InputError, match="length of approaches = 1: must be 2"):
        rotor.rest_at([1e-6])
    free = Rotor(mass=np.eye(2), stiffness=np.zeros((2, 2)), mounts=(ContactMount(0.0, x=0),))
    with pytest.raises(InputError, match="contacts alone do not hold this rotor"):
        free.rest_at([1e-6])


def test_load_away_from_every_contact_is_not_held(contact):
    rotor = jeffcott_rotor(bearings=1, **BODY, load=(0.0, 1000.0))
    with pytest.raises(ConvergenceError, match="do not hold"):
        rotor.on([contact]).equilibrium()


def test_side_load_on_one_contact_is_not_held(contact):
    rotor = jeffcott_rotor(mounts=[ContactMount(-np.pi / 2)], **BODY, load=(100.0, -500.0))
    with pytest.raises(ConvergenceError, match="do not hold"):
        rotor.on([contact]).equilibrium()


def test_static_needs_static_laws_one_each(contact, maxwell):
    rotor = jeffcott_rotor(bearings=1, **BODY)
    with pytest.raises(InputError, match=r"without static law.*rotor\.rest_at"):
        rotor.on([maxwell(1.0, 1.0, 1.0)]).equilibrium()
    with pytest.raises(InputError, match="one per mount"):
        rotor.on([contact, contact])
    afloat = jeffcott_rotor(bearings=1, **BODY, gravity=(0, 0)).on([contact])
    assert contact.spring(float(afloat.approaches(afloat.equilibrium())[0])) < 1e-9


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
        ({"half_angle": 2.0}, "half_angle"),
        ({"half_angle": 0.5, "mounts": [ContactMount(0.0)]}, "half_angle"),
        ({"mounts": ()}, "mounts"),
        ({"mounts": [1.0]}, "mounts[0]"),
    ],
)
def test_bad_rotors_are_named(changes, field):
    with pytest.raises(InputError) as caught:
        jeffcott_rotor(**(BODY | changes))
    assert caught.value.field == field


def test_bad_mounts():
    with pytest.raises(InputError, match="radians"):
        ContactMount(-90.0)
    with pytest.raises(InputError, match="offset"):
        ContactMount(0.0, np.nan)


def test_a_node_that_is_not_there_is_no_attribute():
    mode = RotorMode(-1.0 + 100.0j, np.ones(2, complex), 0.0, 0.5, ("hub x", "hub y"), np.array([0, 1]))
    assert not hasattr(mode, "disc") and not hasattr(mode, "journal")
    with pytest.raises(InputError, match="one of hub"):
        mode.node("disc")
