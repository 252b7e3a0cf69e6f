"""The C sources of rotors: clean under strict warnings, under sanitizers, and in other programs' eyes."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from fmpy.validation import validate_fmu

from fmu.rotor.laws import distinct, law_source

pytestmark = pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
STRICT = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Wshadow", "-Wconversion", "-Wsign-conversion", "-Werror"]
SANITIZE = ["-g", "-O1", "-fsanitize=address,undefined,float-divide-by-zero", "-fno-sanitize-recover=all"]
FUZZ = Path(__file__).parents[1] / "fuzz.c"
KINDS = ["alone", "mixed", "wide in y"]


@pytest.fixture(scope="module")
def compiler() -> str:
    for name in ("gcc", "clang", "cc"):
        if shutil.which(name):
            return name
    pytest.skip("no system C compiler")


def run(line):
    return subprocess.run([str(part) for part in line], capture_output=True, text=True, timeout=200, check=False)


@pytest.mark.parametrize("name", [*KINDS, "alone in y", "cubic"])
def test_sources_are_clean_under_strict_warnings(compiler, unit, name, tmp_path):
    files = sorted((Path(unit(name).folder) / "sources").glob("*.c"))
    done = run([compiler, *STRICT, "-O2", "-fPIC", "-shared", *files, "-lm", "-o", tmp_path / "x.so"])
    assert done.returncode == 0 and done.stderr == "", done.stderr


@pytest.mark.parametrize("name", KINDS)
def test_random_calls_under_sanitizers(compiler, unit, name, tmp_path):
    """A call that fails changes nothing, and OK never comes with a number that is not finite."""
    folder = Path(unit(name).folder) / "sources"
    first = "FIRST_STATE+4*AXES" if name.startswith("alone") else "FIRST_FORCE"  # the angle, or a force
    given = {"INPUTS": "0,1", "OUTPUTS": f"{first},FIRST_APPROACH,FIRST_RATE", "USUAL": "1e3", "STEP": "1e-8"}
    macros = [f"-DFUZZ_{macro}={text}" for macro, text in given.items()]
    options = ["-std=c99", *SANITIZE, "-ffp-contract=off", *macros, "-I", folder]
    line = [compiler, *options, FUZZ, *sorted(folder.glob("*.c"))]
    built = run([*line, "-lm", "-o", tmp_path / "fuzz"])
    if built.returncode != 0 and "sanitize" in built.stderr:
        pytest.skip("no sanitizer runtime")
    assert built.returncode == 0, built.stderr
    done = run([tmp_path / "fuzz", 40000, 1])
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("name", KINDS)
def test_others_have_nothing_to_say(unit, name, fmi):
    path = unit(name, fmi).path
    assert validate_fmu(str(path)) == []
    pytest.importorskip("fmu_manipulation_toolbox")
    done = run([Path(sys.executable).with_name("fmutool"), "-input", path, "-check"])
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    assert f"compliant with FMI-{fmi}.0" in said and "No semantic error" in said
    assert "WARNING" not in said and "ERROR" not in said


def test_equal_contacts_share_a_law(rotors):
    wide, mixed = rotors["wide"].elements, rotors["mixed"].elements
    assert [len(distinct(elements)[0]) for elements in (wide, mixed)] == [1, 2]
    assert distinct((*mixed, *wide))[1] == [0, 1, 0, 0]
    text = law_source(wide[0], "law_of_a_ball")
    assert "#define model_step law_of_a_ball_model_step" in text and '#include "' not in text
