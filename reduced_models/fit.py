"""Least-squares fit of the viscous elements to records: Nonato and Cavalca (2010), eqs. 9-13."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError, require_choice
from reduced_models.element import CubicContact, LinearContact
from reduced_models.element_file import library_version
from reduced_models.least_squares import linear_fit
from reduced_models.records import ContactRecord

_POWERS = {"linear": (1,), "cubic": (1, 2, 3)}
_ELEMENTS: dict[str, type[LinearContact] | type[CubicContact]] = {
    "linear": LinearContact,
    "cubic": CubicContact,
}


@dataclass(frozen=True, eq=False)
class FitResult:
    """An element and how well it stands for the records.

    Judge by ``rms``; the signed sum ``e_f`` of eq. 13 is near zero by construction. Of a cubic, ``root`` and
    ``tangent`` are identifiable from a small vibration while K1, K2, K3 are not.
    """

    element: LinearContact | CubicContact
    model: str
    parameters: Mapping[str, float]
    std_errors: Mapping[str, float]  # lower bounds: the residuals are taken as independent
    covariance: NDArray[np.float64]  # in the order of parameters
    rms: float  # RMS error of the force / standard deviation of the force
    e_f: float  # eq. 13 for the force: sum(f - f_fit)/sum(f)
    e_acc: float | None  # eq. 13 for u'' = Omega_n^2 (load - f_fit); None without inertia
    root: float | None  # approach where the spring carries the static load (1, dimensionless)
    tangent: float | None  # spring tangent there
    valid: Mapping[str, float]  # low, high: fitted approach; rate: largest |rate|
    condition: float  # of the column-scaled design matrix
    window: tuple[tuple[float, float], ...]  # (start, end) in T, one per record
    samples: int

    def to_dict(self) -> dict[str, Any]:
        """Everything but the element, ready for JSON."""
        return {
            "model": self.model,
            "parameters": dict(self.parameters),
            "rms": self.rms,
            "e_f": self.e_f,
            "root": self.root,
            "tangent": self.tangent,
            "valid": dict(self.valid),
            "condition": self.condition,
            "e_acc": self.e_acc,
            "std_errors": dict(self.std_errors),
            "window": [list(span) for span in self.window],
            "samples": self.samples,
        }


def fit(
    records: ContactRecord | Sequence[ContactRecord],
    model: str = "cubic",
    window: tuple[float, float] | None = None,
) -> FitResult:
    """Fit a spring and a damper to the force of one or several records of the same contact.

    Parameters
    ----------
    records : ContactRecord or sequence of ContactRecord
        Several are fitted together, sample by sample.
    model : {"cubic", "linear"}
        F = K1 u + K2 u^2 + K3 u^3 + C1 u' (eq. 11 as Table 2 reduces it), or F = K1 u + C1 u' (eq. 8).
    window : (start, end), optional
        Part of T to fit, in every record. Left out, each record gives up its first third
        (`ContactRecord.default_window`): the film of the steady start has to leave the contact first.

    Returns
    -------
    FitResult
        With the element, valid over the approach that was fitted.

    Raises
    ------
    InputError
        Unknown model; no record, or records of different points, scales or units; a window without samples; a
        record that varies too little (it names the columns); a fit that makes no contact (C1 < 0, or a spring
        that does not push at the ends of the range).
    """
    require_choice("model", model, tuple(_POWERS))
    taken = [records] if isinstance(records, ContactRecord) else list(records)
    if not taken:
        raise InputError("records", 0, "at least one record")
    _require_one_contact(taken)
    spans = [record.default_window if window is None else _span(window) for record in taken]
    cuts = [record.window(*span) for record, span in zip(taken, spans, strict=True)]

    u, v, f = (np.concatenate([getattr(cut, name) for cut in cuts]) for name in ("approach", "rate", "force"))
    columns = {f"approach^{i}" if i > 1 else "approach": u**i for i in _POWERS[model]} | {"rate": v}
    solved = linear_fit(columns, f)
    spread = float(np.std(f))
    if spread == 0.0:
        raise InputError("force", float(f[0]), "a history that varies")

    names = _ELEMENTS[model].parameter_names
    parameters = dict(zip(names, solved.values.tolist(), strict=True))
    valid = {"low": float(u.min()), "high": float(u.max()), "rate": float(np.abs(v).max())}
    element = _ELEMENTS[model](**parameters, **valid, units=taken[0].units)  # type: ignore[arg-type]
    static_load = taken[0].static_load
    root = None if static_load is None else element.approach_at(static_load)
    result = FitResult(
        element=element,
        model=model,
        parameters=parameters,
        std_errors=dict(zip(names, np.sqrt(np.diag(solved.covariance)).tolist(), strict=True)),
        covariance=solved.covariance,
        rms=float(np.sqrt(np.mean((f - solved.fitted) ** 2))) / spread,
        e_f=float(np.sum(f - solved.fitted) / np.sum(f)),
        e_acc=_acceleration_error(cuts, solved.fitted),
        root=root,
        tangent=None if root is None else float(element.stiffness(root, 0.0)),
        valid=valid,
        condition=solved.condition,
        window=tuple(spans),
        samples=int(f.size),
    )
    quality = {key: value for key, value in result.to_dict().items() if key not in ("parameters", "valid")}
    return replace(result, element=replace(element, fit=quality, source=_source(taken)))


def _span(window: tuple[float, float]) -> tuple[float, float]:
    try:
        start, end = window
        return float(start), float(end)
    except (TypeError, ValueError):
        raise InputError("window", window, "a pair (start, end) of numbers") from None


def _require_one_contact(records: list[ContactRecord]) -> None:
    first = records[0]
    for i, record in enumerate(records):
        if not isinstance(record, ContactRecord):
            raise InputError(f"records[{i}]", type(record).__name__, "a ContactRecord")
        for name in ("units", "point", "scales", "static_load"):
            if getattr(record, name) != getattr(first, name):
                raise InputError(
                    f"records[{i}].{name}",
                    getattr(record, name),
                    f"as in records[0]: {getattr(first, name)!r}",
                )


def _acceleration_error(cuts: list[ContactRecord], fitted: NDArray[np.float64]) -> float | None:
    """Eq. 13 for the acceleration that the motion equation (eq. 7) gives with the fitted force."""
    true, modelled, start = 0.0, 0.0, 0
    for cut in cuts:
        if cut.omega_n is None or cut.load is None or cut.acceleration is None:
            return None
        true += float(np.sum(cut.acceleration))
        modelled += float(np.sum(cut.omega_n**2 * (cut.load - fitted[start : start + len(cut)])))
        start += len(cut)
    return (true - modelled) / true if true != 0.0 else None


def _source(records: list[ContactRecord]) -> dict[str, Any]:
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
        "version": library_version(),
    }
