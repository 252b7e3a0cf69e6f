"""What the FMU of a rotor refuses, and its saved states."""

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException

pytestmark = pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
ERROR, DISCARD = 3, 2


def started(instance, name="mixed", **settings):
    slave = instance(name)
    slave.start(force_lead=0.0, **settings)
    return slave


def status_of(call, *arguments, **named):
    with pytest.raises(FMICallException) as caught:
        call(*arguments, **named)
    return caught.value.status


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("unbalance[1]", np.nan),
        ("speed", np.inf),
        *(("inner_step", value) for value in (0.0, 1e-15, np.nan)),
        ("journal.x", np.nan),
        ("disc.velocity_y", np.inf),
        ("disc_mass", 0.0),
        ("journal_mass", -1.0),
        ("shaft_stiffness", np.nan),
        ("shaft_damping", -1.0),
        ("disc_damping", np.inf),
    ],
)
def test_impossible_settings_are_refused_at_the_start(instance, name, value):
    slave = instance("mixed")
    assert status_of(slave.start, force_lead=0.0, **{name: value}) == ERROR


def test_a_refused_step_changes_nothing(instance):
    slave = started(instance)
    slave.step(1e-5)
    before = slave.get("journal.x", "journal.y", "contact[1].force", "angle")
    for name, value, expected in (
        ("speed", np.inf, ERROR),
        ("disc.force_x", np.nan, ERROR),
        ("disc.force_x", 1e305, DISCARD),
    ):
        kept = slave.get(name)[0]
        slave.set(**{name: value})
        assert status_of(slave.step, 1e-5) == expected
        slave.set(**{name: kept})
        assert slave.get("journal.x", "journal.y", "contact[1].force", "angle") == before
    slave.step(1e-5)
    for h, expected in ((0.0, ERROR), (-1e-5, ERROR), (1e6, DISCARD)):  # a million inner steps, and not one more
        assert status_of(slave.step, h) == expected


def test_states_and_fixed_parameters_are_not_set_on_the_way(instance):
    slave = started(instance)
    slave.step(1e-5)
    for name in ("journal.x", "inner_step", "disc_mass", "contact[1].force"):
        assert status_of(slave.set, **{name: 1e-5}) == ERROR


def run(slave, steps, h=1e-5, names=("disc.x", "journal.y", "contact[1].force", "contact[1].q[3]", "angle")):
    found = []
    for k in range(steps):
        slave.set(**{"disc.force_y": 100.0 * np.sin(0.1 * k)})
        slave.step(h * (1.0 + 0.5 * (k % 2)))
        found.append(slave.get(*names))
    return np.array(found)


def test_rollback_is_bit_identical_and_serialization_too(instance):
    slave = started(instance)
    run(slave, 40)
    state, time = slave.raw.getFMUState(), slave.time
    first = run(slave, 60)
    slave.raw.setFMUState(state)
    slave.time = time
    assert np.array_equal(run(slave, 60), first)
    other = started(instance)
    other.raw.setFMUState(other.raw.deserializeFMUState(bytes(slave.raw.serializeFMUState(state))))
    other.time = time
    assert np.array_equal(run(other, 60), first)
    slave.raw.freeFMUState(state)


def test_reading_changes_nothing(instance):
    """Outputs after a set follow the states; the motion is the same as if nobody had looked."""
    one, other = started(instance), started(instance)
    found = []
    for slave in (one, other):
        for k in range(100):
            slave.set(**{"journal.force_x": 50.0 * np.sin(0.2 * k)})
            if slave is one:
                slave.get("contact[1].force", "contact[2].approach")
            slave.step(1e-5)
        found.append(slave.get("journal.x", "journal.y", "disc.x", "angle"))
    assert found[0] == found[1]


def test_instances_do_not_know_of_each_other(instance):
    alone = run(started(instance), 50)
    pair = [started(instance) for _ in range(2)]
    mixed = [[], []]
    for k in range(50):
        for slave, found in zip(pair, mixed, strict=True):
            slave.set(**{"disc.force_y": 100.0 * np.sin(0.1 * k)})
            slave.step(1e-5 * (1.0 + 0.5 * (k % 2)))
            found.append(slave.get("disc.x", "journal.y", "contact[1].force", "contact[1].q[3]", "angle"))
    assert all(np.array_equal(found, alone) for found in mixed)


@pytest.mark.parametrize("push", [-1500.0, 1500.0])
def test_one_contact_outside_is_enough(instance, push):
    """Whichever it is; the flags of the contacts say so too."""
    slave = started(instance, "cubic")
    slave.set(**{"journal.force_x": push})
    seen = set()
    for _ in range(60):
        slave.step(2e-6)
        flags = tuple(slave.flag(f"contact[{i}].outside_validity") for i in (1, 2))
        assert slave.flag("outside_validity") == any(flags)
        seen.add(flags)
    assert ((True, False) if push > 0.0 else (False, True)) in seen, seen


def test_the_log_names_the_contact_that_left_its_box(unit):
    """Once, until it is another one."""
    from fmu.driver import Slave

    messages = []
    one = unit("cubic")
    slave = Slave(one.folder, one.description, messages)
    slave.raw.fmi2SetDebugLogging(slave.raw.component, True, 0, None)
    slave.start(force_lead=0.0)
    slave.set(**{"journal.force_x": 3e3})
    for _ in range(40):
        slave.step(1e-5)
    told = [message for message in messages if "validity box" in message]
    slave.free()
    assert told and "contact[" in told[0] and len(told) < 10


def test_event_mode_tells_of_a_lost_contact(instance, unit):
    """FMI 3.0, with early return: the step ends where the contact is lost."""
    from fmu.driver import Slave

    one = unit("cubic", 3)
    slave = Slave(one.folder, one.description, [], eventModeUsed=True, earlyReturnAllowed=True)
    slave.set(**{"journal.force_y": 6e3})
    slave.raw.enterInitializationMode()
    slave.raw.exitInitializationMode()
    slave.time = 0.0
    slave.raw.updateDiscreteStates()
    slave.raw.enterStepMode()
    for _ in range(100):
        event, _, early, last = slave.step(1e-5)
        if event:
            break
    forces = slave.get("contact[1].force", "contact[2].force")
    slave.free()
    assert event and early and last == slave.time and 0.0 < min(1.0, last)
    assert min(forces) == 0.0
