"""Links of the built site, without a network: inside each leads somewhere, outside each is a whole address.

    python docs/site/links.py build/docs   # says what is broken; exit code 1 if anything is

A page must not need another machine either: no script, style, font or picture is fetched from one.
"""

from __future__ import annotations

import sys
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

FETCHED = {"script": "src", "img": "src", "iframe": "src", "link": "href", "source": "src"}
NO_PAGE = {"canonical"}  # of a link element: said, not fetched


class Page(HTMLParser):
    """Anchors that a page has, links that it follows, files that it fetches."""

    def __init__(self) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.files: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Called for every element."""
        said = {name: value for name, value in attrs if value is not None}
        self.anchors |= {said[name] for name in ("id", "name") if name in said}
        if tag == "a" and "href" in said:
            self.links.append(said["href"])
        elif tag in FETCHED and FETCHED[tag] in said and said.get("rel") not in NO_PAGE:
            self.files.append(said[FETCHED[tag]])


@cache
def read(path: Path) -> Page:
    """A page, once."""
    page = Page()
    page.feed(path.read_text(encoding="utf-8"))
    return page


def outside(link: str) -> str | None:
    """What is wrong with an address of another machine."""
    parts = urlsplit(link)
    if parts.scheme == "mailto":
        return None if "@" in parts.path else "no address"
    if parts.scheme != "https":
        return "not https"
    return None if "." in parts.netloc and " " not in link else "no whole address"


def inside(path: Path, link: str) -> str | None:
    """What is wrong with a link of the page at `path` to this site."""
    parts = urlsplit(link)
    target = path if not parts.path else (path.parent / unquote(parts.path)).resolve()
    if not target.is_file():
        return "no such file"
    anchor = unquote(parts.fragment)
    if anchor and target.suffix == ".html" and anchor not in read(target).anchors:
        return "no such place on that page"
    return None


def faults(root: Path) -> list[str]:
    """One line for every link that leads nowhere."""
    found = []
    for path in sorted(root.resolve().rglob("*.html")):
        page = read(path)
        for link in page.links + page.files:
            parts = urlsplit(link)
            if parts.scheme == "data" or link == "#":
                continue
            if parts.scheme or parts.netloc:
                wrong = "fetched from another machine" if link in page.files else outside(link)
            else:
                wrong = inside(path, link)
            if wrong:
                found.append(f"{path.relative_to(root.resolve())}: {link}: {wrong}")
    return found


def main() -> int:
    """Say what is broken."""
    root = Path(sys.argv[1])
    found = faults(root)
    print("\n".join(found) or f"all links of {len(list(root.rglob('*.html')))} pages lead somewhere")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
