"""Rotors and contacts that are known in closed form, one mass on a spring and a damper; constructed runs."""

import numpy as np
from balls import OF_6205

from ehlcontact import Lubricant, OperatingPoint
from ehlcontact.status import Status
from reduced_models import jeffcott_rotor
from reduced_models.rotor.result import RotorResult

POINT = OperatingPoint.ball_bearing(Lubricant(0.0367, 2e-8), **OF_6205, speed_rpm=3000, load=48.7)
SCALES = POINT.scales
K, C, MASS = 4e7, 120.0, 2.0  # of one contact [N/m], [N s/m]; of the rotor [kg]


def one_mass(**changes):
    """All of a rotor in its disc, on two contacts and a shaft that hardly bends: one mass on a spring."""
    settings = {"disc_mass": MASS - 1e-6, "journal_mass": 1e-6, "shaft_stiffness": 1e13, "load": (0.0, -100.0)}
    return jeffcott_rotor(**{"unbalance": 4e-5, "speed_rpm": 3000} | settings | changes)


def omega_of(rotor):
    """Speed [rad/s]."""
    return rotor.speed_rpm * np.pi / 30.0


def moving(rotor, **velocities):
    """Velocities, shape (N,), of a rotor of which some nodes move, (x, y) each."""
    v = np.zeros(rotor.size)
    for node, velocity in velocities.items():
        for name, place in rotor.nodes[node].items():
            v[place] = velocity["xy".index(name)]
    return v


def carried(rotor):
    """Force on each contact of a Jeffcott rotor, where the balance of the journal alone decides."""
    size = rotor.size // 2
    load = rotor.load[:size] + rotor.load[size:]
    normals = rotor.support_rows[:, size:] * np.array([[mount.count] for mount in rotor.contacts])
    assert np.linalg.matrix_rank(normals) == len(normals)
    return np.linalg.lstsq(normals.T, load)[0]


def applied_force(rotor, t):
    """Load and unbalance."""
    force, angle, (unbalance,) = rotor.load.copy(), omega_of(rotor) * t, rotor.unbalances
    for place, share in ((unbalance.x, np.cos(angle)), (unbalance.y, np.sin(angle))):
        if place is not None:
            force[place] += unbalance.amount * omega_of(rotor) ** 2 * share
    return force


def spring(omega):
    """Impedance of one contact."""
    return np.asarray(K + 1j * C * np.asarray(omega), dtype=complex)


def run_of(t, approach, rate, force, **others):
    """A run at 3000 rev/min with these histories of its contacts; all that is not given is at rest."""
    still = np.zeros((len(t), 2))
    columns = [np.asarray(values, float).reshape(len(t), -1) for values in (approach, rate, force)]
    given = dict(zip(("approach", "rate", "force"), columns, strict=True))
    given |= {"t": t, "speed_rpm": np.full(len(t), 3000.0), "displacement": still, "velocity": still}
    given |= {
        "iterations": np.ones(len(t), dtype=int),
        "largest_load": np.zeros((0, 2)),
        "status": Status.CONVERGED,
    }
    given["columns"] = tuple(f"contact {i}" for i in range(columns[2].shape[1]))
    return RotorResult(**(given | others))
