"""A linear rotor on supports: matrices, supports, constant forces and unbalance.

    M q'' + (C + omega G) q' + K q + B^T F(B q, B q') = load + unbalance

with B q the motions at the supports and F their forces, which depend on the past where films have a memory.
Where the matrices come from does not matter: `jeffcott_rotor`, shaft and discs, ROSS, a reduction that keeps the
degrees of freedom of the supports.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import pi
from types import MappingProxyType
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import (
    as_column,
    as_numbers,
    as_rows,
    parts,
    require_finite,
    require_integer,
    require_no_others,
    shown,
)
from ehlcontact.checks.kinds import INDEX_OR_NONE, NAME, Object, Objects
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import InputError
from ehlcontact.summary import Summary, counted
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.rotor.equilibrium import equilibrium
from reduced_models.rotor.linear_bearing import LinearBearing
from reduced_models.rotor.supports import (
    BearingMount,
    ContactMount,
    Mount,
    SupportGeometry,
    bearing_columns,
    bearing_names,
    is_ball_bearing,
    is_damper,
    kind_of,
    require_contact,
    support_geometry,
    support_rows,
)

_Floats = NDArray[np.float64]
Matrices = tuple[_Floats, _Floats, _Floats]


# m of a centre of mass: balanced rotors have some 1e-6, and no disc runs with more; and of a rotor of matrices, of
# whose degrees of freedom it is not known what each moves.
MOST_ECCENTRIC, MOST_OF_MATRICES = 0.01, 1.0
MISSED = 1e-9  # distance from wanted approaches, over the largest, that rounding may leave
SKEW = 1e-9  # of the largest stiffness, the part of it that is not symmetric: below is rounding
SYMMETRIC = 1e-6  # of the largest entry, by which matrices of another program may be off
SUM = 1e-9  # of the largest entry, by which parts may miss their sum
MATRICES = ("mass", "damping", "stiffness")


def require_unbalance(field: str, amount: float, mass: float, eccentric: float = MOST_ECCENTRIC) -> None:
    """Raise `InputError` for an unbalance [kg m] that is more than `eccentric` [m] times the mass [kg]."""
    most = eccentric * mass
    if not abs(amount) <= most:
        guess = f" (in g mm? then {1e-6 * amount:.6g} kg m)" if abs(1e-6 * amount) <= most else ""
        raise InputError(field, amount, f"at most {most:g} kg m, {1e3 * eccentric:g} mm times the mass{guess}")


class _DampingParts(dict[str, _Floats]):
    """Parts that a rotor has taken; one with another damping, made by `dataclasses.replace`, leaves them out."""

    def make(self, damping: _Floats) -> bool:
        """Whether the damping is their sum."""
        if any(part.shape != damping.shape for part in self.values()):
            return False
        return bool(np.abs(sum(self.values()) - damping).max() <= SUM * np.abs(damping).max())


class _Nodes(dict[str, Mapping[str, int]]):
    """Degrees of freedom by node; the error for a name that is missing lists those that exist."""

    def __missing__(self, name: object) -> Mapping[str, int]:
        raise InputError("node", name, f"one of {', '.join(self)}" if self else "none: the rotor has no names")


@fields_take(x=INDEX_OR_NONE, y=INDEX_OR_NONE, amount=parts.UNBALANCE, phase="rad")
@dataclass(frozen=True, kw_only=True)
class Unbalance(Summary):
    """Mass times eccentricity [kg m] at two degrees of freedom; `phase` [rad] ahead of the shaft's angle.

    Parameters
    ----------
    x, y : int or None
        The two degrees of freedom, across the shaft; None: it does not move that way.
    amount : float
        Mass times eccentricity [kg m].
    phase : float
        Ahead of the angle of the shaft [rad].
    """

    x: int | None
    y: int | None
    amount: float
    phase: float = 0.0

    def __post_init__(self) -> None:
        require_finite("amount", self.amount)
        if abs(require_finite("phase", self.phase)) > 2.0 * pi:
            raise InputError("phase", self.phase, "between -2 pi and 2 pi; angles are in radians")


@fields_take(name=NAME, unit=NAME, text=NAME, value=parts.ANY, parts=Object(Mapping, "a mapping"), reason=NAME)
@dataclass(frozen=True, kw_only=True, eq=False)
class Parameter(Summary):
    """A number that is a factor of constant matrices; mass, damping, stiffness and load are sums of such products.

    An FMU of the rotor has it as a parameter.

    Parameters
    ----------
    name, unit, text : str
        Of the parameter; the unit as FMI writes it.
    value : float
    parts : mapping of str to ndarray
        What it is multiplied with in "mass", "damping" and "stiffness", shape (N, N), and "load", shape (N,).
    positive, signed : bool
        Whether it must be > 0, or may be < 0.
    reason : str
        Message for a value outside this range.
    """

    name: str
    unit: str
    text: str
    value: float
    parts: Mapping[str, _Floats] = field(default_factory=dict)
    positive: bool = False
    signed: bool = False
    reason: str = ""

    def __post_init__(self) -> None:
        require_no_others(self.parts, (*MATRICES, "load"), "parts.")
        for name, part in self.parts.items():
            if as_numbers(f"parts.{name}", part).ndim != (1 if name == "load" else 2):
                raise InputError(f"parts.{name}", "a number", "of shape (N, N), of load (N,)")
        if not self.reason:
            allowed = f"finite and {'>' if self.positive else '>='} 0"
            object.__setattr__(self, "reason", f"{self.name} must be {allowed}")


@fields_take(
    mounts=Objects((BearingMount, ContactMount), "a BearingMount or ContactMount"),
    unbalances=Objects(Unbalance, "an Unbalance"), parameters=Objects(Parameter, "a Parameter"),
    load=parts.FORCE, speed_rpm=parts.SPEED_OR_NONE,
)  # fmt: skip
@dataclass(frozen=True, kw_only=True, eq=False)
class Rotor(Summary):
    """A linear rotor on supports, SI units.

    Parameters
    ----------
    mass, stiffness : array_like, shape (N, N)
        Without the supports; the stiffness may leave the rotor free.
    damping, gyroscopic : array_like, shape (N, N), optional
        The damping force is ``(damping + omega gyroscopic) q'`` at the speed omega [rad/s].
    damping_by_part : mapping of str to array_like, shape (N, N), optional
        What the damping is the sum of, by name, as ``{"shaft": ..., "housing 0": ...}``: rows of a damping budget.
        `dataclasses.replace` with another damping leaves them out.
    mounts : tuple of BearingMount or ContactMount
        Its supports.
    load : array_like, shape (N,), optional
        Constant forces [N], weight for one.
    unbalances : tuple of Unbalance
    nodes : mapping of str to mapping of str to int, optional
        Degrees of freedom by node and direction, as ``{"disc": {"x": 4, "y": 5}}``.
    speed_rpm : float, optional
        At which it runs unless another speed is given [rev/min].
    parameters : tuple of Parameter
        Of which mass, damping and stiffness are sums, as of `jeffcott_rotor`; by default none.

    Raises
    ------
    InputError
        Matrices that do not fit together, a damping that is not the sum of its parts, or a degree of freedom that
        is not there or taken.
    """

    mass: _Floats
    stiffness: _Floats
    mounts: tuple[Mount, ...]
    damping: _Floats = None  # type: ignore[assignment]
    gyroscopic: _Floats = None  # type: ignore[assignment]
    load: _Floats = None  # type: ignore[assignment]
    unbalances: tuple[Unbalance, ...] = ()
    nodes: Mapping[str, Mapping[str, int]] = field(default_factory=dict)
    speed_rpm: float | None = None
    parameters: tuple[Parameter, ...] = ()
    damping_by_part: Mapping[str, _Floats] = field(default_factory=dict)

    def _summary_lines(self) -> list[str]:
        bearings = [kind_of(mount.bearing) for mount in self.bearings if not is_damper(mount)]
        dampers = [kind_of(mount.bearing) for mount in self.film_dampers]
        contacts = self.contacts
        on = [f"{counted(len(bearings), 'bearing')}: {', '.join(bearings)}"] if bearings else []
        on += [counted(len(dampers), "squeeze film damper")] if dampers else []
        on += [counted(len(contacts), "contact")] if contacts else []
        amounts = ", ".join(f"{1e6 * abs(unbalance.amount):.4g}" for unbalance in self.unbalances)
        speed = "" if self.speed_rpm is None else f", {self.speed_rpm:.5g} rev/min"
        return [
            f"{len(self.mass)} degrees of freedom on {' and '.join(on)}{speed}",
            f"nodes {', '.join(self.nodes)}" if self.nodes else "nodes without names",
            f"unbalances {amounts} g mm" if amounts else "no unbalance",
        ]

    def __post_init__(self) -> None:
        size = len(np.atleast_1d(as_numbers("mass", self.mass)))
        for name in ("mass", "stiffness", "damping", "gyroscopic"):
            given = getattr(self, name)
            if given is None and name == "stiffness":
                raise InputError(name, None, f"a matrix of shape ({size}, {size}); zeros of a rotor that is free")
            matrix = as_rows(name, np.zeros((size, size)) if given is None else given, size, size)
            object.__setattr__(self, name, matrix)
            if matrix.shape != (size, size):
                raise InputError(f"shape of {name}", matrix.shape, f"({size}, {size}), as that of mass")
        for name, sign, kind in (("mass", 1.0, "symmetric"), ("gyroscopic", -1.0, "skew symmetric")):
            matrix = getattr(self, name)
            apart = np.abs(matrix - sign * matrix.T).max()
            if apart > SYMMETRIC * np.abs(matrix).max():
                raise InputError(name, f"a matrix off by {apart:.3g}", f"{kind}, as inertia makes it")
        if np.linalg.eigvalsh(0.5 * (self.mass + self.mass.T)).min() <= 0.0:
            raise InputError(
                "mass", "a matrix that is not positive definite", "one with inertia in every direction"
            )
        load = as_column("load", np.zeros(size) if self.load is None else self.load, size=size)
        object.__setattr__(self, "load", load)
        self._check_mounts()
        for i, unbalance in enumerate(self.unbalances):
            self._require_there(f"unbalances[{i}]", (unbalance.x, unbalance.y))
            whole = float(np.trace(self.mass))
            require_unbalance(f"unbalances[{i}].amount", unbalance.amount, whole, MOST_OF_MATRICES)
        if not isinstance(self.nodes, Mapping) or not all(
            isinstance(name, str) and isinstance(at, Mapping) and all(isinstance(key, str) for key in at)
            for name, at in self.nodes.items()
        ):
            raise InputError("nodes", shown(self.nodes), 'as {"disc": {"x": 4, "y": 5}}')
        named = {name: MappingProxyType(dict(at)) for name, at in self.nodes.items()}
        object.__setattr__(self, "nodes", MappingProxyType(_Nodes(named)))
        for name, at in named.items():
            self._require_there(f"nodes[{name!r}]", tuple(at.values()))
        self._check_parameters()
        self._check_damping()

    def _check_damping(self) -> None:
        """Raise `InputError` for parts of which the damping is not the sum."""
        own = self.damping_by_part
        if not isinstance(own, Mapping) or not all(isinstance(name, str) for name in own):
            raise InputError("damping_by_part", shown(own), 'as {"shaft": matrix}')
        if isinstance(own, _DampingParts) and not own.make(self.damping):
            own = {}
        fields = {name: f"damping_by_part[{name!r}]" for name in own}
        parts = {name: as_rows(fields[name], part, self.size, self.size) for name, part in own.items()}
        for name, part in parts.items():
            if part.shape != self.damping.shape:
                raise InputError(f"shape of {fields[name]}", part.shape, f"{self.damping.shape}, as that of mass")
        kept = _DampingParts(parts)
        if parts and not kept.make(self.damping):
            apart = np.abs(sum(parts.values()) - self.damping).max()
            allowed = "parts whose sum is the damping, or none"
            raise InputError("damping_by_part", f"parts off by {apart:.3g}", allowed)
        object.__setattr__(self, "damping_by_part", kept)

    def _check_parameters(self) -> None:
        """Raise `InputError` for parameters of which the matrices are not the sums."""
        for name in MATRICES if self.parameters else ():
            parts = (own.value * own.parts[name] for own in self.parameters if name in own.parts)
            if not np.allclose(sum(parts), getattr(self, name), rtol=1e-12, atol=0.0):
                names = ", ".join(own.name for own in self.parameters)
                raise InputError(name, "another matrix", f"the sum of the parts of {names}; or no parameters")

    def _check_mounts(self) -> None:
        if not self.mounts:
            raise InputError("mounts", (), "at least one support")
        taken: list[tuple[Any, ...]] = []
        for i, mount in enumerate(self.mounts):
            for end in mount.ends:
                self._require_there(f"mounts[{i}]", end)
            if isinstance(mount, BearingMount):
                self._require_still(i, mount)
                place = (*mount.ends[0], mount.arm, mount.name, is_damper(mount))
                if place in taken:
                    allowed = "at degrees of freedom that no other bearing has, or with a name of its own"
                    raise InputError(f"mounts[{i}]", mount.ends[0], allowed)
                taken.append(place)

    def _require_still(self, i: int, mount: BearingMount) -> None:
        """Raise `InputError` for a bearing whose outer ring turns in a rotor whose shaft turns."""
        turning = getattr(mount.bearing, "turning", "inner")
        if turning != "inner" and (self.unbalances or self.gyroscopic.any()):
            what = "gyroscopic moments" if self.gyroscopic.any() else "unbalances"
            allowed = f'"inner" in a rotor with {what}: its shaft turns at the speed of one ring against the other'
            raise InputError(f"mounts[{i}].bearing.turning", turning, allowed)

    def require_either_way(self, speed_rpm: float) -> None:
        """Raise `InputError`, of a speed below 0, for a rotor with parts that are for one direction of it."""
        linear = any(isinstance(mount.bearing, LinearBearing) for mount in self.bearings)
        K = self.stiffness
        if linear or self.contacts or np.abs(K - K.T).max() > SKEW * np.abs(K).max():
            allowed = ">= 0 for a rotor with contacts, linear bearings or cross-coupled stiffness"
            raise InputError("speed_rpm", speed_rpm, f"{allowed}: they are for one direction of the speed")

    def _require_there(self, field: str, places: tuple[Any, ...]) -> None:
        """Raise `InputError` for degrees of freedom that do not exist, or of which two are one."""
        allowed = f"two different degrees of freedom from 0 to {self.size - 1}"
        given = [place for place in places if place is not None]
        for value in given:
            if require_integer(field, value, allowed, 0) >= self.size:
                raise InputError(field, places, allowed)
        if len(set(given)) < max(len(given), 1):
            raise InputError(field, places, allowed)

    def on(self, contacts: Sequence[Any]) -> Self:
        """The rotor with these contacts in its mounts.

        Parameters
        ----------
        contacts : sequence
            One per `ContactMount`, in SI: elements, full films (`TransientContact`), or impedances for linear
            responses.

        Raises
        ------
        InputError
            Not one contact per mount; what is no contact.
        """
        if not isinstance(contacts, list | tuple):
            raise InputError("contacts", shown(contacts), "a list of contacts, one per mount")
        if len(contacts) != len(self.contacts):
            raise InputError("contacts", len(contacts), f"one per mount, {len(self.contacts)}")
        for k, contact in enumerate(contacts):
            require_contact(f"contacts[{k}]", contact)
        others = iter(contacts)
        return replace(
            self,
            mounts=tuple(
                replace(mount, contact=next(others)) if isinstance(mount, ContactMount) else mount
                for mount in self.mounts
            ),
        )

    @property
    def size(self) -> int:
        """Number of degrees of freedom."""
        return len(self.mass)

    @property
    def damping_parts(self) -> dict[str, _Floats]:
        """Parts of the damping by name: as given, or of the `parameters`; else the "rotor" alone."""
        named = {own.name: own.value * own.parts["damping"] for own in self.parameters if "damping" in own.parts}
        parts = dict(self.damping_by_part) or named or {"rotor": self.damping}
        return {name.replace("_", " "): part for name, part in parts.items() if part.any()}

    @property
    def support_rows(self) -> _Floats:
        """Motions of all supports from the displacements of the rotor, shape (directions of all supports, N)."""
        return support_rows(self.mounts, self.size)

    @property
    def contacts(self) -> tuple[ContactMount, ...]:
        """Supports that are contacts."""
        return tuple(mount for mount in self.mounts if isinstance(mount, ContactMount))

    @property
    def bearings(self) -> tuple[BearingMount, ...]:
        """Supports that are bearings or dampers."""
        return tuple(mount for mount in self.mounts if isinstance(mount, BearingMount))

    @property
    def ball_bearings(self) -> tuple[BearingMount, ...]:
        """Supports that are ball bearings."""
        return tuple(mount for mount in self.bearings if is_ball_bearing(mount))

    @property
    def ball_bearing_names(self) -> tuple[str, ...]:
        """Names of `ball_bearings`."""
        rows = zip(self.bearings, bearing_names(self.bearings), strict=True)
        return tuple(name for mount, name in rows if is_ball_bearing(mount))

    @property
    def film_dampers(self) -> tuple[BearingMount, ...]:
        """Supports that are squeeze film dampers."""
        return tuple(mount for mount in self.bearings if is_damper(mount))

    @property
    def film_damper_names(self) -> tuple[str, ...]:
        """Names of `film_dampers`."""
        rows = zip(self.bearings, bearing_names(self.bearings), strict=True)
        return tuple(name for mount, name in rows if is_damper(mount))

    @cached_property
    def geometry(self) -> SupportGeometry:
        """Where contacts, then ball bearings, then dampers act; linear bearings are in `matrices`."""
        return support_geometry(self.contacts, (*self.ball_bearings, *self.film_dampers), self.size)

    @property
    def ball_columns(self) -> tuple[slice, ...]:
        """Where the directions of each ball bearing are among the motions of `geometry`."""
        return bearing_columns(self.contacts, self.ball_bearings)

    @property
    def film_damper_columns(self) -> tuple[slice, ...]:
        """Where the directions of each damper are among these motions."""
        columns = bearing_columns(self.contacts, (*self.ball_bearings, *self.film_dampers))
        return columns[len(self.ball_bearings) :]

    @property
    def changes_with_speed(self) -> bool:
        """Whether `matrices` depend on the speed."""
        linear = (mount.bearing for mount in self.bearings if isinstance(mount.bearing, LinearBearing))
        tables = (bearing for bearing in linear if bearing.speeds_rpm is not None)
        return bool(self.gyroscopic.any()) or any(True for _ in tables)

    @property
    def turning_unbalance(self) -> NDArray[np.complex128]:
        """Amplitudes a of the unbalances on the freedoms, shape (N,) [kg m]: forces are Re(w^2 a exp(i w t))."""
        found = np.zeros(self.size, complex)
        for unbalance in self.unbalances:
            amplitude = unbalance.amount * np.exp(1j * unbalance.phase)
            for place, share in ((unbalance.x, 1.0), (unbalance.y, -1j)):
                if place is not None:
                    found[place] += amplitude * share
        return found

    @takes(omega=parts.ANY)
    def matrices(self, omega: float) -> Matrices:
        """Mass, damping with the gyroscopic part, and stiffness at a speed [rad/s], linear bearings added."""
        damping = self.damping + omega * self.gyroscopic
        stiffness = self.stiffness
        for mount in self.bearings:
            if isinstance(mount.bearing, LinearBearing):
                rows = mount.rows(self.size)
                K, C = mount.bearing.at(omega / RPM_TO_RAD_S)
                stiffness, damping = stiffness + rows.T @ K @ rows, damping + rows.T @ C @ rows
        return self.mass, damping, stiffness

    @property
    def dry(self) -> Self:
        """The rotor on ball bearings without oil, as they are while the shaft stands still."""
        mounts = [
            replace(mount, bearing=mount.bearing.dry)
            if isinstance(mount, BearingMount) and isinstance(mount.bearing, BallBearing)
            else mount
            for mount in self.mounts
        ]
        return replace(self, mounts=tuple(mounts))

    @takes(speed_rpm=parts.SPEEDS._replace(zero=True))
    def equilibrium(self, speed_rpm: float = 0.0) -> _Floats:
        """Displacements in static equilibrium under the load, films as at a speed, shape (N,) [m].

        Raises
        ------
        InputError
            A speed that a bearing does not take, a contact without static law.
        ConvergenceError
            The supports do not hold it; ``result`` is the last displacement.
        """
        _, _, stiffness = self.matrices(speed_rpm * RPM_TO_RAD_S)
        return equilibrium(self.mounts, self.load, stiffness, speed_rpm)

    def approaches(self, displacements: ArrayLike) -> _Floats:
        """Approach of every contact at displacements of shape (N,), shape (contacts,) [m]."""
        moved = self._contact_rows @ as_column("displacements", displacements, size=self.size)
        return np.asarray(moved + self._offsets)

    def rest_at(self, approaches: ArrayLike) -> _Floats:
        """Displacements at rest with given approaches of the contacts, the rotor bent by the load, shape (N,) [m].

        Raises
        ------
        InputError
            Not one approach per contact, approaches that no displacement gives, or a rotor that they do not hold.
        """
        wanted = as_column("approaches", approaches, size=len(self.contacts))
        held = sorted({place for mount in self.contacts for place in mount.ends[0] if place is not None})
        rows, moved = self._contact_rows[:, held], wanted - self._offsets
        q = np.zeros(self.size)
        q[held] = np.linalg.lstsq(rows, moved)[0]
        miss = float(np.abs(rows @ q[held] - moved).max(initial=0.0))
        if miss > MISSED * float(np.abs(wanted).max(initial=0.0)):
            allowed = f"reachable by one position of the rotor (off by {miss:.3g} m)"
            raise InputError("approaches", approaches, allowed)
        free, stiffness = np.setdiff1d(np.arange(self.size), held), self.matrices(0.0)[2]
        bent = stiffness[np.ix_(free, free)]
        if free.size and np.linalg.matrix_rank(bent) < free.size:
            raise InputError("approaches", approaches, "left out: contacts alone do not hold this rotor")
        q[free] = np.linalg.solve(bent, (self.load - stiffness @ q)[free])
        return q

    @takes(speed_rpm=parts.SPEEDS._replace(zero=True))
    def check_contacts(self, speed_rpm: float | None = None) -> None:
        """Let elements warn, once each, whose band does not hold a speed, or that were made for other contacts.

        The points of the mounts count. `simulate_rotor` and `fmu.export` call it.

        Parameters
        ----------
        speed_rpm : float, optional
            By default that of the rotor.
        """
        speed = self.speed_rpm if speed_rpm is None else speed_rpm
        for mount in self.contacts:
            check = getattr(mount.contact, "check", None)
            if check is not None:
                omega = speed * RPM_TO_RAD_S if speed else None
                check(mount.point, omega=omega)

    @property
    def _contact_rows(self) -> _Floats:
        """Approaches but for offsets from the displacements, shape (contacts, N)."""
        return support_rows(self.contacts, self.size) if self.contacts else np.zeros((0, self.size))

    @property
    def _offsets(self) -> _Floats:
        return np.array([mount.offset for mount in self.contacts])
