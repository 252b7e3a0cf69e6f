"""``ehlcontact export STUDY.toml``: the rotor of a study, closed with its contacts."""

import json
from pathlib import Path

import fmpy
import pytest

from ehlcontact import save
from ehlcontact.cli.study.rotor import build_rotor
from ehlcontact.cli.study.schema import load_study
from reduced_models import Atlas, CubicContact

STUDY = Path(__file__).parents[2] / "examples" / "small_study.toml"
CUBIC = {"K1": 0.624, "K2": 0.750, "K3": -0.174, "C1": 0.0130, "low": 0.75, "high": 1.0}


def test_a_study_becomes_its_rotor(call, tmp_path):
    """On the atlas's contacts, at rest under the load of the study."""
    target = tmp_path / "rotor.fmu"
    done = call("export", STUDY, "-o", target, "--json", "-")
    assert done.code == 0, done
    document = json.loads(done.out)
    assert document["passes"] is True and document["units"] == "SI" and document["motion"] < 1e-6
    study = load_study(STUDY)
    rotor = build_rotor(study)
    state = rotor.static_equilibrium([Atlas().element(study.point)])
    starts = {v.name: v.start for v in fmpy.read_model_description(str(target)).modelVariables}
    assert float(starts["journal_y"]) == pytest.approx(state.journal[1], rel=1e-12)
    assert float(starts["speed_rpm"]) == study.bearing.speed_rpm
    assert float(starts["unbalance"]) == study.rotor.unbalance


def test_an_element_of_ones_own(call, tmp_path):
    """Dimensionless or in SI it is the same contact."""
    scales = load_study(STUDY).point.scales
    found = []
    for name, element in (("one", CubicContact(**CUBIC)), ("si", CubicContact(**CUBIC).to_si(scales))):
        file, target = save(element, tmp_path / f"{name}.json"), tmp_path / f"{name}.fmu"
        done = call("export", STUDY, "-o", target, "--contact", file, "--fmi", "3")
        assert done.code == 0 and "cubic" in done.out and "inner step" in done.out, done
        found.append(target.read_bytes())
    assert found[0] == found[1]


def test_what_cannot_be(refused, tmp_path):
    target = tmp_path / "x.fmu"
    text = STUDY.read_text()
    start, end = text.index("[rotor]"), text.index("[whole_bearing]")
    bare = tmp_path / "bare.toml"
    bare.write_text(text[:start] + text[end:])
    refused(("bare.toml", "no table [rotor]"), "export", bare, "-o", target)
    refused(("none.toml", "readable TOML"), "export", tmp_path / "none.toml", "-o", target)
    element = save(CubicContact(**CUBIC), tmp_path / "e.json")
    refused(("--contact", "left out"), "export", element, "-o", target, "--contact", element)
    refused(("nothing.json",), "export", STUDY, "-o", target, "--contact", tmp_path / "nothing.json")
    broken = tmp_path / "broken.toml"
    broken.write_text(text.replace("disc_mass = 1.5", "disc_mass = -1.5"))
    refused(("broken.toml", "rotor.disc_mass"), "export", broken, "-o", target)
    assert not target.exists()
    target.write_text("kept")
    refused(("--output", "--force"), "export", STUDY, "-o", target)
    assert target.read_text() == "kept"
