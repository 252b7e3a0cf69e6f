"""Who knows which number of a report: the headline's and the rotor's part, from `report.rotor`."""

import re

import numpy as np

from report.page import LONE
from report.rotor import CONTACTS, SETTLED


def shares(text, values):
    """The text with a percentage, or a dash, for each ``%``; and the numbers in it."""
    for value in values:
        text = text.replace("%", "-" if value is None else "# \0", 1)
    return text.replace("\0", "%"), [100.0 * value for value in values if value is not None]


def claim_headline(page, rotor):
    again, p = rotor.contact, rotor.contact.point
    stiffness, damping = rotor.impedance("full", 2.0 * np.pi * rotor.hz)
    fitted, unit = again.fit("rotor_band", "cubic"), again.units.damping
    page.claim(
        "presses # N on the inner race (M = #, L = #, kappa = #, # GPa)",
        p.load,
        p.M,
        p.L,
        p.kappa,
        p.p_hertz * 1e-9,
    )
    page.claim(
        "an oil film of # um (± # % of it), # um (± # % of it) at its thinnest",
        *(p.h_central_um, 100.0 * p.h_central_error, p.h_min_um, 100.0 * p.h_min_error),
    )
    page.claim("At the rotor's # Hz a contact is a spring of # N/um", rotor.hz, stiffness * 1e-6)
    page.claim("with a damper of # N s/m, by its impedance there", damping)
    interval = [end * unit for end in fitted.intervals["C1"]]
    page.claim("has # N s/m (95 %: # to #)", fitted.parameters["C1"] * unit, *interval)
    decays = {name: rotor.decrement(run) for name, run in rotor.runs.decaying.items()}
    full = decays.pop("full")
    page.claim("vibrates up and down at # Hz with a logarithmic decrement of # on", full.hz, full.decrement)
    off = {name: found.decrement / full.decrement - 1.0 for name, found in decays.items()}
    for name, found in decays.items():
        page.claim(f"the {CONTACTS[name]} gives # (# % of it)", found.decrement, 100.0 * off[name])
    nearest = min(abs(off[name]) for name in ("undamped", "dry"))
    said = "it is at least # % off" if nearest > 0.2 else "one is # % off"
    page.claim(f"without it, or without its damping, {said}", 100.0 * nearest)
    for name in ("rotor_band", "memory", "dry"):
        _, vibration, _, force = rotor.against_full(name)
        page.claim(f"the {CONTACTS[name]} by # % and # %", 100.0 * vibration, 100.0 * force)
    claim_notes(page, rotor)


def claim_notes(page, rotor):
    """Of the headline: what has not settled, steps that are long, and time outside."""
    wild = {name: rotor.changes(name)[-1] for name in rotor.runs.turning if rotor.changes(name)[-1] > SETTLED}
    if wild:
        listed = ", ".join(f"{CONTACTS[name]} (# %)" for name in wild)
        page.claim(
            f"(change in the last revolution over the standard deviation of a signal): {listed}.",
            *(100.0 * v for v in wild.values()),
        )
    turning, decaying = rotor.runs.turning, rotor.runs.decaying
    step = max(rotor.differences(turning["full"], rotor.runs.turning_half["full"])[::2])
    if step > 0.01:
        page.claim("the run with unbalance by # %", 100.0 * step)
    if (half := step_of_the_decay(rotor)) > 0.01:
        page.claim("the decrement by # % of it", 100.0 * half)
    for when, runs in (("under unbalance", turning), ("after the kick", decaying)):
        for name in ("rotor_band", "memory"):
            outside = np.array([contact[5:] for contact in rotor.events(name, runs[name])], dtype=float).max(
                axis=0
            )
            for what, share in zip(("approach", "rate", "load", "frequency"), outside, strict=True):
                if share > 0.0:
                    page.claim(f"{when} the {CONTACTS[name]} is outside its {what} for # %", 100.0 * share)


def step_of_the_decay(rotor):
    whole, half = (rotor.decrement(runs["full"]) for runs in (rotor.runs.decaying, rotor.runs.decaying_half))
    return abs(half.decrement / whole.decrement - 1.0)


def claim_rotor(page, rotor):
    r, mode = rotor.rotor, rotor.mode("full")
    page.claim("rotor of # kg and # kg of journals", r["disc_mass"], r["journal_mass"])
    page.claim("at # rpm, shaft of # N/um", rotor.hz * 60.0, r["shaft_stiffness"] * 1e-6)
    page.claim("unbalance # g mm", r["unbalance"] * 1e6)
    if rotor.directions == "xy":
        page.claim("balls at ±#°", r["half_angle_deg"])
    loss = r["shaft_damping"] * mode.omega / r["shaft_stiffness"]
    page.claim("# N s/m in the shaft, a loss factor of #", r["shaft_damping"], loss)
    page.claim("and # N s/m from the disc", r["disc_damping"])


