"""Figures made ready for a page: legend, places of panels, points and digits, packing."""

import json
from dataclasses import replace

import numpy as np
import pytest

from ehlcontact.cli.page import together
from ehlcontact.cli.plots.bundle import bundle, library, packed, unpacked, version
from ehlcontact.cli.plots.finish import finished
from ehlcontact.cli.plots.render import figure_of
from ehlcontact.cli.plots.thinned import LINE, rounded, thin_line
from ehlcontact.results.drawing import draw
from ehlcontact.results.picture import BLUE, ORANGE, RED, Band, Line, LoadZone, Map, Mark, Panel, Picture, Slides


@pytest.fixture
def figure():
    panels = [
        Panel([Line([1.0, 10.0], [3.0, np.nan], "film")], ("frequency", "Hz"), ("force", "N"), title=title)
        for title in "abcd"
    ]
    both = [*panels[0].lines, Line([1.0, 10.0], [7.0, 8.0], "pressure", second=True)]
    panels[0] = replace(panels[0], lines=both, second="pressure")
    places = np.array([1.0, 2.0])
    panels[1] = Map((places, ("frequency", "Hz")), (places, ("force", "N")), (np.eye(2), ("film", "m")), title="b")
    return figure_of(Picture(panels, heights=(200.0, 100.0), shared=True))


def test_a_name_is_in_the_legend_once(figure):
    ready = finished(figure)
    json.dumps(ready, allow_nan=False)
    shown = [trace.get("name") for trace in ready["data"] if trace["showlegend"]]
    assert shown == ["film", "pressure"] and ready["layout"]["showlegend"]
    film, _, field, *_ = ready["data"]
    assert film["y"] == [3, None] and film["hovertemplate"].startswith("frequency [Hz]: %{x")
    assert "film [µm]: %{z" in field["hovertemplate"]


def overlaps(layout):
    """Panels that lie upon one another."""
    boxes = [
        (*layout[f"xaxis{k}"]["domain"], *layout[f"yaxis{m}"]["domain"])
        for k, m in (("", ""), ("2", "3"), ("3", "4"), ("4", "5"))  # the second axis has a number too
    ]
    pairs = [(a, b) for i, a in enumerate(boxes) for b in boxes[:i]]
    return [
        p
        for p in pairs
        if min(p[0][1], p[1][1]) > max(p[0][0], p[1][0]) and min(p[0][3], p[1][3]) > max(p[0][2], p[1][2])
    ]


def test_panels_stand_side_by_side_or_below_each_other(figure):
    ready = finished(figure)
    wide, narrow = ready["layout"], ready["layout"]["meta"]["narrow"]
    assert overlaps(wide) == overlaps(narrow) == []
    assert {tuple(narrow[f"xaxis{k}"]["domain"]) for k in ("", "2", "3", "4")} == {(0.0, 1.0)}
    tops = [narrow[f"yaxis{k}"]["domain"][1] for k in ("", "4", "3", "5")]  # a column, then the next one
    assert tops == sorted(tops, reverse=True) and narrow["height"] > 1.5 * wide["height"]
    bar = wide["coloraxis2"]["colorbar"]
    low, high = wide["yaxis3"]["domain"]
    assert bar["y"] == pytest.approx(0.5 * (low + high)) and bar["x"] > wide["xaxis2"]["domain"][1]


def test_words_on_logarithmic_axes():
    marks, bands = (Mark(100.0, "mode"),), (Band(1.0, 10.0),)
    panel = Panel([Line([1.0, 1000.0], [1.0, 2.0])], "x", "y", logs="x", marks=marks, bands=bands)
    drawn = figure_of(Picture([panel]))
    (note,) = drawn.layout.annotations
    assert note.x == 2.0 and {(shape.x0, shape.x1) for shape in drawn.layout.shapes} == {
        (100.0, 100.0),
        (1.0, 10.0),
    }
    axes = draw(Picture([panel])).axes[0]
    assert axes.get_xscale() == "log" and "mode" in [text.get_text() for text in axes.texts]


