"""The README keeps its word: links lead somewhere, commands are taken, numbers are those of the picture."""

import importlib.util
import re
import shlex
from pathlib import Path

import pytest

from ehlcontact import __version__

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```(\w*)\n(.*?)```", TEXT, flags=re.S)
COMMANDS = [
    part
    for kind, block in BLOCKS
    if not kind
    for line in block.splitlines()
    for part in line.partition("   #")[0].split("&&")
    if part.strip().startswith("ehlcontact")
]


def test_links_lead_somewhere():
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]
    for page in pages:
        text = page.read_text(encoding="utf-8")
        for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", text):
            if not target.startswith("http"):
                assert (page.parent / target).exists(), f"{page.name}: {target}"


def test_there_are_commands():
    assert len(COMMANDS) >= 10
    assert "ehlcontact run examples/small_study.toml" in COMMANDS[0]


@pytest.mark.parametrize("line", COMMANDS)
def test_commands_are_taken(line):
    """By the parser: options that there are, with values of their kind. What they do is tested elsewhere."""
    import typer

    from ehlcontact.cli.app import app

    command, arguments = typer.main.get_command(app), shlex.split(line)[1:]
    while hasattr(command, "commands"):
        command, arguments = command.commands[arguments[0]], arguments[1:]
    command.make_context(command.name, arguments)
    for word in arguments:
        if word.startswith("examples/"):
            assert (ROOT / word).exists()


def test_the_citation_is_of_this_version():
    said = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.search(r"^version: (\S+)$", said, flags=re.M)[1] == __version__


@pytest.mark.slow
def test_the_numbers_beside_the_first_picture():
    spec = importlib.util.spec_from_file_location("why", ROOT / "docs" / "why.py")
    why = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(why)
    found, _, _ = why.respond(why.load_study(why.STUDY))
    peak = {name: resonance.amplitude for name, resonance in found.peaks["y"].items()}
    told = re.search(
        r"gives a fifth of the peak .* no film (\d+) times, .* (\d+) times as much", TEXT.replace("\n", " ")
    )
    assert peak[why.FULL] / peak[why.GUESSED] == pytest.approx(5.0, abs=0.5)
    assert peak[why.DRY] / peak[why.FULL] == pytest.approx(float(told[1]), abs=0.5)
    assert peak[why.CUBIC] / peak[why.FULL] == pytest.approx(float(told[2]), abs=0.5)
    assert peak[why.MEMORY] / peak[why.FULL] == pytest.approx(1.0, abs=0.03)
