"""The report in a browser and beside its files: what its figures show, how it fits, what is printed."""

import html
import json
import re
from pathlib import Path

import numpy as np
import pytest
from browsers import dom

from ehlcontact import load

LARGEST = 8e6  # bytes
WIDTHS = (400, 768, 1280)
SHEET = 703  # px of an A4 sheet between its margins, at 96 to the inch
WAIT = ("--virtual-time-budget=60000",)  # for what the page does after it was loaded


@pytest.fixture(scope="module")
def page(finished):
    return finished[1] / "report.html"


@pytest.fixture(scope="module")
def scenes(page):
    from ehlcontact.cli.plots.live.bundle import unpacked

    text = page.read_text(encoding="utf-8")
    return json.loads(unpacked(re.search(r'id="scenes"[^>]*>([^<]*)<', text)[1]))


@pytest.fixture(scope="module")
def results(finished):
    return json.loads((finished[1] / "results.json").read_text())


@pytest.fixture
def seen(page, tmp_path):
    """``seen(asked, width, dark)``: what an asynchronous body returns on the drawn page; its console is silent.

    The page stands in a frame, for no window of a browser is as narrow as a telephone.
    """

    def run(asked, width=1280, dark=False):
        tell = f"""<script>(async () => {{
          const all = (what, inside = document) => [...inside.querySelectorAll(what)];
          await report.ready; const ask = async () => {{ {asked} }};
          const told = await ask().catch(error => String(error));
          parent.document.getElementById("told").textContent = JSON.stringify(told); }})();</script>"""
        inside = html.escape(page.read_text(encoding="utf-8").replace("</body>", f"{tell}</body>"))
        style = f'style="border: 0; width: {width}px; height: 3000px"'
        file = tmp_path / "framed.html"
        file.write_text(f'<pre id="told"></pre><iframe {style} srcdoc="{inside}"></iframe>', encoding="utf-8")
        scheme = f"--blink-settings=preferredColorScheme={0 if dark else 1}"
        out, said = dom(file, flags=(*WAIT, scheme))
        assert "CONSOLE" not in said, said[-2000:]
        found = re.search(r'<pre id="told">(.+?)</pre>', out, flags=re.S)
        assert found, said[-2000:]
        return json.loads(html.unescape(found[1]))

    return run


def test_it_stands_alone_and_links_to_what_is_there(page):
    text = page.read_text(encoding="utf-8")
    assert page.stat().st_size < LARGEST
    bare = re.sub(r"<script.*?</script>", "", text, flags=re.S)
    assert re.findall(r"<(?:link|script [^>]*src)|@import|url\(", bare) == []
    assert all(source.startswith("data:") for source in re.findall(r'src="(.{5})', bare))
    ids, links = set(re.findall(r'id="([\w-]+)"', bare)), re.findall(r'href="([^"]+)"', bare)
    inside = [link[1:] for link in links if link[0] == "#"]
    assert len(inside) >= 13 and set(inside) <= ids
    assert set(re.findall(r"<h[23] id=\"(\w+)\"", bare)) <= set(inside)
    beside = {link for link in links if link[0] != "#" and "://" not in link}
    assert all((page.parent / link).is_file() for link in beside)
    lying = {path.relative_to(page.parent).as_posix() for path in page.parent.rglob("*") if path.is_file()}
    assert lying - beside <= {page.name, "run.log", "summary.json", "summary.csv"}  # written after it


def test_every_figure_has_a_picture_and_a_scene(page, scenes):
    text = page.read_text(encoding="utf-8")
    figures = re.findall(r'<figure id="figure-(\w+)" data-scene="(\w+)"><img src="data:image/png', text)
    assert len(figures) == len(re.findall("<figure", text)) == 21
    assert {name for name, _ in figures} == {name for _, name in figures} == set(scenes)


def line(scene, name, panel=0):
    return next(trace for trace in scene["panels"][panel]["traces"] if trace.get("name") == name)


def close(shown, true):
    """Within what rounding to a share of the span leaves."""
    true = np.asarray(true)
    assert np.asarray(shown) == pytest.approx(true, abs=1e-4 * np.ptp(true))


