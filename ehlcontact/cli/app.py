"""The program: subcommands, and every way to fail turned into one line and an exit code."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from typing import Annotated

import typer

from ehlcontact.cli.commands import (
    atlas,
    element,
    export,
    fit,
    impedance,
    reproduce,
    run,
    simulate,
    steady,
    validate,
)
from ehlcontact.cli.output import FAILED, INTERRUPTED_LINE, USAGE, complain, one_line
from ehlcontact.cli.streams import StdoutError, watched_stdout
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.origin import __version__

# Root of the usage errors; typer's own or click's, depending on the version of typer.
UsageFailure: type[Exception] = [base for base in typer.BadParameter.__mro__ if hasattr(base, "format_message")][
    -1
]

app = typer.Typer(
    name="ehlcontact",
    help="Transient elastohydrodynamic rolling contacts, reduced to elements for rotordynamics.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"ehlcontact {__version__}")
        raise typer.Exit()


@app.callback()
def _program(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    """Transient elastohydrodynamic rolling contacts, reduced to elements for rotordynamics."""


for module in (steady, simulate, impedance, fit, element, export, validate, run, reproduce, atlas):
    module.register(app)


def execute(arguments: Sequence[str] | None = None) -> int:
    """Run one command line; returns the exit code, and says on stderr in one line what was wrong."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    try:
        with watched_stdout(), warnings.catch_warnings():
            warnings.showwarning = lambda message, *_: complain(f"warning: {message}")
            return _invoke(given)
    except InputError as error:
        complain(str(error))
        return USAGE
    except ConvergenceError as error:
        complain(str(error))
        return FAILED
    except StdoutError as error:
        if error.closed:
            complain("stdout was closed before everything was written to it")
            return FAILED
        complain(str(InputError("stdout", str(error), "able to take the output")))
        return USAGE
    except OSError as error:  # no room for temporary files, no more processes: no fault of the input, nor of ours
        complain(f"the system refuses: {error}")
        return FAILED
    except MemoryError as error:
        complain(f"out of memory{f': {error}' if str(error) else ''}")
        return FAILED
    except (KeyboardInterrupt, typer.Abort):
        complain(INTERRUPTED_LINE)
        return FAILED
    except UsageFailure as error:
        complain(_usage_line(error, given))
        return USAGE


def _invoke(given: list[str]) -> int:
    """The command itself: not by its `main`, which has its own ways with Ctrl-C and a closed stdout."""
    try:
        with typer.main.get_command(app).make_context("ehlcontact", given) as context:
            context.command.invoke(context)
    except typer.Exit as end:
        return end.exit_code
    except UsageFailure as error:
        if type(error).__name__ != "NoArgsIsHelpError":
            raise
        typer.echo(str(error))
        return USAGE
    return 0


def _usage_line(error: Exception, arguments: Sequence[str]) -> str:
    """What was wrong with the command line; for a value, the option, the value and what it must be."""
    message = str(getattr(error, "format_message", error.__str__)())
    parameter = getattr(error, "param", None)
    given = list(arguments)
    for option in getattr(parameter, "opts", ()):
        if isinstance(error, typer.BadParameter) and option in given:
            start = given.index(option) + 1
            value = " ".join(given[start : start + parameter.nargs])  # type: ignore[union-attr]
            allowed = str(getattr(error, "message", message)).removeprefix("Input should be ")
            return str(InputError(option, value, allowed))
    return one_line(message)
