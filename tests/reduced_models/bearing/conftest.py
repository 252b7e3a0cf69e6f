"""Prescribed motions of a ring."""

import numpy as np
import pytest


@pytest.fixture
def shake():
    """A ring that goes round and up and down about a place: positions and velocities at the ends of steps."""

    def make(dt, steps, about=(1e-6, -12e-6), size=2e-6, hz=300.0):
        t = dt * np.arange(1, steps + 1)
        w = 2.0 * np.pi * hz
        # from rest, smoothly
        q = np.column_stack([size * np.sin(0.7 * w * t) ** 2, size * np.sin(w * t) ** 2])
        v = np.column_stack([0.7 * w * size * np.sin(1.4 * w * t), w * size * np.sin(2.0 * w * t)])
        return np.array(about) + q, v

    return make