def test_lines_are_those_of_the_files(finished, scenes, results):
    free = load(finished[1] / "free.h5").si
    shown = scenes["free"]["panels"][0]["traces"][0]
    close(shown["x"], free.t * 1e3)
    close(shown["y"], free.approach * 1e6)
    close(line(scenes["free"], "centre", 2)["y"], free.h_central * 1e6)
    film = line(scenes["impedance"], "film")
    of = results["memory"]["impedance"]
    moving = np.array(of["Omega"]) > 0.0
    assert film["x"] == pytest.approx(np.array(of["Omega"])[moving], rel=1e-4)
    close(film["y"], np.array(of["stiffness"])[moving])
    inner = [ball["force"][0] for ball in results["whole_bearing"]["balls"]]
    close(line(scenes["whole_balls"], "inner race")["r"], inner)
    residuals = line(scenes["convergence"], "residual of Reynolds, over the dry start's")["y"]
    assert residuals[-1] == pytest.approx(results["steady"]["residual"], rel=1e-4)


def test_maps_are_those_of_the_files(finished, scenes):
    film = load(finished[1] / "steady.h5")
    pressure, thickness = (panel["traces"][0] for panel in scenes["film_maps"]["panels"])
    scales = film.scales
    i, j = (int(np.argmin(np.abs(np.array(pressure[key])))) for key in ("y", "x"))
    assert thickness["z"][i][j] == pytest.approx(film.h_central * scales.length * 1e6, rel=0.01)
    centre = film.P[np.argmin(np.abs(film.X)), 0] * scales.pressure * 1e-9
    assert pressure["z"][i][j] == pytest.approx(centre, rel=0.02)
    assert pressure["x"][-1] == pytest.approx(1.5 * scales.b * 1e3, rel=0.02)


def test_frames_are_the_snapshots_of_the_last_period(finished, scenes):
    run = load(finished[1] / "harmonic.h5")
    scene, s = scenes["instants"], run.scales
    frames = scene["frames"]
    times = np.array(frames["values"]) / (s.time * 1e3)
    assert times.size == run.snapshot_T.size == 21
    assert times == pytest.approx(run.snapshot_T, rel=2e-3)
    assert run.snapshot_T[-1] == pytest.approx(run.T[-1])
    assert np.ptp(run.snapshot_T) == pytest.approx(run.motion.period)
    maps, moving = scene["panels"][0]["traces"][0], {one["trace"]: one for one in frames["traces"]}
    i, j = (int(np.argmin(np.abs(np.array(maps[key])))) for key in ("y", "x"))
    centre = np.argmin(np.abs(run.X))
    for k in range(times.size):
        step = np.argmin(np.abs(run.T - run.snapshot_T[k]))
        assert np.array_equal(run.snapshot_P[k][:, 0], run.p_midplane[step])
        for trace, field, unit in ((0, run.snapshot_P, s.pressure * 1e-9), (1, run.snapshot_H, s.length * 1e6)):
            assert moving[trace]["z"][k][i][j] == pytest.approx(field[k][centre, 0] * unit, rel=0.01)
        inside = (run.X >= -1.8) & (run.X <= 1.5)
        close(moving[2]["y"][k], run.p_midplane[step, inside] * s.pressure * 1e-9)
        close(moving[3]["y"][k], run.h_midplane[step, inside] * s.length * 1e6)
        assert moving[9]["y"][k][0] == pytest.approx(run.force[step] * s.force, rel=1e-4)
    assert len({json.dumps(field) for field in moving[1]["z"]}) > times.size - 2  # they move


def test_a_run_without_whole_fields_still_has_its_mid_planes(finished):
    from dataclasses import replace

    from ehlcontact.cli.plots.instants import instants
    from ehlcontact.cli.plots.live.instants import instants_scene

    run = load(finished[1] / "harmonic.h5")
    bare = replace(run, **{f"snapshot_{name}": getattr(run, f"snapshot_{name}")[:0] for name in "THP"})
    scene = instants_scene(bare)
    assert [panel["title"][:5] for panel in scene["panels"]] == ["along", "over "]
    assert scene["frames"]["values"][-1] == pytest.approx(run.si.t[-1] * 1e3, rel=2e-3)
    assert 10 <= len(scene["frames"]["values"]) <= 24 and "maps" not in scene["thinned"]
    assert len(instants(bare).axes) == 2


