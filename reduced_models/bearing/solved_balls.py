"""Small motion of a bearing under an oil supply with the impedance of its solved contacts, of either sign.

Elements are passive, so they do not have the negative damping of starved contacts at low frequencies. The atlas
has the impedance of each contact; that of the bearing follows as in `reduced_models.bearing.linear_balls`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.errors import warn_user
from reduced_models.atlas.answer import AtlasAnswer
from reduced_models.atlas.atlas import NEGATIVE
from reduced_models.atlas.frequency_curve import FrequencyCurve
from reduced_models.bearing.linear_balls import LinearBalls
from reduced_models.bearing.race import INSIDE, RACES, Race, races_at_angles
from reduced_models.elements.validity import OutsideValidityWarning

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

ALIKE = 9  # digits to which the loads, angles and speeds of two contacts are the same


class SolvedContacts:
    """Contacts with the impedance that the atlas has of each over real frequencies.

    At a complex s it is K + s C at the frequency of s, as of `reduced_models.rotor.linear_contact`. Beyond the
    highest frequency of the atlas K and C stay what they are there.

    Parameters
    ----------
    contacts : sequence of sequence of (Race, float)
        Race and load [N] of each contact with the inner and the outer race; one lighter than the atlas knows
        carries nothing.
    speed_rpm : float
        Of the shaft [rev/min].
    """

    def __init__(self, contacts: Sequence[Sequence[tuple[Race, float]]], speed_rpm: float) -> None:
        keys, found = [], {}
        for race, load in (contact for column in contacts for contact in column):
            sizes = load, race.geometry.radius_x, race.speed_sum
            keys.append(tuple(float(f"{size:.{ALIKE}g}") for size in sizes))
            rounded = keys[-1][0]
            if keys[-1] not in found and rounded > race.loads(speed_rpm)[0]:
                found[keys[-1]] = race.answer(rounded, speed_rpm)
        self.answers: list[AtlasAnswer] = list(found.values())
        places = [list(found).index(key) if key in found else len(found) for key in keys]
        self._of = np.reshape(places, (len(contacts), -1))
        self._curves = _Curves(self.answers) if found else None

    def impedance(self, s: ArrayLike) -> _Complex:
        """Z [N/m] at s [1/s] of exp(s t), shape of `s`, whose last axes are (1, 1), with that of the contacts."""
        s = np.asarray(s, complex)[..., 0]
        Z = np.zeros((*s.shape[:-1], len(self.answers) + 1), complex)
        if self._curves is not None:
            K, C = self._curves.at(np.abs(s.imag))
            Z[..., :-1] = K + s * C
        return Z[..., self._of]


class _Curves:
    """K [N/m] and C [N s/m] of many answers over the angular frequency: those of `AtlasAnswer.impedance`."""

    def __init__(self, answers: Sequence[AtlasAnswer]) -> None:
        scales, own = [one.point.scales for one in answers], [one.dimensionless for one in answers]
        self._time, *self._units = np.array([(one.time, one.stiffness, one.damping) for one in scales]).T
        nodes = own[0].omega  # of one table, so the same for all
        self._highest, self._x = nodes[-1], np.arcsinh(nodes)
        self._cubics = [
            np.stack([FrequencyCurve(nodes, getattr(one, name)).coefficients for one in own], axis=-1)
            for name in ("stiffness", "damping")
        ]

    def at(self, omega: _Floats) -> tuple[_Floats, _Floats]:
        """K and C, shape (..., answers), at frequencies [rad/s], shape (..., 1)."""
        x = np.arcsinh(np.minimum(omega * self._time, self._highest))
        interval = np.clip(np.searchsorted(self._x, x, side="right") - 1, 0, self._x.size - 2)
        t, which = x - self._x[interval], np.arange(self._time.size)
        powers = 1.0, t, t * t, t * t * t
        K, C = (
            sum(cubic[3 - k, interval, which] * power for k, power in enumerate(powers)) * unit
            for cubic, unit in zip(self._cubics, self._units, strict=True)
        )
        return K, C


def with_solved_contacts(
    bearing: Any, speed_rpm: float, small: LinearBalls, equilibria: Sequence[Any]
) -> LinearBalls:
    """A `BallBearing` about equilibrium with impedances of its solved contacts in place of its elements'.

    Flooded bearings stay as they are: their elements leave out nothing. `small` is the bearing about the
    `equilibria`, with its inertia and losses.

    Raises
    ------
    InputError
        A contact that the table of oil supply does not have.
    """
    if bearing.supply is None:
        return small
    force = np.concatenate([at.force for at in equilibria])
    columns = []
    for column, name in enumerate(RACES):
        angles, speeds = (
            np.concatenate([getattr(at, what)[:, column] for at in equilibria]) for what in ("angles", "speed_sum")
        )
        races = races_at_angles(bearing, name, angles, speeds)
        loads = force[:, column].tolist()
        columns.append(list(zip(races, loads, strict=True)))
    return replace(small, films=SolvedContacts(columns, speed_rpm))  # type: ignore[arg-type]


def signed_damping(
    bearing: Any, speed_rpm: float, small: LinearBalls, equilibria: Sequence[Any], omega: _Floats
) -> Any:
    """C [N s/m] of a `BallBearing` by its solved contacts, shape (k, n, n), at angular frequencies [rad/s], (k,).

    None of a flooded bearing. Raises `InputError` above the highest frequency of the atlas.
    """
    if bearing.supply is None:
        return None
    solved = with_solved_contacts(bearing, speed_rpm, small, equilibria)
    require_frequencies(solved, omega)
    return solved.coefficients(omega)[1]


def require_frequencies(solved: Any, omega: _Floats) -> None:
    """Raise `InputError` above the highest frequency that the atlas has of solved contacts."""
    for answer in solved.films.answers:
        answer.impedance(omega=omega.max())


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


def warn_of_damping_left_out(bearing: Any, name: str, words: str) -> None:
    """Warn, once per bearing, of what `damping_left_out` says; `name` is that of the bearing."""
    if words and not bearing.tables.warned:
        bearing.tables.warned = True
        warn_user(f"{name}: {words}", OutsideValidityWarning)


def _below_zero(race: Race, speed_rpm: float, load: float) -> tuple[float, float]:
    """Frequency [Hz] from 0 up to which C of a contact is below zero, and its least there [N s/m]; or zeros."""
    if load <= race.loads(speed_rpm)[0]:
        return 0.0, 0.0
    bearable = race.heaviest(speed_rpm)[0] * (1.0 - INSIDE)
    at = race.answer(min(load, bearable), speed_rpm)
    C, hz = at.damping, at.hz
    if not C[0] < -NEGATIVE * np.abs(C).max():
        return 0.0, 0.0
    end = int(np.argmax(C >= 0.0))  # 0: below zero at all frequencies
    crossing = hz[end - 1] + (hz[end] - hz[end - 1]) * C[end - 1] / (C[end - 1] - C[end]) if end else hz[-1]
    return float(crossing), float(C[:end].min() if end else C.min())
