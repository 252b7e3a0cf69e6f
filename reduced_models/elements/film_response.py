"""The film law linearised about rest, as an impedance and as a state space; gains from an impedance, passivity.

About rest the law of `reduced_models.elements.film_law` is linear: with the own time tau of the contact, its
filters are fed by i = tau u', and

    dF = stiffness du + slope dm,    dm = c i + g_i s + g_f y + sum_k g_k q_k

    Z(s) = stiffness + slope s tau G(s tau),
    G(z) = c + g_i/(1 + z/p_i) + g_f/(1 + z/p_f) + 1/(1 + z/p_i) sum_k g_k/(1 + z/nu)^k

In the units of the load (force F, length F^(2/3), time F^(1/3)) slope is 3/2 and tau 1. G is linear in the gains,
so that they interpolate as impedances do, and C(Omega) = (3/2) Re G(i Omega). Elements and races of bearings have
this form, in their own units of force, approach and time.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import scipy
from numpy.polynomial import Chebyshev
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import require_integer, require_positive
from ehlcontact.errors import InputError
from ehlcontact.process.blas import one_blas_thread
from reduced_models.elements.film_filters import DIRECT

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

DRY = 1.5  # tangent of the dry contact in units of its load and approach
SMALL_OMEGA = 1e-5  # stands for 0
WEIGHT_C, WEIGHT_K = 0.05, 0.01  # relative errors of C and K that count alike
MOST_LAGS = 32
POINTS, PIECES = 64, 12
LEAST_VISCOUS = 1e-3
FILTERS = DIRECT - 1  # states of a film before those of its chain: inlet and fast


@dataclass(frozen=True)
class FilterRates:
    """Number of lags in the chain, and the rates of the filters in own time.

    Raises
    ------
    InputError
        No lag or more than 32, or a rate that is not > 0.
    """

    lags: int
    lag_rate: float
    inlet_rate: float
    fast_rate: float

    def __post_init__(self) -> None:
        allowed = f"a whole number from 1 to {MOST_LAGS}"
        object.__setattr__(self, "lags", require_integer("lags", self.lags, allowed, 1))
        if self.lags > MOST_LAGS:
            raise InputError("lags", self.lags, allowed)
        for name in ("lag_rate", "inlet_rate", "fast_rate"):
            object.__setattr__(self, name, require_positive(name, getattr(self, name)))

    @property
    def coefficients(self) -> dict[str, Any]:
        """Rates by name, as arguments of the elements with a film memory."""
        return {"lag_rate": self.lag_rate, "inlet_rate": self.inlet_rate, "fast_rate": self.fast_rate}

    def basis(self, omega: ArrayLike) -> _Complex:
        """Response of every filter to a vibration, shape of `omega` + (3 + lags,)."""
        return self.transfer(1j * np.asarray(omega, float))

    def transfer(self, s: ArrayLike) -> _Complex:
        """Transfer function of every filter at complex `s`, shape of `s` + (3 + lags,)."""
        s = np.asarray(s, complex)[..., None]
        s = np.where(np.abs(s) < SMALL_OMEGA, 1j * SMALL_OMEGA, s)
        inlet = 1.0 / (1.0 + s / self.inlet_rate)
        lag = 1.0 / (1.0 + s / self.lag_rate)
        response = np.empty((*s.shape[:-1], DIRECT + self.lags), complex)
        response[..., 0:1], response[..., 1:2], response[..., 2:3] = 1.0, inlet, 1.0 / (1.0 + s / self.fast_rate)
        for k in range(DIRECT, DIRECT + self.lags):  # each lag is fed by the one before it, the first by the inlet
            response[..., k : k + 1] = lag * (inlet if k == DIRECT else response[..., k - 1 : k])
        return response

    @one_blas_thread()
    def passive(self, gains: ArrayLike) -> bool:
        """Whether every row of `gains`, shape (rows, 3 + lags) or (3 + lags,), has Re G >= 0 at all frequencies.

        A polynomial of degree d cannot dip below its least value on M Chebyshev points by more than
        (sec(pi d/2M) - 1) times half its range there (Ehlich and Zeller 1964). That settles it piece by piece;
        only where it does not, the eigenvalues of `least_dissipation` do.
        """
        rows = np.atleast_2d(np.asarray(gains, float))
        values = self._on_pieces(rows)
        least, most = values.min(axis=2), values.max(axis=2)
        dip = 0.5 * (most - least) * (1.0 / math.cos(0.5 * math.pi * (2 + self.lags) / POINTS) - 1.0)
        # The first extrema decide the sign; `least_dissipation` goes on to the minimum itself.
        return all(
            self._dissipation(row, self._extrema(row, math.inf)).min() >= 0.0
            for row in rows[np.any(least < dip, axis=1)]
        )

    def _on_pieces(self, rows: _Floats) -> _Floats:
        """The polynomials of rows of gains on the pieces of [0, 1], shape (rows, pieces, points)."""
        x, t, chain = _pieces()
        inlet, fast = (1.0 / (1.0 + 1j * t * (self.lag_rate / rate)) for rate in (self.inlet_rate, self.fast_rate))
        carried = rows[:, 3:] @ chain[: self.lags]
        G = rows[:, :1] + (rows[:, 1:2] + carried) * inlet + rows[:, 2:3] * fast
        return np.asarray(G.real * self._factor(x)).reshape(len(rows), PIECES, POINTS)

    def least_dissipation(self, gains: ArrayLike) -> float:
        """Smallest Re G over all frequencies from 0 to infinity; the gains are passive where it is >= 0.

        In x = 1/(1 + (Omega/nu)^2) from 0 to 1, Re G times positive factors is a polynomial of degree 2 + lags.
        Its extrema, found as eigenvalues, decide the sign without a scan; taken again from the level of the
        lowest one, they end on the minimum itself.
        """
        g = np.array(gains, dtype=np.float64)
        level = math.inf
        for _ in range(20):  # from one level to the lowest dip below it; two or three rounds
            dip = float(self._dissipation(g, self._extrema(g, level)).min())
            if not dip < level - 1e-12:
                break
            level = dip
        return level

    def _dissipation(self, gains: _Floats, x: _Floats) -> _Floats:
        return np.asarray(self._real_basis(x) @ gains)

    def _real_basis(self, x: _Floats) -> _Floats:
        """Re of the response of every filter at x = 1/(1 + (Omega/nu)^2)."""
        omega = self.lag_rate * np.sqrt(np.maximum(1.0 / np.maximum(x, 1e-30) - 1.0, 0.0))
        return self.basis(omega).real

    def _factor(self, x: _Floats) -> _Floats:
        """Positive factor that makes a polynomial in x of it."""
        inlet, fast = ((self.lag_rate / rate) ** 2 for rate in (self.inlet_rate, self.fast_rate))
        return np.asarray((x + inlet * (1.0 - x)) * (x + fast * (1.0 - x)))

    def _extrema(self, gains: _Floats, level: float) -> _Floats:
        """Ends of [0, 1] and the extrema of the polynomial that has the sign of Re G - level."""
        shifted = gains.copy()
        if math.isfinite(level):
            shifted[0] -= level

        def polynomial(x: _Floats) -> _Floats:
            return self._dissipation(shifted, x) * self._factor(x)

        extrema = Chebyshev.interpolate(polynomial, 2 + self.lags, domain=[0.0, 1.0]).deriv().roots()
        inside = extrema.real[(np.abs(extrema.imag) < 1e-6) & (extrema.real > 0.0) & (extrema.real < 1.0)]
        return np.concatenate([[0.0, 1.0], inside])


@cache
def _pieces() -> tuple[_Floats, _Floats, _Complex]:
    """Chebyshev points x of the pieces of [0, 1], Omega/nu there, and the chain of 1, 2 ... lags (lags, points).

    The pieces halve towards x = 0, high frequencies, where the polynomials are small.
    """
    ends = np.append(0.0, 0.5 ** np.arange(PIECES - 1, -1, -1))
    place = 0.5 + 0.5 * np.cos(math.pi * (np.arange(POINTS) + 0.5) / POINTS)
    x = (ends[:-1, None] + np.diff(ends)[:, None] * place).ravel()
    t = np.sqrt(1.0 / x - 1.0)
    chain: _Complex = np.cumprod(np.tile(1.0 / (1.0 + 1j * t), (MOST_LAGS, 1)), axis=0, dtype=complex)
    return x, t, chain


class StateSpace(NamedTuple):
    """Linear system x' = A x + B w, f = C x + D w; w holds displacements, then their rates."""

    A: _Floats  # (n, n)
    B: _Floats  # (n, inputs)
    C: _Floats  # (forces, n)
    D: _Floats  # (forces, inputs)


