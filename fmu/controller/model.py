"""`SpeedController`: proportional-integral control of the speed of a shaft; variables of its FMU."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import as_column, require_finite, require_nonnegative, require_positive
from ehlcontact.errors import InputError
from fmu.c_headers import c_double
from fmu.contact_spec import checked_name
from fmu.contact_variables import ALLOWED_ERROR
from fmu.lead import CONTACT
from fmu.spec import ModelSpec, VariableList
from reduced_models.bearing.kinematics import RPM_TO_RAD_S

_Floats = NDArray[np.float64]

STEP = 1e-5  # s, of the default experiment: that of a drive
LEAD = 1.0  # inputs are held in a step, whose end the torque is for
LEAD_TEXT = (
    "Time from the inputs of a communication step to that for which the torque is given, in steps: 1 = inputs of"
    " its start, 0 = inputs of its end"
)
UNITS = {"proportional_gain": "N.m.s/rad", "integral_gain": "N.m/rad", "torque_limit": "N.m"}
ABOUT = {
    "proportional_gain": "Torque over the difference of set point and speed",
    "integral_gain": "Rate of the torque over that difference",
    "torque_limit": "Largest torque, either way",
}


@dataclass(frozen=True)
class SpeedController:
    """Proportional-integral controller of the speed of a shaft, with a limit of its torque.

    With e the set point less the speed, the torque is the sum of `proportional_gain` e and the integral of
    `integral_gain` e, at most `torque_limit` either way. At the limit the integral goes on only as far as the sum
    stays at the limit, or comes back (anti-windup).

    Parameters
    ----------
    speed_rpm : float
        Set point at the start [rev/min].
    proportional_gain : float
        [N m s/rad], >= 0.
    integral_gain : float
        [N m/rad], >= 0.
    torque_limit : float
        [N m], > 0.

    Raises
    ------
    InputError
        A value outside its range; or both gains zero.
    """

    speed_rpm: float
    proportional_gain: float
    integral_gain: float
    torque_limit: float

    def __post_init__(self) -> None:
        require_finite("speed_rpm", self.speed_rpm)
        for name in ("proportional_gain", "integral_gain"):
            require_nonnegative(name, getattr(self, name))
        if not self.proportional_gain + self.integral_gain > 0.0:
            raise InputError("proportional_gain", 0.0, "> 0, or integral_gain > 0")
        require_positive("torque_limit", self.torque_limit)

    def torque(self, t: Any, speed: Any, set_point: Any = None, *, start: float = 0.0) -> _Floats:
        """Torque over time [N m], shape (k,), speed and set point straight between the given times.

        Parameters
        ----------
        t : array_like, shape (k,)
            Increasing [s].
        speed : array_like, shape (k,)
            Of the shaft [rad/s].
        set_point : array_like, shape (k,), optional
            [rad/s]; by default `speed_rpm`, constant.
        start : float
            Integral part at the first time [N m].
        """
        t = as_column("t", t, least=1, increasing=True)
        wanted = np.full(t.size, self.speed_rpm * RPM_TO_RAD_S) if set_point is None else set_point
        e = as_column("set_point", wanted, size=t.size) - as_column("speed", speed, size=t.size)
        limit, summed = self.torque_limit, float(start)
        found = np.clip(self.proportional_gain * e + summed, -limit, limit)
        for k in range(1, t.size):
            proportional = self.proportional_gain * e[k]
            further = summed + self.integral_gain * (t[k] - t[k - 1]) * 0.5 * (e[k - 1] + e[k])
            found[k] = np.clip(proportional + further, -limit, limit)
            if found[k] != proportional + further:
                further = np.clip(found[k] - proportional, *sorted((summed, further)))
            summed = further
        return found


def controller_spec(
    controller: SpeedController, model_name: str | None = None, lead: float | None = None
) -> ModelSpec:
    """Specification of a controller's FMU.

    Raises
    ------
    InputError
        A name that is empty, too long or not printable, or another lead.
    """
    made = VariableList()
    start, kind = controller.speed_rpm * RPM_TO_RAD_S, replace(CONTACT, text=LEAD_TEXT)
    for name, text in (("speed_set_point", "Wanted speed of the shaft"), ("speed", "Speed of the shaft")):
        made.add(name, "input", "continuous", text, unit="rad/s", start=start, nominal=100.0)
    made.add("torque", "output", "continuous", "Torque of the motor on the shaft", unit="N.m", nominal=1.0)
    made.lead(kind, LEAD if lead is None else lead)
    for name, text in ABOUT.items():
        made.add(
            name, "parameter", "tunable", text,
            unit=UNITS[name], start=float(getattr(controller, name)), minimum=0.0,
        )  # fmt: skip
    made.add("integral_start", "parameter", "fixed", "Integral part at the start", unit="N.m", start=0.0)
    return ModelSpec(
        name=checked_name("SpeedController" if model_name is None else model_name),
        description="Speed controller, proportional and integral, with a limit of its torque; SI units",
        sources=("core.c", "core_step.c", "model_controller.c"),
        headers=("core.h", "model.h"),
        variables=tuple(made.variables),
        notes=(("Controller", "proportional and integral; at the limit of the torque the integral is held"),),
        macros={"N_CACHE": "3", "DEFAULT_TOLERANCE": c_double(ALLOWED_ERROR)} | dict(kind.macros),
        step=STEP,
        exchange=False,
        indicators=(),
        flanges=(),
    )
