"""Saved states: rollback, serialization into another process, instances side by side, threads."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException

from fmu.driver import Exchange

FILM_KINDS = ["memory", "wide_si"]


def drive(unit, element, T):
    """Forces of a motion through lift-off; times in 2a/u_sum, from the FMU's present one."""
    _, length, time = element._units
    found = []
    for a, b in pairwise(T):
        u, v = 0.3 + 1.5 * np.cos(3.0 * b), -4.5 * np.sin(3.0 * b)
        unit.set(approach=u * length, rate=v * length / time)
        unit.raw.doStep(currentCommunicationPoint=a * time, communicationStepSize=(b - a) * time)
        found.append(unit.get("force", "stiffness", "damping", "step_stiffness", "step_damping", "q[1]"))
    return np.array(found)


@pytest.mark.parametrize("kind", FILM_KINDS)
@pytest.mark.parametrize("lead", [0.0, 0.5, 1.0, 1.5])
def test_rollback_is_bit_identical_while_parted_too(slave, elements, kind, lead):
    unit, element = slave(kind, lead=lead), elements[kind]
    T = np.linspace(0.0, 3.0, 151)
    drive(unit, element, T[:60])
    state = unit.raw.getFMUState()
    before = unit.raw.serializeFMUState(state)
    first = drive(unit, element, T[59:])
    assert (first[:, 0] == 0.0).any() and (first[:, 0] > 0.0).any()
    unit.raw.setFMUState(state)
    again = unit.raw.getFMUState()
    assert unit.raw.serializeFMUState(again) == before
    assert np.array_equal(drive(unit, element, T[59:]), first)
    for one in (state, again):
        unit.raw.freeFMUState(one)


@pytest.mark.parametrize("kind", [pytest.param("memory", marks=pytest.mark.slow), "wide_si"])
def test_state_moves_to_another_process(slave, elements, extracted, kind, tmp_path):
    unit, element = slave(kind), elements[kind]
    T = np.linspace(0.0, 3.0, 151)
    drive(unit, element, T[:60])
    state = unit.raw.getFMUState()
    file = tmp_path / "state.bin"
    file.write_bytes(bytes(unit.raw.serializeFMUState(state)))
    unit.raw.freeFMUState(state)
    code = f"""
import sys
sys.path[:0] = {[str(p) for p in sys.path]!r}
import fmpy
from fmu.driver import Slave
folder = {str(extracted[kind])!r}
unit = Slave(folder, fmpy.read_model_description(folder), [])
unit.start(lead=1.5)
unit.raw.setFMUState(unit.raw.deserializeFMUState(open({str(file)!r}, "rb").read()))
unit.set(approach={0.7 * element._units[1]!r})
unit.raw.doStep(
    currentCommunicationPoint={float(T[59] * element._units[2])!r},
    communicationStepSize={0.01 * element._units[2]!r},
)
print(unit.get("force")[0].hex())
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    unit.set(approach=0.7 * element._units[1])
    unit.raw.doStep(
        currentCommunicationPoint=T[59] * element._units[2], communicationStepSize=0.01 * element._units[2]
    )
    assert float.fromhex(done.stdout.strip()) == unit.get("force")[0]


def test_state_of_another_kind_of_instance_is_refused(slave, extracted):
    unit = slave("wide")
    other = Exchange(extracted["wide"], fmpy.read_model_description(extracted["wide"]), [])
    other.start()
    state = unit.raw.getFMUState()
    for call in (lambda: other.raw.setFMUState(state),
                 lambda: other.raw.deserializeFMUState(unit.raw.serializeFMUState(state))):  # fmt: skip
        with pytest.raises(FMICallException):
            call()
    unit.raw.freeFMUState(state)
    other.free()


@pytest.mark.parametrize("kind", FILM_KINDS)
def test_instances_do_not_know_of_each_other(slave, elements, kind):
    """Side by side, step by step, and in four threads."""
    element, T = elements[kind], np.linspace(0.0, 3.0, 151)
    alone = drive(slave(kind), element, T)
    units = [slave(kind) for _ in range(3)]
    mixed = [[], [], []]
    for a, b in pairwise(T):
        for unit, found in zip(units, mixed, strict=True):
            found.append(drive(unit, element, [a, b])[0])
    assert all(np.array_equal(found, alone) for found in mixed)
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda unit: drive(unit, element, T), [slave(kind) for _ in range(4)]))
    assert all(np.array_equal(one, alone) for one in found)
