"""Blocks of python-control: their frequency response, and slopes of nonlinear ones."""

import numpy as np


def response(block, w):
    return block.C @ np.linalg.solve(1j * w * np.eye(block.nstates) - block.A, block.B)


def slopes(moving, size_of):
    """Rates of the states by every state and input at rest, by differences of ``size_of(state)``."""
    n, m = moving.nstates, moving.ninputs

    def rates(z):
        return moving.dynamics(0.0, z[:n], z[n:])

    found = np.zeros((n, n + m))
    for k in range(n + m):
        # of inputs so small that a knot of a tabulated law hardly ever lies between
        size = size_of(moving.state_labels[k]) if k < n else 1e-4
        step = size * np.eye(n + m)[k]
        near, far = (rates(j * step) - rates(-j * step) for j in (1.0, 2.0))
        found[:, k] = (8.0 * near - far) / (12.0 * size)
    return found
