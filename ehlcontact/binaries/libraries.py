"""Compilation of C sources: of an FMU for each platform, of the library's own for this machine."""

from __future__ import annotations

import os
import platform
import re
import tempfile
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from threading import Event

from ehlcontact.binaries import cache
from ehlcontact.binaries.compiler import Compiler, compilers
from ehlcontact.binaries.headers import Library, read_library, universal
from ehlcontact.binaries.platforms import WEB, WEB_FLAGS, Platform, this_machine
from ehlcontact.binaries.process import BuildError, run
from ehlcontact.errors import warn_user

# Binaries shall run on Linux from here on; what a newer system's compiler makes may need that system.
OLDEST_GLIBC = (2, 17)
WEB_MAGIC = b"\0asm"
LAYOUT = b"2"  # of what is kept: another number where compiled libraries would differ for a reason not in the key

MACRO = re.compile(rb"^#define (\w+)", flags=re.MULTILINE)

Progress = Callable[[int, int], None]


@dataclass(frozen=True, slots=True)
class Work:
    """Input of a compilation: files by name, the files to compile, and the name of the library."""

    sources: Mapping[str, bytes]
    units: Sequence[str]
    identifier: str
    flags: Sequence[str] = ()  # of the compiler, behind those of the platform
    stop: Event = field(default_factory=Event)  # set where it is in vain

    def all_flags(self, target: Platform) -> tuple[str, ...]:
        """Flags of the compiler."""
        if target is WEB:
            return (*WEB_FLAGS, *self.flags)
        return (*target.all_flags(self.identifier), *self.flags)


def build_binaries(
    sources: Mapping[str, bytes],
    units: Sequence[str],
    identifier: str,
    platforms: Sequence[Platform],
    fmi: int,
    progress: Progress | None = None,
) -> tuple[dict[str, bytes], tuple[str, ...]]:
    """Compile C sources for each platform.

    Parameters
    ----------
    sources : mapping
        File name to content, headers included: the ``sources/`` folder of the FMU.
    units : sequence of str
        Files to compile.
    identifier : str
        Name of the model, and of the library.
    platforms : sequence of Platform
        From `choose`.
    fmi : int
        Version of FMI.
    progress : callable, optional
        Called with (number done, number of all).

    Returns
    -------
    files : dict
        Libraries by their path in the FMU. FMI 2 has one folder for both Macs: there lies one universal library.
    labels : tuple of str
        Platform, compiler and flags of each.

    Raises
    ------
    BuildError
        No compiler, or one that failed, was killed, hung, or made something else.
    """
    work = Work(sources, units, identifier)
    _warn_of_first_build(platforms, work)
    made: dict[str, list[bytes]] = {}
    labels = []
    for one, (library, compiler) in zip(platforms, _libraries(work, platforms, progress), strict=True):
        path = f"binaries/{one.folder(fmi)}/{identifier}{one.suffix}"
        made.setdefault(path, []).append(library)
        labels.append(f"{one.name}: {compiler.label} {' '.join(one.all_flags(identifier))}")
    return {path: universal(found) for path, found in made.items()}, tuple(labels)


def build_library(
    sources: Mapping[str, bytes], units: Sequence[str], identifier: str, flags: Sequence[str] = ()
) -> bytes:
    """Compile C sources for this machine alone, with its C library, by the first compiler that can.

    Parameters
    ----------
    sources, units, identifier
        As of `build_binaries`.
    flags : sequence of str
        Of the compiler, behind those of the platform.

    Raises
    ------
    BuildError
        No compiler, one that failed, or a machine that nothing is built for.
    """
    target, work = this_machine(), Work(sources, units, identifier, flags)
    if target is None:
        raise BuildError(f"C code is not built for this machine, {platform.system()} {platform.machine()}")
    tried = compilers(target, any_of_them=True)
    for compiler in tried[:-1]:
        try:
            return _kept(work, target, compiler)
        except BuildError:  # a gcc without the headers of the C library, say
            continue
    return _kept(work, target, tried[-1])


def build_module(sources: Mapping[str, bytes], units: Sequence[str], identifier: str) -> bytes:
    """Compile C sources to a module of WebAssembly, by zig, which has a C library for it.

    Parameters
    ----------
    sources, units, identifier
        As of `build_binaries`.

    Raises
    ------
    BuildError
        No zig, or sources that it does not compile.
    """
    work, compiler = Work(sources, units, identifier), compilers(WEB)[-1]
    key = _key(work, WEB, compiler)
    module = cache.recall(key)
    if module is None:
        module = _compile(work, WEB, compiler)
        if not module.startswith(WEB_MAGIC):
            raise BuildError(f"the C compiler {compiler.label} made no module of WebAssembly")
        cache.remember(key, module)
    return module


def _libraries(
    work: Work, platforms: Sequence[Platform], progress: Progress | None
) -> list[tuple[bytes, Compiler]]:
    """Library and compiler of each platform, compiled in as many threads as there are processors."""
    report = progress or (lambda done, of: None)
    report(0, len(platforms))
    with ThreadPoolExecutor(min(len(platforms), os.cpu_count() or 1)) as pool:
        waiting = [pool.submit(_library, work, one) for one in platforms]
        try:
            for done, one in enumerate(as_completed(waiting), start=1):
                one.result()
                report(done, len(platforms))
        except BaseException:  # Ctrl-C too
            work.stop.set()
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return [one.result() for one in waiting]


