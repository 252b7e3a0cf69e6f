"""The protocol of contacts, and contacts that are not in SI."""

import pytest

from ehlcontact import Grid, InputError, MoesPoint, TransientContact
from reduced_models import jeffcott_rotor, simulate_rotor
from reduced_models.rotor.contact_protocol import Contact, has_tangents


def test_elements_have_tangents_and_films_do_not(cubic, maxwell):
    assert isinstance(cubic, Contact) and has_tangents(cubic)
    assert isinstance(maxwell(1, 1, 1), Contact) and not has_tangents(maxwell(1, 1, 1))


def test_contacts_that_are_not_in_si_are_refused(cubic):
    film = TransientContact(MoesPoint(20, 5, 0.5), grid=Grid(n=16))
    rotor = jeffcott_rotor(bearings=1, disc_mass=2.0, journal_mass=0.3, shaft_stiffness=1e8)
    for contact in (cubic, film):
        with pytest.raises(InputError, match=r"contacts\[0\]\.units = 'dimensionless': must be SI"):
            simulate_rotor(rotor.on([contact]), speed_rpm=0.0, dt=1e-5, until=1e-4)
