"""Picture of docs/notes/heat.md: film and temperatures while a contact stops, stands and rolls back.

python docs/site/heat_at_speeds.py   # a minute
"""

import numpy as np
from heat_over_time import IMAGES, POINT
from matplotlib.figure import Figure

from ehlcontact import Domain, Grid, Heat, PrescribedLoad, SpeedHistory, TimeSteps, simulate

GRID = Grid(192, Domain(-4.5, 4.5, 3.0))
SPEED = SpeedHistory([0.0, 1.0, 3.0, 8.0, 10.0, 20.0], [1.0, 1.0, 0.0, 0.0, -1.0, -1.0])
STOP, GO, END = 3.0, 8.0, 16.0


def main():
    """Both runs and the picture."""
    held, unit = PrescribedLoad([0.0, 1.0, 2.0, 100.0], [1.0] * 4), POINT.scales.time
    time = TimeSteps(until=END * unit, dt=0.1 * unit)
    cold, warm = (simulate(POINT, held, grid=GRID, speed=SPEED, thermal=t, time=time) for t in (None, Heat()))
    for T in (0.0, STOP, GO, END):
        k = int(np.searchsorted(warm.t / unit, T - 1e-9))
        film = cold.h_central[k] * 1e6, warm.h_central[k] * 1e6
        least = cold.h_min[k] * 1e6, warm.h_min[k] * 1e6
        print(
            f"T = {T:g}: film {film}, least {least} um; {warm.warmest_oil[k]:.2f}, {warm.warmest_surface[k]:.2f} K"
        )
    print(f"balance {warm.heat_balance.max():.0e}")
    figure = Figure(figsize=(8.6, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    for run, style, name in ((cold, "k", "isothermal"), (warm, "C3", "with heat")):
        left.plot(run.t / unit, run.h_central * 1e6, style, label=f"central, {name}")
        left.plot(run.t / unit, run.h_min * 1e6, style, ls="--", label=f"smallest, {name}")
    left.set(xlabel="T (unit of time a/u, 14 µs)", ylabel="film, µm", ylim=(-0.1, None))
    right.plot(warm.t / unit, warm.warmest_oil, "C3-", label="warmest oil")
    right.plot(warm.t / unit, warm.warmest_surface, "C0-", label="warmest surface")
    right.set(xlabel="T (unit of time a/u, 14 µs)", ylabel="K above the inlet")
    for axes in (left, right):
        axes.axvspan(STOP, GO, color="0.9", label="standstill")
        axes.grid(alpha=0.3)
        lower = {"loc": "lower left", "ncols": 2} if axes is left else {"loc": "center right"}
        axes.legend(frameon=False, fontsize=8, **lower)
    figure.savefig(IMAGES / "heat_at_speeds.png", dpi=130)


if __name__ == "__main__":
    main()
