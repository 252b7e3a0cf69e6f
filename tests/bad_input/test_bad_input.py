"""Bad input of every kind: one line that names the input and what it may be, soon, and nothing is lost.

The tables beside this file hold command lines, study files, damaged files, Python calls and their arguments.
"""

import errno
import json
import os
import re
import shlex
import subprocess
import sys
import time
import tomllib
from copy import deepcopy
from datetime import date
from pathlib import Path

import pytest
from bad_input import files, kinds, methods
from bad_input.calls import CALLS, full_contact
from bad_input.commands import COMMANDS, ELEMENT, FILM, OTHER, RECORD, STUDY, at, bearing, steady
from bad_input.fields import FIELDS, INF, NAMED, NAN
from bad_input.studies import SLIPS, SMALL
from balls import OF_6205

from ehlcontact import (
    Grid,
    HarmonicLoad,
    InputError,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    RunSettings,
    TimeSteps,
    kernel_cache,
    read,
    save,
    simulate,
    solve_steady,
)
from ehlcontact.cli import main
from ehlcontact.cli.entries import section_of
from ehlcontact.cli.page import _drawn
from ehlcontact.cli.plots.finish import finished
from ehlcontact.cli.study.schema import Study, load_study, study_of
from ehlcontact.jit import jit
from reduced_models import Atlas, BallBearing, SpringContact

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.usefixtures("quiet")

NAMED_FIRST = "^(length of |shape of )?{}[^=]* = .*: must be "
SECONDS = 2.0  # of the processor
SAMPLE = [
    ("init", STUDY),
    steady(M="1e9"),
    steady(alpha="20"),
    steady("--save", RECORD, "--json", RECORD),
    at("simulate", "--free", "314000"),
    at("impedance", "--Omega", "x"),
    ("fit", RECORD, RECORD),
    at("element", eta0="3"),
    ("export", RECORD, "-o", "new.fmu"),
    ("verify", ELEMENT),
    ("validate", STUDY, "--json", STUDY),
    ("explore", "-o", "k.json"),
    ("run", STUDY, "--jobs", "0"),
    ("reproduce", "--table", "7"),
    ("atlas", "build", "-o", "new.h5", "--scheduler", "nowhere"),
    bearing("6205", load="0"),
]


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    """A folder with sound files of every kind that commands read, and with some that they could replace."""
    folder = tmp_path_factory.mktemp("good")
    for name, M in ((RECORD, 20.0), (OTHER, 30.0)):
        save(
            simulate(
                MoesPoint(M, 5, 0.5),
                HarmonicLoad(Omega=3.0),
                grid=Grid(n=16),
                time=TimeSteps(until=0.5, dt=0.05),
                run=RunSettings(throw=False),
            ),
            folder / name,
        )
    save(solve_steady(MoesPoint(20, 5, 0.5), grid=Grid(n=16), throw=False), folder / FILM)
    save(SpringContact.cubic(K1=1.0, K2=0.1, K3=0.1, C1=0.01, low=0.7, high=1.0), folder / ELEMENT)
    (folder / STUDY).write_text(SMALL)
    for name in ("x.fmu", "new.h5", "k.json", "slip.toml"):
        (folder / name).write_text("kept")
    return folder


@pytest.fixture(scope="module")
def compiled():
    """Kernels of bearings, and fmpy, which asks `ldconfig` once: what is told soon is not told meanwhile."""
    pytest.importorskip("fmpy")
    oil = Lubricant.iso_vg(68, temperature=50.0)
    BallBearing.catalogue("6205", oil=oil).equilibrium((0.0, -500.0), speed_rpm=1000.0)


