"""Clearance in operation: thick rings against a solve of their boundary conditions, limits of classes."""

import warnings
from math import cos, radians

import numpy as np
import pytest

from ehlcontact import InputError
from reduced_models import BallBearing, BearingSet, OutsideValidityWarning, operating_clearance
from reduced_models.bearing.seats import MATERIALS, groove_bottoms, spinning
from reduced_models.bearing.tolerances import bore_limits, housing_limits, outside_limits, outside_of, shaft_limits

STEEL, ALUMINIUM = MATERIALS["steel"], MATERIALS["aluminium"]


def pressed(rings, overlap, where, asked):
    """Growth [m] in radius at `asked` of two rings (E, nu, inner and outer radius), the outer `overlap` too small.

    u = A r + B/r in each; without stress at free surfaces, one radial stress at the seat.
    """
    matrix, right = np.zeros((4, 4)), np.zeros(4)

    def stress(E, nu, r):
        return E / (1.0 - nu**2) * np.array([1.0 + nu, -(1.0 - nu) / r**2])

    (E0, nu0, a, _), (E1, nu1, _, b) = rings
    matrix[0, :2] = [0.0, 1.0] if a == 0.0 else stress(E0, nu0, a)
    matrix[1, 2:] = stress(E1, nu1, b)
    matrix[2, :2], matrix[2, 2:] = stress(E0, nu0, where), -stress(E1, nu1, where)
    matrix[3, :2], matrix[3, 2:] = [-where, -1.0 / where], [where, 1.0 / where]
    right[3] = overlap
    scale = np.abs(matrix).max(axis=1)
    A0, B0, A1, B1 = np.linalg.solve(matrix / scale[:, None], right / scale)
    return A1 * asked + B1 / asked if asked >= where else A0 * asked + B0 / asked


