"""Picture of a bearing with heat and with a layer of oil in docs/notes/bearings.md.

python docs/site/oil_and_heat.py   # half a minute
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ehlcontact import Heat, Lubricant, OilLayer
from reduced_models import BallBearing
from reduced_models.bearing.oil_and_heat import BOTH, FLOODED, HEAT, LAYER, oil_and_heat
from reduced_models.bearing.picture import from_load

IMAGES = Path(__file__).parents[1] / "images"
BEARING = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=60.0))
BAND = np.geomspace(10.0, 20e3, 41)


def conditions():
    """Bearings by their words, with the state that they share and the frequencies."""
    found = {
        ratio: oil_and_heat(
            BEARING,
            (0.0, -1000.0),
            speed_rpm=3000.0,
            supply=OilLayer(over_flooded=ratio),
            thermal=Heat(),
            band=BAND,
        )
        for ratio in (1.5, 1.0)
    }
    one, two = (found[ratio].conditions for ratio in (1.5, 1.0))
    shown = {FLOODED: one[FLOODED], HEAT: one[HEAT], "layer, r = 1.5": one[LAYER]}
    return found[1.0].state, shown | {"layer, r = 1": two[LAYER], f"{BOTH}, r = 1": two[BOTH]}


def draw():
    """Films around the ring, K and C over the frequency."""
    state, shown = conditions()
    figure = Figure(figsize=(10.0, 3.8), layout="constrained")
    around, left, right = figure.subplots(1, 3)
    place = from_load(state)
    order = [k for k in np.argsort(place) if state.approach[k].sum() > 0.0]
    for (words, one), style in zip(shown.items(), ("k--", "C3-", "C9-", "C0-", "C2:"), strict=True):
        around.plot(place[order], 1e6 * one.h_central[order, 0], style, marker=".", label=words)
        left.semilogx(BAND, 1e-6 * one.stiffness[2:, 1], style)
        right.semilogx(BAND, one.damping[2:, 1], style)
        print(f"{words}: film {1e6 * one.h_central[state.heaviest, 0]:.4f} um, C {one.damping[:2, 1].round(1)}")
    around.set(xlabel="angle from the load [degrees]", ylabel="central film, inner race [µm]", ylim=(0.0, None))
    around.legend(fontsize=8, loc="lower center")
    left.set(xlabel="frequency [Hz]", ylabel="K along the load [N/µm]")
    right.set(xlabel="frequency [Hz]", ylabel="C along the load [N s/m]")
    right.axhline(0.0, color="black", linewidth=0.8)
    for axes in (around, left, right):
        axes.grid(alpha=0.3)
    figure.savefig(IMAGES / "oil_and_heat.png", dpi=130)


if __name__ == "__main__":
    draw()
