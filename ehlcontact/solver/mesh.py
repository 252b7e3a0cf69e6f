"""Mesh of a film: intervals, region, refinement across; its nodes, and the memory that a solve on it takes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from math import log2

from ehlcontact.errors import InputError
from ehlcontact.process.free_memory import available_bytes
from ehlcontact.solver.domain import MOST_INTERVALS, Domain
from ehlcontact.solver.grid_rules import longer_axis, x_coarsenings


class Solve(StrEnum):
    """What a mesh is solved by; the last two factorise a sparse matrix over all nodes."""

    CYCLES = "cycles"
    NEWTON = "newton"
    IMPEDANCE = "impedance"  # complex


# All fields, their deflections and what a step in time keeps, over the nodes of all levels: a steady film takes
# 24 numbers per node and a step 30, as measured; the memory of cycles that fall slowly five more, as counted.
NUMBERS_PER_NODE = 29.0
# Bytes of sparse factors and of what makes them, over a power of the nodes; measured up to 205 000 nodes.
FACTORS, FACTOR_POWER = {Solve.CYCLES: 0.0, Solve.NEWTON: 750.0, Solve.IMPEDANCE: 1300.0}, 1.17


@dataclass(frozen=True, slots=True)
class Mesh:
    """Mesh of a film in a contact of one ellipse ratio.

    Attributes
    ----------
    n : int
        Intervals along X.
    domain : Domain
    kappa : float
        Ellipse ratio of the contact: nodes are as far apart along as across in metres.
    y_refinement : int
        Distance of nodes along X over the distance of lines, both in metres: 1, or a power of two in contacts that
        are long in the rolling direction (kappa > 1).
    """

    n: int
    domain: Domain
    kappa: float
    y_refinement: int = 1

    @property
    def nodes(self) -> float:
        """Nodes of the grid, about; infinite beyond `MOST_INTERVALS`."""
        if self.n > MOST_INTERVALS:
            return float("inf")
        return self.n * self.n * self.y_refinement * self.domain.y_max / (self._length * longer_axis(self.kappa))

    @property
    def levels(self) -> float:
        """Nodes of all levels over those of this grid, about: the first may be halved in one direction alone."""
        halvings = x_coarsenings(self.kappa) + round(log2(self.y_refinement))
        return 2.0 - 2.0 / 3.0 * 0.5**halvings

    @property
    def size(self) -> float:
        """Mesh size over the longer semi-axis."""
        return self._length / self.n * max(1.0, self.kappa / self.y_refinement)

    @property
    def _length(self) -> float:
        return self.domain.x_out - self.domain.x_in

    def needed_bytes(self, solve: Solve = Solve.CYCLES) -> float:
        """Bytes that a solve takes, within 30 %."""
        return 8.0 * NUMBERS_PER_NODE * self.levels * self.nodes + FACTORS[solve] * self.nodes**FACTOR_POWER

    def fits(self, solve: Solve = Solve.CYCLES) -> bool:
        """Whether there is memory for a solve; also where the free memory is not known."""
        available = available_bytes()
        return available is None or self.needed_bytes(solve) <= available

    def require_memory(self, solve: Solve = Solve.CYCLES) -> None:
        """Raise `InputError` unless there is memory for a solve."""
        if not self.fits(solve):
            needed, available = self.needed_bytes(solve), available_bytes() or 0.0
            allowed = (
                f"such that the grid fits into memory: {self.nodes:.3g} nodes take about {_gigabytes(needed)} "
                f"({solve}), and {_gigabytes(available)} are free"
            )
            raise InputError("n", self.n, allowed)


def _gigabytes(count: float) -> str:
    return f"{count / 1e9:.3g} GB"
