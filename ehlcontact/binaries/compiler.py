"""Finds a C compiler for a platform: for this machine that of ``EHLCONTACT_CC`` or the system's, else zig."""

from __future__ import annotations

import os
import shlex
import shutil
import sys
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path

from ehlcontact.binaries.platforms import Platform, this_machine
from ehlcontact.binaries.process import BuildError
from ehlcontact.errors import InputError

COMPILER_VARIABLE = "EHLCONTACT_CC"
SYSTEM = ("cc", "gcc", "clang")  # in the order they are looked for


@dataclass(frozen=True, slots=True)
class Compiler:
    """A compiler: command line, label in the FMU, and identity of program and version for the cache."""

    command: tuple[str, ...]
    label: str  # without the paths of this machine
    identity: str
    is_zig: bool = False


def compilers(target: Platform, any_of_them: bool = False) -> list[Compiler]:
    """Compilers for a platform, in the order of preference.

    For this machine's binary: ``EHLCONTACT_CC`` (a command line), where it is set, and no other unless
    `any_of_them` will do; then the system's ``cc``, ``gcc`` or ``clang``, then zig. For any other: zig.

    Raises
    ------
    InputError
        ``EHLCONTACT_CC`` cannot be read as a command line.
    BuildError
        There is none.
    """
    found = []
    if target is this_machine():
        chosen = os.environ.get(COMPILER_VARIABLE, "").strip()
        found += [_compiler(_words(chosen))] if chosen else []
        if chosen and not any_of_them:
            return found
        # A cc on Windows may be of many makes, each with libraries of its own that the binary would need.
        name = None if target.system == "windows" else next(filter(shutil.which, SYSTEM), None)
        found += [_compiler((name,))] if name else []
    zig = _zig()
    if zig is not None:
        command = (*zig, "cc", "-target", target.target)
        label = f"zig {_zig_version()} cc -target {target.target}"
        found.append(Compiler(command, label, f"{_identity(zig)} {_zig_version()}", is_zig=True))
    if not found:
        raise BuildError(
            f"no C compiler for {target.name}: pip install ziglang"
            + (f", install gcc or set {COMPILER_VARIABLE}" if target is this_machine() else "")
        )
    return found


def _words(line: str) -> tuple[str, ...]:
    posix = os.name != "nt"  # where a backslash parts folders
    try:
        words = shlex.split(line, posix=posix)
    except ValueError as error:
        raise InputError(COMPILER_VARIABLE, line, f"a command line ({str(error).lower()})") from None
    program, *rest = (word if posix else word.strip('"') for word in words)
    # It runs in a folder of its own, where a path that begins here leads nowhere.
    return (os.path.abspath(program) if os.path.dirname(program) else program, *rest)


def _compiler(command: tuple[str, ...]) -> Compiler:
    label = " ".join((Path(command[0]).name, *command[1:]))
    return Compiler(command, label, f"{_identity(command)} {shlex.join(command)}")


def _identity(command: tuple[str, ...]) -> str:
    """Path, size and date of the program, which differ between its versions."""
    program = shutil.which(command[0])
    if program is None:
        return "none"
    there = os.stat(program)
    return f"{os.path.realpath(program)} {there.st_size} {there.st_mtime_ns}"


def _zig() -> tuple[str, ...] | None:
    """Command of the zig in package ``ziglang``, without its Python wrapper, which is slow to start."""
    package = find_spec("ziglang")
    if package is None or package.origin is None:
        return None
    for name in ("zig", "zig.exe"):
        program = Path(package.origin).with_name(name)
        if program.is_file():
            return (str(program),)
    return (sys.executable, "-m", "ziglang")


def _zig_version() -> str:
    try:
        return version("ziglang")
    except PackageNotFoundError:
        return ""
