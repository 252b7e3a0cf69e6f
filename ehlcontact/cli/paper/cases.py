"""The simulations behind the paper's tables and figures."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from ehlcontact.point import MoesPoint
from ehlcontact.solver.domain import Domain
from ehlcontact.transient.motion import FreeVibration, HarmonicLoad, Motion, RampLoad

POINT = MoesPoint(200.0, 10.0, 0.5)
VALIDATION_POINT = MoesPoint(58.07, 4.62, 1.0)
# Fig. 2: approach over M at three L; the paper does not say for which ellipse. A circle, as Wijnant's formula.
STATIC_LOADS = (10.0, 20.0, 50.0, 100.0, 200.0, 500.0)
STATIC_OILS = (0.0, 15.0, 20.0)


@dataclass(frozen=True, slots=True)
class Case:
    """One transient simulation."""

    name: str  # as in the paper's tables: 1 to 6, validation
    title: str
    motion: Motion
    point: MoesPoint = POINT
    domain: Domain | None = None
    until: float | None = None
    snapshots: tuple[float, ...] = ()

    def file(self, n: int) -> str:
        """Name of its file on `n` intervals."""
        return f"case_{self.name}_n{n}.h5"


CASES = {
    case.name: case
    for case in (
        Case("1", "free vibration, Omega_n = 10.26", FreeVibration(10.26)),
        Case(
            "2",
            "free vibration, Omega_n = 5.13",
            FreeVibration(5.13),
            snapshots=tuple(0.25 * k for k in range(8)),
        ),
        Case("3", "free vibration, Omega_n = 2.56", FreeVibration(2.56)),
        Case("4", "harmonic load, Omega = pi", HarmonicLoad(pi)),
        Case("5", "harmonic load, Omega = 2 pi", HarmonicLoad(2.0 * pi), snapshots=(0.0, 0.5, 1.0, 2.0)),
        Case("6", "harmonic load, Omega = 4 pi", HarmonicLoad(4.0 * pi)),
        Case(
            "validation",
            "load ramp, Omega_n = 2.4",
            RampLoad(3.67, 1.69, 2.4),
            VALIDATION_POINT,
            Domain(-5.0, 3.0, 4.0),
            5.6,
            tuple(0.8 * k for k in range(8)),
        ),
    )
}
FREE, HARMONIC, RAMP = ("1", "2", "3"), ("4", "5", "6"), ("validation",)
