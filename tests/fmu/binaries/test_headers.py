"""Headers of libraries, read as the binutils read them; damaged ones are told."""

import random
import re
import shutil
import subprocess

import pytest
from library_contents import contents

from ehlcontact.binaries import build_binaries, read_library, this_machine
from ehlcontact.binaries.headers import universal
from fmu.sources import compiled


@pytest.fixture(scope="module")
def own(spec, sources):
    """Library for this machine."""
    (library,) = build_binaries(sources, compiled(spec, 2), spec.identifier, [this_machine()], fmi=3)[0].values()
    return library


def test_of_this_machine(own):
    (found,) = read_library(own)
    assert found.platform == this_machine().name
    assert {"fmi2Instantiate", "fmi2DoStep", "fmi2FreeInstance"} <= contents(own).exports


@pytest.mark.skipif(shutil.which("readelf") is None, reason="no readelf")
def test_as_readelf_reads_them(own, tmp_path):
    if not own.startswith(b"\x7fELF"):
        pytest.skip("no ELF library on this machine")
    (tmp_path / "x.so").write_bytes(own)

    def readelf(*options):
        line = ["readelf", "--wide", *options, tmp_path / "x.so"]
        return subprocess.run(line, capture_output=True, text=True, check=True).stdout

    (found,), inside = read_library(own), contents(own)
    rows = [line.split() for line in readelf("--dyn-syms").splitlines() if re.match(r"\s+\d+:", line)]
    exported = {row[7].split("@")[0] for row in rows if row[6] != "UND" and row[4] in ("GLOBAL", "WEAK")}
    assert inside.exports == exported and len(exported) >= 44
    assert set(inside.needs) == set(re.findall(r"\(NEEDED\).*\[(.*)\]", readelf("--dynamic")))
    versions = re.findall(r"Name: GLIBC_([\d.]+)", readelf("--version-info"))
    assert found.glibc == max(tuple(map(int, version.split("."))) for version in versions)


@pytest.mark.parametrize(
    "content", [b"", b"MZ", b"\x7fELF", b"\xcf\xfa\xed\xfe", b"\xca\xfe\xba\xbe\0\0\0\x02", b"#!/bin/sh"]
)
def test_no_library(content):
    with pytest.raises(ValueError, match="library"):
        read_library(content)


def assert_damage_is_told(library):
    """Cut or changed anywhere: read, or told; never a loop without end, nor another error."""
    dice = random.Random(0)
    told = 0
    for _ in range(300):
        damaged = bytearray(library)
        for _ in range(dice.choice((1, 4, 16))):
            damaged[dice.randrange(min(len(damaged), 4096))] = dice.choice((0, 1, 0x7F, 0xFF))
        for content in (bytes(damaged), library[: dice.randrange(len(library))]):
            try:
                read_library(content)
            except ValueError:
                told += 1
    assert told > 100


def test_damaged(own):
    assert_damage_is_told(own)


@pytest.mark.slow
def test_damaged_ones_of_every_platform(libraries):
    for library in (
        *libraries.values(),
        universal([libraries[3, "x86_64-darwin"], libraries[3, "aarch64-darwin"]]),
    ):
        assert_damage_is_told(library)
