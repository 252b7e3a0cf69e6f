"""Tasks of a study that solve nothing: they leave files at once, and numbers that follow from speed and load.

Threads run them in place of processes. ``calls`` has a line for every task begun; ``orders`` names tasks to fail,
as ``4000rpm_20N free``; with ``slow`` in it every task takes a moment.
"""

import json
import time

from ehlcontact.cli.study.stages import Answer
from ehlcontact.content_store import checksum
from ehlcontact.executors import ProcessExecutor

FMU = {"passes": True, "file": "contact.fmu"}


class Threads(ProcessExecutor):
    """Executor that runs its tasks in threads of this process."""

    def _run(self, fn, args, kwargs):
        return fn(*args, **kwargs)


class StubTasks:
    """The tasks; a call gives what was begun since the last call."""

    def __init__(self):
        self.calls, self.orders = [], []

    def __call__(self):
        done, self.calls = sorted(self.calls), []
        return done

    def _begin(self, key):
        self.calls.append(key)
        time.sleep(0.05 if "slow" in self.orders else 0.0)
        if key in self.orders:
            return {"status": "diverged", "message": "The residual grows: use a finer grid.", "seconds": 0.01}
        return {"status": "converged", "message": "", "seconds": 0.01}

    def solve_stage(self, key, study, name):
        entry = self._begin(key)
        return Answer(entry, key.encode() if entry["status"] == "converged" else b"some")

    def finalise_point(self, key, study, folder, seconds):
        entry = self._begin(key)
        speed, load = study.speed_rpm, study.radial_load
        results = {
            "machine": None,
            "does_not_hold": ["isothermal"],
            "answer": f"It rolls at {speed:g} rpm.",
            "fits": [
                {"record": "free", "model": "cubic"},
                {"record": "free", "model": "linear", "refused": "why"},
            ],
            "memory": {"refused": "why"},
            "fmu": FMU | {"passes": f"{key} without FMU" not in self.orders},
            "film_fmu": None,
            "oil_and_heat": {
                "1": {"refused": {"with the layer": "thin"} if f"{key} without films" in self.orders else {}}
            },
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
        (folder / "report.html").write_text(study.title)
        files = {name: checksum(folder / name) for name in ("results.json", "report.html")}
        return Answer(entry | {"whole": results["fmu"]["passes"], "warnings": ["a warning"], "files": files})
