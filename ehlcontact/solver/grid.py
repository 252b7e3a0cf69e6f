"""Grid of a solve as a user gives it: intervals, computed region, and engine of the elastic deflection."""

from __future__ import annotations

from dataclasses import dataclass

from ehlcontact.checks import require_choice, require_instance
from ehlcontact.solver.deflection import ENGINES
from ehlcontact.solver.domain import Domain, check_intervals


@dataclass(frozen=True, slots=True)
class Grid:
    """Grid of a solve; what is left out is chosen for the film to be expected.

    Parameters
    ----------
    n : int, optional
        Intervals along X, a multiple of 16.
    domain : Domain, optional
        Computed region.
    deflection : {"fft", "mlmi", "direct"}
        Engine of the elastic deflection: fast Fourier transforms, exact to rounding; multilevel multi-integration;
        the direct sum, slow. See `ehlcontact.solver.deflection`.

    Raises
    ------
    InputError
        n not a multiple of 16 from 16 to 2048, a domain that is no `Domain`, an unknown engine.
    """

    n: int | None = None
    domain: Domain | None = None
    deflection: str = "fft"

    def __post_init__(self) -> None:
        if self.n is not None:
            object.__setattr__(self, "n", check_intervals(self.n))
        if self.domain is not None:
            require_instance("domain", self.domain, Domain, "a Domain(x_in, x_out, y_max)")
        require_choice("deflection", self.deflection, tuple(ENGINES))


AUTOMATIC = Grid()


def require_grid(grid: object) -> None:
    """Raise `InputError` unless this is a `Grid`."""
    require_instance("grid", grid, Grid, "a Grid(n=..., domain=..., deflection=...)")