def test_few_decades_have_few_ticks():
    """Whole numbers at 1, 2 and 5; over more decades at these, over hardly any plotly's own: no bare digits."""
    values = ((0.007, 0.1), (1e-5, 1.0), (2.0, 3.0))
    panels = [Panel([Line([1.0, 2.0], pair)], "x", "y", logs="Y") for pair in values]
    layout = finished(figure_of(Picture(panels, columns=1, heights=(100.0,))))["layout"]
    ticks = [(axis.get("dtick"), axis.get("tickformat")) for axis in (layout[f"yaxis{k}"] for k in ("", "2", "3"))]
    assert ticks == [("D2", "~g"), (1, None), (None, None)]


def test_a_long_label_has_two_lines_beside_a_flat_panel():
    panel = Panel([Line([1.0, 2.0], [1.0, 2.0])], "x", ("place along rolling", "m"))
    heights = {height: finished(figure_of(Picture([panel], heights=(height,)))) for height in (60.0, 270.0)}
    titles = {height: ready["layout"]["yaxis"]["title"]["text"] for height, ready in heights.items()}
    assert titles == {60.0: "place along<br>rolling [µm]", 270.0: "place along rolling [µm]"}


def test_axes_reach_over_all_frames():
    def one(k):
        rest = Line([0.0, 1.0], [1.0, 1.0], "at rest")
        return Picture([Panel([Line([0.0, 1.0], [0.0, 10.0 * k], "film"), rest], "x", "y")])

    slides = Slides([one(k) for k in (1, 2, 3)], ("speed", "rpm"), [1000.0, 2000.0, 3000.0], 1)
    figure = figure_of(slides)
    assert figure.layout.yaxis.range[1] > 30.0 and figure.layout.yaxis.range[0] < 0.0
    ready = finished(figure)
    assert ready["data"][0]["y"] == [0, 20] and [frame["data"][0]["y"] for frame in ready["frames"]][2] == [0, 30]
    assert {tuple(frame["traces"]) for frame in ready["frames"]} == {(0,)}  # what rests is there once
    assert ready["layout"]["meta"]["slider"]["texts"] == ["1000 rpm", "2000 rpm", "3000 rpm"]
    assert draw(slides).axes[0].lines[0].get_ydata().tolist() == [0.0, 20.0]


