"""The binaries of an FMU: for which platforms, by which compiler, and what came out.

============== ================================================================================================
room           responsibility
============== ================================================================================================
``platforms``  `Platform`: names, folders in the FMU, target and flags of each; which of them are asked for
``compiler``   which compiler makes this machine's binary, and which the others
``process``    a compiler is run, and ended where it hangs
``cache``      what was compiled before, by its sources, flags and compiler; safe with several processes
``libraries``  sources in, a library for each platform out, as it should be
``headers``    `read_library`: headers of an ELF, PE or Mach-O file; universal Mach-O files
``recipe``     ``sources/buildDescription.xml`` of FMI 3, how to compile what is there
============== ================================================================================================
"""

from inspect import ismodule as _ismodule

from fmu.binaries.headers import Library as Library
from fmu.binaries.headers import read_library as read_library
from fmu.binaries.libraries import build_binaries as build_binaries
from fmu.binaries.platforms import PLATFORMS as PLATFORMS
from fmu.binaries.platforms import Platform as Platform
from fmu.binaries.platforms import choose as choose
from fmu.binaries.platforms import this_machine as this_machine
from fmu.binaries.process import BuildError as BuildError
from fmu.binaries.recipe import build_description as build_description


def __dir__() -> list[str]:
    """Public names, without the rooms that they are in."""
    return sorted(name for name, value in globals().items() if name[0] != "_" and not _ismodule(value))
