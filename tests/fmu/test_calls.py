"""The FMI calls: state, wrong input, wrong order. A call that fails leaves the instance as it was."""

import fmpy
import pytest
from fmpy.fmi1 import FMICallException

STATUS = {"discard": 2, "error": 3}


@pytest.fixture
def logged(slave):
    """Make a slave and the list of its log messages."""

    def make(name="cubic", **options):
        unit = slave(name, **options)
        return unit, unit.log

    return make


def fails(call, *arguments, **options):
    with pytest.raises(FMICallException) as error:
        call(*arguments, **options)
    return error.value.status


def snapshot(unit):
    return unit.raw.serializeFMUState(unit.raw.getFMUState())


def test_rollback_is_bit_identical(slave):
    unit = slave("cubic")
    unit.set(K1=0.66)
    unit.force(0.9, 0.1)
    state = unit.raw.getFMUState()
    before = snapshot(unit)
    path = [(0.7 + 0.05 * n, (-1.0) ** n) for n in range(20)]
    first = [unit.force(u, v) for u, v in path]
    unit.set(K1=1.0, low=0.5, C1=0.0)
    unit.raw.setFMUState(state)
    assert snapshot(unit) == before
    assert unit.get("K1", "low", "approach") == [0.66, 0.75, 0.9]
    unit.time = 1e-3
    assert [unit.force(u, v) for u, v in path] == first
    unit.raw.freeFMUState(state)


def test_serialized_state_moves_to_another_instance(slave):
    one, two = slave("cubic"), slave("cubic")
    one.set(K3=-0.1)
    force = one.force(1.3, 0.4)
    state = two.raw.deserializeFMUState(snapshot(one))
    two.raw.setFMUState(state)
    two.raw.freeFMUState(state)
    assert two.get("force", "K3", "approach") == [force, -0.1, 1.3]
    assert snapshot(two) == snapshot(one)


def test_foreign_or_damaged_state_is_refused(logged):
    unit, lines = logged()
    other, _ = logged("linear")
    good = snapshot(unit)
    for bad in (snapshot(other), good[:-1], b"", b"\0" * len(good), good[:-16] + b"\xff" * 16):
        assert fails(unit.raw.deserializeFMUState, bad) == STATUS["error"]
    assert all(status == STATUS["error"] for status, _, _ in lines)
    assert snapshot(unit) == good


def test_reset_returns_to_the_start_values(slave):
    unit = slave("cubic")
    unit.set(K1=1.0, approach=2.0)
    unit.step()
    unit.raw.reset()
    unit.raw.setupExperiment(startTime=0.0)
    unit.raw.enterInitializationMode()
    unit.raw.exitInitializationMode()
    assert unit.get("K1", "approach", "rate") == [0.624, 0.875, 0.0]


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
@pytest.mark.parametrize("name", ["approach", "rate", "K1", "K3", "C1", "low", "high"])
def test_step_refuses_what_is_not_finite(logged, name, value):
    unit, lines = logged()
    force = unit.force(0.9, 0.1)
    good = unit.raw.getFMUState()
    unit.set(**{name: value})
    before = snapshot(unit)
    assert fails(unit.step) == STATUS["error"]
    assert snapshot(unit) == before
    ((status, category, message),) = lines
    assert (status, category) == (STATUS["error"], "logStatusError")
    assert "fmi2DoStep" in message
    assert name in message
    unit.raw.setFMUState(good)
    unit.raw.freeFMUState(good)
    assert unit.force(0.9, 0.1) == force


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"C1": -1.0}, "C1"),
        ({"low": 1.0}, "low must be below high"),
        ({"K1": -5.0}, "positive and rising"),
        ({"K3": -10.0}, "positive and rising"),
        (
            {"K1": 0.7556, "K2": -0.875, "K3": 1 / 3},
            "rise everywhere",
        ),  # falls inside, though it rises at both ends
        ({"K1": 1.7e308}, "too steep"),
    ],
)
def test_step_refuses_a_law_that_does_not_exist(logged, change, reason):
    unit, lines = logged()
    unit.set(**change)
    assert fails(unit.step) == STATUS["error"]
    assert reason in lines[-1][2]


def test_a_step_that_is_discarded_leaves_what_was_tuned_before_it(logged):
    unit, _ = logged()
    unit.set(K1=0.7, approach=1e300)
    before = snapshot(unit)
    assert fails(unit.step) == STATUS["discard"]
    assert snapshot(unit) == before
    tuned, _ = logged()
    tuned.set(K1=0.7)
    assert unit.force(0.9, 0.1) == tuned.force(0.9, 0.1)


@pytest.mark.parametrize("approach", [1e7, -1e7])
def test_a_displacement_that_no_machine_has(logged, approach):
    unit, lines = logged()
    unit.raw.setDebugLogging(True, ["logStatusDiscard"])
    unit.set(approach=approach)
    assert fails(unit.step) == STATUS["discard"]
    assert "approach is more than a million times its nominal value" in lines[-1][2]
    unit.set(approach=0.9)
    unit.step()


@pytest.mark.parametrize("h", [1e300, 2e9])
def test_a_step_of_more_than_a_life(logged, h):
    unit, lines = logged()
    assert fails(lambda: unit.raw.doStep(0.0, h)) == STATUS["error"]
    assert "the step size must be at most 1e9" in lines[-1][2]


