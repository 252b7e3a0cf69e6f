"""A rotor linearised about its static equilibrium at a shaft speed: modes, responses, stability, unbalance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Protocol, Self, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import (
    as_column,
    parts,
    require_finite,
    require_instance,
    require_integer,
    require_nonnegative,
)
from ehlcontact.checks.frequency import Frequency, by_name, radians_per_second
from ehlcontact.checks.kinds import COMPLEX, NAME, Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.summary import Summary
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.linear_balls import LinearBalls
from reduced_models.bearing.race import beyond_loads
from reduced_models.bearing.ring import RingEquilibrium, equilibrium_at, ring_equilibrium
from reduced_models.bearing.ring_statics import cage_angles, linear_balls, static_ring
from reduced_models.bearing.solved_balls import damping_left_out, warn_of_damping_left_out, with_solved_contacts
from reduced_models.elements.base import ContactElement
from reduced_models.rotor.control import Signals, linear_block
from reduced_models.rotor.damping_budget import DampingBudget, budget_of
from reduced_models.rotor.equilibrium import require_held
from reduced_models.rotor.linear_bearing import LinearBearing
from reduced_models.rotor.linear_contact import ContactImpedance, LinearElement, WithoutLoss
from reduced_models.rotor.linear_system import eigenmodes
from reduced_models.rotor.loss_parts import (
    matrix_losses,
    require_parts,
    support_losses,
    taken_by_supports,
    without_losses,
)
from reduced_models.rotor.modes import (
    ALONG,
    CANDIDATES,
    CONVERGED,
    CONVERGED_BY_STEPS,
    RotorMode,
    eigenvectors,
    is_new,
    mode_distance,
    refine_root,
    whirl_of,
)
from reduced_models.rotor.nodes import flat_nodes
from reduced_models.rotor.rotor import Matrices, Rotor
from reduced_models.rotor.supports import BearingMount, ContactMount, Mount, bearing_names, is_damper
from reduced_models.rotor.unbalance_result import UnbalanceResponse

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

NEAR = 0.5  # relative distance of an eigenvalue from that with frozen supports, within which it may be its own
DEFAULT_MODES = 8  # modes, unless another number is given
SLOW = 1e-3  # rad/s, stands for rest where damping is computed: films forget in less than a second
FREE = 1e-9  # of the largest stiffness, what rounding leaves where a rotor is free
UNLOADED = 1e-9  # of its most loaded ball, the load of a preloaded bearing that is the rounding of none
REDUCED = 1e-6  # of the static stiffness of a bearing, error of its impedance with fewer states
VERTICAL = 0.5  # share of the motion of a mode from which it counts as vertical


class LinearSupport(Protocol):
    """A support about static equilibrium."""

    def impedance(self, s: ArrayLike) -> _Complex:
        """Forces over its motions [N/m] at s [1/s] of exp(s t), shape of `s` + (directions, directions)."""


@dataclass(frozen=True, eq=False)
class LinearRotor(Summary):
    """A rotor about static equilibrium under its load, made by `linearise`.

    Squeeze film dampers are `LinearBearing` about their journals at rest: `SqueezeFilmDamper.linear`.
    Ball bearings and elements are exact at complex frequencies, the memory of their films included; impedances are
    those of the frequency. Films are those of the speed. Balls stand still while the rotor vibrates, at the angle
    of their mount or, over a ball passage, at all positions of the cage: then the impedance of a bearing is the
    mean of those, each with the ring where the bearing's share of the load puts it. That bearings change while the
    rotor vibrates is left out: a mode across the load of the beam in the tests, where stiffness changes by a
    quarter as balls pass, has 0.7 % more decrement and 0.2 % less frequency by that; one along the load nothing.

    Attributes
    ----------
    rotor : Rotor
    speed_rpm : float
        Of the shaft.
    passage : bool
        Mean over a ball passage, or at the angles of the mounts.
    rest : ndarray, shape (N,)
        Static displacements, balls at the angles of the mounts [m]; 0 where contacts are impedances alone.
    loads : ndarray, shape (ball bearings, n)
        Forces on the inner rings in static equilibrium, n = 2 or 5 [N], [N m], in the frame of each bearing.
    contacts : tuple
        Contacts about static equilibrium.
    balls : tuple
        Ball bearings about static equilibrium.
    damping_left_out : tuple of str
        Damping below zero of starved contacts that elements leave out, by ball bearing, in words; empty where
        there is none.
    signed_damping : bool
        Contacts under an oil supply have the impedance of the solved ones, with damping below zero, in place of
        their elements. It is known over real frequencies: K + s C with K and C at the frequency of a mode stands
        for Z(s), to first order in the damping.
    reservation : str
        Loads of balls outside those of the atlas, in words; empty where there are none.
    lossless : tuple of str
        Parts whose loss is left out, as `without` does.
    """

    rotor: Rotor
    speed_rpm: float
    passage: bool
    rest: _Floats
    loads: _Floats
    contacts: tuple[LinearElement | ContactImpedance | WithoutLoss, ...]
    balls: tuple[LinearBalls, ...]
    damping_left_out: tuple[str, ...] = ()
    signed_damping: bool = False
    reservation: str = ""
    lossless: tuple[str, ...] = ()

    def _summary_lines(self) -> list[str]:
        named = zip(self.rotor.ball_bearing_names, self.damping_left_out, strict=False)
        left_out = [f"{name}: {words}" for name, words in named if words]
        of = ", with the signed damping of solved contacts" if self.signed_damping else ""
        of += f", without the loss of {' and '.join(self.lossless)}" if self.lossless else ""
        about = f"about static equilibrium at {self.speed_rpm:.5g} rev/min{of}"
        return [about, *self.rotor._summary_lines(), *left_out, *filter(None, [self.reservation])]

    @cached_property
    def matrices(self) -> Matrices:
        """Mass, damping with the gyroscopic part, and stiffness; linear bearings are in them."""
        M, C, K = self.rotor.matrices(self.speed_rpm * RPM_TO_RAD_S)
        for name, (damping, skew) in self._matrix_losses.items():
            if name in self.lossless:
                C, K = C - damping, K - skew
        return M, C, K

    @property
    def supports(self) -> tuple[tuple[str, LinearSupport], ...]:
        """Contacts, then ball bearings about static equilibrium, with their names."""
        contacts = ((f"contact {k}", contact) for k, contact in enumerate(self.contacts))
        return *contacts, *zip(self.rotor.ball_bearing_names, self.balls, strict=True)

    @property
    def losses(self) -> tuple[str, ...]:
        """Names of the parts that take energy from a vibration: rows of `damping_budget`."""
        own = (name for name in self._matrix_losses if name not in self.lossless)
        return *support_losses(self.supports), *own

    def without(self, *names: str) -> Self:
        """The rotor without the loss of some parts, by their names in `losses`; their stiffness stays.

        Modes and responses are those of the rest. What is left of a part is the real K of Z = K + s C: known at
        each frequency, without states in time.

        Raises
        ------
        InputError
            What is none of `losses`.
        """
        require_parts(names, self.losses)
        others = iter(without_losses(self.supports, names))
        contacts = tuple(next(others) for _ in self.contacts)
        return replace(self, contacts=contacts, balls=tuple(others), lossless=(*self.lossless, *names))

    def taken(self, s: complex, q: _Complex) -> tuple[dict[str, float], float]:
        """What each part takes from a motion q exp(s t), Im(q^H Z q) [N m], and the inertia of it [kg m2].

        `reduced_models.rotor.loss_parts` has the sums: for a mode the parts together are -2 Re(s) Im(s) times the
        inertia, in which gyroscopic forces are.
        """
        found, mass = taken_by_supports(self.supports, self._rows, s, q)
        M, C, _ = self.matrices
        for name, (damping, skew) in self._matrix_losses.items():
            if name not in self.lossless:
                found[name] = float(np.real(s.imag * (q.conj() @ damping @ q)) + np.imag(q.conj() @ skew @ q))
        turning = float(np.imag(q.conj() @ (0.5 * (C - C.T)) @ q))
        mass += float(np.real(q.conj() @ M @ q)) + 0.5 * turning / s.imag
        return found, mass

    def refined(self, mode: RotorMode) -> tuple[complex, _Complex]:
        """Eigenvalue and shape of a mode by Newton's method from that of `mode`, perhaps of a rotor much like it.

        Raises
        ------
        ConvergenceError
            There is none near.
        """
        return refine_root(self.dynamic_stiffness, mode.eigenvalue, mode.shape, CONVERGED_BY_STEPS)

    def damping_budget(self, count: int | None = DEFAULT_MODES) -> DampingBudget:
        """Who damps what: the damping ratio of each mode by the parts that take its energy; None: all modes.

        Raises
        ------
        ConvergenceError
            As of `modes`.
        """
        return budget_of(self, self.modes(count))

    @cached_property
    def _matrix_losses(self) -> dict[str, tuple[_Floats, _Floats]]:
        return matrix_losses(self.rotor, self.speed_rpm * RPM_TO_RAD_S)

    @takes(s=COMPLEX)
    def support_impedance(self, s: ArrayLike) -> _Complex:
        """Part of contacts and ball bearings in `dynamic_stiffness` [N/m] at s [1/s], shape of `s` + (N, N)."""
        rows = self._rows
        Z, first = np.zeros((*np.shape(s), len(rows), len(rows)), complex), 0
        for _, support in self.supports:
            impedance = support.impedance(s)
            here = slice(first, first + impedance.shape[-1])
            Z[..., here, here], first = impedance, here.stop
        return np.asarray(rows.T @ Z @ rows)

    @takes(s=COMPLEX)
    def dynamic_stiffness(self, s: ArrayLike) -> _Complex:
        """Forces over displacements [N/m] at s [1/s] of exp(s t), shape of `s` + (N, N)."""
        M, C, K = self.matrices
        rate = np.asarray(s, complex)[..., None, None]
        return np.asarray(rate * rate * M + rate * C + K + self.support_impedance(s))

    def modes(self, count: int | None = DEFAULT_MODES) -> tuple[RotorMode, ...]:
        """Modes that oscillate, the slowest first; None: all.

        Raises
        ------
        ConvergenceError
            A mode that was there with bearings of one stiffness and damping was not found with their memory.
        """
        if count is not None:
            require_integer("count", count, "a whole number >= 1", 1)
        if count not in self._known_modes:
            self._known_modes[count] = self._modes(count)
        return self._known_modes[count]

    @cached_property
    def _known_modes(self) -> dict[int | None, tuple[RotorMode, ...]]:
        """Modes by the count asked for: a diagram to which a speed is added has those of the others already."""
        return {}

    def _modes(self, count: int | None) -> tuple[RotorMode, ...]:
        undamped = self.support_impedance(SLOW)  # at a real s, real
        values, vectors = eigenvectors(self.matrices, undamped, SLOW)
        roots: list[tuple[complex, _Complex]] = []
        for s, q in zip(values[:count], vectors.T[:count], strict=True):
            roots += self._root(complex(s), q, roots)
        modes = [self._mode(s, q) for s, q in roots if s.imag > 0.0]
        return tuple(sorted(modes, key=lambda mode: mode.omega))

    def slowest(self) -> dict[str, RotorMode]:
        """The slowest mode along each direction, "x" or "y", by the larger share of its motion."""
        modes: dict[str, RotorMode] = {}
        for mode in self.modes(None):
            if mode.axial_share > ALONG:
                continue
            modes.setdefault("y" if mode.vertical_share >= VERTICAL else "x", mode)
        return modes

    @takes(mode=Object(RotorMode, "a RotorMode"))
    def nearest(self, mode: RotorMode) -> RotorMode:
        """The mode next in frequency to that of another rotor, if possible among those along its direction."""
        modes = self.modes(None)
        alike = [own for own in modes if (own.vertical_share >= VERTICAL) == (mode.vertical_share >= VERTICAL)]
        return min(alike or modes, key=lambda own: abs(own.omega - mode.omega))

    @property
    def growth(self) -> float:
        """Largest real part [1/s] of all modes that oscillate; below 0 they all die away."""
        return max((mode.eigenvalue.real for mode in self.modes(None)), default=-np.inf)

    @property
    def stable(self) -> bool:
        """Whether all vibrations die away, and no direction has a negative static stiffness."""
        _, _, K = self.matrices
        static = K + self.support_impedance(SLOW).real
        slopes = np.linalg.eigvalsh(0.5 * (static + static.T))
        return self.growth < 0.0 and bool(slopes[0] > -FREE * slopes[-1])

    @by_name(1)
    def receptance(self, **frequency: Unpack[Frequency]) -> _Complex:
        """Displacements over forces, shape (k, N, N) [m/N].

        Parameters
        ----------
        **frequency
            Exactly one of omega [rad/s], hz and rpm, shape (k,).
        """
        w = radians_per_second(None, **frequency)
        return np.array([np.linalg.inv(self.dynamic_stiffness(1j * omega)) for omega in w.tolist()])

    @by_name(1)
    def unbalance_response(self, **frequency: Unpack[Frequency]) -> UnbalanceResponse:
        """Response over the rate at which the unbalances turn.

        Parameters
        ----------
        **frequency
            At which they turn, films, cage and gyroscopic forces being those of `speed_rpm` all the same: exactly
            one of omega [rad/s], hz and rpm, shape (k,).
        """
        w = radians_per_second(None, **frequency)
        return UnbalanceResponse.of(
            self.rotor, w / RPM_TO_RAD_S, np.array([self._unbalanced(omega) for omega in w.tolist()])
        )

    def orbit(self, rest: ArrayLike | None = None) -> tuple[_Floats, _Floats]:
        """Displacements and velocities at t = 0 of the settled motion under the unbalances at the rotor's speed.

        Parameters
        ----------
        rest : array_like, shape (N,), optional
            Displacements about which it moves, by default those of static equilibrium.
        """
        w = self.speed_rpm * RPM_TO_RAD_S
        q = self._unbalanced(w)
        about = self.rest if rest is None else as_column("rest", rest, size=self.rotor.size)
        return about + q.real, (1j * w * q).real

    @takes(t=parts.ANY)
    def motion(self, t: ArrayLike) -> _Floats:
        """Displacements of that motion over times [s], shape (k, N)."""
        w = self.speed_rpm * RPM_TO_RAD_S
        turned = np.exp(1j * w * np.atleast_1d(np.asarray(t, float)))[:, None]
        return np.asarray(self.rest + np.real(turned * self._unbalanced(w)))

    @takes(name=NAME, tolerance=parts.SHARE)
    def to_control(
        self, inputs: Signals = None, outputs: Signals = None, name: str = "rotor", *, tolerance: float = REDUCED
    ) -> Any:
        """Linear python-control ``StateSpace``, films' memory included, from forces [N] to displacements [m].

        Its first states are displacements and velocities, as of `rotor_to_control`, in their units. Bearings have
        as few states as `tolerance` allows (`reduced_models.bearing.linear_reduction`). With a tolerance of 0 all
        balls at all positions of the cage have theirs, as there: thousands with means over a ball passage.

        Parameters
        ----------
        inputs, outputs : mapping of str to int, or sequence of int, optional
            Degrees of freedom by name; without names they are F0, F1, ... and q0, q1, ... By default all.
        name : str
            Of the system.
        tolerance : float
            Largest error of the impedance of a bearing at any frequency, over its static stiffness.

        Returns
        -------
        control.StateSpace
            With the attribute ``reduction_error``, the bound of that error.

        Raises
        ------
        InputError
            A degree of freedom that is not there; a tolerance of 1 or more; signed damping, which has no states.
        """
        if self.signed_damping:
            raise InputError("signed_damping", True, "False: impedances of solved contacts have no states")
        if self.lossless:
            allowed = "none: a part without its loss has no states in time"
            raise InputError("lossless", ", ".join(self.lossless), allowed)
        if require_nonnegative("tolerance", tolerance) >= 1.0:
            raise InputError("tolerance", tolerance, "below 1, of the static stiffness of a bearing")
        w = self.speed_rpm * RPM_TO_RAD_S
        return linear_block(self.rotor, w, self.balls, inputs, outputs, name, tolerance)

    @cached_property
    def _rows(self) -> _Floats:
        """Motions of contacts and ball bearings from those of the rotor."""
        points, normals, _ = self.rotor.geometry
        return np.asarray(normals @ points)

    def _unbalanced(self, omega: float) -> _Complex:
        """Complex amplitudes, shape (N,), of q(t) = Re(q exp(i w t)); the angle of the shaft is w t."""
        return np.asarray(
            np.linalg.solve(self.dynamic_stiffness(1j * omega), omega * omega * self.rotor.turning_unbalance)
        )

    def _mode(self, s: complex, q: _Complex) -> RotorMode:
        shape = q / q[np.argmax(np.abs(q))]
        K, held = self.matrices[2], self.support_impedance(1j * s.imag).real
        in_supports, in_shaft = (float(np.real(shape.conj() @ part @ shape)) for part in (held, K))
        pairs = [*(m.ends[0][:2] for m in self.rotor.mounts), *((u.x, u.y) for u in self.rotor.unbalances)]
        whole = in_supports + in_shaft
        housings = float(np.real(shape.conj() @ self._housing_springs @ shape)) / whole
        found = whirl_of(shape, pairs), in_supports / whole
        return RotorMode(s, shape, *found, *flat_nodes(self.rotor.nodes), housings)

    @cached_property
    def _housing_springs(self) -> _Floats:
        """Part of the stiffness that holds housings on the ground, springs of dampers among it."""
        nodes = self.rotor.nodes.items()
        places = [at for name, own in nodes if name.startswith("housing ") for at in own.values()]
        block, found = np.ix_(places, places), np.zeros_like(self.rotor.stiffness)
        if places:
            found[block] = self.rotor.stiffness[block]
        for mount in self.rotor.bearings:
            if isinstance(mount.bearing, LinearBearing) and set(mount.ends[0]) <= set(places):
                rows = mount.rows(self.rotor.size)
                found += rows.T @ mount.bearing.at(abs(self.speed_rpm))[0] @ rows
        return found

    @cached_property
    def _exact(self) -> tuple[_Complex, _Complex] | None:
        """Eigenvalues and shapes on contacts that all have states; those of many balls are too many."""
        spaces = [contact.space for contact in self.contacts if isinstance(contact, LinearElement)]
        if self.balls or len(spaces) < len(self.contacts):
            return None
        return eigenmodes(self.matrices, self._rows, spaces)

    def _root(
        self, s: complex, q: _Complex, roots: list[tuple[complex, _Complex]]
    ) -> list[tuple[complex, _Complex]]:
        """The root near a mode without damping, none of those found; nothing where damping leaves fewer modes."""
        values, vectors = eigenvectors(self.matrices, self.support_impedance(1j * s.imag), s.imag)
        for k in np.argsort(mode_distance(s, q, values, vectors))[:CANDIDATES].tolist():
            for root, shape in self._near(complex(values[k]), vectors[:, k]):
                if is_new(root, shape, roots):
                    return [(root, shape)]
        if len(values) < self.rotor.size:
            return []
        raise ConvergenceError(f"mode near {s.imag / (2.0 * np.pi):.4g} Hz not found", None)

    def _near(self, s: complex, q: _Complex) -> list[tuple[complex, _Complex]]:
        """Roots near one of frozen bearings: of one eigenvalue problem, or by Newton's method."""
        if self._exact is None:
            by_steps = self.contacts or self.signed_damping or self.lossless
            tolerance = CONVERGED_BY_STEPS if by_steps else CONVERGED
            return [refine_root(self.dynamic_stiffness, s, q, tolerance)]
        values, vectors = self._exact
        off = np.abs(values - s)
        near = [j for j in np.argsort(off).tolist() if off[j] < NEAR * abs(s)]
        return [(complex(values[j]), vectors[:, j]) for j in near]


