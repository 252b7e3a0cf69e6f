"""Matrices of shafts against closed forms, the beams of the tests, and ROSS's."""

import warnings
from math import pi, sqrt

import numpy as np
import pytest
from beam_rotor import shaft as twin
from scipy import linalg

from reduced_models import Disc, Shaft, Support, rotor_on_bearings
from reduced_models.rotor.beam import shear_coefficient

STEEL = {"youngs_modulus": 211e9, "poisson_ratio": 0.5 * 211e9 / 81.2e9 - 1.0, "density": 7810.0}
LENGTH, DIAMETER = 0.8, 0.03


def built(dry, shaft, ends, discs=(), **supports):
    held = [Support(position=at, bearing=dry, **supports) for at in ends]
    return rotor_on_bearings(shaft, discs=discs, supports=held, gravity=(0.0, 0.0))


def whirling(rotor, omega, stiff=1e13):
    """Angular frequencies, forward above 0 and backward below, with the shaft pinned at its bearings."""
    K = rotor.stiffness + stiff * rotor.support_rows.T @ rotor.support_rows
    # along z = x + i y, all that is round: M z'' - i omega g z' + k z of half the matrices
    size = rotor.size
    A = np.zeros((2 * size, 2 * size))
    A[:size, size:] = np.eye(size)
    A[size:] = -np.linalg.solve(rotor.mass, np.hstack([K, omega * rotor.gyroscopic]))
    values, vectors = linalg.eig(A)
    signed = []
    for s, q in zip(values, vectors.T, strict=True):
        if s.imag > 1.0:
            x, y = q[0:size:4], q[1:size:4]
            signed.append(s.imag * np.sign((np.conj(x) * -y).imag.sum()) if omega else s.imag)
    return np.array(sorted(signed, key=abs))


def test_pinned_shaft_in_whirl(dry):
    """Rayleigh's beam that turns: EI k^4 = rho A w^2 + rho I k^2 (w^2 - 2 omega w), k = n pi/L (Genta, 2005)."""
    omega = 4000.0
    shaft = Shaft(length=LENGTH, diameter=DIAMETER, shear=False, elements=24)
    found = whirling(built(dry, shaft, (0.0, LENGTH)), omega)
    EI, rA = shaft.youngs_modulus * pi / 64.0 * DIAMETER**4, shaft.density * pi / 4.0 * DIAMETER**2
    rI = rA * DIAMETER**2 / 16.0
    expected = []
    for n in (1, 2, 3):
        k = n * pi / LENGTH
        a, b, c = rA + rI * k**2, -2.0 * rI * k**2 * omega, -EI * k**4
        expected += [(-b + sign * sqrt(b * b - 4.0 * a * c)) / (2.0 * a) for sign in (-1.0, 1.0)]
    np.testing.assert_allclose(found[:6], sorted(expected, key=abs), rtol=2e-5)


def test_pinned_shaft_that_shears(dry):
    """Timoshenko's beam at rest: E I k^4 - (rho A + rho I k^2 (1 + E/kG)) w^2 + rho^2 I/(kG) w^4 = 0."""
    thick = 0.12
    shaft = Shaft(length=LENGTH, diameter=thick)
    coarse, fine = (
        whirling(built(dry, Shaft(length=LENGTH, diameter=thick, elements=n), (0.0, LENGTH)), 0.0, stiff=1e15)[
            :6:2
        ]
        for n in (24, 48)
    )
    found = fine + (fine - coarse) / 3.0  # pieces that mostly shear are of second order
    E, rho, nu = shaft.youngs_modulus, shaft.density, shaft.poisson_ratio
    area, inertia, kG = (
        pi / 4.0 * thick**2,
        pi / 64.0 * thick**4,
        shear_coefficient(nu, 0.0) * E / (2.0 + 2.0 * nu),
    )
    for n in (1, 2, 3):
        k = n * pi / LENGTH
        b = rho * area + rho * inertia * k**2 * (1.0 + E / kG)
        squared = min(np.roots([rho**2 * inertia / kG, -b, E * inertia * k**4]).real)
        assert found[n - 1] == pytest.approx(sqrt(squared), rel=2e-5)
        assert fine[n - 1] == pytest.approx(sqrt(squared), rel=5e-4)
    assert shear_coefficient(0.3, 0.0) == pytest.approx(6.0 * 1.3**2 / (7.0 + 3.6 + 0.36))
    assert shear_coefficient(0.0, 1.0 - 1e-9) == pytest.approx(0.5)  # of a thin tube


def test_against_the_beams_of_the_tests(dry):
    """The rotor of the issue; disc and both bearings at nodes of six pieces."""
    M, K, G = twin([0.05] * 6, 0.04, [(3, 0.28, 0.07)])
    shaft = Shaft(length=0.3, diameter=0.04, elements=6, **STEEL)
    disc = Disc.cylinder(position=0.15, diameter=0.28, width=0.07, bore=0.04, density=7810.0)
    rotor = built(dry, shaft, (0.05, 0.25), [disc])
    for one, other in ((rotor.mass, M), (rotor.stiffness, K), (rotor.gyroscopic, G)):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-10 * np.abs(other).max())
    assert rotor.nodes == {
        name: {"x": first, "y": first + 1, "tilt_x": first + 2, "tilt_y": first + 3}
        for name, first in (("bearing 0", 4), ("bearing 1", 20), ("disc", 12))
    }


def cowper(nu, bore):
    m2 = bore * bore
    return 6.0 * (1.0 + nu) * (1.0 + m2) ** 2 / ((7.0 + 6.0 * nu) * (1.0 + m2) ** 2 + (20.0 + 12.0 * nu) * m2)


@pytest.mark.parametrize("sections", [1, 3])
def test_against_ross(dry, sections, monkeypatch):
    """A stepped hollow shaft with a disc, with the shear coefficient that ROSS takes: Cowper's (1966)."""
    monkeypatch.setattr("reduced_models.rotor.beam.shear_coefficient", cowper)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        rs = pytest.importorskip("ross", reason="ROSS is not installed: pip install 'ehlcontact[ross]'")
    lengths, outer, bore = np.array([0.1, 0.15, 0.05]), np.array([0.04, 0.05, 0.03]), np.array([0.0, 0.01, 0.0])
    if sections == 1:
        outer[:], bore[:] = 0.04, 0.0
    steel = rs.Material("own", rho=7810, E=211e9, G_s=81.2e9)
    theirs = rs.Rotor(
        [rs.ShaftElement(L, i, o, material=steel) for L, i, o in zip(lengths, bore, outer, strict=True)],
        [rs.DiskElement.from_geometry(1, steel, width=0.07, i_d=0.04, o_d=0.28)],
        [rs.BearingElement(n, 1e7, 0.0) for n in (0, 3)],
    )
    lateral = [6 * node + k for node in range(4) for k in (0, 1, 3, 4)]
    shaft = Shaft(length=lengths, diameter=outer, bore=bore, elements=1, **STEEL)
    disc = Disc.cylinder(position=0.1, diameter=0.28, width=0.07, bore=0.04, density=7810.0)
    rotor = built(dry, shaft, (0.0, 0.3), [disc])
    bearings = 1e7 * rotor.support_rows.T @ rotor.support_rows
    for ours, whole in (
        (rotor.mass, theirs.M(0.0)),
        (rotor.stiffness + bearings, theirs.K(0.0)),
        (rotor.gyroscopic, theirs.G()),
    ):
        expected = whole[np.ix_(lateral, lateral)]
        np.testing.assert_allclose(ours, expected, rtol=0.0, atol=1e-6 * np.abs(expected).max())
