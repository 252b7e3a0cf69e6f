"""`ContactRecord`: histories of approach, rate and force, the data of every fit."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import (
    as_column,
    parts,
    require_choice,
    require_finite,
    require_instance,
    require_positive,
    shown,
)
from ehlcontact.checks.admissible_range import Quantity
from ehlcontact.checks.frequency import fields_by_name
from ehlcontact.checks.kinds import ENTRIES, Count
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import InputError
from ehlcontact.point import POINT, OperatingPoint, Point, Scales, moes_point
from ehlcontact.quantities import ACCELERATION, FORCE, LENGTH, MASS, RATE, TIME, scaled
from ehlcontact.results.table import Display, PointTable
from ehlcontact.status import Status
from ehlcontact.summary import contact_text, quantity_text
from reduced_models.elements.validity import UNITS

_Floats = NDArray[np.float64]

# Least samples of a record; a fit needs more samples than parameters besides.
FEWEST_SAMPLES = 4
# Largest distance of approach and integrated rate, as a share of the motion: 8 samples per period of a true rate
# stay below it, a wrong sign, unit or delay does not.
RATE_MISMATCH = 0.1
FAR = 100.0  # static loads or dry approaches: a history whose largest value is beyond is in another unit
OTHER_LENGTHS = {"mm": 1e-3, "um": 1e-6, "nm": 1e-9}
_MASS = "mass: 1/Omega_n^2 of a dimensionless record"
_REQUIRED = ("t", "approach", "rate", "force")
_HISTORIES = (*_REQUIRED, "load", "acceleration")


@fields_take(point=POINT, n=Count(2, 100_000), domain=parts.ANY, motion=ENTRIES, conditions=ENTRIES)
@fields_by_name(6, omega_n=_MASS, Omega_n=_MASS)
@dataclass(frozen=True, eq=False)
class ContactRecord(PointTable):
    """One history of a contact, simulated or measured, in the units of its point.

    These are SI at an `OperatingPoint` and, after the semicolon, Moes units at a `MoesPoint`.

    Parameters
    ----------
    t, approach, rate, force : array_like, shape (N,)
        Time [s; 2a/u_sum], mutual approach [m; dry approach], its time derivative and contact force [N; static
        load].
    load, acceleration : array_like, shape (N,), optional
        Applied load and second derivative of the approach.
    point : MoesPoint or OperatingPoint, optional
        The contact.
    n : int, optional
        Grid intervals of the simulation.
    domain : tuple of float, optional
        (x_in, x_out, y_max) of the simulation; damping depends on it.
    motion : mapping, optional
        Description of the motion. ``Omega`` of a harmonic load is in u_sum/(2a) where there is a point, else in
        the units of the record.
    conditions : mapping, optional
        Supply, heat and sliding of the film, by their keywords in `ehlcontact.simulate`, as dictionaries.
    mass : float, optional
        Of bodies with inertia [kg; 1/Omega_n^2 of eq. 5].
    static_load : float, optional
        Load at which the static approach (``root``) of a fit is given; by default that of the point, 1 for a
        dimensionless record.
    units : {"SI", "dimensionless"}, optional
        By default those of the point; without a point "dimensionless".

    Raises
    ------
    InputError
        A history that is not one-dimensional, too short, not finite or of another length than t; t not
        strictly increasing; units of another point; at an `OperatingPoint` approaches or forces in another unit
        than m and N, as their size says. The message names the field.
    """

    t: Annotated[_Floats, TIME.over("t")]
    approach: Annotated[_Floats, LENGTH.over("t")]
    rate: Annotated[_Floats, RATE.over("t")]
    force: Annotated[_Floats, FORCE.over("t")]
    load: Annotated[_Floats | None, FORCE.over("t")] = None
    acceleration: Annotated[_Floats | None, ACCELERATION.over("t")] = None
    point: Point | None = None  # type: ignore[assignment]  # nothing is converted where it is None
    n: int | None = None
    domain: tuple[float, ...] | None = None
    motion: Mapping[str, Any] | None = None
    conditions: Mapping[str, Any] | None = None
    mass: Annotated[float | None, MASS] = None
    static_load: Annotated[float | None, FORCE] = None
    units: str = ""

    DISPLAY: ClassVar[Display] = Display(rows="t", panels=("force load", "approach", "rate"))

    def _in_si(self) -> bool:
        return self.units == "SI"

    def _summary_lines(self) -> list[str]:
        kind = "" if self.motion is None else f", {self.motion.get('kind', 'a motion')}"
        under = f", with {', '.join(self.conditions)}" if self.conditions else ""
        end = quantity_text(self.t[-1], self._unit("t"))
        return [
            f"{self.units}{kind}{under}, {self.t.size} samples up to t = {end}",
            *([] if self.point is None else [contact_text(self.point)]),
            f"approach {self._amount('approach')}, force {self._amount('force')}",
        ]

    def __post_init__(self) -> None:
        if self.point is None:
            units = self.units or "dimensionless"
        else:
            units = "SI" if isinstance(self.point, OperatingPoint) else "dimensionless"
            if self.units not in ("", units):
                raise InputError("units", self.units, f"left out, or those of the point, {units!r}")
        object.__setattr__(self, "units", require_choice("units", units, UNITS))
        if self.domain is not None:
            as_column("domain", self.domain, size=3)
        object.__setattr__(self, "t", as_column("t", self.t, least=FEWEST_SAMPLES, increasing=True))
        for name in _HISTORIES[1:]:
            values = getattr(self, name)
            if name in _REQUIRED or values is not None:
                object.__setattr__(self, name, as_column(name, values, size=self.t.size))
        if isinstance(self.point, OperatingPoint):
            self._require_units_of(self.point.scales)
        if self.static_load is None and self.point is not None:
            object.__setattr__(self, "static_load", self.point.scales.force)
        elif self.static_load is None and self.units == "dimensionless":
            object.__setattr__(self, "static_load", 1.0)
        for name in ("mass", "static_load"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, require_positive(name, getattr(self, name)))

    def _require_units_of(self, scales: Scales) -> None:
        """Raise `InputError`, with a guess, for histories that are hardly in metres and newton."""
        unit, force = scales.length, scales.force
        length = Quantity("m", (0.0, FAR * unit), (0.1 * unit, 10.0 * unit), OTHER_LENGTHS)
        length.require("largest approach", float(np.abs(self.approach).max()))
        load = Quantity("N", (force / FAR, FAR * force), (0.1 * force, 10.0 * force), {"kN": 1e3}, zero=True)
        load.require("largest force", float(np.abs(self.force).max()))

    @classmethod
    @takes()
    def from_result(cls, simulation: Any, *, accept_unconverged: bool = False) -> Self:
        """Record of an `ehlcontact` simulation, in its units.

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
        if not all(hasattr(simulation, name) for name in ("t", *_HISTORIES[1:], "status", "motion", "mass")):
            allowed = "a SimulationResult, as of ehlcontact.simulate"
            raise InputError("simulation", shown(simulation), allowed)
        status = str(simulation.status)
        if status != Status.CONVERGED and not accept_unconverged:
            raise InputError(
                "simulation.status",
                status,
                "'converged' (in Python, accept_unconverged=True takes it all the same)",
            )
        domain, conditions = simulation.domain, getattr(simulation, "conditions", None)
        if not isinstance(domain, tuple | list):
            domain = (domain.x_in, domain.x_out, domain.y_max)
        return cls(
            t=simulation.t,
            approach=simulation.approach,
            rate=simulation.rate,
            force=simulation.force,
            load=simulation.load,
            acceleration=simulation.acceleration,
            point=simulation.point,
            n=int(simulation.n),
            domain=tuple(float(value) for value in domain),
            motion=dict(simulation.motion.to_dict()),
            conditions=None if conditions is None else {k: v.to_dict() for k, v in conditions.keywords.items()},
            mass=simulation.mass,
        )

    def __len__(self) -> int:
        return int(self.t.size)

    @property
    def dimensionless(self) -> Self:
        """The record in Moes units.

        Raises
        ------
        InputError
            In SI without a point.
        """
        if self.units == "dimensionless":
            return self
        if self.point is None:
            raise InputError("point", None, "given: it has the units of a record in SI")
        own = scaled(self, self.point.scales, back=True)
        return replace(self, point=self.point.moes, units="dimensionless", **own)

    def in_units_of(self, point: Point) -> Self:
        """The record in the units of a point; raises `InputError` where that is another one."""
        own, moes = self.dimensionless, moes_point(point)
        if own.point != moes:
            theirs = (
                "given to the record" if own.point is None else f"that of the record, {contact_text(own.point)}"
            )
            raise InputError("point", contact_text(moes), theirs)
        if moes is point:
            return own
        return replace(own, point=point, units="SI", **scaled(own, point.scales))

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
            period = 2.0 * np.pi / self._own_frequency(motion["Omega"])
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
            return self._own_frequency(motion["Omega"])
        spread = float(np.std(self.approach))
        return float(np.std(self.rate)) / spread if spread > 0.0 else 0.0

    def _own_frequency(self, Omega: float) -> float:
        """Frequency of the motion in the units of the record."""
        return float(Omega) if self.point is None else float(Omega) * self.point.scales.frequency

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
        raise InputError("records", shown(records), allowed)
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
