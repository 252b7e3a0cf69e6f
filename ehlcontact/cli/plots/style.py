"""Look of the figures of a page: fonts, axes, grids."""

from __future__ import annotations

from typing import Any

import plotly.graph_objects as go

from ehlcontact.results.picture import INK

SOFT, FAINT = "#59616b", "#d5d9de"  # as in page.css

_AXIS: dict[str, Any] = {
    "gridcolor": FAINT,
    "linecolor": SOFT,
    "showline": True,
    "zeroline": False,
    "ticks": "outside",
    "ticklen": 3,
    "tickcolor": SOFT,
    "exponentformat": "e",
    "title": {"standoff": 6, "font": {"size": 12}},
}
_CLEAR = "rgba(0,0,0,0)"
TEMPLATE = go.layout.Template(
    layout={
        "paper_bgcolor": _CLEAR,
        "plot_bgcolor": _CLEAR,
        "font": {"size": 12, "color": INK},
        "separators": ".\u202f",  # of thousands a narrow space
        "hovermode": "closest",
        "hoverlabel": {"font": {"size": 13}},
        "xaxis": _AXIS,
        "yaxis": _AXIS,
        "polar": {
            "bgcolor": _CLEAR,
            "radialaxis": {"gridcolor": FAINT, "nticks": 4, "angle": 20, "tickangle": 0},
            "angularaxis": {"gridcolor": FAINT, "linecolor": FAINT, "dtick": 45},
        },
        "legend": {"orientation": "h", "x": 0.0, "xanchor": "left", "yanchor": "bottom"},
        "modebar": {"bgcolor": _CLEAR, "color": SOFT, "activecolor": INK},
    },
    data={"scatter": [{"mode": "lines", "line": {"width": 2.0}}], "heatmap": [{"zsmooth": "best"}]},
)