class LinearFilm(NamedTuple):
    """Contacts about rest, shape S: () of one contact, (k,) of k contacts with one set of filters."""

    stiffness: float | _Floats  # S, slope of the static force
    slope: float | _Floats  # S, dF/dm
    tau: float | _Floats  # S, own time
    gains: _Floats  # S + (DIRECT + lags,); none in a dry contact
    rates: FilterRates | None  # in own time; None in a dry contact
    made: float | _Floats = 1.0  # S, film that a unit of the inlet's state lets into the chain; cancels in Z

    @classmethod
    def stack(cls, contacts: Sequence[LinearFilm]) -> LinearFilm:
        """Contacts with one set of filters, shape (k,) + S of k of shape S."""
        stiffness, slope, tau, gains, rates, made = zip(*contacts, strict=True)
        return cls(np.array(stiffness), np.array(slope), np.array(tau), np.array(gains), rates[0], np.array(made))

    def impedance(self, s: ArrayLike) -> _Complex:
        """Z of a motion exp(s t) at complex `s`, whose shape broadcasts against that of the contacts."""
        own = np.asarray(s, complex) * self.tau
        if self.rates is None:
            return np.asarray(self.stiffness + 0.0 * own)
        return np.asarray(self.stiffness + self.slope * own * (self.rates.transfer(own) * self.gains).sum(axis=-1))

    def state_space(self, *index: int) -> StateSpace:
        """System from (u, u') to the force; states inlet, fast, chain. `index` is the contact of several."""
        stiffness, slope, tau, gains = (np.asarray(part)[index] for part in self[:4])
        if self.rates is None:
            return StateSpace(
                np.zeros((0, 0)), np.zeros((0, 2)), np.zeros((1, 0)), np.array([[float(stiffness), 0.0]])
            )
        made = float(np.broadcast_to(self.made, np.shape(self.stiffness))[index])
        rates, size = self.rates, FILTERS + self.rates.lags
        A = np.diag(np.array([-rates.inlet_rate, -rates.fast_rate, *[-rates.lag_rate] * rates.lags]) / tau)
        for j in range(FILTERS, size):
            A[j, 0 if j == FILTERS else j - 1] = rates.lag_rate / tau * (made if j == FILTERS else 1.0)
        shares = gains[1:].copy()
        shares[FILTERS:] /= made
        fed = np.zeros((size, 2))
        fed[:FILTERS, 1] = rates.inlet_rate, rates.fast_rate
        return StateSpace(A, fed, slope * shares[None], np.array([[float(stiffness), slope * gains[0] * tau]]))


