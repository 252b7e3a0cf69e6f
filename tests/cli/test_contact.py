"""A bearing's contact in SI on the command line: the point that Python makes, answers in SI, slips in one line."""

import json
import re
from math import pi

import pytest

from ehlcontact import (
    Grid,
    Lubricant,
    OperatingPoint,
    ShearThinning,
    assumptions,
    impedance,
    read,
    solve_steady,
)
from ehlcontact.cli.contact import Contact
from ehlcontact.cli.study.schema import oil_grade
from ehlcontact.errors import InputError
from ehlcontact.hertz import most_loaded_ball
from ehlcontact.lubricant import Eyring
from ehlcontact.lubricant.oil import GRADES
from ehlcontact.transient.result import SimulationResult
from fmu.contact_spec import contact_spec
from reduced_models import Atlas, BallBearing
from reduced_models.fitting.records import ContactRecord

GIVEN = {"--bearing": "6205", "--oil": "ISO VG 68", "--temp": "60", "--speed-rpm": "3000", "--load": "100"}
COARSE = ("--n", "32")


def options(*without, **changes):
    """Options of the point, some left out or changed."""
    given = GIVEN | {f"--{name}": value for name, value in changes.items()}
    return [part for name, value in given.items() if name not in without for part in (name, value)]


def ball(race="inner", radial=100.0):
    bearing = BallBearing.catalogue("6205")
    return OperatingPoint.ball_bearing(
        Lubricant.iso_vg(68, temperature=60.0),
        ball_diameter=bearing.ball_diameter,
        pitch_diameter=bearing.pitch_diameter,
        conformity=bearing.conformity_inner,
        speed_rpm=3000.0,
        load=most_loaded_ball(radial, bearing.balls),
        race=race,
    )


@pytest.mark.parametrize("race", ["inner", "outer"])
def test_the_point_is_that_of_python(race):
    given = Contact(bearing="6205", oil="vg68", temp=60.0, speed_rpm=3000.0, load=100.0, race=race)
    assert given.in_si and given.point() == ball(race)
    assert Contact(bearing="6205", eta0=0.03, alpha=2e-8, speed_rpm=3000.0, load=100.0).lubricant() == Lubricant(
        0.03, 2e-8
    )


@pytest.mark.parametrize("text", ["ISO VG 68", "iso vg 68", " VG68", "ISO-VG-68", "isovg68", "68"])
def test_names_of_an_oil(text):
    assert oil_grade(text, "--oil") == 68


@pytest.mark.parametrize("text", ["ISO VG 70", "Mobil DTE 26", "", "68 cSt", "SAE 30", "-68"])
def test_other_oils_with_the_list_of_grades(text):
    with pytest.raises(InputError) as error:
        oil_grade(text, "--oil")
    assert all(str(grade) in str(error.value) for grade in GRADES) and "eta0 and alpha" in str(error.value)


def test_steady_answers_in_si(call, tmp_path):
    result = call("steady", *options(), *COARSE, "--json", "-", "--save", tmp_path / "r.h5")
    found, ours = json.loads(result.out), solve_steady(ball(), grid=Grid(n=32))
    assert ours.reservation and found["reservation"] == ours.reservation
    assert result.code == 0 and result.err == f"ehlcontact: warning: {ours.reservation}\n"
    assert found["h_central"] == ours.h_central and found["force"] == ours.force
    about = found["contact"]
    assert about["bearing"] == "6205" and about["race"] == "inner" and about["radial_load"] == 100.0
    assert about["ball_load"] == ball().load and about["oil"]["name"] == "ISO VG 68 at 60 °C"
    assert read(tmp_path / "r.h5").point == ball()
    table = call("steady", *options(), *COARSE, "--contact", "outer").out
    said = " ".join(table.split())  # a terminal of 80 columns folds
    for words in ("6205, outer race", "of 100 N: the most loaded ball", "ISO VG 68 at 60 °C", "GPa", "µm", "N mm"):
        assert words in said


