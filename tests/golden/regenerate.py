"""Write golden.json anew: the library's own numbers, to notice when they change.

Run from the root of the checkout, look at the difference, and record it under "Numerics" in CHANGELOG.md:

    python tests/golden/regenerate.py

`bits.py` beside this file is sharper, and for two checkouts on one machine.
"""

import json
import sys
from pathlib import Path

import numpy as np

from ehlcontact import (
    FreeVibration,
    Grid,
    HarmonicLoad,
    MoesPoint,
    PrescribedApproach,
    RampLoad,
    TimeSteps,
    impedance,
    simulate,
    solve_steady,
)
from reduced_models import Atlas, ContactRecord, fit, fit_memory

sys.path.insert(0, str(Path(__file__).parents[1]))  # the tests' own helpers

from argument_groups import grouped

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
    "free": (FreeVibration(Omega_n=5.13), {}),
    "offset": (FreeVibration(Omega_n=2.56, offset=0.05), {"until": 1.0}),
    "harmonic": (HarmonicLoad(Omega=np.pi), {"until": 1.0}),
    "ramp": (RampLoad(1.5, 0.5, Omega_n=5.13), {"until": 1.0}),
    "approach": (PrescribedApproach(T, 0.88 + 0.05 * np.sin(np.pi * T) ** 2), {}),
}
OMEGAS = [0.0, 0.25, 3.0, 12.0]
MODELS = ("linear", "cubic", "polynomial", "power", "memory")
ATLAS = {"paper": PAPER, "narrow": MoesPoint(500, 15, 0.12), "heavy": MoesPoint(9000, 16, 0.1)}


def steady(name):
    """Numbers of one steady film, solved far below discretisation error."""
    point, n = STEADY[name]
    film = solve_steady(point, grid=Grid(n=n), tol=1e-8, max_cycles=80)
    return {k: getattr(film, k) for k in ("approach", "h_central", "h_min", "p_max")}


def transient(name):
    """End of one record at n = 32."""
    motion, arguments = TRANSIENT[name]
    record = simulate(PAPER, motion, **grouped(n=32, tol=1e-7, **arguments))
    last = {k: float(getattr(record, k)[-1]) for k in ("T", "approach", "rate", "force", "h_central", "h_min")}
    return {"steps": record.steps, **last}


def response():
    """Stiffness and damping at n = 32."""
    result = impedance(PAPER, Omega=OMEGAS, grid=Grid(n=32))
    return {"stiffness": result.stiffness.tolist(), "damping": result.damping.tolist()}


def fitted(model):
    """What every model makes of one short record: coefficients, quality, and the statics of the element."""
    if model == "memory":
        response = impedance(PAPER, Omega=[0.0, *np.geomspace(0.03, 60.0, 12)], grid=Grid(n=32))
        result = fit_memory(response, lags=6)
        return {"root": result.root, "tangent": result.tangent, "gains": list(result.element.gains)}
    record = ContactRecord.from_result(
        simulate(PAPER, FreeVibration(Omega_n=5.13), grid=Grid(n=32), time=TimeSteps(tol=1e-7))
    )
    result = fit(record, model=model)
    return {"root": result.root, "tangent": result.tangent, "rms": result.rms, **result.parameters}


def answered(name):
    """The atlas at one point, with its bars, and the force and tangents of its elements in one step."""
    atlas, point = Atlas(), ATLAS[name]
    answer = atlas.at(point)
    found = {k: getattr(answer, k) for k in ("approach", "h_central", "h_min")}
    found |= {k: getattr(answer, k).tolist() for k in ("stiffness", "damping")}
    found["bars"] = [answer.error["approach"], answer.error["h_central"], *answer.error["damping"].tolist()]
    for model in ("wide", "memory", "cubic"):
        element = atlas.element(point, model, **({"Omega": 2.0 * np.pi} if model == "cubic" else {}))
        rest = element.approach_at(1.0)
        element.rest(rest)
        found[model] = [rest, *element.step_tangents(0.3, rest + 0.02, 0.05)]
    return found


def everything():
    """All golden values."""
    return {
        "steady": {name: steady(name) for name in STEADY},
        "transient": {name: transient(name) for name in TRANSIENT},
        "impedance": response(),
        "fit": {model: fitted(model) for model in MODELS},
        "atlas": {name: answered(name) for name in ATLAS},
    }


if __name__ == "__main__":
    FILE.write_text(json.dumps(everything(), indent=2) + "\n")
    print(f"wrote {FILE}")
