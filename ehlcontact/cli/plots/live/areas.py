"""Maps, fields of colour, lines right across and notes of matplotlib's axes, for plotly.js."""

from __future__ import annotations

import base64
import io
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.contour import ContourSet
from matplotlib.image import AxesImage, imsave
from matplotlib.patches import Ellipse, Polygon, Rectangle
from matplotlib.path import Path
from matplotlib.text import Annotation

from ehlcontact.cli.plots.live.lines import DASHES, PIXELS, crosses, label_of
from ehlcontact.cli.plots.live.thinned import rounded, thin_map

COLOURS = 11  # of a colour map, between which the browser mixes
LEVELS = 500.0  # that a map tells apart; a screen shows 256
COARSER = 2  # steps from point to point of a picture in colours
EVERY = 4  # of the points of a contour

Mark = dict[str, Any]


def map_of(image: AxesImage) -> tuple[Mark, tuple[int, int]]:
    """A trace with the numbers behind a picture of one field, and the strides it was thinned by."""
    whole: Any = image.get_array()
    values, strides = thin_map(np.ma.filled(whole, np.nan))
    left, right, bottom, top = image.get_extent()
    ny, nx = np.shape(whole)[:2]
    cells = ((left, right, nx, strides[1]), (bottom, top, ny, strides[0]))
    x, y = ((low + (high - low) / n * (np.arange(n) + 0.5))[::every] for low, high, n, every in cells)
    scale = np.linspace(0.0, 1.0, COLOURS)
    bar, norm = image.colorbar, image.norm
    low, high = np.ravel([norm.vmin, norm.vmax]).astype(float).tolist()
    return {
        "type": "heatmap",
        "x": rounded(x),
        "y": rounded(y),
        "z": rounded(values, fineness=LEVELS),
        "zmin": low,
        "zmax": high,
        "zsmooth": "best",
        "colorscale": [[float(at), to_hex(image.get_cmap()(at))] for at in scale],
        "label": "" if bar is None else bar.ax.get_ylabel() or bar.ax.get_xlabel(),
    }, strides


def picture_of(image: AxesImage) -> Mark:
    """A picture in colours of its own, as it is."""
    buffer = io.BytesIO()
    imsave(buffer, np.clip(np.asarray(image.get_array())[::-COARSER, ::COARSER], 0.0, 1.0), format="png")
    left, right, bottom, top = image.get_extent()
    address = "data:image/png;base64," + base64.b64encode(buffer.getvalue()).decode("ascii")
    return {"source": address, "x": left, "y": top, "sizex": right - left, "sizey": top - bottom}


def contours_of(lines: ContourSet) -> Mark:
    """All lines of a contour plot as one trace that cannot be pointed at."""
    x, y = [], []
    for path in lines.get_paths():
        starts = np.flatnonzero(path.codes == Path.MOVETO) if path.codes is not None else np.array([0])
        for piece in np.split(path.vertices, starts[1:]):
            x += [*piece[:-1:EVERY, 0], *piece[-1:, 0], np.nan]
            y += [*piece[:-1:EVERY, 1], *piece[-1:, 1], np.nan]
    line = {"color": "#ffffff", "width": 0.8}
    coordinates = {"x": rounded(x), "y": rounded(y)}
    return {"type": "scatter", "mode": "lines", "name": "", "hoverinfo": "skip", "line": line, **coordinates}


def marks_of(axes: Axes) -> list[Mark]:
    """Lines right across without a name, coloured stretches, ellipses: in the data, or in shares of the axes."""
    found: list[Mark] = []
    for line in axes.get_lines():
        if crosses(line) and not label_of(line):
            x, y = (np.asarray(data, dtype=float) for data in line.get_data(orig=False))
            level = y[0] == y[-1]
            place = {"y": float(y[0])} if level else {"x": float(x[0])}
            look = {"color": to_hex(line.get_color()), "dash": DASHES.get(str(line.get_linestyle()), "solid")}
            found.append({"kind": "line", **place, "line": look | {"width": 1.2}})
    for patch in axes.patches:
        if isinstance(patch, Ellipse):
            middle: Any = patch.get_center()
            (x, y), w, h = middle, patch.get_width(), patch.get_height()
            box = {"x0": x - w / 2, "x1": x + w / 2, "y0": y - h / 2, "y1": y + h / 2}
            edge = {"color": to_hex(patch.get_edgecolor()), "dash": "dash", "width": PIXELS}
            found.append({"kind": "ellipse", **{key: float(v) for key, v in box.items()}, "line": edge})
        elif isinstance(patch, Rectangle | Polygon):
            corners = patch.get_patch_transform().transform(patch.get_path().vertices)[:, 0]
            ends = {"x0": float(corners.min()), "x1": float(corners.max())}
            fill = {"fill": to_hex(patch.get_facecolor()), "name": label_of(patch)}
            found.append({"kind": "stretch", **ends, **fill})
    return found


def notes_of(axes: Axes) -> list[Mark]:
    """Words on the axes: each coordinate in the data, or as a share of the axes."""
    found = []
    for text in axes.texts:
        if not isinstance(text, Annotation) or not text.get_text().strip():
            continue
        told = text.xycoords
        ways = told if isinstance(told, tuple) else (told, told)
        found.append(
            {
                "text": text.get_text().strip(),
                "x": float(text.xy[0]),
                "y": float(text.xy[1]),
                "shares": [way == "axes fraction" for way in ways],
                "anchors": [text.get_horizontalalignment(), _vertical(text)],
                "color": to_hex(text.get_color()),
            }
        )
    return found


def _vertical(text: Annotation) -> str:
    """What plotly.js calls that alignment."""
    return {"top": "top", "bottom": "bottom", "baseline": "bottom"}.get(text.get_verticalalignment(), "middle")