def test_impedance_is_at_the_shafts_frequency_unless_another_is_given(call):
    said = json.loads(call("impedance", *options(), *COARSE, "--json", "-").out)
    ours = impedance(ball(), rpm=3000.0, grid=Grid(n=32))
    assert said["hz"] == pytest.approx([50.0]) and said["damping"] == pytest.approx(
        ours.damping.tolist(), rel=1e-9
    )
    table = call("impedance", *options(), *COARSE, "--hz", "100", "--hz", "1e3").out
    assert "100 Hz" in table and "1000 Hz" in table and "N/µm" in table and "N s/m" in table
    ours = ball()
    for name, value in (("Omega", 1.0), ("omega", 1.0 / ours.scales.time), ("rpm", 30.0 / pi / ours.scales.time)):
        found = json.loads(call("impedance", *options(), *COARSE, f"--{name}", value, "--json", "-").out)
        assert found["omega"] == pytest.approx([1.0 / ours.scales.time], rel=1e-12)


def test_element_is_in_si_and_its_damper_that_of_the_shaft(call, tmp_path):
    target = tmp_path / "e.json"
    assert call("element", *options(), "--model", "cubic", "--save", target).code == 0
    saved, ours = read(target), Atlas().element(ball(), "cubic", rpm=3000)
    assert saved.units == "SI" and saved.C1 == ours.C1
    said = "6205, inner race, most loaded ball of 100 N at 3000 rpm, ISO VG 68 at 60 °C"
    assert saved.source["contact"] == said and contact_spec(saved).description.endswith(f"; {said}")
    assert call("element", *options(), "--model", "cubic", "--hz", "5000", "--json", tmp_path / "j").code == 0
    assert (
        json.loads((tmp_path / "j").read_text())["parameters"]["C1"]
        == Atlas().element(ball(), "cubic", hz=5000).C1
    )
    assert "the shaft's own frequency" in " ".join(call("element", *options()).out.split())


def test_simulation_in_hz_and_its_element_in_si(call, refused, tmp_path):
    record, element = tmp_path / "r.h5", tmp_path / "e.json"
    motion = ("--harmonic-hz", "2e4", "--until", "1e-4", "--dt", str(0.3 * ball().scales.time))
    result = call("simulate", *options(), *COARSE, *motion, "--save", record)
    assert result.code == 0 and "20000 Hz" in result.out and "0.1 ms" in result.out
    stored = read(record)
    assert isinstance(stored, SimulationResult)
    assert stored.hz == pytest.approx(2e4) and stored.t[-1] == pytest.approx(1e-4)
    assert call("fit", record, "--model", "linear", "--save", element).code == 0
    assert read(element).units == "SI"


def test_bearing_takes_the_same_oil(call):
    at = ("bearing", "6205", "--load", "100", "--speed-rpm", "3000", "--temp", "60", "--oil")
    short, long = call(*at, "68"), call(*at, "ISO VG 68")
    assert long.code == 0 and long.out == short.out


def test_lambda_of_a_given_roughness(call, refused, point):
    """--rq on every command that has a film."""
    at = options()
    found = json.loads(call("element", *at, "--rq", "0.1", "--json", "-").out)
    answer = Atlas().at(ball())
    assert found["lambda_ratio"] == pytest.approx(answer.h_min / 1e-7, rel=1e-9)
    assert "lambda" in call("element", *at, "--rq", "0.1").out
    assert "lambda_ratio" not in json.loads(call("element", *at, "--json", "-").out)
    coarse = (*options(load="20"), *COARSE, "--rq", "0.1", "--json", "-")
    film = json.loads(call("steady", *coarse).out)
    assert film["lambda_ratio"] == pytest.approx(film["h_min"] / 1e-7)
    run = json.loads(call("simulate", "--harmonic", "3", "--until", "4e-6", "--dt", "2e-6", *coarse).out)
    assert 0.5 * film["lambda_ratio"] < run["lambda_ratio"] < 1.5 * film["lambda_ratio"]
    for command, rest in (("steady", ()), ("element", ()), ("simulate", ("--free", "3"))):
        refused(("--rq = 0.1", "no unit of length"), command, *point, *rest, "--rq", "0.1")
        refused(("--rq = 1e-07", "between 0.001 and 100 um"), command, *at, *rest, "--rq", "1e-7")


