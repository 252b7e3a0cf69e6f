"""A small motor on two ball bearings, preloaded by a wave spring: damping over preload, a blow along the shaft.

    python examples/preloaded_motor.py [preloaded_motor.png]     # half a minute

A rotor of 2.7 kg on a shaft of 200 mm, two 6305 bearings with clearance, 12 000 rev/min. The outer ring of the
right bearing is free along the shaft, and a spring presses it. What one learns: with 200 N the mode along the
shaft is damped seven times as much as that which bends it; damping of the bending mode falls with the preload.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact import Lubricant
from reduced_models import BallBearing, Disc, Rotor, Shaft, Support, linearise, rotor_on_bearings, simulate_rotor

RPM, SPRINGS, SPRING = 12000.0, (50.0, 100.0, 200.0, 400.0), 200.0  # rev/min; N, of the figure and of the blow
BLOW, DT, UNTIL = 2e-3, 5e-6, 0.05  # m/s along the shaft; s


def bearing() -> BallBearing:
    """Bearing and oil."""
    return BallBearing.catalogue("6305", clearance="CN", oil=Lubricant.iso_vg(46, temperature=70.0))


def motor(held: BallBearing, spring: float) -> Rotor:
    """The rotor; the left bearing is fixed, a spring pushes the outer ring of the right one to the left."""
    return rotor_on_bearings(
        Shaft(length=0.2, diameter=0.02),
        discs=[Disc.cylinder(position=0.1, diameter=0.08, width=0.06, bore=0.02, unbalance=1e-6)],
        supports=[
            Support(position=0.02, bearing=held, facing="-z"),
            Support(position=0.18, bearing=held, facing="+z", preload=spring),
        ],
    )


def axial_and_bending(rotor: Rotor) -> tuple[Any, Any]:
    """The mode along the shaft, and the slowest that bends it."""
    modes = linearise(rotor, RPM).modes(4)
    axial = max(modes, key=lambda one: one.axial_share)
    return axial, next(one for one in modes if one is not axial)


def blow(rotor: Rotor) -> Any:
    """A run after a blow along the shaft."""
    at_rest, rate = rotor.equilibrium(RPM), np.zeros(rotor.size)
    rate[rotor.nodes["shaft"]["z"]] = BLOW
    return simulate_rotor(rotor, speed_rpm=RPM, dt=DT, until=UNTIL, start=(at_rest, rate))


def main(picture: str | None = None) -> dict[str, Any]:
    """All results, printed, and the picture."""
    held = bearing()
    modes = [axial_and_bending(motor(held, spring)) for spring in SPRINGS]
    rotor = motor(held, SPRING)
    run, linear = blow(rotor), linearise(rotor, RPM)
    state = held.equilibrium(linear.loads[0], speed_rpm=RPM)
    for spring, pair in zip(SPRINGS, modes, strict=True):
        axial, bending = (f"{one.hz:.0f} Hz (decrement {one.decrement:.2g})" for one in pair)
        print(f"{spring:5.0f} N: along the shaft {axial}, bending {bending}")
    print(f"films of {1e6 * state.h_min.min():.2f} µm or more, contact angles up to "
          f"{np.degrees(state.contact_angles.max()):.1f} degrees")  # fmt: skip
    draw(modes, run, state, picture or Path(__file__).with_name("preloaded_motor.png"))
    return {"modes": modes, "run": run, "state": state, "rotor": rotor}


def draw(modes: list[Any], run: Any, state: Any, picture: str | Path) -> None:
    """Frequencies and decrements over the spring, the blow, and contact angles around the ring."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 3.6), layout="constrained")
    left, middle, right = figure.subplots(1, 3)
    for k, name in enumerate(("along the shaft", "bending")):
        left.semilogy(SPRINGS, [pair[k].decrement for pair in modes], "o-", label=name)
    left.set(xlabel="force of the spring, N", ylabel="logarithmic decrement", ylim=(1e-4, 1e-2))
    left.legend()
    z = run.displacement[:, run.nodes["shaft"]["z"]]
    middle.plot(1e3 * run.t, 1e6 * (z - z[0]))
    middle.set(xlabel="time, ms", ylabel="motion along the shaft, µm")
    for column, race in enumerate(("inner race", "outer race")):
        right.plot(np.degrees(state.angles) % 360.0, np.degrees(state.contact_angles[:, column]), "o", label=race)
    right.set(xlabel="angle around the ring, degrees", ylabel="contact angle, degrees")
    right.legend()
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:2])
