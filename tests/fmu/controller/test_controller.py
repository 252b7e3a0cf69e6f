"""A speed controller in Python and as an FMU: its law, its limit, what it refuses."""

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException

from ehlcontact import InputError
from fmu import SpeedController, export_controller, verify, verify_references
from fmu.driver import Slave

LIMIT, KP, KI = 10.0, 0.5, 20.0
CONTROLLER = SpeedController(speed_rpm=3000.0, proportional_gain=KP, integral_gain=KI, torque_limit=LIMIT)


@pytest.fixture(scope="module")
def paths(tmp_path_factory):
    folder = tmp_path_factory.mktemp("controller")
    return {fmi: export_controller(CONTROLLER, folder / f"x{fmi}.fmu", fmi=fmi) for fmi in (2, 3)}


@pytest.fixture
def messages():
    return []


@pytest.fixture
def slave(paths, tmp_path, messages):
    folder = fmpy.extract(str(paths[2]), unzipdir=str(tmp_path))
    made = Slave(folder, fmpy.read_model_description(str(paths[2])), messages, loggingOn=True)
    yield made
    made.free()


def test_torque_is_that_of_the_law():
    """Within its limit: proportional part and integral of a cosine, solved by hand."""
    t = np.linspace(0.0, 0.5, 4001)
    speed = 314.159265358979 - 2.0 * np.cos(30.0 * t)
    wanted = KP * 2.0 * np.cos(30.0 * t) + KI * 2.0 * np.sin(30.0 * t) / 30.0 + 1.5
    assert CONTROLLER.torque(t, speed, start=1.5) == pytest.approx(wanted, abs=1e-5)


def test_the_integral_does_not_wind_up():
    """Long at its limit: the torque leaves it as soon as the difference falls, and never passes it."""
    t = np.linspace(0.0, 2.0, 2001)
    e = np.where(t < 1.0, 30.0, 30.0 - 100.0 * (t - 1.0))  # 15 N m of the proportional part alone
    torque = CONTROLLER.torque(t, 300.0 - e, np.full(t.size, 300.0))
    assert (torque[t < 1.1] == LIMIT).all() and np.abs(torque).max() == LIMIT
    # z is 0 all the time, for K e alone is at the limit until e = 20, from where z rises
    leaves = t[np.flatnonzero(torque < LIMIT)[0]]
    assert 1.1 < leaves < 1.3 and torque[-1] < -LIMIT + 1e-9


def test_it_verifies(paths):
    for path in paths.values():
        found = verify(path, CONTROLLER)
        assert found.passes and found.motion < 1e-13
        assert verify_references(path).passes


def test_inputs_are_held_and_the_limit_is_tunable(slave):
    slave.start(speed=300.0, speed_set_point=304.0, integral_start=1.0)
    assert slave.get("torque") == [KP * 4.0 + 1.0]
    slave.step(0.01)
    assert slave.get("torque")[0] == pytest.approx(KP * 4.0 + 1.0 + KI * 4.0 * 0.01, rel=1e-14)
    slave.set(torque_limit=2.5, speed=299.0)
    slave.step(0.01)
    assert slave.get("torque") == [2.5]


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"proportional_gain": -1.0}, "gain must be finite and >= 0"),
        ({"torque_limit": 0.0}, "torque_limit must be finite and > 0"),
        ({"speed": np.nan}, "speed must be finite"),
    ],
)
def test_bad_values(slave, messages, wrong, words):
    with pytest.raises(FMICallException):
        slave.start(**wrong)
    assert words in messages[-1]


def test_bad_controllers(tmp_path):
    good = {"speed_rpm": 1e3, "proportional_gain": 1.0, "integral_gain": 1.0, "torque_limit": 1.0}
    for wrong in (
        {"torque_limit": 0.0},
        {"proportional_gain": -1.0},
        {"integral_gain": np.inf},
        {"speed_rpm": np.nan},
    ):
        with pytest.raises(InputError) as error:
            SpeedController(**good | wrong)
        assert error.value.field in wrong
    with pytest.raises(InputError, match="integral_gain > 0"):
        SpeedController(**good | {"proportional_gain": 0.0, "integral_gain": 0.0})
    with pytest.raises(InputError, match="a SpeedController"):
        export_controller(3.0, tmp_path / "x.fmu")
