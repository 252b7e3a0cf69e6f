"""Film-memory element as an object, beside the contract of all elements: units of its impedance, bad input."""

import json
import math
from dataclasses import replace
from math import pi

import numpy as np
import pytest

from ehlcontact import InputError, load, save
from reduced_models import ScaledContact


def test_active_gains_are_refused(memory):
    with pytest.raises(InputError, match="passive"):
        replace(memory, gains=(0.0,) * 10 + (0.05,))


def test_impedance_and_wrapper_in_si(memory, scales):
    si, wrapped = memory.to_si(scales), ScaledContact(memory.copy(), scales)
    np.testing.assert_allclose(si.impedance(omega=pi / scales.time), memory.impedance(Omega=pi) * scales.stiffness)
    for i in range(1, 40):
        at = 0.05 * scales.time, (0.87 + 0.05 * np.sin(0.05 * pi * i)) * scales.length, 0.1 * scales.rate
        assert si.advance(*at) == pytest.approx(wrapped.advance(*at), rel=1e-12)


@pytest.mark.parametrize(
    ("section", "key", "value", "message"),
    [
        ("parameters", "gains", 1.0, "parameters.gains"),
        ("parameters", "gains", [1.0, "x", 2.0, 3.0], "gains"),
        ("parameters", "film", -1.0, "film"),
        ("parameters", "lag_rate", 0.0, "lag_rate"),
        (None, "scales", [1.0], "scales"),
        (None, "units", "SI", "scales"),
        ("valid", "low", 5.0, "low"),
    ],
)
def test_wrong_files_name_the_entry(memory, tmp_path, section, key, value, message):
    path = save(memory, tmp_path / "wrong.json")
    document = json.loads(path.read_text())
    (document if section is None else document[section])[key] = value
    path.write_text(json.dumps(document))
    with pytest.raises(InputError, match=message) as caught:
        load(path)
    assert "wrong.json" in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"film": 0.0}, "film"),
        ({"exponent": 0.0}, "exponent"),
        ({"inlet_saturation": -0.1}, "inlet_saturation"),
        ({"gains": (0.1, 0.1, 0.1)}, "gains"),
        ({"gains": (0.1, math.nan, 0.1, 0.1)}, "gains"),
    ],
)
def test_bad_coefficients(memory, changes, message):
    with pytest.raises(InputError, match=message):
        replace(memory, **changes)


@pytest.mark.parametrize("dt", [0.0, -1.0, math.nan, math.inf])
def test_bad_steps(memory, dt):
    with pytest.raises(InputError, match="dt"):
        memory.advance(dt, 0.9, 0.0)


def test_not_a_number_leaves_the_state(memory):
    before = memory.save_state()
    with pytest.raises(InputError, match="finite"):
        memory.advance(0.1, math.nan, 0.0)
    np.testing.assert_array_equal(memory.save_state(), before)
