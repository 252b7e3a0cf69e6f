"""Cache of compiled libraries in the user's cache folder; without such a folder everything is compiled anew.

A folder that became read-only after it was filled is read.

Entries are those of a `ContentStore`: several processes may write at once, and a damaged entry is ignored. The
least recently used entries are removed beyond a size.
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from ehlcontact.content_store import ContentStore
from ehlcontact.errors import InputError
from ehlcontact.kernel_cache import warn_not_kept

CACHE_VARIABLE = "EHLCONTACT_CACHE"
ZIG_VARIABLE = "ZIG_GLOBAL_CACHE_DIR"
LARGEST = 2**26  # bytes of all entries: some thousand libraries
SUFFIX = ".library"


def cache_folder() -> Path | None:
    """The library's folder in the user's cache, created if missing; None if that is not possible.

    ``EHLCONTACT_CACHE`` if set, else the place that the system has for caches.
    """
    return _folder(CACHE_VARIABLE, "ehlcontact")


def zig_folder() -> Path | None:
    """Folder of zig's global cache (its own default); None if it cannot be written."""
    return _folder(ZIG_VARIABLE, "zig")


def key_of(parts: Iterable[bytes]) -> str:
    """Key of an entry: a hash of all parts and their lengths."""
    found = hashlib.sha256()
    for part in parts:
        found.update(len(part).to_bytes(8, "big") + part)  # where one ends and the next begins
    return found.hexdigest()


def recall(key: str) -> bytes | None:
    """Content of the entry with this key, in a folder that may be read-only; None if missing or damaged."""
    folder = _named(CACHE_VARIABLE, "ehlcontact")
    if folder is None:
        return None
    name = f"{key}{SUFFIX}"
    with suppress(OSError):
        os.utime(folder / name)  # used now
    try:
        return ContentStore(folder, CACHE_VARIABLE).get(name)
    except InputError:  # there is no folder, or it is somebody else's
        return None


def remember(key: str, content: bytes) -> None:
    """Store an entry; a warning where there is no folder for it, or no room."""
    folder = cache_folder()
    if folder is None:
        warn_not_kept("no folder of caches can be written to")
        return
    try:
        ContentStore(folder, CACHE_VARIABLE).put(f"{key}{SUFFIX}", content)
    except InputError as error:  # a full disk, say: only time is lost
        warn_not_kept(str(error))
    with suppress(OSError):
        _shrink(folder)


def _shrink(folder: Path) -> None:
    """Remove the least recently used entries until their total is below `LARGEST`."""
    entries = []
    for path in folder.glob(f"*{SUFFIX}"):
        with suppress(OSError):  # another process may do the same
            there = path.stat()
            entries.append((there.st_mtime_ns, there.st_size, path))
    total = sum(size for _, size, _ in entries)
    for _, size, path in sorted(entries):
        if total <= LARGEST:
            return
        path.unlink(missing_ok=True)
        total -= size


def _folder(variable: str, name: str) -> Path | None:
    """Folder that an environment variable names, else `name` in the user's cache; None if it cannot be written."""
    folder = _named(variable, name)
    try:
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError):  # a file in the way, read-only, no path at all
        return None
    return folder if folder is not None and os.access(folder, os.W_OK | os.X_OK) else None


def _named(variable: str, name: str) -> Path | None:
    """Path of that folder, which need not exist; None without a home."""
    chosen = os.environ.get(variable, "").strip()
    try:
        return Path(chosen).absolute() if chosen else _caches() / name
    except (OSError, RuntimeError):
        return None


def _caches() -> Path:
    """Folder of the user's caches on this system."""
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA", "").strip()
        return Path(base) if base else Path.home() / "AppData" / "Local"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches"
    base = os.environ.get("XDG_CACHE_HOME", "").strip()
    return Path(base) if os.path.isabs(base) else Path.home() / ".cache"
