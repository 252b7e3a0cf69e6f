"""Contact elements and rotors as Functional Mock-up Units: FMI 2.0 and 3.0, co-simulation and model exchange.

=====================  =============================================================================
module                 responsibility
=====================  =============================================================================
``spec``               `ModelSpec`: name, value reference, unit and start value of every variable
``contact_variables``  variables that the FMUs of all contact elements have
``spring``             variables and C text of the elements without film memory
``film``               variables, C text and tables of the elements with a film memory
``contacts``           `contact_spec`: specification of the FMU of a contact element; advice on steps
``c_headers``          `ModelSpec` to the generated C headers
``sources``            C files of an FMU, and its zip archive
``model_description``  `ModelSpec` to ``modelDescription.xml`` of FMI 2.0 and 3.0, and FMI 3.0's other XML
``documentation``      `ModelSpec` to ``documentation/index.html``
``icon``               icon of an FMU
``binaries/``          shared libraries for every platform
``export``             `export_contact`: element to FMU file
``verify``             `verify`: an FMU against fmpy's rules and the Python element, state by state
``verify_before_write``  verification of an FMU before it is written
``comparison``         forces, tangents and derivatives of FMU and Python element
``references/``        reference results inside an FMU; `verify_references`
``driver``             one instance of an FMU, driven through fmpy
``rotor/``             FMU of a Jeffcott rotor, alone or with its contacts
``system/``            `export_system`: a rotor and its contacts as a system archive (SSP)
``csrc/``              C sources: core, interface of each FMI version, models; equations in its README
=====================  =============================================================================

The import name ``fmu`` is also that of the geoscience distribution fmu-tools (a namespace package there):
the two cannot be installed into one environment.
"""

from inspect import ismodule as _ismodule

from fmu.binaries import BuildError as BuildError
from fmu.export import export_contact as export_contact
from fmu.references.check import ReferenceCheck as ReferenceCheck
from fmu.references.check import verify_references as verify_references
from fmu.references.files import reference_files as reference_files
from fmu.references.series import References as References
from fmu.references.series import Trial as Trial
from fmu.rotor.export import export_rotor as export_rotor
from fmu.rotor.model import RotorModel as RotorModel
from fmu.system.export import export_system as export_system
from fmu.verify import Verification as Verification
from fmu.verify import verify as verify
from fmu.verify_before_write import VerificationError as VerificationError


def __dir__() -> list[str]:
    """Public names."""
    return sorted(name for name, value in globals().items() if name[0] != "_" and not _ismodule(value))
