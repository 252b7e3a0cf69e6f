"""Envelope spectrum of a signal, and order spectrum over the shaft angle."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import ceil, pi
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, require_finite, require_integer, require_positive, shown
from ehlcontact.checks.kinds import NAME
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.quantities import ACCELERATION, HERTZ, NUMBER
from ehlcontact.results.drawing import draw
from ehlcontact.results.picture import Line as Curve
from ehlcontact.results.picture import Mark, Panel, Picture
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.summary import span
from reduced_models.signals.sampling import resampled

_Floats = NDArray[np.float64]

FILTER_ORDER = 4  # of the band-pass, forwards and backwards
FEWEST = 64  # samples of a signal
NARROWEST = 2.0  # lines of the record that a band has at least
FINER = 4  # factor of upsampling before interpolation at angles
OF_SIGNAL = "amplitude", "mean"  # quantities in the unit of the signal
HIGHEST_SHOWN, SHOWN_MULTIPLES = 1000.0, 3.5  # Hz, of a picture; of a mark, that it shows at least
MOST_SAMPLES = 2**26  # of a signal over the angle: 0.5 GB


class Line(NamedTuple):
    """Place and amplitude of the highest value within a range."""

    at: float
    amplitude: float


class _Lines(QuantityTable):
    """Amplitudes over frequencies or orders."""

    __slots__ = ()
    unit: str

    def line(self, at: float, within: float) -> Line:
        """The highest line at `at` +- `within`.

        Raises
        ------
        InputError
            The spectrum has no value there.
        """
        places, amplitude = self._spectrum()
        near = np.abs(places - require_finite("at", at)) <= require_positive("within", within)
        if not near.any():
            raise InputError(
                "at", at, f"from {places[0]:.4g} to {places[-1]:.4g}, with a value within {within:.4g}"
            )
        highest = np.flatnonzero(near)[amplitude[near].argmax()]
        return Line(float(places[highest]), float(amplitude[highest]))

    def _spectrum(self) -> tuple[_Floats, _Floats]:
        raise NotImplementedError

    def _unit(self, name: str) -> str:
        return self.unit if name in OF_SIGNAL else super()._unit(name)


@dataclass(frozen=True, eq=False)
class EnvelopeSpectrum(_Lines):
    """Amplitudes of the envelope of a signal.

    Attributes
    ----------
    hz : ndarray, shape (k,)
        Frequencies [Hz], from 0.
    amplitude : ndarray, shape (k,)
        Of the envelope, in the unit of the signal; entry 0 is 0: the mean is taken off.
    mean : float
        Of the envelope.
    unit : str
        Of the signal.
    """

    hz: Annotated[_Floats, HERTZ.over("hz")]
    amplitude: Annotated[_Floats, NUMBER.over("hz")]
    mean: Annotated[float, NUMBER]
    unit: str = ACCELERATION.unit

    DISPLAY: ClassVar[Display] = Display(rows="hz", panels=("amplitude",))

    def picture(self, marks: Mapping[str, float] | None = None, highest: float = HIGHEST_SHOWN) -> Picture:
        """Amplitudes over frequency, with marks at frequencies and their multiples.

        Parameters
        ----------
        marks : mapping of str to float, optional
            Frequencies [Hz] by name, as ``{"BPFO": bearing.frequencies(1800.0).bpfo}``.
        highest : float
            End of the axis [Hz]; it is further where that leaves less than three multiples of a mark.

        Raises
        ------
        InputError
            Marks without names; a frequency that is not positive.
        """
        if marks is not None and not isinstance(marks, Mapping):
            raise InputError("marks", shown(marks), 'frequencies [Hz] by name, as {"BPFO": 153.0}')
        given = {name: require_positive(name, hz) for name, hz in (marks or {}).items()}
        end = shown_to(list(given.values()), require_positive("highest", highest), float(self.hz[-1]))
        lines = [mark for name, hz in given.items() for mark in multiples(name, hz, end)]
        inside = self.hz <= end
        panel = Panel(
            [Curve(self.hz[inside], self.amplitude[inside])],
            self._axis("hz"),
            ("amplitude of the envelope", self.unit),
            x_ends=(0.0, end),
            marks=lines,
        )
        return Picture([panel], self._title())

    def plot(
        self,
        path: str | os.PathLike[str] | None = None,
        marks: Mapping[str, float] | None = None,
        highest: float = HIGHEST_SHOWN,
    ) -> Any:
        """Matplotlib figure of `picture`, into a file too where a path is given.

        Raises
        ------
        InputError
            As `picture`; the file cannot be written.
        """
        return draw(self.picture(marks, highest), path)

    def _spectrum(self) -> tuple[_Floats, _Floats]:
        return self.hz, self.amplitude

    def _summary_lines(self) -> list[str]:
        highest = self.hz[self.amplitude.argmax()]
        return [
            f"{self.hz.size} lines {span(self.hz, 1.0, 'Hz')}",
            f"highest {self.amplitude.max():.4g} {self.unit} at {highest:.5g} Hz,"
            f" mean of the envelope {self.mean:.4g} {self.unit}",
        ]


@dataclass(frozen=True, eq=False)
class OrderSpectrum(_Lines):
    """Amplitudes of a signal over orders, multiples of the turning shaft.

    Attributes
    ----------
    order : ndarray, shape (k,)
        Per turn of the shaft, from 0.
    amplitude : ndarray, shape (k,)
        Root of the mean square over blocks of the signal, in its unit.
    unit : str
        Of the signal.
    """

    order: Annotated[_Floats, NUMBER.over("order")]
    amplitude: Annotated[_Floats, NUMBER.over("order")]
    unit: str = ACCELERATION.unit

    DISPLAY: ClassVar[Display] = Display(rows="order", panels=("amplitude",))

    def _spectrum(self) -> tuple[_Floats, _Floats]:
        return self.order, self.amplitude

    def _summary_lines(self) -> list[str]:
        highest = self.order[self.amplitude.argmax()]
        return [
            f"{self.order.size} lines of orders {span(self.order)}",
            f"highest {self.amplitude.max():.4g} {self.unit} at order {highest:.5g}",
        ]


def shown_to(marks: Sequence[float], highest: float, last: float) -> float:
    """End of the axis of a spectrum up to `last` [Hz]: `highest`, or as far as each mark has three multiples."""
    return min(max([highest, *(SHOWN_MULTIPLES * hz for hz in marks)]), last)


def multiples(name: str, hz: float, end: float) -> list[Mark]:
    """Marks at a frequency, with its name, and at its multiples up to `end` [Hz]."""
    return [Mark(k * hz, f"{k}x" if k > 1 else name) for k in range(1, int(end / hz) + 1)]


@takes(rate="Hz", unit=NAME)
def envelope_spectrum(
    signal: ArrayLike, rate: float, band: tuple[float, float], *, unit: str = ACCELERATION.unit
) -> EnvelopeSpectrum:
    """Amplitude spectrum of the envelope of a signal within a band, over the whole record with a Hann window.

    Band-pass of Butterworth, fourth order, forwards and backwards; the envelope is the magnitude of the analytic
    signal (Hilbert).

    Parameters
    ----------
    signal : array_like, shape (k,)
    rate : float
        Of its samples [Hz].
    band : (float, float)
        Hz.
    unit : str
        Of the signal, for axes and tables.

    Raises
    ------
    InputError
        Fewer than 64 samples; a band that does not rise, does not lie between the resolution of the record (one
        over its length) and half the rate, or is narrower than two lines of it.
    """
    from scipy.signal import butter, hilbert, sosfiltfilt

    column, rate = as_column("signal", signal, least=FEWEST), require_positive("rate", rate)
    low, high = _band(band, 0.5 * rate, rate / column.size)
    passed = sosfiltfilt(butter(FILTER_ORDER, (low, high), "bandpass", fs=rate, output="sos"), column)
    envelope = np.abs(hilbert(passed))
    mean = float(envelope.mean())
    window = np.hanning(column.size)
    amplitude = 2.0 * np.abs(np.fft.rfft(window * (envelope - mean))) / window.sum()
    amplitude[0] = 0.0
    return EnvelopeSpectrum(np.asarray(np.fft.rfftfreq(column.size, 1.0 / rate)), amplitude, mean, unit)


def _band(band: tuple[float, float], highest: float, line: float) -> tuple[float, float]:
    low, high = as_column("band", band, size=2).tolist()
    if not 0.0 < low < high < highest:
        raise InputError(
            "band", [low, high], f"two rising frequencies, above 0 and below {highest:g} Hz, half the rate"
        )
    if low < line or high - low < NARROWEST * line:
        allowed = f"from {line:.4g} Hz, which the record resolves, and {NARROWEST * line:.4g} Hz wide at least"
        raise InputError("band", [low, high], allowed)
    return low, high


@takes(rate="Hz", unit=NAME)
def order_spectrum(
    signal: ArrayLike,
    rate: float,
    angle: ArrayLike,
    *,
    turns: int = 16,
    most: float = 50.0,
    unit: str = ACCELERATION.unit,
) -> OrderSpectrum:
    """Amplitude spectrum over orders of a signal of changing speed, resampled over the angle of the shaft.

    The signal is resampled at equal angles, finely enough for its bandwidth at the lowest speed, low-pass filtered
    over the angle at the highest order, and averaged over blocks with a Hann window that overlap by half.

    Parameters
    ----------
    signal : array_like, shape (k,)
    rate : float
        Of its samples [Hz].
    angle : array_like, shape (k,)
        Of the shaft at the samples [rad], rising.
    turns : int
        Of the shaft in a block: the resolution is one over them.
    most : float
        Highest order.
    unit : str
        Of the signal, for axes and tables.

    Raises
    ------
    InputError
        Fewer than 64 samples; an angle that does not rise, as at standstill; fewer turns than one block;
        orders that the rate does not resolve at the highest speed; a shaft so slow that the signal over its angle
        has more than 2^26 samples.
    """
    from scipy.interpolate import make_interp_spline
    from scipy.signal import welch

    column, rate = as_column("signal", signal, least=FEWEST), require_positive("rate", rate)
    turned = as_column("angle", angle, size=column.size, increasing=True) / (2.0 * pi)
    turns, most = require_integer("turns", turns, "a whole number >= 1", 1), require_positive("most", most)
    speed = np.diff(turned) * rate  # turns per s
    if most * speed.max() > 0.5 * rate:
        fastest = 60.0 * speed.max()
        degrees = " (angle in degrees?)" if most * speed.max() <= 90.0 / pi * rate else ""
        allowed = f"at most {0.5 * rate / speed.max():.4g}, half the rate at the highest speed, {fastest:.4g} rpm"
        raise InputError("most", most, allowed + degrees)
    per_turn = ceil(2.5 * most)  # as room for the filter
    whole = turned[-1] - turned[0]
    if whole < turns:
        raise InputError("turns", turns, f"at most {whole:.4g}, the turns of the record")
    finer = max(1, ceil(rate / (per_turn * speed.min())))
    if whole * per_turn * finer > MOST_SAMPLES:
        slowest = rate * whole / MOST_SAMPLES
        raise InputError(
            "angle", speed.min(), f"of a shaft that makes at least {slowest:.3g} turns per s all the time"
        )
    dense = resampled(column, FINER, 1)[: FINER * (column.size - 1) + 1]
    angles = turned[0] + np.arange(int(whole * per_turn * finer) + 1) / (per_turn * finer)
    place = FINER * np.interp(angles, turned, np.arange(column.size, dtype=float))
    even = make_interp_spline(np.arange(dense.size, dtype=float), dense)(place)
    over_angle = resampled(even, 1, finer)
    order, power = welch(
        over_angle,
        per_turn,
        "hann",
        min(turns * per_turn, over_angle.size),
        scaling="spectrum",
        detrend="constant",
    )
    kept = order <= most
    return OrderSpectrum(order[kept], np.sqrt(2.0 * power[kept]), unit)
