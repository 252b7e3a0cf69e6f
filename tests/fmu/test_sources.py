"""The C sources without fmpy in between: clean under strict warnings and sanitizers."""

import re
import shutil
import subprocess
import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.build import build_platform_binary

from fmu import verify
from fmu.comparison import film_motion, state_grid
from fmu.sources import CSRC

STRICT = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Wshadow", "-Wconversion", "-Wsign-conversion", "-Werror"]
SANITIZE = ["-g", "-O1", "-fsanitize=address,undefined,float-divide-by-zero", "-fno-sanitize-recover=all"]
DRIVER = Path(__file__).parent / "driver.c"


@pytest.fixture(scope="module")
def compiler() -> str:
    """A system compiler: zig brings no sanitizer runtime."""
    for name in ("gcc", "clang", "cc"):
        if shutil.which(name):
            return name
    pytest.skip("no system C compiler")


@pytest.fixture
def sources(extracted, any_kind) -> tuple[list[str], Path]:
    """C files and folder of an exported FMU."""
    folder = Path(extracted[any_kind]) / "sources"
    return sorted(str(path) for path in folder.glob("*.c")), folder


def run(line, **options):
    return subprocess.run([str(part) for part in line], capture_output=True, text=True, timeout=120, **options)


def test_sources_are_clean_under_strict_warnings(compiler, sources, tmp_path):
    files, _ = sources
    done = run([compiler, *STRICT, "-O2", "-fPIC", "-shared", *files, "-lm", "-o", tmp_path / "x.so"])
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""


def test_driver_under_sanitizers_agrees_with_python(compiler, sources, elements, any_kind, tmp_path):
    files, folder = sources
    probe = tmp_path / "probe.c"
    probe.write_text("int main(void) { return 0; }\n")
    if run([compiler, *SANITIZE, probe, "-o", tmp_path / "probe"]).returncode != 0:
        pytest.skip("no sanitizer runtime")
    line = [compiler, *STRICT, *SANITIZE, "-ffp-contract=off", "-I", folder, DRIVER, *files, "-lm"]
    built = run([*line, "-o", tmp_path / "driver"])
    assert built.returncode == 0, built.stderr
    element = elements[any_kind]
    h, u, v, expected, scales = wanted(element)
    text = "".join(f"{a!r} {b!r} {c!r}\n" for a, b, c in zip(h.tolist(), u.tolist(), v.tolist(), strict=True))
    done = run([tmp_path / "driver"], input=text)
    assert done.returncode == 0, done.stderr
    found = np.array(done.stdout.split(), dtype=float).reshape(-1, 3)
    assert found.shape == (u.size, 3)
    for k, (values, scale) in enumerate(zip(expected, scales, strict=True)):  # of a film the force alone
        assert np.allclose(found[:, k], values, rtol=1e-12, atol=1e-15 * scale)


def wanted(element):
    """Steps, approaches and rates; what an element says to each, and the size of it."""
    if element.state_count:
        T, u, v = film_motion(element)
        # from where the driver begins: at rest under the reference load
        T, u, v = np.append(-T[1], T), np.append(element.approach_at(element._units[0]), u), np.append(0.0, v)
        return np.diff(T), u[1:], v[1:], [element.drive(T, u, v)[1:]], [element._units[0]]
    u, v = state_grid(element)
    functions = (element.force, element.stiffness, element.damping)
    scales = element.step_tangents(1.0, element.high, 0.0)
    return np.full(u.size, 1e-3), u, v, [function(u, v) for function in functions], scales


def test_sources_in_the_fmu_build_by_cmake(fmus, elements, kind, tmp_path):
    if shutil.which("cmake") is None:
        pytest.skip("no cmake")
    folder, build = tmp_path / "fmu", tmp_path / "build"
    build.mkdir()
    fmpy.extract(str(fmus[kind]), unzipdir=str(folder))
    (library,) = (folder / "binaries" / "linux64").iterdir()
    library.unlink()
    build_platform_binary(folder, build_dir=build)
    assert library.is_file()
    rebuilt = tmp_path / "rebuilt.fmu"
    with zipfile.ZipFile(rebuilt, "w") as archive:
        for path in folder.rglob("*"):
            archive.write(path, path.relative_to(folder))
    assert verify(rebuilt, elements[kind]).passes


def test_library_exports_fmi_and_nothing_else(extracted):
    if shutil.which("nm") is None:
        pytest.skip("no nm")
    (library,) = (Path(extracted["cubic"]) / "binaries" / "linux64").iterdir()
    lines = run(["nm", "-D", "--defined-only", library], check=True).stdout.splitlines()
    exported = {line.split()[-1] for line in lines}
    header = (CSRC / "fmi2" / "fmi2Functions.h").read_text()
    declared = set(re.findall(r"FMI2_Export\s+fmi2\w+TYPE\s+(fmi2\w+);", header))
    assert len(declared) == 44
    assert {name for name in exported if not name.startswith("_")} == declared


def test_sources_are_ascii_and_short():
    for path in CSRC.rglob("*.[ch]"):
        text = path.read_bytes().decode("ascii")
        assert "\t" not in text
        assert path.parent.name in ("fmi2", "fmi3") or len(text.splitlines()) <= 400  # or not ours
