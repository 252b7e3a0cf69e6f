"""Elastic contacts over heights along their track, against a slow twin on a finer grid."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
import scipy

from ehlcontact.dry_contact import ElasticContact, elastic_contact
from ehlcontact.hertz import shape_factor
from ehlcontact.solver.deflection.coefficients import influence_coefficients
from reduced_models import BallBearing, Indentation, Spall
from reduced_models.bearing.contact_heights import table_height
from reduced_models.bearing.height_tables import filtered, track_radius

KAPPA = 0.14
DRY = BallBearing.catalogue("6205", clearance=15e-6)


def twin(kappa, height, nx=64, ny=14):
    """Force over that of smooth surfaces, by non-negative least squares on a whole grid without symmetry."""
    S = shape_factor(kappa)
    ends = 1.0 / np.sqrt(S), 1.0 / np.sqrt(1.0 - S)
    hx, hy = 2.0 * ends[0] / nx, 2.0 * ends[1] / ny
    i, j = (one.ravel() for one in np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij"))
    X, Y = hx * (i - 0.5 * (nx - 1)), hy * (j - 0.5 * (ny - 1))
    lags = influence_coefficients(nx, ny, hx, hy, kappa)
    bend = lags[np.abs(j[:, None] - j), np.abs(i[:, None] - i)]
    force = []
    for h in (height(X), np.zeros(X.size)):
        gap = S * X**2 + (1.0 - S) * Y**2 - 1.0 - h
        near = gap < 0.0  # P is 0 elsewhere: what does not overlap is not pressed
        L = scipy.linalg.cholesky(bend[np.ix_(near, near)])
        force.append(scipy.optimize.nnls(L, scipy.linalg.solve_triangular(L.T, -gap[near], lower=True))[0].sum())
    return force[0] / force[1]


def pit(depth, place=0.0, length=2.5, edge=0.6):
    return lambda X: -depth * np.clip((0.5 * length - np.abs(X - place)) / edge, 0.0, 1.0)


@pytest.mark.long
@pytest.mark.parametrize("depth", [0.3, 0.8, 3.0])
def test_force_over_a_pit_is_that_of_the_slow_twin(depth):
    """Forces within 0.02 of the smooth one's, beside, over the edge and in the middle of a pit."""
    contact = ElasticContact(KAPPA)
    middle = 0.5 * (contact.edges[1:] + contact.edges[:-1])
    places = np.array([0.0, 0.8, 1.6, 2.4])
    found = contact.force(np.array([pit(depth, one)(middle) for one in places]))
    expected = [twin(KAPPA, pit(depth, one)) for one in places]
    np.testing.assert_allclose(found, expected, atol=0.02)
    assert found[0] < 0.8 and found[-1] > 0.8


def test_smooth_and_raised_surfaces():
    """Hertz: force as the approach to the power of 1.5; none where a pit has taken the contact."""
    contact = ElasticContact(KAPPA)
    raised = np.array([0.0, -0.1, -0.5, -1.0, -2.0])
    found = contact.force(raised[:, None] * np.ones(contact.edges.size - 1))
    np.testing.assert_allclose(found, np.maximum(1.0 + raised, 0.0) ** 1.5, atol=0.01)
    assert found[-1] == 0.0
    assert contact.first_order.sum() == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize("defect", [
    Spall(race="outer", angle=1.0, length=5e-4, depth=2e-6, edge=1e-4),
    pytest.param(Indentation(race="outer", angle=1.0, length=4e-4, depth=4e-6, rim=5e-7), marks=pytest.mark.long),
])  # fmt: skip
def test_tables_of_defects_are_those_of_elastic_contacts(defect):
    """Within 2 % of the depth of the twin at two loads; the strip of springs differs by up to 14 %."""
    bearing, body = replace(DRY, features=[defect]), DRY.race("outer").geometry
    radius, kn = track_radius(bearing, "outer"), bearing.race("outer").kn
    off, strip_off = [], []
    for load in (150.0, 400.0):
        point_a = np.cbrt(load) * np.sqrt(2.0 * body.radius_x * shape_factor(body.kappa)) * kn ** (-1.0 / 3.0)
        d = (load / kn) ** (2.0 / 3.0)
        raised = d + getattr(defect, "rim", 0.0)
        a = point_a * np.sqrt(raised / d)
        spacing = a / 40.0
        profile = defect.height(spacing * np.arange(-400, 400))
        strip = filtered(profile, spacing, point_a**2 / (2.0 * d), point_a)[:, -1]
        for place in np.linspace(-3.5e-4, 0.0, 4):
            force = twin(body.kappa, lambda X, a=a, x=place, r=raised, d=d: (defect.height(x + a * X) + d - r) / r)
            expected = raised * force ** (2.0 / 3.0) - d
            found = table_height(bearing.tables.heights, 1, defect.angle + place / radius, d)
            off.append(abs(found - expected) / defect.depth)
            strip_off.append(
                abs(np.interp(place, spacing * np.arange(-400, 400), strip) - expected) / defect.depth
            )
    assert max(off) < 0.02 and max(strip_off) > 0.06


def test_far_from_defects_tables_are_those_of_the_strip():
    spall = Spall(race="outer", angle=1.0, length=5e-4, depth=2e-6, edge=1e-4)
    table = replace(DRY, features=[spall]).tables.heights[1, :-1]
    theta = 2.0 * pi * np.arange(len(table)) / len(table)
    away = np.abs(theta - 1.0) * track_radius(DRY, "outer")
    assert np.abs(table[away > 2e-3]).max() < 1e-15 and table[away < 1e-4].max() < -5e-7
    assert table.max() < 1e-15
    assert elastic_contact(0.2) is elastic_contact(0.2)
