"""Numbers and the picture of docs/notes/heat.md.

python docs/site/heat.py   # some minutes
"""

from itertools import product
from pathlib import Path
from time import process_time

import numpy as np
from matplotlib.figure import Figure

from ehlcontact import Grid, Heat, Lubricant, OperatingPoint, solve_steady
from ehlcontact.film_formulas import gupta_heating, wilson_heating
from ehlcontact.hertz import most_loaded_ball
from reduced_models.bearing.catalogue import deep_groove_row

IMAGES = Path(__file__).parents[1] / "images"
BEARINGS = (("6202", 500.0), ("6205", 1000.0), ("6305", 2000.0), ("6310", 5000.0))  # radial load, N
OILS = ((32, 50.0), (68, 50.0), (100, 70.0))  # grade, C
SPEEDS = (2000.0, 5000.0, 10_000.0, 15_000.0)  # rev/min
FASTEST = 7e5  # rev/min times mm of pitch diameter
SLIDING = (0.0, 0.05, 0.2)
GRID = Grid(128)


def ball(name, oil, rpm, load):
    """The most loaded ball on the inner race."""
    _, row = deep_groove_row(name)
    return OperatingPoint.ball_bearing(
        oil,
        ball_diameter=row.ball_diameter,
        pitch_diameter=row.pitch_diameter,
        conformity=row.conformity,
        speed_rpm=rpm,
        load=most_loaded_ball(load, row.balls),
    )


def gupta(q, pressure, slide):
    """Gupta et al. with sliding."""
    rolling = gupta_heating(q, pressure) * (1.0 + 0.213 * q**0.64)
    return rolling / (1.0 + 0.213 * (1.0 + 2.23 * slide**0.83) * q**0.64)


def murch(q, slide):
    """Murch and Wilson; without sliding that is Wilson and Sheu."""
    return 1.0 / (1.0 + 0.1 * (1.0 + 14.8 * slide**0.83) * (4.0 * q) ** 0.64)


def scan():
    """Thermal load, sliding, film share, both formulas and the balance, a row each."""
    rows = []
    for (name, load), (grade, temperature), rpm in product(BEARINGS, OILS, SPEEDS):
        if rpm * deep_groove_row(name)[1].pitch_diameter * 1e3 > FASTEST:
            continue
        point = ball(name, Lubricant.iso_vg(grade, temperature=temperature), rpm, load)
        pressure = point.scales.pressure / point.geometry.e_reduced
        for slide in SLIDING:
            found = solve_steady(point, grid=GRID, thermal=Heat(slide)).temperature
            q = found.thermal_load
            rows.append((q, slide, found.film_share, gupta(q, pressure, slide), murch(q, slide), found.balance))
    return np.array(rows)


def said(rows):
    """Deviations from the formulas."""
    for slide in SLIDING:
        q, _, share, one, other, balance = rows[rows[:, 1] == slide].T
        nearest = np.minimum(abs(share / one - 1.0), abs(share / other - 1.0))
        print(
            f"slide-to-roll {slide:g}: {q.size} points, thermal load {q.min():.3f} to {q.max():.2f}; "
            f"over Gupta {np.median(share / one):.3f} (largest {abs(share / one - 1.0).max():.3f}), "
            f"over Murch and Wilson {np.median(share / other):.3f} ({abs(share / other - 1.0).max():.3f}); "
            f"Gupta over Murch and Wilson {abs(one / other - 1.0).max():.3f}; "
            f"within 10 % of one: {np.mean(nearest < 0.1):.2f}; balance {balance.max():.0e}"
        )


def draw(rows):
    """Film share over the thermal load."""
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    axes = figure.subplots()
    for slide, marker in zip(SLIDING, "o^s", strict=True):
        q, _, share, one, _, _ = rows[rows[:, 1] == slide].T
        order = np.argsort(q)
        axes.plot(q, share, marker, ms=4, label=f"solved, slide-to-roll {slide:g}")
        axes.plot(q[order], one[order], "-", lw=0.8, color=axes.lines[-1].get_color())
    q = np.geomspace(0.005, 3.0, 100)
    axes.plot(q, list(map(wilson_heating, q)), "k--", lw=1.0, label="Wilson and Sheu, rolling")
    axes.set(xscale="log", xlabel="thermal load Q", ylabel="central film over the isothermal one")
    axes.plot([], [], "-", color="grey", lw=0.8, label="Gupta et al.")
    axes.legend(frameon=False)
    axes.grid(alpha=0.3)
    figure.savefig(IMAGES / "heat.png", dpi=130)


def main():
    """All of it."""
    rows = scan()
    said(rows)
    draw(rows)
    oil = Lubricant.iso_vg(68, temperature=50.0)
    fast = ball("6305", oil, 10_000.0, 2000.0)
    for n in (64, 128, 256):
        start = process_time()
        cold = solve_steady(fast, grid=Grid(n))
        middle = process_time()
        film = solve_steady(fast, grid=Grid(n), thermal=Heat())
        end, f = process_time(), film.temperature
        print(
            f"n {n}: film share {f.film_share:.5f}, smallest {film.h_min / cold.h_min:.4f}, "
            f"warmest {f.largest:.2f} K, surface {f.surfaces.max():.2f} K, "
            f"cycles {cold.cycles} and {film.cycles}, "
            f"time {(end - middle) / (middle - start):.2f}"
        )
    film = solve_steady(fast, thermal=Heat())
    cold = solve_steady(fast)
    print(film, cold, sep="\n")


if __name__ == "__main__":
    main()
