"""One response: what it is to, its units, and where its damping is below zero, in words."""

import re

import numpy as np
import pytest
from balls import OF_6205

from ehlcontact import (
    Grid,
    InputError,
    Lubricant,
    MoesPoint,
    OilLayer,
    OperatingPoint,
    Waves,
    impedance,
    read,
    response,
    save,
)
from ehlcontact.results import Response
from reduced_models import Atlas, BallBearing

POINT = MoesPoint(200, 10, 0.5)
NO_TIME = "{} = 50.0: must be left out: a dimensionless contact has no unit of time"


def known(omega, damping, **others):
    """Response to approach with a stiffness of 100."""
    w, C = np.array(omega), np.array(damping)
    return Response.to_approach(w, 100.0 + 1j * w * C, w, **others)


def test_negative_damping_is_said_with_the_loss_factor_that_outweighs_it():
    """The largest of omega |C|/K where C is below zero: .04 at omega = 2."""
    found = known([1.0, 2.0, 4.0], [-3.0, -2.0, 1.0], units="dimensionless")
    words = "damping is negative from omega 1 to omega 2; a loss factor above 0.04 outweighs it (omega |C|/K)"
    assert (
        found.negative_damping == words and words in repr(found) and found.to_dict()["negative_damping"] == words
    )
    np.testing.assert_allclose(found.loss_factor, [-0.03, -0.04, 0.04])
    assert known([1.0, 2.0], [3.0, 2.0]).negative_damping == ""
    assert "at 0.1592 Hz" in known([1.0, 2.0], [-3.0, 2.0]).negative_damping


def test_in_directions_of_a_ring_that_of_the_worst():
    """Matrices: K_yy 50, C_yy -4 at omega 1, so .08; what couples directions does not count."""
    K, C = np.array([[100.0, 0.0], [0.0, 50.0]]), np.array([[3.0, -9.0], [-9.0, -4.0]])
    found = Response.to_approach(np.ones(1), (K + 1j * C)[None], np.ones(1))
    assert "a loss factor above 0.08 outweighs it" in found.negative_damping
    np.testing.assert_allclose(found.loss_factor, [[0.03, -0.08]])


def test_a_starved_wide_contact_has_negative_damping_at_low_frequency():
    point, grid = MoesPoint(120, 10, 0.12), Grid(n=64)
    found = impedance(point, Omega=[0.02, 1.0], grid=grid, supply=OilLayer(over_flooded=1.0))
    assert found.damping[0] < 0.0 < found.damping[1]
    share = -0.02 * found.damping[0] / found.stiffness[0]
    assert f"negative at omega 0.02; a loss factor above {share:.2g} outweighs it" in repr(found)


@pytest.mark.long
def test_a_starved_bearing_says_it_of_its_solved_contacts():
    bearing = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=60.0))
    load, under = (0.0, -500.0), {"speed_rpm": 3000.0, "hz": [10.0, 50.0]}
    assert bearing.coefficients(load, **under).negative_damping == ""
    found = BallBearing.catalogue("6205", oil=bearing.oil, supply=OilLayer(over_flooded=1.0)).coefficients(
        load, **under
    )
    assert (np.einsum("kii->ki", found.damping) > 0.0).all()
    C, K = (np.einsum("kii->ki", one) for one in (found.signed_damping, found.stiffness))
    largest = (-found.omega[:, None] * C / K).max()
    assert f"from 10 Hz to 50 Hz; a loss factor above {largest:.2g} outweighs it" in repr(found)


def test_a_response_to_the_layer_is_in_the_units_of_the_point():
    """Force in N/m at an `OperatingPoint`; the share passed on is a number, and others have none."""
    point = OperatingPoint.ball_bearing(
        Lubricant.iso_vg(68, temperature=60.0), **OF_6205, speed_rpm=3000.0, load=49.0
    )
    found = response(point, to="layer", hz=[10.0, 1e3], grid=Grid(n=48), supply=OilLayer(over_flooded=1.0))
    own = found.dimensionless
    np.testing.assert_allclose(found.value, own.value * point.scales.stiffness)
    np.testing.assert_array_equal(found.layer_behind, own.layer_behind)
    assert 0.4 < found.passed_share[0] < 0.9 and found.in_phase[0] > 0.0
    assert set(found.error_bars) == {"in_phase", "quadrature", "layer_behind"}
    assert "force over thickness of the layer ahead" in repr(found) and "passed_share" in found.to_dict()
    assert len(found.panels()) == 2
    with pytest.raises(InputError, match=r"^passed_share = 'speed': must be asked of a response to layer"):
        _ = response(POINT, to="speed", Omega=1.0, grid=Grid(n=32)).passed_share


def test_units_are_those_of_the_point(tmp_path):
    point = OperatingPoint.ball_bearing(
        Lubricant.iso_vg(68, temperature=60.0), **OF_6205, load=49.0, speed_rpm=3e3
    )
    si = known([1.0, 2.0], [3.0, 2.0], point=point)
    moes = known([1.0, 2.0], [3.0, 2.0], point=POINT)
    assert (si.units, si.dimensionless.units) == ("SI", "dimensionless")
    assert moes.units == read(save(moes, tmp_path / "moes.h5")).units == "dimensionless"
    assert si.dimensionless.in_units_of(point).units == read(save(si, tmp_path / "si.h5")).units == "SI"
    assert known([1.0], [3.0]).units == "SI" and known([1.0], [3.0], units="dimensionless").units != "SI"


def test_plain_names_are_the_response():
    one, same = (f(POINT, Omega=[0.0, 1.0], grid=Grid(n=32)) for f in (response, impedance))
    np.testing.assert_array_equal(one.value, same.value)
    assert one.to == "approach" and one.value[0].imag == 0.0 and one.damping[0] > 0.0


def test_of_elements_and_the_atlas_alike():
    """The same class, in SI; at rest damping is the limit from above."""
    point = OperatingPoint.ball_bearing(
        Lubricant.iso_vg(68, temperature=60.0), **OF_6205, speed_rpm=3000.0, load=49.0
    )
    atlas, hz = Atlas(), [0.0, 1e-3, 50.0]
    answer, element = atlas.at(point).impedance(hz=hz), atlas.element(point).impedance(hz=hz)
    for one in (answer, element):
        assert type(one) is Response
        np.testing.assert_allclose(one.hz, hz)
        assert one.damping[0] == pytest.approx(one.damping[1], rel=1e-6)
        np.testing.assert_allclose(one.value, one.stiffness + 1j * one.omega * one.damping)
    np.testing.assert_allclose(element.damping, answer.damping, rtol=0.06)
    with pytest.raises(InputError, match=r"^point = None: must be known"):
        _ = element.dimensionless


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"to": "load", "Omega": 1.0}, "to = 'load': must be 'approach', 'speed', 'layer' or Waves"),
        ({"to": "speed", "hz": 50.0}, NO_TIME.format("hz")),
        ({"to": "layer", "hz": 50.0}, NO_TIME.format("hz")),
        ({"to": "layer", "Omega": 1.0}, "supply = None: must be given in a response to the layer ahead"),
        (
            {"to": Waves(), "rpm": 50.0},
            NO_TIME.format("rpm"),
        ),
        ({"hz": 50.0}, NO_TIME.format("hz")),
        ({"to": "speed"}, "frequency = None: must be given once"),
        ({"to": Waves(2.0), "Omega": 1.0}, "wavelength = 2.0: must be left out"),
    ],
)
def test_bad_input_is_one_line(arguments, message):
    with pytest.raises(InputError, match=f"^{re.escape(message)}"):
        response(POINT, **arguments)
