"""A mass on the FMU of a contact, coupled by fmpy in three ways, and where each of them ends.

Run ``python examples/studies/coupling.py``: half a minute. It prints what is left of the amplitude after 40
periods and draws `coupling.png` beside it.

A ball of a 6305 carries 1 kN, the weight of the mass. The contact is stiff and damps little, so a loop lives on
what it does with time:

- explicit: set, doStep, get, while the mass goes through the same step with the force that it has, held. The force
  that does the right work is the one of the middle of that step, a step and a half after the inputs: the default
  `lead` of 1.5. With a force of the end of the FMU's step, a lead of 1, half the step times the stiffness is
  missing in the damping, and the vibration grows without bound at either step. With the default the amplitude is
  kept at a hundredth of the period; at a twentieth it is less than half of it after 40 periods, as the
  extrapolated motion adds to the damping.
- linearly implicit: a step to where the last force leads, then on the FMU's tangents to where mass and contact
  agree. No rollback, one doStep a step, and stable at both.
- implicit: doStep, look at force and tangents, take it back, until mass and FMU agree; and shorter steps where a
  step and its two halves differ.
"""

from __future__ import annotations

import argparse
import math
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import fmpy
import numpy as np

from ehlcontact import Lubricant, OperatingPoint
from fmu import export
from reduced_models import Atlas, simulate_oscillator

RPM, LOAD = 6000.0, 1000.0  # rev/min, N
MASS = LOAD / 9.81  # kg
START = 0.98  # of the approach at rest, from where the mass swings
PERIODS, PARTS = 40, (100, 20)  # steps in a period
LOST = 1000.0  # amplitudes of the start, at which a loop is given up
TOLERANCE = 1e-5  # of that amplitude, in a step whose length is controlled
HELD_PARALLEL, LATE, END = 1.5, 1.0, 0.0  # values of lead


def contact() -> Any:
    """Element of the most loaded ball, with its film's memory, in SI."""
    oil = Lubricant(eta0=0.037, alpha=2.0e-8)
    point = OperatingPoint.ball_bearing(
        oil, ball_diameter=12.3e-3, pitch_diameter=43.5e-3, conformity=0.52, speed_rpm=RPM, load=LOAD
    )
    return Atlas().element(point, "wide")


class Look(NamedTuple):
    """What the FMU says at the end of a step."""

    force: float  # N
    stiffness: float  # d(force)/d(approach at the end) [N/m]
    damping: float  # d(force)/d(rate at the end) [N s/m]


class Unit:
    """The FMU as a master has it: set inputs, make a step, read outputs; save, and go back."""

    def __init__(self, folder: str, lead: float, approach: float):
        description = fmpy.read_model_description(folder)
        self._references = {v.name: v.valueReference for v in description.modelVariables}
        self._raw = fmpy.instantiate_fmu(folder, description, fmi_type="CoSimulation")
        self._raw.setReal([self._references["lead"]], [lead])
        self._set(approach, 0.0)
        self._raw.setupExperiment(startTime=0.0)
        self._raw.enterInitializationMode()
        self._raw.exitInitializationMode()
        self.time, self.steps = 0.0, 0

    def _set(self, approach: float, rate: float) -> None:
        self._raw.setReal([self._references[name] for name in ("approach", "rate")], [approach, rate])

    def _get(self, *names: str) -> Look:
        return Look(*self._raw.getReal([self._references[name] for name in names]))

    def look(self) -> Look:
        """At the present time, the film as it is."""
        return self._get("force", "stiffness", "damping")

    def step(self, approach: float, rate: float, h: float) -> Look:
        """Set inputs, make a step, look at its end, through the film's memory."""
        self._set(approach, rate)
        self._raw.doStep(currentCommunicationPoint=self.time, communicationStepSize=h)
        self.time, self.steps = self.time + h, self.steps + 1
        return self._get("force", "step_stiffness", "step_damping")

    @contextmanager
    def saved(self) -> Iterator[Callable[[], None]]:
        """Save the state; what is yielded goes back to it."""
        state, time = self._raw.getFMUState(), self.time

        def back() -> None:
            self._raw.setFMUState(state)
            self.time = time

        try:
            yield back
        finally:
            self._raw.freeFMUState(state)

    def free(self) -> None:
        """End and free the instance."""
        self._raw.terminate()
        self._raw.freeInstance()


class Run(NamedTuple):
    """Times [s], approaches [m] and rates [m/s] at the ends of the steps, and how often the FMU was stepped."""

    t: np.ndarray
    approach: np.ndarray
    rate: np.ndarray
    steps: int


