"""The README's way from a bearing to an FMU: its damper is that of the film at the rotor's speed."""

import re
from math import pi
from pathlib import Path
from zipfile import ZipFile

import pytest

from ehlcontact import HarmonicLoad, TimeSteps, impedance, simulate
from ehlcontact.cli.study.forecast import cautions
from ehlcontact.cli.study.schema import load_study
from reduced_models import Atlas, ContactRecord, fit

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def snippet(tmp_path_factory):
    """What the snippet leaves, run as it stands but for the folder."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    code = next(c for c in re.findall(r"```python\n(.*?)```", text, flags=re.S) if "export_contact" in c)
    folder = tmp_path_factory.mktemp("readme")
    found = {}
    exec(code.replace('"contact.fmu"', repr(str(folder / "contact.fmu"))), found)
    found["contact.fmu"] = folder / "contact.fmu"
    return found


def test_it_runs_and_has_the_damping_of_its_speed(snippet, capsys):
    point, si = snippet["point"], snippet["si"]
    answer = Atlas().at(point)
    assert pytest.approx(answer.impedance(rpm=3000).si.damping, rel=1e-6) == si.C1
    assert si.is_valid(si.approach_at(486.0), rpm=3000) and not si.is_valid(si.approach_at(486.0), hz=25e3)
    assert si.design_point.u_sum == pytest.approx(point.u_sum)
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    said = float(re.search(r"that of the rotor's speed, (\d+) N s/m", text)[1])
    assert said == pytest.approx(si.C1, abs=0.5)
    own = Atlas().element(point, "cubic", hz=1.5**0.5 * 2.56 / (2 * pi * point.scales.time))  # that free vibration
    assert 5.0 < si.C1 / own.C1 < 7.0


def test_the_fmu_says_what_it_is_for(snippet):
    """Band, speed and oil: whoever gets the file has neither the element nor the study."""
    si = snippet["si"]
    low, high = (w / (2.0 * pi) for w in si.omega_range)
    with ZipFile(snippet["contact.fmu"]) as archive:
        described = archive.read("modelDescription.xml").decode()
        page = archive.read("documentation/index.html").decode()
    assert f'description="Damping coefficient, for motion of {low:.4g} to {high:.4g} Hz"' in described
    assert f"{low:.4g} to {high:.4g} Hz" in page and "437.4 to 534.6" in page
    assert f"u_sum: {snippet['point'].u_sum:.6g}" in page and "eta0: 0.037" in page


@pytest.mark.slow
def test_the_film_itself_says_the_same(snippet):
    """From the linearised film, and from a simulated record, on grids that a study is not warned of."""
    point, si = snippet["point"], snippet["si"]
    film = impedance(point, rpm=3000)
    assert pytest.approx(float(film.si.damping[0]), rel=0.03) == si.C1
    assert pytest.approx(float(film.si.stiffness[0]), rel=0.01) == si.spring_tangent(si.approach_at(486.0))
    motion = HarmonicLoad.at(point, rpm=3000, amplitude=0.1)
    record = simulate(point, motion, time=TimeSteps(periods=2, steps_per_period=40))
    fitted = fit(ContactRecord.from_result(record), model="cubic").element.to_si(point.scales)
    assert pytest.approx(float(film.si.damping[0]), rel=0.03) == fitted.C1
    assert record.n == load_study(ROOT / "examples" / "deep_groove_6205.toml").solver.n_transient
    assert cautions(load_study(ROOT / "examples" / "deep_groove_6205.toml")) == []
