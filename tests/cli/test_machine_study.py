"""A study of a machine, or of a bearing under axial load: numbers of the library, and what is no machine."""

import json
import warnings
from dataclasses import replace
from math import cos, pi, radians
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from tiny_study import ALONE, ANGULAR, CONTACT, MOTOR, PAIR

from ehlcontact import InputError, OilLayer
from ehlcontact.cli.study.answer import answer_of, over_frequency
from ehlcontact.cli.study.exports import machine_model
from ehlcontact.cli.study.forecast import seals_left_out
from ehlcontact.cli.study.headline import ball_words, clearances_apart, headline, limits
from ehlcontact.cli.study.headline import oil_and_heat as conditions_sentence
from ehlcontact.cli.study.loads import by_formula
from ehlcontact.cli.study.machine import bearing_of, carrier_of, clearance_of, rotor_of
from ehlcontact.cli.study.oil_and_heat import run_oil_and_heat
from ehlcontact.cli.study.points.lists import Point
from ehlcontact.cli.study.points.numbers import numbers_of
from ehlcontact.cli.study.points.summary import Row, cells, columns_of, narrowed
from ehlcontact.cli.study.results import Findings
from ehlcontact.cli.study.schema import load_study
from reduced_models import (
    BallBearing,
    BearingSet,
    Disc,
    OutsideValidityWarning,
    Shaft,
    Support,
    linearise,
    operating_clearance,
    rotor_on_bearings,
)
from reduced_models.bearing.clearance import clearance_limits
from reduced_models.bearing.oil_and_heat import LAYER
from reduced_models.rotor.machine_state import machine_state, single_bearing_state

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def study(tmp_path):
    """``study(text, old=new, ...)``: the file of a text with other entries."""

    def write(text, *changes):
        for old, new in changes:
            assert old in text, old
            text = text.replace(old, new)
        path = tmp_path / "s.toml"
        path.write_text(text)
        return path

    return write


def test_the_contact_is_that_of_the_heaviest_ball_at_its_angle(study):
    one = load_study(study(ANGULAR + CONTACT))
    state = BallBearing.catalogue("7205").equilibrium((0.0, -200.0, 400.0), speed_rpm=6000.0)
    load, angle = state.force[:, 0].max(), state.contact_angles[state.force[:, 0].argmax(), 0]
    assert one.ball == (load, angle) and one.ball_load == one.point.load == load
    D, dm = 7.938e-3, 38.5e-3
    gamma = D * cos(angle) / dm
    assert one.point.geometry.radius_x == pytest.approx(0.5 * D * (1.0 - gamma), rel=1e-4)
    # both surfaces roll at omega dm (1 - gamma^2)/4 as seen from the contact
    assert one.point.u_sum == pytest.approx(200.0 * pi * dm * (1.0 - gamma**2) / 2.0, rel=1e-4)
    other = load_study(study(ANGULAR + CONTACT, ("400.0", "500.0")))
    assert one.fingerprint("grid") != other.fingerprint("grid")


def test_other_angle_than_that_of_the_name(study):
    one = load_study(study(f"{ANGULAR}contact_angle_deg = 15.0\n"))
    assert bearing_of(one, 0).contact_angle == pytest.approx(radians(15.0))


def test_seals_of_a_name_are_not_in_the_torque(study):
    """Said once of all bearings that have some."""
    assert seals_left_out(load_study(study(MOTOR))) == []
    names = ('bearing = "6306"', 'bearing = "6306-2RS"'), ('bearing = "6206"', 'bearing = "6206-2RSH/C3"')
    said = seals_left_out(load_study(study(MOTOR, *names, ('"6206-2RSH/C3"\nclearance = "CN"', '"6206-2RSH/C3"'))))
    assert said == ["drag of the seals and of the grease is not in the torque"]


def test_a_bearing_alone_is_that_of_the_library(study):
    one = load_study(study(ANGULAR))
    bearing, load = carrier_of(one, 0), (0.0, -200.0, 400.0)
    found = answer_of(one)
    assert found.to_dict() == single_bearing_state(bearing, load, 6000.0).to_dict()
    assert json.loads(json.dumps(found.to_dict(), default=lambda array: array.tolist()))["modes"] == []
    (small,) = over_frequency(one, found).values()
    ends = bearing.coefficients(load, speed_rpm=6000.0, hz=(10.0, 10000.0))
    np.testing.assert_allclose(small.stiffness[[0, -1], 2, 2], ends.stiffness[:, 2, 2], rtol=1e-12)
    asked = load_study(study(ANGULAR, ("speed_rpm", "hz = [123.0]\nspeed_rpm")))
    assert next(iter(over_frequency(asked, found).values())).hz.tolist() == [123.0]


