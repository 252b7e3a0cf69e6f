"""`ModelSpec` to the texts of FMI 3.0: ``modelDescription.xml`` and ``terminalsAndIcons.xml``.

FMI 3.0 wants the time and every event indicator as variables; they come behind those of the specification.
"""

from __future__ import annotations

from xml.etree import ElementTree

from ehlcontact import __version__
from fmu.spec import ModelSpec, Variable
from fmu.texts import LOG_CATEGORIES, default_experiment, used_units, value_attributes

TIME = "time"  # behind the others, and before the event indicators
FLANGE = "Modelica.Mechanics.Translational.Interfaces.Flange_a"
MEMBERS = (("s", "signal"), ("v", "signal"), ("f", "inflow"))  # of a flange: approach, rate, force
_BOTH = {
    "canGetAndSetFMUState": "true",
    "canSerializeFMUState": "true",
    "providesDirectionalDerivatives": "true",
    "providesAdjointDerivatives": "true",
}
_TYPES = {"Real": "Float64", "Boolean": "Boolean", "Enumeration": "Enumeration"}


def model_description_3(spec: ModelSpec, token: str) -> bytes:
    """``modelDescription.xml`` of FMI 3.0."""
    root = ElementTree.Element(
        "fmiModelDescription",
        fmiVersion="3.0",
        modelName=spec.name,
        instantiationToken=token,
        description=spec.description,
        author="ehlcontact",
        version=__version__,
        copyright="Copyright (c) 2026, the ehlcontact developers",
        license="BSD-3-Clause",
        generationTool=f"ehlcontact {__version__}",
        variableNamingConvention="structured",
    )
    ElementTree.SubElement(root, "ModelExchange", _BOTH, modelIdentifier=spec.identifier)
    ElementTree.SubElement(
        root,
        "CoSimulation",
        _BOTH,
        modelIdentifier=spec.identifier,
        canHandleVariableCommunicationStepSize="true",
        maxOutputDerivativeOrder="1",
        providesIntermediateUpdate="true",
        mightReturnEarlyFromDoStep="true",
        hasEventMode="true",
    )
    definitions = ElementTree.SubElement(root, "UnitDefinitions")
    for name, exponents, display in used_units(spec):
        unit = ElementTree.SubElement(definitions, "Unit", name=name)
        ElementTree.SubElement(unit, "BaseUnit", {base: str(power) for base, power in exponents.items()})
        if display is not None:
            ElementTree.SubElement(unit, "DisplayUnit", name=display[0], factor=repr(display[1]))
    types = ElementTree.SubElement(root, "TypeDefinitions")
    for choice in spec.choices:
        kind = ElementTree.SubElement(types, "EnumerationType", name=choice.name)
        for value, (name, text) in enumerate(choice.items, start=1):
            ElementTree.SubElement(kind, "Item", name=name, value=str(value), description=text)
    categories = ElementTree.SubElement(root, "LogCategories")
    for name, text in LOG_CATEGORIES.items():
        ElementTree.SubElement(categories, "Category", name=name, description=text)
    ElementTree.SubElement(root, "DefaultExperiment", default_experiment(spec))
    _variables(root, spec)
    _structure(root, spec)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)


def _variables(root: ElementTree.Element, spec: ModelSpec) -> None:
    text = "Above zero while the surfaces push: force, or a film's power 2/3 of it, before it is clipped"
    parent = ElementTree.SubElement(root, "ModelVariables")
    for variable in spec.variables:
        _variable(parent, variable, spec)
    behind = len(spec.variables)
    ElementTree.SubElement(
        parent,
        "Float64",
        name=TIME,
        valueReference=str(behind),
        causality="independent",
        variability="continuous",
        description="Time" if spec.time_unit == "s" else "Time in 2a/u_sum",
    )
    for k, (name, _) in enumerate(spec.indicators, start=1):
        ElementTree.SubElement(
            parent,
            "Float64",
            name=name,
            valueReference=str(behind + k),
            causality="local",
            variability="continuous",
            initial="calculated",
            description=text,
        )


def _variable(parent: ElementTree.Element, variable: Variable, spec: ModelSpec) -> None:
    entry = ElementTree.SubElement(
        parent,
        _TYPES[variable.type],
        name=variable.name,
        valueReference=str(variable.value_reference),
        causality=variable.causality,
        variability=variable.variability,
        description=variable.description,
    )
    if variable.causality != "input":
        entry.set("initial", "calculated" if variable.start is None else "exact")
    if variable.type == "Enumeration":
        entry.set("declaredType", spec.choices[0].name)
    for name, text in value_attributes(variable).items():
        entry.set(name, text)
    if variable.derivative_of is not None:
        entry.set("derivative", str(spec[variable.derivative_of].value_reference))


def _structure(root: ElementTree.Element, spec: ModelSpec) -> None:
    structure = ElementTree.SubElement(root, "ModelStructure")
    moving = {variable.name for variable in (*spec.inputs, *spec.states)}
    computed = sorted((*spec.outputs, *spec.derivatives), key=lambda variable: variable.value_reference)
    # While running only inputs and states are knowns; at initialization the parameters are as well.
    for section, variables, all_knowns in (
        ("Output", spec.outputs, False),
        ("ContinuousStateDerivative", spec.derivatives, False),
        ("InitialUnknown", tuple(computed), True),
    ):
        for variable in variables:
            named = [name for name in variable.depends if all_knowns or name in moving]
            _unknown(structure, section, variable.value_reference, spec, named)
    for k, (_, like) in enumerate(spec.indicators, start=1):
        named = [name for name in spec[like].depends if name in moving]
        _unknown(structure, "EventIndicator", len(spec.variables) + k, spec, named)


def _unknown(parent: ElementTree.Element, section: str, reference: int, spec: ModelSpec, named: list[str]) -> None:
    knowns = sorted(spec[name].value_reference for name in named)
    ElementTree.SubElement(
        parent,
        section,
        valueReference=str(reference),
        dependencies=" ".join(map(str, knowns)),
        dependenciesKind=" ".join(["dependent"] * len(knowns)),
    )


def terminals(spec: ModelSpec) -> bytes:
    """``terminalsAndIcons.xml``: approach, rate and force of each contact as a mechanical flange."""
    root = ElementTree.Element("fmiTerminalsAndIcons", fmiVersion="3.0")
    parent = ElementTree.SubElement(root, "Terminals")
    for name, text, variables in spec.flanges:
        flange = ElementTree.SubElement(
            parent, "Terminal", name=name, matchingRule="bus", terminalKind=FLANGE, description=text
        )
        for variable, (member, kind) in zip(variables, MEMBERS, strict=True):
            ElementTree.SubElement(
                flange, "TerminalMemberVariable", variableName=variable, memberName=member, variableKind=kind
            )
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)