@takes(rotor=Object(Rotor, "a Rotor"), speed_rpm=parts.SPEEDS)
def linearise(
    rotor: Rotor,
    speed_rpm: float | None = None,
    *,
    passage: bool = True,
    signed_damping: bool = False,
) -> LinearRotor:
    """Linearise a rotor about static equilibrium under its load.

    A bearing warns, once, where its elements leave out damping below zero under its oil supply
    (docs/oil_supply.md): decrements are too high then. `signed_damping` has it.

    Parameters
    ----------
    rotor : Rotor
        Its contacts are elements in SI, or impedances over omega [rad/s] to N/m, as `film_impedance` and
        `impedance_about` make them.
    speed_rpm : float, optional
        Of the shaft, for films, centrifugal and gyroscopic forces; by default that of the rotor. Below 0 it turns
        from y to x: bearings do not tell the directions apart, gyroscopic forces do. At 0 ball bearings are dry:
        without rolling there is no film.
    passage : bool
        Ball bearings as means over a ball passage (as in `BallBearing.coefficients`, the load of a bearing being
        that with the balls as mounted); or with the balls as mounted.
    signed_damping : bool
        Ball bearings under an oil supply with the impedance of their solved contacts, from the atlas, in place of
        their elements, which have no damping below zero: modes, growth, `stable` and responses then have it.
        Flooded bearings stay the same.

    Raises
    ------
    InputError
        A speed or a load that a bearing does not take, a contact without impedance; a speed below 0 of a rotor
        with parts that are for one direction of it: contacts, linear bearings, cross-coupled stiffness.
    ConvergenceError
        The supports do not hold the rotor.
    """
    require_instance("rotor", rotor, Rotor, "a Rotor")
    speed_rpm = rotor.speed_rpm if speed_rpm is None else speed_rpm
    if speed_rpm is None:
        raise InputError("speed_rpm", None, "given: that of the shaft")
    speed = require_finite("speed_rpm", speed_rpm)
    if speed < 0.0:
        rotor.require_either_way(speed)
    if speed == 0.0:
        rotor = rotor.dry
    mounted, bearings = rotor.contacts, rotor.ball_bearings
    known, rolling = all(_is_impedance(mount.contact) for mount in mounted), abs(speed)
    rest = np.zeros(rotor.size) if mounted and known and not bearings else rotor.equilibrium(rolling)
    require_held(rotor.mounts, rest, rotor.matrices(rolling * RPM_TO_RAD_S)[2], rolling)
    rotor = _with_linear_dampers(rotor, rest)
    points, normals, _ = rotor.geometry
    r = normals @ (points @ rest)
    parts = [
        _linear_bearing(mount, rolling, r[columns], passage, signed_damping)
        for columns, mount in zip(rotor.ball_columns, bearings, strict=True)
    ]
    names, words = rotor.ball_bearing_names, tuple("" if signed_damping else one for _, _, one, _ in parts)
    beyond = (
        beyond_loads(mount.ball_bearing, name, rolling, largest)
        for mount, name, (*_, largest) in zip(bearings, names, parts, strict=True)
    )
    reservation = "; ".join(text for both in beyond for texts in both for text in texts)
    for mount, name, left_out in zip(bearings, names, words, strict=True):
        warn_of_damping_left_out(mount.ball_bearing, name, left_out)
    return LinearRotor(
        rotor,
        speed,
        passage,
        rest,
        np.array([load for load, *_ in parts]) if parts else np.zeros((0, 2)),
        tuple(_linear_contact(mount, float(u) + mount.offset) for mount, u in zip(mounted, r, strict=False)),
        tuple(balls for _, balls, *_ in parts),
        words,
        signed_damping,
        reservation,
    )


