"""Work with the library of an FMU in a child process, with limits of time and memory.

A library is native code: it may end the process, crash, hang or take all memory, and then nothing of what Python
would do happens. The child works in a temporary folder of the parent, which is removed whatever becomes of it.
"""

from __future__ import annotations

import faulthandler
import multiprocessing
import os
import pickle
import signal
import tempfile
import warnings
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar

from ehlcontact.checks import require_instance
from ehlcontact.errors import InputError

T = TypeVar("T")

LONGEST = 120.0  # s: a rotor takes some seconds
LARGEST = 2**31  # bytes that the child may take beside what it starts with: an FMU of ours takes some MB
ANSWER = "answer.pickle"


def isolated(work: Callable[[Path], T], path: Path) -> T:
    """`work` of an FMU in a child process; on Windows, which cannot fork, in this one.

    Raises
    ------
    InputError
        The child ended without an answer: the library crashed, called exit, or took too long. What `work` raises
        is raised here.
    """
    if "fork" not in multiprocessing.get_all_start_methods():
        return work(path)
    with tempfile.TemporaryDirectory(prefix="ehlcontact-verify-", ignore_cleanup_errors=True) as folder:
        child: Any = multiprocessing.get_context("fork").Process(target=_answer, args=(work, path, folder))
        with warnings.catch_warnings():  # of threads, which the child has no use for
            warnings.simplefilter("ignore", DeprecationWarning)
            child.start()
        try:
            child.join(LONGEST)
            code = child.exitcode
        finally:
            if child.is_alive():
                child.kill()
            child.join()
        answer = Path(folder, ANSWER)
        if code is None or not answer.exists():
            raise InputError("path", str(path), f"an FMU whose library runs to the end ({_ended(code)})")
        found, error = pickle.loads(answer.read_bytes())
    if error is not None:
        raise error
    return found


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


def _answer(work: Callable[[Path], Any], path: Path, folder: str) -> None:
    """Write what `work` returned or raised to the folder, and end."""
    tempfile.tempdir = folder
    faulthandler.disable()  # how it ended is told by the parent
    _limit()
    found: Any = None
    error: Exception | None = None
    try:
        found = work(path)
    except MemoryError:
        error = InputError("path", str(path), f"an FMU that runs in {LARGEST / 2**30:g} GiB of memory")
    except Exception as raised:
        # its text only: dask has pickle take tracebacks and contexts along, and those of lxml cannot be pickled
        error = raised.with_traceback(None)
        error.__context__ = error.__cause__ = None
    content = pickle.dumps((found, _portable(error)))
    whole = Path(folder, f"{ANSWER}.part")
    whole.write_bytes(content)
    whole.rename(whole.with_name(ANSWER))
    os._exit(0)  # without the end of Python, in which the library would have its say once more


def _portable(error: Exception | None) -> Exception | None:
    """The error, or one with its text where pickle cannot make it again: fmpy's of a call that the FMU refuses."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        return RuntimeError(str(error))
    return error


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