class TestSeats:
    def test_inner_ring_on_a_solid_shaft(self) -> None:
        """One material: the groove grows by the interference times bore over groove diameter."""
        found = operating_clearance("6206", fit=(10e-6, (0.0, 0.0)), initial=15e-6)
        bearing = BallBearing.catalogue("6206")
        groove = bearing.pitch_diameter - bearing.ball_diameter
        interference = 10e-6 + np.array([10e-6, 5e-6, 0.0])
        assert found.inner_interference == pytest.approx(interference)
        assert found.by_inner_fit == pytest.approx(interference * 0.03 / groove, rel=1e-12)
        assert found.clearance == pytest.approx(15e-6 - interference * 0.03 / groove, rel=1e-12)

    def test_inner_ring_on_a_hollow_shaft_of_aluminium(self) -> None:
        given = {"shaft_bore": 0.012, "shaft_material": "aluminium"}
        found = operating_clearance("6205", fit=((8e-6, 8e-6), "H7"), initial=1e-5, **given)
        bearing = BallBearing.catalogue("6205")
        groove = 0.5 * (bearing.pitch_diameter - bearing.ball_diameter)
        rings = ((*ALUMINIUM[:2], 0.006, 0.0125), (bearing.youngs_modulus, bearing.poisson_ratio, 0.0125, groove))
        growth = 2.0 * pressed(rings, 0.5 * found.inner_interference[1], 0.0125, groove)
        assert found.by_inner_fit[1] == pytest.approx(growth, rel=1e-9)

    def test_outer_ring_in_a_housing_of_aluminium(self) -> None:
        found = operating_clearance(
            "6205", fit=("h5", (-2e-5, -2e-5)), initial=1e-5, housing_outside=0.07, housing_material="aluminium"
        )
        bearing = BallBearing.catalogue("6205")
        groove = 0.5 * (bearing.pitch_diameter + bearing.ball_diameter)
        rings = ((bearing.youngs_modulus, bearing.poisson_ratio, groove, 0.026), (*ALUMINIUM[:2], 0.026, 0.035))
        shrinkage = -2.0 * pressed(rings, 0.5 * found.outer_interference[1], 0.026, groove)
        assert found.by_outer_fit[1] == pytest.approx(shrinkage, rel=1e-9)

    def test_loose_seats_take_nothing(self) -> None:
        with pytest.warns(OutsideValidityWarning, match="loose on its shaft"):
            found = operating_clearance("6206", fit=("g6", "G7"))
        assert not found.by_inner_fit[2] and not found.by_outer_fit.any()
        assert found.loose_from == 0.0

    def test_the_ring_that_turns_creeps_where_it_is_loose(self) -> None:
        """Of a wheel under a load that stands still g6 and N7 are usual practice: its inner ring may be loose."""
        wheel = BallBearing.catalogue("6204", turning="outer")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            right = operating_clearance(wheel, fit=("g6", "N7"))
            operating_clearance("6204", fit=("k5", "H7"))
        assert right.inner_pressed[1] < 0.0 < right.outer_pressed[1] and "loose" not in repr(right)
        with pytest.warns(
            OutsideValidityWarning, match="the outer ring of 6204 is loose in its housing"
        ) as caught:
            wrong = operating_clearance(wheel, fit=("k5", "H7"))
        assert len(caught) == 1 and wrong.turning_pressed[1] < 0.0 < wrong.inner_pressed[1]

    def test_a_shaft_that_turns_loosens_its_ring(self) -> None:
        slow = operating_clearance("6206", fit=("m5", "H6"), speed_rpm=1000.0)
        at_end = operating_clearance("6206", fit=("m5", "H6"), speed_rpm=slow.loose_from)
        assert slow.inner_pressed[2] > 0.0
        assert at_end.inner_pressed[2] == pytest.approx(0.0, abs=1e-15)
        assert at_end.by_inner_fit[2] == pytest.approx(0.0, abs=1e-15)

    def test_a_turning_disc_by_its_equation(self) -> None:
        """r (r sigma_r)' - r sigma_t + rho omega^2 r^2 r = 0 by differences, free at both radii."""
        a, b, omega, E, nu, rho = 0.01, 0.02, 3000.0, *STEEL[:3]
        r = np.linspace(a, b, 2001)
        u = np.array([spinning(STEEL, a, b, one, omega) for one in r])
        strain, hoop = np.gradient(u, r, edge_order=2), u / r
        radial, around = (
            E / (1.0 - nu**2) * (one + nu * other) for one, other in ((strain, hoop), (hoop, strain))
        )
        balance = np.gradient(r * radial, r, edge_order=2) - around + rho * omega**2 * r**2
        assert np.abs(balance[5:-5]).max() < 1e-5 * np.abs(around).max()
        assert abs(radial[0]) < 1e-4 * around.max() and abs(radial[-1]) < 1e-4 * around.max()

    def test_warm_rings(self) -> None:
        warm = {"shaft": 70.0, "inner": 70.0, "outer": 50.0, "housing": 50.0, "balls": 60.0}
        found = operating_clearance("6206", fit=("k5", "H6"), temperatures=warm)
        cold = operating_clearance("6206", fit=("k5", "H6"))
        bearing = BallBearing.catalogue("6206")
        pitch, ball = bearing.pitch_diameter, bearing.ball_diameter
        taken = 12.5e-6 * (50.0 * (pitch - ball) + 40.0 * 2.0 * ball - 30.0 * (pitch + ball))
        assert found.by_temperature == pytest.approx(np.full(3, taken), rel=1e-12)
        seat = 50.0 * (11.5e-6 - 12.5e-6) * 0.03  # shaft and ring expand by different amounts
        assert found.inner_pressed - cold.inner_pressed == pytest.approx(np.full(3, seat), rel=1e-6)

    def test_shaft_and_housing_are_as_warm_as_their_rings(self) -> None:
        rings = {"inner": 75.0, "outer": 60.0}
        whole = rings | {"shaft": 75.0, "housing": 60.0, "balls": 67.5}
        found, told = (operating_clearance("6306", fit=("k5", "H6"), temperatures=one) for one in (rings, whole))
        assert found.temperatures == whole and found.clearance.tolist() == told.clearance.tolist()
        cold = operating_clearance("6306", fit=("k5", "H6"), temperatures=rings | {"shaft": 70.0})
        assert cold.temperatures["shaft"] == 70.0 and cold.mean > found.mean

    def test_warm_alike_nothing_but_size_changes(self) -> None:
        """Rings, balls, shaft and housing of one material at one temperature."""
        warm = dict.fromkeys(("shaft", "inner", "outer", "housing", "balls"), 100.0)
        given = {"shaft_material": "bearing steel", "housing_material": "bearing steel", "temperatures": warm}
        for name in ("7205", "6205"):
            found = operating_clearance(name, fit=((5e-6, 5e-6), "H6"), initial=None, **given)
            own = found.initial[1] if name == "7205" else 0.0  # clearance grows as all lengths do
            assert found.by_temperature == pytest.approx(np.full(3, -80.0 * 12.5e-6 * own), abs=1e-14)

    def test_groove_bottoms_leave_the_clearance(self) -> None:
        bearing = BallBearing.catalogue("7205")
        inner, outer = groove_bottoms(bearing)
        distance = (2.0 * 0.52 - 1.0) * bearing.ball_diameter
        play = 2.0 * distance * (1.0 - cos(radians(30.0)))
        assert outer - inner - 2.0 * bearing.ball_diameter == pytest.approx(play, rel=1e-9)


