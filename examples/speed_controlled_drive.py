"""A controller of the speed runs a rotor up: shaft, bearings and controller are FMUs of one SSP.

    python examples/speed_controlled_drive.py [speed_controlled_drive.png]  # half a minute

The disc between two 6205 of `gear_free_drive.py`; its motor gives what a proportional-integral controller asks
for, at most 50 N m. What one learns: at the limit the integral does not wind up, so that the speed hardly
overshoots; the motion is that of `simulate_rotor` at the speed of this run, and this speed that of a shaft under
the same law of torque, integrated by itself.
"""

import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from gear_free_drive import FIRST, INERTIA, RPM, STEP, TORQUE, rotor

from fmu import SpeedController, export_drive
from fmu.system.master import SystemRun
from reduced_models import SpeedProfile, simulate_rotor

LAST, UNTIL = 5500.0, 0.3  # rev/min, s
CONTROLLER = SpeedController(
    speed_rpm=LAST, proportional_gain=2.0, integral_gain=40.0, torque_limit=TORQUE
)  # N m s/rad, N m/rad, N m


def speed_under_the_law(t: np.ndarray, drag: np.ndarray) -> np.ndarray:
    """Speed [rad/s] of the shaft alone, by Euler's method, under the torque of the controller and this drag."""
    omega, summed = np.full(t.size, FIRST * RPM), 0.0
    for k in range(t.size - 1):
        e, h = LAST * RPM - omega[k], t[k + 1] - t[k]
        asked = CONTROLLER.proportional_gain * e + summed
        given = np.clip(asked, -TORQUE, TORQUE)
        summed += CONTROLLER.integral_gain * h * e * (asked == given)
        omega[k + 1] = omega[k] + h * (given - drag[k]) / INERTIA
    return omega


def main(picture: str | None = None) -> dict[str, Any]:
    """All three runs, their differences printed, and the picture."""
    from matplotlib.figure import Figure

    with tempfile.TemporaryDirectory() as folder:
        path = export_drive(
            rotor(), Path(folder) / "drive.ssp", inertia=INERTIA, controller=CONTROLLER, speed_rpm=FIRST,
            speeds_rpm=(FIRST, 6000.0),
        )  # fmt: skip
        watched = [("shaft", name) for name in ("disc.x", "disc.y", "speed")] + [("controller", "torque")]
        watched += [(part, "rolling_torque") for part in ("bearing_1", "bearing_2")]
        with SystemRun(path.read_bytes()) as run:
            found = run.run(STEP, round(UNTIL / STEP), watched)
    t, speed, torque, drag = STEP * np.arange(len(found)), found[:, 2], found[:, 3], found[:, 4:].sum(axis=1)
    whole = simulate_rotor(rotor(), speed_rpm=SpeedProfile(t, speed / RPM), dt=STEP, until=UNTIL)
    wanted = whole.disc[: t.size]
    gap = float(np.abs(found[:, :2] - wanted).max() / np.ptp(wanted))
    alone = speed_under_the_law(t, drag)
    off = float(np.abs(speed - alone).max() / np.ptp(speed))
    top, bottom = (figure := Figure(figsize=(8.0, 5.0), layout="constrained")).subplots(2, 1, sharex=True)
    top.plot(t, speed / RPM, label="FMUs")
    top.plot(t, alone / RPM, "k:", label="shaft alone under the same law")
    top.set(ylabel="speed, rev/min")
    top.legend()
    bottom.plot(t, torque)
    bottom.set(xlabel="time, s", ylabel="torque of the motor, N m")
    figure.savefig(picture or Path(__file__).with_suffix(".png"), dpi=110)
    print(f"largest difference from simulate_rotor: {100.0 * gap:.2g} % of the motion of the disc")
    print(f"largest difference from the shaft alone: {100.0 * off:.2g} % of the range of the speed")
    print(f"speed at most {speed.max() / RPM:.0f} rev/min, at the end {speed[-1] / RPM:.1f}")
    return {"gap": gap, "off": off, "speed": speed / RPM, "torque": torque, "t": t, "drag": drag}


if __name__ == "__main__":
    main(*sys.argv[1:])
