"""Results of fits, and the errors by which they are judged."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from math import nan
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.point import Scales
from ehlcontact.quantities import LENGTH, STIFFNESS
from ehlcontact.results.table import frame_of, plain
from ehlcontact.summary import Summary, quantity_text
from reduced_models.elements.base import ContactElement
from reduced_models.elements.element_summary import parameter_text
from reduced_models.elements.film_contact import FilmContact
from reduced_models.elements.spring import SpringContact

_Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False, kw_only=True)
class ElementFit(Summary):
    """Fitted element and its errors, in the units of its records; judge by ``rms``.

    Attributes
    ----------
    element : ContactElement
    model : str
        As asked for.
    parameters : mapping of str to float
        Coefficients by name, in the units of the element.
    rms : float or None
        RMS error of the force over its standard deviation; None without records.
    e_f : float or None
        Eq. 13 for the force: sum(f - f_fit)/sum(f), near zero by construction.
    root, tangent : float or None
        Approach where the spring carries the static load, and its tangent there.
    valid : mapping
        low, high: approach that was fitted; rate: largest magnitude of the rate; load, omega: [low, high].
    condition : float or None
        Of the column-scaled design matrix, or Jacobian, in Moes units at a point; None where there is none.
    """

    element: ContactElement
    model: str
    parameters: Mapping[str, Any]
    rms: float | None
    e_f: float | None
    root: float | None
    tangent: float | None
    valid: Mapping[str, Any]
    condition: float | None

    def _summary_lines(self) -> list[str]:
        own = {"root": LENGTH, "tangent": STIFFNESS}
        rest = [
            f"{name} {quantity_text(value, quantity.unit if self.element.units == 'SI' else quantity.moes)}"
            for name, quantity in own.items()
            if (value := getattr(self, name)) is not None
        ]
        numbers = parameter_text(self.parameters, self.element.units)
        note = ", coefficients dimensionless" if self.element.state_count and self.element.units == "SI" else ""
        lines = [f"{self.model}, {self.element.units}{note}", numbers, ", ".join(rest) or "no root"]
        if self.rms is not None:
            lines.append(f"rms error {100.0 * self.rms:.2g} % of the standard deviation of the force")
        return lines

    def plot(self, path: str | os.PathLike[str] | None = None) -> Any:
        """Figure of the element, as `ContactElement.plot`."""
        return self.element.plot(path)

    def to_pandas(self) -> Any:
        """``pandas.DataFrame``, a row for each coefficient: value, and standard error and 95 % interval if known.

        Raises
        ------
        InputError
            pandas is not installed.
        """
        errors, intervals = getattr(self, "std_errors", {}), getattr(self, "intervals", {})
        rows = []
        for name, value in self.parameters.items():
            for k, one in enumerate(np.ravel(value).tolist()):
                low, high = intervals.get(name, (nan, nan))
                row = {"value": one, "std_error": errors.get(name, nan), "low": low, "high": high}
                rows.append({"parameter": f"{name}[{k}]" if np.ndim(value) else name, **row})
        about = {"model": self.model, "units": self.element.units, "rms": self.rms}
        return frame_of(rows, "parameter", about)

    def to_dict(self) -> dict[str, Any]:
        """Everything but the element, ready for JSON."""
        return {f.name: plain(getattr(self, f.name)) for f in fields(self) if f.name != "element"}

    def to_si(self, scales: Scales) -> Self:
        """The fit in SI, of the contact whose Moes units are `scales`; raises `InputError` as the element's."""
        element = self.element.to_si(scales)
        units = {"root": scales.length, "tangent": scales.stiffness}
        known = {name: value for name in units if (value := getattr(self, name)) is not None}
        changes = {name: value * units[name] for name, value in known.items()} | self._in_si(element, scales)
        own: dict[str, Any] = {"parameters": element.parameters, "valid": element.validity.to_dict()}
        result = replace(self, element=element, **own, **changes)
        return replace(result, element=replace(element, fit=result.quality()))

    def _in_si(self, element: ContactElement, scales: Scales) -> dict[str, Any]:
        """Fields in SI that only a class of its own has."""
        return {}

    def quality(self) -> dict[str, Any]:
        """Part of `to_dict` that the element stores; coefficients and validity box have their own entries."""
        return {key: value for key, value in self.to_dict().items() if key not in ("parameters", "valid")}


