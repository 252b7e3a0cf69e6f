"""Numbers and the picture of the bearing in docs/notes/traction.md.

python docs/site/bearing_friction.py   # a minute
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ehlcontact import InputError, Lubricant
from ehlcontact.lubricant import LimitingShear
from reduced_models import BallBearing
from reduced_models.bearing.cage_slip import cage_slip
from reduced_models.bearing.sliding import bearing_friction

IMAGES = Path(__file__).parents[1] / "images"
LAW = LimitingShear(0.07)  # the one traction parameter
SPEEDS, LOADS = (1000.0, 3000.0, 6000.0, 10_000.0), (100.0, 500.0, 1000.0, 2000.0)  # rev/min, N
CLEARANCE = 12e-6  # m, the middle of CN
MFPT = {"balls": 8, "ball_diameter": 5.969e-3, "pitch_diameter": 31.623e-3}  # 0.235 and 1.245 inches
DRAGS = (0.0, 0.2, 1.0, 10.0, 40.0)  # N
MEASURED = ((20.0, 0.56), (667.0, 0.35), (1334.0, 0.15))  # N, of which the first is a guess at 0 lbf; slip in %


def torques():
    """Friction of a 6205 in VG 68 at 60 C, a row for each speed and a column for each load."""
    bearing = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=60.0), clearance=CLEARANCE)
    return [[bearing_friction(bearing, (0.0, -load), speed_rpm=rpm, law=LAW) for load in LOADS] for rpm in SPEEDS]


def draw(found):
    """Parts beside each other."""
    figure = Figure(figsize=(11.0, 3.6), layout="compressed")
    for k, (axes, rpm, row) in enumerate(zip(figure.subplots(1, len(SPEEDS)), SPEEDS, found, strict=True)):
        at = np.arange(len(LOADS))
        for side, names, label in (
            (-0.2, ("rolling", "sliding"), ""),
            (0.2, ("skf_rolling", "skf_sliding"), " SKF"),
        ):
            below = np.zeros(len(LOADS))
            for name, colour in zip(names, ("#0072b2", "#e69f00"), strict=True):
                values = 1e3 * np.array([getattr(one, name) for one in row])
                look = {"color": colour, "alpha": 0.5 if label else 1.0}
                axes.bar(at + side, values, 0.36, bottom=below, label=name.removeprefix("skf_") + label, **look)
                below += values
        axes.set(title=f"{rpm:g} rev/min", xlabel="radial load [N]")
        axes.set_xticks(at, [f"{load:g}" for load in LOADS])
        if k == 0:
            axes.set_ylabel("moment of friction [N mm]")
            axes.legend(frameon=False, fontsize=8)
    figure.savefig(IMAGES / "bearing_friction.png", dpi=110)


def main():
    """All of it."""
    found = torques()
    draw(found)
    ratios = []
    for rpm, row in zip(SPEEDS, found, strict=True):
        for load, one in zip(LOADS, row, strict=True):
            parts = (1e3 * v for v in (one.rolling, one.sliding, one.total, one.skf_rolling, one.skf_sliding))
            ratios.append(one.total / one.skf_total)
            print(f"| {rpm:g} | {load:g} |", " | ".join(f"{v:.2f}" for v in parts), f"| {ratios[-1]:.2f} |")
    print(f"within 20 %: {(np.abs(np.array(ratios) - 1.0) < 0.2).sum()} of {len(ratios)}")
    bearing = BallBearing(**MFPT, oil=Lubricant.iso_vg(32, temperature=40.0), clearance=10e-6)
    for load, measured in MEASURED:
        slips = []
        for drag in DRAGS:
            try:
                slips.append(100.0 * cage_slip(bearing, (0.0, -load), speed_rpm=1500.0, law=LAW, drag=drag))
            except InputError:
                slips.append(np.inf)  # it slides
        print(f"{load:g} N: measured {measured} %, computed", *(f"{slip:.3f}" for slip in slips))


if __name__ == "__main__":
    main()
