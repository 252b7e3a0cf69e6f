"""Figures made ready for a page: legend, places of panels, points and digits, packing."""

import json

import numpy as np
import plotly.graph_objects as go
import pytest

from ehlcontact.cli.plots.bundle import bundle, library, packed, unpacked, version
from ehlcontact.cli.plots.finish import finished
from ehlcontact.cli.plots.style import grid, label_axes, running, shaded, vertical
from ehlcontact.cli.plots.thinned import LINE, rounded, thin_line


@pytest.fixture
def figure():
    figure = grid(2, 2, heights=[200, 100], titles="abcd", second=((1, 1),), shared=True)
    for row, col in ((1, 1), (1, 2), (2, 1), (2, 2)):
        figure.add_scatter(x=[1.0, 10.0], y=[3.0, np.nan], name="film", row=row, col=col)
        label_axes(figure, "" if row == 1 else "frequency [Hz]", "force [N]", row, col)
    figure.add_scatter(x=[1.0, 10.0], y=[7.0, 8.0], name="pressure", row=1, col=1, secondary_y=True)
    figure.add_heatmap(x=[1, 2], y=[1, 2], z=np.eye(2), coloraxis="coloraxis", row=1, col=2)
    return figure.update_layout(coloraxis={"colorbar": {"title": {"text": "film [µm]"}}})


def test_a_name_is_in_the_legend_once(figure):
    ready = finished(figure)
    json.dumps(ready, allow_nan=False)
    shown = [trace.get("name") for trace in ready["data"] if trace["showlegend"]]
    assert shown == ["film", "pressure"] and ready["layout"]["showlegend"]
    film, *_, field = ready["data"]
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
    bar = wide["coloraxis"]["colorbar"]
    low, high = wide["yaxis3"]["domain"]
    assert bar["y"] == pytest.approx(0.5 * (low + high)) and bar["x"] > wide["xaxis2"]["domain"][1]


def test_words_on_logarithmic_axes():
    figure = grid()
    figure.update_xaxes(type="log")
    vertical(figure, 100.0, "mode")
    shaded(figure, (1.0, 10.0), "")
    (note,) = figure.layout.annotations
    assert note.x == 2.0 and figure.layout.shapes[0].x0 == 100.0 and figure.layout.shapes[1].x1 == 10.0


def test_few_decades_have_few_ticks():
    """All digits lie upon one another there; over many decades, or hardly any, plotly's own ticks do not."""
    drawn = grid(3, heights=[100] * 3)
    for row, values in enumerate(((0.007, 0.1), (1e-5, 1.0), (2.0, 3.0)), start=1):
        drawn.add_scatter(x=[1.0, 2.0], y=values, row=row, col=1)
        drawn.update_yaxes(type="log", row=row, col=1)
    layout = finished(drawn)["layout"]
    assert [layout[f"yaxis{k}"].get("dtick") for k in ("", "2", "3")] == ["D2", None, None]


def test_axes_reach_over_all_frames():
    def one(k):
        return grid().add_scatter(x=[0.0, 1.0], y=[0.0, 10.0 * k], row=1, col=1)

    figure = running([one(k) for k in (1, 2, 3)], "speed", "rpm", [1000.0, 2000.0, 3000.0], 1)
    assert figure.layout.yaxis.range[1] > 30.0 and figure.layout.yaxis.range[0] < 0.0
    ready = finished(figure)
    assert ready["data"][0]["y"] == [0, 20] and [frame["data"][0]["y"] for frame in ready["frames"]][2] == [0, 30]
    assert ready["layout"]["meta"]["slider"]["texts"] == ["1000 rpm", "2000 rpm", "3000 rpm"]


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
    ready = finished(grid().add_scatter(x=t, y=t, row=1, col=1))
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


def test_figures_are_plotly_s_own():
    assert isinstance(grid(), go.Figure)
