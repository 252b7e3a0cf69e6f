"""Force of waves on a surface over frequency."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.assumptions.judge import judged
from ehlcontact.origin import Origin
from ehlcontact.quantities import ALONG, FREQUENCY, LENGTH, NUMBER, STIFFNESS
from ehlcontact.results.steady_result import DOUBTFUL
from ehlcontact.results.table import Display, ScaledTable
from ehlcontact.store import stored
from ehlcontact.summary import contact_text, note_line, span

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@stored("result of excitation")
@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ExcitationResult(ScaledTable, Origin):
    """Force of a contact at fixed approach by waves that pass on a surface; ``si`` has it in SI.

    Attributes
    ----------
    Omega : ndarray, shape (k,)
        Angular frequency, per unit 2a/u_sum of time; in SI ``omega`` [rad/s] and ``hz``.
    wavelength : ndarray, shape (k,)
        Along rolling, in semi-axes a: ``2 pi speed/Omega``; in SI [m].
    in_phase, quadrature : ndarray, shape (k,)
        Real and imaginary part of G(Omega), the force over the height of the waves at X = 0, positive out of the
        surface, in f0/delta_H; in SI [N/m].
    contact_filter : ndarray, shape (k,)
        ``|G/Z|`` with the impedance Z at the same frequency: share of the height that acts like an approach.
    amplitude_error : ndarray, shape (k,)
        How far G, whatever its phase, may be from that of an endless fine mesh on the same region, in f0/delta_H;
        in SI in ``error_bars``, which has it by the names "in_phase", "quadrature", "amplitude" and, over ``|Z|``,
        "contact_filter".
    residual : ndarray, shape (k,)
        Relative residual of the linear system.
    approach, h_central, h_min : float
        Of the steady state, over the dry approach; in SI [m].
    speed : float
        dX/dT of the surface: 1 in pure rolling.
    point, scales, domain, n, seconds, version
        As in every result: `ehlcontact.origin.Origin`.
    """

    Omega: Annotated[Array, FREQUENCY.over("Omega")]
    wavelength: Annotated[Array, ALONG.over("Omega")]
    in_phase: Annotated[Array, STIFFNESS.over("Omega")]
    quadrature: Annotated[Array, STIFFNESS.over("Omega")]
    contact_filter: Annotated[Array, NUMBER.over("Omega")]
    residual: Annotated[Array, NUMBER.over("Omega")]
    approach: Annotated[float, LENGTH]
    h_central: Annotated[float, LENGTH]
    h_min: Annotated[float, LENGTH]
    speed: float
    amplitude_error: Array

    DISPLAY = Display(rows="Omega", panels=("amplitude", "in_phase quadrature"), logs="x")

    @property
    def G(self) -> Complex:
        """Force over height, shape (k,), in f0/delta_H: with ``exp(i Omega T)`` and the wave's summit at X = 0."""
        return np.asarray(self.in_phase + 1j * self.quadrature)

    @property
    def amplitude(self) -> Annotated[Array, STIFFNESS.over("Omega")]:
        """``|G|``, shape (k,): amplitude of the force over that of the waves."""
        return np.abs(self.G)

    @property
    def error_bars(self) -> Mapping[str, Array]:
        """Estimated errors by the name of their quantity, in its unit."""
        with np.errstate(divide="ignore", invalid="ignore"):
            of_filter = self.amplitude_error * (self.contact_filter / self.amplitude)
        return dict.fromkeys(("in_phase", "quadrature", "amplitude"), self.amplitude_error) | {
            "contact_filter": of_filter
        }

    @property
    def reservation(self) -> str:
        """What the result leaves open, in words: a large error; else empty."""
        bar = self.error_bars["contact_filter"]
        worst = int(np.argmax(bar))
        if bar[worst] <= DOUBTFUL:
            return ""
        wave = f"waves of {self.wavelength[worst]:.3g} semi-axes a (Omega {self.Omega[worst]:.4g})"
        return f"the force of {wave} may be off by {100.0 * bar[worst]:.0f} % of height times |Z|"

    @property
    def outside_assumptions(self) -> str:
        """Assumptions that do not hold at this contact, in words (`ehlcontact.assumptions`); empty where none."""
        return judged(self).headline

    def _summary_lines(self) -> list[str]:
        si = None if self.scales is None else self.si
        hz = "" if si is None else f", {span(si.hz)} Hz"
        waves = f"{self.Omega.size} waves of {span(self.wavelength)} a, Omega {span(self.Omega)}{hz}"
        force = span(self.amplitude) if si is None else f"{span(si.amplitude * 1e-6)} N/µm"
        return [
            contact_text(self.point, self.scales),
            f"{waves}; linearised on n = {self.n}",
            f"force over height |G| {force}, contact filter |G/Z| {span(self.contact_filter)}",
            *filter(None, [self.reservation]),
            *note_line(self.outside_assumptions),
        ]

    def to_dict(self) -> dict[str, Any]:
        """Quantities and origin, ready for JSON; of an SI point with ``si``."""
        said = {"reservation": self.reservation, "outside_assumptions": self.outside_assumptions}
        return ScaledTable.to_dict(self) | {"speed": self.speed} | said | self.origin_dict()
