"""Ball bearings with oil films in a rotor of ROSS, in place of its own: modes, damping, and a run over time.

Needs ``pip install "ehlcontact[ross]"``. Run ``python examples/ross_drop_in.py``: about half a minute, most of it
imports.

A shaft of six pieces with a disc of 33 kg in the middle, on two 6205 bearings of 500 N each, at 3000 rpm.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ehlcontact import Lubricant
from reduced_models import BallBearing, BearingRun, from_ross, simulate_on_bearings

RPM = 3000.0
NODES, DISC = (1, 5), 3
LOAD = 500.0  # N on either bearing
BESIDE = {DISC: (0.0, -648.0)}  # N beside the rotor's own weight of 352 N: a belt, say
UNBALANCE = 3.4e-4  # kg m
SPEEDS = np.linspace(500.0, 9000.0, 18)  # rev/min, for the table of coefficients


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

    return rotor(*(ross.BallBearingElement(n=n, n_balls=9, d_balls=7.94e-3, fs=LOAD, alpha=0.0) for n in NODES))


def first_mode(model: Any) -> tuple[float, float]:
    """Frequency [Hz] and logarithmic decrement."""
    modal = model.run_modal(RPM * np.pi / 30.0)
    return float(modal.wn[0] / (2.0 * np.pi)), float(modal.log_dec[0])


def over_time(held: BallBearing, seconds: float = 0.2) -> BearingRun:
    """The same shaft on the bearings themselves: every ball and every film, from equilibrium."""
    on_balls = from_ross(rotor(), dict.fromkeys(NODES, held), loads=BESIDE, unbalances={DISC: UNBALANCE})
    return simulate_on_bearings(on_balls, speed_rpm=RPM, dt=2e-5, until=seconds)


def main() -> None:
    """Print modes and the run."""
    held = bearing()
    for name, model in (("films", on_films(held)), ("ROSS's own", on_theirs())):
        hz, decrement = first_mode(model)
        K, C = (
            matrix(RPM * np.pi / 30.0) for matrix in (model.bearing_elements[0].K, model.bearing_elements[0].C)
        )
        print(f"{name:>10}: first mode {hz:.1f} Hz, decrement {decrement:.4f}; ", end="")
        print(f"K {K[1, 1]:.3g} and {K[0, 0]:.3g} N/m, C {C[1, 1]:.3g} and {C[0, 0]:.3g} N s/m along and across")
    run = over_time(held)
    late = run.t > 0.5 * run.t[-1]
    ring, disc = run.ring[late, 0] * 1e6, run.displacement[late, 4 * DISC] * 1e6
    print(
        f"over time: the ring stands {-ring[:, 1].mean():.3f} um low and swings {np.ptp(ring[:, 1]):.3f} um, ",
        end="",
    )
    print(f"the disc {np.ptp(disc):.3f} um across")


if __name__ == "__main__":
    main()
