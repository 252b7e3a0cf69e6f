"""`uncertainty`: samples of a function of uncertain inputs, on workers, kept in a folder."""

from __future__ import annotations

import inspect
import json
import pickle
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact.checks.kinds import DONE, ENTRIES, FOLDER, Count
from ehlcontact.checks.quantity import takes
from ehlcontact.content_store import ContentStore, key_of
from ehlcontact.errors import InputError
from ehlcontact.executors import executor_for, results_of
from ehlcontact.files import parse_json
from reduced_models.margins.result import Uncertainty
from reduced_models.margins.samples import Sample, sample_of
from reduced_models.margins.spread import draws, spread_of
from reduced_models.margins.statistics import LEAST

MOST = 1_000_000  # samples


@takes(
    inputs=ENTRIES, samples=Count(LEAST, MOST), seed=Count(0, 2**32 - 1), processes=Count(1, 1024), folder=FOLDER,
    progress=DONE,
)  # fmt: skip
def uncertainty(
    build: Callable[..., Any],
    inputs: Mapping[str, Any],
    *,
    samples: int = 200,
    seed: int = 0,
    processes: int = 1,
    folder: str | Path | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Uncertainty:
    """Intervals of the numbers of a machine whose inputs are not known exactly.

    Inputs are independent of each other. Their values are quasi-random (`spread.draws`).

    Parameters
    ----------
    build : callable
        Called with the inputs by name; gives the `MachineState` of `machine_state(rotor, speed_rpm, fine=False)`,
        or other numbers by name, None where there is none. A machine for which it raises `InputError` or
        `ConvergenceError` is counted with its reason.
    inputs : mapping
        Range (low, high), `spread` or frozen distribution of `scipy.stats` of each, in the unit of `build`.
    samples : int
        A power of 2 covers the inputs most evenly. More of them later leave the first as they are.
    seed : int
        Of the draws.
    processes : int
        Of this machine; with several `build` is a function of a module that can be imported.
    folder : path, optional
        Where samples are kept as they come: after an interruption the same call computes the missing ones. They
        are found by the text of `build` and the values of its inputs; what `build` calls may not change.
    progress : callable, optional
        Called with the numbers of samples done and in all.

    Raises
    ------
    InputError
        No input, or one that is none (`spread`); fewer than 8 samples; with several processes a function that
        they cannot import.
    """
    if not callable(build):
        raise InputError("build", build, "a function of the inputs")
    if not inputs:
        raise InputError("inputs", dict(inputs), "at least one")
    names = tuple(map(str, inputs))
    spreads = [spread_of(f"inputs[{name!r}]", value) for name, value in inputs.items()]
    if processes > 1:
        _require_importable(build)
    rows = np.vstack([[float(one.ppf(0.5)) for one in spreads], draws(spreads, samples, seed)]).tolist()
    store = None if folder is None else _store(Path(folder))
    keys = [key_of([_text_of(build), names, row]) for row in rows]
    found: dict[int, Sample] = {}
    if store is not None:
        for k, key in enumerate(keys):
            if (content := store.get(key)) is not None:
                found[k] = Sample(**parse_json(content))
    missing = {str(k): row for k, row in enumerate(rows) if k not in found}
    for name, sample in _computed(partial(_answer, build, names), missing, processes):
        found[int(name)] = sample
        if store is not None:
            store.put(keys[int(name)], json.dumps(sample._asdict()).encode())
        if progress is not None:
            progress(len(found), len(rows))
    return Uncertainty.of(names, [found[k] for k in range(1, len(rows))], found[0], seed)


def _computed(
    answer: Callable[[list[float]], Sample], rows: Mapping[str, list[float]], processes: int
) -> Iterator[tuple[str, Sample]]:
    """Samples of rows by their names as they come, in this process or in others."""
    if processes == 1:
        yield from ((name, answer(row)) for name, row in rows.items())
    elif rows:
        with executor_for(processes, 1) as executor:
            yield from results_of(executor, answer, rows)


def _answer(build: Callable[..., Any], names: tuple[str, ...], values: list[float]) -> Sample:
    return sample_of(values, lambda: build(**dict(zip(names, values, strict=True))))


def _require_importable(build: Callable[..., Any]) -> None:
    """Raise `InputError` for a function that other processes cannot find."""
    try:
        pickle.dumps(build)
        plain = getattr(build, "__module__", "") != "__main__"
    except (pickle.PicklingError, AttributeError, TypeError):
        plain = False
    if not plain:
        name = getattr(build, "__qualname__", repr(build))
        raise InputError("build", name, "a function of a module that can be imported, or processes = 1")


def _store(folder: Path) -> ContentStore:
    folder.parent.mkdir(parents=True, exist_ok=True)
    return ContentStore(folder, "folder")


def _text_of(build: Callable[..., Any]) -> str:
    """Source of a function; its name where there is none."""
    try:
        return inspect.getsource(build)
    except (OSError, TypeError):
        return f"{getattr(build, '__module__', '')}.{getattr(build, '__qualname__', repr(build))}"
