"""Rotors and contacts that are known in closed form, one mass on a spring and a damper; constructed runs."""

import numpy as np
from balls import OF_6205

from ehlcontact import Lubricant, OperatingPoint
from ehlcontact.status import Status
from reduced_models import JeffcottRotor
from reduced_models.rotor.result import RotorResult

POINT = OperatingPoint.ball_bearing(Lubricant(0.0367, 2e-8), **OF_6205, speed_rpm=3000, load=48.7)
SCALES = POINT.scales
K, C, MASS = 4e7, 120.0, 2.0  # of one contact [N/m], [N s/m]; of the rotor [kg]


def one_mass(**changes):
    """All of a rotor in its disc, on two contacts and a shaft that hardly bends: one mass on a spring."""
    settings = {"disc_mass": MASS - 1e-6, "journal_mass": 1e-6, "shaft_stiffness": 1e13, "load": (0.0, -100.0)}
    return JeffcottRotor.vertical(**{"bearings": 2, "unbalance": 4e-5, "speed_rpm": 3000} | settings | changes)


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
