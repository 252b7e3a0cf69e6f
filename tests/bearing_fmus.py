"""Bearings of which the tests of FMUs make some, and instances of these."""

import fmpy

from ehlcontact import Lubricant, OilLayer
from fmu import BearingModel
from fmu.bearing.trial import START
from fmu.driver import Exchange, Slave
from reduced_models import BallBearing

OIL = Lubricant.iso_vg(46, temperature=70.0)
RPM = 3000.0


def bearing(name="6205", **options):
    return BallBearing.catalogue(name, **{"oil": OIL, "rq_ball": 2e-8, "rq_race": 1e-7} | options)


MODELS = {
    "planar": lambda: BearingModel(bearing(clearance=5e-6, loss_factor=0.05, ball_inertia=True), RPM, 500.0),
    "range": lambda: BearingModel(bearing(clearance=5e-6), (2000.0, RPM), 500.0),
    "five": lambda: BearingModel(bearing(clearance="CN", loss_factor=0.05), RPM, (0.0, -500.0, 200.0)),
    "five dry": lambda: BearingModel(
        bearing(clearance="CN", oil=None, loss_factor=0.05), RPM, (0.0, -500.0, 200.0)
    ),
    "starved": lambda: BearingModel(
        bearing(clearance=5e-6, supply=OilLayer(over_flooded=1.0)), (2000.0, RPM), 500.0
    ),
    "starved five": lambda: BearingModel(
        bearing("7205", supply=OilLayer(over_flooded=0.8), thermal=True), 6000.0, (0.0, -300.0, 200.0)
    ),
    "lossy": lambda: BearingModel(bearing(clearance=5e-6, loss_factor=0.05), RPM, 500.0),
    "dry": lambda: BearingModel(BallBearing.catalogue("6205", clearance=5e-6), RPM, 500.0),
    "angular": lambda: BearingModel(bearing("7205"), (10000.0, 12000.0), (0.0, -300.0, 200.0)),
    "inner": lambda: BearingModel(bearing("7205", race_control="inner"), 9000.0, (0.0, -100.0, 200.0)),
    "shared": lambda: BearingModel(bearing("7205", race_control="shared"), 12000.0, (0.0, -300.0, 200.0)),
}


class Made:
    """An exported bearing, and instances of it."""

    def __init__(self, model, path, fmi):
        self.model, self.path = model, path
        self.folder = fmpy.extract(str(path), unzipdir=str(path.with_suffix("")))
        self.description = fmpy.read_model_description(self.folder)
        self.fmi = fmi

    def started(self, lead=0.0, **values):
        slave = Slave(self.folder, self.description, [])
        slave.start(lead=lead, cage_angle_start=START, **values)
        return slave

    def exchange(self, messages=None, **values):
        """A started instance for model exchange."""
        one = Exchange(self.folder, self.description, [] if messages is None else messages)
        one.start(cage_angle_start=START, **values)
        return one
