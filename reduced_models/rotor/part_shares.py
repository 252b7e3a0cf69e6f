"""`PartShares`: amounts by the parts that take energy, as shares, in words and as a picture."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.results.picture import Picture
from ehlcontact.results.table import QuantityTable
from reduced_models.rotor.picture import shares_picture

_Floats = NDArray[np.float64]

LEAST = 0.005  # least share that is told in words


class PartShares(QuantityTable):
    """Base of what parts contribute to n modes or answers, the parts by name, as "bearing 0, inner films"."""

    parts: tuple[str, ...]

    @property
    def amounts(self) -> _Floats:
        """Of each part, shape (parts, n); all of one column together are the whole."""
        raise NotImplementedError

    @property
    def columns(self) -> tuple[tuple[str, ...], str]:
        """Numbers of the columns in words, and what they are, with the unit."""
        raise NotImplementedError

    def _share(self) -> _Floats:
        """Amounts over the sum of their sizes."""
        return np.asarray(self.amounts / sizes(self.amounts))

    @property
    def kinds(self) -> dict[str, _Floats]:
        """Shares of alike parts of all bearings together, shape (n,): "inner films", "rings and fits", ..."""
        found: dict[str, Any] = {}
        for part, row in zip(self.parts, self._share(), strict=True):
            kind = part.rpartition(", ")[2]
            found[kind] = found.get(kind, 0.0) + row
        return found

    def share_words(self, column: int) -> str:
        """Shares of alike parts in a column, in words, the largest first; empty where nothing takes energy."""
        shares = [(float(row[column]), kind) for kind, row in self.kinds.items()]
        told = sorted((one for one in shares if abs(one[0]) >= LEAST), key=lambda one: -abs(one[0]))
        return ", ".join(f"{kind} {100.0 * share:.3g} %" for share, kind in told)

    def renamed(self, name_of: Callable[[str], str]) -> Self:
        """The same with other names of bearings and nodes: `name_of` has them by the old ones."""
        rows = (part.partition(", ") for part in self.parts)
        names = tuple(f"{name_of(name)}{comma}{kind}" for name, comma, kind in rows)
        found: Self = replace(self, parts=names)  # type: ignore[type-var]
        return found

    def picture(self) -> Picture:
        """Shares of the parts, stacked, one bar for each column."""
        words, label = self.columns
        return shares_picture(self.parts, self._share(), words, label)


def sizes(amounts: _Floats) -> _Floats:
    """Sums of the sizes of the parts, shape (n,); 1 where there are none."""
    found = np.abs(amounts).sum(axis=0)
    return np.where(found > 0.0, found, 1.0)
