"""`ModelSpec` to the texts of an FMU: ``modelDescription.xml``, ``config.h`` and ``documentation/index.html``.

They depend on nothing but their arguments and the library's version.
"""

from __future__ import annotations

from html import escape
from xml.etree import ElementTree

from ehlcontact import __version__
from fmu.spec import UNITS, ModelSpec, Variable

LOG_CATEGORIES = {
    "logStatusError": "Calls that failed, always logged",
    "logStatusDiscard": "Values that do not exist for the present inputs",
    "logStatusWarning": "Approach leaving the validity interval",
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
</table>
<h2>Sources</h2>
<pre>{readme}</pre>
<h2>Build</h2>
<p>Exported by ehlcontact {version} as FMI 2.0 for co-simulation; the binary needs nothing but the C library.
It was compiled with <code>{compiler}</code>. To build it for another platform, compile the files in
<code>sources/</code> and link the maths library.</p>
</body>
</html>
"""


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


def config_header(spec: ModelSpec, guid: str) -> str:
    """``config.h``, what the C sources must know of one model: GUID, value references, starts with 17 digits."""
    lines = [
        "/* Generated by ehlcontact. GUID, value references and start values as in modelDescription.xml. */",
        "#ifndef CONFIG_H",
        "#define CONFIG_H",
        "",
        f'#define MODEL_GUID "{guid}"',
        f'#define MODEL_HEADER "{spec.header}"',
        "",
        "enum {",
        ",\n".join(f"    VR_{v.name} = {v.value_reference}" for v in spec.variables),
        "};",
        "",
        *(f"#define START_{v.name} ({c_double(v.start)})" for v in spec.variables if v.start is not None),
        "",
        "#endif",
        "",
    ]
    return "\n".join(lines)


def c_double(value: float) -> str:
    """C literal that reads back as exactly this double."""
    text = format(value, ".17g")
    return text if any(mark in text for mark in ".e") else f"{text}.0"


def documentation(spec: ModelSpec, readme: str, compiler: str) -> str:
    """``index.html``, shown to an importer's user: variables with units, equations, how the binary was made."""
    return _PAGE.format(
        title=escape(spec.name),
        description=escape(spec.description),
        notes="".join(f"<tr><th>{escape(a)}</th><td>{escape(b)}</td></tr>" for a, b in spec.notes),
        variables="\n".join(_row(variable) for variable in spec.variables),
        readme=escape(readme),
        version=escape(__version__),
        compiler=escape(compiler),
    )


def _row(variable: Variable) -> str:
    start = "" if variable.start is None else repr(variable.start)
    cells = (variable.name, variable.causality, variable.unit or "", start, variable.description)
    return "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>"
