"""A spall rolls through one full film whose bodies are held: its force beside those of reduced answers.

The full film is `simulate` with the spall as a surface and the approach held. Beside it: the linear answer G of
`excitation`, a film element at an approach that the height is added to as dry contacts filter it, the same with
what the film leaves of that height, as runs of bearings have it, and with the bare height. Some minutes on one
core:

    python examples/studies/spall_passage.py [spall_passage.png] [--n 128]
"""

import argparse
from dataclasses import dataclass
from math import pi

import numpy as np

from ehlcontact import Grid, MoesPoint, PrescribedApproach, TimeSteps, excitation, simulate, solve_steady
from ehlcontact.dry_contact import ElasticContact
from ehlcontact.hertz import shape_factor
from reduced_models import Atlas
from reduced_models.atlas.waves import film_over_dry
from reduced_models.bearing.elastic_heights import Track

CASES = ((MoesPoint(200, 10, 0.5), 0.2), (MoesPoint(200, 10, 0.5), 0.5), (MoesPoint(30, 8, 0.5), 1.5))
LENGTH, EDGE = 4.0, 1.0  # of the spall and of its slopes, in semi-axes a
START, END = -8.0, 14.0  # place of the middle at T = 0, and end of the runs
PERIOD = 32.0  # of the spalls of the linear answer, in semi-axes
SHORTEST = 0.5  # wavelength of that answer
LIGHTEST, HEAVIEST = 6.0, 4.0  # load M, and load over the static one, of the element


def height(x: np.ndarray, depth: float) -> np.ndarray:
    """Height of the spall at distances x from its middle."""
    return -depth * np.clip((0.5 * LENGTH - np.abs(x)) / EDGE, 0.0, 1.0)


@dataclass
class Passage:
    """Forces over the static one while the spall passes; X is the place of its middle."""

    point: MoesPoint
    depth: float  # dry approaches
    X: np.ndarray
    full: np.ndarray
    linear: np.ndarray
    filtered: np.ndarray
    with_film: np.ndarray
    bare: np.ndarray


def passage(point: MoesPoint, depth: float, n: int) -> Passage:
    """One spall in one contact, with a grid of n."""
    grid = Grid(n=n)
    approach = solve_steady(point, grid=grid).approach
    held = PrescribedApproach([0.0, 0.3 * END, 0.6 * END, END], [approach] * 4)

    def dug(X, Y, T):
        return -height(X - START - T, depth) + 0.0 * Y

    run = simulate(point, held, grid=grid, time=TimeSteps(until=END), surface=dug)
    wavelength = PERIOD / np.arange(1, int(PERIOD / SHORTEST) + 1)
    G = excitation(point, wavelength=np.append(1e3, wavelength), grid=grid).value
    element = Atlas().wide(point, np.geomspace(LIGHTEST / point.M, HEAVIEST, 24))
    X = START + run.t
    return Passage(point, depth, X, run.force, linear(G, X, depth), *reduced(point, element, run.t, X, depth))


def linear(G: np.ndarray, X: np.ndarray, depth: float) -> np.ndarray:
    """Force by the linear answer, of a row of spalls."""
    x = np.linspace(0.0, PERIOD, 4096, endpoint=False)
    waves = np.fft.rfft(height((x + PERIOD / 2) % PERIOD - PERIOD / 2, depth))[: G.size] / x.size
    waves[1:] *= 2.0
    k = 2.0 * pi / PERIOD * np.arange(G.size)
    return 1.0 + ((G * waves) * np.exp(1j * np.outer(X, k))).sum(axis=1).real


def reduced(point: MoesPoint, element, T: np.ndarray, X: np.ndarray, depth: float) -> tuple[np.ndarray, ...]:
    """Force of the film element with the height filtered dry, with its film, and with the bare one."""
    spacing = 0.005
    x = np.arange(-PERIOD / 2, PERIOD / 2, spacing)
    # in Hertz' units a = 1 at the compression 1
    track = Track(height(x, depth), spacing, 0.5, 0.5 / shape_factor(point.kappa), ElasticContact(point.kappa))
    dry = track.heights(1.0, height(x, depth), np.ones(x.size, bool))
    k = 2.0 * pi * np.fft.rfftfreq(x.size, spacing)
    # the spall is symmetric: over its place X the height is what it is over the place of the contact
    carried = np.fft.irfft(np.fft.rfft(dry) * film_over_dry(point, k), x.size)
    still, forces = element.approach_at(1.0), []
    for heights in (dry, carried, height(x, depth)):
        moved = np.interp(X, x, heights)
        forces.append(element.drive(T, still + moved, np.gradient(moved, T)))
    return tuple(forces)


def draw(found: list[Passage], path: str) -> None:
    """All forces over the place of the spall."""
    import matplotlib.pyplot as plt

    figure, panels = plt.subplots(1, len(found), figsize=(10.0, 3.6), sharey=True, layout="constrained")
    for axes, one in zip(panels, found, strict=True):
        axes.plot(one.X, one.full, "k", lw=2.5, label="full film")
        axes.plot(one.X, one.linear, "C0", label="linear, G")
        axes.plot(one.X, one.filtered, "C1", label="element, dry filter")
        axes.plot(one.X, one.with_film, "C2", label="element, filtered with its film (runs)")
        axes.plot(one.X, one.bare, "C3:", label="element, bare height")
        for side in (-1.0, 1.0):
            axes.axvline(side * LENGTH / 2, color="#bbbbbb", lw=0.8, zorder=0)
        axes.set(xlabel="middle of the spall, X [semi-axes a]", xlim=(-5.0, 5.0))
        axes.set_title(f"M {one.point.M:g}: {one.depth:g} dry approaches deep", fontsize=10)
        axes.grid(color="#eeeeee")
    panels[0].set_ylabel("force over the static one")
    panels[0].legend(fontsize=8)
    figure.savefig(path, dpi=130)


def main() -> None:
    """Print how far the reduced forces are off and draw the picture."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("path", nargs="?", default="spall_passage.png")
    parser.add_argument("--n", type=int, default=128)
    given = parser.parse_args()
    found = [passage(point, depth, given.n) for point, depth in CASES]
    print("rms and largest difference from the full film, over its largest change [%]")
    print("    M  depth  least force")
    for one in found:
        change = np.abs(one.full - 1.0).max()
        print(f"{one.point.M:5g}  {one.depth:5g}  {one.full.min():16.3f}  |", end="")
        for name in ("linear", "filtered", "with_film", "bare"):
            off = (getattr(one, name) - one.full) / change
            print(f"  {name} {100 * np.sqrt(np.mean(off**2)):.1f} {100 * np.abs(off).max():.1f}", end="")
        print(
            f"  least filtered {one.filtered.min():.3f} largest full {one.full.max():.3f} {one.filtered.max():.3f}"
        )
    draw(found, given.path)


if __name__ == "__main__":
    main()
