"""`save` and `load`: results in HDF5 files."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from ehlcontact.checks import require_instance
from ehlcontact.files import hdf5
from ehlcontact.results import SteadyResult
from ehlcontact.transient.result import SimulationResult

Result = SteadyResult | SimulationResult
_CLASSES: dict[str, type[Any]] = {cls.__name__: cls for cls in (SteadyResult, SimulationResult)}


def save(result: Result, path: str | os.PathLike[str]) -> Path:
    """Write a result; an existing file is replaced in one move, or kept if anything fails.

    Raises
    ------
    InputError
        `result` is none; the folder does not exist or cannot be written to.
    """
    require_instance("result", result, Result, "a result of solve_steady or simulate")
    return hdf5.write(result, path, "save")


def load(path: str | os.PathLike[str]) -> Result:
    """Read a result written by `save`.

    Raises
    ------
    InputError
        No such file, not HDF5, truncated, not one of ours, or written by a newer version.
    """
    result: Result = hdf5.read(path, _CLASSES, "file", "result of this library (steady or simulation)")
    return result
