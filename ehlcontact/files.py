"""Files written in one move, and texts of any origin.

A file is never half written: a reader finds the old content or the new, whatever happens in between. A text that
is too large, nested too deeply or no text at all raises an error that names the reason.
"""

from __future__ import annotations

import errno
import json
import os
import platform
import re
import stat
import tempfile
import time
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

from ehlcontact.errors import InputError

LARGEST_TEXT = 2**28  # bytes of a JSON or TOML file: a hundred times the largest of ours; /dev/zero has no end
DEEPEST = 50  # levels of nested JSON: ours have six, and Python writes and compares some hundred at most
LONGEST_INTEGER = 300  # digits: what is longer is no float any more
STALE = 5.0  # seconds without a write after which no process of another machine is writing a file any more
# A file that is being written: whose place it will take, machine and process that write, when that process was
# started, and a number of its own.
_TEMPORARY = re.compile(
    r"\.(?P<target>[0-9a-f]{8})(?P<machine>[0-9a-f]{8})(?P<process>[0-9a-f]{8})(?P<start>[0-9a-f]{8})[0-9a-f]{8}\.tmp"
)
_LONE_SURROGATE = re.compile("[\ud800-\udfff]")


@contextmanager
def replacing(path: str | os.PathLike[str], field: str = "path") -> Iterator[Path]:
    """Give a new, empty file beside `path` to write to; it takes the place of `path` if nothing was raised.

    It is on the disk before it takes that place: some file systems tell only then that there is no room (NFS,
    quotas), and without it a power cut can leave an empty file under the name of the good one. A link is followed;
    what is no file to replace (``/dev/stdout``, a pipe) is written to as it is.

    Parameters
    ----------
    path : path
        The file to make or to replace.
    field : str
        What it is called in messages.

    Raises
    ------
    InputError
        The folder cannot be written to, or the file cannot: an `OSError` within the block is turned into it.
    """
    try:
        target = Path(os.path.realpath(path))
        in_place = _is_device(target)
        # not tempfile: it makes files that only their owner may read
        temporary = target if in_place else temporary_for(target)
        if not in_place:
            temporary.touch(exist_ok=False)
    except OSError as error:
        raise InputError(field, str(path), f"in a folder that can be written to ({error.strerror})") from None
    except (TypeError, ValueError) as error:  # no path at all, or one with a zero byte
        raise InputError(field, path, f"the path of a file ({error})") from None
    try:
        yield temporary
        if not in_place:
            with temporary.open("rb+") as stream:
                os.fsync(stream.fileno())
            os.replace(temporary, target)
            remove_leftovers(target.parent, target)
    except OSError as error:
        raise InputError(field, str(path), f"a file that can be written ({error.strerror or error})") from None
    finally:
        if not in_place:
            with suppress(OSError):  # the folder itself may be gone; the first error says why
                temporary.unlink(missing_ok=True)


def temporary_for(target: Path) -> Path:
    """Name beside a file for what takes its place; short, so that a long one fits."""
    process = os.getpid()
    own = f"{_short_hash(target.name)}{_machine()}{process:08x}{_start(process):08x}{uuid.uuid4().hex[:8]}"
    return target.with_name(f".{own}.tmp")


def remove_leftovers(folder: Path, target: Path | None = None) -> None:
    """Remove files that were being written, to take the place of `target` or of any, when a process was killed."""
    for path in folder.glob(".*.tmp"):
        parts = _TEMPORARY.fullmatch(path.name)
        if parts is None or (target is not None and parts["target"] != _short_hash(target.name)):
            continue
        with suppress(OSError):
            if _is_abandoned(path, parts["machine"], int(parts["process"], 16), int(parts["start"], 16)):
                path.unlink()


def _is_abandoned(path: Path, machine: str, process: int, start: int) -> bool:
    """Whether the process that wrote a file is gone; of another machine's, whether nothing was written lately.

    Another process may have its number: after a restart of the machine, or in a container, where the same command
    has the same number at every start.
    """
    if machine != _machine() or os.name != "posix":
        return time.time() - path.stat().st_mtime > STALE
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return True
    except OSError:  # of another user
        pass
    return _start(process) not in (start, 0)


