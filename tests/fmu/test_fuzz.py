"""Random calls of the C sources under sanitizers, and all of it under valgrind.

A call that fails changes nothing, and OK never comes with a number that is not finite.
"""

import shutil
import subprocess
from pathlib import Path

import pytest

from fmu.contacts import contact_spec
from fmu.export import content_guid
from fmu.sources import source_files

SANITIZE = ["-g", "-O1", "-fsanitize=address,undefined,float-divide-by-zero", "-fno-sanitize-recover=all"]
KINDS = ["cubic", "polynomial", "power_si", "wide_si", "memory"]
FUZZ = {2: "fuzz.c", 3: "fuzz3.c"}
MANY = 1_250_000  # calls of each version of FMI, over all kinds
FEW = 20_000  # of each kind, in the default suite
UNDER_VALGRIND = 2_000  # of each kind: it is some fifty times slower


@pytest.fixture(scope="module")
def compiler() -> str:
    """A system compiler: zig brings no sanitizer runtime."""
    for name in ("gcc", "clang", "cc"):
        if shutil.which(name):
            return name
    pytest.skip("no system C compiler")


@pytest.fixture
def compiled(compiler, elements, tmp_path):
    """Compile a program of this folder with the sources of an FMU."""

    def make(kind: str, fmi: int, program: str, flags: list[str]) -> Path:
        spec = contact_spec(elements[kind])
        folder = tmp_path / f"{kind}{fmi}"
        folder.mkdir()
        for name, content in source_files(spec, content_guid(spec, fmi), fmi).items():
            (folder / name).write_bytes(content)
        made = folder / "program"
        line = [compiler, "-std=c99", *flags, "-ffp-contract=off", "-I", folder, Path(__file__).with_name(program)]
        built = run([*line, *sorted(folder.glob("*.c")), "-lm", "-o", made])
        if built.returncode != 0 and "sanitize" in built.stderr:
            pytest.skip("no sanitizer runtime")
        assert built.returncode == 0, built.stderr
        return made

    return make


def run(line, **options):
    return subprocess.run([str(part) for part in line], capture_output=True, text=True, timeout=1000, **options)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("fmi", [2, 3])
def test_random_calls_under_sanitizers(compiled, fmi, kind):
    done = run([compiled(kind, fmi, FUZZ[fmi], SANITIZE), FEW, 1])
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("fmi", [2, 3])
def test_a_million_random_calls_under_sanitizers(compiled, fmi, kind):
    program = compiled(kind, fmi, FUZZ[fmi], SANITIZE)
    for seed in (2, 3):
        done = run([program, MANY // len(KINDS) // 2, seed])
        assert done.returncode == 0, done.stderr


@pytest.fixture
def valgrind() -> list[str]:
    """The command; a leak, or a use of memory that holds nothing, ends with its exit code."""
    program = shutil.which("valgrind")
    if program is None:
        pytest.skip("valgrind is not installed")
    return [program, "--quiet", "--error-exitcode=99", "--leak-check=full", "--errors-for-leak-kinds=all"]


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("fmi", [2, 3])
def test_random_calls_under_valgrind(compiled, valgrind, fmi, kind):
    done = run([*valgrind, compiled(kind, fmi, FUZZ[fmi], ["-g", "-O1"]), UNDER_VALGRIND, 4])
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["cubic", "wide_si"])
def test_driver_under_valgrind(compiled, valgrind, elements, kind):
    u = contact_spec(elements[kind])["approach"].start
    done = run([*valgrind, compiled(kind, 2, "driver.c", ["-g", "-O1"])], input=f"1e-6 {u!r} 0.0\n")
    assert (done.returncode, done.stderr) == (0, "")
    assert len(done.stdout.split()) == 3


def test_valgrind_sees_what_is_wrong(compiler, valgrind, tmp_path):
    """A leak and a number that was never written."""
    for k, body in enumerate(("return malloc(8) == NULL;", 'int x[2]; return x[1] == 3 ? puts("") : 0;')):
        source, program = tmp_path / f"{k}.c", tmp_path / f"{k}"
        source.write_text(f"#include <stdio.h>\n#include <stdlib.h>\nint main(void) {{ {body} }}\n")
        run([compiler, "-O0", source, "-o", program], check=True)
        assert run([*valgrind, program]).returncode == 99
