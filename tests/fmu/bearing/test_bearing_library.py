"""The C library of bearings by itself: slopes of a step, sizes, random bearings and motions under sanitizers."""

import shutil
import subprocess
from pathlib import Path

import pytest
from bearing_fmus import MODELS

from fmu.bearing.tables import bearing_table
from fmu.bearing.variables import BEARING_SOURCES
from reduced_models.core import CSRC

HERE, MODEL_SOURCES = Path(__file__).parent, CSRC
FLAGS = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-ffp-contract=off", "-I", MODEL_SOURCES]


def built(folder, source, table, *flags):
    """A program of the tests with a bearing in ``bearing_data.h``."""
    compiler = next((name for name in ("gcc", "clang", "cc") if shutil.which(name)), None)
    if compiler is None:
        pytest.skip("no system C compiler")
    (folder / "bearing_data.h").write_text(table)
    program = folder / "program"
    sources = [HERE / source, *(MODEL_SOURCES / name for name in BEARING_SOURCES)]
    line = [compiler, *FLAGS, *flags, "-I", folder, *sources, "-lm", "-o", program]
    made = subprocess.run(line, capture_output=True, text=True)
    if made.returncode != 0 and "sanitize" in made.stderr:
        pytest.skip("no sanitizer runtime")
    assert made.returncode == 0, made.stderr
    return program


ALL = "1e-6,-2e-6,8e-6,0.0,0.0"


# Slopes of centrifugal force and gyroscopic moment, where contact angles vary, are those of up to 16 steps before
@pytest.mark.parametrize(
    ("name", "speed", "clearance", "start", "within"),
    [
        ("lossy", 600.0, 5e-6, "1e-6,-6e-6", 1e-7),
        ("planar", 600.0, 5e-6, "1e-6,-6e-6", 1e-7),
        ("five", 6.0, 5e-6, ALL, 1e-7),
        ("five", 600.0, 5e-6, ALL, 3e-4),
        ("shared", 6.0, 0.0, ALL, 1e-7),
    ],
)
def test_slopes_of_a_step(name, speed, clearance, start, within, tmp_path):
    """Beside differences of the force, balls and films following: what Newton's method iterates with."""
    given = {"SPEED": speed, "CLEARANCE": clearance, "START": start}
    macros = (f"-D{macro}={text}" for macro, text in given.items())
    program = built(tmp_path, "slopes.c", bearing_table(MODELS[name]()), "-O1", *macros)
    found = subprocess.run([program], check=True, capture_output=True, text=True).stdout.split()
    assert len(found) == 2 and max(map(float, found)) < within


SANITIZE = ["-g", "-O1", "-fsanitize=address,undefined,float-divide-by-zero", "-fno-sanitize-recover=all"]


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
@pytest.mark.parametrize(
    ("name", "steps"),
    [
        ("lossy", 2000),
        *(pytest.param(name, 8000, marks=pytest.mark.long) for name in ("range", "angular")),
        *(
            pytest.param(name, 100_000, marks=pytest.mark.slow)
            for name in ("lossy", "thin five", "five dry", "angular")
        ),
    ],
)
def test_random_bearings_under_sanitizers(name, steps, tmp_path):
    """No number that is not finite without a reason; only steps of rings without a velocity are refused."""
    program = built(tmp_path, "fuzz_steps.c", bearing_table(MODELS[name]()), *SANITIZE)
    done = subprocess.run([program, str(steps), "3"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    made, refused, parted = map(int, done.stdout.split())
    assert made == steps and parted > steps / 500 and refused == 0
