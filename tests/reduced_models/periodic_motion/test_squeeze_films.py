"""Periodic answers in a squeeze film damper, whose circular orbits, folds and all, are in closed form."""

import numpy as np
import pytest
from scipy.optimize import brentq
from squeeze_films import CLEARANCE, ECCENTRIC, FILM, MASS, SPRING, on_orbit, orbits, ratio, rigid

from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.periodic_motion.floquet import with_multipliers
from reduced_models.periodic_motion.periodic import periodic
from reduced_models.periodic_motion.shooting import shoot

OMEGA = 640.0


def fold(e, omega):
    """Speed at which two circular orbits meet, near these values: the balance of forces and its slope are zero."""

    def off(e, omega):
        along = SPRING + 2.0 * FILM * omega * e / ratio(e) ** 2 - MASS * omega**2
        across = omega * np.pi * FILM / (2.0 * ratio(e) ** 1.5)
        return np.hypot(along, across) * e * CLEARANCE - MASS * ECCENTRIC * omega**2

    def flattest(omega):
        near = brentq(lambda x: off(x + 1e-6, omega) - off(x - 1e-6, omega), e - 0.03, e + 0.03, xtol=1e-14)
        return off(near, omega)

    return brentq(flattest, omega - 0.5, omega + 0.5, xtol=1e-12)


@pytest.mark.long
def test_three_orbits_and_both_folds():
    branch = periodic(
        rigid(), "speed", between=(300.0 / RPM_TO_RAD_S, 720.0 / RPM_TO_RAD_S), harmonics=3, samples=64
    )
    folds = np.array(branch.fold_values) * RPM_TO_RAD_S
    assert folds == pytest.approx([fold(0.735, 672.5), fold(0.64, 607.2)], rel=1e-6)
    found = [np.hypot(*one.run.displacement.T) / CLEARANCE for one in branch.at(OMEGA / RPM_TO_RAD_S)]
    assert [one.max() for one in found] == pytest.approx(orbits(OMEGA)[::-1], rel=1e-6)
    assert all(np.ptp(one) < 1e-10 for one in found)


@pytest.mark.long
def test_the_middle_orbit_is_unstable():
    """By shooting: steps of a 512th of a turn, whose error is of second order."""
    for e, stable in zip(orbits(OMEGA), (True, False, True), strict=True):
        answer = shoot(rigid(), OMEGA / RPM_TO_RAD_S, start=on_orbit(e, OMEGA), steps=512)
        assert np.hypot(*answer.run.displacement[-1]) / CLEARANCE == pytest.approx(e, rel=1e-4)
        largest = np.abs(with_multipliers(rigid(), answer).multipliers).max()
        assert (largest < 1.0) == stable