def _with_linear_dampers(rotor: Rotor, rest: _Floats) -> Rotor:
    """The rotor with each damper as a linear bearing about the place of its journal."""
    if not rotor.film_dampers:
        return rotor
    names = iter(bearing_names(rotor.mounts))
    mounts: list[Mount] = []
    for mount in rotor.mounts:
        name = next(names) if isinstance(mount, BearingMount) else ""
        if isinstance(mount, BearingMount) and is_damper(mount):
            about = mount.damper.linear(mount.rows(rotor.size) @ rest)
            mounts.append(replace(mount, bearing=about, name=name))
        else:
            mounts.append(mount)
    return replace(rotor, mounts=tuple(mounts))


def _is_impedance(contact: object) -> bool:
    return callable(contact) and not isinstance(contact, ContactElement)


def _linear_contact(mount: ContactMount, approach: float) -> LinearElement | ContactImpedance:
    """A contact about the approach at which it rests."""
    contact = mount.contact
    if isinstance(contact, ContactElement):
        return LinearElement(contact.state_space(float(contact.spring(approach))), mount.count)
    if not _is_impedance(contact):
        raise InputError(
            "contacts", type(contact).__name__, "elements, or impedances over omega: see film_impedance"
        )
    return ContactImpedance(contact, mount.count)


