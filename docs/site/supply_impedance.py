"""Picture of stiffness and damping over the supply of oil in docs/notes/oil_supply.md.

python docs/site/supply_impedance.py   # a minute or two
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ehlcontact import Domain, Grid, MoesPoint, OilLayer, impedance

IMAGES = Path(__file__).parents[1] / "images"
POINTS = (MoesPoint(20, 10, 1), MoesPoint(200, 10, 0.5), MoesPoint(1000, 12, 0.3))
REGION = Domain(-6.0, 1.5, 3.0)  # the front at r = 3 is far ahead
RATIOS = np.array([0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0])
OMEGA = {"0.05": 0.05, "1": 1.0, "2π": 2.0 * np.pi}


def shares(point):
    """K and C over those of the flooded film, shape (2, ratios, frequencies)."""
    omega = list(OMEGA.values())
    flooded = impedance(point, Omega=omega, grid=Grid(160, REGION))
    found = [
        impedance(point, Omega=omega, grid=Grid(160, REGION), supply=OilLayer(over_flooded=ratio))
        for ratio in RATIOS
    ]
    return np.array(
        [[one.stiffness / flooded.stiffness for one in found], [one.damping / flooded.damping for one in found]]
    )


def draw():
    """K above, C below, a column for each frequency."""
    figure = Figure(figsize=(9.0, 5.4), layout="constrained")
    axes = figure.subplots(2, len(OMEGA), sharex=True, sharey="row")
    for point in POINTS:
        name = f"{point.M:g}, {point.L:g}, {point.kappa:g}"
        found = shares(point)
        print(name, *(f"\n  r {r:g}: {np.round(found[:, k].ravel(), 3)}" for k, r in enumerate(RATIOS)))
        for row, values in zip(axes, found, strict=True):
            for one, value in zip(row, values.T, strict=True):
                one.semilogx(RATIOS, value, ".-", linewidth=1.2, label=name)
    for one, words in zip(axes[0], OMEGA, strict=True):
        one.set_title(f"Omega = {words}", fontsize=10)
    for one in axes.flat:
        one.axhline(1.0, color="grey", linewidth=0.8, linestyle="--")
        one.set_xticks([0.3, 0.5, 1.0, 2.0, 3.0], labels=["0.3", "0.5", "1", "2", "3"])
        one.minorticks_off()
        one.grid(alpha=0.3)
    for one in axes[1]:
        one.axhline(0.0, color="black", linewidth=0.8)
    axes[0, 0].set_ylabel("K over that of the flooded film")
    axes[1, 0].set_ylabel("C over that of the flooded film")
    figure.supxlabel("layer of oil over what the flooded film lets through", fontsize=10)
    axes[1, 0].legend(title="M, L, kappa", fontsize=8, title_fontsize=8)
    figure.savefig(IMAGES / "supply_impedance.png", dpi=130)


if __name__ == "__main__":
    draw()
