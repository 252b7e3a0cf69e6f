"""Numbers and the picture of docs/asperities.md.

python docs/site/asperities.py   # two minutes
"""

from math import pi
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ehlcontact import Asperities, Grid, Lubricant, OperatingPoint, solve_steady

IMAGES = Path(__file__).parents[1] / "images"
GRID = Grid(96)
LAMBDAS = np.array([0.5, 0.7, 1.0, 1.5, 2.0, 2.5, 3.0])
BALL = {"ball_diameter": 7.938e-3, "pitch_diameter": 39.04e-3, "conformity": 0.52}  # 6205
CASES = {  # of an inner race of a 6205: speed in rev/min, load of the ball in N; of a ball on a flat: m/s and N
    "6205, 480 N, 3000 rev/min": (3000.0, 480.0),
    "6205, 120 N, 3000 rev/min": (3000.0, 120.0),
    "6205, 480 N, 9000 rev/min": (9000.0, 480.0),
    "ball of 20 mm on a flat, 20 N, 1 m/s": None,
}


def contact(case):
    """The operating point of a case."""
    oil = Lubricant.iso_vg(68, temperature=60.0)
    if case is None:
        return OperatingPoint.ball_on_flat(oil, ball_diameter=0.02, entrainment_speed=1.0, load=20.0)
    return OperatingPoint.ball_bearing(oil, **BALL, speed_rpm=case[0], load=case[1])


def shares(point):
    """Solved load shares, those without a solve, and what the film gains, over LAMBDAS of the smooth film."""
    smooth = solve_steady(point, grid=GRID)
    mean = point.load / (pi * point.scales.a * point.scales.b)
    rows = []
    for ratio in LAMBDAS:
        rough = Asperities(smooth.h_central / ratio)
        found = solve_steady(point, grid=GRID, asperities=rough, throw=False)
        if found.status.ok:
            law = float(rough.load_share(found.h_central, mean, point.geometry.e_reduced))
            seen = found.asperities
            rows.append((seen.film_over_rq, seen.load_share, law, seen.film_share, found.cycles))
    return np.array(rows)


def main():
    """Print the table and draw the picture."""
    figure = Figure(figsize=(9.0, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2)
    for name, case in CASES.items():
        found = shares(contact(case))
        print(name)
        for row in found:
            print(
                "  lambda {:.2f}: {:.3g} %, law {:.3g} %, film {:.4f}, cycles {:.0f}".format(
                    row[0], 100 * row[1], 100 * row[2], *row[3:]
                )
            )
        (line,) = left.semilogy(found[:, 0], 100.0 * found[:, 1], "o", label=name)
        left.semilogy(found[:, 0], 100.0 * found[:, 2], "-", color=line.get_color(), lw=1.0)
    left.set(xlabel="central film over Rq", ylabel="load on asperities [%]", xlim=(0.4, 3.2), ylim=(1e-3, 20.0))
    left.legend(fontsize=7, loc="lower left")
    left.set_title("solved (points), 1 - exp(-p/mean) (lines)", fontsize=9)
    found = solve_steady(contact((3000.0, 480.0)), grid=Grid(128), asperities=Asperities(0.3e-6))
    s = found.point.scales
    Y = np.concatenate([-found.y[:0:-1], found.y]) / s.b
    field = np.concatenate([found.asperities.pressure[:, :0:-1], found.asperities.pressure], axis=1)
    picture = right.pcolormesh(found.x / s.a, Y, field.T * 1e-6, shading="gouraud", cmap="magma_r")
    right.set(xlim=(-1.3, 1.3), ylim=(-1.2, 1.2), xlabel="x/a, along rolling", ylabel="y/b")
    right.set_title("asperities of Rq 0.3 µm, 480 N, 3000 rev/min [MPa]", fontsize=9)
    figure.colorbar(picture, ax=right)
    figure.savefig(IMAGES / "asperities.png", dpi=130)
    point = contact((3000.0, 480.0))
    rough, e = Asperities(0.1e-6), point.geometry.e_reduced
    gap = rough.gap(point.scales.pressure, e)
    pressure, area = point.scales.pressure, pi * point.scales.a * point.scales.b
    stiff, elastic = area * float(rough.stiffness(gap, e)), 1.5 * point.load / point.scales.length
    print(f"at rest: gap {gap / rough.rq:.2f} Rq in the centre under {pressure / 1e6:.0f} MPa")
    print(f"unit {rough.unit(e) / 1e6:.0f} MPa, stiffness {stiff / 1e6:.0f}, of Hertz {elastic / 1e6:.0f} N/um")


if __name__ == "__main__":
    main()
