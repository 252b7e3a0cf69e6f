"""Rotors with axial motion and tilts for tests, and their balls as springs between groove centres in space."""

from math import pi, radians

import numpy as np

from reduced_models import BallBearing, BearingMount, Disc, Rotor, Shaft, Support, rotor_on_bearings

SPINDLE = {"balls": 13, "ball_diameter": 7.938e-3, "pitch_diameter": 38.5e-3, "contact_angle": radians(25.0)}
LIGHT = BallBearing(**SPINDLE, density=1e-9)  # balls whose inertia has no effect
ARM, OFFSET = 0.05, 8e-6  # m
MASS, ACROSS, POLAR = 3.0, 6e-3, 4e-3
NODES = {"rotor": {"x": 0, "y": 1, "tilt_x": 3, "tilt_y": 4}, "shaft": {"z": 2}}


def rigid(first, second, offset=OFFSET, load=None, **others):
    """A rigid rotor on two bearings back to back, or face to face with ``apart=True``."""
    facings = ("-z", "+z") if others.pop("apart", False) else ("+z", "-z")
    gyroscopic = np.zeros((5, 5))
    gyroscopic[3, 4], gyroscopic[4, 3] = POLAR, -POLAR
    places = {"x": 0, "y": 1, "z": 2, "tilt_x": 3, "tilt_y": 4}
    return Rotor(
        mass=np.diag([MASS, MASS, MASS, ACROSS, ACROSS]),
        stiffness=np.zeros((5, 5)),
        gyroscopic=gyroscopic,
        load=load,
        nodes=NODES,
        mounts=tuple(
            BearingMount(bearing=bearing, facing=facing, offset=offset, arm=arm, **places)
            for bearing, facing, arm in zip((first, second), facings, (-ARM, ARM), strict=True)
        ),
        **others,
    )


def ring_force(bearing, facing, arm, offset, q):
    """Generalised force of massless balls as springs between groove centres, placed in space; q may be complex."""
    D, alpha = bearing.ball_diameter, bearing.free_angle
    inner, outer = ((f - 0.5) * D for f in (bearing.conformity_inner, bearing.conformity_outer))
    kn = sum(bearing.race(race).kn ** (-2.0 / 3.0) for race in ("inner", "outer")) ** -1.5
    radius = 0.5 * bearing.pitch_diameter + inner * np.cos(alpha)
    axial = 1.0 if facing == "+z" else -1.0
    total = np.zeros(5, q.dtype)
    for k in range(bearing.balls):
        psi = -pi / 2.0 + 2.0 * pi * k / bearing.balls
        out = np.array([np.cos(psi), np.sin(psi), 0.0])
        from_node = radius * out + np.array([0.0, 0.0, arm])
        turned = np.array([q[4] * from_node[2], -q[3] * from_node[2], q[3] * from_node[1] - q[4] * from_node[0]])
        moved = q[:3] + turned + np.array([0.0, 0.0, axial * offset])
        apart = (inner + outer) * (np.cos(alpha) * out + np.array([0.0, 0.0, axial * np.sin(alpha)]))
        # balls stay in their planes, so the springs do not see motions along the orbit
        c = np.array([(apart + moved) @ out, (apart + moved)[2]])
        length = np.sqrt(c @ c)
        pressed = length - (inner + outer)
        force = kn * pressed**1.5 * c / length if pressed.real > 0.0 else np.zeros(2, q.dtype)
        pull = force[0] * out + np.array([0.0, 0.0, 1.0]) * force[1]
        total[:3] += pull
        total[3] += from_node[1] * pull[2] - from_node[2] * pull[1]
        total[4] += from_node[2] * pull[0] - from_node[0] * pull[2]
    return total


def pair_force(rotor, q):
    return sum(ring_force(m.bearing, m.facing, m.arm, m.offset, q) for m in rotor.mounts)


def pair_stiffness(rotor, q):
    step = 1e-30
    return np.array([pair_force(rotor, q + 1j * step * e).imag / step for e in np.eye(5)]).T


def motor(bearing, **second):
    """A rotor of 3 kg between two bearings, the second one preloaded by a spring."""
    return rotor_on_bearings(
        Shaft(length=0.2, diameter=0.02),
        discs=[Disc.cylinder(position=0.1, diameter=0.08, width=0.06, bore=0.02, unbalance=2e-6)],
        supports=[
            Support(position=0.02, bearing=bearing, facing="-z"),
            Support(position=0.18, bearing=bearing, facing="+z", **second),
        ],
    )
