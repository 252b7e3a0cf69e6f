"""Reference inputs and results inside an FMU, and verification of the FMU against them.

======================  =======================================================================
module                  responsibility
======================  =======================================================================
``series``              `References`: inputs and results, row by row, for each FMI interface; differences from them
``contact_references``  those of a contact element, computed by the element in Python
``files``               files in ``extra/org.fmi-standard.fmi-ls-ref/`` of an FMU
``check``               `verify_references`: an FMU against the references inside it
======================  =======================================================================

The files are those that the FMI cross-check has (``x_in.csv``, ``x_ref.csv``, ``x_ref.opt``), in the folder and
with the manifest of the layered standard FMI-LS-REF 1.0.0-beta.1 (https://github.com/modelica/fmi-ls-ref),
described as experiments (https://github.com/modelica/ma-hs-experiments).
"""

from inspect import ismodule as _ismodule

from fmu.references.check import ReferenceCheck as ReferenceCheck
from fmu.references.check import verify_references as verify_references


def __dir__() -> list[str]:
    """Public names."""
    return sorted(name for name, value in globals().items() if name[0] != "_" and not _ismodule(value))
