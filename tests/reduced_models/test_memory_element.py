"""Film-memory element as an object: units, files, box, bad input."""

import json
import math
from dataclasses import replace
from math import pi

import numpy as np
import pytest

from ehlcontact import InputError
from reduced_models import FilmMemoryContact, OutsideValidityWarning, ScaledContact, load_element


def test_active_gains_are_refused(memory):
    with pytest.raises(InputError, match="passive"):
        replace(memory, gains=(0.0,) * 10 + (0.05,))


def test_si_element_is_the_dimensionless_one_in_other_units(memory, scales):
    si = memory.to_si(scales)
    wrapped = ScaledContact(memory, scales)
    T = np.linspace(0.0, 2.0, 41)
    u, v = 0.87 + 0.05 * np.sin(pi * T), 0.05 * pi * np.cos(pi * T)
    for i in range(1, 40):
        arguments = T[1] * scales.time, u[i] * scales.length, v[i] * scales.rate
        force = si.advance(*arguments)
        assert force == pytest.approx(wrapped.advance(*arguments), rel=1e-12)
    assert si.spring(1e-6) == pytest.approx(memory.spring(1e-6 / scales.length) * scales.force)
    assert si.approach_at(900.0) == pytest.approx(memory.approach_at(0.9) * scales.length)
    Z = memory.impedance(pi) * scales.stiffness
    np.testing.assert_allclose(si.impedance(pi / scales.time), Z)
    assert si.omega_range[1] == pytest.approx(60.0 / scales.time)
    F, stiffness, damping = si.step_tangents(T[1] * scales.time, scales.length, 0.0)
    ours = memory.step_tangents(T[1], 1.0, 0.0)
    expected = [
        value * unit for value, unit in zip(ours, (scales.force, scales.stiffness, scales.damping), strict=True)
    ]
    assert [F, stiffness, damping] == pytest.approx(expected)
    with pytest.raises(InputError, match="units"):
        si.to_si(scales)


def test_file_round_trip(memory, scales, tmp_path):
    for element in (memory, replace(memory, fit={"rms": 0.01}, source={"n": 64}), memory.to_si(scales)):
        back = load_element(element.save(tmp_path / "e.json"))
        assert back == element and type(back) is FilmMemoryContact
        assert back.fit == element.fit and back.source == element.source
        document = json.loads((tmp_path / "e.json").read_text())
        assert (document["schema"], document["kind"]) == ("ehlcontact-element", "memory")
        u = element.approach_at(1.1 if element.scales is None else 1.1 * scales.force)
        assert back.advance(1e-6, u, 0.0) == element.advance(1e-6, u, 0.0)


@pytest.mark.parametrize(
    ("section", "key", "value", "message"),
    [
        ("parameters", "gains", 1.0, "parameters.gains"),
        ("parameters", "gains", [1.0, "x", 2.0, 3.0], "gains"),
        ("parameters", "film", None, "parameters.film"),
        ("parameters", "film", -1.0, "film"),
        ("parameters", "lag_rate", 0.0, "lag_rate"),
        (None, "scales", [1.0], "scales"),
        (None, "units", "SI", "scales"),
        ("valid", "low", 5.0, "low"),
    ],
)
def test_wrong_files_name_the_entry(memory, tmp_path, section, key, value, message):
    path = memory.save(tmp_path / "wrong.json")
    document = json.loads(path.read_text())
    (document if section is None else document[section])[key] = value
    path.write_text(json.dumps(document))
    with pytest.raises(InputError, match=message) as caught:
        load_element(path)
    assert "wrong.json" in str(caught.value) and "\n" not in str(caught.value)


def test_leaving_the_box_is_told_once(memory):
    with pytest.warns(OutsideValidityWarning, match="approach 1.5"):
        memory.advance(0.1, 1.5, 0.0)
    memory.advance(0.1, 1.6, 0.0)  # warnings are errors here: a second one would fail


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"film": 0.0}, "film"),
        ({"exponent": 0.0}, "exponent"),
        ({"squeeze": -0.1}, "squeeze"),
        ({"inlet_rate": math.inf}, "inlet_rate"),
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
