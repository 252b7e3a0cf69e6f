"""Joint fit of the film-memory element to an impedance and to any number of records."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact import Domain, Grid, impedance
from ehlcontact.checks import shown
from ehlcontact.errors import InputError
from ehlcontact.point import OperatingPoint
from ehlcontact.process.blas import one_blas_thread
from ehlcontact.results import Response
from reduced_models.elements.film_contact import FilmContact
from reduced_models.elements.film_curve import approach_under, film_and_exponent, power_nodes
from reduced_models.elements.film_law import FilmLaw, film_drive
from reduced_models.elements.film_response import WEIGHT_C, WEIGHT_K, FilterRates, GainFit, fit_gains
from reduced_models.elements.validity import Validity
from reduced_models.fitting.records import ContactRecord, as_records
from reduced_models.fitting.result import MemoryFit, rms_error, sum_error

_Floats = NDArray[np.float64]

# Frequencies that an impedance is solved at: rest, and evenly on the logarithm from slow rotors to far above the
# rate at which the film crosses the contact.
OMEGAS = (0.0, *np.geomspace(0.03, 60.0, 24).tolist())
LOWEST_OMEGA = 0.1  # a frequency up to here is needed: it gives the static tangent and the damping of rotors
FEWEST_OMEGAS = 8  # frequencies needed: twice as many numbers, for the 10 unknowns of the shortest chain
CHAIN_LENGTHS = (4, 6, 8, 12, 16)  # numbers of lags that cross-validation chooses from
SHORTER_CHAIN = 1.05  # a shorter chain is taken if its cross-validation error is at most so much larger
FOLDS = 3  # parts of the data, each of which cross-validation leaves out once
FORCE_WEIGHT = 0.01  # RMS error of a record over its spread that counts like 5 % of C
WEIGHTS = {"damping": WEIGHT_C, "stiffness": WEIGHT_K, "force": FORCE_WEIGHT}  # errors that count alike

# Search for rates (per time of the contact) and saturation of the inlet.
TRANSIT_TIME = 1.6  # start: time in which the chain carries the film through
RATE_STARTS = ((30.0, 60.0), (200.0, 80.0))  # of inlet and fast rate; the better of two minima is taken
SATURATION_START = 0.25
SEARCH_LIMITS = ((0.5, 200.0), (2.0, 300.0), (5.0, 1000.0), (0.0, 20.0))  # of lag, inlet, fast rate, saturation
SEARCH: dict[str, Any] = {"diff_step": 1e-3, "max_nfev": 30}  # steps of differences on logs of rates; rounds
SEARCH_TOLERANCE = 1e-4  # of the cost and of the logs, relative: a hundredth of a per cent of a rate

LOAD_RANGE_OF_IMPEDANCE = 0.1  # share of the load about 1 that an impedance alone, a small motion, stands for


@dataclass(frozen=True)
class Target:
    """Data of one fit in Moes units, as arrays in the order of frequency."""

    Omega: _Floats
    stiffness: _Floats
    damping: _Floats
    approach: float
    records: tuple[ContactRecord, ...] = ()

    @classmethod
    def of(cls, response: Response, records: Sequence[ContactRecord]) -> Target:
        """Check and sort.

        Raises
        ------
        InputError
            Too few frequencies or none low enough, an approach beyond the dry one, SI records, or records that
            are not of the contact of the impedance.
        """
        order = np.argsort(response.omega)
        Omega = response.omega[order]
        if Omega.size < FEWEST_OMEGAS:
            raise InputError("frequencies of the impedance", Omega.size, f"at least {FEWEST_OMEGAS} frequencies")
        if Omega[0] > LOWEST_OMEGA:
            raise InputError("lowest Omega", float(Omega[0]), f"at most {LOWEST_OMEGA}")
        film = response.film
        if film is None:
            raise InputError("response.film", None, "that of a solved contact, from `impedance`")
        if not film.approach < 1.0:
            raise InputError("approach", film.approach, "below 1: there must be a film (refine the grid)")
        for i, record in enumerate(records):
            if record.units != "dimensionless":
                allowed = "dimensionless, or with a point that has its units"
                raise InputError(f"records[{i}].units", record.units, allowed)
            for name, ours, theirs in (("point", film.point, record.point), ("n", film.n, record.n)):
                if theirs is not None and ours != theirs:
                    raise InputError(f"records[{i}].{name}", theirs, f"as of the impedance, {ours!r}")
            record.require_matching_rate()
        stiffness, damping = response.stiffness[order], response.damping[order]
        return cls(Omega, stiffness, damping, film.approach, tuple(records))

    @property
    def film(self) -> tuple[float, float]:
        """Film at load 1 and its exponent."""
        return film_and_exponent(self.approach, float(self.stiffness[0]))

    @property
    def static(self) -> float:
        """Tangent of the element's static curve at load 1."""
        film, exponent = self.film
        return 1.0 / (2.0 / 3.0 + exponent * film)

    @property
    def motion(self) -> tuple[_Floats, _Floats | None, _Floats]:
        """Approach, rate and force of the data; of an impedance alone, the ends of a small static motion."""
        if self.records:
            u, v, f = (
                np.concatenate([getattr(record, name) for record in self.records])
                for name in ("approach", "rate", "force")
            )
            return u, v, f
        loads = np.array([1.0 - LOAD_RANGE_OF_IMPEDANCE, 1.0 + LOAD_RANGE_OF_IMPEDANCE])
        return approach_under(loads, *self.film), None, loads

    def part(self, fold: int, inside: bool) -> Target:
        """The data of one fold, or all but those; the lowest frequency belongs to all."""
        keep = (np.arange(self.Omega.size) % FOLDS == fold) == inside
        keep[0] = True
        records = tuple(r for i, r in enumerate(self.records) if (i % FOLDS == fold) == inside)
        return replace(
            self,
            Omega=self.Omega[keep],
            stiffness=self.stiffness[keep],
            damping=self.damping[keep],
            records=records,
        )