class TestClasses:
    @pytest.mark.parametrize(
        ("fit", "diameter", "lower", "upper"),
        [("k5", 30.0, 2, 11), ("j6", 25.0, -4, 9), ("h5", 25.0, -9, 0), ("g6", 40.0, -25, -9),
         ("js5", 60.0, -6.5, 6.5), ("m6", 80.0, 11, 30), ("n6", 100.0, 23, 45), ("p6", 120.0, 37, 59),
         ("k6", 18.0, 1, 12)],
    )  # fmt: skip
    def test_limits_of_shafts(self, fit: str, diameter: float, lower: float, upper: float) -> None:
        """Limits of ISO 286-2, quoted from memory."""
        assert shaft_limits(fit, 1e-3 * diameter) == pytest.approx((1e-6 * lower, 1e-6 * upper), abs=1e-12)

    @pytest.mark.parametrize(
        ("fit", "diameter", "lower", "upper"),
        [("H7", 62.0, 0, 30), ("H6", 52.0, 0, 19), ("J7", 72.0, -12, 18), ("K6", 47.0, -13, 3),
         ("N7", 90.0, -45, -10), ("M7", 62.0, -30, 0), ("P7", 52.0, -51, -21), ("G7", 80.0, 10, 40),
         ("JS7", 62.0, -15, 15)],
    )  # fmt: skip
    def test_limits_of_housings(self, fit: str, diameter: float, lower: float, upper: float) -> None:
        assert housing_limits(fit, 1e-3 * diameter) == pytest.approx((1e-6 * lower, 1e-6 * upper), abs=1e-12)

    def test_limits_of_rings(self) -> None:
        assert bore_limits(0.03) == pytest.approx((-10e-6, 0.0)) and outside_limits(0.062) == pytest.approx(
            (-13e-6, 0.0)
        )

    def test_outside_diameters(self) -> None:
        names = {
            "6205": 52.0,
            "6306": 72.0,
            "7205 A": 52.0,
            "608": 22.0,
            "16004": 42.0,
            "S 61905 C": 42.0,
            "218": 160.0,
        }
        for name, outside in names.items():
            bore = {"608": 8.0, "218": 90.0, "16004": 20.0, "6306": 30.0}.get(name, 25.0)
            assert outside_of(name, 1e-3 * bore) == pytest.approx(1e-3 * outside), name


