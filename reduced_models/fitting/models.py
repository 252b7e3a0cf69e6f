"""Models of `fit`: coefficients, fitted force and uncertainty from samples."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from reduced_models.elements.polynomial import CubicContact, LinearContact, PolynomialContact
from reduced_models.elements.power import PowerLawContact
from reduced_models.elements.spring import MemorylessContact
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
    build: Callable[..., MemorylessContact]  # called with parameters, validity box and units
    damping: str | None = None  # coefficient of u', where it is the whole damper

    def without_negative_damping(self, samples: Samples, errors: Mapping[str, float]) -> Estimate:
        """Damping 0 where it is negative by rounding, or by no more than its standard error in `errors`."""
        if self.damping is None:
            return self
        damping = self.parameters[self.damping]
        smallest = ROUNDING_FORCE * float(np.abs(samples.force).max()) / float(np.abs(samples.rate).max())
        if not -max(errors[self.damping], smallest) <= damping < 0.0:
            return self
        return replace(
            self,
            parameters=self.parameters | {self.damping: 0.0},
            fitted=self.fitted - damping * samples.rate,
        )


def linear_estimate(samples: Samples, names: Sequence[str], build: Callable[..., MemorylessContact]) -> Estimate:
    """Least squares of the columns of eq. 12 that belong to `names`."""
    columns = {COLUMNS[name][0]: COLUMNS[name][1](samples.approach, samples.rate) for name in names}
    solved = linear_fit(columns, samples.force)
    parameters = dict(zip(names, solved.values.tolist(), strict=True))
    damping = "C1" if set(names).isdisjoint(("C2", "C3", "B4")) else None
    return Estimate(parameters, solved.fitted, solved.covariance, solved.condition, build, damping)


def _power_estimate(samples: Samples) -> Estimate:
    return Estimate(
        *fit_power_law(samples.approach, samples.rate, samples.force), build=PowerLawContact, damping="C"
    )


def _of_columns(element: type[MemorylessContact]) -> Callable[[Samples], Estimate]:
    return lambda samples: linear_estimate(samples, element.parameter_names, element)


# A new model is entered here, and nowhere else for `fit` and the command line to offer it.
ESTIMATORS: dict[str, Callable[[Samples], Estimate]] = {
    "linear": _of_columns(LinearContact),
    "cubic": _of_columns(CubicContact),
    "polynomial": _of_columns(PolynomialContact),
    "power": _power_estimate,
}
