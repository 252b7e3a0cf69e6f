"""`LinearBearing`: a bearing as stiffness and damping matrices, constant or tabulated over shaft speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import as_column, as_numbers, parts
from ehlcontact.checks.kinds import NAME
from ehlcontact.checks.quantity import fields_take
from ehlcontact.errors import InputError
from ehlcontact.summary import Summary, counted
from reduced_models.bearing.freedoms import FIVE, PLANAR

_Floats = NDArray[np.float64]


@fields_take(speeds_rpm=parts.SPEEDS, name=NAME)
@dataclass(frozen=True, eq=False)
class LinearBearing(Summary):
    """A bearing given by its stiffness and damping, constant or tabulated over the speed of the shaft.

    Parameters
    ----------
    stiffness, damping : array_like, shape (n, n) or (k, n, n)
        In the order x, y, and with n = 5 z, tilt_x, tilt_y: [N/m], [N s/m], and with tilts N m for N, rad for m.
    speeds_rpm : array_like, shape (k,), optional
        Increasing speeds [rev/min] of a table: straight lines between them, its ends beyond them.
    name : str

    Raises
    ------
    InputError
        Matrices that are not 2 by 2 or 5 by 5, or not one for each speed.
    """

    stiffness: Any
    damping: Any
    speeds_rpm: Any = None
    name: str = ""

    def __post_init__(self) -> None:
        speeds = None if self.speeds_rpm is None else as_column("speeds_rpm", self.speeds_rpm, increasing=True)
        first = np.shape(as_numbers("stiffness", self.stiffness))
        size = len(FIVE) if first[-1:] == (len(FIVE),) else len(PLANAR)
        shape = (size, size) if speeds is None else (speeds.size, size, size)
        object.__setattr__(self, "speeds_rpm", speeds)
        for name in ("stiffness", "damping"):
            matrices = as_numbers(name, getattr(self, name))
            if matrices.shape != shape or not np.isfinite(matrices).all():
                raise InputError(name, getattr(self, name), f"finite, of shape {shape}")
            matrices.setflags(write=False)
            object.__setattr__(self, name, matrices)

    def _summary_lines(self) -> list[str]:
        table = "constant" if self.speeds_rpm is None else f"at {counted(self.speeds_rpm.size, 'speed')}"
        return [f"{self.name or 'linear bearing'}, stiffness and damping {table}"]

    def at(self, speed_rpm: float | _Floats) -> tuple[_Floats, _Floats]:
        """Stiffness and damping at speeds [rev/min], shape (n, n) or one for each."""
        speed_rpm = as_numbers("speed_rpm", speed_rpm)
        if self.speeds_rpm is None:
            return self.stiffness, self.damping
        n = self.stiffness.shape[-1]
        K, C = (
            np.stack(
                [np.interp(speed_rpm, self.speeds_rpm, entries) for entries in table.reshape(-1, n * n).T], -1
            )
            for table in (self.stiffness, self.damping)
        )
        return K.reshape(*np.shape(speed_rpm), n, n), C.reshape(*np.shape(speed_rpm), n, n)