def test_speeds_are_those_of_the_results(scenes, results):
    """Every speed of the results has a frame, with its films, loads, stiffness and damping."""
    scene, found = scenes["whole_speeds"], results["whole_bearing"]["over_speed"]
    frames = scene["frames"]
    assert len(found) == 10 and frames["values"] == pytest.approx([one["speed_rpm"] for one in found], rel=1e-3)
    assert found[frames["start"]]["speed_rpm"] == results["whole_bearing"]["speed_rpm"]
    balls = np.array([ball["h_min"] for ball in results["whole_bearing"]["balls"]])
    assert np.array(found[frames["start"]]["h_min"]) == pytest.approx(balls)
    panels = scene["panels"]
    names = [trace["name"] for panel in panels for trace in panel["traces"]]
    moving = {one["trace"]: one for one in frames["traces"]}
    low, high = panels[1]["y"]["range"]
    for k, one in enumerate(found):
        force, film = np.array(one["force"]), np.array(one["h_min"]) * 1e6
        close(moving[names.index("inner race")]["r"][k], force[:, 0])
        shown = moving[names.index("inner race", 2)]["y"][k]
        assert sorted(shown) == pytest.approx(sorted(film[:, 0]), rel=1e-4)
        assert low <= film.min() and film.max() <= high
        along, across = (moving[names.index("along the load") + i]["y"][k] for i in (0, 1))
        assert along == pytest.approx(np.array(one["stiffness"]["along"]) * 1e-6, rel=1e-4)
        assert across == pytest.approx(np.array(one["stiffness"]["across"]) * 1e-6, rel=1e-4)
        damping = moving[names.index("along the load", names.index("across it"))]["y"][k]
        assert damping == pytest.approx(one["damping"]["along"], rel=1e-4)
    assert found[-1]["h_min"][0][0] > found[0]["h_min"][0][0]  # faster, thicker


@pytest.mark.parametrize("width", WIDTHS)
def test_every_figure_is_drawn_and_nothing_sticks_out(seen, scenes, width):
    body = """const grown = ({ a, b }) => Math.hypot(a, b);
    const letters = one => parseFloat(getComputedStyle(one).fontSize);
    const texts = all(".plot svg text").filter(text => text.textContent.trim());
    const size = text => letters(text) * grown(text.getScreenCTM()), spans = all(".plot svg tspan").map(letters);
    const within = ({ left, right }) => left >= 0 && right <= innerWidth;
    const outside = texts.filter(text => !within(text.getBoundingClientRect()));
    return { failed: report.failed, wanted: report.wanted, drawn: report.drawn, width: innerWidth,
      needed: document.documentElement.scrollWidth, texts: texts.length,
      smallest: Math.min(...texts.map(size), ...spans), out: outside.map(text => text.textContent),
      pictures: all("figure > img").filter(one => one.offsetWidth).length,
      flat: all(".plot").filter(plot => plot.clientHeight < 100).length,
      cloud: all('[data-title*="loud"], [data-title*="tudio"], .modebar a[href]').length };"""
    found = seen(body, width)
    assert found["failed"] == [] and found["drawn"] == found["wanted"] == len(scenes)
    assert found["width"] == width and found["needed"] <= width and found["out"] == []
    assert found["texts"] > 300 and found["smallest"] >= 9.0
    assert found["pictures"] == 0 and found["flat"] == 0 and found["cloud"] == 0


