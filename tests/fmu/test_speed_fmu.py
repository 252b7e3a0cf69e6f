"""FMUs of contacts over the speed of their surfaces, which is an input, beside the elements in Python."""

from pathlib import Path

import fmpy
import numpy as np
import pytest

from ehlcontact import Geometry, InputError, Lubricant, MoesPoint, OperatingPoint
from fmu import export, verify, verify_references
from fmu.contact_spec import contact_spec
from fmu.driver import Slave
from fmu.models import fmu_model
from reduced_models import Atlas, jeffcott_rotor

pytestmark = pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
BALL = OperatingPoint(Geometry(5e-3, 5e-3), Lubricant(eta0=0.04, alpha=2.2e-8), load=20.0, u_sum=1.0)
POINTS = {"ball": (BALL, (0.2, 3.0)), "moes": (MoesPoint(200, 10, 0.5), (0.1, 4.0))}
ELEMENTS = {}


def element_of(name):
    """Made once; a copy at the speed of its reference."""
    if name not in ELEMENTS:
        ELEMENTS[name] = Atlas().element_over_speed(*POINTS[name])
    return ELEMENTS[name].copy()


class ExportedSpeed:
    """An FMU, and instances of it for co-simulation."""

    def __init__(self, path, name, fmi):
        self.path, self.element = path, element_of(name)
        export(self.element, path, fmi=fmi)
        self.folder = fmpy.extract(str(path), unzipdir=str(path.with_suffix("")))
        self.description = fmpy.read_model_description(self.folder)
        self.messages = []

    def started(self, **values):
        slave = Slave(self.folder, self.description, self.messages, loggingOn=True)
        slave.start(**values)
        return slave

    def driven(self, time, approach, rate, u_sum, lead=0.0):
        """Forces at the times of a motion, of which a lead of 1 gets the start of each step."""
        rows = np.column_stack([approach, rate, u_sum]).tolist()
        names = ("approach", "rate", "u_sum")
        slave = self.started(lead=lead, **dict(zip(names, rows[0], strict=True)))
        found = [slave.get("force")[0]]
        for k in range(1, len(rows)):
            slave.set(**dict(zip(names, rows[k if lead < 1.0 else k - 1], strict=True)))
            slave.step(float(time[k] - time[k - 1]))
            found.append(slave.get("force")[0])
        slave.free()
        return np.array(found)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """``made("ball", 2)``: exported once."""
    known = {}

    def make(name, fmi=2):
        if (name, fmi) not in known:
            known[name, fmi] = ExportedSpeed(tmp_path_factory.mktemp("speed") / "x.fmu", name, fmi)
        return known[name, fmi]

    return make


def random_motion(element, steps=300, seed=4):
    """Steps of random lengths, with a lift-off and speeds down to standstill and backwards."""
    rng = np.random.default_rng(seed)
    force, length, unit = element._units
    T = np.concatenate([[0.0], np.cumsum(10.0 ** rng.uniform(-3.0, -0.3, steps))])
    omega = rng.uniform(0.5, 4.0, (3, 1))
    waves = np.sin(omega * T)
    u = element.approach_at(force) / length + 0.3 * waves.sum(axis=0) - 5.0 * np.exp(-(((T - 15.0) / 2.0) ** 2))
    v = 0.3 * (omega * np.cos(omega * T)).sum(axis=0) + 5.0 * (T - 15.0) * np.exp(-(((T - 15.0) / 2.0) ** 2))
    v[0] = 0.0
    speed = element.speeds[-1] * np.sin(0.3 * T + 0.8) * element._reference_speed
    return T * unit, u * length, v * length / unit, speed


@pytest.mark.parametrize("name", POINTS)
def test_variables(name):
    """The speed has the highest of the tables as bound; there are no states, as it is for co-simulation alone."""
    element = element_of(name)
    spec = contact_spec(element)
    speed, most = spec["u_sum"], element.speeds[-1] * element._reference_speed
    assert [v.name for v in spec.inputs] == ["approach", "rate", "u_sum"]
    assert (speed.minimum, speed.maximum) == (-most, most)
    assert speed.start == element._reference_speed == pytest.approx(1.0, rel=1e-12, abs=0.0)
    assert speed.unit == ("m/s" if name == "ball" else "1")
    assert spec.states == () and not spec.exchange and "outside_speed" in {v.name for v in spec.outputs}
    slower = element_of(name)
    slower.set_speed(0.5 * most)
    assert fmu_model(slower).spec["u_sum"].start == speed.start  # of its reference, whatever its present speed


@pytest.mark.long
@pytest.mark.parametrize(("name", "fmi"), [("ball", 2), ("ball", 3), ("moes", 2)])
def test_forces_are_those_of_python(made, name, fmi):
    one = made(name, fmi)
    motion = random_motion(one.element)
    wanted = one.element.drive(*motion)
    assert (wanted == 0.0).any() and (wanted > 0.0).sum() > 100
    assert np.abs(one.driven(*motion) - wanted).max() < 1e-9 * wanted.max()
    assert verify(one.path, one.element).passes
    assert verify_references(one.path).passes
    assert Path(one.path).stat().st_size < 2e5


@pytest.mark.long
def test_a_lead_of_a_step_foresees_the_force(made):
    """Steps that are given their starts: film and speed go on within them."""
    one = made("ball")
    force, length, unit = one.element._units
    gaps = []
    for n in (200, 400):
        T = np.linspace(0.0, 8.0, n + 1)
        u = one.element.approach_at(force) + 0.2 * length * np.sin(2.0 * T)
        speed = 1.0 + 0.5 * np.sin(0.5 * T)
        motion = T * unit, u, 0.4 * length / unit * np.cos(2.0 * T), speed
        wanted = one.element.drive(*motion)
        gaps.append(np.abs(one.driven(*motion, lead=1.0) - wanted)[10:].max() / wanted.max())
    assert gaps[1] < 0.6 * gaps[0] and gaps[1] < 0.01


@pytest.mark.long
def test_above_the_tables_it_warns_once(made):
    """There films are those of the highest speed."""
    one = made("ball", 3)
    one.messages.clear()
    most = 3.0
    forces = []
    for speed in (most, 1.4 * most):
        slave = one.started(u_sum=speed, rate=1e-4, lead=0.0)
        for _ in range(5):
            slave.set(u_sum=speed)
            slave.step(1e-5)
        forces.append(slave.get("force")[0])
        assert slave.flag("outside_speed") == slave.flag("outside_validity") == (speed > most)
        slave.free()
    assert forces[0] == forces[1] > 0.0
    assert sum("u_sum above the speeds of the tables" in message for message in one.messages) == 1


@pytest.mark.long
def test_it_is_for_co_simulation_alone(made):
    one = made("ball")
    assert one.description.modelExchange is None and one.description.coSimulation is not None
    page = (Path(one.folder) / "documentation" / "index.html").read_text(encoding="utf-8")
    assert "for co-simulation;" in page


def test_inside_a_rotor_it_is_refused(tmp_path):
    rotor = jeffcott_rotor(
        bearings=1, disc_mass=2.0, journal_mass=0.3, shaft_stiffness=2e8, load=(0.0, -40.0), speed_rpm=8000.0
    )
    contacts = [element_of("ball") for _ in rotor.contacts]
    with pytest.raises(InputError, match=r"^contacts\[0\] = .*: must be a contact element for one speed"):
        export(rotor.on(contacts), tmp_path / "x.fmu")