def test_a_pair_carries_the_load(study):
    one = load_study(study(PAIR + CONTACT))
    pair = BearingSet.pair(bearing_of(one, 0), preload=200.0, distance=0.04)
    support = answer_of(one).supports[0]
    state = pair.equilibrium((0.0, -200.0, 100.0), speed_rpm=6000.0)
    np.testing.assert_array_equal(support.state.axial_forces, state.axial_forces)
    dry = BearingSet.pair(bearing_of(one, 0, oil=False), preload=200.0, distance=0.04)
    heaviest = dry.equilibrium((0.0, -200.0, 100.0), speed_rpm=6000.0).bearings[0]
    assert one.ball_load == heaviest.force[:, 0].max()


@pytest.mark.long
def test_a_pair_with_a_layer_of_oil(study):
    """What the study has of it is that of the set; its words are of a pair."""
    one = load_study(study(PAIR, ("speed_rpm", "layer_ratio = 0.8\nspeed_rpm"), ("distance_mm = 40.0\n", "")))
    (found,) = run_oil_and_heat(one).values()
    pair = BearingSet.pair(bearing_of(one, 0), preload=200.0)
    starved = replace(pair, bearings=[replace(k, supply=OilLayer(over_flooded=0.8)) for k in pair.bearings])
    load = (0.0, -200.0, 100.0)
    small = starved.coefficients(load, speed_rpm=6000.0, hz=found.hz)
    state = starved.equilibrium(load, speed_rpm=6000.0).bearings[0]
    layer = found.conditions[LAYER]
    np.testing.assert_array_equal(layer.damping, np.einsum("kii->ki", small.signed_damping)[:, :3])
    np.testing.assert_array_equal(layer.h_central, state.h_central)
    assert "isothermal, the pair has" in conditions_sentence(SimpleNamespace(oil_and_heat={"1": found}))


@pytest.fixture(scope="module")
def motor(tmp_path_factory):
    path = tmp_path_factory.mktemp("motor") / "motor.toml"
    path.write_text(MOTOR)
    one = load_study(path)
    return one, answer_of(one)


def test_a_motor_of_unequal_bearings(motor):
    """The numbers of `machine_state` for the rotor that ten lines of Python make of the same parts."""
    one, found = motor
    given = {"clearance": "CN", "oil": one.lubricant, "rq_ball": 0.0, "rq_race": 1e-7}
    left, right = (BallBearing.catalogue(name, **given) for name in ("6306", "6206"))
    rotor = rotor_on_bearings(
        Shaft(length=0.36, diameter=0.035),
        discs=[Disc.cylinder(position=0.18, diameter=0.11, width=0.12, bore=0.035, unbalance=1e-5)],
        supports=[
            Support(position=0.03, bearing=left, facing="-z"),
            Support(position=0.33, bearing=right, facing="+z", preload=200.0),
        ],
    )
    own = machine_state(rotor, 15000.0, names=("drive end", "fan end"), positions=(0.03, 0.33))
    assert found.clearances == (clearance_limits("CN", 30e-3),) * 2
    assert found.to_dict() == replace(own, clearances=found.clearances).to_dict()
    assert [round(1e6 * support.h_min, 3) for support in found.supports] == [0.369, 0.322]
    assert sorted(round(mode.hz) for mode in found.modes[:3]) == [161, 266, 267]


def test_numbers_of_a_point_of_a_machine(motor, tmp_path):
    """Those of the worst bearing and of the machine, in a table of the columns that have numbers."""
    one, answer = motor
    point = Point(one, "15000rpm", tmp_path)
    numbers = numbers_of(point, {"machine": answer.to_dict()})
    assert numbers["h_min"] == min(support.h_min for support in answer.supports) and numbers["M"] is None
    assert numbers["ball_load"] == max(support.ball_load for support in answer.supports)
    assert numbers["torque"] == pytest.approx(sum(support.torque for support in answer.supports), rel=1e-12)
    assert numbers["critical_rpm"] == pytest.approx(answer.nearest_critical.speed_rpm, rel=1e-12)
    assert numbers["p_hertz"] == max(support.p_hertz for support in answer.supports)
    assert numbers["capacitance"] == pytest.approx(sum(s.capacitance for s in answer.supports), rel=1e-12)
    assert numbers["field"] is None
    assert numbers["peak"] == answer.largest_peak.size and numbers["mode_damping"] == answer.modes[0].damping_ratio
    diagram = answer.diagram
    axial = replace(diagram, axial_share=np.ones_like(diagram.axial_share))
    along = replace(answer, diagram=axial, amplifications=())
    assert along.critical_speeds and along.numbers["critical_rpm"] is None
    row = Row(point, "converged", (), answer.concerns, (), (), numbers, {}, {}, None, ())
    heads = [column.head for column in columns_of([row]).values()]
    narrow = [column.head for column in narrowed([row], columns_of([row]), 50).values()]
    assert narrow == ["speed [rpm]", "mode [Hz]", "critical [rpm]", "response [µm]", "h_min [µm]", "lambda"]
    assert heads[:3] == ["speed [rpm]", "ball [N]", "mode [Hz]"] and "h_c [µm]" not in heads
    assert cells(row, columns_of([row]))[0] == "15000"


