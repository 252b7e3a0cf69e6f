"""Numbers and the picture of ball bearings with heat in docs/notes/heat.md.

python docs/site/heat_bearing.py   # a minute
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from ehlcontact import Heat, Lubricant
from reduced_models import Atlas, BallBearing
from reduced_models.atlas.heat import RECIPE

IMAGES = Path(__file__).parents[1] / "images"
OIL = Lubricant.iso_vg(68, temperature=50.0)
BEARINGS = (("6205", 1000.0), ("6305", 2000.0))  # radial load, N
SPEEDS = np.array([1000.0, 2000.0, 3000.0, 4500.0, 6000.0, 8000.0, 10_000.0, 12_500.0, 15_000.0])
TABLE = (1000.0, 3000.0, 6000.0, 10_000.0, 15_000.0)
LOADS = ((1.0, np.inf), (0.2, 1.0))  # Q of the contacts whose elements are compared with answers
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


def carrying(bearing, load, rpm):
    """C [N s/m] of balls whose loads the atlas has, by elements and answers, at the frequency of the shaft."""
    state, hz, total = bearing.equilibrium((0.0, -load), speed_rpm=rpm), rpm / 60.0, np.zeros(2, complex)
    races = [bearing.race(name) for name in ("inner", "outer")]
    elements = [race.element(rpm) for race in races]
    for forces, angle in zip(state.force.tolist(), state.angles.tolist(), strict=True):
        if all(force > race.loads(rpm)[0] for force, race in zip(forces, races, strict=True)):
            own = [
                one.impedance(load=force, hz=hz).value.item() for one, force in zip(elements, forces, strict=True)
            ]
            found = [
                answered(race.point(force, rpm), hz, bearing.thermal)
                for race, force in zip(races, forces, strict=True)
            ]
            total += [np.sin(angle) ** 2 / sum(1.0 / Z for Z in of) for of in (own, found)]
    return total.imag / (2.0 * np.pi * hz)


def answered(point, hz, thermal):
    """Impedance of an answer of the atlas, N/m."""
    found = Atlas().at(point, thermal=thermal).impedance(hz=hz)
    return np.squeeze(found.value)[()]


def compare():
    """Elements beside the answers that they are made of."""
    for name, load in BEARINGS:
        for thermal, _, word in STYLES:
            bearing = BallBearing.catalogue(name, oil=OIL, thermal=thermal)
            for rpm in (3000.0, 10_000.0, 15_000.0):
                whole = bearing.coefficients((0.0, -load), speed_rpm=rpm, hz=rpm / 60.0).damping[0, 1, 1]
                own, found = carrying(bearing, load, rpm)
                print(f"{name}, {word}, {rpm:g}: C {whole:.4g}, of carrying balls {own:.4g}, answers {found:.4g}")
    hz, points = np.array([20.0, 200.0, 2000.0, 6000.0, 20_000.0]), RECIPE.sample(512, 5).values()
    strong, weak = ([one.point for one in points if low < heated(one.point) < high] for low, high in LOADS)
    for word, these in (("Q > 1", strong[:30]), ("Q < 1", weak[:20])):
        for thermal in (None, Heat()):
            elements = [Atlas().element(point, "memory", thermal=thermal).impedance(hz=hz) for point in these]
            off = (
                np.imag([one.value for one in elements])
                / np.imag([answered(point, hz, thermal) for point in these])
                - 1.0
            )
            rms, most = np.sqrt(np.mean(off**2, axis=0)), np.abs(off).max(axis=0)
            print(
                f"{word}, heat {thermal is not None}: rms {(100 * rms).round(1)}, largest {(100 * most).round(1)}"
            )


def heated(point):
    """Thermal load Q."""
    return Heat().at(point).load(point.moes, point.scales)


def main():
    """All of it."""
    compare()
    figure = Figure(figsize=(9.2, 3.4), layout="constrained")
    panels = figure.subplots(1, 3)
    names = (
        "central film of most loaded ball, µm",
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
