"""``sources/buildDescription.xml`` of FMI 3: which files are compiled, in which language, with which library."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree

LANGUAGE = "C99"
OPTIONS = "-ffp-contract=off"  # what results depend on; how symbols are hidden is the importer's affair


def build_description(identifier: str, units: Sequence[str]) -> bytes:
    """``buildDescription.xml`` of FMI 3.0, section 2.5.1.4.

    Parameters
    ----------
    identifier : str
        As ``modelIdentifier`` in the model description.
    units : sequence of str
        Files of ``sources/`` to compile; headers are found beside them, those of FMI the importer has.
    """
    root = ElementTree.Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = ElementTree.SubElement(root, "BuildConfiguration", modelIdentifier=identifier)
    files = ElementTree.SubElement(
        configuration, "SourceFileSet", language=LANGUAGE, compiler="gcc", compilerOptions=OPTIONS
    )
    for name in units:
        ElementTree.SubElement(files, "SourceFile", name=name)
    ElementTree.SubElement(
        configuration, "Library", name="m", external="true", description="Maths library, where C has it apart"
    )
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)
