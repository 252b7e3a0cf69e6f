"""Quantities with units of their own where an input is in SI: converted, or refused in one line."""

from dataclasses import dataclass
from math import pi

import numpy as np
import pytest

from ehlcontact import (
    FreeVibration,
    Geometry,
    HarmonicLoad,
    InputError,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    assumptions,
)
from ehlcontact.checks import as_column
from ehlcontact.checks.frequency import dimensionless, radians_per_second
from ehlcontact.checks.quantity import in_unit, takes
from reduced_models import BallBearing, Disc, Shaft, SpeedProfile, SpringContact, jeffcott_rotor

SIZES = {"N": (1.0, "load"), "kN": (1e3, "load"), "s": (1.0, "time"), "m": (1.0, "length"), "mm": (1e-3, "length")}
TURNS = {"hertz": 2.0 * pi, "revolution / minute": pi / 30.0, "radian / second": 1.0, "1 / second": 1.0}


@dataclass(frozen=True)
class Own:
    """The least that is taken for a quantity, without any library."""

    number: float
    units: str

    def to_base_units(self):
        return self

    @property
    def magnitude(self):
        return self.number

    def to(self, unit):
        if self.units in TURNS:  # as in pint, where Hz is 1/s, and so is rad/s
            known = {"Hz": 1.0, "rad/s": 1.0}[unit]
            plain = 1.0 if self.units == "hertz" else TURNS[self.units]
            return Own(self.number * plain / known, unit)
        (size, kind), (asked, wanted) = SIZES[self.units], SIZES[unit]
        if kind != wanted:
            raise TypeError(f"{self.units} is no {unit}")
        return Own(self.number * size / asked, unit)


def test_a_unit_is_converted():
    assert in_unit("load", Own(2.0, "kN"), "N") == 2000.0
    assert in_unit("load", [Own(2.0, "kN"), Own(-3.0, "N")], "N") == [2000.0, -3.0]
    assert in_unit("load", 2.0, "N") == 2.0 and in_unit("load", None, "N") is None


def test_another_kind_is_one_line_that_names_field_and_unit():
    with pytest.raises(InputError, match=r"^load\[1\] = .*3.0.*: must be a number, or a quantity .* into N$"):
        in_unit("load", [Own(2.0, "kN"), Own(3.0, "mm")], "N")


@pytest.mark.parametrize(
    "given", [Own(50.0, "hertz"), Own(3000.0, "revolution / minute"), Own(100.0 * pi, "radian / second")]
)
def test_a_frequency_is_the_same_in_every_unit(given):
    for name, value in (("hz", 50.0), ("rpm", 3000.0), ("omega", 100.0 * pi)):
        assert radians_per_second(None, **{name: given}) == pytest.approx([100.0 * pi], rel=1e-14)
        assert dimensionless(2e-5, **{name: given}) == pytest.approx(
            dimensionless(2e-5, **{name: value}), rel=1e-14
        )


def test_turns_or_radians_are_not_guessed():
    with pytest.raises(InputError, match=r"hz = .*Hz, rad/s or rev/min \(1/s may be turns or radians\)"):
        radians_per_second(None, hz=Own(50.0, "1 / second"))


def test_positions_and_names_are_taken_alike():
    @takes(length="m", load="N")
    def both(length, other, load=1.0, *rest):
        return length, other, load, rest

    assert both(Own(5.0, "mm"), "a", Own(1.0, "kN"), 7) == (0.005, "a", 1000.0, (7,))
    assert both(load=Own(1.0, "kN"), other="a", length=2.0) == (2.0, "a", 1000.0, ())


def test_what_has_no_unit_takes_no_quantity():
    """numpy would take the number and drop the unit."""
    with pytest.raises(InputError, match="Omega = "):
        dimensionless(1.0, Omega=Own(3.0, "N"))
    with pytest.raises(InputError, match="takes no quantity"):
        as_column("T", [Own(1.0, "s"), Own(2.0, "s")])
    with pytest.raises(InputError, match=r"^M = "):
        MoesPoint(Own(200.0, "N"), 10, 0.5)
    element = SpringContact.cubic(1.0, 0.1, 0.1, 0.01, 0.5, 1.0)
    with pytest.raises(InputError, match=r"^load = "):  # of a dimensionless element: over the static load
        element.impedance(Omega=1.0, load=Own(3.0, "N"))


@pytest.fixture(scope="module")
def Q():
    return (
        pytest.importorskip("pint", reason="pint is not installed: pip install 'ehlcontact[tables]'")
        .UnitRegistry()
        .Quantity
    )