def test_oil_and_voltage_of_a_study(study, motor):
    """[electric] sets the permittivity of the oil, the voltage and the limit of the field."""
    _, plain = motor
    given = "[electric]\nvoltage = 4.0\npermittivity = 2.5\nbreakdown = 30.0\n"
    one = load_study(study(ALONE + given))
    found, state = answer_of(one), answer_of(load_study(study(ALONE))).supports[0].state
    assert found.supports[0].capacitance == state.capacitance(2.5).total
    assert found.field_strength == pytest.approx(state.capacitance(2.5).field_strength(4.0), rel=1e-12)
    tiles = {tile.name: tile for tile in found.tiles()}
    assert "of permittivity 2.5" in tiles["capacitance of the films"].note
    assert "4 V between shaft and housing" in tiles["largest field in a film"].note
    assert "limit of 30 V/µm" in tiles["largest field in a film"].note
    assert plain.voltage is None and plain.supports[0].permittivity == 2.2
    assert "largest field in a film" not in {tile.name for tile in plain.tiles()}
    usual = answer_of(load_study(study(ALONE + "[electric]\n")))
    assert (usual.voltage, usual.breakdown) == (10.0, 15.0)
    assert usual.numbers["field"] == 10.0 * usual.supports[0].field_per_volt
    assert "capacitance" in {variable.name for variable in machine_model(one, [3000.0]).spec.variables}
    plainer = machine_model(load_study(study(ALONE)), [3000.0])
    assert "capacitance" not in {variable.name for variable in plainer.spec.variables}


def test_the_film_of_a_bearing_of_a_machine(study, motor):
    """That of the heaviest ball of the machine at rest, under the axial load of the spring."""
    path = study(f'{MOTOR}[contact]\nsupport = "fan end"\n')
    one = load_study(path)
    assert one.carrier.bearing == "6206" and 80.0 < one.ball_load < 100.0
    loads = linearise(rotor_of(one), 15000.0).loads
    state = motor[1].supports[1].state
    assert one.ball_load == pytest.approx(state.force[:, 0].max(), rel=1e-9)
    assert one.radial_load == pytest.approx(abs(loads[1][1]), rel=1e-9)


def test_the_contact_says_where_its_load_is_from(study):
    """And why it is another one than that of the machine's tile."""
    one = load_study(EXAMPLES / "small_study.toml")
    assert by_formula(one)
    machine = SimpleNamespace(supports=[SimpleNamespace(ball_load=0.9 * one.ball_load, outer_load=1.0)] * 2)
    words = ball_words(SimpleNamespace(study=one, machine=machine))
    assert words.startswith("by Stribeck's formula") and f"{0.9 * one.ball_load:.4g} N with films" in words
    tight = study(ALONE + "clearance = -1.0\n" + CONTACT)
    assert ball_words(SimpleNamespace(study=load_study(tight), machine="none")).endswith("at rest without films")


