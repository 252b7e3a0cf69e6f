"""Damping of a mass on the FMU of a contact: masters, masses, the lead that fits and the longest step.

Run ``python examples/studies/masters.py``: a minute. It prints the table of docs/notes/coupling.md and draws
`masters.png`.

A ball of a 6305 carries 1 kN; the mass on it is 5 kg, so that it vibrates at 860 Hz. A master steps mass and FMU
beside each other (parallel), or the mass first, and hands the FMU its new motion (serial). The mass holds the
force that it was given over its step and goes through the step exactly, as a mass FMU does, or by symplectic
Euler, as loops written by hand do. The damping is measured over eight periods.
"""

from __future__ import annotations

import argparse
import tempfile
from math import pi, sqrt
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
from coupling import LOAD, contact

from fmu import export
from reduced_models import simulate_oscillator
from reduced_models.rotor.decay import log_decrement

MASS = 5.0  # kg
PERIODS = 8.0
STEPS = (1e-6, 2e-6, 3e-6, 5e-6, 1e-5, 2e-5, 3e-5, 5e-5)  # s
LEADS = {
    ("parallel", "exact"): 1.5,
    ("parallel", "symplectic Euler"): 1.0,
    ("serial", "exact"): 0.5,
    ("serial", "symplectic Euler"): 0.0,
}
ALLOWED = 0.05  # of the damping


class Loop:
    """The FMU of a contact, unpacked in `folder`, and a mass that starts a thousandth above its rest."""

    def __init__(self, element: Any, folder: Path):
        self.element = element
        path = export(element, folder / "ball.fmu")
        self._description = fmpy.read_model_description(path)
        self._folder = fmpy.extract(str(path), unzipdir=str(folder / "ball"))
        self.rest = float(element.approach_at(LOAD))
        self.omega = sqrt(float(element.spring_tangent(self.rest)) / MASS)
        self.start = 1.001 * self.rest
        self.until = PERIODS * 2.0 * pi / self.omega

    def decrement(self, t: np.ndarray, approach: np.ndarray) -> float:
        """Logarithmic decrement of a motion."""
        return float(log_decrement(t, approach, omega=self.omega).decrement)

    def reference(self) -> float:
        """Decrement with the element in continuous time."""
        t = np.linspace(0.0, self.until, 8001)
        run = simulate_oscillator(self.element, t, mass=MASS, load=LOAD, u0=self.start)
        return self.decrement(t, run.approach)

    def run(self, master: str, mass: str, h: float, lead: float) -> float:
        """Decrement in a loop with steps of h [s]; not a number where the contact opens."""
        number = {v.name: v.valueReference for v in self._description.modelVariables}
        motion, force = [number["approach"], number["rate"]], [number["force"]]
        unit = fmpy.instantiate_fmu(self._folder, self._description, fmi_type="CoSimulation")
        u, v = self.start, 0.0
        unit.setReal([*motion, number["lead"]], [u, v, lead])
        unit.setupExperiment(startTime=0.0)
        unit.enterInitializationMode()
        unit.exitInitializationMode()
        (held,) = unit.getReal(force)
        moved = [u]
        for k in range(round(self.until / h)):
            before, a = [u, v], (LOAD - held) / MASS
            v += h * a
            u += h * (v if mass == "symplectic Euler" else v - 0.5 * h * a)
            unit.setReal(motion, before if master == "parallel" else [u, v])
            unit.doStep(k * h, h)
            (held,) = unit.getReal(force)
            moved.append(u)
            if held <= 0.0:
                break
        unit.terminate()
        unit.freeInstance()
        return self.decrement(h * np.arange(len(moved)), np.array(moved)) if held > 0.0 else float("nan")


def measure(loop: Loop, steps: tuple[float, ...] = STEPS) -> dict[tuple[str, str], np.ndarray]:
    """Damping over that of the contact, for every master and mass with the lead that fits, over the steps."""
    wanted = loop.reference()
    return {case: np.array([loop.run(*case, h, lead) for h in steps]) / wanted for case, lead in LEADS.items()} | {
        ("parallel", "exact, lead 1"): np.array([loop.run("parallel", "exact", h, 1.0) for h in steps]) / wanted
    }


def picture(
    path: Path,
    found: dict[tuple[str, str], np.ndarray],
    steps: tuple[float, ...] = STEPS,
    over: str = "that of the contact",
) -> Any:
    """Damping over the step."""
    from matplotlib.figure import Figure

    axes = (figure := Figure(figsize=(7.5, 3.6), layout="constrained")).add_subplot()
    for ((master, mass), damping), look in zip(found.items(), ("o-", "s-", "^-", "v-", "x:"), strict=False):
        lead = LEADS.get((master, mass))
        text = f"{master}, mass {mass}" + ("" if lead is None else f": lead {lead:g}")
        axes.plot(steps, damping, look, label=text, markersize=4)
    axes.axhspan(1.0 - ALLOWED, 1.0 + ALLOWED, color="0.9")
    axes.set(xscale="log", xlabel="step [s]", ylabel=f"damping over {over}", ylim=(-1.0, 3.0))
    axes.legend(frameon=False, fontsize="small", loc="upper left")
    figure.savefig(path, dpi=110)
    return figure


def main() -> None:
    """Print and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path())
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        found = measure(Loop(contact(), Path(folder)))
    print(f"{'damping over that of the contact at a step of':<46}" + "".join(f"{h:>9.0e}" for h in STEPS))
    for (master, mass), damping in found.items():
        lead = LEADS.get((master, mass))
        print(f"{master:<9} {mass:<17} {'' if lead is None else f'lead {lead:g}':<18}"
              + "".join(f"{one:>9.3f}" for one in damping))  # fmt: skip
    picture(arguments.out / "masters.png", found)


if __name__ == "__main__":
    main()
