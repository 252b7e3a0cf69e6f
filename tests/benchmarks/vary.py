"""Half and double of a constant of the solver: what they change in films, impedance and a free vibration.

    python tests/benchmarks/vary.py ehlcontact.solver.mesh_choice:FINEST ehlcontact.solver.iterate:SLOW

Each value runs in a fresh process with kernels compiled anew, so that copies in other modules change too. A row
gives the largest relative change of each group of results and the time over that of the unchanged constant.
"""

from __future__ import annotations

import importlib
import json
import os
import subprocess
import sys
import tempfile
import time

import numpy as np

POINTS = (200, 10, 0.5), (2900, 19, 0.107), (20, 10, 1.0)


def results() -> dict[str, list[float]]:
    """Films on default grids, one impedance, one free vibration."""
    from ehlcontact import FreeVibration, Grid, MoesPoint, TimeSteps, impedance, simulate, solve_steady

    points = [MoesPoint(*numbers) for numbers in POINTS]
    films = [solve_steady(point) for point in points]
    response = impedance(points[0], Omega=[0.0, 0.25, 3.0], grid=Grid(n=64))
    record = simulate(points[0], FreeVibration(Omega_n=5.13), grid=Grid(n=64), time=TimeSteps(until=1.0))
    return {
        "films": [value for film in films for value in (film.approach, film.h_central, film.h_min)],
        "impedance": [*response.stiffness, *response.damping],
        "transient": [record.approach[-1], record.force[-1], record.h_min[-1]],
    }


def scaled(value: object, factor: float) -> object:
    """A number, or every number of a tuple, times `factor`; whole numbers stay whole and at least 1."""
    if isinstance(value, tuple):
        return type(value)(scaled(entry, factor) for entry in value)
    if isinstance(value, int):
        return max(1, round(value * factor))
    assert isinstance(value, float), "numbers and tuples of numbers only"
    return value * factor


def measure(constant: str, factor: float) -> None:
    """Print the results with one constant changed, as JSON; called in a process of its own."""
    module, name = constant.split(":")
    home = importlib.import_module(module)
    old, new = getattr(home, name), scaled(getattr(home, name), factor)
    for other in [m for key, m in sys.modules.items() if key.startswith("ehlcontact") and hasattr(m, name)]:
        if getattr(other, name) is old:
            setattr(other, name, new)
    results()  # compiles
    started = time.process_time()
    found = results()
    print(json.dumps({"seconds": time.process_time() - started, **found}, default=float))


def run(constant: str, factor: float) -> dict[str, object]:
    """`measure` in a fresh process; raises `CalledProcessError` where the solver fails."""
    with tempfile.TemporaryDirectory() as cache:
        command = [sys.executable, __file__, "--measure", constant, str(factor)]
        environment = os.environ | {"NUMBA_CACHE_DIR": cache, "OPENBLAS_NUM_THREADS": "1"}
        done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True, check=True)
    found: dict[str, object] = json.loads(done.stdout)
    return found


def main(constants: list[str]) -> None:
    """One row for the half and one for the double of every constant."""
    for constant in constants:
        base = run(constant, 1.0)
        for factor in (0.5, 2.0):
            row = f"{constant} x {factor:g}"
            try:
                found = run(constant, factor)
            except subprocess.CalledProcessError:
                print(f"{row}: the solver fails")
                continue
            changes = {
                group: float(np.max(np.abs(np.divide(found[group], base[group]) - 1.0)))  # type: ignore[arg-type]
                for group in ("films", "impedance", "transient")
            }
            words = ", ".join(f"{group} {change:.2g}" for group, change in changes.items())
            print(f"{row}: {words}, time {found['seconds'] / base['seconds']:.2f}")  # type: ignore[operator]


if __name__ == "__main__":
    if sys.argv[1:2] == ["--measure"]:
        measure(sys.argv[2], float(sys.argv[3]))
    else:
        main(sys.argv[1:])
