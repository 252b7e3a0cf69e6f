"""Degrees of freedom of a bearing's inner ring: names, units, loads.

A load has as many components as degrees of freedom that it moves:

| load | moves | held |
|---|---|---|
| (Fx, Fy) | x, y | axial motion and tilts: the planar bearing |
| (Fx, Fy, Fz) | x, y, z | tilts, at 0 or at given angles |
| (Fx, Fy, Fz, Mx, My) | all five | |

z is along the shaft. Tilts are small rotations about x and y; displacements and moments are those of the point of
the ring's axis in the plane of its groove centres.

A bearing on a shaft has a facing, "+z" or "-z": the direction in which its inner ring is pressed against the outer
one. "-z" is the mirror image in the plane across the shaft; the sense of rotation stays.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, require_choice, require_finite
from ehlcontact.errors import InputError
from ehlcontact.quantities import Quantity
from ehlcontact.results.table import Display

_Floats = NDArray[np.float64]

PLANAR = ("x", "y")
FIVE = ("x", "y", "z", "tilt_x", "tilt_y")
MOVING = (PLANAR, FIVE[:3], FIVE)  # directions in which a ring moves; in the others it is held
FACINGS = ("+z", "-z")
# Units of matrices and columns over all five: of the first three entries, and with tilts
MIXED = {"N": "N, N m", "m": "m, rad", "N/m": "N/m, N, N m", "N s/m": "N s/m, N s, N m s", "rad": "rad"}
FARTHEST_OFFSET = 0.1  # of a ball diameter, of a ring along the shaft: grooves end before
LARGEST_TILT = 0.1  # rad, of a ring: fifty times what a deep-groove bearing bears
DECIMALS = 6  # decimal places beyond which N, N m, µm, nm, mrad and spin-to-roll ratios are rounding


def directions_of(given: Sequence[str] | None, angular: bool) -> tuple[str, ...]:
    """Directions in which a ring moves: those `given`, else all of an angular contact bearing, x and y of others.

    Raises
    ------
    InputError
        Others than the first 2, 3 or 5 of `FIVE`.
    """
    if given is None:
        return FIVE if angular else PLANAR
    found = tuple(given) if isinstance(given, tuple | list) else ()
    if found not in MOVING:
        raise InputError("directions", given, '("x", "y"), ("x", "y", "z") or ("x", "y", "z", "tilt_x", "tilt_y")')
    return found


def bearing_load(load: ArrayLike) -> _Floats:
    """Load on the inner ring, shape (2,), (3,) or (5,); raises `InputError` for any other."""
    size = np.size(load) if isinstance(load, tuple | list | np.ndarray) else 0
    if size not in (2, 3, 5):
        raise InputError("load", load, "(Fx, Fy), (Fx, Fy, Fz) or (Fx, Fy, Fz, Mx, My) [N], [N m]")
    return as_column("load", load, size=size)


def held_tilt(tilt: ArrayLike | None, size: int) -> _Floats:
    """Tilts (about x, about y) [rad] at which the ring is held under a load of `size` components.

    Raises
    ------
    InputError
        Tilts where the load does not hold them, or in degrees.
    """
    if tilt is None:
        return np.zeros(2)
    if size != 3:
        raise InputError("tilt", tilt, "left out unless the load is (Fx, Fy, Fz)")
    found = as_column("tilt", tilt, size=2)
    if np.abs(found).max() > LARGEST_TILT:
        raise InputError("tilt", found.tolist(), f"between {-LARGEST_TILT:g} and {LARGEST_TILT:g} rad")
    return found


def facing_signs(facing: str) -> _Floats:
    """Signs, shape (5,), of displacements and loads between the frame of the shaft and that of a bearing.

    Raises
    ------
    InputError
        A facing other than "+z" and "-z".
    """
    require_choice("facing", facing, FACINGS)
    axial = 1.0 if facing == FACINGS[0] else -1.0
    return np.array([1.0, 1.0, axial, axial, axial])


def require_offset(name: str, offset: float, ball_diameter: float) -> None:
    """Raise `InputError` for a displacement [m] that takes the ring of a bearing out of its grooves."""
    most = FARTHEST_OFFSET * ball_diameter
    if not abs(require_finite(name, offset)) <= most:
        guess = f" (in µm? then {1e-6 * offset:g} m)" if 0.1 <= abs(offset) <= 1e6 * most else ""
        raise InputError(name, offset, f"between {-most:.3g} and {most:.3g} m{guess}")


def in_freedoms(declared: Mapping[str, Quantity], size: int) -> Mapping[str, Quantity]:
    """Quantities of a result over `size` degrees of freedom, those over all five with their mixed units."""
    if size == len(PLANAR):
        return declared
    return {
        name: replace(one, unit=MIXED[one.unit]) if "axis" in one.dims else one for name, one in declared.items()
    }


def labelled(display: Display, size: int) -> Display:
    """Rows and panels with the names of `size` degrees of freedom."""
    names = PLANAR if size == len(PLANAR) else FIVE
    return replace(display, labels={**display.labels, "axis": names, "by": names})


def load_words(load: _Floats) -> str:
    """A load in words, for summaries."""
    moments = _listed(load[3:])
    return f"({_listed(load[:3])}) N" + (f" and ({moments}) N m" if moments else "")


def place_words(displacement: _Floats) -> str:
    """Likewise where it has displaced a ring or a shaft, without tilts."""
    return f"({_listed(1e6 * displacement[:3])}) µm"


def _listed(values: _Floats) -> str:
    return ", ".join(f"{round(one, DECIMALS) + 0.0:.4g}" for one in values.tolist())  # no "-0"
