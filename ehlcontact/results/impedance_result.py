"""Stiffness and damping of a contact over frequency."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.assumptions.judge import judged
from ehlcontact.origin import Origin
from ehlcontact.quantities import DAMPING, FORCE, FREQUENCY, LENGTH, MOMENT, NUMBER, STIFFNESS
from ehlcontact.results.film_temperature import FilmTemperature
from ehlcontact.results.frequency import ScaledResponse
from ehlcontact.results.steady_result import DOUBTFUL
from ehlcontact.solver.error_estimate import ALL
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.mesh_choice import damping_mesh
from ehlcontact.store import stored
from ehlcontact.summary import contact_text, note_line, span
from ehlcontact.supply import OilLayer

Array = NDArray[np.float64]

SLOW = 0.2  # Omega below which oil that heats and cools slowly may add to C
COARSE = 1.1  # mesh over the one that damping needs, from which a result says so


@stored("result of impedance")
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
    stiffness_error, damping_error : ndarray, shape (k,), or None
        How far both may be from those of an endless fine mesh on the same region, in their units; as large as
        they are where nothing is known. Also as ``error_bars``, by the names "stiffness" and "damping"; in
        SI there alone.
    residual : ndarray, shape (k,)
        Relative residual of the linear system.
    approach, h_central, h_min : float
        Of the steady state, over the dry approach: mutual approach, film at X = Y = 0, smallest film; in SI [m].
    moment : float
        Of the steady pressure about the centre line, over load times a: `SteadyResult.moment`; in SI [N m].
    force : float
        Static load: 1; in SI [N].
    supply : OilLayer or None
        As given to `impedance`; None of a flooded inlet.
    temperature : FilmTemperature or None
        Of the steady film, where it was solved with heat.
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
    stiffness_error: Array | None = None
    damping_error: Array | None = None
    supply: OilLayer | None = None
    temperature: FilmTemperature | None = None

    def require_complete(self, **sizes: int) -> None:
        """Raise `ValueError` unless all arrays have one value per frequency."""
        ScaledResponse.require_complete(self, **sizes)
        for name, bar in (self.error_bars or {}).items():
            if np.shape(bar) != self.Omega.shape:
                raise ValueError(f"the error of {name} has the shape {np.shape(bar)}, not {self.Omega.shape}")

    @property
    def error_bars(self) -> Mapping[str, Array] | None:
        """Estimated errors by the name of their quantity, in its unit; None of a result without them."""
        if self.stiffness_error is None or self.damping_error is None:
            return None
        return {"stiffness": self.stiffness_error, "damping": self.damping_error}

    @property
    def reservation(self) -> str:
        """What the result leaves open, in words: a mesh coarser than damping needs, a large error; else empty."""
        mesh, needed, found = Mesh(self.n, self.domain, self.point.kappa), damping_mesh(self.point), []
        if mesh.size > COARSE * needed:
            apart = f"nodes are {mesh.size:.2g} semi-axes apart, damping needs {needed:.2g}"
            found.append(f"the grid is too coarse: {apart}")
        if self.damping_error is not None:
            share = self._share("damping")
            worst = int(np.argmax(share))
            if share[worst] > DOUBTFUL:
                bar = "anything" if share[worst] >= ALL else f"{100.0 * share[worst]:.0f} %"
                heated = self.temperature is not None and self.supply is None  # a front is slow by itself
                slow = not found and heated and self.Omega[worst] < SLOW
                advice = " (perhaps by slow oil ahead of the contact: compare another n)" if slow else ""
                found.append(f"C may be off by {bar} at {self._frequency(worst)}{advice}")
        return "; ".join(found)

    def _share(self, name: str) -> Array:
        """Error of a quantity over it, shape (k,)."""
        return np.asarray((self.error_bars or {})[name] / np.abs(getattr(self, name)))

    def _frequency(self, k: int) -> str:
        return f"Omega {self.Omega[k]:.4g}" if self.scales is None else f"{self.si.hz[k]:.4g} Hz"

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
        si = None if self.scales is None else self.si
        hz, K, C = ("", self.stiffness, self.damping) if si is None else (si.hz, si.stiffness * 1e-6, si.damping)
        units = ("", "") if si is None else (" N/µm", " N s/m")
        at = f"{self.Omega.size} frequencies, Omega {span(self.Omega)}{'' if si is None else f', {span(hz)} Hz'}"
        found = [f"stiffness K {span(K)}{units[0]}", f"damping C {span(C)}{units[1]}"]
        if self.error_bars is not None:
            shares = (100.0 * self._share(name) for name in ("stiffness", "damping"))
            found = [f"{text} (± {span(np.round(share, 2))} %)" for text, share in zip(found, shares, strict=True)]
        return [
            contact_text(self.point, self.scales),
            f"{at}; linearised on n = {self.n}",
            ", ".join(found),
            *([] if self.temperature is None else [self.temperature.summary]),
            *filter(None, [self.reservation]),
            *note_line(self.outside_assumptions),
        ]

    def to_dict(self) -> dict[str, Any]:
        """Quantities and origin, ready for JSON; of an SI point with ``si``."""
        said: dict[str, Any] = {"reservation": self.reservation, "outside_assumptions": self.outside_assumptions}
        if self.temperature is not None:
            said |= {"temperature": self.temperature.to_dict()}
        return ScaledResponse.to_dict(self) | said | self.origin_dict()
