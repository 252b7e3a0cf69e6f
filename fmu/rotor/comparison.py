"""The FMU of a rotor beside the rotor: a short run of co-simulation, and its equations along it."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fmu.comparison import END, LEAST_THETA, Comparison, difference, outside, tangents
from fmu.contacts import Element, Film
from fmu.rotor.model import RotorModel
from fmu.spec import ModelSpec
from reduced_models import JeffcottRotor, OutsideValidityWarning, RotorState, simulate_rotor
from reduced_models.elements.film_law import static
from reduced_models.rotor.step import CondensedRotor, Motion

_Floats = NDArray[np.float64]

STEPS = 240  # of the run
TURN = 60  # steps that a revolution takes in it, where the rotor's own unbalance would not show
SWING = 0.1  # force of the unbalance, or of a contact outside, over the static load, in the run
OFF = 0.1  # how far the disc starts off its place of rest, in static bends of the shaft
TOLERANCE = 1e-9  # of `simulate_rotor`
EVERY = 8  # steps between the states at which the equations are compared


@dataclass(frozen=True, slots=True)
class _Run:
    """What the rotor does in steps of dt: positions and velocities in the order of the FMU's states; forces."""

    rotor: JeffcottRotor
    start: RotorState
    dt: float
    inputs: dict[str, _Floats]
    motion: _Floats
    force: _Floats


def compare_rotor(slave: Any, exchange: Any, model: RotorModel, spec: ModelSpec) -> Comparison:
    """Compare a rotor, in a run with an unbalance that shows and from off its place of rest."""
    run = _free_run(model) if not model.elements else _closed_run(model)
    names = [variable.name for variable in spec.states]
    moving, settings = (
        names[: run.motion.shape[1]],
        {"unbalance": run.rotor.unbalance, "speed_rpm": run.rotor.speed_rpm},
    )
    first = {name: history[0] for name, history in run.inputs.items()}
    slave.start(END, **settings, **dict(zip(moving, run.motion[0], strict=True)), **first)
    exchange.set(**settings)
    exchange.start()
    ours, wrong = np.empty_like(run.motion), 0
    ours[0] = run.motion[0]
    equations = _Equations(run, model, exchange, moving)
    for n in range(1, len(ours)):
        slave.set(**{name: history[n] for name, history in run.inputs.items()})
        slave.step(run.dt)
        ours[n] = slave.get(*moving)
        if n % EVERY == 0:
            now = {name: history[n] for name, history in run.inputs.items()}
            equations.compare(np.array(slave.get(*names)), now)
            wrong += bool(model.elements) and slave.flag("outside_validity") != equations.outside
    slave.raw.terminate()
    gaps = np.abs(ours - run.motion).max(axis=0) / np.ptp(run.motion, axis=0)
    return replace(
        equations.found(),
        states=len(ours) - 1,
        parted=int((run.force == 0.0).sum()),
        flags=wrong,
        motion=float(gaps.max()),
    )


def _shaken(model: RotorModel) -> tuple[JeffcottRotor, RotorState]:
    """The rotor turning with an unbalance that shows, and a start off its place of rest."""
    rotor, state, dt = model.rotor, model.state, model.inner_step
    load = _size(rotor)
    speed = rotor.speed_rpm if rotor.speed_rpm * dt > 0.0 else 60.0 / (TURN * dt)
    omega = speed * np.pi / 30.0
    rotor = replace(rotor, speed_rpm=speed, unbalance=max(rotor.unbalance, SWING * load / omega**2))
    off = np.zeros(2)
    off[list(rotor.axes)] = OFF * load / rotor.shaft_stiffness
    # at rest: a film of the Python element begins there, whatever its rate
    return rotor, RotorState(state.disc + off, state.journal, np.zeros(2), np.zeros(2))


def _size(rotor: JeffcottRotor) -> float:
    load = float(np.abs(rotor.static_load).max())
    return load if load > 0.0 else 1.0