def _start(process: int) -> int:
    """When a process was started, in ticks since the start of the machine, modulo 2^32; 0 where no file has it."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text("utf-8", "replace").rpartition(")")[2].split()
        return int(fields[19]) & 0xFFFFFFFF
    except (OSError, LookupError, ValueError):
        return 0


@cache
def _machine() -> str:
    """Where a number names a process: this machine, or this container of it."""
    try:
        names = os.stat("/proc/self/ns/pid").st_ino
    except OSError:
        names = 0
    return _short_hash(f"{platform.node()} {names}")


def _short_hash(text: str) -> str:
    return sha256(text.encode("utf-8", "surrogateescape")).hexdigest()[:8]


def write_text(path: str | os.PathLike[str], text: str, field: str = "path") -> Path:
    """Write a text file as UTF-8 by `replacing`."""
    return write_bytes(path, text.encode("utf-8"), field)


def write_bytes(path: str | os.PathLike[str], content: bytes, field: str = "path") -> Path:
    """Write a file by `replacing`."""
    with replacing(path, field) as temporary:
        temporary.write_bytes(content)
    return Path(path)


def require_writable(field: str, path: Path, suffixes: tuple[str, ...] = ()) -> None:
    """Make sure, before long work, that a file can be written.

    Raises
    ------
    InputError
        Wrong ending, a folder of that name, or a folder that does not exist or cannot be written to; it names the
        file as `field`.
    """
    if suffixes and path.suffix.lower() not in suffixes:
        raise InputError(field, str(path), "a file name ending in " + " or ".join(suffixes))
    try:
        if path.is_dir():
            raise InputError(field, str(path), "a file, not a folder")
        if not path.parent.is_dir():
            raise InputError(field, str(path), "in a folder that exists")
        if is_named_pipe(path):
            raise InputError(field, str(path), "a file, not a pipe with a name, which may wait for ever")
        if path.exists() and not path.is_file():  # a device, which is written to and not replaced
            return
        path.lstat()  # whether there can be a file of that name
    except FileNotFoundError:  # a new file, which is what most are
        pass
    except OSError as error:
        raise InputError(field, str(path), f"a file that can be written ({error.strerror})") from None
    require_writable_folder(field, path.parent, str(path))


def require_writable_folder(field: str, folder: Path, named: str | None = None) -> None:
    """Make sure that files can be made in an existing folder."""
    try:
        with tempfile.TemporaryFile(dir=folder):
            return
    except OSError as error:
        allowed = f"in a folder that can be written to ({error.strerror})"
        raise InputError(field, named or str(folder), allowed) from None


def is_named_pipe(path: str | os.PathLike[str]) -> bool:
    """Whether it is a pipe that `mkfifo` made, which one may wait at for ever; not /dev/stdin or a <(...)."""
    try:
        return stat.S_ISFIFO(os.lstat(os.path.realpath(path)).st_mode)
    except (OSError, ValueError):
        return False


def require_no_pipe(path: str | os.PathLike[str]) -> None:
    """Raise `OSError` for a pipe with a name."""
    if is_named_pipe(path):
        raise OSError(errno.ESPIPE, "a pipe with a name, in place of a file", str(path))


def is_file(path: str | os.PathLike[str]) -> bool:
    """Whether there is a regular file; False, too, where one may not look or no name is that long."""
    try:
        return Path(path).is_file()
    except OSError:
        return False


def read_text(path: str | os.PathLike[str]) -> str:
    """Return the whole of a UTF-8 file, without the byte order mark that editors on Windows begin it with.

    Raises
    ------
    OSError
        There is none, or it cannot be read, or it is a pipe with a name.
    ValueError
        Not UTF-8, or larger than any file of ours.
    """
    require_no_pipe(path)
    with Path(path).open("rb") as stream:
        content = stream.read(LARGEST_TEXT + 1)
    if len(content) > LARGEST_TEXT:
        raise ValueError(f"more than {LARGEST_TEXT >> 20} MiB")
    return content.decode("utf-8-sig")


def parse_json(text: str | bytes, nan: bool = False) -> Any:
    """Return what JSON text says, fit to be used and written again.

    Parameters
    ----------
    text : str or bytes
    nan : bool
        Whether NaN and Infinity, which Python writes but JSON does not know, are accepted.

    Raises
    ------
    ValueError
        Not JSON, or nested deeper, or with longer integers or other characters than any that is meant.
    """
    refuse = None if nan else _refuse_constant
    try:
        document = json.loads(text, parse_int=_integer, parse_constant=refuse, object_pairs_hook=_object)
    except RecursionError:
        raise ValueError("nested too deeply") from None
    level = [document]
    for _ in range(DEEPEST):
        level = [member for value in level for member in _members(value)]
        if not level:
            break
    else:
        raise ValueError("nested too deeply")
    if _LONE_SURROGATE.search(json.dumps(document, ensure_ascii=False)):
        raise ValueError("half a character (a lone surrogate)")
    return document


def _is_device(target: Path) -> bool:
    try:
        mode = target.stat().st_mode
    except OSError:
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))


def _members(value: Any) -> list[Any]:
    if isinstance(value, dict):
        return list(value.values())
    return value if isinstance(value, list) else []


def _integer(digits: str) -> int:
    if len(digits) > LONGEST_INTEGER:
        raise ValueError(f"a whole number of {len(digits)} digits")
    return int(digits)


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """An object of JSON, whose names differ: of two the standard lets a reader take either."""
    found = dict(pairs)
    if len(found) < len(pairs):
        names = [name for name, _ in pairs]
        raise ValueError(f"{next(name for name in names if names.count(name) > 1)!r} twice in an object")
    return found


def _refuse_constant(text: str) -> float:
    raise ValueError(f"{text} is not JSON")
