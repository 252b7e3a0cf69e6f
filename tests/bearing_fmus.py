"""Bearings and rotors on them of which the tests of FMUs make some, and instances of these."""

import fmpy
import numpy as np
import pytest

from ehlcontact import Lubricant, OilLayer
from fmu.bearing.model import BearingModel
from fmu.bearing.trial import START
from fmu.bearing.variables import RATES
from fmu.driver import Exchange, Slave
from reduced_models import BallBearing, BearingMount, Rotor, Unbalance

OIL = Lubricant.iso_vg(46, temperature=70.0)
RPM = 3000.0


def bearing(name="6205", **options):
    return BallBearing.catalogue(name, **{"oil": OIL, "rq_ball": 2e-8, "rq_race": 1e-7} | options)


MODELS = {
    "planar": lambda: BearingModel(bearing(clearance=5e-6, loss_factor=0.05, ball_inertia=True), RPM, 500.0),
    "range": lambda: BearingModel(bearing(clearance=5e-6), (2000.0, RPM), 500.0),
    "five": lambda: BearingModel(bearing(clearance="CN", loss_factor=0.05), RPM, (0.0, -500.0, 200.0)),
    "held": lambda: BearingModel(
        bearing(clearance="CN", loss_factor=0.05), RPM, (0.0, -500.0, 200.0), ("x", "y", "z")
    ),
    "heavy five": lambda: BearingModel(bearing("7205", ball_inertia=True), RPM, (0.0, -300.0, 200.0)),
    "five dry": lambda: BearingModel(
        bearing(clearance="CN", oil=None, loss_factor=0.05), RPM, (0.0, -500.0, 200.0)
    ),
    "starved": lambda: BearingModel(
        bearing(clearance=5e-6, supply=OilLayer(over_flooded=1.0)), (2000.0, RPM), 500.0
    ),
    "starved five": lambda: BearingModel(
        bearing("7205", supply=OilLayer(over_flooded=0.8), thermal=True), 6000.0, (0.0, -300.0, 200.0)
    ),
    "thin five": lambda: BearingModel(
        bearing("7205", oil=Lubricant.iso_vg(46, temperature=80.0), supply=OilLayer(3e-7)),
        (3000.0, 10000.0),
        (0.0, -2000.0, 300.0),
    ),
    "lossy": lambda: BearingModel(bearing(clearance=5e-6, loss_factor=0.05), RPM, 500.0),
    "dry": lambda: BearingModel(BallBearing.catalogue("6205", clearance=5e-6), RPM, 500.0),
    "angular": lambda: BearingModel(bearing("7205"), (10000.0, 12000.0), (0.0, -300.0, 200.0)),
    "inner": lambda: BearingModel(bearing("7205", race_control="inner"), 9000.0, (0.0, -100.0, 200.0)),
    "shared": lambda: BearingModel(bearing("7205", race_control="shared"), 12000.0, (0.0, -300.0, 200.0)),
    "turning": lambda: BearingModel(bearing("7205", turning="outer"), 9000.0, (0.0, -300.0, 200.0)),
}


FIVE = {"x": 0, "y": 1, "z": 2, "tilt_x": 3, "tilt_y": 4}
POLAR = 0.012  # moment of inertia of the rotor below


def pressed_pair():
    """Rigid, on two 7205 that press each other, with gyroscopic moments."""
    angular, gyroscopic = BallBearing.catalogue("7205", oil=OIL), np.zeros((5, 5))
    gyroscopic[3, 4], gyroscopic[4, 3] = POLAR, -POLAR
    return Rotor(
        mass=np.diag([3.0, 3.0, 3.0, 0.01, 0.01]),
        stiffness=np.zeros((5, 5)),
        gyroscopic=gyroscopic,
        mounts=(
            BearingMount(bearing=angular, **FIVE, offset=8e-6, arm=-0.05, facing="-z"),
            BearingMount(bearing=angular, **FIVE, offset=8e-6, arm=0.05),
        ),
        load=np.array([0.0, -30.0, 0.0, 0.0, 0.0]),
        unbalances=(Unbalance(x=0, y=1, amount=2e-4, phase=0.4),),
        nodes={"rotor": FIVE},
    )


class Exported:
    """An exported FMU, what it was made of, and instances of it."""

    def __init__(self, path, model=None, fmi=2):
        self.path, self.model, self.fmi = path, model, fmi
        self.folder = fmpy.extract(str(path), unzipdir=str(path.with_suffix("")))
        self.description = fmpy.read_model_description(self.folder)
        self.messages = []

    def started(self, **values):
        """An instance for co-simulation; its messages are added to those of the FMU."""
        slave = Slave(self.folder, self.description, self.messages, loggingOn=True)
        slave.start(**values)
        return slave


def assert_speeds_are_reached(slave, given):
    """A jump within one step, its mean in between, and down to standstill: never beyond."""
    turned = [0.0]
    for speed in given:
        slave.set(speed=speed)
        slave.step(1e-4)
        turned.append(slave.get("angle")[0])
    means = 0.5 * (np.array([given[0], *given[:-1]]) + given)
    assert np.diff(turned) / 1e-4 == pytest.approx(means, rel=1e-9, abs=1e-9)


def assert_states_start_as_declared(one, count):
    """States of model exchange are those of the description, of which `count` are guesses: it computes them."""
    names = [variable.variable.name[4:-1] for variable in one.description.derivatives]
    known = {variable.name: variable for variable in one.description.modelVariables}
    declared = np.array([float(known[name].start) for name in names])
    guessed = [name for name in names if known[name].initial == "approx"]
    assert len(guessed) == count and {known[name].initial for name in names} <= {"approx", "exact"}
    for before in ({}, dict.fromkeys(guessed, 1e-6)):  # importers may set guesses: rest is computed all the same
        model = Exchange(one.folder, one.description, [])
        model.start(**before)
        sizes = np.array([float(known[name].nominal) for name in names])
        assert (np.abs(np.array(model.get(*names)) - declared) <= 1e-9 * sizes).all()
        model.free()


def inputs(model, trial, k):
    """Inputs of the FMU of a bearing at a time of a trial."""
    place = dict(zip(model.directions, trial.place[k].tolist(), strict=True))
    rates = {RATES[name]: rate for name, rate in zip(model.directions, trial.velocity[k].tolist(), strict=True)}
    return place | rates | {"speed": float(trial.speed[k])}


class ExportedBearing(Exported):
    """The FMU of a bearing."""

    def started(self, lead=0.0, **values):
        return super().started(lead=lead, cage_angle_start=START, **values)

    def exchange(self, messages=None, **values):
        """A started instance for model exchange."""
        one = Exchange(self.folder, self.description, [] if messages is None else messages)
        one.start(cage_angle_start=START, **values)
        return one