def test_what_is_assumed(Q):
    oil = Lubricant.iso_vg(68, temperature=50.0)
    point = OperatingPoint(Geometry(3e-3, 4e-2), oil, load=486.0, u_sum=3.0)
    given = assumptions(
        point, roughness=(Q(0.02, "um"), Q(100, "nm")), vibration=Q(50, "mm/s"), conductivity=Q(0.14, "W/m/K")
    )
    same = assumptions(point, roughness=(2e-8, 1e-7), vibration=0.05, conductivity=0.14)
    for name in ("smooth", "constant speed", "isothermal"):
        assert given[name].value == pytest.approx(same[name].value, rel=1e-12)
    with pytest.raises(InputError, match=r"^roughness\[1\] = 1 newton: must be a number, or a quantity"):
        assumptions(point, roughness=(Q(0.02, "um"), Q(1, "N")))


def test_an_operating_point(Q):
    sizes = {"conformity": 0.52, "race": "inner"}
    oil = Lubricant.iso_vg(68, temperature=Q(333.15, "K"), density_15=Q(0.875, "g/cm^3"))
    plain = Lubricant.iso_vg(68, temperature=60.0)
    assert oil.eta0 == pytest.approx(plain.eta0, rel=1e-12) and oil.alpha == pytest.approx(plain.alpha, rel=1e-12)
    assert Lubricant(Q(37.0, "mPa*s"), Q(20.0, "1/GPa")).eta0 == pytest.approx(0.037, rel=1e-14)
    given = OperatingPoint.ball_bearing(
        plain,
        ball_diameter=Q(7.94, "mm"),
        pitch_diameter=Q(39.04, "mm"),
        speed_rpm=Q(50, "Hz"),
        load=Q(0.486, "kN"),
        **sizes,
    )
    same = OperatingPoint.ball_bearing(
        plain, ball_diameter=7.94e-3, pitch_diameter=39.04e-3, speed_rpm=3000.0, load=486.0, **sizes
    )
    assert given.moes.M == pytest.approx(same.moes.M, rel=1e-12) and given.scales.time == pytest.approx(
        same.scales.time
    )
    assert given.Omega_n(Q(500, "g")) == pytest.approx(same.Omega_n(0.5), rel=1e-12)
    assert HarmonicLoad.at(given, hz=Q(3000, "rpm")).Omega == pytest.approx(HarmonicLoad.at(same, hz=50.0).Omega)
    assert FreeVibration.at(given, mass=Q(1, "lb"), offset=Q(0.1, "um")).offset == pytest.approx(
        FreeVibration.at(same, mass=0.45359237, offset=1e-7).offset, rel=1e-12
    )
    with pytest.raises(InputError, match=r"^load = 0.486 kilonewton \* meter: must be .* into N$"):
        OperatingPoint(given.geometry, plain, load=Q(0.486, "kN*m"), u_sum=3.0)
    with pytest.raises(InputError, match=r"^temperature = 60 meter: .* degrees Celsius$"):
        Lubricant.iso_vg(68, temperature=Q(60, "m"))
    assert Geometry(Q(3, "mm"), Q(4, "cm"), e1=Q(206, "GPa")) == Geometry(3e-3, 4e-2)


def test_a_bearing_and_a_rotor(Q):
    bearing = BallBearing.catalogue("6205", clearance=Q(10, "um"))
    assert bearing.clearance == pytest.approx(1e-5, rel=1e-12, abs=0.0)
    given = bearing.equilibrium([Q(0, "N"), Q(-0.5, "kN")], speed_rpm=Q(100 * pi, "rad/s"))
    same = bearing.equilibrium(Q([0.0, -500.0], "N"), speed_rpm=3000.0)
    assert given.force == pytest.approx(same.force, rel=1e-12, abs=0.0) and given.speed_rpm == pytest.approx(
        3000.0
    )
    assert np.all(Shaft(length=Q([50, 60], "mm"), diameter=Q(20, "mm")).length == [0.05, 0.06])
    assert Disc(position=0.1, mass=Q(500, "g"), unbalance=Q(5, "g*mm")).unbalance == pytest.approx(
        5e-6, rel=1e-12, abs=0.0
    )
    assert SpeedProfile.ramp(0.0, Q(50, "Hz"), Q(100, "ms")).speed_rpm[-1] == pytest.approx(
        3000.0, rel=1e-12, abs=0.0
    )
    rotor = jeffcott_rotor(
        bearings=1, disc_mass=Q(5, "kg"), journal_mass=0.5, shaft_stiffness=Q(5, "kN/mm"), speed_rpm=Q(50, "Hz")
    )
    assert rotor.stiffness[0, 0] == pytest.approx(5e6, rel=1e-12, abs=0.0)
    assert rotor.speed_rpm == pytest.approx(3000.0, rel=1e-12, abs=0.0)
    with pytest.raises(InputError, match=r"^ball_diameter = 8.0 kilogram: .* into m$"):
        BallBearing(balls=9, ball_diameter=Q(8.0, "kg"), pitch_diameter=0.039)
