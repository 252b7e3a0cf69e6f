"""Ball bearings with oil films in a rotor of ROSS, in place of its own: modes, damping, and a run over time.

    python examples/ross_drop_in.py [ross_drop_in.png]     # half a minute; needs ehlcontact[ross]

A shaft of six pieces with a disc of 33 kg in the middle, on two 6205 bearings of 500 N each, at 3000 rpm. What one
learns: `to_ross` is one line of a script for ROSS; `from_ross` puts its rotor on the bearings themselves.
"""

import sys
from typing import Any

import numpy as np

from ehlcontact import Lubricant
from reduced_models import BallBearing, from_ross, simulate_rotor
from reduced_models.rotor.result import RotorResult

RPM, NODES, DISC, LOAD = 3000.0, (1, 5), 3, 500.0  # rev/min; nodes of the bearings and of the disc; N on a bearing
BESIDE, UNBALANCE = {DISC: (0.0, -648.0)}, 3.4e-4  # N beside the weight of 352 N, a belt, say; kg m
SPEEDS = np.linspace(500.0, 9000.0, 18)  # rev/min, for the table of coefficients
BEARING = {"n_balls": 9, "d_balls": 7.94e-3, "fs": LOAD, "alpha": 0.0}  # the same 6205, for ROSS's own element


def bearing() -> BallBearing:
    """Bearing and oil."""
    return BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))


def rotor(*bearings: Any) -> Any:
    """The rotor of ROSS on bearing elements of any kind, or on none."""
    import ross

    steel = ross.Material("steel", rho=7810, E=211e9, G_s=81.2e9)
    shaft = [ross.ShaftElement(L=0.05, idl=0.0, odl=0.04, material=steel) for _ in range(6)]
    disc = ross.DiskElement.from_geometry(n=DISC, material=steel, width=0.07, i_d=0.04, o_d=0.28)
    return ross.Rotor(shaft, [disc], list(bearings))


def on_films(held: BallBearing) -> Any:
    """The rotor on elements from films: all that changes in a script for ROSS."""
    return rotor(*(held.to_ross(n, speeds_rpm=SPEEDS, load=LOAD) for n in NODES))


def on_theirs() -> Any:
    """The rotor on ROSS's own ball bearings."""
    import ross

    return rotor(*(ross.BallBearingElement(n=n, **BEARING) for n in NODES))


def first_mode(model: Any) -> tuple[float, float]:
    """Frequency [Hz] and logarithmic decrement."""
    modal = model.run_modal(RPM * np.pi / 30.0)
    return float(modal.wn[0] / (2.0 * np.pi)), float(modal.log_dec[0])


def over_time(held: BallBearing, seconds: float = 0.2) -> RotorResult:
    """The same shaft on the bearings themselves: every ball and every film, from equilibrium."""
    on_balls = from_ross(rotor(), dict.fromkeys(NODES, held), loads=BESIDE, unbalances={DISC: UNBALANCE})
    return simulate_rotor(on_balls, speed_rpm=RPM, dt=2e-5, until=seconds)


def main(picture: str = "ross_drop_in.png", seconds: float = 0.2) -> None:
    """Print modes, and draw the bearing's coefficients and the ring over time."""
    from matplotlib.figure import Figure

    held, omega = bearing(), SPEEDS * np.pi / 30.0
    damp, ring = (figure := Figure(figsize=(9.0, 3.6), layout="constrained")).subplots(1, 2)
    for name, model in (("films", on_films(held)), ("ROSS's own", on_theirs())):
        print("{:>10}: first mode {:.1f} Hz, decrement {:.4f}".format(name, *first_mode(model)))
        damp.plot(SPEEDS, [model.bearing_elements[0].C(w)[1, 1] for w in omega], label=name)
    damp.set(xlabel="speed [rev/min]", ylabel="damping along the load [N s/m]", yscale="log")
    damp.legend(frameon=False)
    run = over_time(held, seconds)
    ring.plot(run.t * 1e3, run.ring[:, 0, 1] * 1e6)
    ring.set(xlabel="time [ms]", ylabel="ring of the first bearing, upwards [µm]")
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
