"""An atlas whose answers are known everywhere."""

import atlas_stub
import pytest

from ehlcontact import save
from reduced_models import Atlas
from reduced_models.atlas.build import assemble


@pytest.fixture(scope="package")
def analytic(tmp_path_factory):
    """Atlas of the stand-in for the solver."""
    path = tmp_path_factory.mktemp("atlas") / "a.h5"
    save(assemble("film", atlas_stub.entries("film", 128, 128, 2), {"version": "stub"}), path)
    return Atlas(path)
