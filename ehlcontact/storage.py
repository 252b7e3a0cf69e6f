"""Results in HDF5: arrays as datasets, everything else as JSON attributes; written atomically."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from ehlcontact.checks import require_instance
from ehlcontact.errors import InputError
from ehlcontact.point import MoesPoint, Scales
from ehlcontact.results import SteadyResult
from ehlcontact.solver.domain import Domain
from ehlcontact.status import Status
from ehlcontact.transient.motion import Motion
from ehlcontact.transient.result import SimulationResult

FORMAT = 1
Result = SteadyResult | SimulationResult
_CLASSES: dict[str, type[Result]] = {cls.__name__: cls for cls in (SteadyResult, SimulationResult)}


def save(result: Result, path: str | os.PathLike[str]) -> Path:
    """Write a result; an existing file is replaced in one step, or kept if anything fails.

    Raises
    ------
    InputError
        `result` is none; the folder does not exist or cannot be written to.
    """
    require_instance("result", result, Result, "a result of solve_steady or simulate")
    return write_fields(result, path, "save")


def write_fields(record: Any, path: str | os.PathLike[str], field: str) -> Path:
    """Write any dataclass as `save` does; errors name `field`."""
    target = Path(path)
    # not tempfile: it makes files that only their owner may read
    name = target.with_name(f".{target.name}.{os.getpid()}.tmp")
    try:
        name.touch()
    except OSError as error:
        raise InputError(field, str(target), f"in a folder that can be written to ({error.strerror})") from None
    try:
        with h5py.File(name, "w") as file:
            file.attrs["format"] = FORMAT
            file.attrs["class"] = type(record).__name__
            for f in fields(record):
                value = getattr(record, f.name)
                if isinstance(value, np.ndarray):
                    file.create_dataset(
                        f.name, data=value, compression="gzip" if value.ndim > 1 and value.size else None
                    )
                else:
                    file.attrs[f.name] = json.dumps(_plain(value))
        os.replace(name, target)
    except OSError as error:
        raise InputError(field, str(target), f"a file that can be written ({error.strerror})") from None
    finally:
        name.unlink(missing_ok=True)
    return target


def load(path: str | os.PathLike[str]) -> Result:
    """Read a result written by `save`.

    Raises
    ------
    InputError
        No such file, not HDF5, truncated, not one of ours, or written by a newer version.
    """
    return read_fields(path, _CLASSES, "file", "result of this library (steady or simulation)")


def read_fields(path: str | os.PathLike[str], classes: Mapping[str, type[Any]], field: str, what: str) -> Any:
    """Read what `write_fields` wrote, one of `classes` by name; errors name `field` and say `what` was wanted."""
    source = Path(path)
    if not source.is_file():
        raise InputError(field, str(source), f"an existing HDF5 {what}")
    try:
        with h5py.File(source, "r") as file:
            name = file.attrs.get("class")
            if name not in classes:
                raise InputError(field, str(source), f"a {what}")
            if int(file.attrs["format"]) > FORMAT:
                raise InputError(field, str(source), f"of format {FORMAT} or older; upgrade to read it")
            cls = classes[name]
            values = {
                f.name: file[f.name][...] if f.name in file else _rebuild(f.name, json.loads(file.attrs[f.name]))
                for f in fields(cls)
            }
    except (OSError, KeyError, ValueError, TypeError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(field, str(source), f"a complete HDF5 {what}") from None
    return cls(**values)


def _plain(value: Any) -> Any:
    if isinstance(value, MoesPoint | Scales | Domain):
        return asdict(value)
    if isinstance(value, Motion):
        return value.to_dict()
    return value


def _rebuild(name: str, value: Any) -> Any:
    match name:
        case "point":
            return MoesPoint(**value)
        case "scales":
            return None if value is None else Scales(**value)
        case "domain":
            return Domain(**value)
        case "motion":
            return Motion.from_dict(value)
        case "status":
            return Status(value)
    return value
