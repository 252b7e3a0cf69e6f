"""Headers of shared libraries (ELF, PE, Mach-O), read with LIEF; universal Mach-O files, written here."""

from __future__ import annotations

import re
import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

UNIVERSAL = b"\xca\xfe\xba\xbe"  # first bytes of a Mach-O file with several libraries (fat.h)
ALIGNMENT = 14  # power of two, of each library in such a file: pages of arm64
MACHINES = {"X86_64": "x86_64", "AMD64": "x86_64", "AARCH64": "aarch64", "ARM64": "aarch64"}


@dataclass(frozen=True, slots=True)
class Library:
    """A shared library by its headers.

    Attributes
    ----------
    platform : str
        Architecture and system, as FMI 3 has them: ``x86_64-linux``.
    exports : frozenset of str
        Functions that can be called from outside.
    needs : tuple of str
        Libraries that it loads.
    glibc : tuple of int
        Newest version of the GNU C library that a symbol needs, () for none.
    minimum : tuple of int
        Oldest macOS that it runs on, () elsewhere.
    name : str
        Name it is linked by: install name of a Mach-O, soname of an ELF, module of a PE; "" for none.
    signed : bool
        Whether it has a code signature, which macOS requires on arm64.
    """

    platform: str
    exports: frozenset[str]
    needs: tuple[str, ...]
    glibc: tuple[int, ...] = ()
    minimum: tuple[int, ...] = ()
    name: str = ""
    signed: bool = False


def read_library(content: bytes) -> tuple[Library, ...]:
    """Read the headers of an ELF, PE or Mach-O library; a universal Mach-O holds several.

    Raises
    ------
    ValueError
        None of these, or damaged.
    """
    import lief

    lief.logging.disable()
    try:
        if content.startswith((UNIVERSAL, b"\xcf\xfa\xed\xfe")):
            found = lief.MachO.parse(list(content))
            parsed: list[Any] = [] if found is None else [found.at(k) for k in range(found.size)]
        else:
            one = lief.parse(list(content)) if content else None
            parsed = [] if one is None else [one]
        readers: dict[Any, Callable[[Any], Library]] = {
            lief.ELF.Binary: _elf,
            lief.PE.Binary: _pe,
            lief.MachO.Binary: _macho,
        }
        libraries = [readers[type(one)](one) for one in parsed]
        early = any(_end(one) > len(content) for one in parsed)
    except (SystemError, KeyError) as error:  # an entry that LIEF has no name for; a format that is none of these
        raise ValueError(f"a damaged library ({type(error).__name__} in its headers)") from None
    if early:
        raise ValueError("a damaged library: it ends too early")
    if not libraries:
        raise ValueError("no ELF, PE or Mach-O library, or a damaged library")
    return tuple(libraries)


def _end(library: Any) -> int:
    """First byte behind all that the headers say is in the file."""
    if hasattr(library, "segments"):  # ELF, Mach-O
        shift = getattr(library, "fat_offset", 0)
        sizes = [
            (s.file_offset, getattr(s, "physical_size", getattr(s, "file_size", 0))) for s in library.segments
        ]
    else:
        shift, sizes = 0, [(s.pointerto_raw_data, s.sizeof_raw_data) for s in library.sections]
    return shift + max((offset + size for offset, size in sizes), default=0)


def _text(name: str | bytes) -> str:
    """Name as LIEF gives it: bytes where it is no UTF-8."""
    if isinstance(name, bytes):
        raise ValueError(f"a damaged library: the name {name!r}")
    return name


def _platform(machine: Any, system: str) -> str:
    if machine.name in ("NONE", "UNKNOWN"):
        raise ValueError("a damaged library: no architecture in its header")
    return f"{MACHINES.get(machine.name, machine.name)}-{system}"


def _elf(library: Any) -> Library:
    import lief

    versions = [_text(a.name) for r in library.symbols_version_requirement for a in r.get_auxiliary_symbols()]
    glibc = [re.fullmatch(r"GLIBC_([\d.]+)", version) for version in versions]
    soname = library.get(lief.ELF.DynamicEntry.TAG.SONAME)
    return Library(
        platform=_platform(library.header.machine_type, "linux"),
        exports=frozenset(_text(symbol.name) for symbol in library.exported_symbols),
        needs=tuple(map(_text, library.libraries)),
        glibc=max((tuple(map(int, match[1].split("."))) for match in glibc if match), default=()),
        name="" if soname is None else _text(soname.name),
    )


def _pe(library: Any) -> Library:
    table = library.get_export() if library.has_exports else None
    return Library(
        platform=_platform(library.header.machine, "windows"),
        exports=frozenset() if table is None else frozenset(_text(entry.name) for entry in table.entries),
        needs=tuple(map(_text, library.libraries)),
        name="" if table is None else _text(table.name),
    )


def _macho(library: Any) -> Library:
    import lief

    own, needs = "", []
    for command in library.libraries:
        if command.command == lief.MachO.LoadCommand.TYPE.ID_DYLIB:
            own = _text(command.name)
        else:
            needs.append(_text(command.name))
    built = library.build_version.minos if library.has_build_version else None
    built = library.version_min.version if built is None and library.has_version_min else built
    return Library(
        platform=_platform(library.header.cpu_type, "darwin"),
        exports=frozenset(_text(symbol.name).removeprefix("_") for symbol in library.exported_symbols),
        needs=tuple(needs),
        minimum=() if built is None else tuple(built[:2]),
        name=own,
        signed=library.has_code_signature,
    )


def universal(libraries: Sequence[bytes]) -> bytes:
    """One Mach-O file with libraries of several architectures; the system takes the one that fits."""
    if len(libraries) == 1:
        return libraries[0]
    unit = 1 << ALIGNMENT
    table = struct.pack(">4sI", UNIVERSAL, len(libraries))
    body = b""
    for library in libraries:
        offset = unit + len(body)
        cpu, kind = struct.unpack_from("<II", library, 4)
        table += struct.pack(">IIIII", cpu, kind, offset, len(library), ALIGNMENT)
        body += library + bytes(-len(library) % unit)
    return table + bytes(unit - len(table)) + body
