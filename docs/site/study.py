"""The reference page of the study file, from its schema.

python docs/site/study.py   # writes docs/guide/study.md
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pydantic.fields import FieldInfo

from ehlcontact.cli.commands.bearing import ENTRIES
from ehlcontact.cli.commands.init import ENTRIES as OF_INIT
from ehlcontact.cli.entries import allowed_of, is_several, meaning_of, options_of, section_of
from ehlcontact.cli.study.schema import Study
from ehlcontact.cli.study.schema_errors import REPLACED
from ehlcontact.cli.toml import toml_value

PAGE = Path(__file__).parents[1] / "guide" / "study.md"
EXAMPLES = {
    "motor": "a motor on a 6306 and a 6206 with a wave spring",
    "motor_margins": "this motor with ranges of clearance, oil temperature, balance and damping",
    "spindle": "a spindle on a pair of 7205 and a floating bearing",
    "jump": "a fan in squeeze film dampers that jumps in a run-up: periodic answers over the speed",
    "small_study": "a light rotor, and the full film of its most loaded ball on a coarse grid",
    "deep_groove_6205": "the full film of one contact, and a Jeffcott rotor on it",
}
HEAD = """# The study file

A study is a machine in TOML: a shaft with discs, and a bearing at each support. `ehlcontact init` writes it with
every entry explained, `ehlcontact validate` says what it will do, `ehlcontact run` does it. Without `[shaft]`
the file is of a bearing alone, under the loads of `[operation]`. Sections beside `[operation]` and `[[support]]`
may be left out. `[[disc]]`, `[[support]]`, `[[damper]]` and `[[defect]]` may stand several times. An option in the
last column sets its entry in `ehlcontact bearing`, which takes sections of a bearing alone, and in `init`.

"""
FOOT = """## Sections of files of another kind

A file with one of these is refused, with what stands in its place:

| section | in its place |
|---|---|
"""


def text() -> str:
    """The page."""
    examples = "".join(
        f"- {{download}}`{name}.toml <../../examples/{name}.toml>`: {words}\n" for name, words in EXAMPLES.items()
    )
    replaced = "".join(f"| `[{name}]` | {words} |\n" for name, words in REPLACED.items())
    sections = "\n".join(_sections(Study, ""))
    return f"{HEAD}{examples}\n{sections}\n{FOOT}{replaced}"


def _sections(model: Any, above: str) -> Iterator[str]:
    """A heading and a table for each section, and for those in it."""
    own = {name: entry for name, entry in model.model_fields.items() if section_of(entry.annotation) is None}
    if above:
        yield from (_rows(own, above), "")
    for name, entry in model.model_fields.items():
        if (section := section_of(entry.annotation)) is not None:
            head = f"{above}{name}"
            several = is_several(entry.annotation)
            words = " ".join((section.__doc__ or "").split())
            yield from (f"## {'[[' if several else '['}{head}{']]' if several else ']'}", "", words, "")
            yield from _sections(section, f"{head}.")


def _rows(entries: dict[str, FieldInfo], above: str) -> str:
    options = {name: _option(f"{above}{name}") for name in entries}
    last = ["option"] if any(options.values()) else []
    heads = ["entry", "what it is", "default", *last]
    rows = [
        [f"`{name}`", _cell(entry), _default(entry), *([options[name]] if last else [])]
        for name, entry in entries.items()
    ]
    lines = [f"| {' | '.join(row)} |" for row in (heads, *rows)]
    return "\n".join((lines[0], f"|{'---|' * len(heads)}", *lines[1:]))


def _option(entry: str) -> str:
    return f"`{options_of(entry)[0]}`" if entry in {**ENTRIES, **OF_INIT} else ""


def _cell(entry: FieldInfo) -> str:
    parts = meaning_of(entry), allowed_of(entry).removeprefix("a finite number ")
    return "; ".join(part for part in parts if part).replace("|", "\\|")


def _default(entry: FieldInfo) -> str:
    if entry.is_required():
        return "must be given"
    return "" if entry.default is None else f"`{toml_value(entry.default)}`"


if __name__ == "__main__":
    PAGE.write_text(text(), "utf-8")
