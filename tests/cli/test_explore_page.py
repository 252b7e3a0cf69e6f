"""The page of ``ehlcontact explore`` in a browser: what it shows and refuses, its address, its command."""

import html
import json
import re
from dataclasses import asdict

import numpy as np
import pytest
from browsers import dom

from ehlcontact import Lubricant
from reduced_models import Atlas, BallBearing
from reduced_models.bearing.sliding import USUAL_LAW, bearing_friction
from reduced_models.rotor.support_state import ABOVE_MEASURED

LARGEST = 3e6  # bytes
WIDTHS = (420, *(pytest.param(width, marks=pytest.mark.long) for width in (768, 1280)))
OWN = "bearing=own&balls=8&ball_diameter=7.94&pitch_diameter=39.04&conformity_inner=0.52&conformity_outer=0.53"


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    from ehlcontact.cli.explorer import write_explorer

    return write_explorer(tmp_path_factory.mktemp("page") / "page.html")


@pytest.fixture
def seen(page, tmp_path):
    """``seen(asked, address, width)``: what an expression is worth on the page; no word in its console."""

    def run(asked, address="", width=None):
        tell = '<pre id="told"></pre><script>field("told").textContent = told;</script>'
        file = tmp_path / "asked.html"
        text = page.read_text(encoding="utf-8")
        script = f"<script>const told = JSON.stringify((() => {{ {asked} }})());</script>"
        file.write_text(text.replace("</body>", f"{script}{tell}</body>"), encoding="utf-8")
        if width is not None:  # no window of a browser is as narrow as a telephone
            file = framed(file, width)
        out, said = dom(file, address)
        assert "CONSOLE" not in said, said[-2000:]
        return json.loads(html.unescape(re.search(r'<pre id="told">(.*)</pre>', out, flags=re.S)[1]))

    return run


def framed(file, width):
    """A file that has another one in a frame of so many pixels, and takes over what it told."""
    frame = file.with_name("framed.html")
    inside = html.escape(file.read_text(encoding="utf-8"))
    take = "document.getElementById('told').textContent = this.contentDocument.getElementById('told').textContent"
    style = f'style="border: 0; width: {width}px; height: 4000px"'
    frame.write_text(
        f'<pre id="told"></pre><iframe {style} onload="{take}" srcdoc="{inside}"></iframe>', encoding="utf-8"
    )
    return frame


TEXTS = """return { refused: !field("refusal").hidden && field("refusal").textContent, address: location.hash,
  python: field("python").textContent, said: !field("address").hidden && field("address").textContent,
  tiles: [...document.querySelectorAll(".tile")].map(one => [...one.children].map(part => part.textContent)),
  invalid: [...document.querySelectorAll("[aria-invalid]")].map(input => input.id),
  pictures: document.querySelectorAll("#results svg[role=img]").length,
  shown: !field("results").hidden, hz: field("at").textContent, defects: field("defects").textContent };"""


def test_it_stands_alone(page):
    """Nothing is fetched: no address of a network, no other file."""
    text = page.read_text(encoding="utf-8")
    assert page.stat().st_size < LARGEST
    assert "://" not in text and "@import" not in text and "fetch(" not in text
    assert re.findall(r"<(?:link|img|iframe|script [^>]*src)", text) == []


@pytest.mark.parametrize("width", WIDTHS)
def test_nothing_sticks_out(seen, width):
    body = """for (const one of document.querySelectorAll("details")) one.open = true;
    const texts = [...document.querySelectorAll("#results svg text")];
    const grown = ({ a, b }) => Math.hypot(a, b), within = ({ left, right }) => left >= 0 && right <= innerWidth;
    const size = text => parseFloat(getComputedStyle(text).fontSize) * grown(text.getScreenCTM());
    const out = text => !within(text.getBoundingClientRect());
    return { width: innerWidth, needed: document.documentElement.scrollWidth, texts: texts.length,
      smallest: Math.min(...texts.map(size)), out: texts.filter(out).map(text => text.textContent) };"""
    found = seen(body, width=width)
    assert found["width"] == width and found["needed"] <= width
    assert found["texts"] > 40 and found["out"] == []
    assert found["smallest"] > 9.0  # px


