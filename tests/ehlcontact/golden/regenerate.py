"""Write golden.json anew: the library's own numbers, to notice when they change.

Run from the root of the checkout, look at the difference, and record it under "Numerics" in CHANGELOG.md:

    python tests/ehlcontact/golden/regenerate.py
"""

import json
from pathlib import Path

import numpy as np

from ehlcontact import FreeVibration, HarmonicLoad, MoesPoint, PrescribedApproach, RampLoad, simulate, solve_steady
from ehlcontact.impedance import impedance

FILE = Path(__file__).with_name("golden.json")
PAPER = MoesPoint(200, 10, 0.5)

STEADY = {
    "paper": (PAPER, 64),
    "circle": (MoesPoint(20, 10, 1.0), 64),
    "barus incompressible": (MoesPoint(50, 6, 0.5, viscosity="barus", density="incompressible"), 64),
    "isoviscous": (MoesPoint(200, 0, 1.0), 64),
    "deep groove": (MoesPoint(2900, 19, 0.11), 64),
    "along rolling": (MoesPoint(50, 6, 2.0), 64),
}
T = np.linspace(0.0, 1.0, 21)
TRANSIENT = {
    "free": (FreeVibration(5.13), {}),
    "offset": (FreeVibration(2.56, offset=0.05), {"until": 1.0}),
    "harmonic": (HarmonicLoad(np.pi), {"until": 1.0}),
    "ramp": (RampLoad(1.5, 0.5, 5.13), {"until": 1.0}),
    "approach": (PrescribedApproach(T, 0.88 + 0.05 * np.sin(np.pi * T) ** 2), {}),
}
OMEGAS = [0.0, 0.25, 3.0, 12.0]


def steady(name):
    """Numbers of one steady film, solved far below discretisation error."""
    point, n = STEADY[name]
    film = solve_steady(point, n=n, tol=1e-8, max_cycles=80)
    return {k: getattr(film, k) for k in ("approach", "h_central", "h_min", "p_max")}


def transient(name):
    """End of one record at n = 32."""
    motion, arguments = TRANSIENT[name]
    record = simulate(PAPER, motion, n=32, tol=1e-7, **arguments)
    last = {k: float(getattr(record, k)[-1]) for k in ("T", "approach", "rate", "force", "h_central", "h_min")}
    return {"steps": record.steps, **last}


def response():
    """Stiffness and damping at n = 32."""
    result = impedance(PAPER, OMEGAS, n=32)
    return {"stiffness": result.stiffness.tolist(), "damping": result.damping.tolist()}


def everything():
    """All golden values."""
    return {
        "steady": {name: steady(name) for name in STEADY},
        "transient": {name: transient(name) for name in TRANSIENT},
        "impedance": response(),
    }


if __name__ == "__main__":
    FILE.write_text(json.dumps(everything(), indent=2) + "\n")
    print(f"wrote {FILE}")
