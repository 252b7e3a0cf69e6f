"""Memory that a grid takes, estimated before it is solved."""

from __future__ import annotations

from enum import StrEnum

from ehlcontact.errors import InputError
from ehlcontact.process.memory import available_bytes


class Solve(StrEnum):
    """What a grid is solved by; the last two factorise a sparse matrix over all nodes."""

    CYCLES = "cycles"
    NEWTON = "newton"
    IMPEDANCE = "impedance"  # complex


# All fields, their deflections and what a step in time keeps, over the nodes of all levels: a steady film takes
# 24 numbers per node and a step 30, as measured; the memory of cycles that fall slowly five more, as counted.
NUMBERS_PER_NODE = 29.0
QUARTERED = 4.0 / 3.0  # nodes of all levels over those of the finest, each level with a quarter of the one above
# Bytes of sparse factors and of what makes them, over a power of the nodes; measured up to 130 000 nodes.
FACTORS, FACTOR_POWER = {Solve.CYCLES: 0.0, Solve.NEWTON: 750.0, Solve.IMPEDANCE: 1300.0}, 1.17


def needed_bytes(nodes: float, solve: Solve = Solve.CYCLES, levels: float = QUARTERED) -> float:
    """Bytes that a solve on so many nodes takes, within 30 %; `levels` is what all levels have over these."""
    return 8.0 * NUMBERS_PER_NODE * levels * nodes + FACTORS[solve] * nodes**FACTOR_POWER


def fits(nodes: float, solve: Solve = Solve.CYCLES, levels: float = QUARTERED) -> bool:
    """Whether there is memory for a solve on so many nodes; also where nobody tells how much there is."""
    available = available_bytes()
    return available is None or needed_bytes(nodes, solve, levels) <= available


def require_memory(n: int, nodes: float, solve: Solve = Solve.CYCLES, levels: float = QUARTERED) -> None:
    """Raise `InputError` for a grid of `n` intervals along X and so many nodes that would not fit into memory."""
    if not fits(nodes, solve, levels):
        needed, available = needed_bytes(nodes, solve, levels), available_bytes() or 0.0
        allowed = (
            f"such that the grid fits into memory: {nodes:.3g} nodes take about {_size(needed)} "
            f"({solve}), and {_size(available)} are free"
        )
        raise InputError("n", n, allowed)


def _size(count: float) -> str:
    return f"{count / 1e9:.3g} GB"
