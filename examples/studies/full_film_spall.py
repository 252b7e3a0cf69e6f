"""A ball of a 6205 rolls over a worn spall of 0.5 mm on a full film, beside the reduced answer.

The full film takes the place of the element of one contact (`simulate_full_films`); all others are elements. Half
a minute on one core:

    python examples/studies/full_film_spall.py [full_film_spall.png] [--depth 2e-6] [--n 128]
"""

import argparse
import time
from dataclasses import replace
from math import pi

import numpy as np

from ehlcontact import Grid, Lubricant
from reduced_models import BallBearing, BearingMount, Rotor, Spall
from reduced_models.bearing.height_tables import track_radius
from reduced_models.rotor.bearing_films import FullFilm, simulate_full_films

MASS, DAMPING, LOAD, SPEED = 5.0, 2000.0, 500.0, 1800.0  # kg, N s/m of what holds the mass, N, rev/min
LENGTH, EDGE, AT = 0.5e-3, 1e-4, -pi / 2  # m, m, under the load
BALL, START = 8, 0.4  # that comes to the spall, so many pitches after the start
BEFORE_AND_AFTER = 6e-4  # m, between the spall's edges and the contact where its film is solved
STEP = 4.75e-6  # m along the track per time step: a node of the grid of n = 128
SMOOTH = BallBearing.catalogue("6205", clearance=5e-6, oil=Lubricant.iso_vg(68, temperature=50.0))
CAGE = SMOOTH.orders.ftf_order * SPEED * pi / 30.0  # rad/s
TRACK = track_radius(SMOOTH, "outer")


def with_dry_filter(bearing: BallBearing) -> BallBearing:
    """The same with heights in runs as dry contacts filter them."""
    bearing.tables.heights_in_films[SPEED] = bearing.tables.heights
    return bearing


def passages(depth: float, n: int = 128, refined: int = 1):
    """Runs with the full film, reduced, reduced with dry filters; time of the ball over the middle; seconds."""
    bearing = replace(SMOOTH, features=[Spall(race="outer", angle=AT, length=LENGTH, depth=depth, edge=EDGE)])
    pitch = 2.0 * pi / bearing.balls
    rotor = Rotor(
        mass=np.diag([MASS, MASS]),
        damping=np.diag([DAMPING, DAMPING]),
        stiffness=np.zeros((2, 2)),
        load=(0.0, -LOAD),
        mounts=(BearingMount(bearing=bearing, x=0, y=1, cage_angle=AT + (1.0 - START) * pitch),),
    )
    middle, reach = START * pitch / CAGE, (0.5 * LENGTH + BEFORE_AND_AFTER) / (CAGE * TRACK)
    film = FullFilm(ball=BALL, race="outer", between=(middle - reach, middle + reach), grid=Grid(n=n))
    options = {"speed_rpm": SPEED, "dt": STEP / (CAGE * TRACK) / refined, "until": middle + 3.0 * reach}
    began = time.perf_counter()
    full = simulate_full_films(rotor, [film], **options)
    seconds = time.perf_counter() - began
    probe = [replace(film, solved=False)]
    reduced = simulate_full_films(rotor, probe, **options)
    rotor = replace(rotor, mounts=(replace(rotor.mounts[0], bearing=with_dry_filter(replace(bearing))),))
    dry = simulate_full_films(rotor, probe, **options)
    return full, reduced, dry, middle, seconds


def differences(full, reduced) -> dict[str, float]:
    """Largest differences of the reduced answer from the full one, over what each is said over [%]."""
    force, element = full.films[0].force, reduced.films[0].force
    ring, ring_reduced = (-run.rotor.force[:, 1] for run in (full, reduced))
    moved, moved_reduced = (run.rotor.displacement[:, 1] for run in (full, reduced))
    off = {
        "contact force": (force, element),
        "force of the bearing": (ring, ring_reduced),
        "displacement": (moved, moved_reduced),
    }
    found = {}
    for name, (one, other) in off.items():
        largest = np.abs(other - one).max()
        found[f"{name} over its static value"] = 100.0 * largest / abs(one[0])
        found[f"{name} over its range"] = 100.0 * largest / np.ptp(one)
    return found


def draw(full, reduced, dry, middle: float, path: str) -> None:
    """Force of the contact, of the bearing, displacement and film over the passage."""
    import matplotlib.pyplot as plt

    figure, panels = plt.subplots(2, 2, figsize=(10.0, 6.4), sharex=True, layout="constrained")
    edges = 1e3 * 0.5 * LENGTH / (CAGE * TRACK)
    styles = ("k", "full film"), ("C2", "element, filtered with its film"), ("C1", "element, dry filter")
    for one, (color, label) in zip((full, reduced, dry), styles, strict=True):
        film, run = one.films[0], one.rotor
        at, over = 1e3 * (film.t - middle), 1e3 * (run.t - middle)
        panels[0, 0].plot(at, film.force, color, label=label)
        panels[0, 1].plot(over, -run.force[:, 1], color)
        panels[1, 0].plot(over, 1e6 * run.displacement[:, 1], color)
    film = full.films[0]
    panels[1, 1].plot(1e3 * (film.t - middle), 1e6 * film.h_central, "k", label="centre")
    panels[1, 1].plot(1e3 * (film.t - middle), 1e6 * film.h_min, "k:", label="smallest")
    names = "force of the contact [N]", "force of the bearing [N]", "displacement [µm]", "film [µm]"
    for axes, name in zip(panels.flat, names, strict=True):
        axes.axvspan(-edges, edges, color="#cfe3f5", zorder=0)
        axes.set_ylabel(name)
        axes.grid(color="#eeeeee")
    for axes in panels[1]:
        axes.set(xlabel="time, 0 with the ball over the middle of the spall [ms]", xlim=(-0.5, 1.5))
    panels[0, 0].legend(fontsize=8)
    panels[1, 1].set_yscale("log")
    panels[1, 1].legend(fontsize=8)
    figure.savefig(path, dpi=130)


def main() -> None:
    """Print how far the reduced answer is off and draw the picture."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("path", nargs="?", default="full_film_spall.png")
    parser.add_argument("--depth", type=float, default=2e-6)
    parser.add_argument("--n", type=int, default=128)
    parser.add_argument("--refined", type=int, default=1)
    given = parser.parse_args()
    full, reduced, dry, middle, seconds = passages(given.depth, given.n, given.refined)
    print(f"{seconds:.0f} s, {full.films[0].solves.sum()} solves in {full.films[0].t.size - 1} steps")
    for run, name in ((full, "full"), (reduced, "reduced")):
        force, ring, moved = run.films[0].force, -run.rotor.force[:, 1], 1e6 * run.rotor.displacement[:, 1]
        print(
            f"{name}: contact {force.min():.1f} to {force.max():.1f} N, bearing {ring.min():.1f} to "
            f"{ring.max():.1f} N, displacement {moved.min():.3f} to {moved.max():.3f} µm"
        )
    print(f"smallest film {1e9 * full.films[0].h_min.min():.0f} nm")
    for run, what in ((reduced, ""), (dry, "with the dry filter, ")):
        for name, value in differences(full, run).items():
            print(f"{what}{name}: {value:.2f} %")
    draw(full, reduced, dry, middle, given.path)


if __name__ == "__main__":
    main()