def _linear_bearing(
    mount: BearingMount, speed: float, ring: _Floats, passage: bool, signed: bool
) -> tuple[_Floats, LinearBalls, str, _Floats]:
    """Static force on the inner ring, linear bearing about it, damping left out in words, largest ball forces."""
    bearing, rpm, ring = mount.ball_bearing, mount.ball_bearing.speed(speed), ring + mount.shift
    held = equilibrium_at(static_ring(bearing, rpm, mount.cage_angle, ring.size), ring)
    force, loaded = held.load, np.linalg.norm(held.load) >= UNLOADED * held.force.max()
    places = [held]
    if passage:
        rings = [static_ring(bearing, rpm, angle, ring.size) for angle in cage_angles(bearing, force[:2], None)]
        places = [
            ring_equilibrium(static, force, first=ring) if loaded else equilibrium_at(static, ring)
            for static in rings
        ]
    largest = np.max([place.force.max(axis=0) for place in places], axis=0)
    return force, *linear_bearing(bearing, rpm, places, signed), largest


def linear_bearing(
    bearing: BallBearing, speed: float, places: Sequence[RingEquilibrium], signed: bool
) -> tuple[LinearBalls, str]:
    """A bearing about static equilibrium at positions of its cage, and the damping left out, in words.

    With `signed` contacts under an oil supply have the impedance of the solved ones.
    """
    left_out = damping_left_out(bearing, speed, np.array([balls.force for balls in places]))
    small = linear_balls(bearing, speed, list(places))
    return with_solved_contacts(bearing, speed, small, places) if signed else small, left_out
