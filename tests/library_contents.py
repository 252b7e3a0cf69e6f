"""What the headers of a shared library say beside what the export reads there, by LIEF."""

from typing import NamedTuple

import lief

from ehlcontact.binaries.headers import parse


class Contents(NamedTuple):
    """Functions that can be called from outside, libraries that are loaded, the name that it is linked by.

    `minimum` is the oldest macOS that it runs on, and `signed` whether it has the signature of that system.
    """

    exports: set
    needs: list
    name: str
    minimum: tuple = ()
    signed: bool = False


def contents(file):
    """Contents of the one library in a file."""
    (library,) = parse(file)
    if isinstance(library, lief.PE.Binary):
        table = library.get_export()
        return Contents({entry.name for entry in table.entries}, list(library.libraries), table.name)
    exports = {symbol.name for symbol in library.exported_symbols}
    if isinstance(library, lief.ELF.Binary):
        soname = library.get(lief.ELF.DynamicEntry.TAG.SONAME)
        return Contents(exports, list(library.libraries), "" if soname is None else soname.name)
    own = lief.MachO.LoadCommand.TYPE.ID_DYLIB
    (name,) = (command.name for command in library.libraries if command.command == own)
    needs = [command.name for command in library.libraries if command.command != own]
    oldest = library.build_version.minos if library.has_build_version else library.version_min.version
    exports = {symbol.removeprefix("_") for symbol in exports}
    return Contents(exports, needs, name, tuple(oldest[:2]), library.has_code_signature)
