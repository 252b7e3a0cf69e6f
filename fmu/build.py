"""Compiler, compilation and packing of an FMU."""

from __future__ import annotations

import os
import platform
import shlex
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Mapping
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path

COMPILER_VARIABLE = "EHLCONTACT_CC"
CSRC = Path(__file__).parent / "csrc"
FLAGS = (
    *("-std=c99", "-O2", "-Wall", "-Wextra", "-Werror"),
    *("-fvisibility=hidden", "-fPIC", "-shared", "-ffp-contract=off", "-s"),
)
_ZIG_TARGET = "x86_64-linux-gnu.2.17"
_TIMEOUT = 600.0  # seconds; zig builds its C runtime on first use


class BuildError(RuntimeError):
    """No compiler, or one that failed; the message ends with what the compiler said."""


def find_compiler() -> tuple[str, ...]:
    """Command of the C compiler.

    ``EHLCONTACT_CC`` if set (a command line), else ziglang where installed (its binaries run from glibc 2.17
    on), else ``cc``, ``gcc`` or ``clang`` of the system.

    Raises
    ------
    BuildError
        There is none.
    """
    chosen = os.environ.get(COMPILER_VARIABLE, "").strip()
    if chosen:
        return tuple(shlex.split(chosen))
    if find_spec("ziglang") is not None:
        return (sys.executable, "-m", "ziglang", "cc", "-target", _ZIG_TARGET)
    for name in ("cc", "gcc", "clang"):
        if shutil.which(name):
            return (name,)
    raise BuildError(
        f"no C compiler: install the extra 'ehlcontact[fmu]' (ziglang) or gcc, or set {COMPILER_VARIABLE}"
    )


def compiler_label(command: tuple[str, ...]) -> str:
    """Compiler and flags as they go into the documentation, without the path of this machine's Python."""
    name = " ".join(part for part in command if part not in (sys.executable, "-m"))
    return f"{name} {' '.join(FLAGS)}"


def binary_folder() -> str:
    """Name of the FMI 2.0 platform this process runs on.

    Raises
    ------
    BuildError
        A platform that FMUs are not built for yet.
    """
    if (platform.system(), platform.machine()) != ("Linux", "x86_64"):
        raise BuildError(f"FMUs are built on Linux x86_64 only, not on {platform.system()} {platform.machine()}")
    return "linux64"


def compile_library(sources: Mapping[str, bytes], units: tuple[str, ...], command: tuple[str, ...]) -> bytes:
    """Compile C sources to a shared library.

    Parameters
    ----------
    sources : mapping
        File name to content, headers included: the ``sources/`` folder of the FMU.
    units : tuple of str
        Files to compile.
    command : tuple of str
        From `find_compiler`.

    Returns
    -------
    bytes
        The library.

    Raises
    ------
    BuildError
        The compiler cannot be started, failed, or took too long.
    """
    with tempfile.TemporaryDirectory(prefix="ehlcontact-fmu-") as name:
        folder = Path(name)
        for file, content in sources.items():
            (folder / file).write_bytes(content)
        line = [*command, *FLAGS, "-o", "library.so", *units, "-lm"]
        try:
            done = subprocess.run(
                line,
                cwd=folder,
                capture_output=True,
                text=True,
                errors="replace",
                timeout=_TIMEOUT,
                check=False,
            )
        except OSError as error:
            raise BuildError(f"cannot start the C compiler {shlex.join(command)}: {error.strerror}") from None
        except subprocess.TimeoutExpired:
            raise BuildError(f"the C compiler took more than {_TIMEOUT:g} s: {shlex.join(line)}") from None
        if done.returncode != 0:
            raise BuildError(
                f"the C compiler failed with exit code {done.returncode}: {shlex.join(line)}\n"
                f"{done.stderr}{done.stdout}".rstrip()
            )
        library = folder / "library.so"
        if not library.is_file():
            raise BuildError(f"the C compiler made no library: {shlex.join(line)}")
        return library.read_bytes()


def pack(files: Mapping[str, bytes]) -> bytes:
    """Zip archive with sorted entries and fixed times: equal files give equal bytes."""
    stream = BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3  # Unix, whatever the machine, so that the mode below counts
            entry.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            archive.writestr(entry, files[name])
    return stream.getvalue()
