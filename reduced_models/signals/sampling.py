"""Signals at an output rate from the steps of a run."""

from __future__ import annotations

from fractions import Fraction
from math import pi
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, as_numbers, parts, require_choice, require_integer, require_positive
from ehlcontact.checks.kinds import NAME, Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from reduced_models.rotor.result import RotorResult
from reduced_models.signals.transfer_path import MeasuredPath, TransferPath

if TYPE_CHECKING:
    from reduced_models.bearing.ball_bearing import BallBearing

_Floats = NDArray[np.float64]

FINEST = 10_000  # largest denominator of a ratio of rates
STOP = ("kaiser", 8.0)  # window of the low-pass: 80 dB
REACH, PASSED = 32, 0.92  # samples on either side; its edge over half the rate: it stops at 1.0
LEAST_SAMPLES = 8  # per passage of a ball over a point of the inner race: its third harmonic, with room
AXES = ("x", "y", "z")
STENCIL = 5  # steps of a derivative of fourth order


@takes(dt="s", rate="Hz")
def sampled(values: ArrayLike, dt: float, rate: float) -> _Floats:
    """Values at steps of `dt`, sampled at a lower rate after a low-pass at half of it.

    By `scipy.signal.resample_poly` with a low-pass of linear phase, which passes up to 0.84 of half the rate and
    stops by 80 dB from half the rate on. Entry 0 is at the time of the first step.

    Parameters
    ----------
    values : array_like, shape (k,) or (k, columns)
        At the steps, along the first axis.
    dt, rate : float
        Step [s] and output rate [Hz].

    Raises
    ------
    InputError
        A rate above that of the steps, or one whose ratio to it is no fraction of numbers up to 10 000.
    """
    column, dt, rate = as_numbers("values", values), require_positive("dt", dt), require_positive("rate", rate)
    ratio = Fraction(rate * dt).limit_denominator(FINEST)
    if not np.isfinite(column).all():
        raise InputError("values", "nan or infinity", "finite numbers")
    if rate * dt > 1.0 + 1e-9:
        raise InputError("rate", rate, f"at most {1.0 / dt:.6g} Hz, that of the steps")
    if not ratio or abs(float(ratio) - rate * dt) > 1e-9 * rate * dt:
        raise InputError(
            "rate", rate, f"{1.0 / dt:.10g} Hz of the steps times a fraction of numbers up to {FINEST}"
        )
    up, down = ratio.numerator, ratio.denominator
    return resampled(column, up, down)


@takes(speed_rpm="rev/min", rate="Hz")
def require_sampling(bearing: BallBearing, speed_rpm: float, rate: float) -> None:
    """Make sure that an output rate resolves passages of balls over a defect.

    Raises
    ------
    InputError
        Fewer than 8 samples per passage over a point of the inner race.
    """
    fastest = bearing.frequencies(speed_rpm).bpfi
    if require_positive("rate", rate) < LEAST_SAMPLES * fastest:
        allowed = f"at least {LEAST_SAMPLES * fastest:.4g} Hz: {LEAST_SAMPLES} samples per ball passage"
        raise InputError("rate", rate, allowed)


@takes(run=Object(RotorResult, "a RotorResult"), node=NAME, rate=parts.RATE)
def node_acceleration(run: RotorResult, node: str, rate: float) -> _Floats:
    """Accelerations x, y of a node [m/s2] at an output rate, shape (samples, 2).

    From velocities at the steps, by differences of fourth order.

    Raises
    ------
    InputError
        As `sampled`; an unknown node, a run of fewer than 5 steps.
    """
    from scipy.signal import savgol_filter

    dt = _step(run)
    rates = run.node_velocity(node)
    return sampled(savgol_filter(rates, STENCIL, STENCIL - 1, deriv=1, delta=dt, axis=0), dt, rate)


@takes(
    run=Object(RotorResult, "a RotorResult"), path=Object(TransferPath, "a path, as ModalPath"), rate=parts.RATE
)
def housing_acceleration(
    run: RotorResult, path: TransferPath, rate: float, *, bearing: int = 0, axis: str = "y"
) -> _Floats:
    """Acceleration [m/s2] that a bearing's force gives to a housing, at an output rate.

    The rotor is simulated with a fixed housing; the path is at rest under the force at the start. The force is
    that of the inner ring on the bearing, in the bearing's own frame.

    Parameters
    ----------
    run : RotorResult
    path : TransferPath
        From the force on the outer ring to the sensor. It is applied at the steps of the run; a `MeasuredPath`
        at the output rate, to the force after the low-pass of `sampled`.
    rate : float
        Of the output [Hz].
    bearing : int
        Number of the bearing, from 0.
    axis : {"x", "y", "z"}

    Raises
    ------
    InputError
        As `sampled`; a bearing or an axis that is not in the run; an output rate above twice the frequencies of a
        `MeasuredPath`.
    """
    force, dt = run.ring_force, _step(run)
    require_choice("axis", axis, AXES[: min(force.shape[2], len(AXES))])
    last = force.shape[1] - 1
    if require_integer("bearing", bearing, f"a whole number from 0 to {last}", 0) > last:
        raise InputError("bearing", bearing, f"a whole number from 0 to {last}")
    pushed = force[:, bearing, AXES.index(axis)]
    if isinstance(path, MeasuredPath):  # not known beyond its highest frequency
        return path.acceleration(sampled(pushed, dt, rate), rate)
    return sampled(path.acceleration(pushed, 1.0 / dt), dt, rate)


@takes(t="s", speed_rpm=parts.SPEEDS._replace(most=10**9))
def shaft_angle(t: ArrayLike, speed_rpm: ArrayLike) -> _Floats:
    """Angle of the shaft [rad] at times [s], 0 at the first; speeds [rev/min] are straight between them.

    Raises
    ------
    InputError
        Times that do not increase; speeds that are neither one nor as many.
    """
    times, given = as_column("t", t, increasing=True), as_numbers("speed_rpm", speed_rpm)
    one = np.full(times.size, given) if given.ndim == 0 else given
    speed = as_column("speed_rpm", one, size=times.size) * pi / 30.0
    turned = 0.5 * (speed[1:] + speed[:-1]) * np.diff(times)
    return np.concatenate([[0.0], np.cumsum(turned)])


def resampled(values: _Floats, up: int, down: int) -> _Floats:
    """Values resampled by the factor up/down, after a low-pass at half the lower rate."""
    from scipy.signal import firwin, resample_poly

    coarser = max(up, down)
    low_pass = firwin(2 * REACH * coarser + 1, PASSED / coarser, window=STOP)
    return np.asarray(resample_poly(values, up, down, axis=0, window=low_pass, padtype="line"))


def _step(run: RotorResult) -> float:
    if run.t.size < STENCIL + 1:
        raise InputError("steps of the run", run.t.size - 1, f"at least {STENCIL}")
    return float((run.t[-1] - run.t[0]) / (run.t.size - 1))