def test_both_renderers_show_what_is_described():
    """Values in the units of pictures, error bars, colours, words; a line of a name has one colour."""
    lines = [
        Line([1e-6, 2e-6], [1e6, 3e6], "film", bars=[1e5, 1e5]),
        Line([1e-6, 2e-6], [2e6, 2e6], "rest", RED, "--"),
        Line([2e-6, 3e-6], [3e6, 4e6], "film"),
    ]
    panel = Panel(lines, ("place", "m"), ("stiffness", "N/m"), title="a title", bottom=0.0)
    words = Panel([Line(np.array(["a", "b"]), [1.0, 2.0])], "term", "error")
    picture = Picture([panel, words])
    axes, bars = draw(picture).axes
    page = figure_of(picture)
    own = [trace for trace in page.data if trace.type == "scatter" and trace.fill is None]
    for drawn, line in zip(axes.lines, own, strict=True):
        np.testing.assert_allclose(drawn.get_ydata(), line.y)
        np.testing.assert_allclose(drawn.get_xdata(), line.x)
        assert drawn.get_color() == line.line.color
    assert [line.line.color for line in own] == [BLUE, RED, BLUE] and own[0].y.tolist() == [1.0, 3.0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("place [µm]", "stiffness [N/µm]")
    assert (page.layout.xaxis.title.text, page.layout.yaxis.title.text) == ("place [µm]", "stiffness [N/µm]")
    assert axes.get_title() == "a title" and axes.get_ylim()[0] == 0.0
    assert [patch.get_height() for patch in bars.patches] == [1.0, 2.0]
    assert next(trace for trace in page.data if trace.type == "bar").y.tolist() == [1.0, 2.0]


def test_stacked_bars_stand_over_words():
    """Words that read as numbers stay words; bars begin where those below end, in both renderers."""
    places = ["161.2", "266.1"]
    lines = [
        Line(places, [40.0, 70.0], "films", base=[0.0, 0.0]),
        Line(places, [60.0, 30.0], "rings", base=[40.0, 70.0]),
    ]
    picture = Picture([Panel(lines, "mode", "share [%]")])
    ready = finished(figure_of(picture))
    json.dumps(ready, allow_nan=False)
    assert [trace["base"] for trace in ready["data"]] == [[0, 0], [40, 70]]
    assert ready["data"][1]["x"] == places and ready["layout"]["xaxis"]["type"] == "category"
    assert ready["layout"]["barmode"] == "overlay"
    assert ready["data"][0]["hovertemplate"].startswith("mode: %{x}<br>")
    (axes,) = draw(picture, None).axes
    assert sorted({(bar.get_y(), bar.get_height()) for bar in axes.patches}) == [
        (0.0, 40.0), (0.0, 70.0), (40.0, 60.0), (70.0, 30.0),
    ]  # fmt: skip
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["rings", "films"]


def test_a_load_zone_points_along_the_load():
    angles = np.linspace(0.0, 2.0 * np.pi, 8, endpoint=False)
    zone = LoadZone(angles, [("outer race", np.arange(8.0), ORANGE, 1.0)], -0.5 * np.pi)
    page = figure_of(Picture([zone]))
    load = page.data[1]
    assert load.theta[0] == 270.0 and page.data[0].r.tolist() == list(range(8))
    assert page.layout.polar.radialaxis.range[1] == pytest.approx(1.25 * 7.0)
    axes = draw(Picture([zone])).axes[0]
    assert axes.get_ylim()[1] == pytest.approx(1.25 * 7.0) and len(axes.patches) == 8
    # numbers stand between two balls, away from the load
    assert np.sin(np.radians(zone.free_angle)) > 0.9
    assert np.min(np.abs(np.degrees(angles) - zone.free_angle % 360.0)) == pytest.approx(22.5)
    # and only where the bars of these two are not in the way
    ticks = page.layout.polar.radialaxis
    assert zone.longest_beside == 2.0 and ticks.tickvals[:4] == (2.0, 4.0, 6.0, 8.0)
    assert ticks.ticktext[:4] == ("", "4 N", "6 N", "8 N")


def test_numbers_are_as_short_as_the_axis_allows():
    assert rounded([0.123456789, 1.123456789]) == [0.12346, 1.12346]
    assert rounded([12.3456789, 12.3456790]) != [12.35, 12.35]  # of the span, not of the number
    assert rounded([1.23456789e-9, 1.0, np.inf], logarithmic=True) == [1.2346e-9, 1.0, None]
    assert rounded([3.0, 3.0]) == [3, 3] and rounded([]) == []
    assert rounded(np.eye(2)) == [[1, 0], [0, 1]]


def test_long_lines_keep_their_peaks():
    t = np.linspace(0.0, 1.0, 10 * LINE)
    y = np.zeros_like(t)
    y[4321], y[4322] = 7.0, -3.0
    x, kept, told = thin_line(t, y)
    assert told == "lines: of every 20 samples the lowest and the highest"
    assert x.size <= 1.1 * LINE and kept.max() == 7.0 and kept.min() == -3.0
    assert np.all(np.diff(x) > 0.0) and (x[0], x[-1]) == (0.0, 1.0)
    x, y, told = thin_line(np.cos(40.0 * t), np.sin(40.0 * t))  # a path in the plane, to its end
    assert x.size <= LINE + 1 and np.hypot(x, y) == pytest.approx(1.0) and x[-1] == np.cos(40.0)
    assert told == "paths: 1 in 10 points"
    ready = finished(figure_of(Picture([Panel([Line(t, t)], "x", "y")])))
    assert len(ready["data"][0]["x"]) < 1.1 * LINE and "samples" in ready["layout"]["meta"]["thinned"]


def test_what_is_packed_comes_out_again():
    text = 'ä "</script>" <!-- 1e-9'
    assert unpacked(packed(text)) == text and packed(text) == packed(text)
    assert "<" not in packed(text)
    script = unpacked(library())
    assert f"plotly.js v{version()}" in script[:200] and len(library()) < 2.5e6
    found = bundle({"a": {"x": [1, 2]}})
    assert json.loads(json.loads(unpacked(found["figures"]))["a"]) == {"x": [1, 2]}
    assert "</script" not in found["script"]
    with pytest.raises(ValueError):
        bundle({"a": float("nan")})


def test_numbers_stay_beside_their_units():
    kept = together("uncertain by ± 4.4 % atlas; 39.5 N s/m at 15957 rev/min, 2 roads").replace("\u00a0", "~")
    assert kept == "uncertain by ±~4.4~% atlas; 39.5~N~s/m at 15957~rev/min, 2 roads"
