"""Command lines: what is wrong with one, in one line, by the option as it was typed; and examples for the help."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import typer

from ehlcontact.cli.output import one_line
from ehlcontact.errors import InputError

# Messages of the parser about numbers, in plain words.
PLAIN_WORDS = {
    "a valid integer, unable to parse string as an integer": "a whole number",
    "a valid number, unable to parse string as a number": "a number, as 0.04 or 4e-2",
}


_RADIAL = "a single contact has a load along its normal: `ehlcontact bearing` has axial loads, angles and tilts"
_PRELOAD = (
    "`ehlcontact bearing --axial` is that of one bearing, with a --clearance below 0 radially; "
    "--pair has that of two"
)
_FILMS = "films are fully flooded and isothermal, without sliding; the answer lists assumptions that do not hold"
# What people ask for and no command computes, by the option that they try.
NOT_IN_THE_MODEL = {
    **dict.fromkeys(("--axial", "--axial-load", "--thrust", "--contact-angle", "--angle"), _RADIAL),
    **dict.fromkeys(("--moment", "--tilt", "--misalignment"), f"{_RADIAL} (--moment-x, --tilt-x)"),
    **dict.fromkeys(("--preload", "--axial-preload"), _PRELOAD),
    **dict.fromkeys(("--grease",), _FILMS),
}
# Likewise what some commands have.
OF_OTHERS = {
    **dict.fromkeys(
        ("--starvation", "--starved"),
        "`ehlcontact steady`, `impedance`, `simulate` and `bearing` have --layer; elsewhere " + _FILMS,
    ),
    **dict.fromkeys(
        ("--thermal", "--heat", "--sliding", "--slide-roll"),
        "`ehlcontact steady` has --thermal and --slide-roll, `impedance`, `simulate` and `bearing` --thermal; "
        "elsewhere " + _FILMS,
    ),
    "--asperities": "`ehlcontact steady` has --asperities with --rq; elsewhere films are between smooth surfaces",
    **dict.fromkeys(
        ("--traction", "--slip"), "`ehlcontact steady` has --slide-roll, with its traction; elsewhere " + _FILMS
    ),
}


def usage_line(error: Exception, arguments: Sequence[str], root: Any) -> str:
    """A usage error in one line: the option, the value and its allowed range, as far as the error has them.

    Parameters
    ----------
    error : Exception
        A usage error of the parser.
    arguments : sequence of str
        The command line.
    root : click.Command
        The program.
    """
    message = one_line(str(getattr(error, "format_message", error.__str__)()))
    command, name = command_of(root, arguments)
    kind, parameter = type(error).__name__, getattr(error, "param", None)
    if kind == "MissingParameter" and parameter is not None:
        return str(InputError(_title(parameter, ()), None, f"given{_about(parameter)}"))
    if kind == "BadOptionUsage":
        parameter = next((p for p in command.params if getattr(error, "option_name", "") in p.opts), None)
        if parameter is not None:
            few = "one value" if parameter.nargs == 1 else f"{parameter.nargs} values"
            found = InputError(_title(parameter, arguments), None, f"followed by {few}{_about(parameter)}")
            return str(found).replace(" = None", "", 1)
    asked = getattr(error, "option_name", "")
    if kind == "NoSuchOption" and asked in NOT_IN_THE_MODEL:
        return f"{asked}: not in the model; {NOT_IN_THE_MODEL[asked]}"
    if kind == "NoSuchOption" and name and asked in OF_OTHERS:
        return f"{asked}: no option of `{name}`; {OF_OTHERS[asked]}"
    if kind == "NoSuchOption" and name:
        options = (option.opts[0] for option in command.params if option.opts[0].startswith("--"))
        return f"{message.rstrip('.')}; `{name}` takes {', '.join(options)}"
    if kind == "UsageError" and "unexpected extra argument" in message:
        return f"{message}; `ehlcontact {name} --help` shows what `{name}` takes: options come with their names"
    if "No such command" in message and getattr(command, "commands", None) and "Did you mean" not in message:
        return f"{message.rstrip('.')}; known: {', '.join(command.commands)}"
    if isinstance(error, typer.BadParameter) and parameter is not None:
        return _bad_value(error, parameter, arguments, message)
    return message


def command_of(root: Any, arguments: Sequence[str]) -> tuple[Any, str]:
    """The command that a command line calls, as far as its words name one, and its name."""
    command, names = root, []
    for word in arguments:
        below = getattr(command, "commands", {})
        if word not in below:
            break
        command = below[word]
        names.append(word)
    return command, " ".join(names)


def by_option(error: InputError, command: Any, arguments: Sequence[str]) -> InputError:
    """The error with the option, as it was typed, in place of the library's name for what it sets."""
    for parameter in command.params:
        option = parameter.opts[0]
        typed = _title(parameter, arguments)
        if error.field == option and typed.startswith("--"):  # by its other long name
            return InputError(typed, error.value, error.allowed)
        if option.startswith("--") and error.field in (parameter.name, option[2:]):
            return InputError(typed, error.value, error.allowed)
    return error


