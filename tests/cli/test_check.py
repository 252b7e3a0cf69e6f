"""half_step of a study: without it nothing is solved twice, and no output mentions it.

Nor does a compiler that cannot be started cost more than the FMUs.
"""

import contextlib
import io
import json
import shutil

import pytest

from ehlcontact.cli import main
from ehlcontact.cli.study.forecast import forecast
from ehlcontact.cli.study.points.kept import stage_key
from ehlcontact.cli.study.schema import load_study
from ehlcontact.cli.study.stages import STAGES, stage_named, stages_of

HALF_STEP = ("rotor_half_step", "decay_half_step")


@pytest.fixture(scope="module")
def unchecked(finished, tmp_path_factory):
    """The tiny study without half the step, and folder and stderr of its run, which finds its stages in a copy.

    There is no C compiler.
    """
    root = tmp_path_factory.mktemp("unchecked")
    file, folder = root / "tiny.toml", root / "out"
    file.write_text(finished[0].read_text().replace("half_step = true\n", ""))
    shutil.copytree(finished[1], folder)
    for name in HALF_STEP:
        (folder / f"{name}.h5").unlink()
        (folder / "store" / stage_key(stage_named(name), load_study(finished[0]))).unlink()
    said = io.StringIO()
    with (
        pytest.raises(SystemExit) as stop,
        contextlib.redirect_stderr(said),
        pytest.MonkeyPatch.context() as patch,
    ):
        patch.setenv("EHLCONTACT_CC", "/none/cc")
        main(["run", str(file), "-o", str(folder), "--force"])
    assert stop.value.code == 1
    return file, folder, said.getvalue()


@pytest.mark.long
def test_a_study_without_its_fmus_has_all_the_rest(unchecked):
    _, folder, said = unchecked
    assert "Traceback" not in said
    for name, line in zip(("contact.fmu", "contact_film.fmu"), said.splitlines()[-2:], strict=True):
        assert f"{name}: cannot start the C compiler /none/cc" in line
    results = json.loads((folder / "results.json").read_text())
    assert results["fmu"]["passes"] is False and "/none/cc" in results["fmu"]["error"]
    assert (folder / "report.html").is_file()


@pytest.mark.long
def test_stages_of_the_check_are_opt_in(finished, unchecked):
    names = [stage.name for stage in STAGES]
    assert [stage.name for stage in stages_of(load_study(finished[0]))] == names
    study = load_study(unchecked[0])
    assert [stage.name for stage in stages_of(study)] == [name for name in names if name not in HALF_STEP]
    plans = {plan.stage.name for plan in forecast(study, unchecked[1], 2).plans}
    assert plans == set(names) - set(HALF_STEP)


@pytest.mark.long
def test_results_of_a_study_without_a_check(finished, unchecked):
    """Its numbers are those of the study with the check, whose stages it keeps."""
    folder = unchecked[1]
    assert not any((folder / f"{name}.h5").exists() for name in HALF_STEP)
    own, checked = (json.loads((path / "results.json").read_text()) for path in (folder, finished[1]))
    for name in ("half_step", "step_full", "step_reduced"):
        assert name in checked["rotor"] and name not in own["rotor"]
    assert "half_step" in checked["rotor"]["decay"] and "half_step" not in own["rotor"]["decay"]
    assert own["rotor"]["whole"] == checked["rotor"]["whole"] and own["fits"] == checked["fits"]
    texts = [(folder / name).read_text() for name in ("report.html", "results.json", "summary.json")]
    texts = [texts[0].partition("<script")[0], *texts[1:]]
    assert not any(word in text.lower() for text in texts for word in ("half the step", "half_step", "half step"))
    assert "half the step" in (finished[1] / "report.html").read_text()


@pytest.mark.long
def test_a_check_that_is_switched_on_later_is_all_that_is_solved(finished, unchecked):
    plans = forecast(load_study(finished[0]), unchecked[1], 2).plans
    assert {plan.stage.name for plan in plans if not plan.kept} == set(HALF_STEP)
