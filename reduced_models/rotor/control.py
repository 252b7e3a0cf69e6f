"""Rotors on ball bearings as systems of python-control: forces on degrees of freedom in, displacements out.

States are differences from static equilibrium in um (um/s, urad), with the films' memory; they start at 0. So the
absolute tolerance of python-control's solvers, 1e-6, is a picometre. Films are fast: of the solvers, take one
for stiff equations (``solve_ivp_method="BDF"``); the relative tolerance of scipy is 1e-3 unless
``solve_ivp_kwargs={"rtol": 1e-6}`` is given.

After displacements and velocities of the rotor come the states of each bearing: of ball 3 of bearing 0 its place
``b0_3_w`` along the outer contact, with five degrees of freedom ``b0_3_a`` across it, the inlet, fast and chain
filters of both films (``b0_3_i_s``, ``b0_3_i_y``, ``b0_3_i_q1``, ...), then those of a loss factor. Where the cage
turns, its angle comes last, ``b0_cage``: it follows the contact angles.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_instance, require_integer, require_nonnegative, shown
from ehlcontact.checks.kinds import NAME, Object
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from reduced_models.bearing.ball_states import PER_METRE, across_damping, bearing_system
from reduced_models.bearing.continuous_time import BearingRates
from reduced_models.bearing.core_bearing import ORIGIN
from reduced_models.bearing.freedoms import FIVE, PLANAR
from reduced_models.bearing.linear_balls import LinearBalls
from reduced_models.bearing.linear_reduction import reduced_system
from reduced_models.bearing.ring import equilibrium_at
from reduced_models.bearing.ring_statics import linear_balls, static_ring
from reduced_models.elements.film_response import FILTERS
from reduced_models.rotor.linear_system import rotor_system
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.supports import BearingMount

_Floats = NDArray[np.float64]

Signals = Mapping[str, int] | Sequence[int] | None

UNIT = 1e-6  # m, of the states


def rings_of(rotor: Rotor) -> _Floats:
    """Motions of the rings of ball bearings, shape (n bearings, N); `InputError` for a rotor on contacts."""
    if rotor.contacts:
        raise InputError("mounts", "with contacts", "ball bearings or linear bearings, for python-control")
    if rotor.film_dampers:
        allowed = "without: linearise(rotor).to_control() has them about static equilibrium"
        raise InputError("mounts", "with squeeze film dampers", allowed)
    return np.concatenate([np.zeros((0, rotor.size)), *(m.rows(rotor.size) for m in rotor.ball_bearings)])


def linear_block(
    rotor: Rotor,
    omega: float,
    about: Sequence[LinearBalls],
    inputs: Signals,
    outputs: Signals,
    name: str,
    tolerance: float,
) -> Any:
    """`LinearRotor.to_control`: of a rotor at a speed [rad/s], `about` what it finds in its ball bearings."""
    import control

    size = rotor.size
    ins, outs = _signals("inputs", inputs, "F", size), _signals("outputs", outputs, "q", size)
    reductions = [
        reduced_system(balls, tolerance) if tolerance else (bearing_system(balls), 0.0) for balls in about
    ]
    A, driven = rotor_system(rotor.matrices(omega), rings_of(rotor), [space for space, _ in reductions])
    C = np.zeros((len(outs), len(A)))
    C[range(len(outs)), list(outs.values())] = UNIT
    states = _states(size, [] if tolerance else [_shape_of(balls) for balls in about])
    for b, (space, _) in enumerate(reductions if tolerance else []):
        states += [f"b{b}_{k}" for k in range(len(space.A))]
    system = control.ss(
        A,
        driven[:, list(ins.values())] / UNIT,
        C,
        0.0,
        inputs=list(ins),
        outputs=list(outs),
        states=states,
        name=name,
    )
    system.reduction_error = max((error for _, error in reductions), default=0.0)
    return system


@takes(rotor=Object(Rotor, "a Rotor"), name=NAME)
def rotor_to_control(
    rotor: Rotor,
    speed_rpm: float,
    *,
    inputs: Signals = None,
    outputs: Signals = None,
    cage_turns: bool = True,
    name: str = "rotor",
) -> Any:
    """Rotor on ball bearings as one nonlinear python-control system, in continuous time.

    Forces in and displacements out are differences from rest under the rotor's own load: with no input and the
    cage held, it stays at 0. States: see `reduced_models.rotor.control`.

    Parameters
    ----------
    rotor : Rotor
        Its unbalances are not in it: they are forces, to be put in.
    speed_rpm : float
        Of the shaft.
    inputs, outputs : mapping of str to int, or sequence of int, optional
        Degrees of freedom by name; without names they are F0, F1, ... [N, N m] and q0, q1, ... [m, rad]. By
        default all.
    cage_turns : bool
        Whether balls go round with the cage as time goes on; they start at the angles of the mounts.
    name : str
        Of the system.

    Raises
    ------
    InputError
        A degree of freedom that is not there, a speed that a bearing does not take.
    """
    import control

    require_instance("rotor", rotor, Rotor, "a Rotor")
    ins, outs = _signals("inputs", inputs, "F", rotor.size), _signals("outputs", outputs, "q", rotor.size)
    motion = _Motion(rotor, require_nonnegative("speed_rpm", speed_rpm), cage_turns)
    pushed, seen = list(ins.values()), list(outs.values())

    def update(t: float, x: _Floats, u: _Floats, params: object) -> _Floats:
        force = np.zeros(rotor.size)
        np.add.at(force, pushed, u)
        return motion.rates(np.asarray(x, float) * UNIT, force) / UNIT

    def output(t: float, x: _Floats, u: _Floats, params: object) -> _Floats:
        return np.asarray(x, float)[seen] * UNIT

    states = _states(rotor.size, [ring.shape for ring in motion.rings])
    return control.nlsys(update, output, inputs=list(ins), outputs=list(outs), states=states, name=name)


def _signals(field: str, given: Signals, letter: str, size: int) -> dict[str, int]:
    chosen = range(size) if given is None else given
    if isinstance(chosen, str) or not isinstance(chosen, Iterable):
        raise InputError(
            field, shown(given), f"degrees of freedom from 0 to {size - 1}, or a mapping of names to them"
        )
    named = dict(chosen) if isinstance(chosen, Mapping) else {f"{letter}{one}": one for one in chosen}
    allowed = f"degrees of freedom from 0 to {size - 1}, each once"
    if not named or (not isinstance(chosen, Mapping) and len(named) != len(chosen)):
        raise InputError(field, given, allowed)
    for name, value in named.items():
        if require_integer(f"{field}[{name!r}]", value, allowed, 0) >= size:
            raise InputError(f"{field}[{name!r}]", value, allowed)
    return named


class _Shape(NamedTuple):
    """How many states a bearing has: its balls, lags of each film (none: dry), filters of its seat."""

    moving: int  # directions of the ring
    balls: int
    lags: int
    seat: int
    inertia: float  # of a ball
    cage: bool = False  # its angle, which turns as the balls roll

    @property
    def own(self) -> tuple[str, ...]:
        """States of a ball's own place."""
        names = ("w", "v") if self.moving == len(PLANAR) else ("w", "a", "vw", "va")
        return names if self.inertia else names[: len(names) // 2] if self.lags else ()

    @property
    def of_balls(self) -> int:
        """States of all balls."""
        return self.balls * (len(self.own) + (2 * (FILTERS + self.lags) if self.lags else 0))

    @property
    def directions(self) -> tuple[str, ...]:
        """Of the ring."""
        return FIVE[: self.moving]


def _states(size: int, bearings: Sequence[_Shape]) -> list[str]:
    """Names, in order."""
    names = [f"q{k}" for k in range(size)] + [f"v{k}" for k in range(size)]
    for b, shape in enumerate(bearings):
        for k in range(shape.balls):
            names += [f"b{b}_{k}_{one}" for one in shape.own]
            filters = ["s", "y", *(f"q{j}" for j in range(1, shape.lags + 1))] if shape.lags else []
            names += [f"b{b}_{k}_{race}_{own}" for race in ("i", "o") for own in filters]
        names += [f"b{b}_seat_{one}{k}" for k in range(1, shape.seat + 1) for one in shape.directions]
        names += [f"b{b}_cage"] if shape.cage else []
    return names


class _Ring:
    """One bearing: its balls about static equilibrium, with the ring at `r`, and its seat.

    The angle of the cage is a state where it turns.
    """

    def __init__(self, mount: BearingMount, speed: float, r: _Floats, cage_turns: bool) -> None:
        bearing, rpm = mount.ball_bearing, mount.ball_bearing.speed(speed)
        static = static_ring(bearing, rpm, mount.cage_angle, r.size)
        held = equilibrium_at(static, r)
        linear = linear_balls(bearing, rpm, [held])
        self.shape = _shape_of(linear)._replace(cage=cage_turns)
        self.force = held.load.copy()
        origins = np.zeros(static.balls.number, ORIGIN)
        origins["place"], origins["moved"] = static.places, held.maps[:, :2] @ r
        origins["across"] = [across_damping(linear, k) for k in range(origins.size)]
        self._omega = static.balls.omega
        self._rates = BearingRates(static.balls, FIVE[: r.size], origins, cage_held=not cage_turns)
        seat = np.tile(self.force, self.shape.seat)
        self._rest = np.concatenate([[mount.cage_angle], np.zeros(self.shape.of_balls), seat])
        # in the order of `BearingRates` the cage comes first, and a seat is in N
        self.size = self._rest.size - 1 + cage_turns
        self._moving = np.roll(np.arange(self._rest.size), -1)[: self.size]
        self._unit = np.repeat([1.0, PER_METRE, 1.0], [self.shape.of_balls, seat.size, cage_turns])

    def rates(self, x: _Floats, r: _Floats, v: _Floats) -> tuple[_Floats, _Floats]:
        """Rates of the states `x`, which are differences from rest; force of the ring on the balls."""
        states = self._rest.copy()
        states[self._moving] += self._unit * x
        rates, force = self._rates.at(self._omega, states, r, v)
        return rates[self._moving] / self._unit, force


def _shape_of(balls: LinearBalls) -> _Shape:
    """States of a bearing."""
    lags = 0 if balls.films.rates is None else balls.films.rates.lags
    return _Shape(balls.maps.shape[-1], len(balls.maps), lags, balls.loss.gains.size, balls.inertia)


class _Motion:
    """Rates of all states, which are differences from rest [m]."""

    def __init__(self, rotor: Rotor, speed: float, cage_turns: bool) -> None:
        self._rest, self._to_rings = rotor.equilibrium(speed), rings_of(rotor)
        shift = np.concatenate([mount.shift for mount in rotor.ball_bearings])
        self._r, self._places = self._to_rings @ self._rest + shift, rotor.ball_columns
        self._size = rotor.size
        self._inverse = np.linalg.inv(rotor.mass)
        _, self._damping, self._stiffness = rotor.matrices(speed * np.pi / 30.0)
        self.rings = [
            _Ring(mount, speed, self._r[at], cage_turns)
            for at, mount in zip(self._places, rotor.ball_bearings, strict=True)
        ]

    def rates(self, x: _Floats, force: _Floats) -> _Floats:
        """Of q, q' and the states of the bearings, under a force beside the load [N]."""
        size, out = self._size, np.empty(x.size)
        q, v = x[:size], x[size : 2 * size]
        r, r_rate = self._r + self._to_rings @ q, self._to_rings @ v
        net = force - self._damping @ v - self._stiffness @ q
        at = 2 * size
        for own, ring in zip(self._places, self.rings, strict=True):
            here = slice(at, at + ring.size)
            out[here], pushed = ring.rates(x[here], r[own], r_rate[own])
            net -= self._to_rings[own].T @ (pushed - ring.force)
            at = here.stop
        out[:size], out[size : 2 * size] = v, self._inverse @ net
        return out
