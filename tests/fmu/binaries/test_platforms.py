"""Names of platforms, and which folder each has in which version of FMI."""

import platform

import fmpy
import pytest

from ehlcontact import InputError
from fmu.binaries import PLATFORMS, choose, this_machine


def names(*chosen):
    return [one.name for one in chosen]


def test_this_machine_is_the_default_and_is_fmpys():
    own = this_machine()
    assert own.name == fmpy.platform_tuple and choose(None, 3) == (own,)
    if own.fmi2 is not None:
        assert own.fmi2 == fmpy.platform and choose(None, 2) == (own,)


def test_all_and_each_by_either_name():
    assert names(*choose("all", 3)) == list(PLATFORMS)
    assert names(*choose("all", 2)) == [name for name in PLATFORMS if name != "aarch64-linux"]
    assert names(*choose("win64", 2)) == names(*choose(["x86_64-windows"], 2)) == ["x86_64-windows"]
    assert names(*choose(["darwin64"], 2)) == ["x86_64-darwin", "aarch64-darwin"]
    twice = choose(("aarch64-darwin", "linux64", "x86_64-linux", "aarch64-darwin"), 2)
    assert names(*twice) == ["x86_64-linux", "aarch64-darwin"]


@pytest.mark.parametrize("bad", ["linux", "win32", "LINUX64", "", "x86_64-linux,win64", None, 64])
def test_unknown_ones_are_named_with_those_there_are(bad):
    with pytest.raises(InputError) as error:
        choose([bad], 2)
    line = str(error.value)
    assert line.startswith(f"platforms = {bad!r}: must be x86_64-linux, x86_64-windows, ") and "\n" not in line
    assert line.endswith("or all") and "aarch64-linux" not in line


def test_folders_of_both_versions():
    assert [one.folder(3) for one in PLATFORMS.values()] == list(PLATFORMS)
    assert {name: one.folder(2) for name, one in PLATFORMS.items()} == {
        "x86_64-linux": "linux64",
        "aarch64-linux": None,
        "x86_64-windows": "win64",
        "x86_64-darwin": "darwin64",
        "aarch64-darwin": "darwin64",
    }


def test_none_at_all():
    with pytest.raises(InputError, match="one or more of x86_64-linux"):
        choose([], 3)


def test_linux_on_arm_is_for_fmi_3():
    with pytest.raises(InputError, match="FMI 2 has no folder for it, FMI 3 has"):
        choose("aarch64-linux", 2)
    assert names(*choose("aarch64-linux", 3)) == ["aarch64-linux"]


@pytest.mark.parametrize(
    ("system", "machine", "name"),
    [
        ("Linux", "x86_64", "x86_64-linux"),
        ("Linux", "aarch64", "aarch64-linux"),
        ("Windows", "AMD64", "x86_64-windows"),
        ("Darwin", "arm64", "aarch64-darwin"),
        ("Darwin", "x86_64", "x86_64-darwin"),
        ("Linux", "riscv64", None),
        ("Windows", "ARM64", None),
        ("FreeBSD", "amd64", None),
    ],
)
def test_machines_as_python_calls_them(monkeypatch, system, machine, name):
    monkeypatch.setattr(platform, "system", lambda: system)
    monkeypatch.setattr(platform, "machine", lambda: machine)
    own = this_machine()
    assert own is (None if name is None else PLATFORMS[name])
    if name is None:
        with pytest.raises(InputError, match=f"not built for this machine, {system} {machine}"):
            choose(None, 3)
    elif name == "aarch64-linux":
        with pytest.raises(InputError, match=r"this machine is aarch64-linux, and FMI 2 has no folder"):
            choose(None, 2)
