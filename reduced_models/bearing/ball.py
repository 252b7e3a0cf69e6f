"""A bearing as balls between two races: tables, grooves and inertia, as the C core takes them (`core_bearing`).

The ring has the displacement q = (x, y, z, tilt about x, tilt about y) of the point of its axis in the plane of
its groove centres; tilts are small. At the ball at psi it moves the inner groove centre (`contact_angles`) to

    c_r = c_r0 + x cos psi + y sin psi
    c_z = c_z0 + z + groove_circle (tilt_x sin psi - tilt_y cos psi).

Contacts have their film memory (``race_contact.c``). With the inner groove centre at c, moving at c', and the ball
at b,

    u_i = |c - b| - inner,    u_i' = n_i . (c' - b'),    u_o = |b| - outer,    u_o' = n_o . b',

the ball goes where the forces R of both contacts, centrifugal force, gyroscopic moment and, of a ball with inertia
m towards the rings, m b'' balance: two unknowns b, by Newton's method (``ball.c``). In a step b' follows from the
places of the last steps, and b'' from its rates (BDF 2). Without m that leaves out the vibration of a ball on its
two contacts (30 to 40 kHz for a 6205). At rest, with a gain of 0 from places to rates, the balance is the static
law.

Films follow the angles of their ball, their thickness over that of the table and their time scale. At rest they
are those of the place; in a step, where they change slowly, they are extrapolated from the last two steps.
Centrifugal force and gyroscopic moment are those of the place; their derivatives, of little weight in the
tangents, are renewed after some steps, and at rest, those of the films with them, at every place. Balls stand in
one cage, which turns at the mean of the speeds at which they would roll alone, by their loads.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from reduced_models.bearing.contact_angles import Grooves
from reduced_models.bearing.loss import Loss
from reduced_models.bearing.race_table import RaceForceTable

_Floats = NDArray[np.float64]


class Balls(NamedTuple):
    """A bearing at one speed, or in time at a range of them."""

    inner: RaceForceTable
    outer: RaceForceTable
    number: int
    grooves: Grooves
    omega: float  # of the shaft [rad/s], at rest: the first of `speeds`
    speeds: _Floats  # (rows of the tables,) of the shaft, increasing [rad/s]
    loss: Loss  # of rings and fits
    inertia: float  # of a ball towards the rings [kg]; 0: it has none
    heights: _Floats  # tables of features, see `height_tables`
