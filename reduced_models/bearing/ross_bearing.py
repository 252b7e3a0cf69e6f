"""Export to ROSS, https://ross.readthedocs.io, 2.3 to 3.1: bearings as elements of a ROSS rotor.

Both have SI units, x and y across the shaft, y upwards, and a rotor that turns from x to y; ROSS has speeds in
rad/s. It is imported where it is needed: that takes seconds.

An element of ROSS 2 has tables over `frequency`, which is the speed of the shaft. In ROSS 3 `speed` is the speed
of the shaft and `frequency` that of the whirl (the vibration); tables are over either or both. An analysis of
ROSS 3 that is given no frequency takes both as equal, the only case of ROSS 2.

Matrices of both are 3 x 3 at a node: x and y with their coupling, and z alone. Stiffness and damping against
tilts, and the coupling of x and y with z and with tilts, have no place in them and are left out;
`reduced_models.rotor.ross_rotor` has all of it.

Beyond the ends of a table ROSS extrapolates: damping that falls with the speed gets far below zero there. Elements
made here hold the values of the ends instead, as `LinearBearing` does, and warn once (`HeldTable`). Read from a
file of ROSS, an element has only its table, and is extrapolated again.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from inspect import signature
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, require_integer
from ehlcontact.checks.frequency import is_given, radians_per_second
from ehlcontact.errors import InputError, warn_user
from reduced_models.bearing.freedoms import PLANAR, bearing_load
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.solved_balls import warn_of_damping_left_out
from reduced_models.elements.validity import OutsideValidityWarning

_Floats = NDArray[np.float64]

ROUNDING = 1e-12  # of the end of a table: a unit of speed that was converted
ELEMENT = ("xx", "xy", "yx", "yy", "zz")  # places of an element

# Whirl frequencies of tables [rad/s] unless others are given: 0, and 1 Hz to 10 kHz in 40 equal ratios. Between
# them the cubics of ROSS 3 meet damping within 1.6 % (6205, 6305; ISO VG 32 to 220; 60 to 12 000 rev/min).
WHIRL = 2.0 * np.pi * np.append(0.0, np.geomspace(1.0, 1e4, 41))


def import_ross() -> Any:
    """The module `ross`; raises `InputError` with what to install where it is not there."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a package that it brings misses another one
            import ross
    except (ImportError, ValueError) as error:  # the second: ROSS 2.3.0 beside plotly 7
        raise InputError("ross", None, f"installed: pip install 'ehlcontact[ross]' ({error})") from None
    return ross


def has_whirl_axis(ross: Any) -> bool:
    """Whether tables of this ROSS have an axis of whirl frequency beside that of speed: from 3 on."""
    return "speed" in signature(ross.BearingElement).parameters


def name_of(frequency: Mapping[str, ArrayLike | None]) -> str:
    """Name of the frequency that is given."""
    return next(name for name, value in frequency.items() if value is not None)


def downward(load: ArrayLike) -> _Floats:
    """The load as 2, 3 or 5 components; a number is a weight, in -y, as ROSS has loads along y."""
    return bearing_load(
        (0.0, -float(load)) if isinstance(load, int | float) and not isinstance(load, bool) else load
    )


class TableRange:
    """Axes of a table, by their names in ROSS, and the warning of analyses beyond their ends.

    Parameters
    ----------
    axes : mapping of str to ndarray
        "speed" or "frequency" to increasing values [rad/s].
    rotation : str
        Name of the axis of the speed of the shaft.
    name : str
        Of the bearing.
    """

    def __init__(self, axes: Mapping[str, _Floats], rotation: str, name: str) -> None:
        self._ends = {axis: (float(values[0]), float(values[-1])) for axis, values in axes.items()}
        self._rotation, self._name = rotation, name
        self._warned = False

    def held(self, places: Mapping[str, Any]) -> dict[str, Any]:
        """Places [rad/s] on the axes, those beyond the ends moved to them; warns of the first."""
        known = next(place for place in places.values() if place is not None)  # one place: whirl and speed alike
        asked = {axis: known if places.get(axis) is None else places[axis] for axis in self._ends}
        inside = {axis: np.clip(place, *self._ends[axis]) for axis, place in asked.items()}
        beyond = [
            axis for axis, place in inside.items() if not np.allclose(place, asked[axis], rtol=ROUNDING, atol=0.0)
        ]
        if beyond and not self._warned:
            self._warned = True
            warn_user(f"{self._name}: {self._words(beyond[0])}", OutsideValidityWarning)
        return {name: place for name, place in places.items() if place is not None} | inside

    def _words(self, axis: str) -> str:
        speeds = axis == self._rotation
        unit, words = (RPM_TO_RAD_S, "rev/min") if speeds else (2.0 * np.pi, "Hz of the whirl")
        low, high = (end / unit for end in self._ends[axis])
        return (
            f"an analysis goes beyond its table, {low:.5g} to {high:.5g} {words}: coefficients there are those of "
            f"the ends; a table with more {'speeds (speeds_rpm)' if speeds else 'frequencies (hz)'} has them"
        )


