"""``buildDescription.xml`` against the schema of FMI 3."""

from pathlib import Path

import fmpy
from lxml import etree

from fmu.model_description import build_description


def test_it_is_valid_and_names_every_file(spec):
    schema = etree.XMLSchema(file=str(Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3BuildDescription.xsd"))
    root = etree.fromstring(build_description(spec.identifier, spec.sources))
    schema.assertValid(root)
    (configuration,) = root.findall("BuildConfiguration")
    assert configuration.get("modelIdentifier") == spec.identifier
    assert [file.get("name") for file in configuration.iter("SourceFile")] == list(spec.sources)
    assert configuration.find("SourceFileSet").get("language") == "C99"
    (library,) = configuration.findall("Library")
    assert (library.get("name"), library.get("external")) == ("m", "true")
