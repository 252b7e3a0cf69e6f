"""`save` and `load`: results in HDF5 files."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from ehlcontact.checks import require_instance
from ehlcontact.errors import InputError
from ehlcontact.files import hdf5
from ehlcontact.results import SteadyResult
from ehlcontact.transient.record import COLUMNS
from ehlcontact.transient.result import SimulationResult

Result = SteadyResult | SimulationResult
_CLASSES: dict[str, type[Any]] = {cls.__name__: cls for cls in (SteadyResult, SimulationResult)}
FORMAT = 2  # of the file: 1 had the frequencies of motions under omega and omega_n
WHAT = "result of this library (steady or simulation)"


def save(result: Result, path: str | os.PathLike[str]) -> Path:
    """Write a result; an existing file is replaced in one move, or kept if anything fails.

    Raises
    ------
    InputError
        `result` is none; the folder does not exist or cannot be written to.
    """
    require_instance("result", result, Result, "a result of solve_steady or simulate")
    return hdf5.write(result, path, "save", FORMAT)


def load(path: str | os.PathLike[str]) -> Result:
    """Read a result written by `save`.

    Raises
    ------
    InputError
        No such file, not HDF5, truncated, not one of ours, or written by a newer version.
    """
    require_instance("file", path, str | os.PathLike, "the name of a file")
    result: Result = hdf5.read(path, _CLASSES, "file", WHAT, (1, FORMAT))
    for names, shape in _shapes(result):
        for name in names:
            if getattr(result, name).shape != shape:
                found = f"{name} has the shape {getattr(result, name).shape}, not {shape}"
                raise InputError("file", str(path), f"a complete HDF5 {WHAT}: its {found}")
    return result


def _shapes(result: Result) -> list[tuple[tuple[str, ...], tuple[int, ...]]]:
    """Arrays of a result and the shape that the others ask of them."""
    nx, ny = result.n + 1, result.Y.size
    if isinstance(result, SteadyResult):
        cycles = max(result.residuals.size, 1)
        arrays = [(("X",), (nx,)), (("P", "H"), (nx, ny)), (("residuals", "load_residuals"), (cycles,))]
        later = [(("pressure_changes",), (cycles - 1,))] if result.pressure_changes.size else []
        return arrays + later
    steps, kept = max(result.T.size, 1), result.snapshot_T.size
    midplanes = ("h_midplane", "p_midplane"), (steps, nx)
    return [(("X",), (nx,)), (COLUMNS, (steps,)), midplanes, (("snapshot_H", "snapshot_P"), (kept, nx, ny))]
