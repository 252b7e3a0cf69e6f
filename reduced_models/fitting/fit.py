"""Records to element; least squares after Nonato and Cavalca (2010), eqs. 9-13."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, Literal, overload

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_choice
from ehlcontact.errors import InputError
from ehlcontact.origin import __version__
from reduced_models.elements.spring import MemorylessContact
from reduced_models.fitting.memory import MemoryFit, fit_memory
from reduced_models.fitting.models import ESTIMATORS, Samples
from reduced_models.fitting.records import ContactRecord, as_records
from reduced_models.fitting.result import ElementFit
from reduced_models.fitting.uncertainty import half_widths, independent_samples

MEMORY = "memory"
MODELS = (*ESTIMATORS, MEMORY)


@dataclass(frozen=True, eq=False, kw_only=True)
class FitResult(ElementFit):
    """A least-squares fit of a memoryless element.

    Of a cubic, ``root`` and ``tangent`` are identifiable from a small vibration while K1, K2, K3 are not: see
    their intervals.
    """

    element: MemorylessContact
    parameters: Mapping[str, float]
    rms: float
    e_f: float
    condition: float
    std_errors: Mapping[str, float]  # square roots of the diagonal of covariance
    intervals: Mapping[str, tuple[float, float]]  # 95 %, Student's; see `uncertainty`
    covariance: NDArray[np.float64]  # in the order of parameters, enlarged for residuals that hang together
    e_acc: float | None  # eq. 13 for u'' = Omega_n^2 (load - f_fit); None without inertia
    window: tuple[tuple[float, float], ...]  # (start, end) in T, one per record
    samples: int
    independent_samples: float  # how many of them are worth something: `uncertainty`

    def to_dict(self) -> dict[str, Any]:
        """Everything but the element, ready for JSON."""
        return super().to_dict() | {
            "e_acc": self.e_acc,
            "std_errors": dict(self.std_errors),
            "intervals": {name: list(pair) for name, pair in self.intervals.items()},
            "covariance": self.covariance.tolist(),
            "window": [list(span) for span in self.window],
            "samples": self.samples,
            "independent_samples": self.independent_samples,
        }


Records = ContactRecord | Sequence[ContactRecord]
Window = tuple[float, float]


@overload
def fit(records: Records, model: Literal["memory"], window: None = None) -> MemoryFit: ...
@overload
def fit(
    records: Records,
    model: Literal["linear", "cubic", "polynomial", "power"] = "cubic",
    window: Window | None = None,
) -> FitResult: ...
@overload
def fit(records: Records, model: str, window: Window | None = None) -> ElementFit: ...
def fit(records: Records, model: str = "cubic", window: Window | None = None) -> ElementFit:
    """Fit a contact element to one or several records of the same contact.

    Parameters
    ----------
    records : ContactRecord or sequence of ContactRecord
        Several are fitted together, sample by sample.
    model : {"cubic", "linear", "polynomial", "power", "memory"}
        F = K1 u + K2 u^2 + K3 u^3 + C1 u' (eq. 11 as Table 2 reduces it), F = K1 u + C1 u' (eq. 8), the seven
        terms of eq. 11, F = K (u + u0)_+^n + F0 + C u', or the film memory: `fit_memory`, which solves the
        impedance of the contact too.
    window : (start, end), optional
        Part of T to fit, in every record. Left out, each record gives up its first third
        (`ContactRecord.default_window`): the film of the steady start has to leave the contact first. A film
        memory knows that film, and takes whole records only.

    Returns
    -------
    FitResult, or MemoryFit for the film memory
        With the element, valid over the approach that was fitted.

    Raises
    ------
    InputError
        Unknown model; no record, something else, or records of different points, scales or units; a window
        without samples; a record that varies too little (it names the columns) or whose rate is not the
        derivative of its approach; a fit that makes no contact (C1 < 0, or a spring that does not push at the ends
        of the range).

    Notes
    -----
    Damping of a linear, cubic or power-law element that comes out negative, but within its standard error or with
    a force below 1e-9 of the largest contact force, is no damping: it is taken as 0, the spring as fitted.
    """
    require_choice("model", model, MODELS)
    if model != MEMORY:
        return _least_squares(records, model, window)
    if window is not None:
        raise InputError("window", window, "left out with the memory model: it takes whole records, from rest")
    return fit_memory(None, records)


def _least_squares(records: Records, model: str, window: Window | None) -> FitResult:
    samples, spans = take_samples(records, window)
    estimate = ESTIMATORS[model](samples)
    spread = float(np.std(samples.force))
    if spread == 0.0:
        raise InputError("force", float(samples.force[0]), "a history that varies")
    for cut in samples.cuts:
        cut.require_matching_rate()

    residuals = samples.force - estimate.fitted
    independent = independent_samples(samples.split(residuals))
    covariance = estimate.covariance * (samples.force.size / independent)
    errors = np.sqrt(np.diag(covariance))
    estimate = estimate.without_negative_damping(samples, errors)
    residuals = samples.force - estimate.fitted
    values = np.array(list(estimate.parameters.values()))
    widths = half_widths(errors, independent)
    box = _validity(samples)
    first = samples.records[0]
    element = estimate.build(**estimate.parameters, **box, units=first.units)
    root = tangent = None
    if first.static_load is not None:
        root = element.approach_at(first.static_load)
        tangent = float(element.stiffness(root, 0.0))
    names = tuple(estimate.parameters)
    result = FitResult(
        element=element,
        model=model,
        parameters=estimate.parameters,
        std_errors=dict(zip(names, errors.tolist(), strict=True)),
        intervals=dict(
            zip(names, zip((values - widths).tolist(), (values + widths).tolist(), strict=True), strict=True)
        ),
        covariance=covariance,
        rms=float(np.sqrt(np.mean(residuals**2))) / spread,
        e_f=float(np.sum(residuals) / np.sum(samples.force)),
        e_acc=acceleration_error(samples, estimate.fitted),
        root=root,
        tangent=tangent,
        valid={key.removesuffix("_range"): value for key, value in box.items()},
        condition=estimate.condition,
        window=spans,
        samples=int(samples.force.size),
        independent_samples=independent,
    )
    quality, source = result.quality(), _source(samples.records)
    return replace(result, element=replace(element, fit=quality, source=source))


def take_samples(
    records: ContactRecord | Sequence[ContactRecord], window: tuple[float, float] | None
) -> tuple[Samples, tuple[tuple[float, float], ...]]:
    """Check that the records belong together, and cut each to its window; returns samples and windows.

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
    spans = tuple(record.default_window if window is None else _span(window) for record in taken)
    cuts = [record.window(*span) for record, span in zip(taken, spans, strict=True)]
    return Samples(taken, cuts), spans