@pytest.mark.parametrize(("width", "first"), [(420, "tiles"), (1280, "speed_rpm")])
def test_tiles_come_first_on_a_phone(seen, width, first):
    body = """const top = id => field(id).getBoundingClientRect().top;
    return { tiles: top("tiles"), speed_rpm: top("speed_rpm"), rest: top("rq") };"""
    found = seen(body, width=width)
    assert min(found, key=found.get) == first and max(found, key=found.get) == "rest"


def numbers(text):
    """All numbers of a text of the page, groups of three digits together."""
    return [float(word.replace("\u202f", "")) for word in re.findall(r"-?\d[\d.\u202f]*(?:e-?\d+)?", text)]


def test_inputs_after_a_question_mark(seen):
    asked = "bearing=6206&clearance_class=C3&grade=32"
    found, known = seen(TEXTS, f"?{asked}"), seen(TEXTS, f"#{asked}")
    assert '"6206"' in found["python"] and found["tiles"] == known["tiles"] and found["said"] is False


def test_what_it_shows_is_what_python_answers(seen):
    address = "#bearing=6206&clearance_class=C3&grade=32&temperature=80&speed_rpm=15000&load=59&preload=200&rq=0.1"
    found = seen(TEXTS, address)
    assert found["refused"] is False and found["said"] is False and found["shown"] and found["pictures"] == 5
    state = eval(found["python"], {"BallBearing": BallBearing, "Lubricant": Lubricant})
    bearing = BallBearing.catalogue(
        "6206", oil=Lubricant.iso_vg(32, temperature=80.0), rq_race=1e-7, clearance="C3"
    )
    mine = bearing.equilibrium((0, -59, 200), speed_rpm=15000)
    assert state.to_dict() == mine.to_dict()
    at = bearing.coefficients((0, -59, 200), speed_rpm=15000, rpm=15000)
    friction = bearing_friction(bearing, (0, -59, 200), speed_rpm=15000, law=USUAL_LAW)
    inner = bearing.race("inner").at_angle(bearing.pitch_diameter, mine.contact_angles[0, 0], 1.0)
    hertz = inner.point(mine.force[0, 0], 1.0).moes.p_hertz * 1e-9
    K, C = np.diagonal(at.stiffness[0]) * 1e-6, np.diagonal(at.damping[0])
    skf, hz = 1e3 * mine.skf_torque, asdict(mine.orders.at(15000.0))
    life = mine.life()
    degrees = np.degrees(np.abs(mine.contact_angles[mine.heaviest]))
    told = [
        [mine.h_min.min() * 1e6, mine.lambda_ratio.min(), 0.0],
        [mine.force.max(axis=0)[0], hertz, mine.loaded, 9, *degrees],
        [250.0, K[1], C[1], K[0], C[0], K[2], C[2]],
        [skf, 1e-3 * skf * 500.0 * np.pi, 1e3 * friction.rolling, 1e3 * friction.sliding],
        [life.l10rh, 90.0, life.l10r, life.viscosity_ratio, 1.0, life.film_ratio, life.pressure_safety, 19.5],
        [hz["bpfo"], hz["bpfi"], hz["ftf"], hz["bsf"]],
    ]
    for values, tile in zip(told, found["tiles"], strict=True):
        assert numbers(" ".join(tile)) == pytest.approx(values, rel=6e-3, abs=0.0), tile
    for name, order in asdict(mine.orders).items():
        name = name.removesuffix("_order")
        assert f"{hz[name]:.4g}{order:.5g}" in found["defects"] and name.upper() in found["defects"]


