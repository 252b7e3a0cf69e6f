"""Platforms of FMU binaries: names in FMI 2, FMI 3 and for the compiler."""

from __future__ import annotations

import platform
import sys
from collections.abc import Iterable
from dataclasses import dataclass

from ehlcontact.errors import InputError

ALL = "all"
# Architectures as Python's `platform.machine` may spell them.
ARCHITECTURES = {"x86_64": "x86_64", "amd64": "x86_64", "aarch64": "aarch64", "arm64": "aarch64"}
# For all: no symbol is seen from outside that is not marked, and no rounding depends on the machine. No vectors:
# loops are short, and a vector waits for numbers that were just written one by one.
COMMON = (
    "-std=c99", "-O3", "-fno-tree-vectorize", "-fvisibility=hidden", "-shared", "-s",
    # No code reads errno or floating-point exceptions: roots and choices of the same value cost less without.
    "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math",
)  # fmt: skip
# Functions that nothing calls are left out; linkers of macOS do not know these flags.
WITHOUT_UNUSED = ("-ffunction-sections", "-fdata-sections", "-Wl,--gc-sections")
# A missing function is an error when linking, not in an importer.
# Nothing is thrown through C: tables for unwinding its stack are left out where the C library does without.
NO_UNWINDING = ("-fno-asynchronous-unwind-tables", "-fno-unwind-tables")
LINUX = ("-fPIC", "-Wl,-z,defs", *WITHOUT_UNUSED, *NO_UNWINDING)


@dataclass(frozen=True, slots=True)
class Platform:
    """One platform.

    Attributes
    ----------
    name : str
        Architecture and system, as the folders of FMI 3 are called.
    fmi2 : str or None
        Folder of FMI 2; None where it has none for this platform.
    target : str
        Name for zig, with the oldest system that the binary runs on.
    suffix : str
        Of the library.
    flags : tuple of str
        Of the compiler, on top of `COMMON`.
    """

    name: str
    fmi2: str | None
    target: str
    suffix: str
    flags: tuple[str, ...] = ()

    @property
    def system(self) -> str:
        """``linux``, ``windows`` or ``darwin``."""
        return self.name.split("-")[1]

    def folder(self, fmi: int) -> str | None:
        """Folder below ``binaries/`` in that version of FMI; None where there is none."""
        return self.fmi2 if fmi == 2 else self.name

    def all_flags(self, identifier: str) -> tuple[str, ...]:
        """Flags for the library of a model of that name."""
        # A Mach-O library has the place it is meant for inside, by default the path it was built at.
        named = ("-Wl,-install_name,@rpath/" + identifier + self.suffix,) if self.system == "darwin" else ()
        return (*COMMON, *self.flags, *named)


# glibc 2.17: RHEL 7, 2014. macOS 10.13: 2017; 11 is the first on arm64. zig writes its own system's without.
PLATFORMS = {
    one.name: one
    for one in (
        Platform("x86_64-linux", "linux64", "x86_64-linux-gnu.2.17", ".so", LINUX),
        Platform("aarch64-linux", None, "aarch64-linux-gnu.2.17", ".so", LINUX),
        Platform("x86_64-windows", "win64", "x86_64-windows-gnu", ".dll", WITHOUT_UNUSED),
        Platform("x86_64-darwin", "darwin64", "x86_64-macos.10.13", ".dylib", NO_UNWINDING),
        Platform("aarch64-darwin", "darwin64", "aarch64-macos.11.0", ".dylib", NO_UNWINDING),
    )
}

# WebAssembly of a page: it imports nothing, and functions that are visible can be called.
WEB = Platform("wasm32-web", None, "wasm32-wasi", ".wasm")
WEB_FLAGS = (
    "-std=c99", "-O2", "-fvisibility=hidden", "-s", "-mexec-model=reactor", "-Wl,--export-dynamic",
    "-Wl,--gc-sections", "-ffunction-sections", "-fdata-sections",
    "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math",
)  # fmt: skip


def this_machine() -> Platform | None:
    """Platform of this process; None if FMUs are not built for it."""
    architecture = ARCHITECTURES.get(platform.machine().lower())
    name = f"{architecture}-{platform.system().lower()}"
    return PLATFORMS.get(name) if sys.maxsize > 2**32 else None


def choose(names: str | Iterable[str] | None, fmi: int) -> tuple[Platform, ...]:
    """Platforms of these names.

    Parameters
    ----------
    names : str or iterable of str, optional
        Names of FMI 3 (``x86_64-linux``) or FMI 2 (``linux64``; ``darwin64`` is both Macs), or ``all`` there are
        in this version of FMI; this machine's by default.
    fmi : int
        Version of FMI; FMI 2 has no folder for Linux on aarch64.

    Raises
    ------
    InputError
        Another name, none at all, or a platform that this version of FMI has no folder for.
    """
    if names is None:
        return (_own(fmi),)
    if not isinstance(names, Iterable):
        raise InputError("platforms", names, f"{', '.join(_known(fmi))} or {ALL}")
    asked = [names] if isinstance(names, str) else list(names)
    wanted: set[str] = set()
    for name in asked:
        found = _named(name, fmi)
        if not found:
            raise InputError("platforms", name, f"{', '.join(_known(fmi))} or {ALL}")
        for one in found:
            if one.folder(fmi) is None:
                raise InputError("platforms", name, f"{', '.join(_known(fmi))} or {ALL}: {_no_folder(fmi)}")
            wanted.add(one.name)
    if not wanted:
        raise InputError("platforms", asked, f"one or more of {', '.join(_known(fmi))}")
    return tuple(one for name, one in PLATFORMS.items() if name in wanted)


def _own(fmi: int) -> Platform:
    own = this_machine()
    others = f"given: {', '.join(_known(fmi))}"
    if own is None:
        machine = f"{platform.system()} {platform.machine()}"
        raise InputError("platforms", None, f"{others}; FMUs are not built for this machine, {machine}")
    if own.folder(fmi) is None:
        raise InputError("platforms", None, f"{others}; this machine is {own.name}, and {_no_folder(fmi)}")
    return own


def _named(name: object, fmi: int) -> list[Platform]:
    if name == ALL:
        return [one for one in PLATFORMS.values() if one.folder(fmi) is not None]
    return [one for one in PLATFORMS.values() if isinstance(name, str) and name in (one.name, one.fmi2)]


def _known(fmi: int) -> list[str]:
    return [one.name for one in PLATFORMS.values() if one.folder(fmi) is not None]


def _no_folder(fmi: int) -> str:
    return f"FMI {fmi} has no folder for it, FMI 3 has"
