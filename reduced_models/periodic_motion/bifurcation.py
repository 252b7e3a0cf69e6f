"""Bifurcation diagrams by runs, and Poincare sections: what a rotor does where it does not repeat itself, too.

A diagram goes through the values of a parameter in their order; every run begins with the state, films among it,
with which the one before it ended. Rising and falling values show different answers where there are several.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, parts, require_choice, require_integer, require_positive
from ehlcontact.checks.kinds import Callback, Count, Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.quantities import NUMBER, TIME, Quantity
from ehlcontact.results.picture import Picture
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.status import Status
from ehlcontact.store import stored
from ehlcontact.summary import counted, span
from reduced_models.periodic_motion.branch_result import UNITS
from reduced_models.periodic_motion.excitation import OVER, PASSAGE, Excitation, set_to
from reduced_models.periodic_motion.picture import diagram_picture, section_picture
from reduced_models.periodic_motion.step_map import StepMap
from reduced_models.rotor.nodes import ByNode, flat_nodes
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.rotor import Rotor

_Floats = NDArray[np.float64]

MIXED = Quantity("m, or rad where it turns")
MIXED_RATE = Quantity("m/s, or rad/s where it turns")
REPEATS = 1e-3  # of the motion's size: how near samples are of a motion that repeats itself
MOST_PERIODS = 8  # after which a motion is looked for to repeat itself
JUMP = 0.1  # change of the size between neighbouring values that may be a jump, over the larger size
HALVINGS, STAYS = 3, 0.7  # of the step there, and least share of the change that a jump keeps over them all


@stored("bifurcation diagram")
@dataclass(frozen=True, eq=False, kw_only=True)
class BifurcationDiagram(QuantityTable, ByNode):
    """Settled motions of a rotor over a parameter, each after a run from the one before it.

    Attributes
    ----------
    over : str
        The parameter: "speed" [rev/min], "amplitude", "clearance" [m], "preload" [m] or "frequency" [Hz].
    value : ndarray, shape (k,)
        Of the parameter, in the order of the runs.
    samples : ndarray, shape (k, kept, N)
        Displacements at the starts of the last periods of the excitation [m], or rad where they turn.
    peak_to_peak : ndarray, shape (k, N)
        Of all degrees of freedom over these periods.
    periods : ndarray, shape (k,)
        Periods of the excitation after which the motion repeats itself; 0: more than 8, or never.
    sharpness : ndarray, shape (k - 1,)
        Of the change of the size between neighbouring values, share that stays where the step is halved thrice
        about the largest part of it, by runs: 1 of a jump, 1/8 of a straight slope. 1 where the change is below a
        tenth, and where a run ends, too.
    status : Status
        "interrupted" after Ctrl-C, with the values until then.
    names, places
        As of `RotorResult`.
    """

    over: str
    value: Annotated[_Floats, NUMBER.over("value")]
    samples: _Floats
    peak_to_peak: Annotated[_Floats, MIXED.over("value dof")]
    periods: Annotated[NDArray[np.int64], NUMBER.over("value")]
    sharpness: _Floats
    status: Status = Status.CONVERGED
    names: tuple[str, ...] = ()
    places: NDArray[np.int64] = None  # type: ignore[assignment]

    DISPLAY: ClassVar[Display] = Display(rows="value", first=0)

    def __post_init__(self) -> None:
        if self.places is None:
            object.__setattr__(self, "places", np.zeros(0, np.int64))

    def _unit(self, name: str) -> str:
        return UNITS[self.over] if name == "value" else super()._unit(name)

    def _summary_lines(self) -> list[str]:
        unit = UNITS[self.over]
        jumps = ", ".join(f"{low:.6g} and {high:.6g}" for low, high in self.jumps())
        many = [counted(one, "period") for one in sorted(set(self.periods.tolist()) - {0})]
        runs = f"{self.status}, {counted(self.value.size, 'run')} over {self.over}"
        return [
            f"{runs}, {span(self.value)} {unit}".rstrip(),
            f"motions repeat themselves after {', '.join(many) or 'no period'}",
            f"{np.count_nonzero(self.periods == 0)} of more than {MOST_PERIODS} periods, or none",
            f"jumps between {jumps} {unit}".rstrip() if jumps else "no jump",
        ]

    def jumps(self, share: float = JUMP) -> tuple[tuple[float, float], ...]:
        """Neighbouring values between which the size of the motion jumps by more than a share of it.

        A steep slope is no jump: its change becomes smaller where the step does (`sharpness`).
        """
        size = self.peak_to_peak.max(axis=1)
        change = np.abs(np.diff(size)) > require_positive("share", share) * np.maximum(size[1:], size[:-1])
        jumped = np.flatnonzero(change & (self.sharpness > STAYS)).tolist()
        return tuple((float(self.value[k]), float(self.value[k + 1])) for k in jumped)

    def picture(self) -> Picture:
        """Samples and sizes over the parameter."""
        return diagram_picture(self)


@stored("Poincare section")
@dataclass(frozen=True, eq=False, kw_only=True)
class PoincareSection(QuantityTable, ByNode):
    """States of a rotor at equal distances in time.

    Attributes
    ----------
    t : ndarray, shape (k,)
        Times [s].
    displacement, velocity : ndarray, shape (k, N)
        Of all degrees of freedom [m], [m/s], or rad where they turn.
    names, places
        As of `RotorResult`.
    """

    t: Annotated[_Floats, TIME.over("t")]
    displacement: Annotated[_Floats, MIXED.over("t dof")]
    velocity: Annotated[_Floats, MIXED_RATE.over("t dof")]
    names: tuple[str, ...] = ()
    places: NDArray[np.int64] = None  # type: ignore[assignment]

    DISPLAY: ClassVar[Display] = Display(rows="t", first=0)

    def _summary_lines(self) -> list[str]:
        many = repeats_after(self.displacement, np.ptp(self.displacement, axis=0).max())
        words = "do not repeat themselves" if many == 0 else f"repeat themselves after {many}"
        return [f"{counted(self.t.size, 'state')}, every {1e3 * (self.t[1] - self.t[0]):.5g} ms; they {words}"]

    def picture(self) -> Picture:
        """Velocity over displacement of every node, in x and y."""
        return section_picture(self)


def poincare(run: RotorResult, period: float, first: float = 0.0) -> PoincareSection:
    """Section of a run at multiples of a period [s] after a time `first` [s], by cubics between steps.

    Raises
    ------
    InputError
        A period that is not > 0, or a run that does not have two of them.
    """
    require_positive("period", period)
    count = int(np.floor((run.t[-1] - first) / period * (1.0 + 1e-12))) + 1
    if count < 2:
        raise InputError("period", period, f"at most {run.t[-1] - first:g} s, that of the run")
    t: _Floats = np.asarray(first + period * np.arange(count), np.float64)
    k = np.clip(np.searchsorted(run.t, t, side="right") - 1, 0, run.t.size - 2)
    h = np.diff(run.t)[k]
    s = ((t - run.t[k]) / h)[:, None]
    d, v, h = run.displacement, run.velocity, h[:, None]
    rise = d[k + 1] - d[k]
    first_left, second_left = h * v[k] - rise, rise - h * v[k + 1]  # Hermite's cubic beside the straight line
    bent = s * (1.0 - s) * ((1.0 - s) * first_left + s * second_left)
    slope = (1.0 - 2.0 * s) * ((1.0 - s) * first_left + s * second_left) + s * (1.0 - s) * (
        second_left - first_left
    )
    return PoincareSection(
        t=t, displacement=d[k] + s * rise + bent, velocity=(rise + slope) / h, names=run.names, places=run.places
    )


@takes(
    rotor=Object(Rotor, "a Rotor"), speed_rpm=parts.SPEEDS, periods=Count(1, 100_000), settle=Count(0, 1_000_000),
    steps=Count(16, 100_000), callback=Callback("made, values"),
)  # fmt: skip
def bifurcation_diagram(
    rotor: Rotor,
    values: ArrayLike,
    over: str = "speed",
    *,
    excitation: Excitation = PASSAGE,
    speed_rpm: float | None = None,
    start: Any = "static",
    settle: int = 200,
    periods: int = 32,
    steps: int = 128,
    callback: Callable[[int, int], object] | None = None,
    **options: Any,
) -> BifurcationDiagram:
    """Settled motions of a rotor over a parameter by runs, each from the end of the one before it.

    Where the size changes by more than a tenth three more runs tell a jump from a steep slope.

    Parameters
    ----------
    rotor : Rotor
    values : array_like, shape (k,)
        Of the parameter, in the order of the runs: rising, falling, or both.
    over : {"speed", "amplitude", "clearance", "preload", "frequency"}
        As of `periodic`.
    excitation : "unbalance", "passage" or PeriodicForce
    speed_rpm : float, optional
        Of the shaft, unless it is the parameter; by default that of the rotor [rev/min].
    start
        Of the first run, as of `shoot`.
    settle, periods : int
        Periods of the excitation before the first sample, and that are sampled.
    steps : int
        Time steps in a period.
    callback : callable, optional
        Called as ``callback(made, values)`` after every value.
    **options
        As of `StepMap`.

    Returns
    -------
    BifurcationDiagram
        With the values that were reached, after Ctrl-C.

    Raises
    ------
    InputError
        What `StepMap` refuses.
    ConvergenceError
        A step found no balance, or a ring left its bearing; ``result`` has the values before.
    """
    wanted = as_column("values", values)
    require_choice("over", over, tuple(OVER))
    speed_rpm = rotor.speed_rpm if speed_rpm is None else speed_rpm
    if speed_rpm is None and over != "speed":
        raise InputError("speed_rpm", None, "given: that of the shaft")
    require_integer("periods", periods, "a whole number >= 1", 1)
    made: list[tuple[_Floats, _Floats, int]] = []
    steps_of: StepMap | None = None
    sharpness: list[float] = []

    def settled_from(before: StepMap, value: float) -> tuple[StepMap, tuple[_Floats, _Floats, int]]:
        after = before.at(*set_to(rotor, speed_rpm or 0.0, excitation, over, value))
        return after, _settled(after, settle, periods)

    def sharpness_of(before: StepMap, low: float, high: float, first: float, last: float) -> float:
        """Of the change from size `first` to `last` between two values, from the settled motion at the first."""
        change = abs(last - first)
        if change <= JUMP * max(first, last):
            return 1.0
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            try:
                there, (_, sizes, _) = settled_from(before, middle)
            except ConvergenceError:
                return 1.0
            size = float(sizes.max())
            if abs(size - first) > abs(last - size):
                high, last = middle, size
            else:
                before, low, first = there, middle, size
        return abs(last - first) / change

    def diagram(status: Status) -> BifurcationDiagram:
        names, places = flat_nodes(rotor.nodes)
        kept = wanted[: len(made)]
        samples, sizes, repeats = (np.array([row[k] for row in made]) for k in range(3))
        return BifurcationDiagram(
            over=over,
            value=kept,
            samples=samples.reshape(kept.size, periods, rotor.size),
            peak_to_peak=sizes.reshape(kept.size, rotor.size),
            periods=repeats.astype(np.int64),
            sharpness=np.array([*sharpness, 1.0])[: max(kept.size - 1, 0)],
            status=status,
            names=names,
            places=places,
        )

    try:
        for value in wanted.tolist():
            if steps_of is None:
                here, speed, excited = set_to(rotor, speed_rpm or 0.0, excitation, over, value)
                steps_of = StepMap(here, speed, excited, start=start, steps=steps, **options)
                made.append(_settled(steps_of, settle, periods))
            else:
                before, (steps_of, answer) = steps_of, settled_from(steps_of, value)
                made.append(answer)
                first, last = (float(sizes.max()) for _, sizes, _ in made[-2:])
                sharpness.append(sharpness_of(before, float(wanted[len(made) - 2]), value, first, last))
            if callback is not None:
                callback(len(made), wanted.size)
    except KeyboardInterrupt:
        return diagram(Status.INTERRUPTED)
    except ConvergenceError as error:
        raise ConvergenceError(f"at {over} {wanted[len(made)]:.6g}: {error}", diagram(Status.FAILED)) from error
    return diagram(Status.CONVERGED)


def _settled(steps_of: StepMap, settle: int, periods: int) -> tuple[_Floats, _Floats, int]:
    """Samples of the last periods, shape (periods, N), sizes (N,), and after how many of them they repeat."""
    steps_of.march(steps_of.numbers, settle)
    samples, low, high = [], np.inf, -np.inf
    for _ in range(periods):
        samples.append(steps_of.places)
        steps_of.march(steps_of.numbers, 1)
        history = steps_of.run.histories.displacement
        low, high = np.minimum(low, history.min(axis=0)), np.maximum(high, history.max(axis=0))
    size = np.asarray(high - low)
    return np.array(samples), size, repeats_after(np.array(samples), float(size.max()))


def repeats_after(samples: _Floats, size: float) -> int:
    """After how many samples they repeat themselves to a share of the size of the motion; 0 where they do not."""
    for many in range(1, min(MOST_PERIODS, len(samples) // 2) + 1):
        if np.abs(samples[many:] - samples[:-many]).max() <= REPEATS * size:
            return many
    return 0
