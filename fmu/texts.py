"""`ModelSpec` to the texts of an FMU: ``modelDescription.xml`` of FMI 2.0 and ``documentation/index.html``.

They depend on nothing but their arguments and the library's version.
"""

from __future__ import annotations

from html import escape
from xml.etree import ElementTree

from ehlcontact import __version__
from fmu.sources import compiled
from fmu.spec import DISPLAY_UNITS, UNITS, ModelSpec, Variable

DEFAULT_STEPS = 1000  # of the default experiment
LOG_CATEGORIES = {
    "logStatusError": "Calls that failed, always logged",
    "logStatusDiscard": "Values that do not exist for the present inputs",
    "logStatusWarning": "Motion leaving the validity box",
}
_PAGE = """<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><title>{title}</title>
<style>body {{ font-family: sans-serif; max-width: 60em; margin: 2em auto; line-height: 1.4 }}
table {{ border-collapse: collapse }}
td, th {{ text-align: left; padding: 0.2em 0.8em; border-bottom: 1px solid #ccc }}
pre {{ background: #f4f4f4; padding: 1em; overflow-x: auto }}</style></head>
<body>
<h1>{title}</h1>
<p>{description}.</p>
<table>{notes}</table>
<h2>Variables</h2>
<table>
<tr><th>name</th><th>causality</th><th>unit</th><th>start</th><th>description</th></tr>
{variables}
</table>{references}
<h2>Sources</h2>
<pre>{readme}</pre>
<h2>Build</h2>
<p>Exported by ehlcontact {version} as FMI {fmi}.0 for co-simulation and model exchange; the binary needs
nothing but the C library. It was compiled with <code>{compiler}</code>. To build it for another platform,
compile the files in
<code>sources/</code> and link the maths library.</p>
</body>
</html>
"""
_REFERENCES = """
<h2>Reference results</h2>
<p>In <code>extra/org.fmi-standard.fmi-ls-ref/</code>, for any importer. {about}. Its steps go from each row of the
tables to the next, with the parameters that are given there; the rows for model exchange stand by themselves.
<code>ehlcontact verify</code> compares this FMU with them.</p>"""


def model_description(spec: ModelSpec, guid: str) -> bytes:
    """``modelDescription.xml`` of FMI 2.0."""
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
        numberOfEventIndicators=str(len(spec.indicators)),
    )
    _interfaces(root, spec)
    _units(root, spec)
    _choices(root, spec)
    categories = ElementTree.SubElement(root, "LogCategories")
    for name, text in LOG_CATEGORIES.items():
        ElementTree.SubElement(categories, "Category", name=name, description=text)
    ElementTree.SubElement(root, "DefaultExperiment", default_experiment(spec))
    variables = ElementTree.SubElement(root, "ModelVariables")
    for variable in spec.variables:
        _variable(variables, variable, spec)
    _structure(root, spec)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)


def default_experiment(spec: ModelSpec) -> dict[str, str]:
    """Start, stop and step that resolve the contact."""
    stop = float(f"{DEFAULT_STEPS * spec.step:.6g}")
    numbers = {"startTime": 0.0, "stopTime": stop, "tolerance": spec.tolerance, "stepSize": spec.step}
    return {name: repr(value) for name, value in numbers.items()}


def _interfaces(root: ElementTree.Element, spec: ModelSpec) -> None:
    both = {
        "modelIdentifier": spec.identifier,
        "canGetAndSetFMUstate": "true",
        "canSerializeFMUstate": "true",
        "providesDirectionalDerivative": "true",
    }
    exchange = ElementTree.SubElement(root, "ModelExchange", both, completedIntegratorStepNotNeeded="true")
    simulation = ElementTree.SubElement(
        root,
        "CoSimulation",
        both,
        canHandleVariableCommunicationStepSize="true",
        canInterpolateInputs="true",
        maxOutputDerivativeOrder="1",
    )
    for interface in (exchange, simulation):
        files = ElementTree.SubElement(interface, "SourceFiles")
        for name in compiled(spec, 2):
            ElementTree.SubElement(files, "File", name=name)


def _units(root: ElementTree.Element, spec: ModelSpec) -> None:
    definitions = ElementTree.SubElement(root, "UnitDefinitions")
    for name, exponents, display in used_units(spec):
        unit = ElementTree.SubElement(definitions, "Unit", name=name)
        ElementTree.SubElement(unit, "BaseUnit", {base: str(power) for base, power in exponents.items()})
        if display is not None:
            ElementTree.SubElement(unit, "DisplayUnit", name=display[0], factor=repr(display[1]))


