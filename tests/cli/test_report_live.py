"""The report in a browser and beside its files: what its figures show, their fit to the page, what is printed."""

import html
import json
import re

import numpy as np
import pytest
from browsers import dom

from ehlcontact import read
from ehlcontact.cli.study.points.origin import ORIGIN

LARGEST = 4e6  # bytes
WIDTHS = (400, *(pytest.param(width, marks=pytest.mark.long) for width in (768, 1280)))
WAIT = ("--virtual-time-budget=60000",)  # for what the page does after it was loaded


@pytest.fixture(scope="module")
def page(finished):
    return finished[1] / "report.html"


@pytest.fixture(scope="module")
def figures(page):
    """Figures of the page as plotly.js gets them, by name."""
    from ehlcontact.cli.plots.bundle import unpacked

    text = page.read_text(encoding="utf-8")
    packed = json.loads(unpacked(re.search(r'id="figures"[^>]*>([^<]*)<', text)[1]))
    return {name: json.loads(figure) for name, figure in packed.items()}


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
        frame = f'<meta charset="utf-8"><pre id="told"></pre><iframe {style} srcdoc="{inside}"></iframe>'
        file.write_text(frame, encoding="utf-8")
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
    words = re.sub(r'base64,[^"]*|application/gzip">[^<]*', "", text)  # of packed letters any word may be a part
    assert "http" not in words and "Traceback" not in words and "nan" not in words.lower().split()
    bare = re.sub(r"<script.*?</script>", "", text, flags=re.S)
    assert re.findall(r"<(?:link|script [^>]*src)|@import|url\(", bare) == []
    assert all(source.startswith("data:") for source in re.findall(r'src="(.{5})', bare))
    ids, links = set(re.findall(r'id="([\w-]+)"', bare)), re.findall(r'href="([^"]+)"', bare)
    inside = [link[1:] for link in links if link[0] == "#"]
    assert len(inside) >= 13 and set(inside) <= ids
    assert set(re.findall(r"<h[23] id=\"(\w+)\"", bare)) <= set(inside)
    beside = {link for link in links if link[0] != "#" and "://" not in link}
    assert [link for link in beside if not (page.parent / link).exists()] == []  # files, and the folder "store"
    lying = {path.relative_to(page.parent).as_posix() for path in page.parent.rglob("*") if path.is_file()}
    lying = {name for name in lying if not name.startswith("store/")}
    later = {page.name, "run.log", "summary.json", "summary.csv"}  # written after it
    assert "store" in beside and lying - beside <= later | {ORIGIN}


def test_every_figure_of_the_page_is_there(page, figures):
    found = re.findall(r'<figure id="figure-(\w+)">\s*<div class="plot" data-figure="(\w+)"', page.read_text())
    assert len(found) == 24 and {name for name, _ in found} == {name for _, name in found} == set(figures)


def line(figure, name, number=0):
    return [trace for trace in figure["data"] if trace.get("name") == name][number]


def close(shown, true):
    """Within what rounding to a share of the span leaves."""
    true = np.asarray(true)
    assert np.asarray(shown) == pytest.approx(true, abs=1e-4 * np.ptp(true))


def test_lines_are_those_of_the_files(finished, figures, results):
    free = read(finished[1] / "free.h5")
    close(line(figures["free"], "film")["x"], free.t * 1e3)
    close(line(figures["free"], "film")["y"], free.approach * 1e6)
    close(line(figures["free"], "centre")["y"], free.h_central * 1e6)
    of = results["memory"]["impedance"]
    moving = np.array(of["omega"]) > 0.0
    hz = np.array(of["omega"])[moving] / (2.0 * np.pi)
    assert line(figures["impedance"], "film")["x"] == pytest.approx(hz, rel=1e-4)
    close(line(figures["impedance"], "film")["y"], np.array(of["stiffness"])[moving] * 1e-6)
    inner = [ball["force"][0] for ball in results["in_time"]["balls"]]
    close(line(figures["balls_1"], "inner race")["r"], inner)
    residuals = line(figures["convergence"], "residual of Reynolds, over the dry start's")["y"]
    assert residuals[-1] == pytest.approx(results["steady"]["residual"], rel=1e-4)


