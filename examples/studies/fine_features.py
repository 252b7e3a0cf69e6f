"""Fine features on fine grids: a dimple that rolls and one that slides, and a rough surface, through a contact.

The dimple is that of Mourier, Mazuyer, Lubrecht and Donnet, Tribology International 39 (2006) 1745, with the
numbers under which Hansen et al. (Tribology Letters 70 (2022) 80) repeat it: 160 nm deep, the film 212 nm. In pure
rolling it goes with the film. Where its surface goes at half the mean speed (SRR -0.5 as they count), the oil that
it let in at the inlet runs ahead at the mean speed: more film where there is no dimple.

The roughness is made, self-affine, with an rms of a tenth of the central film and waves down to 8 nodes of the
mesh. Half a minute on one core with n = 256 (the default), eight times as long with every doubling:

    python examples/studies/fine_features.py [--n 512] [--folder docs/images]
"""

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact import (
    Dent,
    Domain,
    Geometry,
    Grid,
    KeepSettings,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    PrescribedLoad,
    Roughness,
    TimeSteps,
    simulate,
    solve_steady,
)
from ehlcontact.film import film_of
from ehlcontact.transient.result import SimulationResult

HALF = 110e9 * (1.0 - 0.3**2)  # two equal bodies of this modulus have E' = 110 GPa, steel on glass
BALL_ON_DISC = OperatingPoint(
    Geometry(12.5e-3, 12.5e-3, e1=HALF, e2=HALF), Lubricant(eta0=0.25, alpha=22e-9), load=15.0, u_sum=2 * 0.09
)
DEPTH, RADIUS = 160e-9, 1.2 * 21.5e-6  # m
PLACES = (-0.7, -0.4, -0.1, 0.3)  # of the dimple in semi-axes, where whole fields are kept
SPEEDS = {"rolling, $u_1 = u_m$": (1.0, -1.5), "sliding, $u_1 = u_m/2$": (0.5, -1.375)}  # and where it starts

ROUGH_POINT = MoesPoint(200.0, 10.0, 1.0)
LONGEST = 0.5  # wavelength, in semi-axes
FRONT = -1.25, 2.0  # of the rough surface: where it starts, and how far it goes

NEAR = Domain(-2.5, 1.5, 2.0)
COLOURS = {"blue": "#0072b2", "red": "#d55e00", "grey": "#888888"}


def under_load(
    point: MoesPoint | OperatingPoint, n: int, until: float, surface: Any, snapshots: Sequence[float]
) -> SimulationResult:
    """A run under constant load in steps of one mesh size; times in 2a/u_sum."""
    mesh = (NEAR.x_out - NEAR.x_in) / n
    until = mesh * np.ceil(until / mesh - 1e-9)
    load = PrescribedLoad(np.linspace(0.0, until, 4), np.ones(4))
    unit = point.scales.time
    return simulate(
        point,
        load,
        grid=Grid(n=n, domain=NEAR),
        time=TimeSteps(dt=mesh * unit),
        surface=surface,
        keep=KeepSettings(snapshots=[T * unit for T in snapshots]),
    )


def roll(speed: float, start: float, n: int) -> SimulationResult:
    """Let the dimple pass at `speed`, keeping whole fields where it is at `PLACES`."""
    dent = Dent.at(BALL_ON_DISC, DEPTH, RADIUS, start=start * BALL_ON_DISC.scales.a, speed=speed)
    mesh = (NEAR.x_out - NEAR.x_in) / n
    times = [mesh * round((place - start) / speed / mesh) for place in PLACES]
    return under_load(BALL_ON_DISC, n, times[-1], surface=dent, snapshots=times)


def rough(n: int, seed: int = 1) -> tuple[SimulationResult, Roughness]:
    """Let a rough surface roll in, until its front has left."""
    film = solve_steady(ROUGH_POINT, grid=Grid(n=128, domain=NEAR)).h_central
    shortest = 8.0 * (NEAR.x_out - NEAR.x_in) / n
    surface = Roughness.synthetic(0.1 * film, LONGEST, shortest, length=4.0, width=2.0, seed=seed, start=FRONT[0])
    return under_load(ROUGH_POINT, n, FRONT[1], surface=surface, snapshots=[FRONT[1]]), surface


def told(run: SimulationResult) -> str:
    """Steps, cycles and seconds."""
    steps = run.steps
    return f"{run.status}, {steps} steps, {run.cycles[1:].mean():.2f} cycles and {run.seconds / steps:.2f} s each"


def report_dent(name: str, speed: float, start: float, run: SimulationResult) -> None:
    """Print what stands in the dimple and ahead of it, at the second of its places."""
    t, s = float(run.snapshot_t[1]), BALL_ON_DISC.scales
    along, place = film_of(run, t).along, s.a * (start + speed * t / s.time)
    ahead = (along.x > place + 1.6 * RADIUS) & (along.x < 0.85 * s.a)
    crest = int(np.argmax(np.where(ahead, along.h, 0.0)))
    smooth = 1e9 * run.h_central[0]
    print(f"{name.replace('$', '')}: {told(run)}; {smooth:.0f} nm smooth")
    here = 1e9 * along.h[np.abs(along.x - place) < 0.2 * s.a].max()
    print(f"  dimple at x/a = {place / s.a:+.2f}: {here:.0f} nm in it,", end=" ")
    print(f"at most {1e9 * along.h[crest]:.0f} nm ahead of it, at x/a = {along.x[crest] / s.a:+.2f}")


