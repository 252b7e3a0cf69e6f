"""Binaries in a C program without Python: on this machine, on Linux on arm, on Windows.

Linux on arm by qemu-aarch64: with its C library (Debian's libc6-arm64-cross, or QEMU_LD_PREFIX) the library of the
FMU is loaded; without it, its sources and musl are linked with the program.
"""

import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from bearing_fmus import MODELS

from ehlcontact.binaries import PLATFORMS, build_binaries, this_machine
from ehlcontact.binaries.compiler import compilers
from fmu.archive import content_guid
from fmu.bearing.trial import bearing_trial
from fmu.bearing.variables import RATES, bearing_spec
from fmu.contact_spec import contact_spec
from fmu.references.contact_references import film_motion
from fmu.sources import compiled, source_files, standard_folder
from reduced_models.bearing.race import RACES

OWN = this_machine()
LOADER = Path(__file__).parent / "loader.c"
KINDS = ("cubic", "cubic_si", "wide", "wide_si")
HERE = ["cubic", *(pytest.param(kind, marks=pytest.mark.long) for kind in KINDS[1:])]
pytestmark = [
    pytest.mark.filterwarnings("ignore:the first library for Windows"),
    pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning"),  # of references, on purpose
]


def outputs_on(platform, spec, folder, start, knowns, unknowns, linked=False):
    """Outputs by name after each step of a C program for a platform, along inputs over "time".

    ``start(program)`` starts a program of that platform, with `folder` as the working directory; `linked` links
    sources with the program, in place of a library that it loads.
    """
    guid = content_guid(spec)
    sources, units = source_files(spec, guid), compiled(spec, 2)
    folder.mkdir(parents=True)
    path = folder / f"x{platform.suffix}"
    if linked:
        for name, content in sources.items():
            (folder / name).write_bytes(content)
    else:
        path.write_bytes(*build_binaries(sources, units, spec.identifier, [platform], fmi=3)[0].values())
    given = [name for name in knowns if name != "time"]
    references = [str(spec[name].value_reference) for name in ("lead", *given, *unknowns)]
    program = built_loader(folder, platform, units if linked else ())
    rows = zip(*(knowns[name].tolist() for name in ("time", *given)), strict=True)
    done = subprocess.run(
        [*start(program), f"./{path.name}", guid, str(len(given)), *references],
        input="".join(" ".join(map(repr, row)) + "\n" for row in rows),
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
        cwd=folder,
    )
    assert done.returncode == 0, done.stderr
    found = np.array([[float.fromhex(x) for x in row.split()] for row in done.stdout.splitlines()])
    assert found.shape == (knowns["time"].size - 1, len(unknowns))
    return dict(zip(unknowns, found.T, strict=True))


def check_element(platform, element, folder, *how):
    """Step an element on a platform and compare every force with that in Python."""
    T, u, v = motion(element)
    knowns = {"time": T, "approach": u, "rate": v}
    found = outputs_on(platform, contact_spec(element), folder, *how[:1], knowns, ("force",), *how[1:])
    assert_right(element, found["force"], T, u, v)


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


def built_loader(folder, platform, units):
    """The C program for a platform, as a file; linked with these sources of the folder, if any."""
    own = platform is OWN and shutil.which("cc")
    target = platform.target.split("-gnu")[0] + "-musl" if units else None
    command = ("cc",) if own else compilers(platform)[-1].command
    if target is not None:
        command = [target if part == platform.target else part for part in command]
    program = folder / ("loader.exe" if platform.system == "windows" else "loader")
    line = [*command, "-std=c99", "-O1", "-I", standard_folder(), LOADER, "-o", program]
    if units:
        line += ["-static", "-DLINKED", "-ffp-contract=off", *(folder / unit for unit in units), "-lm"]
    else:
        line += ["-Wall", "-Wextra", "-Werror", *([] if platform.system == "windows" else ["-ldl"])]
    done = subprocess.run([str(part) for part in line], capture_output=True, text=True, check=False, timeout=600)
    assert done.returncode == 0, done.stderr
    return program


def on_this_machine():
    """How a program of this machine is started."""
    return (lambda program: [program],)


def on_arm(tmp_path_factory):
    """How a program of Linux on arm is started, and whether sources have to be linked with it."""
    emulator = shutil.which("qemu-aarch64") or shutil.which("qemu-aarch64-static")
    if emulator is None:
        pytest.skip("no package qemu-user")
    root = Path(os.environ.get("QEMU_LD_PREFIX", "/usr/aarch64-linux-gnu"))
    return lambda program: [emulator, "-L", root, program], not root.is_dir()


def on_windows(tmp_path_factory):
    """How a program of Windows is started."""
    wine = next(filter(None, map(shutil.which, ("wine64", "wine", "wine64-stable"))), None)
    if wine is None:
        pytest.skip("no package wine64")
    prefix = tmp_path_factory.getbasetemp() / "wine"
    return (lambda program: ["env", f"WINEPREFIX={prefix}", "WINEDEBUG=-all", wine, program.name],)


OTHERS = {"aarch64-linux": on_arm, "x86_64-windows": on_windows}


@pytest.fixture(params=KINDS)
def element(request, elements):
    return elements[request.param]


@pytest.mark.skipif(OWN.system == "windows", reason="the next one is this machine's there")
@pytest.mark.parametrize("element", HERE, indirect=True)
def test_on_this_machine(element, tmp_path):
    check_element(OWN, element, tmp_path / "mit Leerzeichen und Umläuten ß", *on_this_machine())


@pytest.mark.slow
@pytest.mark.parametrize("name", OTHERS)
def test_on_another_machine(name, element, tmp_path, tmp_path_factory):
    check_element(PLATFORMS[name], element, tmp_path / "x", *OTHERS[name](tmp_path_factory))


@pytest.mark.slow
@pytest.mark.skipif(OWN.system == "windows", reason="compares with Linux")
@pytest.mark.parametrize("bearing", ("planar", "range", "five", "shared"))
@pytest.mark.parametrize("name", OTHERS)
def test_bearings_between_machines(name, bearing, tmp_path, tmp_path_factory):
    how = OTHERS[name](tmp_path_factory)
    model = MODELS[bearing]()
    spec, trial = bearing_spec(model), bearing_trial(model, seed=3)
    rates = [RATES[axis] for axis in model.directions]
    moved = np.hstack([trial.place, trial.velocity]).T
    knowns = {"time": trial.time, "speed": trial.speed} | dict(
        zip((*model.directions, *rates), moved, strict=True)
    )
    outputs = [one.name for one in spec.outputs if one.type == "Real"]
    outputs += [f"ball[{k}].{what}_{race}" for k in (1, 2) for what in ("load", "film") for race in RACES]
    assert (trial.balls[:, :, 0] == 0.0).any()  # balls part from the ring
    here = outputs_on(OWN, spec, tmp_path / "here", *on_this_machine(), knowns, outputs)
    there = outputs_on(PLATFORMS[name], spec, tmp_path / "there", how[0], knowns, outputs, *how[1:])
    gaps = {axis: np.abs(there[axis] - here[axis]).max() / np.abs(here[axis]).max() for axis in outputs}
    print(name, bearing, max(gaps.values()), max(gaps, key=gaps.get))  # the figures of docs/notes/coupling.md
    assert max(gaps.values()) <= 1e-10
