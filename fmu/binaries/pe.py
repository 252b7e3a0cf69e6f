"""Headers of a 64-bit PE library, the format of Windows (Microsoft, PE format specification)."""

from __future__ import annotations

import struct
from typing import NamedTuple

from fmu.binaries.headers import Library, text_at

MAGICS = (b"MZ",)
MACHINES = {0x8664: "x86_64", 0xAA64: "aarch64"}
PE32_PLUS = 0x20B  # an optional header with 64-bit addresses


class _Section(NamedTuple):
    """Where a section lies in memory and in the file."""

    address: int
    size: int
    offset: int


def read(content: bytes) -> tuple[Library, ...]:
    """The one library of a PE file."""
    (start,) = struct.unpack_from("<I", content, 60)
    if content[start : start + 4] != b"PE\0\0":
        raise ValueError("a program of DOS, not a PE library")
    machine, count = struct.unpack_from("<HH", content, start + 4)
    (size,) = struct.unpack_from("<H", content, start + 20)
    optional = start + 24
    (magic,) = struct.unpack_from("<H", content, optional)
    if magic != PE32_PLUS:
        raise ValueError("a PE library, but not of 64 bits")
    table = [struct.unpack_from("<IIIII", content, optional + size + 40 * k + 8) for k in range(count)]
    sections = [_Section(address, max(virtual, raw), offset) for virtual, address, raw, offset, _ in table]
    exports, _, imports = struct.unpack_from("<III", content, optional + 112)
    name, functions = _exports(content, sections, exports)
    library = Library(
        platform=f"{MACHINES.get(machine, f'machine {machine:#x}')}-windows",
        exports=functions,
        needs=_imports(content, sections, imports),
        name=name,
    )
    return (library,)


def _place(sections: list[_Section], address: int) -> int:
    """Offset in the file of an address in memory."""
    for one in sections:
        if one.address <= address < one.address + one.size:
            return one.offset + address - one.address
    raise IndexError(f"address {address:#x} is in no section")


def _exports(content: bytes, sections: list[_Section], table: int) -> tuple[str, frozenset[str]]:
    if table == 0:
        return "", frozenset()
    at = _place(sections, table)
    (name,) = struct.unpack_from("<I", content, at + 12)
    (count,) = struct.unpack_from("<I", content, at + 24)
    (names,) = struct.unpack_from("<I", content, at + 32)
    first = _place(sections, names) if count else 0
    pointers = struct.unpack_from(f"<{count}I", content, first)
    functions = frozenset(text_at(content, _place(sections, pointer)) for pointer in pointers)
    return text_at(content, _place(sections, name)), functions


def _imports(content: bytes, sections: list[_Section], table: int) -> tuple[str, ...]:
    """Libraries of the import table, which ends with a row of zeros."""
    found: list[str] = []
    at = _place(sections, table) if table else None
    while at is not None:
        (name,) = struct.unpack_from("<I", content, at + 12)
        if name == 0:
            break
        found.append(text_at(content, _place(sections, name)))
        at += 20
    return tuple(found)
