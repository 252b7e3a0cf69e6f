"""Who knows which number of a report about whole bearings: `report.whole`."""

import pytest

from report.whole import NAMES


def claim_headline(page, whole):
    modes = {name: whole.mode(name, "vertical") for name in NAMES}
    said = "; ".join(f"with {NAMES[name]} # at # Hz" for name in NAMES).replace("1.25e-05", "#")
    numbers = [
        n for name in NAMES for n in ([1.25e-5] if name == "usual" else []) + [modes[name][1], modes[name][0]]
    ]
    page.claim(f"slowest vertical vibration has a decrement of: {said}.", *numbers)
    passing = {name: whole.row(name)["passing"] * 1e9 for name in ("memory", "dry")}
    said = ", ".join(f"# nm with {NAMES[name]}" for name in passing)
    page.claim(f"Balls that pass, at # Hz, move the disc up and down by {said}.", whole.passage, *passing.values())


def claim_table(page, whole, results):
    b, found = whole.study["bearing"], results["whole_bearing"]
    page.claim("# balls of # mm each", b["balls"], b["ball_diameter_mm"])
    page.claim(
        "grooves of # inside and # outside, clearance # um",
        *(whole.wet.conformity_inner, whole.wet.conformity_outer, whole.asked["clearance_um"]),
    )
    page.claim("Each bearing carries # N.", b["radial_load"])
    for k in reversed(range(b["balls"])):  # 0 is the end of 40
        force, film = whole.state.force[k], whole.state.h_min[k] * 1e6
        page.claim(f"{round(k * 360 / b['balls'])}° | #, # | #, #", *force, *film)
    page.claim(
        "The ring stands # um below the middle, without films it would be # um.",
        *(-whole.state.displacement[1] * 1e6, whole.dry_deflection * 1e6),
    )
    page.claim("Balls pass the outer race at # Hz", whole.passage)
    for name, title in NAMES.items():
        row = whole.row(name)
        numbers = [row["vertical"][0], row["vertical"][1], row["horizontal"][0], row["horizontal"][1]]
        numbers += [*(row["ring"] * 1e6), *(row["disc"] * 1e6), row["once"] * 1e6]
        numbers += [None if row["passing"] is None else row["passing"] * 1e9, row["load"]]
        text = title.replace("1.25e-05", "#")
        numbers = [1.25e-5, *numbers] if name == "usual" else numbers
        page.claim(f"{text} | # | # | # | # | #, # | #, # | # | # | #", *numbers)
        peaks = []
        for way in ("horizontal", "vertical"):
            hz, height = whole.highest(name, way)
            theirs = found["resonance"][name][way]  # from frequencies that stand close, not from their top
            assert theirs["hz"] == pytest.approx(hz, rel=1e-3)
            assert theirs["amplitude"] == pytest.approx(height, rel=0.01) and theirs["amplitude"] < 1.001 * height
            peaks += [theirs["amplitude"], theirs["hz"]]
        page.claim(f"{text} | # | # | # | #", *([1.25e-5] if name == "usual" else []), *peaks)
    page.claim(
        "Time steps of # us over # revolutions",
        1e6 / whole.hz / whole.asked["steps_per_revolution"],
        whole.asked["revolutions"],
    )
    page.claim("(Krämer 1993)")
