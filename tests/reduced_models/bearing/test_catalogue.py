"""The catalogue: rows derived from load ratings, bores, names in short, and clearances by class."""

import numpy as np
import pytest
from programs import script

from ehlcontact.errors import InputError
from reduced_models import BallBearing
from reduced_models.bearing.catalogue import ROWS, catalogue_row, names_in_short
from reduced_models.bearing.clearance import CLASSES, clearance_limits

# NSK, Rolling Bearings, tables of single-row deep groove ball bearings: d, D [mm], Cr, C0r [N], f0
NSK = {
    "6000": (10, 26, 4550, 1970, 12.4),
    "6001": (12, 28, 5100, 2370, 13.0),
    "6002": (15, 32, 5600, 2830, 13.9),
    "6003": (17, 35, 6000, 3250, 14.4),
    "6004": (20, 42, 9400, 5000, 13.8),
    "6005": (25, 47, 10100, 5850, 14.5),
    "6006": (30, 55, 13200, 8300, 14.7),
    "6007": (35, 62, 16000, 10300, 14.8),
    "6008": (40, 68, 16800, 11500, 15.3),
    "6009": (45, 75, 20900, 15200, 15.3),
    "6010": (50, 80, 21800, 16600, 15.6),
    "6200": (10, 30, 5100, 2390, 13.2),
    "6201": (12, 32, 6800, 3050, 12.3),
    "6202": (15, 35, 7650, 3750, 13.2),
    "6203": (17, 40, 9550, 4800, 13.2),
    "6204": (20, 47, 12800, 6600, 13.1),
    "6205": (25, 52, 14000, 7850, 13.9),
    "6206": (30, 62, 19500, 11300, 13.8),
    "6207": (35, 72, 25700, 15300, 13.8),
    "6208": (40, 80, 29100, 17900, 14.0),
    "6209": (45, 85, 31500, 20400, 14.4),
    "6210": (50, 90, 35000, 23200, 14.4),
    "6211": (55, 100, 43500, 29300, 14.3),
    "6300": (10, 35, 8100, 3450, 11.2),
    "6301": (12, 37, 9700, 4200, 11.1),
    "6302": (15, 42, 11400, 5450, 12.3),
    "6303": (17, 47, 13600, 6650, 12.4),
    "6304": (20, 52, 15900, 7900, 12.4),
    "6305": (25, 62, 20600, 11200, 13.2),
    "6306": (30, 72, 26700, 15000, 13.3),
    "6307": (35, 80, 33500, 19200, 13.2),
    "6308": (40, 90, 40500, 24000, 13.2),
    "6309": (45, 100, 53000, 32000, 13.1),
    "6310": (50, 110, 62000, 38500, 13.2),
    "6311": (55, 120, 71500, 44500, 13.1),
    "6312": (60, 130, 82000, 52000, 13.1),
}
# ISO 281, factor fc of radial ball bearings with grooves of 0.52, over ball by pitch diameter
FC = {
    0.05: 46.7, 0.06: 49.1, 0.07: 51.1, 0.08: 52.8, 0.09: 54.3, 0.10: 55.5, 0.12: 57.5, 0.14: 58.8, 0.16: 59.6,
    0.18: 59.9, 0.20: 59.9, 0.22: 59.6, 0.24: 59.0, 0.26: 58.2, 0.28: 57.1, 0.30: 56.0, 0.32: 54.6, 0.34: 53.2,
}  # fmt: skip
STEP = 25.4 / 64  # mm
OTHER_MAKES = {"6200"}  # GMN's has other balls than NSK's


def balls_of(name):
    """Number of balls, diameter [mm] and misfit, by the rule of the catalogue."""
    bore, outside, dynamic, static, f0 = NSK[name]
    pitch, best = 0.5 * (bore + outside), (np.inf, 0, 0.0)
    for number in range(5, 20):
        for diameter in STEP * np.arange(8, 100):
            share = diameter / pitch
            if not (min(FC) < share < max(FC)) or number * np.arcsin(share) >= np.pi:
                continue
            fc = np.interp(share, list(FC), list(FC.values()))
            misfits = number * diameter**2 * f0 / static, 1.3 * fc * number ** (2 / 3) * diameter**1.8 / dynamic
            misfit = max(abs(one - 1.0) for one in misfits)
            best = min(best, (misfit, number, float(diameter)))
    return best[1:] + best[:1]