def explicit(unit: Unit, start: float, h: float, count: int, lost: float = math.inf) -> Run:
    """Set, doStep, get, the mass with its force held, as co-simulation tools do; not further than `lost` [m]."""
    u, v, rows, force = start, 0.0, [(0.0, start, 0.0)], unit.look().force
    for k in range(1, count + 1):
        ahead = unit.step(u, v, h).force
        a = (LOAD - force) / MASS
        u, v = u + h * (v + 0.5 * h * a), v + h * a
        force = ahead
        rows.append((k * h, u, v))
        if abs(u - start) > lost:
            break
    return Run(*np.array(rows).T, unit.steps)


def linearly_implicit(unit: Unit, start: float, h: float, count: int) -> Run:
    """Trapezoidal steps of the mass, the force linear about the one end that the FMU is asked for."""
    u, v, rows, force = start, 0.0, [(0.0, start, 0.0)], unit.look().force
    for k in range(1, count + 1):
        new = v + h * (LOAD - force) / MASS
        there = unit.step(u + 0.5 * h * (v + new), new, h)
        change = _correction(there, new - v, h, force)
        new -= change
        u, v = u + 0.5 * h * (v + new), new
        force = there.force - (0.5 * h * there.stiffness + there.damping) * change
        rows.append((k * h, u, v))
    return Run(*np.array(rows).T, unit.steps)


def _correction(there: Look, gain: float, h: float, force: float) -> float:
    """By how much a gain of rate misses m gain = h (load - (force + force at the end)/2), by the tangents."""
    miss = MASS * gain - h * (LOAD - 0.5 * (force + there.force))
    return miss / (MASS + 0.5 * h * (0.5 * h * there.stiffness + there.damping))


def balanced(unit: Unit, u: float, v: float, h: float, force: float) -> tuple[float, float, Look]:
    """Approach, rate and look at the end of a trapezoidal step, where mass and FMU agree: Newton's method."""
    new = v + h * (LOAD - force) / MASS
    with unit.saved() as back:
        for _ in range(20):
            at = u + 0.5 * h * (v + new)
            there = unit.step(at, new, h)
            change = _correction(there, new - v, h, force)
            if abs(change) <= 1e-12 * (abs(new) + abs(v) + h * LOAD / MASS):
                return at, new, there
            new -= change
            back()
    raise RuntimeError(f"mass and contact do not agree at t = {unit.time:g} s")


def implicit(unit: Unit, start: float, h: float, count: int) -> Run:
    """Steps of one length, each taken back until it balances."""
    u, v, rows, force = start, 0.0, [(0.0, start, 0.0)], unit.look().force
    for k in range(1, count + 1):
        u, v, there = balanced(unit, u, v, h, force)
        force = there.force
        rows.append((k * h, u, v))
    return Run(*np.array(rows).T, unit.steps)


def controlled(unit: Unit, start: float, until: float, allowed: float, omega: float) -> Run:
    """Steps as long as a step and its two halves agree within `allowed` [m], in approach or rate over `omega`.

    Either misses h^3, so both together tell what it is.
    """
    u, v, rows, force = start, 0.0, [(0.0, start, 0.0)], unit.look().force
    h = 0.01 / omega
    while unit.time < until * (1.0 - 1e-12):
        h = min(h, until - unit.time)
        with unit.saved() as back:
            coarse = balanced(unit, u, v, h, force)
            back()
            middle = balanced(unit, u, v, 0.5 * h, force)
            fine = balanced(unit, middle[0], middle[1], 0.5 * h, middle[2].force)
            du, dv = (fine[0] - coarse[0]) / 3.0, (fine[1] - coarse[1]) / 3.0
            error = math.hypot(du, dv / omega) / allowed
            if error > 1.0:
                back()
            else:
                u, v, there = fine[0] + du, fine[1] + dv, fine[2]
                force = there.force + there.stiffness * du + there.damping * dv
                rows.append((unit.time, u, v))
        h *= min(2.0, max(0.2, 0.9 * max(error, 1e-9) ** (-1.0 / 3.0)))
    return Run(*np.array(rows).T, unit.steps)


