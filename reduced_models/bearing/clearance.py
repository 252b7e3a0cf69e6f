"""Radial internal clearance of deep-groove ball bearings by class and bore.

The contact angle that follows from a clearance: `BallBearing.free_angle`; the reverse:
`ring.free_clearance`.

Limits of ISO 5753-1 (DIN 620-4) for cylindrical bores, as makers' catalogues print them: of a bearing that is not
mounted. Fits and a warm inner ring take some of it.
"""

from __future__ import annotations

from bisect import bisect_left

from ehlcontact.errors import InputError

CLASSES = ("C2", "CN", "C3", "C4")
# Bore up to [mm]: least and largest clearance [um] of each class; the bore is above that of the row before
LIMITS = {
    10: ((0, 7), (2, 13), (8, 23), (14, 29)),
    18: ((0, 9), (3, 18), (11, 25), (18, 33)),
    24: ((0, 10), (5, 20), (13, 28), (20, 36)),
    30: ((1, 11), (5, 20), (13, 28), (23, 41)),
    40: ((1, 11), (6, 20), (15, 33), (28, 46)),
    50: ((1, 11), (6, 23), (18, 36), (30, 51)),
    65: ((1, 15), (8, 28), (23, 43), (38, 61)),
    80: ((1, 15), (10, 30), (25, 51), (46, 71)),
    100: ((1, 18), (12, 36), (30, 58), (53, 84)),
}
SMALLEST_BORE = 2.5  # mm


def clearance_limits(name: str, bore: float | None) -> tuple[float, float]:
    """Least and largest radial clearance [m] of a class, "C2", "CN", "C3" or "C4", at a bore [m].

    Raises
    ------
    InputError
        No such class; a bore that is unknown or not in the table.
    """
    wanted = name.strip().upper()
    if wanted not in CLASSES:
        raise InputError("clearance", name, f"a number, or a class: {', '.join(CLASSES)}")
    if bore is None:
        raise InputError("clearance", name, "a number: the bore of this bearing is not known, which classes need")
    bores = list(LIMITS)
    bore_mm = round(1e3 * bore, 6)
    if not SMALLEST_BORE <= bore_mm <= bores[-1]:
        allowed = (
            f"a number: classes are known for bores of {SMALLEST_BORE:g} to {bores[-1]} mm, not of {bore_mm:g} mm"
        )
        raise InputError("clearance", name, allowed)
    low, high = LIMITS[bores[bisect_left(bores, bore_mm)]][CLASSES.index(wanted)]
    return low * 1e-6, high * 1e-6


def clearance_of_class(name: str, bore: float | None) -> float:
    """Middle of the limits of a class [m]; raises `InputError` as `clearance_limits`."""
    return round(0.5 * sum(clearance_limits(name, bore)), 9)
