"""Kernels of a steady film that a second process compiles beside the first solve on a machine.

The first process compiles the first kernels of the deflection and of the flow, and those of whole lines, the
second meanwhile those that are needed later, into numba's cache, where the first one finds them. Nothing happens
once they are there.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numba.core import event

from ehlcontact.jit import compile_for, is_kept, plain
from ehlcontact.point import MoesPoint
from ehlcontact.process.beside import start_beside
from ehlcontact.process.threads import Kernel, Team
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.kernels import cavitation, flanks, fourier, relax, reynolds, transfer
from ehlcontact.solver.kernels.linearise import dense_jacobian
from ehlcontact.solver.level import Level
from ehlcontact.solver.lowest_film import lowest_of_cells


@cache
def await_compilation() -> None:
    """Let the second process begin as soon as this one has to compile the first kernel of a film."""
    event.register("numba:compile", _FirstKernel())


class _FirstKernel(event.Listener):
    """Starts the second process, once."""

    def __init__(self) -> None:
        self._awaited: Any = plain(fourier.across_lines)

    def on_start(self, event: Any) -> None:
        kernel = event.data["dispatcher"]
        if kernel.py_func is self._awaited:
            self._awaited = None
            start_beside(__name__, compile_some.__name__, kernel._cache.cache_path)

    def on_end(self, event: Any) -> None:
        pass


def solver_is_kept() -> bool:
    """Whether the kernels of a film are found compiled, by the one that takes longest."""
    return is_kept(relax.relax_lines)


def compile_some() -> None:
    """Compile the kernels of the second process: half of the work."""
    for kernel, arguments in kernels_beside():
        compile_for(kernel, arguments)


def kernels_beside() -> list[tuple[Any, tuple[Any, ...]]]:
    """Kernels of the second process, with arguments of the types with which a film calls them.

    They stand in the order in which the film needs them: four before those of whole lines, which take the first
    process longest, the others after them. Those of flanks are parts: the rest needs the kernel of a line.
    """
    level = Level(MoesPoint(200, 10, 0.5), Domain(), 16, 8)  # types are the same for all
    level.team = level.deflection.team = calls = _Calls()
    level.deflection(level.P)
    level.update_residual()
    level.relax()
    f, law, numbers, c_t, near, marks = level.fields, level.law, level.stencil, level.c_t, level.near, level.marks
    places, square, found = np.zeros(1, np.int64), np.zeros((1, 1)), np.zeros((1, 3), np.int64)
    return [
        calls.of(fourier.back_across_lines),
        (dense_jacobian, (places, f.p_coef, f.h_coef, level.deflection.kernel, places, square)),
        calls.of(reynolds.residual_lines),
        calls.of(relax.distribution_weights),
        calls.of(relax.apply_lines),
        calls.of(cavitation.relax_boundary_blocks),
        (flanks.mark_front, (0, 1, f.P, f.flow.eps, marks)),
        (flanks.segments, (0, 1, marks, flanks.SOLVED)),
        (flanks.spread_segments, (found, found, 0, f, law, numbers, near)),
        (flanks.update_between_segments, (found, f.flow)),
        (flanks.weigh_segments, (found, f, numbers, c_t)),
        (transfer.restrict_pressure, (f.P, f.P, 2, 2)),
        (transfer.full_weighting, (level.r, level.rhs, 2, 2)),
        (transfer.add_correction, (f.P, f.P, f.P, 2, 2)),
        (lowest_of_cells, (f.H, places, places, square)),
    ]


class _Calls(Team):
    """Notes the kernels it is to run, and their arguments."""

    def __init__(self) -> None:
        super().__init__()
        self._found: list[tuple[Kernel, tuple[Any, ...]]] = []

    def run(self, kernel: Kernel, count: int, *args: Any, least: int = 0) -> None:
        self._found.append((kernel, (0, count, *args)))

    def of(self, kernel: Kernel) -> tuple[Kernel, tuple[Any, ...]]:
        """A kernel and the arguments of its first call."""
        return next(call for call in self._found if call[0] is kernel)
