"""Numbers and the picture of ball bearings with heat in docs/heat.md.

python docs/site/heat_bearing.py   # a minute
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ehlcontact import Lubricant
from reduced_models import BallBearing

IMAGES = Path(__file__).parents[1] / "images"
OIL = Lubricant.iso_vg(68, temperature=50.0)
BEARINGS = (("6205", 1000.0), ("6305", 2000.0))  # radial load, N
SPEEDS = np.array([1000.0, 2000.0, 3000.0, 4500.0, 6000.0, 8000.0, 10_000.0, 12_500.0, 15_000.0])
TABLE = (1000.0, 3000.0, 6000.0, 10_000.0, 15_000.0)
STYLES = ((None, "--", "isothermal"), (True, "-", "with heat"))


def along(name, load, thermal):
    """Film [um], K [N/um], C [N s/m] along the load and torque of the films [N mm] over speed."""
    bearing = BallBearing.catalogue(name, oil=OIL, thermal=thermal)
    rows = []
    for rpm in SPEEDS.tolist():
        state = bearing.equilibrium((0.0, -load), speed_rpm=rpm)
        small = bearing.coefficients((0.0, -load), speed_rpm=rpm, hz=rpm / 60.0)
        film = 1e6 * state.h_central[state.heaviest, 0]
        rows.append((film, 1e-6 * small.stiffness[0, 1, 1], small.damping[0, 1, 1], 1e3 * state.rolling_torque))
    return np.array(rows).T


def main():
    """All of it."""
    figure = Figure(figsize=(9.2, 3.4), layout="constrained")
    panels = figure.subplots(1, 3)
    names = (
        "central film, heaviest ball, inner race, µm",
        "damping C along the load, N s/m",
        "torque of the films, N mm",
    )
    for k, (name, load) in enumerate(BEARINGS):
        found = []
        for thermal, line, word in STYLES:
            film, _, C, torque = values = along(name, load, thermal)
            found.append(values)
            for axes, value in zip(panels, (film, C, torque), strict=True):
                axes.plot(1e-3 * SPEEDS, value, f"C{k}{line}", label=f"{name}, {word}")
        for rpm in TABLE:
            at = int(np.flatnonzero(SPEEDS == rpm)[0])
            cold, warm = (part[:, at] for part in found)
            pairs = "; ".join(f"{a:.4g} -> {b:.4g} ({b / a:.3f})" for a, b in zip(cold, warm, strict=True))
            print(f"{name} {load:g} N {rpm:g} rev/min: film, K, C, torque {pairs}")
    for axes, label in zip(panels, names, strict=True):
        axes.set(xlabel="speed, 1000 rev/min", ylabel=label, ylim=(0.0, None))
        axes.grid(alpha=0.3)
    panels[0].legend(frameon=False, fontsize=8)
    figure.savefig(IMAGES / "heat_bearing.png", dpi=130)


if __name__ == "__main__":
    main()
