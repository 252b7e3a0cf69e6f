"""Findings of a study in sentences made from its numbers; a sentence without content is empty."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import hypot
from typing import Any

from ehlcontact.cli.numerals import numeral, percent
from ehlcontact.cli.study.answer import NAMES
from ehlcontact.cli.study.differences import Events, RotorFindings
from ehlcontact.cli.study.forecast import cautions
from ehlcontact.cli.study.reduction import CONTACT_BAND, CONTACTS, DRY, FULL, MEMORY, ROTOR_BAND, UNDAMPED
from ehlcontact.cli.study.results import ContactFindings, Findings
from reduced_models.bearing.oil_and_heat import FLOODED, SHOWN, OilAndHeat
from reduced_models.bearing.set_result import SetState

# Change by half the step, over the standard deviation of a signal or the decrement, that has a sentence.
LARGE_CHANGE = 0.01


def document(found: Findings) -> dict[str, Any]:
    """Content of ``results.json``: the sentences, and all numbers."""
    said = {
        "status": "converged",
        "title": found.study.title,
        "verdict": verdict(found),
        "answer": headline(found),
    }
    return said | found.to_dict()


def verdict(found: Findings) -> str:
    """The result in one line: whether the film decides the damping, the nearest element, film and assumptions."""
    contact, rotors = found.contact, found.rotors
    if contact is None:
        return _machine_verdict(found)
    op, rough = contact.operating_point, found.study.roughness
    ratio = "" if rough is None else f", {numeral(1e-6 * op['h_min_um'] / hypot(*rough), 3)} times the roughness"
    film = f"Smallest film {numeral(op['h_min_um'], 3)} \N{MICRO SIGN}m{ratio}."
    outside = ", ".join(one.name for one in contact.assumptions.out_of_range)
    held = f"Does not hold: {outside}." if outside else "All assumptions that can be judged hold."
    damped = "" if rotors is None else _damping_verdict(rotors)
    return " ".join(filter(None, (damped, film, held, conditions(found))))


def _machine_verdict(found: Findings) -> str:
    """The machine or the bearing alone in one line: its first tiles."""
    machine = found.machine
    if isinstance(machine, str):
        return f"NOT COMPUTED: {machine}."
    return ". ".join(map(str, machine.tiles()[:3])) + "."


def _damping_verdict(rotors: RotorFindings) -> str:
    """Whether the film decides the damping of the rotor on full films, and the nearest element."""
    d = rotors.decay
    own, nearest = d.decrements[FULL], d.nearest_without
    said = [f"Log decrement {numeral(own.decrement, 3)} at {numeral(own.hz)} Hz on the full film"]
    elements = {name: abs(d.off(name)) for name in (ROTOR_BAND[0], MEMORY) if name in d.decrements}
    if elements:
        best = min(elements, key=lambda name: elements[name])
        said.append(f"{percent(elements[best], 2)} off with the {CONTACTS[best]}")
    if nearest is not None:
        said.append(f"at least {percent(nearest, 2)} off without a film or its damping")
    decides = (
        "" if nearest is None else f"The film {'decides' if d.film_decides else 'does not decide'} the damping. "
    )
    return f"{decides}{', '.join(said)}."


def conditions(found: Findings) -> str:
    """What the whole bearing is computed with beside flooded isothermal films; else empty."""
    w = found.oil_and_heat
    if not isinstance(w, OilAndHeat):
        return ""
    keys = [key for key in w.conditions if key != FLOODED]
    beside = "The single contact is flooded and isothermal; the bearing is computed"
    return f"{beside} {', '.join(keys)} too." if keys else ""


def headline(found: Findings) -> str:
    """All in one paragraph."""
    return " ".join((*findings(found), *reservations(found)))


def findings(found: Findings) -> list[str]:
    """Findings, a text per subject."""
    rotor = () if found.rotors is None else (decay, unbalance)
    single = () if found.contact is None else _sentences(found.contact, contact, damper, *rotor)
    return [*_sentences(found, machine), *single, *_sentences(found, whole, oil_and_heat)]


def reservations(found: Findings) -> list[str]:
    """Reservations about the findings, a text per subject."""
    rotor = () if found.rotors is None else (unsettled, step_check)
    after = () if found.rotors is None else (contact_events, failures)
    single = () if found.contact is None else _sentences(found.contact, *after, broken_assumptions)
    return [
        *_sentences(found, without_films, damping_below_zero, *rotor, mesh_warnings),
        *single,
    ]


def _sentences(found: Any, *parts: Callable[[Any], str]) -> list[str]:
    return [text for text in (part(found) for part in parts) if text]


def machine(found: Findings) -> str:
    """The machine, or the bearing alone, in its tiles; why it is not computed."""
    state = found.machine
    return f"NOT COMPUTED: {state}." if isinstance(state, str) else ". ".join(map(str, state.tiles())) + "."


def contact(found: ContactFindings) -> str:
    """Load, pressure and film."""
    op, settings, label = found.operating_point, found.study.contact, found.study.carrier.label
    assert settings is not None
    central, smallest = (
        "" if op[name] is None else f" (\N{PLUS-MINUS SIGN} {numeral(100.0 * op[name], 2)} % of it)"
        for name in ("h_central_error", "h_min_error")
    )
    return (
        f"The most loaded ball of this {label} presses {numeral(op['load'])} N on the {settings.race} race "
        f"(M = {op['M']:.0f}, L = {op['L']:.1f}, kappa = {op['kappa']:.3f}, {op['p_hertz'] * 1e-9:.2f} GPa) and "
        f"rolls on an oil film of {op['h_central_um']:.3f} \N{MICRO SIGN}m{central}, {op['h_min_um']:.3f} "
        f"\N{MICRO SIGN}m{smallest} at its thinnest."
    )


def damper(found: ContactFindings) -> str:
    """Spring and damper at the rotor's frequency, from the impedance; the fit and its interval beside them."""
    own, fitted = found.at_rotor_speed, found.damper_of_fit
    low, high = fitted["interval"]
    sure = f"95 %: {numeral(low, 3)} to {numeral(high, 3)}" if low > 0.0 else "not determined by the fit"
    spring = numeral(own["stiffness"] * 1e-6, 3)
    return (
        f"At the rotor's {numeral(found.study.rotor_hz)} Hz a contact is a spring of {spring} "
        f"N/\N{MICRO SIGN}m with a damper of {numeral(own['damping'], 3)} N s/m, by its impedance there; the "
        f"cubic fitted to a harmonic load of this frequency has {numeral(fitted['damping'], 3)} N s/m "
        f"({sure})."
    )


