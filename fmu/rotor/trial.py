"""A run of a rotor by the steps of `simulate_rotor`, with inputs as its FMU has them."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks.parts import SPEED
from ehlcontact.errors import ConvergenceError
from fmu.bearing.model import BearingModel
from fmu.bearing.tables import film_logarithms
from fmu.rotor.model import RotorModel
from reduced_models import OutsideValidityWarning, SpringContact
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.race import RACES
from reduced_models.rotor.integrate_python import PythonSteps
from reduced_models.rotor.prepared_run import PreparedRun
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.speed_profile import SpeedProfile, turning_forces
from reduced_models.rotor.supports import ContactMount

_Floats = NDArray[np.float64]

STEPS = 100
TOLERANCE = 1e-11  # of the balance of a step
RHO = 0.8  # of simulate_rotor
PUSH = 1.5  # of the weight: forces that lift the rotor off
SWING = 0.3  # of the forces of supports outside, by which they vary
LEVER = 0.02  # m, of forces that turn a node
UNIT, MORE = 1e-6, 2e-5  # kg m, unbalances: by which forces are scaled; by which they grow
RISE = 0.1  # of the speed, where no table has a range
TURN = 60  # steps of a revolution of a rotor that stands
DRAG = 0.05  # N m, of bearings outside
FAR = -1e3  # m
SHARES = 1.0, 0.1, 0.01, 1e-3  # of forces and growth of unbalances, until the journals of dampers stay clear
NOWHERE = SpringContact.linear(K1=1.0, C1=0.0, low=1.0, high=2.0, units="SI")  # a contact that is not met


@dataclass(frozen=True, slots=True, eq=False)
class RotorTrial:
    """Ends of equal steps, the first one at rest.

    Attributes
    ----------
    time : ndarray, shape (k,)
    inputs : ndarray, shape (k, inputs)
        In the order of the FMU; straight between the ends of a step.
    displacement, velocity : ndarray, shape (k, N)
    motion, rate : ndarray, shape (k, motions of the supports)
        Inside before outside.
    force : ndarray, shape (k, motions of supports inside)
        Of the rotor on them [N], [N m].
    load : ndarray, shape (k, bearings inside, 2)
        Largest of a ball at both races [N].
    angle, speed : ndarray, shape (k,)
        Of the shaft [rad], [rad/s].
    parted : int
        Balls and contacts that carried nothing, over all ends of steps.
    """

    time: _Floats
    inputs: _Floats
    displacement: _Floats
    velocity: _Floats
    motion: _Floats
    rate: _Floats
    force: _Floats
    load: _Floats
    angle: _Floats
    speed: _Floats
    parted: int


class _Run(PreparedRun):
    """A prepared run with the tables of the FMU, forces that are given, and unbalances that change."""

    def __init__(self, model: RotorModel, dt: float, course: SpeedProfile, given: _Floats, rows: _Floats) -> None:
        self._model, self._given, self._course, self._rows = model, given, course, rows
        inside = bool(model.inside) and not model.out and model.start is None
        start = "static" if inside else model.motion
        super().__init__(_rotor_inside(model), course, dt, len(given) - 1, start, RHO)

    def _begin(self, start: Any) -> _Floats:
        model, rotor, time = self._model, self.rotor, self.t
        self.balls = tuple(one.motion() for one in model.bearings)
        unit = replace(rotor, unbalances=tuple(replace(u, amount=UNIT) for u in rotor.unbalances))
        omega, angle, rise = self._course.at(time)
        turning, at = turning_forces(unit, omega, angle, rise)
        forces = len(self._rows)
        amounts = self._given[:, forces:] / UNIT
        self.turning = np.hstack([turning * np.repeat(amounts, 2, axis=1), self._given[:, :forces]])
        self.at = np.hstack([at, self._rows.T])
        if not isinstance(start, str):
            for mount, approach in zip(
                rotor.contacts, rotor.geometry.normals @ (rotor.geometry.points @ start[0]), strict=False
            ):
                mount.contact.rest(float(approach) + mount.offset)
        return super()._begin(start)


def _rotor_inside(model: RotorModel) -> Rotor:
    """The rotor on its supports inside alone."""
    gone = {id(station.mount) for station in model.out}
    mounts: list[Any] = [
        replace(mount, contact=mount.contact.copy()) if isinstance(mount, ContactMount) else mount
        for mount in model.rotor.mounts
        if id(mount) not in gone
    ]
    if not model.inside:
        nowhere = ContactMount(0.0, 0.0, None, NOWHERE, x=0, y=None)
        object.__setattr__(nowhere, "offset", FAR)  # a rotor without supports flies further than machines reach
        mounts.append(nowhere)
    return replace(model.rotor, mounts=tuple(mounts))


@lru_cache(maxsize=1)
def rotor_trial(model: RotorModel, rows: bytes = b"", steps: int = STEPS) -> RotorTrial:
    """A run-up with forces that lift the rotor off its supports, and unbalances that grow."""
    rng, rotor = np.random.default_rng(1), model.rotor
    dt, points = model.inner_step, model.points
    time = dt * np.arange(steps + 1)
    load = max(float(np.abs(rotor.load).sum()), 1.0)
    sizes = [PUSH * load * (LEVER if name.startswith("tilt") else 1.0) for _, name, _ in points]
    middle = [0.0] * len(points)
    for station in model.out:
        force = model.force(station)
        least = 0.1 * max(float(np.abs(force).max()), load / len(model.out))
        levers = [LEVER if name.startswith("tilt") else 1.0 for name in station.mount.directions]
        sizes += [SWING * max(abs(f), least * arm) for f, arm in zip(force.tolist(), levers, strict=True)]
        middle += force.tolist()
    omega = 2.0 * np.pi * rng.uniform(1.0, 10.0, len(sizes)) / time[-1]
    amounts = np.array([u.amount for u in rotor.unbalances])
    grown = amounts + MORE * np.outer(time / time[-1], np.ones(amounts.size))
    given = np.hstack([np.array(middle) + np.array(sizes) * np.sin(omega * time[:, None]), grown])
    course = SpeedProfile.ramp(*_speeds(model, dt), 2.0 * float(time[-1]))
    at = np.frombuffer(rows).reshape(-1, rotor.size)
    with warnings.catch_warnings():  # about a motion that is none of the user's
        warnings.simplefilter("ignore", OutsideValidityWarning)
        for share in SHARES if model.dampers else ():
            moved = given[0] + share * (given - given[0])
            try:
                return _recorded(model, _Run(model, dt, course, moved, at), moved)
            except ConvergenceError:  # the journal of a damper touches its housing
                continue
        return _recorded(model, _Run(model, dt, course, given, at), given)


def _speeds(model: RotorModel, dt: float) -> tuple[float, float]:
    """Speed at the start, and that to which it would go in twice the time [rev/min]."""
    if model.bearings:
        return float(model.bearings[0].speeds[0]), float(model.bearings[0].speeds[-1])
    first = model.speed if model.speed > 0.0 else 60.0 / (TURN * dt)
    first = min(first, SPEED.limits[1] / (1.0 + RISE))
    return first, (1.0 + RISE) * first


def _recorded(model: RotorModel, run: _Run, given: _Floats) -> RotorTrial:
    integrator = PythonSteps(run, TOLERANCE, 30)
    forces, rolls, resisted = [[one.loads.copy() for one in run.balls]], [_rolls(run)], [0.0]
    for k in range(run.steps):
        middle = float(0.5 * (run.omega[k] + run.omega[k + 1]))
        integrator.advance(middle, k, k + 1, lambda made: None)
        forces.append([one.loads.copy() for one in run.balls])
        rolls.append(_rolls(run))
        resisted.append(_slowed(model, run, given[k + 1], k + 1))
    d, v, _, _, force, _ = run.histories
    stations = (*model.inside, *model.out)
    rows = np.concatenate([station.mount.rows(model.rotor.size) for station in stations])
    shifts = np.concatenate([station.shift for station in stations])
    contacts = len(model.elements)
    angle, rise = run._course.at(run.t)[1:]
    if model.inertia is None:
        drive = np.column_stack([run.omega, rise])
    else:
        drags = np.full((len(run.t), len(model.bearings_out)), DRAG)
        drive = np.column_stack(
            [_torque(model, run, forces, rolls, np.array(resisted)) + drags.sum(axis=1), drags]
        )
    parted = sum(int((one[:, 0] == 0.0).sum()) for row in forces for one in row)
    return RotorTrial(
        time=run.t,
        inputs=np.column_stack([given, drive]),
        displacement=d,
        velocity=v,
        motion=d @ rows.T + shifts,
        rate=v @ rows.T,
        force=force if model.inside else force[:, :0],
        load=np.array([[one.max(axis=0) for one in row] for row in forces]),
        angle=angle,
        speed=run.omega,
        parted=parted + int((force[:, :contacts] == 0.0).sum()),
    )


def _slowed(model: RotorModel, run: _Run, given: _Floats, k: int) -> float:
    """Torque that the unbalances take from the shaft at the end of a step, through their accelerations."""
    angle, acceleration, torque = float(run._course.at(run.t[k : k + 1])[1][0]), run.state[2], 0.0
    amounts = given[given.size - len(model.rotor.unbalances) :]
    for u, amount in zip(model.rotor.unbalances, amounts, strict=True):
        for place, share in ((u.x, -np.sin(angle + u.phase)), (u.y, np.cos(angle + u.phase))):
            torque += 0.0 if place is None else float(amount * share * acceleration[place])
    return torque


def _rolls(run: _Run) -> list[_Floats]:
    """Sums of both surface speeds at all contacts over the speed of the shaft [m], shape (balls, 2) each."""
    return [one.speed_sums.copy() for one in run.balls]


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