def test_maps_are_those_of_the_files(finished, figures):
    film = read(finished[1] / "steady.h5")
    pressure, thickness = (trace for trace in figures["film_maps"]["data"] if trace["type"] == "heatmap")
    scales = film.point.scales
    i, j = (int(np.argmin(np.abs(np.array(pressure[key])))) for key in ("y", "x"))
    assert thickness["z"][i][j] == pytest.approx(film.h_central * 1e6, rel=0.01)
    centre = film.p[np.argmin(np.abs(film.x)), 0] * 1e-9
    assert pressure["z"][i][j] == pytest.approx(centre, rel=0.02)
    assert pressure["x"][-1] == pytest.approx(1.5 * scales.b * 1e6, rel=0.02)


def test_frames_are_the_snapshots_of_the_last_period(finished, figures):
    run = read(finished[1] / "harmonic.h5")
    figure, s = figures["instants"], run.point.scales
    frames, texts = figure["frames"], figure["layout"]["meta"]["slider"]["texts"]
    times = np.array([float(text.removesuffix(" ms")) for text in texts]) / 1e3
    assert times.size == len(frames) == run.snapshot_t.size == 21
    assert times == pytest.approx(run.snapshot_t, rel=2e-3)
    assert run.snapshot_t[-1] == pytest.approx(run.t[-1])
    assert np.ptp(run.snapshot_t) == pytest.approx(run.motion.period * s.time)
    maps = figure["data"][0]
    i, j = (int(np.argmin(np.abs(np.array(maps[key])))) for key in ("y", "x"))
    centre = np.argmin(np.abs(run.x))
    for k, frame in enumerate(frames):
        step = np.argmin(np.abs(run.t - run.snapshot_t[k]))
        assert np.array_equal(run.snapshot_p[k][:, 0], run.p_midplane[step])
        pressure, film, along, gap, force, _ = frame["data"]
        assert pressure["z"][i][j] == pytest.approx(run.snapshot_p[k][centre, 0] * 1e-9, rel=0.01)
        assert film["z"][i][j] == pytest.approx(run.snapshot_h[k][centre, 0] * 1e6, rel=0.01)
        inside = (run.x >= -1.8 * s.a) & (run.x <= 1.5 * s.a)
        close(along["y"], run.p_midplane[step, inside] * 1e-9)
        close(gap["y"], run.h_midplane[step, inside] * 1e6)
        assert force["y"][0] == pytest.approx(run.force[step], rel=1e-4)
    assert len({json.dumps(frame["data"][1]["z"]) for frame in frames}) > times.size - 2  # they move


def test_speeds_are_those_of_the_results(figures, results):
    """Every speed of the results has a frame, with its films, loads, stiffness and damping."""
    figure, found = figures["whole_speeds"], results["in_time"]["over_speed"]
    slider = figure["layout"]["meta"]["slider"]
    shown = [float(text.removesuffix(" rpm")) for text in slider["texts"]]
    assert len(found) == len(figure["frames"]) == 10
    assert shown == pytest.approx([one["speed_rpm"] for one in found], rel=1e-3)
    assert found[slider["start"]]["speed_rpm"] == results["in_time"]["speed_rpm"]
    names = [trace["name"] for trace in figure["data"]]
    axis = figure["layout"]["yaxis"]
    low, high = (10.0**end if axis.get("type") == "log" else end for end in axis["range"])
    for frame, one in zip(figure["frames"], found, strict=True):
        shown = dict(zip(frame["traces"], frame["data"], strict=True))  # those that move, by their number
        force, film = np.array(one["force"]), np.array(one["h_min"]) * 1e6
        close(shown[names.index("inner race")]["r"], force[:, 0])
        films = shown[names.index("inner race", names.index("load"))]["y"]
        assert sorted(films) == pytest.approx(sorted(film[:, 0]), rel=1e-4)
        assert low <= film.min() and film.max() <= high
        first = names.index("along the load")
        for part, name, unit in ((first, "stiffness", 1e-6), (first + 2, "damping", 1.0)):
            for k, way in enumerate(("along", "across")):
                values = np.array(one[name][way]) * unit
                assert shown[part + k]["y"] == pytest.approx(values, rel=1e-4)
    assert found[-1]["h_min"][0][0] > found[0]["h_min"][0][0]  # faster, thicker


