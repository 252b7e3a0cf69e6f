"""K and C between the frequencies of the atlas."""

import math

import numpy as np
import pytest

from ehlcontact import (
    Geometry,
    Grid,
    InputError,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    impedance,
)
from reduced_models.atlas.film import OMEGAS
from reduced_models.atlas.frequency_curve import FrequencyCurve
from reduced_models.atlas.mesh import impedance_grid

CASE = MoesPoint(200.0, 10.0, 0.5)
POINT = OperatingPoint(Geometry(0.0016, 0.05), Lubricant(0.037, 2e-8), 60.0, 5.0)
NODES = np.array(OMEGAS)


def test_exact_at_the_nodes_and_static_at_0(shipped):
    answer = shipped.at(CASE)
    found = answer.impedance(Omega=OMEGAS)
    np.testing.assert_allclose(found.stiffness, answer.stiffness, rtol=1e-12)
    np.testing.assert_allclose(found.damping, answer.damping, rtol=1e-9)
    for name in ("stiffness", "damping"):
        np.testing.assert_allclose(found.error_bars[name], answer.error_bars[name], rtol=1e-6)
    still = answer.impedance(Omega=0.0)
    assert still.value[0] == pytest.approx(answer.stiffness[0])
    np.testing.assert_array_equal(found.value, found.stiffness + 1j * NODES * found.damping)


@pytest.mark.parametrize(
    "point",
    [
        pytest.param(CASE, marks=pytest.mark.slow),
        pytest.param(MoesPoint(20.0, 5.0, 0.3), marks=pytest.mark.long),
    ],
)
def test_between_the_nodes_it_is_what_is_solved_there(point):
    """The interpolation over frequency alone: nodes and what lies between are solved on one mesh."""
    mesh = impedance_grid(point)
    middle = 0.5 * (NODES[1:] + NODES[:-1])
    solved = impedance(point, Omega=np.concatenate([NODES, middle]), grid=Grid(n=mesh.n, domain=mesh.domain))
    k = NODES.size
    for values, size, limit in (
        (solved.stiffness, solved.stiffness[0], 1e-3),
        (solved.damping, solved.damping[1], 3e-3),
    ):
        off = np.abs(FrequencyCurve(NODES, values[:k]).at(middle) - values[k:]) / size
        line = np.abs(np.interp(middle, NODES, values[:k]) - values[k:]) / size
        assert off.max() < limit and off.max() < 0.7 * line.max() and np.mean(off) < 0.3 * np.mean(line)


def test_bars_are_wider_between_the_nodes(shipped):
    answer = shipped.at(CASE)
    at = 0.5 * (NODES[8:20] + NODES[9:21])
    bars, beside = answer.impedance(Omega=at).error_bars["damping"], answer.error_bars["damping"]
    assert np.all(bars >= np.minimum(beside[8:20], beside[9:21]))
    assert np.all(bars <= np.maximum(beside[8:20], beside[9:21]) + 0.02 * answer.damping[1])


def test_in_si_by_any_name(shipped):
    answer = shipped.at(POINT)
    found, time = answer.impedance(hz=[0.0, 50.0]), POINT.scales.time
    same = answer.impedance(Omega=[0.0, 100.0 * math.pi * time]), answer.impedance(rpm=[0.0, 3000.0])
    for other in same:
        np.testing.assert_allclose(other.damping, found.damping, rtol=1e-12)
    plain = found.dimensionless
    np.testing.assert_allclose(found.hz, [0.0, 50.0], rtol=1e-12)
    np.testing.assert_allclose(found.value, plain.value * POINT.scales.stiffness, rtol=1e-12)
    np.testing.assert_allclose(found.error_bars["damping"], plain.error_bars["damping"] * POINT.scales.damping)
    assert pytest.approx(found.damping[1], rel=1e-12) == shipped.element(POINT, "cubic", hz=50.0).C1


def test_what_is_refused(shipped):
    answer = shipped.at(CASE)
    with pytest.raises(InputError, match=r"^Omega = 61.0: must be finite, >= 0 and <= 60$"):
        answer.impedance(Omega=61.0)
    with pytest.raises(InputError, match=r"^hz = 50.0: must be left out"):
        answer.impedance(hz=50.0)
    with pytest.raises(InputError, match=r"^frequency = "):
        answer.impedance(1.0)
    with pytest.raises(InputError, match=r"^hz = 'asked for': must be omega"):
        _ = answer.impedance(Omega=1.0).hz