@pytest.fixture
def refused(good, compiled, capsys, monkeypatch):
    """``refused(arguments, words)``: exit 2, one line that holds the words, soon, and not a byte is changed."""
    monkeypatch.chdir(good)
    monkeypatch.setattr(subprocess, "Popen", None)  # no worker is started

    def run(arguments, words, folder=good):
        before, started = contents(folder), time.process_time()
        with pytest.raises(SystemExit) as stop:
            main([str(part) for part in arguments])
        spent, said = time.process_time() - started, capsys.readouterr()
        assert stop.value.code == 2 and said.out == "", said
        assert len(said.err.splitlines()) == 1, said.err
        line = said.err.strip()
        assert line.startswith("ehlcontact: ") and [word for word in words if word not in line] == [], line
        assert spent < SECONDS and contents(folder) == before

    return run


def contents(folder):
    """What is in the files of a folder."""
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_every_subcommand_is_among_them():
    from ehlcontact.cli.app import app

    known = {command.name or command.callback.__name__ for command in app.registered_commands} | {"atlas"}
    assert known <= {arguments[0] for arguments, _ in COMMANDS}
    assert known <= {arguments[0] for arguments in SAMPLE}


@pytest.mark.parametrize(("arguments", "words"), COMMANDS, ids=lambda part: shlex.join(part)[:60])
def test_command_lines(refused, monkeypatch, arguments, words):
    monkeypatch.setattr("ehlcontact.steady.solve_steady", None)  # nothing is solved
    refused(arguments, words)


@pytest.mark.parametrize("old", SLIPS, ids=lambda old: old.split("\n")[0][:40])
def test_studies(refused, good, old):
    assert old in SMALL
    for new, *words in SLIPS[old]:
        (good / "slip.toml").write_text(SMALL.replace(old, new, 1))
        refused(("run", "slip.toml", "-o", "results"), ("slip.toml", *words))
        refused(("validate", "slip.toml", "-o", "results"), ("slip.toml", *words))


def numbers_in(model, above=""):
    """Entries of a model, and of the sections in it, that are numbers."""
    for name, entry in model.model_fields.items():
        if (section := section_of(entry.annotation)) is not None:
            yield from numbers_in(section, f"{above}{name}.")
        elif re.search(r"\b(int|float)\b", str(entry.annotation)):
            yield f"{above}{name}"


OF_LISTS = {"operation.shares"}  # entries that are lists of numbers, of which one at least
NUMBERS = [entry for entry in numbers_in(Study) if entry not in ("support.clearance", "operation.hz")]


LEAST = {  # of sections that the small study does not have
    "shaft": {"length_mm": 9.0},
    "disc": [{"position_mm": 1.0}],
    "defect": [{"spall": "outer,1,1"}],
    "damper": [{"length_mm": 20.0, "diameter_mm": 80.0, "clearance_um": 100.0}],
    "periodic": {"from_rpm": 1000.0, "to_rpm": 2000.0},
}


@pytest.mark.parametrize("entry", NUMBERS)
def test_entries_that_are_no_numbers(entry):
    *sections, key = entry.split(".")
    document = tomllib.loads(SMALL)
    table = document
    for name in sections:
        table = table.setdefault(name, deepcopy(LEAST.get(name, {})))
        table = table[0] if isinstance(table, list) else table
    a_list = [] if entry in OF_LISTS else [7.94]
    for value in (True, "7.94", a_list, {"mm": 7.94}, date(2020, 1, 1), NAN, INF):
        table[key] = value
        assert_named(entry, lambda _: study_of(document), value)


def test_whole_numbers_are_numbers(good, monkeypatch):
    (good / "slip.toml").write_text(
        SMALL.replace("radial_load = 70.0", "radial_load = 70").replace("3000.0", "3_000")
    )
    monkeypatch.chdir(good)
    with pytest.raises(SystemExit) as stop:
        main(["validate", "slip.toml", "-o", "none"])
    assert not stop.value.code