def test_initialization_refuses_it_too(logged):
    unit, lines = logged(start=False)
    unit.set(C1=-1.0)
    unit.raw.enterInitializationMode()
    assert fails(unit.raw.exitInitializationMode) == STATUS["error"]
    unit.set(C1=0.0)
    unit.raw.exitInitializationMode()
    unit.step()
    assert len(lines) == 1


def test_output_that_does_not_exist_is_discarded(logged):
    unit, lines = logged()
    unit.raw.setDebugLogging(True, ["logStatusDiscard"])
    unit.set(approach=float("nan"))
    assert fails(unit.outside) == STATUS["discard"]
    assert fails(unit.get, "force") == STATUS["discard"]
    unit.set(approach=2.0, K1=float("nan"))
    assert fails(unit.get, "stiffness") == STATUS["discard"]
    assert fails(unit.gradient, "force", "rate") == STATUS["discard"]
    assert {(status, category) for status, category, _ in lines} == {(2, "logStatusDiscard")}
    assert unit.get("approach") == [2.0]  # what was set can still be read


@pytest.mark.parametrize("h", [0.0, -1e-3, float("nan"), float("inf")])
def test_step_size(logged, h):
    unit, lines = logged()
    assert fails(unit.step, h) == STATUS["error"]
    assert "step size" in lines[-1][2]


def test_no_step_beyond_the_stop_time(logged):
    unit, lines = logged(start=False)
    unit.raw.setupExperiment(startTime=0.0, stopTime=1.0)
    unit.raw.enterInitializationMode()
    unit.raw.exitInitializationMode()
    for _ in range(10):
        unit.step(0.1)  # 0.1 ten times is not 1 to the last bit
    assert fails(unit.step, 0.1) == STATUS["error"]
    assert "stop time" in lines[-1][2]
    assert unit.raw.getRealStatus(2) == pytest.approx(1.0)


def test_order_of_calls(logged):
    unit, lines = logged(start=False)
    assert fails(unit.step) == STATUS["error"]
    assert fails(unit.get, "force") == STATUS["error"]
    assert fails(unit.raw.exitInitializationMode) == STATUS["error"]
    assert fails(unit.raw.terminate) == STATUS["error"]
    unit.raw.setupExperiment(startTime=0.0)
    unit.raw.enterInitializationMode()
    assert unit.get("force")[0] > 0.0
    assert fails(unit.step) == STATUS["error"]
    unit.raw.exitInitializationMode()
    assert fails(unit.raw.setupExperiment) == STATUS["error"]
    unit.step()
    unit.raw.terminate()
    assert unit.get("force")[0] > 0.0
    assert fails(unit.set, approach=1.0) == STATUS["error"]
    assert fails(unit.step) == STATUS["error"]
    assert all("call sequence" in message for _, _, message in lines)


def test_variables_that_are_not_there(logged):
    unit, lines = logged()
    before = snapshot(unit)
    assert fails(unit.raw.getReal, [99]) == STATUS["error"]
    assert fails(unit.raw.getReal, [unit.reference["outside_validity"]]) == STATUS["error"]
    assert fails(unit.raw.getBoolean, [unit.reference["force"]]) == STATUS["error"]
    assert fails(unit.raw.setReal, [unit.reference["force"]], [1.0]) == STATUS["error"]
    # The first of the two is settable, yet nothing is set.
    assert fails(unit.raw.setReal, [unit.reference["K1"], 99], [1.0, 1.0]) == STATUS["error"]
    assert fails(unit.raw.getInteger, [0]) == STATUS["error"]
    assert fails(unit.raw.getString, [0]) == STATUS["error"]
    assert fails(unit.gradient, "force", "lead") == STATUS["error"]
    assert fails(unit.gradient, "K1", "approach") == STATUS["error"]
    assert fails(unit.set, lead=1.0) == STATUS["error"]  # is fixed
    assert len(lines) == 10
    assert snapshot(unit) == before


def test_leaving_the_interval_is_logged_once(logged):
    unit, lines = logged()
    unit.raw.setDebugLogging(True, [])
    for u in (0.9, 1.1, 1.2, 0.9, 0.5, 0.4):
        unit.force(u, 0.0)
        assert unit.outside() is (u != 0.9)
    assert [(status, category) for status, category, _ in lines] == [(1, "logStatusWarning")] * 2
    assert "above" in lines[0][2]
    assert "below" in lines[1][2]
    unit.raw.setDebugLogging(False, ["logStatusWarning"])
    unit.force(0.9, 0.0)
    unit.force(1.1, 0.0)
    assert len(lines) == 2
    assert fails(unit.raw.setDebugLogging, True, ["nonsense"]) == STATUS["error"]


def test_wrong_guid_is_refused(extracted, instantiated):
    description = fmpy.read_model_description(extracted["cubic"])
    expected, description.guid = description.guid, "{00000000-0000-0000-0000-000000000000}"
    lines = []
    with pytest.raises(Exception, match="Failed to instantiate"):
        instantiated(extracted["cubic"], description, lambda *arguments: lines.append(arguments[2:]))
    ((status, category, message),) = lines
    assert (status, category) == (STATUS["error"], b"logStatusError")
    assert f"wrong GUID, expected {expected}".encode() in message