def test_method_and_tolerance(call, refused, point):
    coarse = (*point, "--n", "32", "--json", "-")
    usual = json.loads(call("steady", *coarse).out)
    newton = json.loads(call("steady", *coarse, "--method", "newton", "--tol", "1e-8").out)
    cycles = json.loads(call("steady", *coarse, "--method", "multigrid", "--tol", "1e-8").out)["cycles"]
    assert newton["cycles"] < cycles > usual["cycles"]
    assert newton["approach"] == pytest.approx(usual["approach"], abs=1e-4)
    refused(("--method = 'magic'", "newton"), "steady", *point, "--method", "magic")
    refused(("--tol = -1.0", "> 0"), "steady", *point, "--tol", "-1")
    run = ("simulate", *coarse, "--harmonic", "3", "--until", "0.4", "--dt", "0.1")
    tight, short = (json.loads(call(*run, *more).out) for more in (("--tol", "1e-6"), ()))
    assert tight["force"] != short["force"] and tight["force"] == pytest.approx(short["force"], rel=1e-2)
    refused(("--tol = 0.0", "> 0"), *run[:-4], "--tol", "0")


def test_assumptions_that_do_not_hold_stand_in_every_answer(call):
    """With the oil of the command, in the table and in JSON; the roughness is judged where it is given."""
    fast = options(**{"speed-rpm": "25000", "load": "1000"})
    point = Contact(bearing="6205", oil="68", temp=60.0, speed_rpm=25000.0, load=1000.0).point()
    motion = ("--harmonic-hz", "20000", "--until", "2e-6", "--dt", "1e-6")
    wanted = f"{100.0 * (1.0 - assumptions(point)['isothermal'].value):.0f} % thinner"
    for command, more in (
        ("steady", COARSE),
        ("impedance", COARSE),
        ("element", ()),
        ("simulate", (*COARSE, *motion)),
    ):
        result = call(command, *fast, *more, "--json", "-")
        assert f"film {wanted}" in json.loads(result.out)["outside_assumptions"], command
        shown = " ".join(call(command, *fast, *more).out.split())
        assert "NOT isothermal shear heats the inlet" in shown and "thinner" in shown
    assert "NOT smooth" in call("element", *fast, "--rq", "0.5").out
    assert "NOT" not in call("element", *options()).out


DISC = ("--ball-diameter", "19.05", "--flat", "glass", "--entrainment", "0.1", "--load", "20")
DISC_OIL = ("--eta0", "0.2", "--alpha", "2.5e-8")


def on_glass():
    at = {"ball_diameter": 1e-3 * 19.05, "entrainment_speed": 0.1, "load": 20.0}
    return OperatingPoint.ball_on_flat(Lubricant(0.2, 2.5e-8), **at, e2=7e10, nu2=0.21)


def test_a_ball_on_a_disc(call):
    found = json.loads(call("steady", *DISC, *DISC_OIL, *COARSE, "--json", "-").out)
    assert found["h_central"] == solve_steady(on_glass(), grid=Grid(n=32)).h_central
    assert found["contact"]["flat"] == "glass" and found["contact"]["entrainment_speed"] == 0.1
    assert found["contact"]["ball_diameter"] == pytest.approx(19.05e-3) and "bearing" not in found["contact"]
    said = " ".join(call("element", *DISC, *DISC_OIL).out.split())
    assert "steel ball of 19.05 mm on" in said and "0.1 m/s" in said and "shaft" not in said
    made = json.loads(call("element", *DISC, *DISC_OIL, "--model", "cubic", "--hz", "100", "--json", "-").out)
    assert made["parameters"]["C1"] == Atlas().element(on_glass(), "cubic", hz=100).C1
    assert made["source"]["contact"].startswith("steel ball of 19.05 mm on glass, 20 N, entrainment 0.1 m/s")


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ((*DISC, *DISC_OIL, "--bearing", "6205"), ("--bearing = '6205'", "of no bearing")),
        ((*DISC, *DISC_OIL, "--M", "200"), ("--M = 200.0", "left out where --ball-diameter is given")),
        ((*DISC[:4], *DISC[6:], *DISC_OIL), ("--entrainment", "given", "m/s")),
        ((*DISC[:-2], *DISC_OIL), ("--load", "given")),
        ((*DISC,), ("--oil", "given")),
        ((*DISC, "--flat", "wood"), ("--flat = 'wood'", "steel, glass")),
        (("--ball-diameter", "0.019", *DISC[2:], *DISC_OIL), ("--ball-diameter = 0.019", "in m? then 19 mm")),
    ],
)
def test_slips_about_a_ball_on_a_disc(refused, given, words):
    refused(words, "steady", *given)


