"""Heights of all contacts of a bearing in a time step, compiled: looked up in the tables of `height_tables`."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np

from ehlcontact.jit import jit_exact_called_node, jit_exact_loop, jit_exact_node
from reduced_models.bearing.race_contact import APPROACH

# Entries of the heights of a contact: height and rate of the step, heights at its last two ends; where a full film
# is in place of its element, the force of that film, its slope and the approach where it is, heights left out
HEIGHT, HEIGHT_RATE, HEIGHT_NOW, HEIGHT_BEFORE, FILM_FORCE, FILM_SLOPE, FILM_APPROACH, HEIGHTS = range(8)
# Entries of an angle: at the end of the step, at the end of the last one, its speed over that of the shaft. The
# first row is that of the shaft, with the first angle of the cage for planar balls in place of the speed.
ANGLE_NOW, ANGLE_LAST, ANGLE_RATE = range(3)

# Tables of heights, shape (1 + tables, rows, semi-axes): one array, for every field of a bearing's parameters is
# handed to its kernels in every call. Without features it has no pages. The first page has numbers: in its first
# row turns of a ball per turn of the shaft, without contact angles, and the tables of both races; then, for every
# ball, its height where it is larger than the others, and its tables at both races; 0 is no table. The others are
# tables over the angle, with the column over the square root of the compression in their last row.
ROTATION, RAISED, TABLE = 0, 0, 1


@jit_exact_called_node
def looked_up(heights, table, angle, compression):
    """Height H [m] of one table at an `angle` [rad] of its track and a `compression` d [m]."""
    if table == 0:
        return 0.0
    found, places = heights[table], heights.shape[1] - 1
    turns = angle / (2.0 * pi)
    at = (turns - np.floor(turns)) * places
    i = min(int(at), places - 1)
    s, after = at - i, i + 1 if i + 1 < places else 0
    load = min(sqrt(max(compression, 0.0)) * found[places, 0], found.shape[1] - 1.0)
    j = min(int(load), found.shape[1] - 2)
    # straight over d: so are contacts that are lost, and the mean over long waves
    t = (load * load - j * j) / (2.0 * j + 1.0)
    here = found[i, j] + t * (found[i, j + 1] - found[i, j])
    return here + s * (found[after, j] + t * (found[after, j + 1] - found[after, j]) - here)


@jit_exact_called_node
def height_of(heights, k, race, psi, turned, compression):
    """Height [m] at the contact of ball `k`, which stands at `psi`, with a race (0: inner)."""
    on_race = psi - turned[0, ANGLE_NOW] if race == 0 else psi
    on_ball = turned[1 + k, ANGLE_NOW] + (0.0 if race == 0 else pi)
    of_race, of_ball = int(heights[0, 0, TABLE + race]), int(heights[0, 1 + k, TABLE + race])
    found = looked_up(heights, of_race, on_race, compression) + looked_up(heights, of_ball, on_ball, compression)
    return heights[0, 1 + k, RAISED] + found


@jit_exact_loop
def find_heights(balls, films, angle, gain):
    """Heights at all contacts and their rates (BDF 2), the first ball at `angle`, shaft and balls as turned."""
    heights, found = balls.heights, films.heights
    for k in range(balls.number):
        psi = angle + 2.0 * pi * k / balls.number
        for race in range(2):
            c = 2 * k + race
            law = balls.inner if race == 0 else balls.outer
            force, pressed = films.force[k, race], films.state[c, APPROACH]
            if force > 0.0:
                pressed = (force / law.kn) ** (2.0 / 3.0)
            found[c, HEIGHT] = height_of(heights, k, race, psi, films.turned, pressed - found[c, HEIGHT_NOW])
            past = (4.0 * found[c, HEIGHT_NOW] - found[c, HEIGHT_BEFORE]) / 3.0
            found[c, HEIGHT_RATE] = gain * (found[c, HEIGHT] - past)


@jit_exact_node
def full_film(given, u):
    """Force of a full film at approach `u`, heights left out, and its slopes, from the `given` entries."""
    return given[FILM_FORCE] + given[FILM_SLOPE] * (u - given[FILM_APPROACH]), given[FILM_SLOPE], 0.0


@jit_exact_loop
def keep_heights(balls, films):
    """Move the heights to the end of the step."""
    if balls.heights.shape[0] == 0:
        return
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
