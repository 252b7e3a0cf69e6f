"""Contact elements and rotors as Functional Mock-up Units: FMI 2.0 and 3.0, co-simulation and model exchange.

==============  ====================================================================================
module          responsibility
==============  ====================================================================================
``spec``        `ModelSpec`, the only place where a variable's name, reference, unit and start are said
``contacts``    `contact_spec`: what all contact elements have in common
``spring``      variables and C text of the elements without memory
``film``        those of the elements with a film memory
``c_headers``   `ModelSpec` to the generated C headers
``glue``        C files of an FMI version, whatever the model
``texts``       `ModelSpec` to ``modelDescription.xml`` of FMI 2.0 and ``documentation/index.html``
``texts3``      `ModelSpec` to ``modelDescription.xml`` and ``terminalsAndIcons.xml`` of FMI 3.0
``icon``        the picture of an FMU
``binaries``    for which platforms, by which compiler, and what came out
``build``       C sources, reproducible zip
``export``      `export_contact`: element in, FMU file out
``gate``        nothing unverified is written
``verify``      `verify`: the FMU against fmpy's rules and, state by state, against the Python element
``comparison``  forces, tangents and derivatives of both, side by side
``references``  reference results inside an FMU, and `verify_references`: the FMU against them alone
``driver``      an instance of an FMU, by hand, through fmpy
``rotor/``      a Jeffcott rotor, alone or closed with its contacts
``system/``     `export_system`: a rotor and its contacts as one system archive (SSP)
``csrc/``       the C sources: common core, glue of each FMI version, models; equations in its README
==============  ====================================================================================

The import name ``fmu`` is also that of the geoscience distribution fmu-tools (a namespace package there):
the two cannot be installed into one environment.
"""

from inspect import ismodule as _ismodule

from fmu.binaries import BuildError as BuildError
from fmu.export import export_contact as export_contact
from fmu.gate import VerificationError as VerificationError
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


def __dir__() -> list[str]:
    """Public names, without the rooms that they are in."""
    return sorted(name for name, value in globals().items() if name[0] != "_" and not _ismodule(value))