def _bad_value(error: Exception, parameter: Any, arguments: Sequence[str], message: str) -> str:
    """A value that is none for its option or argument; all of them where it was given more than once."""
    values = []
    for k, word in enumerate(arguments):
        option, joined, value = word.partition("=")
        if option in parameter.opts:
            values.append(value if joined else " ".join(arguments[k + 1 : k + 1 + parameter.nargs]))
    if not values:
        return message
    allowed = str(getattr(error, "message", message)).removeprefix("Input should be ")
    # typer's own options have the ends of their range themselves, click's have a type that has them
    low, high = (
        getattr(parameter, end, getattr(getattr(parameter, "type", None), end, None)) for end in ("min", "max")
    )
    if low is not None and high is not None:
        allowed = f"a whole number between {low} and {high}"
    shown = values[0] if len(values) == 1 else ", ".join(values)
    typed = next(
        option for option in parameter.opts if any(word.partition("=")[0] == option for word in arguments)
    )
    return str(InputError(typed, shown, f"{PLAIN_WORDS.get(allowed, allowed)}{_about(parameter)}"))


def _title(parameter: Any, arguments: Sequence[str]) -> str:
    """An option as it was typed, where it has several names; the name that stands for an argument."""
    typed = {word.partition("=")[0] for word in arguments}
    option = str(next((name for name in parameter.opts if name in typed), parameter.opts[0]))
    return option if option.startswith("-") else str(parameter.metavar or option)


def _about(parameter: Any) -> str:
    """What an option's help says, in brackets: its quantity, unit and range."""
    text = one_line(getattr(parameter, "help", None) or "").rstrip(".")
    metavar = parameter.metavar if parameter.nargs > 1 and parameter.metavar else ""
    about = f"{metavar}: {text}" if metavar and text else text or metavar
    return f" ({about})" if about else ""


# Examples of every command, which a test parses.
_BALL = '--bearing 6205 --oil "ISO VG 68" --temp 60 --speed-rpm 3000 --load 1000'
EXAMPLES = {
    "init": (
        "ehlcontact init",
        'ehlcontact init mine.toml --bearing 6206 --oil "ISO VG 46" --temp 65 --speed-rpm 6000 --load 200',
        "ehlcontact init --speed-rpm 1500 --speed-rpm 3000 --load 100 --load 500",
    ),
    "steady": (
        f"ehlcontact steady {_BALL} --rq 0.1",
        "ehlcontact steady --ball-diameter 19.05 --flat glass --entrainment 0.1 --load 20 --oil 100 --temp 40",
        "ehlcontact steady --M 200 --L 10 --kappa 0.5 --figure film.png",
    ),
    "simulate": (
        f"ehlcontact simulate {_BALL} --harmonic-hz 2000 --save run.h5",
        "ehlcontact simulate --M 200 --L 10 --kappa 0.5 --free 5.13 --save free.h5",
    ),
    "impedance": (
        f"ehlcontact impedance {_BALL} --hz 50 --hz 1000",
        "ehlcontact impedance --M 200 --L 10 --kappa 0.5 --Omega 0.05 --Omega 3.14",
    ),
    "fit": (
        "ehlcontact fit free.h5 --model cubic --save element.json",
        "ehlcontact fit run.h5 --model memory --save memory.json",
    ),
    "element": (
        f"ehlcontact element {_BALL} --save ball.json",
        f"ehlcontact element {_BALL} --model cubic --hz 200 --save ball.json",
    ),
    "export": (
        "ehlcontact export ball.json -o ball.fmu",
        "ehlcontact export ball.json -o ball.fmu --fmi 3 --platform all --force",
        "ehlcontact export examples/small_study.toml -o rotor.fmu",
        "ehlcontact export examples/small_study.toml -o rotor.ssp",
        "ehlcontact export examples/small_study.toml --bearings outside -o shaft.fmu",
        "ehlcontact export examples/small_study.toml --bearings wired --inertia 0.001 --top-rpm 6000 -o drive.ssp",
    ),
    "validate": ("ehlcontact validate examples/small_study.toml",),
    "run": (
        "ehlcontact run examples/small_study.toml",
        "ehlcontact run examples/deep_groove_6205.toml -o results/mine --jobs 4",
        "ehlcontact run study.toml --scheduler tcp://127.0.0.1:8786",
    ),
    "reproduce": ("ehlcontact reproduce --table 3", "ehlcontact reproduce -o results/paper"),
    "bearing": (
        'ehlcontact bearing 6205 --oil "ISO VG 68" --temp 50 --load 1000 --speed-rpm 3000 --figure bearing.png',
        'ehlcontact bearing 7205 --axial 200 --radial 500 --oil "ISO VG 46" --temp 60 --speed-rpm 6000',
        "ehlcontact bearing 7205 --pair back-to-back --preload 150 --axial 200 --radial 500 --speed-rpm 6000",
        "ehlcontact bearing examples/bearing_6205.toml --json -",
    ),
    "verify": ("ehlcontact verify ball.fmu",),
    "explore": ("ehlcontact explore -o page.html",),
    "atlas build": (
        "ehlcontact atlas build -o atlas.h5 --draws 200 --processes 4",
        "ehlcontact atlas build --recipe supply -o supply.h5 --draws 128",
        "ehlcontact atlas build --recipe waves",
    ),
}


def epilog(command: str) -> str | None:
    """Examples of a command, a paragraph each; None where it has none."""
    found = EXAMPLES.get(command)
    return None if found is None else "\n\n".join(["Examples:", *found])