class HeldTable:
    """Interpolation of one coefficient by ROSS, called as there, with values held at the ends of its table."""

    def __init__(self, table: Any, covered: TableRange) -> None:
        self.table, self.covered = table, covered

    def __call__(self, frequency: Any = None, speed: Any = None) -> Any:
        """Coefficients at whirl frequencies and speeds [rad/s]."""
        if frequency is None and speed is None:
            return self.table()
        held = self.covered.held({"frequency": frequency, "speed": speed})
        return self.table(*(held[axis] for axis in ("frequency", "speed") if axis in held))

    def __getattr__(self, name: str) -> Any:
        """Whatever else ROSS asks of its own interpolation."""
        if name in ("table", "covered"):  # of a copy that has none yet
            raise AttributeError(name)
        return getattr(self.table, name)


def hold_ends(element: Any, axes: Mapping[str, _Floats], rotation: str, name: str) -> None:
    """Let all coefficients of an element of ROSS with a table hold their values beyond its axes."""
    covered = TableRange(axes, rotation, name)
    for attribute, table in list(vars(element).items()):
        if axes and attribute.endswith("_interpolated"):
            setattr(element, attribute, HeldTable(table, covered))


def bearing_element(
    bearing: Any,
    node: int,
    speeds_rpm: ArrayLike,
    load: ArrayLike,
    frequency: Mapping[str, ArrayLike | None],
    **options: Any,
) -> Any:
    """Element of ROSS with the coefficients of a `BallBearing` or a `BearingSet`: see their method `to_ross`."""
    ross = import_ross()
    known = set(signature(ross.BearingElement).parameters)
    for name, value in options.items():
        if name not in known:  # ROSS would swallow it
            allowed = "an option of ross.BearingElement; an axial load is the third number of load"
            raise InputError(name, value, allowed)
    n = require_integer("node", node, "a node of the rotor, a whole number >= 0", 0)
    speeds = as_column("speeds_rpm", np.atleast_1d(np.asarray(speeds_rpm, float)), increasing=True)
    whirl = WHIRL if has_whirl_axis(ross) else None  # None: the frequency of the shaft at each speed
    if is_given(**frequency):
        whirl = radians_per_second(None, **frequency)
        name = name_of(frequency)
        as_column(name, np.atleast_1d(np.asarray(frequency[name], float)), increasing=True)
        if whirl.size > 1 and not has_whirl_axis(ross):
            raise InputError(name, f"{whirl.size} numbers", "a single frequency: tables of ROSS 2 have one axis")
    own = bearing.name or ("set of bearings" if hasattr(bearing, "bearings") else "ball bearing")
    rows = []
    for rpm in speeds.tolist():
        there = bearing.dry if rpm == 0.0 else bearing
        omega = rpm * RPM_TO_RAD_S if whirl is None else whirl
        rows.append(there.coefficients(downward(load), speed_rpm=rpm, omega=omega))
    for row in reversed(rows):  # the faster, the higher these frequencies
        warn_of_damping_left_out(getattr(bearing, "bearings", (bearing,))[0], own, row.damping_left_out)
    K, C = (np.array([getattr(row, name) for row in rows]) for name in ("stiffness", "damping"))
    rotation = "speed" if has_whirl_axis(ross) else "frequency"
    axes = {rotation: speeds * RPM_TO_RAD_S} if speeds.size > 1 else {}
    if whirl is not None and whirl.size > 1:
        axes["frequency"] = whirl
    element = ross.BearingElement(n=n, **(ross_entries(K, C) | axes | options))
    hold_ends(element, axes, rotation, f"{own} at node {n}")
    return element


def ross_entries(K: _Floats, C: _Floats) -> dict[str, Any]:
    """Coefficients as ROSS calls them, from shape (..., n, n): without axes of one value, else numbers.

    ROSS has places for x and y with their coupling and for z alone, none for tilts.
    """
    entries = {}
    for name, matrices in (("k", K), ("c", C)):
        for place in ELEMENT if K.shape[-1] > len(PLANAR) else ELEMENT[:-1]:
            values = np.squeeze(matrices[..., "xyz".index(place[0]), "xyz".index(place[1])]) + 0.0  # no -0
            entries[f"{name}{place}"] = values if values.ndim else float(values)
    return entries
