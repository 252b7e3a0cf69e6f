"""Grids of a point of the atlas: for steady film and impedance, for a finer film, for both regions.

A grid follows from the width of the inlet, in Hertz semi-axes (`MoesPoint.inlet_width`), and from the load number.
"""

from __future__ import annotations

from typing import NamedTuple

from ehlcontact import Domain, Grid, InputError, MoesPoint


class TableGrid(NamedTuple):
    """Grid for inlets of at least this width."""

    least_inlet: float
    n: int
    near: bool  # on `Domain.near()`, otherwise on the default region

    def on(self, point: MoesPoint) -> Grid:
        """Return the grid of this row for a point."""
        return Grid(self.n, Domain.near() if self.near else Domain.for_point(point))


# The mesh is about a third of the inlet width, half of it at most. Thinner films than the last are left out.
GRIDS = (
    TableGrid(0.13, 128, False),
    TableGrid(0.09, 192, False),
    TableGrid(0.05, 192, True),
    TableGrid(0.025, 256, True),
    TableGrid(0.0165, 384, True),
    TableGrid(0.0115, 512, True),
)
LIGHT_LOAD, LIGHT_INTERVALS = 4.5, 96  # a load number below which few intervals resolve the thick film
# Below FILM_INLET the film by itself is solved once more: on more intervals, if possible with all the oil.
FILM_INLET = 0.3
FILM_GRIDS = (
    TableGrid(0.13, 256, False),
    TableGrid(0.09, 384, False),
    TableGrid(0.05, 768, False),
    TableGrid(0.033, 1024, False),
    TableGrid(0.0, 1024, True),
)
# Inlet widths at which both regions are solved, for the difference that the oil further out makes.
BOTH_REGIONS, NEAR_INTERVALS = (0.1, 0.16), 128


def impedance_grid(point: MoesPoint) -> Grid:
    """Return the grid of steady film and impedance.

    Raises
    ------
    InputError
        A film too thin for any mesh that is affordable for a table.
    """
    width = point.inlet_width
    if point.load_number < LIGHT_LOAD:
        return Grid(LIGHT_INTERVALS, Domain.for_point(point))
    if width < GRIDS[-1].least_inlet:
        allowed = f"at least {GRIDS[-1].least_inlet} semi-axes, for a mesh that a table can afford"
        raise InputError("inlet width", f"{width:.3g}", allowed)
    return _first(GRIDS, point)


def film_grid(point: MoesPoint) -> Grid:
    """Return the grid of the steady film alone; that of the impedance where the film needs no finer one."""
    grid = impedance_grid(point)
    return _first(FILM_GRIDS, point) if point.inlet_width < FILM_INLET else grid


def near_grid(point: MoesPoint) -> Grid:
    """Return the grid on the near region where both regions are solved; else that of the impedance."""
    low, high = BOTH_REGIONS
    grid = impedance_grid(point)
    return Grid(NEAR_INTERVALS, Domain.near()) if low <= point.inlet_width < high else grid


def _first(grids: tuple[TableGrid, ...], point: MoesPoint) -> Grid:
    """Return the first of the grids that serves an inlet as narrow as this."""
    return next(grid for grid in grids if point.inlet_width >= grid.least_inlet).on(point)
