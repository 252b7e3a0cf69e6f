"""A worker that solves nothing: it leaves the files of a task, and numbers that follow from speed and load.

Run in place of Python by the runner: ``stub -m MODULE STUDY.toml FOLDER TASK``. Beside itself it keeps
``calls``, a line for every task begun, and finds ``orders``: tasks to fail, as ``4000rpm_20N free``, or ``slow``.
"""

import json
import sys
import time
import tomllib
from pathlib import Path

FMU = {"passes": True, "file": "contact.fmu"}


def main(study_file, folder, task):
    """Do the task."""
    here, folder = Path(sys.argv[0]).parent, Path(folder)
    study = tomllib.loads(Path(study_file).read_text())
    speed, load = study["bearing"]["speed_rpm"], study["bearing"]["radial_load"]
    name = f"{speed:g}rpm_{load:g}N {task}"
    with (here / "calls").open("a") as calls:
        calls.write(name + "\n")
    orders = (here / "orders").read_text().splitlines() if (here / "orders").exists() else []
    time.sleep(0.05 if "slow" in orders else 0.0)
    last = {"status": "converged", "message": "", "seconds": 0.01}
    if name in orders:
        last |= {"status": "diverged", "message": "The residual grows: use a finer grid."}
    elif task == "report":
        results = {
            "answer": f"It rolls at {speed:g} rpm.",
            "fits": [
                {"record": "free", "model": "cubic"},
                {"record": "free", "model": "linear", "refused": "why"},
            ],
            "memory": {"refused": "why"},
            "fmu": FMU | {"passes": f"{name} without FMU" not in orders},
            "film_fmu": None,
            "operating_point": {
                "h_central_um": 1e-4 * speed,
                "h_min_um": 0.5e-4 * speed,
                "h_central_error": 0.01,
                "h_min_error": None,
            },
            "at_rotor_speed": {"stiffness": 1e6 * load, "damping": 1e5 / speed},
            "rotor": {"decay": {"decrements": {"full": {"hz": 800.0, "decrement": 0.02}}}},
        }
        (folder / "results.json").write_text(json.dumps(results))
        (folder / "report.html").write_text(study.get("title", ""))
        last |= {"whole": results["fmu"]["passes"], "warnings": ["a warning"], "files": {}}
    else:
        (folder / f"{task}.h5").write_text(name)
    print(json.dumps(last))


if __name__ == "__main__":
    main(*sys.argv[3:])
