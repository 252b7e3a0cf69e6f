"""A disc on a ball bearing, films and all, in a control loop: an active damper beside the little that oil damps.

    python examples/control_loop.py [control_loop.png]     # half a minute

A 6205 carries a journal of 1 kg; a stiff shaft leads to a disc of 20 kg, where an actuator pushes and a probe
measures. What one learns: `rotor_to_control` has rotor, balls and films as one nonlinear system of python-control,
`linearise(...).to_control()` the same about rest, exactly, the films' memory as states.
"""

import sys
from typing import Any

import control
import numpy as np

from ehlcontact import Lubricant
from reduced_models import BallBearing, BearingMount, Rotor, linearise, rotor_to_control

RPM, SHAFT = 3000.0, 4e8  # rev/min; N/m between journal and disc
JOURNAL, DISC = 1.0, 20.0  # kg
PUSH, PROBE = {"Fx": 2, "Fy": 3}, {"x": 2, "y": 3, "x_ring": 0, "y_ring": 1}  # degrees of freedom, by name
DAMPER, SLOW = 4e3, 2.0 * np.pi * 3e3  # N s/m of the controller; rad/s, up to which it follows
BLOW, SHORT = 20.0, 5e-4  # N, s


def rotor() -> Rotor:
    """Degrees of freedom x, y of the journal, then of the disc."""
    held = BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))
    masses, spring = np.array([JOURNAL, DISC]), SHAFT * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return Rotor(
        mass=np.kron(np.diag(masses), np.eye(2)),
        stiffness=np.kron(spring, np.eye(2)),
        load=np.kron(masses, [0.0, -9.81]),
        mounts=(BearingMount(bearing=held, x=0, y=1),),
    )


def linear(line: Rotor) -> Any:
    """About rest, balls standing still: an exact ``StateSpace``, from forces on the disc to both places."""
    return linearise(line, RPM, passage=False).to_control(PUSH, PROBE, name="rotor", tolerance=0.0)


def nonlinear(line: Rotor) -> Any:
    """The same with all that is not linear in it."""
    return rotor_to_control(line, RPM, inputs=PUSH, outputs=PROBE, cage_turns=False)


def damped(plant: Any) -> Any:
    """The plant, with forces on the disc against its velocity made from the places that are measured."""
    one = control.ss([[-SLOW]], [[1.0]], [[-DAMPER * SLOW * SLOW]], [[DAMPER * SLOW]])
    nothing = control.ss([], [], [], np.zeros((2, 2)))  # of the ring's places
    return control.feedback(plant, control.append(one, one, nothing)[:2, :])


def first_mode(system: Any) -> tuple[float, float]:
    """Frequency [Hz] and logarithmic decrement of the slowest vibration of a linear system."""
    poles = system.poles()
    poles = poles[(poles.imag > 1.0) & (-poles.real < poles.imag)]  # of those that vibrate at all
    slowest = poles[np.argmin(poles.imag)]
    return float(slowest.imag / (2.0 * np.pi)), float(-2.0 * np.pi * slowest.real / slowest.imag)


def blown(system: Any, slopes: Any, t: np.ndarray) -> np.ndarray:
    """The disc, shape (2, k) [m], after a blow upwards; `slopes`, linear, is the Jacobian, for films are stiff."""
    push = np.array([np.zeros(t.size), np.where(t < SHORT, BLOW, 0.0)])
    options = {"max_step": 0.5 * SHORT, "jac": slopes.A}  # or a solver steps over the blow
    seen = control.input_output_response(system, t, push, solve_ivp_method="BDF", solve_ivp_kwargs=options)
    return np.asarray(seen.outputs)[:2]


def main(picture: str = "control_loop.png", until: float = 0.02) -> None:
    """Print the first mode without the damper and with it, and draw Bode plot and blow."""
    from matplotlib.figure import Figure

    line = rotor()
    plant, moving = linear(line), nonlinear(line)
    bode, after = (figure := Figure(figsize=(9.0, 3.6), layout="constrained")).subplots(1, 2)
    hz, t = np.geomspace(20.0, 5000.0, 600), np.linspace(0.0, until, 401)
    for name, exact, whole in (("alone", plant, moving), ("damped", damped(plant), damped(moving))):
        print("{:>7}: first mode {:.1f} Hz, decrement {:.4f}".format(name, *first_mode(exact)))
        gain = np.abs(control.frequency_response(exact, 2.0 * np.pi * hz).frdata[1, 1])
        bode.loglog(hz, gain * 1e9, label=name)
        after.plot(t * 1e3, blown(whole, exact, t)[1] * 1e9)
    bode.set(title="disc over force, along the load", xlabel="frequency [Hz]", ylabel="[nm/N]")
    after.set(title=f"after a blow of {BLOW:g} N", xlabel="time [ms]", ylabel="displacement [nm]")
    bode.legend(frameon=False)
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
