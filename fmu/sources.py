"""C sources of an FMU: files of the FMI version, of the model, generated headers; and the zip archive."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

from fmu.c_headers import c_headers
from fmu.spec import ModelSpec

CSRC = Path(__file__).parent / "csrc"


@dataclass(frozen=True, slots=True)
class FmiFiles:
    """Sources and headers of one FMI version, those of the standard apart."""

    sources: tuple[str, ...]
    headers: tuple[str, ...]
    standard: tuple[str, ...]  # headers of the standard; FMI 3.0 has the importer bring them
    licence: str | None  # of those that go into the FMU


_SHARED = ("instance.c", "exchange.c")  # of the core: what both versions do alike

FMI_FILES = {
    2: FmiFiles(
        sources=("fmi2.c", "fmi2_values.c", "fmi2_state.c", "fmi2_cosimulation.c", "fmi2_exchange.c", *_SHARED),
        headers=("fmi2_instance.h", "instance.h"),
        standard=("fmi2FunctionTypes.h", "fmi2Functions.h", "fmi2TypesPlatform.h"),
        licence="fmi2-headers.txt",
    ),
    3: FmiFiles(
        sources=(
            "fmi3.c", "fmi3_values.c", "fmi3_state.c", "fmi3_cosimulation.c", "fmi3_exchange.c",
            "fmi3_unsupported.c", *_SHARED,
        ),
        headers=("fmi3_instance.h", "instance.h"),
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
    found = {path.name: path for path in CSRC.rglob("*") if path.is_file()}
    files = {name: found[name].read_bytes() for name in (*names, *interface.standard)}
    return files | {name: text.encode("ascii") for name, text in c_headers(spec, guid).items()}


def pack(files: Mapping[str, bytes]) -> bytes:
    """Zip archive with sorted entries and fixed times: equal files give equal bytes."""
    stream = BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3  # Unix, whatever the machine, so that the mode below counts
            entry.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            archive.writestr(entry, files[name])
    return stream.getvalue()
