"""Element files: exact round trip, and one clear line for whatever else is in the file."""

import json

import pytest

from ehlcontact import __version__, read, save
from ehlcontact.errors import InputError
from reduced_models import SpringContact, fit
from reduced_models.elements.base import ContactElement


def test_round_trip_is_exact(tmp_path, record):
    element = fit(record).element
    path = save(element, tmp_path / "e.json")
    back = read(path)
    assert back == element and type(back) is SpringContact and back.kind == "cubic"
    assert back.fit == element.fit and back.source == element.source
    assert read(path, SpringContact) == element
    document = json.loads(path.read_text())
    assert document["header"] == {"class": "SpringContact", "format": 1, "version": __version__}
    assert set(document["parameters"]) == {"K1", "K2", "K3", "C1"}
    assert set(document["valid"]) == {"low", "high", "rate", "load", "omega"}
    assert {"covariance", "intervals", "condition", "independent_samples", "rms"} <= set(document["fit"])
    assert element.rms == document["fit"]["rms"] and element.load_range == tuple(document["valid"]["load"])
    assert set(document["source"]) == {"point", "scales", "n", "domain", "motion", "version"}


def test_unknown_bounds_may_be_left_out(tmp_path, cubic):
    path = save(cubic, tmp_path / "e.json")
    _edit(path, valid={"low": 0.75, "high": 1.0, "rate": None})
    assert read(path) == cubic and read(path).load_range is None


def _edit(path, **changes):
    document = json.loads(path.read_text())
    for key, value in changes.items():
        if value is ...:
            del document[key]
        else:
            document[key] = value
    path.write_text(json.dumps(document))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"header": ...}, "it has no header"),
        ({"header": {"class": "Spline", "format": 1}}, "class 'Spline'"),
        ({"header": {"class": "BallBearing", "format": 1}}, "class 'BallBearing'"),
        ({"header": {"class": "SpringContact", "format": 2}}, "a newer version"),
        ({"kind": "spline"}, "one of linear, cubic, polynomial, power"),
        ({"kind": ["cubic"]}, "kind"),
        ({"units": "mm"}, "dimensionless, SI"),
        ({"parameters": ...}, "parameters"),
        ({"parameters": {"K1": 1.0}}, "parameters.K2"),
        ({"parameters": {"K1": True, "K2": 0, "K3": 0, "C1": 0}}, "parameters.K1"),
        ({"parameters": {"K1": 1.0, "K2": 0.0, "K3": 0.0, "C1": -1.0}}, "C1"),
        ({"valid": {"low": 0.7}}, "valid.high"),
        ({"valid": {"low": 0.7, "high": 1.0, "rate": "fast"}}, "valid.rate"),
        ({"valid": {"low": 0.7, "high": 1.0, "load": 3.0}}, "valid.load"),
        ({"valid": {"low": 0.7, "high": 1.0, "omega": [3.0, None]}}, "valid.omega.high"),
        ({"valid": {"low": 0.7, "high": 1.0, "omega": [3.0, 1.0]}}, "omega_range"),
        ({"fit": [1]}, "fit"),
    ],
)
def test_wrong_content_is_one_line_that_names_the_file(tmp_path, cubic, changes, message):
    path = save(cubic, tmp_path / "wrong.json")
    _edit(path, **changes)
    with pytest.raises(InputError, match=message) as caught:
        read(path, ContactElement)
    assert "wrong.json" in str(caught.value) and "\n" not in str(caught.value)


def test_truncation_anywhere_is_noticed(tmp_path, cubic):
    path = save(cubic, tmp_path / "cut.json")
    text = path.read_text().rstrip()
    for length in range(0, len(text), 7):
        path.write_text(text[:length])
        with pytest.raises(InputError, match=r"cut\.json"):
            read(path)
