"""The library of every platform, read where it cannot be run: what it is for, offers, needs, and gives away."""

import os
import re
import shutil
import subprocess
import sys
import threading
import zipfile
from pathlib import Path

import fmpy
import pytest
from library_contents import contents
from programs import shell_script

from ehlcontact import InputError
from ehlcontact.binaries import (
    PLATFORMS,
    BuildError,
    build_binaries,
    build_module,
    choose,
    libraries,
    read_library,
    this_machine,
)
from ehlcontact.binaries.compiler import Compiler, compilers
from fmu import export
from fmu.archive import content_guid
from fmu.contact_spec import contact_spec
from fmu.sources import FMI_FILES, compiled, source_files, standard_headers
from reduced_models import SpringContact

OWN = this_machine()
STRICT = (
    *("-std=c99", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wsign-conversion", "-Wshadow"),
    *("-Werror", "-c"),
)
KINDS = (("polynomial", 2), ("wide", 3))  # all sources once
ELEMENT = SpringContact.cubic(K1=0.624, K2=0.750, K3=-0.174, C1=0.0130, low=0.75, high=1.0)
pytestmark = pytest.mark.filterwarnings("ignore:the first library for Windows")


def declared(fmi):
    """Functions that a version of FMI wants a library to have."""
    header = standard_headers(fmi)[f"fmi{fmi}Functions.h"].decode()
    return set(re.findall(rf"FMI{fmi}_Export\s+fmi{fmi}\w+TYPE\s+(fmi{fmi}\w+);", header))


def test_functions_were_found():
    assert (len(declared(2)), len(declared(3))) == (44, 75)


def assert_sound(content, platform, identifier, fmi=2):
    """By its headers, a library of that platform that loads on old systems and shows nothing of this one."""
    (found,), inside = read_library(content), contents(content)
    assert found.platform == platform.name
    assert {name for name in inside.exports if name[0] != "_"} == declared(fmi)
    if platform.system == "linux":
        assert found.glibc <= (2, 17) and inside.name == ""
        assert set(inside.needs) <= {"libc.so.6", "libm.so.6"}
    elif platform.system == "windows":
        # the C library that Windows 10 has itself
        assert all(re.fullmatch(r"(?i)kernel32\.dll|api-ms-win-crt-[\w-]+\.dll", name) for name in inside.needs)
    else:
        assert inside.minimum == {"x86_64-darwin": (10, 13), "aarch64-darwin": (11, 0)}[platform.name]
        assert inside.name == f"@rpath/{identifier}.dylib"
        assert inside.needs == ["/usr/lib/libSystem.B.dylib"]
        assert inside.signed or platform.name != "aarch64-darwin"  # which loads no other
    for place in (b"ehlcontact-fmu-", os.fsencode(Path.home()), os.fsencode(sys.prefix), b"/tmp/"):
        assert place not in content


def test_this_machines(spec, sources):
    files, (label,) = build_binaries(sources, compiled(spec, 2), spec.identifier, [OWN], fmi=3)
    ((path, content),) = files.items()
    assert path == f"binaries/{OWN.name}/CubicContact{OWN.suffix}"
    assert label.startswith(f"{OWN.name}: ") and "-ffp-contract=off" in label
    assert_sound(content, OWN, spec.identifier)


@pytest.mark.slow
@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("name", PLATFORMS)
def test_every_platforms(libraries, name, fmi):
    identifier = {2: "CubicContact", 3: "WideContact"}[fmi]
    assert_sound(libraries[fmi, name], PLATFORMS[name], identifier, fmi)


@pytest.mark.slow
@pytest.mark.parametrize("name", PLATFORMS)
def test_the_same_again_without_the_cache(libraries, spec, sources, name, monkeypatch, tmp_path):
    monkeypatch.setenv("EHLCONTACT_CACHE", str(tmp_path))
    made, _ = build_binaries(sources, compiled(spec, 2), spec.identifier, [PLATFORMS[name]], fmi=3)
    (again,) = made.values()
    assert len(again) == len(libraries[2, name])
    assert again == libraries[2, name]


def test_a_compiler_that_makes_something_else(spec, sources, monkeypatch, tmp_path):
    other = "aarch64-linux" if OWN.name != "aarch64-linux" else "x86_64-linux"
    (zig,) = compilers(PLATFORMS[other])
    words = " ".join(f"'{word}'" for word in zig.command)
    monkeypatch.setenv("EHLCONTACT_CC", words)
    with pytest.raises(BuildError, match=f"made a library for {other}, not {OWN.name}"):
        build_binaries(sources, compiled(spec, 2), spec.identifier, [OWN], fmi=3)
    text = 'while [ "$1" != -o ]; do shift; done\necho text > "$2"'
    monkeypatch.setenv("EHLCONTACT_CC", shell_script(tmp_path / "cc", text))
    with pytest.raises(BuildError, match="made no ELF, PE or Mach-O library"):
        build_binaries(sources, compiled(spec, 2), spec.identifier, [OWN], fmi=3)


@pytest.mark.skipif(OWN.system == "windows", reason="the system's compiler is not looked for on Windows")
@pytest.mark.parametrize(
    "text",
    ["echo 'stdio.h: no such file' >&2; exit 1", pytest.param('exec gcc "$@" -lnone', marks=pytest.mark.long)],
)
def test_a_system_compiler_that_fails_is_passed_over(spec, sources, monkeypatch, tmp_path, text):
    """A gcc without the headers of a C library, as slim images have it."""
    shell_script(tmp_path / "cc", text)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.delenv("EHLCONTACT_CC", raising=False)
    _, (label,) = build_binaries(sources, compiled(spec, 2), spec.identifier, [OWN], fmi=3)
    assert " zig " in label


@pytest.mark.skipif(OWN.system != "linux", reason="glibc is on Linux")
def test_a_binary_for_newer_systems_only_is_passed_over(monkeypatch):
    """exp and pow of a new glibc are not those of 2.17: zig's are."""
    sources = {
        "a.c": b'#include <math.h>\n__attribute__((visibility("default"))) double f(double x) {return exp(x);}'
    }
    monkeypatch.delenv("EHLCONTACT_CC", raising=False)
    files, (label,) = build_binaries(sources, ["a.c"], "a", [OWN], fmi=3)
    (found,) = read_library(*files.values())
    assert contents(*files.values()).exports >= {"f"} and () < found.glibc <= (2, 17)
    own = compilers(OWN)[0]
    if not own.is_zig:
        there = libraries._made(libraries.Work(sources, ["a.c"], "a"), OWN, own)[1]
        assert (" zig " in label) == (there.glibc > (2, 17))


@pytest.mark.skipif(OWN.system != "linux", reason="glibc is on Linux")
def test_a_compiler_whose_libraries_are_too_new_is_asked_once(monkeypatch, tmp_path):
    """Not again for the same code with other numbers; for other code, or another part of it, it is."""
    monkeypatch.setenv("EHLCONTACT_CACHE", str(tmp_path))
    asked = []

    def compile_(work, target, compiler):
        asked.append(compiler.label)
        return b"library"

    def checked(library, target, compiler):
        return libraries.Library(OWN.name, (2, 17) if compiler.is_zig else (2, 29))

    old, new = (Compiler((name,), name, name, is_zig=name == "zig") for name in ("zig", "cc"))
    monkeypatch.setattr(libraries, "compilers", lambda target: [new, old])
    monkeypatch.setattr(libraries, "_compile", compile_)
    monkeypatch.setattr(libraries, "_checked", checked)
    one, two, power = b"#define N 1\n", b"#define N 2\n", b"#define N 2\n#define LAW_POWER 1\n"
    for code, header in ((b"f", one), (b"f", two), (b"g", two), (b"f", power)):
        build_binaries({"a.c": code, "a.h": header}, ["a.c"], "a", [OWN], fmi=3)
    assert asked == ["cc", "zig", "zig", "cc", "zig", "cc", "zig"]


def test_where_one_platform_fails_the_others_are_ended(monkeypatch, tmp_path):
    """They are compiled side by side; none is waited for."""
    monkeypatch.setenv("EHLCONTACT_CACHE", str(tmp_path))
    monkeypatch.setattr(libraries.os, "cpu_count", lambda: 2)
    begun, ended, told = threading.Event(), [], []

    def compile_(work, target, compiler):
        if target.system == "windows":
            assert begun.wait(30.0)
            raise BuildError("no")
        begun.set()
        ended.append(work.stop.wait(30.0))
        raise BuildError("told to stop")

    monkeypatch.setattr(libraries, "compilers", lambda target: [Compiler(("cc",), "cc", "cc")])
    monkeypatch.setattr(libraries, "_compile", compile_)
    asked = [PLATFORMS[name] for name in ("x86_64-linux", "x86_64-windows", "x86_64-darwin")]
    with pytest.raises(BuildError, match=r"^no$"):
        build_binaries({"a.c": b""}, ["a.c"], "a", asked, 3, lambda *step: told.append(step))
    assert set(ended) == {True}  # the third may have begun at that moment, and is told likewise
    assert told[0] == (0, 3) and (3, 3) not in told


def test_no_room_to_compile(spec, sources, monkeypatch, tmp_path):
    monkeypatch.setenv("EHLCONTACT_CACHE", str(tmp_path))

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(BuildError, match=r"^no room to compile in .* \(No space left on device\)$"):
        build_binaries(sources, compiled(spec, 2), spec.identifier, [OWN], fmi=3)


@pytest.mark.slow
def test_all_platforms_of_fmi_2(tmp_path):
    """It has one folder for both Macs, and none for Linux on arm."""
    told = []
    path = export(ELEMENT, tmp_path / "x.fmu", platforms="all", progress=lambda *step: told.append(step))
    assert told == [(k, 4) for k in range(5)] and path.stat().st_size < 300_000
    folder = Path(fmpy.extract(str(path), unzipdir=str(tmp_path / "x")))
    names = sorted(p.relative_to(folder / "binaries").as_posix() for p in (folder / "binaries").rglob("*.*"))
    assert names == ["darwin64/CubicContact.dylib", "linux64/CubicContact.so", "win64/CubicContact.dll"]
    both = read_library((folder / "binaries" / names[0]).read_bytes())
    assert [one.platform for one in both] == ["x86_64-darwin", "aarch64-darwin"]
    page = (folder / "documentation" / "index.html").read_text()
    assert all(f"{one.name}: " in page for one in choose("all", 2))


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["cubic", "wide_si"])
def test_all_platforms_of_fmi_3(elements, kind, tmp_path):
    """Five of them in less than 300 kB."""
    path = export(elements[kind], tmp_path / "x.fmu", fmi=3, platforms="all")
    with zipfile.ZipFile(path) as archive:
        folders = {name.split("/")[1] for name in archive.namelist() if name.startswith("binaries/")}
        assert "sources/buildDescription.xml" in archive.namelist()
    assert folders == set(PLATFORMS) and path.stat().st_size < 300_000


