"""What a study says in words: operating line, tiles, what is critical, what does not hold; a verdict per section.

A sentence without content is empty. The page, ``results.json`` and the last lines of a run say the same.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ehlcontact.cli.numerals import numeral, percent
from ehlcontact.cli.study.answer import NAMES
from ehlcontact.cli.study.damper import too_long
from ehlcontact.cli.study.differences import Events, RotorFindings
from ehlcontact.cli.study.forecast import cautions, discs_without_inertia, seals_left_out
from ehlcontact.cli.study.loads import by_formula, places_of_bearings
from ehlcontact.cli.study.machine import balance_speed, disc_of
from ehlcontact.cli.study.reduction import CONTACT_BAND, CONTACTS, DRY, FULL, MEMORY, ROTOR_BAND, UNDAMPED
from ehlcontact.cli.study.results import ContactFindings, Findings
from reduced_models.bearing.catalogue import ROWS, designation_of
from reduced_models.bearing.oil_and_heat import FLOODED, SHOWN, OilAndHeat
from reduced_models.bearing.operating_clearance import NO_FIT
from reduced_models.bearing.set_result import SetState
from reduced_models.rotor.machine_tiles import MARGIN, digits

if TYPE_CHECKING:
    from ehlcontact.cli.study.schema import Study
    from ehlcontact.cli.study.sections import Support

# Change by half the step, over the standard deviation of a signal or the decrement, that has a sentence.
LARGE_CHANGE = 0.01
STANDS_FOR = 0.05  # of the decrement on full films, within which an element stands for the film
SAME_BALL = 1e-3  # share by which loads of a ball differ at least where both are told
PRESSED = 0.2  # change of a preload by fits, over it, that a line names
UM = "\N{MICRO SIGN}m"
AXIAL = 2  # of the components of a load
ROUNDING = 1e-9  # of a diameter
NEGLIGIBLE = 1e-6  # of the largest component of a load, below which another one is none


def document(found: Findings) -> dict[str, Any]:
    """Content of ``results.json``: the sentences, and all numbers."""
    said = {
        "status": "converged",
        "title": found.study.title,
        "operating_line": operating_line(found),
        "verdict": "" if found.rotors is None else verdict(found.rotors),
        "answer": headline(found),
        "does_not_hold": limits(found),
    }
    return said | found.to_dict()


def headline(found: Findings) -> str:
    """The answer in lines: operating line, tiles, what is critical, what does not hold."""
    machine = found.machine
    if isinstance(machine, str):
        return "\n".join(filter(None, (operating_line(found), f"not computed: {machine}", *limits(found))))
    tiles = (tile.brief for tile in found.tiles)
    critical = (f"critical: {text}" for text in machine.concerns)
    broken = limits(found)
    holds = f"does not hold: {'; '.join(broken)}" if broken else ""
    return "\n".join(filter(None, (operating_line(found), *tiles, *critical, holds)))


def operating_line(found: Findings) -> str:
    """Machine, speed, loads and oil in one sentence."""
    study, machine = found.study, found.machine
    oil = "dry" if study.oil is None else f"in {study.oil.label}"
    speed = f"at {numeral(study.speed_rpm, 6)} rev/min"
    if isinstance(machine, str):
        return f"{study.title or 'Machine'} {speed}, {oil}."
    parts = [(support.label or "ball bearing", load_words(support.state.load)) for support in machine.supports]
    if study.shaft is None:
        (name, load), *_ = parts
        turns = "" if study.support[0].turning == "inner" else " of the outer ring"
        return f"{name[0].upper()}{name[1:]} under {load} {speed}{turns}, {oil}."
    on = [f"{name} ({load})" for name, load in parts]
    stands = " and ".join(filter(None, (", ".join(on[:-1]), on[-1])))
    return f"Shaft on {stands} {speed}, {oil}{_of_grades(study)}."


def _of_grades(study: Study) -> str:
    """Unbalances of balance grades, after a comma."""
    said = []
    for k, disc in enumerate(study.disc):
        if disc.balance_grade is not None:
            name = "the disc" if len(study.disc) == 1 else f"disc {k + 1}"
            amount, speed = numeral(1e6 * disc_of(study, k).unbalance, 3), numeral(balance_speed(study, k), 6)
            said.append(f"{amount} g mm at {name} (G {disc.balance_grade:g} at {speed} rev/min)")
    return f", unbalance {' and '.join(said)}" if said else ""


def load_words(load: Any) -> str:
    """Radial and axial part of a load in words."""
    radial, axial = float(np.hypot(*load[:2])), float(load[AXIAL]) if len(load) > AXIAL else 0.0
    parts = f"{numeral(radial, 3)} N radially", f"{numeral(axial, 3)} N axially"
    sizes = radial, abs(axial)
    said = [text for text, size in zip(parts, sizes, strict=True) if size > NEGLIGIBLE * max(sizes)]
    return " and ".join(said) or "no load"


def limits(found: Findings) -> list[str]:
    """What does not hold, with its number, one text for all supports of which it is said."""
    machine = found.machine
    rest = [] if found.uncertainty is None else found.uncertainty.remarks
    rest += [text for text in (without_films(found), damping_below_zero(found)) if text]
    rest += [] if found.periodic is None else found.periodic.reservations
    rest += [*clearances_apart(found), *discs_without_inertia(found.study), *seals_left_out(found.study)]
    rest += too_long(found.study)
    if isinstance(machine, str):
        broken = "" if found.contact is None else found.contact.assumptions.headline
        return [*filter(None, [broken]), *rest]
    said: dict[str, dict[str, list[str]]] = {}  # supports by assumption and by what is said of it
    labels, several = {support.label for support in machine.supports}, len(machine.supports) > 1
    for text in machine.reservations:
        label, _, own = text.partition(": ") if text.partition(": ")[0] in labels else ("", "", text)
        what, _, detail = own.partition(": ") if label else (text, "", "")
        said.setdefault(what, {}).setdefault(detail, []).append(label if several else "")
    lines = []
    for what, details in said.items():
        each = [": ".join(filter(None, (", ".join(filter(None, of)), detail))) for detail, of in details.items()]
        inside = "; ".join(filter(None, each))
        lines.append(f"{what} ({inside})" if inside else what)
    return [*lines, *rest]


def clearances_apart(found: Findings) -> list[str]:
    """Bearings on fits that preload some, press a pair, hold a sprung ring, or leave the ring that turns loose."""
    said: dict[str, list[str]] = {}  # labels of bearings of which a text is
    supports = dict(zip(found.study.names, found.study.support, strict=True))
    for name, own in found.clearances.items():
        numbered = name.isdigit() or own.name in name
        label = (name if own.name in name else own.name) if numbered else f"{name} {own.name}"
        low, mean, high, least, most = (f"{1e6 * one + 0.0:.3g}" for one in (*own.clearance, *own.probable))
        texts = []
        if own.clearance[0] < 0.0:
            texts.append(
                f"clearance in operation of LABEL is {low} to {high} {UM}, probably {least} to {most} {UM}:"
                f" everything but the range of the life is for the mean, {mean} {UM}"
            )
        before, mounted = found.preloads.get(name, (0.0, 0.0))
        if abs(mounted - before) > PRESSED * before:
            texts.append(f"fits and temperatures press LABEL with {digits(mounted)} N, not {digits(before)} N")
        if own.turning_pressed[2] < 0.0:
            gap = f"{-1e6 * own.turning_pressed[2]:.3g} {UM}"
            texts.append(f"{own.loose_of('LABEL')} in the loosest fit: a gap of {gap}")
        if own.outer_pressed[0] > 0.0 and (supports[name].spring, supports[name].pair_spring) != (None, None):
            tight = f"{1e6 * own.outer_pressed[0]:.3g} {UM} and {1e-6 * own.outer_pressure[0]:.3g} MPa"
            texts.append(
                f"the housing holds the outer ring of LABEL in the tightest fit, by {tight}:"
                " its spring cannot move it"
            )
        if own.fits[0] != NO_FIT and (wide := _wide_shaft(found.study, supports[name])):
            texts.append(f"the fit of LABEL is on {wide}")
        for text in texts:
            said.setdefault(text, []).append(label)
    return [text.replace("LABEL", " and ".join(labels)) for text, labels in said.items()]


def _wide_shaft(study: Study, support: Support) -> str:
    """Diameters of a journal and of the wider shaft of the model, in words; empty where none is wider."""
    wide = None if study.shaft is None else study.shaft.diameter_mm
    bore = None if support.bearing is None else ROWS[designation_of(support.bearing).name].bore
    if wide is None or bore is None or wide <= 1e3 * bore * (1.0 + ROUNDING):
        return ""
    return f"a journal of {1e3 * bore:g} mm, its bore; the shaft of the model has {wide:g} mm there"


def calm(found: Findings) -> str:
    """That nothing is critical, with the numbers that show it; empty where something is, or was not computed."""
    machine = found.machine
    if isinstance(machine, str) or machine.concerns or machine.failed:
        return ""
    ratio, nearest = machine.worst_support.lambda_ratio, machine.nearest_critical
    said = [] if ratio is None else [f"lambda {numeral(ratio, 3)}"]
    if machine.diagram is not None:
        end = f"below {numeral(float(machine.diagram.speed_rpm[-1]), 5)} rev/min"
        within = end if nearest is None else f"that unbalance excites within {percent(MARGIN)} of the speed"
        said.append(f"no critical speed {within}")
    return ", ".join(said)


def verdict(rotors: RotorFindings) -> str:
    """Whether elements stand for the full film, and whether the film decides the damping, in two sentences."""
    d = rotors.decay
    elements = {name: abs(d.off(name)) for name in (ROTOR_BAND[0], MEMORY) if name in d.decrements}
    nearest, said = d.nearest_without, []
    if elements:
        best = min(elements, key=lambda name: elements[name])
        error, own = percent(elements[best], 2), f"the {CONTACTS[best]}"
        if elements[best] <= STANDS_FOR:
            said.append(f"{own[0].upper()}{own[1:]} stands for the full film: its decrement is {error} off.")
        else:
            said.append(f"No element stands for the full film: with {own} the decrement is {error} off.")
    if nearest is not None:
        decides = "decides" if d.film_decides else "does not decide"
        without = f"Without a film, or without its damping, it is off by {percent(nearest, 2)} or more"
        said.append(f"{without}: the film {decides} the damping.")
    return " ".join(said)


def in_sections(found: Findings) -> dict[str, list[str]]:
    """Sentences with which sections of the page begin, and notes about them, by section."""
    contact_texts = [] if found.contact is None else _sentences(found.contact, contact, damper)
    rotor = () if found.rotors is None else _sentences(found, decay, unbalance)
    notes = () if found.rotors is None else _sentences(found, unsettled, step_check, contact_events, failures)
    return {
        "contact": contact_texts,
        "contact_notes": _sentences(found, mesh_warnings),
        "rotor": list(rotor),
        "rotor_notes": list(notes),
        "in_time": _sentences(found, whole),
        "oil_and_heat": _sentences(found, oil_and_heat),
    }


def _sentences(found: Any, *parts: Callable[[Any], str]) -> list[str]:
    return [text for text in (part(found) for part in parts) if text]


def contact(found: ContactFindings) -> str:
    """Load, pressure and film."""
    op, settings = found.operating_point, found.study.contact
    assert settings is not None
    central, smallest = (uncertainty(found, name) for name in ("h_central_error", "h_min_error"))
    numbers = f"M = {op['M']:.0f}, L = {op['L']:.1f}, kappa = {op['kappa']:.3f}, {op['p_hertz'] * 1e-9:.2f} GPa"
    thick, thin = (f"{op[name]:.3f} \N{MICRO SIGN}m" for name in ("h_central_um", "h_min_um"))
    return (
        f"The most loaded ball of {found.study.carrier.label} presses {numeral(op['load'])} N on the "
        f"{settings.race} race ({numbers}) and rolls on an oil film of {thick}{central}, {thin}{smallest} "
        "at its thinnest."
    )


def ball_words(found: Findings) -> str:
    """Where the load of the contact is from, and that of the most loaded ball of the support with its films."""
    study, machine = found.study, found.machine
    if by_formula(study):
        source = "by Stribeck's formula, of a bearing without clearance and films"
    elif study.shaft is None:
        source = "of the bearing at rest without films"
    else:
        source = "of the machine at rest with its films"
    if isinstance(machine, str):
        return source
    places = places_of_bearings(study)
    own = max((one for one, k in zip(machine.supports, places, strict=True) if k == study.at), key=_ball_load)
    race = 0 if study.contact is None else int(study.contact.race == "outer")
    load = (own.ball_load, own.outer_load)[race]
    if abs(load / study.ball_load - 1.0) < SAME_BALL:
        return source
    why = (
        "films take up clearance, so that more balls share the load"
        if load < study.ball_load
        else "films change it"
    )
    return f"{source}; {numeral(load)} N with films, as in the machine above ({why})"


def _ball_load(one: Any) -> float:
    return float(one.ball_load)


def uncertainty(found: ContactFindings, name: str) -> str:
    """Error of a film by the grid, and its scatter by that of the oil, in words; empty where neither is known."""
    op = found.operating_point
    parts = {"grid": op[name], "oil": op["h_oil_scatter"]}
    said = (
        f"\N{PLUS-MINUS SIGN} {percent(error, 2)} {cause}" for cause, error in parts.items() if error is not None
    )
    return f" ({', '.join(said)})" if any(error is not None for error in parts.values()) else ""


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
        parts.append(f"Warnings of the runs: {'; '.join(found.whole.said)}.")
    return " ".join(parts)


def _flooded_words(found: Findings) -> str:
    """Of bearings of a rotor, where heat or a layer is asked for: they have neither."""
    return "" if not found.oil_and_heat else ", flooded and isothermal,"


def oil_and_heat(found: Findings) -> str:
    """Bearings with heat and with their layer of oil, where they are asked for: films and damping."""
    return " ".join(
        _sentence(f"{of}: {_of_conditions(w)}") if of else _sentence(_of_conditions(w))
        for of, w in conditions_of(found)
        if isinstance(w, OilAndHeat)
    )


def _sentence(text: str) -> str:
    return f"{text[0].upper()}{text[1:]}"


def conditions_of(found: Findings) -> list[tuple[str, OilAndHeat | str]]:
    """Results of oil supply and heat with the supports that share each, empty where all do."""
    shared: dict[int, tuple[list[str], OilAndHeat | str]] = {}
    for name, w in found.oil_and_heat.items():
        shared.setdefault(id(w), ([], w))[0].append(name)
    if len(shared) == 1:
        return [("", next(iter(shared.values()))[1])]
    return [(" and ".join(names), w) for names, w in shared.values()]


def _of_conditions(w: OilAndHeat) -> str:
    ball, way, flooded = w.state.heaviest, next(iter(w.ways.values())), w.conditions[FLOODED]
    said = (
        f"{key} {percent(float((one.h_central / flooded.h_central)[ball, 0]), 3)} of the film and "
        f"{numeral(float(one.damping[0, way]), 3)} N s/m"
        for key, one in w.conditions.items()
        if key != FLOODED
    )
    own = numeral(float(flooded.damping[0, way]), 3)
    carrier = "pair" if isinstance(w.at_rest, SetState) else "bearing"
    text = f"flooded and isothermal, the {carrier} has {own} N s/m of damping at the frequency of the speed; "
    return f"{text}{'; '.join(said) or 'nothing beside it'}."


def without_films(found: Findings) -> str:
    """Conditions of oil and heat that were asked for and have no films, and why."""
    said = []
    for of, w in conditions_of(found):
        bearing = of or "the bearing"
        if isinstance(w, str):
            said.append(f"not computed: oil supply and heat of {bearing} ({w})")
        elif w.refused:
            reasons = "; ".join(f"{key} ({reason})" for key, reason in w.refused.items())
            said.append(f"no films of {bearing} {reasons}")
    return "; ".join(said) + "." if said else ""


def damping_below_zero(found: Findings) -> str:
    """Conditions of oil and heat in which a bearing adds energy to small vibrations."""
    bearings = []
    for of, w in conditions_of(found):
        if not isinstance(w, OilAndHeat):
            continue
        said = [
            f"{key} {numeral(C, 3)} N s/m at {numeral(hz)} Hz{f' {way}' if len(w.ways) > 1 else ''}"
            for key, one in w.conditions.items()
            for k, hz in enumerate(w.hz[:SHOWN].tolist())
            for way, column in w.ways.items()
            if (C := float(one.damping[k, column])) < 0.0
        ]
        if said:
            bearings.append(f"{of or 'the bearing'} has {'; '.join(said)}")
    if not bearings:
        return ""
    return f"damping below zero: {'; '.join(bearings)}: there films add energy to vibrations."


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
        f"Not settled (change in the last revolution over the standard deviation of a signal): {', '.join(said)}."
    )


def step_check(found: Any) -> str:
    """Changes by half the step above a hundredth."""
    u, d = found.rotors.unbalance.step_share, found.rotors.decay.step_share
    said = []
    if u is not None and u > LARGE_CHANGE:
        said.append(f"the run with unbalance by {percent(u, 2)} of the standard deviation of a signal")
    if d is not None and d > LARGE_CHANGE:
        said.append(f"the decrement by {percent(d, 2)} of it")
    return f"The step is long: half of it changes {' and '.join(said)}, on the full film." if said else ""


def mesh_warnings(found: Findings) -> str:
    """Warnings of `validate`: a mesh too coarse for this film, numbers beyond the measured range."""
    said = cautions(found.study)
    return f"Less sure than it looks: {'; '.join(said)}." if said else ""


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
    return f"Note: {'; '.join(said)}." if said else ""


def failures(found: Any) -> str:
    """Contacts that the rotor could not be run on."""
    said = [f"{CONTACTS[name]} ({reason})" for name, reason in found.rotors.failed.items()]
    return f"The rotor could not be run on: {'; '.join(said)}." if said else ""
