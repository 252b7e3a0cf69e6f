"""Harmonic balance of a rotor on its supports.

Motions r = R q of the supports have harmonics 0 to H. With D_h = K + i h w (C + omega G) - (h w)^2 M of the rotor

    r_h = R D_h^-1 (f_h - R^T W F_h),

with forces F of the supports, driven through the samples of a period (`support_laws`): their films are in the
periodic state of that motion, exact but for the steps between samples. A reference stiffness of the supports is on
both sides, so that D_h is regular where the rotor alone is free. Newton's method has the slopes of the supports
at every sample; what films remember beyond a step is known from small motions, and from its own steps (Broyden).
"""

from __future__ import annotations

from itertools import product
from math import pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.status import Status
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.race import beyond_loads
from reduced_models.periodic_motion.answer import PeriodicAnswer
from reduced_models.periodic_motion.excitation import (
    OVER,
    PASSAGE,
    UNBALANCE,
    Excitation,
    PeriodicForce,
    Setting,
    name_of,
)
from reduced_models.periodic_motion.support_laws import Along, BallLaw, ContactLaw, DamperLaw, SupportLaw
from reduced_models.rotor.nodes import flat_nodes
from reduced_models.rotor.prepared_run import Histories
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.simulate import support_histories, warn_of_contacts
from reduced_models.rotor.speed_profile import law_speeds
from reduced_models.rotor.supports import AXIAL

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

UNIT = 1e-6  # m, in which the motions of supports are unknowns
TILT_ARM = 0.02  # m, of which such a motion is a tilt of the same size
CONVERGED = 1e-9  # of the largest motion, the last Newton step
MOST_ITERATIONS = 40
MOST_HALVINGS = 6
NUDGE = 1e-4  # of the units, by which motions tell what films remember
LEAST_REFERENCE = 1e-6  # of the stiffest direction


class Balance(NamedTuple):
    """A motion, and how far it is from balance."""

    x: _Floats
    w: float  # angular frequency of the motion [rad/s]
    along: Along
    by_force: _Complex  # motions of the supports by forces on them, (H + 1, m, m)
    residual: _Floats

    @property
    def error(self) -> float:
        """Size of the residual, in units of the unknowns."""
        return float(np.linalg.norm(self.residual))


