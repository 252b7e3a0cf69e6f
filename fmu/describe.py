"""`ModelSpec` to ``modelDescription.xml`` of FMI 2.0."""

from __future__ import annotations

from xml.etree import ElementTree

from ehlcontact import __version__
from fmu.spec import UNITS, ModelSpec, Variable

LOG_CATEGORIES = {
    "logStatusError": "Calls that failed, always logged",
    "logStatusDiscard": "Values that do not exist for the present inputs",
    "logStatusWarning": "Approach leaving the validity interval",
}


def model_description(spec: ModelSpec, guid: str) -> bytes:
    """Return the XML text, which depends on nothing but its arguments and the library's version."""
    root = ElementTree.Element(
        "fmiModelDescription",
        fmiVersion="2.0",
        modelName=spec.name,
        guid=guid,
        description=spec.description,
        author="ehlcontact",
        version=__version__,
        copyright="Copyright (c) 2026, the ehlcontact developers",
        license="BSD-3-Clause",
        generationTool=f"ehlcontact {__version__}",
        variableNamingConvention="structured",
        numberOfEventIndicators="0",
    )
    _co_simulation(root, spec)
    _units(root, spec)
    categories = ElementTree.SubElement(root, "LogCategories")
    for name, text in LOG_CATEGORIES.items():
        ElementTree.SubElement(categories, "Category", name=name, description=text)
    ElementTree.SubElement(root, "DefaultExperiment", startTime="0.0", stopTime="1.0", stepSize="0.001")
    variables = ElementTree.SubElement(root, "ModelVariables")
    for variable in spec.variables:
        _variable(variables, variable)
    _structure(root, spec)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)


def _co_simulation(root: ElementTree.Element, spec: ModelSpec) -> None:
    slave = ElementTree.SubElement(
        root,
        "CoSimulation",
        modelIdentifier=spec.identifier,
        canHandleVariableCommunicationStepSize="true",
        canGetAndSetFMUstate="true",
        canSerializeFMUstate="true",
        providesDirectionalDerivative="true",
    )
    files = ElementTree.SubElement(slave, "SourceFiles")
    for name in spec.sources:
        ElementTree.SubElement(files, "File", name=name)


def _units(root: ElementTree.Element, spec: ModelSpec) -> None:
    used = {variable.unit for variable in spec.variables}
    definitions = ElementTree.SubElement(root, "UnitDefinitions")
    for name, exponents in UNITS.items():
        if name in used:
            unit = ElementTree.SubElement(definitions, "Unit", name=name)
            ElementTree.SubElement(unit, "BaseUnit", {base: str(power) for base, power in exponents.items()})


def _variable(parent: ElementTree.Element, variable: Variable) -> None:
    scalar = ElementTree.SubElement(
        parent,
        "ScalarVariable",
        name=variable.name,
        valueReference=str(variable.value_reference),
        causality=variable.causality,
        variability=variable.variability,
        initial="calculated" if variable.start is None else "exact",
        description=variable.description,
    )
    if variable.causality == "input":
        del scalar.attrib["initial"]  # FMI 2.0 forbids it there
    value = ElementTree.SubElement(scalar, variable.type)
    if variable.unit is not None:
        value.set("unit", variable.unit)
    if variable.minimum is not None:
        value.set("min", repr(variable.minimum))
    if variable.start is not None:
        value.set("start", repr(variable.start))


def _structure(root: ElementTree.Element, spec: ModelSpec) -> None:
    structure = ElementTree.SubElement(root, "ModelStructure")
    inputs = {variable.name for variable in spec.inputs}
    # While stepping only the inputs are knowns; at initialization the parameters are as well.
    for section, all_knowns in (("Outputs", False), ("InitialUnknowns", True)):
        unknowns = ElementTree.SubElement(structure, section)
        for output in spec.outputs:
            knowns = sorted(spec.index(name) for name in output.depends if all_knowns or name in inputs)
            ElementTree.SubElement(
                unknowns,
                "Unknown",
                index=str(spec.index(output.name)),
                dependencies=" ".join(map(str, knowns)),
                dependenciesKind=" ".join(["dependent"] * len(knowns)),
            )