@dataclass(frozen=True, eq=False)
class GainFit:
    """Gains of one load, and what they make of its impedance."""

    gains: _Floats  # (3 + lags,)
    stiffness: _Floats  # K(Omega) of the gains
    damping: _Floats
    residuals: _Floats  # weighted: relative errors of C over 5 %, then of K over 1 %


def fit_gains(
    rates: FilterRates, omega: ArrayLike, stiffness: ArrayLike, damping: ArrayLike, static: float
) -> GainFit:
    """Gains >= 0 by linear least squares on C and K, relative, 5 % of C counting like 1 % of K.

    The viscous gain is at least a thousandth of the damping at the lowest frequency, so that the fastest motion
    is damped too, and is raised until the gains dissipate at every frequency, inside the data and beyond.

    Parameters
    ----------
    rates : FilterRates
    omega, stiffness, damping : array_like, shape (k,)
        Impedance in the units of its load.
    static : float
        Tangent of the static curve in those units.
    """
    w, K, C = (np.asarray(values, float) for values in (omega, stiffness, damping))
    if not np.all(C > 0.0):
        raise InputError("damping", float(C.min()), "> 0 at every frequency (a contact dissipates)")
    basis = rates.basis(w) * DRY
    rows = np.vstack([basis.real / (WEIGHT_C * C)[:, None], -(w[:, None] * basis.imag) / (WEIGHT_K * K)[:, None]])
    target = np.concatenate([np.full(w.size, 1.0 / WEIGHT_C), (K - static) / (WEIGHT_K * K)])
    floor = LEAST_VISCOUS * float(C[np.argmin(w)]) / DRY
    gains, _ = scipy.optimize.nnls(rows, target - rows[:, 0] * floor)
    gains[0] += floor
    for _ in range(10):
        if rates.passive(gains):
            break
        gains[0] -= 1.001 * rates.least_dissipation(gains)
    G = basis @ gains
    return GainFit(gains, static - w * G.imag, G.real, rows @ gains - target)


def inlet_saturation_of(loads: ArrayLike, approach: ArrayLike, gain_loads: ArrayLike, gains: ArrayLike) -> float:
    """Beta at which opening takes away at most the static film at load 1: film made per own rate over that film.

    Parameters as for `FilmContact.wide`.
    """
    places, x = np.log(np.asarray(gain_loads, float)), np.log(np.asarray(loads, float))
    made = np.interp(0.0, places, np.abs(np.asarray(gains, float)[:, DIRECT:]).sum(axis=1))
    film = np.interp(0.0, x, np.exp(2.0 / 3.0 * x) - np.asarray(approach, float))
    return float(made / film)
