"""Small motion of a bearing under an oil supply with the impedance of its solved contacts, of either sign.

Elements are passive, so they do not have the negative damping of starved contacts at low frequencies. The atlas
has the impedance of each contact; that of the bearing follows with both races of a ball in series, as in
`reduced_models.bearing.linear_balls`.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reduced_models.atlas.atlas import NEGATIVE
from reduced_models.bearing.equilibrium import RingEquilibrium
from reduced_models.bearing.linear_balls import TINY_OMEGA, SmallBalls
from reduced_models.bearing.race import INSIDE, RACES, Race
from reduced_models.elements.validity import OutsideValidityWarning

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

ALIKE = 9  # digits to which the loads of two balls are the same
WARNED = "warned of damping left out"  # where a bearing keeps that


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
    force, w = np.concatenate([at.force for at in equilibria]), np.maximum(omega, TINY_OMEGA)
    races = (bearing.race(name) for name in RACES)
    inner, outer = (
        SolvedContacts(_solved(race, speed_rpm, loads, w)) for race, loads in zip(races, force.T, strict=True)
    )
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


def damping_left_out(bearing: Any, speed_rpm: float, force: _Floats) -> str:
    """Damping below zero that the elements of a `BallBearing` leave out, in words; empty where there is none.

    Parameters
    ----------
    bearing : BallBearing
    speed_rpm : float
        Of the shaft [rev/min].
    force : ndarray, shape (..., 2)
        On the balls at the inner and the outer race [N]; the contacts under the largest are asked.
    """
    if bearing.supply is None:
        return ""
    most = np.reshape(force, (-1, len(RACES))).max(axis=0).tolist()
    contacts = [_below_zero(bearing.race(name), speed_rpm, load) for name, load in zip(RACES, most, strict=True)]
    hz, least = max(contact[0] for contact in contacts), min(contact[1] for contact in contacts)
    if hz == 0.0:
        return ""
    hz, least = (float(f"{number:.3g}") for number in (hz, least))
    return (
        f"under this layer the solver finds damping of a contact below zero below {hz:g} Hz "
        f"(as low as {least:g} N s/m); elements leave it out: decrements are too high"
    )


def warn_of_damping_left_out(bearing: Any, name: str, words: str, stacklevel: int) -> None:
    """Warn, once per bearing, of what `damping_left_out` says; `name` is that of the bearing."""
    if words and WARNED not in bearing._cache:
        bearing._cache[WARNED] = True
        warnings.warn(f"{name}: {words}", OutsideValidityWarning, stacklevel=stacklevel + 1)


def _below_zero(race: Race, speed_rpm: float, load: float) -> tuple[float, float]:
    """Frequency [Hz] from 0 up to which C of a contact is below zero, and its least there [N s/m]; or zeros."""
    if load <= race.loads(speed_rpm)[0]:
        return 0.0, 0.0
    bearable = race.heaviest(speed_rpm)[0] * (1.0 - INSIDE)
    at = race.answer(min(load, bearable), speed_rpm).si
    C, hz = at.damping, at.hz
    if not C[0] < -NEGATIVE * np.abs(C).max():
        return 0.0, 0.0
    end = int(np.argmax(C >= 0.0))  # 0: below zero at all frequencies
    crossing = hz[end - 1] + (hz[end] - hz[end - 1]) * C[end - 1] / (C[end - 1] - C[end]) if end else hz[-1]
    return float(crossing), float(C[:end].min() if end else C.min())
