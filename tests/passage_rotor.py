"""A rigid rotor on a dry bearing, excited by the passage of its balls: the case of machine.md, section 3.

M x'' + c x' + sum over the balls of Cb d^1.5 = W along x, with d = x cos + y sin - g0: M 20 kg, c 200 N s/m,
8 balls with Cb 1.334e10 N/m^1.5 of both races together and without inertia, W 196 N, g0 6 um.
"""

from math import pi

import numpy as np

from reduced_models import BallBearing, BearingMount, Rotor

STIFFNESS, MASS, DAMPING, LOAD, GAP = 1.334e10, 20.0, 200.0, 196.0, 6e-6
BALLS, RATIO = 8, 0.25  # ball diameter over pitch diameter

# Near the three answers at 500 rad/s: places and velocities at t = 0.
SMALL = (8.54353e-6, -1.57914e-6), (9.0382e-4, 2.4649e-4)
LARGE = (1.061340e-5, 5.20791e-7), (7.1351e-4, 1.36880e-3)
UNSTABLE = (9.734839e-6, 8.912832e-7), (5.8865e-4, -6.2184e-4)


def bearing(clearance=2.0 * GAP):
    """Its modulus is that at which both races together have the stiffness."""
    given = {
        "balls": BALLS,
        "ball_diameter": 0.01,
        "pitch_diameter": 0.01 / RATIO,
        "clearance": clearance,
        "density": 1e-3,
    }
    steel = 2.06e11
    races = BallBearing(**given, youngs_modulus=steel).tables.balls([1000.0])
    both = (races.inner.kn ** (-2.0 / 3.0) + races.outer.kn ** (-2.0 / 3.0)) ** -1.5
    return BallBearing(**given, youngs_modulus=steel * STIFFNESS / both)


def rotor(load=LOAD, **given):
    """x along the load."""
    mount = BearingMount(bearing=bearing(**given), x=0, y=1, cage_angle=0.0)
    unit = np.eye(2)
    return Rotor(mass=MASS * unit, stiffness=0.0 * unit, damping=DAMPING * unit, load=[load, 0.0], mounts=(mount,))


def speed_rpm(passage):
    """Of the shaft [rev/min], at which balls pass so often [rad/s]."""
    return passage / (BALLS * 0.5 * (1.0 - RATIO)) * 30.0 / pi