@pytest.mark.long
def test_slip_of_the_cage(seen):
    found = seen(TEXTS, "#axial_load=60&load=500&slip=0.5&temperature=50")
    bearing = BallBearing.catalogue("6205", clearance="CN", oil=Lubricant.iso_vg(68, temperature=50.0))
    bpfo = bearing.orders_under(500.0, axial=60.0, speed_rpm=3000.0, slip=0.005).bpfo_order
    assert "with 0.5 % slip of the cage" in found["defects"] and f"{bpfo:.5g}" in found["defects"]
    found = seen(TEXTS, "#axial_load=60&slip=100")
    assert "slip" in found["invalid"] and "below 100 %" in found["refused"]


@pytest.mark.long
def test_an_angular_contact_bearing_needs_axial_load(seen):
    found = seen(TEXTS, "#bearing=7206 C&load=100")
    assert found["invalid"] == ["axial_load"] and "in one direction" in found["refused"]
    found = seen(TEXTS, "#bearing=7206 C&load=100&preload=250")
    state = eval(found["python"], {"BallBearing": BallBearing, "Lubricant": Lubricant})
    assert found["refused"] is False and "of 12 balls" in found["tiles"][1][2]
    assert numbers(found["tiles"][1][1])[0] == pytest.approx(state.force[:, 0].max(), rel=6e-3)


CLEARANCE = """return { class: field("clearance_class").value, off: field("clearance_class").disabled,
  clearance: field("clearance").value, read: field("read").textContent, python: field("python").textContent,
  refused: !field("refusal").hidden && field("refusal").textContent };"""


def test_a_name_as_it_is_printed_on_the_bearing(seen):
    """Its class is that of the clearance; seals are told; bearings with a contact angle have an empty entry."""
    steps = ["6205-2RS/C3", "7206 C", "6206", "6205/C1", "NU205"]
    body = f"""const told = () => {{ {CLEARANCE} }};
    return {json.dumps(steps)}.map(name => {{ field("bearing").value = name; update(); return told(); }});"""
    sealed, angular, plain, none, roller = seen(body, "#axial_load=300&clearance_class=C4")
    assert (sealed["class"], sealed["off"], sealed["clearance"]) == ("C3", True, "20.5")
    assert (
        "2RS: seals; C3: clearance class; drag of the seals and of the grease is not in the torque."
        in sealed["read"]
    )
    assert 'catalogue("6205", clearance="C3"' in sealed["python"]
    assert (angular["class"], angular["off"], angular["clearance"]) == ("", True, "")
    assert angular["refused"] is False and "clearance" not in angular["python"]
    assert (plain["class"], plain["off"]) == ("C4", False) and 'clearance="C4"' in plain["python"]
    assert "of a class of clearance: C2, CN, C3, C4" in none["refused"]
    assert "NU205 is one of the cylindrical roller bearings" in roller["refused"]


def test_torque_at_high_speed_without_a_measured_model(seen):
    slow, fast = (seen(TEXTS, f"#bearing=7206 C&load=100&preload=250&speed_rpm={rpm}") for rpm in (4000, 9000))
    assert "resist more than measured" not in slow["tiles"][3][2]
    assert ABOVE_MEASURED in fast["tiles"][3][2]


def test_a_bearing_of_ones_own(seen):
    found = seen(TEXTS, f"#{OWN}&grade=own&eta0=37&alpha=20&load=486&hz=120")
    assert found["refused"] is False and "120 Hz" in found["hz"]
    state = eval(found["python"], {"BallBearing": BallBearing, "Lubricant": Lubricant})
    oil = Lubricant(eta0=0.037, alpha=2e-8)
    sizes = {"ball_diameter": 7.94e-3, "pitch_diameter": 39.04e-3, "conformity_outer": 0.53}
    mine = BallBearing(balls=8, **sizes, oil=oil, rq_race=1e-7).equilibrium((0, -486), speed_rpm=3000)
    assert state.force == pytest.approx(mine.force)


