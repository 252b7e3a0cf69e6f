"""Rotors and their FMUs, compiled once, and instances of them by hand."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from reduced_models import Rotor


def names_of(rotor: Rotor) -> list[str]:
    """Positions and velocities, as `motion_of` has them."""
    return [
        f"{body}.{what}{axis}" for what in ("", "velocity_") for body, at in rotor.nodes.items() for axis in at
    ]


@pytest.fixture
def moving() -> Callable[[Rotor], list[str]]:
    """Names of positions and velocities."""
    return names_of


@pytest.fixture
def motion_of() -> Callable[..., np.ndarray]:
    """Positions and velocities of a `RotorResult`, shape (N, 2 freedoms)."""

    def stacked(result: Any) -> np.ndarray:
        return np.hstack([result.displacement, result.velocity])

    return stacked
