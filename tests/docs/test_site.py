"""What the site is made of: the reference has every public name, the README its marks, links lead somewhere."""

import inspect
import re
import tomllib
from dataclasses import fields, is_dataclass
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace

import pytest
import typer
from programs import script

import ehlcontact
import ehlcontact.film
import fmu
import reduced_models
import reduced_models.signals
from ehlcontact.cli.app import app

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PACKAGES = {
    package.__name__: package
    for package in (ehlcontact, ehlcontact.film, reduced_models, reduced_models.signals, fmu)
}


def public(package):
    """Names that a package shows, without its rooms and its version."""
    names = {n for n, value in vars(package).items() if n[0] != "_" and not inspect.ismodule(value)}
    return names & set(getattr(package, "__all__", names))


def described():
    """(package or module, directive, name) of every entry of the reference."""
    found = []
    for page in sorted((DOCS / "api").glob("*.rst")):
        text = page.read_text(encoding="utf-8")
        package = re.search(r"^.. currentmodule:: ([\w.]+)$", text, flags=re.M)[1]
        for directive, entry in re.findall(r"^.. auto((?!module)\w+):: ([\w.]+)$", text, flags=re.M):
            module, _, name = entry.rpartition(".")
            found.append((module or package, directive, name))
    return found


@pytest.mark.parametrize("name", PACKAGES)
def test_reference_has_every_public_name_once(name):
    entries = [entry for package, _, entry in described() if package == name]
    assert sorted(entries) == sorted(public(PACKAGES[name])), "a line in a page of docs/api for each"


def test_entries_are_of_their_kind():
    for package, directive, name in described():
        value = getattr(import_module(package), name)
        if not inspect.isclass(value):
            assert directive == "function", name
        else:
            assert directive == ("exception" if issubclass(value, BaseException) else "class"), name


def test_every_field_is_described():
    """By its name, in the list of parameters of its class or a base, or in the text of a small class."""
    for package, _, name in described():
        if not is_dataclass(kind := getattr(import_module(package), name)):
            continue
        text = "\n\n".join(inspect.getdoc(own) for own in kind.__mro__ if is_dataclass(own))
        lists = re.findall(r"^(?:Parameters|Attributes)\n-+\n(.*?)(?=^\w+\n-+\n|\Z)", text, flags=re.M | re.S)
        heads = [line.split(" : ")[0] for part in lists for line in part.splitlines() if re.match(r"\w", line)]
        listed = {word.strip() for head in heads for word in head.split(",")} | set(re.findall(r"`(\w+)`", text))
        assert {field.name for field in fields(kind) if field.name[0] != "_"} - listed == set(), name


def test_marks_of_the_readme():
    """The site shows parts of the README, and of that of the examples, between marks, in this order."""
    marks = {}
    for name in ("README.md", "examples/README.md"):
        text = (ROOT / name).read_text(encoding="utf-8")
        marks[name] = re.findall(r"<!-- docs: (.*?) -->", text)
    assert marks["README.md"] == ["what it is", "how it is used", "tasks", "end"]
    assert marks["examples/README.md"] == ["examples", "end of the examples"]
    pages = "".join(page.read_text(encoding="utf-8") for page in DOCS.rglob("*.md"))
    asked = re.findall(r"<!-- docs: (.*?) -->", pages)
    assert set(asked) == {mark for found in marks.values() for mark in found}


def test_the_explorer_is_part_of_the_site(tmp_path):
    """Made anew as the site is built, framed and linked by a page of its own, which the index names first."""
    page = (DOCS / "guide" / "explorer.md").read_text(encoding="utf-8")
    assert re.findall(r'(?:src|href)="([^"]+)"', page) == ["../explore.html"] * 2
    index = (DOCS / "index.md").read_text(encoding="utf-8")
    assert "\nguide/explorer\n" in index and "(guide/explorer.md)" in index
    assert "ehlcontact explore" in (ROOT / "README.md").read_text(encoding="utf-8")
    pytest.importorskip("sphinx", reason="no Sphinx is installed: pip install 'ehlcontact[docs]'")
    conf = script(DOCS / "conf.py")
    connected = {}
    app = SimpleNamespace(builder=SimpleNamespace(format="html"), outdir=tmp_path, connect=connected.__setitem__)
    app.add_html_math_renderer = lambda *_: None
    conf.setup(app)
    connected["build-finished"](app, ValueError("a build that failed"))
    assert list(tmp_path.iterdir()) == []
    connected["build-finished"](app, None)
    assert "Ball bearing explorer" in (tmp_path / "explore.html").read_text(encoding="utf-8")


