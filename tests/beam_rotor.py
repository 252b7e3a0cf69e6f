"""Rotors of Timoshenko beams and discs, the obvious way, and the rotors on ball bearings of the tests.

Every node has x, y, and the turns about x and y; a node's shaft bends in x-z with the turn about y.
"""

from dataclasses import replace

import numpy as np

from reduced_models import BearingMotion, BearingMount, Rotor, Unbalance
from reduced_models.bearing.bearing_tables import BearingTables
from reduced_models.rotor.integrate_compiled import CompiledSteps
from reduced_models.rotor.prepared_run import PreparedRun
from reduced_models.rotor.simulate import steps_until

RHO, E, G_S = 7810.0, 211e9, 81.2e9  # steel


def element(length, diameter):
    """Mass, stiffness and gyroscopic matrix of a beam in one plane, with shear and turning inertia."""
    area, inertia = np.pi / 4.0 * diameter**2, np.pi / 64.0 * diameter**4
    nu = 0.5 * E / G_S - 1.0
    kappa = 6.0 * (1.0 + nu) ** 2 / (7.0 + 12.0 * nu + 4.0 * nu * nu)
    phi = 12.0 * E * inertia / (G_S * kappa * area * length**2)
    L = length
    k = E * inertia / ((1.0 + phi) * L**3) * np.array(
        [
            [12.0, 6.0 * L, -12.0, 6.0 * L],
            [6.0 * L, (4.0 + phi) * L**2, -6.0 * L, (2.0 - phi) * L**2],
            [-12.0, -6.0 * L, 12.0, -6.0 * L],
            [6.0 * L, (2.0 - phi) * L**2, -6.0 * L, (4.0 + phi) * L**2],
        ]
    )  # fmt: skip
    p = phi
    a, b, c = (
        312.0 + 588.0 * p + 280.0 * p**2,
        (44.0 + 77.0 * p + 35.0 * p**2) * L,
        108.0 + 252.0 * p + 140.0 * p**2,
    )
    d, e, f = (
        -(26.0 + 63.0 * p + 35.0 * p**2) * L,
        (8.0 + 14.0 * p + 7.0 * p**2) * L**2,
        -(6.0 + 14.0 * p + 7.0 * p**2) * L**2,
    )
    m = RHO * area * L / (840.0 * (1.0 + p) ** 2) * np.array(
        [[a, b, c, d], [b, e, -d, f], [c, -d, a, -b], [d, f, -b, e]]
    )  # fmt: skip
    g, h = 36.0, (3.0 - 15.0 * p) * L
    i, j = (4.0 + 5.0 * p + 10.0 * p**2) * L**2, (-1.0 - 5.0 * p + 5.0 * p**2) * L**2
    turning = RHO * inertia / (30.0 * (1.0 + p) ** 2 * L) * np.array(
        [[g, h, -g, h], [h, i, -h, j], [-g, -h, g, -h], [h, j, -h, i]]
    )  # fmt: skip
    return m + turning, k, 2.0 * turning


def planes(one_plane, across=None):
    """Both planes of bending from one: x with the turn about y, y with minus that about x."""
    out = np.zeros((8, 8))
    xz, yz = [0, 3, 4, 7], [1, 2, 5, 6]
    sign = np.array([1.0, -1.0, 1.0, -1.0])
    if across is None:
        out[np.ix_(xz, xz)] = one_plane
        out[np.ix_(yz, yz)] = one_plane * np.outer(sign, sign)
    else:  # gyroscopic: couples the planes
        out[np.ix_(xz, yz)] = across * sign
        out[np.ix_(yz, xz)] = -(across * sign).T
    return out


def shaft(lengths, diameter, discs=()):
    """Mass, stiffness and gyroscopic matrix; `discs` are (node, diameter, width)."""
    size = 4 * (len(lengths) + 1)
    M, K, G = np.zeros((3, size, size))
    for n, length in enumerate(lengths):
        m, k, g = element(length, diameter)
        at = np.ix_(range(4 * n, 4 * n + 8), range(4 * n, 4 * n + 8))
        M[at] += planes(m)
        K[at] += planes(k)
        G[at] += planes(None, g)
    for node, outer, width in discs:
        mass = RHO * np.pi / 4.0 * (outer**2 - diameter**2) * width
        polar = mass * (outer**2 + diameter**2) / 8.0
        across = 0.5 * polar + mass * width**2 / 12.0
        at = 4 * node
        M[range(at, at + 4), range(at, at + 4)] += [mass, mass, across, across]
        G[at + 2, at + 3] += polar
        G[at + 3, at + 2] -= polar
    return M, K, G


M, K, G = shaft([0.05] * 6, 0.04, [(3, 0.28, 0.07)])
NODES, DISC = (1, 5), 12  # of the bearings; first degree of freedom of the disc


def beam(bearing, unbalance=0.0, phase=0.0, **changes):
    """Disc of 34 kg in the middle of a shaft, 500 N on either bearing."""
    load = np.zeros(len(M))
    load[DISC + 1] = -1000.0
    mounts = tuple(BearingMount(bearing=bearing, x=4 * n, y=4 * n + 1) for n in NODES)
    heavy = (Unbalance(x=DISC, y=DISC + 1, amount=unbalance, phase=phase),) if unbalance else ()
    given = {"mass": M, "stiffness": K, "gyroscopic": G, "load": load, "mounts": mounts, "unbalances": heavy}
    return Rotor(**(given | changes))


def block(bearing, mass=2.0, load=(0.0, -300.0), unbalance=0.0, **changes):
    """A rigid mass on one bearing."""
    given = {"mass": mass * np.eye(2), "stiffness": np.zeros((2, 2)), "load": np.array(load)}
    given |= {"mounts": (BearingMount(bearing=bearing, x=0, y=1),)}
    heavy = (Unbalance(x=0, y=1, amount=unbalance),) if unbalance else ()
    return Rotor(**(given | {"unbalances": heavy} | changes))


def still_motion(bearing, speed_rpm, dt, cage_angle=-np.pi / 2.0):
    """A motion with films as at a speed whose balls do not go round and have no centrifugal force."""
    motion = BearingMotion(bearing, speed_rpm, dt, cage_angle)
    motion._omega = 0.0
    motion.rest(np.zeros(2))
    return motion


def still_run(rotor, speed_rpm, dt, until, start="static", rho_inf=0.8):
    """Times and displacements of a run with films and unbalances as at a speed, and balls that do not go round."""
    run = PreparedRun(rotor, speed_rpm, dt, steps_until(dt, until), start, rho_inf)
    run.omega = np.zeros_like(run.omega)
    for mount, at, balls in zip(rotor.ball_bearings, run.ball_directions, run.balls, strict=True):
        balls.rest(0.0, mount.cage_angle, run.histories.motion[0, at])
    integrator = CompiledSteps(run, 1e-9)
    for first, end, omega in run.blocks():
        integrator.advance(omega, first, end, lambda made: None)
    return run.t, run.histories.displacement


def with_light_balls(bearing):
    """A copy of a bearing whose balls have hardly any inertia about the shaft."""
    changed = replace(bearing)
    object.__setattr__(changed, "tables", _LightBalls(changed))
    return changed


class _LightBalls(BearingTables):
    def balls(self, speeds_rpm):
        balls = super().balls(speeds_rpm)
        return balls._replace(grooves=balls.grooves._replace(mass=1e-12))
