"""A dimple rolls through a lubricated contact: Mourier et al. (2006), measured and computed, beside this solver.

A ball with a dimple rolls on a glass disc, and interferometry shows the gap along the centre line while the
dimple passes. Mourier, Mazuyer, Lubrecht and Donnet, Tribology International 39 (2006) 1745, measure a dimple
about 7 um deep, thirty times the film, and compute one 0.175 um deep; both are run here. The formula for the
dimple stands out in a rim of 1.7 % of its depth: of the deep one 0.12 um, more than half the film, which the
measured one evidently had not. About two minutes on one core:

    python examples/studies/dimple.py [dimple.png]
"""

import argparse
import csv
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ehlcontact import (
    Dent,
    Geometry,
    Grid,
    KeepSettings,
    Lubricant,
    OperatingPoint,
    PrescribedLoad,
    RunSettings,
    TimeSteps,
    simulate,
    solve_steady,
)
from ehlcontact.film import film_of, interferogram
from ehlcontact.transient.result import SimulationResult

DATA = Path(__file__).parent / "data" / "mourier_2006.csv"
E_REDUCED = 110e9  # Pa, with 2/E' = (1 - nu1^2)/E1 + (1 - nu2^2)/E2
HALF = E_REDUCED * (1.0 - 0.3**2)  # two equal bodies of this modulus have it
POINT = OperatingPoint(
    Geometry(12.5e-3, 12.5e-3, e1=HALF, e2=HALF),
    Lubricant(eta0=0.25, alpha=22e-9),
    load=15.0,
    u_sum=2 * 0.09,
)
RADIUS = 1.2 * 15.5e-6  # m
SHALLOW, DEEP = 0.175e-6, 7e-6  # m, computed by them and measured by them
START = -2.25  # of the dimple, in semi-axes; on a node
BEFORE = -1.3125  # place of the dimple at the first instant, when the gap does not show it yet
VISIBLE = 280.0  # nm; the dimple lies where the gap within the contact is above
WAVELENGTH = 600e-9  # m, of the interferograms

Curve = tuple[np.ndarray, np.ndarray]
Surface = Callable[[np.ndarray, np.ndarray, float], np.ndarray]


def published(kind: str) -> list[Curve]:
    """Curves of the five instants, x [um] and gap [nm], of the "experiment" or the "simulation"."""
    with DATA.open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(line for line in file if line[0] != "#") if row["curve"] == kind]
    points = [
        [(float(r["x_um"]), float(r["gap_nm"])) for r in rows if r["instant"] == str(k)] for k in range(1, 6)
    ]
    return [(np.array(p)[:, 0], np.array(p)[:, 1]) for p in points]


def dimple_centre(curve: Curve) -> float:
    """Middle [um] of the part within the contact where the gap shows the dimple; `BEFORE` where it does not."""
    a = POINT.scales.a * 1e6
    x = np.linspace(-0.92 * a, 0.92 * a, 2001)
    shown = x[np.interp(x, *curve) > VISIBLE]
    return 0.5 * (shown[0] + shown[-1]) if shown.size else BEFORE * a


def dent(depth: float) -> Dent:
    """Their dimple, of the given depth [m], at its starting place."""
    return Dent.at(POINT, depth, RADIUS, start=START * POINT.scales.a)


def without_rim(shape: Dent) -> Surface:
    """The same dimple, cut off where it would begin to stand out; any function of X, Y, T can be a surface."""
    return lambda X, Y, T: np.where(np.hypot(X - shape.start - T, Y) < shape.radius, shape(X, Y, T), 0.0)


def roll(surface: Surface, centres: list[float], n: int = 256) -> SimulationResult:
    """Let a dimple pass, keeping whole fields when its centre is at `centres` [um]; steps of one mesh size."""
    scales = POINT.scales
    mesh = 6.0 / n  # of the default domain
    steps = [round((centre * 1e-6 / scales.a - START) / mesh) for centre in centres]
    until = (max(steps) + 1) * mesh
    T = np.linspace(0.0, until, 4)
    return simulate(
        POINT,
        PrescribedLoad(T, np.ones_like(T)),
        grid=Grid(n=n),
        time=TimeSteps(dt=mesh * scales.time),
        surface=surface,
        keep=KeepSettings(snapshots=[k * mesh * scales.time for k in steps]),
        run=RunSettings(callback=show_progress if sys.stdout.isatty() else None),
    )


def show_progress(t: float, end: float) -> None:
    """One line, written over and over."""
    print(f"\r  dimple at X = {START + t / POINT.scales.time:+.2f}  ({t / end:4.0%})", end="\r", flush=True)


def gaps(run: SimulationResult) -> list[Curve]:
    """Gap [nm] along the centre line over x [um] at the snapshots."""
    films = [film_of(run, t).along for t in run.snapshot_t]
    return [(film.x * 1e6, film.h * 1e9) for film in films]


