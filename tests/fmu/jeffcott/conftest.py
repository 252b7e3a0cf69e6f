"""Rotors and their FMUs, compiled once, and instances of them by hand."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from reduced_models import JeffcottRotor


def names_of(rotor: JeffcottRotor) -> list[str]:
    """Positions and velocities, as `motion_of` has them."""
    axes = [("x", "y")[k] for k in rotor.axes]
    return [f"{body}.{what}{axis}" for what in ("", "velocity_") for body in ("disc", "journal") for axis in axes]


@pytest.fixture
def moving() -> Callable[[JeffcottRotor], list[str]]:
    """Names of positions and velocities."""
    return names_of


@pytest.fixture
def motion_of() -> Callable[..., np.ndarray]:
    """Positions and velocities of a `RotorResult`, shape (N, 2 freedoms)."""

    def stacked(result: Any) -> np.ndarray:
        return np.hstack([result.displacement, result.velocity])

    return stacked