@one_blas_thread()
def fit_memory(
    response: Response | None, records: ContactRecord | Sequence[ContactRecord] = (), *, lags: int | None = None
) -> MemoryFit:
    """Fit one element to the impedance of a contact and to records of its motion, whole and from rest.

    The static curve follows from approach and static tangent; the gains from linear least squares in every step
    (variable projection); rates and inlet saturation from what is left. Relative errors of 5 % in C, 1 % in
    K (each RMS over the frequencies) and 1 % of the spread of the force of each record count alike.

    Parameters
    ----------
    response : Response or None
        To approach, from `impedance`, with an Omega of at most 0.1; 20 or more from 0 to 60 make a good element.
        None has it solved for the point, grid and domain of the first record.
    records : ContactRecord or sequence of ContactRecord
        Of the same contact on the same grid and domain.
    lags : int, optional
        Length of the chain; by default the shortest whose cross-validation error is within 5 % of the best.

    Returns
    -------
    MemoryFit
        In the units of the impedance: SI at an `OperatingPoint`, Moes units at a `MoesPoint`.

    Raises
    ------
    InputError
        Data that do not go together; see `Target.of`.
    """
    taken = as_records(records)
    if response is not None and not isinstance(response, Response):
        raise InputError("response", shown(response), "a Response, from `impedance`, or None")
    if response is None:
        response = impedance_of(taken)
    point = response.point
    target = Target.of(
        response if point is None else response.dimensionless,
        [record if record.point is None else record.dimensionless for record in taken],
    )
    scores: dict[int, float] = {}
    if lags is None:
        scores = {length: cross_validate(target, length) for length in CHAIN_LENGTHS}
        best = min(scores.values())
        lags = min(length for length, score in scores.items() if score <= SHORTER_CHAIN * best)
    FilterRates(lags, 1.0, 1.0, 1.0)  # raises InputError for a wrong number of lags
    element, gains = _solve(target, lags)
    forces = [(record.force, _force(element.law, record)) for record in target.records]
    whole = [np.concatenate(parts) for parts in zip(*forces, strict=True)]
    root = element.approach_at(1.0)
    result = MemoryFit(
        element=element,
        model=element.kind,
        parameters=element.parameters,
        rms=rms_error(*whole) if taken else None,
        e_f=sum_error(*whole) if taken else None,
        root=root,
        tangent=element.spring_tangent(root),
        valid=element.validity.to_dict(),
        condition=None,
        record_rms=tuple(rms_error(*pair) for pair in forces),
        damping_error=gains.damping / target.damping - 1.0,
        stiffness_error=gains.stiffness / target.stiffness - 1.0,
        validation=scores,
        weights=WEIGHTS,
    )
    assert response.film is not None
    source = response.film.source([record.motion for record in taken])
    result = replace(result, element=replace(element, fit=result.quality(), source=source))
    return result.to_si(point.scales) if isinstance(point, OperatingPoint) else result