@pytest.mark.parametrize("name", [name for name, row in ROWS.items() if not row.sourced])
def test_derived_rows_are_those_of_the_rule(name):
    row, (number, diameter, misfit) = ROWS[name], balls_of(name)
    assert (row.balls, row.ball_diameter) == (number, pytest.approx(1e-3 * diameter, abs=6e-7))
    assert row.pitch_diameter == pytest.approx(0.5e-3 * sum(NSK[name][:2])) and misfit < 0.01


@pytest.mark.literature
def test_the_rule_finds_the_balls_that_others_print():
    """All of GMN, the 6203 and 6205 of Case Western and the measured 6010, whose balls are inch ones too."""
    known = [name for name in NSK if ROWS[name].sourced]
    found = {name: balls_of(name) for name in known}
    other = {
        name
        for name, (number, diameter, _) in found.items()
        if number != ROWS[name].balls or abs(diameter - 1e3 * ROWS[name].ball_diameter) > 3e-3
    }
    assert len(known) == 17 and other == OTHER_MAKES


def test_series_and_bores():
    assert len(ROWS) >= 30
    for name, row in ROWS.items():
        if len(name) == 4 and name.isdigit():
            bore = {0: 10, 1: 12, 2: 15, 3: 17}.get(int(name[2:]), 5 * int(name[2:]))
            assert row.bore == pytest.approx(1e-3 * bore), name
        assert row.bore is None or row.bore < row.pitch_diameter - row.ball_diameter


def test_page_of_the_catalogue_is_made_from_it():
    """`python docs/site/catalogue.py` makes it."""
    catalogue = script("docs/site/catalogue.py")
    assert catalogue.PAGE.read_text(encoding="utf-8") == catalogue.page()


def test_names_in_short():
    assert names_in_short(list(ROWS)) == "6000 to 6010, 6200 to 6211, 6300 to 6312, 209, UER204, ER-16K, NICE"
    assert names_in_short(["6000", "6001", "6003", "209"]) == "6000, 6001, 6003, 209"


@pytest.mark.parametrize(
    ("bore", "limits"),
    [
        (10e-3, ((0, 7), (2, 13), (8, 23), (14, 29))),
        (12e-3, ((0, 9), (3, 18), (11, 25), (18, 33))),
        (25e-3, ((1, 11), (5, 20), (13, 28), (23, 41))),
        (30e-3, ((1, 11), (5, 20), (13, 28), (23, 41))),
        (35e-3, ((1, 11), (6, 20), (15, 33), (28, 46))),
        (60e-3, ((1, 15), (8, 28), (23, 43), (38, 61))),
    ],
)
def test_clearances_by_class_and_bore(bore, limits):
    for name, pair in zip(CLASSES, limits, strict=True):
        np.testing.assert_allclose(clearance_limits(name, bore), np.multiply(pair, 1e-6))


def test_classes_are_in_order_at_every_bore():
    for row in ROWS.values():
        if row.bore is not None:
            ends = np.array([clearance_limits(name, row.bore) for name in CLASSES])
            assert (np.diff(ends, axis=0) > 0.0).all() and (np.diff(ends, axis=1) > 0.0).all()


def test_clearance_of_a_bearing_by_its_class():
    assert BallBearing.catalogue("6205", clearance="CN").clearance == pytest.approx(12.5e-6)
    assert BallBearing.catalogue("6205", clearance="c3").clearance == pytest.approx(20.5e-6)
    assert BallBearing.catalogue("6206", clearance=3e-6).clearance == 3e-6


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: BallBearing.catalogue("6205", clearance="C9"), "clearance = 'C9': .*C2, CN, C3, C4"),
        (
            lambda: BallBearing.catalogue("NICE", clearance="CN"),
            "clearance = 'CN': .*bore of this bearing is not known",
        ),
        (
            lambda: BallBearing(balls=9, ball_diameter=8e-3, pitch_diameter=39e-3, clearance="CN"),
            "clearance = 'CN': must be a number .m.; classes need a bore",
        ),
        (lambda: clearance_limits("CN", 0.2), "bores of 2.5 to 100 mm, not of 200 mm"),
    ],
)
def test_clearances_that_are_none(call, words):
    with pytest.raises(InputError, match=words):
        call()


def test_every_row_is_a_bearing_that_runs(oil):
    for name in ROWS:
        _, row = catalogue_row(name.lower())
        bearing = BallBearing.catalogue(name, oil=oil)
        assert bearing.orders.bpfo + bearing.orders.bpfi == pytest.approx(row.balls)
        assert bearing.equilibrium((0.0, -100.0), speed_rpm=1500.0).h_min.min() > 0.0
