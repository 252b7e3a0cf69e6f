"""Reference inputs and results of the FMU of a rotor: a run-up with lift-off, and its equations along it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fmu.bearing.places import rates_of
from fmu.bearing.variables import FORCES
from fmu.contact_variables import Element, Film
from fmu.lead import ROTOR
from fmu.references.contact_references import film_rates_at
from fmu.references.series import References, Trial
from fmu.rotor.dampers import ECCENTRICITY
from fmu.rotor.model import RotorModel
from fmu.rotor.trial import RotorTrial, rotor_trial
from fmu.rotor.variables import force_rows
from fmu.spec import ModelSpec
from reduced_models.bearing.race import RACES

_Floats = NDArray[np.float64]

TOLERANCE = 1e-6  # of references
REFERENCE_POINTS = 2  # with ball bearings
EVERY = 20  # steps of the trial between states for model exchange
FILM = 0.02  # size of the states of films there, over their nominal values
TURNED = 0.1  # rad, of the cage from rest
ABOUT = "The speed rises, unbalances grow, forces lift the rotor off; steps of simulate_rotor, in Python"


def rotor_references(model: RotorModel, spec: ModelSpec) -> References:
    """References inside the FMU of a rotor; it is compared on the same."""
    trial = rotor_trial(model, force_rows(model).tobytes())
    inputs = {v.name: trial.inputs[:, k] for k, v in enumerate(spec.inputs)}
    settings = {ROTOR.name: ROTOR.at_end, "inner_step": model.inner_step}
    if model.inertia is not None:
        settings["speed"] = float(trial.speed[0])
    if model.start is not None:
        names = [state.name for state in spec.states[: 2 * model.rotor.size]]
        settings |= dict(zip(names, [*trial.displacement[0], *trial.velocity[0]], strict=True))
    results = _results(trial, model, spec)
    sizes = {name: _moved(values) for name, values in results.items()}
    steps = Trial(trial.time, inputs, results, sizes, dict.fromkeys(results, "motion"))
    return References(steps, _points(trial, model, spec), settings, TOLERANCE, ABOUT, parted=trial.parted)


def _moved(history: _Floats) -> float:
    """What an output moves in a run, or where it stands."""
    return max(float(np.ptp(history)), 1e-3 * float(np.abs(history).max()), 1e-12)


def _results(trial: RotorTrial, model: RotorModel, spec: ModelSpec) -> dict[str, Any]:
    states = [v.name for v in spec.states]
    results = dict(zip(states, [*trial.displacement.T, *trial.velocity.T], strict=False))
    first = next(
        v.value_reference
        for v in spec.variables
        if v.name.startswith(model.stations_in_order[0].label)
        and v.causality == "output"
        and v.derivative_of is None
    )
    moving = [v.name for v in spec.variables[first : first + 2 * trial.motion.shape[1]]]
    results |= dict(zip(moving, [*trial.motion.T, *trial.rate.T], strict=True))
    column = 0
    for station in model.inside:
        if station.is_contact:
            results[f"{station.label}.force"] = trial.force[:, column]
            column += 1
            continue
        first_of = column
        for name in station.mount.directions:
            results[f"{station.label}.{FORCES[name]}"] = -trial.force[:, column]
            column += 1
        if station.is_damper:
            moved = trial.motion[:, first_of : first_of + len(station.mount.directions)]
            results[f"{station.label}.{ECCENTRICITY}"] = station.mount.damper.eccentricity(moved)
    for b, station in enumerate(model.bearings_inside):
        results |= {f"{station.label}.largest_load_{race}": trial.load[:, b, k] for k, race in enumerate(RACES)}
    turning = {"angle": trial.angle} | ({} if model.inertia is None else {"speed": trial.speed})
    return results | turning


# ---- continuous time


class _SupportsInside:
    """Supports inside a rotor at states of their own away from rest: rates of these, and forces of the rotor."""

    def __init__(self, model: RotorModel, spec: ModelSpec) -> None:
        self._model = model
        self._nominal = np.array([state.nominal or 1.0 for state in spec.states])
        self._made = [rates_of(bearing) for bearing in model.bearings]

    def states_at(self, place: _Floats, rate: _Floats, omega: float, first: int, n: int) -> _Motion:
        """States, rates and force on the rotor at its displacements and velocities.

        The states begin with number `first` of all; `n` decides how they are moved.
        """
        size, bearings = place.size, iter(self._made)
        states, rates, force = [], [], np.zeros(size)
        for station in self._model.inside:
            rows = station.mount.rows(size)
            ring, speed = rows @ place + station.shift, rows @ rate
            if station.is_contact:
                own, change, carried = _contact_at(station.mount.contact, ring, speed, n)
            elif station.is_damper:
                own, change, carried = np.empty(0), np.empty(0), station.mount.damper.forces(ring, speed).force
            else:
                in_time = next(bearings)
                rest = in_time.rest(omega, station.mount.cage_angle, ring)
                own = rest + self._nominal[first : first + rest.size] * _moved_states(rest.size, n)
                own[0] = rest[0] + TURNED
                change, carried = in_time.at(omega, own, ring, speed)
            first += own.size
            states.append(own)
            rates.append(change)
            force -= station.count * rows.T @ carried
        return _Motion(np.concatenate([np.empty(0), *states]), np.concatenate([np.empty(0), *rates]), force)


class _Motion(NamedTuple):
    """States of supports, their rates, and the forces of supports on the rotor."""

    states: _Floats
    rates: _Floats
    force: _Floats


def _moved_states(count: int, n: int) -> _Floats:
    return np.asarray(FILM * np.cos((1.0 + np.arange(count)) * n))


def _contact_at(element: Element, ring: _Floats, speed: _Floats, n: int) -> tuple[_Floats, _Floats, _Floats]:
    """States of a contact, their rates and its force."""
    states, (u, v) = _moved_states(element.state_count, n), (float(ring[0]), float(speed[0]))
    if isinstance(element, Film):
        force, rates = film_rates_at(element, states, u, v)
    else:
        force, rates = float(element.force(u, v)), np.empty(0)
    return states, rates, np.array([force])


def _points(trial: RotorTrial, model: RotorModel, spec: ModelSpec) -> Trial:
    """States of the trial with films away from rest: derivatives there."""
    rotor, forces, turns = model.rotor, force_rows(model), model.inertia is not None
    steps = np.arange(EVERY, len(trial.time), EVERY)
    if model.bearings:  # some 300 states and rates each: 6 kB in an FMU
        steps = steps[:REFERENCE_POINTS]
    supports, rows, states = _SupportsInside(model, spec), [], []
    for n in steps.tolist():
        q, v, omega = trial.displacement[n], trial.velocity[n], float(trial.speed[n])
        angle, inputs = float(trial.angle[n]), trial.inputs[n]
        _, C, K = rotor.matrices(omega)
        own = np.concatenate([q, v, [angle], [omega] if turns else []])
        inside = supports.states_at(q, v, omega, own.size, n)
        net = rotor.load + inputs[: len(forces)] @ forces - C @ v - K @ q + inside.force
        a, alpha = _accelerations(model, net, inputs, angle, omega)
        rows.append(np.concatenate([v, a, [omega], [alpha] if turns else [], inside.rates]))
        states.append(np.concatenate([own, inside.states]))
    names = [state.name for state in spec.states]
    knowns = dict(zip(names, np.array(states).T, strict=True))
    knowns |= {v.name: trial.inputs[steps, k] for k, v in enumerate(spec.inputs)}
    unknowns = dict(zip((f"der({name})" for name in names), np.array(rows).T, strict=True))
    if turns and any(bearing.bearing.oil is not None for bearing in model.bearings):
        unknowns = {name: values for name, values in unknowns.items() if not _is_driven(name, model, spec)}
    number, fields = np.arange(steps.size, dtype=float), dict.fromkeys(unknowns, "rates")
    return Trial(number, knowns, unknowns, _rate_sizes(unknowns, model, names), fields)


def _is_driven(name: str, model: RotorModel, spec: ModelSpec) -> bool:
    """Whether a derivative depends on the torque that films take, which Python has in steps only."""
    accelerations = {f"der({state.name})" for state in spec.states[model.rotor.size : 2 * model.rotor.size]}
    return name == "der(speed)" or (name in accelerations and bool(model.rotor.unbalances))


def _accelerations(
    model: RotorModel, net: _Floats, inputs: _Floats, angle: float, omega: float
) -> tuple[_Floats, float]:
    """Of the rotor, and of its shaft, at once: the centre of mass of an unbalance moves with both."""
    rotor, size = model.rotor, model.rotor.size
    forces = len(force_rows(model))
    amounts = inputs[forces : forces + len(rotor.unbalances)]
    turning = inputs[forces + len(rotor.unbalances) :]
    w, net = np.zeros(size), net.copy()
    for u, amount in zip(rotor.unbalances, amounts, strict=True):
        c, s = np.cos(angle + u.phase), np.sin(angle + u.phase)
        for place, swing, side in ((u.x, c, s), (u.y, s, -c)):
            if place is not None:
                net[place] += amount * omega**2 * swing
                w[place] += amount * side
    if model.inertia is None:
        return np.linalg.solve(rotor.mass, net + turning[1] * w), float(turning[1])
    whole = np.zeros((size + 1, size + 1))
    whole[:size, :size], whole[size, size] = rotor.mass, model.inertia
    whole[:size, size] = whole[size, :size] = -w
    found = np.linalg.solve(whole, np.append(net, turning[0] - turning[1:].sum()))
    return found[:size], float(found[size])


def _rate_sizes(rates: dict[str, Any], model: RotorModel, names: list[str]) -> dict[str, float]:
    """What differences of rates are measured by: the largest of a kind, or what balances within it."""
    size = model.rotor.size
    load = max(float(np.abs(model.rotor.load).max()), 1.0) / float(np.diag(model.rotor.mass).max())
    least = {"velocity": 0.0, "acceleration": load}
    largest = dict(least)
    kinds = {}
    for j, name in enumerate(names):
        if f"der({name})" not in rates:
            continue
        support, _, own = name.rpartition(".")
        kind = f"{support.partition('[')[0]}.{own.partition('[')[0]}"
        kinds[f"der({name})"] = kind = [*least, kind][min(j // size, 2)]
        largest[kind] = max(largest.get(kind, 1e-300), float(np.abs(rates[f"der({name})"]).max()))
    return {name: largest[kind] for name, kind in kinds.items()}
