"""The C files that every FMU of a version has, whatever its model."""

from __future__ import annotations

from dataclasses import dataclass

from fmu.spec import ModelSpec


@dataclass(frozen=True, slots=True)
class Glue:
    """Sources and headers of one FMI version, those of the standard apart."""

    sources: tuple[str, ...]
    headers: tuple[str, ...]
    standard: tuple[str, ...]  # headers of the standard; FMI 3.0 has the importer bring them
    licence: str | None  # of those that go into the FMU


_SHARED = ("instance.c", "exchange.c")  # of the core: what both versions do alike

GLUE = {
    2: Glue(
        sources=("fmi2.c", "fmi2_values.c", "fmi2_state.c", "fmi2_cosimulation.c", "fmi2_exchange.c", *_SHARED),
        headers=("fmi2_instance.h", "instance.h"),
        standard=("fmi2FunctionTypes.h", "fmi2Functions.h", "fmi2TypesPlatform.h"),
        licence="fmi2-headers.txt",
    ),
    3: Glue(
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
    return (*GLUE[fmi].sources, *spec.sources, *generated)
