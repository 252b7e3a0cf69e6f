"""Tables, JSON and messages; checks of output paths; closed pipes, full disks, terminals without Unicode."""

from __future__ import annotations

import io
import json
import math
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, TextIO

import numpy as np
import typer
from rich.console import Console
from rich.table import Table

from ehlcontact.checks.kinds import FOLDER
from ehlcontact.cli.numerals import spelled
from ehlcontact.errors import InputError, printable
from ehlcontact.files import require_writable, require_writable_folder, write_text

FAILED, USAGE = 1, 2
INTERRUPTED_LINE = "interrupted: nothing was computed that could be kept"
STDOUT = "-"


def one_line(text: str) -> str:
    """The text without line breaks and runs of blanks, and with escapes for what a terminal would obey."""
    return printable(" ".join(text.split()))


def complain(text: str) -> None:
    """Say one line on stderr."""
    to_stderr(f"ehlcontact: {one_line(text)}")


def say(text: str, json_to: str | None = None) -> None:
    """Say one line on stdout, unless JSON goes there."""
    if json_to != STDOUT:
        typer.echo(spelled(text, sys.stdout))


def check_new(field: str, path: Path, force: bool) -> None:
    """Make sure that a file is not there yet, unless it may be replaced."""
    if not force and path.exists():
        raise InputError(field, str(path), "a new file, or replaced with --force")


def prepare_folder(folder: Path) -> None:
    """Make the folder and be sure that it can be written to.

    Raises
    ------
    InputError
        It cannot.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError("--output", str(folder), f"a folder that can be written to ({error.strerror})") from None
    require_writable_folder("--output", folder)


def check_place(folder: Path) -> None:
    """Make sure, without making it, that `prepare_folder` will be able to.

    Raises
    ------
    InputError
        A file stands there or above it, or the folder above cannot be written to.
    """
    FOLDER.take("--output", folder, False)
    try:
        os.lstat(folder)
    except (FileNotFoundError, NotADirectoryError):
        pass
    except OSError as error:
        raise InputError("--output", str(folder), f"a folder that can be made ({error.strerror})") from None
    above = next(path for path in (folder, *folder.absolute().parents) if os.path.lexists(path))
    if not above.is_dir():
        raise InputError("--output", str(folder), f"a folder that can be made; {above} is a file")
    if not os.access(above, os.W_OK):
        raise InputError("--output", str(folder), f"a folder that can be written to; {above} cannot")


def check_json(path: str | None) -> None:
    """The same for the target of ``--json``."""
    if path == STDOUT and isinstance(sys.stdout, _Closed):
        raise InputError("--json", path, "used with a stdout that is not closed")
    if path not in (None, STDOUT):
        require_writable("--json", Path(str(path)))


def check_apart(targets: Mapping[str, Path | str | None], read: Iterable[Path | None] = ()) -> None:
    """Make sure that no result takes the place of another, or of a file that is read.

    Parameters
    ----------
    targets : mapping
        Option to where its result goes; None where it was not given.
    read : iterable of Path
        Files that the command reads.

    Raises
    ------
    InputError
        It names the second option of one file, or the option whose file is read.
    """
    taken = {os.path.realpath(path): "read" for path in read if path is not None}
    for option, path in targets.items():
        if path is None or path == STDOUT or _is_device(path):
            continue
        place = os.path.realpath(path)
        if place in taken:
            used = "which is read" if taken[place] == "read" else f"which is for {taken[place]}"
            raise InputError(option, str(path), f"another file than this, {used}")
        taken[place] = option


def _is_device(path: Path | str) -> bool:
    """Whether it is written to and not replaced, as /dev/null is."""
    with suppress(OSError, ValueError):
        return os.path.exists(path) and not os.path.isfile(path)
    return False


def plain(value: Any) -> Any:
    """`value` with arrays as lists and non-finite numbers as None, for strict JSON."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def write_json(document: Mapping[str, Any], target: str | None, field: str = "--json") -> None:
    """Write to a file in one move, or to stdout for ``-``; nothing for None."""
    if target is None:
        return
    text = json.dumps(plain(document), indent=None if target == STDOUT else 1, allow_nan=False)
    if target == STDOUT:
        typer.echo(text)
    else:
        write_text(target, text + "\n", field)


