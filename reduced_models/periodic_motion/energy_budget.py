"""`EnergyBudget`: who damps what in periodic answers, the energy that every part takes in a period.

Over a period inertia and stiffness give back what they took: all parts together take what unbalances, forces and
passing balls put in. A part takes the integral of its force times its rate, a dashpot C that of v^T C v. The
force of a ball bearing with a loss factor is that of its balls times the filters r of the seat: films take Re r
times what the balls would alone, harmonic by harmonic, and rings and fits the rest, as in a damping budget.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks.kinds import Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.quantities import NUMBER, TIME, Quantity
from ehlcontact.results.table import Display
from ehlcontact.store import stored
from ehlcontact.summary import counted
from reduced_models.bearing.linear_balls import SEAT
from reduced_models.bearing.loss import loss_of, response
from reduced_models.periodic_motion.answer import PeriodicAnswer
from reduced_models.rotor.linear_bearing import LinearBearing
from reduced_models.rotor.loss_parts import matrix_losses
from reduced_models.rotor.part_shares import PartShares
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.supports import BearingMount, bearing_names, is_ball_bearing

_Floats = NDArray[np.float64]

JOULE, WATT = Quantity("J"), Quantity("W")
FILMS = "films"
TOLD = 4  # answers that the summary has


@stored("energy budget")
@dataclass(frozen=True, eq=False, kw_only=True)
class EnergyBudget(PartShares):
    """Energy that p parts take in a period of k periodic answers; a part that puts energy in has it below 0.

    Attributes
    ----------
    over : str
        Parameter of the answers, as of `PeriodicAnswer`.
    value : ndarray, shape (k,)
        Of that parameter.
    period : ndarray, shape (k,)
        Of the answers [s].
    parts : tuple of str
        Names of what takes energy, as "bearing 0, films", "bearing 0, rings and fits", "shaft".
    work : ndarray, shape (p, k)
        In a period [J].
    """

    over: str
    value: Annotated[_Floats, NUMBER.over("answer")]
    period: Annotated[_Floats, TIME.over("answer")]
    parts: tuple[str, ...]
    work: Annotated[_Floats, JOULE.over("part answer")]

    DISPLAY: ClassVar[Display] = Display(rows="part", first=0)

    def _display(self) -> Display:
        return replace(self.DISPLAY, labels={"part": self.parts})

    def _summary_lines(self) -> list[str]:
        lines = [
            f"{self.over} {value:.6g}: {power:.4g} W; {self.share_words(k) or 'nothing takes energy'}"
            for k, (value, power) in enumerate(zip(self.value[:TOLD], self.power.sum(axis=0)[:TOLD], strict=True))
        ]
        return [counted(self.value.size, "periodic answer"), *lines]

    @property
    def power(self) -> Annotated[_Floats, WATT.over("part answer")]:
        """Mean power of each part [W], shape (p, k)."""
        return np.asarray(self.work / self.period)

    @property
    def share(self) -> Annotated[_Floats, NUMBER.over("part answer")]:
        """Work over the sum of its sizes, shape (p, k); without parts that put energy in 1 in sum."""
        return self._share()

    @property
    def amounts(self) -> _Floats:
        """`work`."""
        return self.work

    @property
    def columns(self) -> tuple[tuple[str, ...], str]:
        """Values of the parameter."""
        return tuple(f"{value:.5g}" for value in self.value.tolist()), self.over

    def to_dict(self) -> dict[str, Any]:
        """All numbers, ready for JSON."""
        return super().to_dict() | {"over": self.over, "parts": list(self.parts)}


@takes(rotor=Object(Rotor, "a Rotor"))
def energy_budget(rotor: Rotor, answers: PeriodicAnswer | Sequence[PeriodicAnswer]) -> EnergyBudget:
    """Energy that every part of a rotor takes in a period of its periodic answers.

    Parameters
    ----------
    rotor : Rotor
        Whose answers they are.
    answers : PeriodicAnswer or sequence of PeriodicAnswer
        As ``PeriodicBranch.answers``.

    Raises
    ------
    InputError
        No answers, or answers of another rotor.
    """
    several = [answers] if isinstance(answers, PeriodicAnswer) else list(answers)
    if not several or not all(isinstance(one, PeriodicAnswer) for one in several):
        raise InputError("answers", f"{len(several)} entries", "a PeriodicAnswer, or several")
    rows = []
    for one in several:
        if one.run.displacement.shape[1] != rotor.size:
            has = f"{one.run.displacement.shape[1]} degrees of freedom"
            raise InputError("answers", has, f"of the rotor, which has {rotor.size}")
        rows.append(_work(rotor, one))
    return EnergyBudget(
        over=several[0].over,
        value=np.array([one.value for one in several]),
        period=np.array([one.period for one in several]),
        parts=tuple(rows[0]),
        work=np.array([list(row.values()) for row in rows]).T,
    )


def _work(rotor: Rotor, answer: PeriodicAnswer) -> dict[str, float]:
    """Work of every part in a period [J], by name."""
    run, names = answer.run, bearing_names(rotor.bearings)
    found: dict[str, float] = {}
    mean = answer.period / (len(run.t) - 1)  # first and last sample are one
    force, rate = run.force[1:], run.rate[1:]
    for k, contact in enumerate(rotor.contacts):
        found[f"contact {k}"] = contact.count * mean * float(force[:, k] @ rate[:, k])
    first = len(rotor.contacts)
    for mount, name in zip(rotor.bearings, names, strict=True):
        at = slice(first, first + len(mount.directions))
        first = at.stop
        if isinstance(mount.bearing, LinearBearing):
            continue  # in the matrices
        whole = mean * float((force[:, at] * rate[:, at]).sum())
        if is_ball_bearing(mount):
            found |= _of_balls(mount, name, whole, answer, force[:, at], rate[:, at])
        else:
            found[name] = whole
    q, v = run.displacement[1:], run.velocity[1:]
    for name, (damping, skew) in matrix_losses(rotor, answer.speed).items():
        found[name] = mean * float(((v @ damping) * v).sum() + ((q @ skew.T) * v).sum())
    return found


def _of_balls(
    mount: BearingMount, name: str, whole: float, answer: PeriodicAnswer, force: _Floats, rate: _Floats
) -> dict[str, float]:
    """Work of the films of a ball bearing, and of its rings and fits."""
    factor, films = mount.ball_bearing.loss_factor, f"{name}, {FILMS}"
    if factor == 0.0:
        return {films: whole}
    forces, rates = (np.fft.rfft(values, axis=0)[1:] / len(values) for values in (force, rate))
    s = np.asarray(1j * answer.omega * np.arange(1, len(forces) + 1), np.complex128)
    seat = response(loss_of(factor), s)[:, None]
    power = 2.0 * float((seat.real * (rates.conj() * forces / seat).real).sum())
    return {films: answer.period * power, f"{name}, {SEAT}": whole - answer.period * power}
