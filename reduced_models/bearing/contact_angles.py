"""Groove centres, contact angles and rolling of a ball between two races, compiled.

The contact angle without load is `BallBearing.free_angle`.

In the plane through a ball and the axis of the bearing, with r outward and z along the shaft, the centre of the
outer groove is the origin, that of the inner groove is at c and that of the ball at b. Both contacts are springs
in series from groove centre to groove centre,

    l_o = |b|, n_o = b/l_o,    l_i = |c - b|, n_i = (c - b)/l_i,    u = l - (f - 1/2) D,

with n = (cos alpha, sin alpha). Surfaces do not slip at the centres of both contacts; the axis of the ball, at the
angle beta from that of the shaft, follows from race control (Harris, Rolling Bearing Analysis, ch. 8):

    outer: no spin there, tan beta_o = sin alpha_o/(cos alpha_o + gamma),    gamma = D/dm
    inner: no spin there, tan beta_i = sin alpha_i/(cos alpha_i - gamma)
    shared: tan beta = (W_i tan beta_i + W_o tan beta_o)/(W_i + W_o),    W = Q b E(1 - kappa^2)

W is proportional to the moment that friction has against spin (3/8 mu Q b E). Inner race control is a share too,
of nearly 1, that ends where the ball leaves the inner race.

Friction of the outer race, of the inner race, or of both in the ratio of W turns the axis of the ball around the
shaft (gyroscopic moment). With the inner ring rotating, the angular momentum of the ball points outward where
alpha > 0. Its change is along the orbit, so that friction across the outer contact has to push the ball outward,
that across the inner contact inward (derivation: `docs/theory.md`). Published tables have the opposite direction;
"harris" is outer race control with the direction of these tables.

All functions of places take real or complex numbers: derivatives by complex steps are exact (Squire and Trapp,
SIAM Review 40 (1998) 110).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ehlcontact.jit import jit_exact_node

CONTROLS = ("outer", "inner", "shared", "harris")
OUTER, INNER, SHARED, HARRIS = range(4)
OF_OUTER = 0.01  # W_i/W_o below which inner race control fades
# Film over speed and over the radius Rx at a given load (Hamrock and Dowson 1977), between the angle that a table
# of films is for and that of a ball
FILM_BY_SPEED, FILM_BY_RADIUS = 0.67, 0.464
# Least cosine of a contact angle with which a ball rolls (63 degrees): none that carries runs so steeply, and one
# that the inner ring has left by a tenth of a millimetre has no place on it at which it would roll.
LEAST_COSINE = 0.45
LEAST_DRIVE = (
    0.1  # cosine between the axis of a ball and the cone of a contact that drives it, from which on it slips
)
TINY = 1e-20  # m, no length


class Grooves(NamedTuple):
    """Grooves, ball and race control of a bearing."""

    radial: float  # free place c of the inner groove centre from the outer one [m]
    axial: float
    inner: float  # (f_i - 1/2) D [m]
    outer: float
    groove_circle: float  # radius of the circle of inner groove centres [m]
    radius: float  # of the inner groove [m]
    ball: float  # diameter [m]
    pitch: float  # diameter [m]
    mass: float  # of a ball [kg]
    control: int  # index of `CONTROLS`
    gyroscopic: float  # factor of the gyroscopic moment: 1, or -1 of "harris"; between while a search goes on
    inner_spin_moment: float  # W over the dry compression squared
    outer_spin_moment: float
    cosine: float  # of the contact angle that the tables of both races are for


class Rolling(NamedTuple):
    """Ball between two races. Angular speeds over that of the shaft, sums of surface speeds over it [m]."""

    l_i: float  # length of the inner spring [m]
    cos_i: float
    sin_i: float
    l_o: float
    cos_o: float
    sin_o: float
    orbit: float  # of the centre of the ball about the shaft
    ball_rotation: float  # of the ball about its own axis, seen from the cage
    sin_b: float  # of beta
    cos_b: float
    share: float  # of the inner race in the gyroscopic moment
    u_i: float  # sum of both surface speeds [m]
    u_o: float


@jit_exact_node
def _rolls_at(cosine, sine):
    """Cosine and sine of the angle at which a ball rolls on a race, at most that of `LEAST_COSINE`."""
    if cosine.real >= LEAST_COSINE:
        return cosine, sine
    most = np.sqrt(1.0 - LEAST_COSINE * LEAST_COSINE)
    return LEAST_COSINE + 0.0 * cosine, (most if sine.real >= 0.0 else -most) + 0.0 * sine


@jit_exact_node
def _at_least(value, least):
    """The value, or a constant where it would be smaller."""
    return value if value.real > least else least + 0.0 * value


@jit_exact_node
def inner_span(b_r, b_z, c_r, c_z):
    """Length of the inner spring and the vector along it.

    The groove is half a circle with straight walls beyond it: it never pulls a ball inward, however far the ring
    has left it, and the potential stays convex.
    """
    s_r, s_z = c_r - b_r, c_z - b_z
    if s_r.real < 0.0:
        s_r = 0.0 * s_r
    return np.sqrt(s_r * s_r + s_z * s_z + TINY * TINY), s_r, s_z


@jit_exact_node
def rolling(g, b_r, b_z, c_r, c_z, g_i, g_o):
    """Angles and speeds of a ball at `b` with the inner groove centre at `c`.

    `g_i` and `g_o` are dry compressions [m] under the forces of both contacts: W is as their square.
    """
    gamma = g.ball / g.pitch
    l_o = np.sqrt(b_r * b_r + b_z * b_z)
    l_i, s_r, s_z = inner_span(b_r, b_z, c_r, c_z)
    per_i, per_o = 1.0 / l_i, 1.0 / l_o
    cos_o, sin_o, cos_i, sin_i = b_r * per_o, b_z * per_o, s_r * per_i, s_z * per_i
    share = 0.0 * l_i
    if sin_i == 0.0 and sin_o == 0.0:  # on no inclined contact nothing spins
        orbit, u = 0.5 * (1.0 - gamma) + share, 0.5 * g.pitch * (1.0 - gamma * gamma) + share
        turns = 0.5 * (1.0 - gamma * gamma) / gamma + share
        return Rolling(l_i, cos_i, sin_i, l_o, cos_o, sin_o, orbit, turns, share, 1.0 + share, share, u, u)
    (c_i, s_i), (c_o, s_o) = _rolls_at(cos_i, sin_i), _rolls_at(cos_o, sin_o)
    if g.control in (INNER, SHARED) and g_i.real > 0.0:
        ratio = g.outer_spin_moment * g_o * g_o / (g.inner_spin_moment * g_i * g_i)  # W_o/W_i
        share = 1.0 / (1.0 + (ratio if g.control == SHARED else (OF_OUTER * ratio) ** 2))
    slope = (1.0 - share) * s_o / (c_o + gamma) + share * s_i / (c_i - gamma)
    cos_b = 1.0 / np.sqrt(1.0 + slope * slope)
    # no slip: both races drive the ball at gamma ball_rotation cos_b e/r
    r_i, r_o = 1.0 - gamma * c_i, 1.0 + gamma * c_o
    by_i, by_o = (
        _at_least((c_i + slope * s_i) / r_i, LEAST_DRIVE),
        _at_least((c_o + slope * s_o) / r_o, LEAST_DRIVE),
    )
    orbit = by_o / (by_i + by_o)
    ball_rotation = 1.0 / (gamma * cos_b * (by_i + by_o))
    u_i, u_o = (1.0 - orbit) * g.pitch * r_i, orbit * g.pitch * r_o
    return Rolling(
        l_i, cos_i, sin_i, l_o, cos_o, sin_o, orbit, ball_rotation, slope * cos_b, cos_b, share, u_i, u_o
    )  # fmt: skip


@jit_exact_node
def film_factors(g, at):
    """Films at both races over those of the tables, whose contacts have the nominal angle, at the same load."""
    gamma = g.ball / g.pitch
    if g.cosine == 1.0 and at.sin_i == 0.0 and at.sin_o == 0.0:
        return 1.0 + 0.0 * at.u_i, 1.0 + 0.0 * at.u_o
    nominal = gamma * g.cosine
    r_i, r_o = at.u_i / ((1.0 - at.orbit) * g.pitch), at.u_o / (at.orbit * g.pitch)  # radii of rolling
    u = 0.5 * g.pitch * (1.0 - nominal * nominal)
    film_i = (at.u_i / u) ** FILM_BY_SPEED * (r_i / (1.0 - nominal)) ** FILM_BY_RADIUS
    film_o = (at.u_o / u) ** FILM_BY_SPEED * (r_o / (1.0 + nominal)) ** FILM_BY_RADIUS
    return film_i, film_o


@jit_exact_node
def ball_forces(g, omega, at, q_i, q_o):
    """Forces on a ball in (r, z) [N] and its inner contact, the contacts pressed by `q_i` and `q_o` [N].

    Returns
    -------
    tuple
        Sum of all forces on the ball, (r, z); force of the inner ring on it, (r, z); moment of that force about
        the inner groove centre [N m], in the direction of the orbit.
    """
    speed = at.orbit * omega
    centrifugal = g.mass * 0.5 * g.pitch * speed * speed
    # moment J x orbit x ball_rotation x sin(beta) along the orbit, over D/2, by friction across both contacts
    gyroscopic_friction = 0.2 * g.gyroscopic * g.mass * g.ball * speed * at.ball_rotation * omega * at.sin_b
    f_i, f_o = at.share * gyroscopic_friction, -(1.0 - at.share) * gyroscopic_friction
    p_r, p_z = q_i * at.cos_i - f_i * at.sin_i, q_i * at.sin_i + f_i * at.cos_i
    r_r = p_r - q_o * at.cos_o - f_o * at.sin_o + centrifugal
    r_z = p_z - q_o * at.sin_o + f_o * at.cos_o
    return r_r, r_z, p_r, p_z, g.radius * f_i
