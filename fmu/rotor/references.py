"""Reference inputs and results of the FMU of a rotor: a run-up with lift-off, and its equations along it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fmu.bearing.continuous import rates_in_time, rest_states
from fmu.bearing.places import counted_from
from fmu.bearing.variables import FORCES
from fmu.contact_variables import Element, Film
from fmu.lead import ROTOR
from fmu.references.contact_references import film_rates_at
from fmu.references.series import References, Trial
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
    size = model.rotor.size
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
        for name in station.mount.directions:
            results[f"{station.label}.{FORCES[name]}"] = -trial.force[:, column]
            column += 1
    for b, station in enumerate(model.bearings_inside):
        results |= {f"{station.label}.largest_load_{race}": trial.load[:, b, k] for k, race in enumerate(RACES)}
    turning = {"angle": trial.angle} | ({} if model.inertia is None else {"speed": trial.speed})
    assert size
    return results | turning


# ---- continuous time


class Felt(NamedTuple):
    """A support in a state: forces of the rotor on it, rates of its states, and their sizes."""

    force: _Floats
    rates: _Floats
    scales: _Floats


def _contact(element: Element, states: _Floats, u: float, v: float) -> Felt:
    if isinstance(element, Film):
        force, rates = film_rates_at(element, states, u, v)
        return Felt(np.array([force]), rates, np.full(rates.size, 1e3 * element.law.fast_rate / element._units[2]))
    return Felt(np.array([float(element.force(u, v))]), np.empty(0), np.empty(0))


def _points(trial: RotorTrial, model: RotorModel, spec: ModelSpec) -> Trial:
    """States of the trial with films away from rest: derivatives there."""
    rotor, size = model.rotor, model.rotor.size
    at = np.arange(EVERY, len(trial.time), EVERY)
    if model.bearings:  # some 300 states and rates each: 6 kB in an FMU
        at = at[:REFERENCE_POINTS]
    M = rotor.mass
    bearings = list(model.bearings)
    motions = [bearing.motion() for bearing in bearings]
    counted = [counted_from(bearing) for bearing in bearings]
    named = [state.name for state in spec.states]
    nominal = np.array([state.nominal or 1.0 for state in spec.states])
    forces = force_rows(model)
    rows, states = [], []
    for n in at:
        q, v, omega = trial.displacement[n], trial.velocity[n], float(trial.speed[n])
        angle = float(trial.angle[n])
        inputs = trial.inputs[n]
        _, C, K = rotor.matrices(omega)
        net = rotor.load + inputs[: len(forces)] @ forces - C @ v - K @ q
        x = [q, v, [angle], *([[omega]] if model.inertia is not None else [])]
        rates: list[Any] = [v, None, [omega], *([[0.0]] if model.inertia is not None else [])]
        drag, b = 0.0, 0
        first = sum(map(len, x))
        for station in model.inside:
            mount = station.mount
            place, rate = mount.rows(size) @ q + station.shift, mount.rows(size) @ v
            if station.is_contact:
                count = mount.contact.state_count
                films = FILM * np.cos((1.0 + np.arange(count)) * n)
                felt = _contact(mount.contact, films, float(place[0]), float(rate[0]))
            else:
                own = rest_states(bearings[b], motions[b], omega, mount.cage_angle, place)
                count = own.size
                films = own + FILM * nominal[first : first + count] * np.cos((1.0 + np.arange(count)) * n)
                films[0] = own[0] + 0.1
                rates_of, force = rates_in_time(bearings[b], motions[b], films, place, rate, omega, counted[b])
                felt = Felt(-force, rates_of, np.abs(rates_of))
                b += 1
            x.append(films)
            rates.append(felt.rates)
            net = net - station.count * mount.rows(size).T @ felt.force
            first += count
        a, alpha = _accelerations(model, net, inputs, angle, omega, drag)
        rates[1] = a
        if model.inertia is not None:
            rates[3] = [alpha]
        states.append(np.concatenate(x))
        rows.append(np.concatenate([np.asarray(one, float) for one in rates]))
    assert M.size
    knowns = dict(zip(named, np.array(states).T, strict=True))
    knowns |= {v.name: trial.inputs[at, k] for k, v in enumerate(spec.inputs)}
    unknowns = dict(zip((f"der({name})" for name in named), np.array(rows).T, strict=True))
    if model.inertia is not None and any(bearing.bearing.oil is not None for bearing in bearings):
        unknowns = {name: values for name, values in unknowns.items() if not _is_driven(name, model, spec)}
    sizes = _rate_sizes(unknowns, model, named)
    fields = dict.fromkeys(unknowns, "rates")
    return Trial(np.arange(at.size, dtype=float), knowns, unknowns, sizes, fields)


def _is_driven(name: str, model: RotorModel, spec: ModelSpec) -> bool:
    """Whether a derivative depends on the torque that films take, which Python has in steps only."""
    accelerations = {f"der({state.name})" for state in spec.states[model.rotor.size : 2 * model.rotor.size]}
    return name == "der(speed)" or (name in accelerations and bool(model.rotor.unbalances))


def _accelerations(
    model: RotorModel, net: _Floats, inputs: _Floats, angle: float, omega: float, drag: float
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
    found = np.linalg.solve(whole, np.append(net, turning[0] - turning[1:].sum() - drag))
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
