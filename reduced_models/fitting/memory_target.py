"""What a film memory is fitted to: an impedance and records, checked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from reduced_models.elements.film_curve import LEAST_EXPONENT
from reduced_models.fitting.records import ContactRecord

_Floats = NDArray[np.float64]

FOLDS = 3
LOWEST = 0.1  # a frequency up to here is needed: it gives the static tangent and the damping of rotors


class Response(Protocol):
    """What is asked of an impedance; `ehlcontact.impedance` returns one."""

    @property
    def omega(self) -> _Floats:
        """Frequencies, shape (k,)."""

    @property
    def stiffness(self) -> _Floats:
        """K(Omega)."""

    @property
    def damping(self) -> _Floats:
        """C(Omega)."""

    @property
    def approach(self) -> float:
        """Static approach under load 1."""


@dataclass(frozen=True)
class Target:
    """Everything that one fit sees, as plain arrays in the order of frequency."""

    omega: _Floats
    stiffness: _Floats
    damping: _Floats
    approach: float
    records: tuple[ContactRecord, ...] = ()

    @classmethod
    def of(cls, response: Response, records: Sequence[ContactRecord]) -> Target:
        """Check and sort.

        Raises
        ------
        InputError
            Too few frequencies or none low enough, an approach beyond the dry one, SI records, or records that
            are not of the contact of the impedance.
        """
        order = np.argsort(response.omega)
        omega = np.asarray(response.omega, float)[order]
        if omega.size < 8:
            raise InputError("omega", omega.size, "at least 8 frequencies")
        if omega[0] > LOWEST:
            raise InputError("lowest omega", float(omega[0]), f"at most {LOWEST}")
        if not response.approach < 1.0:
            raise InputError("approach", response.approach, "below 1: there must be a film (refine the grid)")
        for i, record in enumerate(records):
            if record.units != "dimensionless":
                raise InputError(f"records[{i}].units", record.units, "dimensionless")
            for name in ("point", "n"):
                ours, theirs = getattr(response, name, None), getattr(record, name)
                if ours is not None and theirs is not None and ours != theirs:
                    raise InputError(f"records[{i}].{name}", theirs, f"as of the impedance, {ours!r}")
            record.require_matching_rate()
        stiffness, damping = np.asarray(response.stiffness, float), np.asarray(response.damping, float)
        return cls(omega, stiffness[order], damping[order], float(response.approach), tuple(records))

    @property
    def film(self) -> tuple[float, float]:
        """Film at load 1 and its exponent, from approach and static tangent: 1/K_0 = 2/3 + exponent film."""
        film = 1.0 - self.approach
        return film, max((1.0 / float(self.stiffness[0]) - 2.0 / 3.0) / film, LEAST_EXPONENT)

    @property
    def static(self) -> float:
        """Tangent of the element's static curve at load 1."""
        film, exponent = self.film
        return 1.0 / (2.0 / 3.0 + exponent * film)

    def part(self, fold: int, inside: bool) -> Target:
        """The data of one fold, or all but those; the lowest frequency belongs to all."""
        keep = (np.arange(self.omega.size) % FOLDS == fold) == inside
        keep[0] = True
        records = tuple(r for i, r in enumerate(self.records) if (i % FOLDS == fold) == inside)
        return replace(
            self,
            omega=self.omega[keep],
            stiffness=self.stiffness[keep],
            damping=self.damping[keep],
            records=records,
        )
