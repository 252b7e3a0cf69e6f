"""The balls of two 6205 bearings shake a rotor of 34 kg as it runs up from 500 to 9000 rev/min, and down again.

Run ``python examples/studies/ball_passage.py [--out DIR]``: prints where the ball passage, and twice it, meet the
modes of the Campbell diagram, and where their amplitude is largest; draws ``ball_passage.png``. Half a minute.

The speed never reaches a mode itself (225 Hz and more), but balls pass 3.6 times in a turn. Nothing is out of
round: it is the changing number of balls under the load that shakes the rotor. Two cages do not start at the same
angle, so that it tilts, too. A mode swings most some time after it was met, on the way up as on the way down; how
long after, a single oscillator with its frequency and damping tells.
"""

from __future__ import annotations

import argparse
from math import pi
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ehlcontact import Lubricant
from reduced_models import (
    BallBearing,
    Disc,
    Rotor,
    Shaft,
    SpeedProfile,
    Support,
    campbell,
    linearise,
    rotor_on_bearings,
    simulate_rotor,
)
from reduced_models.rotor.campbell import Campbell, CriticalSpeed
from reduced_models.rotor.result import RotorResult

STEEL = {"youngs_modulus": 211e9, "poisson_ratio": 0.2993, "density": 7810.0}
RANGE, SECONDS, DT = (500.0, 9000.0), 5.0, 5e-5  # rev/min, s, s
SPEEDS = np.linspace(*RANGE, 18)  # rev/min, of the diagram
MODES = 4
UNBALANCE = 1e-4  # kg m: 3 um on the disc, balance quality G 2.8 at the highest speed
LOAD = 500.0  # N on a bearing
WINDOW = 0.06  # s, over which an amplitude is taken
BESIDE = 0.08  # of a crossing: how far from it its peak is looked for


class Peak(NamedTuple):
    """A crossing of a multiple of the ball passage and a mode, and the speeds [rev/min] of largest amplitude."""

    passages: int
    crossing: CriticalSpeed
    up: float
    expected_up: float  # of a single oscillator
    down: float | None  # of twice the passage, none: modes still ring that the passage itself has met before
    expected_down: float | None
    height: float  # of the peak on the way up, over the least amplitude beside it


def bearing() -> BallBearing:
    """Bearing and oil."""
    return BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))


def rotor(held: BallBearing) -> Rotor:
    """Shaft of 300 x 40 mm, a disc of 280 x 70 mm in its middle, bearings 50 mm from its ends."""
    disc = Disc.cylinder(
        position=0.15, diameter=0.28, width=0.07, bore=0.04, density=7810.0, unbalance=UNBALANCE,
        load=(0.0, -2.0 * LOAD),
    )  # fmt: skip
    other = -pi / 2.0 + 0.3 * 2.0 * pi / held.balls
    supports = [Support(position=0.05, bearing=held), Support(position=0.25, bearing=held, cage_angle=other)]
    shaft = Shaft(length=0.3, diameter=0.04, elements=6, **STEEL)
    return rotor_on_bearings(shaft, discs=[disc], supports=supports, gravity=(0.0, 0.0))


def courses() -> tuple[SpeedProfile, SpeedProfile]:
    """Up and down."""
    return SpeedProfile.ramp(*RANGE, SECONDS), SpeedProfile.ramp(*RANGE[::-1], SECONDS)


def run(held: BallBearing, course: SpeedProfile, dt: float = DT) -> RotorResult:
    """The rotor along a course."""
    return simulate_rotor(rotor(held), speed_rpm=course, dt=dt, until=SECONDS)