class Bench:
    """The mass on its contact: an FMU, unpacked in `folder`, and what the ways of coupling are compared with."""

    def __init__(self, element: Any, folder: Path):
        self.element = element
        self._fmu = fmpy.extract(str(export(element, folder / "ball.fmu")), unzipdir=str(folder / "ball"))
        self.rest = float(element.approach_at(LOAD))
        self.omega = math.sqrt(float(element.spring_tangent(self.rest)) / MASS)
        self.period = 2.0 * math.pi / self.omega
        self.start, self.first_amplitude = START * self.rest, (1.0 - START) * self.rest
        self._references: dict[bytes, Run] = {}

    def run(self, way: Callable[..., Run], lead: float, *arguments: float) -> Run:
        """One way of coupling on an instance of its own."""
        unit = Unit(self._fmu, lead, self.start)
        try:
            return way(unit, self.start, *arguments)
        finally:
            unit.free()

    def ways(self, part: int) -> dict[str, Run]:
        """All ways at steps of one part of a period."""
        h, count = self.period / part, PERIODS * part
        lost = LOST * self.first_amplitude
        return {
            "explicit, lead 1": self.run(explicit, LATE, h, count, lost),
            "explicit, lead 1.5": self.run(explicit, HELD_PARALLEL, h, count, lost),
            "linearly implicit": self.run(linearly_implicit, END, h, count),
            "implicit": self.run(implicit, END, h, count),
        }

    def controlled(self, tolerance: float = TOLERANCE) -> Run:
        """The implicit way with steps of its own choice."""
        return self.run(controlled, END, PERIODS * self.period, tolerance * self.first_amplitude, self.omega)

    def reference(self, t: np.ndarray) -> Run:
        """The Python element in continuous time."""
        key = t.tobytes()
        if key not in self._references:
            found = simulate_oscillator(self.element, t, mass=MASS, load=LOAD, u0=self.start)
            self._references[key] = Run(found.T, found.approach, found.rate, 0)
        return self._references[key]

    def amplitude(self, run: Run) -> np.ndarray:
        """Over that of the start, at every time: of approach and rate, which a sine has in turn."""
        return np.hypot(run.approach - self.rest, run.rate / self.omega) / self.first_amplitude

    def left(self, run: Run) -> float:
        """Amplitude over the last two periods of a run, over that of the reference."""
        late = run.t >= run.t[-1] - 2.0 * self.period
        ours, theirs = (self.amplitude(one)[late] for one in (run, self.reference(run.t)))
        return float(np.sqrt(np.mean(ours**2) / np.mean(theirs**2)))


def picture(path: Path, bench: Bench, runs: dict[int, dict[str, Run]], own: Run) -> Any:
    """Amplitude over time for each way, a column for each step; below, those that stay near the reference."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 5.6), layout="constrained")
    colours = ("#d55e00", "#e69f00", "#0072b2", "#009e73")
    exact = bench.reference(own.t)
    for column, (part, ways) in zip(figure.subplots(2, 2, sharex=True, sharey="row").T, runs.items(), strict=True):
        for panel in column:
            for colour, (name, run) in zip(colours, ways.items(), strict=True):
                panel.plot(run.t / bench.period, bench.amplitude(run), color=colour, label=name)
            for run, style, name in ((own, "k:", "implicit, own steps"), (exact, "k--", "Python element")):
                panel.plot(run.t / bench.period, bench.amplitude(run), style, lw=1.0, label=name)
        column[0].set(title=f"step: 1/{part} of the period", yscale="log", ylim=(1e-2, 1e2))
        column[1].set(xlabel="time [periods]", ylim=(0.8, 1.1))
    figure.axes[1].legend(frameon=False, fontsize="small")
    figure.supylabel("amplitude over that of the start")
    figure.savefig(path, dpi=110)
    return figure


def main() -> None:
    """Print and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path())
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(contact(), Path(folder))
        runs = {part: bench.ways(part) for part in PARTS}
        own = bench.controlled()
        print("step, way; amplitude over the reference's in the last two periods; periods; steps of the FMU")
        for part, ways in runs.items():
            for name, run in ways.items():
                print(
                    f"1/{part:<4} {name:<24}{bench.left(run):10.4g}{run.t[-1] / bench.period:8.1f}{run.steps:8d}"
                )
        print(f"own   {'implicit':<24}{bench.left(own):10.4g}{own.t[-1] / bench.period:8.1f}{own.steps:8d}")
        off = np.abs(own.approach - bench.reference(own.t).approach).max() / bench.first_amplitude
        print(f"with steps of its own the mass is at most {off:.1e} of the first amplitude off the Python element")
        picture(arguments.out / "coupling.png", bench, runs, own)


if __name__ == "__main__":
    main()