def decay(found: Any) -> str:
    """Decrement on the full film, with elements, and without a film."""
    d = found.rotors.decay
    own = d.decrements[FULL]
    rest = [
        f"the {CONTACTS[name]} gives {numeral(d.decrements[name].decrement, 3)} ({off(d.off(name))})"
        for name in (ROTOR_BAND[0], MEMORY, CONTACT_BAND[0], UNDAMPED, DRY)
        if name in d.decrements
    ]
    text = (
        f"Kicked, the rotor vibrates up and down at {numeral(own.hz)} Hz with a logarithmic decrement of "
        f"{numeral(own.decrement, 3)} on the full film; {', '.join(rest)}."
    )
    nearest = d.nearest_without
    if nearest is None:
        return text
    without = "without it, or without its damping,"
    if d.film_decides:
        return f"{text} The film decides it: {without} it is at least {percent(nearest, 2)} off."
    return f"{text} The film does not decide it: {without} one is {percent(nearest, 2)} off."


def off(share: float) -> str:
    """Difference from the value on the full film, as a share of it."""
    return f"{'+' if share >= 0.0 else '-'}{percent(abs(share), 2)} of it"


def unbalance(found: Any) -> str:
    """Differences of elements and baselines from the full film under unbalance."""
    u = found.rotors.unbalance
    said = [
        f"the {CONTACTS[name]} by {percent(c.displacement_vibration, 2)} and {percent(c.force_vibration, 2)}"
        for name, c in u.best.items()
        if name in (ROTOR_BAND[0], MEMORY, DRY)
    ]
    part = "settled" if u.settled else "not settled"
    return (
        f"Under its unbalance ({part}) vibrations and contact forces, about their mean, differ from those on the "
        f"full film, rms over standard deviation of the signal, by at most: {'; '.join(said)}."
    )


def whole(found: Findings) -> str:
    """The rotor on whole bearings, where the study has them: decrements, and motion at ball passage."""
    if found.whole is None:
        return ""
    rows, parts = found.whole.rows, []
    slowest = [(name, row["vertical"]) for name, row in rows.items() if row["vertical"] is not None]
    if slowest:
        said = (f"with {NAMES[name]} {numeral(m['decrement'], 3)} at {numeral(m['hz'])} Hz" for name, m in slowest)
        parts.append(
            f"On its bearings{_flooded_words(found)} the slowest vertical vibration has a decrement of: "
            f"{'; '.join(said)}."
        )
    heard = [(name, row["at_ball_passage"]) for name, row in rows.items() if row["at_ball_passage"] is not None]
    if heard:
        said = (f"{numeral(size * 1e9, 3)} nm with {NAMES[name]}" for name, size in heard)
        hz = numeral(found.whole.passage_hz)
        parts.append(f"Balls that pass, at {hz} Hz, move the disc up and down by {', '.join(said)}.")
    if found.whole.failed:
        said = (f"{NAMES[name]} ({reason})" for name, reason in found.whole.failed.items())
        parts.append(f"The rotor could not be run on its bearings with: {'; '.join(said)}.")
    if found.whole.said:
        parts.append(f"NOTE, in time: {'; '.join(found.whole.said)}.")
    return " ".join(parts)


def _flooded_words(found: Findings) -> str:
    """Of bearings of a rotor, where heat or a layer is asked for: they have neither."""
    return "" if found.oil_and_heat is None else ", flooded and isothermal,"


