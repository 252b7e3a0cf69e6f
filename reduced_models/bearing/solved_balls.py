"""Small motion of a bearing under an oil supply with the impedance of its solved contacts, of either sign.

Elements are passive, so they do not have the negative damping of starved contacts at low frequencies. The atlas
has the impedance of each contact; that of the bearing follows with both races of a ball in series, as in
`reduced_models.bearing.linear_balls`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduced_models.bearing.equilibrium import RingEquilibrium
from reduced_models.bearing.linear_balls import TINY_OMEGA, SmallBalls
from reduced_models.bearing.race import RACES, Race

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

ALIKE = 9  # digits to which the loads of two balls are the same


class SolvedContacts(NamedTuple):
    """Impedance of k contacts [N/m] at frequencies chosen before, shape (frequencies, k)."""

    Z: _Complex

    def impedance(self, s: ArrayLike) -> _Complex:
        """At those frequencies, which `s` has again."""
        return self.Z


def signed_damping(
    bearing: Any, speed_rpm: float, small: SmallBalls, equilibria: Sequence[RingEquilibrium], omega: _Floats
) -> _Floats:
    """C [N s/m] of a `BallBearing`, shape (k, 2, 2), at angular frequencies [rad/s], shape (k,).

    `small` is the bearing about the same equilibria with its elements, whose inertia and losses count.
    """
    force = np.concatenate([at.force for at in equilibria])
    races = (bearing.race(name) for name in RACES)
    inner, outer = (
        SolvedContacts(_solved(race, speed_rpm, loads, omega)) for race, loads in zip(races, force.T, strict=True)
    )
    w = np.maximum(omega, TINY_OMEGA)
    Z = small._replace(inner=inner, outer=outer).impedance(1j * w)  # type: ignore[arg-type]
    return np.asarray(Z.imag / w[:, None, None])


def _solved(race: Race, speed_rpm: float, loads: _Floats, omega: _Floats) -> _Complex:
    """Impedance of contacts under loads [N], shape (frequencies, contacts); 0 below the lightest of the atlas."""
    found = np.zeros((omega.size, loads.size), complex)
    rounded = np.array([float(f"{load:.{ALIKE}g}") for load in loads.tolist()])
    for load in np.unique(rounded[rounded > race.loads(speed_rpm)[0]]).tolist():
        at = race.answer(load, speed_rpm).impedance(omega=omega).si
        found[:, rounded == load] = (at.stiffness + 1j * omega * at.damping)[:, None]
    return found
