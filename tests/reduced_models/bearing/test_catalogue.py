"""The catalogue: rows derived from load ratings, bores, names in short, and clearances by class."""

import numpy as np
import pytest
from programs import script
from refusals import refusals

from ehlcontact.errors import InputError
from reduced_models import BallBearing
from reduced_models.bearing.catalogue import (
    DEEP_GROOVE,
    ROWS,
    catalogue_row,
    deep_groove_row,
    designation_of,
    names_in_short,
)
from reduced_models.bearing.clearance import CLASSES, clearance_limits
from reduced_models.bearing.designation import NOT_READ
from reduced_models.bearing.printed_ratings import RATINGS

# NSK, Rolling Bearings, tables of single-row deep groove ball bearings: d, D [mm], f0; `RATINGS` has Cr, C0r
NSK = {
    "6000": (10, 26, 12.4),
    "6001": (12, 28, 13.0),
    "6002": (15, 32, 13.9),
    "6003": (17, 35, 14.4),
    "6004": (20, 42, 13.8),
    "6005": (25, 47, 14.5),
    "6006": (30, 55, 14.7),
    "6007": (35, 62, 14.8),
    "6008": (40, 68, 15.3),
    "6009": (45, 75, 15.3),
    "6010": (50, 80, 15.6),
    "6200": (10, 30, 13.2),
    "6201": (12, 32, 12.3),
    "6202": (15, 35, 13.2),
    "6203": (17, 40, 13.2),
    "6204": (20, 47, 13.1),
    "6205": (25, 52, 13.9),
    "6206": (30, 62, 13.8),
    "6207": (35, 72, 13.8),
    "6208": (40, 80, 14.0),
    "6209": (45, 85, 14.4),
    "6210": (50, 90, 14.4),
    "6211": (55, 100, 14.3),
    "6300": (10, 35, 11.2),
    "6301": (12, 37, 11.1),
    "6302": (15, 42, 12.3),
    "6303": (17, 47, 12.4),
    "6304": (20, 52, 12.4),
    "6305": (25, 62, 13.2),
    "6306": (30, 72, 13.3),
    "6307": (35, 80, 13.2),
    "6308": (40, 90, 13.2),
    "6309": (45, 100, 13.1),
    "6310": (50, 110, 13.2),
    "6311": (55, 120, 13.1),
    "6312": (60, 130, 13.1),
    # quoted from memory
    "608": (8, 22, 12.4),
    "16004": (20, 42, 14.5),
    "16005": (25, 47, 15.1),
    "16006": (30, 55, 15.2),
    "16007": (35, 62, 15.6),
    "16008": (40, 68, 16.0),
    "16009": (45, 75, 15.9),
    "16010": (50, 80, 16.1),
}
# NSK, Rolling Bearings, tables of single-row angular contact ball bearings: as above, f0 where the table has it
NSK_ANGULAR = {
    "7204 A": (20, 47, None),
    "7204 B": (20, 47, None),
    "7204 C": (20, 47, 13.3),
    "7205 A": (25, 52, None),
    "7205 B": (25, 52, None),
    "7205 C": (25, 52, 14.0),
    "7206 A": (30, 62, None),
    "7206 B": (30, 62, None),
    "7206 C": (30, 62, 13.9),
    "7207 A": (35, 72, None),
    "7207 B": (35, 72, None),
    "7207 C": (35, 72, 13.9),
    "7208 A": (40, 80, None),
    "7208 B": (40, 80, None),
    "7208 C": (40, 80, 14.1),
    "7305 A": (25, 62, None),
    "7305 B": (25, 62, None),
    "7306 A": (30, 72, None),
    "7306 B": (30, 72, None),
}
# ISO 76, factor f0 of radial ball bearings, over D cos a/dm
F0 = {
    0.12: 15.9, 0.13: 15.6, 0.14: 15.4, 0.15: 15.2, 0.16: 14.9, 0.17: 14.7, 0.18: 14.4, 0.19: 14.2, 0.20: 14.0,
    0.21: 13.7, 0.22: 13.5, 0.23: 13.2, 0.24: 13.0, 0.25: 12.8, 0.26: 12.5, 0.27: 12.3, 0.28: 12.1,
}  # fmt: skip
# ISO 281, factor fc of radial ball bearings with grooves of 0.52, over ball by pitch diameter
FC = {
    0.05: 46.7, 0.06: 49.1, 0.07: 51.1, 0.08: 52.8, 0.09: 54.3, 0.10: 55.5, 0.12: 57.5, 0.14: 58.8, 0.16: 59.6,
    0.18: 59.9, 0.20: 59.9, 0.22: 59.6, 0.24: 59.0, 0.26: 58.2, 0.28: 57.1, 0.30: 56.0, 0.32: 54.6, 0.34: 53.2,
}  # fmt: skip
STEP = 25.4 / 64  # mm
OTHER_MAKES = {"6200"}  # GMN's has other balls than NSK's


