"""Error of wide-range elements by kind of motion, stated from full solves.

Atlas elements of three points against `simulate` under a prescribed approach (``tests/golden/motions.py``), by the
film of the reference load over its dry approach; times in 2a/u_sum, u_1 the approach under the reference load,
rates in dry approaches per time:

| kind | motion | largest rate |
|---|---|---|
| small vibration | 0.02 and 0.01 dry approaches about u_1, Omega = pi/2 and 2 pi | 0.09 |
| vibration within contact | static load 0.4 to 1.8, Omega = pi/2 | 1.0 |
| slow return | to u_1 - 1.1 within 1, back to u_1 within 4 | 2.1 |
| fast return | to u_1 - 1.6 within 0.6, back to u_1 + 0.3 within 0.6 | 5.9 |
| impact | from rest at u_1 - 1.3 to u_1 + 0.2 within 0.4 | 7.0 |
| unloading | twice to u_1 - 0.5 and back, raised cosines of 3 | 0.52 |
| repeated lift-off | twice to u_1 - 1.3 and back, raised cosines of 1.5 | 2.7 |

The last two are not among the stored solves. Errors are those of these motions, so typical ones, not bounds:
the error grows with the rate of the motion (unloading at twice the rate: 3 to 9 times; docs/notes/elements.md).

An error is the rms error of the force over the standard deviation of the force. With thick films that of
both returns is the static force of parted surfaces, which depends on the flooded inlet (docs/notes/elements.md).
"""

from __future__ import annotations

import numpy as np

FILMS = (0.053, 0.367, 0.795)  # of the points (M, L, kappa) = (2900, 19, 0.11), (37, 12, 0.8), (20, 5, 0.3)
WITHIN, UNLOADING = "vibration within contact", "unloading"
ERRORS = {  # rms at these films
    "small vibration": (0.013, 0.025, 0.011),
    WITHIN: (0.0034, 0.011, 0.029),
    "slow return": (0.0084, 0.057, 0.436),
    "fast return": (0.016, 0.069, 0.242),
    "impact": (0.029, 0.099, 0.163),
    UNLOADING: (0.0020, 0.012, 0.042),
    "repeated lift-off": (0.043, 0.179, 0.445),
}


def motion_errors(film: float) -> dict[str, float]:
    """Rms error by kind of motion, straight between the points and held beyond them; it grows with the rate."""
    return {kind: float(np.interp(film, FILMS, errors)) for kind, errors in ERRORS.items()}
