"""All numbers of an HTML page, each to be claimed by somebody who knows it from elsewhere."""

import math
import re
from html.parser import HTMLParser

BLOCKS = ("p", "tr", "figcaption", "h1", "h2", "h3", "li")
INVISIBLE = ("style", "script", "head", "title")
NUMBER = r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
LONE = re.compile(rf"(?<![\w.]){NUMBER}")  # not part of a name, such as K1 or u2
SLOT = rf"(?<![\w.])((?:below )?{NUMBER}|-)(?![\w.]*\d)"
ASCII = str.maketrans({"µ": "u", "μ": "u", "Ω": "Omega", "ω": "omega", "≤": "<=", "≥": ">=", "−": "-"})
EDGE = 1e-6  # of the last digit shown: where two computations of it may round to different sides


class _Blocks(HTMLParser):
    """Text of every block; cells are kept apart by bars."""

    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.blocks, self._open, self._hidden = [], [], 0

    def handle_starttag(self, tag, attrs):
        if tag in INVISIBLE:
            self._hidden += 1
        elif tag in BLOCKS:
            self.blocks.append("")

    def handle_endtag(self, tag):
        if tag in INVISIBLE:
            self._hidden -= 1
        elif tag in ("td", "th"):
            self.blocks[-1] += " | "

    def handle_data(self, data):
        if self._hidden:
            return
        if not self.blocks:
            self.blocks.append("")
        self.blocks[-1] += data


class PageNumbers:
    """Text of a page by blocks, and what of it has been claimed."""

    def __init__(self, page):
        parser = _Blocks()
        parser.feed(page)
        self.blocks = [" ".join(block.translate(ASCII).split()).removesuffix(" |") for block in parser.blocks]
        self._claimed = [bytearray(len(block)) for block in self.blocks]

    def claim(self, text, *values, least=2):
        """Claim `text`, which stands once in what nobody has claimed yet, with a number of `values` at each ``#``.

        None is a dash. For `least` see `is_shown`.
        """
        pattern = re.escape(" ".join(text.split())).replace(r"\#", SLOT)
        found = [
            (k, match)
            for k, block in enumerate(self.blocks)
            for match in re.finditer(pattern, block)
            if not any(self._claimed[k][match.start() : match.end()])
        ]
        assert len(found) == 1, f"{text!r} stands {len(found)} times on the page"
        k, match = found[0]
        assert len(match.groups()) == len(values), text
        for shown, value in zip(match.groups(), values, strict=True):
            assert is_shown(shown, value, least), f"{text!r}: {shown} on the page, {value!r} computed"
        self._claimed[k][match.start() : match.end()] = b"\1" * (match.end() - match.start())

    @property
    def left(self):
        """Numbers that nobody has claimed, with what stands beside them."""
        return [
            f"{match[0]} in ...{block[max(0, match.start() - 40) : match.end() + 20]}..."
            for block, claimed in zip(self.blocks, self._claimed, strict=True)
            for match in LONE.finditer(block)
            if not all(claimed[match.start() : match.end()])
        ]


def is_shown(shown, value, least=2):
    """Whether the number text `shown` is `value`, rounded to the digits it shows.

    Zeros at the end may have been left out, so at least to `least` figures; but a whole number to ones.
    """
    if shown == "-" or value is None:
        return shown == "-" and value is None
    value = float(value)
    if shown.startswith("below "):
        return abs(value) < float(shown.removeprefix("below ")) and value != 0.0
    number = float(shown)
    if value == 0.0 or number == 0.0:
        return value == number
    figures = re.sub(r"e.*|[-+.]", "", shown).lstrip("0")
    kept = max(len(figures if "." in shown else figures.rstrip("0")), least)
    unit = 10.0 ** (math.floor(math.log10(abs(value)) + 1e-12) - kept + 1)
    if shown.lstrip("-+").isdigit():
        unit = max(unit, 1.0)
    return abs(number - value) <= (0.5 + EDGE) * unit