REFUSED = [
    ("temperature=333.15", "temperature", ["333.15 °C", "between 20 and 120", "given in K?"]),
    ("load=abc", "load", ["abc", "a number"]),
    ("load=", "load", ["nothing", "a number"]),
    ("load=-5", "load", [">= 0"]),
    ("load=1e5", "load", ["1e5 N", "the end of the atlas"]),
    ("speed_rpm=90000", "speed_rpm", ["at most", "where the atlas ends"]),
    ("speed_rpm=0", "speed_rpm", ["without rolling there is no film"]),
    ("clearance=900", "clearance", ["900 µm", "between -0.000397 and 0.000397 m"]),
    (OWN.replace("7.94", "0.00794"), "ball_diameter", ["mm", "in m? then 7.94 mm"]),
    (OWN.replace("balls=8", "balls=8.5"), "balls", ["a whole number"]),
    (OWN.replace("0.53", "0.502"), "conformity_outer", ["lies outside the atlas"]),
    ("grade=own&eta0=5000&alpha=20", "eta0", ["the range of the atlas"]),
    ("grade=680&temperature=20", "eta0", ["the range of the atlas"]),
    ("hz=1e7", "hz", ["there the atlas ends"]),
    ("rq=0", "rq", ["> 0"]),
    ("ratio=-1", "ratio", [">= 0"]),
    ("preload=-1", "preload", [">= 0"]),
    ("axial_load=20&preload=1e5", "load", ["the end of the atlas", "in the mean of all balls"]),
    ("bearing=NICE&clearance=900", "clearance", ["900 µm"]),
    (OWN + "&contact_angle=50", "contact_angle", ["from 0 to 45 degrees"]),
    ("load=900", None, []),
]


def test_refused_input_marks_its_field(seen):
    """And is as it was before when it can again."""
    addresses = json.dumps([f"#{address}" for address, _, _ in REFUSED])
    body = f"""const told = () => {{ {TEXTS} }};
    const go = address => {{ history.replaceState(null, "", address); fromAddress(); return told(); }};
    return {addresses}.map(go);"""
    for (_, field, words), found in zip(REFUSED, seen(body), strict=True):
        assert found["shown"] == (field is None) and found["invalid"] == ([field] if field else [])
        assert (found["refused"] is False) == (field is None)
        for word in words:
            assert word in found["refused"]


@pytest.mark.long
def test_unknown_parts_of_an_address_are_named(seen):
    first = seen(TEXTS)
    assert first["refused"] is False and first["said"] is False
    strange = seen(TEXTS, "#bearing=<b>x</b>&grade=47&nothing=1&%%")
    assert strange["tiles"] == first["tiles"] and strange["refused"] is False
    for words in (
        "bearing = <b>x</b> is not in its list, and 6205",
        "grade = 47",
        "nothing, %%: no input",
        "preload",
    ):
        assert words in strange["said"]


@pytest.mark.long
def test_the_address_brings_a_case_back(seen):
    """As typed: by the events of a user, a name and a grade that fill in, and what is left as it was."""
    typed = json.dumps([["bearing", "own"], ["balls", "7"], ["load", "640"], ["preload", "90"], ["grade", "100"]])
    body = (
        f"for (const [name, value] of {typed})"
        + """ {
      field(name).value = value;
      field("inputs").requestSubmit();
    }"""
    )
    there = seen(body + TEXTS)
    assert there["refused"] is False and "load=640" in there["address"] and "temperature" not in there["address"]
    back = seen(TEXTS, there["address"])
    assert {**back, "address": ""} == {**there, "address": ""}
    assert "balls=7" in back["python"] and "iso_vg(100" in back["python"]


def test_every_input_has_a_label_and_takes_the_keyboard(seen):
    body = """const inputs = [...document.querySelectorAll("input, select, button")];
    return inputs.map(input => [input.id, input.tabIndex, (input.labels?.[0] ?? input).textContent.trim()]);"""
    found = seen(body)
    assert len(found) == 22
    assert all(index == 0 and len(text) > 3 for _, index, text in found)


def test_pictures_have_descriptions(seen):
    pictures = 'document.querySelectorAll("#results svg[role=img]")'
    body = f'return [...{pictures}].map(one => one.getAttribute("aria-label"));'
    found = seen(body)
    assert len(found) == 5 and all(len(text) > 40 for text in found)


