"""Figures taken apart for the browser: panels, traces, marks, and how much of them is left."""

import json

import numpy as np
import pytest
from matplotlib.figure import Figure

from ehlcontact.cli.plots.live.bundle import bundle, library, packed, unpacked, version
from ehlcontact.cli.plots.live.scene import scene_of
from ehlcontact.cli.plots.live.thinned import LINE, MAP, rounded, thin_line, thin_map


@pytest.fixture
def figure():
    figure = Figure(figsize=(9.0, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    left.plot([1.0, 10.0, 100.0], [3.0, np.nan, 5.0], "--o", color="#0072b2", label="film", fillstyle="none")
    left.axhline(4.0, color="#7f7f7f", label="rest")
    left.axvline(20.0, color="black", linestyle=":")
    left.axvspan(2.0, 3.0, color="#eaf3fa", label="valid")
    left.annotate("mode", (20.0, 0.5), xycoords=("data", "axes fraction"))
    left.set(xscale="log", xlabel="frequency [Hz]", ylabel="force [N]", xlim=(1.0, 100.0), ylim=(2.0, 6.0))
    place = {"origin": "lower", "extent": (0, 3, 0, 2), "aspect": "auto"}
    image = right.imshow(np.arange(6.0).reshape(2, 3), cmap="gray", **place)
    figure.colorbar(image, ax=right, label="film [µm]")
    beside = left.twinx()
    beside.plot([1.0, 2.0], [7.0, 8.0], color="#d55e00", label="pressure")
    beside.set_ylabel("p")
    figure.suptitle("not to scale")
    figure.draw_without_rendering()
    return figure


def test_a_figure_is_its_panels(figure):
    scene = scene_of(figure)
    json.dumps(scene, allow_nan=False)
    left, right = scene["panels"]
    assert scene["note"] == "not to scale" and scene["thinned"] == ""
    assert (left["row"], left["column"], right["row"], right["column"]) == (0, 0, 0, 1)
    assert left["x"] | {"alone": 0} == {
        "label": "frequency [Hz]",
        "log": True,
        "range": [1.0, 100.0],
        "ticks": None,
        "color": None,
        "alone": 0,
    }
    assert right["y"]["label"] == "" and right["y"]["alone"] == "force [N]"
    assert right["matches"] == {"x": None, "y": 0} and left["matches"] == {"x": None, "y": None}


def test_lines_marks_and_notes(figure):
    left = scene_of(figure)["panels"][0]
    film, rest, pressure = left["traces"]
    assert (film["name"], film["x"], film["y"]) == ("film", [1.0, 10.0, 100.0], [3, None, 5])
    assert film["line"]["dash"] == "dash" and film["marker"]["symbol"] == "circle-open"
    assert (rest["x"], rest["y"]) == ([1.0, 100.0], [4.0, 4.0])
    assert pressure["second"] and left["y2"]["label"] == "p"
    line, stretch = left["marks"]
    assert line["x"] == 20.0 and line["line"]["dash"] == "dot" and "y" not in line
    assert (stretch["x0"], stretch["x1"], stretch["fill"], stretch["name"]) == (2.0, 3.0, "#eaf3fa", "valid")
    (note,) = left["notes"]
    assert (note["text"], note["x"], note["y"], note["shares"]) == ("mode", 20.0, 0.5, [False, True])


def test_maps_have_their_numbers(figure):
    (field,) = scene_of(figure)["panels"][1]["traces"]
    assert field["x"] == [0.5, 1.5, 2.5] and field["y"] == [0.5, 1.5]
    assert np.array(field["z"]) == pytest.approx(np.arange(6.0).reshape(2, 3), abs=0.01)
    assert (field["zmin"], field["zmax"], field["label"]) == (0.0, 5.0, "film [µm]")
    assert field["colorscale"][0] == [0.0, "#000000"] and field["colorscale"][-1] == [1.0, "#ffffff"]


def test_polar_bars_and_arrows():
    figure = Figure()
    axes = figure.add_subplot(projection="polar")
    axes.bar([0.0, 0.5 * np.pi], [3.0, 4.0], width=0.2, color="#0072b2", label="inner")
    axes.annotate("", xy=(np.pi, 5.0), xytext=(np.pi, 4.5), arrowprops={"color": "#d55e00"})
    axes.set_rlim(0.0, 6.0)
    (panel,) = scene_of(figure)["panels"]
    bars, arrow = panel["traces"]
    assert panel["polar"] == 6.0 and bars["r"] == [3, 4]
    assert bars["theta"] == pytest.approx([0.0, 90.0], abs=0.02)
    assert bars["width"] == pytest.approx([11.46] * 2, abs=0.01)
    assert arrow["r"] == [4.5, 5.0] and arrow["theta"] == [180.0, 180.0]


def test_contours_are_not_joined():
    figure = Figure()
    axes = figure.subplots()
    x = np.linspace(-3.0, 3.0, 121)
    axes.contour(x, x, np.abs(x)[None, :] + 0.0 * x[:, None], [1.0])  # two lines apart
    x = np.array(scene_of(figure)["panels"][0]["traces"][0]["x"], dtype=float)
    steps = np.abs(np.diff(x))
    assert np.nanmax(steps) < 0.01 and np.count_nonzero(np.isnan(x)) == 2


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
    assert thin_line(t[:LINE], t[:LINE])[2] == ""


def test_large_maps_are_thinned():
    values, strides = thin_map(np.ones((3 * MAP[0], MAP[1])))
    assert strides == (3, 1) and values.shape == MAP


def test_what_is_packed_comes_out_again():
    text = 'ä "</script>" <!-- 1e-9'
    assert unpacked(packed(text)) == text and packed(text) == packed(text)
    assert "<" not in packed(text)
    script = unpacked(library())
    assert f"plotly.js v{version()}" in script[:200] and len(library()) < 2.5e6
    found = bundle({"a": {"x": [1, 2]}})
    assert json.loads(unpacked(found["scenes"])) == {"a": {"x": [1, 2]}} and "</script" not in found["script"]
    with pytest.raises(ValueError):
        bundle({"a": float("nan")})