def balls_of(name):
    """Number of balls, diameter [mm] and misfit, by the rule of the catalogue."""
    (bore, outside, given), (dynamic, static) = (NSK | NSK_ANGULAR)[name], RATINGS[name]
    pitch, best = 0.5 * (bore + outside), (np.inf, 0, 0.0)
    cosine = np.cos(ROWS[name].contact_angle or 0.0)
    for number in range(5, 20):
        for diameter in STEP * np.arange(8, 100):
            share = diameter * cosine / pitch
            if not (min(FC) < share < max(FC)) or number * np.arcsin(diameter / pitch) >= np.pi:
                continue
            fc, f0 = (np.interp(share, list(table), list(table.values())) for table in (FC, F0))
            c0 = (given or f0) * number * diameter**2 * cosine
            c = 1.3 * fc * cosine**0.7 * number ** (2 / 3) * diameter**1.8
            misfit = max(abs(c0 / static - 1.0), abs(c / dynamic - 1.0))
            best = min(best, (misfit, number, float(diameter)))
    return best[1:] + best[:1]


@pytest.mark.parametrize("name", [name for name, row in ROWS.items() if not row.sourced])
def test_derived_rows_are_those_of_the_rule(name):
    row, (number, diameter, misfit) = ROWS[name], balls_of(name)
    assert (row.balls, row.ball_diameter) == (number, pytest.approx(1e-3 * diameter, abs=6e-7))
    assert row.pitch_diameter == pytest.approx(0.5e-3 * sum((NSK | NSK_ANGULAR)[name][:2])) and misfit < 0.01


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
        if len(name) > 3 and name.isdigit():
            bore = {0: 10, 1: 12, 2: 15, 3: 17}.get(int(name[-2:]), 5 * int(name[-2:]))
            assert row.bore == pytest.approx(1e-3 * bore), name
        assert row.bore is None or row.bore < row.pitch_diameter - row.ball_diameter


def test_page_of_the_catalogue_is_made_from_it():
    """`python docs/site/catalogue.py` makes it."""
    catalogue = script("docs/site/catalogue.py")
    assert catalogue.PAGE.read_text(encoding="utf-8") == catalogue.page()


def test_names_in_short():
    shown = "6000 to 6010, 6200 to 6211, 6300 to 6312, 16004 to 16010, 608, 209, UER204, ER-16K, NICE"
    assert names_in_short(list(DEEP_GROOVE)) == shown
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


test_clearances_that_are_none = refusals(
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
)


@pytest.mark.parametrize("names", [list(ROWS)[::5], pytest.param(list(ROWS), marks=pytest.mark.slow)], ids=len)
def test_every_row_is_a_bearing_that_runs(oil, names):
    for name in names:
        _, row = catalogue_row(name.lower())
        bearing = BallBearing.catalogue(name, oil=oil)
        assert bearing.orders.bpfo_order + bearing.orders.bpfi_order == pytest.approx(row.balls)
        load = (0.0, -100.0) if name in DEEP_GROOVE else (0.0, -100.0, 200.0)
        assert bearing.equilibrium(load, speed_rpm=1500.0).h_min.min() > 0.0


@pytest.mark.parametrize(
    ("typed", "name", "angle"),
    [
        ("7205", "7205 A", 30.0),
        ("7205c", "7205 C", 15.0),
        (" 7205 B ", "7205 B", 40.0),
        ("S 6205 C", "S 6205 C", 15.0),
        ("s6205e", "S 6205 E", 25.0),
        ("S-61905-C", "S 61905 C", 15.0),
        ("218", "218", 40.0),
    ],
)
def test_angular_contact_bearings_as_people_type_them(typed, name, angle):
    bearing = BallBearing.catalogue(typed)
    assert bearing.name == name and np.degrees(bearing.contact_angle) == pytest.approx(angle)


