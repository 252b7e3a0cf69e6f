"""Stiffness and damping of a contact over frequency."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.assumptions.judge import judged
from ehlcontact.origin import Origin
from ehlcontact.quantities import DAMPING, FORCE, FREQUENCY, LENGTH, MOMENT, NUMBER, STIFFNESS
from ehlcontact.results.frequency import ScaledResponse
from ehlcontact.summary import contact_text, note_line, span

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ImpedanceResult(ScaledResponse, Origin):
    """Stiffness and damping of a contact over frequency, dimensionless; ``si`` has it in SI.

    Attributes
    ----------
    Omega : ndarray, shape (k,)
        Angular frequency, per unit 2a/u_sum of time; in SI ``omega`` [rad/s] and ``hz``.
    stiffness, damping : ndarray, shape (k,)
        K(Omega) = Re Z in f0/delta_H, and C(Omega) = Im Z/Omega, its limit at Omega = 0, in that times 2a/u_sum;
        in SI [N/m] and [N s/m].
    residual : ndarray, shape (k,)
        Relative residual of the linear system.
    approach, h_central, h_min : float
        Of the steady state, over the dry approach: mutual approach, film at X = Y = 0, smallest film; in SI [m].
    moment : float
        Of the steady pressure about the centre line, over load times a: `SteadyResult.moment`; in SI [N m].
    force : float
        Static load: 1; in SI [N].
    point, scales, domain, n, seconds, version
        As in every result: `ehlcontact.origin.Origin`.
    """

    Omega: Annotated[Array, FREQUENCY.over("Omega")]
    stiffness: Annotated[Array, STIFFNESS.over("Omega")]
    damping: Annotated[Array, DAMPING.over("Omega")]
    residual: Annotated[Array, NUMBER.over("Omega")]
    approach: Annotated[float, LENGTH]
    h_central: Annotated[float, LENGTH]
    h_min: Annotated[float, LENGTH]
    moment: Annotated[float, MOMENT]

    @property
    def force(self) -> Annotated[float, FORCE.in_si_only()]:
        """Static load: 1."""
        return 1.0

    @property
    def film_origin(self) -> str:
        """How the films were found, in words."""
        return "solved"

    @property
    def outside_assumptions(self) -> str:
        """Assumptions that do not hold at this contact, in words (`ehlcontact.assumptions`); empty where none."""
        return judged(self).headline

    def _summary_lines(self) -> list[str]:
        at = f"{self.Omega.size} frequencies, Omega {span(self.Omega)}"
        if self.scales is None:
            found = [at, f"stiffness K {span(self.stiffness)}, damping C {span(self.damping)}"]
        else:
            si = self.si
            found = [f"{at}, {span(si.hz, 1.0, 'Hz')}", f"stiffness K {span(si.stiffness, 1e-6, 'N/µm')}"]
            found[-1] += f", damping C {span(si.damping, 1.0, 'N s/m')}"
        found += [f"linearised on n = {self.n}", *note_line(self.outside_assumptions)]
        return [contact_text(self.point, self.scales), *found]

    def to_dict(self) -> dict[str, Any]:
        """Quantities and origin, ready for JSON; of an SI point with ``si``."""
        said = {"outside_assumptions": self.outside_assumptions}
        return ScaledResponse.to_dict(self) | said | self.origin_dict()
