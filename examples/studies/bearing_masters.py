"""Damping of a rotor on the FMUs of two bearings: masters, the lead that fits and the longest step.

Run ``python examples/studies/bearing_masters.py``: a minute. Prints the table of docs/notes/coupling.md and draws
`bearing_masters.png`.

A rigid rotor of 10 kg on two 6305 at 3000 rev/min is struck across; it vibrates at 650 Hz. Masters and masses are
those of `masters.py`. The damping is that of half the difference between two runs, struck up and down, over that
of `simulate_rotor`.
"""

from __future__ import annotations

import argparse
import tempfile
from math import pi
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
from masters import ALLOWED, LEADS, picture

from ehlcontact import Lubricant
from fmu import export
from reduced_models import BallBearing, BearingMount, Rotor, simulate_rotor
from reduced_models.rotor.decay import log_decrement

RPM, OMEGA, LOAD, BLOW = 3000.0, 100.0 * pi, 500.0, 1e-4  # rev/min, rad/s, N on each bearing, m/s
END, BETWEEN = 3.75, 1.25  # kg: inertia of an end by its own acceleration, and by that of the other one
STEPS = (1e-6, 3e-6, 1e-5, 2e-5, 3e-5, 4e-5, 5e-5, 1e-4)  # s
FINE, UNTIL = 2e-6, 0.012  # s
HZ = 650.0
MOTION, FORCES = ("x", "y", "velocity_x", "velocity_y"), ("force_x", "force_y")


def rotor() -> Rotor:
    """Places x, y of both ends."""
    held = BallBearing.catalogue("6305", oil=Lubricant.iso_vg(46, temperature=70.0), clearance=0.0)
    return Rotor(
        mass=np.kron(np.array([[END, BETWEEN], [BETWEEN, END]]), np.eye(2)),
        stiffness=np.zeros((4, 4)),
        mounts=tuple(BearingMount(bearing=held, x=x, y=x + 1) for x in (0, 2)),
        load=np.array([0.0, -LOAD, 0.0, -LOAD]),
    )


def decrement(up: np.ndarray, down: np.ndarray, h: float) -> float:
    """Logarithmic decrement of half the difference of two runs."""
    half = 0.5 * (up - down)
    return float(log_decrement(h * np.arange(half.size), half, omega=2.0 * pi * HZ).decrement)


class Loop:
    """The FMU of the bearing, unpacked in `folder`, and the rotor at rest on two of them."""

    def __init__(self, folder: Path) -> None:
        self.rotor = rotor()
        self.start = self.rotor.equilibrium(RPM)
        self.inverse = np.linalg.inv(self.rotor.mass)
        path = export(self.rotor.bearings[0].ball_bearing, folder / "6305.fmu", speeds_rpm=RPM)
        self._description = fmpy.read_model_description(path)
        self._folder = fmpy.extract(str(path), unzipdir=str(folder / "6305"))
        self._number = {v.name: v.valueReference for v in self._description.modelVariables}

    def reference(self) -> float:
        """Decrement of `simulate_rotor`."""
        blow, y = np.array([0.0, BLOW, 0.0, BLOW]), []
        for sign in (1.0, -1.0):
            run = simulate_rotor(self.rotor, speed_rpm=RPM, dt=FINE, until=UNTIL, start=(self.start, sign * blow))
            y.append(run.displacement[:, 1])
        return decrement(*y, FINE)

    def run(self, master: str, mass: str, h: float, lead: float) -> float:
        """Decrement in a loop with steps of h [s]."""
        return decrement(*(self._swing(master, mass, h, lead, sign * BLOW) for sign in (1.0, -1.0)), h)

    def _swing(self, master: str, mass: str, h: float, lead: float, blow: float) -> np.ndarray:
        given, asked = [self._number[k] for k in MOTION], [self._number[k] for k in FORCES]
        q, v = self.start.copy(), np.array([0.0, blow, 0.0, blow])
        units = [fmpy.instantiate_fmu(self._folder, self._description, fmi_type="CoSimulation") for _ in range(2)]
        for k, unit in enumerate(units):
            there = slice(2 * k, 2 * k + 2)
            unit.setReal(
                [*given, self._number["lead"], self._number["speed"]], [*q[there], *v[there], lead, OMEGA]
            )
            unit.setupExperiment(startTime=0.0)
            unit.enterInitializationMode()
            unit.exitInitializationMode()
        moved = [q[1]]
        for n in range(round(UNTIL / h)):
            held = np.concatenate([unit.getReal(asked) for unit in units])
            a, before = self.inverse @ (self.rotor.load + held), (q, v)
            q = q + h * (v + (h if mass == "symplectic Euler" else 0.5 * h) * a)
            v = v + h * a
            at, rate = before if master == "parallel" else (q, v)
            for k, unit in enumerate(units):
                unit.setReal(given, [*at[2 * k : 2 * k + 2], *rate[2 * k : 2 * k + 2]])
                unit.doStep(n * h, h)
            moved.append(q[1])
        for unit in units:
            unit.freeInstance()
        return np.array(moved)


def measure(loop: Loop, steps: tuple[float, ...] = STEPS) -> dict[tuple[str, str], np.ndarray]:
    """Damping over that of the rotor in one run, for every master and mass with the lead that fits."""
    wanted = loop.reference()
    return {case: np.array([loop.run(*case, h, lead) for h in steps]) / wanted for case, lead in LEADS.items()}


def longest(damping: np.ndarray, steps: tuple[float, ...] = STEPS) -> float:
    """Longest step up to which the damping is right to 5 % [s]."""
    return steps[int(np.argmax(~(np.append(np.abs(damping - 1.0), np.inf) <= ALLOWED))) - 1]


def main() -> None:
    """Print and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path())
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        found: dict[tuple[str, str], Any] = measure(Loop(Path(folder)))
    print(f"{'damping over that in one run, at a step of':<46}" + "".join(f"{h:>9.0e}" for h in STEPS))
    for (master, mass), damping in found.items():
        print(f"{master:<9} {mass:<17} {f'lead {LEADS[master, mass]:g}':<18}", end="")
        print("".join(f"{one:>9.3f}" for one in damping), f"  within 5 % up to {longest(damping):g} s")
    picture(arguments.out / "bearing_masters.png", found, STEPS, "that in one run")


if __name__ == "__main__":
    main()
