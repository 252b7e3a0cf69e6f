"""Heights that the contacts of a bearing meet in time steps, compiled: from the tables of `height_tables`."""

from __future__ import annotations

from math import pi, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.jit import jit_exact_called_node, jit_exact_loop
from reduced_models.bearing.race_contact import APPROACH

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

NONE = -1  # no table
# Entries of the heights of a contact: height and rate of the step, heights at its last two ends
HEIGHT, HEIGHT_RATE, HEIGHT_NOW, HEIGHT_BEFORE, HEIGHTS = range(5)
# Entries of an angle: at the end of the step, at the end of the last one, its speed over that of the shaft. The
# first row is that of the shaft, with the first angle of the cage for planar balls in place of the speed.
ANGLE_NOW, ANGLE_LAST, ANGLE_RATE = range(3)


class ContactHeights(NamedTuple):
    """Heights over the angle and the semi-axis, as the kernels need them. No features: all of size 0."""

    tables: _Floats  # (tables, places, semi-axes) [m]
    per_root: _Floats  # (tables,) column over the square root of the compression [m^-0.5]
    of_race: _Integers  # (2,) table of each race; `NONE`
    of_ball: _Integers  # (balls, 2) table of each ball at both races
    raised: _Floats  # (balls,) height of a ball of another diameter at both of its contacts [m]
    rotation: float  # turns of a ball per turn of the shaft, without contact angles


@jit_exact_called_node
def looked_up(heights, table, angle, compression):
    """Height H [m] of one table at an `angle` [rad] of its track and a `compression` d [m]."""
    if table < 0:
        return 0.0
    found, places = heights.tables[table], heights.tables.shape[1]
    turns = angle / (2.0 * pi)
    at = (turns - np.floor(turns)) * places
    i = min(int(at), places - 1)
    s, after = at - i, i + 1 if i + 1 < places else 0
    load = min(sqrt(max(compression, 0.0)) * heights.per_root[table], found.shape[1] - 1.0)
    j = min(int(load), found.shape[1] - 2)
    t = (load * load - j * j) / (
        2.0 * j + 1.0
    )  # straight over d: so are lost contacts, and the mean of long waves
    here = found[i, j] + t * (found[i, j + 1] - found[i, j])
    return here + s * (found[after, j] + t * (found[after, j + 1] - found[after, j]) - here)


@jit_exact_called_node
def height_of(heights, k, race, psi, turned, compression):
    """Height [m] at the contact of ball `k`, which stands at `psi`, with a race (0: inner)."""
    on_race = psi - turned[0, ANGLE_NOW] if race == 0 else psi
    on_ball = turned[1 + k, ANGLE_NOW] + (0.0 if race == 0 else pi)
    found = looked_up(heights, heights.of_race[race], on_race, compression)
    return heights.raised[k] + found + looked_up(heights, heights.of_ball[k, race], on_ball, compression)


@jit_exact_loop
def find_heights(balls, films, angle, gain):
    """Heights at all contacts and their rates (BDF 2), the first ball at `angle`, shaft and balls as turned."""
    heights, found = balls.heights, films.heights
    for k in range(heights.raised.size):
        psi = angle + 2.0 * pi * k / heights.raised.size
        for race in range(2):
            c = 2 * k + race
            law = balls.inner if race == 0 else balls.outer
            force, pressed = films.force[k, race], films.state[c, APPROACH]
            if force > 0.0:
                pressed = (force / law.kn) ** (2.0 / 3.0)
            found[c, HEIGHT] = height_of(heights, k, race, psi, films.turned, pressed - found[c, HEIGHT_NOW])
            past = (4.0 * found[c, HEIGHT_NOW] - found[c, HEIGHT_BEFORE]) / 3.0
            found[c, HEIGHT_RATE] = gain * (found[c, HEIGHT] - past)


@jit_exact_loop
def keep_heights(films):
    """Move the heights to the end of the step."""
    found = films.heights
    for c in range(found.shape[0]):
        found[c, HEIGHT_BEFORE], found[c, HEIGHT_NOW] = found[c, HEIGHT_NOW], found[c, HEIGHT]


@jit_exact_loop
def rest_heights(films):
    """Heights at rest: they have been what they are."""
    found = films.heights
    for c in range(found.shape[0]):
        found[c, HEIGHT_RATE] = 0.0
        found[c, HEIGHT_NOW] = found[c, HEIGHT_BEFORE] = found[c, HEIGHT]
