"""``SystemStructure.ssd`` of System Structure and Parameterization 1.0: components, connectors, and the wires.

Written so that Ecos and the Open Simulation Platform read it, which ask for more than the standard: these prefixes
of the namespaces, a type of every connector, every wire between two components.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from xml.etree import ElementTree

from ehlcontact import __version__
from fmu.spec import UNITS

SSD = "http://ssp-standard.org/SSP1/SystemStructureDescription"
SSC = "http://ssp-standard.org/SSP1/SystemStructureCommon"
SSV = "http://ssp-standard.org/SSP1/SystemStructureParameterValues"
OSP = (
    "http://opensimulationplatform.com/SSP/OSPAnnotations"  # its annotation of the step, which SSP has no word for
)
VERSION = "1.0"
START = "start"  # name of the parameter sets with the values to start from


@dataclass(frozen=True, slots=True)
class Connector:
    """A real input or output of a component."""

    name: str
    kind: str  # input, output
    unit: str  # key of UNITS


@dataclass(frozen=True, slots=True)
class Component:
    """An FMU of the system."""

    name: str
    source: str  # path in the archive
    connectors: tuple[Connector, ...]
    starts: Mapping[str, float] = field(default_factory=dict)  # of inputs, by name
    description: str = ""


@dataclass(frozen=True, slots=True)
class Wire:
    """From an output to an input: component and connector of each."""

    source: tuple[str, str]
    sink: tuple[str, str]


def system_structure(
    name: str,
    components: Sequence[Component],
    wires: Iterable[Wire],
    *,
    step: float,
    stop: float,
    description: str,
) -> bytes:
    """The file; `step` and `stop` [s] are those of the default experiment."""
    for prefix, space in (("ssd", SSD), ("ssc", SSC), ("ssv", SSV), ("osp", OSP)):
        ElementTree.register_namespace(prefix, space)
    root = ElementTree.Element(
        f"{{{SSD}}}SystemStructureDescription",
        version=VERSION,
        name=name,
        description=description,
        author="ehlcontact",
        generationTool=f"ehlcontact {__version__}",
    )
    system = _child(root, SSD, "System", name=name, description=description)
    elements = _child(system, SSD, "Elements")
    for component in components:
        _component(elements, component)
    connections = _child(system, SSD, "Connections")
    for wire in wires:
        _child(
            connections,
            SSD,
            "Connection",
            startElement=wire.source[0],
            startConnector=wire.source[1],
            endElement=wire.sink[0],
            endConnector=wire.sink[1],
        )
    _units(root, {connector.unit for component in components for connector in component.connectors})
    experiment = _child(root, SSD, "DefaultExperiment", startTime="0.0", stopTime=repr(stop))
    annotation = _child(
        _child(experiment, SSD, "Annotations"), SSC, "Annotation", type="com.opensimulationplatform"
    )
    _child(_child(annotation, OSP, "Algorithm"), OSP, "FixedStepAlgorithm", baseStepSize=repr(step))
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)


def _component(parent: ElementTree.Element, component: Component) -> None:
    element = _child(
        parent,
        SSD,
        "Component",
        name=component.name,
        description=component.description,
        type="application/x-fmu-sharedlibrary",
        source=component.source,
        implementation="CoSimulation",
    )
    connectors = _child(element, SSD, "Connectors")
    for connector in component.connectors:
        at = _child(connectors, SSD, "Connector", name=connector.name, kind=connector.kind)
        _child(at, SSC, "Real", unit=connector.unit)
    if component.starts:
        binding = _child(_child(element, SSD, "ParameterBindings"), SSD, "ParameterBinding")
        values = _child(binding, SSD, "ParameterValues")
        parameters = _child(_child(values, SSV, "ParameterSet", version=VERSION, name=START), SSV, "Parameters")
        for name, value in component.starts.items():
            _child(_child(parameters, SSV, "Parameter", name=name), SSV, "Real", value=repr(float(value)))


def _units(root: ElementTree.Element, used: set[str]) -> None:
    units = _child(root, SSD, "Units")
    for name, exponents in UNITS.items():
        if name in used:
            unit = _child(units, SSC, "Unit", name=name)
            _child(unit, SSC, "BaseUnit", **{base: str(power) for base, power in exponents.items()})


def _child(parent: ElementTree.Element, space: str, tag: str, **attributes: str) -> ElementTree.Element:
    return ElementTree.SubElement(parent, f"{{{space}}}{tag}", attributes)