def used_units(spec: ModelSpec) -> list[tuple[str, dict[str, int | float], tuple[str, float] | None]]:
    """Units of the variables: name, exponents, and name and factor of what may be shown instead."""
    used = {variable.unit for variable in spec.variables}
    return [(name, powers, DISPLAY_UNITS.get(name)) for name, powers in UNITS.items() if name in used]


def _choices(root: ElementTree.Element, spec: ModelSpec) -> None:
    definitions = ElementTree.SubElement(root, "TypeDefinitions")
    for choice in spec.choices:
        simple = ElementTree.SubElement(definitions, "SimpleType", name=choice.name)
        values = ElementTree.SubElement(simple, "Enumeration")
        for value, (name, text) in enumerate(choice.items, start=1):
            ElementTree.SubElement(values, "Item", name=name, value=str(value), description=text)


def _variable(parent: ElementTree.Element, variable: Variable, spec: ModelSpec) -> None:
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
    if variable.type == "Enumeration":
        value.set("declaredType", spec.choices[0].name)
    for name, text in value_attributes(variable).items():
        value.set(name, text)
    if variable.derivative_of is not None:
        value.set("derivative", str(spec.index(variable.derivative_of)))


def value_attributes(variable: Variable) -> dict[str, str]:
    """Unit, bounds, nominal and start of a variable, as both versions of FMI write them."""
    number = str if variable.type == "Enumeration" else repr
    display = DISPLAY_UNITS.get(variable.unit or "")
    entries = {
        "unit": variable.unit,
        "displayUnit": None if display is None else display[0],
        "min": None if variable.minimum is None else number(variable.minimum),
        "max": None if variable.maximum is None else number(variable.maximum),
        "nominal": None if variable.nominal is None else number(variable.nominal),
        "start": None if variable.start is None else number(variable.start),
    }
    return {name: text for name, text in entries.items() if text is not None}


def _structure(root: ElementTree.Element, spec: ModelSpec) -> None:
    structure = ElementTree.SubElement(root, "ModelStructure")
    computed = initial_unknowns(spec)
    moving = {variable.name for variable in (*spec.inputs, *spec.states)}
    # While running only inputs and states are knowns; at initialization the parameters are as well.
    sections = (
        ("Outputs", spec.outputs, False),
        ("Derivatives", spec.derivatives, False),
        ("InitialUnknowns", tuple(computed), True),
    )
    for section, variables, all_knowns in sections:
        if not variables:
            continue
        unknowns = ElementTree.SubElement(structure, section)
        for variable in variables:
            knowns = sorted(spec.index(name) for name in variable.depends if all_knowns or name in moving)
            ElementTree.SubElement(
                unknowns,
                "Unknown",
                index=str(spec.index(variable.name)),
                dependencies=" ".join(map(str, knowns)),
                dependenciesKind=" ".join(["dependent"] * len(knowns)),
            )


def initial_unknowns(spec: ModelSpec) -> list[Variable]:
    """Outputs and derivatives that follow from start values, and are none themselves."""
    found = [variable for variable in (*spec.outputs, *spec.derivatives) if variable.start is None]
    return sorted(found, key=lambda variable: variable.value_reference)


def documentation(spec: ModelSpec, readme: str, compiler: str, fmi: int = 2, references: str = "") -> str:
    """``index.html``, shown to an importer's user: variables with units, equations, how the binary was made.

    With reference results in the FMU, a sentence about them.
    """
    return _PAGE.format(
        title=escape(spec.name),
        description=escape(spec.description),
        notes="".join(f"<tr><th>{escape(a)}</th><td>{escape(b)}</td></tr>" for a, b in spec.notes),
        variables="\n".join(_row(variable) for variable in spec.variables),
        readme=escape(readme),
        version=escape(__version__),
        compiler=escape(compiler),
        fmi=fmi,
        references=references and _REFERENCES.format(about=escape(references)),
    )


def _row(variable: Variable) -> str:
    start = "" if variable.start is None else repr(variable.start)
    cells = (variable.name, variable.causality, variable.unit or "", start, variable.description)
    return "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>"
