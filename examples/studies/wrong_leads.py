"""Masters with the lead that fits and with the default: the damping of a mass, and what the FMU logs of it.

Run ``python examples/studies/wrong_leads.py``: some minutes. It prints the table of docs/notes/coupling.md.

A mass of 5 kg is on the FMU of a contact (a ball of a 6305 that carries 1 kN) or of a 6205 under 500 N, free
after a blow or with a harmonic force beside it. The mass holds the force (exact) or goes on by symplectic Euler,
beside the FMU (parallel) or before it (serial), or by the Runge-Kutta method of fourth order (RK4), whose stages
take back the step of the FMU and make it again. The damping is that of half the difference of two runs, struck in
opposite directions, over that of RK4 at the shortest step with `lead` 0.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Callable, Iterator
from math import pi
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
from coupling import contact

from ehlcontact import Lubricant
from fmu import export
from reduced_models import BallBearing
from reduced_models.rotor.decay import log_decrement

MASS, OMEGA = 5.0, 100.0 * pi  # kg, rad/s of the shaft
STEPS = (1e-6, 1e-5, 3e-5)  # s
DEFAULT = 1.5
LEADS = {
    ("parallel", "exact"): 1.5,
    ("parallel", "symplectic Euler"): 1.0,
    ("serial", "exact"): 0.5,
    ("serial", "symplectic Euler"): 0.0,
    ("rollback", "RK4"): 0.0,
}
UNTIL = 0.012  # s, of which the damping is that
WATCHED = 2000  # steps within which a wrong lead is named
FORCED = 390.0  # Hz
Vector = np.ndarray


class Bench:
    """The FMU of a contact or of a 6205, unpacked in `folder`, and a mass at rest on it."""

    def __init__(self, kind: str, folder: Path) -> None:
        path = folder / f"{kind}.fmu"
        self.kind = kind
        if kind == "contact":
            element = contact()
            export(element, path)
            names, self.sign, self.load, self.blow = ("approach", "rate", "force"), -1.0, 1000.0, 3e-5
            self.rest, self.more, self.omega = float(element.approach_at(self.load)), {}, 5422.0
        else:
            oil = Lubricant.iso_vg(46, temperature=70.0)
            export(BallBearing.catalogue(kind, oil=oil), path, speeds_rpm=3000.0, load=500.0)
            names, self.sign, self.load, self.blow = ("y", "velocity_y", "force_y"), 1.0, -500.0, 1e-4
            self.more, self.omega = {"speed": OMEGA}, 2.0 * pi * 600.0
        self._described = fmpy.read_model_description(path)
        self._folder = fmpy.extract(str(path), unzipdir=str(folder / kind))
        variables = {v.name: v for v in self._described.modelVariables}
        self._number = {name: v.valueReference for name, v in variables.items()}
        self._motion, self._force = [self._number[k] for k in names[:2]], [self._number[names[2]]]
        if kind != "contact":
            self.rest = float(variables["y"].start)

    def started(self, lead: float, v: float, log: list[str]) -> Any:
        """The FMU at rest, with the rate `v`; it logs to the list."""

        def logged(*said: Any) -> None:
            log.append(said[-1].decode() if isinstance(said[-1], bytes) else said[-1])

        unit = fmpy.instantiate_fmu(
            self._folder, self._described, fmi_type="CoSimulation", debug_logging=True, logger=logged
        )
        more = [self._number[name] for name in self.more]
        unit.setReal([*self._motion, self._number["lead"], *more], [self.rest, v, lead, *self.more.values()])
        unit.setupExperiment(startTime=0.0)
        unit.enterInitializationMode()
        unit.exitInitializationMode()
        return unit

    def pull(self, forced: bool) -> Callable[[float], float]:
        """All forces on the mass beside that of the FMU, over time."""
        amplitude = 0.08 * abs(self.load) if forced else 0.0
        return lambda t: self.load + amplitude * np.sin(2.0 * pi * FORCED * t)

    def run(
        self, master: str, mass: str, h: float, lead: float, forced: bool, steps: int, sign: float = 1.0
    ) -> tuple[Vector, list[str]]:
        """Displacements in a loop, and what the FMU logged."""
        log: list[str] = []
        unit = self.started(lead, sign * self.blow, log)
        try:
            path = self._path(unit, master, mass, h, self.pull(forced), sign * self.blow)
            return np.array([next(path) for _ in range(steps)]), log
        finally:
            unit.freeInstance()

    def _path(
        self, unit: Any, master: str, mass: str, h: float, pull: Callable[[float], float], v: float
    ) -> Iterator[float]:
        u, k, held = self.rest, 0, self._held(unit)
        while True:
            t = k * h
            if master == "rollback":
                u, v, held = self._runge_kutta(unit, t, h, pull, u, v, held)
            else:
                before, a = (u, v), (pull(t) + held) / MASS
                v += h * a
                u += h * (v if mass == "symplectic Euler" else v - 0.5 * h * a)
                unit.setReal(self._motion, before if master == "parallel" else (u, v))
                unit.doStep(t, h)
                held = self._held(unit)
            k += 1
            yield u

    def _held(self, unit: Any) -> float:
        """Force on the mass."""
        return self.sign * float(unit.getReal(self._force)[0])

    def _runge_kutta(
        self, unit: Any, t: float, h: float, pull: Callable[[float], float], u: float, v: float, held: float
    ) -> tuple[float, float, float]:
        state = unit.getFMUState()

        def force(u: float, v: float, dt: float) -> float:
            unit.setFMUState(state)
            unit.setReal(self._motion, [u, v])
            unit.doStep(t, dt)
            return self._held(unit)

        a1 = (pull(t) + held) / MASS
        v2 = v + 0.5 * h * a1
        a2 = (pull(t + 0.5 * h) + force(u + 0.5 * h * v, v2, 0.5 * h)) / MASS
        v3 = v + 0.5 * h * a2
        a3 = (pull(t + 0.5 * h) + force(u + 0.5 * h * v2, v3, 0.5 * h)) / MASS
        v4 = v + h * a3
        a4 = (pull(t + h) + force(u + h * v3, v4, h)) / MASS
        u, v = u + h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4), v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
        held = force(u, v, h)
        unit.freeFMUState(state)
        return u, v, held

    def decrement(self, master: str, mass: str, h: float, lead: float, forced: bool) -> float:
        """Logarithmic decrement of the vibration after the blow."""
        up, down = (self.run(master, mass, h, lead, forced, round(UNTIL / h), sign)[0] for sign in (1.0, -1.0))
        half = 0.5 * (up - down)
        return float(log_decrement(h * np.arange(half.size), half, omega=self.omega).decrement)


def named(log: list[str]) -> str | None:
    """The lead that a log names, or None."""
    words = [line.split("lead must be ")[1].split(",")[0] for line in log if "lead must be " in line]
    return words[0] if words else None


def main() -> None:
    """Print."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for bench in (Bench("contact", Path(folder)), Bench("6205", Path(folder))):
            for forced in (False, True):
                wanted = bench.decrement("rollback", "RK4", STEPS[0], 0.0, forced)
                for (master, mass), right in LEADS.items():
                    for lead in dict.fromkeys((right, DEFAULT)):
                        how = f"{'forced' if forced else 'free':<7} {master:<9} {mass:<17}"
                        row = f"{bench.kind:<8} {how} {lead:<4g}"
                        for h in STEPS:
                            damping = bench.decrement(master, mass, h, lead, forced) / wanted
                            right_lead = named(bench.run(master, mass, h, lead, forced, WATCHED)[1])
                            row += f"{damping:>8.3f} {right_lead or '-':<4}"
                        print(row, flush=True)


if __name__ == "__main__":
    main()