def test_a_pair_in_a_machine(study):
    """Beside a bearing that floats; the contact of the study is that of the pair's heaviest ball."""
    pair = 'bearing = "7206"\npair = "back-to-back"\npreload = 300.0'
    changes = ('bearing = "6306"\nclearance = "CN"', pair), ("spring = 200.0", "spring = 0.0")
    one = load_study(study(f"{MOTOR}[contact]\n", *changes))
    assert one.ball[1] == pytest.approx(radians(30.0), abs=0.1) and one.ball_load > 20.0
    assert [mount.facing for mount in rotor_of(one).mounts] == ["+z", "-z", "+z"]
    load = [float(value) for value in linearise(rotor_of(one), 15000.0).loads[2]]
    assert load[2] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(
    ("text", "old", "new", "words"),
    [
        (MOTOR, "position_mm = 330.0", "position_mm = 30.0", ("fan end.position_mm = 30.0", "place are a pair")),
        (MOTOR, "position_mm = 330.0", "position_mm = 430.0", ("fan end.position_mm = 430", "0 and 360 mm")),
        (MOTOR, "position_mm = 330.0\n", "", ("support.fan end.position_mm = None", "given, with [shaft]")),
        (MOTOR, "position_mm = 180.0", "position_mm = 361.0", ("disc.position_mm = 361.0", "0 and 360 mm")),
        (MOTOR, "spring = 200.0", "spring = 200.0\noffset_um = 3.0", ("fan end.spring = 200.0", "cannot slide")),
        (
            MOTOR,
            "spring = 200.0",
            "spring = 200.0\nhousing_stiffness = 1e8\nhousing_mass = 1.0",
            ("fan end.spring = 200.0", "cannot slide"),
        ),
        (
            MOTOR,
            'bearing = "6306"',
            'bearing = "6306"\nspring = 100.0',
            ("support.fan end.spring = 200.0", "left out at one support"),
        ),
        (MOTOR, "speed_rpm", "radial_load = 9.0\nspeed_rpm", ("operation.radial_load = 9.0", "disc.radial_load")),
        (MOTOR, 'name = "fan end"', 'name = "drive end"', ("support.name = 'drive end'", "once")),
        (MOTOR, "diameter_mm = 35.0", "bore_mm = 20.0", ("shaft.diameter_mm = None", "given")),
        (MOTOR, "diameter_mm = 35.0", "diameter_mm = 35.0\nbore_mm = 40.0", ("shaft.bore_mm = 40.0", "below")),
        (MOTOR, "diameter_mm = 35.0", "diameter_mm = 0.035", ("shaft.diameter_mm = 0.035", "in m? then 35 mm")),
        (MOTOR, "diameter_mm = 110.0", "diameter_mm = 30.0", ("disc.diameter_mm = 30.0", "above 35 mm")),
        (MOTOR, "spring = 200.0", "preload = 200.0", ("fan end.preload = 200.0", "is support.fan end.spring")),
        (MOTOR, "spring = 200.0", "spring = 2e5", ("support.fan end.spring = 200000.0", "a ball carries at most")),
        (MOTOR, MOTOR[MOTOR.rindex("[[support]]") :], "", ("number of [[support]] = 1", "pair = ")),
        (MOTOR, "diameter_mm = 35.0", "diameter_mm = 35.0\nstiffness = 1e8", ("shaft.diameter_mm = 35", "left")),
        (MOTOR, "width_mm = 120.0", "mass = 3.0", ("disc.diameter_mm = 110.0", "left out where disc.mass")),
        (MOTOR, "width_mm = 120.0", "", ("disc.width_mm = None", "given")),
        (MOTOR, 'bearing = "6206"', 'bearing = "6260"', ("support.fan end.bearing = '6260'", "nearest")),
        (MOTOR, 'bearing = "6206"', 'bearing = "6206"\nballs = 7', ("support.fan end.balls = 7", "'6206' has 9")),
        (MOTOR, "[oil]", '[contact]\nsupport = "left"\n[oil]', ("contact.support = 'left'", "drive end, fan end")),
        (MOTOR, "[oil]", "[full_films]\n[oil]", ("contact = None", "given, with [full_films]")),
        (MOTOR, "[shaft]\nlength_mm = 360.0\ndiameter_mm = 35.0\n", "", ("shaft = None", "given")),
        (MOTOR, "width_mm", "axial_load = 1e6\nwidth_mm", ("support.drive end = ", "contact angles stay below")),
        (MOTOR, "width_mm", "radial_load = 8e5\nwidth_mm", ("end = '", "static rating is")),
        (ANGULAR, "axial_load = 400.0\n", "", ("operation.axial_load = None", "7205 A is an angular contact")),
        (ANGULAR, "400.0", "1e6", ("operation.radial_load, operation.axial_load = (200.0, 1000000.0)",)),
        (ANGULAR, "[[support]]", "[[support]]\nfacing = '-z'", ("support.facing = '-z'", "without [shaft]")),
        (ANGULAR, "[[support]]", "[[support]]\npreload = 9.0", ("support.preload = 9.0", "without support.pair")),
        (ANGULAR, "[[support]]", "[[support]]\ncontact_angle_deg = 0.44", ("angle_deg", "in rad? then 25")),
        (ANGULAR, "[[support]]", "[[support]]\nrace_control = 'both'", ("support.race_control", "harris")),
        (ANGULAR, "[[support]]", "[[support]]\nclearance = 30.0", ("support.clearance = 30", "beside a contact")),
        (ANGULAR, "axial_load", "moment_x = 1.0\ntilt_y_mrad = 0.1\naxial_load", ("tilt_y_mrad = 0.1", "moments")),
        (ANGULAR, "axial_load", "tilt_x_mrad = 200.0\naxial_load", ("tilt_x_mrad = 200", "-100 and 100 mrad")),
        (PAIR, '"back-to-back"', '"tandem"', ("support.preload = 200", "do not press each")),
        (ALONE, "conformity = 0.52", "race_control = 'inner'", ("support.race_control", "no contact angles")),
        (MOTOR, '"6206"', '"6206"\nturning = "outer"', ("fan end.turning = 'outer'", "stands still")),
        (ALONE, "conformity = 0.52", "turning = 'both'", ("support.turning = 'both'", "outer")),
        (ALONE, "radial_load = 20.0\n", "", ("operation.radial_load = None", "N")),
    ],
)  # fmt: skip
def test_mistakes(refused, study, tmp_path, text, old, new, words):
    for command in ("validate", "run"):
        refused(words, command, study(text, (old, new)), "-o", tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_load_ratings_of_the_maker(study):
    """Of one support: its life has them, and its tile says that they are given."""
    given = 'bearing = "6306"\ndynamic_rating = 29.6e3\nstatic_rating = 16e3'
    plain, rated = (
        answer_of(load_study(study(MOTOR, ('bearing = "6306"', text)))) for text in ('bearing = "6306"', given)
    )
    lives = [[one.l10r for one in state.rating_life] for state in (plain, rated)]
    assert lives[1][0] == pytest.approx(lives[0][0] * (29.6 / 26.7) ** 3, rel=1e-12)
    assert lives[1][1] == lives[0][1]
    ratings = rated.rating_life[0].ratings
    assert (ratings.static, ratings.dynamic_source, ratings.static_source) == (16e3, "given", "given")
    alone = study(ALONE, ("balls = 9", "dynamic_rating = 14.8e3\nballs = 9"))
    (tile,) = (one for one in answer_of(load_study(alone)).tiles() if one.name == "rating life")
    assert tile.note.endswith("C 14.8 kN given")


FITS = 'bearing = "6306"\nshaft_fit = "k5"\nhousing_fit = "H6"\ninner_temperature = 75\nouter_temperature = 60'


def test_clearance_of_fits(study):
    """That of the mean deviations, warm and at the speed."""
    one = load_study(study(MOTOR, ('bearing = "6306"', FITS)))
    warm = {"inner": 75.0, "outer": 60.0}
    found = operating_clearance("6306", fit=("k5", "H6"), temperatures=warm, speed_rpm=15000.0)
    assert bearing_of(one, 0).clearance == pytest.approx(found.mean, rel=1e-5)
    assert clearance_of(one, 0).clearance == pytest.approx(found.clearance, rel=1e-12)
    assert clearance_of(one, 1) is None


def test_a_fit_of_one_seat(study):
    """The other seat takes nothing, as in Python."""
    for entry, fit in (('shaft_fit = "k5"', ("k5", None)), ('housing_fit = "N7"', (None, "N7"))):
        one = load_study(study(MOTOR, ('bearing = "6306"', f'bearing = "6306"\n{entry}')))
        found = operating_clearance("6306", fit=fit, speed_rpm=15000.0)
        assert clearance_of(one, 0).clearance.tolist() == found.clearance.tolist()


def test_a_class_of_a_fit_is_all_that_an_entry_takes(study):
    with pytest.raises(InputError, match="shaft_fit = 'k15': must be a class of ISO 286") as caught:
        clearance_of(load_study(study(MOTOR, ('bearing = "6306"', FITS.replace("k5", "k15")))), 0)
    assert "metres" not in str(caught.value)


def findings_of(one):
    """Findings of a study with its machine alone."""
    return Findings(one, answer_of(one), {}, None, {}, (), None, None, {}, {})


def findings_without_machine(one):
    """Findings of the entries of a study alone."""
    return Findings(one, "not asked for", {}, None, {}, (), None, None, {}, {})


def test_a_wheel_is_named(study):
    """The first line says which ring turns; an outer one that does leaves the shaft, with its fit, at rest."""
    wheel = study(ALONE, ("conformity = 0.52", 'turning = "outer"'))
    found = findings_of(load_study(wheel))
    assert "rev/min of the outer ring, " in headline(found).splitlines()[0]
    (support,) = found.machine.supports
    assert support.bearing.turning == "outer"


def test_fits_that_preload_or_leave_a_ring_loose(study):
    """Numbers are for the mean clearance: a line has the others, the tile the life at both ends."""
    fits = FITS.replace("6306", "6205").replace("75", "105")
    found = findings_of(load_study(study(ALONE, (ALONE[ALONE.index("balls = 9") :], fits))))
    (own,) = found.clearances.values()
    assert own.clearance[0] < own.probable[0] < 0.0 and own.inner_pressed[2] < 0.0
    state = found.machine.supports[0]
    lives = []
    for end in own.probable:
        there = replace(state.bearing, clearance=float(end)).equilibrium((0.0, -20.0), speed_rpm=3000.0)
        lives.append(there.life().l10rh)
    ends = [one.l10rh for one in found.machine.lives_at_clearances]
    assert ends == pytest.approx(lives, rel=1e-12) and lives[0] < lives[1]
    apart, loose = limits(found)[-2:]
    for word in (f"{1e6 * own.clearance[0]:.3g} to", f"probably {1e6 * own.probable[0]:.3g} to", "the mean"):
        assert word in apart
    assert "loose on its shaft" in loose and apart in headline(found) and loose in headline(found)
    assert found.to_dict()["machine"]["life_at_clearances"]["least"]["l10rh"] == ends[0]
    (tile,) = (one for one in found.machine.tiles() if one.name == "rating life")
    least, most = (f"{1e6 * end:.3g} µm" for end in own.probable)
    assert f"h at the probable least clearance, {least}, and " in tile.note
    assert f"h at the probable largest, {most}" in tile.note


def test_the_loose_ring_of_a_wheel(study):
    """The outer ring turns relative to the load: it must not be loose in its housing; the inner one may be."""
    dimensions = ALONE[ALONE.index("balls = 9") :]
    said = []
    for shaft, housing in (("k5", "H7"), ("g6", "P7")):
        fits = f'bearing = "6204"\nturning = "outer"\nshaft_fit = "{shaft}"\nhousing_fit = "{housing}"'
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", OutsideValidityWarning)
            one = load_study(study(ALONE, (dimensions, fits)))
            said.append([text for text in clearances_apart(findings_without_machine(one)) if "loose" in text])
    ((wrong,), right) = said
    assert wrong.startswith("the outer ring of 6204 is loose in its housing in the loosest fit") and not right


@pytest.mark.parametrize(("housing", "holds"), [("H6", True), ("G6", False)])
def test_a_housing_that_holds_a_ring_on_a_spring(study, housing, holds):
    """The warm ring is pressed in the tightest fit, and does not slide; in a looser housing it does."""
    fits = FITS.replace("6306", "6206").replace("H6", housing) + "\nhousing_temperature = 50.0"
    found = findings_without_machine(load_study(study(MOTOR, ('bearing = "6206"', fits))))
    (own,) = found.clearances.values()
    lines = [text for text in limits(found) if "spring cannot move it" in text]
    assert bool(own.outer_pressed[0] > 0.0) is holds is bool(lines)
    size = f"by {1e6 * own.outer_pressed[0]:.3g} µm and {1e-6 * own.outer_pressure[0]:.3g} MPa"
    assert all("the outer ring of fan end 6206 in the tightest fit" in text and size in text for text in lines)
    fixed = load_study(study(MOTOR, ('bearing = "6206"', fits), ("spring = 200.0\n", "")))
    assert not any("spring cannot" in text for text in limits(findings_without_machine(fixed)))


@pytest.mark.parametrize(("wide", "said"), [("35.0", True), ("30.0", False)])
def test_a_fit_of_a_shaft_wider_than_the_bore(study, wide, said):
    """The fit is that of the bore: the shaft is turned down at its seat, and a line says so."""
    fits = FITS.replace("6306", "6206")
    one = load_study(study(MOTOR, ("diameter_mm = 35.0", f"diameter_mm = {wide}"), ('bearing = "6206"', fits)))
    lines = [text for text in clearances_apart(findings_without_machine(one)) if "bore" in text]
    text = "the fit of fan end 6206 is on a journal of 30 mm, its bore; the shaft of the model has 35 mm there"
    assert lines == [text][: int(said)]


def test_fits_with_play_left(study):
    fits = FITS.replace("6306", "6205").replace("75", "60").replace('"k5"', '"k5"\nclearance = "C4"')
    found = findings_of(load_study(study(ALONE, (ALONE[ALONE.index("balls = 9") :], fits))))
    (own,) = found.clearances.values()
    assert own.clearance[0] > 0.0 and own.inner_pressed[2] > 0.0 and found.machine.lives_at_clearances
    assert not any("fit" in text for text in limits(found))


def test_life_over_a_class_of_clearance(study):
    """Of a class without fits its limits; of a number none."""
    dimensions = ALONE[ALONE.index("balls = 9") :]
    by_class = answer_of(load_study(study(ALONE, (dimensions, 'bearing = "6205"\nclearance = "C3"'))))
    in_name = answer_of(load_study(study(ALONE, (dimensions, 'bearing = "6205/C3"'))))
    assert by_class.clearances == in_name.clearances == (clearance_limits("C3", 25e-3),)
    number = answer_of(load_study(study(ALONE, (dimensions, 'bearing = "6205"\nclearance = 20.5'))))
    assert number.clearances == (None,) and number.lives_at_clearances is None
    machine = answer_of(load_study(study(MOTOR)))
    least, largest = machine.lives_at_clearances
    assert len(least) == len(largest) == 2 and least.names == machine.rating_life.names
    assert least.l10rh != machine.rating_life.l10rh != largest.l10rh


def test_a_line_of_fits_names_all_bearings_that_it_is_of(study):
    changes = [
        ('bearing = "6206"', FITS.replace("6306", "6206")),
        ('bearing = "6306"', FITS.replace("6306", "6206")),
    ]
    found = findings_without_machine(load_study(study(MOTOR, *changes)))
    both = "drive end 6206 and fan end 6206"
    clearance, loose, *_ = clearances_apart(found)
    assert clearance.startswith(f"clearance in operation of {both} is ") and f"inner ring of {both} is" in loose


@pytest.mark.long
def test_a_response_from_the_speed_on_that_films_are_known_for(study):
    """At a fifteenth of the speed the ball load is beyond the atlas: the response begins above."""
    slow = ("speed_rpm = 15000.0", "speed_rpm = 750.0"), ("iso_vg = 32", "iso_vg = 100")
    machine = answer_of(load_study(study(MOTOR, *slow, ("unbalance", "radial_load = 900.0\nunbalance"))))
    assert machine.response is not None and machine.response.speed_rpm[0] > 50.0
    (line,) = (text for text in machine.failed if "response" in text)
    assert line.startswith(f"no response to unbalance below {machine.response.speed_rpm[0]:.5g} rev/min: load of ")
    assert " must be such that a ball carries at most" in line and "bearing 0" not in line
    assert machine.diagram.speed_rpm[0] >= machine.response.speed_rpm[0]


def test_temperatures_without_fits(study):
    one = load_study(study(MOTOR, ('bearing = "6306"', 'bearing = "6306"\ninner_temperature = 75')))
    found = operating_clearance("6306", temperatures={"inner": 75.0}, speed_rpm=15000.0)
    assert bearing_of(one, 0).clearance == pytest.approx(found.mean, rel=1e-5)
    assert not found.by_inner_fit.any() and clearance_of(one, 0).fits_in_words == "no fit"


def test_fits_of_angular_contact_bearings(study):
    """A pair is pressed by them, on a spring it is not; a bearing alone has the contact angle."""
    fits = 'bearing = "7205"\nshaft_fit = "k5"\nhousing_fit = "H6"'
    bearing = BallBearing.catalogue("7205")
    tight = operating_clearance(bearing, fit=("k5", "H6"), speed_rpm=6000.0)
    alone = load_study(study(ANGULAR, ('bearing = "7205"', fits)))
    assert bearing_of(alone, 0).contact_angle == pytest.approx(tight.of(bearing).contact_angle, rel=1e-5)
    one = load_study(study(PAIR, ('bearing = "7205"', fits)))
    pair = BearingSet.pair(bearing, preload=200.0, distance=0.04).mounted(tight)
    assert carrier_of(one, 0).offsets == pytest.approx(pair.offsets, rel=1e-5)
    found = findings_of(one)
    before, mounted = found.preloads["1"]
    assert before == 200.0 and mounted == pytest.approx(pair.preload, rel=1e-4) and mounted > 900.0
    assert any("press 7205 A with 94" in text for text in limits(found))
    sprung = load_study(study(PAIR, ('bearing = "7205"', fits), ("preload", "pair_spring")))
    assert carrier_of(sprung, 0).spring == 200.0
    assert findings_of(sprung).preloads["1"] == (200.0, pytest.approx(200.0, rel=1e-9))


def test_fits_of_angular_contact_bearings_under_a_shaft(study):
    """Opposite bearings press each other by the offsets of their fits."""
    fits = 'bearing = "7206"\nshaft_fit = "k5"\nhousing_fit = "H6"\noffset_um = 2.0'
    right = 'bearing = "7206"\noffset_um = 2.0'
    changes = [
        ('bearing = "6306"\nclearance = "CN"', fits),
        ('bearing = "6206"\nclearance = "CN"\nspring = 200.0', right),
    ]
    rotor = rotor_of(load_study(study(MOTOR, *changes)))
    bearing = BallBearing.catalogue("7206")
    tight = operating_clearance(bearing, fit=("k5", "H6"), speed_rpm=15000.0)
    offsets = [mount.offset for mount in rotor.bearings]
    assert offsets == pytest.approx([2e-6 + tight.offset(bearing), 2e-6], rel=1e-5)
    assert rotor.bearings[0].bearing.contact_angle == pytest.approx(tight.of(bearing).contact_angle, rel=1e-5)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            'shaft_fit = "k5"\n',
            "shaft_temperature = 60\n",
            ("shaft_temperature = 60", "without", "drive end.shaft_fit"),
        ),
        ('"k5"', '"H6"', ("support.drive end.shaft_fit = 'H6'", "shaft first")),
        ("= 75", "= 348", ("support.drive end.inner_temperature = 348", "in K")),
        ('shaft_fit = "k5"\nhousing_fit = "H6"\ninner', "shaft", ("shaft_temperature = 75", "left out without")),
        (
            '"6306"',
            '"NICE"',
            ("support.drive end.shaft_fit = 'k5'", "the bore of NICE is not known"),
        ),
        ('"k5"', '"k5"\ncontact_angle_deg = 15.0', ("support.drive end.clearance = ", "beside a contact angle")),
    ],
)
def test_mistakes_in_fits(refused, study, tmp_path, old, new, words):
    path = study(MOTOR, ('bearing = "6306"', FITS), (old, new))
    refused(words, "validate", path, "-o", tmp_path / "out")


