"""Shared libraries of C sources: platforms, compilers, cache of compiled files, checks of the result.

============== ================================================================================================
room           responsibility
============== ================================================================================================
``platforms``  `Platform`: names, folder in the FMU, compiler target and flags; choice of platforms by name
``compiler``   compilers of each platform: the system's, or zig
``process``    running a compiler, with a time limit
``cache``      compiled libraries on disk, by sources, flags and compiler; safe with several processes
``libraries``  `build_binaries`: one library per platform, checked; `build_library`: for this machine alone;
               `build_module`: WebAssembly for a page
``headers``    `read_library`: headers of an ELF, PE or Mach-O file; universal Mach-O files
============== ================================================================================================
"""

from inspect import ismodule as _ismodule

from ehlcontact.binaries.headers import Library as Library
from ehlcontact.binaries.headers import read_library as read_library
from ehlcontact.binaries.libraries import build_binaries as build_binaries
from ehlcontact.binaries.libraries import build_library as build_library
from ehlcontact.binaries.libraries import build_module as build_module
from ehlcontact.binaries.platforms import PLATFORMS as PLATFORMS
from ehlcontact.binaries.platforms import Platform as Platform
from ehlcontact.binaries.platforms import choose as choose
from ehlcontact.binaries.platforms import this_machine as this_machine
from ehlcontact.binaries.process import BuildError as BuildError


def __dir__() -> list[str]:
    """Public names."""
    return sorted(name for name, value in globals().items() if name[0] != "_" and not _ismodule(value))
