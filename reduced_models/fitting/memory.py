"""Joint fit of the film-memory element to an impedance and to any number of records."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from ehlcontact import Domain, ImpedanceResult, impedance
from ehlcontact.errors import InputError
from ehlcontact.origin import __version__
from reduced_models.elements.film_law import film_drive
from reduced_models.elements.film_response import WEIGHT_C, WEIGHT_K, FilterRates, GainFit, fit_gains
from reduced_models.elements.memory import FilmMemoryContact
from reduced_models.fitting.memory_target import FOLDS, Response, Target
from reduced_models.fitting.records import ContactRecord, as_records
from reduced_models.fitting.result import ElementFit

_Floats = NDArray[np.float64]

OMEGAS = (0.0, *np.geomspace(0.03, 60.0, 24).tolist())  # that an impedance is solved at
ORDERS = (4, 6, 8, 12, 16)  # numbers of lags to choose from
TOLERATED = 1.05  # a shorter chain is taken if its cross-validation error is at most so much larger
FORCE_WEIGHT = 0.01  # RMS error of a record over its spread that counts like 5 % of C
TRANSIT = 1.6  # start: time in which the chain carries the film through
STARTS = ((30.0, 60.0), (200.0, 80.0))  # inlet and fast rate; the better of two minima is taken
LIMITS = ((0.5, 200.0), (2.0, 300.0), (5.0, 1000.0), (0.0, 20.0))  # lag, inlet, fast rate, squeeze
SMALL_MOTION = 0.1  # load range that an impedance alone stands for


@dataclass(frozen=True, eq=False, kw_only=True)
class MemoryFit(ElementFit):
    """A film-memory element and how well it stands for the data; ``rms`` is of all samples together."""

    element: FilmMemoryContact
    record_rms: tuple[float, ...]  # RMS error of the force over its standard deviation, whole record, each
    damping_error: _Floats  # relative error of C at every frequency
    stiffness_error: _Floats
    validation: dict[int, float] = field(default_factory=dict)  # cross-validation error by number of lags

    def to_dict(self) -> dict[str, Any]:
        """Everything but the element, ready for JSON."""
        return super().to_dict() | {
            "record_rms": list(self.record_rms),
            "damping_error_max": float(np.abs(self.damping_error).max()),
            "stiffness_error_max": float(np.abs(self.stiffness_error).max()),
            "validation": {str(lags): score for lags, score in self.validation.items()},
            "weights": {"damping": WEIGHT_C, "stiffness": WEIGHT_K, "force": FORCE_WEIGHT},
        }


def fit_memory(
    response: Response | None, records: ContactRecord | Sequence[ContactRecord] = (), *, lags: int | None = None
) -> MemoryFit:
    """Fit one element to the impedance of a contact and to records of its motion, whole and from rest.

    The static curve follows from approach and static tangent; the gains from linear least squares in every step
    (variable projection); the rates and the squeeze term from what is left. Relative errors of 5 % in C, 1 % in
    K (each RMS over the frequencies) and 1 % of the spread of the force of each record count alike.

    Parameters
    ----------
    response : ImpedanceResult or alike, or None
        Dimensionless, with a frequency of at most 0.1; 20 or more from 0 to 60 make a good element. None has it
        solved for the point, grid and domain of the first record.
    records : ContactRecord or sequence of ContactRecord
        Dimensionless, of the same contact on the same grid and domain.
    lags : int, optional
        Length of the chain; by default the shortest whose cross-validation error is within 5 % of the best.

    Raises
    ------
    InputError
        Data that do not go together; see `Target.of`.
    """
    taken = as_records(records)
    if response is None:
        response = impedance_of(taken)
    target = Target.of(response, taken)
    scores: dict[int, float] = {}
    if lags is None:
        scores = {order: cross_validate(target, order) for order in ORDERS}
        best = min(scores.values())
        lags = min(order for order, score in scores.items() if score <= TOLERATED * best)
    FilterRates(lags, 1.0, 1.0, 1.0)  # says what is wrong with the number of lags
    element, gains = _solve(target, lags)
    errors = [_force_error(element, record) for record in taken]
    spreads = [float(np.std(record.force)) for record in taken]
    rms = e_f = None
    if taken:
        error, force = np.concatenate(errors), np.concatenate([record.force for record in taken])
        rms, e_f = float(np.sqrt(np.mean(error**2)) / np.std(force)), float(-np.sum(error) / np.sum(force))
    root = element.approach_at(1.0)
    box = {"low": element.low, "high": element.high, "rate": element.rate}
    result = MemoryFit(
        element=element,
        model=element.kind,
        parameters=element.parameters,
        rms=rms,
        e_f=e_f,
        root=root,
        tangent=element.spring_tangent(root),
        valid=box | {"load": element.load_range, "omega": element.omega_range},
        condition=None,
        record_rms=tuple(float(np.sqrt(np.mean(e**2))) / s for e, s in zip(errors, spreads, strict=True)),
        damping_error=gains.damping / target.damping - 1.0,
        stiffness_error=gains.stiffness / target.stiffness - 1.0,
        validation=scores,
    )
    return replace(result, element=replace(element, fit=result.quality(), source=_source(response, taken)))


def impedance_of(records: Sequence[ContactRecord]) -> ImpedanceResult:
    """Impedance at the point and on the grid of the first record.

    Raises
    ------
    InputError
        No record, or one that does not say where it comes from.
    """
    if not records:
        raise InputError("records", 0, "at least one record, or give an impedance")
    first = records[0]
    if first.point is None or first.n is None or first.domain is None:
        raise InputError("records[0]", "without point, n or domain", "of a simulation, or give an impedance")
    return impedance(first.point, OMEGAS, n=first.n, domain=Domain(*first.domain))


def cross_validate(target: Target, lags: int) -> float:
    """RMS of the weighted residuals on the data left out, each third of frequencies and records in turn."""
    squares = []
    for fold in range(FOLDS):
        element, _ = _solve(target.part(fold, inside=False), lags)
        left_out = target.part(fold, inside=True)
        w = left_out.omega
        Z = element.impedance(w)
        damping = Z.imag / np.maximum(w, 1e-5) / left_out.damping - 1.0
        squares.append(np.mean((damping[w > 0.0] / WEIGHT_C) ** 2))
        squares.append(np.mean(((Z.real / left_out.stiffness - 1.0) / WEIGHT_K) ** 2))
        for record in left_out.records:
            squares.append(np.mean((_force_error(element, record) / np.std(record.force) / FORCE_WEIGHT) ** 2))
    return float(np.sqrt(np.mean(squares)))


def _solve(target: Target, lags: int) -> tuple[FilmMemoryContact, GainFit]:
    """Nonlinear least squares over logs of the rates and the squeeze term, gains projected out."""

    def parts(p: _Floats) -> tuple[FilmMemoryContact, GainFit]:
        rates = FilterRates(lags, *(float(value) for value in np.exp(p[:3])))
        gains = fit_gains(rates, target.omega, target.stiffness, target.damping, target.static)
        squeeze = float(p[3]) if target.records else 0.0
        return _element(target, rates, gains, squeeze), gains

    def residuals(p: _Floats) -> _Floats:
        element, gains = parts(p)
        rows = [gains.residuals / np.sqrt(target.omega.size)]
        for record in target.records:
            rows.append(
                _force_error(element, record) / (FORCE_WEIGHT * np.std(record.force) * np.sqrt(len(record)))
            )
        return np.concatenate(rows)

    lower, upper = np.array(LIMITS).T.copy()
    lower[:3], upper[:3] = np.log(lower[:3]), np.log(upper[:3])
    solutions = []
    for inlet, fast in STARTS:
        start = np.array([np.log(lags / TRANSIT), np.log(inlet), np.log(fast), 0.25])
        solutions.append(
            least_squares(
                residuals, start, bounds=(lower, upper), diff_step=1e-3, xtol=1e-4, ftol=1e-4, max_nfev=30
            )
        )
    return parts(min(solutions, key=lambda solution: solution.cost).x)


def _element(target: Target, rates: FilterRates, gains: GainFit, squeeze: float) -> FilmMemoryContact:
    film, exponent = target.film
    box: dict[str, Any] = {"omega_range": (float(target.omega[0]), float(target.omega[-1]))}
    if target.records:
        u, v, f = (
            np.concatenate([getattr(r, name) for r in target.records]) for name in ("approach", "rate", "force")
        )
        box |= {"low": float(u.min()), "high": float(u.max()), "rate": float(np.abs(v).max())}
        box["load_range"] = (float(f.min()), float(f.max()))
    else:
        loads = np.array([1.0 - SMALL_MOTION, 1.0 + SMALL_MOTION])
        low, high = loads ** (2.0 / 3.0) - film * loads**-exponent
        box |= {"low": float(low), "high": float(high), "load_range": (float(loads[0]), float(loads[1]))}
    return FilmMemoryContact(
        film=film,
        exponent=exponent,
        squeeze=squeeze,
        lag_rate=rates.lag_rate,
        inlet_rate=rates.inlet_rate,
        fast_rate=rates.fast_rate,
        gains=tuple(gains.gains.tolist()),
        **box,
    )


def _force_error(element: FilmMemoryContact, record: ContactRecord) -> _Floats:
    force = np.empty(len(record))
    film_drive(element.law, record.T, record.approach, record.rate, force)
    return force - record.force


def _source(response: Response, records: Sequence[ContactRecord]) -> dict[str, Any]:
    point, domain = getattr(response, "point", None), getattr(response, "domain", None)
    return {
        "point": None if point is None else point.to_dict(),
        "scales": None if getattr(response, "scales", None) is None else asdict(response.scales),  # type: ignore[attr-defined]
        "n": getattr(response, "n", None),
        "domain": None if domain is None else list(domain.as_tuple()),
        "motion": [record.motion for record in records],
        "version": __version__,
    }
