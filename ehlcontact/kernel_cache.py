"""Numba's cache of compiled kernels on disk: renewed, checked before it is used, and done without.

Numba runs what it finds in a file. One that a full disk or a power cut left empty, cut or of zeros would end every
later start in a traceback or a segmentation fault. So each has a checksum before its content, and what does not
agree with it is compiled anew. Where no folder can be written to, kernels are compiled in every process.

Processes that need a kernel at one time compile it once: the first leaves a file beside the index, and the others
wait for what it keeps. Two that saved types of one kernel together would each write an index without the other's,
whose kernel every later run would compile again.
"""

from __future__ import annotations

import os
import pickle
import re
import socket
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

import numba
from numba.core import config
from numba.core.caching import (
    CompileResultCacheImpl,
    FunctionCache,
    IndexDataCacheFile,
    InTreeCacheLocator,
)
from numba.core.sigutils import normalize_signature
from numba.misc.appdirs import AppDirs

from ehlcontact.errors import warn_user
from ehlcontact.files import remove_leftovers, temporary_for

_PACKAGES = "ehlcontact", "reduced_models", "fmu"
_IMPORT = re.compile(r"^(?:from|import) ([\w.]+)", re.MULTILINE)
DIGEST = sha256().digest_size  # bytes before the content of a file
PATIENCE, TICK = 120.0, 0.05  # s: of a process that waits for another's kernel, and between its looks
SUFFIX = "checked"  # of names: files that numba keeps of other decorators have no checksum


@cache
def _source(module: str) -> tuple[bytes, tuple[str, ...]]:
    """Digest of the source of a loaded module, and which of our modules it imports as it is loaded."""
    file = getattr(sys.modules.get(module), "__file__", None)
    text = Path(file).read_text("utf-8") if file and Path(file).is_file() else ""
    names = dict.fromkeys(_IMPORT.findall(text))
    return sha256(text.encode()).digest(), tuple(name for name in names if name.partition(".")[0] in _PACKAGES)


@cache
def sources(module: str) -> str:
    """Digest of the sources of a module and of all of ours that it imports, by others too, as it is loaded."""
    found: dict[str, bytes] = {}
    names = [module]
    while names:
        if (name := names.pop()) not in found:
            found[name], more = _source(name)
            names += more
    return sha256(b"".join(found[name] for name in sorted(found))).hexdigest()[:16]


class KernelCache(FunctionCache):
    """Cache of a kernel, renewed after a change of any source that the kernel depends on.

    Numba looks at the kernel's own file alone. Kernels that it calls, types and constants of other files may have
    changed since: results are wrong then, or the cache cannot be read because a class is no longer there.
    """

    def __init__(self, kernel: Any) -> None:
        self._impl_class = _Place
        super().__init__(kernel)
        stamp = self._impl.locator.get_source_stamp()
        self._cache_file: Any = _Files(self._cache_path, f"{self._impl.filename_base}.{SUFFIX}", stamp)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Compiled kernel for a signature; None where there is none that is sound, and of these sources.

        A kernel that another process compiles meanwhile is awaited; None leaves its file to this process.
        """
        deadline = time.monotonic() + PATIENCE
        while True:
            found = self._loaded(sig, target_context)
            if found is not None or self._claimed() or time.monotonic() > deadline:
                return found
            time.sleep(TICK)

    @property
    def is_kept(self) -> bool:
        """Whether a kernel of these sources is there, for whatever types."""
        self._renew()
        return bool(self._cache_file._load_index())

    def _renew(self) -> None:
        """Have the version of the index be that of the sources: compared before anything else is read."""
        self._cache_file._version = f"{numba.__version__} {sources(self._py_func.__module__)}"

    def _loaded(self, sig: Any, target_context: Any) -> Any:
        self._renew()
        try:
            found = super().load_overload(sig, target_context)
        except Exception:  # with a checksum that agrees: of another version of what numba stands on, say
            _warn_damaged(self._cache_path)
            return None
        # Two processes that save one kernel for different types within a millisecond may leave an index that names
        # the file of the other's: numba numbers files by what was in the index.
        same = found is not None and tuple(found.signature.args) == tuple(normalize_signature(sig)[0])
        return found if same else None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep a compiled kernel, where there is room."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            warn_not_kept(f"{self._cache_path}: {error.strerror or error}")
        finally:
            with suppress(OSError):
                self._claim.unlink()

    @property
    def _claim(self) -> Path:
        """File that a process leaves while it compiles the kernel."""
        return Path(f"{self._cache_file._index_path}.claim")

    def _claimed(self) -> bool:
        """Whether this process may compile the kernel: no other one that lives is at it."""
        own = f"{socket.gethostname()} {os.getpid()}"
        try:
            with self._claim.open("x", encoding="utf-8") as stream:
                stream.write(own)
        except FileExistsError:
            return not self._is_alive(own)
        except OSError:  # nothing can be kept there
            return True
        return True

    def _is_alive(self, own: str) -> bool:
        """Whether the process that claims the kernel is another one that runs, as far as this machine can tell."""
        try:
            claim, age = self._claim.read_text("utf-8"), time.time() - self._claim.stat().st_mtime
        except FileNotFoundError:  # it has just ended
            return True
        except OSError:
            return False
        host, _, number = claim.partition(" ")
        if claim == own or age > PATIENCE:
            return False
        if host != own.partition(" ")[0] or not number.isdigit():
            return True
        try:
            os.kill(int(number), 0)
        except ProcessLookupError:
            return False
        except OSError:
            return True
        return True


class _Files(IndexDataCacheFile):
    """Index of a kernel's signatures, and a file for each; a checksum before the content of all."""

    def _load_index(self) -> dict[Any, str]:
        try:
            version, _, content = self._content(self._index_path).partition(b"\n")
        except OSError:
            return {}
        if version != self._version.encode():
            return {}
        stamp, names = pickle.loads(content)
        return names if stamp == self._source_stamp else {}

    def _save_index(self, overloads: dict[Any, str]) -> None:
        content = self._dump((self._source_stamp, overloads))
        self._write(self._index_path, self._version.encode() + b"\n" + content)

    def _load_data(self, name: str) -> Any:
        return pickle.loads(self._content(self._data_path(name)))

    def _save_data(self, name: str, data: Any) -> None:
        self._write(self._data_path(name), self._dump(data))

    def _content(self, path: str) -> bytes:
        """Content of a file; raises `OSError`, as for one that is not there, where its checksum does not agree."""
        with open(path, "rb") as stream:
            digest, content = stream.read(DIGEST), stream.read()
        if digest != sha256(content).digest():
            _warn_damaged(self._cache_path)
            raise OSError(f"{path} is damaged")
        return content

    def _write(self, path: str, content: bytes) -> None:
        """Write a file in one move, and not through to the disk, which the checksum does without."""
        with self._open_for_write(path) as stream:
            stream.write(sha256(content).digest() + content)

    @contextmanager
    def _open_for_write(self, filepath: str) -> Iterator[Any]:
        target = Path(filepath)
        temporary = temporary_for(target)
        try:
            with temporary.open("wb") as stream:
                yield stream
            os.replace(temporary, target)
        finally:
            with suppress(OSError):
                temporary.unlink(missing_ok=True)
        remove_leftovers(target.parent, target)


