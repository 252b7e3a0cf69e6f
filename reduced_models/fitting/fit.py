"""Least-squares fit of an element to records, after Nonato and Cavalca (2010), eqs. 9-13."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Literal, overload

import numpy as np

from ehlcontact.checks import require_choice
from ehlcontact.errors import InputError
from ehlcontact.origin import source_of
from ehlcontact.point import OperatingPoint
from reduced_models.elements.spring import SpringContact
from reduced_models.elements.validity import Validity
from reduced_models.fitting.memory_fit import fit_memory
from reduced_models.fitting.models import Estimate, estimate
from reduced_models.fitting.records import ContactRecord
from reduced_models.fitting.result import ElementFit, FitResult, MemoryFit, rms_error, sum_error
from reduced_models.fitting.samples import Samples, Window
from reduced_models.fitting.uncertainty import Uncertainty

MEMORY = "memory"
MODELS = (*SpringContact.kinds, MEMORY)

Records = ContactRecord | Sequence[ContactRecord]


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
        Several are fitted together, sample by sample. The fit and its element are in their units: SI at an
        `OperatingPoint`, Moes units at a `MoesPoint`.
    model : {"cubic", "linear", "polynomial", "power", "memory"}
        F = K1 u + K2 u^2 + K3 u^3 + C1 u' (eq. 11 as Table 2 reduces it), F = K1 u + C1 u' (eq. 8), the seven
        terms of eq. 11, F = K (u + u0)^n + F0 + C1 u', or the film memory: `fit_memory`, which solves the
        impedance of the contact too.
    window : (start, end), optional
        Part of t to fit, in every record, in its unit. Left out, each record gives up its first third
        (`ContactRecord.default_window`): the film of the steady start has to leave the contact first. A film
        memory includes that film and is fitted to whole records only.

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
    samples = Samples.of(records, window)
    fitted = estimate(samples, model)
    if np.std(samples.force) == 0.0:
        raise InputError("force", float(samples.force[0]), "a history that varies")
    samples.require_matching_rates()
    known = Uncertainty.of(
        tuple(fitted.parameters), fitted.covariance, samples.split(samples.force - fitted.fitted)
    )
    fitted = fitted.without_negative_damping(samples, known.std_errors)
    element = _element(samples, model, fitted)
    root, tangent = _static(element, samples.records[0].static_load)
    result = FitResult(
        element=element,
        model=model,
        parameters=fitted.parameters,
        std_errors=known.std_errors,
        intervals=known.intervals(fitted.parameters),
        covariance=known.covariance,
        rms=rms_error(samples.force, fitted.fitted),
        e_f=sum_error(samples.force, fitted.fitted),
        e_acc=samples.acceleration_error(fitted.fitted),
        root=root,
        tangent=tangent,
        valid=element.validity.to_dict(),
        condition=fitted.condition,
        window=samples.windows,
        samples=int(samples.force.size),
        independent_samples=known.independent_samples,
    )
    result = replace(result, element=replace(element, fit=result.quality()))
    return result.to_si(samples.point.scales) if isinstance(samples.point, OperatingPoint) else result


def _element(samples: Samples, kind: str, fitted: Estimate) -> SpringContact:
    """Element of the estimate, with validity box and origin of the samples."""
    frequencies = [cut.frequency for cut in samples.cuts]
    box = Validity.of(samples.approach, samples.rate, samples.force, frequencies).fields()
    return SpringContact(
        kind=kind,
        **(fitted.parameters | box),
        units=samples.records[0].units,
        source=source_of(samples.point, samples.each("n"), samples.each("domain"), samples.each("motion")),
    )


def _static(element: SpringContact, load: float | None) -> tuple[float | None, float | None]:
    """Approach and tangent of the spring under the static load, where that is known."""
    if load is None:
        return None, None
    root = element.approach_at(load)
    return root, float(element.stiffness(root, 0.0))
