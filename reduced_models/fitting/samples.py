"""Samples of a fit: records of one contact, each cut to its window."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import as_column
from ehlcontact.errors import InputError
from ehlcontact.point import Point
from ehlcontact.summary import contact_text
from reduced_models.fitting.records import ContactRecord, as_records

_Floats = NDArray[np.float64]
Window = tuple[float, float]  # (start, end) in t


@dataclass(frozen=True, eq=False)
class Samples:
    """Records of one contact, and of each the part inside its window.

    Records of an `OperatingPoint` are in Moes units here, in which all fits are made.

    Attributes
    ----------
    point : MoesPoint, OperatingPoint or None
        In whose units the records were given; those without a point stay as they are.
    records, cuts : tuple of ContactRecord
        Whole, and their parts.
    windows : tuple of (float, float)
        Of each.
    """

    point: Point | None
    records: tuple[ContactRecord, ...]
    windows: tuple[Window, ...]
    cuts: tuple[ContactRecord, ...]

    @classmethod
    def of(cls, records: ContactRecord | Sequence[ContactRecord], window: Window | None) -> Self:
        """Check that the records belong together, and cut each to `window`, or to its own default window.

        Raises
        ------
        InputError
            No record, something else, records of different contacts, a window that is no pair or holds too few
            samples.
        """
        taken = as_records(records)
        if not taken:
            raise InputError("records", 0, "at least one record")
        _require_one_contact(taken)
        point = taken[0].point
        if window is not None:
            start, end = as_column("window", window, size=2).tolist()
            for record in taken:
                record.window(start, end)  # raises InputError in the units of the record
        if point is not None:
            taken = tuple(record.dimensionless for record in taken)
        if window is None:
            windows = tuple(record.default_window for record in taken)
        else:
            time = 1.0 if point is None else point.scales.time
            windows = ((start / time, end / time),) * len(taken)
        cuts = (record.window(*span) for record, span in zip(taken, windows, strict=True))
        return cls(point, taken, windows, tuple(cuts))

    @cached_property
    def approach(self) -> _Floats:
        """Approach of all cuts, one after the other."""
        return np.concatenate([cut.approach for cut in self.cuts])

    @cached_property
    def rate(self) -> _Floats:
        """Rate of all cuts, one after the other."""
        return np.concatenate([cut.rate for cut in self.cuts])

    @cached_property
    def force(self) -> _Floats:
        """Force of all cuts, one after the other."""
        return np.concatenate([cut.force for cut in self.cuts])

    def each(self, name: str) -> Any:
        """An attribute of the records: one value if they agree, else a list of all."""
        values = [getattr(record, name) for record in self.records]
        return values[0] if all(value == values[0] for value in values) else values

    def split(self, values: _Floats) -> list[_Floats]:
        """Values of all cuts as one array per cut."""
        return np.split(values, np.cumsum([len(cut) for cut in self.cuts])[:-1])

    def require_matching_rates(self) -> None:
        """Make sure that the rate of every cut is the derivative of its approach; raises InputError."""
        for cut in self.cuts:
            cut.require_matching_rate()

    def acceleration_error(self, fitted: _Floats) -> float | None:
        """Eq. 13 for the acceleration that the motion equation (eq. 7) gives with the fitted force."""
        true, modelled = 0.0, 0.0
        for cut, force in zip(self.cuts, self.split(fitted), strict=True):
            if cut.mass is None or cut.load is None or cut.acceleration is None:
                return None
            true += float(np.sum(cut.acceleration))
            modelled += float(np.sum((cut.load - force) / cut.mass))
        return (true - modelled) / true if true != 0.0 else None


def _require_one_contact(records: Sequence[ContactRecord]) -> None:
    first = records[0]
    for i, record in enumerate(records):
        for name in ("units", "point", "static_load"):
            own, theirs = getattr(record, name), getattr(first, name)
            if own == theirs:
                continue
            if None not in (own, theirs) and name == "point":
                own, theirs = contact_text(own), contact_text(theirs)
            raise InputError(f"records[{i}].{name}", own, f"as in records[0]: {theirs!r}")
