"""Blocks of code in pages of markdown, as a reader would run them: from the top of a page to its end."""

import re
from collections.abc import Collection, Iterable
from pathlib import Path
from typing import Any, NamedTuple

import pytest

ROOT = Path(__file__).parents[1]
BLOCK = re.compile(r"(?:<!-- needs: (\w+) -->\n)?^```(python|\{code-cell\})\n(.*?)^```$", flags=re.M | re.S)
FENCE = re.compile(r"^ *(?P<ticks>`{3,}|:{3,})(?P<kind>\S*).*\n(?P<text>(?:.*\n)*?) *(?P=ticks)$", flags=re.M)
WRITTEN = {  # every page that there is
    str(path.relative_to(ROOT)): path
    for path in (
        *sorted(ROOT.glob("*.md")),
        *sorted(ROOT.glob("examples/**/*.md")),
        *sorted(ROOT.glob("docs/**/*.md")),
    )
}
PAGES = {name: path for name, path in WRITTEN.items() if BLOCK.search(path.read_text(encoding="utf-8"))}


def cases(pages: Iterable[str], long: Collection[str]) -> list[Any]:
    """Pages as cases of a test, some of them for `pytest -m long`."""
    return [pytest.param(page, marks=pytest.mark.long) if page in long else page for page in pages]


class Block(NamedTuple):
    """One of a page."""

    code: str
    line: int  # of the page, of its first line
    needs: str | None  # a library that an extra brings


def blocks(page: str) -> list[Block]:
    """All of a page, in its order; tags of notebooks left out."""
    text, found = PAGES[page].read_text(encoding="utf-8"), []
    for match in BLOCK.finditer(text):
        code = re.sub(r"^:\w+:.*$", "", match[3], flags=re.M)
        found.append(Block(code, text[: match.start(3)].count("\n") + 1, match[1]))
    return found


def run(
    page: str,
    names: dict,
    *,
    have: set[str] = frozenset(),
    only: str | None = None,
    put: dict[str, str] | None = None,
) -> None:
    """Execute a page in `names`; an error tells the page and its line.

    Blocks that need what is not in `have` are left out; with `only`, all but those that need it. `put` replaces
    text.
    """
    for block in blocks(page):
        if (block.needs is None and only is None) or (block.needs in have and only in (None, block.needs)):
            source = "\n" * (block.line - 1) + block.code
            for old, new in (put or {}).items():
                source = source.replace(old, new)
            exec(compile(source, str(PAGES[page]), "exec"), names)


class Fence(NamedTuple):
    """A fenced block of any kind."""

    kind: str  # what stands behind the ticks
    text: str
    line: int  # of the page, of its ticks


def fences(page: str) -> list[Fence]:
    """All of a page, in its order."""
    text = WRITTEN[page].read_text(encoding="utf-8")
    return [Fence(f["kind"], f["text"], text[: f.start()].count("\n") + 1) for f in FENCE.finditer(text)]


def shell_lines(page: str) -> list[str]:
    """Every command of a page's plain blocks, without comments; what `&&` joins is two."""
    lines = [line for fence in fences(page) if not fence.kind for line in fence.text.splitlines()]
    parts = [part.strip() for line in lines for part in re.sub(r"(^|\s{2,})#.*", "", line).split("&&")]
    return [part for part in parts if part]


def commands(page: str) -> list[str]:
    """Lines of a page's plain blocks that call the program, from its name on, without comments."""
    fenced = [fence.text for fence in fences(page) if not fence.kind]
    lines = [line.split("#")[0].strip() for block in fenced for line in block.splitlines()]
    return [line[line.index("ehlcontact ") :] for line in lines if re.search(r"(^|&& )ehlcontact ", line)]
