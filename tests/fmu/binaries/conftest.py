"""C sources of an FMU, and its libraries for every platform, compiled once."""

import warnings

import pytest

from fmu.binaries import PLATFORMS, build_binaries
from fmu.contacts import contact_spec
from fmu.export import content_guid, source_files
from fmu.glue import compiled
from reduced_models import CubicContact


@pytest.fixture(scope="session")
def spec():
    return contact_spec(CubicContact(K1=0.624, K2=0.750, K3=-0.174, C1=0.0130, low=0.75, high=1.0))


@pytest.fixture(scope="session")
def sources(spec):
    return source_files(spec, content_guid(spec))


@pytest.fixture(scope="session")
def libraries(spec, sources):
    """Library of each platform by its name; the first one for Windows takes minutes."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="the first library for Windows")
        made, _ = build_binaries(sources, compiled(spec, 2), spec.identifier, list(PLATFORMS.values()), fmi=3)
    return {path.split("/")[1]: content for path, content in made.items()}
