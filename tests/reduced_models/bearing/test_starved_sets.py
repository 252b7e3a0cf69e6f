"""Sets of ball bearings with a layer of oil and with heat: against the single bearings that they are made of."""

from dataclasses import replace

import numpy as np
import pytest

from ehlcontact import Heat, InputError, Lubricant, OilLayer
from reduced_models import BallBearing, BearingSet, Shaft, Support, linearise, rotor_on_bearings
from reduced_models.bearing.oil_and_heat import FLOODED, LAYER, oil_and_heat
from reduced_models.bearing.race import RACES
from reduced_models.elements.validity import OutsideValidityWarning

OIL = Lubricant.iso_vg(46, temperature=60.0)
SINGLE = BallBearing.catalogue("7205", oil=OIL)
SUPPLY = OilLayer(over_flooded=1.0)
STARVED = replace(SINGLE, supply=SUPPLY)
RPM, HZ = 6000.0, [100.0, 1000.0]


def in_series(bearing, load):
    """C [N s/m] of both contacts of the first ball in series, as the atlas has them."""
    state, w = bearing.equilibrium(load, speed_rpm=RPM, cage_angle=0.0), 2.0 * np.pi * np.array(HZ)
    answers = [bearing.race(name).answer(float(state.force[0, k]), RPM) for k, name in enumerate(RACES)]
    springs = [at.impedance(omega=w) for at in answers]
    return (1.0 / sum(1.0 / (at.stiffness + 1j * w * at.damping) for at in springs)).imag / w


def test_signed_damping_at_contact_angles():
    """Flooded K and C where the layer is thick; below zero where it is not, as C of both contacts in series."""
    load, under = (0.0, 0.0, 300.0), {"speed_rpm": RPM, "hz": HZ, "cage_angle": 0.0}
    flooded = SINGLE.coefficients(load, **under)
    thick = replace(SINGLE, supply=OilLayer(over_flooded=1e3)).coefficients(load, **under)
    found = STARVED.coefficients(load, **under)
    assert flooded.signed_damping is None
    np.testing.assert_allclose(
        np.einsum("kii->ki", thick.signed_damping), np.einsum("kii->ki", flooded.damping), rtol=0.02
    )
    assert found.signed_damping.shape == found.damping.shape and found.signed_damping[0, 2, 2] < 0.0
    assert "C_zz" in str(found) and found.damping[0, 2, 2] > 0.0
    # what the ring finds of the damping of a ball depends on geometry alone: the same share, flooded and starved
    share = flooded.damping[:, 2, 2] / in_series(SINGLE, load)
    np.testing.assert_allclose(found.signed_damping[:, 2, 2], share * in_series(STARVED, load), rtol=0.02)
    with pytest.raises(InputError, match="omega"):
        STARVED.coefficients(load, speed_rpm=RPM, omega=1e9)


@pytest.mark.long
@pytest.mark.parametrize("given", [{"supply": SUPPLY}, {"thermal": True}])
def test_a_pair_is_both_of_its_bearings(given):
    """Tandem: twice a single one under half the load. Back to back: the sum of both under their axial forces."""
    single = replace(SINGLE, **given)
    under = {"speed_rpm": RPM, "hz": HZ, "cage_angle": 0.0}
    alone, tandem = (
        one.coefficients((0.0, 0.0, force), **under)
        for one, force in ((single, 300.0), (BearingSet.tandem(single), 600.0))
    )
    for name in ("stiffness", "damping", "signed_damping"):
        one, two = (getattr(at, name) for at in (alone, tandem))
        if one is not None:
            np.testing.assert_allclose(two[:, 2, 2], 2.0 * one[:, 2, 2], rtol=1e-6)
    pair = BearingSet.pair(single, preload=150.0)
    state = pair.equilibrium((0.0, 0.0, 100.0), speed_rpm=RPM, cage_angle=0.0)
    small = pair.coefficients((0.0, 0.0, 100.0), **under)
    both = [single.coefficients((0.0, 0.0, force), **under) for force in state.axial_forces.tolist()]
    films = [
        single.equilibrium((0.0, 0.0, force), speed_rpm=RPM, cage_angle=0.0)
        for force in state.axial_forces.tolist()
    ]
    for one, own in zip(state.bearings, films, strict=True):
        np.testing.assert_allclose(one.h_central, own.h_central, rtol=1e-6)
    for name in ("stiffness", "damping", "signed_damping"):
        whole, parts = getattr(small, name), [getattr(one, name) for one in both]
        if whole is not None:
            np.testing.assert_allclose(whole[:, 2, 2], sum(parts)[:, 2, 2], rtol=1e-6)
    if "supply" in given:
        for k, one in enumerate(both):
            assert f"bearing {k}: {one.damping_left_out}" in small.damping_left_out


@pytest.mark.long
def test_conditions_of_a_pair_are_twice_those_of_a_bearing_with_half_the_load():
    given = {"speed_rpm": RPM, "supply": SUPPLY}
    one = oil_and_heat(SINGLE, (0.0, 0.0, 300.0), **given)
    two = oil_and_heat(BearingSet.tandem(SINGLE), (0.0, 0.0, 600.0), **given)
    assert not two.solved and list(two.conditions) == [FLOODED, LAYER] and two.bearing == 0
    for (words, unit, values), (_, _, doubled) in zip(one.rows, two.rows, strict=True):
        factor = 1.0 if unit == "µm" else 2.0
        for key, value in values.items():
            assert doubled[key] == pytest.approx(factor * value, rel=1e-6), words
    assert two.conditions[LAYER].damping[0, 2] < 0.0
    assert any("bearing 0, facing +z" in line for line in two.notes) and two.to_dict()["bearing"] == 0
    with pytest.raises(InputError, match=r"bearing\.supply"):
        oil_and_heat(BearingSet.tandem(STARVED), (0.0, 0.0, 600.0), speed_rpm=RPM, supply=SUPPLY)
    with pytest.raises(InputError, match="dry one"):
        dry = BearingSet.tandem(replace(SINGLE, oil=None))
        oil_and_heat(dry, (0.0, 0.0, 600.0), speed_rpm=RPM, thermal=Heat())


def test_a_shaft_on_a_pair_finds_its_damping():
    """What a small vibration of the shaft finds is the set under its load; less damping than flooded."""
    decrements = []
    for single in (SINGLE, STARVED):
        pair = BearingSet.pair(single, distance=40e-3, preload=150.0)
        shaft = Shaft(length=0.2, diameter=0.03, elements=2)
        rotor = rotor_on_bearings(shaft, supports=[Support(position=0.1, bearing=pair)])
        if single is STARVED:
            with pytest.warns(OutsideValidityWarning, match="bearing 0 of support 0: under this layer"):
                linear = linearise(rotor, RPM, passage=False)
        else:
            linear = linearise(rotor, RPM, passage=False)
        decrements.append(linear.modes(1)[0].decrement)
    assert 0.0 < decrements[1] < 0.7 * decrements[0]
