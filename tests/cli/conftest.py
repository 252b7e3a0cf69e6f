"""The command line called in this process, as the console script calls it."""

import json
from collections import namedtuple

import pytest
from tiny_study import STUDY

Outcome = namedtuple("Outcome", "code out err")
POINT = ["--M", "20", "--L", "5", "--kappa", "0.5"]


@pytest.fixture(scope="session")
def point():
    return list(POINT)


@pytest.fixture
def call(capsys):
    """``call(*arguments)`` returns the exit code, stdout and stderr."""
    from ehlcontact.cli import main

    def run(*arguments):
        with pytest.raises(SystemExit) as stop:
            main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return Outcome(stop.value.code or 0, captured.out, captured.err)

    return run


@pytest.fixture
def refused(call):
    """``refused(words, *arguments)``: exit 2, nothing on stdout, one line on stderr that holds all words."""

    def run(words, *arguments):
        result = call(*arguments)
        assert result.code == 2, result
        assert result.out == "" and "Traceback" not in result.err
        lines = result.err.splitlines()
        assert len(lines) == 1, lines
        for word in words:
            assert word in lines[0], (word, lines[0])

    return run


@pytest.fixture(autouse=True)
def every_command_is_quiet(quiet):
    """Their own tests call the lines of progress."""


@pytest.fixture(scope="session")
def finished(made_once):
    """A study file and the folder of its finished run, in one process: it compiles every kernel once."""
    from ehlcontact.cli import main

    def run(folder):
        (folder / "tiny.toml").write_text(STUDY)
        with pytest.raises(SystemExit) as stop:
            main(["run", str(folder / "tiny.toml"), "-o", str(folder / "out"), "--jobs", "1"])
        assert not stop.value.code

    root = made_once("finished study", run)
    return root / "tiny.toml", root / "out"


@pytest.fixture(scope="session")
def results(finished):
    """The results of that run."""
    return json.loads((finished[1] / "results.json").read_text())
