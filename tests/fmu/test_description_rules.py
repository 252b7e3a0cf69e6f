"""Rules of FMI for names, beside fmpy's parser of them, and for descriptions."""

import re
from types import SimpleNamespace
from zipfile import ZipFile

import pytest
from bearing_fmus import MODELS
from exported import model_of
from fmpy.model_description import ModelDescription
from fmpy.validation import validate_fmu, validate_model_description

from fmu.description_rules import findings, is_structured

GOOD = "a _ a1 a.b a[1] a[1,2].b[3] der(a) der(a[1].b,2) der der.a".split()
GOOD += ["'a'", "'a'.b", "'a b'", r"'it\'s'", r"'\\'", "'a;b'", "'/'", "'{|}~'", "'?'"]
BAD = "1a a..b a. .a a[] a[x] a[1][2] a[1,] a[-1] der(a,b) der(der(a)) der(a ä a-b a.der(b)".split()
BAD += ["", "a b", "a\n", "''", "'ä'", "'`'"]


def allowed_by_fmpy(names):
    described = ModelDescription(fmiVersion="1.0", variableNamingConvention="structured")
    described.modelVariables = [
        SimpleNamespace(name=name, sourceline=1, type="Real", variability="continuous") for name in names
    ]
    return not validate_model_description(described, validate_variable_names=True)


@pytest.mark.parametrize(("names", "allowed"), [(GOOD, True), (BAD, False)])
def test_names_are_judged_as_by_fmpy(names, allowed):
    for name in names:
        assert is_structured(name) is allowed, name
        assert allowed_by_fmpy([name]) is allowed, name


def test_names_of_bearings_are_allowed_by_fmpy():
    """One of those that differ in their numbers alone: fmpy takes seconds for all."""
    for kind in ("planar", "five"):
        names = [variable.name for variable in model_of(MODELS[kind]()).spec.variables]
        assert all(map(is_structured, names))
        assert allowed_by_fmpy({re.sub(r"\d+", "1", name) for name in names})


def test_what_fmpy_finds_is_found(fmus, tmp_path):
    assert findings(fmus["cubic"]) == tuple(validate_fmu(str(fmus["cubic"]))) == ()
    for old, new, words in (
        ('name="force"', 'name="for ce"', "for ce"),
        ('causality="output"', 'causality="local"', "Outputs"),
        ("<ModelVariables>", "<Variables>", "Variables"),
    ):
        with ZipFile(fmus["cubic"]) as archive:
            described = archive.read("modelDescription.xml").decode()
        assert old in described
        path = tmp_path / "changed.fmu"
        with ZipFile(path, "w") as archive:
            archive.writestr("modelDescription.xml", described.replace(old, new))
        assert any(words in one for one in findings(path))
        assert any(words in one for one in validate_fmu(str(path)))
