"""`ModelSpec` to the XML of an FMU: model description of FMI 2.0 and 3.0, terminals, build description.

The texts depend on nothing but their arguments and the library's version. FMI 3.0 requires the time and every
event indicator as variables; they follow those of the specification.
"""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree

from ehlcontact import __version__
from fmu.sources import compiled
from fmu.spec import DISPLAY_UNITS, UNITS, ModelSpec, Variable

Element = ElementTree.Element

LONGEST_LIST = 200  # of inputs and states; those of bearings would be half the text
DEFAULT_STEPS = 1000  # of the default experiment
LOG_CATEGORIES = {
    "logStatusError": "Calls that failed, always logged",
    "logStatusDiscard": "Values that do not exist for the present inputs",
    "logStatusWarning": "Motion leaving the validity box; steps that are too long for it",
}
TIME = "time"  # name of the independent variable of FMI 3.0
# Kind of a flange and names of its members: place, its rate, force; angle, its rate, moment.
TRANSLATIONAL = "Modelica.Mechanics.Translational.Interfaces.Flange_a", ("s", "v", "f")
ROTATIONAL = "Modelica.Mechanics.Rotational.Interfaces.Flange_a", ("phi", "w", "tau")
MEMBER_KINDS = ("signal", "signal", "inflow")
SECTIONS_2 = {
    "Output": "Outputs",
    "ContinuousStateDerivative": "Derivatives",
    "InitialUnknown": "InitialUnknowns",
}
TYPES_3 = {"Real": "Float64", "Boolean": "Boolean"}
STATES_3 = {"canGetAndSetFMUState": "true", "canSerializeFMUState": "true"}
DERIVATIVES_3 = "providesDirectionalDerivatives", "providesAdjointDerivatives"
C_OPTIONS = "-ffp-contract=off"  # results depend on it; visibility of symbols is chosen by the importer


def model_description(spec: ModelSpec, token: str, fmi: int) -> bytes:
    """``modelDescription.xml`` of FMI 2.0 or 3.0; `token` is the GUID or the instantiation token."""
    root = Element(
        "fmiModelDescription",
        {
            "fmiVersion": f"{fmi}.0",
            "modelName": spec.name,
            "guid" if fmi == 2 else "instantiationToken": token,
            "description": spec.description,
            "author": "ehlcontact",
            "version": __version__,
            "copyright": "Copyright (c) 2026, the ehlcontact developers",
            "license": "BSD-3-Clause",
            "generationTool": f"ehlcontact {__version__}",
            "variableNamingConvention": "structured",
        },
    )
    if fmi == 2:
        root.set("numberOfEventIndicators", str(len(spec.indicators)))
    (_interfaces_2 if fmi == 2 else _interfaces_3)(root, spec)
    _units(root, spec)
    categories = _child(root, "LogCategories")
    for name, text in LOG_CATEGORIES.items():
        _child(categories, "Category", name=name, description=text)
    ElementTree.SubElement(root, "DefaultExperiment", default_experiment(spec))
    variables = _child(root, "ModelVariables")
    for variable in spec.variables:
        _variable(variables, variable, spec, fmi)
    if fmi == 3:
        _time_and_indicators(variables, spec)
    _structure(root, spec, fmi)
    return _text(root)


def default_experiment(spec: ModelSpec) -> dict[str, str]:
    """Start, stop, tolerance and a step that resolves the contact."""
    stop = float(f"{DEFAULT_STEPS * spec.step:.6g}")
    numbers = {"startTime": 0.0, "stopTime": stop, "tolerance": spec.tolerance, "stepSize": spec.step}
    return {name: repr(value) for name, value in numbers.items()}


def _child(parent: Element, tag: str, **attributes: str) -> Element:
    return ElementTree.SubElement(parent, tag, attributes)


def _text(root: Element) -> bytes:
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)


# ---- interfaces, units, types