def oil_and_heat(found: Findings) -> str:
    """The bearing with heat and with its layer of oil, where they are asked for: films and damping."""
    w = found.oil_and_heat
    if not isinstance(w, OilAndHeat):
        return ""
    ball, way, flooded = w.state.heaviest, next(iter(w.ways.values())), w.conditions[FLOODED]
    said = (
        f"{key} {percent(float((one.h_central / flooded.h_central)[ball, 0]), 3)} of the film and "
        f"{numeral(float(one.damping[0, way]), 3)} N s/m"
        for key, one in w.conditions.items()
        if key != FLOODED
    )
    own = numeral(float(flooded.damping[0, way]), 3)
    carrier = "pair" if isinstance(w.at_rest, SetState) else "bearing"
    text = f"Flooded and isothermal, the {carrier} has {own} N s/m of damping at the frequency of the speed; "
    return f"{text}{'; '.join(said) or 'nothing beside it'}."


def without_films(found: Findings) -> str:
    """Conditions of oil and heat that were asked for and have no films, and why."""
    w = found.oil_and_heat
    if isinstance(w, str):
        return f"NOT COMPUTED: oil supply and heat of the bearing ({w})."
    said = [] if w is None else [f"{key} ({reason})" for key, reason in w.refused.items()]
    return f"NO FILMS of the bearing {'; '.join(said)}." if said else ""


def damping_below_zero(found: Findings) -> str:
    """Conditions of oil and heat in which the bearing adds energy to small vibrations."""
    w = found.oil_and_heat
    if not isinstance(w, OilAndHeat):
        return ""
    said = [
        f"{key} {numeral(C, 3)} N s/m at {numeral(hz)} Hz{f' {way}' if len(w.ways) > 1 else ''}"
        for key, one in w.conditions.items()
        for k, hz in enumerate(w.hz[:SHOWN].tolist())
        for way, column in w.ways.items()
        if (C := float(one.damping[k, column])) < 0.0
    ]
    if not said:
        return ""
    return f"DAMPING BELOW ZERO: the bearing has {'; '.join(said)}: there films add energy to vibrations."


def unsettled(found: Any) -> str:
    """Runs that had not settled at their end."""
    said = [
        f"{CONTACTS[name]} ({percent(s.last_change, 2)})"
        for name, s in found.rotors.unbalance.settling.items()
        if not s.settled
    ]
    if not said:
        return ""
    return (
        f"NOT SETTLED (change in the last revolution over the standard deviation of a signal): {', '.join(said)}."
    )


def step_check(found: Any) -> str:
    """Changes by half the step above a hundredth."""
    u, d = found.rotors.unbalance.step_share, found.rotors.decay.step_share
    said = []
    if u is not None and u > LARGE_CHANGE:
        said.append(f"the run with unbalance by {percent(u, 2)} of the standard deviation of a signal")
    if d is not None and d > LARGE_CHANGE:
        said.append(f"the decrement by {percent(d, 2)} of it")
    return f"THE STEP IS LONG: half of it changes {' and '.join(said)}, on the full film." if said else ""


def mesh_warnings(found: Findings) -> str:
    """Warnings of `validate`: a mesh too coarse for this film, numbers beyond the measured range."""
    said = cautions(found.study)
    return f"NOT AS SURE AS IT LOOKS: {'; '.join(said)}." if said else ""


def contact_events(found: Any) -> str:
    """Contacts lost and regained, and time outside what elements stand for."""
    runs: Mapping[str, Events] = {
        "under unbalance": found.rotors.unbalance.events,
        "after the kick": found.rotors.decay.events,
    }
    said = []
    for when, events in runs.items():
        for name, contacts in events.items():
            lost = max(contacts, key=lambda c: (c.lift_offs, c.lost_share))
            if lost.lost_share > 0.0:
                said.append(
                    f"{when} the {CONTACTS[name]} loses contact (of one contact: {lost.lift_offs} lift-offs, "
                    f"{lost.impacts} impacts, {percent(lost.lost_share, 2)} of the time without contact)"
                )
            for quantity in ("approach", "rate", "load", "omega") if name in (ROTOR_BAND[0], MEMORY) else ():
                shares = [getattr(c, f"outside_{quantity}") or 0.0 for c in contacts]
                if max(shares) > 0.0:
                    what = "frequency" if quantity == "omega" else quantity
                    share = percent(max(shares), 2)
                    said.append(f"{when} the {CONTACTS[name]} is outside its {what} for {share} of the time")
    return f"NOTE: {'; '.join(said)}." if said else ""


def failures(found: Any) -> str:
    """Contacts that the rotor could not be run on."""
    said = [f"{CONTACTS[name]} ({reason})" for name, reason in found.rotors.failed.items()]
    return f"The rotor could not be run on: {'; '.join(said)}." if said else ""


def broken_assumptions(found: ContactFindings) -> str:
    """Assumptions that do not hold."""
    return found.assumptions.headline