class TestBearings:
    def test_a_deep_groove_bearing_takes_the_mean(self) -> None:
        found = operating_clearance("6206/C3", fit=("k5", "H6"))
        assert found.initial == pytest.approx([13e-6, 20.5e-6, 28e-6])
        assert found.of(BallBearing.catalogue("6206")).clearance == found.mean
        assert found.clearance[0] <= found.probable[0] < found.mean < found.probable[1] <= found.clearance[2]

    def test_a_pair_back_to_back_is_pressed_by_its_fits(self) -> None:
        bearing = BallBearing.catalogue("7205")
        found = operating_clearance(bearing, fit=((8e-6, 8e-6), "H6"))
        fitted, offset = found.of(bearing), found.offset(bearing)
        distance = (2.0 * 0.52 - 1.0) * bearing.ball_diameter
        play = 2.0 * distance * (1.0 - cos(radians(30.0))) - found.by_inner_fit[1]
        assert cos(fitted.contact_angle) == pytest.approx(1.0 - 0.5 * play / distance, rel=1e-12)
        pair = BearingSet.pair(bearing, "back to back", preload=200.0)
        tight = pair.mounted(found)
        assert tight.bearings == (fitted,) * 2 and tight.positions == pair.positions
        assert tight.offsets == pytest.approx([one + offset for one in pair.offsets], rel=1e-12, abs=0.0)
        forces = tight.equilibrium((0.0, 0.0, 0.0)).axial_forces
        assert forces.min() > 300.0 and tight.preload == pytest.approx(forces.min(), rel=1e-9)
        assert pair.preload == pytest.approx(200.0, rel=1e-6)
        assert found.by_inner_fit[1] > 0.0 and offset > 0.0

    def test_a_spring_takes_fits_up(self) -> None:
        bearing = BallBearing.catalogue("7205")
        found = operating_clearance(bearing, fit=("k5", "H6"))
        sprung = BearingSet.pair(bearing, spring=200.0).mounted(found)
        assert sprung.offsets == (0.0, 0.0) and sprung.preload == pytest.approx(200.0, rel=1e-9)
        loose = BearingSet.pair(bearing, offset=-20e-6, may_lift_off=True)
        assert loose.preload == 0.0 and loose.mounted(found).preload == 0.0

    def test_temperatures_without_fits(self) -> None:
        """Rings and balls alone: no seat, and no bore where nothing needs it."""
        rings = {"inner": 70.0, "outer": 50.0}
        found = operating_clearance("6206", temperatures=rings)
        fitted = operating_clearance("6206", fit=("k5", "H6"), temperatures=rings)
        assert found.by_temperature.tolist() == fitted.by_temperature.tolist()
        assert found.clearance == pytest.approx(found.initial - found.by_temperature, rel=1e-15)
        assert not found.by_inner_fit.any() and not found.inner_pressure.any() and not found.by_outer_fit.any()
        half = 0.5 * np.ptp(found.initial)
        assert found.probable == pytest.approx([found.mean - half, found.mean + half], rel=1e-12)
        assert found.loose_from == float("inf") and "no fit" in repr(found) and "shaft" not in repr(found)
        nameless = BallBearing(balls=9, ball_diameter=9.525e-3, pitch_diameter=46e-3, clearance=1e-5)
        own = operating_clearance(nameless, temperatures=rings)
        assert own.by_temperature == pytest.approx(found.by_temperature, rel=1e-12)
        one_seat = operating_clearance("6206", fit=(None, "N7"))
        assert (
            one_seat.fits == ("no fit", "N7") and one_seat.by_outer_fit.any() and not one_seat.by_inner_fit.any()
        )

    def test_warm_alike_takes_nothing(self) -> None:
        warm = dict.fromkeys(("inner", "outer"), 60.0)
        found = operating_clearance("6206", temperatures=warm)
        assert not found.by_temperature.any() and "temperature 0 / 0 / 0" in repr(found)


class TestRefused:
    @pytest.mark.parametrize(
        ("given", "words"),
        [
            ({"fit": ("H6", "k5")}, "shaft first"),
            ({"fit": ("k5", "h6")}, "shaft first"),
            ({"fit": ("z9", "H6")}, "fit"),
            ({"fit": "k5"}, "fit"),
            ({"fit": ((8.0, 12.0), "H6")}, "in µm"),
            ({"fit": ((2e-6, 1e-6), "H6")}, "lower deviation before"),
            ({"fit": ("k5", "H6"), "temperatures": {"inner": 340.0}}, r"66.85"),
            ({"fit": ("k5", "H6"), "temperatures": {"ring": 50.0}}, "of shaft, inner"),
            ({"fit": ("k5", "H6"), "shaft_bore": 0.03}, "below 0.03"),
            ({"fit": ("k5", "H6"), "housing_outside": 0.05}, "above 0.062"),
            ({"fit": ("k5", "H6"), "housing_material": "brass"}, "housing_material"),
            ({"fit": ("k5", "H6"), "smoothing": 3.0}, "smoothing"),
            ({"fit": ("k5", "H6"), "initial": "C9"}, "C9"),
        ],
    )
    def test_inputs(self, given: dict[str, object], words: str) -> None:
        with pytest.raises(InputError, match=words):
            operating_clearance("6206", **given)  # type: ignore[arg-type]

    def test_fits_without_diameters(self) -> None:
        plain = BallBearing(balls=9, ball_diameter=8e-3, pitch_diameter=39e-3)
        with pytest.raises(InputError, match=r"^bore"):
            operating_clearance(plain, fit=("k5", "H6"))
        with pytest.raises(InputError, match=r"^outside"):
            operating_clearance(plain, fit=("k5", "H6"), bore=0.025)
        found = operating_clearance(plain, fit=("k5", "H6"), bore=0.025, outside=0.052)
        assert found.initial == pytest.approx(np.zeros(3))

    def test_a_class_beside_a_contact_angle(self) -> None:
        with pytest.raises(InputError, match="follows from its angle"):
            operating_clearance("7205", fit=("k5", "H6"), initial="CN")