def impedance_of(records: Sequence[ContactRecord]) -> Response:
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
    return impedance(first.point, Omega=OMEGAS, grid=Grid(n=first.n, domain=Domain(*first.domain)))


def cross_validate(target: Target, lags: int) -> float:
    """RMS of the weighted residuals on the data left out, each third of frequencies and records in turn."""
    squares = []
    for fold in range(FOLDS):
        element, _ = _solve(target.part(fold, inside=False), lags)
        left_out = target.part(fold, inside=True)
        w = left_out.Omega
        Z = element.impedance(Omega=w)
        damping = Z.damping / left_out.damping - 1.0
        squares.append(np.mean((damping[w > 0.0] / WEIGHT_C) ** 2))
        squares.append(np.mean(((Z.stiffness / left_out.stiffness - 1.0) / WEIGHT_K) ** 2))
        for record in left_out.records:
            error = _force(element.law, record) - record.force
            squares.append(np.mean((error / np.std(record.force) / FORCE_WEIGHT) ** 2))
    return float(np.sqrt(np.mean(squares)))


def _solve(target: Target, lags: int) -> tuple[FilmContact, GainFit]:
    """Nonlinear least squares over logs of the rates and the inlet saturation, gains projected out."""
    curve = power_nodes(*target.film) | {"gain_x": np.zeros(1)}

    def parts(p: _Floats) -> tuple[FilterRates, GainFit, float]:
        rates = FilterRates(lags, *(float(value) for value in np.exp(p[:3])))
        gains = fit_gains(rates, target.Omega, target.stiffness, target.damping, target.static)
        return rates, gains, float(p[3]) if target.records else 0.0

    def residuals(p: _Floats) -> _Floats:
        rates, gains, inlet_saturation = parts(p)
        rows = [gains.residuals / np.sqrt(target.Omega.size)]
        # The law alone: an element checks and stores far more than a step of the search needs.
        law = FilmLaw(
            **curve,
            gains=gains.gains[None],
            lag_rate=rates.lag_rate,
            inlet_rate=rates.inlet_rate,
            fast_rate=rates.fast_rate,
            inlet_saturation=inlet_saturation,
            rim=0.0,
        )
        for record in target.records:
            error = _force(law, record) - record.force
            rows.append(error / (FORCE_WEIGHT * np.std(record.force) * np.sqrt(len(record))))
        return np.concatenate(rows)

    lower, upper = np.array(SEARCH_LIMITS).T.copy()
    lower[:3], upper[:3] = np.log(lower[:3]), np.log(upper[:3])
    tolerances = {"xtol": SEARCH_TOLERANCE, "ftol": SEARCH_TOLERANCE}
    solutions = []
    for inlet, fast in RATE_STARTS:
        start = np.array([np.log(lags / TRANSIT_TIME), np.log(inlet), np.log(fast), SATURATION_START])
        solutions.append(
            scipy.optimize.least_squares(residuals, start, bounds=(lower, upper), **tolerances, **SEARCH)
        )
    rates, gains, inlet_saturation = parts(min(solutions, key=lambda solution: solution.cost).x)
    return _element(target, rates, gains, inlet_saturation), gains


def _element(target: Target, rates: FilterRates, gains: GainFit, inlet_saturation: float) -> FilmContact:
    film, exponent = target.film
    return FilmContact.memory(
        film=film,
        exponent=exponent,
        inlet_saturation=inlet_saturation,
        **rates.coefficients,
        gains=tuple(gains.gains.tolist()),
        **Validity.of(*target.motion, target.Omega).fields(),
    )


def _force(law: FilmLaw, record: ContactRecord) -> _Floats:
    """Force of the law along the record."""
    force = np.empty(len(record))
    motion = (np.array(values) for values in (record.t, record.approach, record.rate))  # not read-only
    film_drive(law, *motion, force)
    return force
