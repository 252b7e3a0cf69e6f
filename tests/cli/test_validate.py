"""``ehlcontact validate``: what a study will do, without doing it."""

import json
import re
import subprocess
from pathlib import Path

import pytest
from tiny_study import SMALL as ALONE

from ehlcontact.cli.study.forecast import forecast
from ehlcontact.cli.study.points.kept import Kept, stage_key
from ehlcontact.cli.study.schema import load_study
from ehlcontact.cli.study.stages import STAGES, stage_named
from ehlcontact.solver.mesh_choice import Purpose, mesh_for
from reduced_models.elements.film_law import film_drive

EXAMPLES = Path(__file__).parents[2] / "examples"
SMALL, SPINDLE = EXAMPLES / "small_study.toml", EXAMPLES / "spindle.toml"
# Seconds of processor of the stages of both examples; one convolution took 2.3 ms then.
MEASURED = {
    "small_study": {
        "steady": 0.02, "rotor_full": 1.00, "free": 0.42, "harmonic": 0.45, "rotor_band": 0.46,
        "rotor_half_step": 1.27, "decay": 2.13, "decay_half_step": 1.59,
    },
    "deep_groove_6205": {
        "steady": 0.06, "rotor_full": 9.32, "free": 1.47, "harmonic": 3.13, "rotor_band": 1.27,
        "rotor_half_step": 10.3, "decay": 14.2, "decay_half_step": 12.5,
    },
}  # fmt: skip


@pytest.fixture
def plan(call, tmp_path):
    """The document for a study file, or for changes to that of a bearing alone."""

    def run(file=SMALL, **changes):
        if changes:
            text = ALONE
            for old, new in changes.values():
                assert old in text
                text = text.replace(old, new, 1)
            file = tmp_path / "changed.toml"
            file.write_text(text)
        result = call("validate", file, "-o", tmp_path / "none", "--json", "-")
        assert result.code == 0 and result.err == ""
        return json.loads(result.out)

    return run


def test_operating_point_and_meshes(plan):
    found = plan(EXAMPLES / "deep_groove_6205.toml")
    point = found["operating_point"]
    assert point["M"] == pytest.approx(297.5, rel=1e-3) and point["kappa"] == pytest.approx(0.107, rel=1e-2)
    assert point["L"] == pytest.approx(19.0, rel=0.02) and point["p_hertz"] == pytest.approx(0.935e9, rel=1e-2)
    assert point["ball_load"] == pytest.approx(48.72, rel=1e-3)
    assert found["domain"] == [-4.5, 1.5, 3.0] and found["warnings"] == []
    stages = {stage["name"]: stage for stage in found["stages"]}
    assert list(stages) == [stage.name for stage in STAGES]
    assert stages["steady"]["steps"] == 0 and stages["steady"]["nodes"] == 8192
    assert stages["free"]["steps"] == 200 and stages["harmonic"]["steps"] == 240
    assert stages["rotor_full"]["steps"] == 180 and stages["rotor_full"]["contacts"] == 2
    assert stages["rotor_half_step"]["step"] == pytest.approx(stages["rotor_full"]["step"] / 2.0)
    assert stages["rotor_full"]["step"] == pytest.approx(19.0, abs=0.05)
    assert stages["decay"]["steps"] == 320 and stages["decay_half_step"]["steps"] == 640
    assert stages["decay"]["step"] is None  # it follows from the mode
    assert not any(stage["kept"] for stage in found["stages"])


@pytest.mark.parametrize("name", MEASURED)
def test_estimates_are_good_to_a_factor_of_two(monkeypatch, tmp_path, name):
    monkeypatch.setattr("ehlcontact.cli.study.forecast.convolution_seconds", lambda: 2.3e-3)
    found = forecast(load_study(EXAMPLES / f"{name}.toml"), tmp_path, 2)
    for plan in found.plans:
        assert plan.seconds is not None, f"{plan.stage.name} has no cost in forecast.py"
        assert 0.5 < plan.seconds / MEASURED[name][plan.stage.name] < 2.0, plan.stage.name
    assert found.seconds > max(plan.seconds for plan in found.plans)


