"""Files that are never half written, and any dataclass in an HDF5 file.

=============== ===================================================================
room            responsibility
=============== ===================================================================
``replacement`` a new file takes the old one's place in one move
``hdf5``        any dataclass as an HDF5 file and back
=============== ===================================================================
"""

from ehlcontact.files.replacement import replacing, write_bytes, write_text

__all__ = ["replacing", "write_bytes", "write_text"]
