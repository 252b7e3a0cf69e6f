"""Mean bearings of time steps: bearings in one place whose cages stand at several angles, each with a share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from math import pi
from typing import Any

import numpy as np

from reduced_models.life.bearing_life import STANDING, TURNING
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.supports import BearingMount, bearing_names, is_ball_bearing

EXPONENTS = np.array([TURNING, STANDING])


def mean_rotor(rotor: Rotor, copies: Sequence[int]) -> Rotor:
    """The rotor with so many of each ball bearing, their cages spaced over a pitch, which share its forces."""
    if all(count == 1 for count in copies):
        return rotor
    counts, mounts, shares = iter(copies), list[Any](), list[float]()
    names = iter(bearing_names(rotor.mounts))
    for mount in rotor.mounts:
        if not isinstance(mount, BearingMount):
            mounts.append(mount)
            continue
        name = next(names)
        if not is_ball_bearing(mount):
            mounts.append(replace(mount, name=name))
            continue
        count = next(counts)
        for k in range(count):
            angle = mount.cage_angle + 2.0 * pi / mount.ball_bearing.balls * k / count
            mounts.append(replace(mount, name=_copy_name(name, k), cage_angle=angle))
            shares.append(1.0 / count)
    found = replace(rotor, mounts=tuple(mounts))
    forces = found.geometry.counts.copy()
    for columns, share in zip(found.ball_columns, shares, strict=True):
        forces[columns] *= share
    vars(found)["geometry"] = found.geometry._replace(counts=forces)  # where its cached property has it
    return found


def mean_result(run: RotorResult, rotor: Rotor, copies: Sequence[int]) -> RotorResult:
    """The run of a `mean_rotor` as that of the rotor: means of forces and loads, the largest load of all balls."""
    if all(count == 1 for count in copies):
        return run
    names = {
        _copy_name(name, k): name
        for name, count in zip(rotor.ball_bearing_names, copies, strict=True)
        for k in range(count)
    }
    columns: dict[str, list[int]] = {}
    for k, column in enumerate(run.columns):
        name, _, direction = column.rpartition(" ")
        columns.setdefault(f"{names.get(name, name)} {direction}", []).append(k)
    means: dict[str, Any] = {
        name: np.stack([getattr(run, name)[:, at].mean(axis=1) for at in columns.values()], axis=1)
        for name in ("approach", "rate", "force")
    }
    ends = np.cumsum([0, *copies]).tolist()
    parts = [slice(first, end) for first, end in pairwise(ends)]
    histories = []
    for name, part in zip(rotor.ball_bearing_names, parts, strict=True):
        loads = np.array([one.mean_loads for one in run.ball_bearings[part]]) ** EXPONENTS
        histories.append(
            replace(run.ball_bearings[part.start], name=name, mean_loads=loads.mean(axis=0) ** (1.0 / EXPONENTS))
        )
    return replace(
        run,
        **means,
        columns=tuple(columns),
        largest_load=np.array([run.largest_load[part].max(axis=0) for part in parts]),
        ball_bearings=tuple(histories),
    )


def _copy_name(name: str, k: int) -> str:
    return f"{name}, position {k}"