def test_calls_and_commands_of_the_how_to_are_there():
    """Functions, classes and methods by their names; subcommands and options of the program."""
    text = (DOCS / "guide" / "howto.md").read_text(encoding="utf-8")
    shown = {name: getattr(import_module(package), name) for package, _, name in described()}
    members = {name for value in shown.values() if inspect.isclass(value) for name in dir(value)}
    code = re.findall(r"`([^`]+)`", text)
    calls = {name for part in code for name in re.findall(r"([\w.]+)\(", part)}
    assert len(calls) > 30
    for call in calls:
        first, *rest = call.strip(".").split(".")
        assert first in shown or (rest and rest[0] in members) or first in members, call
        assert not (rest and first in shown) or hasattr(shown[first], rest[0]), call
    root = typer.main.get_command(app)
    options = {name for command in root.commands.values() for one in command.params for name in one.opts}
    for part in code:
        words = part.split()
        assert words[0] != "ehlcontact" or words[1] in root.commands, part
        assert {word for word in words if word.startswith("--")} <= options, part


def test_the_built_site_is_not_kept():
    assert "build/" in (ROOT / ".gitignore").read_text(encoding="utf-8").split()


def test_extra_and_step_of_ci():
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"][
        "optional-dependencies"
    ]
    assert {re.split("[<>=]", name)[0] for name in extras["docs"]} == {"sphinx", "furo", "myst-nb", "numpydoc"}
    script = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    assert "sphinx-build -W" in script and "docs/site/links.py" in script


@pytest.fixture(scope="module")
def links():
    return script(DOCS / "site" / "links.py")


GOOD = '<a href="b.html#there">x</a><a href="#here">x</a><p id="here"></p><a href="https://fmi-standard.org">x</a>'


@pytest.mark.parametrize(
    ("added", "words"),
    [
        ("", None),
        ('<a href="c.html">x</a>', "c.html: no such file"),
        ('<a href="b.html#gone">x</a>', "no such place"),
        ('<a href="http://fmi-standard.org">x</a>', "not https"),
        ('<a href="https://fmi standard">x</a>', "no whole address"),
        ('<script src="https://cdn.example.org/x.js"></script>', "fetched from another machine"),
        ('<img src="gone.png">', "gone.png: no such file"),
    ],
)
def test_links_that_lead_nowhere_are_found(links, tmp_path, added, words):
    (tmp_path / "a.html").write_text(GOOD + added)
    (tmp_path / "b.html").write_text('<h1 id="there"></h1>')
    found = links.faults(tmp_path)
    assert (found == []) if words is None else (len(found) == 1 and words in found[0])


def test_links_of_the_pages_themselves():
    """Those of markdown, as a reader of the repository follows them; outside ones are whole addresses."""
    for page in [ROOT / "README.md", *DOCS.rglob("*.md")]:
        for link in re.findall(r"\]\(<?([^)>\s]+)>?\)", page.read_text(encoding="utf-8")):
            if "://" in link:
                assert re.match(r"https://[\w.-]+\.\w+(/|$)", link), (page.name, link)
            elif not link.startswith("#"):
                assert (page.parent / link.split("#")[0]).exists(), (page.name, link)


def test_the_citation_is_of_this_version():
    said = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.search(r"^version: (\S+)$", said, flags=re.M)[1] == ehlcontact.__version__


@pytest.mark.slow
def test_the_numbers_beside_the_first_picture():
    why = script(DOCS / "why.py")
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    found, _, _ = why.respond(why.load_study(why.STUDY))
    peak = {name: resonance.amplitude for name, resonance in found.peaks["y"].items()}
    pattern = r"by default \| 0\.2 \|\n.*damper fitted at another frequency \| (\d+) \|\n.*damp \| (\d+) \|"
    told = re.search(pattern, text)
    assert told is not None
    assert peak[why.FULL] / peak[why.GUESSED] == pytest.approx(5.0, abs=0.5)
    assert peak[why.DRY] / peak[why.FULL] == pytest.approx(float(told[2]), abs=0.5)
    assert peak[why.CUBIC] / peak[why.FULL] == pytest.approx(float(told[1]), abs=0.5)
    assert peak[why.MEMORY] / peak[why.FULL] == pytest.approx(1.0, abs=0.03)