def _interfaces_2(root: Element, spec: ModelSpec) -> None:
    both = {
        "modelIdentifier": spec.identifier,
        "canGetAndSetFMUstate": "true",
        "canSerializeFMUstate": "true",
    }
    interfaces = []
    if spec.exchange:
        own = {"providesDirectionalDerivative": "true", "completedIntegratorStepNotNeeded": "true"}
        interfaces.append(_child(root, "ModelExchange", **both, **own))
    simulation = _child(
        root,
        "CoSimulation",
        **both,
        providesDirectionalDerivative=_boolean(spec.partials),
        canHandleVariableCommunicationStepSize="true",
        canInterpolateInputs="true",
        maxOutputDerivativeOrder=str(int(spec.partials)),
    )
    for interface in (*interfaces, simulation):
        files = _child(interface, "SourceFiles")
        for name in compiled(spec, 2):
            _child(files, "File", name=name)


def _interfaces_3(root: Element, spec: ModelSpec) -> None:
    if spec.exchange:
        provided = dict.fromkeys(DERIVATIVES_3, "true")
        _child(root, "ModelExchange", **STATES_3, **provided, modelIdentifier=spec.identifier)
    _child(
        root,
        "CoSimulation",
        **STATES_3,
        **dict.fromkeys(DERIVATIVES_3, _boolean(spec.partials)),
        modelIdentifier=spec.identifier,
        canHandleVariableCommunicationStepSize="true",
        maxOutputDerivativeOrder=str(int(spec.partials)),
        providesIntermediateUpdate="true",
        mightReturnEarlyFromDoStep="true",
        hasEventMode="true",
    )


def _boolean(value: bool) -> str:
    return "true" if value else "false"


def _units(root: Element, spec: ModelSpec) -> None:
    definitions = _child(root, "UnitDefinitions")
    used = {variable.unit for variable in spec.variables}
    for name, exponents in UNITS.items():
        if name not in used:
            continue
        unit = _child(definitions, "Unit", name=name)
        ElementTree.SubElement(unit, "BaseUnit", {base: str(power) for base, power in exponents.items()})
        if name in DISPLAY_UNITS:
            display, factor = DISPLAY_UNITS[name]
            _child(unit, "DisplayUnit", name=display, factor=repr(factor))


# ---- variables


def _variable(parent: Element, variable: Variable, spec: ModelSpec, fmi: int) -> None:
    facts = {
        "name": variable.name,
        "valueReference": str(variable.value_reference),
        "causality": variable.causality,
        "variability": variable.variability,
        "description": variable.description,
    }
    if variable.causality != "input":  # FMI 2.0 forbids it there
        computed = "calculated" if variable.guess is None else "approx"
        facts["initial"] = computed if variable.start is None else "exact"
    if fmi == 2:
        entry = _child(_child(parent, "ScalarVariable", **facts), variable.type)
    else:
        entry = _child(parent, TYPES_3[variable.type], **facts)
    _set_value(entry, variable)
    if variable.derivative_of is not None:
        entry.set("derivative", str(_place(spec, variable.derivative_of, fmi)))


def _place(spec: ModelSpec, name: str, fmi: int) -> int:
    """Number by which other entries refer to a variable: its index in FMI 2.0, its value reference in FMI 3.0."""
    return spec.index(name) if fmi == 2 else spec[name].value_reference


def _set_value(entry: Element, variable: Variable) -> None:
    """Set unit, bounds, nominal value and start value."""
    numbers = {
        "min": variable.minimum,
        "max": variable.maximum,
        "nominal": variable.nominal,
        "start": variable.declared_start,
    }
    if variable.unit is not None:
        entry.set("unit", variable.unit)
        if variable.unit in DISPLAY_UNITS:
            entry.set("displayUnit", DISPLAY_UNITS[variable.unit][0])
    for name, value in numbers.items():
        if value is not None:
            entry.set(name, repr(value))


def _time_and_indicators(parent: Element, spec: ModelSpec) -> None:
    """Append the variables that FMI 3.0 requires beyond those of the specification."""
    text = "Above zero while the surfaces push: force, or a film's power 2/3 of it, before it is clipped"
    behind = len(spec.variables)
    _child(
        parent,
        "Float64",
        name=TIME,
        valueReference=str(behind),
        causality="independent",
        variability="continuous",
        description="Time" if spec.time_unit == "s" else "Time in 2a/u_sum",
    )
    for k, (name, _) in enumerate(spec.indicators, start=1):
        _child(
            parent,
            "Float64",
            name=name,
            valueReference=str(behind + k),
            causality="local",
            variability="continuous",
            initial="calculated",
            description=text,
        )