@pytest.mark.parametrize("command", [("steady", "--json"), ("verify",), ("bearing",)], ids=lambda c: c[0])
def test_a_pipe_with_a_name(refused, good, command):
    """Whoever opens one waits for the other end, which may never come."""
    pipe = good / "pipe.toml"
    os.mkfifo(pipe)
    try:
        refused((*command, pipe) if command[0] != "steady" else steady(command[1], pipe), ("pipe with a name",))
    finally:
        pipe.unlink()


def test_a_byte_order_mark(good, tmp_path):
    """As editors on Windows write one: read over."""
    for name in (STUDY, ELEMENT):
        (tmp_path / name).write_bytes(b"\xef\xbb\xbf" + (good / name).read_bytes())
    assert load_study(tmp_path / STUDY) == load_study(good / STUDY)
    assert read(tmp_path / ELEMENT) == read(good / ELEMENT)


def test_the_element_of_another_contact(refused, tmp_path, good):
    point = OperatingPoint.ball_bearing(Lubricant(0.02, 2e-8), **OF_6205, speed_rpm=3000.0, load=34.0)
    element = Atlas().element(point)
    file = save(element, tmp_path / "other.json")
    words = ("--contact", "an element of the study's contact: ", "eta0 = 0.0367 Pa s (made for 0.02 Pa s)")
    refused(("export", STUDY, "-o", "new.fmu", "--contact", file), words)


def test_a_working_folder_that_is_gone(tmp_path, good, monkeypatch, capsys):
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    for command in (("validate", good / STUDY, "-o", "out"), ("fit", "r.h5"), ("init", "new.toml")):
        with pytest.raises(SystemExit) as stop:
            main([str(part) for part in command])
        (line,) = capsys.readouterr().err.splitlines()
        assert stop.value.code == 2 and "must be" in line, line


@pytest.mark.filterwarnings("default")
def test_no_room_for_compiled_code(monkeypatch, capsys, tmp_path):
    """A full disk: a warning that names the folder; the answer comes all the same."""

    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    film = solve_steady(MoesPoint(20, 10, 1), grid=Grid(n=16))
    monkeypatch.setattr(kernel_cache, "_given", set())
    monkeypatch.setattr("numba.core.caching.IndexDataCacheFile.save", full)
    monkeypatch.setattr("numba.core.config.CACHE_DIR", str(tmp_path))
    kernel, other = jit(_unchanged), jit(_unchanged)
    monkeypatch.setattr("ehlcontact.steady.solve_steady", lambda *_, **__: [film, kernel(1.0), other(1.0)][0])
    with pytest.raises(SystemExit) as stop:
        main(steady(M="20", L="10", kappa="1", n="16"))
    (line,) = capsys.readouterr().err.splitlines()
    assert stop.value.code == 0 and str(tmp_path) in line and "No space left on device" in line, line
    assert line.startswith("ehlcontact: warning: compiled code is not kept") and "NUMBA_CACHE_DIR" in line


def _unchanged(x):
    return x


def test_a_figure_that_fails_costs_no_report(tmp_path):
    def fails():
        raise ValueError("no backend <here>")

    with pytest.warns(UserWarning, match="the figure 'convergence' could not be drawn: ValueError: no backend"):
        figure = finished(_drawn("convergence", fails))
    assert "no backend &lt;here&gt;" in json.dumps(figure)


def test_a_grid_beyond_the_memory(refused, monkeypatch, good):
    """Refused before anything is tried or written."""
    monkeypatch.setattr("ehlcontact.solver.mesh.available_bytes", lambda: 5e6)
    words = ("n = 256", "fits into memory", "nodes take about", "GB", "0.005 GB are free")
    for command in (("steady",), ("simulate", "--free", "5"), ("impedance", "--Omega", "1")):
        refused(at(*command, n="256"), ("--" + words[0], *words[1:]))
    refused(steady("--save", RECORD, n="256"), words)
    (good / "slip.toml").write_text(SMALL.replace("n_transient = 64", "n_transient = 256"))
    refused(("run", "slip.toml", "-o", "results"), ("slip.toml: contact.n_transient = 256", *words[1:]))


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    return files.make_good(tmp_path_factory.mktemp("sound"))