def write_to(option: str, path: Path | None, write: Callable[[Path], object] | None) -> None:
    """Write to the path of an option, if there is one, and anything to write.

    Raises
    ------
    InputError
        It cannot be written; it names the option.
    """
    if path is not None and write is not None:
        try:
            write(path)
        except InputError as error:
            raise InputError(option, error.value, error.allowed) from None


def save_to(option: str, path: Path | None, record: Any) -> None:
    """Save a result or an element at the path of an option, if there is one; an `InputError` names the option."""
    from ehlcontact.store import save

    if path is not None:
        save(record, path, option)


def deliver(*steps: Callable[[], object]) -> None:
    """Hand a result over, step by step: one that fails does not keep it from the others.

    Raises
    ------
    InputError, StdoutError
        Of the first step that failed.
    """
    failed: list[InputError | StdoutError] = []
    for step in steps:
        try:
            step()
        except (InputError, StdoutError) as error:
            failed.append(error)
    if failed:
        raise failed[0]


def show_table(title: str, rows: Iterable[tuple[str, str, str]], json_to: str | None) -> None:
    """Compact table of quantity, value and unit on stdout, unless JSON goes there."""
    if json_to == STDOUT:
        return
    table = _table(title, show_header=False)
    table.add_column(style="bold")
    table.add_column(justify="right")
    table.add_column(style="dim", overflow="fold")
    _print(table, rows)


def show_columns(
    heads: Iterable[str], rows: Iterable[Iterable[str]], title: str = "", *, named: bool = False, **look: Any
) -> None:
    """Table of columns on stdout, set to the right; `named`: but for the first one. `look` is for rich's Table."""
    table = _table(title, **look)
    for k, head in enumerate(heads):
        table.add_column(spelled(head, sys.stdout), justify="left" if named and k == 0 else "right")
    _print(table, rows)


def _table(title: str, **look: Any) -> Table:
    shown = spelled(title, sys.stdout) or None
    return Table(title=shown, title_justify="left", pad_edge=False, box=None, **look)


def _print(table: Table, rows: Iterable[Iterable[str]]) -> None:
    for row in rows:
        table.add_row(*(spelled(text, sys.stdout) for text in row))
    Console().print(table)


class StdoutError(Exception):
    """stdout accepts no more; the message is the reason of the system."""

    def __init__(self, error: OSError) -> None:
        self.closed = isinstance(error, BrokenPipeError)
        super().__init__(error.strerror or str(error))


class _Closed(io.TextIOBase):
    """In place of a stdout that was closed before the program started: it takes nothing."""

    encoding = "utf-8"

    def write(self, text: str) -> int:
        """Raise the `StdoutError` of a stream that nobody reads."""
        raise StdoutError(BrokenPipeError())


class _Watched:
    """A stream whose failures are `StdoutError`: libraries for command lines take others for their own matter."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self.failure: StdoutError | None = None

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        """Write the text in characters of the encoding."""
        try:
            return self._stream.write(known(text, self._stream))
        except OSError as error:
            raise self._failure(error) from None

    def flush(self) -> None:
        """Write what is still held back."""
        try:
            self._stream.flush()
        except OSError as error:
            raise self._failure(error) from None

    def _failure(self, error: OSError) -> StdoutError:
        discard(self._stream)
        self.failure = self.failure or StdoutError(error)
        return self.failure


@contextmanager
def watched_stdout() -> Iterator[None]:
    """Within the block stdout raises `StdoutError`, also for what it still holds back at the end."""
    stream = sys.stdout
    if stream is None:
        sys.stdout = _Closed()
        try:
            yield
        finally:
            sys.stdout = stream
        return
    watched = _Watched(stream)
    sys.stdout = watched
    try:
        yield
        watched.flush()
        if watched.failure:  # swallowed by a library that only tried what kind of stream it is
            raise watched.failure
    finally:
        sys.stdout = stream


def to_stderr(line: str) -> None:
    """Write a line on stderr if anybody listens."""
    if sys.stderr is not None:
        try:
            sys.stderr.write(known(line, sys.stderr) + "\n")
            sys.stderr.flush()
        except OSError:
            discard(sys.stderr)


def known(text: str, stream: TextIO) -> str:
    """The text with escapes for characters that the encoding of the stream does not have."""
    encoding = stream.encoding or "utf-8"
    return text.encode(encoding, "backslashreplace").decode(encoding)


def discard(stream: TextIO) -> None:
    """Let what the stream still holds go nowhere: Python would try once more when it ends, and fail."""
    with suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
