"""Oil that comes back: layers that follow the passes of the balls before, while the feed is held.

Contacts under a layer that stands still have damping below zero at low frequencies: oil that is on its way to a
contact is left ahead of it while it closes (docs/oil_supply.md). What a contact leaves less is missing at the
next ones. With the motion exp(s t), the approach u of a contact and the change m of the layer on its way to it

    m_a = H (m - s D u),  H = 1/(1 + s T)          what arrives: the oil ahead of a contact is one store
    F   = Z u + f H m                              Z: under a layer that stands still, f: force by the layer
    m_b = a m_a + b u                              what it leaves: a of a change of layer, and b by the approach
    m   = E (mean(m_b + R/(1 + s tau_R) (m_a - m_b)) - q w/(1 + s tau_q)),  E = mean of exp(-s tau).

The mean is over both contacts of all balls; those without load pass everything. It is the assumption of
`OilBalance`, that balls mix what is on them so that the layer is the same everywhere, with delays in the place of
a rate. Half of what arrives is from the race, where the ball before passed, a quarter from each race in the mean,
and half from the ball itself, half a turn ago. The mean of these delays tau is l/(4 Z u) of the tracks of length
l, so both are the same to first order in s. As s goes to 0 the mean says that all contacts together lose what
they lost at rest: that is a held feed, and the equation of `OilBalance.lasting_layer`. a and b are derivatives of
its loss, and w is the relative change of the width of the track on which the feed, q in a pass, is spread: that
of the heaviest contact with the inner race. Oil that lies there already is not spread anew, so the width follows
within tau_q, the time in which the feed renews the layer.

G = f D is what a store takes from the damping. G and T are fitted to C of the solved contact over the frequency,
C = phi C_flooded - G/(1 + (T Omega)^2).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact import OilLayer
from ehlcontact.film_formulas import layer_sharpness
from ehlcontact.jit import plain
from ehlcontact.lubricant import density
from ehlcontact.side_flow import side_flow
from reduced_models.atlas.answer import AtlasAnswer
from reduced_models.bearing.coefficients import stiffness_and_damping
from reduced_models.bearing.fed_layer import FedLayer, lost_share
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.linear_balls import LinearBalls
from reduced_models.bearing.race import RACES, Race, races_at_angles
from reduced_models.bearing.solved_balls import with_solved_contacts

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

STEP = 0.02  # relative, of layers and loads in differences
SLOW_OMEGA = 0.4  # Omega up to which one store describes C
SLOWEST, FASTEST = 0.1, 300.0  # times T, in 2a/u_sum, between which that of the store lies
LEAST_FORCE = 1e-4  # of a layer that doubles, over the load: below, the film does not depend on it
HELD_FEED = (
    "the feed is held: layers follow the passes of the balls before, in K and in the damping of either sign"
)
LOAD_DIGITS = 6  # digits to which the loads of two contacts are the same


class Passage(NamedTuple):
    """What a contact does to a layer that passes, in SI."""

    passed: float  # a
    lost_by_approach: float  # b
    force: float  # f [N/m]
    taken: float  # D [s]
    time: float  # T [s]
    lost: float  # of the layer at rest [m]
    widening: float  # relative change of the width of the track by the approach [1/m]


UNLOADED = Passage(1.0, *(len(Passage._fields) - 1) * (0.0,))
LAYER_SHARES = np.array(
    [0.25, 0.25, 0.5]
)  # shares of a layer ahead from the inner race, the outer race and the ball
WIDTH_OF_LOAD = 1.0 / 3.0  # power of the load in the width of a Hertz contact


def passage(race: Race, load: float, speed_rpm: float) -> Passage:
    """The passage of a layer through a loaded contact with a race, under its `FedLayer`."""
    supply = race.conditions.supply
    assert isinstance(supply, FedLayer)
    h, flooded = float(supply.h), replace(race, conditions=replace(race.conditions, supply=None))

    def under(layer: float) -> Race:
        return replace(race, conditions=replace(race.conditions, supply=OilLayer(layer)))

    more, less = 1.0 + STEP, 1.0 - STEP
    starved, thinner, thicker = (under(h * times).answer(load, speed_rpm) for times in (1.0, less, more))
    full, lighter, heavier = (flooded.answer(load * times, speed_rpm) for times in (1.0, less, more))
    stiffness = float(starved.stiffness[0])
    force = -stiffness * (thicker.approach - thinner.approach) / (2.0 * STEP * h)

    def left(layer: float, by: AtlasAnswer, load: float) -> float:
        point = flooded.point(load, speed_rpm)
        moes = point.moes
        most = float(plain(density)(1.0, moes.law)[0]) * by.h_central
        g = layer_sharpness(moes.kappa) if supply.sharpness is None else supply.sharpness
        return layer * (1.0 - float(lost_share(layer / most, g, side_flow(point) * most * most)))

    passed = (left(h * more, full, load) - left(h * less, full, load)) / (2.0 * STEP * h)
    by_load = (left(h, heavier, load * more) - left(h, lighter, load * less)) / (2.0 * STEP * load)
    rest = h - left(h, full, load), WIDTH_OF_LOAD * stiffness / load
    if force * h < LEAST_FORCE * load:
        return Passage(passed, by_load * stiffness, 0.0, 0.0, 0.0, *rest)
    G, T = store_of(starved, full)
    return Passage(passed, by_load * stiffness, force, G / force, T, *rest)


def store_of(answer: AtlasAnswer, flooded: AtlasAnswer) -> tuple[float, float]:
    """G [N s/m] and T [s] of the oil ahead of a contact, by its C under a layer and flooded."""
    own, scales = answer.dimensionless, answer.point.scales
    Omega = own.omega[own.omega <= SLOW_OMEGA]
    C = own.damping[: Omega.size]
    free = flooded.dimensionless.impedance(Omega=Omega).damping

    def fitted(log_time: float) -> tuple[float, float]:
        store = -1.0 / (1.0 + (np.exp(log_time) * Omega) ** 2)
        # phi <= 1: a film damps no more than it does flooded, else a fast store takes what a large phi gives
        best = scipy.optimize.lsq_linear(np.column_stack([free, store]), C, ([0.0, 0.0], [1.0, np.inf]))
        return float(best.cost), float(best.x[1])

    tried = np.linspace(np.log(SLOWEST), np.log(FASTEST), 60)
    best = int(np.argmin([fitted(x)[0] for x in tried]))
    ends = tried[max(best - 1, 0)], tried[min(best + 1, tried.size - 1)]
    found = scipy.optimize.minimize_scalar(lambda x: fitted(x)[0], bounds=ends, method="bounded")
    return fitted(found.x)[1] * scales.damping, float(np.exp(found.x)) * scales.time


@dataclass(frozen=True, eq=False)
class OilFeedback:
    """What a held feed adds to the impedance of a bearing under a layer that stands still.

    Parameters
    ----------
    balls : LinearBalls
        About equilibrium, with the impedances of its solved contacts.
    passages : ndarray, shape (5, 2, positions * balls)
        a, b, f, D and T of all contacts.
    spread : ndarray, shape (2, positions * balls)
        Feed of a pass that all contacts of a position have less by the approach of each, as the track gets wider.
    delays : ndarray, shape (3,)
        Times between two passes [s]: on the inner and the outer race, and on a ball.
    renewal : ndarray, shape (positions * balls,)
        Time in which the feed renews the layer [s].
    returned, return_time : float
        Of the oil pressed aside, as of `FedLayer`.
    """

    balls: LinearBalls
    passages: _Floats
    spread: _Floats
    delays: _Floats
    renewal: _Floats
    returned: float
    return_time: float

    @classmethod
    def of(cls, bearing: Any, speed_rpm: float, solved: LinearBalls, equilibria: Sequence[Any]) -> OilFeedback:
        """Of a `BallBearing` under a `FedLayer`, at its equilibria."""
        found: dict[tuple[float, ...], Passage] = {}
        columns = []
        for column, name in enumerate(RACES):
            angles, speeds, force = (
                np.concatenate([getattr(at, what)[:, column] for at in equilibria])
                for what in ("angles", "speed_sum", "force")
            )
            rows = []
            for race, load in zip(races_at_angles(bearing, name, angles, speeds), force.tolist(), strict=True):
                key = tuple(float(f"{x:.{LOAD_DIGITS}g}") for x in (load, race.geometry.radius_x, race.speed_sum))
                if load > race.loads(speed_rpm)[0] and key not in found:
                    found[key] = passage(race, key[0], speed_rpm)
                rows.append(found.get(key, UNLOADED))
            columns.append(rows)
        across, ball, supply = bearing.pitch_diameter, bearing.ball_diameter, bearing.supply
        ways = np.pi * np.array([across - ball, across + ball, 0.5 * bearing.balls * ball]) / bearing.balls
        delays = ways / (0.5 * bearing.race("inner").speed_sum * speed_rpm * RPM_TO_RAD_S)
        *passages, lost, widening = np.moveaxis(np.array(columns), -1, 0)
        places, contacts = len(equilibria), 2 * bearing.balls
        fed = (1.0 - supply.returned) * lost.reshape(2, places, -1).sum(axis=(0, 2))  # contacts times q
        heaviest = np.concatenate([_heaviest(at.force[:, 0]) for at in equilibria])
        spread = np.array([heaviest * np.repeat(fed, contacts // 2) * widening[0], np.zeros(heaviest.size)])
        renewal = np.repeat(LAYER_SHARES @ delays * float(supply.h) * contacts / fed, contacts // 2)
        oil = supply.returned, supply.return_time
        return cls(solved, np.array(passages), spread, delays, renewal, *oil)

    def impedance(self, s: _Complex) -> _Complex:
        """Addition to the impedance of the ring, shape (k, n, n), at frequencies s [1/s], shape (k,)."""
        a, b, f, D, T = self.passages[:, :, None]
        r = s[:, None]
        lag = 1.0 / (1.0 + r * T)
        films = np.moveaxis(np.asarray(self.balls.films.impedance(s[:, None, None])), -2, 0)
        heights = np.where(f > 0.0, f * lag / np.where(films == 0.0, 1.0, films), 0.0)
        by_ring, by_layer = self.balls.approaches(s, heights)
        back = self.returned / (1.0 + r * self.return_time) if self.returned else 0.0
        kept = (a + back * (1.0 - a)) * lag
        by_approach = -r * D * kept + (1.0 - back) * b - self.spread[:, None] / (1.0 + r * self.renewal)
        left = self._means(kept + by_approach * by_layer)
        moved = self._means(by_approach[..., None] * by_ring)
        later = np.exp(-r * self.delays) @ LAYER_SHARES[:, None]
        layer = later[..., None] * moved / (1.0 - later * left)[..., None]  # by the ring, (k, positions, n)
        force = -self.balls.force_of_heights(s, *heights)
        pressed = force.reshape(s.size, self.balls.positions, -1, force.shape[-1]).sum(axis=2)
        return np.asarray(np.einsum("kpi,kpj->kij", pressed, layer) / self.balls.positions)

    def _means(self, values: _Complex) -> _Complex:
        """Means over both contacts of all balls: of (2, k, contacts, ...), shape (k, positions, ...)."""
        shape = (2, values.shape[1], self.balls.positions, -1, *values.shape[3:])
        return np.asarray(values.reshape(shape).mean(axis=(0, 3)))


def with_held_feed(
    bearing: Any, speed_rpm: float, small: LinearBalls, equilibria: Sequence[Any], omega: _Floats
) -> tuple[Any, Any, str]:
    """What a held feed adds to K and C at angular frequencies [rad/s], and words about it.

    Nothing where the supply of the `BallBearing` is no `FedLayer`: 0, 0 and no words. `small` is the bearing about
    the `equilibria`.
    """
    if not isinstance(bearing.supply, FedLayer):
        return 0.0, 0.0, ""
    solved = with_solved_contacts(bearing, speed_rpm, small, equilibria)
    feedback = OilFeedback.of(bearing, speed_rpm, solved, equilibria)
    return *stiffness_and_damping(feedback.impedance, omega), HELD_FEED


def _heaviest(force: _Floats) -> _Floats:
    """Shares of the heaviest balls, which sum to 1: two by symmetry share alike."""
    most = force >= (1.0 - 10.0**-LOAD_DIGITS) * force.max()
    return np.asarray(most / np.count_nonzero(most))
