"""How long a fixed step may be: the one that a run takes by itself, and when one that was given is too long.

A motion says what step its own course asks for (`Motion.default_step`); the film asks for no more than
`Motion.film_step`, and a feature that travels through for its share of the time in which it passes.
"""

from __future__ import annotations

from math import inf

import numpy as np
from numpy.typing import NDArray

from ehlcontact.transient.bodies import Motion
from ehlcontact.transient.roughness import Roughness
from ehlcontact.transient.surface import Dent, Surface, TransverseRidge, Waviness

# Of the passing of a wave on a surface. Against four times as many it leaves up to 1.2 % of the film in the middle
# open under dents (their radius in ten steps), 1.1 % under a ridge, 0.2 % under waviness; half as many leave 3, 2
# and 0.6 %, and 15 % of the swing of the approach. Measured at (200, 10, 0.5), n = 64 and 128.
STEPS_PER_WAVE = 40
# Of a period of the load, below which a result says so. Damping C against that of 80 steps, at (200, 10, 0.5),
# Omega = 3, n = 64, and at (1000, 10, 1), Omega = 1, n = 192: in 40 steps +0.9 and -0.7 %, in 30 +3.0 and -0.7 %,
# in 25 +4.6 and -1.4 %, in 20 +7.4 and -2.1 %, in 12 +19 and -7 %, in 10 +23 and -10 %, in 5 +26 and -28 %.
FEWEST_STEPS = 25
EVEN = 1e-6  # of a step: those of a controlled run, whose error was asked for, differ by more


def fixed_step(motion: Motion, surface: Surface | None, mesh: float) -> float:
    """Step of a run under this motion over a grid of this mesh size along X, where none is given."""
    return min(motion.default_step, motion.film_step, _feature_step(surface, mesh))


def _feature_step(surface: Surface | None, mesh: float) -> float:
    """Step over a feature; over one that does not tell its waves, or has them of all lengths, by a node."""
    if surface is None:
        return inf
    if isinstance(surface, Dent | TransverseRidge | Waviness):
        return surface.passing / STEPS_PER_WAVE
    speed = surface.speed if isinstance(surface, Roughness) else 1.0
    return mesh / speed if speed > 0.0 else inf


def overlong(motion: Motion, T: NDArray[np.float64]) -> str:
    """Say in words that the fixed steps between the times `T`, shape (steps + 1,), are long; else empty."""
    steps = np.diff(T)
    if not steps.size or np.ptp(steps) > EVEN * steps[0] or steps[0] * FEWEST_STEPS <= motion.load_period:
        return ""
    count = motion.load_period / steps[0]
    return (
        f"the step is coarse: {count:.3g} to a period of the load; before taking damping from it give dT = "
        f"{motion.default_step:.2g}"
    )