# ---- structure


def _sections(spec: ModelSpec) -> dict[str, tuple[Variable, ...]]:
    """Outputs, derivatives and initial unknowns, by the names of FMI 3.0."""
    found = {v.name: v for v in (*spec.outputs, *spec.states, *spec.derivatives)}  # a state may be an output
    computed = [variable for variable in found.values() if variable.start is None]
    initial = tuple(sorted(computed, key=lambda variable: variable.value_reference))
    return {"Output": spec.outputs, "ContinuousStateDerivative": spec.derivatives, "InitialUnknown": initial}


def _structure(root: Element, spec: ModelSpec, fmi: int) -> None:
    structure = _child(root, "ModelStructure")
    moving = {variable.name for variable in (*spec.inputs, *spec.states)}

    def unknown(parent: Element, tag: str, place: int, depends: tuple[str, ...], initial: bool = False) -> None:
        knowns = [_place(spec, name, fmi) for name in depends if initial or name in moving]
        entry = _child(parent, tag, **{"index" if fmi == 2 else "valueReference": str(place)})
        # without a list it depends on all, which the standard says
        if initial or len(knowns) < len(moving) or len(knowns) <= LONGEST_LIST:
            entry.set("dependencies", " ".join(map(str, sorted(knowns))))
            entry.set("dependenciesKind", " ".join(["dependent"] * len(knowns)))

    for name, variables in _sections(spec).items():
        if not variables:
            continue
        # FMI 2.0 has a list of unknowns in each section, FMI 3.0 an entry of that name for each unknown
        parent, tag = (_child(structure, SECTIONS_2[name]), "Unknown") if fmi == 2 else (structure, name)
        for variable in variables:
            initial = name == "InitialUnknown"
            depends = spec.initially(variable) if initial else variable.depends
            unknown(parent, tag, _place(spec, variable.name, fmi), depends, initial)
    if fmi == 3:
        for k, (_, output) in enumerate(spec.indicators, start=1):
            unknown(structure, "EventIndicator", len(spec.variables) + k, spec[output].depends)


# ---- further files of FMI 3.0


def terminals(spec: ModelSpec) -> bytes:
    """``terminalsAndIcons.xml``: place of the icon; place or tilt, rate, and force or moment as a flange."""
    root = Element("fmiTerminalsAndIcons", fmiVersion="3.0")
    ends = {"x1": "-100", "y1": "-100", "x2": "100", "y2": "100"}
    shown = ElementTree.SubElement(root, "GraphicalRepresentation")
    ElementTree.SubElement(shown, "CoordinateSystem", ends, suggestedScalingFactorTo_mm="0.1")
    ElementTree.SubElement(shown, "Icon", ends)
    parent = ElementTree.SubElement(root, "Terminals") if spec.flanges else root  # never an empty list
    for name, text, variables in spec.flanges:
        flange_kind, members = ROTATIONAL if spec[variables[0]].unit == "rad" else TRANSLATIONAL
        flange = ElementTree.SubElement(
            parent, "Terminal", name=name, matchingRule="bus", terminalKind=flange_kind, description=text
        )
        for variable, member, kind in zip(variables, members, MEMBER_KINDS, strict=True):
            ElementTree.SubElement(
                flange, "TerminalMemberVariable", variableName=variable, memberName=member, variableKind=kind
            )
    return _text(root)


def build_description(identifier: str, units: Sequence[str]) -> bytes:
    """``buildDescription.xml`` of FMI 3.0, section 2.5.1.4.

    Parameters
    ----------
    identifier : str
        As ``modelIdentifier`` in the model description.
    units : sequence of str
        Files of ``sources/`` to compile; headers are found beside them, those of FMI the importer has.
    """
    root = Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = ElementTree.SubElement(root, "BuildConfiguration", modelIdentifier=identifier)
    files = ElementTree.SubElement(
        configuration, "SourceFileSet", language="C99", compiler="gcc", compilerOptions=C_OPTIONS
    )
    for name in units:
        ElementTree.SubElement(files, "SourceFile", name=name)
    ElementTree.SubElement(
        configuration, "Library", name="m", external="true", description="Maths library, where C has it apart"
    )
    return _text(root)
