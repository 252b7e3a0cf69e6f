"""Independent balance of a bearing at contact angles, in plain numpy: what is left of the equations of a state."""

from math import atan, cos, log, pi, sin

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from reduced_models.elements.film_law import films

STEEPEST_ROLLING = np.arccos(0.45)  # beyond it a ball that the inner ring has left rolls as there
LEAST_DRIVE = 0.1


def hertz_by_hand(radius_x, radius_y, e_reduced):
    """Force over approach^1.5 of two bodies, half axis across under 1 N, and the integral E (Hamrock 1994)."""

    def ratio(k):
        E, K = ellipe(1.0 - k**-2), ellipk(1.0 - k**-2)
        return (k * k * E - K) / (K - E) - radius_y / radius_x

    k = brentq(ratio, 1.0 + 1e-7, 300.0)
    E, K = ellipe(1.0 - k**-2), ellipk(1.0 - k**-2)
    R = 1.0 / (1.0 / radius_x + 1.0 / radius_y)
    approach = K * (9.0 / (2.0 * E * R) / (pi * k * e_reduced) ** 2) ** (1.0 / 3.0)
    return approach**-1.5, (6.0 * k * k * E * R / (pi * e_reduced)) ** (1.0 / 3.0), E


def races_by_hand(bearing):
    """`hertz_by_hand` of inner and outer race, at the nominal contact angle."""
    D, angle = bearing.ball_diameter, bearing.contact_angle or 0.0
    gamma = D * cos(angle) / bearing.pitch_diameter
    e_reduced = bearing.youngs_modulus / (1.0 - bearing.poisson_ratio**2)
    return [
        hertz_by_hand(0.5 * D * (1.0 + sign * gamma), 1.0 / (2.0 / D - 1.0 / (f * D)), e_reduced)
        for f, sign in ((bearing.conformity_inner, -1.0), (bearing.conformity_outer, 1.0))
    ]


def table_film(element, force):
    """Film [m] of an element under a force [N]."""
    h, slope = np.empty((2, 1))
    films(element.law, np.array([log(force / element.scales.force)]), h, slope)
    return float(h[0] * element.scales.length)


def table_force(element, kn, approach):
    """Force [N] of an element at an approach [m]."""

    def gap(x):
        return (np.exp(x) / kn) ** (2.0 / 3.0) - table_film(element, np.exp(x)) - approach

    return float(np.exp(brentq(gap, log(1e-9), log(1e7), xtol=1e-14, rtol=1e-14)))