@pytest.mark.long
def test_moments_and_tilts(study):
    held = load_study(study(ANGULAR, ("axial_load", "tilt_x_mrad = 0.1\naxial_load")))
    state = answer_of(held).supports[0].state
    assert state.displacement[3] == pytest.approx(1e-4)
    free = load_study(study(ANGULAR, ("axial_load", "moment_x = 0.2\naxial_load")))
    np.testing.assert_allclose(answer_of(free).supports[0].state.load, [0.0, -200.0, 400.0, 0.2, 0.0], atol=1e-8)


def test_init_of_an_angular_contact_bearing(call, refused, tmp_path):
    path = tmp_path / "s.toml"
    refused(("--axial = None", "7205 A is an angular contact bearing"), "init", path, "--bearing", "7205")
    assert call("init", path, "--bearing", "7205", "--axial", "400").code == 0
    assert load_study(path).ball[1] == pytest.approx(radians(30.0), abs=0.1)


def test_the_motor_of_the_examples_is_what_init_writes(call, tmp_path):
    """Its comment has the options: the same shaft, disc and bearings, named left and right."""
    example = EXAMPLES / "motor.toml"
    lines = [line.lstrip("# ").rstrip("\\ ") for line in example.read_text().splitlines() if "--" in line]
    _, _, name, *options = " ".join(lines).split()
    assert name == "motor.toml" and call("init", tmp_path / name, *options).code == 0
    own, made = (load_study(path).model_dump() for path in (example, tmp_path / name))
    for document in (own, made):
        document.pop("title")
        for support in document["support"]:
            support.pop("name")
    assert made == own