def acceleration_error(samples: Samples, fitted: NDArray[np.float64]) -> float | None:
    """Eq. 13 for the acceleration that the motion equation (eq. 7) gives with the fitted force."""
    true, modelled = 0.0, 0.0
    for cut, force in zip(samples.cuts, samples.split(fitted), strict=True):
        if cut.omega_n is None or cut.load is None or cut.acceleration is None:
            return None
        true += float(np.sum(cut.acceleration))
        modelled += float(np.sum(cut.omega_n**2 * (cut.load - force)))
    return (true - modelled) / true if true != 0.0 else None


def _validity(samples: Samples) -> dict[str, Any]:
    u, v, f = samples.approach, samples.rate, samples.force
    omegas = [cut.omega for cut in samples.cuts]
    return {
        "low": float(u.min()),
        "high": float(u.max()),
        "rate": float(np.abs(v).max()),
        "load_range": (float(f.min()), float(f.max())),
        "omega_range": (min(omegas), max(omegas)),
    }


def _span(window: tuple[float, float]) -> tuple[float, float]:
    try:
        start, end = window
        return float(start), float(end)
    except (TypeError, ValueError):
        raise InputError("window", window, "a pair (start, end) of numbers") from None


def _require_one_contact(records: Sequence[ContactRecord]) -> None:
    first = records[0]
    for i, record in enumerate(records):
        for name in ("units", "point", "scales", "static_load"):
            if getattr(record, name) != getattr(first, name):
                raise InputError(
                    f"records[{i}].{name}",
                    getattr(record, name),
                    f"as in records[0]: {getattr(first, name)!r}",
                )


def _source(records: Sequence[ContactRecord]) -> dict[str, Any]:
    def plain(name: str) -> Any:
        values = [getattr(record, name) for record in records]
        return values[0] if all(value == values[0] for value in values) else values

    point, scales = records[0].point, records[0].scales
    return {
        "point": None if point is None else point.to_dict(),
        "scales": None if scales is None else asdict(scales),
        "n": plain("n"),
        "domain": plain("domain"),
        "motion": plain("motion"),
        "version": __version__,
    }
