"""`Conditions`: which go together, data of the oil, and keywords."""

from itertools import combinations

import pytest

from ehlcontact import (
    Asperities,
    Geometry,
    InputError,
    Lubricant,
    MoesPoint,
    OilLayer,
    OperatingPoint,
    ShearThinning,
)
from ehlcontact.conditions import APART, Conditions
from ehlcontact.heat import Heat

GIVEN = {
    "supply": OilLayer(H=0.2),
    "heat": Heat(),
    "sliding": ShearThinning(0.1),
    "asperities": Asperities(0.1e-6),
}
OIL = Lubricant.iso_vg(68, temperature=50.0)
POINT = OperatingPoint(Geometry.ball_bearing(7.94e-3, 38.5e-3, 0.52, "inner"), OIL, 60.0, 6.0)


@pytest.mark.parametrize("pair", list(combinations(GIVEN, 2)))
def test_two_go_together_or_are_refused_by_name(pair):
    given = {name: GIVEN[name] for name in pair}
    apart = next((both for both in APART if set(both) == set(pair)), None)
    if apart is None:
        conditions = Conditions(**given)
        assert list(conditions.keywords.values()) == list(given.values())
        assert Conditions.of(**conditions.keywords) == conditions
    else:
        with pytest.raises(InputError, match=f"^{apart[0]} = 'given': must be left out with "):
            Conditions(**given)


def test_heat_takes_the_data_of_the_oil():
    heat = Conditions.of(thermal=True).at(POINT).heat
    assert (heat.temperature, heat.temperature_slope) == (50.0, OIL.temperature_slope)
    assert Conditions.of(thermal=False) == Conditions()


@pytest.mark.parametrize("name", ["heat", "sliding", "asperities"])
def test_conditions_in_si_are_refused_at_a_dimensionless_point(name):
    with pytest.raises(InputError, match="left out at a dimensionless point"):
        Conditions(**{name: GIVEN[name]}).at(MoesPoint(20.0, 10.0, 1.0))


def test_layer_in_metres_is_refused_at_a_dimensionless_point():
    with pytest.raises(InputError, match="over_flooded or H at a dimensionless point"):
        Conditions(OilLayer(0.2e-6)).at(MoesPoint(20.0, 10.0, 1.0))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"supply": 0.3e-6}, r"supply = 3e-07: must be an OilLayer\(h, ...\)"),
        ({"thermal": 1.0}, r"thermal = 1.0: must be True or a Heat"),
        ({"sliding": 0.1}, r"sliding = 0.1: must be a ShearThinning"),
        ({"asperities": 1e-7}, r"asperities = 1e-07: must be Asperities\(rq, ...\)"),
    ],
)
def test_other_objects_are_refused(given, message):
    with pytest.raises(InputError, match=f"^{message}"):
        Conditions.of(**given)