def _library(work: Work, target: Platform) -> tuple[bytes, Compiler]:
    """Library by the first compiler whose result runs on glibc 2.17."""
    tried = compilers(target)
    for compiler in tried[:-1]:
        too_new = _key_of_too_new(work, compiler)
        if cache.recall(too_new) is not None:
            continue
        try:
            library, found = _made(work, target, compiler)
        except BuildError:  # a gcc without the headers of the C library, say
            continue
        if found.glibc <= OLDEST_GLIBC:
            return library, compiler
        cache.remember(too_new, b"")
    return _made(work, target, tried[-1])[0], tried[-1]


def _key_of_too_new(work: Work, compiler: Compiler) -> str:
    """Cache key of the mark that a compiler's library needs a newer glibc, shared by elements with equal sources.

    Which functions of the C library a code calls is decided by its files and by which macros its headers define,
    not by their values: a power law calls pow, a cubic none, from the same file.
    """
    defined = sorted({name for content in work.sources.values() for name in MACRO.findall(content)})
    files = (work.sources[unit] for unit in work.units)
    return cache.key_of([LAYOUT, b"too new", compiler.identity.encode(), *defined, b"", *files])


def _made(work: Work, target: Platform, compiler: Compiler) -> tuple[bytes, Library]:
    """Library by one compiler, from the cache if it is there, and its headers."""
    library = _kept(work, target, compiler)
    return library, _checked(library, target, compiler)


def _kept(work: Work, target: Platform, compiler: Compiler) -> bytes:
    """Library by one compiler, from the cache if it is there; its headers are checked before it is kept."""
    key = _key(work, target, compiler)
    library = cache.recall(key)
    if library is None:
        library = _compile(work, target, compiler)
        _checked(library, target, compiler)
        cache.remember(key, library)
    return library


def _key(work: Work, target: Platform, compiler: Compiler) -> str:
    flags = work.all_flags(target)
    texts = (compiler.identity, *compiler.command[1:], work.identifier, *flags, "", *work.units)
    parts = [LAYOUT, *(text.encode("utf-8", "surrogateescape") for text in texts)]
    for name in sorted(work.sources):
        parts += [name.encode(), work.sources[name]]
    return cache.key_of(parts)


def _compile(work: Work, target: Platform, compiler: Compiler) -> bytes:
    file = f"{work.identifier}{target.suffix}"  # Windows has the name inside
    line = [*compiler.command, *work.all_flags(target), "-o", file, *work.units]
    line += [] if target.system == "windows" else ["-lm"]
    try:
        with tempfile.TemporaryDirectory(prefix="ehlcontact-c-", ignore_cleanup_errors=True) as name:
            folder = Path(name)
            for source, content in work.sources.items():
                (folder / source).write_bytes(content)
            run(line, folder, _environment(folder) if compiler.is_zig else {}, work.stop)
            library = folder / file
            if not library.is_file():
                raise BuildError(f"the C compiler made no library: {' '.join(line)}")
            found = library.read_bytes()
    except OSError as error:
        # `tempfile.gettempdir` would raise, too, where there is none; then the reason has the names of all
        place = tempfile.tempdir or "TMPDIR"
        raise BuildError(f"no room to compile in {place} ({error.strerror or error})") from None
    if compiler.is_zig:
        _mark_built(target, compiler)
    return found


def _environment(folder: Path) -> dict[str, str]:
    """Cache folders of zig: a lasting one for C libraries, a temporary one for the rest."""
    shared = cache.zig_folder() or folder / "zig"
    return {cache.ZIG_VARIABLE: str(shared), "ZIG_LOCAL_CACHE_DIR": str(folder / "zig-local")}


def _checked(library: bytes, target: Platform, compiler: Compiler) -> Library:
    """Headers of a library; raises `BuildError` if it is not one for this platform."""
    try:
        (found,) = read_library(library)
    except ValueError as error:
        raise BuildError(f"the C compiler {compiler.label} made {error}") from None
    if found.platform != target.name:
        raise BuildError(f"the C compiler {compiler.label} made a library for {found.platform}, not {target.name}")
    return found


def _warn_of_first_build(platforms: Sequence[Platform], work: Work) -> None:
    """Warn that the first compilation for Windows takes minutes."""
    for one in platforms:
        if one.system != "windows":
            continue
        compiler = compilers(one)[-1]
        mark = _mark(one, compiler)
        if mark is not None and mark.exists():
            continue
        if cache.recall(_key(work, one, compiler)) is None:
            warn_user(
                "the first library for Windows takes about 2 minutes: its C library is compiled too, and kept"
            )


def _mark(target: Platform, compiler: Compiler) -> Path | None:
    """File marking that zig has built the C library of a platform; None without a cache folder."""
    folder = cache.zig_folder()
    if folder is None or not compiler.is_zig:
        return None
    return folder / f"ehlcontact-{cache.key_of([compiler.identity.encode(), target.target.encode()])[:16]}"


def _mark_built(target: Platform, compiler: Compiler) -> None:
    mark = _mark(target, compiler)
    if mark is not None:
        with suppress(OSError):  # a warning too many, next time
            mark.touch()
