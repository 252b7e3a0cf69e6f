"""Force of a mass on a 6205 whose outer race has a spall of 0.5 or 2 mm: over time, and as a spectrum.

Beside runs with heights that the contacts and their films filter there are those with the bare step. One minute on
one core:

    python examples/studies/spalled_bearing.py [spalled_bearing.png]
"""

import sys
from dataclasses import dataclass, replace
from math import pi

import numpy as np

from ehlcontact import Lubricant
from reduced_models import BallBearing, BearingMount, Rotor, Spall, simulate_rotor
from reduced_models.bearing.height_tables import profile_of, track_radius

MASS, DAMPING, LOAD, SPEED = 5.0, 2000.0, 500.0, 1800.0  # kg, N s/m of what holds the mass, N, rev/min
LENGTHS, DEPTH = (0.5e-3, 2e-3), 50e-6  # m
AT = -pi / 2  # under the load
DT, UNTIL, SETTLED = 4e-6, 0.4, 0.1  # s
SMOOTH = BallBearing.catalogue("6205", clearance=5e-6, oil=Lubricant.iso_vg(68, temperature=50.0))


@dataclass
class Run:
    """Vertical force of the bearing over time, and where a ball enters and leaves the spall."""

    t: np.ndarray
    force: np.ndarray
    passages: np.ndarray  # (k, 2) times at which the centre of a ball is over both edges [s]


def spalled(length: float) -> BallBearing:
    """The bearing with its spall."""
    return replace(SMOOTH, features=[Spall(race="outer", angle=AT, length=length, depth=DEPTH)])


def without_filter(bearing: BallBearing) -> BallBearing:
    """The same with the bare height under the middle of every contact."""
    bare = profile_of(bearing, bearing.features, "outer", track_radius(bearing, "outer"))
    heights = bearing.tables.heights.copy()
    heights[1, : bare.size] = bare[:, None]
    bearing.tables.heights_in_films[SPEED] = heights
    return bearing


def run(bearing: BallBearing, length: float) -> Run:
    """A mass on the bearing."""
    mount = BearingMount(bearing=bearing, x=0, y=1)
    rotor = Rotor(
        mass=np.diag([MASS, MASS]),
        damping=np.diag([DAMPING, DAMPING]),
        stiffness=np.zeros((2, 2)),
        load=(0.0, -LOAD),
        mounts=(mount,),
    )
    found = simulate_rotor(rotor, speed_rpm=SPEED, dt=DT, until=UNTIL)
    return Run(found.t, found.force[:, 1], passages(mount.cage_angle, length))


def passages(cage_angle: float, length: float) -> np.ndarray:
    """Times at which balls are over both edges of the spall [s]."""
    cage = SMOOTH.orders.ftf_order * SPEED * pi / 30.0
    edges = AT + np.array([-0.5, 0.5]) * length / track_radius(SMOOTH, "outer")
    turns = 2.0 * pi * np.arange(round(UNTIL * cage * SMOOTH.balls / (2.0 * pi)) + 1) / SMOOTH.balls
    return (edges + turns[:, None] - cage_angle) / cage


def spectrum(one: Run) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies [kHz] and amplitudes [N] of the settled force."""
    force = one.force[one.t > SETTLED]
    window = np.hanning(force.size)
    return np.fft.rfftfreq(force.size, DT) * 1e-3, np.abs(
        np.fft.rfft((force - force.mean()) * window)
    ) * 2.0 / window.sum()


def draw(found: dict[float, tuple[Run, Run]], path: str) -> None:
    """Forces over one passage, and their spectra."""
    import matplotlib.pyplot as plt

    figure, panels = plt.subplots(2, len(found), figsize=(10.0, 6.4), sharey="row", layout="constrained")
    for (over_time, lines), (length, (filtered, bare)) in zip(panels.T, found.items(), strict=True):
        enters, leaves = filtered.passages[filtered.passages[:, 0] > SETTLED][0] * 1e3
        for one, style, label in ((bare, "C3", "bare step"), (filtered, "k", "filtered by contact and film")):
            over_time.plot(one.t * 1e3, -one.force, style, lw=0.9 if one is bare else 1.3, label=label)
            lines.semilogy(*spectrum(one), style, lw=0.6, label=label)
        over_time.axvspan(enters, leaves, color="#cfe3f5", zorder=0, label="ball over the spall")
        over_time.set(xlim=(enters - 1.0, enters + 6.0), xlabel="time [ms]")
        over_time.set_title(f"spall of {length * 1e3:g} mm", fontsize=10)
        lines.set(xlabel="frequency [kHz]", xlim=(0.0, 20.0), ylim=(1e-3, 1e3))
    panels[0, 0].set_ylabel("force of the bearing [N]")
    panels[1, 0].set_ylabel("amplitude [N]")
    panels[0, 0].legend(fontsize=8)
    figure.savefig(path, dpi=130)


def main() -> None:
    """Print peaks and draw the picture."""
    found = {}
    for length in LENGTHS:
        found[length] = run(spalled(length), length), run(without_filter(spalled(length)), length)
    for length, runs in found.items():
        for name, one in zip(("filtered", "bare"), runs, strict=True):
            force = -one.force[one.t > SETTLED]
            hz, lines = spectrum(one)
            high = np.sqrt(0.5 * np.sum(lines[(hz > 5.0) & (hz < 20.0)] ** 2))
            print(
                f"{length * 1e3:g} mm, {name}: {force.min():.0f} to {force.max():.0f} N, rms {force.std():.1f} N, "
                f"5 to 20 kHz {high:.2f} N"
            )
    draw(found, sys.argv[1] if len(sys.argv) > 1 else "spalled_bearing.png")


if __name__ == "__main__":
    main()
