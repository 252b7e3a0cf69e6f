"""plotly.js and the figures of a page, packed: a page that needs no network and stays small.

Plotly, because its Python package is maintained, carries its JavaScript for `get_plotlyjs`, and draws SVG, whose
words a test can measure. That script has 4.8 MB; gzipped, and unpacked in the browser by `DecompressionStream`
(every browser since 2023), it takes 2 MB of the page.
"""

from __future__ import annotations

import base64
import gzip
import json
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any

PACKING = 6  # of gzip: 9 takes three times as long for a hundredth of the size


def packed(text: str) -> str:
    """Gzipped, in the letters of base64; the same text gives the same letters."""
    return base64.b64encode(gzip.compress(text.encode("utf-8"), PACKING, mtime=0)).decode("ascii")


def unpacked(letters: str) -> str:
    """The text behind `packed`."""
    return gzip.decompress(base64.b64decode(letters)).decode("utf-8")


@cache
def library() -> str:
    """plotly.js, packed."""
    from plotly.offline import get_plotlyjs  # imported here: no other command needs it

    return packed(get_plotlyjs())


def version() -> str:
    """Of plotly.js."""
    from plotly.offline import get_plotlyjs_version

    return str(get_plotlyjs_version())


def bundle(figures: Mapping[str, Any]) -> dict[str, str]:
    """What the page's template puts in: the library and the figures, both packed, and our script."""
    texts = {name: json.dumps(one, separators=(",", ":"), allow_nan=False) for name, one in figures.items()}
    script = files("ehlcontact.cli") / "templates" / "figures.js"
    return {
        "library": library(),
        "figures": packed(json.dumps(texts)),
        "script": script.read_text(encoding="utf-8"),
        "version": version(),
    }
