"""`Change`: change of answers of the atlas by an oil supply or by heat."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reduced_models.atlas.table import HEAD, LOW

_Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Change:
    """Change of rows of answers by a condition, in the order of `AtlasTable.answers`, shape (n, 5 + 2 k).

    Attributes
    ----------
    rows : ndarray, shape (n, 5 + 2 k)
        Factors on 1 - approach, both films, moment and K; for every C, that at low frequency included, what is
        added to it, over the C at low frequency.
    bars : ndarray, shape (n, 5 + 2 k)
        Half widths of the error bars of `rows`.
    """

    rows: _Floats
    bars: _Floats

    def of(self, values: _Floats, bars: _Floats) -> tuple[_Floats, _Floats]:
        """Changed answers and half widths of their error bars."""
        damping = _is_damping(values.shape[1])
        unit = np.where(damping, values[:, [LOW]], values)
        unit[:, 0] = 1.0 - values[:, 0]
        changed = np.where(damping, values + unit * self.rows, unit * self.rows)
        changed[:, 0] = 1.0 - changed[:, 0]
        grown = np.where(damping, 1.0, self.rows)
        return changed, np.hypot(grown * bars, unit * self.bars)


def _is_damping(columns: int) -> NDArray[np.bool_]:
    """Which columns of answers are C."""
    which = np.zeros(columns, dtype=bool)
    which[LOW] = which[(HEAD + columns) // 2 :] = True
    return which