@pytest.fixture
def place(tmp_path):
    """A folder with results that would be replaced."""
    out = tmp_path / "out"
    out.mkdir()
    for suffix in (".json", ".h5", ".fmu", ".h5"):
        (out / f"kept{suffix}").write_text("kept")
    return tmp_path


@pytest.mark.parametrize(("kind", "name"), [(kind, name) for kind, table in files.BAD.items() for name in table])
def test_files(refused, sound, place, kind, name):
    made = files.BAD[kind][name]
    data = sound[made] if isinstance(made, str) else made(sound[kind])
    assert data != sound[kind]
    file = place / f"bad{files.SUFFIX[kind]}"
    file.write_bytes(data)
    refused(files.COMMANDS[kind](file, place / "out"), ("must be", file.name), place)


@pytest.mark.parametrize("kind", files.COMMANDS)
@pytest.mark.parametrize("name", files.MISSING)
def test_files_that_are_not_there(refused, place, kind, name):
    refused(files.COMMANDS[kind](files.missing(place, kind, name), place / "out"), ("must be",), place)


@pytest.mark.parametrize("name", CALLS)
def test_calls(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    call, words = CALLS[name]
    full_contact()
    started = time.process_time()
    with pytest.raises(InputError) as caught:
        call()
    assert time.process_time() - started < SECONDS
    line = str(caught.value)
    assert "\n" not in line and [word for word in words if word not in line] == [], line
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("function", "good", "bad"), FIELDS, ids=lambda part: getattr(part, "__name__", ""))
def test_fields(function, good, bad):
    for field, values in bad.items():
        for value in values:
            assert_named(field, lambda change: function(**(good | change)), {field: value})


@pytest.mark.parametrize(
    ("call", "bad"),
    [*kinds.ARGUMENTS, *methods.ARGUMENTS],
    ids=lambda part: ",".join(part)[:60] if isinstance(part, dict) else "",
)
def test_kinds(call, bad, tmp_path, monkeypatch):
    """Units, flags, columns, lists, paths, callbacks: one line, with the name of the argument in front."""
    monkeypatch.chdir(tmp_path)
    for field, values in bad.items():
        for value in values:
            with pytest.raises(InputError, match=NAMED_FIRST.format(re.escape(field))) as caught:
                call(**{field: value})
            assert "\n" not in str(caught.value), value
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", kinds.CALLS)
def test_kinds_together(name):
    call, field = kinds.CALLS[name]
    with pytest.raises(InputError, match=NAMED_FIRST.format(re.escape(field))):
        call()


def test_guesses_of_units():
    for call, field, guess in kinds.GUESSES:
        with pytest.raises(InputError, match=rf"^{re.escape(field)}.* = .*: must be .*\(in {re.escape(guess)}\)"):
            call()


@pytest.mark.parametrize(("field", "call"), NAMED)
def test_named(field, call):
    assert_named(field, lambda _: call(), None)


def assert_named(field, call, change):
    with pytest.raises(InputError, match=rf"^{re.escape(field)} = .*: must be ") as caught:
        call(change)
    assert caught.value.field == field and "\n" not in str(caught.value), change


@pytest.mark.slow
@pytest.mark.parametrize("arguments", SAMPLE, ids=lambda part: shlex.join(part)[:60])
def test_as_a_user_runs_them(good, arguments):
    """In a process of its own: its imports, too, are a part of the two seconds."""
    before, used = contents(good), os.times().children_user + os.times().children_system
    command = [sys.executable, "-m", "ehlcontact.cli", *arguments]
    environment = os.environ | {"PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=good, env=environment)
    spent = os.times().children_user + os.times().children_system - used
    assert (done.returncode, done.stdout) == (2, "") and len(done.stderr.splitlines()) == 1, done
    assert "must be" in done.stderr and contents(good) == before
    assert spent < SECONDS
