"""Assumptions about the bodies: constant speed, one direction of rolling, elastic."""

from __future__ import annotations

from ehlcontact.assumptions.contact import NO_SI, Contact
from ehlcontact.assumptions.table import Assumption

FILM_SPEED_EXPONENT = 0.67  # of the central film; Hamrock and Dowson (1977)
LARGEST_SPEED_CHANGE = 0.01 / FILM_SPEED_EXPONENT  # relative, while a film crosses: 1 % of film
LARGEST_CROSS_SPEED = 0.1  # over the rolling speed: an angle of 6 degrees, half a per cent of entrained speed
LARGEST_PRESSURE = 4.2e9  # Pa, static rating of ball bearings, a dent of 1e-4 ball diameters; ISO 76
FATIGUE_PRESSURE = 1.5e9  # Pa, below which bearing steel does not tire; ISO 281


def constant_speed(contact: Contact, vibration: float | None) -> Assumption:
    """Speed of vibration along the surfaces [m/s] against the rolling speed, and the time of a crossing."""
    value, verdict, details = None, NO_SI, {}
    if contact.scales is not None:
        s, _, _, u = contact.require_si()
        details = {"crossing_time": 2.0 * s.time, "largest_change": LARGEST_SPEED_CHANGE * u}
        verdict = (
            f"a change of {details['largest_change']:.2g} m/s within the {details['crossing_time'] * 1e6:.2g} "
            "\N{MICRO SIGN}s that the film takes to cross makes 1 % of film"
        )
        value, verdict = _against_rolling(vibration, u, verdict)
    return Assumption(
        name="constant speed",
        number="speed of vibration along the surfaces over the rolling speed",
        value=value,
        limit=LARGEST_SPEED_CHANGE,
        at_least=False,
        unit="-",
        verdict=verdict,
        scatter="on the safe side: what is slow beside the crossing only makes the film of its own speed",
        source="film ~ u^0.67, Hamrock and Dowson 1977; a film crosses in 4a/u_sum",
        details=details,
    )


def one_direction(contact: Contact, vibration: float | None) -> Assumption:
    """Speed of vibration across rolling, or against it [m/s], over the rolling speed."""
    value, verdict, details = None, NO_SI, {}
    if contact.scales is not None:
        u = contact.require_si()[3]
        details = {"largest_cross_speed": LARGEST_CROSS_SPEED * u}
        largest = details["largest_cross_speed"]
        verdict = f"holds up to {largest:.2g} m/s across; a reversal needs `speed=` of `simulate`"
        value, verdict = _against_rolling(vibration, u, verdict)
    return Assumption(
        name="one direction",
        number="speed of vibration across rolling over the rolling speed",
        value=value,
        limit=LARGEST_CROSS_SPEED,
        at_least=False,
        unit="-",
        verdict=verdict,
        scatter="an estimate: the cosine of the angle by which the entraining speed turns",
        source="own estimate; no published limit is known to us",
        details=details,
    )


def elastic(contact: Contact) -> Assumption:
    """Hertz pressure against what bearing steel bears."""
    value, verdict = None, "not judged: L = 0 is the limit of small Hertz pressures"
    if contact.scales is not None or contact.moes.L > 0.0:
        value = contact.moes.p_hertz if contact.scales is None else contact.scales.pressure
        limit = FATIGUE_PRESSURE if value <= LARGEST_PRESSURE else LARGEST_PRESSURE
        side = "above" if value > limit else "below"
        what = "where bearing steel begins to tire" if limit is FATIGUE_PRESSURE else "where balls leave dents"
        verdict = f"{value * 1e-9:.3g} GPa, {side} the {limit * 1e-9:g} GPa {what}"
    return Assumption(
        name="elastic",
        number="Hertz pressure against the static rating of ball bearings",
        value=value,
        limit=LARGEST_PRESSURE,
        at_least=False,
        unit="Pa",
        verdict=verdict,
        scatter="for hardened bearing steel; others yield from 1.6 times their yield stress (Johnson 1985, 6.1)",
        source="ISO 76; ISO 281",
        details={"fatigue_pressure": FATIGUE_PRESSURE},
    )


def _against_rolling(vibration: float | None, u: float, verdict: str) -> tuple[float | None, str]:
    if vibration is None:
        return None, f"not judged: no vibration along the surfaces given; {verdict}"
    return vibration / u, f"vibration adds up to {vibration:.2g} m/s to {u:.3g} m/s; {verdict}"
