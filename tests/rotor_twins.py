"""Rotors and contacts that are known in closed form: one mass on a spring and a damper."""

import numpy as np

from ehlcontact import Lubricant, OperatingPoint
from reduced_models import JeffcottRotor

POINT = OperatingPoint.ball_bearing(
    Lubricant(0.0367, 2e-8),
    ball_diameter=7.94e-3,
    pitch_diameter=39.04e-3,
    conformity=0.52,
    speed_rpm=3000,
    load=48.7,
)
SCALES = POINT.scales
K, C, MASS = 4e7, 120.0, 2.0  # of one contact [N/m], [N s/m]; of the rotor [kg]


def one_mass(**changes):
    """All of a rotor in its disc, on two contacts and a shaft that hardly bends: one mass on a spring."""
    settings = {"disc_mass": MASS - 1e-6, "journal_mass": 1e-6, "shaft_stiffness": 1e13, "load": (0.0, -100.0)}
    return JeffcottRotor.vertical(**{"bearings": 2, "unbalance": 4e-5, "speed_rpm": 3000} | settings | changes)


def spring(omega):
    """Impedance of one contact."""
    return np.asarray(K + 1j * C * np.asarray(omega), dtype=complex)