@pytest.mark.parametrize("width", WIDTHS)
def test_every_figure_is_drawn_and_nothing_sticks_out(seen, figures, width):
    body = """const grown = ({ a, b }) => Math.hypot(a, b);
    const letters = one => parseFloat(getComputedStyle(one).fontSize);
    const texts = all(".plot svg text").filter(text => text.textContent.trim());
    const size = text => letters(text) * grown(text.getScreenCTM()), spans = all(".plot svg tspan").map(letters);
    const within = ({ left, right }) => left >= 0 && right <= innerWidth;
    const outside = texts.filter(text => !within(text.getBoundingClientRect()));
    return { failed: report.failed, wanted: report.wanted, drawn: report.drawn, width: innerWidth,
      needed: document.documentElement.scrollWidth, texts: texts.length,
      smallest: Math.min(...texts.map(size), ...spans), out: outside.map(text => text.textContent),
      flat: all(".plot").filter(plot => plot.clientHeight < 100).length,
      cloud: all('[data-title*="loud"], [data-title*="tudio"], .modebar a[href]').length };"""
    found = seen(body, width)
    assert found["failed"] == [] and found["drawn"] == found["wanted"] == len(figures)
    assert found["width"] == width and found["needed"] <= width and found["out"] == []
    assert found["texts"] > 300 and found["smallest"] >= 9.0
    assert found["flat"] == 0 and found["cloud"] == 0


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.long
def test_words_of_a_figure_do_not_lie_on_each_other(seen, width):
    body = """const found = [];
    for (const figure of all("figure")) {
      const texts = all(".plot svg text", figure).filter(text => text.textContent.trim());
      const boxes = texts.map(text => [text.textContent, text.getBoundingClientRect()]);
      boxes.forEach(([one, p], k) => boxes.slice(k + 1).forEach(([other, q]) => {
        const wide = Math.min(p.right, q.right) - Math.max(p.left, q.left);
        const tall = Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top);
        if (wide > 2 && tall > 3) found.push([figure.id, one, other, wide, tall]);
      }));
    }
    return found;"""
    assert seen(body, width) == []


@pytest.mark.long
def test_the_page_opens_with_the_machine_and_its_tiles(seen, results):
    """Operating line and first tiles on the first screen of a telephone, all of them on that of a desk."""
    body = """const top = one => Math.round(one.getBoundingClientRect().top);
    const values = all(".tile .value").map(one => one.textContent.trim().replace(/\\s+/g, " "));
    const last = all(".tile").at(-1).getBoundingClientRect().bottom;
    const line = document.querySelector(".operating"), names = all(".tile h2").map(one => one.textContent);
    return { line: [line.textContent, top(line)], values, names, first: top(document.querySelector(".tile")),
      last, heads: all("main h2").map(one => one.id) };"""
    narrow, wide = seen(body, 400), seen(body, 1280)
    tiles = results["machine"]["tiles"]
    for shown in (narrow, wide):
        assert shown["line"][0] == results["operating_line"]
        assert shown["names"] == [tile["name"] for tile in tiles]
        assert shown["values"] == [f"{tile['value']} {tile['unit']}".strip() for tile in tiles]
    assert narrow["line"][1] < 120 and narrow["first"] < 300 and wide["last"] < 620
    assert wide["heads"][0] == "machine" and wide["heads"][-2:] == ["convergence", "made"]


@pytest.mark.long
def test_reduced_against_full_is_a_section_with_its_verdict(seen, results):
    body = """const cells = row => all("th, td", row).filter(one => one.clientWidth).map(one => one.textContent);
    return { verdict: document.querySelector("#reduced + .verdict").textContent,
      rows: all(".models tr").map(cells) };"""
    narrow, wide = seen(body, 400), seen(body, 1280)
    decay = results["rotor"]["decay"]
    assert wide["verdict"] == results["verdict"]
    assert len(wide["rows"]) == 1 + len(decay["decrements"]) and len(wide["rows"][0]) == 6
    for row, (name, found) in zip(narrow["rows"][1:], decay["decrements"].items(), strict=True):
        assert row[1:3] == [f"{found['hz']:.4g}", f"{found['decrement']:.3g}"]
        assert (row[3] == "-") is (name == "full") and len(row) == 4


