"""A mass in a squeeze film damper whose unbalance makes it jump, its circular orbits, and a shaft."""

from math import pi

import numpy as np
import pytest

from ehlcontact import Lubricant
from reduced_models import (
    BallBearing,
    BearingMount,
    Disc,
    Rotor,
    Shaft,
    SqueezeFilmDamper,
    Support,
    Unbalance,
    rotor_on_bearings,
)

LENGTH, RADIUS, CLEARANCE, VISCOSITY = 0.02, 0.06, 1.2e-4, 3.4e-3
MASS, SPRING, ECCENTRIC = 20.0, 2e6, 4e-5
FILM = VISCOSITY * LENGTH**3 * RADIUS / CLEARANCE**3


def damper(**changes):
    given = {"length": LENGTH, "radius": RADIUS, "clearance": CLEARANCE, "viscosity": VISCOSITY}
    return SqueezeFilmDamper(**given | changes)


def rigid(spring=SPRING, load=(0.0, 0.0), eccentric=ECCENTRIC, **changes):
    """A mass in a damper."""
    return Rotor(
        mass=MASS * np.eye(2),
        stiffness=np.zeros((2, 2)),
        mounts=(BearingMount(bearing=damper(stiffness=spring, **changes), x=0, y=1),),
        load=np.array(load),
        unbalances=(Unbalance(x=0, y=1, amount=MASS * eccentric),),
        nodes={"disc": {"x": 0, "y": 1}},
    )


def ratio(eccentricity):
    return 1.0 - eccentricity**2


def orbits(omega):
    """Eccentricity ratios of circular orbits of the balanced forces at a speed: closed form."""
    e = np.linspace(1e-3, 0.98, 20001)
    along = SPRING + 2.0 * FILM * omega * e / ratio(e) ** 2 - MASS * omega**2
    across = omega * pi * FILM / (2.0 * ratio(e) ** 1.5)
    off = np.hypot(along, across) * e * CLEARANCE - MASS * ECCENTRIC * omega**2
    k = np.flatnonzero(np.diff(np.sign(off)))
    return e[k] + (e[1] - e[0]) * off[k] / (off[k] - off[k + 1])


def on_orbit(e, omega):
    """Displacement and velocity on such an orbit, with the unbalance along x."""
    stiffness, damping = damper(stiffness=SPRING).circular_orbit(e, omega)
    z = MASS * ECCENTRIC * omega**2 / (stiffness - MASS * omega**2 + 1j * omega * damping)
    assert abs(z) == pytest.approx(e * CLEARANCE, rel=1e-4)
    return np.array([z.real, z.imag]), omega * np.array([-z.imag, z.real])


def in_series(film=True, axial=None, **changes):
    """A shaft on two 6205 whose housings stand on squirrel cages, in dampers."""
    bearing = BallBearing.catalogue("6205", clearance=5e-6, oil=Lubricant.iso_vg(46, temperature=80.0))
    made = damper(length=0.012, radius=0.026, clearance=1e-4, viscosity=0.012, **changes)
    housing = {"housing_mass": 0.6, "housing_stiffness": 1.5e7}
    own = {"damper": made} if film else {}
    return rotor_on_bearings(
        Shaft(length=0.4, diameter=0.03, damping_time=1e-6, elements=2),
        discs=[Disc(position=0.2, mass=4.0, unbalance=4e-5)],
        supports=[Support(position=at, bearing=bearing, **housing, **own) for at in (0.02, 0.38)],
        axial=axial,
    )
