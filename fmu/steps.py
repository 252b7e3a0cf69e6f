"""Communication steps of contact FMUs: the default, and the longest that leave a contact its damping."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from fmu.contact_variables import Element

SHARE_OF_TRANSIT = 0.05  # default step, over the transit time 2a/u_sum of the film
FAST_STEP = 0.1  # step times angular frequency of the fastest motion for which steps are advised
ADDED_DAMPING = 2.4  # extrapolated motion adds at most this times K h (w h)^4 to the damping: docs/coupling.md
ALLOWED_DAMPING = 0.05  # of a contact, that such steps may add


def default_step(element: Element) -> float:
    """A step that resolves the contact, 1, 2 or 5 times a power of ten.

    A twentieth of 2a/u_sum; of an element in SI that does not know its scales, the 60th part of its fastest
    period, or of the time that its largest rate takes through its interval.
    """
    if element.units == "dimensionless" or element.time is not None:
        return round_down(SHARE_OF_TRANSIT * (1.0 if element.time is None else element.time))
    times = [1e-3]
    if element.omega_range is not None and element.omega_range[1] > 0.0:
        times.append(0.1 / element.omega_range[1])
    if element.rate:
        low, high = element.validity.approach
        times.append(SHARE_OF_TRANSIT * (high - low) / element.rate)
    return round_down(min(times))


def round_down(value: float) -> float:
    """1, 2 or 5 times a power of ten, at most `value` > 0."""
    power = math.floor(math.log10(value))
    digit = max(d for d in (1, 2, 5) if d <= value / 10.0**power * (1.0 + 1e-12))
    return float(f"{digit}e{power}")


def step_advice(element: Element) -> list[tuple[str, str, str]]:
    """Advice on co-simulation steps at the static load: (name, largest step, reason) per way of coupling."""
    unit = " s" if element.units == "SI" else ""
    low, high = element.validity.approach
    lines = [("default step", f"{default_step(element):g}{unit}", "resolves the contact")]
    try:
        u = element.approach_at(element._static_load(None))
    except InputError:
        u = 0.5 * (low + high)
    K, load = float(element.spring_tangent(u)), float(element.spring(u))
    if not (K > 0.0 and 0.0 < load < math.inf):
        return lines
    C = damping_at(element, load)
    late = C / K
    return [
        *lines,
        (
            "largest step, with the right lead",
            f"{late * ALLOWED_DAMPING / (ADDED_DAMPING * FAST_STEP**4):.3g}{unit}",
            f"and at most {FAST_STEP:g}/w for the fastest motion w: then C is {ALLOWED_DAMPING:.0%} too large at"
            f" most, as {ADDED_DAMPING:g} K h (w h)^4 is added; K = {K:.4g}, C = {C:.4g}",
        ),
        (
            "largest step, with a lead half a step too small",
            f"{2.0 * late:.3g}{unit}",
            "where K h/2 is C and the contact damps no more: beyond, vibrations grow",
        ),
        (
            "largest step, force iterated",
            "the master's",
            "for rollback lead is 0; set, get, then doStep has no delay either",
        ),
    ]


def damping_at(element: Element, load: float) -> float:
    """Damping coefficient of slow motion about rest under a load."""
    return float(element._response(_slow(element), load)[0].imag / _slow(element)[0])


def _slow(element: Element) -> NDArray[np.float64]:
    time = 1.0 if element.time is None else element.time
    return np.array([0.1 / time])
