"""Sources in, a library for each platform out."""

from __future__ import annotations

import tempfile
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from fmu.binaries import cache, macho
from fmu.binaries.compiler import Compiler, compilers
from fmu.binaries.headers import Library, read_library
from fmu.binaries.platforms import Platform
from fmu.binaries.process import BuildError, run

# Binaries shall run on Linux from here on; what a newer system's compiler makes may need that system.
OLDEST_GLIBC = (2, 17)
LAYOUT = b"2"  # of what is kept: another number where compiled libraries would differ for a reason not in the key

Progress = Callable[[int, int], None]


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
        Told (number done, number of all).

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
    made: dict[str, list[bytes]] = {}
    labels = []
    _warn_of_first_build(platforms, sources, units, identifier)
    for done, one in enumerate(platforms):
        if progress is not None:
            progress(done, len(platforms))
        library, compiler = _library(sources, units, identifier, one)
        path = f"binaries/{one.folder(fmi)}/{identifier}{one.suffix}"
        made.setdefault(path, []).append(library)
        labels.append(f"{one.name}: {compiler.label} {' '.join(one.all_flags(identifier))}")
    if progress is not None:
        progress(len(platforms), len(platforms))
    return {path: macho.universal(found) for path, found in made.items()}, tuple(labels)


def _library(
    sources: Mapping[str, bytes], units: Sequence[str], identifier: str, target: Platform
) -> tuple[bytes, Compiler]:
    """Library by the first compiler that makes a good one."""
    tried = compilers(target)
    for compiler in tried[:-1]:
        try:
            library, found = _made(sources, units, identifier, target, compiler)
        except BuildError:  # a gcc without the headers of the C library, say
            continue
        if found.glibc <= OLDEST_GLIBC:
            return library, compiler
    return _made(sources, units, identifier, target, tried[-1])[0], tried[-1]


def _made(
    sources: Mapping[str, bytes], units: Sequence[str], identifier: str, target: Platform, compiler: Compiler
) -> tuple[bytes, Library]:
    """Library by one compiler, or as it was made before."""
    key = _key(sources, units, identifier, target, compiler)
    library = cache.recall(key)
    if library is None:
        library = _compile(sources, units, identifier, target, compiler)
        found = _checked(library, target, compiler)
        cache.remember(key, library)
        return library, found
    return library, _checked(library, target, compiler)


def _key(
    sources: Mapping[str, bytes], units: Sequence[str], identifier: str, target: Platform, compiler: Compiler
) -> str:
    texts = (compiler.identity, *compiler.command[1:], identifier, *target.all_flags(identifier), "", *units)
    parts = [LAYOUT, *(text.encode("utf-8", "surrogateescape") for text in texts)]
    for name in sorted(sources):
        parts += [name.encode(), sources[name]]
    return cache.key_of(parts)


def _compile(
    sources: Mapping[str, bytes], units: Sequence[str], identifier: str, target: Platform, compiler: Compiler
) -> bytes:
    file = f"{identifier}{target.suffix}"  # Windows has the name inside
    line = [*compiler.command, *target.all_flags(identifier), "-o", file, *units]
    line += [] if target.system == "windows" else ["-lm"]
    try:
        with tempfile.TemporaryDirectory(prefix="ehlcontact-fmu-", ignore_cleanup_errors=True) as name:
            folder = Path(name)
            for source, content in sources.items():
                (folder / source).write_bytes(content)
            run(line, folder, _environment(folder) if compiler.is_zig else {})
            library = folder / file
            if not library.is_file():
                raise BuildError(f"the C compiler made no library: {' '.join(line)}")
            found = library.read_bytes()
    except OSError as error:
        raise BuildError(f"no room to compile in {tempfile.gettempdir()} ({error.strerror or error})") from None
    if compiler.is_zig:
        _tick_off(target, compiler)
    return found


def _environment(folder: Path) -> dict[str, str]:
    """Where zig keeps things: C libraries where they are found again, all else where it goes with the folder."""
    shared = cache.zig_folder() or folder / "zig"
    return {cache.ZIG_VARIABLE: str(shared), "ZIG_LOCAL_CACHE_DIR": str(folder / "zig-local")}


def _checked(library: bytes, target: Platform, compiler: Compiler) -> Library:
    """Headers of a library, once it is sure to be one for this platform."""
    try:
        (found,) = read_library(library)
    except ValueError as error:
        raise BuildError(f"the C compiler {compiler.label} made {error}") from None
    if found.platform != target.name:
        raise BuildError(f"the C compiler {compiler.label} made a library for {found.platform}, not {target.name}")
    return found


def _warn_of_first_build(
    platforms: Sequence[Platform], sources: Mapping[str, bytes], units: Sequence[str], identifier: str
) -> None:
    """Say that a minute or two will pass, before they do."""
    for one in platforms:
        if one.system != "windows":
            continue
        compiler = compilers(one)[-1]
        mark = _mark(one, compiler)
        if mark is not None and mark.exists():
            continue
        if cache.recall(_key(sources, units, identifier, one, compiler)) is None:
            warnings.warn(
                "the first library for Windows takes about 2 minutes: its C library is compiled too, and kept",
                stacklevel=2,
            )


def _mark(target: Platform, compiler: Compiler) -> Path | None:
    """File that says that zig has the C library of a platform; None where nothing can be kept."""
    folder = cache.zig_folder()
    if folder is None or not compiler.is_zig:
        return None
    return folder / f"ehlcontact-{cache.key_of([compiler.identity.encode(), target.target.encode()])[:16]}"


def _tick_off(target: Platform, compiler: Compiler) -> None:
    mark = _mark(target, compiler)
    if mark is not None:
        with suppress(OSError):  # a warning too many, next time
            mark.touch()
