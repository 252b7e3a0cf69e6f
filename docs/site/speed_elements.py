"""Table and picture of the element over speed in docs/notes/elements.md.

python docs/site/speed_elements.py   # five minutes: 21 runs of the full film
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ehlcontact import Grid, MoesPoint, PrescribedApproach, SpeedHistory, TimeSteps, simulate
from reduced_models import Atlas

IMAGES = Path(__file__).resolve().parents[1] / "images"
POINTS = {MoesPoint(2900, 19, 0.11): 192, MoesPoint(37, 12, 0.8): 64, MoesPoint(200, 10, 0.5): 64}
DT = 0.05
SPEEDS = {  # rows of T and U
    "run-up": [(0, 0.25), (1, 0.25), (7, 1), (10, 1)],
    "run-down": [(0, 1), (1, 1), (7, 0.1), (10, 0.1)],
    "slow run-up": [(0, 0.5), (2, 0.5), (26, 2), (30, 2)],
    "run-up with vibration": [(0, 0.25), (2, 0.25), (14, 1), (16, 1)],
    "ripple of the speed": None,
    "stop and go, with vibration": [(0, 1), (1, 1), (4, 0), (6, 0), (9, 1), (12, 1)],
    "reversal": [(0, 1), (1, 1), (7, -1), (12, -1)],
}
VIBRATIONS = {"run-up with vibration": (0.04, 0.5 * np.pi), "stop and go, with vibration": (0.02, np.pi)}


def motion(kind, static):
    """Times, speed, approach and its rate, shape (N,) each; `static` is the approach at rest."""
    rows = SPEEDS[kind]
    T = np.arange(0.0, 12.0 + 0.5 * DT if rows is None else rows[-1][0] + 0.5 * DT, DT)
    U = 1.0 + 0.2 * np.sin(0.5 * np.pi * T) if rows is None else np.interp(T, *zip(*rows, strict=True))
    amplitude, Omega = VIBRATIONS.get(kind, (0.0, 1.0))
    table = PrescribedApproach(T, static + amplitude * np.clip(T, 0.0, 1.0) * np.sin(Omega * T))
    return T, U, table, np.array([table.rate(t) for t in T])


def forces(point, n, kind):
    """Speed, force of the full film, of the element over speed, and what is simpler, over the same times."""
    atlas = Atlas()
    over, fixed = atlas.element_over_speed(point), atlas.element(point)
    T, U, table, rate = motion(kind, fixed.approach_at(1.0))
    run = simulate(point, table, grid=Grid(n), speed=SpeedHistory(T, U), time=TimeSteps(until=float(T[-1]), dt=DT))
    u = np.array([table.approach(t) for t in T])
    momentary = []
    for speed, approach in zip(U, u, strict=True):
        over.set_speed(speed)
        momentary.append(over.spring(approach))
    found = {"full": run.force, "element": over.drive(T, u, rate, U), "momentary": np.array(momentary)}
    return T, U, found | {"fixed": fixed.drive(T, u, rate)}


def errors(found):
    """Rms errors over the standard deviation of the full force; the largest error over the largest force."""
    full = found["full"]
    simple = ("element", "momentary", "fixed")
    rms = [float(np.sqrt(np.mean((found[name] - full) ** 2)) / full.std()) for name in simple]
    return *rms, float(np.abs(found["element"] - full).max() / full.max())


def main():
    """Runs, table and picture."""
    shown = {}
    for kind in SPEEDS:
        row = []
        for point, n in POINTS.items():
            T, U, found = forces(point, n, kind)
            rms, momentary, fixed, largest = (100.0 * error for error in errors(found))
            row.append(f"{rms:.1f} / {largest:.1f} ({momentary:.0f}, {fixed:.0f})")
            if point.M == 37:
                shown[kind] = T, U, found
        print(f"| {kind} | {' | '.join(row)} |", flush=True)
    draw(shown)


def draw(shown):
    """Force and speed over time, four kinds of motion."""
    figure = Figure(figsize=(10.5, 6.0), layout="constrained")
    kinds = ("run-up with vibration", "ripple of the speed", "stop and go, with vibration", "reversal")
    looks = {
        "full": ("k", "full film"),
        "element": ("C1", "element over speed"),
        "momentary": ("C0", "static, momentary speed"),
    }
    for axes, kind in zip(figure.subplots(2, 2).ravel(), kinds, strict=True):
        T, U, found = shown[kind]
        for name, (colour, label) in looks.items():
            axes.plot(T, found[name], color=colour, lw=0.9 if name == "momentary" else 1.5, label=label)
        axes.set(title=kind, xlabel="T, in 2a/u_sum", ylabel="force over the load of the point")
        speed = axes.twinx()
        speed.plot(T, U, ":", color="0.5", label="speed")
        speed.set(ylabel="speed (dotted)")
    figure.axes[0].legend(loc="lower right", fontsize="small")
    figure.savefig(IMAGES / "speed_elements.png", dpi=130)


if __name__ == "__main__":
    main()
