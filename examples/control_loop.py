"""A disc on a ball bearing, films and all, in a control loop: an active damper beside the little that oil damps.

Run ``python examples/control_loop.py``: half a minute. It prints the first mode with and without the damper and
draws `control_loop.png` beside it: Bode plots of the disc, and the disc after a blow.

A 6205 in oil carries a journal of 1 kg; a stiff shaft leads to a disc of 20 kg, where an actuator pushes and a
probe measures. `rotor_to_control` has rotor, balls and films as one nonlinear system of python-control, and
`linearise(...).to_control()` the same about rest, exactly: no differences, the films' memory as states.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import control
import numpy as np

from ehlcontact import Lubricant
from reduced_models import BallBearing, BearingMount, MatrixRotor, linearise, rotor_to_control

RPM = 3000.0
JOURNAL, DISC = 1.0, 20.0  # kg
SHAFT = 4e8  # N/m between them
PUSH, PROBE = {"Fx": 2, "Fy": 3}, {"x": 2, "y": 3}  # degrees of freedom of the disc, by name
RING = {"x_ring": 0, "y_ring": 1}
DAMPER = 4e3  # N s/m, of the controller
SLOW = 2.0 * np.pi * 3e3  # rad/s, up to which it follows
BLOW, SHORT = 20.0, 5e-4  # N, s


def bearing() -> BallBearing:
    """Bearing and oil."""
    return BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))


def rotor(held: BallBearing) -> MatrixRotor:
    """Degrees of freedom x, y of the journal, then of the disc."""
    masses = np.array([JOURNAL, DISC])
    spring = SHAFT * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return MatrixRotor(
        mass=np.kron(np.diag(masses), np.eye(2)),
        stiffness=np.kron(spring, np.eye(2)),
        load=np.kron(masses, [0.0, -9.81]),
        mounts=(BearingMount(bearing=held, x=0, y=1),),
    )


def linear(line: MatrixRotor) -> Any:
    """About rest, balls standing still: an exact ``StateSpace``, from forces on the disc to both places."""
    return linearise(line, RPM, passage=False).to_control(PUSH, PROBE | RING, name="rotor")


def nonlinear(line: MatrixRotor, cage_turns: bool = False) -> Any:
    """The same with all that is not linear in it, balls going round if wanted."""
    return rotor_to_control(line, RPM, inputs=PUSH, outputs=PROBE | RING, cage_turns=cage_turns)


def damper(strength: float = DAMPER) -> Any:
    """Controller: forces on the disc against its velocity, from the places that are measured."""
    one = control.ss([[-SLOW]], [[1.0]], [[-strength * SLOW * SLOW]], [[strength * SLOW]])
    nothing = control.ss([], [], [], np.zeros((2, 2)))
    return control.append(one, one, nothing)[:2, :]


def looped(plant: Any, strength: float = DAMPER) -> Any:
    """The plant with the damper; its inputs are what pushes beside that."""
    return control.feedback(plant, damper(strength))


def first_mode(system: Any) -> tuple[float, float]:
    """Frequency [Hz] and logarithmic decrement of the slowest vibration of a linear system."""
    poles = system.poles()
    poles = poles[(poles.imag > 1.0) & (-poles.real < poles.imag)]  # of those that swing at all
    slowest = poles[np.argmin(poles.imag)]
    return float(slowest.imag / (2.0 * np.pi)), float(-2.0 * np.pi * slowest.real / slowest.imag)


def blown(system: Any, slopes: Any, t: np.ndarray) -> np.ndarray:
    """The disc, shape (2, k) [m], after a blow upwards.

    Films are stiff, which takes an implicit solver; it has its Jacobian from the linear system `slopes`, for one
    by differences would cost as much as hundreds of its steps.
    """
    push = np.array([np.zeros(t.size), np.where(t < SHORT, BLOW, 0.0)])
    options = {"max_step": 0.5 * SHORT, "jac": slopes.A}  # or a solver steps over the blow
    seen = control.input_output_response(system, t, push, solve_ivp_method="BDF", solve_ivp_kwargs=options)
    return np.asarray(seen.outputs)[:2]


def picture(path: Path, plant: Any, line: MatrixRotor, t: np.ndarray) -> Any:
    """Bode plot of the disc up and down, and its motion after the blow, without the damper and with it."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 3.8), layout="constrained")
    bode, after = figure.subplots(1, 2)
    omega = 2.0 * np.pi * np.geomspace(20.0, 5000.0, 600)
    for system, moving, colour, name in (
        (plant, nonlinear(line), "#d55e00", "bearing alone"),
        (looped(plant), looped(nonlinear(line)), "#0072b2", "with the damper"),
    ):
        gain = np.abs(control.frequency_response(system, omega).frdata[1, 1])
        bode.loglog(omega / (2.0 * np.pi), gain * 1e9, color=colour, label=name)
        after.plot(t * 1e3, blown(moving, system, t)[1] * 1e9, color=colour, label=name)
    bode.set(title="disc over force, along the load", xlabel="frequency [Hz]", ylabel="[nm/N]")
    after.set(title=f"after a blow of {BLOW:g} N", xlabel="time [ms]", ylabel="displacement [nm]")
    bode.legend(frameon=False)
    figure.savefig(path, dpi=110)
    return figure


def main() -> None:
    """Print and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path())
    arguments = parser.parse_args()
    line = rotor(bearing())
    plant = linear(line)
    for name, system in (("bearing alone", plant), ("with the damper", looped(plant))):
        hz, decrement = first_mode(system)
        print(f"{name:>15}: first mode {hz:.1f} Hz, decrement {decrement:.4f}")
    arguments.out.mkdir(parents=True, exist_ok=True)
    picture(arguments.out / "control_loop.png", plant, line, np.linspace(0.0, 0.04, 801))


if __name__ == "__main__":
    main()