def test_compilation_is_foreseen(call, monkeypatch, tmp_path):
    """Once for all stages and points, where kernels of these sources are not kept."""
    monkeypatch.setattr("ehlcontact.cli.study.forecast.convolution_seconds", lambda: 2.3e-3)
    study, wait = load_study(SMALL), []
    for kept in (True, False):
        for name in ("is_kept", "solver_is_kept"):
            monkeypatch.setattr(f"ehlcontact.cli.study.forecast.{name}", lambda *_, kept=kept: kept)
        found = forecast(study, tmp_path, 2)
        wait.append(found.seconds)
        assert (found.compiling == 0.0) == kept and found.to_dict()["compiling_seconds"] == found.compiling
    assert wait[1] - wait[0] == pytest.approx(found.compiling, rel=1e-12) and found.compiling > 20.0
    said = call("validate", SMALL, "-o", tmp_path / "none").out
    assert "compiling, once" in said and "results and report" in said
    assert "of it to compile the solver, which later runs need not" in said
    for name in ("is_kept", "solver_is_kept"):
        monkeypatch.setattr(f"ehlcontact.cli.study.forecast.{name}", lambda *_: True)
    assert "compil" not in call("validate", SMALL, "-o", tmp_path / "none").out


def test_a_machine_needs_no_kernels_of_elements(call, monkeypatch, tmp_path):
    """Without [contact] what is not kept of fits is not compiled either, and points have no numbers of a film."""
    monkeypatch.setattr("ehlcontact.cli.study.forecast.is_kept", lambda kernel: kernel is not film_drive)
    assert forecast(load_study(SPINDLE), tmp_path, 2).compiling == 0.0
    assert forecast(load_study(SMALL), tmp_path, 2).compiling > 0.0
    text = SPINDLE.read_text()
    several = tmp_path / "several.toml"
    several.write_text(re.sub(r"(?m)^speed_rpm = ([\d.]+)", r"speed_rpm = [\1, 3000.0]", text, count=1))
    said = call("validate", several, "-o", tmp_path / "none").out
    assert "to do" in said and "kappa" not in said and "kept" not in said


def test_nothing_is_solved(call, monkeypatch, tmp_path):
    for name in ("ehlcontact.steady.solve_steady", "ehlcontact.transient.simulate.simulate"):
        monkeypatch.setattr(name, None)
    monkeypatch.setattr(subprocess, "Popen", None)
    result = call("validate", SMALL, "-o", tmp_path / "none")
    assert result.code == 0 and result.err == "" and not (tmp_path / "none").exists()
    assert "rotor on full contacts" in result.out and "factor of two" in result.out


@pytest.mark.parametrize("rpm", ["1500", "[1500, 2000]"])
def test_layer_and_heat_of_the_bearing_are_said(call, tmp_path, rpm):
    file = tmp_path / "s.toml"
    file.write_text(
        f'[[support]]\nbearing = "6205"\n[oil]\niso_vg = 68\ntemperature = 50.0\n[operation]\n'
        f"radial_load = 200.0\nspeed_rpm = {rpm}\nlayer_um = 2.0\nthermal = true\n"
    )
    said = call("validate", file, "-o", tmp_path / "none").out
    assert "also with heat (thermal) and under a layer of oil, 2 µm on both surfaces together" in said


def test_what_is_finished_is_kept(call, tmp_path):
    """As the runner finds it: in the store, by the inputs of this study."""
    study, folder = load_study(SMALL), tmp_path / "out"
    folder.mkdir()
    entry = {"status": "converged", "message": "", "seconds": 1.0}
    Kept(folder).put(stage_key(stage_named("steady"), study), entry)
    found = forecast(study, folder, 2)
    assert [plan.stage.name for plan in found.plans if plan.kept] == ["steady"]
    assert "kept" in call("validate", SMALL, "-o", folder).out
    whole = forecast(study, tmp_path / "none", 1)
    assert not any(plan.kept for plan in whole.plans)


def test_grids_too_coarse_for_the_inlet_warn(plan):
    """The film that the example file itself warns of: n = 64 at 1000 N."""
    found = plan(load=("radial_load = 70.0", "radial_load = 1000.0"))
    texts = found["warnings"]
    assert [text.split(" = ")[0] for text in texts] == ["contact.n", "contact.n_transient"]
    wanted = mesh_for(load_study(EXAMPLES / "deep_groove_6205.toml").point.moes, Purpose.RUN).n
    assert all(f"= {wanted}" in text and "too coarse" in text for text in texts)


def test_regions_and_numbers_beyond_the_range_warn(plan):
    light = plan(load=("radial_load = 70.0", "radial_load = 2.0"))["warnings"]
    assert any(text.startswith("contact.domain = ") and "wants" in text for text in light)
    thick = plan(eta0=("eta0 = 0.0367", "eta0 = 0.2"), load=("radial_load = 70.0", "radial_load = 1000.0"))[
        "warnings"
    ]
    assert any("L = " in text and "measured between 0 and 25" in text for text in thick)
