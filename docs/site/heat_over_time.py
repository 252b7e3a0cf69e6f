"""Picture of docs/notes/heat.md: film and temperatures while the load doubles, with heat and without.

python docs/site/heat_over_time.py   # half a minute
"""

from pathlib import Path
from time import process_time

from matplotlib.figure import Figure

from ehlcontact import Domain, Grid, Heat, Lubricant, OperatingPoint, PrescribedLoad, TimeSteps, simulate

IMAGES = Path(__file__).parents[1] / "images"
POINT = OperatingPoint.ball_bearing(
    Lubricant.iso_vg(68, temperature=50.0),
    ball_diameter=12.3e-3,
    pitch_diameter=43.5e-3,
    conformity=0.52,
    speed_rpm=10_000.0,
    load=800.0,
)
GRID = Grid(128, Domain(-6.0, 2.0, 3.5))
END, RISE, STEP = 8.0, 0.5, 0.05


def runs():
    """Without heat and with it, and the processor time of each."""
    motion = PrescribedLoad([0.0, 1.0, 1.0 + RISE, 2.0 * END], [1.0, 1.0, 2.0, 2.0])
    unit = POINT.scales.time
    time = TimeSteps(until=END * unit, dt=STEP * unit)
    for thermal in (None, Heat()):
        started = process_time()
        run = simulate(POINT, motion, grid=GRID, thermal=thermal, time=time)
        print(f"{process_time() - started:.1f} s, {run.cycles[1:].mean():.2f} cycles a step")
        yield run


def draw(cold, warm):
    """Load and films, and temperatures."""
    figure = Figure(figsize=(8.6, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    for run, style, name in ((cold, "k--", "isothermal"), (warm, "C3-", "with heat")):
        left.plot(run.dimensionless.t, run.h_central / run.h_central[0], style, label=name)
    left.set(xlabel="T (unit of time a/u)", ylabel="central film over that at rest")
    right.plot(warm.dimensionless.t, warm.warmest_oil, "C3-", label="warmest oil")
    right.plot(warm.dimensionless.t, warm.warmest_surface, "C0-", label="warmest surface")
    right.set(xlabel="T (unit of time a/u)", ylabel="K above the inlet")
    for axes in (left, right):
        axes.axvspan(1.0, 1.0 + RISE, color="0.9")
        axes.grid(alpha=0.3)
        axes.legend(frameon=False, fontsize=8)
    figure.savefig(IMAGES / "heat_over_time.png", dpi=130)


def main():
    """All of it."""
    cold, warm = runs()
    for run in (cold, warm):
        print(f"central film {run.h_central[0] * 1e6:.4f} to {run.h_central[-1] * 1e6:.4f} um")
    ends = warm.warmest_oil[[0, -1]], warm.warmest_surface[[0, -1]]
    print(f"oil {ends[0]}, at most {warm.warmest_oil.max():.1f} K; surface {ends[1]}")
    print(f"balance {warm.heat_balance.max():.0e}")
    draw(cold, warm)


if __name__ == "__main__":
    main()