@pytest.mark.parametrize(
    ("typed", "words"),
    [
        ("7502", "7205 A"),
        ("7205 D", "7205 [ABC], .*nearest"),
        ("S 6205", "S 6205 C"),
        ("s6250c", "one of S 6205 C, .*nearest"),
        ("7205 AC", "7205 [ABC], .*nearest"),
        ("62205-2RS1", "one of 6205, .*nearest"),
    ],
)
def test_nearest_name_of_an_angular_contact_bearing(typed, words):
    with pytest.raises(InputError, match=words):
        catalogue_row(typed)


@pytest.mark.parametrize(
    ("typed", "name", "clearance", "suffixes"),
    [
        ("6205-2RS", "6205", None, ["2RS"]),
        ("6203-2RS-JEM", "6203", None, ["2RS", "JEM"]),
        ("6205 ZZ", "6205", None, ["ZZ"]),
        ("6201-2Z", "6201", None, ["2Z"]),
        ("SKF 6205", "6205", None, []),
        ("6205/C3", "6205", "C3", ["C3"]),
        ("6205-2Z/C3", "6205", "C3", ["2Z", "C3"]),
        ("nsk6205ddu c4", "6205", "C4", ["DDU", "C4"]),
        ("6205-2RSH/C3LHT23", "6205", "C3", ["2RSH", "C3", "LHT23"]),
        ("7205 BECBP", "7205 B", None, ["ECBP"]),
        ("7205-2RS", "7205 A", None, ["2RS"]),
        ("S 6205 C/P4", "S 6205 C", None, ["P4"]),
        ("608ZZ", "608", None, ["ZZ"]),
    ],
)
def test_suffixes_of_names_as_people_type_them(typed, name, clearance, suffixes):
    read = designation_of(typed)
    assert (read.name, read.clearance, [suffix for suffix, _ in read.suffixes]) == (name, clearance, suffixes)
    assert (NOT_READ in read.words) == ("ECBP" in suffixes) and BallBearing.catalogue(typed).name == name


def test_seals_and_grease_are_told_not_to_be_in_the_torque():
    sealed, shielded, open_ = (designation_of(name) for name in ("6205-2RS/C3", "6205 ZZ", "6205/C3"))
    assert sealed.without_friction == "drag of the seals and of the grease is not in the torque"
    assert sealed.words.endswith(sealed.without_friction) and "shields" in shielded.without_friction
    assert open_.without_friction == "" and open_.words == "C3: clearance class"


def test_the_class_in_a_name_is_the_clearance_where_none_is_given():
    by_class = BallBearing.catalogue("6205", clearance="C3")
    assert BallBearing.catalogue("6205/C3") == by_class == BallBearing.catalogue("6205-2RS C3", clearance="c3")
    assert BallBearing.catalogue("6205/C3", clearance=3e-6).clearance == 3e-6
    assert BallBearing.catalogue("7205 B/C3") == BallBearing.catalogue("7205 B")
    with pytest.raises(InputError, match="clearance = 'C2': must be C3, the class in the name 6205/C3"):
        BallBearing.catalogue("6205/C3", clearance="C2")


@pytest.mark.parametrize(
    ("typed", "words"),
    [
        ("NU205", "NU205 is one of the cylindrical roller bearings, which are not in this library"),
        ("SKF NU 205 ECP", "cylindrical roller bearings"),
        ("22228", "spherical roller bearings"),
        ("30205", "tapered roller bearings"),
        ("HK1512", "needle roller bearings"),
        ("1205", "self-aligning ball bearings of two rows"),
        ("3205 A-2RS1", "angular contact ball bearings of two rows"),
        ("51105", "thrust ball bearings"),
        ("QJ205", "four-point contact ball bearings"),
        ("S6205-2RS", "6205 for one of stainless steel, or a spindle .*: S 6205 C with 15 degrees or S 6205 E"),
        ("S6201", "6201 for one of stainless steel$"),
    ],
)
def test_other_kinds_of_bearings_are_named(typed, words):
    with pytest.raises(InputError, match=words):
        designation_of(typed)


def test_single_contacts_have_deep_groove_bearings_only():
    assert deep_groove_row("6205") == catalogue_row("6205")
    with pytest.raises(InputError, match="name = '7205': must be a deep-groove bearing here"):
        deep_groove_row("7205")