def imbalance(bearing, state, load):
    """Largest residual of the equations of all balls and of the ring, over the load."""
    D, dm, omega = bearing.ball_diameter, bearing.pitch_diameter, state.speed_rpm * pi / 30.0
    fi, fo, gamma = bearing.conformity_inner, bearing.conformity_outer, D / dm
    A, mass = (fi + fo - 1.0) * D, bearing.density * pi / 6.0 * D**3
    speeds = {"inner": (1.0, 0.0), "outer": (0.0, 1.0)}.get(bearing.turning, bearing.turning)  # of both rings
    turned_i, turned_o = (speed / abs(speeds[0] - speeds[1]) for speed in speeds)
    races = races_by_hand(bearing)
    angle = bearing.contact_angle
    free = np.arccos(1.0 - 0.5 * max(bearing.clearance, 0.0) / A) if angle is None else angle
    start = np.array([A - 0.5 * bearing.clearance, 0.0] if angle is None else [A * cos(angle), A * sin(angle)])
    lever = 0.5 * dm + (fi - 0.5) * D * cos(free)
    x, y, z, tilt_x, tilt_y = state.displacement
    load = np.asarray(load)
    scale = max(np.abs(load[:3]).max(), np.abs(load[3:]).max(initial=0.0) / lever)
    left, total = [0.0], np.zeros(5)
    for k, psi in enumerate(state.angles.tolist()):
        (ai, ao), (qi, qo), (ui, uo) = state.contact_angles[k], state.force[k], state.approach[k]
        li, lo = (fi - 0.5) * D + ui, (fo - 0.5) * D + uo
        ni, no = np.array([cos(ai), sin(ai)]), np.array([cos(ao), sin(ao)])
        along = z + lever * (tilt_x * sin(psi) - tilt_y * cos(psi))
        span = (
            start + np.array([x * cos(psi) + y * sin(psi), along]) - lo * no
        )  # from the ball to the inner groove centre
        span[0] = max(span[0], 0.0)  # a groove does not pull
        left.append(np.abs(li * ni - span).max() / A)
        # moments of friction against spin, of forces without the film's change by the angle
        qs = [qi, qo]
        if bearing.oil is not None:
            elements = [bearing.element(name, state.speed_rpm) for name in ("inner", "outer")]
            rows = zip(elements, races, (ui, uo), strict=True)
            qs = [table_force(element, race[0], u) for element, race, u in rows]
        against = [q ** (4.0 / 3.0) * race[1] * race[2] for q, race in zip(qs, races, strict=True)]
        share = 0.0
        if qi > 0.0 and bearing.race_control in ("inner", "shared"):
            ratio = against[1] / against[0]
            share = 1.0 / (1.0 + ratio if bearing.race_control == "shared" else 1.0 + (0.01 * ratio) ** 2)
        ri, ro = np.clip([ai, ao], -STEEPEST_ROLLING, STEEPEST_ROLLING)
        tan_beta = (1.0 - share) * sin(ro) / (cos(ro) + gamma) + share * sin(ri) / (cos(ri) - gamma)
        beta = atan(tan_beta)
        # surface speeds of a ball that turns about its own axis at 1 rad/s, over the radii of the races
        least = LEAST_DRIVE * cos(beta) * gamma
        driven_o = max(0.5 * D * cos(ro - beta) / (0.5 * dm + 0.5 * D * cos(ro)), least)
        driven_i = max(0.5 * D * cos(ri - beta) / (0.5 * dm - 0.5 * D * cos(ri)), least)
        turn, orbit = 1.0 / (driven_o + driven_i), driven_o / (driven_o + driven_i)  # seen from the outer ring
        about = turned_o + (turned_i - turned_o) * orbit
        left.append(max(abs(about - state.orbit[k]), abs(turn / state.ball_rotation[k] - 1.0)) if omega else 0.0)
        if bearing.oil is None:
            dry = [race[0] * max(u, 0.0) ** 1.5 - q for race, u, q in zip(races, (ui, uo), (qi, qo), strict=True)]
            left.append(np.abs(dry).max() / scale)
        else:
            nominal = gamma * cos(angle or 0.0)
            entrained = (1.0 - orbit) * (1.0 - gamma * cos(ri)), orbit * (1.0 + gamma * cos(ro))
            rows = zip(
                elements, races, (qi, qo), (ui, uo), entrained, (-cos(ri), cos(ro)), (-1.0, 1.0), strict=True
            )
            for element, race, q, u, speed, c, sign in rows:
                by_speed = (speed / (0.5 * (1.0 - nominal**2))) ** 0.67
                film = by_speed * ((1.0 + gamma * c) / (1.0 + sign * nominal)) ** 0.464
                g = (q / race[0]) ** (2.0 / 3.0)
                left.append(abs(g - film * table_film(element, q) - u) * 1.5 * q / g / scale)
        moment = 0.1 * mass * D * D * (turned_i - turned_o) * turn * about * sin(beta) * omega**2
        moment *= -1.0 if bearing.race_control == "harris" else 1.0
        friction_i, friction_o = 2.0 * share * moment / D, 2.0 * (1.0 - share) * moment / D
        pressed = qi * ni + friction_i * np.array([-ni[1], ni[0]])
        held = qo * no + friction_o * np.array([-no[1], no[0]])
        if max(qi, qo) > 0.0:
            ball = pressed - held + [mass * 0.5 * dm * (about * omega) ** 2, 0.0]
            left.append(np.abs(ball).max() / scale)
        outward, axis = np.array([cos(psi), sin(psi), 0.0]), np.array([0.0, 0.0, 1.0])
        force = pressed[0] * outward + pressed[1] * axis
        at = lever * outward - fi * D * (ni[0] * outward + ni[1] * axis)  # where it acts on the ring
        total += [*force, *np.cross(at, force)[:2]]
    unit = np.array([1.0, 1.0, 1.0, 1.0 / lever, 1.0 / lever]) / scale
    left.append(np.abs((total - state.load) * unit).max())
    left.append(np.abs((state.load[: load.size] - load) * unit[: load.size]).max())
    return max(left) if np.isfinite(left).all() else np.inf


