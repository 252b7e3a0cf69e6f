"""A run of a rotor on its ball bearings by the steps of `simulate_rotor`, with inputs as its FMU has them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fmu.bearing.model import BearingModel
from fmu.bearing.tables import film_logarithms
from fmu.rotor.model import RotorModel
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.race import RACES
from reduced_models.rotor.integrate_python import PythonSteps
from reduced_models.rotor.prepared_run import PreparedRun
from reduced_models.rotor.speed_profile import SpeedProfile, turning_forces

_Floats = NDArray[np.float64]

STEPS = 100
NOW = 1  # entry of speeds of contacts: at the end of the last step
TOLERANCE = 1e-11  # of the balance of a step
RHO = 0.8  # of simulate_rotor
PUSH = 1.5  # of the weight: forces that lift the rotor off
LEVER = 0.02  # m, of forces that turn a node
UNIT, MORE = 1e-6, 2e-5  # kg m, unbalances: by which forces are scaled; by which they grow


@dataclass(frozen=True, slots=True, eq=False)
class RotorTrial:
    """Ends of equal steps, the first one at rest.

    Attributes
    ----------
    time : ndarray, shape (k,)
    inputs : ndarray, shape (k, inputs)
        In the order of the FMU; straight between the ends of a step.
    displacement, velocity : ndarray, shape (k, named directions + motions of rings)
    force : ndarray, shape (k, motions of rings)
        On the inner rings [N].
    load : ndarray, shape (k, bearings, 2)
        Largest of a ball at both races [N].
    angle, speed : ndarray, shape (k,)
        Of the shaft [rad], [rad/s].
    parted : int
        Balls that carried nothing at the inner race, over all ends of steps.
    """

    time: _Floats
    inputs: _Floats
    displacement: _Floats
    velocity: _Floats
    force: _Floats
    load: _Floats
    angle: _Floats
    speed: _Floats
    parted: int


class _Run(PreparedRun):
    """A prepared run with the tables of the FMU, forces at named nodes, and unbalances that change."""

    def __init__(self, model: RotorModel, dt: float, course: SpeedProfile, given: _Floats) -> None:
        self._model, self._given, self._course = model, given, course
        super().__init__(model.rotor, course, dt, len(given) - 1, "static", RHO)

    def _begin(self, start: Any) -> _Floats:
        model, rotor, time = self._model, self._model.rotor, self.t
        self.balls = tuple(one.motion() for one in model.bearings)
        places = [place for _, _, place in model.shaft.points]
        unit = replace(rotor, unbalances=tuple(replace(u, amount=UNIT) for u in rotor.unbalances))
        omega, angle, rise = self._course.at(time)
        turning, at = turning_forces(unit, omega, angle, rise)
        amounts = self._given[:, len(places) :] / UNIT
        self.turning = np.hstack([turning * np.repeat(amounts, 2, axis=1), self._given[:, : len(places)]])
        self.at = np.hstack([at, np.eye(rotor.size)[:, places]])
        return super()._begin(start)


@lru_cache(maxsize=1)
def rotor_trial(model: RotorModel, steps: int = STEPS) -> RotorTrial:
    """A run-up with forces that lift the rotor off its bearings, and unbalances that grow."""
    rng, speeds = np.random.default_rng(1), model.bearings[0].speeds
    dt, rotor, points = model.inner_step, model.rotor, model.shaft.points
    time = dt * np.arange(steps + 1)
    omega = 2.0 * np.pi * rng.uniform(1.0, 10.0, len(points)) / time[-1]
    size = PUSH * max(float(np.abs(rotor.load).sum()), 1.0)
    levers = np.array([LEVER if name.startswith("tilt") else 1.0 for _, name, _ in points])
    amounts = np.array([u.amount for u in rotor.unbalances])
    grown = amounts + MORE * np.outer(time / time[-1], np.ones(amounts.size))
    given = np.hstack([size * levers * np.sin(omega * time[:, None]), grown])
    course = SpeedProfile.ramp(float(speeds[0]), float(speeds[-1]), 2.0 * float(time[-1]))
    return _recorded(model, _Run(model, dt, course, given), given)


def _recorded(model: RotorModel, run: _Run, given: _Floats) -> RotorTrial:
    integrator = PythonSteps(run, TOLERANCE, 30)
    forces, rolls, resisted = [[one.films.force.copy() for one in run.balls]], [_rolls(run)], [0.0]
    for k in range(run.steps):
        middle = float(0.5 * (run.omega[k] + run.omega[k + 1]))
        integrator.advance(run._steps_at(middle), k, k + 1, lambda made: None)
        forces.append([one.films.force.copy() for one in run.balls])
        rolls.append(_rolls(run))
        resisted.append(_slowed(model, run, given[k + 1], k + 1))
    d, v, motion, rate, force, _ = run.histories
    places = [place for _, _, place in model.shaft.points]
    drive = run.omega if model.inertia is None else _torque(model, run, forces, rolls, np.array(resisted))
    return RotorTrial(
        time=run.t,
        inputs=np.column_stack([given, drive]),
        displacement=np.hstack([d[:, places], motion + run.shift]),
        velocity=np.hstack([v[:, places], rate]),
        force=-force,
        load=np.array([[one.max(axis=0) for one in row] for row in forces]),
        angle=run._course.at(run.t)[1],
        speed=run.omega,
        parted=sum(int((one[:, 0] == 0.0).sum()) for row in forces for one in row),
    )


def _slowed(model: RotorModel, run: _Run, given: _Floats, k: int) -> float:
    """Torque that the unbalances take from the shaft at the end of a step, through their accelerations."""
    angle, acceleration, found = float(run._course.at(run.t[k : k + 1])[1][0]), run.state[2], 0.0
    for u, amount in zip(model.rotor.unbalances, given[len(model.shaft.points) :], strict=True):
        for place, share in ((u.x, -np.sin(angle + u.phase)), (u.y, np.cos(angle + u.phase))):
            found += 0.0 if place is None else float(amount * share * acceleration[place])
    return found


def _rolls(run: _Run) -> list[_Floats]:
    """Sums of both surface speeds at all contacts over the speed of the shaft [m], shape (balls, 2) each."""
    return [one.films.speed_sum[:, NOW].reshape(-1, 2).copy() for one in run.balls]


def _torque(
    model: RotorModel,
    run: _Run,
    forces: list[list[_Floats]],
    rolls: list[list[_Floats]],
    resisted: _Floats,
) -> _Floats:
    """Torque of a motor that makes the shaft turn as it does, against what resists."""
    assert model.inertia is not None
    speed = run.omega / RPM_TO_RAD_S
    for b, one in enumerate(model.bearings):
        if one.bearing.oil is not None:
            loads, sums = (np.array([row[b] for row in rows]) for rows in (forces, rolls))
            resisted += _rolling_torques(one, speed, loads, sums)
    on = 1.5 * resisted - 0.5 * np.append(resisted[:1], resisted[:-1])  # as the FMU has it go on in a step
    means = model.inertia * np.diff(run.omega) / run.dt + on[:-1]
    torque = np.append(means[0], means)
    for k in range(1, torque.size):
        torque[k] = 2.0 * means[k - 1] - torque[k - 1]  # it runs straight through a step
    return torque


def _rolling_torques(model: BearingModel, speed: _Floats, force: _Floats, rolls: _Floats) -> _Floats:
    """Torque that films take at speeds [rev/min], shape (k,), from the tables of the FMU.

    Forces and sums of surface speeds at all contacts have shape (k, balls, 2).
    """
    torque = np.zeros(speed.size)
    k, place = np.arange(speed.size), np.interp(np.log(speed), np.log(model.speeds), np.arange(model.speeds.size))
    row = np.minimum(place.astype(int), max(model.speeds.size - 2, 0))
    above, share = np.minimum(row + 1, model.speeds.size - 1), (place - row)[:, None]
    for race, (name, x, rows) in enumerate(zip(RACES, *film_logarithms(model), strict=True)):
        at = np.log(np.maximum(force[:, :, race], np.exp(x[0])))
        of_speeds = np.array([np.interp(at, x, moment) for _, _, moment in rows])
        moment = np.exp(of_speeds[row, k] + share * (of_speeds[above, k] - of_speeds[row, k]))
        torque += (0.5 * rolls[:, :, race] * moment).sum(axis=1) / model.bearing.race(name).geometry.radius_x
    return torque
