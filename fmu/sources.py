"""C sources of an FMU: files of the FMI version, of the model, and generated headers.

The headers of the FMI standard are those that FMPy is installed with.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from fmu.c_headers import c_headers
from fmu.spec import ModelSpec
from reduced_models.core import CSRC as CORE

CSRC = Path(__file__).parent / "csrc"
SOURCE_FOLDERS = CSRC, CORE  # what belongs to FMI; what Python calls too


@dataclass(frozen=True, slots=True)
class FmiFiles:
    """Sources and headers of one FMI version, those of the standard apart."""

    sources: tuple[str, ...]
    headers: tuple[str, ...]
    standard: tuple[str, ...]  # headers of the standard; FMI 3.0 has the importer bring them
    licence: str | None  # of those that go into the FMU


_SHARED = ("instance.c", "master.c", "values.c", "exchange.c")  # of the core: what both versions do alike

FMI_FILES = {
    2: FmiFiles(
        sources=("fmi2.c", "fmi2_values.c", "fmi2_state.c", "fmi2_cosimulation.c", "fmi2_exchange.c", *_SHARED),
        headers=("fmi2_instance.h", "instance.h", "master.h"),
        standard=("fmi2FunctionTypes.h", "fmi2Functions.h", "fmi2TypesPlatform.h"),
        licence="fmi2-headers.txt",
    ),
    3: FmiFiles(
        sources=(
            "fmi3.c", "fmi3_values.c", "fmi3_state.c", "fmi3_cosimulation.c", "fmi3_exchange.c",
            "fmi3_unsupported.c", *_SHARED,
        ),
        headers=("fmi3_instance.h", "instance.h", "master.h"),
        standard=("fmi3FunctionTypes.h", "fmi3Functions.h", "fmi3PlatformTypes.h"),
        licence=None,
    ),
}  # fmt: skip


def compiled(spec: ModelSpec, fmi: int) -> tuple[str, ...]:
    """C files of an FMU that are compiled."""
    generated = (name for name in spec.tables if name.endswith(".c"))
    return (*FMI_FILES[fmi].sources, *spec.sources, *generated)


def source_files(spec: ModelSpec, guid: str, fmi: int = 2) -> dict[str, bytes]:
    """All that a compiler needs: content of ``sources/``, and the headers of FMI."""
    interface = FMI_FILES[fmi]
    names = (*interface.sources, *spec.sources, *interface.headers, *spec.headers, "README.md")
    found = source_paths()
    files = {name: found[name].read_bytes() for name in names} | standard_headers(fmi)
    return files | {name: text.encode("ascii") for name, text in c_headers(spec, guid).items()}


def source_paths() -> dict[str, Path]:
    """C sources and what lies beside them, by name."""
    return {path.name: path for folder in SOURCE_FOLDERS for path in folder.rglob("*") if path.is_file()}


def standard_headers(fmi: int) -> dict[str, bytes]:
    """Headers of an FMI version by name, lines ending in LF: FMPy 0.3.22 has some with CR LF."""
    folder = standard_folder()
    return {name: (folder / name).read_bytes().replace(b"\r\n", b"\n") for name in FMI_FILES[fmi].standard}


def standard_folder() -> Path:
    """Folder of the headers of the FMI standard, in FMPy."""
    fmpy = find_spec("fmpy")  # which need not be imported for its files
    assert fmpy is not None and fmpy.origin is not None
    return Path(fmpy.origin).parent / "c-code"
