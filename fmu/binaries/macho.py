"""Headers of 64-bit Mach-O libraries, the format of macOS, and several of them in one file (loader.h, fat.h)."""

from __future__ import annotations

import struct
from collections.abc import Sequence

from fmu.binaries.headers import Library, text_at

THIN, UNIVERSAL = b"\xcf\xfa\xed\xfe", b"\xca\xfe\xba\xbe"
MAGICS = (THIN, UNIVERSAL)
MACHINES = {0x01000007: "x86_64", 0x0100000C: "aarch64"}
# Load commands.
SYMBOLS, NEEDED, OWN_NAME, SIGNATURE, OLD_MINIMUM, BUILD = 0x2, 0xC, 0xD, 0x1D, 0x24, 0x32
MACOS = 1  # a platform of BUILD
EXTERNAL, DEFINED, DEBUGGING = 0x01, 0x0E, 0xE0  # bits of a symbol's type
ALIGNMENT = 14  # power of two, of each library in a universal file: pages of arm64


def read(content: bytes) -> tuple[Library, ...]:
    """The libraries of a Mach-O file."""
    if not content.startswith(UNIVERSAL):
        return (_thin(content),)
    (count,) = struct.unpack_from(">I", content, 4)
    rows = [struct.unpack_from(">IIIII", content, 8 + 20 * k) for k in range(count)]
    return tuple(_thin(content[offset : offset + size]) for _, _, offset, size, _ in rows)


def universal(libraries: Sequence[bytes]) -> bytes:
    """One file with libraries of several architectures; the system takes the one that fits."""
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


def _thin(content: bytes) -> Library:
    if not content.startswith(THIN):
        raise ValueError("a Mach-O library, but not of 64 bits")
    (cpu,) = struct.unpack_from("<I", content, 4)
    (count,) = struct.unpack_from("<I", content, 16)
    needs: list[str] = []
    minimum: tuple[int, ...] = ()
    name, signed, exports = "", False, frozenset[str]()
    at = 32
    for _ in range(count):
        command, size = struct.unpack_from("<II", content, at)
        if size < 8:
            raise ValueError("a damaged library (a load command without length)")
        kind = command & 0x7FFFFFFF  # the top bit only says that it must be understood
        if kind in (NEEDED, OWN_NAME):
            (text,) = struct.unpack_from("<I", content, at + 8)
            library = text_at(content, at + text)
            name, needs = (library, needs) if kind == OWN_NAME else (name, [*needs, library])
        elif kind == BUILD:
            platform, packed = struct.unpack_from("<II", content, at + 8)
            minimum = _version(packed) if platform == MACOS else minimum
        elif kind == OLD_MINIMUM:
            (packed,) = struct.unpack_from("<I", content, at + 8)
            minimum = _version(packed)
        elif kind == SYMBOLS:
            exports = _exports(content, *struct.unpack_from("<III", content, at + 8))
        signed = signed or kind == SIGNATURE
        at += size
    platform_name = f"{MACHINES.get(cpu, f'machine {cpu:#x}')}-darwin"
    return Library(platform_name, exports, tuple(needs), minimum=minimum, name=name, signed=signed)


def _version(packed: int) -> tuple[int, ...]:
    return (packed >> 16, packed >> 8 & 0xFF)


def _exports(content: bytes, offset: int, count: int, texts: int) -> frozenset[str]:
    """Symbols that are external and defined here, without the underscore that C gets there."""
    found = set()
    for at in range(offset, offset + 16 * count, 16):
        name, kind = struct.unpack_from("<IB", content, at)
        if kind & EXTERNAL and kind & DEFINED and not kind & DEBUGGING:
            found.add(text_at(content, texts + name).removeprefix("_"))
    return frozenset(found)
