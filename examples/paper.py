"""The paper in one figure: a mass swings on a film, a cubic with a damper is fitted, and what that cannot know.

    python examples/paper.py [paper.png]     # under a minute, most of it one simulation

Nonato and Cavalca, J. Sound Vib. 329 (2010) 4656-4671, at their point M = 200, L = 10, kappa = 0.5: Table 3 fits a
cubic to a free vibration. What one learns: it is found again, its coefficients are not unique but its tangent is,
and the damper of that vibration is several times too small at the frequencies of a rotor.
"""

import sys

import numpy as np

from ehlcontact import FreeVibration, Grid, MoesPoint, impedance, simulate
from ehlcontact.results import Response
from ehlcontact.transient.result import SimulationResult
from reduced_models import ContactRecord, fit
from reduced_models.fitting.result import FitResult

POINT = MoesPoint(M=200, L=10, kappa=0.5)
TABLE_3 = {"K1": 0.806, "K2": 0.346, "K3": 0.054, "C1": 0.013}  # the paper's, of this vibration
OMEGA_N = 5.13  # of the mass, dimensionless


def vibration(n: int = 128) -> tuple[SimulationResult, FitResult]:
    """A mass on the film starts by opening, as the paper's; the cubic is fitted to its motion and force."""
    run = simulate(POINT, FreeVibration(Omega_n=OMEGA_N, start="opening"), grid=Grid(n=n))
    return run, fit(ContactRecord.from_result(run), model="cubic")


def film(n: int = 128) -> Response:
    """The same film, linearised: damping at every frequency."""
    return impedance(POINT, Omega=np.geomspace(0.02, 30.0, 40), grid=Grid(n=n))


def tangent(K1: float, K2: float, K3: float) -> float:
    """Slope of a cubic where it carries the load 1."""
    roots = np.roots([K3, K2, K1, -1.0])
    u = min(root.real for root in roots if abs(root.imag) < 1e-9 and root.real > 0.0)
    return K1 + 2.0 * K2 * u + 3.0 * K3 * u * u


def main(picture: str = "paper.png", n: int = 128) -> None:
    """Print both cubics and draw force and damping."""
    from matplotlib.figure import Figure

    (run, found), whole = vibration(n), film(n)
    ours = {name: found.parameters[name] for name in TABLE_3}
    for name, cubic in (("paper", TABLE_3), ("here", ours)):
        told = ", ".join(f"{key} {value:.3f}" for key, value in cubic.items())
        print(f"{name:>5}: {told}; tangent {tangent(*list(cubic.values())[:3]):.3f}")
    print(f"damping at Omega = 0.02: film {whole.damping[0]:.4f}, cubic {ours['C1']:.4f}")

    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    loop, damp = figure.subplots(1, 2)
    loop.plot(run.approach, run.force, color="black", label="film")
    loop.plot(run.approach, found.element.force(run.approach, run.rate), "--", label="cubic")
    loop.set(xlabel="approach", ylabel="force")
    damp.loglog(whole.omega, whole.damping, color="black", label="film")
    damp.axhline(ours["C1"], linestyle="--", label="cubic")
    damp.set(xlabel="Omega", ylabel="damping")
    damp.legend(frameon=False)
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