def random_bearing(rng, **changes):
    """Dimensions of a bearing with 5 to 25 balls: deep groove of any clearance, or angular contact."""
    balls, D = int(rng.integers(5, 26)), 10.0 ** rng.uniform(-2.5, -1.5)
    pitch = max(D / sin(pi / balls) * rng.uniform(1.03, 1.6), 2.5 * D)
    inner, outer = rng.uniform(0.512, 0.535, 2) if "oil" in changes else rng.uniform(0.505, 0.56, 2)
    found = {"balls": balls, "ball_diameter": D, "pitch_diameter": pitch}
    found |= {"conformity_inner": inner, "conformity_outer": outer}
    found["race_control"] = str(rng.choice(["outer", "inner", "shared", "harris"]))
    if rng.random() < 0.4:
        found["clearance"] = float(rng.choice([rng.uniform(0.0, 3e-3), -rng.uniform(0.0, 5e-4), 0.0])) * D
    else:
        found["contact_angle"] = rng.uniform(0.21, 0.70)
    return found | changes


def random_load(rng, bearing):
    """Kind of a load, the load, the speed [rev/min] and the tilt at which the ring is held, or None."""
    q = (2.2e9 / 1e9) ** 3 * bearing.ball_diameter**2 * 3e6  # of a ball, about
    size, pitch = q * bearing.balls / 5.0 * 10.0 ** rng.uniform(-3.5, 0.2), bearing.pitch_diameter
    rpm = min(0.999 * bearing.highest_speed, 1.2e3 / pitch) * 10.0 ** rng.uniform(-2.0, 0.0)
    if bearing.oil is None and rng.random() < 0.35:
        rpm = 0.0
    psi, one_way, tilt = rng.uniform(0.0, 2.0 * pi), bearing.contact_angle is not None, None
    radial = [size * cos(psi), size * sin(psi)]
    kind = str(rng.choice(["axial", "little axial", "little axial, free", "combined", "all", "moment", "tilted"]))
    if kind == "axial":
        load = [0.0, 0.0, 0.4 * size * (1.0 if one_way else rng.choice([-1.0, 1.0]))]
    elif kind == "little axial":
        load = [*radial, size * 10.0 ** rng.uniform(-3.0, -1.0)]
    elif kind == "little axial, free":
        load = [*radial, size * 10.0 ** rng.uniform(-3.0, -1.0), 0.0, 0.0]
    elif kind == "combined":
        load = [*radial, size * rng.uniform(0.3, 2.0)]
    elif kind == "all":
        load = [
            *radial,
            size * rng.uniform(0.3, 2.0),
            *(rng.normal(size=2) * pitch * size * rng.uniform(0.0, 0.15)),
        ]
    elif kind == "moment":
        load = [0.0, 0.0, 0.1 * size * one_way, *(rng.normal(size=2) * pitch * size * rng.uniform(0.0, 0.1))]
    else:
        load, tilt = [*radial, size * rng.uniform(0.0, 1.0)], tuple(rng.normal(size=2) * 3e-3 * rng.random())
    return kind, tuple(map(float, load)), float(rpm), tilt
