"""Headers of shared libraries (ELF, PE, Mach-O), read with LIEF; universal Mach-O files, written here."""

from __future__ import annotations

import re
import struct
from collections.abc import Sequence
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
    glibc : tuple of int
        Newest version of the GNU C library that a symbol needs, () for none.
    """

    platform: str
    glibc: tuple[int, ...] = ()


def read_library(content: bytes) -> tuple[Library, ...]:
    """Read the headers of an ELF, PE or Mach-O library; a universal Mach-O holds several.

    Raises
    ------
    ValueError
        None of these, or damaged.
    """
    try:
        parsed = parse(content)
        libraries = tuple(map(_library, parsed))
        early = any(_end(one) > len(content) for one in parsed)
    except (SystemError, KeyError) as error:  # an entry that LIEF has no name for; a format that is none of these
        raise ValueError(f"a damaged library ({type(error).__name__} in its headers)") from None
    if early:
        raise ValueError("a damaged library: it ends too early")
    if not libraries:
        raise ValueError("no ELF, PE or Mach-O library, or a damaged library")
    return libraries


def parse(content: bytes) -> list[Any]:
    """Libraries in a file, as LIEF parses them; none where it is no library."""
    import lief

    lief.logging.disable()
    if content.startswith((UNIVERSAL, b"\xcf\xfa\xed\xfe")):
        found = lief.MachO.parse(list(content))
        return [] if found is None else [found.at(k) for k in range(found.size)]
    one = lief.parse(list(content)) if content else None
    return [] if one is None else [one]


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


def _library(library: Any) -> Library:
    import lief

    if isinstance(library, lief.ELF.Binary):
        return Library(_platform(library.header.machine_type, "linux"), _newest_glibc(library))
    if isinstance(library, lief.PE.Binary):
        return Library(_platform(library.header.machine, "windows"))
    if isinstance(library, lief.MachO.Binary):
        return Library(_platform(library.header.cpu_type, "darwin"))
    raise KeyError(type(library).__name__)


def _platform(machine: Any, system: str) -> str:
    if machine.name in ("NONE", "UNKNOWN"):
        raise ValueError("a damaged library: no architecture in its header")
    return f"{MACHINES.get(machine.name, machine.name)}-{system}"


def _newest_glibc(library: Any) -> tuple[int, ...]:
    """Newest version of the GNU C library that an ELF needs."""
    needed = library.symbols_version_requirement
    names = (symbol.name for one in needed for symbol in one.get_auxiliary_symbols())
    found = [re.fullmatch(r"GLIBC_([\d.]+)", name) for name in names if isinstance(name, str)]
    return max((tuple(map(int, match[1].split("."))) for match in found if match), default=())


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