@pytest.mark.long
def test_a_run_of_a_machine(call, tmp_path):
    """The motor from its example alone: the numbers that a designer asks for, in the results."""
    assert call("run", EXAMPLES / "motor.toml", "-o", tmp_path / "out").code == 0
    found = json.loads((tmp_path / "out" / "results.json").read_text())
    machine = found["machine"]
    films = {support["name"]: support["h_min"] for support in machine["supports"]}
    assert films["drive end"] == pytest.approx(0.369e-6, rel=2e-3, abs=0.0)
    assert films["fan end"] == pytest.approx(0.3216e-6, rel=2e-3, abs=0.0)
    hz = [mode["hz"] for mode in machine["modes"]]
    assert hz[:5] == pytest.approx([161.2, 266.1, 266.6, 778.2, 961.4], rel=1e-3)
    speeds = [one["speed_rpm"] for one in machine["critical_speeds"]]
    assert speeds == pytest.approx([10363.0, 15926.0, 15958.0], rel=1e-3)
    assert machine["largest_response"]["size"] == pytest.approx(195e-6, rel=0.01, abs=0.0)
    assert machine["largest_response"]["speed_rpm"] == pytest.approx(16000.0)
    assert found["in_time"] is None and "fits" not in found and set(found["over_frequency"]) == set(films)
    assert (tmp_path / "out" / "report.html").stat().st_size > 10_000


@pytest.mark.long
def test_a_run_of_a_spindle(call, tmp_path):
    """A pair is two bearings of the answer, in its results and in the picture over frequency."""
    assert call("run", EXAMPLES / "spindle.toml", "-o", tmp_path / "out").code == 0
    found = json.loads((tmp_path / "out" / "results.json").read_text())
    names = [support["name"] for support in found["machine"]["supports"]]
    assert names == ["nose 1", "nose 2", "end"] == list(found["over_frequency"])
    assert found["no_machine"] is None and found["machine"]["modes"][0]["hz"] > 100.0