def test_an_fmu_for_other_machines_is_verified_on_this_one(tmp_path):
    """Its sources are, by this machine's binary of them, which is not in it."""
    other = "aarch64-darwin" if OWN.name != "aarch64-darwin" else "x86_64-darwin"
    path = export(ELEMENT, tmp_path / "x.fmu", platforms=other)
    folder = Path(fmpy.extract(str(path), unzipdir=str(tmp_path / "x")))
    assert [p.name for p in (folder / "binaries").iterdir()] == ["darwin64"]


def test_the_first_for_windows_is_announced(spec, sources, monkeypatch, tmp_path):
    """Before minutes pass, and not again once it was made."""
    windows = PLATFORMS["x86_64-windows"]
    monkeypatch.setenv("ZIG_GLOBAL_CACHE_DIR", str(tmp_path / "zig"))
    monkeypatch.setenv("EHLCONTACT_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(
        libraries,
        "run",
        lambda line, folder, more, stop: (folder / f"{line[line.index('-o') + 1]}").write_bytes(b"MZ"),
    )
    monkeypatch.setattr(libraries, "_checked", lambda *_: None)
    with pytest.warns(UserWarning, match="takes about 2 minutes"):
        build_binaries(sources, compiled(spec, 2), "a", [OWN, windows][1:], fmi=3)
    build_binaries(sources, compiled(spec, 2), "b", [windows], fmi=3)  # warnings are errors here
    build_binaries(sources | {"x.h": b""}, compiled(spec, 2), "b", [windows], fmi=3)


