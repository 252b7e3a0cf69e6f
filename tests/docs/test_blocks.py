"""Every block of code in any page or docstring is run by a test, and whoever adds one of a new kind is told so.

Python is run in `test_code.py`; here are command lines, the docstrings, and what may not be run and why.
"""

import doctest
import importlib
import inspect
import os
import pkgutil
import re
import shlex
import sys
from pathlib import Path
from types import SimpleNamespace

import fake_ross
import numpy as np
import pytest
from page_blocks import PAGES, ROOT, WRITTEN, blocks, cases, commands, fences, shell_lines

import ehlcontact
import fmu
import reduced_models
from ehlcontact.cli import main

PACKAGES = (ehlcontact, reduced_models, fmu)
RUN = {"python", "{code-cell}"}  # in test_code.py, from the top of a page to its end
NO_CODE = {"{toctree}", "{include}", "{raw}"}
NEEDS = {  # a library that may not be there: the test that runs its blocks where it is
    "ross": "test_tutorial_of_the_bearing_in_ross",
    "ecospy": "test_a_system_archive_in_other_masters",
    "libcosimpy": "test_a_system_archive_in_other_masters",
}
ELSEWHERE = {  # lines of a shell that no test calls: where they are run instead
    "pip install .": ".ci/run",
    'pip install ".[test]"': ".ci/run",
    'pip install -e ".[test,docs]"': ".ci/run",
    "pytest": ".ci/run",
    "pytest -m long": ".ci/run",
    "ruff check .": ".ci/run",
    "ruff format .": ".ci/run",
    "mypy": ".ci/run",
    "lint-imports": ".ci/run",
    ".ci/run": ".ci/run",
    "sphinx-build -W docs build/docs": ".ci/run",
    "python docs/site/links.py build/docs": ".ci/run",
}
SLOW = {  # subcommands of `ehlcontact` that take long here: why they are run with the slow tests only
    "run": "whole studies; the small one is run by .ci/run too",
    "reproduce": "six transient runs",
    "steady": "on the grid that is right, not on one for tests",
    "simulate": "likewise, hundreds of steps",
    "impedance": "likewise",
    "fit": "solves an impedance for a memory, and needs the run of `simulate`",
    "export": "compiles; the first library for Windows takes minutes",
    "verify": "needs what `export` leaves",
}


def slow(line):
    return shlex.split(line)[1] in SLOW


@pytest.mark.parametrize("page", WRITTEN)
def test_every_block_is_of_a_kind_that_is_run(page):
    for fence in fences(page):
        kinds = RUN | NO_CODE | {""}
        assert fence.kind in kinds, f"{page}:{fence.line}: say here how a block of {fence.kind} is run"
        assert fence.kind not in RUN or page in PAGES, f"{page}:{fence.line}: test_code.py does not see it"
    for line in shell_lines(page):
        known = line.startswith("ehlcontact ") or line in ELSEWHERE
        assert known, f"{page}: {line!r} is no command that is run; what is no code is indented or a table"


def test_blocks_are_found():
    """Of all kinds, with their lines; a comment is none."""
    lines = WRITTEN["README.md"].read_text(encoding="utf-8").splitlines()
    kind, text, line = fences("README.md")[0]
    assert (kind, line) == ("", lines.index("```") + 1) and text.rstrip() == lines[line]
    assert [fence.kind for fence in fences("CONTRIBUTING.md")] == ["", ""]
    assert "pytest" in shell_lines("CONTRIBUTING.md") and "mypy" in shell_lines("CONTRIBUTING.md")
    assert all("#" not in line for page in WRITTEN for line in shell_lines(page))
    assert sum(fence.kind in RUN for page in PAGES for fence in fences(page)) == sum(map(len, map(blocks, PAGES)))
    ours = {line for page in WRITTEN for line in shell_lines(page) if line.startswith("ehlcontact ")}
    assert ours == {line for page in WRITTEN for line in commands(page)}


def test_what_is_run_elsewhere_is_run_there():
    for line, place in ELSEWHERE.items():
        program = next(word for word in shlex.split(line) if not word.startswith("-"))
        text = (ROOT / place).read_text(encoding="utf-8")
        assert program == place or program in text, (line, place)


def test_blocks_that_need_a_library_have_a_test():
    told = (ROOT / "tests" / "docs" / "test_code.py").read_text(encoding="utf-8")
    needed = {block.needs for page in PAGES for block in blocks(page) if block.needs}
    assert needed == set(NEEDS)
    assert all(f"def {test}(" in told for test in NEEDS.values())


@pytest.fixture
def checkout(tmp_path, monkeypatch):
    """A folder with the examples in it, as somebody who reads the page has it."""
    monkeypatch.chdir(tmp_path)
    os.symlink(ROOT / "examples", tmp_path / "examples")
    return tmp_path


