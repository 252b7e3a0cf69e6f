"""The program: subcommands; every error becomes one line on stderr and an exit code."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Sequence
from typing import Annotated, Any

import typer

from ehlcontact.binaries import BuildError
from ehlcontact.cli.commands import (
    atlas,
    bearing,
    element,
    explore,
    export,
    fit,
    impedance,
    init,
    reproduce,
    run,
    simulate,
    steady,
    validate,
    verify,
)
from ehlcontact.cli.output import FAILED, INTERRUPTED_LINE, USAGE, StdoutError, complain, watched_stdout
from ehlcontact.cli.usage import by_option, command_of, epilog, usage_line
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.process.early_interrupt import INTERRUPTED
from ehlcontact.version import __version__

# Root of the usage errors; typer's own or click's, depending on the version of typer.
UsageFailure: type[Exception] = [base for base in typer.BadParameter.__mro__ if hasattr(base, "format_message")][
    -1
]

COMPLETION = "_EHLCONTACT_COMPLETE"  # set by the scripts that --install-completion leaves

app = typer.Typer(
    name="ehlcontact",
    help="Transient elastohydrodynamic rolling contacts, reduced to elements for rotordynamics.",
    no_args_is_help=True,
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


# In the order of the help.
COMMANDS = (
    *(init.init, validate.validate, run.run, reproduce.reproduce),
    *(steady.steady, simulate.simulate, impedance.impedance, fit.fit, element.element),
    *(export.export, verify.verify, bearing.bearing, explore.explore),
)
for command in COMMANDS:
    app.command(command.__name__, epilog=epilog(command.__name__))(command)
app.add_typer(atlas.group, name="atlas")


def execute(arguments: Sequence[str] | None = None) -> int:
    """Run one command line; return the exit code. An error is one line on stderr."""
    if COMPLETION in os.environ and arguments is None:  # completion in a shell
        typer.main.get_command(app).main(prog_name="ehlcontact")
    given = list(sys.argv[1:] if arguments is None else arguments)
    try:
        with watched_stdout(), warnings.catch_warnings():
            told: set[str] = set()

            def tell(message: Warning | str, *_: Any, **__: Any) -> None:
                """Show each warning once, wherever it comes from."""
                if str(message) not in told:
                    told.add(str(message))
                    complain(f"warning: {message}")

            warnings.showwarning = tell
            return _invoke(given)
    except InputError as error:
        complain(str(error))
        return USAGE
    except ConvergenceError as error:
        complain(str(error))
        return FAILED
    except BuildError as error:  # the C core of bearings and rotors
        complain(str(error))
        return USAGE
    except StdoutError as error:
        if error.closed:
            complain("stdout was closed before everything was written to it")
            return FAILED
        complain(str(InputError("stdout", str(error), "able to take the output")))
        return USAGE
    except OSError as error:  # no room for temporary files, no more processes: no fault of the input, nor of ours
        if isinstance(error, FileNotFoundError) and not _in_a_folder():
            complain(str(InputError("working folder", "a folder that is gone", "there: change to another")))
            return USAGE
        complain(f"the system refuses: {error}")
        return FAILED
    except MemoryError as error:
        complain(f"out of memory{f': {error}' if str(error) else ''}")
        return FAILED
    except (KeyboardInterrupt, typer.Abort):
        complain(INTERRUPTED_LINE)
        return INTERRUPTED
    except UsageFailure as error:
        complain(usage_line(error, given, typer.main.get_command(app)))
        return USAGE


def _in_a_folder() -> bool:
    """Whether the folder that the program was started in is still there."""
    try:
        os.getcwd()
    except FileNotFoundError:
        return False
    return True


def _invoke(given: list[str]) -> int:
    """Run the command itself; its `main` would handle Ctrl-C and a closed stdout by itself."""
    root = typer.main.get_command(app)
    try:
        with root.make_context("ehlcontact", list(given)) as context:
            context.command.invoke(context)
    except InputError as error:
        raise by_option(error, command_of(root, given)[0], given) from None
    except typer.Exit as end:
        return end.exit_code
    except UsageFailure as error:
        if type(error).__name__ != "NoArgsIsHelpError":
            raise
        typer.echo(str(error))
        return USAGE
    return 0
