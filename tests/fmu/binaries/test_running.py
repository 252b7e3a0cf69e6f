"""Binaries in a C program that knows nothing of Python: on this machine, on Linux on arm, on Windows."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from fmu.archive import content_guid
from fmu.binaries import PLATFORMS, build_binaries, this_machine
from fmu.binaries.compiler import compilers
from fmu.comparison import film_motion
from fmu.contact_spec import contact_spec
from fmu.sources import compiled, source_files, standard_folder

OWN = this_machine()
LOADER = Path(__file__).parent / "loader.c"
KINDS = ("cubic", "cubic_si", "wide", "wide_si")
pytestmark = pytest.mark.filterwarnings("ignore:the first library for Windows")


def run_on(platform, element, folder, command):
    """Compile an element for a platform, step it in the C program there and compare every force.

    ``command(program)`` starts a program of that platform, with `folder` as the working directory.
    """
    spec = contact_spec(element)
    sources = source_files(spec, content_guid(spec))
    (library,) = build_binaries(sources, compiled(spec, 2), spec.identifier, [platform], fmi=3)[0].values()
    folder.mkdir()
    path = folder / f"x{platform.suffix}"
    path.write_bytes(library)
    names = ("approach", "rate", "force", "stiffness", "damping", "lead")
    references = [str(spec[name].value_reference) for name in names]
    T, u, v = motion(element)
    done = subprocess.run(
        [*command(built_loader(folder, platform)), f"./{path.name}", content_guid(spec), *references],
        input="".join(f"{t!r} {a!r} {b!r}\n" for t, a, b in zip(T.tolist(), u.tolist(), v.tolist(), strict=True)),
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
        cwd=folder,
    )
    assert done.returncode == 0, done.stderr
    found = np.array([[float.fromhex(x) for x in row.split()] for row in done.stdout.splitlines()])
    assert found.shape == (T.size - 1, 3)
    assert_right(element, found[:, 0], T, u, v)


def motion(element):
    """Times and motion: that of `verify` for films, with lift-off and a pulse; any states for springs."""
    if element.state_count:
        return film_motion(element)
    length = element.high - element.low
    u, v = np.meshgrid(element.low + length * np.linspace(-5.0, 3.0, 57), np.linspace(-1.0, 0.4, 25))
    v = v * element.force(element.high, 0.0) / element.damping(element.high, 0.0)
    return np.arange(u.size, dtype=float), u.ravel(), v.ravel()


def assert_right(element, force, T, u, v):
    """Within rounding, of the force or of a thousandth of a usual one; contact and lift-off are both met."""
    expected = element.drive(T, u, v) if element.state_count else element.force(u, v)
    usual = element.spring(0.5 * (element.low + element.high))
    assert (expected[1:] == 0.0).any() and (expected[1:] > usual).any()
    error = np.abs(force - expected[1:]) / np.maximum(expected[1:], 1e-3 * usual)
    assert error.max() <= 1e-12


def built_loader(folder, platform):
    """The C program for a platform, as a file."""
    own = platform is OWN and shutil.which("cc")
    command = ("cc",) if own else compilers(platform)[-1].command
    program = folder / ("loader.exe" if platform.system == "windows" else "loader")
    line = [*command, "-std=c99", "-O1", "-Wall", "-Wextra", "-Werror", "-I", standard_folder(), LOADER]
    line += ["-o", program]
    line += [] if platform.system == "windows" else ["-ldl"]
    done = subprocess.run([str(part) for part in line], capture_output=True, text=True, check=False, timeout=600)
    assert done.returncode == 0, done.stderr
    return program


@pytest.fixture(params=KINDS)
def element(request, elements):
    return elements[request.param]


@pytest.mark.skipif(OWN.system == "windows", reason="the next but one is this machine's there")
def test_on_this_machine(element, tmp_path):
    run_on(OWN, element, tmp_path / "mit Leerzeichen und Umläuten ß", lambda program: [program])


@pytest.mark.slow
def test_on_linux_on_arm(element, tmp_path):
    emulator, root = shutil.which("qemu-aarch64-static"), Path("/usr/aarch64-linux-gnu")
    if emulator is None or not root.is_dir():
        pytest.skip("no packages qemu-user-static and libc6-arm64-cross")
    run_on(PLATFORMS["aarch64-linux"], element, tmp_path / "x", lambda program: [emulator, "-L", root, program])


@pytest.mark.slow
def test_on_windows(element, tmp_path, tmp_path_factory, monkeypatch):
    wine = next(filter(None, map(shutil.which, ("wine64", "wine", "wine64-stable"))), None)
    if wine is None:
        pytest.skip("no package wine64")
    monkeypatch.setenv("WINEPREFIX", str(tmp_path_factory.getbasetemp() / "wine"))
    monkeypatch.setenv("WINEDEBUG", "-all")
    run_on(PLATFORMS["x86_64-windows"], element, tmp_path / "x", lambda program: [wine, program.name])
