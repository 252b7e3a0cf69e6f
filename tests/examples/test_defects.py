"""Studies of spalls: what they print is that of the documentation, on coarser grids and shorter runs."""

import numpy as np
import pytest
from programs import script

from ehlcontact import MoesPoint

PNG = b"\x89PNG"


@pytest.mark.long
def test_bearing_with_a_spall(tmp_path, monkeypatch, capsys):
    """The bare step has several times the force above 5 kHz; the ball loses load at the edge of the spall."""
    study = script("examples/studies/spalled_bearing.py")
    monkeypatch.setattr(study, "UNTIL", 0.05)
    monkeypatch.setattr(study, "SETTLED", 0.01)
    length = study.LENGTHS[1]
    filtered, bare = (
        study.run(one, length) for one in (study.spalled(length), study.without_filter(study.spalled(length)))
    )
    hz, lines = study.spectrum(filtered)
    high = (hz > 5.0) & (hz < 20.0)
    assert np.hypot.reduce(study.spectrum(bare)[1][high]) > 4.0 * np.hypot.reduce(lines[high])
    enters = filtered.passages[filtered.passages[:, 0] > study.SETTLED][0, 0]
    before, after = (-np.interp(enters + dt, filtered.t, filtered.force) for dt in (-1e-4, 1e-4))
    assert after < before - 100.0
    path = tmp_path / "spall.png"
    study.draw({one: (filtered, bare) for one in study.LENGTHS}, str(path))
    assert path.read_bytes().startswith(PNG) and capsys.readouterr().out == ""


@pytest.mark.slow
def test_spall_in_a_full_film(tmp_path, monkeypatch, capsys):
    """Heights filtered with the film come nearer to the full film than dry ones, and those than bare ones."""
    study = script("examples/studies/spall_passage.py")
    monkeypatch.setattr(study, "CASES", ((MoesPoint(200, 10, 0.5), 0.2), (MoesPoint(200, 10, 0.5), 0.5)))
    path = tmp_path / "passage.png"
    monkeypatch.setattr("sys.argv", ["spall_passage.py", str(path), "--n", "64"])
    study.main()
    assert path.read_bytes().startswith(PNG) and "200" in capsys.readouterr().out
    for point, depth in study.CASES:
        one = study.passage(point, depth, 64)
        change = np.abs(one.full - 1.0).max()
        off = {
            name: np.sqrt(np.mean((getattr(one, name) - one.full) ** 2)) / change
            for name in ("linear", "filtered", "with_film", "bare")
        }
        assert off["with_film"] < 0.015 and 0.02 < off["filtered"] < 0.04 and off["bare"] > 0.09
        assert off["linear"] < (0.04 if depth < 0.3 else 0.1)


@pytest.mark.slow
def test_spall_on_a_full_film_in_a_rotor(tmp_path, monkeypatch, capsys):
    """The table of the documentation, with its grid."""
    study = script("examples/studies/full_film_spall.py")
    path = tmp_path / "passage.png"
    monkeypatch.setattr("sys.argv", ["full_film_spall.py", str(path)])
    study.main()
    assert path.read_bytes().startswith(PNG)
    printed = dict(line.split(": ") for line in capsys.readouterr().out.splitlines() if line.endswith("%"))
    wanted = {
        "contact force over its static value": 0.65,
        "contact force over its range": 1.65,
        "force of the bearing over its static value": 0.33,
        "force of the bearing over its range": 1.3,
        "displacement over its static value": 0.07,
        "displacement over its range": 0.6,
        "with the dry filter, contact force over its static value": 2.3,
        "with the dry filter, contact force over its range": 5.9,
        "with the dry filter, force of the bearing over its static value": 1.25,
        "with the dry filter, force of the bearing over its range": 4.9,
        "with the dry filter, displacement over its static value": 0.08,
        "with the dry filter, displacement over its range": 0.75,
    }
    assert {name: float(value.split()[0]) for name, value in printed.items()} == pytest.approx(wanted, abs=0.1)
