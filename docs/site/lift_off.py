"""Table and picture of lift-off and return in docs/notes/elements.md.

python docs/site/lift_off.py   # half an hour: runs of the full film, and tables from solves in their regions

Elements of the atlas have oil as far ahead as the contact at rest. Here tables are solved in the region of the
run: what is left is the error of the law. Where films are thin (M of 60 and more) the region hardly matters, and
the element is that of the atlas. In brackets: all film made at the inlet, none at the rim.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ehlcontact import (
    ConvergenceError,
    Domain,
    Grid,
    KeepSettings,
    MoesPoint,
    TimeSteps,
    impedance,
    simulate,
    solve_steady,
)
from reduced_models import Atlas, FilmContact
from reduced_models.elements.film_response import fit_gains, inlet_saturation_of
from reduced_models.fitting.memory_fit import OMEGAS

DOCS = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(DOCS.parent / "tests" / "golden"))
import motions  # noqa: E402

LATER = {  # the first three were looked at while the law was chosen, the others only afterwards
    "(500 15 0.12)": MoesPoint(500, 15, 0.12),
    "(60 8 1)": MoesPoint(60, 8, 1.0),
    "(8000 10 0.2)": MoesPoint(8000, 10, 0.2),
    "(30 3 0.15)": MoesPoint(30, 3, 0.15),
    "(12 8 0.5)": MoesPoint(12, 8, 0.5),
}
FAST = ("fast return", "impact")
THIN = 60
LOADS = (0.03, 0.06, 0.12, 0.25, 0.5, 1.0, 1.7, 3.0)
LEAST = np.array([2.5, 1.2, 1.2])  # half lengths of a region, in those of the contact
SNAPSHOTS = (0.25, 0.35, 0.5, 1.0, 1.5)


def element_of_region(point, domain):
    """Wide-range element from solves at every load in the same `domain` of the reference load."""
    if point.M >= THIN:
        return Atlas().element(point, "wide")
    rates = Atlas().element(point, "wide").rates
    solved, approach, gains = [], [], []
    for load in LOADS:
        sides = np.array(domain.as_tuple()) * load ** (-1.0 / 3.0)
        region = Domain(*(np.sign(sides) * np.maximum(np.abs(sides), LEAST)))
        at, grid = replace(point, M=point.M * load), Grid(n=128 if load > 0.3 else 192, domain=region)
        try:
            film, Z = solve_steady(at, grid=grid), impedance(at, Omega=OMEGAS, grid=grid)
        except ConvergenceError:  # a light load whose film reaches beyond the region
            continue
        solved.append(load)
        approach.append(film.approach * load ** (2.0 / 3.0))
        gains.append(fit_gains(rates, Z.omega, Z.stiffness, Z.damping, float(Z.stiffness[0])).gains.tolist())
    saturation = inlet_saturation_of(solved, approach, solved, gains)
    return FilmContact.wide(solved, approach, solved, gains, inlet_saturation=saturation, **rates.coefficients)


def run_of(case, snapshots=()):
    """Full film under the motion of a case, and its approach and rate at every step."""
    point, table, until, dt = motions.motion(case)
    run = simulate(point, table, time=TimeSteps(until=until, dt=dt), keep=KeepSettings(snapshots=snapshots))
    return run, [np.array([at(T) for T in run.t]) for at in (table.approach, table.rate)]


def without_rim(element):
    """Copy of the element whose film is made at the inlet alone."""
    other = element.copy()
    object.__setattr__(other, "law", element.law._replace(rim=0.0))
    return other


def rms(force, full):
    """RMS error over the standard deviation [%]."""
    return 100.0 * float(np.sqrt(np.mean((force - full) ** 2)) / full.std())


def main():
    """Runs, table and picture."""
    motions.POINTS.update(LATER)
    elements = {}
    for name, point in motions.POINTS.items():
        for kind in FAST if name in LATER else motions.KINDS:
            run, motion = run_of(f"{name}, {kind}")
            key = name, run.domain.as_tuple()
            if key not in elements:
                elements[key] = element_of_region(point, run.domain)
            errors = [rms(e.drive(run.t, *motion), run.force) for e in (elements[key], without_rim(elements[key]))]
            print(f"{name}, {kind}: {errors[0]:.1f} ({errors[1]:.1f}) %", flush=True)
    draw(elements["middle", Domain().as_tuple()])


def draw(element):
    """Film along the mid-plane and force over time: the impact at (37, 12, 0.8)."""
    run, motion = run_of("middle, impact", SNAPSHOTS)
    figure = Figure(figsize=(10.5, 4.0), layout="constrained")
    films, forces = figure.subplots(1, 2)
    middle = int(np.argmin(np.abs(run.y)))
    for k, T in enumerate(SNAPSHOTS):
        films.plot(run.x, run.snapshot_h[k][:, middle], color=f"C{k}", label=f"T = {T:g}")
    films.set(
        xlabel="X, surfaces move to the right", ylabel="gap over the dry approach", xlim=(-2, 1.5), ylim=(0, 1.2)
    )
    forces.plot(run.t, run.force, "k", label="full film")
    forces.plot(run.t, element.drive(run.t, *motion), "C1", label="element")
    forces.plot(run.t, without_rim(element).drive(run.t, *motion), "C0:", label="film made at the inlet alone")
    forces.plot(run.t, element.spring(motion[0]), "--", color="0.6", label="static")
    forces.set(xlabel="T, in 2a/u_sum", ylabel="force over the load of the point")
    for axes in (films, forces):
        axes.legend(fontsize="small")
    figure.savefig(DOCS / "images" / "lift_off.png", dpi=130)


if __name__ == "__main__":
    main()
