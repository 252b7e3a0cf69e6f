"""The Jeffcott rotor of an FMU in Python, for comparison: a short run, and its equations in a state."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fmu.comparison import bounds, film_rates_at, tangents
from fmu.contact_variables import Element, Film
from reduced_models import JeffcottRotor, OutsideValidityWarning, simulate_rotor
from reduced_models.rotor.jeffcott import RotorState
from reduced_models.rotor.speed_profile import SpeedProfile
from reduced_models.rotor.time_step import free_displacement, move_to, steps_of

_Floats = NDArray[np.float64]

STEPS = 240  # of the run
TURN = 60  # steps that a revolution takes in it, of a rotor that does not turn
SWING = 0.1  # force of the unbalance at least, or of a contact outside, over the static load, in the run
RISE = 0.1  # of the speed, over the run
OFF = 0.1  # how far the disc starts off its place of rest, in static bends of the shaft
TOLERANCE = 1e-9  # of `simulate_rotor`
RHO = 0.8  # spectral radius at infinite frequency, as `simulate_rotor` has it


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """What a rotor does in steps of dt [s].

    Inputs by name, each of shape (N,); positions and velocities in the order of the FMU's states, (N, states);
    forces of the contacts, (N, contacts).
    """

    rotor: JeffcottRotor
    dt: float
    inputs: dict[str, _Floats]
    motion: _Floats
    force: _Floats


@dataclass(frozen=True, slots=True, eq=False)
class Felt:
    """One contact or all of them in a state: rates are those of the films."""

    force: _Floats
    stiffness: _Floats
    damping: _Floats
    rates: _Floats
    rate_scales: _Floats
    outside: tuple[bool, ...]


def reference_run(rotor: JeffcottRotor, elements: tuple[Element, ...], rest: RotorState, dt: float) -> Run:
    """Run from `rest` with the disc displaced, the unbalance at least `SWING` of the load, in a run-up."""
    load = load_size(rotor)
    speed = rotor.speed_rpm if rotor.speed_rpm > 0.0 else 60.0 / (TURN * dt)
    omega = speed * np.pi / 30.0
    rotor = replace(rotor, unbalance=max(rotor.unbalance, SWING * load / omega**2))
    profile = SpeedProfile.ramp(speed, (1.0 + RISE) * speed, (STEPS + 1) * dt)
    off = np.zeros(2)
    off[list(rotor.axes)] = OFF * load / rotor.shaft_stiffness
    # at rest: a film of the Python element begins there, whatever its rate
    start = RotorState(rest.disc + off, rest.journal, np.zeros(2), np.zeros(2))
    return (_closed_run if elements else _free_run)(rotor, elements, start, dt, profile)


def load_size(rotor: JeffcottRotor) -> float:
    """Size of the static load [N], 1 where there is none."""
    load = float(np.abs(rotor.static_load).max())
    return load if load > 0.0 else 1.0


def _turning(rotor: JeffcottRotor, profile: SpeedProfile, dt: float) -> tuple[_Floats, dict[str, _Floats]]:
    """Angle of the shaft in the run, and the inputs that turn."""
    speed, angle, rise = profile.at(np.asarray(dt * np.arange(STEPS + 1), np.float64))
    amount = np.full(STEPS + 1, rotor.unbalance)
    return angle, {"unbalance": amount, "speed": speed, "angular_acceleration": rise}


def _closed_run(
    rotor: JeffcottRotor, elements: tuple[Element, ...], start: RotorState, dt: float, profile: SpeedProfile
) -> Run:
    contacts = [element.copy() for element in elements]
    for contact, approach in zip(contacts, rotor.approaches(start.journal).tolist(), strict=True):
        contact.rest(approach)
    with warnings.catch_warnings():  # about a motion that is none of the user's
        warnings.simplefilter("ignore", OutsideValidityWarning)
        result = simulate_rotor(
            rotor, contacts, speed_rpm=profile, dt=dt, until=STEPS * dt, start=start, tolerance=TOLERANCE
        )
    return Run(
        rotor, dt, _turning(rotor, profile, dt)[1], np.hstack([result.displacement, result.velocity]), result.force
    )


def _free_run(
    rotor: JeffcottRotor, _: tuple[Element, ...], start: RotorState, dt: float, profile: SpeedProfile
) -> Run:
    """Under forces of the contacts, and further ones, that are given."""
    axes, load = list(rotor.axes), load_size(rotor)
    size = len(axes)
    phase = 2.0 * np.pi * np.arange(STEPS + 1) / TURN
    names = [f"{body}_force_{'xy'[k]}" for body in ("journal", "disc") for k in axes]
    names += [f"force[{i + 1}]" for i in range(len(rotor.mounts))]
    inputs = {name: SWING * load * np.sin(phase + k) for k, name in enumerate(names)}
    table = np.stack(list(inputs.values()), axis=1)
    one, none = np.eye(size), np.zeros((size, size))
    contacts = rotor.bearings * rotor.normals.T
    at = np.block([[none, one, np.zeros_like(contacts)], [one, none, -contacts]])  # where each input acts
    M, C, K = rotor.matrices()
    angle, turning = _turning(rotor, profile, dt)
    disc = rotor.disc_load + unbalance_force(rotor, angle, turning)
    applied = np.hstack([disc, np.tile(rotor.static_load - rotor.disc_load, (STEPS + 1, 1))])
    given = np.hstack([table, applied])
    d, v = rotor.motion(start)
    state = np.array([d, v, np.linalg.solve(M, applied[0] + at @ table[0] - C @ v - K @ d), np.zeros_like(d)])
    everywhere = np.hstack([at, np.eye(2 * size)])
    steps = steps_of((M, C, K), np.zeros((0, 2 * size)), everywhere, np.zeros(2 * size), dt, RHO)
    motion = np.empty((STEPS + 1, 4 * size))
    motion[0] = state[:2].ravel()
    for n in range(1, STEPS + 1):
        move_to(steps, state, free_displacement(steps, state, given[n], given[n - 1]))
        motion[n] = state[:2].ravel()
    force = table[:, 2 * size :]
    return Run(rotor, dt, inputs | turning, motion, force)


# ---- in a state


def felt_by(elements: tuple[Element, ...], films: _Floats, approach: _Floats, rate: _Floats) -> Felt:
    """All contacts, whose films have these states one after the other."""
    found, at = [], 0
    for element, u, v in zip(elements, approach.tolist(), rate.tolist(), strict=True):
        count = element.state_count
        found.append(_felt(element, films[at : at + count], u, v))
        at += count
    joined = {
        name: np.concatenate([getattr(one, name) for one in found])
        for name in ("force", "stiffness", "damping", "rates", "rate_scales")
    }
    return Felt(**joined, outside=tuple(left for one in found for left in one.outside))


def _felt(element: Element, states: _Floats, u: float, v: float) -> Felt:
    if isinstance(element, Film):
        force, rates = film_rates_at(element, states, u, v)
        stiffness, damping = tangents(element, states, u, v)
        scales = np.full(rates.size, 1e3 * element.law.fast_rate / element._units[2])
    else:
        force, stiffness, damping = (float(f(u, v)) for f in (element.force, element.stiffness, element.damping))
        rates = scales = np.empty(0)
    one = [np.array([float(value)]) for value in (force, stiffness, damping)]
    left = bounds(element, np.array([u]), np.array([v]), one[0])["outside_validity"]
    return Felt(one[0], one[1], one[2], rates, scales, (bool(left[0]),))


def unbalance_force(rotor: JeffcottRotor, angle: Any, inputs: Mapping[str, Any]) -> _Floats:
    """Force of the unbalance [N] along the directions that move, shape (..., directions)."""
    c, s, omega, alpha = np.cos(angle), np.sin(angle), inputs["speed"], inputs["angular_acceleration"]
    both = inputs["unbalance"] * np.array([omega**2 * c + alpha * s, omega**2 * s - alpha * c])
    return np.asarray(np.moveaxis(both, 0, -1)[..., list(rotor.axes)])


def accelerations(
    rotor: JeffcottRotor, motion: _Floats, angle: float, force: _Floats, inputs: dict[str, float]
) -> _Floats:
    """Of disc and journal, in this motion, at this angle of the shaft, under inputs and forces of the contacts."""
    M, C, K = rotor.matrices()
    size, axes = len(M), list(rotor.axes)
    disc, journal = (
        np.array([inputs.get(f"{body}_force_{'xy'[k]}", 0.0) for k in axes]) for body in ("disc", "journal")
    )
    carried = rotor.bearings * rotor.normals.T @ force
    applied = np.concatenate(
        [
            rotor.disc_load + unbalance_force(rotor, angle, inputs) + disc,
            rotor.static_load - rotor.disc_load + journal - carried,
        ]
    )
    return np.asarray(np.linalg.solve(M, applied - C @ motion[size:] - K @ motion[:size]))
