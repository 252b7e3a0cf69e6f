"""One FMU of each bearing for all tests here."""

import warnings

import pytest
from bearing_fmus import MODELS, ExportedBearing

from fmu import export
from reduced_models.elements.validity import OutsideValidityWarning


@pytest.fixture(scope="session")
def made(tmp_path_factory):
    """``made("planar", 2)``: exported once."""
    known = {}

    def make(name, fmi=2):
        if (name, fmi) not in known:
            path = tmp_path_factory.mktemp("bearing") / "x.fmu"
            with warnings.catch_warnings():  # of starved bearings, which `test_starved_fmu.py` tests
                warnings.simplefilter("ignore", OutsideValidityWarning)
                model = MODELS[name]()
                own = {"speeds_rpm": model.speeds_rpm, "load": model.load, "directions": model.directions}
                export(model.bearing, path, **own, fmi=fmi)
            known[name, fmi] = ExportedBearing(path, model, fmi)
        return known[name, fmi]

    return make