@pytest.mark.long
def test_the_slider_runs_through_the_period(seen, figures):
    body = """const figure = document.getElementById("figure-instants"), plot = figure.querySelector(".plot");
    const input = figure.querySelector("input[type=range]"), told = figure.querySelector("output");
    const named = figure.querySelector("label").htmlFor === input.id;
    const now = () => [told.textContent, plot.data[0].z[24][40], plot.data[2].y[10], named];
    const first = now();
    input.value = 7;
    input.dispatchEvent(new Event("input"));
    await new Promise(done => setTimeout(done, 100));
    return [first, now(), input.tabIndex];"""
    *shown, index = seen(body)
    figure = figures["instants"]
    for k, found in zip((0, 7), shown, strict=True):
        pressure, _, along, *_ = figure["frames"][k]["data"]
        texts = figure["layout"]["meta"]["slider"]["texts"]
        assert found == [texts[k], pressure["z"][24][40], along["y"][10], True]
    assert index == 0


def test_the_legend_hides_what_has_the_same_name(figures):
    """One entry for amplitude and phase of a contact."""
    traces = figures["bode"]["data"]
    shown = [trace["name"] for trace in traces if trace["showlegend"]]
    assert shown[0] == "full film" and len(shown) == 6 and len(traces) == 12
    assert all(trace["legendgroup"] == trace["name"] for trace in traces)


@pytest.mark.long
def test_dark_pages_have_dark_figures(seen):
    body = """const parts = colour => colour.match(/[\\d.]+/g).slice(0, 3).map(Number);
    const luminance = colour => parts(colour).reduce((sum, part) => sum + part) / 765;
    const text = document.querySelector(".plot svg text"), style = getComputedStyle(text);
    return { paper: luminance(getComputedStyle(document.body).backgroundColor), words: luminance(style.fill),
      line: document.getElementById("figure-free").querySelector(".plot").data[0].line.color };"""
    dark, light = seen(body, dark=True), seen(body)
    assert dark["paper"] < 0.15 and dark["words"] > 0.8 and light["paper"] > 0.95 and light["words"] < 0.3
    assert (dark["line"], light["line"]) == ("#56b4e9", "#0072b2")


@pytest.mark.long
def test_print_cuts_nothing(seen):
    """The rules for paper, on a page wider than a sheet: figures shrunk to it, every column inside."""
    body = """for (const sheet of document.styleSheets) for (const { media } of sheet.cssRules) {
      if (media?.mediaText === "print") media.mediaText = "all";
      else if (/^screen|max-width/.test(media?.mediaText)) media.mediaText = "not all";
    }
    document.body.style.width = "703px";
    const right = one => one.getBoundingClientRect().right, left = document.body.getBoundingClientRect().left;
    const cells = all("th, td"), plots = all(".plot .main-svg");
    const style = one => getComputedStyle(one);
    await new Promise(done => setTimeout(done, 500));
    const out = [...cells, ...plots].filter(one => right(one) > left + 703 + 1);
    return { out: out.map(one => one.textContent), plots: plots.filter(one => one.clientWidth > 300).length > 20,
      tools: all(".modebar-container, .slider").filter(one => one.clientWidth).length,
      columns: cells.some(one => one.textContent.startsWith("valid u")),
      parted: all("h2, h3").filter(one => style(one).breakAfter !== "avoid").length,
      letters: Math.min(...cells.map(one => parseFloat(style(one).fontSize))) };"""
    found = seen(body)
    assert found["out"] == [] and found["columns"] and found["plots"] and found["tools"] == found["parted"] == 0
    assert found["letters"] >= 9.0  # px: 7 pt


def test_note_of_a_page_without_scripts(page, tmp_path):
    text = re.sub(r"<script.*?</script>", "", page.read_text(encoding="utf-8"), flags=re.S)
    (tmp_path / "bare.html").write_text(text, encoding="utf-8")
    out, said = dom(tmp_path / "bare.html")
    assert "CONSOLE" not in said and out.count("drawn by JavaScript") == 24 and "plotly-logo" not in out
