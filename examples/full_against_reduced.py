"""One rotor after a kick, on the film itself and on what takes its place: element with memory, cubic, dry contact.

    python examples/full_against_reduced.py [full_against_reduced.png]     # half a minute, most of it the film

What one learns: the film and its elements go into a rotor by the same call; the element with a memory loses as
much in a period as the film does; a cubic with a damper from the contact's own vibrations loses far less, and
warns that it was not made for this.
"""

import sys
from math import pi, sqrt
from typing import Any

import numpy as np

from ehlcontact import Grid, Lubricant, OperatingPoint, TransientContact
from reduced_models import Atlas, jeffcott_rotor, simulate_rotor
from reduced_models.rotor.baselines import dry_contact
from reduced_models.rotor.decay import log_decrement
from reduced_models.rotor.result import RotorResult

BALL, MASS, KICK = 50.0, 2.0, 0.05  # N on the ball of either bearing; kg; of the approach at rest
OIL = Lubricant(eta0=0.037, alpha=2e-8)
POINT = OperatingPoint.ball_bearing(
    OIL, ball_diameter=7.94e-3, pitch_diameter=39.04e-3, conformity=0.52, speed_rpm=3000, load=BALL
)
PRESSED = (0.0, (MASS + 0.2) * 9.81 - 2.0 * BALL)  # N on the disc beside its weight
ROTOR = jeffcott_rotor(
    disc_mass=MASS, journal_mass=0.2, shaft_stiffness=2e8, bearings=2, load=PRESSED, point=POINT
)
OMEGA = sqrt(2.0 * 1.5 * POINT.scales.stiffness / MASS)  # rad/s, about that of the rotor on its contacts


def kicked(contact: Any, rest: float, periods: float, steps: int = 40) -> RotorResult:
    """The rotor starts from rest with a velocity; `steps` in a period."""
    start = ROTOR.rest_at([rest]), np.full(2, KICK * rest * OMEGA)  # disc and journal
    period = 2.0 * pi / OMEGA
    return simulate_rotor(ROTOR.on([contact]), dt=period / steps, until=periods * period, start=start)


def full(periods: float = 8.0, n: int | None = None) -> RotorResult:
    """On the film, solved in every step."""
    film = TransientContact(POINT, grid=Grid(n=n))
    return kicked(film, film.static_approach, periods)


def reduced(periods: float = 8.0) -> dict[str, RotorResult]:
    """On elements: no time at all."""
    atlas, own = Atlas(), {"Omega": 2.0 * pi}  # the contact's own vibration, about
    elements = {"memory": atlas.element(POINT), "cubic": atlas.element(POINT, "cubic", **own)}
    elements["dry"] = dry_contact(POINT.scales)
    rests = {name: one.approach_at(BALL) for name, one in elements.items()}
    for name, one in elements.items():
        one.rest(rests[name])  # the film of that approach
    return {name: kicked(one, rests[name], periods) for name, one in elements.items()}


def decrement(run: RotorResult) -> float:
    """Logarithmic, of the journal."""
    return log_decrement(run.t, run.journal[:, 1], omega=OMEGA).decrement


def main(picture: str = "full_against_reduced.png") -> None:
    """Print the decrements and draw the journal."""
    from matplotlib.figure import Figure

    runs = {"film": full()} | reduced()
    axes = (figure := Figure(figsize=(9.0, 3.6), layout="constrained")).add_subplot()
    for (name, run), look in zip(runs.items(), ("k-", "c--", "b-", "r:"), strict=True):
        label = f"{name}, decrement {decrement(run):.4f}"
        print(label)
        axes.plot(run.t * 1e3, (run.journal[:, 1] - run.journal[0, 1]) * 1e9, look, label=label)
    axes.set(xlabel="time [ms]", ylabel="journal [nm]", ylim=(-90.0, 130.0))
    axes.legend(frameon=False, ncols=2, loc="upper right")
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