def test_a_ball_on_a_disc_has_no_shaft(refused):
    refused(("--hz", "given", "no shaft"), "impedance", *DISC, *DISC_OIL)


@pytest.mark.parametrize("grade", ["68", "320"])
def test_rows_of_an_element_are_the_answers_of_the_atlas_with_their_bars(call, grade):
    """Each row by its name, for the oil that was given."""
    contact = Contact(bearing="6205", oil=grade, temp=60.0, speed_rpm=3000.0, load=100.0)
    answer = Atlas().at(contact.point())
    si, shaft = answer, answer.impedance(rpm=3000.0)
    shown = call("element", *options(oil=grade)).out
    rows, name = {}, ""
    for line in shown.splitlines()[1:]:
        name = line[:24].strip() or name
        rows[name] = f"{rows.get(name, '')} {' '.join(line[24:].split())}".strip()
    wanted = {
        "mutual approach": (si.approach * 1e6, si.error_bars["approach"] * 1e6),
        "film in the centre": (si.h_central * 1e6, si.error_bars["h_central"] * 1e6),
        "smallest film": (si.h_min * 1e6, si.error_bars["h_min"] * 1e6),
        "static tangent": (si.stiffness[0] * 1e-6, si.error_bars["stiffness"][0] * 1e-6),
        "C at 50 Hz": (shaft.damping[0], shaft.error_bars["damping"][0]),
    }
    for start, (value, bar) in wanted.items():
        found = next(text for name, text in rows.items() if start.startswith(name) or name.startswith(start))
        numbers = [float(text) for text in re.findall(r"-?\d+\.?\d*(?:e[-+]?\d+)?", found.partition("±")[0])]
        assert numbers[0] == pytest.approx(value, rel=6e-4), (start, found)
        told = float(re.search(r"± (\d\S*)", found)[1])
        assert told == pytest.approx(bar, rel=0.5) and told == float(f"{bar:.1g}"), (start, found)


@pytest.mark.long
def test_a_layer_of_oil(call, refused):
    """`--layer` in um, or over the flooded film; the front of the full film is in the table."""
    point = "--M", "20", "--L", "10", "--kappa", "1", "--n", "32"
    flooded, starved = (
        json.loads(call("steady", *point, *given, "--json", "-").out) for given in ((), ("--layer-ratio", "0.5"))
    )
    assert 0.45 < starved["h_central"] / flooded["h_central"] < 0.5
    assert starved["supply"] == {"over_flooded": 0.5}
    shown = call("steady", *options(), *COARSE, "--layer", "0.2").out
    assert re.search(r"layer of oil +0\.2 µm +full from x/a = -1", shown)
    full, short = (
        json.loads(call("impedance", *point, *given, "--Omega", "1", "--json", "-").out)["damping"][0]
        for given in ((), ("--layer-ratio", "0.5"))
    )
    assert short < 0.5 * full
    moved = "--harmonic", "2", "--amplitude", "0.3", "--until", "0.5", "--dt", "0.1"
    flooded, starved = (
        json.loads(call("simulate", *point, *moved, *given, "--json", "-").out)
        for given in ((), ("--layer-ratio", "0.5"))
    )
    assert "supply" not in flooded
    assert starved["supply"] == {"over_flooded": 0.5}
    assert max(starved["h_central"]) < 0.6 * min(flooded["h_central"])
    shown = call("simulate", *point, *moved, "--layer-ratio", "0.5").out
    assert re.search(r"layer of oil +0\.2\d+ of the dry approach +0\.\d+ to 0\.\d+ of the dry", shown)
    refused(("--layer = 1.0", "--layer-ratio instead"), "steady", *point, "--layer", "1")
    refused(("--layer = 2e-07", "in m? then 0.2 um"), "steady", *options(), "--layer", "2e-7")
    refused(
        ("--layer = 0.2", "without --layer-ratio"), "steady", *options(), "--layer", "0.2", "--layer-ratio", "1"
    )


