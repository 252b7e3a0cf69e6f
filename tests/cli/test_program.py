"""The program itself: help, version, and usage errors in one line."""

import shlex
import subprocess
import sys

import pytest

import ehlcontact

SUBCOMMANDS = (
    "init", "validate", "run", "reproduce", "steady", "simulate", "impedance", "fit", "element", "export",
    "verify", "bearing", "explore", "atlas",
)  # fmt: skip


def test_help_lists_the_subcommands(call):
    result = call("--help")
    assert result.code == 0 and result.err == ""
    listed = [
        line.split()[1] for line in result.out.splitlines() if line.startswith("│ ") and len(line.split()) > 2
    ]
    assert [name for name in listed if name in SUBCOMMANDS] == list(SUBCOMMANDS)


@pytest.mark.parametrize("name", SUBCOMMANDS)
def test_every_subcommand_has_help(call, name):
    result = call(name, "--help")
    assert result.code == 0 and result.err == "" and "Usage" in result.out


@pytest.mark.parametrize("name", [*SUBCOMMANDS[:-1], "atlas build"])
def test_help_ends_in_examples_that_the_parser_takes(call, name):
    """Every one of them is shown, and is a command line of that command."""
    import typer

    from ehlcontact.cli.app import app
    from ehlcontact.cli.usage import EXAMPLES

    said = " ".join(word for word in call(*name.split(), "--help").out.split() if word != "│")
    for example in EXAMPLES[name]:
        assert " ".join(example.split()) in said
        command, words = typer.main.get_command(app), shlex.split(example)[1:]
        for part in name.split():
            command, words = command.commands[part], words[1:]
        command.make_context(name, words)


def test_completion_in_a_shell():
    """A subcommand, an option and a value, in one process, which has the program's name."""
    asked = {
        "ehlcontact imp": ["impedance"],
        "ehlcontact steady --bea": ["--bearing"],
        "ehlcontact steady --bearing 631": ["6310", "6311", "6312"],
    }
    code = f"""
import os
from ehlcontact.cli import main
os.environ["_EHLCONTACT_COMPLETE"] = "complete_bash"
for line in {list(asked)}:
    os.environ |= {{"COMP_WORDS": line, "COMP_CWORD": str(line.count(" "))}}
    try:
        main()
    except SystemExit as stop:
        print("", stop.code)
"""
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    expected = [word for offered in asked.values() for word in (*offered, "0")]
    assert (found.returncode, found.stdout.split(), found.stderr) == (0, expected, "")


def test_version(call):
    result = call("--version")
    assert result.code == 0 and result.out.split() == ["ehlcontact", ehlcontact.__version__]


def test_no_arguments_show_the_help(call):
    result = call()
    assert result.code == 2 and "Usage" in result.out + result.err


def test_as_a_process():
    command = [sys.executable, "-m", "ehlcontact.cli", "steady", "--M", "-1", "--L", "5", "--kappa", "1"]
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    assert found.returncode == 2 and found.stdout == ""
    assert found.stderr.splitlines() == ["ehlcontact: --M = -1.0: must be a finite number > 0"]


def test_help_does_not_load_the_solver():
    heavy = {"matplotlib", "fmpy", "scipy.linalg", "scipy.optimize"}
    code = f"import sys, ehlcontact.cli.app\nprint({heavy} & set(sys.modules))"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "set()"
