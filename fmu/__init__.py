"""Contact elements, ball bearings, Jeffcott rotors and shafts as Functional Mock-up Units, FMI 2.0 and 3.0.

=======================  ===========================================================================
module                   responsibility
=======================  ===========================================================================
``spec``                 `ModelSpec`: name, value reference, unit and start value of every variable; `VariableList`
``contact_variables``    variables that the FMUs of all contact elements have
``contact_spec``         `contact_spec`: specification of the FMU of a contact element, with or without film memory
``lead``                 `Lead`: the parameter `lead` of contacts, `force_lead` of rotors
``steps``                default communication step of a contact; advice on longer ones
``fmu_model``            `FmuModel`: specification, references and comparison of an element or rotor
``export``               `export_contact`: element to model, files, verification, FMU file
``archive``              files of an FMU, and the zip archive of them
``model_description``    `ModelSpec` to ``modelDescription.xml`` and the other XML of FMI 2.0 and 3.0
``description_rules``    rules of FMI for that file, as fmpy has them
``c_headers``            `ModelSpec` to the generated C headers
``sources``              C files of an FMU
``documentation``        `ModelSpec` to ``documentation/index.html``
``binaries/``            shared libraries for every platform
``references/``          reference results inside an FMU; `verify_references`
``fmu_file``             an FMU file, unpacked, and instances of it
``isolated``             work with an FMU's library in a child process, with limits
``driver``               one instance of an FMU, driven through fmpy
``comparison``           FMU and Python element: forces, tangents and derivatives
``verification``         `Verification`: result of a comparison
``verify``               `verify`: an FMU against fmpy's rules and the Python element, also before it is written
``bearing/``             FMU of a ball bearing whose inner ring is moved from outside
``jeffcott/``            FMU of a Jeffcott rotor, alone or with its contacts
``rotor/``               FMU of a rotor with its ball bearings inside
``shaft/``               FMU of a shaft whose bearings are outside, with the torque of its motor
``controller/``          FMU of a speed controller: torque of that motor
``system/``              `export_system`, `export_drive`: system archives (SSP) of a rotor, of a drive
``csrc/``                C sources: core, interface of each FMI version, models; equations in its README
=======================  ===========================================================================

The import name ``fmu`` is also that of the geoscience distribution fmu-tools (a namespace package there):
the two cannot be installed into one environment.
"""

from inspect import ismodule as _ismodule

from fmu.bearing.export import export_bearing as export_bearing
from fmu.binaries import BuildError as BuildError
from fmu.controller.export import export_controller as export_controller
from fmu.controller.model import SpeedController as SpeedController
from fmu.export import export_contact as export_contact
from fmu.jeffcott.export import export_jeffcott as export_jeffcott
from fmu.references.check import verify_references as verify_references
from fmu.rotor.export import export_rotor as export_rotor
from fmu.shaft.export import export_shaft as export_shaft
from fmu.system.drive import export_drive as export_drive
from fmu.system.export import export_system as export_system
from fmu.verify import VerificationError as VerificationError
from fmu.verify import verify as verify


def __dir__() -> list[str]:
    """Public names."""
    return sorted(name for name, value in globals().items() if name[0] != "_" and not _ismodule(value))
