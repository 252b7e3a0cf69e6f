"""Cage slip by the balance of tractions at the balls, rolling resistance of their films and a drag.

Equation numbers are those of docs/notes/traction.md.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from ehlcontact.checks import parts
from ehlcontact.checks.kinds import Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.lubricant import TractionLaw
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.bearing.sliding import WIDEST, SlidingContact, oiled_state, sliding_contact

MOST = 0.5 * WIDEST  # slip of the inner race against the outer one, over the rolling speed
FINEST = 1e-9


@dataclass(frozen=True)
class _Ball:
    """A loaded ball: both contacts, and the forces of its films.

    Parameters
    ----------
    inner, outer : SlidingContact
    turning : float
        Traction that overcomes the resistance of both films to the rotation of the ball [N].
    driving : float
        Force of the films along the orbit [N].
    """

    inner: SlidingContact
    outer: SlidingContact
    turning: float
    driving: float

    def force(self, apart: float) -> float:
        """Force along the orbit [N] on a ball that turns freely.

        `apart` is the slip at the inner race less that at the outer one. Where the tractions cannot overcome the
        rolling resistance, the ball slides.
        """

        def missing(slip: float) -> float:
            return self.inner.traction(slip + apart) + self.outer.traction(slip) - self.turning

        turns = missing(WIDEST) > 0.0
        slip = float(scipy.optimize.brentq(missing, -WIDEST, WIDEST, xtol=FINEST)) if turns else WIDEST
        return self.inner.traction(slip + apart) - self.outer.traction(slip) + self.driving


@takes(
    bearing=Object(BallBearing, "a BallBearing"),
    load="N",
    drag=parts.PRELOAD,
    speed_rpm=parts.SPEED,
)
def cage_slip(bearing: Any, load: ArrayLike, *, speed_rpm: float, law: TractionLaw, drag: float = 0.0) -> float:
    """How much slower the cage turns than it would if balls rolled at the middle of their contacts, relative.

    Negative where it is faster: contacts of curved grooves roll on two lines beside their middle, where the
    rolling radius of the inner race is larger and that of the outer one smaller; this effect grows with load.

    Parameters
    ----------
    bearing : BallBearing
        In oil, under a radial load.
    load : (float, float)
        Fx and Fy [N].
    speed_rpm : float
        Of the shaft [rev/min].
    law : TractionLaw
        `ehlcontact.Eyring`, `Carreau` or `LimitingShear`.
    drag : float
        Force against the orbit by cage and unloaded balls, at the pitch circle [N]; the rolling resistance of
        the films of loaded balls is computed.

    Raises
    ------
    InputError
        A drag that the loaded balls cannot carry: the cage slides; a load with an axial part; a dry bearing.
    """
    if np.size(load) != 2:
        raise InputError("load", np.size(load), "(Fx, Fy): the balance of cage and balls is for radial loads")
    state = oiled_state(bearing, load, speed_rpm, law)
    balls = _loaded(bearing, state, law)

    # A drag acts against the turning of the cage, which goes as balls do seen from the outer ring, or backward
    cage, sense = bearing.orders.ftf_order, bearing.ring_speeds.sense
    if cage == 0.0:
        raise InputError("bearing.turning", bearing.turning, "such that the cage turns: this one stands still")
    way = sense if cage > 0.0 else -sense

    def left(apart: float) -> float:
        return way * sum(ball.force(way * apart) for ball in balls) - drag

    if not balls or left(MOST) < 0.0:
        most = left(MOST) + drag if balls else 0.0
        raise InputError("drag", drag, f"below {most:.3g} N, what the traction of the loaded balls carries")
    gamma = bearing.ball_diameter / bearing.pitch_diameter
    slower = 0.5 * (1.0 - gamma) / (way * sense * cage)  # 1 with the inner ring turning
    return slower * 0.5 * (1.0 + gamma) * float(scipy.optimize.brentq(left, -MOST, MOST, xtol=FINEST))


def _loaded(bearing: Any, state: BearingState, law: TractionLaw) -> list[_Ball]:
    """Balls that both races press, with the moments of their films (eqs. 14, 15)."""
    assert state.moment is not None
    r, pitch = 0.5 * bearing.ball_diameter, 0.5 * bearing.pitch_diameter
    found = []
    for k, (m_i, m_o) in enumerate(state.moment.tolist()):
        inner, outer = (sliding_contact(bearing, state, k, column, law) for column in (0, 1))
        if inner is None or outer is None:
            continue
        drag_i, drag_o = 0.5 * m_i * (1.0 / r + 1.0 / (pitch - r)), 0.5 * m_o * (1.0 / r - 1.0 / (pitch + r))
        found.append(_Ball(inner, outer, drag_i + drag_o, (m_i / r - drag_i) - (m_o / r - drag_o)))
    return found