def test_the_command_writes_it_and_replaces_none(call, refused, tmp_path, page):
    target = tmp_path / "p.html"
    done = call("explore", "-o", target)
    assert done.code == 0 and str(target) in done.out.replace("\n", "") and done.err == ""
    assert target.read_bytes() == page.read_bytes()
    target.write_text("mine")
    refused(["--output", "replaced with --force"], "explore", "-o", target)
    assert target.read_text() == "mine"
    assert call("explore", "-o", target, "--force").code == 0 and target.stat().st_size > 1e6


def test_a_full_disk_keeps_the_old_page(refused, tmp_path, no_room):
    target = tmp_path / "p.html"
    target.write_text("mine")
    no_room()
    refused(["--output", "No space left"], "explore", "-o", target, "--force")
    assert target.read_text() == "mine"


@pytest.mark.parametrize(
    ("rq", "words"),
    [
        pytest.param("0.05", "", marks=pytest.mark.long),
        pytest.param("0.1", "; mixed: asperities touch", marks=pytest.mark.long),
        ("0.5", "; boundary: asperities touch all the time"),
    ],
)
def test_words_about_the_lambda_ratio(seen, rq, words):
    """A film of some 0.2 um: above 3, above 1 and below 1 times the roughness; heat, where it takes a tenth."""
    slow, fast = (seen(LINES, f"#clearance=0&rq={rq}&speed_rpm={rpm}") for rpm in (3000, 20000))
    bearing = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=60.0), rq_race=1e-6 * float(rq))
    ratio = bearing.equilibrium((0, -1000), speed_rpm=3000).lambda_ratio.min()
    assert (3.0 <= ratio, ratio < 1.0) == (words == "", "boundary" in words)
    assert numbers(slow["film"][1])[1] == pytest.approx(ratio, rel=6e-3) and slow["film"][2].endswith(f"°{words}")
    assert slow["outside"] is None and "isothermal (shear heats the inlet" in fast["outside"]


LINES = """return { film: [...document.querySelector("#tiles .tile").children].map(part => part.textContent),
  outside: field("outside").hidden ? null : field("outside").textContent };"""


def test_bands_are_the_error_bars_and_the_load_zone_has_the_forces(seen):
    body = """const numbers = (id, what) => document.querySelector(`#${id} .${what}.inner`).getAttribute("points")
      .split(" ").map(pair => pair.split(",").map(Number));
    const box = field("contact_c"), y = [...box.querySelectorAll("text[text-anchor=end]")].map(text =>
      [text.textContent, Number(text.getAttribute("y")) - 4]).filter(([text]) => Number(text) > 0);
    return { band: numbers("contact_c", "band"), line: numbers("contact_c", "curve"), y, hzs: current.hzs,
      zone: [...document.querySelectorAll("#zone text")].map(text => Number(text.textContent)) };"""
    page = seen(body, "#clearance=0")
    bearing = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=60.0))
    state = bearing.equilibrium((0, -1000), speed_rpm=3000)
    carried = [force for force in state.force[:, 0] if force > 0.01 * state.force.max()]
    assert sorted(page["zone"]) == pytest.approx(sorted(carried), rel=6e-3)
    at = Atlas().at(bearing.race("inner").point(state.force[0, 0], 3000.0)).impedance(hz=page["hzs"])
    C, bar = at.damping, at.error_bars["damping"]
    (one, low), (ten, high) = ((float(text), place) for text, place in (page["y"][0], page["y"][-1]))
    slope = (high - low) / np.log10(ten / one)
    places = [low + slope * np.log10(values / one) for values in (C - bar, C + bar, C)]
    shown = np.array(page["band"])[:, 1]
    np.testing.assert_allclose(shown[: C.size], places[0], atol=0.2)
    np.testing.assert_allclose(shown[C.size :][::-1], places[1], atol=0.2)
    np.testing.assert_allclose(np.array(page["line"])[:, 1], places[2], atol=0.2)
