"""A motor turns a rotor on two ball bearings through its critical speed: shaft and bearings are FMUs of one SSP.

    python examples/gear_free_drive.py [gear_free_drive.png]  # half a minute

A disc of 8 kg between two 6205 under a constant torque. `export_drive` writes the archive, which Ecos and the Open
Simulation Platform run as it is; here a loop through fmpy does. What one learns: the motion is that of
`simulate_rotor` at the speed of this run; nearly all of the torque that the motor loses goes into the bearings,
and what the unbalance puts into vibrations comes from the motor too.
"""

import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact import Lubricant
from fmu import export_drive
from fmu.system.master import SystemRun
from reduced_models import BallBearing, BearingMount, Rotor, SpeedProfile, Unbalance, simulate_rotor

MASSES = np.array([1.0, 8.0, 1.0])  # kg, of journal, disc, journal
SHAFT = 5e5 * np.array([[1.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])  # N/m
INERTIA, TORQUE, UNBALANCE = 0.02, 50.0, 1e-4  # kg m2, N m, kg m: 12 micrometres
FIRST, UNTIL, STEP = 1500.0, 0.18, 1e-5  # rev/min, s, s
RPM = np.pi / 30.0  # rad/s


def rotor() -> Rotor:
    """Places x, y of the left journal, of the disc and of the right one."""
    held = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))
    return Rotor(
        mass=np.kron(np.diag(MASSES), np.eye(2)),
        stiffness=np.kron(SHAFT, np.eye(2)),
        load=np.kron(MASSES, [0.0, -9.81]),
        mounts=tuple(BearingMount(bearing=held, x=x, y=x + 1) for x in (0, 4)),
        unbalances=(Unbalance(x=2, y=3, amount=UNBALANCE),),
        nodes={"disc": {"x": 2, "y": 3}},
    )


def main(picture: str | None = None) -> dict[str, Any]:
    """Both runs, their difference printed, and the picture."""
    from matplotlib.figure import Figure

    with tempfile.TemporaryDirectory() as folder:
        path = export_drive(
            rotor(), Path(folder) / "drive.ssp", inertia=INERTIA, torque=TORQUE, speed_rpm=FIRST,
            speeds_rpm=(FIRST, 6000.0),
        )  # fmt: skip
        watched = [("shaft", name) for name in ("disc.x", "disc.y", "speed")]
        watched += [(part, "rolling_torque") for part in ("bearing_1", "bearing_2")]
        with SystemRun(path.read_bytes()) as run:
            found = run.run(STEP, round(UNTIL / STEP), watched)
    t, speed = STEP * np.arange(len(found)), found[:, 2] / RPM
    whole = simulate_rotor(rotor(), speed_rpm=SpeedProfile(t, speed), dt=STEP, until=UNTIL)
    wanted = whole.disc[: t.size]
    gap = float(np.abs(found[:, :2] - wanted).max() / np.ptp(wanted))
    lost = TORQUE - INERTIA * np.gradient(found[:, 2], t)  # what does not speed the shaft up
    top, bottom = (figure := Figure(figsize=(8.0, 5.0), layout="constrained")).subplots(2, 1, sharex=True)
    top.plot(speed, 1e6 * (found[:, 0] - found[0, 0]), label="FMUs")
    top.plot(speed, 1e6 * (wanted[:, 0] - wanted[0, 0]), "k:", label="simulate_rotor")
    top.set(ylabel="disc across, µm")
    top.legend()
    bottom.plot(speed[2:], lost[2:], label="unbalance and bearings")
    bottom.plot(speed[2:], found[2:, 3:].sum(axis=1), label="bearings")
    bottom.set(xlabel="speed, rev/min", ylabel="torque taken, N m")
    bottom.legend()
    figure.savefig(picture or Path(__file__).with_suffix(".png"), dpi=110)
    print(f"largest difference from simulate_rotor: {100.0 * gap:.2g} % of the motion of the disc")
    print(f"speed reached {speed[-1]:.0f} rev/min; bearings take {found[-1, 3:].sum():.2g} N m")
    return {"gap": gap, "speed": speed, "lost": lost, "drag": found[:, 3:].sum(axis=1), "disc": found[:, :2]}


if __name__ == "__main__":
    main(*sys.argv[1:])
