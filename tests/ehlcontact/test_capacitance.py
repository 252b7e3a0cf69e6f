"""Capacitance of gaps and films: plate, sphere over a plane, the dry gap after Hertz, solved films."""

from dataclasses import replace
from math import acos, log, pi, sqrt

import numpy as np
import pytest
from numpy.typing import ArrayLike
from scipy.special import elliprd, elliprf

from ehlcontact import Grid, InputError, Lubricant, MoesPoint, OperatingPoint, solve_steady
from ehlcontact.capacitance import EPS0, DryGap, _integrals, hertz_capacitance
from ehlcontact.hertz import hertz_contact
from ehlcontact.results.steady_result import SteadyResult

OIL = Lubricant.iso_vg(68, temperature=50.0)
RADIUS, MODULUS = 9.525e-3, 2.26e11


def dry(load: ArrayLike, radius_x: float = RADIUS, radius_y: float = RADIUS) -> DryGap:
    unit = hertz_contact(1.0, radius_x, radius_y, MODULUS).pressure
    return DryGap.under(load, unit, radius_x, radius_y)


@pytest.fixture(scope="module")
def film() -> SteadyResult:
    point = OperatingPoint.ball_on_flat(OIL, ball_diameter=19.05e-3, load=20.0, entrainment_speed=0.5)
    return solve_steady(point, grid=Grid(64))


class TestGaps:
    def test_sphere_over_a_plane(self) -> None:
        """A paraboloid: 2 pi eps R ln(edge over middle)."""
        found = hertz_capacitance(dry(0.0), 1e-6, 2.2)
        assert found.largest == pytest.approx(
            2.0 * pi * 2.2 * EPS0 * RADIUS * log(1.0 + 0.5 * RADIUS / 1e-6), rel=1e-9
        )

    def test_plate(self) -> None:
        """A thin film under a large contact is a plate."""
        gap = dry(1e4)
        plate = 2.2 * EPS0 * pi * gap.a * gap.b / 1e-12
        assert hertz_capacitance(gap, 1e-12, 2.2).total == pytest.approx(plate, rel=1e-3)

    def test_circular_gap_in_closed_form(self) -> None:
        """Johnson, Contact Mechanics, eq. 3.42a."""
        gap = dry(100.0)
        for s in (1.02, 1.5, 4.0, 30.0):
            exact = gap.approach / pi * (sqrt(s * s - 1.0) + (s * s - 2.0) * acos(1.0 / s))
            found = gap.at(np.array([s * gap.a]), np.array([0.0])), gap.at(np.array([0.0]), np.array([s * gap.a]))
            assert found == (pytest.approx(exact, rel=1e-6), pytest.approx(exact, rel=1e-6))

    @pytest.mark.parametrize("radius_y", [4e-3, 0.1])
    def test_elliptic_gap_opens_at_the_ellipse(self, radius_y: float) -> None:
        gap, phi = dry(50.0, 5e-3, radius_y), np.linspace(0.0, 0.5 * pi, 7)
        assert np.abs(gap.at(gap.a * np.cos(phi), gap.b * np.sin(phi))).max() < 1e-8 * gap.approach
        far = gap.at(np.array([50.0 * gap.a]), np.array([0.0]))
        assert far == pytest.approx(0.5 * (50.0 * gap.a) ** 2 / 5e-3 - gap.approach, rel=1e-2)

    def test_integrals_of_the_deflection(self) -> None:
        x, y, z = np.array([[1.0, 4.0, 2.0], [36.0, 1e-2, 2.0], [0.0, 3.0, 1e4]])
        found = _integrals(x, y, z)
        exact = 2.0 * elliprf(x, y, z), 2.0 / 3.0 * elliprd(y, z, x), 2.0 / 3.0 * elliprd(x, z, y)
        assert np.array(found) == pytest.approx(np.array(exact), rel=2e-9, abs=0.0)

    def test_many_contacts_at_once(self) -> None:
        load, film = np.array([[0.0, 3.0], [50.0, 900.0]]), np.array([[1e-6, 2e-7], [1e-7, 5e-8]])
        found = hertz_capacitance(dry(load, 4e-3, 0.1), film)
        for k in np.ndindex(load.shape):
            own = hertz_capacitance(dry(load[k], 4e-3, 0.1), film[k])
            for part in ("hertz_zone", "track", "surroundings", "least", "largest"):
                assert getattr(found, part)[k] == pytest.approx(float(getattr(own, part)), rel=1e-13, abs=0.0)

    def test_capacitance_against_fine_cells(self) -> None:
        """All gaps full of oil, by the midpoint rule in polar coordinates."""
        gap, film = dry(80.0, 5e-3, 0.05), 1e-7
        phi = (np.arange(200) + 0.5) * 0.5 * pi / 200
        rim = 1.0 / np.hypot(np.cos(phi) / gap.a, np.sin(phi) / gap.b)
        v = (np.arange(1000) + 0.5) / 1000
        r = rim[:, None] + (5e-3 - rim)[:, None] * v**4
        weight = 4.0 * v**3 / 1000 * (5e-3 - rim)[:, None] * r * 0.5 * pi / 200
        height = film + gap.at(r * np.cos(phi)[:, None], r * np.sin(phi)[:, None])
        outside = 4.0 * 2.2 * EPS0 * (weight / height).sum()
        found = hertz_capacitance(gap, film, 2.2)
        assert found.largest - found.hertz_zone == pytest.approx(outside, rel=2e-5)

    @pytest.mark.parametrize("film", [0.0, -1e-7, float("nan")])
    def test_a_film_is_refused(self, film: float) -> None:
        with pytest.raises(InputError, match="film"):
            hertz_capacitance(dry(1.0), film)

    def test_parts_and_bounds(self) -> None:
        found = hertz_capacitance(dry(50.0), 2e-7)
        assert found.least < found.total < found.largest
        air = hertz_capacitance(dry(50.0), 2e-7, surroundings=1.0)
        assert air.surroundings == pytest.approx(found.surroundings / 2.2)