def claim_decay(page, rotor):
    r, mode = rotor.rotor, rotor.mode("full")
    page.claim("vertical mode, # Hz with # % of the strain energy", mode.hz, 100.0 * mode.contact_share)
    page.claim("swings by # % of that at rest", 100.0 * r["kick"])
    page.claim("| 95 % | off")
    full = rotor.decrement(rotor.runs.decaying["full"])
    for name, run in rotor.runs.decaying.items():
        found, linear = rotor.decrement(run), rotor.mode(name)
        off = None if name == "full" else found.decrement / full.decrement - 1.0
        text, percent = shares("% | %", (off, found.misfit))
        page.claim(
            f"{CONTACTS[name]} | # | # | # .. # | {text} | # | #",
            *(found.hz, found.decrement, *rotor.interval(name), *percent, linear.hz, linear.decrement),
        )
    page.claim("over # periods, the first being left out", full.periods)
    page.claim("Half the step changes the full film's decrement by # % of it", 100.0 * step_of_the_decay(rotor))
    page.claim("unbalance (# um), of the rotor linearised", r["unbalance"] / r["disc_mass"] * 1e6)
    page.claim("those of the operating speed, # rpm, throughout", rotor.hz * 60.0)
    peaks = {name: {way: rotor.peak(name, way) for way in rotor.directions} for name in CONTACTS}
    for name, found in peaks.items():
        cells, values = "", []
        for way, peak in found.items():
            off = None if name == "full" else peak.amplitude / peaks["full"][way].amplitude - 1.0
            text, percent = shares("%", (off,))
            cells, values = f"{cells} | # | # | {text}", [*values, peak.amplitude, peak.hz, *percent]
        page.claim(CONTACTS[name] + cells, *values)


def claim_unbalance(page, rotor):
    runs, p = rotor.runs, rotor.contact.point
    full, changes, settled = runs.turning["full"], rotor.changes("full"), rotor.settled_from
    page.claim("Each run is of # revolutions", rotor.rotor["revolutions"])
    page.claim("or have had 128 revolutions")
    listed = ", ".join(["# %"] * len(changes))
    until = "" if settled is None else f": settled from revolution {settled + 1} on"
    page.claim(f"revolutions differ by {listed}{until} (limit # %", *(100.0 * c for c in changes), 100.0 * SETTLED)
    turns = 1 if settled is None else rotor.rotor["revolutions"] - settled
    page.claim("lines # Hz apart", rotor.hz / turns)
    page.claim("force of contact 1;")
    for name in list(runs.turning)[1:]:
        found = [*rotor.against_full(name), rotor.changes(name)[-1]]
        page.claim(
            f"{CONTACTS[name]} against full film | # % | # % | # % | # % | # %", *(100.0 * v for v in found)
        )
    chosen, half = CONTACTS["rotor_band"], runs.turning_half
    rows = {
        f"{chosen} against full film, both with half the step, whole run": (half["full"], half["rotor_band"]),
        "full film, step against half step, whole run": (full, half["full"]),
        f"{chosen}, step against half step, whole run (the rotor's integrator alone)": (
            runs.turning["rotor_band"],
            half["rotor_band"],
        ),
    }
    for title, pair in rows.items():
        found = [100.0 * value for value in rotor.differences(*pair)]
        page.claim(f"{title} | # % | # % | # % | # %", *found)
    steps = [step for run in (full, runs.decaying["full"]) for step in (run.t[1] * 1e6, run.t[1] / p.time_unit)]
    page.claim("Step # us = # film time units, in the decay # us = #.", *steps)
    page.claim("The full film took # solves", full.iterations[1:].mean())


def claim_events(page, rotor):
    for when, runs in (("unbalance", rotor.runs.turning), ("kick", rotor.runs.decaying)):
        for name, run in runs.items():
            for number, found in enumerate(rotor.events(name, run), start=1):
                text, percent = shares("% | % | % | % | %", found[4:])
                row = f"{when}: {CONTACTS[name]} | {number} | # .. # | # | # | {text}"
                page.claim(row, *found[:4], *percent)
    page.claim("below # % of its load at rest", 1.0)
    claim_warnings(page, rotor)


def claim_warnings(page, rotor):
    """Each as it stands in the results, but for its numbers; none is left out."""
    expected = {
        (when, CONTACTS[name], k + 1): rotor.warned(name, run, k)
        for when, runs in (("unbalance", rotor.runs.turning), ("kick", rotor.runs.decaying))
        for name, run in list(runs.items())[1:]
        for k in range(run.force.shape[1])
    }
    for line in rotor.results["warnings"]:
        head, text, numbers = re.fullmatch(r"(.*?): (.*) \(contact ([\d, ]+)\)", line).groups()
        told = [expected.pop((*head.split(", ", 1), int(number))) for number in numbers.split(", ")]
        page.claim(f"{head}: {LONE.sub('#', text)} (contact {numbers})", *told[0])
    assert not any(expected.values())
