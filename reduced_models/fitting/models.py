"""Least squares of each kind of spring: coefficients, fitted force and uncertainty from samples."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from reduced_models.elements.spring import SpringContact
from reduced_models.fitting.least_squares import linear_fit
from reduced_models.fitting.power_law_fit import fit_power_law
from reduced_models.fitting.samples import Samples

_Floats = NDArray[np.float64]
# Largest force of a damper, as a share of the largest of the contact, that is taken for the rounding of a record
# without damping: far above that of its numbers (1e-16), far below any oil's.
ROUNDING_FORCE = 1e-9

# Columns of eq. 12: name, and what stands in it.
COLUMNS: dict[str, tuple[str, Callable[[_Floats, _Floats], _Floats]]] = {
    "K1": ("approach", lambda u, v: u),
    "C1": ("rate", lambda u, v: v),
    "K2": ("approach^2", lambda u, v: u**2),
    "C2": ("rate^2", lambda u, v: v**2),
    "K3": ("approach^3", lambda u, v: u**3),
    "C3": ("rate^3", lambda u, v: v**3),
    "B4": ("approach*rate", lambda u, v: u * v),
}


@dataclass(frozen=True, eq=False)
class Estimate:
    """Coefficients by name; arrays in their order."""

    parameters: dict[str, float]
    fitted: _Floats  # force of all cuts
    covariance: _Floats  # as if the residuals were independent
    condition: float  # of the column-scaled (Jacobian) matrix

    def without_negative_damping(self, samples: Samples, errors: Mapping[str, float]) -> Estimate:
        """Viscous damper 0 where it is negative by rounding, or by no more than its standard error in `errors`."""
        if not {"C2", "C3", "B4"}.isdisjoint(self.parameters):
            return self
        damping = self.parameters["C1"]
        smallest = ROUNDING_FORCE * float(np.abs(samples.force).max()) / float(np.abs(samples.rate).max())
        if not -max(errors["C1"], smallest) <= damping < 0.0:
            return self
        return replace(self, parameters=self.parameters | {"C1": 0.0}, fitted=self.fitted - damping * samples.rate)


def estimate(samples: Samples, kind: str) -> Estimate:
    """Coefficients of a kind of spring, one of ``SpringContact.kinds``."""
    if kind == "power":
        return Estimate(*fit_power_law(samples.approach, samples.rate, samples.force))
    return linear_estimate(samples, SpringContact.kinds[kind])


def linear_estimate(samples: Samples, names: Sequence[str]) -> Estimate:
    """Least squares of the columns of eq. 12 that belong to `names`."""
    columns = {COLUMNS[name][0]: COLUMNS[name][1](samples.approach, samples.rate) for name in names}
    solved = linear_fit(columns, samples.force)
    parameters = dict(zip(names, solved.values.tolist(), strict=True))
    return Estimate(parameters, solved.fitted, solved.covariance, solved.condition)
