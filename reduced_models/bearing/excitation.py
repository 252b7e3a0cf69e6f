"""Forces by which features of balls and races excite a bearing whose ring is held: lines over the shaft's turns.

A height h, positive out of the surface, presses its contact by Z W h, with the impedance Z of the film and the
contact filter W over the wave number k per semi-axis: of a film G/Z by `reduced_models.atlas.waves`, of
a dry contact sin(k)/k. The ball follows as in `linear_balls`: with the balance R of a ball
over its place b and the force P of the ring on it,

    R_b db + R_h = 0,    R_h = Z_i W_i h_i n_i - Z_o W_o h_o n_o,    dP = P_h + P_b db,    P_h = Z_i W_i h_i n_i,

at the frequency at which the ball meets the waves, while it stands at psi: the force D(psi) per height, the sum of
D_m exp(i m psi) over m. The n waves of a race that has turned by r are met by all Z balls. With the cage at theta
their forces add up where m + n is a multiple of Z:

    F = Re sum over j of Z D_(jZ-n) A exp(i (j Z theta - n r - phase)).

Where contact angles vary around the orbit, so do the turns of a ball about its axis: its n waves lead
their mean by n phi(psi), and D is multiplied by exp(i n phi), which adds lines n BSF + m FTF.

Under axial load D has m = 0 along the shaft and m = +-1 across it and in tilts. So waves of n = kZ excite axial
vibrations and n = kZ +- 1 radial ones and tilts: those of the inner race at the orders k BPFI and k BPFI +- 1, of
the outer race at k BPFO (the table of Wardle, Proc. IMechE C 202 (1988) 305).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ceil
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact import Dent
from ehlcontact.checks import parts, require_instance
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.hertz import hertz_contact
from ehlcontact.quantities import FORCE, HERTZ, LENGTH, NUMBER, RADIAN, SPEED, Quantity
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.summary import span
from reduced_models.atlas.waves import SHORTER, ContactFilters, dry_filter, filters_of, last_wave_number
from reduced_models.bearing.features import (
    FEATURES,
    BallDiameter,
    BallWaviness,
    Feature,
    RaceWaviness,
)
from reduced_models.bearing.freedoms import PLANAR, in_freedoms, labelled, load_words
from reduced_models.bearing.height_tables import profile_of, track_radius
from reduced_models.bearing.kinematics import RPM_TO_HZ, RPM_TO_RAD_S, DefectOrders
from reduced_models.bearing.linear_balls import LinearBalls
from reduced_models.bearing.race import RACES
from reduced_models.bearing.ring import RingEquilibrium

if TYPE_CHECKING:
    from reduced_models.bearing.ball_bearing import BallBearing

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

NO_LINE = 1e-6  # of the height over the approach of the most loaded ball times its force: below is rounding
SAME_ORDER = 9  # decimal places of orders that are one line
SHORTEST = (
    4.0 * np.pi
)  # wave number per semi-axis of the most loaded ball, to which defects are waves: 8 % get through
SWING = 1e-6  # of the phase of waves per radian of the orbit, below which it is rounding
TOGETHER = 64  # waves whose forces are worked out in one go: a few MB
FILTERS = ("film", "dry", "none")
HIGHEST = 0.01  # of a ball's diameter: amplitudes, rims, excess diameters
LARGE = 0.1  # height over the approach of both contacts of the most loaded ball, from which a result says so


@dataclass(frozen=True, eq=False)
class BearingExcitation(QuantityTable):
    """Forces of the balls on a ring that is held in n = 2 or 5 degrees of freedom, as lines.

    ``F = Re sum of amplitude exp(i (2 pi order turns + phase))`` over the turns of the shaft, beside the load.

    Attributes
    ----------
    order : ndarray, shape (lines,)
        Of the lines, per turn of the shaft, increasing; ``hz`` has them in Hz.
    amplitude : ndarray, shape (lines, n)
        In x, y (, z, tilt_x, tilt_y) [N], [N m].
    phase : ndarray, shape (lines, n)
        In rad.
    load : ndarray, shape (n,)
        Force on the ring [N], [N m].
    speed_rpm : float
        Of the shaft.
    height : float
        Largest amplitude of the features [m], half of a ball's excess diameter.
    approach : float
        Of both contacts of the most loaded ball together [m].
    short_waves : int
        Largest number of waves of a waviness shorter than those of the table of contact filters; 0 without one.
    """

    order: Annotated[_Floats, NUMBER.over("order")]
    amplitude: Annotated[_Floats, FORCE.over("order axis")]
    phase: Annotated[_Floats, RADIAN.over("order axis")]
    load: Annotated[_Floats, FORCE.over("axis")]
    speed_rpm: Annotated[float, SPEED]
    height: Annotated[float, LENGTH]
    approach: Annotated[float, LENGTH]
    short_waves: int = 0

    DISPLAY: ClassVar[Display] = Display(rows="order", panels=("amplitude",), labels={"axis": ("x", "y")})

    @property
    def hz(self) -> Annotated[_Floats, HERTZ.over("order")]:
        """Frequencies of the lines [Hz]."""
        return np.asarray(self.order * self.speed_rpm * RPM_TO_HZ)

    @property
    def loses_load(self) -> bool:
        """Whether heights are at least the approach of the most loaded ball: linear forces then mean nothing."""
        return self.height >= self.approach

    @property
    def reservation(self) -> str:
        """What the result leaves open, in words; else empty.

        Heights for which contacts are not linear, and waves whose contact filter is not in the table.
        """
        notes, share = [], 100.0 * self.height / self.approach
        if self.loses_load:
            notes.append(
                f"features of {1e6 * self.height:.3g} um are {self.height / self.approach:.2g} times the approach"
                " of the most loaded ball: forces are not linear in them, and those here mean nothing: a ball"
                " loses its load over a pit or dent; simulate_rotor computes the force (docs/defects.md)"
            )
        elif self.height > LARGE * self.approach:
            notes.append(
                f"features are {share:.2g} % of the approach of the most loaded ball:"
                " forces are not linear in them"
            )
        if self.short_waves:
            notes.append(
                f"{self.short_waves} waves are shorter than those of the table of contact filters at the most"
                f" loaded ball: its filter is taken as 0 ± {SHORTER:g}, and lines of lighter contacts remain"
            )
        return "; ".join(notes)

    @takes(turns=parts.ANY)
    def force(self, turns: ArrayLike) -> _Floats:
        """Forces [N], [N m] at these turns of the shaft, shape of `turns` + (n,)."""
        at = np.exp(2j * np.pi * np.asarray(turns, float)[..., None] * self.order)
        return np.asarray((at @ (self.amplitude * np.exp(1j * self.phase))).real)

    def _quantities(self) -> Mapping[str, Quantity]:
        return in_freedoms(super()._quantities(), self.load.size)

    def _display(self) -> Display:
        return labelled(super()._display(), self.load.size)

    def _summary_lines(self) -> list[str]:
        largest = self.amplitude.max(axis=0, initial=0.0)
        axial = [] if largest.size == len(PLANAR) else [f"axial up to {largest[2]:.4g} N"]
        moments = [] if not axial else [f"moments up to {largest[3:].max():.4g} N m"]
        return [
            f"load {load_words(self.load)} at {self.speed_rpm:.5g} rev/min",
            f"features up to {1e6 * self.height:.4g} µm: {self.order.size} lines of orders {span(self.order)}",
            ", ".join([f"radial up to {largest[:2].max():.4g} N", *axial, *moments]),
            *filter(None, [self.reservation]),
        ]

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        return super().to_dict() | {"reservation": self.reservation}


@dataclass(frozen=True)
class FeaturedBalls:
    """All balls of a bearing about static equilibrium, at positions of the cage over a ball passage.

    Parameters
    ----------
    bearing : BallBearing
    small : LinearBalls
        At these positions.
    force : ndarray, shape (positions, balls, 2)
        Static forces at the inner and the outer race [N].
    first : float
        Angle of the first ball at the first position [rad].
    speed_rpm, cage : float
        Of the shaft [rev/min]; turns of the cage per turn of the shaft, or of one ring against the other.
    contact_filter : {"film", "dry", "none"}
        As in `BallBearing.excitation`.
    rotations : ndarray, shape (positions, balls)
        Turns of every ball about its axis per turn of the shaft, which vary with the contact angles; below 0 where
        the outer ring turns.
    """

    bearing: BallBearing
    small: LinearBalls
    force: _Floats
    first: float
    speed_rpm: float
    cage: float
    rotations: _Floats
    contact_filter: str = FILTERS[0]

    def harmonics(self, order: _Floats, inner: _Complex, outer: _Complex) -> tuple[NDArray[np.int64], _Complex]:
        """Numbers m (l,) and forces D_m on the ring, (k, l, n), by heights met `order`, (k,), times per turn.

        `inner` and `outer` are the heights at both contacts of every ball, filtered, that broadcast against
        (k, positions * balls).
        """
        s = 1j * np.abs(order) * self.speed_rpm * RPM_TO_RAD_S
        forces = self.small.force_of_heights(s, inner, outer)
        forces = np.where(order[:, None, None] < 0.0, forces.conj(), forces)
        positions, balls, _ = self.force.shape
        size = positions * balls
        around = forces.reshape(order.size, positions, balls, -1).swapaxes(1, 2).reshape(order.size, size, -1)
        m = np.fft.fftfreq(size, 1.0 / size).round().astype(np.int64)
        found = np.fft.fft(around, axis=1) * (np.exp(-1j * m * self.first) / size)[:, None]
        kept = np.abs(m) < size / 2.0
        return m[kept], found[:, kept]

    def filters(self, waves: NDArray[np.int64], name: str, ball: bool) -> _Complex:
        """Contact filters of k waves around a race, or the ball, at the contacts with a race.

        (k, positions * balls).
        """
        j = RACES.index(name)
        k = waves[:, None] * (self._semi_axes[j].ravel() / self._radius(name, ball))
        if self.contact_filter == "none":
            return np.ones_like(k, complex)
        return dry_filter(k).astype(complex) if self._films is None else self._films[j].at(k)[0]

    def _radius(self, race: str, ball: bool) -> float:
        """Of the track of a race, or of a ball [m]."""
        return 0.5 * self.bearing.ball_diameter if ball else track_radius(self.bearing, race)

    @cached_property
    def _semi_axes(self) -> list[_Floats]:
        """Of the contacts with both races along rolling, (positions, balls) [m]."""
        bodies = [self.bearing.race(name).geometry for name in RACES]
        units = [hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced).a for body in bodies]
        return [unit * np.cbrt(self.force[..., j]) for j, unit in enumerate(units)]

    @cached_property
    def _films(self) -> list[ContactFilters] | None:
        """Contact filters of the films of both races; None where they are those of dry contacts."""
        if self.bearing.oil is None or self.contact_filter == "dry":
            return None
        found = []
        for j, name in enumerate(RACES):
            unit, M = self.bearing.race(name).point(1.0, self.speed_rpm).moes, self.force[..., j].ravel()
            rows = np.column_stack([unit.M * M, np.full(M.size, unit.L), np.full(M.size, unit.kappa)])
            found.append(filters_of(rows))
        return found

    def lines(self, features: Sequence[Feature], cage_angle: float) -> tuple[_Floats, _Complex]:
        """Orders of the lines of all features, (l,), negative ones too, and complex forces, (l, n)."""
        waves: dict[str | None, list[tuple[int, complex, int]]] = {}  # of both races, and of balls
        for feature in features:
            race, ball = getattr(feature, "race", None), getattr(feature, "ball", None)
            own = waves.setdefault(race if ball is None else None, [])
            own += [(n, amplitude, ball or 0) for n, amplitude in self.waves_of(feature)]
        found = []
        for surface, every in waves.items():
            for start in range(0, len(every), TOGETHER):
                n, amplitude, ball = map(np.array, zip(*every[start : start + TOGETHER], strict=True))
                if surface is None:
                    found += self._ball_lines(n, amplitude, ball, cage_angle)
                else:
                    found.append(self._race_lines(surface, n, amplitude, cage_angle))
        order, force = zip(*found, strict=True)
        return np.concatenate(order), np.concatenate(force)

    def short_waves(self, feature: Feature) -> int:
        """Number of waves of a waviness that are shorter than any of the table of contact filters; else 0."""
        if not isinstance(feature, RaceWaviness | BallWaviness) or self.contact_filter != FILTERS[0]:
            return 0
        if self._films is None:
            return 0
        ball = isinstance(feature, BallWaviness)
        k = [
            feature.waves * float(self._semi_axes[j].max()) / self._radius(name, ball)
            for j, name in enumerate(RACES)
            if name == getattr(feature, "race", name)
        ]
        return feature.waves if max(k) > last_wave_number() else 0

    def waves_of(self, feature: Feature) -> list[tuple[int, complex]]:
        """Waves n around a race or a ball and their complex amplitudes: heights ``Re sum A exp(i n theta)``."""
        if isinstance(feature, BallDiameter):
            return [(0, complex(0.5 * feature.excess))]
        if isinstance(feature, RaceWaviness | BallWaviness):
            return [(feature.waves, feature.amplitude * np.exp(-1j * feature.phase))]
        race = feature.race or "inner"
        radius = 0.5 * self.bearing.ball_diameter if feature.race is None else track_radius(self.bearing, race)
        profile = profile_of(self.bearing, [feature], race, radius)
        amplitude = np.fft.rfft(profile)[: profile.size // 2] * 2.0 / profile.size
        amplitude[0] *= 0.5
        body = self.bearing.race(race).geometry
        a = hertz_contact(float(self.force.max()), body.radius_x, body.radius_y, body.e_reduced).a
        last = min(int(SHORTEST * radius / a), amplitude.size - 1)
        return list(enumerate(amplitude[: last + 1].tolist()))

    @cached_property
    def _ball_turns(self) -> tuple[float, _Complex]:
        """Mean turns of a ball per turn of the shaft, and harmonics m >= 0 of what it leads that mean by [rad].

        The harmonics r_m of its turns around the orbit lead by r_m/(i m cage) exp(i m psi).
        """
        around = self.rotations.T.ravel()
        found = np.fft.rfft(around)[: (around.size + 1) // 2] / around.size
        m = np.arange(found.size)
        lead = 2.0 * found * np.exp(-1j * m * self.first) / (1j * np.maximum(m, 1) * self.cage)
        lead[0] = 0.0
        return float(found[0].real), lead

    def _race_lines(
        self, race: str, n: NDArray[np.int64], amplitude: _Complex, cage_angle: float
    ) -> tuple[_Floats, _Complex]:
        balls, none = self.force.shape[1], np.zeros((1, 1), complex)
        turning = self.bearing.ring_speeds[RACES.index(race)]
        filters = self.filters(n, race, ball=False)
        heights = (filters, none) if race == "inner" else (none, filters)
        m, D = self.harmonics(np.asarray(n * (self.cage - turning), float), *heights)
        number = m + n[:, None]
        i, met = np.nonzero(number % balls == 0)
        number = number[i, met]
        scale = balls * amplitude[i] * np.exp(1j * number * cage_angle)
        return number * self.cage - n[i] * turning, D[i, met] * scale[:, None]

    def _ball_lines(
        self, n: NDArray[np.int64], amplitude: _Complex, ball: NDArray[np.int64], cage_angle: float
    ) -> list[tuple[_Floats, _Complex]]:
        inner, outer = (self.filters(n, name, ball=True) for name in RACES)
        mean, lead = self._ball_turns
        m, D = self.harmonics(np.asarray(n * mean, float), inner, outer * (-1.0) ** n[:, None])
        psi = cage_angle + 2.0 * np.pi * ball / self.force.shape[1]
        found = []
        for waves, height, start, force in zip(n.tolist(), amplitude, psi, D, strict=True):
            number, own = _modulated(m, force, waves * lead, start)
            scale = height * np.exp(1j * number * start)
            found.append((number * self.cage + waves * mean, own * scale[:, None]))
        return found


def _modulated(
    m: NDArray[np.int64], D: _Complex, lead: _Complex, start: float
) -> tuple[NDArray[np.int64], _Complex]:
    """Harmonics (k, n) around the orbit of the D_m times exp(i phi): phi is 0 where the ball starts."""
    numbers = np.arange(lead.size)
    swing = float(np.sum(np.abs(lead) * numbers))  # rate of phi: shifts of m
    if swing < SWING:
        return m, D
    points = 2 ** ceil(np.log2(4.0 * (np.abs(m).max() + swing)))
    phi = points * np.fft.ifft(lead, points).real - (np.exp(1j * start * numbers) @ lead).real
    spectrum = np.zeros((points, D.shape[1]), complex)
    spectrum[m] = D
    force = np.fft.ifft(spectrum, axis=0) * np.exp(1j * phi)[:, None]
    return np.fft.fftfreq(points, 1.0 / points).round().astype(np.int64), np.fft.fft(force, axis=0)


def excitation_of(
    balls: FeaturedBalls, load: _Floats, approach: float, features: Sequence[Feature], cage_angle: float
) -> BearingExcitation:
    """Lines of all features together, those of one order added."""
    signed, lines = balls.lines(features, cage_angle)
    order, place = np.unique(np.round(np.abs(signed), SAME_ORDER), return_inverse=True)
    force = np.zeros((order.size, load.size), complex)
    np.add.at(force, place, np.where(signed[:, None] < 0.0, lines.conj(), lines))
    force[order == 0.0] = force[order == 0.0].real
    heights = [_height(one) for one in features]
    unit = np.ones(load.size)
    unit[3:] = 0.5 * balls.bearing.pitch_diameter
    least = NO_LINE * max(heights) * balls.force.max() / approach
    kept = (np.abs(force) / unit).max(axis=1) > least
    force, order = force[kept], order[kept]
    short = max(balls.short_waves(one) for one in features)
    return BearingExcitation(
        order, np.abs(force), np.angle(force), load, balls.speed_rpm, max(heights), approach, short
    )


def _height(feature: Feature) -> float:
    if isinstance(feature, BallDiameter):
        return 0.5 * abs(feature.excess)
    return feature.amplitude if isinstance(feature, RaceWaviness | BallWaviness) else feature.depth


def require_features(features: object, balls: int, ball_diameter: float) -> list[Feature]:
    """Return the features as a list, or raise `InputError`: none, what is none, too high, no such ball."""
    given: list[Any] = list(features) if isinstance(features, Sequence) else [features]
    if not given:
        raise InputError("features", [], "at least one, as RaceWaviness(...) or BallDiameter(...)")
    for one in given:
        dent = " (a dent of a race or a ball is an Indentation)" if isinstance(one, Dent) else ""
        require_instance("features", one, Feature, FEATURES + dent)
        ball = getattr(one, "ball", None)
        if ball is not None and ball >= balls:
            raise InputError("ball", ball, f"from 0 to {balls - 1}")
        _require_low(one, HIGHEST * ball_diameter)
    return given


def _require_low(feature: Feature, most: float) -> None:
    """Raise `InputError` for heights that no bearing has: above `most` [m]."""
    for name in ("amplitude", "excess", "rim"):
        height = getattr(feature, name, 0.0)
        if abs(height) > most:
            low = "between {0:.3g} and {1:.3g} m" if name == "excess" else "at most {1:.3g} m"
            where = f"{HIGHEST:g} of the ball's diameter (given in um?)"
            raise InputError(name, height, f"{low.format(-most, most)}, {where}")


def turns_of(places: Sequence[RingEquilibrium]) -> tuple[float, float]:
    """Turns of the cage, seen from the outer ring, and of a ball, per turn of the shaft: means by the loads."""
    weights = np.concatenate([at.force[:, 0] for at in places])
    cage, rotation = (
        float(np.average(np.concatenate([getattr(at, name) for at in places]), weights=weights))
        for name in ("orbit", "ball_rotation")
    )
    return cage, rotation


def with_cage_slip(bearing: BallBearing, cage: float, rotation: float, slip: float) -> tuple[float, float]:
    """Turns of the cage about the axis, and of a ball, where the cage turns slower by the share `slip`.

    `cage` and `rotation` are those without slip, seen from the outer ring.
    """
    rings = bearing.ring_speeds
    orders = DefectOrders.at_speeds(bearing.balls, rings.about_axis(cage), rotation, rings)
    slipped = orders.with_slip(slip, rings)
    return slipped.ftf_order, slipped.bsf_order