def test_asperities(call, refused):
    """`--asperities` with `--rq`: their share of the load, and the film that they lift."""
    smooth, rough = (
        json.loads(call("steady", *options(), *COARSE, "--rq", "0.2", *given, "--json", "-").out)
        for given in ((), ("--asperities",))
    )
    assert "asperities" not in smooth and rough["h_central"] > smooth["h_central"]
    assert 0.0 < rough["asperities"]["load_share"] < 0.1
    shown = call("steady", *options(), *COARSE, "--rq", "0.2", "--asperities").out
    assert re.search(r"load on asperities +\d\.\d+ % +their central film is 1\.0", shown)
    refused(("--asperities = True", "with --rq above 0"), "steady", *options(), "--asperities")
    refused(
        ("--asperities: no option of `impedance`", "`ehlcontact steady` has"),
        "impedance",
        *options(),
        "--asperities",
    )


@pytest.mark.long
def test_heat(call, refused):
    """`--thermal`, beside the published formulas; what it needs, and what it does not go with."""
    cold, warm = (
        json.loads(call("steady", *options(), *COARSE, *given, "--json", "-").out)
        for given in ((), ("--thermal", "--slide-roll", "0.1"))
    )
    assert "temperature" not in cold
    assert warm["h_central"] < cold["h_central"]
    assert warm["temperature"]["inputs"]["slide_roll"] == 0.1
    shown = call("steady", *options(), *COARSE, "--thermal").out
    assert re.search(r"film by heat +0\.9\d+ +of the isothermal film; 0\.9\d+ by Gupta", shown)
    starved = call("steady", *options(), *COARSE, "--thermal", "--layer-ratio", "0.8").out
    assert re.search(r"film by heat +0\.9\d+ +of the isothermal film;.*Sheu;\s+flooded", starved, re.S)
    both = ("--thermal", "--layer-ratio", "1")
    moved = call("simulate", *options(), *COARSE, *both, "--free", "5", "--until", "1e-5").out
    assert re.search(r"warmest oil +\d.*K +mean over the film", moved)
    assert "NOT isothermal" not in moved
    for bad in ("2", "nan", "-0.5"):
        words = f"--slide-roll = {float(bad)}", "between 0 and 1"
        refused(words, "steady", *options(), "--thermal", "--slide-roll", bad)
    refused(("--thermal = True", "no metres"), "steady", "--M", "20", "--L", "10", "--kappa", "1", "--thermal")
    shaken = json.loads(call("impedance", *options(), *COARSE, "--thermal", "--hz", "10", "--json", "-").out)
    assert shaken["film"]["temperature"]["film_share"] == pytest.approx(
        warm["temperature"]["film_share"], abs=0.02
    )
    assert "film by heat" in call("impedance", *options(), *COARSE, "--thermal", "--hz", "10").out
    refused(("--thermal: no option of `element`", "`ehlcontact steady` has"), "element", *options(), "--thermal")