def draw_dents(runs: dict[str, SimulationResult], path: Path) -> None:
    """Film maps at the four places, and the films along the middle."""
    import matplotlib.pyplot as plt

    scales = BALL_ON_DISC.scales
    a = scales.a * 1e6
    smooth = next(iter(runs.values())).h_midplane[0] * 1e9
    figure, panels = plt.subplots(
        3, 4, figsize=(10.5, 6.7), layout="constrained", sharex=True, sharey="row", height_ratios=(1.35, 1.35, 1.0)
    )
    for row, (name, run) in zip(panels[:2], runs.items(), strict=True):
        speed, start = SPEEDS[name]
        for panel, profile, t in zip(row, panels[2], run.snapshot_t, strict=True):
            film, place = film_of(run, float(t)), (start + speed * t / scales.time) * a
            along = film.along
            image = panel.pcolormesh(
                film.x * 1e6, film.y * 1e6, film.h.T * 1e9, vmin=120, vmax=320, cmap="viridis", rasterized=True
            )
            panel.add_patch(plt.Circle((0, 0), a, fill=False, color="white", linewidth=0.7, linestyle=":"))
            panel.set(aspect="equal", ylim=(-1.15 * a, 1.15 * a))
            panel.plot(place, -1.05 * a, "^", color="white", markersize=5, clip_on=False)
            colour = COLOURS["blue" if speed == 1.0 else "red"]
            profile.plot(along.x * 1e6, along.h * 1e9, color=colour, linewidth=1.4, label=name)
            if speed == 1.0:
                panel.set_title(f"dimple at {place:+.0f} µm", fontsize=9)
        row[0].set_ylabel(f"{name}\ny across [µm]")
    for profile in panels[2]:
        profile.plot(film.x * 1e6, smooth, "--", color=COLOURS["grey"], linewidth=1.0, label="no dimple")
        profile.set(xlim=(-1.15 * a, 1.15 * a), ylim=(30, 400), xlabel="x along rolling [µm]")
        profile.grid(color="#dddddd", linewidth=0.6)
        profile.set_axisbelow(True)
    panels[2, 0].set_ylabel("film along the middle [nm]")
    panels[2, 0].legend(frameon=False, fontsize=8, loc="lower center")
    figure.colorbar(image, ax=panels[:2, :], label="film [nm]", shrink=0.7, extend="both")
    figure.savefig(path, dpi=90)
    plt.close(figure)


def draw_rough(run: SimulationResult, surface: Roughness, path: Path) -> None:
    """Film and pressure as maps, and along the middle beside the smooth ones."""
    import matplotlib.pyplot as plt

    T = float(run.snapshot_t[-1])
    film, central = film_of(run, T), run.h_central[0]
    figure = plt.figure(figsize=(9.5, 6.9), layout="constrained")
    maps, lines = figure.subfigures(2, 1, height_ratios=(1.35, 1.0))
    for panel, field, limits, colours, label in (
        (maps.add_subplot(1, 2, 1), film.h / central, (0.4, 1.4), "viridis", "film over the smooth central one"),
        (maps.add_subplot(1, 2, 2), film.p, (0.0, 1.1), "magma", "pressure over the Hertz pressure"),
    ):
        low, high = limits
        image = panel.pcolormesh(film.x, film.y, field.T, vmin=low, vmax=high, cmap=colours, rasterized=True)
        panel.set(
            aspect="equal", xlim=(-1.3, 1.2), ylim=(-1.2, 1.2), xlabel="x/a along rolling", ylabel="y/b across"
        )
        maps.colorbar(image, ax=panel, label=label, shrink=0.95)
    upper, lower = lines.subplots(2, 1, sharex=True)
    heights = surface(film.x[None, :], np.zeros((1, 1)), T)[0]
    upper.plot(
        film.x, heights / central, color=COLOURS["grey"], linewidth=0.9, label="roughness, undeformed, valleys up"
    )
    change = (film.along.h - run.h_midplane[0]) / central
    upper.plot(film.x, change, color=COLOURS["blue"], linewidth=1.2, label="change of the film")
    upper.set(ylabel="height/film", ylim=(-0.65, 0.65))
    lower.plot(film.x, run.p_midplane[0], "--", color=COLOURS["grey"], linewidth=1.0, label="smooth")
    lower.plot(film.x, film.along.p, color=COLOURS["red"], linewidth=1.2, label="rough")
    lower.set(ylabel="P", xlabel="x/a along the middle", xlim=(-1.3, 1.2), ylim=(0.0, 1.3))
    for panel in (upper, lower):
        panel.legend(frameon=False, fontsize=8, ncols=2, loc="upper left")
        panel.grid(color="#dddddd", linewidth=0.6)
        panel.set_axisbelow(True)
    figure.savefig(path, dpi=90)
    plt.close(figure)


def main() -> None:
    """Run, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--n", type=int, default=256, help="intervals along X")
    parser.add_argument("--folder", type=Path, default=Path(), help="where the pictures go")
    options = parser.parse_args()
    import matplotlib.pyplot as plt

    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False})
    runs = {name: roll(speed, start, options.n) for name, (speed, start) in SPEEDS.items()}
    for name, run in runs.items():
        report_dent(name, *SPEEDS[name], run)
    draw_dents(runs, options.folder / "dimple_passing.png")
    run, surface = rough(options.n)
    inside = np.hypot(run.x[:, None], run.y) < 0.7
    share = np.std(run.snapshot_h[-1][inside]) / run.h_central[0]
    print(f"roughness of {surface.rms / run.h_central[0]:.3f} of the film: {told(run)}")
    print(f"  film within 0.7 of the radius: rms {share:.3f} of the central one")
    draw_rough(run, surface, options.folder / "rough_film.png")


if __name__ == "__main__":
    main()