def difference(ours: Curve, theirs: Curve, centre: float) -> np.ndarray:
    """Gap less theirs [nm] at their points outside the dimple; the second row holds their x [um]."""
    outside = np.abs(theirs[0] - centre) > 1.1 * RADIUS * 1e6
    x = theirs[0][outside]
    return np.array([np.interp(x, *ours) - theirs[1][outside], x])


def rms(values: np.ndarray) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(values**2)))


def report(title: str, ours: list[Curve], theirs: list[Curve], central: float) -> tuple[float, float]:
    """Print the rms differences outside the dimple over the central film [nm]; return those of all instants.

    The first is over all their points, the second over those within the Hertz circle.
    """
    a = POINT.scales.a * 1e6
    parts = [difference(o, t, dimple_centre(t)) for o, t in zip(ours, theirs, strict=True)]
    print(title)
    for k, (gap, x) in enumerate(parts, 1):
        within = rms(gap[np.abs(x) < a]) / central
        print(f"  instant {k}: rms {rms(gap) / central:5.1%}, within the Hertz circle {within:5.1%}")
    gap, x = np.hstack(parts)
    everywhere, within = rms(gap) / central, rms(gap[np.abs(x) < a]) / central
    print(f"  all:       rms {everywhere:5.1%}, within the Hertz circle {within:5.1%}")
    return everywhere, within


def draw(shallow: SimulationResult, deep: SimulationResult, rimless: SimulationResult, path: Path) -> None:
    """Fringes of the deep dimple, and the gaps of all three over the published ones."""
    import matplotlib.pyplot as plt

    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False})
    figure, panels = plt.subplots(
        3, 5, figsize=(13, 7.2), layout="constrained", sharex=True, sharey="row", height_ratios=(1.15, 1, 1)
    )
    for k, panel in enumerate(panels[0]):
        film = film_of(rimless, float(rimless.snapshot_t[k]))
        fringes = interferogram(film, WAVELENGTH)
        shown = np.where(fringes.resolved, fringes.intensity, 0.5)
        panel.pcolormesh(film.x * 1e6, film.y * 1e6, shown.T, cmap="gray", shading="gouraud", rasterized=True)
        panel.set(title=f"instant {k + 1}", ylim=(-185, 185), aspect="equal")
    panels[0, 0].set_ylabel("fringes at 600 nm, 7 µm deep\ny across [µm]")
    for row, kind, run, without in (
        (panels[1], "simulation", shallow, None),
        (panels[2], "experiment", deep, rimless),
    ):
        for k, (panel, theirs) in enumerate(zip(row, published(kind), strict=True)):
            verb = "computed" if kind == "simulation" else "measured"
            panel.plot(*theirs, "o", color="#d55e00", markersize=2.6, label=f"Mourier et al., {verb}")
            panel.plot(*gaps(run)[k], color="#0072b2", linewidth=1.4, label="ehlcontact")
            if without is not None:
                panel.plot(*gaps(without)[k], "--", color="#009e73", linewidth=1.2, label="ehlcontact, no rim")
            panel.grid(color="#dddddd", linewidth=0.6)
            panel.set_axisbelow(True)
            panel.set(xlim=(-185, 185), ylim=(0, 400))
        row[0].legend(frameon=False, loc="lower center", fontsize=8)
    panels[1, 0].set_ylabel("0.175 µm deep\ngap [nm]")
    panels[2, 0].set_ylabel("7 µm deep\ngap [nm]")
    for panel in panels[2]:
        panel.set_xlabel("x along rolling [µm]")
    figure.savefig(path, dpi=120)


def main() -> None:
    """Roll, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture", nargs="?", type=Path, default=Path("dimple.png"))
    target = parser.parse_args().picture
    steady = solve_steady(POINT, grid=Grid(n=256))
    central, least = steady.h_central * 1e9, steady.h_min * 1e9
    print(f"smooth: central film {central:.1f} nm, minimum film {least:.1f} nm (Mourier et al.: 212 and 119 nm)")
    runs = []
    for name, kind, surface in (
        ("0.175 um deep", "simulation", dent(SHALLOW)),
        ("7 um deep", "experiment", dent(DEEP)),
        ("7 um deep, no rim", "experiment", without_rim(dent(DEEP))),
    ):
        theirs = published(kind)
        run = roll(surface, [dimple_centre(curve) for curve in theirs])
        print(f"dimple {name}: {run.steps} steps, {run.cycles[1:].mean():.1f} cycles each,", end=" ")
        print(f"least film {run.h_min.min() * 1e9:.0f} nm")
        report(
            f"  difference from their {kind} outside the dimple, over the central film", gaps(run), theirs, central
        )
        runs.append(run)
    draw(runs[0], runs[1], runs[2], target)
    print(f"picture: {target}")


if __name__ == "__main__":
    main()
