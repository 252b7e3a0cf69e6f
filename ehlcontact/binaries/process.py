"""Running a compiler: its output is kept; it ends with this process or after a time limit."""

from __future__ import annotations

import os
import shlex
import signal
import subprocess
import tempfile
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from threading import Event

LONGEST_RUN = 900.0  # seconds; zig builds the C runtime of Windows on first use, which took 154 s on two cores
SHOWN = 3  # lines of a compiler's complaints in a message; all of them are in `BuildError.output`


class BuildError(RuntimeError):
    """No C compiler, or a failed compilation: message of one line; ``output`` is the compiler's."""

    def __init__(self, message: str, output: str = "") -> None:
        self.output = output
        super().__init__(" ".join(f"{message}{': ' if output.strip() else ''}{_gist(output)}".split()))


def run(line: Sequence[str], folder: Path, more: Mapping[str, str], stop: Event | None = None) -> None:
    """Run a command in `folder`, with `more` in its environment, until `stop` is set.

    Raises
    ------
    BuildError
        It cannot be started, fails, is killed, takes too long, or `stop` is set.
    """
    shown = shlex.join(line)
    # Into a file: a compiler's children may outlive it and would hold a pipe open for ever.
    with tempfile.TemporaryFile(dir=folder) as output_file:
        try:
            process = subprocess.Popen(
                line,
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=output_file,
                stderr=subprocess.STDOUT,
                env=os.environ | more,
                start_new_session=True,  # so that its children can be ended with it
            )
        except (OSError, ValueError) as error:
            reason = error.strerror if isinstance(error, OSError) else error
            raise BuildError(f"cannot start the C compiler {shown} ({reason})") from None
        try:
            code = _wait(process, stop, shown)
        finally:  # Ctrl-C too: in a session of its own it does not get the signal
            _end(process)
        output_file.seek(0)
        output = output_file.read().decode("utf-8", "replace")
    if code < 0:
        raise BuildError(f"the C compiler was killed ({_signal(-code)}): {shown}", output)
    if code != 0:
        raise BuildError(f"the C compiler failed with exit code {code}: {shown}", output)


def _wait(process: subprocess.Popen[bytes], stop: Event | None, shown: str) -> int:
    """Exit code of a command that has ended by itself."""
    until = time.monotonic() + LONGEST_RUN
    while True:
        try:
            return process.wait(0.1)  # s, between two looks at `stop`
        except subprocess.TimeoutExpired:
            if stop is not None and stop.is_set():
                raise BuildError(f"the C compiler was told to stop: {shown}") from None
            if time.monotonic() > until:
                raise BuildError(f"the C compiler took more than {LONGEST_RUN:g} s: {shown}") from None


def _end(process: subprocess.Popen[bytes]) -> None:
    if process.poll() is not None:
        return
    with suppress(OSError):
        if hasattr(os, "killpg"):
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
    process.wait()


def _signal(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


def _gist(output: str) -> str:
    """First lines with an error, else the last lines."""
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    telling = [line for line in lines if "error" in line.lower()]
    return "; ".join(telling[:SHOWN] or lines[-SHOWN:])
