"""Errors of the element over speed under a layer of oil in docs/notes/elements.md.

python docs/site/speed_supply_elements.py   # a minute: 6 runs of the full film
"""

import numpy as np
from speed_elements import DT, SPEEDS, errors, motion

from ehlcontact import Grid, MoesPoint, OilLayer, SpeedHistory, TimeSteps, simulate
from reduced_models import Atlas

POINT = MoesPoint(200, 10, 0.5)
LAYERS = (1.5, 0.7)  # nearly r at the speed of the point
DENSITY = 1.2


def main():
    """Runs and errors."""
    atlas = Atlas()
    flooded, film = atlas.element_over_speed(POINT), atlas.at(POINT).h_central
    SPEEDS["run-down"] = [(0, 1), (1, 1), (7, 0.3), (10, 0.3)]
    for r in LAYERS:
        layer = OilLayer(H=r * DENSITY * film)
        over, fixed = (make(POINT, supply=layer) for make in (atlas.element_over_speed, atlas.element))
        for kind in ("run-up", "run-down", "run-up with vibration"):
            T, U, table, rate = motion(kind, fixed.approach_at(1.0))
            time, speed = TimeSteps(until=float(T[-1]), dt=DT), SpeedHistory(T, U)
            full = simulate(POINT, table, grid=Grid(64), speed=speed, supply=layer, time=time).force
            u, momentary = np.array([table.approach(t) for t in T]), []
            for one, approach in zip(U, u, strict=True):
                over.set_speed(one)
                momentary.append(over.spring(approach))
            found = {"full": full, "momentary": np.array(momentary), "fixed": flooded.drive(T, u, rate, U)}
            parts = 100.0 * np.array(errors(found | {"element": over.drive(T, u, rate, U)}))
            rms, static, without, largest = parts
            print(f"r = {r}, {kind}: {rms:.1f} / {largest:.1f} ({static:.0f}, {without:.0f})")


if __name__ == "__main__":
    main()
