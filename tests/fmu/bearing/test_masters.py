"""A mass FMU that is not ours (pythonfmu) on the FMU of a bearing, under fmpy, libcosim and Ecos.

Needs the extra ``importers``.
"""

from pathlib import Path
from runpy import run_path

import pytest
from mass_on_bearing import decay, in_one_run
from other_masters import archive, built_by_pythonfmu, ecospy, libcosimpy, ours

from ehlcontact import Lubricant
from fmu import export
from fmu.bearing.model import BearingModel
from fmu.system.structure import Component, Connector, Wire
from reduced_models import BallBearing

RPM, LOAD, MASS, UNTIL, KICK = 3000.0, 500.0, 5.0, 0.012, 1e-4  # rev/min, N, kg, s, m/s
MOTION = {"x": "m", "y": "m", "velocity_x": "m/s", "velocity_y": "m/s"}
FORCES = {"force_x": "N", "force_y": "N"}
RING = """
from pythonfmu import Fmi2Causality, Fmi2Slave, Real

class {name}(Fmi2Slave):
    def __init__(self, **more):
        super().__init__(**more)
        self.force_x, self.force_y = 0.0, {load!r}
        self.x, self.y, self.velocity_x, self.velocity_y = {x!r}, {y!r}, 0.0, {v!r}
        for name in ("force_x", "force_y"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        for name in ("x", "y", "velocity_x", "velocity_y"):
            self.register_variable(Real(name, causality=Fmi2Causality.output))

    def do_step(self, t, h):
        for name, force in (("x", self.force_x), ("y", self.force_y - {load!r})):
            q, v, a = getattr(self, name), getattr(self, "velocity_" + name), force / {mass!r}
            setattr(self, name, q + h * (v + 0.5 * h * a))
            setattr(self, "velocity_" + name, v + h * a)
        return True
"""
KICKS = {"Up": KICK, "Down": -KICK}


@pytest.fixture(scope="module")
def model():
    return BearingModel(BallBearing.catalogue("6305", oil=Lubricant.iso_vg(46, temperature=70.0)), RPM, LOAD)


@pytest.fixture(scope="module")
def fmus(model, tmp_path_factory):
    """The bearing, and the mass with either kick: pythonfmu keeps one class of a name in a process."""
    pytest.importorskip("pythonfmu")
    folder = tmp_path_factory.mktemp("masters")
    x, y = model.place.tolist()
    for name, v in KICKS.items():
        built_by_pythonfmu(folder, name, RING.format(name=name, load=LOAD, x=x, y=y, v=v, mass=MASS))
    export(model.bearing, folder / "Bearing.fmu", speeds_rpm=RPM, load=LOAD)
    return folder


def connectors(names, kind):
    return tuple(Connector(name, kind, unit) for name, unit in names.items())


def system(folder, model, name, h):
    """The system archive of both at steps of h."""
    parts = [
        Component(
            "mass", f"resources/{name}.fmu", connectors(FORCES, "input") + connectors(MOTION, "output"),
            starts={"force_x": 0.0, "force_y": LOAD},
        ),
        Component(
            "bearing", "resources/Bearing.fmu", connectors(MOTION, "input") + connectors(FORCES, "output"),
            starts={"y": float(model.place[1]), "velocity_y": KICKS[name]},
        ),
    ]  # fmt: skip
    to_bearing = [Wire(("mass", k), ("bearing", k)) for k in MOTION]
    to_mass = [Wire(("bearing", k), ("mass", k)) for k in FORCES]
    return archive(folder / f"{name} {h:g}.ssp", parts, to_bearing + to_mass, h)


@pytest.fixture(scope="module")
def wanted(model):
    return in_one_run(model, MASS, LOAD, UNTIL, KICK)


@pytest.mark.parametrize("master", [ours, libcosimpy, ecospy])
@pytest.mark.parametrize(("h", "within"), [(1e-5, 0.005), (3e-5, 0.05)])
def test_a_mass_of_others_keeps_the_damping(fmus, model, wanted, master, h, within):
    """650 Hz: w h is 0.04 and 0.12; decay of half the difference of two runs, kicked up and down."""
    count = round(UNTIL / h)
    up, down = (master(system(fmus, model, name, h), h, count, "mass", ["y"])[-count:, 0] for name in KICKS)
    assert decay(up - down, h) == pytest.approx(wanted, rel=within)


@pytest.mark.long
def test_a_rotor_on_two_bearing_fmus(tmp_path, monkeypatch):
    """The table of the documentation: every master and mass, with the lead that fits."""
    studies = Path(__file__).parents[3] / "examples" / "studies"
    monkeypatch.syspath_prepend(str(studies))  # it imports another study
    study = run_path(str(studies / "bearing_masters.py"))
    for damping in study["measure"](study["Loop"](tmp_path), (3e-5,)).values():
        assert damping == pytest.approx(1.0, abs=0.02)
