"""What the headers of a library say: for which platform it is, what it offers and what it needs."""

from __future__ import annotations

import struct
from dataclasses import dataclass


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
        Newest version of the GNU C library that a symbol asks for, () for none.
    minimum : tuple of int
        Oldest macOS that it runs on, () elsewhere.
    name : str
        Name it is linked by: install name of a Mach-O, soname of an ELF, module of a PE; "" for none.
    signed : bool
        Whether it has a code signature, which macOS wants on arm64.
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
    from fmu.binaries import elf, macho, pe

    for kind in (elf, macho, pe):
        if content.startswith(kind.MAGICS):
            try:
                return kind.read(content)
            except (struct.error, IndexError, UnicodeDecodeError) as error:
                raise ValueError(f"a damaged library ({error})") from None
    raise ValueError("no ELF, PE or Mach-O library")


def text_at(content: bytes, offset: int) -> str:
    """Text from `offset` to the next zero byte."""
    end = content.find(b"\0", offset)
    if offset < 0 or end < 0:
        raise IndexError("a text without an end")
    return content[offset:end].decode("utf-8")
