"""A rotor on two 6205 bearings runs up through its critical speeds, and down again, films and all.

Run ``python examples/run_up.py [--seconds 2] [--out DIR]``: prints where modes cross the speed and where the disc
swings most, and draws ``run_up.png``. Under a minute.

A rotor that speeds up swings most some time after the crossing; one that slows down likewise, so at a lower speed:
the critical speed lies in the middle. There are two, close together: the bearings are not as stiff across their
load as along it.
"""

from __future__ import annotations

import argparse
from math import pi
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact import Lubricant
from reduced_models import (
    BallBearing,
    BearingMount,
    BearingRun,
    MatrixRotor,
    SpeedCourse,
    Unbalance,
    simulate_on_bearings,
)

DISC, JOURNAL = 40.0, 1.0  # kg
SHAFT = 3.0e7  # N/m, of the disc against both journals
UNBALANCE = 2.0e-5  # kg m: half a micrometre on the disc, balance quality G 0.4
LOAD = (0.0, -0.5 * 9.81 * DISC)  # N on a bearing, but for its journal
RANGE = 4000.0, 9000.0  # rev/min
DT = 5e-5  # s


def bearing() -> BallBearing:
    """Bearing and oil."""
    return BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))


def rotor(held: BallBearing) -> MatrixRotor:
    """Disc between two journals; degrees of freedom x, y of the left journal, of the disc and of the right one."""
    spring = 0.5 * SHAFT * np.array([[1.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])
    masses = np.array([JOURNAL, DISC, JOURNAL])
    return MatrixRotor(
        mass=np.kron(np.diag(masses), np.eye(2)),
        stiffness=np.kron(spring, np.eye(2)),
        load=np.kron(masses, [0.0, -9.81]),
        mounts=tuple(BearingMount(bearing=held, x=x, y=x + 1) for x in (0, 4)),
        unbalances=(Unbalance(x=2, y=3, amount=UNBALANCE),),
    )


def critical_speeds(held: BallBearing) -> tuple[float, float]:
    """Speeds [rev/min] that the first mode across and along the load crosses."""
    line = rotor(held)
    speeds = np.linspace(*RANGE, 11)
    found = []
    for k in (0, 1):
        modes = []
        for speed in speeds:
            at = held.coefficients(LOAD, speed_rpm=speed, rpm=speed).stiffness[0, k, k]
            K, M = line.stiffness[k::2, k::2].copy(), line.mass[k::2, k::2]
            K[[0, 2], [0, 2]] += at
            modes.append(np.sqrt(np.linalg.eigvals(np.linalg.solve(M, K)).real.min()) * 30.0 / pi)
        found.append(float(np.interp(0.0, speeds - modes, speeds)))
    return found[0], found[1]


def runs(held: BallBearing, seconds: float) -> tuple[BearingRun, BearingRun]:
    """The rotor speeding up and slowing down, in so many seconds each."""
    both = []
    for ends in (RANGE, RANGE[::-1]):
        course = SpeedCourse(np.array([0.0, seconds]), np.array(ends))
        both.append(simulate_on_bearings(rotor(held), speed_rpm=course, dt=DT, until=seconds))
    return both[0], both[1]


def swing(run: BearingRun, direction: int) -> tuple[np.ndarray, np.ndarray]:
    """Speeds [rev/min] and swing of the disc [m] in every full turn: half of what it goes back and forth."""
    turns = np.cumsum(run.speed_rpm[:-1] / 60.0 * np.diff(run.t)).astype(int)
    starts = np.flatnonzero(np.diff(turns, prepend=-1))
    y = run.displacement[:-1, 2 + direction]
    size = 0.5 * (np.maximum.reduceat(y, starts) - np.minimum.reduceat(y, starts))
    return run.speed_rpm[starts[:-1]], size[:-1]


def peaks(up: BearingRun, down: BearingRun, direction: int) -> tuple[float, float]:
    """Speeds at which the disc swings most on the way up and on the way down."""
    speeds = []
    for run in (up, down):
        at, size = swing(run, direction)
        speeds.append(float(at[np.argmax(size)]))
    return speeds[0], speeds[1]


def picture(path: Path, up: BearingRun, down: BearingRun, critical: tuple[float, float]) -> Any:
    """Swing of the disc over speed, up and down."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 3.8), layout="constrained")
    for k, name in ((0, "across the load"), (1, "along the load")):
        axes = figure.add_subplot(1, 2, k + 1)
        for run, colour, way in ((up, "#0072b2", "speeding up"), (down, "#d55e00", "slowing down")):
            speed, size = swing(run, k)
            axes.plot(speed, size * 1e6, color=colour, label=way)
        axes.axvline(critical[k], color="#7f7f7f", linestyle=":", label="the mode crosses the speed")
        axes.set(title=f"disc, {name}", xlabel="speed [rev/min]", ylabel="swing [µm]")
        axes.legend(frameon=False)
    figure.savefig(path, dpi=110)
    return figure


def main() -> None:
    """Run, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=2.0, help="of each run")
    parser.add_argument("--out", type=Path, default=Path())
    arguments = parser.parse_args()
    held = bearing()
    critical = critical_speeds(held)
    up, down = runs(held, arguments.seconds)
    for k, name in ((0, "across"), (1, "along")):
        rising, falling = peaks(up, down, k)
        print(f"{name} the load: crossing at {critical[k]:.0f} rpm, ", end="")
        print(f"most swing at {rising:.0f} speeding up and {falling:.0f} slowing down")
    arguments.out.mkdir(parents=True, exist_ok=True)
    picture(arguments.out / "run_up.png", up, down, critical)


if __name__ == "__main__":
    main()