class HarmonicBalance:
    """Unknown harmonics of the motions of all supports, their residual and its derivatives.

    Parameters
    ----------
    rotor : Rotor
    excitation : "unbalance", "passage" or PeriodicForce
    speeds_rpm : (float, float)
        Lowest and highest speed of the shaft, for the tables of films.
    harmonics, samples : int
        H, and samples of a period.
    positions : int
        Of the cage of a mean bearing.
    periods : int
        Periods of the excitation after which the motion repeats itself.
    bearing : int
        Ball bearing whose balls pass, among those of the rotor.
    """

    def __init__(
        self,
        rotor: Rotor,
        excitation: Excitation,
        speeds_rpm: tuple[float, float],
        *,
        harmonics: int,
        samples: int,
        positions: int,
        periods: int = 1,
        bearing: int = 0,
    ) -> None:
        self.rotor, self.excitation, self.periods = rotor, excitation, periods
        self.harmonics, self.samples, self._bearing = harmonics, samples, bearing
        points, normals, counts = rotor.geometry
        self.rows, self._counts = np.asarray(normals @ points), counts
        tables = law_speeds(np.array(speeds_rpm)).tolist()
        bearings = rotor.ball_bearings
        turning = {bearing} if excitation == PASSAGE else set()
        self._laws: list[tuple[slice, SupportLaw]] = [
            (slice(k, k + 1), ContactLaw(mount)) for k, mount in enumerate(rotor.contacts)
        ]
        self.balls = [BallLaw(mount, tables, 0 if k in turning else positions) for k, mount in enumerate(bearings)]
        self._laws += list(zip(rotor.ball_columns, self.balls, strict=True))
        dampers = map(DamperLaw, rotor.film_dampers)
        self._laws += list(zip(rotor.film_damper_columns, dampers, strict=True))
        self._shift = np.zeros(len(self.rows))
        for at, mount in zip(rotor.ball_columns, bearings, strict=True):
            self._shift[at] = mount.shift
        tilts = [name.startswith("tilt") for name in self._names()]
        self.units = np.where(tilts, UNIT / TILT_ARM, UNIT)
        self._synthesis, self._rates, self._analysis = fourier(harmonics, samples)
        self.reference: Any = None  # stiffness of the supports, with that the rotor alone is held, (m, m)
        unknowns = (2 * harmonics + 1) * len(self.rows)
        self._memory = np.zeros((unknowns, unknowns))  # what films add to the slopes

    def _names(self) -> list[str]:
        names = ["x"] * len(self.rotor.contacts)
        for mount in (*self.rotor.ball_bearings, *self.rotor.film_dampers):
            names += mount.directions
        return names

    def period(self, setting: Setting) -> float:
        """After which the motion repeats itself [s]; of a passage, by the speed at which the cage turned last."""
        if isinstance(self.excitation, PeriodicForce):
            once = 1.0 / (self.excitation.hz if setting.frequency is None else setting.frequency)
        elif self.excitation == UNBALANCE:
            once = 2.0 * pi / setting.omega
        else:
            law = self.balls[self._bearing]
            once = law.pitch / (law.cage * setting.omega)
        return self.periods * once

    def _applied(self, setting: Setting) -> _Complex:
        """Forces on the rotor by harmonic, shape (H + 1, N)."""
        H, size = self.harmonics, self.rotor.size
        found = np.zeros((H + 1, size), complex)
        if isinstance(self.excitation, PeriodicForce):
            found += setting.amplitude * self.excitation.spectrum(size, H, self.periods)
        elif self.excitation == UNBALANCE:
            if self.periods > H:
                raise InputError("harmonics", H, f"at least {self.periods}, of {self.periods} turns")
            found[self.periods] = setting.amplitude * setting.omega**2 * self.rotor.turning_unbalance
        found[0] += self.rotor.load
        return found

    def _alone(self, setting: Setting, harmonics: NDArray[np.int64], w: float) -> _Complex:
        """Dynamic stiffness of the rotor with the reference stiffness of its supports, shape (k, N, N)."""
        M, C, K = self.rotor.matrices(setting.omega)
        s = 1j * w * harmonics[:, None, None]
        return np.asarray(s * s * M + s * C + K + self.rows.T @ self.reference @ self.rows)

    def unknowns(self, r: _Complex) -> _Floats:
        """Unknowns, shape ((2H + 1) m,), of harmonics of the motions of the supports, shape (H + 1, m)."""
        return (as_rows_of(r) / self.units).ravel()

    def motion(self, x: _Floats, w: float) -> tuple[_Floats, _Floats]:
        """Motions of the supports and their velocities at the samples, shape (samples, m)."""
        rows = x.reshape(2 * self.harmonics + 1, len(self.units)) * self.units
        return self._synthesis @ rows, w * (self._rates @ rows)

    def forces(self, setting: Setting, x: _Floats, w: float) -> Along:
        """Forces of all supports at the samples, and their slopes."""
        r, v = self.motion(x, w)
        m, n, dt = len(self.units), self.samples, 2.0 * pi / (w * self.samples)
        total = Along(np.zeros((n, m)), np.zeros((n, m, m)), np.zeros((n, m, m)))
        for at, law in self._laws:
            if isinstance(law, BallLaw):
                law.clearance = setting.clearance
            found = law.along(setting.omega, dt, r[:, at] + self._shifted(at, setting), v[:, at])
            total.force[:, at] = found.force
            total.stiffness[:, at, at], total.damping[:, at, at] = found.stiffness, found.damping
        return total

    def balance(self, setting: Setting, x: _Floats) -> Balance:
        """Forces along a motion, and what is left of the equations."""
        along = self.forces(setting, x, 2.0 * pi / self.period(setting))
        if self.reference is None:
            mean = np.abs(np.diagonal(along.stiffness.mean(axis=0)))
            self.reference = np.diag(self._counts * np.maximum(mean, LEAST_REFERENCE * mean.max(initial=0.0)))
        return self._balanced(setting, x, along)

    def _balanced(self, setting: Setting, x: _Floats, along: Along) -> Balance:
        w = 2.0 * pi / self.period(setting)
        alone = self._alone(setting, np.arange(self.harmonics + 1), w)
        by_force = self.rows @ solved(alone, self.rows.T[None])
        applied = solved(alone, self._applied(setting)[:, :, None])[:, :, 0] @ self.rows.T
        moved = applied - np.einsum("hij,hj->hi", by_force, as_spectrum(self._push(along, x)))
        return Balance(x, w, along, by_force, x - self.unknowns(moved))

    def change(self, at: Balance, setting: Setting) -> _Floats:
        """Change of the residual by another setting, next to that of the balance.

        Films stay, but where clearance or preload change.
        """
        if any(getattr(setting, name) is not None for name in ("clearance", "preload")):
            along = self.forces(setting, at.x, 2.0 * pi / self.period(setting))
        else:
            _, v = self.motion(at.x, 2.0 * pi / self.period(setting) - at.w)
            along = at.along._replace(force=at.along.force + np.einsum("nij,nj->ni", at.along.damping, v))
        return self._balanced(setting, at.x, along).residual - at.residual

    def _push(self, along: Along, x: _Floats) -> _Floats:
        """Harmonics of the forces of the supports beside those of the reference, shape (2H + 1, m)."""
        rows = x.reshape(2 * self.harmonics + 1, len(self.units)) * self.units
        return np.asarray(self._counts * (self._analysis @ along.force) - rows @ self.reference)

    def slopes(self, at: Balance) -> _Floats:
        """Harmonics of the forces by those of the motions, shape ((2H + 1) m, (2H + 1) m) [N/m]."""
        m, rows = len(self.units), 2 * self.harmonics + 1
        slopes = np.zeros((rows, m, rows, m))
        for columns, _ in self._laws:
            for i, j in product(range(columns.start, columns.stop), repeat=2):
                by_place = (self._analysis * at.along.stiffness[:, i, j]) @ self._synthesis
                by_rate = (self._analysis * at.along.damping[:, i, j]) @ self._rates
                slopes[:, i, :, j] = by_place + at.w * by_rate
        return slopes.reshape(rows * m, rows * m) + self._memory

    def jacobian(self, at: Balance, slopes: _Floats | None = None) -> _Floats:
        """Derivatives of the residual, shape (unknowns, unknowns)."""
        m, rows = len(self.units), 2 * self.harmonics + 1
        slopes = self.slopes(at) if slopes is None else slopes
        pushed = self._counts[:, None, None] * slopes.reshape(rows, m, rows, m)
        for a in range(rows):
            pushed[a, :, a, :] -= self.reference
        by_row = pushed.reshape(rows, m, rows * m)
        by_force = np.zeros((rows, m, rows * m))
        by_force[0] = at.by_force[0].real @ by_row[0]
        real, imaginary = at.by_force[1:].real, at.by_force[1:].imag
        by_force[1::2] = real @ by_row[1::2] - imaginary @ by_row[2::2]
        by_force[2::2] = imaginary @ by_row[1::2] + real @ by_row[2::2]
        by_force = by_force / self.units[:, None] * np.tile(self.units, rows)
        return np.asarray(by_force.reshape(rows * m, rows * m) + np.eye(rows * m))

    @property
    def remembers(self) -> bool:
        """Whether slopes of the supports leave out what films remember."""
        return any(law.remembers for _, law in self._laws)

    def learn(self, before: Balance, slopes: _Floats, after: Balance) -> None:
        """Add to the slopes what they missed between two motions: Broyden's rule."""
        if self.remembers:
            rows = np.tile(self.units, 2 * self.harmonics + 1)
            change = rows * (after.x - before.x)
            pushed = (self._analysis @ (after.along.force - before.along.force)).ravel()
            weighted = (after.x - before.x) / rows
            self._memory += np.outer(pushed - slopes @ change, weighted) / float(weighted @ change)

    def renew(self, setting: Setting, at: Balance) -> None:
        """Take what films remember about a motion from small motions with all harmonics, one in each direction."""
        if not self.remembers:
            return
        H, m = self.harmonics, len(self.units)
        phases = np.exp(1j * np.arange(H + 1) ** 2)  # of many harmonics the sum stays small
        phases[0] = 1.0
        self._memory[:] = 0.0
        slopes, memory = self.slopes(at), self._memory.reshape(2 * H + 1, m, 2 * H + 1, m)
        for j in range(m):
            spectrum = np.zeros((H + 1, m), complex)
            spectrum[:, j] = NUDGE * self.units[j] * phases
            change = as_rows_of(spectrum)
            there = self.forces(setting, at.x + (change / self.units).ravel(), at.w)
            pushed = (self._analysis @ (there.force - at.along.force)).ravel() - slopes @ change.ravel()
            by = as_spectrum(pushed.reshape(2 * H + 1, m)) / spectrum[:, j, None]
            memory[0, :, 0, j] = by[0].real
            for h in range(1, H + 1):
                a, b = 2 * h - 1, 2 * h
                memory[a, :, a, j] = memory[b, :, b, j] = by[h].real
                memory[b, :, a, j], memory[a, :, b, j] = by[h].imag, -by[h].imag

    def solve(self, setting: Setting, x: _Floats) -> Balance:
        """Newton's method from x at a setting.

        Raises
        ------
        ConvergenceError
            No balance; ``result`` is the last `Balance`.
        """
        at = self.balance(setting, x)
        self.renew(setting, at)
        for _ in range(MOST_ITERATIONS):
            slopes = self.slopes(at)
            step = solved(self.jacobian(at, slopes), -at.residual)
            if np.linalg.norm(step) <= CONVERGED * np.linalg.norm(at.x):
                return at
            there = self._towards(setting, at, step)
            self.learn(at, slopes, there)
            at = there
        raise ConvergenceError(f"no periodic answer in {MOST_ITERATIONS} steps of Newton's method", at)

    def _towards(self, setting: Setting, at: Balance, step: _Floats) -> Balance:
        """The step, or as much of it as makes the residual smaller."""
        best = None
        for k in range(MOST_HALVINGS):
            try:
                there = self.balance(setting, at.x + 0.5**k * step)
            except ConvergenceError:
                continue
            if there.error < at.error:
                return there
            best = there if best is None or there.error < best.error else best
        if best is None:
            raise ConvergenceError("the supports have no forces along the motion", at)
        return best

    def answer(self, setting: Setting, at: Balance, over: str) -> PeriodicAnswer:
        """The periodic answer in balance."""
        rotor, H, w, n = self.rotor, self.harmonics, at.w, self.samples
        dt, omega = 2.0 * pi / (w * n), setting.omega
        push = as_spectrum(self._push(at.along, at.x))
        alone = self._alone(setting, np.arange(H + 1), w)
        q = solved(alone, (self._applied(setting) - push @ self.rows)[:, :, None])[:, :, 0]
        rows = as_rows_of(q)
        d, v = self._synthesis @ rows, w * (self._rates @ rows)
        r, rate = self.motion(at.x, w)
        largest, shift = np.zeros((len(self.balls), 2)), np.zeros(len(self.rows))
        for k, (columns, law) in enumerate(zip(rotor.ball_columns, self.balls, strict=True)):
            shift[columns] = self._shifted(columns, setting)
            largest[k] = law.largest(omega, dt, r[:, columns] + shift[columns], rate[:, columns])
        d, v, r, rate, force = (np.concatenate([x[-1:], x]) for x in (d, v, r, rate, at.along.force))
        histories, omegas = Histories(d, v, r, rate, force, np.zeros(n + 1, np.int64)), np.full(n + 1, omega)
        columns_of, approach, rates, forces = support_histories(rotor, histories, omegas, shift)
        names, places = flat_nodes(rotor.nodes)
        run = RotorResult(
            t=np.asarray(dt * np.arange(n + 1)), speed_rpm=omegas / RPM_TO_RAD_S,
            displacement=histories.displacement, velocity=histories.velocity,
            approach=approach, rate=rates, force=forces, iterations=histories.evaluations,
            largest_load=largest, status=Status.CONVERGED, columns=columns_of, names=names, places=places,
            dampers=rotor.film_damper_names,
        )  # fmt: skip
        warn_of_contacts(rotor, run)
        return PeriodicAnswer(
            run=run, excitation=name_of(self.excitation), over=over, value=float(getattr(setting, OVER[over])),
            periods=self.periods, residual=self._left_out(setting, at),
            reservation=self._reservation(setting, largest),
        )  # fmt: skip

    def _shifted(self, columns: slice, setting: Setting) -> _Floats:
        """Displacement of a ring beside that of the rotor."""
        shift = self._shift[columns].copy()
        if setting.preload is not None and shift.size > AXIAL:
            shift[AXIAL] = setting.preload
        return shift

    def _left_out(self, setting: Setting, at: Balance) -> float:
        """Motion of the supports in as many harmonics beyond those kept, over that within them."""
        H = self.harmonics
        beyond = np.arange(H + 1, min(2 * H, self.samples // 2 - 1) + 1)
        force = 2.0 * np.fft.rfft(at.along.force, axis=0)[beyond] / self.samples * self._counts
        moved = solved(self._alone(setting, beyond, at.w), (force @ self.rows)[:, :, None])[:, :, 0]
        kept = as_spectrum(at.x.reshape(2 * H + 1, len(self.units)))[1:]
        left = np.linalg.norm(moved @ self.rows.T / self.units)
        return float(left / max(float(np.linalg.norm(kept)), np.finfo(float).tiny))

    def _reservation(self, setting: Setting, largest: _Floats) -> str:
        rotor, words = self.rotor, []
        if self.excitation == PASSAGE and rotor.unbalances:
            words.append("unbalances are left out: with balls that pass they have no common period")
        if self.excitation != PASSAGE and rotor.ball_bearings:
            words.append("bearings are means over positions of the cage: the passage of balls is left out")
        for mount, name, loads in zip(rotor.ball_bearings, rotor.ball_bearing_names, largest, strict=True):
            beyond = beyond_loads(mount.ball_bearing, name, setting.speed_rpm, loads)
            words += [text for texts in beyond for text in texts]
        return "; ".join(words)


def fourier(harmonics: int, samples: int) -> tuple[_Floats, _Floats, _Floats]:
    """Samples from harmonics, (n, 2H + 1), their rates over the angular frequency, and harmonics from samples.

    Rows are the mean, then cosines and, with their sign changed, sines: real and imaginary parts of c in
    Re(c exp(i h w t)). Samples are at the ends of n equal parts of the period.
    """
    angle = 2.0 * pi * np.arange(1, samples + 1) / samples
    h = np.arange(1, harmonics + 1)
    waves = np.exp(1j * angle[:, None] * h)
    synthesis, rates = np.ones((samples, 2 * harmonics + 1)), np.zeros((samples, 2 * harmonics + 1))
    synthesis[:, 1::2], synthesis[:, 2::2] = waves.real, -waves.imag
    rates[:, 1::2], rates[:, 2::2] = -h * waves.imag, -h * waves.real
    analysis = synthesis.T * np.append(1.0, np.full(2 * harmonics, 2.0))[:, None] / samples
    return synthesis, rates, analysis


def solved(matrix: NDArray[Any], right: NDArray[Any]) -> NDArray[Any]:
    """Solution of linear equations; raises `ConvergenceError` where the rotor is free."""
    try:
        return np.asarray(np.linalg.solve(matrix, right))
    except np.linalg.LinAlgError:
        raise ConvergenceError("the supports do not hold the rotor along a motion", None) from None


def as_spectrum(rows: _Floats) -> _Complex:
    """Harmonics, shape (H + 1, m), of mean, real and imaginary parts, shape (2H + 1, m)."""
    return np.concatenate([rows[:1], rows[1::2] + 1j * rows[2::2]])


def as_rows_of(r: _Complex) -> _Floats:
    """Mean, real and imaginary parts, shape (2H + 1, m), of harmonics, shape (H + 1, m)."""
    rows = np.zeros((2 * len(r) - 1, r.shape[1]))
    rows[0], rows[1::2], rows[2::2] = r[0].real, r[1:].real, r[1:].imag
    return rows
