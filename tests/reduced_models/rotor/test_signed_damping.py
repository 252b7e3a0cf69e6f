"""Modes of rotors on starved bearings with the damping below zero of solved contacts: hand-made eigenproblems."""

import numpy as np
import pytest

from ehlcontact import InputError, Lubricant, OilLayer
from reduced_models import BallBearing, BearingMount, Rotor, Unbalance, campbell, linearise, unbalance_response
from reduced_models.elements.validity import OutsideValidityWarning

OIL = Lubricant.iso_vg(68, temperature=50.0)
RPM, MASS, LOAD = 3000.0, 20.0, (0.0, -1000.0)


def rotor_on(supply, damper=0.0):
    """A mass on one bearing, with a damper to the ground."""
    bearing = BallBearing.catalogue("6205", oil=OIL, clearance=-4e-6, supply=supply)
    return Rotor(
        mass=MASS * np.eye(2),
        stiffness=np.zeros((2, 2)),
        damping=damper * np.eye(2),
        load=np.array(LOAD),
        nodes={"disc": {"x": 0, "y": 1}},
        mounts=(BearingMount(bearing=bearing, x=0, y=1),),
        unbalances=(Unbalance(x=0, y=1, amount=1e-6),),
    )


def fixed_points(rotor):
    """Eigenvalues of K + s C, 2 x 2, with K and the signed C of the bearing at the frequency of each mode."""
    bearing, found = rotor.ball_bearings[0].ball_bearing, []
    for which in range(2):
        s = 2200j
        for _ in range(4):  # K and C change little with the frequency
            small = bearing.coefficients(LOAD, speed_rpm=RPM, omega=s.imag)
            signed = small.damping if small.signed_damping is None else small.signed_damping
            K, C = small.stiffness[0], rotor.damping + signed[0]
            system = np.block([[np.zeros((2, 2)), np.eye(2)], [-K / MASS, -C / MASS]])
            values = np.linalg.eigvals(system)
            s = np.sort_complex(1j * values[values.imag > 0.0].conj())[which]
            s = complex(s.imag, s.real)
        found.append(s)
    return found


@pytest.fixture(scope="module")
def starved():
    return linearise(rotor_on(OilLayer(over_flooded=1.0)), RPM, signed_damping=True)


@pytest.mark.long
def test_modes_are_those_of_a_hand_made_eigenproblem(starved):
    """K there is that of elements, here of solved contacts: within what tables differ, 0.5 %."""
    modes = starved.modes()
    assert len(modes) == 2
    for mode, s in zip(modes, fixed_points(starved.rotor), strict=True):
        assert mode.omega == pytest.approx(s.imag, rel=3e-3)
        assert mode.eigenvalue.real == pytest.approx(s.real, rel=5e-3) and s.real > 0.0
        assert mode.decrement < 0.0


def test_what_is_stable_changes_where_other_damping_exceeds_that_below_zero(starved):
    supply = OilLayer(over_flooded=1.0)
    with pytest.warns(OutsideValidityWarning, match="under this layer"):
        elements = linearise(starved.rotor, RPM)
    assert elements.stable and not starved.stable and starved.growth > 0.0
    assert elements.damping_left_out[0] and starved.damping_left_out == ("",)
    needed = 2.0 * MASS * starved.growth  # N s/m, of a mass on a spring with growth g: 2 m g
    for share in (0.9, 1.1):
        damped = linearise(rotor_on(supply, share * needed), RPM, signed_damping=True)
        assert damped.stable is (share > 1.0)


def test_flooded_bearings_stay_the_same_and_much_oil_is_nearly_flooded():
    flooded = rotor_on(None)
    modes = {signed: linearise(flooded, RPM, signed_damping=signed).modes() for signed in (False, True)}
    assert [one.eigenvalue for one in modes[False]] == [one.eigenvalue for one in modes[True]]
    thick = linearise(rotor_on(OilLayer(over_flooded=1e3)), RPM, signed_damping=True).modes()
    for one, other in zip(thick, modes[False], strict=True):
        assert one.omega == pytest.approx(other.omega, rel=5e-3)
        assert one.decrement == pytest.approx(other.decrement, rel=0.05)


def test_diagrams_and_responses_have_it_too(starved):
    rotor, hz = starved.rotor, RPM / 60.0
    found = campbell(rotor, [RPM], count=2, signed_damping=True)
    np.testing.assert_array_equal(found.growth[0], [mode.eigenvalue.real for mode in starved.modes()])
    response = unbalance_response(rotor, [RPM], signed_damping=True)
    alone = starved.unbalance_response(hz=[hz])
    np.testing.assert_allclose(response.amplitude, alone.amplitude)
    with pytest.raises(InputError, match="have no states"):
        starved.to_control()
    assert "signed damping" in str(starved)
