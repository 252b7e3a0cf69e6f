"""A rigid rotor of Exudyn on the FMUs of two angular contact bearings, preloaded against each other.

    pip install exudyn
    python examples/studies/rotor_in_exudyn.py [rotor_in_exudyn.png]  # a minute

A body of 3 kg that turns at 6000 rev/min is held by two 7205, 100 mm apart, and struck along the shaft and across
it. What one learns: the FMUs need displacements and velocities of two points of the body before each step, and
loads that hold their forces over it, as a Runge-Kutta step does. The trapezoidal rule takes loads as those of the
ends of its steps, for which the FMUs have `lead` = 2.
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

RING = "x", "y", "z", "tilt_x", "tilt_y"  # displacements of an inner ring

RPM, OMEGA, ARM, PRELOAD = 6000.0, 200.0 * np.pi, 0.05, 8e-6  # rev/min, rad/s, m, m
MASS, INERTIA, POLAR = 3.0, 0.01, 0.004  # kg, kg m2
BLOW = np.array([0.0, 2e-3, 1e-3, 0.02, 0.0])  # m/s, rad/s
STEP, FINE, UNTIL = 1e-5, 2e-6, 0.02  # s
NAMES = {"x": 0, "y": 1, "z": 2, "tilt_x": 3, "tilt_y": 4}
RATES = "velocity_x", "velocity_y", "velocity_z", "tilt_rate_x", "tilt_rate_y"
FORCES = "force_x", "force_y", "force_z", "moment_x", "moment_y"


def bearing() -> BallBearing:
    """Bearing and oil."""
    return BallBearing.catalogue("7205", oil=Lubricant.iso_vg(46, temperature=70.0))


def in_one() -> Any:
    """The start, and the run of `simulate_rotor`."""
    mounts = [
        BearingMount(bearing=bearing(), **NAMES, offset=PRELOAD, arm=side * ARM, facing="+z" if side > 0 else "-z")
        for side in (-1, 1)
    ]
    gyroscopic = np.zeros((5, 5))
    gyroscopic[3, 4], gyroscopic[4, 3] = POLAR, -POLAR
    rotor = Rotor(
        mass=np.diag([MASS, MASS, MASS, INERTIA, INERTIA]), stiffness=np.zeros((5, 5)), gyroscopic=gyroscopic,
        mounts=tuple(mounts), load=np.array([0.0, -9.81 * MASS, 0.0, 0.0, 0.0]),
    )  # fmt: skip
    start = rotor.equilibrium(RPM)
    return start, simulate_rotor(rotor, speed_rpm=RPM, dt=FINE, until=UNTIL, start=(start, BLOW))


class Bearing:
    """The FMU of a bearing at a place along the body, and the loads of Exudyn that have its forces."""

    def __init__(self, path: str, body: Any, mbs: Any, side: float) -> None:
        folder, about = extract(path), read_model_description(path)
        number = {variable.name: variable.valueReference for variable in about.modelVariables}
        self.given, self.asked = [number[name] for name in (*NAMES, *RATES)], [number[name] for name in FORCES]
        self.offset, self.at, self.body, self.mbs = number["offset"], [0.0, 0.0, side * ARM], body, mbs
        self.faces = np.array([1.0, 1.0, side, side, side])  # a bearing that faces -z is a mirror image
        self.unit = instantiate_fmu(folder, about, "CoSimulation")
        zero = [0.0, 0.0, 0.0]
        self.force = mbs.CreateForce(itemNumber=body, loadVector=zero, localPosition=self.at, bodyFixed=False)
        self.moment = mbs.CreateTorque(itemNumber=body, loadVector=zero, bodyFixed=False)

    def of(self, what: Any, at: Any = (0.0, 0.0, 0.0), when: Any = None) -> np.ndarray:
        """Output of the body at a point, by default at present."""
        more = {} if when is None else {"configuration": when}
        return np.array(self.mbs.GetObjectOutputBody(self.body, what, localPosition=list(at), **more))

    def motion(self, v: Any, when: Any = None) -> list[float]:
        """Displacements and velocities of the ring, from place and axis of the body."""
        axis = self.of(v.RotationMatrix, when=when).reshape(3, 3)[:, 2]
        turns = np.cross(self.of(v.AngularVelocity, when=when), axis)
        q = self.faces * [*(self.of(v.Position, self.at, when) - self.at), -axis[1], axis[0]]
        return [*q, *(self.faces * [*self.of(v.Velocity, self.at, when), -turns[1], turns[0]])]

    def start(self, motion: list[float]) -> None:
        """At rest, under its preload."""
        self.unit.setupExperiment(startTime=0.0)
        self.unit.setReal([self.offset, *self.given], [PRELOAD, *motion])
        self.unit.enterInitializationMode()
        self.unit.exitInitializationMode()

    def step(self, t: float, motion: list[float]) -> None:
        """Loads of the next step of the body; the FMU steps beside it, by the motion at its start."""
        force = self.faces * self.unit.getReal(self.asked)
        self.mbs.SetLoadParameter(self.force, "loadVector", force[:3].tolist())
        self.mbs.SetLoadParameter(self.moment, "loadVector", [*force[3:].tolist(), 0.0])
        self.unit.setReal(self.given, motion)
        self.unit.doStep(currentCommunicationPoint=t, communicationStepSize=STEP)


def coupled(path: str, start: np.ndarray) -> np.ndarray:
    """Displacements of the body over the steps, shape (k, 5); at the start it does not tilt."""
    import exudyn as exu
    from exudyn.rigidBodyUtilities import RigidBodyInertia

    container, v = exu.SystemContainer(), exu.OutputVariableType
    mbs = container.AddSystem()
    body = mbs.CreateRigidBody(
        inertia=RigidBodyInertia(mass=MASS, inertiaTensor=np.diag([INERTIA, INERTIA, POLAR])),
        nodeType=exu.NodeType.RotationRotationVector, initialDisplacement=start[:3].tolist(),
        initialVelocity=BLOW[:3].tolist(), initialAngularVelocity=[*BLOW[3:], OMEGA], gravity=[0.0, -9.81, 0.0],
    )  # fmt: skip
    bearings, kept = [Bearing(path, body, mbs, side) for side in (-1.0, 1.0)], []
    mbs.Assemble()
    for one in bearings:
        one.start(one.motion(v, exu.ConfigurationType.Initial))

    def before_step(mbs: Any, t: float) -> bool:
        axis = bearings[0].of(v.RotationMatrix).reshape(3, 3)[:, 2]
        kept.append(np.array([*bearings[0].of(v.Position), -axis[1], axis[0]]))
        for one in bearings:
            one.step((len(kept) - 1) * STEP, one.motion(v))
        return True

    mbs.SetPreStepUserFunction(before_step)
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = round(UNTIL / STEP), UNTIL
    settings.solution.file.write = False
    mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44)
    return np.array(kept)


def main(picture: str | None = None) -> dict[str, Any]:
    """Both runs, their differences printed, and the picture."""
    from matplotlib.figure import Figure

    start, wanted = in_one()
    with tempfile.TemporaryDirectory() as folder:
        path = str(export(bearing(), Path(folder) / "7205.fmu", speeds_rpm=RPM, directions=RING))
        run = coupled(path, start)
    t = STEP * np.arange(len(run))
    exact = np.array([np.interp(t, wanted.t, one) for one in wanted.displacement.T]).T
    gap = np.abs(run - exact).max(axis=0) / np.ptp(exact, axis=0)
    figure = Figure(figsize=(10.0, 3.6), layout="constrained")
    shown = ("along the shaft, µm", 2), ("tilt about y, µrad", 4)
    for panel, (name, k) in zip(figure.subplots(1, 2), shown, strict=True):
        panel.plot(1e3 * t, 1e6 * (run[:, k] - start[k]), label="Exudyn and FMUs")
        panel.plot(1e3 * t, 1e6 * (exact[:, k] - start[k]), "k:", label="simulate_rotor")
        panel.set(xlabel="time, ms", ylabel=name)
    panel.legend()
    figure.savefig(picture or Path(__file__).with_suffix(".png"), dpi=110)
    print("largest difference from one run, over its range:", ", ".join(f"{100.0 * one:.2g} %" for one in gap))
    return {"gap": gap, "wanted": wanted}


if __name__ == "__main__":
    main(*sys.argv[1:])
