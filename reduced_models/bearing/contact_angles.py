"""Groove centres, contact angles and rolling of a ball between two races, as ``rolling.h`` computes them.

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
that across the inner contact inward (derivation: `docs/notes/bearings.md`). With the outer ring turning alone it
is the other way round. Published tables have the opposite
direction; "harris" is outer race control with the direction of these tables.
"""

from __future__ import annotations

from typing import NamedTuple

CONTROLS = ("outer", "inner", "shared", "harris")
FOLLOWING = CONTROLS.index("inner"), CONTROLS.index("shared")  # the axis follows the forces at both races


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
    ring_speed: tuple[float, float]  # of both rings about the axis, over their speed against each other
    sense: float  # of that: 1 where the inner ring turns forward as seen from the outer one, else -1
