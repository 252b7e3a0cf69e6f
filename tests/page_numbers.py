"""Numbers shown on an HTML page, compared with the numbers they were rounded from."""

import math
import re
from html.parser import HTMLParser

BLOCKS = ("p", "tr", "figcaption", "h1", "h2", "h3", "li")
INVISIBLE = ("style", "script", "head", "title")
NUMBER = r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
LONE = re.compile(rf"(?<![\w.]){NUMBER}")  # not part of a name, such as K1 or u2
FACTORS = (1.0, 1e2, 1e3, 1e-3, 1e6, 1e-6, 1e9, 1e-9)  # of %, g mm, GPa, um ...
EDGE = 1e-6  # of the last digit shown: two computations may round to different sides


class _Blocks(HTMLParser):
    """Text of every block; cells of a table row are separated by bars."""

    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.blocks, self._hidden = [""], 0

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
        if not self._hidden:
            self.blocks[-1] += data


def blocks_of(page):
    """Paragraphs, rows of tables, headings and captions of a page, as text."""
    parser = _Blocks()
    parser.feed(page)
    return [" ".join(block.split()).removesuffix(" |") for block in parser.blocks if block.strip()]


def numbers_of(value):
    """All numbers in a JSON value, those in its texts included."""
    if isinstance(value, dict | list):
        for entry in value.values() if isinstance(value, dict) else value:
            yield from numbers_of(entry)
    elif isinstance(value, str):
        yield from map(float, re.findall(NUMBER, value))
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield float(value)


def unknown_numbers(block, known):
    """Numbers of a block that are none of `known`, rounded, in whatever unit."""
    shown = [match[0] for match in LONE.finditer(block.replace("−", "-"))]
    return [text for text in shown if not any(is_shown(text, value * f) for value in known for f in FACTORS)]


def is_shown(shown, value, least=2):
    """Whether the number text `shown` is `value`, rounded to the digits it shows.

    Zeros at the end may have been left out, so at least to `least` figures; a whole number to ones.
    """
    number = float(shown)
    if value == 0.0 or number == 0.0:
        return value == number
    figures = re.sub(r"e.*|[-+.]", "", shown).lstrip("0")
    kept = max(len(figures if "." in shown else figures.rstrip("0")), least)
    unit = 10.0 ** (math.floor(math.log10(abs(value)) + 1e-12) - kept + 1)
    if shown.lstrip("-+").isdigit():
        unit = max(unit, 1.0)
    return abs(number - value) <= (0.5 + EDGE) * unit
