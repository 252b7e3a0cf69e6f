"""Heights of contacts, looked up by the C core in the tables of `height_tables`."""

from __future__ import annotations

from ctypes import byref, c_double

import numpy as np
from numpy.typing import NDArray

from reduced_models.bearing.core_bearing import bearing_library, heights_structure

_Floats = NDArray[np.float64]

# Tables of heights, shape (1 + tables, rows, semi-axes); without features there are no pages. The first page has
# numbers: in its first row turns of a ball per turn of the shaft, without contact angles, the tables of both
# races, and turns of both rings; then, for every ball, its height where it is larger than the others, and its
# tables at both races; 0 is no table. The others are tables over the angle, with the column over the square root
# of the compression in their last row.
ROTATION, RAISED, TABLE, RING_SPEED = 0, 0, 1, 3


def table_height(heights: _Floats, table: int, angle: float, compression: float) -> float:
    """Height H [m] of one table at an `angle` [rad] of its track and a `compression` d [m]."""
    tables = heights_structure(heights)
    return float(bearing_library().table_height(byref(tables), table, c_double(angle), c_double(compression)))


def contact_height(
    heights: _Floats, ball: int, race: int, psi: float, turned: tuple[float, float], compression: float
) -> float:
    """Height [m] at the contact of a ball, which stands at `psi`, with a race (0: inner).

    `turned` are the angles of the shaft and of the ball about its own axis [rad].
    """
    numbers = (c_double(value) for value in (psi, *turned, compression))
    return float(bearing_library().contact_height(byref(heights_structure(heights)), ball, race, *numbers))
