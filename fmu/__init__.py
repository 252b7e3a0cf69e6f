"""Reduced contact elements as Functional Mock-up Units: FMI 2.0 and 3.0, co-simulation and model exchange.

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
``binaries``    for which platforms, by which compiler, and what came out
``build``       C sources, reproducible zip
``export``      `export_contact`: element in, FMU file out
``gate``        nothing unverified is written
``verify``      `verify`: the FMU against fmpy's rules and, state by state, against the Python element
``comparison``  forces, tangents and derivatives of both, side by side
``references``  reference results inside an FMU, and `verify_references`: the FMU against them alone
``driver``      an instance of an FMU, by hand, through fmpy
``csrc/``       the C sources: common core, glue of each FMI version, models; equations in its README
==============  ====================================================================================

The import name ``fmu`` is also that of the geoscience distribution fmu-tools (a namespace package there):
the two cannot be installed into one environment.
"""

from fmu.binaries import BuildError as BuildError
from fmu.export import export_contact as export_contact
from fmu.gate import VerificationError as VerificationError
from fmu.references.check import ReferenceCheck as ReferenceCheck
from fmu.references.check import verify_references as verify_references
from fmu.verify import Verification as Verification
from fmu.verify import verify as verify
