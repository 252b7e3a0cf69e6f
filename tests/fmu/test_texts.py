"""Texts and picture of an FMU: model description, documentation, icon."""

import dataclasses
import re
import zipfile
from xml.etree import ElementTree

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu
from PIL import Image

from ehlcontact.errors import InputError
from fmu import export
from fmu.archive import ICON
from fmu.c_headers import c_double
from fmu.contact_spec import contact_spec
from fmu.documentation import documentation
from fmu.model_description import model_description
from fmu.spec import ModelSpec, Variable
from fmu.steps import step_advice

UNITS_SI = {
    "approach": ("m", {"m": 1}),
    "rate": ("m/s", {"m": 1, "s": -1}),
    "force": ("N", {"kg": 1, "m": 1, "s": -2}),
    "stiffness": ("N/m", {"kg": 1, "s": -2}),
    "damping": ("N.s/m", {"kg": 1, "s": -1}),
    "K1": ("N/m", {"kg": 1, "s": -2}),
    "K2": ("N.m-2", {"kg": 1, "m": -1, "s": -2}),
    "K3": ("N.m-3", {"kg": 1, "m": -2, "s": -2}),
    "C1": ("N.s/m", {"kg": 1, "s": -1}),
    "low": ("m", {"m": 1}),
    "high": ("m", {"m": 1}),
    "lead": ("1", {}),
}


def test_fmpy_validation_has_no_finding(fmus, any_kind):
    assert validate_fmu(str(fmus[any_kind])) == []


def test_units_are_declared_with_si_exponents(fmus):
    description = fmpy.read_model_description(str(fmus["cubic_si"]))
    bases = {unit.name: unit.baseUnit for unit in description.unitDefinitions}
    for variable in description.modelVariables:
        if variable.type != "Real":
            assert variable.unit is None
            continue
        name, exponents = UNITS_SI[variable.name]
        assert variable.unit == name
        base = bases[name]
        found = {key: int(getattr(base, key)) for key in ("kg", "m", "s", "A", "K", "mol", "cd", "rad")}
        assert {key: power for key, power in found.items() if power} == exponents
        assert float(base.factor) == 1.0
        assert float(base.offset) == 0.0


def test_dimensionless_element_has_units_1_throughout(fmus):
    description = fmpy.read_model_description(str(fmus["cubic"]))
    assert [unit.name for unit in description.unitDefinitions] == ["1"]
    assert {v.unit for v in description.modelVariables if v.type == "Real"} == {"1"}
    assert "dimensionless" in description.description


def test_starts_are_exactly_the_elements(fmus, elements, kind, slave):
    element = elements[kind]
    expected = {"K2": 0.0, "K3": 0.0} | element.parameters | {"low": element.low, "high": element.high}
    variables = {v.name: v for v in fmpy.read_model_description(str(fmus[kind])).modelVariables}
    binary = slave(kind)
    for name, value in expected.items():
        assert float(variables[name].start) == value
        assert binary.get(name) == [value]
        assert (variables[name].causality, variables[name].variability) == ("parameter", "tunable")
    for name in ("approach", "rate"):  # XML and binary agree on the inputs too
        assert binary.get(name) == [float(variables[name].start)]
    assert element.low < float(variables["approach"].start) < element.high


def test_dependencies_are_explicit(fmus):
    description = fmpy.read_model_description(str(fmus["cubic"]))
    outputs = {u.variable.name: [v.name for v in u.dependencies] for u in description.outputs}
    assert outputs == {
        "force": ["approach", "rate"],
        "stiffness": ["approach", "rate"],
        "damping": ["approach", "rate"],
        **{f"outside_{what}": ["approach", "rate"] for what in ("validity", "approach", "rate", "force")},
    }
    initial = {u.variable.name: {v.name for v in u.dependencies} for u in description.initialUnknowns}
    assert initial["force"] == {"approach", "rate", "K1", "K2", "K3", "C1", "low", "high"}
    assert initial["outside_validity"] == initial["force"]


def test_capabilities_and_origin(fmus):
    description = fmpy.read_model_description(str(fmus["cubic"]))
    slave = description.coSimulation
    assert slave.canGetAndSetFMUstate
    assert slave.canSerializeFMUstate
    assert slave.providesDirectionalDerivative
    assert slave.canHandleVariableCommunicationStepSize
    assert not slave.needsExecutionTool
    assert slave.maxOutputDerivativeOrder == 1 and slave.canInterpolateInputs
    exchange = description.modelExchange
    assert exchange.canGetAndSetFMUstate and exchange.canSerializeFMUstate
    assert exchange.providesDirectionalDerivative and not exchange.needsCompletedIntegratorStep
    assert description.generationTool.startswith("ehlcontact")
    assert description.defaultExperiment is not None