@pytest.mark.parametrize(("kind", "fmi"), KINDS)
@pytest.mark.parametrize(
    "compiler", ["gcc", *(pytest.param(name, marks=pytest.mark.long) for name in ("clang", OWN.name))]
)
def test_no_warning(elements, kind, fmi, tmp_path, compiler):
    assert_no_warning(elements[kind], fmi, tmp_path, compiler)


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "fmi"), KINDS)
@pytest.mark.parametrize("name", [name for name in PLATFORMS if name != OWN.name])
def test_no_warning_elsewhere(elements, kind, fmi, tmp_path, name):
    assert_no_warning(elements[kind], fmi, tmp_path, name)


def assert_no_warning(element, fmi, folder, compiler):
    if compiler in PLATFORMS:
        command = compilers(PLATFORMS[compiler])[-1].command
    elif shutil.which(compiler):
        command = (compiler,)
    else:
        pytest.skip(f"no {compiler}")
    spec = contact_spec(element)
    (folder / "standard").mkdir()
    for name, content in source_files(spec, content_guid(spec, fmi), fmi).items():
        # those of FMI apart: a type of function without a prototype in FMI 3.0 is not for us to change
        (folder / ("standard" if name in FMI_FILES[fmi].standard else ".") / name).write_bytes(content)
    for unit in compiled(spec, fmi):
        line = [*command, *STRICT, "-isystem", "standard", unit]
        done = subprocess.run(line, cwd=folder, capture_output=True, text=True, check=False, timeout=600)
        assert done.stderr == "" and done.stdout == "" and done.returncode == 0


