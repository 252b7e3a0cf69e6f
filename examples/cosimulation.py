"""The FMU of a contact in a co-simulation with fmpy: a mass on it, and what the step does to its damping.

    python examples/cosimulation.py [cosimulation.png]     # a few seconds

What one learns: how an FMU is made and driven (set, step, get); that a mass which holds a force half a step old
feeds the vibration that the contact damps; and that with a force of the middle of the step, which ours give by
default, it does not. More ways, and their limits: docs/coupling.md.
"""

import sys
import tempfile
from math import pi, sqrt
from pathlib import Path

import fmpy
import numpy as np

from ehlcontact import Lubricant, OperatingPoint
from fmu import export
from reduced_models import Atlas, FilmContact, simulate_oscillator
from reduced_models.rotor.decay import log_decrement

MASS, LOAD = 1.0, 486.0  # kg, N
DEFAULT, LATE = 1.5, 1.0  # values of lead


def contact() -> FilmContact:
    """The most loaded ball of a 6205 on its inner race, with the memory of its film; in N, m, s."""
    sizes = {"ball_diameter": 7.94e-3, "pitch_diameter": 39.04e-3, "conformity": 0.52}
    oil = Lubricant.iso_vg(68, temperature=50.0)
    return Atlas().element(OperatingPoint.ball_bearing(oil, **sizes, speed_rpm=3000, load=LOAD), "wide")


def co_simulate(path: Path, start: float, step: float, count: int, lead: float = DEFAULT) -> np.ndarray:
    """Approach [m] at the end of every step: the mass holds the force got after the one before."""
    description = fmpy.read_model_description(path)
    number = {v.name: v.valueReference for v in description.modelVariables}
    inputs, output = [number["approach"], number["rate"]], [number["force"]]
    with tempfile.TemporaryDirectory() as folder:
        unit = fmpy.instantiate_fmu(fmpy.extract(path, folder), description, fmi_type="CoSimulation")
        u, v, moved = start, 0.0, [start]
        unit.setReal(inputs, [u, v])
        unit.setReal([number["lead"]], [lead])
        unit.setupExperiment(startTime=0.0)
        unit.enterInitializationMode()
        unit.exitInitializationMode()
        (force,) = unit.getReal(output)
        for k in range(count):
            unit.setReal(inputs, [u, v])
            unit.doStep(k * step, step)
            a = (LOAD - force) / MASS
            u, v = u + step * (v + 0.5 * step * a), v + step * a
            (force,) = unit.getReal(output)
            moved.append(u)
        unit.terminate()
        unit.freeInstance()
    return np.array(moved)


def runs(parts: int, periods: float = 12.0) -> tuple[float, np.ndarray, dict[str, np.ndarray]]:
    """Frequency [rad/s], times [s] and approaches in both ways of the FMU, and of its element in Python."""
    element = contact()
    rest = element.approach_at(LOAD)
    omega, start = sqrt(element.spring_tangent(rest) / MASS), 0.98 * rest
    t = np.arange(round(periods * parts) + 1) * 2.0 * pi / omega / parts
    found = {"Python": simulate_oscillator(element, t, mass=MASS, load=LOAD, u0=start).approach}
    with tempfile.TemporaryDirectory() as folder:
        path = export(element, Path(folder) / "contact.fmu")
        for lead in (DEFAULT, LATE):
            found[f"FMU, lead {lead:g}"] = co_simulate(path, start, t[1], t.size - 1, lead)
    return omega, t, found


def main(picture: str = "cosimulation.png") -> None:
    """Print the decrements at a hundredth of the period, and draw the motion."""
    from matplotlib.figure import Figure

    omega, t, found = runs(100)
    axes = (figure := Figure(figsize=(9.0, 3.6), layout="constrained")).add_subplot()
    for (name, moved), look in zip(found.items(), ("k-", "c--", "r:"), strict=True):
        label = f"{name}: decrement {log_decrement(t, moved, omega=omega).decrement:.4f}"
        print(label)
        axes.plot(t * 1e3, moved * 1e6, look, label=label)
    axes.set(xlabel="time [ms]", ylabel="approach [µm]")
    axes.legend(frameon=False, loc="upper left")
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