def _closed_run(model: RotorModel) -> _Run:
    rotor, start = _shaken(model)
    contacts = [element.copy() for element in model.elements]
    for contact, approach in zip(contacts, rotor.approaches(start.journal).tolist(), strict=True):
        contact.rest(approach)
    dt = model.inner_step
    with warnings.catch_warnings():  # about a motion that is none of the user's
        warnings.simplefilter("ignore", OutsideValidityWarning)
        result = simulate_rotor(rotor, contacts, dt=dt, until=STEPS * dt, start=start, tolerance=TOLERANCE)
    axes = list(rotor.axes)
    parts = (result.disc, result.journal, result.disc_velocity, result.journal_velocity)
    return _Run(rotor, start, dt, {}, np.hstack([part[:, axes] for part in parts]), result.force)


def _free_run(model: RotorModel) -> _Run:
    """Under forces of the contacts, and further ones, that are given."""
    rotor, start = _shaken(model)
    dt, axes, load = model.inner_step, list(rotor.axes), _size(rotor)
    phase = 2.0 * np.pi * np.arange(STEPS + 1) / TURN
    names = [f"{body}_force_{'xy'[k]}" for body in ("journal", "disc") for k in axes]
    names += [f"force[{i + 1}]" for i in range(len(rotor.mounts))]
    inputs = {name: SWING * load * np.sin(phase + k) for k, name in enumerate(names)}
    journal, disc = (np.stack(list(inputs.values())[k : k + len(axes)], axis=1) for k in (0, len(axes)))
    force = np.stack(list(inputs.values())[2 * len(axes) :], axis=1)
    M, C, K = rotor.matrices()
    linear = CondensedRotor((M, C, K), np.arange(len(axes), 2 * len(axes)), dt, 0.8)
    carried = np.hstack([0.0 * disc, rotor.bearings * force @ rotor.normals])
    applied = [rotor.applied_force(n * dt) + np.hstack([disc[n], journal[n]]) for n in range(STEPS + 1)]
    d = np.concatenate([start.disc[axes], start.journal[axes]])
    v = np.concatenate([start.disc_velocity[axes], start.journal_velocity[axes]])
    now = Motion(d, v, np.linalg.solve(M, applied[0] - carried[0] - C @ v - K @ d), applied[0])
    rows = [np.concatenate([d, v])]
    for n in range(STEPS):
        pending = linear.begin(now, carried[n], applied[n + 1])
        late = linear.weight * np.linalg.solve(linear.D, carried[n + 1][len(axes) :])
        now = linear.finish(pending, pending.q_free - late)
        rows.append(np.concatenate([now.d, now.v]))
    return _Run(rotor, start, dt, inputs, np.array(rows), force)


