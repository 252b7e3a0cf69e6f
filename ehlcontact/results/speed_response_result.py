"""Force of a contact whose surfaces change their speed, over frequency."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.assumptions.judge import judged
from ehlcontact.origin import Origin
from ehlcontact.quantities import FORCE, FREQUENCY, LENGTH, NUMBER
from ehlcontact.results.steady_result import DOUBTFUL
from ehlcontact.results.table import Display, ScaledTable
from ehlcontact.store import stored
from ehlcontact.summary import contact_text, note_line, span

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@stored("result of speed_response")
@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SpeedResponseResult(ScaledTable, Origin):
    """Force of a contact at fixed approach over a relative change of its speed; ``si`` has it in SI.

    Attributes
    ----------
    Omega : ndarray, shape (k,)
        Angular frequency, per unit 2a/u_sum of time; in SI ``omega`` [rad/s] and ``hz``.
    in_phase, quadrature : ndarray, shape (k,)
        Real and imaginary part of the force over the change of u_sum relative to u_sum, over the static load; in
        SI [N]. A quadrature below zero: the force comes later.
    lift : ndarray, shape (k,)
        Amplitude with which bodies under a constant load, without inertia, move apart for it: the force over the
        impedance, over the dry approach; in SI [m].
    amplitude_error : ndarray, shape (k,)
        How far the force, whatever its phase, may be from that of an endless fine mesh on the same region, over
        the static load; in SI in ``error_bars``, by the names "in_phase" and "quadrature".
    residual : ndarray, shape (k,)
        Relative residual of the linear system.
    approach, h_central, h_min : float
        Of the steady state, over the dry approach; in SI [m].
    point, scales, domain, n, seconds, version
        As in every result: `ehlcontact.origin.Origin`.
    """

    Omega: Annotated[Array, FREQUENCY.over("Omega")]
    in_phase: Annotated[Array, FORCE.over("Omega")]
    quadrature: Annotated[Array, FORCE.over("Omega")]
    lift: Annotated[Array, LENGTH.over("Omega")]
    residual: Annotated[Array, NUMBER.over("Omega")]
    approach: Annotated[float, LENGTH]
    h_central: Annotated[float, LENGTH]
    h_min: Annotated[float, LENGTH]
    amplitude_error: Array

    DISPLAY = Display(rows="Omega", panels=("in_phase quadrature", "lift"), logs="x")

    @property
    def R(self) -> Complex:
        """Force over the relative change of speed, shape (k,), over the static load: with ``exp(i Omega T)``."""
        return np.asarray(self.in_phase + 1j * self.quadrature)

    @property
    def error_bars(self) -> Mapping[str, Array]:
        """Estimated errors by the name of their quantity, in its unit."""
        return dict.fromkeys(("in_phase", "quadrature"), self.amplitude_error)

    @property
    def reservation(self) -> str:
        """What the result leaves open, in words: a large error; else empty."""
        share = self.amplitude_error / np.abs(self.R)
        worst = int(np.argmax(share))
        if share[worst] <= DOUBTFUL:
            return ""
        return f"the force at Omega {self.Omega[worst]:.4g} may be off by {100.0 * share[worst]:.0f} %"

    @property
    def outside_assumptions(self) -> str:
        """Assumptions that do not hold at this contact, in words (`ehlcontact.assumptions`); empty where none."""
        return judged(self).headline

    def _summary_lines(self) -> list[str]:
        si = None if self.scales is None else self.si
        hz = "" if si is None else f", {span(si.hz)} Hz"
        force = span(np.abs(self.R)) if si is None else span(np.hypot(si.in_phase, si.quadrature), 1.0, "N")
        return [
            contact_text(self.point, self.scales),
            f"{self.Omega.size} frequencies, Omega {span(self.Omega)}{hz}; linearised on n = {self.n}",
            f"force over relative change of speed {force}",
            *filter(None, [self.reservation]),
            *note_line(self.outside_assumptions),
        ]

    def to_dict(self) -> dict[str, Any]:
        """Quantities and origin, ready for JSON; of an SI point with ``si``."""
        said = {"reservation": self.reservation, "outside_assumptions": self.outside_assumptions}
        return ScaledTable.to_dict(self) | said | self.origin_dict()
