"""Stiffness and damping over frequency: impedance and python-control system of any such result."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.results.table import Display, QuantityTable

Array = NDArray[np.float64]


class FrequencyResponse(QuantityTable):
    """Base of results with ``stiffness`` K and ``damping`` C over angular frequency, shape (k,) or (k, n, n)."""

    __slots__ = ()
    stiffness: Array
    damping: Array
    DISPLAY = Display(rows="Omega", panels=("stiffness", "damping"), logs="xy")

    @property
    def impedance(self) -> NDArray[np.complex128]:
        """Z = K + i w C in the shape and unit of K, w in rad/s or dimensionless as C."""
        w = self._angular_frequency()
        return np.asarray(self.stiffness + 1j * w.reshape(-1, *(1,) * (self.stiffness.ndim - 1)) * self.damping)

    def to_control(self) -> Any:
        """``control.FrequencyResponseData`` over w: ``u`` to ``F``, or ``u_x, u_y, ...`` to ``F_x, F_y, ...``."""
        import control

        Z, w = np.moveaxis(self.impedance, 0, -1), self._angular_frequency()
        axes = self._display().labels.get("axis", ())
        inputs, outputs = ("u", "F") if Z.ndim == 1 else ([f"u_{x}" for x in axes], [f"F_{x}" for x in axes])
        return control.frd(Z, w, inputs=inputs, outputs=outputs, name="contact")

    def _angular_frequency(self) -> Array:
        w: Array = getattr(self, "omega" if self._in_si() else "Omega")
        return w