class _Folder(InTreeCacheLocator):
    """Folder of the kernels of a source file: numba's, or, where none can be written to, the first of them.

    What was compiled into that one before it became read-only is found there.
    """

    def __init__(self, py_func: Any, py_file: str) -> None:
        super().__init__(py_func, py_file)
        chosen: str = config.CACHE_DIR  # type: ignore[attr-defined]
        self._cache_path = _folder(os.path.dirname(os.path.abspath(py_file)), chosen)

    @classmethod
    def from_function(cls, py_func: Any, py_file: str) -> _Folder | None:
        return cls(py_func, py_file) if os.path.exists(py_file) else None


class _Place(CompileResultCacheImpl):
    _locator_classes = [_Folder, *CompileResultCacheImpl._locator_classes]  # noqa: RUF012 (numba's)


@cache
def _folder(source: str, chosen: str) -> str:
    """Folder of compiled code for a folder of sources: in ``NUMBA_CACHE_DIR``, beside them, or in the user's."""
    own = InTreeCacheLocator.get_suitable_cache_subpath(os.path.join(source, "kernel.py"))
    places = [os.path.join(chosen, own)] if chosen else []
    places.append(os.path.join(source, "__pycache__"))
    user = AppDirs(appname="numba", appauthor=False).user_cache_dir
    if os.path.isabs(user):  # else there is no home
        places.append(os.path.join(user, own))
    return next((place for place in places if _is_writable(place)), places[0])


def _is_writable(folder: str) -> bool:
    try:
        os.makedirs(folder, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return False
    return True


NOT_KEPT = "compiled code is not kept, and compiled anew at every start"
_given: set[str] = set()  # warnings that this process has given, of whatever number of kernels


def _warn(text: str, reason: str) -> None:
    if text not in _given:
        _given.add(text)
        warn_user(f"{text} ({reason})", RuntimeWarning)


def _warn_damaged(folder: str) -> None:
    _warn("kept compiled code was damaged, and is compiled anew", folder)


def warn_not_kept(reason: str) -> None:
    """Warn, once, that compiled code cannot be kept, with the reason of the system."""
    folders = "NUMBA_CACHE_DIR and EHLCONTACT_CACHE name other folders"
    _warn(NOT_KEPT, f"{reason}; {folders}")


def is_keeping() -> bool:
    """Whether what this process compiles can be kept, as far as it has tried."""
    chosen: str = config.CACHE_DIR  # type: ignore[attr-defined]
    return NOT_KEPT not in _given and _is_writable(_folder(os.path.dirname(os.path.abspath(__file__)), chosen))