class TestFilms:
    def test_a_flat_film_is_a_plate(self, film: SteadyResult) -> None:
        flat = replace(film, h=np.full_like(film.h, 1e-7), p=np.ones_like(film.p)).capacitance(3.0)
        area = 2.0 * (film.x[-1] - film.x[0]) * film.y[-1]
        assert flat.hertz_zone + flat.inlet + flat.outlet == pytest.approx(3.0 * EPS0 * area / 1e-7, rel=1e-12)

    def test_surroundings_of_undeformed_bodies(self, film: SteadyResult) -> None:
        """The region holds a paraboloid, its rim no deflection: all to the edge is a sphere over a plane."""
        h0 = 2e-7
        x, y = film.x[:, None], film.y
        gap = h0 + 0.5 * (x * x + y * y) / RADIUS
        still = replace(film, h=gap, p=np.ones_like(gap), approach=-h0).capacitance(2.2)
        exact = 2.0 * pi * 2.2 * EPS0 * RADIUS * log(1.0 + 0.5 * RADIUS / h0)
        corner = film.x[-1], film.y[-1]
        assert corner[0] < RADIUS
        fine = _paraboloid(film, h0)
        assert still.surroundings == pytest.approx(exact - fine, rel=1e-3)

    def test_close_to_the_dry_gap_with_a_film(self, film: SteadyResult) -> None:
        body, point = film.point.geometry, film.point
        unit = hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced).pressure
        law = hertz_capacitance(DryGap.under(point.load, unit, body.radius_x, body.radius_y), film.h_central)
        solved = film.capacitance()
        assert law.total == pytest.approx(solved.total, rel=0.1)
        assert solved.least < solved.total < solved.largest
        assert solved.plate < 0.5 * solved.total

    @pytest.mark.long
    def test_second_order(self) -> None:
        point = OperatingPoint.ball_on_flat(OIL, ball_diameter=19.05e-3, load=20.0, entrainment_speed=0.5)
        coarse, middle, fine = (solve_steady(point, grid=Grid(n)).capacitance().largest for n in (64, 128, 256))
        assert abs(coarse - middle) > 3.0 * abs(middle - fine)

    def test_field(self, film: SteadyResult) -> None:
        assert film.capacitance().field_strength(3.0) == pytest.approx(3e-6 / film.h_min)


def _paraboloid(film: SteadyResult, h0: float) -> float:
    """Capacitance of a paraboloid over the region that was solved, permittivity 2.2, by fine cells."""
    x = np.linspace(film.x[0], film.x[-1], 4001)
    y = np.linspace(0.0, film.y[-1], 2001)
    x, y = 0.5 * (x[1:] + x[:-1]), 0.5 * (y[1:] + y[:-1])
    cells = 1.0 / (h0 + 0.5 * (x[:, None] ** 2 + y * y) / RADIUS)
    return float(2.0 * 2.2 * EPS0 * cells.sum() * (x[1] - x[0]) * (y[1] - y[0]))


class TestRefused:
    @pytest.mark.parametrize(
        ("given", "words"),
        [
            ({"permittivity": 0.9}, "between 1 and 100"),
            ({"permittivity": 1.95e-11}, "in F/m"),
            ({"surroundings": 0.0}, "surroundings"),
            ({"reach": 1e-6}, "at least"),
            ({"permittivity": "oil"}, "permittivity"),
        ],
    )
    def test_inputs(self, film: SteadyResult, given: dict[str, object], words: str) -> None:
        with pytest.raises(InputError, match=words):
            film.capacitance(**given)  # type: ignore[arg-type]

    def test_a_dimensionless_film(self, film: SteadyResult) -> None:
        point = MoesPoint(M=100.0, L=5.0, kappa=1.0)
        with pytest.raises(InputError, match="OperatingPoint"):
            solve_steady(point, grid=Grid(32)).capacitance()