def test_the_slider_runs_through_the_period(seen, scenes):
    body = """const figure = document.getElementById("figure-instants"), plot = figure.querySelector(".plot");
    const input = figure.querySelector("input[type=range]"), told = figure.querySelector("output");
    const named = figure.querySelector("label").htmlFor === input.id;
    const now = () => [told.textContent, plot.data[0].z[24][40], plot.data[2].y[10], named];
    const first = now();
    input.value = 7;
    input.dispatchEvent(new Event("input"));
    await new Promise(done => setTimeout(done, 100));
    return [first, now(), input.tabIndex];"""
    first, later, index = seen(body)
    frames = scenes["instants"]["frames"]
    pressure, middle = frames["traces"][0]["z"], frames["traces"][2]["y"]
    assert first == [f"{frames['values'][0]} ms", pressure[0][24][40], middle[0][10], True]
    assert later == [f"{frames['values'][7]} ms", pressure[7][24][40], middle[7][10], True]
    assert index == 0


def test_keys_hide_and_show_what_looks_like_them(seen):
    body = """const figure = document.getElementById("figure-bode"), plot = figure.querySelector(".plot");
    const shown = () => plot.data.map(trace => trace.visible !== false), keys = all(".keys button", figure);
    const before = shown();
    keys[0].click();
    const hidden = shown(), pressed = keys[0].getAttribute("aria-pressed");
    keys[0].click();
    return { names: keys.map(key => key.textContent), before, hidden, pressed, after: shown() };"""
    found = seen(body)
    assert found["names"][0] == "full film" and len(found["names"]) == 6
    assert all(found["before"]) and found["before"] == found["after"] and found["pressed"] == "false"
    assert found["hidden"].count(False) == 2  # amplitude and phase


def test_dark_pages_have_dark_figures(seen):
    body = """const parts = colour => colour.match(/[\\d.]+/g).slice(0, 3).map(Number);
    const luminance = colour => parts(colour).reduce((sum, part) => sum + part) / 765;
    const text = document.querySelector(".plot svg text"), style = getComputedStyle(text);
    return { paper: luminance(getComputedStyle(document.body).backgroundColor), words: luminance(style.fill),
      line: document.getElementById("figure-free").querySelector(".plot").data[0].line.color };"""
    dark, light = seen(body, dark=True), seen(body)
    assert dark["paper"] < 0.15 and dark["words"] > 0.8 and light["paper"] > 0.95 and light["words"] < 0.3
    assert (dark["line"], light["line"]) == ("#56b4e9", "#0072b2")


def test_print_cuts_nothing(seen):
    """The rules for paper, on the width of a sheet: pictures instead of plots, every column inside."""
    body = """for (const sheet of document.styleSheets) for (const { media } of sheet.cssRules) {
      if (media?.mediaText === "print") media.mediaText = "all";
      else if (/^screen|max-width/.test(media?.mediaText)) media.mediaText = "not all";
    }
    const right = one => one.getBoundingClientRect().right, paper = document.documentElement.clientWidth;
    const cells = all("th, td"), pictures = all("figure > img");
    const wide = ones => ones.filter(one => one.clientWidth > 300);
    const style = one => getComputedStyle(one);
    await new Promise(done => setTimeout(done, 500));
    const out = [...cells, ...pictures].filter(one => right(one) > paper + 1);
    return { paper, out: out.map(one => one.textContent || one.alt), pictures: wide(pictures).length,
      plots: all(".plot").filter(one => one.clientWidth).length,
      columns: cells.some(one => one.textContent === "valid u"),
      parted: all("h2, h3").filter(one => style(one).breakAfter !== "avoid").length,
      letters: Math.min(...cells.map(one => parseFloat(style(one).fontSize))) };"""
    found = seen(body, SHEET)
    assert found["paper"] == SHEET and found["out"] == [] and found["columns"]
    assert found["pictures"] == 21 and found["plots"] == 0 and found["parted"] == 0
    assert found["letters"] >= 9.0  # px: 7 pt


def test_without_scripts_the_pictures_are_there(page):
    text = re.sub(r"<script.*?</script>", "", page.read_text(encoding="utf-8"), flags=re.S)
    bare = Path(page).with_name("bare.html")
    bare.write_text(text, encoding="utf-8")
    out, said = dom(bare)
    bare.unlink()
    assert "CONSOLE" not in said and out.count("data:image/png") == 21 and "plotly-logo" not in out
