"""Transfer paths: acceleration of a housing by a force on it, over frequency (accelerance, ISO 7626-1).

A path has a response A(f) in (m/s2)/N: `ModalPath` from modes, `MeasuredPath` from a measured accelerance,
`SystemPath` from a system of python-control. Acceleration is computed in the frequency domain. After the record
the force returns to its first value along half a cosine, so that the response decays and does not wrap around.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import ceil, log, pi
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, as_numbers, parts, require_positive, shown
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import InputError
from ehlcontact.summary import Summary, counted, span

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

FADED = 1e-6  # of an impulse response, beyond which it is left out
LONGEST = 60.0  # s, of the decay of a path: longer ones are a wrong unit
ROUNDED = 1.0 + 1e-9  # of a frequency over the highest measured one
IMAGINARY = 1e-9  # of a pole over its distance from 0: one nearer to the axis does not decay


class TransferPath(Summary, ABC):
    """Response of a structure: acceleration at a sensor over a force."""

    @abstractmethod
    @takes(hz=parts.ANY)
    def response(self, hz: ArrayLike) -> _Complex:
        """Acceleration over force [(m/s2)/N] at these frequencies [Hz], of their shape."""

    @property
    @abstractmethod
    def decay_time(self) -> float:
        """Time [s] in which an impulse response fades to 1e-6."""

    def acceleration(self, force: ArrayLike, rate: float) -> _Floats:
        """Acceleration [m/s2] by a force [N], shape (k,), sampled at `rate` [Hz].

        The path is at rest under the first value of the force.

        Raises
        ------
        InputError
            A force that is no column of numbers, a rate that is not positive.
        """
        column, rate = as_column("force", force, least=2), require_positive("rate", rate)
        fade = ceil(self.decay_time * rate)
        size = column.size + 2 * fade
        spectrum = np.fft.rfft(_faded_out(column - column[0], fade), size)
        moved = np.fft.irfft(spectrum * self.response(np.fft.rfftfreq(size, 1.0 / rate)), size)
        return np.asarray(moved[: column.size])


def _faded_out(values: _Floats, fade: int) -> _Floats:
    """The column, then half a cosine of `fade` samples from its last value to 0: a step back would ring longer."""
    return np.concatenate([values, values[-1] * 0.5 * (1.0 + np.cos(np.pi * (np.arange(fade) + 1.0) / fade))])


@fields_take(hz=parts.NATURAL, mass=parts.MODAL_MASS)
@dataclass(frozen=True, eq=False)
class ModalPath(TransferPath):
    """Modes of a grounded structure: ``A(f) = sum of -w^2/(m (w0^2 - w^2 + 2i zeta w0 w))``, ``w = 2 pi f``.

    Parameters
    ----------
    hz : float or array_like, shape (modes,)
        Natural frequencies [Hz].
    damping : float or array_like, shape (modes,)
        Damping ratios zeta, between 0 and 1 (0.05 for 5 %).
    mass : float or array_like, shape (modes,)
        Modal masses [kg]; a negative one has its sensor on the other side of a node.

    Raises
    ------
    InputError
        Columns of different lengths; a frequency or a damping ratio that is not positive: its poles would not lie
        left of the imaginary axis; a damping ratio of 1 or more; a mass that is 0; a decay of more than 60 s.
    """

    hz: ArrayLike
    damping: ArrayLike
    mass: ArrayLike

    def __post_init__(self) -> None:
        for name in ("hz", "damping", "mass"):
            column = np.atleast_1d(as_numbers(name, getattr(self, name)))
            object.__setattr__(self, name, as_column(name, column, least=1))
        hz, damping, mass = self._columns
        for name, column in (("damping", damping), ("mass", mass)):
            if column.size != hz.size:
                raise InputError(name, column.tolist(), f"{hz.size} numbers, as many as hz")
        if not (damping > 0.0).all():
            raise InputError("damping", damping.tolist(), "> 0: poles left of the imaginary axis")
        if not (damping < 1.0).all():
            raise InputError("damping", damping.tolist(), "below 1, ratios to critical damping (in per cent?)")
        if not mass.all() or (mass < 0.0).all():
            raise InputError("mass", mass.tolist(), "not 0, and of one mode at least > 0")
        _require_decay("damping", damping.tolist(), self.decay_time)

    def _summary_lines(self) -> list[str]:
        hz, damping, mass = self._columns
        modes = f"{hz.size} mode{'s' * (hz.size > 1)}"
        return [f"{modes} at {span(hz, 1.0, 'Hz')}, damping {span(damping)}, mass {span(mass, 1.0, 'kg')}"]

    @property
    def _columns(self) -> tuple[_Floats, _Floats, _Floats]:
        return np.asarray(self.hz), np.asarray(self.damping), np.asarray(self.mass)

    @property
    def decay_time(self) -> float:
        """Time [s] in which the slowest mode fades to 1e-6."""
        hz, damping, _ = self._columns
        return float((-log(FADED) / (2.0 * pi * hz * damping)).max())

    @takes(hz=parts.ANY)
    def response(self, hz: ArrayLike) -> _Complex:
        """Acceleration over force [(m/s2)/N] at these frequencies [Hz], of their shape."""
        at = 2.0 * pi * np.asarray(hz, float)[..., None]
        natural, damping, mass = self._columns
        w0 = 2.0 * pi * natural
        return np.asarray((-(at**2) / (mass * (w0**2 - at**2 + 2j * damping * w0 * at))).sum(axis=-1))


@fields_take(hz=parts.RATE._replace(zero=True))
@dataclass(frozen=True, eq=False)
class MeasuredPath(TransferPath):
    """Measured response, linear between its frequencies in real and imaginary part; 0 below the first.

    Parameters
    ----------
    hz : array_like, shape (k,), k >= 2
        Increasing, from 0 on [Hz].
    accelerance : array_like of complex, shape (k,)
        Acceleration over force [(m/s2)/N].

    Raises
    ------
    InputError
        Frequencies that do not increase, another number of responses, what is not finite.
    """

    hz: ArrayLike
    accelerance: ArrayLike

    def __post_init__(self) -> None:
        hz = as_column("hz", self.hz, least=2, increasing=True)
        values = np.asarray(self.accelerance)
        if values.shape != hz.shape or values.dtype.kind not in "fciu" or not np.isfinite(values).all():
            raise InputError(
                "accelerance", f"shape {values.shape}", f"{hz.size} finite complex numbers, as many as hz"
            )
        if hz[0] < 0.0:
            raise InputError("hz[0]", hz[0], ">= 0")
        object.__setattr__(self, "hz", hz)
        object.__setattr__(self, "accelerance", values.astype(complex))
        _require_decay("hz", hz.tolist(), self.decay_time)

    def _summary_lines(self) -> list[str]:
        largest = np.abs(np.asarray(self.accelerance)).max()
        hz = np.asarray(self.hz)
        return [
            f"{counted(hz.size, 'frequency', 'frequencies')} {span(hz, 1.0, 'Hz')}, "
            f"accelerance up to {largest:.4g} (m/s2)/N"
        ]

    @property
    def decay_time(self) -> float:
        """Time [s] that the frequencies resolve: one over their smallest distance."""
        return float(1.0 / np.diff(np.asarray(self.hz)).min())

    def acceleration(self, force: ArrayLike, rate: float) -> _Floats:
        """Acceleration [m/s2] by a force [N], shape (k,), sampled at `rate` [Hz], as of every path.

        Raises
        ------
        InputError
            As of every path; a rate above twice the measured frequencies.
        """
        rate, most = require_positive("rate", rate), 2.0 * float(np.asarray(self.hz)[-1])
        if rate > most * ROUNDED:
            raise InputError("rate", rate, f"at most {most:g} Hz, twice the measured frequencies")
        return super().acceleration(force, rate)

    @takes(hz=parts.ANY)
    def response(self, hz: ArrayLike) -> _Complex:
        """Acceleration over force [(m/s2)/N] at these frequencies [Hz], of their shape."""
        known, found, at = np.asarray(self.hz), np.asarray(self.accelerance), np.asarray(hz, float)
        if at.size and at.max() > known[-1] * ROUNDED:
            raise InputError("hz", float(at.max()), f"at most {known[-1]:g} Hz, as measured")
        real, imaginary = (np.interp(at, known, part, left=0.0) for part in (found.real, found.imag))
        return np.asarray(real + 1j * imaginary)


@dataclass(frozen=True, eq=False)
class SystemPath(TransferPath):
    """A system of python-control from a force [N] to an acceleration [m/s2].

    Parameters
    ----------
    system : control.LTI
        Of one input and one output, in continuous time; as ``control.tf`` and ``control.ss`` make it.

    Raises
    ------
    InputError
        No such system, or one with a pole that is not left of the imaginary axis.
    """

    system: Any

    def __post_init__(self) -> None:
        from control import LTI

        if not isinstance(self.system, LTI) or not self.system.issiso() or not self.system.isctime():
            allowed = "a system of python-control in continuous time, one input and one output"
            raise InputError("system", shown(self.system), allowed)
        poles = np.asarray(self.system.poles())
        wrong = poles[poles.real >= -IMAGINARY * np.abs(poles)]
        if wrong.size:
            raise InputError(
                "system", f"a pole at {wrong[0]:.4g}", "one whose poles lie left of the imaginary axis"
            )
        _require_decay("system", "given", self.decay_time)

    def _summary_lines(self) -> list[str]:
        return [f"{len(self.system.poles())} poles, fades in {self.decay_time:.4g} s"]

    @property
    def decay_time(self) -> float:
        """Time [s] in which the slowest pole fades to 1e-6."""
        slowest = -np.asarray(self.system.poles()).real.max(initial=-np.inf)
        return float(-log(FADED) / slowest)

    @takes(hz=parts.ANY)
    def response(self, hz: ArrayLike) -> _Complex:
        """Acceleration over force [(m/s2)/N] at these frequencies [Hz], of their shape."""
        return np.asarray(self.system(2j * pi * np.asarray(hz, float)))


def _require_decay(field: str, value: Any, seconds: float) -> None:
    if seconds > LONGEST:
        raise InputError(field, value, f"such that the path fades within {LONGEST:g} s, not {seconds:.3g} s")
