"""Jeffcott rotor on contacts, by its parameters: a constructor of `Rotor`. SI units.

Four degrees of freedom: disc (x, y) and journal (x, y), y upwards. Both bearings are taken as identical and
move as one, so one journal stands for both: its mass is that of the two journals, and the contacts of one
bearing push on it ``bearings`` times.

    m_d q_d'' + d_d q_d' + c_s (q_d' - q_j') + k_s (q_d - q_j) = m_d g + W + m_e omega^2 (cos, sin)(omega t)
    m_j q_j'' - c_s (q_d' - q_j') - k_s (q_d - q_j)            = m_j g - bearings sum_i F_i n_i
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import cos, pi, sin
from typing import Any, Self

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import (
    as_column,
    require_choice,
    require_integer,
    require_nonnegative,
    require_positive,
)
from ehlcontact.checks.quantity import fields_take
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.point import Point
from ehlcontact.summary import Summary
from reduced_models.rotor.rotor import Rotor, Unbalance, require_unbalance
from reduced_models.rotor.supports import ContactMount

_Floats = NDArray[np.float64]

BODIES = ("disc", "journal")
DOWN = -pi / 2.0  # direction of gravity [rad]
REACHED = 1e-9  # distance from wanted approaches, over the largest, that rounding may leave


@dataclass(frozen=True, eq=False)
class RotorState(Summary):
    """Positions [m] and velocities [m/s] of disc and journal, each of shape (2,).

    Attributes
    ----------
    disc, journal : ndarray, shape (2,)
        Positions [m].
    disc_velocity, journal_velocity : ndarray, shape (2,)
        [m/s].
    """

    disc: _Floats
    journal: _Floats
    disc_velocity: _Floats
    journal_velocity: _Floats

    def _summary_lines(self) -> list[str]:
        disc, journal = (1e6 * q for q in (self.disc, self.journal))
        fast = [1e3 * float(np.hypot(*v)) for v in (self.disc_velocity, self.journal_velocity)]
        return [
            f"disc at ({disc[0]:.4g}, {disc[1]:.4g}) µm, journal at ({journal[0]:.4g}, {journal[1]:.4g}) µm",
            f"moving at {fast[0]:.4g} and {fast[1]:.4g} mm/s",
        ]

    def __post_init__(self) -> None:
        for name in ("disc", "journal", "disc_velocity", "journal_velocity"):
            object.__setattr__(self, name, as_column(name, getattr(self, name), size=2))


@fields_take(
    disc_mass="kg", journal_mass="kg", shaft_stiffness="N/m", shaft_damping="N s/m", disc_damping="N s/m",
    unbalance="kg m", speed_rpm="rev/min", gravity="m/s2", load="N",
)  # fmt: skip
@dataclass(frozen=True, kw_only=True)
class JeffcottRotor(Summary):
    """Jeffcott rotor on contacts, after the equations at the head of this module.

    On ball bearings, with a disc anywhere, gyroscopic moments or housings: `rotor_on_bearings`.

    Parameters
    ----------
    disc_mass, journal_mass : float
        Of the disc, and of both journals together [kg].
    shaft_stiffness, shaft_damping : float
        Between disc and journal [N/m], [N s/m]; the damping acts in the fixed frame (external).
    disc_damping : float
        From the disc to the ground [N s/m].
    unbalance : float
        Mass times eccentricity of the disc [kg m].
    speed_rpm : float
        Constant speed [rev/min].
    gravity : (float, float)
        Acceleration [m/s^2].
    load : (float, float)
        Constant force on the disc [N], to bring the contacts to the load they were reduced at.
    mounts : tuple of ContactMount
        Contacts of one bearing.
    bearings : int
        How many identical bearings carry the rotor.
    directions : {"xy", "y"}
        With "y", disc and journal move in y only.

    Raises
    ------
    InputError
        A value outside its range; the message names it.
    """

    disc_mass: float
    journal_mass: float
    shaft_stiffness: float
    mounts: tuple[ContactMount, ...]
    shaft_damping: float = 0.0
    disc_damping: float = 0.0
    unbalance: float = 0.0
    speed_rpm: float = 0.0
    gravity: tuple[float, float] = (0.0, -9.81)
    load: tuple[float, float] = (0.0, 0.0)
    bearings: int = 2
    directions: str = "xy"

    def _summary_lines(self) -> list[str]:
        alone = np.sqrt(self.shaft_stiffness / self.disc_mass) / (2.0 * pi)
        x, y = self.static_load.tolist() if self.static_load.size == 2 else (0.0, float(self.static_load[-1]))
        return [
            f"disc {self.disc_mass:.4g} kg, journals {self.journal_mass:.4g} kg, {self.speed_rpm:.5g} rev/min",
            f"shaft {1e-6 * self.shaft_stiffness:.4g} N/µm: {alone:.4g} Hz on rigid bearings",
            f"bearings: {self.bearings}, contacts in each: {len(self.mounts)}, moving in {self.directions}",
            f"static load ({x:.4g}, {y:.4g}) N, unbalance {1e6 * self.unbalance:.4g} g mm",
        ]

    def __post_init__(self) -> None:
        for name in ("disc_mass", "journal_mass", "shaft_stiffness"):
            require_positive(name, getattr(self, name))
        for name in ("shaft_damping", "disc_damping", "unbalance", "speed_rpm"):
            require_nonnegative(name, getattr(self, name))
        require_unbalance("unbalance", self.unbalance, self.disc_mass)
        for name in ("gravity", "load"):
            object.__setattr__(self, name, tuple(as_column(name, getattr(self, name), size=2).tolist()))
        require_choice("directions", self.directions, ("xy", "y"))
        bearings = require_integer("bearings", self.bearings, "a whole number >= 1", 1)
        object.__setattr__(self, "bearings", bearings)
        object.__setattr__(self, "mounts", tuple(self.mounts))
        if not self.mounts or not all(isinstance(mount, ContactMount) for mount in self.mounts):
            raise InputError("mounts", self.mounts, "at least one ContactMount")

    @classmethod
    def vertical(cls, *, offset: float = 0.0, point: Point | None = None, **parameters: Any) -> Self:
        """Rotor that moves in y only, above a single contact: the smallest system with a shaft in it.

        Parameters
        ----------
        offset : float
            Approach with the journal at the origin [m].
        point : OperatingPoint or MoesPoint, optional
            The contact, as for `ContactMount`.
        **parameters
            As for the class; ``bearings`` is 1 unless given.
        """
        defaults: dict[str, Any] = {"bearings": 1, "directions": "y"}
        return cls(mounts=(ContactMount(DOWN, offset, point),), **(defaults | parameters))

    @classmethod
    def vee(cls, *, half_angle: float, offset: float = 0.0, point: Point | None = None, **parameters: Any) -> Self:
        """Rotor in two contacts at +-`half_angle` [rad] from straight below, like two balls of a bearing."""
        if not 0.0 < require_positive("half_angle", half_angle) < pi / 2.0:
            raise InputError("half_angle", half_angle, "between 0 and pi/2")
        mounts = tuple(ContactMount(DOWN + angle, offset, point) for angle in (-half_angle, half_angle))
        return cls(mounts=mounts, **parameters)

    @property
    def omega(self) -> float:
        """Speed [rad/s]."""
        return self.speed_rpm * pi / 30.0

    @property
    def axes(self) -> tuple[int, ...]:
        """Directions that move: 0 for x, 1 for y."""
        return (0, 1) if self.directions == "xy" else (1,)

    @property
    def normals(self) -> _Floats:
        """Unit normals of the contacts along the directions that move, shape (contacts, directions)."""
        return np.array([mount.normal[list(self.axes)] for mount in self.mounts])

    @property
    def offsets(self) -> _Floats:
        """Offsets of the contacts [m], shape (contacts,)."""
        return np.array([mount.offset for mount in self.mounts])

    @property
    def disc_load(self) -> _Floats:
        """Static force on the disc [N] along the directions that move."""
        return (self.disc_mass * np.array(self.gravity) + np.array(self.load))[list(self.axes)]

    @property
    def static_load(self) -> _Floats:
        """Static force that the contacts have to carry [N] along the directions that move."""
        return self.disc_load + self.journal_mass * np.array(self.gravity)[list(self.axes)]

    def matrices(self) -> tuple[_Floats, _Floats, _Floats]:
        """Mass, damping and stiffness without contacts; order: disc, then journal, along the moving axes."""
        one, coupling = np.eye(len(self.axes)), np.array([[1.0, -1.0], [-1.0, 1.0]])
        ground = np.diag([self.disc_damping, 0.0])
        masses = np.diag([self.disc_mass, self.journal_mass])
        M, C, K = (
            np.asarray(np.kron(part, one), dtype=np.float64)
            for part in (masses, self.shaft_damping * coupling + ground, self.shaft_stiffness * coupling)
        )
        return M, C, K

    def applied_force(self, t: float) -> _Floats:
        """Static load and unbalance at time `t` [s], in the order of `matrices`."""
        angle, unbalance_force = self.omega * t, self.unbalance * self.omega**2
        rotating = unbalance_force * np.array([cos(angle), sin(angle)])[list(self.axes)]
        return np.concatenate([self.disc_load + rotating, self.static_load - self.disc_load])

    def approaches(self, journal: ArrayLike) -> _Floats:
        """Approach of every contact [m] with the journal at `journal`, shape (2,)."""
        return self.normals @ as_column("journal", journal, size=2)[list(self.axes)] + self.offsets

    def state_at(self, approaches: ArrayLike) -> RotorState:
        """State at rest with given approaches of the contacts [m], the shaft bent by the static load.

        Raises
        ------
        InputError
            Not one approach per contact, or approaches that no position of the journal gives.
        """
        wanted = as_column("approaches", approaches, size=len(self.mounts))
        position: _Floats = scipy.linalg.lstsq(self.normals, wanted - self.offsets)[0]
        miss = float(np.abs(self.normals @ position + self.offsets - wanted).max())
        if miss > REACHED * float(np.abs(wanted).max()):
            raise InputError("approaches", approaches, f"reachable by one journal position (off by {miss:.3g} m)")
        return self.rest_state(position)

    def rest_state(self, position: _Floats) -> RotorState:
        """State at rest with the journal at `position` (moving directions only) and the shaft bent."""
        q = np.concatenate([position + self.disc_load / self.shaft_stiffness, position])
        return self._state(q, np.zeros_like(q))

    def static_forces(self) -> _Floats:
        """Force on every contact under the static load, where equilibrium alone decides it [N].

        Raises
        ------
        InputError
            More contacts than moving directions, or a load that would pull at a contact.
        """
        normals = self.normals
        if np.linalg.matrix_rank(normals) < len(self.mounts):
            raise InputError("mounts", len(self.mounts), "no more independent contacts than moving directions")
        forces: _Floats = scipy.linalg.lstsq(self.bearings * normals.T, self.static_load)[0]
        carried = self.bearings * normals.T @ forces
        if np.any(forces <= 0.0) or not np.allclose(carried, self.static_load, rtol=1e-9, atol=1e-9):
            raise InputError("static load", self.static_load.tolist(), "carried by pushing contacts")
        return forces

    @property
    def nodes(self) -> dict[str, dict[str, int]]:
        """Degrees of freedom of disc and journal by direction, in the order of `matrices`."""
        size, names = len(self.axes), ["xy"[axis] for axis in self.axes]
        return {body: {name: k * size + i for i, name in enumerate(names)} for k, body in enumerate(BODIES)}

    def on(self, contacts: Sequence[Any]) -> Rotor:
        """The rotor on contacts, as `Rotor`.

        Parameters
        ----------
        contacts : sequence
            One per mount, in SI: elements, full films in `ScaledContact`, or impedances for linear responses.

        Raises
        ------
        InputError
            Not one contact per mount.
        """
        if len(contacts) != len(self.mounts):
            raise InputError("contacts", len(contacts), f"one per mount, {len(self.mounts)}")
        M, C, K = self.matrices()
        disc, journal = (self.nodes[body] for body in BODIES)
        places: dict[str, Any] = {"x": journal.get("x"), "y": journal.get("y"), "count": self.bearings}
        turning = Unbalance(x=disc.get("x"), y=disc.get("y"), amount=self.unbalance)
        return Rotor(
            mass=M,
            damping=C,
            stiffness=K,
            mounts=tuple(
                replace(mount, contact=contact, **places)
                for mount, contact in zip(self.mounts, contacts, strict=True)
            ),
            load=np.concatenate([self.disc_load, self.static_load - self.disc_load]),
            unbalances=(turning,) if self.unbalance > 0.0 else (),
            nodes=self.nodes,
        )

    def motion(self, state: RotorState) -> tuple[_Floats, _Floats]:
        """Displacements and velocities of a state, in the order of `matrices`."""
        axes = list(self.axes)
        q = np.concatenate([state.disc[axes], state.journal[axes]])
        return q, np.concatenate([state.disc_velocity[axes], state.journal_velocity[axes]])

    def _state(self, q: _Floats, v: _Floats) -> RotorState:
        planes = np.zeros((4, 2))
        planes[:, list(self.axes)] = np.concatenate([q, v]).reshape(4, -1)
        return RotorState(*planes)

    def check(self, contacts: Sequence[Any], *, stacklevel: int = 2) -> None:
        """Let elements warn, once each, whose band does not hold this speed, or that were made for other contacts.

        The points of the mounts count. `simulate_rotor` and `static_equilibrium` call it.
        """
        omega = self.omega if self.speed_rpm > 0.0 else None
        for mount, contact in zip(self.mounts, contacts, strict=False):
            check = getattr(contact, "check", None)
            if check is not None:
                check(mount.point, stacklevel=stacklevel + 1, omega=omega)

    def static_equilibrium(self, contacts: Sequence[Any]) -> RotorState:
        """State in static equilibrium under the static load, the contacts carrying it.

        Parameters
        ----------
        contacts : sequence
            One per mount, in SI, with `TangentContact`'s ``spring`` and ``spring_tangent``; their states stay.

        Raises
        ------
        InputError
            Wrong number of contacts, a contact without static law, or no static load.
        ConvergenceError
            The contacts do not stand against the load; ``result`` is the last state.
        """
        self.check(contacts, stacklevel=3)
        if not self.static_load.any():
            raise InputError("static load", 0.0, "different from zero to press the contacts")
        try:
            q = self.on(contacts).equilibrium()
        except ConvergenceError as error:
            raise ConvergenceError(str(error), self._state(error.result, np.zeros_like(error.result))) from None
        return self._state(q, np.zeros_like(q))
