"""Cost of runs over the number of bearings and of shaft elements: planar bearings and five degrees of freedom.

    python tests/benchmarks/axial_runs.py [docs/images/axial_runs.png]

Processor time per simulated second, steps of 20 µs, 6205 bearings in oil; the smallest of five, in alternation.
"""

import sys
import time

import numpy as np
from matplotlib.figure import Figure

from ehlcontact import Lubricant
from reduced_models import BallBearing, Disc, Shaft, Support, rotor_on_bearings, simulate_rotor

BEARINGS, ELEMENTS, RPM, DT, UNTIL, REPEATS = (2, 3, 4), (4, 16, 32), 3000.0, 2e-5, 0.1, 5


def rotor(held, bearings, elements, axial):
    """A shaft on so many bearings, 100 mm apart, facing each other in turn."""
    own = [{"facing": ("+z", "-z")[k % 2], "offset": 4e-6} if axial else {} for k in range(bearings)]
    return rotor_on_bearings(
        Shaft(length=0.1 * bearings - 0.06, diameter=0.025, elements=elements),
        supports=[Support(position=0.02 + 0.1 * k, bearing=held, **own[k]) for k in range(bearings)],
        discs=[Disc.cylinder(position=0.06, diameter=0.1, width=0.03, bore=0.025, unbalance=1e-6)],
    )


def seconds(made):
    """Processor time of a run over its length."""
    start = time.process_time()
    simulate_rotor(made, speed_rpm=RPM, dt=DT, until=UNTIL)
    return (time.process_time() - start) / UNTIL


def main(picture=None):
    """The table, and the picture where a path is given."""
    held = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))
    found = np.zeros((len(BEARINGS), len(ELEMENTS), 3))
    print("bearings  degrees of freedom  planar  five  ratio")
    for b, bearings in enumerate(BEARINGS):
        for e, elements in enumerate(ELEMENTS):
            pair = [rotor(held, bearings, elements, axial) for axial in (False, True)]
            for made in pair:  # compiled
                seconds(made)
            planar, five = np.array([[seconds(made) for made in pair] for _ in range(REPEATS)]).min(axis=0)
            found[b, e] = pair[0].size, planar, five
            print(f"{bearings:8d}  {pair[0].size:18d}  {planar:6.2f}  {five:4.2f}  {five / planar:5.2f}")
    if picture:
        axes = (figure := Figure(figsize=(6.0, 3.6), layout="constrained")).subplots()
        for b, bearings in enumerate(BEARINGS):
            for column, style, kind in ((1, "--", "planar"), (2, "-", "five degrees of freedom")):
                axes.plot(
                    found[b, :, 0], found[b, :, column], f"o{style}C{b}", label=f"{bearings} bearings, {kind}"
                )
        axes.set(
            xlabel="degrees of freedom of the planar rotor", ylabel="processor time per simulated time", ylim=0
        )
        axes.legend(fontsize="small")
        figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:2])
