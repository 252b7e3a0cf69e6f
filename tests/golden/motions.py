"""Five kinds of motion of one contact at three points, solved in full: what elements are judged by far from rest.

    python tests/golden/motions.py      # rms and largest error of the force of atlas elements, from stored solves

`regenerate.py motions` solves them again, about three minutes. A motion is a table of the approach; it begins at
rest, near the approach of the static load u_1. Forces are kept at every `EVERY`-th step.
"""

import numpy as np

from ehlcontact import MoesPoint, PrescribedApproach, TimeSteps, simulate
from reduced_models import Atlas

POINTS = {"light": MoesPoint(20, 5, 0.3), "middle": MoesPoint(37, 12, 0.8), "heavy": MoesPoint(2900, 19, 0.11)}
KINDS = ("small vibration", "vibration within contact", "slow return", "fast return", "impact")
CASES = [f"{point}, {kind}" for point in POINTS for kind in KINDS]
EVERY = 4
SAMPLES = 200  # of the table, per unit of time


def smooth(x):
    """From 0 to 1, with continuous curvature."""
    x = np.clip(x, 0.0, 1.0)
    return x**3 * (10.0 - 15.0 * x + 6.0 * x * x)


def motion(case):
    """Point, approach over time, end and step of a case."""
    name, kind = case.split(", ")
    point = POINTS[name]
    answers = Atlas().wide(point, Atlas().element(point, "wide").loads)  # each in the region of its own load
    u1, least, most = (answers.approach_at(load) for load in (1.0, 0.4, 1.8))

    def away(low, high, leave, down, back, up):
        """Off to `low` from `leave` to `down`, and to `high` from `back` to `up`."""
        start = low if leave == down else u1

        def approach(T):
            there = start + (low - start) * smooth((T - leave) / max(down - leave, 1e-9))
            return there + (high - low) * smooth((T - back) / (up - back))

        return approach

    def small(T):
        return u1 + smooth(T) * (0.02 * np.sin(0.5 * np.pi * T) + 0.01 * np.sin(2.0 * np.pi * T))

    def large(T):
        return u1 + smooth(T) * (0.5 * (least + most) - u1 + 0.5 * (most - least) * np.sin(0.5 * np.pi * T))

    approach, until, dt = {
        "small vibration": (small, 8.0, 0.02),
        "vibration within contact": (large, 8.0, 0.02),  # the static load goes from 0.4 to 1.8
        "slow return": (away(u1 - 1.1, u1, 0.2, 1.2, 2.2, 6.2), 8.0, 0.02),
        "fast return": (away(u1 - 1.6, u1 + 0.3, 0.2, 0.8, 2.8, 3.4), 6.0, 0.01),
        "impact": (away(u1 - 1.3, u1 + 0.2, 0.1, 0.1, 0.1, 0.5), 4.0, 0.01),
    }[kind]
    T = np.linspace(0.0, until, round(until * SAMPLES) + 1)
    return point, PrescribedApproach(T, approach(T)), until, dt


def solved(case):
    """Force of the full film at every `EVERY`-th step."""
    point, table, until, dt = motion(case)
    run = simulate(point, table, time=TimeSteps(until=until, dt=dt))
    return {"n": run.n, "force": [round(float(f), 5) for f in run.force[::EVERY]]}


def errors(case, force, model="wide"):
    """RMS error of the force of an element over its standard deviation; largest one over the largest force."""
    point, table, until, dt = motion(case)
    T = np.linspace(0.0, until, round(until / dt) + 1)
    u, v = (np.array([at(t) for t in T]) for at in (table.approach, table.rate))
    full = np.asarray(force)
    off = Atlas().element(point, model).drive(T, u, v)[::EVERY] - full
    return float(np.sqrt(np.mean(off**2)) / full.std()), float(np.abs(off).max() / full.max())


if __name__ == "__main__":
    import json
    from pathlib import Path

    stored = json.loads(Path(__file__).with_name("golden.json").read_text(encoding="utf-8"))["motions"]
    for model in ("wide", "memory"):
        print(f"{model}: rms / largest error [%]")
        for case in CASES:
            rms, largest = errors(case, stored[case]["force"], model)
            print(f"  {case:34} {100 * rms:5.1f} {100 * largest:5.1f}")
