"""A motor with uncertain inputs, for tests that sample it."""

from ehlcontact import Lubricant
from reduced_models import (
    BallBearing,
    Disc,
    Shaft,
    Support,
    grade_unbalance,
    machine_state,
    rotor_on_bearings,
    spread,
)

RPM, CORE = 15_000.0, 8.0  # rev/min; kg
INPUTS = {
    "clearance": spread(uniform=(5e-6, 20e-6)),
    "temperature": spread(normal=(80.0, 5.0), within=(65.0, 95.0)),
    "grade": spread(triangular=(1.0, 2.5, 6.3)),
    "preload": spread(normal=(200.0, 15.0)),
    "loss_factor": spread(uniform=(0.001, 0.01)),
}


def motor(clearance, temperature, grade, preload, loss_factor):
    """State of the motor of the examples, of six speeds."""
    oil = Lubricant.iso_vg(32, temperature=temperature)
    both = {"clearance": clearance, "oil": oil, "rq_race": 1e-7, "loss_factor": loss_factor}
    left, right = (BallBearing.catalogue(name, **both) for name in ("6306", "6206"))
    unbalance = grade_unbalance(grade, CORE, RPM)
    core = Disc.cylinder(position=0.18, diameter=0.11, width=0.12, bore=0.035, unbalance=unbalance)
    supports = [
        Support(position=0.03, bearing=left, facing="-z"),
        Support(position=0.33, bearing=right, facing="+z", preload=preload),
    ]
    rotor = rotor_on_bearings(Shaft(length=0.36, diameter=0.035), discs=[core], supports=supports)
    return machine_state(rotor, RPM, fine=False)
