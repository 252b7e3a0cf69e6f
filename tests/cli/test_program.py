"""The program itself: help, version, and usage errors in one line."""

import subprocess
import sys

import pytest

import ehlcontact

SUBCOMMANDS = (
    "init", "steady", "simulate", "impedance", "fit", "element", "export", "validate", "run", "reproduce",
    "bearing", "atlas",
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


def test_version(call):
    result = call("--version")
    assert result.code == 0 and result.out.split() == ["ehlcontact", ehlcontact.__version__]


def test_no_arguments_show_the_help(call):
    result = call()
    assert result.code == 2 and "Usage" in result.out + result.err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("stedy",), ("stedy",)),
        (("steady", "--M", "20", "--L", "5"), ("--kappa",)),
        (("steady", "--M", "many", "--L", "5", "--kappa", "1"), ("--M", "many", "must be", "number")),
        (
            ("steady", "--M", "20", "--L", "5", "--kappa", "1", "--n", "64.5"),
            ("--n", "64.5", "must be", "whole number"),
        ),
        (("steady", "--M", "20", "--L", "5", "--kappa", "1", "--colour", "x"), ("--colour",)),
        (("steady", "--M", "20", "--L", "5", "--kappa", "1", "--domain", "-4", "2"), ("--domain",)),
        (("fit",), ("R.h5",)),
    ],
)
def test_usage_errors_are_one_line(refused, arguments, words):
    refused(words, *arguments)


def test_as_a_process():
    command = [sys.executable, "-m", "ehlcontact.cli", "steady", "--M", "-1", "--L", "5", "--kappa", "1"]
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    assert found.returncode == 2 and found.stdout == ""
    assert found.stderr.splitlines() == ["ehlcontact: --M = -1.0: must be a finite number > 0"]


def test_help_does_not_load_the_solver():
    code = "import sys, ehlcontact.cli.app\nprint({'matplotlib', 'fmpy', 'pydantic'} & set(sys.modules))"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "set()"