def tracked(signal: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Amplitude of what turns with an angle [rad], through a Hann window."""
    steps = round(WINDOW / DT)
    window = np.hanning(steps)
    turned = (signal - signal.mean()) * np.exp(-1j * angle)
    return np.abs(2.0 * np.convolve(turned, window / window.sum(), "same"))


def oscillator(diagram: Campbell, mode: int, speed_rpm: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Displacement of a mode alone, with its frequency and damping of every speed, pushed along an angle."""
    s = np.interp(speed_rpm, diagram.speed_rpm, diagram.growth[:, mode]) + 1j * np.interp(
        speed_rpm, diagram.speed_rpm, diagram.omega[:, mode]
    )
    grows, push = np.exp(s * DT), np.cos(angle)
    moved, z = np.zeros(angle.size), 0j
    for k in range(1, angle.size):
        z = z * grows[k] + push[k] * DT
        moved[k] = z.imag
    return moved


def peaks(held: BallBearing, diagram: Campbell, runs: tuple[RotorResult, RotorResult]) -> list[Peak]:
    """All crossings of the ball passage and of twice it, each in the motion of its own mode."""
    line, found = rotor(held), []
    for passages in (1, 2):
        order = passages * held.orders.bpfo_order
        for crossing in diagram.critical_speeds(order):
            shape = shape_of(line, crossing)
            speeds: list[float | None] = []
            height = 0.0
            for one, course in zip(runs, courses(), strict=True):
                if one is runs[1] and passages > 1:
                    speeds += [None, None]
                    continue
                angle = order * course.at(one.t)[1]
                near = np.abs(one.speed_rpm / crossing.speed_rpm - 1.0) < BESIDE
                own = tracked(one.displacement @ line.mass @ shape, angle)[near]
                alone = tracked(oscillator(diagram, crossing.mode, one.speed_rpm, angle), angle)[near]
                speeds += [float(one.speed_rpm[near][np.argmax(size)]) for size in (own, alone)]
                height = height or float(own.max() / own.min())
            found.append(Peak(passages, crossing, *speeds, height))
    return found


def shape_of(line: Rotor, crossing: CriticalSpeed) -> np.ndarray:
    """Real shape, shape (N,), of the mode at a crossing, by which its motion is told from that of others."""
    modes = linearise(line, crossing.speed_rpm).modes(MODES + 4)
    nearest = min(modes, key=lambda mode: abs(mode.hz - crossing.hz))
    return np.asarray(nearest.shape.real)


def picture(path: Path, held: BallBearing, diagram: Campbell, runs: tuple[RotorResult, RotorResult]) -> Any:
    """Waterfall of the run-up with the modes of the diagram; amplitudes of the modes up and down."""
    from matplotlib.figure import Figure

    line = rotor(held)
    found = [peak for peak in peaks(held, diagram, runs) if peak.passages == 1]
    figure = Figure(figsize=(10.0, 8.0), layout="constrained")
    above, below = figure.subfigures(2, 1)
    axes = above.add_subplot(1, 1, 1)
    steps, rows = round(0.25 / DT), 150
    starts = np.linspace(0, runs[0].t.size - steps, rows).astype(int)
    motion = runs[0].displacement @ line.mass @ sum(shape_of(line, peak.crossing) for peak in found)
    lines = [
        np.abs(np.fft.rfft(np.hanning(steps) * (motion[k : k + steps] - motion[k : k + steps].mean())))
        for k in starts
    ]
    hz, size = np.fft.rfftfreq(steps, DT), np.log10(np.array(lines) + 1e-30)
    shown = hz < 700.0
    speed = runs[0].speed_rpm[starts + steps // 2]
    axes.pcolormesh(speed, hz[shown], size[:, shown].T, vmin=size.max() - 5.0, cmap="viridis", rasterized=True)
    for mode in range(diagram.hz.shape[1]):
        axes.plot(diagram.speed_rpm, diagram.hz[:, mode], color="white", linewidth=0.9, linestyle=":")
    for order, name in ((1.0, "1x"), (held.orders.bpfo_order, "balls"), (2.0 * held.orders.bpfo_order, "twice")):
        axes.annotate(name, (min(650.0 / order * 60.0, 8300.0), min(650.0, 8300.0 / 60.0 * order)), color="white")
    axes.set(xlabel="speed [rev/min]", ylabel="frequency [Hz]", xlim=(speed[0], speed[-1]))
    axes.set_title("the modes' motion as the rotor runs up; dotted: Campbell diagram")
    for k, peak in enumerate(found):
        axes = below.add_subplot(1, len(found), k + 1)
        shape = shape_of(line, peak.crossing)
        for one, course, colour, way in zip(runs, courses(), ("#0072b2", "#d55e00"), ("up", "down"), strict=True):
            near = np.abs(one.speed_rpm / peak.crossing.speed_rpm - 1.0) < BESIDE
            balls = held.orders.bpfo_order * course.at(one.t)[1]
            size = tracked(one.displacement @ line.mass @ shape, balls)[near]
            axes.plot(one.speed_rpm[near], size / size.max(), color=colour, label=way)
        axes.axvline(peak.crossing.speed_rpm, color="#7f7f7f", linestyle=":", label="crossing")
        axes.set(title=f"mode {peak.crossing.mode + 1}, {peak.crossing.hz:.0f} Hz", xlabel="speed [rev/min]")
        axes.tick_params(axis="x", rotation=30)
    below.axes[0].set_ylabel("amplitude at the ball passage, over its largest")
    below.axes[0].legend(frameon=False)
    figure.savefig(path, dpi=110)
    return figure


def main() -> None:
    """Run, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path())
    arguments = parser.parse_args()
    held = bearing()
    diagram = campbell(rotor(held), SPEEDS, count=MODES)
    up, down = courses()
    runs = run(held, up), run(held, down)
    print("passages  mode  crossing [rpm]  largest up (a single oscillator's), down  their mean off the crossing")
    for peak in peaks(held, diagram, runs):
        print(f"{peak.passages:8d}  {peak.crossing.mode + 1:4d}  {peak.crossing.speed_rpm:14.0f}", end="")
        print(f"  {peak.up:.0f} ({peak.expected_up:.0f})", end="")
        if peak.down is None:
            print()
            continue
        off = 0.5 * (peak.up + peak.down) / peak.crossing.speed_rpm - 1.0
        print(f", {peak.down:.0f} ({peak.expected_down:.0f})  {100.0 * off:+.2f} %")
    arguments.out.mkdir(parents=True, exist_ok=True)
    picture(arguments.out / "ball_passage.png", held, diagram, runs)


if __name__ == "__main__":
    main()