def test_unknown_platform(tmp_path):
    with pytest.raises(InputError, match="platforms = 'win32': must be x86_64-linux"):
        export(ELEMENT, tmp_path / "x.fmu", platforms="win32")
    assert list(tmp_path.iterdir()) == []


def test_a_module_of_webassembly_imports_nothing_and_offers_what_is_visible(tmp_path):
    visible = b'__attribute__((visibility("default")))'
    source = (
        b"#include <math.h>\n"
        + visible
        + b"double root(double x) { return sqrt(x); }\nint hidden(void) { return 1; }\n"
    )
    module = build_module({"one.c": source}, ["one.c"], "one")
    assert module == build_module({"one.c": source}, ["one.c"], "one")
    if shutil.which("node") is not None:
        (tmp_path / "one.wasm").write_bytes(module)
        ask = """const module = new WebAssembly.Module(require("fs").readFileSync("one.wasm"));
        const { exports } = new WebAssembly.Instance(module);
        console.log(WebAssembly.Module.imports(module).length, exports.root(2), typeof exports.hidden);"""
        done = subprocess.run(["node", "-e", ask], cwd=tmp_path, capture_output=True, text=True, check=True)
        assert done.stdout.split() == ["0", str(2.0**0.5), "undefined"]
    with pytest.raises(BuildError, match="failed"):
        build_module({"one.c": b"int root(void) { return nothing; }"}, ["one.c"], "one")
