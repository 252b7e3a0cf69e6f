"""A rotor on two 6205 bearings runs up through its critical speeds, and down again, films and all.

    python examples/run_up.py [run_up.png]     # under a minute

What one learns: a Campbell diagram tells where modes cross the speed; a rotor that speeds up vibrates most some
time after the crossing, one that slows down likewise, so at a lower speed. There are two crossings, close
together: bearings are not as stiff across their load as along it.
"""

import sys

import numpy as np

from ehlcontact import Lubricant
from reduced_models import BallBearing, BearingMount, Rotor, SpeedProfile, Unbalance, campbell, simulate_rotor
from reduced_models.rotor.result import RotorResult

MASSES = np.array([1.0, 40.0, 1.0])  # kg, of journal, disc, journal
SHAFT = 1.5e7 * np.array([[1.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])  # N/m
UNBALANCE = 2e-5  # kg m: half a micrometre on the disc, balance quality G 0.4
RANGE = 4000.0, 9000.0  # rev/min


def rotor() -> Rotor:
    """Places x, y of the left journal, of the disc and of the right one."""
    held = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))
    return Rotor(
        mass=np.kron(np.diag(MASSES), np.eye(2)),
        stiffness=np.kron(SHAFT, np.eye(2)),
        load=np.kron(MASSES, [0.0, -9.81]),
        mounts=tuple(BearingMount(bearing=held, x=x, y=x + 1) for x in (0, 4)),
        unbalances=(Unbalance(x=2, y=3, amount=UNBALANCE),),
    )


def critical_speeds(line: Rotor) -> list[float]:
    """Speeds [rev/min] at which the unbalance meets a mode."""
    return [found.speed_rpm for found in campbell(line, np.linspace(*RANGE, 6), count=2).critical_speeds()]


def runs(line: Rotor, seconds: float) -> dict[str, RotorResult]:
    """Speeding up and slowing down, in so many seconds each."""
    courses = {"up": SpeedProfile.ramp(*RANGE, seconds), "down": SpeedProfile.ramp(*RANGE[::-1], seconds)}
    return {way: simulate_rotor(line, speed_rpm=course, dt=5e-5, until=seconds) for way, course in courses.items()}


def amplitude(run: RotorResult) -> tuple[np.ndarray, np.ndarray]:
    """Speed [rev/min] and amplitude of the disc [m] in every full turn: half of peak to peak."""
    turns = np.cumsum(run.speed_rpm[:-1] / 60.0 * np.diff(run.t)).astype(int)
    starts = np.flatnonzero(np.diff(turns, prepend=-1))
    disc = run.displacement[:-1, 2:4]
    size = 0.5 * (np.maximum.reduceat(disc, starts) - np.minimum.reduceat(disc, starts)).max(axis=1)
    return run.speed_rpm[starts[:-1]], size[:-1]


def most(run: RotorResult, crossings: list[float]) -> float:
    """Speed [rev/min] of the largest amplitude near the crossings; further on the disc still vibrates."""
    speed, size = amplitude(run)
    near = np.abs(speed / np.mean(crossings) - 1.0) < 0.1
    return float(speed[near][np.argmax(size[near])])


def main(picture: str = "run_up.png", seconds: float = 2.0) -> None:
    """Print where the amplitude of the disc is largest, and draw it."""
    from matplotlib.figure import Figure

    line = rotor()
    crossings = critical_speeds(line)
    print("modes cross the speed at", " and ".join(f"{speed:.0f}" for speed in crossings), "rev/min")
    axes = (figure := Figure(figsize=(9.0, 3.6), layout="constrained")).add_subplot()
    for (way, run), colour in zip(runs(line, seconds).items(), ("#0072b2", "#d55e00"), strict=True):
        print(f"on the way {way} the largest amplitude of the disc is at {most(run, crossings):.0f} rev/min")
        speed, size = amplitude(run)
        axes.plot(speed, size * 1e6, color=colour, label=f"on the way {way}")
    for k, crossing in enumerate(crossings):
        axes.axvline(crossing, color="#7f7f7f", linestyle=":", label=None if k else "modes cross the speed")
    axes.set(xlabel="speed [rev/min]", ylabel="amplitude of the disc [µm]")
    axes.legend(frameon=False)
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