@pytest.mark.parametrize("value", [0.0, -0.0, 1.0, 7.0, -1e300, 5e-324, 0.1, 1 / 3, 123456789.0, -0.174, 2.0**-40])
def test_c_literal_reads_back_exactly(value):
    literal = c_double(value)
    assert float.fromhex(literal) == value if "0x" in literal else float(literal) == value
    assert len(literal) <= len(repr(value))
    assert re.fullmatch(r"-?0x[01](\.[0-9a-f]+)?p[-+]\d+|-?[\d.]+(e[-+]\d+)?", literal)
    assert re.search(r"[.ep]", literal)  # else C would read an integer


def test_model_name_becomes_identifier(elements):
    assert contact_spec(elements["cubic"], "Lager 1, Stoß").identifier == "Lager_1__Sto_"
    assert contact_spec(elements["cubic"], "1st").identifier == "m1st"
    assert contact_spec(elements["linear"]).identifier == "LinearContact"


def test_two_variables_of_one_reference_are_refused():
    twins = [Variable(name, 0, "input", "continuous", "", unit="1", start=0.0) for name in "ab"]
    with pytest.raises(InputError, match="unique"):
        ModelSpec("m", "", (), (), tuple(twins))


def test_description_says_whose_contact_it_is(elements):
    said = "6205, inner race, most loaded ball of 100 N at 3000 rpm, ISO VG 68 at 60 °C"
    element = dataclasses.replace(elements["cubic"], source={"contact": said})
    known, unknown = contact_spec(element), contact_spec(elements["cubic"])
    assert known.description == f"{unknown.description}; {said}"
    xml = ElementTree.fromstring(model_description(known, "{}", 2))
    assert xml.attrib["description"] == known.description
    assert said in documentation(known, "", "")
    # a source may be of a file that somebody wrote: one line, of what can be printed
    strange = dataclasses.replace(element, source={"contact": "a\nb\x00" + 500 * "c"})
    assert contact_spec(strange).description == f"{unknown.description}; a b{'c' * 197}"
    assert contact_spec(dataclasses.replace(element, source={"contact": 5})).description.endswith("; 5")


def test_page_tells_where_the_element_comes_from(elements):
    element = dataclasses.replace(
        elements["cubic"], rate=2.5, fit={"rms": 0.003}, source={"n": 128, "motion": "<free>"}
    )
    page = documentation(contact_spec(element), "g(u) < f", "cc")
    for text in ("rms: 0.003", "n: 128", "motion: &lt;free&gt;", "2.5", "g(u) &lt; f", "<code>cc</code>"):
        assert text in page


def test_a_source_is_in_words(elements):
    """Not as Python prints what it holds."""
    made = {"point": {"M": 200.0, "alpha": 2.2e-8, "law": None}, "omega": [0.1, 3.14159265], "n": None}
    notes = dict(contact_spec(dataclasses.replace(elements["cubic"], source=made)).notes)
    assert notes["Source"] == "omega: (0.1, 3.14159); point: (M 200, alpha 2.2e-08)"


def test_page_names_the_largest_step_of_each_coupling(elements):
    """Half a step late takes K h/2 off the damping: 2 C over K, at the static load."""
    for name in ("cubic_si", "wide_si", "power"):
        element = elements[name]
        advice = {label: value for label, value, _ in step_advice(element)}
        u = element.approach_at(element._static_load(None))
        w = 0.1 / (element.time or 1.0)
        Z = element._response(np.array([w]), element._static_load(None))[0]
        late = float(advice["largest step, with a lead half a step too small"].split()[0])
        assert late == pytest.approx(2.0 * Z.imag / w / element.spring_tangent(u), rel=5e-3)
        notes = dict(contact_spec(element).notes)
        assert all(advice[label] in notes[label.capitalize()] for label in advice)
        assert float(advice["default step"].split()[0]) <= 0.05 * (element.time or 1.0)


@pytest.mark.parametrize(("fmi", "place"), [(2, "model.png"), (3, "terminalsAndIcons/icon.png")])
def test_icon_is_in_the_fmu(elements, tmp_path, fmi, place):
    path = export(elements["cubic"], tmp_path / "x.fmu", fmi=fmi)
    with zipfile.ZipFile(path) as archive:
        assert archive.read(place) == ICON.read_bytes()
        assert sum(name.endswith(".png") for name in archive.namelist()) == 1


def test_icon_is_small_and_can_be_read():
    """Ball above raceway with the film between, on nothing."""
    picture = Image.open(ICON)
    picture.load()  # checksums too
    width, height = picture.size
    assert ICON.stat().st_size < 2000
    assert width == height >= 100 and picture.mode == "RGBA"
    middle = [picture.getpixel((width // 2, y)) for y in range(height)]
    solid = [pixel for pixel in middle if pixel[3] == 255]
    assert list(dict.fromkeys(pixel for pixel in solid if solid.count(pixel) > 2)) == [
        (0x8D, 0x99, 0xA6, 255), (0xE0, 0x8A, 0x1E, 255), (0x4A, 0x55, 0x60, 255),
    ]  # fmt: skip
    assert picture.getpixel((0, 0))[3] == 0