class _Equations:
    """Accelerations, rates of the films, forces and partial derivatives in model exchange, state by state."""

    def __init__(self, run: _Run, model: RotorModel, exchange: Any, moving: list[str]) -> None:
        self.run, self.elements, self.exchange, self.moving = run, model.elements, exchange, moving
        self.outside = False
        self._outside = 0
        self._gaps = {"force": 0.0, "derivatives": 0.0, "exchange": 0.0}

    def compare(self, states: _Floats, inputs: dict[str, float]) -> None:
        """At one state of the FMU and these inputs."""
        rotor, count = self.run.rotor, len(self.moving)
        size = count // 2
        d, v, angle = states[:size], states[size:count], states[count]
        M, C, K = rotor.matrices()
        journal = slice(size // 2, size)
        u, rate = rotor.normals @ d[journal] + rotor.offsets, rotor.normals @ v[journal]
        felt = self._contacts(states[count + 1 :], u, rate) if self.elements else None
        force = np.array([inputs[f"force[{i + 1}]"] for i in range(u.size)]) if felt is None else felt.force
        applied = self._applied(angle, inputs)
        applied[journal] -= rotor.bearings * rotor.normals.T @ force
        wanted = np.concatenate([v, np.linalg.solve(M, applied - C @ v - K @ d), [rotor.omega]])
        rates = self.exchange.rates(states, **inputs)
        # what balances within an acceleration, or in the rate of a film, is much larger than it may be
        scales = np.concatenate([np.full(size, np.abs(v).max()), 1e3 * _size(rotor) / np.diag(M), [rotor.omega]])
        self._note("exchange", rates[: count + 1], wanted, scales)
        if felt is not None:
            if felt.rates.size:
                self._note("exchange", rates[count + 1 :], felt.rates, felt.rate_scales)
            names = [f"force[{i + 1}]" for i in range(u.size)]
            self._note("force", np.array(self.exchange.get(*names)), force, np.full(u.size, _size(rotor)))
            self.outside = felt.outside
            self._outside += felt.outside
        self._partials(felt, C, K, np.diag(M))

    def _applied(self, angle: float, inputs: dict[str, float]) -> _Floats:
        rotor = self.run.rotor
        axes = list(rotor.axes)
        swing = rotor.unbalance * rotor.omega**2 * np.array([np.cos(angle), np.sin(angle)])[axes]
        further = [
            np.array([inputs.get(f"{body}_force_{'xy'[k]}", 0.0) for k in axes]) for body in ("disc", "journal")
        ]
        return np.concatenate(
            [rotor.disc_load + swing + further[0], rotor.static_load - rotor.disc_load + further[1]]
        )

    def _contacts(self, films: _Floats, u: _Floats, rate: _Floats) -> _Felt:
        found = [
            _felt(element, part, x, v) for (element, part), x, v in zip(self._films(films), u, rate, strict=True)
        ]
        return _Felt(
            force=np.array([f.force[0] for f in found]),
            stiffness=np.array([f.stiffness[0] for f in found]),
            damping=np.array([f.damping[0] for f in found]),
            rates=np.concatenate([f.rates for f in found]),
            rate_scales=np.concatenate([f.rate_scales for f in found]),
            outside=any(f.outside for f in found),
        )

    def _films(self, films: _Floats) -> list[tuple[Element, _Floats]]:
        parts, at = [], 0
        for element in self.elements:
            count = element.lags + 2 if isinstance(element, Film) else 0
            parts.append((element, films[at : at + count]))
            at += count
        return parts

    def _partials(self, felt: _Felt | None, C: _Floats, K: _Floats, masses: _Floats) -> None:
        """Derivatives of the journal's accelerations by its position and velocity."""
        rotor = self.run.rotor
        size = len(masses)
        journal, none = slice(size // 2, size), np.zeros(len(rotor.mounts))
        for what, linear, slopes in (
            ("", K, none if felt is None else felt.stiffness),
            ("_velocity", C, none if felt is None else felt.damping),
        ):
            wanted = linear[journal, journal] + rotor.bearings * (rotor.normals.T * slopes) @ rotor.normals
            names = [("x", "y")[k] for k in rotor.axes]
            ours = np.array(
                [
                    [-self.exchange.gradient(f"der(journal_velocity_{a})", f"journal{what}_{b}") for b in names]
                    for a in names
                ]
            )
            wanted = wanted / rotor.journal_mass
            self._note("derivatives", ours, wanted, np.full(wanted.shape, np.abs(wanted).max()))

    def _note(self, name: str, ours: _Floats, wanted: _Floats, scales: _Floats) -> None:
        self._gaps[name] = max(self._gaps[name], difference(ours.ravel(), wanted.ravel(), scales.ravel()))

    def found(self) -> Comparison:
        """What there is so far; the run itself is not in it."""
        return Comparison(states=0, outside=self._outside, parted=0, tangents=0.0, flags=0, **self._gaps)


@dataclass(frozen=True, slots=True)
class _Felt:
    """One contact or all of them in a state."""

    force: _Floats
    stiffness: _Floats
    damping: _Floats
    rates: _Floats
    rate_scales: _Floats
    outside: bool


def _felt(element: Element, states: _Floats, u: float, v: float) -> _Felt:
    if isinstance(element, Film):
        _, length, time = element._units
        force, rates = element.continuous(states, u, v)
        stiffness, damping = tangents(element, states, u, v)
        bound = min(1.0, float(static(u / length, element.law)[1]) ** 0.5 / LEAST_THETA)
        rates, scales = rates * bound, np.full(rates.size, 1e3 * element.law.fast_rate / time)
    else:
        force, stiffness, damping = (float(f(u, v)) for f in (element.force, element.stiffness, element.damping))
        rates = scales = np.empty(0)
    left = bool(outside(element, np.array(u), np.array(v), np.array(force)))
    one = [np.array([float(value)]) for value in (force, stiffness, damping)]
    return _Felt(one[0], one[1], one[2], rates, scales, left)