def test_traction(call, refused):
    """`--slide-roll`: traction by Eyring's stress, or a limiting one; what it refuses."""

    def answer(*given):
        return json.loads(call("steady", *options(), *COARSE, *given, "--json", "-").out)

    rolling, sliding = answer(), answer("--slide-roll", "0.1")
    found = sliding.pop("traction")
    assert "traction" not in rolling
    assert sliding["h_central"] == rolling["h_central"]  # isothermal: sliding does nothing else
    assert found["law"] == {"law": "Eyring", "stress": 5e6}
    assert found["limit"] is None
    force = found["coefficient"][0] * sliding["force"]
    assert found["force"][0] == pytest.approx(force)
    limited = answer("--slide-roll", "2", "--limiting-shear", "0.04")["traction"]
    assert 0.03 < limited["coefficient"][0] < limited["limit"] == pytest.approx(0.04, rel=1e-3)
    shown = call("steady", *options(), *COARSE, "--slide-roll", "0.1", "--eyring-mpa", "8").out
    assert re.search(r"traction +0\.0\d+ +over the load, at a slide-to-roll", shown)
    assert float(re.search(r"traction +(0\.\d+)", shown)[1]) > found["coefficient"][0]
    assert re.search(r"power of sliding +0\.\d+ W", shown)

    def bad(words, *given):
        refused(words, "steady", *options(), *given)

    bad(("--slide-roll = -0.1", "between 0 and 2"), "--slide-roll", "-0.1")
    bad(("--slide-roll = 5.0", "between 0 and 2"), "--slide-roll", "5")
    bad(("--slide-roll = nan", "between 0 and 2"), "--slide-roll", "nan")
    bad(("--eyring-mpa = 0.0", "between 0.1 and 1000"), "--slide-roll", "0.1", "--eyring-mpa", "0")
    bad(("--eyring-mpa = 5.0", "without --slide-roll"), "--eyring-mpa", "5")
    bad(("--limiting-shear = -1.0", "between 0.001 and 0.5"), "--slide-roll", "0.1", "--limiting-shear", "-1")
    both = ("--limiting-shear", "0.05", "--eyring-mpa", "5")
    bad(("--eyring-mpa = 5.0", "one traction law"), "--slide-roll", "0.1", *both)
    bad(("--limiting-shear = 0.05", "--thermal"), "--thermal", "--slide-roll", "0.1", *both[:2])
    thin = answer("--slide-roll", "1", "--thinning")
    assert 0.9 < thin["thinned_share"] < 1.0
    assert thin["traction"]["coefficient"][0] > 0.01
    bad(("--thinning = True", "with --slide-roll"), "--thinning")
    bad(("--limiting-shear = 0.05", "with --thinning"), "--slide-roll", "0.1", "--thinning", *both[:2])
    bad(("--slide-roll = 1.5", "between 0 and 1"), "--slide-roll", "1.5", "--thinning", "--thermal")
    dimensionless = ("--M", "20", "--L", "10", "--kappa", "1", "--slide-roll", "0.1")
    refused(("--slide-roll = 0.1", "no pascals"), "steady", *dimensionless)
    for command in (("impedance", "--hz", "50"), ("simulate", "--harmonic", "1")):
        refused(
            ("--slide-roll = 0.1", "given with --thermal or --thinning"),
            *command,
            *options(),
            "--slide-roll",
            "0.1",
        )
        refused(("--thinning = True", "with --slide-roll"), *command, *options(), "--thinning")
    refused(("--traction: no option of `impedance`", "has --slide-roll"), "impedance", *options(), "--traction")


@pytest.mark.long
def test_vibrations_and_runs_are_thinned_by_sliding(call, tmp_path):
    thin = ("--slide-roll", "0.5", "--thinning")
    rolling, sliding = (
        json.loads(call("impedance", *options(), *COARSE, *given, "--hz", "10", "--json", "-").out)
        for given in ((), thin)
    )
    under = ShearThinning(0.5, Eyring(5e6))
    expected = impedance(ball(), hz=10.0, grid=Grid(n=32), sliding=under)
    assert sliding["damping"] == expected.damping.tolist() != rolling["damping"]
    assert sliding["film"]["sliding"] == under.to_dict()
    assert re.search(r"film by sliding +0\.9\d+", call("impedance", *options(), *COARSE, *thin, "--hz", "10").out)
    kept = tmp_path / "run.h5"
    shown = call("simulate", *options(), *COARSE, *thin, "--free", "5", "--until", "1e-5", "--save", str(kept)).out
    assert re.search(r"slide-to-roll ratio +0\.5 +thins the film by the law of\s+Eyring", shown)
    run = read(kept)
    assert run.sliding == under and run.conditions.sliding == under and "thinned by sliding (0.5)" in repr(run)
    record = ContactRecord.from_result(run)
    assert record.conditions == {"sliding": under.to_dict()} and "with sliding" in repr(record)
