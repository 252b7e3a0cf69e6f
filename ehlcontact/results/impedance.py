"""Stiffness and damping of a contact over frequency."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.origin import Origin
from ehlcontact.results.layout import Layout, Tabled
from ehlcontact.results.si import ImpedanceSI
from ehlcontact.summary import Summary, contact_text, span

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ImpedanceResult(Summary, Tabled, Origin):
    """Stiffness and damping of a contact over frequency, dimensionless; ``si`` has it in SI.

    Attributes
    ----------
    Omega : ndarray, shape (k,)
        Angular frequency, per unit 2a/u_sum of time.
    stiffness, damping : ndarray, shape (k,)
        K(Omega) = Re Z in f0/delta_H, and C(Omega) = Im Z/Omega, its limit at Omega = 0, in that times 2a/u_sum.
    residual : ndarray, shape (k,)
        Relative residual of the linear system.
    approach, h_central, h_min : float
        Of the steady state, over the dry approach: mutual approach, film at X = Y = 0, smallest film.
    moment : float
        Of the steady pressure about the centre line, over load times a: `SteadyResult.moment`.
    point, scales, domain, n, seconds, version
        As in every result: `ehlcontact.origin.Origin`.
    """

    Omega: Array
    stiffness: Array
    damping: Array
    residual: Array
    approach: float
    h_central: float
    h_min: float
    moment: float

    LAYOUT: ClassVar[Layout] = Layout(
        rows="Omega",
        panels=("stiffness", "damping"),
        quantities={
            "Omega": ("u_sum/(2a)", "Omega"),
            "stiffness": ("f0/delta_H", "Omega"),
            "damping": ("f0/delta_H 2a/u_sum", "Omega"),
            "residual": ("", "Omega"),
            "approach": ("delta_H", ""),
            "h_central": ("delta_H", ""),
            "h_min": ("delta_H", ""),
            "moment": ("f0 a", ""),
        },
        logs="xy",
    )

    @property
    def impedance(self) -> NDArray[np.complex128]:
        """Z(Omega) = K + i Omega C, shape (k,)."""
        return self.stiffness + 1j * self.Omega * self.damping

    @property
    def si(self) -> ImpedanceSI:
        """All of it in SI; raises `InputError` for a dimensionless point, which has no units."""
        return ImpedanceSI.of(self)

    def to_control(self) -> Any:
        """``control.FrequencyResponseData`` from approach to force, over Omega; of `si` over rad/s."""
        import control

        return control.frd(self.impedance, self.Omega, inputs="u", outputs="F", name="contact")

    @property
    def film_origin(self) -> str:
        """How the films were found, in words."""
        return "solved"

    def _summary_lines(self) -> list[str]:
        at = f"{self.Omega.size} frequencies, Omega {span(self.Omega)}"
        if self.scales is None:
            found = [at, f"stiffness K {span(self.stiffness)}", f"damping C {span(self.damping)}"]
        else:
            si = self.si
            found = [f"{at}, {span(si.hz, 1.0, 'Hz')}", f"stiffness K {span(si.stiffness, 1e-6, 'N/µm')}"]
            found.append(f"damping C {span(si.damping, 1.0, 'N s/m')}")
        return [contact_text(self.point, self.scales), *found, f"linearised on n = {self.n}"]

    def summary(self) -> dict[str, Any]:
        """The JSON form of the command line; ``omega`` is ``Omega``, dimensionless, under its name of old.

        Of an SI point ``si`` has frequencies [rad/s] and [Hz], stiffness [N/m] and damping [N s/m].
        """
        return {
            "omega": self.Omega.tolist(),
            "Omega": self.Omega.tolist(),
            "stiffness": self.stiffness.tolist(),
            "damping": self.damping.tolist(),
            "approach": self.approach,
            "moment": self.moment,
            "residual": self.residual.tolist(),
            "seconds": self.seconds,
            "n": self.n,
            "domain": list(self.domain.as_tuple()),
            "point": self.point.to_dict(),
            "version": self.version,
            **({} if self.scales is None else {"si": self.si.summary()}),
        }
