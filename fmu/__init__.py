"""Contact elements, ball bearings and rotors as Functional Mock-up Units, FMI 2.0 and 3.0.

=======================  ===========================================================================
module                   responsibility
=======================  ===========================================================================
``spec``                 `ModelSpec`: name, value reference, unit and start value of every variable; `VariableList`
``contact_variables``    variables that the FMUs of all contact elements have
``contact_spec``         `contact_spec`: specification of the FMU of a contact element, with or without film memory
``lead``                 `Lead`: the parameter `lead` of contacts, `force_lead` of rotors
``steps``                default communication step of a contact; advice on longer ones
``models``               kinds of models and their keywords; `FmuModel`: specification and references
``export``               `export`: model, files, verification, FMU file
``archive``              files of an FMU, and the zip archive of them
``model_description``    `ModelSpec` to ``modelDescription.xml`` and the other XML of FMI 2.0 and 3.0
``description_rules``    rules of FMI for that file, as fmpy has them
``c_headers``            `ModelSpec` to the generated C headers
``sources``              C files of an FMU
``documentation``        `ModelSpec` to ``documentation/index.html``
``references/``          reference results inside an FMU; `verify_references`
``fmu_file``             an FMU file, unpacked, and instances of it
``isolated``             work with an FMU's library in a child process, with limits
``driver``               one instance of an FMU, driven through fmpy
``verification``         `Verification`: result of a comparison
``verify``               `verify`: an FMU against fmpy's rules and the Python element, also before it is written
``bearing/``             FMU of a ball bearing whose inner ring is moved from outside
``rotor/``               FMU of a rotor, its supports inside or outside
``system/``              `export_system`: system archives (SSP) of a rotor and its supports
``csrc/``                C sources: core, interface of each FMI version, models; equations in its README
=======================  ===========================================================================

The import name ``fmu`` is also that of the geoscience distribution fmu-tools (a namespace package there):
the two cannot be installed into one environment.
"""

from inspect import ismodule as _ismodule

from ehlcontact.binaries import BuildError as BuildError
from fmu.export import export as export
from fmu.references.check import verify_references as verify_references
from fmu.system.export import export_system as export_system
from fmu.verify import VerificationError as VerificationError
from fmu.verify import verify as verify


def __dir__() -> list[str]:
    """Public names."""
    return sorted(name for name, value in globals().items() if name[0] != "_" and not _ismodule(value))
