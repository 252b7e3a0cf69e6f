"""Headers of a 64-bit ELF library, the format of Linux (System V ABI, chapters 4 and 5; LSB for the versions)."""

from __future__ import annotations

import struct
from typing import NamedTuple

from fmu.binaries.headers import Library, text_at

MAGICS = (b"\x7fELF",)
MACHINES = {62: "x86_64", 183: "aarch64"}
DYNAMIC, SYMBOLS, VERSIONS = 6, 11, 0x6FFFFFFE  # types of sections
NEEDED, SONAME = 1, 14  # tags of a dynamic section
GLIBC = "GLIBC_"


class _Section(NamedTuple):
    """A row of the section header table, as far as it is of use."""

    kind: int
    offset: int
    size: int
    link: int
    info: int


def read(content: bytes) -> tuple[Library, ...]:
    """The one library of an ELF file."""
    if content[4:6] != b"\x02\x01":
        raise ValueError("an ELF library, but not of 64 bits, little end first")
    (machine,) = struct.unpack_from("<H", content, 18)
    (table,) = struct.unpack_from("<Q", content, 40)
    size, count = struct.unpack_from("<HH", content, 58)
    sections = [_section(content, table + k * size) for k in range(count)]
    needs, soname = _dynamic(content, sections)
    library = Library(
        platform=f"{MACHINES.get(machine, f'machine {machine}')}-linux",
        exports=_exports(content, sections),
        needs=needs,
        glibc=max(_versions(content, sections), default=()),
        name=soname,
    )
    return (library,)


def _section(content: bytes, at: int) -> _Section:
    _, kind, _, _, offset, size, link, info = struct.unpack_from("<IIQQQQII", content, at)
    return _Section(kind, offset, size, link, info)


def _texts(sections: list[_Section], kind: int) -> list[tuple[_Section, int]]:
    """Sections of a type, with the offset of the texts that each refers to."""
    return [(one, sections[one.link].offset) for one in sections if one.kind == kind]


def _exports(content: bytes, sections: list[_Section]) -> frozenset[str]:
    """Symbols that are defined here, and bound globally or weakly."""
    found = set()
    for section, texts in _texts(sections, SYMBOLS):
        for at in range(section.offset, section.offset + section.size, 24):
            name, info, _, index = struct.unpack_from("<IBBH", content, at)
            if index != 0 and info >> 4 in (1, 2):
                found.add(text_at(content, texts + name))
    return frozenset(found)


def _dynamic(content: bytes, sections: list[_Section]) -> tuple[tuple[str, ...], str]:
    needs, soname = [], ""
    for section, texts in _texts(sections, DYNAMIC):
        for at in range(section.offset, section.offset + section.size, 16):
            tag, value = struct.unpack_from("<QQ", content, at)
            if tag == NEEDED:
                needs.append(text_at(content, texts + value))
            elif tag == SONAME:
                soname = text_at(content, texts + value)
    return tuple(needs), soname


def _versions(content: bytes, sections: list[_Section]) -> list[tuple[int, ...]]:
    """Versions of glibc that symbols ask for: files, each with a list of versions."""
    found = []
    for section, texts in _texts(sections, VERSIONS):
        file = section.offset
        for _ in range(section.info):
            _, count, _, first, after = struct.unpack_from("<HHIII", content, file)
            at = file + first
            for _ in range(count):
                _, _, _, name, following = struct.unpack_from("<IHHII", content, at)
                version = text_at(content, texts + name)
                if version.startswith(GLIBC):
                    found.append(tuple(int(part) for part in version[len(GLIBC) :].split(".") if part.isdigit()))
                at += following
                if following == 0:
                    break
            file += after
            if after == 0:
                break
    return found