def made(line):
    """Files that a command line says it writes."""
    words = shlex.split(line)
    flags = ("-o", "--save", "--figure", "--output")
    found = [words[k + 1] for k, word in enumerate(words) if word in flags]
    return found + ([words[2]] if words[1] == "init" else [])


def called(line, folder):
    with pytest.raises(SystemExit) as stop:
        main(shlex.split(line)[1:])
    assert not stop.value.code, line
    for name in made(line):
        assert (folder / name).stat().st_size > 100, (line, name)


OURS = {page: lines for page in WRITTEN if (lines := commands(page))}


@pytest.mark.parametrize("page", cases(OURS, ["docs/guide/start.md", "docs/bearings.md", "docs/signals.md"]))
def test_quick_command_lines_do_what_they_say(page, checkout, capsys):
    """In the order of the page; `SLOW` tells which are left to the slow tests."""
    for line in OURS[page]:
        if not slow(line):
            called(line, checkout)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
@pytest.mark.parametrize("page", OURS)
def test_all_command_lines_do_what_they_say(page, checkout, capsys):
    for line in OURS[page]:
        called(line, checkout)


SAID = re.compile(r"python ((?:docs|examples|tests)/[\w./]+\.py)((?: \[?--?[\w-]+)*)")
TEXTS = [
    *WRITTEN.values(),
    *(path for room in ("docs", "examples", "tests") for path in (ROOT / room).rglob("*.py")),
]


def test_scripts_that_are_told_of_are_there():
    """With the options they are told with."""
    for script, options in SAID.findall("\n".join(path.read_text(encoding="utf-8") for path in TEXTS)):
        assert (ROOT / script).is_file(), script
        code = (ROOT / script).read_text(encoding="utf-8")
        for option in re.findall(r"--?[\w-]+", options):
            assert f'"{option}"' in code, (script, option)


def modules():
    """All of the library but what only runs as a program."""
    for package in PACKAGES:
        yield package.__name__
        for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if not found.name.endswith(("__main__", "worker")):
                yield found.name


def test_examples_in_docstrings_give_what_they_say():
    """None so far; one that is written is run."""
    finder, runner = doctest.DocTestFinder(exclude_empty=True), doctest.DocTestRunner(verbose=False)
    for name in modules():
        module = importlib.import_module(name)
        if ">>>" in Path(module.__file__).read_text(encoding="utf-8"):  # or there is nothing to look for in it
            for case in finder.find(module):
                runner.run(case)
    assert runner.failures == 0


def literal_blocks(text):
    """Indented text after a paragraph that ends in two colons."""
    return re.findall(r"::\n\n((?:(?:    .*)?\n)+)", f"{text}\n")


def ross_callback(monkeypatch):
    """A rotor of the stand-in of ROSS, steps and forces, for `RossCallback`."""
    monkeypatch.setitem(sys.modules, "ross", fake_ross.module())
    t = np.arange(5) * 1e-5
    rotor = sys.modules["ross"].Rotor([0.05] * 6, [(3, 0.28, 0.07)])
    bearing = reduced_models.BallBearing.catalogue("6205", oil=ehlcontact.Lubricant.iso_vg(68, temperature=50.0))
    return {"rotor": rotor, "bearing": bearing, "t": t, "F": np.zeros((t.size, rotor.ndof))}


BEFORE = {"RossCallback": ross_callback}  # names that the block of a docstring takes as given


def docstrings():
    for package in PACKAGES:
        for name, value in vars(package).items():
            if name[0] != "_" and (inspect.isclass(value) or inspect.isfunction(value)):
                members = [value, *(m for _, m in inspect.getmembers(value, callable) if inspect.isfunction(m))]
                for member in members:
                    for block in literal_blocks(inspect.getdoc(member) or ""):
                        yield pytest.param(name, block, id=f"{name}-{member.__name__}")


@pytest.mark.parametrize(("name", "block"), list(docstrings()))
def test_code_in_a_docstring_runs(name, block, monkeypatch):
    found = {name: getattr(next(p for p in PACKAGES if hasattr(p, name)), name)}
    found |= BEFORE.get(name, lambda _: {})(monkeypatch)
    exec(compile(inspect.cleandoc(block), f"docstring of {name}", "exec"), found)
    if name == "RossCallback":
        assert np.abs(found["displacement"]).max() < 1e-4 and found["displacement"].shape[0] == 5


def test_a_slip_in_a_docstring_is_seen():
    assert literal_blocks("As in::\n\n    x = 1\n    y = x\n\nand more.") == ["    x = 1\n    y = x\n\n"]
    case = SimpleNamespace(__doc__=">>> 1 + 1\n3\n", __name__="slip")
    runner = doctest.DocTestRunner(verbose=False)
    found = doctest.DocTestParser().get_doctest(case.__doc__, {}, "slip", None, 0)
    assert runner.run(found, out=lambda _: None).failed == 1
