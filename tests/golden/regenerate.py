"""The library's own numbers, to notice when they change: cases, and `golden.json` written anew.

    python tests/golden/regenerate.py                       # everything, about two minutes
    python tests/golden/regenerate.py steady meshes         # these groups

Look at the difference and record it under "Numerics" in CHANGELOG.md; after ``validation``, run
``python docs/site/validation.py`` for its page. `bits.py` beside this file compares two checkouts on one machine,
to the last bit.
"""

import json
import subprocess
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

sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parents[1]))  # the tests' own helpers
sys.path.insert(0, str(Path(__file__).parents[2] / "docs" / "site"))

import meshes
import motions
import validation
from argument_groups import grouped

ROOT = Path(__file__).parents[2]
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
    last = {k: float(getattr(record, k)[-1]) for k in ("approach", "rate", "force", "h_central", "h_min")}
    return {"steps": record.steps, "T": float(record.t[-1]), **last}


def response(_):
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
    found["bars"] = [
        answer.error_bars["approach"],
        answer.error_bars["h_central"],
        *answer.error_bars["damping"].tolist(),
    ]
    for model in ("wide", "memory", "cubic"):
        element = atlas.element(point, model, **({"Omega": 2.0 * np.pi} if model == "cubic" else {}))
        rest = element.approach_at(1.0)
        element.rest(rest)
        found[model] = [rest, *element.step_tangents(0.3, rest + 0.02, 0.05)]
    return found


def measured(section):
    """A section of the page of validation: this library beside what others published."""
    return validation.SECTIONS[section].measure()


GROUPS = {  # names, the numbers of one, and how far they may be off: relative and absolute
    "steady": (STEADY, steady, 1e-6, 1e-9),
    "transient": (TRANSIENT, transient, 2e-5, 1e-5),
    "impedance": (["paper"], response, 1e-4, 1e-9),
    "fit": (MODELS, fitted, 1e-3, 1e-9),
    "atlas": (ATLAS, answered, 1e-6, 1e-9),
    "meshes": (meshes.points(), lambda name: meshes.decisions(*meshes.points()[name]), 1e-9, 0.0),
    "motions": (motions.CASES, motions.solved, 1e-3, 1e-4),
    "validation": (validation.SECTIONS, measured, 1e-5, 1e-9),
}


def stored():
    """Content of `golden.json`."""
    return json.loads(FILE.read_text(encoding="utf-8"))


def write(content):
    """One line for every case."""
    groups = []
    for group, cases in content.items():
        lines = ",\n".join(f" {json.dumps(name)}: {json.dumps(found)}" for name, found in cases.items())
        groups.append(f"{json.dumps(group)}: {{\n{lines}\n}}")
    FILE.write_text("{\n" + ",\n".join(groups) + "\n}\n", encoding="utf-8")


def commit():
    """Short name of the present commit."""
    asked = ["git", "rev-parse", "--short", "HEAD"]
    return subprocess.run(asked, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()


if __name__ == "__main__":
    asked = sys.argv[1:] or list(GROUPS)
    made = {group: {name: GROUPS[group][1](name) for name in GROUPS[group][0]} for group in asked}
    if "validation" in made:
        made["validation"]["version"] = commit()
    write(stored() | made)
    print(f"wrote {', '.join(asked)} of {FILE}")