@dataclass(frozen=True, eq=False, kw_only=True)
class FitResult(ElementFit):
    """A least-squares fit of a memoryless element.

    Of a cubic, ``root`` and ``tangent`` are identifiable from a small vibration while K1, K2, K3 are not: see
    their intervals.

    Attributes
    ----------
    std_errors : mapping of str to float
        Square roots of the diagonal of `covariance`.
    intervals : mapping of str to (float, float)
        95 % of each parameter, Student's; see `reduced_models.fitting.uncertainty`.
    covariance : ndarray, shape (k, k)
        Of the k parameters in their order, enlarged for residuals that hang together.
    e_acc : float or None
        Eq. 13 for u'' = Omega_n^2 (load - f_fit); None without inertia.
    window : tuple of (float, float)
        Start and end in t, one pair per record.
    samples : int
        That were fitted.
    independent_samples : float
        How many of them are worth something.
    element, model, parameters, rms, e_f, root, tangent, valid, condition
        As in `ElementFit`, none of them None but `root` and `tangent` of a spring that carries no such load.
    """

    element: SpringContact
    parameters: Mapping[str, float]
    rms: float
    e_f: float
    condition: float
    std_errors: Mapping[str, float]
    intervals: Mapping[str, tuple[float, float]]
    covariance: _Floats
    e_acc: float | None
    window: tuple[tuple[float, float], ...]
    samples: int
    independent_samples: float

    def _in_si(self, element: ContactElement, scales: Scales) -> dict[str, Any]:
        jacobian = self.element.si_jacobian(scales)
        covariance = jacobian @ self.covariance @ jacobian.T
        errors = dict(zip(self.std_errors, np.sqrt(np.diag(covariance)).tolist(), strict=True))
        intervals = {}
        for name, value in element.parameters.items():
            low, high = self.intervals[name]
            half = 0.5 * (high - low)  # as many standard errors in any unit
            half *= errors[name] / self.std_errors[name] if self.std_errors[name] else 0.0
            intervals[name] = (value - half, value + half)
        window = tuple((start * scales.time, end * scales.time) for start, end in self.window)
        return {"std_errors": errors, "intervals": intervals, "covariance": covariance, "window": window}


@dataclass(frozen=True, eq=False, kw_only=True)
class MemoryFit(ElementFit):
    """Fitted film-memory element and its errors; ``rms`` is of all samples together.

    Attributes
    ----------
    record_rms : tuple of float
        RMS error of the force over its standard deviation, of each whole record.
    damping_error, stiffness_error : ndarray, shape (frequencies,)
        Relative error of C and K at every frequency of the impedance.
    validation : dict of int to float
        Cross-validation error by number of lags.
    weights : mapping of str to float
        Relative errors that counted alike.
    element, model, parameters, rms, e_f, root, tangent, valid, condition
        As in `ElementFit`.
    """

    element: FilmContact
    record_rms: tuple[float, ...]
    damping_error: _Floats
    stiffness_error: _Floats
    validation: dict[int, float] = field(default_factory=dict)
    weights: Mapping[str, float] = field(default_factory=dict)

    def to_dict(self) -> dict[str, Any]:
        """Everything but the element, ready for JSON; of the errors over frequency the largest."""
        entries = super().to_dict()
        for name in ("damping_error", "stiffness_error"):
            entries[f"{name}_max"] = float(np.abs(entries.pop(name)).max())
        return entries | {"validation": {str(lags): score for lags, score in self.validation.items()}}


def rms_error(force: _Floats, fitted: _Floats) -> float:
    """RMS of ``force - fitted`` over the standard deviation of the force."""
    return float(np.sqrt(np.mean((force - fitted) ** 2)) / np.std(force))


def sum_error(force: _Floats, fitted: _Floats) -> float:
    """Eq. 13 for the force."""
    return float(np.sum(force - fitted) / np.sum(force))
