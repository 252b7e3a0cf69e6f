"""How closely a step is solved: the `tol` that a run takes by itself, and when one that was given is too coarse.

Where bodies are under a load, film, force and approach are found together by relaxation, until force and approach
change by less than a share of `tol` in a cycle: with `DEFAULT_TOL` by 1e-4 of the static load. That is much of a
small motion: in twenty steps a period of a load that swings by 0.01 of the static one C came out 5 % too small
(docs/solver.md). So the default follows the motion, and what it leaves open is the same share of each.
"""

from __future__ import annotations

from ehlcontact.transient.bodies import Motion

DEFAULT_TOL = 3e-3  # residual of a step, relative to the central film at rest
CHANGE_SHARE = 1.0 / 30.0  # of the tolerance, for changes of u and force: they are means over the field
USUAL_SIZE = 0.1  # of a motion, which that tells to a thousandth; smaller ones are told as well
SMALLEST_TOL = 1e-6  # taken by default: rounding is far, and a smaller motion says what it asks for
COARSE = 3.0  # times the tol that fits, above which it is said


def fitting_tol(motion: Motion) -> float:
    """`tol` of a run under this motion, where none is given."""
    share = round(min(motion.size / USUAL_SIZE, 1.0), 9)  # 0.1 made of a rate and a frequency is 0.1
    return max(DEFAULT_TOL * share, SMALLEST_TOL)


def coarseness(motion: Motion, tol: float) -> str:
    """Say in words that `tol` is coarse for this motion; else empty."""
    if tol <= COARSE * _fit(motion):
        return ""
    left = 100.0 * CHANGE_SHARE * tol / motion.size
    return (
        f"tol = {tol:.3g} is coarse for so small a motion: force and approach settle to {left:.2g} % of it in a "
        f"step; before taking stiffness or damping from it give tol = {_fit(motion):.2g}"
    )


def _fit(motion: Motion) -> float:
    return DEFAULT_TOL * motion.size / USUAL_SIZE
