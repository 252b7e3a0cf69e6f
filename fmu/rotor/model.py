"""What the FMU of a rotor is made from: rotor, supports inside and outside, parameters, and where it starts."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import as_column, require_instance, require_nonnegative, require_positive, shown
from ehlcontact.errors import ConvergenceError, InputError
from fmu.bearing.model import BearingModel
from fmu.contact_variables import Element
from fmu.rotor.parameters import parameters_of
from fmu.steps import default_step, round_down
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.motion import LEAST_STEPS, motion_of
from reduced_models.rotor.linear_bearing import LinearBearing
from reduced_models.rotor.rotor import Parameter, Rotor
from reduced_models.rotor.squeeze_film_damper import SqueezeFilmDamper
from reduced_models.rotor.supports import (
    BearingMount,
    ContactMount,
    SupportGeometry,
    is_damper,
    support_geometry,
)

_Floats = NDArray[np.float64]

ALL = "all"  # in place of the names of all supports
MOST_BALLS = 128  # of all bearings inside: a step keeps some hundred numbers of each on the stack
MOST_SUPPORTS = 32  # two bits of a number each
MOST_FREEDOMS = 100  # of the tables, which have square matrices
MOST_INPUTS = 64  # of the core: one bit for each
LONGEST_STEP = 1e-5  # s, with ball bearings
DAMPED_STEP = 1e-4  # s, with squeeze film dampers
STEPS_PER_PERIOD = 60.0  # of the disc on its shaft against the journal, which an inner step resolves
CONTACT_NAME = re.compile(r"contact \d+")
ROUNDING = 1e-9  # of the largest entry: asymmetry of a stiffness
SPEED_LIMITED = "constant, without speeds_rpm: matrices of a rotor's FMU do not change with the speed"


@dataclass(frozen=True, eq=False)
class Station:
    """One support of the rotor.

    Attributes
    ----------
    label : str
        Of its variables: ``contact[1]``, ``bearing[1]``, ``damper[1]``.
    name : str
        By which `outside` and results of a run have it: ``contact 0``, ``bearing 0`` or the bearing's own.
    mount : BearingMount or ContactMount
    inside : bool
    """

    label: str
    name: str
    mount: Any
    inside: bool

    @property
    def is_contact(self) -> bool:
        """Whether it is a contact."""
        return isinstance(self.mount, ContactMount)

    @property
    def is_damper(self) -> bool:
        """Whether it is a squeeze film damper."""
        return is_damper(self.mount)

    @property
    def is_bearing(self) -> bool:
        """Whether it is a ball bearing."""
        return not (self.is_contact or self.is_damper)

    @property
    def kind(self) -> str:
        """Of its label and its C functions."""
        return "contact" if self.is_contact else "damper" if self.is_damper else "bearing"

    @property
    def shift(self) -> _Floats:
        """What is added to the motions that `rows` of its mount gives."""
        return np.array([self.mount.offset]) if isinstance(self.mount, ContactMount) else self.mount.shift

    @property
    def count(self) -> float:
        """How often its force acts."""
        return float(self.mount.count) if isinstance(self.mount, ContactMount) else 1.0


@dataclass(frozen=True, eq=False)
class RotorModel:
    """A rotor with supports inside and outside.

    Parameters
    ----------
    rotor : Rotor
        Linear bearings stay inside, in its matrices, and so do dampers; contacts are elements in SI, and None
        where all are outside and none is known.
    outside : str or sequence of str
        Names of the supports whose forces are inputs; "all".
    speeds_rpm : float or (float, float), optional
        Of ball bearings inside, as of `BearingModel`.
    speed_rpm : float, optional
        Speed at the start; by default that of the rotor, the highest of the tables, or 0.
    inertia : float, optional
        Polar moment of inertia [kg m2] of all that turns: the speed then follows from torques.
    start : (array_like, array_like), optional
        Displacements and velocities to start from, shape (N,) each; by default equilibrium under the load, and
        of a rotor whose contacts are not known the contacts at their offsets.
    permittivity : float, optional
        Of the oil in all ball bearings inside that have oil, as of `BearingModel`.

    Raises
    ------
    InputError
        No support, a name of none, a contact that is no element, a linear bearing whose matrices depend on the
        speed, a stiffness that is not symmetric, too many degrees of freedom, supports, balls or inputs.
    """

    rotor: Rotor
    outside: str | Iterable[str] = ()
    speeds_rpm: Any = None
    speed_rpm: float | None = None
    inertia: float | None = None
    start: Any = None
    permittivity: float | None = None

    def __post_init__(self) -> None:
        require_instance("rotor", self.rotor, Rotor, "a Rotor")
        object.__setattr__(self, "outside", outside_names(supports_of(self.rotor), self.outside))
        object.__setattr__(self, "rotor", _with_elements(self.rotor, self.outside))
        if self.inertia is not None:
            require_positive("inertia", self.inertia)
        self._check_size()
        self._check_matrices()
        if self.speeds_rpm is None and self.bearings_inside:
            names = tuple(station.name for station in self.bearings_inside)
            raise InputError("speeds_rpm", None, f"those of the ball bearings inside, or outside={names!r}")
        if self.speeds_rpm is not None and not self.bearings_inside:
            raise InputError("speeds_rpm", self.speeds_rpm, "left out: no ball bearing is inside")
        if self.permittivity is not None and not self._has_oil_inside:
            raise InputError("permittivity", self.permittivity, "left out: no ball bearing with oil is inside")
        _ = self.bearings
        require_nonnegative("speed_rpm", self.speed)
        _ = self.motion

    # ---- supports

    @cached_property
    def stations(self) -> tuple[Station, ...]:
        """Contacts, then ball bearings, then dampers, which are always inside."""
        names, rotor = supports_of(self.rotor), self.rotor
        mounts = (*rotor.contacts, *rotor.ball_bearings)
        dampers = enumerate(zip(rotor.film_damper_names, rotor.film_dampers, strict=True), start=1)
        return (
            *(
                Station(label, name, mount, name not in self.outside)
                for label, name, mount in zip(labels_of(names), names, mounts, strict=True)
            ),
            *(Station(f"damper[{k}]", name, mount, True) for k, (name, mount) in dampers),
        )

    @cached_property
    def inside(self) -> tuple[Station, ...]:
        """Stations inside, contacts first and dampers last."""
        return tuple(station for station in self.stations if station.inside)

    @cached_property
    def out(self) -> tuple[Station, ...]:
        """Stations outside, contacts first."""
        return tuple(station for station in self.stations if not station.inside)

    @property
    def stations_in_order(self) -> tuple[Station, ...]:
        """Inside before outside."""
        return self.inside + self.out

    @property
    def bearings_inside(self) -> tuple[Station, ...]:
        """Ball bearings inside."""
        return tuple(station for station in self.inside if station.is_bearing)

    @property
    def bearings_out(self) -> tuple[Station, ...]:
        """Ball bearings outside."""
        return tuple(station for station in self.out if station.is_bearing)

    @property
    def dampers(self) -> tuple[SqueezeFilmDamper, ...]:
        """Squeeze film dampers."""
        return tuple(mount.damper for mount in self.rotor.film_dampers)

    @property
    def elements(self) -> tuple[Element, ...]:
        """Contacts inside."""
        return tuple(station.mount.contact for station in self.inside if isinstance(station.mount, ContactMount))

    @cached_property
    def bearings(self) -> tuple[BearingModel, ...]:
        """Each ball bearing inside as its own FMU has it."""
        return tuple(
            BearingModel(
                station.mount.ball_bearing,
                self.speeds_rpm,
                directions=station.mount.directions,
                permittivity=None if station.mount.ball_bearing.oil is None else self.permittivity,
            )
            for station in self.bearings_inside
            if isinstance(station.mount, BearingMount)
        )

    @property
    def _has_oil_inside(self) -> bool:
        mounts = (station.mount for station in self.bearings_inside)
        return any(isinstance(one, BearingMount) and one.ball_bearing.oil is not None for one in mounts)

    @cached_property
    def geometry(self) -> SupportGeometry:
        """Where the supports inside act."""
        return _geometry(self.inside, self.rotor.size)

    @cached_property
    def held(self) -> _Floats:
        """Points at which supports outside act, which stay where they are as rest is found, shape (n, N)."""
        return _geometry(self.out, self.rotor.size).points

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Of the rotor, or factors of its matrices."""
        return parameters_of(self.rotor)

    @property
    def points(self) -> tuple[tuple[str, str, int], ...]:
        """Node, direction and degree of freedom of all named nodes."""
        return tuple((node, name, place) for node, at in self.rotor.nodes.items() for name, place in at.items())

    # ---- the start

    @property
    def speed(self) -> float:
        """Speed at the start [rev/min]."""
        for speed in (self.speed_rpm, self.rotor.speed_rpm):
            if speed is not None:
                return speed
        return float(self.bearings[0].speeds[-1]) if self.bearings else 0.0

    @cached_property
    def motion(self) -> tuple[_Floats, _Floats]:
        """Displacements and velocities at the start, shape (N,) each."""
        size = self.rotor.size
        if self.start is None:
            return self._rest(), np.zeros(size)
        try:
            q, v = self.start
        except (TypeError, ValueError):
            raise InputError("start", shown(self.start), "displacements and velocities") from None
        return as_column("displacements", q, size=size), as_column("velocities", v, size=size)

    def _rest(self) -> _Floats:
        rotor = self.rotor
        if rotor.contacts and not rotor.ball_bearings and all(one.contact is None for one in rotor.contacts):
            return rotor.rest_at([mount.offset for mount in rotor.contacts])
        if rotor.contacts and not (rotor.ball_bearings or rotor.load.any()):
            raise InputError("static load", 0.0, "different from zero to press the contacts")
        try:
            return rotor.equilibrium(self.speed)
        except ConvergenceError as error:
            if rotor.ball_bearings:
                raise
            load = f"{rotor.load.tolist()} N"
            raise InputError("contacts", str(error), f"ones that carry the static load {load}") from None

    def ring(self, station: Station) -> _Floats:
        """Place of the inner ring of a bearing at the start, or approach of a contact."""
        return np.asarray(station.mount.rows(self.rotor.size) @ self.motion[0] + station.shift, np.float64)

    def force(self, station: Station) -> _Floats:
        """Of a support outside at the start, as its own FMU gives it: of a contact, or on the inner ring."""
        ring = self.ring(station)
        if isinstance(station.mount, ContactMount):
            contact = station.mount.contact
            return np.zeros(1) if contact is None else np.array([float(contact.spring(float(ring[0])))])
        balls = motion_of(station.mount.ball_bearing, [self.speed], station.mount.directions)
        return -balls.rest(self.speed * RPM_TO_RAD_S, station.mount.cage_angle, ring)

    @cached_property
    def inner_step(self) -> float:
        """Longest step inside one of co-simulation [s]: 1, 2 or 5 times a power of ten.

        It resolves contacts; without ball bearings the shaft too, and with them 10 us, and 16 in every turn of
        the shaft and ball passage, as of `simulate_rotor`; with dampers at most 100 us.
        """
        longest = [default_step(element) for element in self.elements]
        longest += [DAMPED_STEP] if self.dampers else []
        mounts = [station.mount.ball_bearing for station in self.stations if station.is_bearing]
        if mounts:
            longest.append(LONGEST_STEP)
        else:
            longest.append(round_down(2.0 * math.pi / self.fastest / STEPS_PER_PERIOD))
        if self.bearings:
            fastest = float(self.bearings[0].speeds[-1])
            passages = [model.bearing.frequencies(fastest).bpfo for model in self.bearings]
            longest.append(round_down(1.0 / (LEAST_STEPS * max(fastest / 60.0, *passages))))
        return min(longest)

    @property
    def fastest(self) -> float:
        """Angular frequency of the fastest vibration on no supports but springs of dampers; at least 1 rad/s."""
        M, _, K = self.rotor.matrices(0.0)
        for mount in self.rotor.film_dampers:
            rows = mount.rows(self.rotor.size)
            K = K + mount.damper.stiffness * rows.T @ rows
        squares = np.linalg.eigvals(np.linalg.solve(M, K)).real
        return math.sqrt(max(float(squares.max()), 1.0))

    # ---- checks

    def _check_size(self) -> None:
        if not self.stations:
            raise InputError("rotor.mounts", "no contact, ball bearing or damper", "one at least")
        if self.rotor.size > MOST_FREEDOMS:
            allowed = f"at most {MOST_FREEDOMS}: reduce the rotor"
            raise InputError("degrees of freedom", self.rotor.size, allowed)
        balls = sum(
            station.mount.ball_bearing.balls
            for station in self.bearings_inside
            if isinstance(station.mount, BearingMount)
        )
        if balls > MOST_BALLS or len(self.stations) > MOST_SUPPORTS:
            allowed = f"at most {MOST_BALLS} in {MOST_SUPPORTS} supports"
            raise InputError("balls", f"{balls} in {len(self.stations)} supports", allowed)
        forces = sum(len(station.mount.directions) for station in self.out) + len(self.points)
        inputs = forces + len(self.bearings_out) + len(self.rotor.unbalances) + 2
        if inputs > MOST_INPUTS:
            allowed = f"at most {MOST_INPUTS}: forces on named nodes and of supports outside, unbalances, speed"
            raise InputError("inputs", inputs, allowed)

    def _check_matrices(self) -> None:
        for mount in self.rotor.bearings:
            if isinstance(mount.bearing, LinearBearing) and mount.bearing.speeds_rpm is not None:
                raise InputError("bearing", mount.bearing.name or "a table over the speed", SPEED_LIMITED)
        _, _, K = self.rotor.matrices(0.0)
        if np.abs(K - K.T).max() > ROUNDING * np.abs(K).max():
            raise InputError("stiffness", "one that is not symmetric", "symmetric, of a rotor that has modes")


