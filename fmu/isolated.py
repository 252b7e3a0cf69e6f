"""Work with the library of an FMU in a child process, with limits of time and memory.

A library is native code: it may end the process, crash, hang or take all memory, and then nothing of what Python
would do happens. The child works in a temporary folder of the parent, which is removed whatever becomes of it.
"""

from __future__ import annotations

import faulthandler
import json
import multiprocessing
import os
import secrets
import signal
import tempfile
import time
import warnings
from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict
from multiprocessing.connection import wait
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from ehlcontact.checks import require_instance
from ehlcontact.errors import InputError

T = TypeVar("T")

LONGEST = 120.0  # s: a rotor takes some seconds
LARGEST = 2**31  # bytes that the child may take beside what it starts with: an FMU of ours takes some MB
LONGEST_PAUSE = 0.05  # s, between looks at the child
ANSWER = "answer.json"


def isolated(work: Callable[[Path], T], path: Path, read: Callable[[dict[str, Any]], T]) -> T:
    """`work` of an FMU in a child process; on Windows, which cannot fork, in this one.

    The answer is JSON with a number that parent and child alone know: nothing that a library writes is run, and
    what it writes in place of an answer is none.

    Parameters
    ----------
    work : callable
        Returns a dataclass.
    path : Path
    read : callable
        Makes that dataclass of its fields.

    Raises
    ------
    InputError
        The child ended without an answer: the library crashed, called exit, or took too long; or `work` raised it.
    RuntimeError
        `work` raised another error, with this text.
    """
    if "fork" not in multiprocessing.get_all_start_methods():
        return work(path)
    with tempfile.TemporaryDirectory(prefix="ehlcontact-verify-", ignore_cleanup_errors=True) as folder:
        nonce = secrets.token_hex(16)
        child: Any = multiprocessing.get_context("fork").Process(target=_answer, args=(work, path, folder, nonce))
        with warnings.catch_warnings():  # of threads, which the child has no use for
            warnings.simplefilter("ignore", DeprecationWarning)
            child.start()
        try:
            code = _wait(child)
        finally:
            _end(child)
        answer = _read_answer(Path(folder, ANSWER), nonce)
    if code is None or answer is None:
        raise InputError("path", str(path), f"an FMU whose library runs to the end ({_ended(code)})")
    if "refused" in answer:
        raise InputError(*answer["refused"])
    if "error" in answer:
        raise RuntimeError(answer["error"])
    return read(answer["found"])


def _wait(child: Any) -> int | None:
    """Exit code of the child; None where it runs longer. Processes it left behind are not waited for."""
    until = time.monotonic() + LONGEST
    while child.exitcode is None and time.monotonic() < until:
        # its end closes the sentinel, unless such a process has it too: then this is a pause
        wait([child.sentinel], timeout=LONGEST_PAUSE)
    return child.exitcode


def _end(child: Any) -> None:
    """End the child and what it left behind, as far as this is in its group."""
    for end in (child.kill, lambda: os.killpg(child.pid, signal.SIGKILL)):
        with suppress(OSError):  # ended
            end()
    while child.exitcode is None:
        wait([child.sentinel], timeout=LONGEST_PAUSE)
    with suppress(OSError):  # of a process that began meanwhile
        os.killpg(child.pid, signal.SIGKILL)


def _read_answer(file: Path, nonce: str) -> dict[str, Any] | None:
    """Answer of the child; None where there is none."""
    try:
        answer = json.loads(file.read_bytes())
    except (OSError, ValueError):
        return None
    return answer if isinstance(answer, dict) and answer.get("nonce") == nonce else None


def require_path(path: object) -> Path:
    """`path` as one; raises `InputError` for what is none."""
    require_instance("path", path, str | os.PathLike, "the name of a file")
    return Path(path)  # type: ignore[arg-type]


def _ended(code: int | None) -> str:
    """How the child ended, in words."""
    if code is None:
        return f"it was still running after {LONGEST:g} s"
    if code < 0:
        name = signal.Signals(-code).name if -code in set(signal.Signals) else f"signal {-code}"
        return f"it crashed: {name}"
    return f"it ended the process with exit code {code}"


def _answer(work: Callable[[Path], Any], path: Path, folder: str, nonce: str) -> None:
    """Write what `work` returned or raised to the folder, and end."""
    tempfile.tempdir = folder
    os.setpgid(0, 0)  # for what the library leaves behind to be ended too
    faulthandler.disable()  # how it ended is told by the parent
    _limit()
    answer: dict[str, Any]
    try:
        answer = {"found": asdict(work(path))}
    except MemoryError:
        answer = {"refused": ("path", str(path), f"an FMU that runs in {LARGEST / 2**30:g} GiB of memory")}
    except InputError as error:
        answer = {"refused": (error.field, error.value, error.allowed)}
    except Exception as error:
        answer = {"error": str(error) or type(error).__name__}
    whole = Path(folder, f"{ANSWER}.part")
    whole.write_text(json.dumps(answer | {"nonce": nonce}, default=_plain))
    whole.rename(whole.with_name(ANSWER))
    os._exit(0)  # without the end of Python, in which the library would have its say once more


def _plain(value: Any) -> Any:
    """Numbers of numpy as Python's, and anything else as text."""
    return value.item() if isinstance(value, np.generic) else str(value)


def _limit() -> None:
    """Limit memory, and the time of the processor should the parent be gone."""
    import resource

    with suppress(OSError, ValueError):  # macOS has no limit of memory
        pages = int(Path("/proc/self/statm").read_text().split()[0])
        limit = pages * resource.getpagesize() + LARGEST
        resource.setrlimit(resource.RLIMIT_AS, (limit, resource.getrlimit(resource.RLIMIT_AS)[1]))
    with suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_CPU, (int(LONGEST) + 1, int(LONGEST) + 1))
    with suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
