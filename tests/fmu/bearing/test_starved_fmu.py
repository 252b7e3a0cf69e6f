"""FMUs of ball bearings under an oil supply: laws of flooded ones with other tables; damping they leave out."""

import re
from dataclasses import replace

import numpy as np
import pytest
from exported import verified

from ehlcontact import Lubricant, OilLayer
from fmu.bearing.model import BearingModel
from fmu.bearing.trial import START
from fmu.rotor.model import RotorModel
from fmu.rotor.variables import rotor_spec
from reduced_models import BallBearing, Disc, Shaft, Support, rotor_on_bearings
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.elements.validity import OutsideValidityWarning

OIL = Lubricant.iso_vg(68, temperature=50.0)
SUPPLY = OilLayer(over_flooded=1.0)


# of the largest force, and of rates of a kind: at contact angles rounding is over the little that damps a ball
@pytest.mark.parametrize(
    ("name", "forces", "rates"),
    [
        ("starved", 1e-12, 1e-9),
        pytest.param("starved five", 1e-9, 1e-7, marks=pytest.mark.long),
        pytest.param("thin five", 1e-10, 1e-7, marks=pytest.mark.long),  # balls let go
    ],
)
def test_forces_and_rates_are_those_of_python(made, name, forces, rates):
    """In steps and in continuous time, with vibrations and lift-off, at every speed of the tables."""
    one = made(name)
    found = verified(one.path, one.model)
    assert found.passes and 0.0 < found.bearing < forces and found.rates < rates


def test_films_and_torque_are_those_of_the_layer(made):
    """Within what 48 loads of a table leave; the flooded torque is 1.6 times as large."""
    one = made("starved")
    bearing, rpm = one.model.bearing, float(one.model.speeds[-1])
    state = bearing.equilibrium((0.0, -500.0), speed_rpm=rpm, cage_angle=START)
    place = dict(zip(one.model.directions, state.displacement.tolist(), strict=True))
    slave = one.started(**place, speed=rpm * RPM_TO_RAD_S)
    smallest, torque = slave.get("smallest_film", "rolling_torque")
    slave.free()
    assert smallest == pytest.approx(state.h_min[state.force > 1.0].min(), rel=0.005)
    assert torque == pytest.approx(state.rolling_torque, rel=0.005)
    flooded = replace(bearing, supply=None).equilibrium((0.0, -500.0), speed_rpm=rpm, cage_angle=START)
    assert torque < 0.7 * flooded.rolling_torque


def test_damping_below_zero_is_in_the_warning_and_in_the_description(made):
    bearing = BallBearing.catalogue("6205", oil=OIL, supply=SUPPLY)
    with pytest.warns(OutsideValidityWarning, match="6205: under this layer") as caught:
        model = BearingModel(bearing, 3000.0, 1000.0)
    assert len(caught) == 1 and caught[0].filename == __file__
    small = bearing.coefficients((0.0, -1000.0), speed_rpm=3000.0, cage_angle=-np.pi / 2.0, hz=50.0)
    numbers = re.compile(r"-?\d[\d.e+]*")
    assert numbers.findall(model.damping_left_out) == numbers.findall(small.damping_left_out)
    assert model.damping_left_out in str(caught[0].message)
    one = made("starved")
    assert one.description.description.endswith(one.model.damping_left_out) and one.model.damping_left_out
    for thick in (None, OilLayer(over_flooded=30.0)):  # no warning, no words
        assert BearingModel(BallBearing.catalogue("6205", oil=OIL, supply=thick), 3000.0).damping_left_out == ""


def test_a_rotor_with_starved_bearings_has_it_in_its_description():
    starved, flooded = (
        BallBearing.catalogue("6205", oil=OIL, supply=SUPPLY),
        BallBearing.catalogue("6205", oil=OIL),
    )
    rotor = rotor_on_bearings(
        Shaft(length=0.2, diameter=0.025, elements=2),
        discs=[Disc.cylinder(position=0.1, diameter=0.15, width=0.05, bore=0.025)],
        supports=[Support(position=0.0, bearing=flooded), Support(position=0.2, bearing=starved)],
    )
    with pytest.warns(OutsideValidityWarning, match="where a ball carries"):
        spec = rotor_spec(RotorModel(rotor, speeds_rpm=3000.0))
    assert "bearing 0" not in spec.description
    assert re.search(r"; bearing 1: where a ball carries [\d.e+]+ N, under this layer", spec.description)
