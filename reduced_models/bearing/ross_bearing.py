"""Bearings as elements of ROSS, https://ross.readthedocs.io, from 2.3.0 on.

Both have SI units, x and y across the shaft, y upwards, and a rotor that turns from x to y; ROSS has speeds in
rad/s. It is imported where it is needed: that takes seconds.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, require_integer
from ehlcontact.checks.frequency import is_given, one, radians_per_second
from ehlcontact.errors import InputError
from reduced_models.bearing.kinematics import RADIANS

_Floats = NDArray[np.float64]


def import_ross() -> Any:
    """The module `ross`; raises `InputError` with what to install where it is not there."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a package that it brings misses another one
            import ross
    except (ImportError, ValueError) as error:  # the second: ROSS 2.3.0 beside plotly 7
        raise InputError("ross", None, f"installed: pip install 'ehlcontact[ross]' ({error})") from None
    return ross


def downward(load: ArrayLike) -> ArrayLike:
    """The load as a pair; a number is a weight, in -y, as ROSS has loads along y."""
    return (0.0, -float(load)) if isinstance(load, int | float) and not isinstance(load, bool) else load


def bearing_element(
    bearing: Any,
    node: int,
    speeds_rpm: ArrayLike,
    load: ArrayLike,
    frequency: Mapping[str, ArrayLike | None],
    **options: Any,
) -> Any:
    """Element of ROSS with the coefficients of a `BallBearing`: see its method `to_ross`."""
    ross = import_ross()
    n = require_integer("node", node, "a node of the rotor, a whole number >= 0", 0)
    speeds = as_column("speeds_rpm", np.atleast_1d(np.asarray(speeds_rpm, float)), increasing=True)
    fixed = one("frequency", radians_per_second(None, **frequency)) if is_given(**frequency) else None
    found = [
        bearing.coefficients(downward(load), speed_rpm=rpm, omega=rpm * RADIANS if fixed is None else fixed)
        for rpm in speeds.tolist()
    ]
    K, C = (np.array([getattr(at, name)[0] for at in found]) for name in ("stiffness", "damping"))
    return ross.BearingElement(n=n, **ross_entries(K, C), **_table(speeds), **options)


def ross_entries(K: _Floats, C: _Floats) -> dict[str, Any]:
    """Coefficients as ROSS calls them; numbers where there is one speed."""
    entries = {}
    for name, matrices in (("k", K), ("c", C)):
        for i, row in enumerate("xy"):
            for j, column in enumerate("xy"):
                values = matrices[:, i, j] + 0.0  # no -0
                entries[f"{name}{row}{column}"] = values if len(values) > 1 else float(values[0])
    return entries


def _table(speeds: _Floats) -> dict[str, Any]:
    return {"frequency": speeds * RADIANS} if speeds.size > 1 else {}