def supports_of(rotor: Rotor) -> tuple[str, ...]:
    """Names of the supports of a rotor that may be outside, as in results: contacts, then ball bearings."""
    return (*(f"contact {i}" for i in range(len(rotor.contacts))), *rotor.ball_bearing_names)


def labels_of(known: Sequence[str]) -> tuple[str, ...]:
    """Labels of the variables of these supports, which count from 1 and each kind for itself."""
    contacts = sum(CONTACT_NAME.fullmatch(name) is not None for name in known)
    bearings = len(known) - contacts
    return (*(f"contact[{i + 1}]" for i in range(contacts)), *(f"bearing[{b + 1}]" for b in range(bearings)))


def outside_names(known: tuple[str, ...], outside: str | Iterable[str]) -> tuple[str, ...]:
    """Names of the supports outside, checked."""
    names = (known if outside == ALL else (outside,)) if isinstance(outside, str) else tuple(outside)
    for name in names:
        if name not in known:
            rows = zip(known, labels_of(known), strict=True)
            named = ", ".join(f"{own!r} (its variables are {label})" for own, label in rows)
            raise InputError("outside", name, f"{named}, or 'all'")
    return names


def _geometry(stations: Sequence[Station], size: int) -> SupportGeometry:
    contacts = [station.mount for station in stations if isinstance(station.mount, ContactMount)]
    bearings = [station.mount for station in stations if isinstance(station.mount, BearingMount)]
    if not stations:
        return SupportGeometry(np.zeros((0, size)), np.zeros((0, 0)), np.zeros(0))
    return support_geometry(contacts, bearings, size)


def _with_elements(rotor: Rotor, outside: str | Iterable[str]) -> Rotor:
    """The rotor with the contacts inside as elements in SI."""
    mounts: list[Any] = []
    unknown = [f"contact {i}" for i, mount in enumerate(rotor.contacts) if mount.contact is None]
    if not set(unknown) <= set(outside):
        raise InputError("contacts", None, f"one per mount, {len(rotor.contacts)}, or outside={tuple(unknown)!r}")
    i = 0
    for mount in rotor.mounts:
        own: Any = mount
        if isinstance(mount, ContactMount):
            if mount.contact is not None:
                own = replace(mount, contact=_element(f"contacts[{i}]", mount.contact))
            i += 1
        mounts.append(own)
    return replace(rotor, mounts=tuple(mounts))


def _element(name: str, contact: Any) -> Element:
    """A contact element in SI that the FMU can hold."""
    if not isinstance(contact, Element) or contact.kind == "speed":
        raise InputError(name, shown(contact), "a contact element for one speed (linear, cubic, ..., wide)")
    if contact.units != "SI":
        raise InputError(f"{name}.units", contact.units, "SI: an element of an OperatingPoint")
    return contact.copy()
