"""Clearance and axial load that belong to a measured contact angle, and damping of films over axial preload.

    python examples/orders_of_defects.py [orders_of_defects.png]     # ten seconds

Defect orders of the 6205 in four records of CWRU give contact angles of 9.4 to 10.0 degrees: clearances and
axial loads that have 9.6, dry and at standstill, with a rotor's weight on the bearing too. On the right,
damping ratio of the films of a 6200 for an assumed mass; Mitsuya et al. (J. Tribol. 120 (1998) 413) measured 2
to 4 % with everything that damps, and a loss factor of rings and fits would explain the rest. What one learns: an
order gives a curve of clearance and load, and films alone are a part of the damping of a bearing.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import brentq

from ehlcontact import Lubricant
from reduced_models import BallBearing

ANGLE, AXIAL, WEIGHTS = 9.6, (5.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0), (0.0, 10.0)  # degrees; N
PRELOADS, MASS, RPM = (10.0, 20.0, 30.0, 50.0, 70.0, 100.0), 0.5, 1000.0  # N, kg on the bearing, rev/min
MEASURED = 0.02, 0.03, 0.04  # damping ratios


def angle(clearance: float, axial: float, weight: float) -> float:
    """Mean contact angle [degrees] of the 6205 at rest, dry, balls weighted by their load."""
    size = {"balls": 9, "ball_diameter": 7.94e-3, "pitch_diameter": 39.04e-3}
    state = BallBearing(clearance=clearance, **size).equilibrium((0.0, -weight, axial))
    return float(np.degrees(np.average(state.contact_angles.mean(axis=1), weights=state.force[:, 0])))


def damping_ratio(preload: float, axis: int, loss_factor: float = 0.0) -> float:
    """Of a 6200 in VG 68 at 40 C with 10 µm of clearance, at the natural frequency of the mass."""
    oil, omega = Lubricant.iso_vg(68, temperature=40.0), 3000.0
    bearing = BallBearing.catalogue("6200", oil=oil, clearance=10e-6, loss_factor=loss_factor)
    for _ in range(6):
        at = bearing.coefficients((0.0, 0.0, preload), speed_rpm=RPM, omega=omega)
        omega = np.sqrt(at.stiffness[0, axis, axis] / MASS)
    return float(at.damping[0, axis, axis] / (2.0 * MASS * omega))


def missing_loss(preload: float, ratio: float) -> float:
    """Loss factor of rings and fits with which the axial mode has a damping ratio."""
    return float(brentq(lambda loss: damping_ratio(preload, 2, loss) - ratio, 0.0, 0.2, xtol=1e-5))


def main(picture: str | None = None) -> dict[str, Any]:
    """All results, printed, and the picture."""
    from matplotlib.figure import Figure

    curves = {w: [brentq(lambda c, f=f, w=w: angle(c, f, w) - ANGLE, 1e-6, 9.3e-6) for f in AXIAL]
              for w in WEIGHTS}  # fmt: skip
    ratios = {name: [damping_ratio(f, axis) for f in PRELOADS] for name, axis in (("axial", 2), ("radial", 0))}
    losses = {preload: [missing_loss(preload, ratio) for ratio in MEASURED] for preload in PRELOADS[::5]}
    for preload, loss in losses.items():
        print(f"{preload:g} N: loss factors for an axial damping ratio of {MEASURED}", np.round(loss, 4))
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    for weight, curve in curves.items():
        print(f"weight {weight:g} N: clearances [µm]", np.round(1e6 * np.array(curve), 2))
        style = "x--" if weight else "o-"
        left.plot(AXIAL, 1e6 * np.array(curve), style, label=f"rotor's weight {weight:g} N")
    left.set(xlabel="axial load, N", ylabel="clearance for 9.6 degrees, µm")
    for name, ratio in ratios.items():
        print(f"{name}: damping ratio of the films [%]", np.round(100.0 * np.array(ratio), 2))
        right.plot(PRELOADS, 100.0 * np.array(ratio), "o-", label=name)
    right.axhspan(2.0, 4.0, alpha=0.15, label="measured, whole bearing")
    right.set(xlabel="axial preload, N", ylabel="damping ratio, %", ylim=(0.0, 4.2))
    for one in (left, right):
        one.legend()
    figure.savefig(picture or Path(__file__).with_name("orders_of_defects.png"), dpi=110)
    return {"curves": curves, "ratios": ratios, "losses": losses}


if __name__ == "__main__":
    main(*sys.argv[1:2])
