"""Files that are never half written, texts of any origin, and any dataclass in an HDF5 file.

=============== ===============================================================================================
room            responsibility
=============== ===============================================================================================
``replacement`` a new file takes the old one's place in one move; texts and JSON of any origin are read or told
``hdf5``        any dataclass as an HDF5 file and back
=============== ===============================================================================================
"""

from ehlcontact.files.replacement import (
    is_file,
    parse_json,
    read_text,
    remove_leftovers,
    replacing,
    write_bytes,
    write_text,
)

__all__ = ["is_file", "parse_json", "read_text", "remove_leftovers", "replacing", "write_bytes", "write_text"]


def __dir__() -> list[str]:
    """Public names, without the rooms that they are in."""
    return sorted(__all__)
