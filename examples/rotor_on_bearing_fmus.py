"""A rigid rotor in a loop of its own on the FMUs of two angular contact bearings, preloaded against each other.

    python examples/rotor_on_bearing_fmus.py [rotor_on_bearing_fmus.png]  # half a minute

A rotor of 3 kg on two 7205 at 6000 rev/min, 100 mm apart and preloaded against each other by 8 um each. It is
struck along the shaft and across it. What one learns: a loop that holds the forces over its step, as most tools
do, gives the run of `simulate_rotor` with steps of a sixtieth of the fastest period (1540 Hz). Four times
that multiplies the damping.
"""

import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from fmpy import extract, instantiate_fmu, read_model_description

from ehlcontact import Lubricant
from fmu import export
from reduced_models import BallBearing, BearingMount, Rotor, simulate_rotor

RPM, ARM, PRELOAD, MASS = 6000.0, 0.05, 8e-6, np.array([3.0, 3.0, 3.0, 0.01, 0.01])  # rev/min, m, m, kg and kg m2
BLOW = np.array([0.0, 2e-3, 1e-3, 0.02, 0.0])  # m/s, rad/s
LOAD = np.array([0.0, -9.81 * MASS[1], 0.0, 0.0, 0.0])
STEPS, FINE, UNTIL = (1e-5, 2e-5, 4e-5), 2e-6, 0.02  # s
NAMES = {"x": 0, "y": 1, "z": 2, "tilt_x": 3, "tilt_y": 4}
RATES = "velocity_x", "velocity_y", "velocity_z", "tilt_rate_x", "tilt_rate_y"
FORCES = "force_x", "force_y", "force_z", "moment_x", "moment_y"


def bearing() -> BallBearing:
    """Bearing and oil."""
    return BallBearing.catalogue("7205", oil=Lubricant.iso_vg(46, temperature=70.0))


def to_bearing(side: float) -> np.ndarray:
    """Displacements of the ring of a bearing from those of the rotor, (5, 5); the left one faces -z."""
    T = np.eye(5)
    T[0, 4], T[1, 3] = side * ARM, -side * ARM
    return np.diag([1.0, 1.0, side, side, side]) @ T


def in_one(dt: float) -> Any:
    """The run of `simulate_rotor`, bearings and rotor in one."""
    left = BearingMount(bearing=bearing(), **NAMES, offset=PRELOAD, arm=-ARM, facing="-z")
    right = BearingMount(bearing=bearing(), **NAMES, offset=PRELOAD, arm=ARM)
    rotor = Rotor(mass=np.diag(MASS), stiffness=np.zeros((5, 5)), mounts=(left, right), load=LOAD)
    start = rotor.equilibrium(RPM)
    return start, simulate_rotor(rotor, speed_rpm=RPM, dt=dt, until=UNTIL, start=(start, BLOW))


def coupled(path: str, start: np.ndarray, dt: float) -> np.ndarray:
    """The run of a loop: all step at once, forces are held, the rotor goes through its step exactly."""
    folder, about = extract(path), read_model_description(path)
    number = {variable.name: variable.valueReference for variable in about.modelVariables}
    given, asked = [number[name] for name in (*NAMES, *RATES)], [number[name] for name in FORCES]
    sides, fmus = [to_bearing(-1.0), to_bearing(1.0)], []
    for T in sides:
        one = instantiate_fmu(folder, about, "CoSimulation")
        one.setupExperiment(startTime=0.0)
        one.setReal([number["offset"], *given], [PRELOAD, *(T @ start), *(T @ BLOW)])
        one.enterInitializationMode()
        one.exitInitializationMode()
        fmus.append(one)
    q, v, kept = start.copy(), BLOW.copy(), [start]
    for k in range(round(UNTIL / dt)):
        a = (LOAD + sum(T.T @ one.getReal(asked) for T, one in zip(sides, fmus, strict=True))) / MASS
        for T, one in zip(sides, fmus, strict=True):
            one.setReal(given, [*(T @ q), *(T @ v)])
            one.doStep(currentCommunicationPoint=k * dt, communicationStepSize=dt)
        q, v = q + dt * (v + 0.5 * dt * a), v + dt * a
        kept.append(q)
    return np.array(kept)


def main(picture: str | None = None) -> dict[str, Any]:
    """All runs, their differences printed, and the picture."""
    from matplotlib.figure import Figure

    start, wanted = in_one(FINE)
    with tempfile.TemporaryDirectory() as folder:
        path = str(export(bearing(), Path(folder) / "7205.fmu", speeds_rpm=RPM))
        runs = {dt: coupled(path, start, dt) for dt in STEPS}
    figure, gaps = Figure(figsize=(10.0, 3.6), layout="constrained"), {}
    for panel, k, name in zip(figure.subplots(1, 2), (2, 1), ("along the shaft", "across it"), strict=True):
        for dt, run in runs.items():
            at = np.arange(len(run)) * dt
            exact = np.array([np.interp(at, wanted.t, one) for one in wanted.displacement.T[:5]]).T
            gaps[dt] = np.abs(run - exact).max(axis=0) / np.ptp(exact, axis=0)
            panel.plot(1e3 * at, 1e6 * (run[:, k] - start[k]), label=f"FMUs, steps of {1e6 * dt:g} µs")
        panel.plot(1e3 * wanted.t, 1e6 * (wanted.displacement[:, k] - start[k]), "k--", label="simulate_rotor")
        panel.set(xlabel="time, ms", ylabel=f"motion {name}, µm")
    print("largest difference from one run:", {dt: f"{100.0 * gap.max():.2g} %" for dt, gap in gaps.items()})
    panel.legend(fontsize=8)
    figure.savefig(picture or Path(__file__).with_suffix(".png"), dpi=110)
    return {"gaps": gaps, "wanted": wanted}


if __name__ == "__main__":
    main(*sys.argv[1:])
