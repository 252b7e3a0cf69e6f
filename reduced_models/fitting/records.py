"""`ContactRecord`: histories of approach, rate and force, the data of every fit."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import as_column, require_choice, require_finite, require_instance, require_positive
from ehlcontact.checks.frequency import fields_by_name
from ehlcontact.errors import InputError
from ehlcontact.point import Point
from ehlcontact.quantities import ACCELERATION, FORCE, LENGTH, RATE, TIME
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.status import Status
from ehlcontact.summary import contact_text, span
from reduced_models.elements.validity import UNITS

_Floats = NDArray[np.float64]

# Least samples of a record; a fit needs more samples than parameters besides.
FEWEST_SAMPLES = 4
# Largest distance of approach and integrated rate, as a share of the motion: 8 samples per period of a true rate
# stay below it, a wrong sign, unit or delay does not.
RATE_MISMATCH = 0.1
_REQUIRED = ("t", "approach", "rate", "force")
_HISTORIES = (*_REQUIRED, "load", "acceleration")


@fields_by_name(6, omega_n="Omega_n, dimensionless")
@dataclass(frozen=True, eq=False)
class ContactRecord(QuantityTable):
    """One history of a contact, simulated or measured.

    Parameters
    ----------
    t, approach, rate, force : array_like, shape (N,)
        Time, mutual approach, its time derivative and contact force: dimensionless, or s, m, m/s and N.
    load, acceleration : array_like, shape (N,), optional
        Applied load and second derivative of the approach.
    point : MoesPoint or OperatingPoint, optional
        Operating point of the contact.
    n : int, optional
        Grid intervals of the simulation.
    domain : tuple of float, optional
        (x_in, x_out, y_max) of the simulation; damping depends on it.
    motion : mapping, optional
        Description of the motion.
    Omega_n : float, optional
        Of eq. 5; None for a record without inertia. Dimensionless records only.
    static_load : float, optional
        Load at which the static approach (``root``) of a fit is given; 1 for a dimensionless record.
    units : {"dimensionless", "SI"}

    Raises
    ------
    InputError
        A history that is not one-dimensional, too short, not finite or of another length than t; t not
        strictly increasing; Omega_n with SI units. The message names the field.
    """

    t: Annotated[_Floats, TIME.over("t")]
    approach: Annotated[_Floats, LENGTH.over("t")]
    rate: Annotated[_Floats, RATE.over("t")]
    force: Annotated[_Floats, FORCE.over("t")]
    load: Annotated[_Floats | None, FORCE.over("t")] = None
    acceleration: Annotated[_Floats | None, ACCELERATION.over("t")] = None
    point: Point | None = None
    n: int | None = None
    domain: tuple[float, ...] | None = None
    motion: Mapping[str, Any] | None = None
    Omega_n: float | None = None
    static_load: float | None = None
    units: str = "dimensionless"

    DISPLAY: ClassVar[Display] = Display(rows="t", panels=("force load", "approach", "rate"))

    def _in_si(self) -> bool:
        return self.units == "SI"

    def _summary_lines(self) -> list[str]:
        kind = "" if self.motion is None else f", {self.motion.get('kind', 'a motion')}"
        return [
            f"{self.units}{kind}, {self.t.size} samples up to t = {self.t[-1]:.4g}",
            contact_text(self.point),
            f"approach {span(self.approach)}, force {span(self.force)}",
        ]

    def __post_init__(self) -> None:
        require_choice("units", self.units, UNITS)
        object.__setattr__(self, "t", as_column("t", self.t, least=FEWEST_SAMPLES, increasing=True))
        for name in _HISTORIES[1:]:
            values = getattr(self, name)
            if name in _REQUIRED or values is not None:
                object.__setattr__(self, name, as_column(name, values, size=self.t.size))
        if self.Omega_n is not None:
            object.__setattr__(self, "Omega_n", require_positive("Omega_n", self.Omega_n))
            if self.units == "SI":
                raise InputError("Omega_n", self.Omega_n, "None for a record in SI units")
        if self.static_load is None and self.units == "dimensionless":
            object.__setattr__(self, "static_load", 1.0)
        elif self.static_load is not None:
            object.__setattr__(self, "static_load", require_positive("static_load", self.static_load))

    @classmethod
    def from_result(cls, simulation: Any, *, accept_unconverged: bool = False) -> Self:
        """Record of an `ehlcontact` simulation.

        Parameters
        ----------
        simulation : SimulationResult
            Of ``ehlcontact.simulate``, or read back from its file.
        accept_unconverged : bool
            Take the record of a run that did not end as converged.

        Raises
        ------
        InputError
            No simulation, one that did not converge, or histories that cannot be used.
        """
        if not all(hasattr(simulation, name) for name in ("t", *_HISTORIES[1:], "status", "motion", "domain")):
            allowed = "a SimulationResult, as of ehlcontact.simulate"
            raise InputError("simulation", type(simulation).__name__, allowed)
        status = str(simulation.status)
        if status != Status.CONVERGED and not accept_unconverged:
            raise InputError(
                "simulation.status",
                status,
                "'converged' (in Python, accept_unconverged=True takes it all the same)",
            )
        motion, point = dict(simulation.motion.to_dict()), simulation.point
        simulation = simulation.dimensionless
        domain = simulation.domain
        if not isinstance(domain, tuple | list):
            domain = (domain.x_in, domain.x_out, domain.y_max)
        return cls(
            t=simulation.t,
            approach=simulation.approach,
            rate=simulation.rate,
            force=simulation.force,
            load=simulation.load,
            acceleration=simulation.acceleration,
            point=point,
            n=int(simulation.n),
            domain=tuple(float(value) for value in domain),
            motion=motion,
            Omega_n=motion.get("Omega_n"),
        )

    def __len__(self) -> int:
        return int(self.t.size)

    @property
    def default_window(self) -> tuple[float, float]:
        """Default window of a fit: the last two thirds.

        A record starts on the film of a steady contact, and until the first film made by the motion has
        crossed, the force is not the one that belongs to the motion; it spoils a viscous fit. Of harmonic
        records the last whole periods within these two thirds are taken, because part of a period lets the
        misfit of the spring leak into the damper. Of a ramp the whole record is: later it never comes near
        the static load again.
        """
        start, end = float(self.t[0]), float(self.t[-1])
        motion = self.motion or {}
        if motion.get("kind") == "ramp":
            return start, end
        if motion.get("kind") == "harmonic" and motion.get("Omega"):
            period = 2.0 * np.pi / motion["Omega"]
            periods = int((end - start) / 1.5 / period + 1e-9)
            if periods >= 1:
                return end - periods * period, end
        return start + (end - start) / 3.0, end

    @property
    def frequency(self) -> float:
        """Angular frequency of the motion in the units of the record: Omega, or rad/s.

        Of a harmonic load its own, else from the spreads of rate and approach; 0 where nothing moves.
        """
        motion = self.motion or {}
        if motion.get("kind") == "harmonic" and motion.get("Omega"):
            return float(motion["Omega"])
        spread = float(np.std(self.approach))
        return float(np.std(self.rate)) / spread if spread > 0.0 else 0.0

    def require_matching_rate(self) -> None:
        """Make sure that `rate` is the time derivative of `approach`.

        The rate is integrated by trapezoids, which noise does not upset as differences would, and a straight
        drift, as of an offset sensor, is left out.

        Raises
        ------
        InputError
            What remains is more than a tenth of the motion: another sign or unit, a delay, or samples too far
            apart for the motion.
        """
        moved = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(self.t) * (self.rate[1:] + self.rate[:-1]))])
        trend = np.column_stack([np.ones_like(self.t), self.t - self.t.mean()])
        error = self.approach - moved
        error = error - trend @ np.linalg.lstsq(trend, error, rcond=None)[0]
        motion = max(float(np.std(self.approach)), float(np.std(moved)))
        still = motion <= 1e-12 * float(np.abs(self.approach).max())  # but for rounding
        share = 0.0 if still else float(np.std(error)) / motion
        if share > RATE_MISMATCH:
            raise InputError(
                "rate",
                f"{share:.0%} off the derivative of approach",
                f"the time derivative of approach within {RATE_MISMATCH:.0%} (sign, units, delay, sampling?)",
            )

    def window(self, start: float, end: float) -> Self:
        """The part with start <= t <= end.

        Raises
        ------
        InputError
            start >= end, or fewer than 4 samples between them.
        """
        start, end = require_finite("start", start), require_finite("end", end)
        if start >= end:
            raise InputError("start", start, f"below end = {end!r}")
        inside = (self.t >= start) & (self.t <= end)
        if np.count_nonzero(inside) < FEWEST_SAMPLES:
            span = f"[{float(self.t[0])!r}, {float(self.t[-1])!r}]"
            raise InputError("window", (start, end), f"one that holds {FEWEST_SAMPLES} samples of t in {span}")
        cut = {name: getattr(self, name)[inside] for name in _HISTORIES if getattr(self, name) is not None}
        return replace(self, **cut)


def as_records(records: object) -> tuple[ContactRecord, ...]:
    """One record or several as a tuple.

    Raises
    ------
    InputError
        Something else, or something else among them; one of them twice, which would count twice and make the
        intervals of a fit narrower than its data.
    """
    if isinstance(records, ContactRecord):
        return (records,)
    if not isinstance(records, Iterable):
        allowed = "a ContactRecord or a sequence of them; ContactRecord.from_result(result) makes one"
        raise InputError("records", type(records).__name__, allowed)
    taken = tuple(records)
    for i, record in enumerate(taken):
        require_instance(
            f"records[{i}]", record, ContactRecord, "a ContactRecord; ContactRecord.from_result(result) makes one"
        )
    again = repeated(taken)
    if again is not None:
        first, second = again
        raise InputError(f"records[{second}]", f"the record of records[{first}]", "another one: each counts once")
    return taken


def repeated(records: Sequence[ContactRecord]) -> tuple[int, int] | None:
    """Indices of the first two records with equal times, approach, rate and force."""
    for second, record in enumerate(records):
        for first, earlier in enumerate(records[:second]):
            if all(np.array_equal(getattr(record, name), getattr(earlier, name)) for name in _REQUIRED):
                return first, second
    return None
