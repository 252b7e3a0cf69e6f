"""Numbers and pictures of docs/notes/speed.md.

python docs/site/speed_history.py   # three minutes
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ehlcontact import (
    Domain,
    Grid,
    MoesPoint,
    OilLayer,
    PrescribedLoad,
    SpeedHistory,
    TimeSteps,
    simulate,
    solve_steady,
)

IMAGES = Path(__file__).resolve().parents[1] / "images"
POINT = MoesPoint(200.0, 10.0, 1.0)
U = SpeedHistory([0.0, 1.0, 3.0, 11.0, 15.0, 25.0], [1.0, 1.0, 0.0, 0.0, -1.0, -1.0])  # stop, stand, back
UNTIL = 21.0


def steady_film(run, speed):
    """Central and smallest film that the momentary speed would have."""
    point = MoesPoint(POINT.M * speed**-0.75, POINT.L * speed**0.25, POINT.kappa)
    film = solve_steady(point, grid=Grid(run.n, run.domain))
    return film.h_central, film.h_min


def main():
    """Run, numbers and picture."""
    load = PrescribedLoad(np.linspace(0.0, UNTIL, 5), np.ones(5))
    run = simulate(POINT, load, speed=U, grid=Grid(n=192), time=TimeSteps(until=UNTIL, dt=0.05, tol=1e-4))
    speed = np.array([U(T) for T in run.t])
    for T in (0.0, 3.0, 11.0, 13.0, UNTIL):
        k = int(np.argmin(np.abs(run.t - T)))
        print(f"T = {T:4.1f}, U = {U(T):5.2f}: central {run.h_central[k] / run.h_central[0]:.3f}, "
              f"smallest {run.h_min[k] / run.h_min[0]:.3f} of the start")  # fmt: skip
    print(f"smallest of all {run.h_min.min() / run.h_min[0]:.3f} at T = {run.t[run.h_min.argmin()]:.2f}")
    draw(run, speed)


def draw(run, speed):
    """Films and speed over time, and the film along the middle over place and time."""
    figure = Figure(figsize=(10.5, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    left.plot(run.t, run.h_central / run.h_central[0], label="central film")
    left.plot(run.t, run.h_min / run.h_central[0], label="smallest film")
    rolling = np.linspace(0.15, 1.0, 10)
    known = np.array([steady_film(run, u) for u in rolling]) / run.h_central[0]
    for k in (0, 1):
        momentary = np.interp(np.abs(speed), np.append(0.0, rolling), np.append(0.0, known[:, k]))
        label = "steady at the momentary speed" if k == 0 else None
        left.plot(run.t, momentary, "--", color=f"C{k}", lw=0.9, label=label)
    left.plot(run.t, speed, ":", color="0.4", label="speed")
    left.set(xlabel="T, in 2a/u_sum", ylabel="film over the central one at the start; speed", ylim=(-1.1, 1.3))
    left.legend(loc="lower left", fontsize="small")
    film = np.ma.masked_greater(run.h_midplane / run.h_central[0], 2.0)
    drawn = right.pcolormesh(run.x, run.t, film, cmap="viridis", vmin=0.0, vmax=1.5, rasterized=True)
    figure.colorbar(drawn, ax=right, label="film along the middle over\nthe central one at the start")
    right.set(xlabel="x/a", ylabel="T, in 2a/u_sum", xlim=(-1.6, 1.6))
    figure.savefig(IMAGES / "speed_history.png", dpi=130)


def starved(ratio, speed, until):
    """A circle to and fro under a layer; flooded for None."""
    supply = None if ratio is None else OilLayer(over_flooded=ratio)
    load = PrescribedLoad(np.linspace(0.0, until, 5), np.ones(5))
    grid, steps = Grid(n=96, domain=Domain(-4.5, 4.5, 3.0)), TimeSteps(until=until, dt=0.05, tol=1e-5)
    return simulate(MoesPoint(20.0, 10.0, 1.0), load, speed=speed, grid=grid, supply=supply, time=steps)


def to_and_fro():
    """A layer of oil, and surfaces that turn back twice: central film, and where the film is full."""
    speed = SpeedHistory([0.0, 1.0, 3.0, 8.0, 10.0, 20.0], [1.0, 1.0, -1.0, -1.0, 1.0, 1.0])
    figure = Figure(figsize=(10.5, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    for ratio, label in ((None, "flooded"), (1.5, "r = 1.5"), (1.0, "r = 1")):
        run = starved(ratio, speed, 20.0)
        left.plot(run.t, run.h_central, label=label)
        at = [int(np.argmin(np.abs(run.t - T))) for T in (0.0, 8.0, 12.5, 20.0)]
        print(
            label,
            "central film at T = 0, 8, 12.5, 20:",
            *(f"{run.h_central[k] / run.h_central[0]:.3f}" for k in at),
        )
    left.plot(run.t, [0.1 * speed(T) for T in run.t], ":", color="0.4", label="speed / 10")
    left.set(xlabel="T, in 2a/u_sum", ylabel="central film, in dry approaches")
    left.legend(loc="center right", fontsize="small")
    right.pcolormesh(run.x, run.t, run.p_midplane > 0.0, cmap="Blues", vmax=2.0, rasterized=True)
    right.set(xlabel="x/a", ylabel="T, in 2a/u_sum", title="film under pressure at y = 0, r = 1", xlim=(-3.0, 3.0))
    figure.savefig(IMAGES / "speed_supply.png", dpi=130)


if __name__ == "__main__":
    main()
    to_and_fro()
