"""C sources of an FMU, and its libraries for every platform, compiled once."""

import warnings

import pytest

from ehlcontact.binaries import PLATFORMS, build_binaries
from fmu.archive import content_guid
from fmu.contact_spec import contact_spec
from fmu.sources import compiled, source_files
from reduced_models import SpringContact


@pytest.fixture(autouse=True)
def compilers_of_users(monkeypatch):
    """Not the quick one of the other tests."""
    monkeypatch.delenv("EHLCONTACT_CC", raising=False)


@pytest.fixture(scope="session")
def spec():
    return contact_spec(SpringContact.cubic(K1=0.624, K2=0.750, K3=-0.174, C1=0.0130, low=0.75, high=1.0))


@pytest.fixture(scope="session")
def sources(spec):
    return source_files(spec, content_guid(spec))


@pytest.fixture(scope="session")
def libraries(spec, sources, elements):
    """Libraries by version of FMI and platform: a spring's in FMI 2, a film's in FMI 3.

    The first one for Windows takes minutes.
    """
    film = contact_spec(elements["wide"])
    cases = {2: (spec, sources), 3: (film, source_files(film, content_guid(film, 3), 3))}
    found = {}
    with warnings.catch_warnings(), pytest.MonkeyPatch.context() as patch:
        patch.delenv("EHLCONTACT_CC", raising=False)
        warnings.filterwarnings("ignore", message="the first library for Windows")
        for fmi, (one, texts) in cases.items():
            made, _ = build_binaries(texts, compiled(one, fmi), one.identifier, list(PLATFORMS.values()), fmi=3)
            found |= {(fmi, path.split("/")[1]): content for path, content in made.items()}
    return found
