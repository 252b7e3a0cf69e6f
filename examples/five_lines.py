"""A 6205 in oil, in five lines: what every ball carries on which film, and what the bearing is in a rotor.

    python examples/five_lines.py [five_lines.png]     # a few seconds, from the atlas: nothing is solved

What one learns: what a bearing is asked for and in which units it answers, and that stiffness comes from the steel
and damping from the oil, so that the latter depends on the frequency at which the rotor shakes.
"""

import sys

import numpy as np

from ehlcontact import Lubricant
from reduced_models import BallBearing
from reduced_models.bearing.coefficients import BearingCoefficients
from reduced_models.bearing.equilibrium_result import BearingState


def five_lines() -> tuple[BearingState, BearingCoefficients]:
    """At rest under 1 kN at 3000 rev/min, and small vibrations about it at 1 Hz to 10 kHz."""
    oil = Lubricant.iso_vg(68, temperature=50.0)
    bearing = BallBearing.catalogue("6205", oil=oil, rq_race=0.1e-6)  # m, roughness
    state = bearing.equilibrium((0.0, -1000.0), speed_rpm=3000)  # N on the inner ring, y upwards
    shaken = bearing.coefficients((0.0, -1000.0), speed_rpm=3000, hz=np.geomspace(1.0, 1e4, 41))
    return state, shaken


def main(picture: str = "five_lines.png") -> None:
    """Print what a designer asks for, and draw it."""
    from matplotlib.figure import Figure

    state, shaken = five_lines()
    K, C = shaken.stiffness[:, 1, 1], shaken.damping[:, 1, 1]  # along the load
    at_shaft = np.argmin(np.abs(shaken.hz - 50.0))
    print(f"the ring stands {-state.displacement[1] * 1e6:.2f} µm low, {state.loaded} balls carry")
    print(f"smallest film {state.h_min.min() * 1e9:.0f} nm, lambda ratio {state.lambda_ratio.min():.1f}")
    print(f"at the shaft's 50 Hz: {K[at_shaft] * 1e-6:.0f} N/µm and {C[at_shaft]:.0f} N s/m along the load")

    figure = Figure(figsize=(9.0, 3.2), layout="constrained")
    zone, stiff, damp = figure.subplots(1, 3)
    zone.bar(np.degrees(state.angles) % 360.0, state.force[:, 0], width=15.0)
    zone.set(xlabel="place of the ball [°]", ylabel="load on the inner race [N]")
    for panel, values, name in ((stiff, K * 1e-6, "stiffness [N/µm]"), (damp, C, "damping [N s/m]")):
        panel.semilogx(shaken.hz, values)
        panel.set(xlabel="frequency [Hz]", ylabel=name, ylim=(0.0, None))
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
