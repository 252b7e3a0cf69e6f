"""The first picture of the README: one rotor on five contact models, and the damping of each.

Run ``python docs/why.py``: under a minute, most of it one simulation.

The rotor is that of ``examples/deep_groove_6205.toml``. What differs is the contact of its balls: a guess
(of Hertz' stiffness, with 1.25e-5 s times that as damping, the default of ROSS); Hertz alone; the cubic
spring with a damper, fitted to a harmonic load in the contact's own band as Nonato and Cavalca (2010)
fitted theirs; the element with the film's memory, from the atlas, without a solve; the full film, solved
and linearised.
"""

from __future__ import annotations

from math import pi
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from ehlcontact import Grid, simulate
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.study.rotor import film_response, linear_rotors
from ehlcontact.cli.study.schema import Study, load_study
from ehlcontact.results import Response
from reduced_models import Atlas, ContactRecord, fit
from reduced_models.elements.base import ContactElement
from reduced_models.rotor.baselines import dry_contact, local_contact
from reduced_models.rotor.linear_contact import impedance_about
from reduced_models.rotor.resonance import Resonances, resonances

ROOT = Path(__file__).parents[1]
STUDY, PICTURE = ROOT / "examples" / "deep_groove_6205.toml", ROOT / "docs" / "images" / "why.png"
GUESS = 1.25e-5  # s: damping over stiffness where none is known
FULL, MEMORY, CUBIC, DRY, GUESSED = (
    "full film",
    "film memory, from the atlas",
    "cubic and damper",
    "dry Hertz",
    "guess",
)
LOOKS = {  # colour, line, width
    GUESSED: ("tab:orange", "-", 1.8),
    FULL: ("black", "-", 3.4),
    MEMORY: ("tab:cyan", "--", 1.8),
    CUBIC: ("tab:blue", "-", 1.4),
    DRY: ("tab:red", ":", 1.8),
}


def elements(study: Study) -> dict[str, ContactElement]:
    """What the rotor runs on in place of the film."""
    point, scales = study.point, study.point.scales
    motion, stiffness = study.harmonic_motion, 1.5 * scales.stiffness
    record = simulate(point, motion, grid=Grid(n=study.contact.n_transient, domain=study.domain))
    return {
        MEMORY: Atlas().element(point, "memory"),
        CUBIC: fit(ContactRecord.from_result(record), model="cubic").element,
        DRY: dry_contact(scales),
        GUESSED: local_contact(study.ball_load, scales.length, stiffness, GUESS * stiffness),
    }


def respond(study: Study) -> tuple[Resonances, Response, dict[str, ContactElement]]:
    """Response of the rotor on every contact, the film's impedance, and the elements."""
    film, contacts = film_response(study), elements(study)
    rotors = linear_rotors(study, film, contacts)
    rotors[FULL] = rotors.pop("full")
    return resonances(rotors, study.jeffcott.unbalance / study.jeffcott.disc_mass), film, contacts


def main() -> None:
    """Draw the response to unbalance, and the damping of one contact, side by side."""
    study = load_study(STUDY)
    found, film, contacts = respond(study)
    peaks = found.peaks["y"]
    plt.rcParams.update({"font.size": 10, "axes.spines.top": False, "axes.spines.right": False})
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.8), layout="constrained")

    for name, (colour, line, width) in LOOKS.items():
        label = f"{name}: {numeral(peaks[name].amplitude, 2)}"
        left.semilogy(found.hz, np.abs(found.curves["y"][name]), line, color=colour, linewidth=width, label=label)
    near, highest = [peak.hz for peak in peaks.values()], max(peak.amplitude for peak in peaks.values())
    left.set(xlim=(0.92 * min(near), 1.1 * max(near)), ylim=(2.0, 60.0 * highest))
    left.set(xlabel="frequency of the unbalance [Hz]", ylabel="amplitude of the disc over eccentricity")
    left.set_title("The same rotor on five contact models, and its peak", loc="left", fontsize=10)
    left.legend(frameon=False, fontsize=9, loc="upper left", handlelength=1.8)

    si, hz = film, np.geomspace(20.0, 1e5, 300)
    for name in (GUESSED, CUBIC, MEMORY):
        colour, line, width = LOOKS[name]
        damping = impedance_about(contacts[name], study.ball_load)(2.0 * pi * hz).imag / (2.0 * pi * hz)
        right.loglog(hz, damping, line, color=colour, linewidth=width)
        right.annotate(name, (25.0, 1.1 * float(damping[0])), color=colour, va="bottom")
    solved = (si.hz >= hz[0]) & (si.hz <= hz[-1])
    right.loglog(si.hz[solved], si.damping[solved], "o", color="black", markersize=4.5, zorder=3)
    right.annotate(FULL, (25.0, 0.87 * float(si.damping[solved][0])), color="black", va="top")
    right.axvspan(min(near), max(near), color="0.8")
    right.annotate(" the rotor's\n resonance", (max(near), 0.02), xycoords=("data", "axes fraction"), color="0.4")
    right.set(ylim=(8.0, 1200.0), yticks=(10.0, 100.0, 1000.0), yticklabels=("10", "100", "1000"))
    right.set(xlabel="frequency of the vibration [Hz]", ylabel="damping of one contact [N s/m]")
    right.set_title("Why: what their contacts damp", loc="left", fontsize=10)
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=110)


if __name__ == "__main__":
    main()
