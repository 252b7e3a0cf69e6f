"""One FMU of each bearing for all tests here."""

import pytest
from bearing_fmus import MODELS, Made

from fmu import export_bearing


@pytest.fixture(scope="session")
def made(tmp_path_factory):
    """``made("planar", 2)``: exported once."""
    known = {}

    def make(name, fmi=2):
        if (name, fmi) not in known:
            model, path = MODELS[name](), tmp_path_factory.mktemp("bearing") / "x.fmu"
            export_bearing(
                model.bearing, path, speeds_rpm=model.speeds_rpm, load=model.load, freedoms=model.freedoms, fmi=fmi
            )
            known[name, fmi] = Made(model, path, fmi)
        return known[name, fmi]

    return make
