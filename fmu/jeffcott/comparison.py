"""Comparison of the FMU of a Jeffcott rotor with the rotor: a short co-simulation, and the equations along it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fmu.comparison import difference
from fmu.jeffcott.model import JeffcottModel
from fmu.jeffcott.reference_rotor import Felt, accelerations, felt_by, load_size
from fmu.lead import ROTOR
from fmu.spec import ModelSpec
from fmu.verification import Verification

_Floats = NDArray[np.float64]

EVERY = 8  # steps between the states at which the equations are compared


def compare_jeffcott(slave: Any, exchange: Any, model: JeffcottModel, spec: ModelSpec) -> Verification:
    """Compare a rotor, in a run with an unbalance that shows and from off its place of rest."""
    run = model.run
    names = [variable.name for variable in spec.states]
    moving = names[: run.motion.shape[1]]
    settings = {"inner_step": run.dt}
    start = dict(zip(moving, run.motion[0].tolist(), strict=True)) | {k: v[0] for k, v in run.inputs.items()}
    slave.start(force_lead=ROTOR.at_end, **settings, **start)
    exchange.start(**settings)
    equations = _Equations(model, exchange, moving)
    ours, wrong = [run.motion[0]], 0
    for n in range(1, len(run.motion)):
        inputs = {name: float(history[n]) for name, history in run.inputs.items()}
        slave.set(**inputs)
        slave.step(run.dt)
        ours.append(np.array(slave.get(*moving)))
        if n % EVERY == 0:
            left = equations.compare(np.array(slave.get(*names)), inputs)
            wrong += bool(model.elements) and slave.flag("outside_validity") != left
    slave.raw.terminate()
    gaps = np.abs(np.array(ours) - run.motion).max(axis=0) / np.ptp(run.motion, axis=0)
    return replace(
        equations.found(),
        states=len(ours) - 1,
        parted=int((run.force == 0.0).sum()),
        flags=wrong,
        motion=float(gaps.max()),
    )


class _Equations:
    """Accelerations, rates of the films, forces and partial derivatives in model exchange, state by state."""

    def __init__(self, model: JeffcottModel, exchange: Any, moving: list[str]) -> None:
        self.rotor, self.elements = model.run.rotor, model.elements
        self.exchange, self.moving = exchange, moving
        self._outside = 0
        self._gaps = {"force": 0.0, "derivatives": 0.0, "exchange": 0.0}

    def compare(self, states: _Floats, inputs: dict[str, float]) -> bool:
        """At one state of the FMU and these inputs; whether a contact has left its box there."""
        rotor, count = self.rotor, len(self.moving)
        size, mounts = count // 2, range(1, len(self.rotor.mounts) + 1)
        motion, velocity = states[:count], states[size:count]
        journal = slice(size // 2, size)
        u, rate = rotor.normals @ motion[journal] + rotor.offsets, rotor.normals @ velocity[journal]
        rates = self.exchange.place(states, **inputs)
        felt = felt_by(self.elements, states[count + 1 :], u, rate) if self.elements else None
        force = np.array([inputs[f"force[{i}]"] for i in mounts]) if felt is None else felt.force
        wanted = np.concatenate(
            [velocity, accelerations(rotor, motion, float(states[count]), force, inputs), [inputs["speed"]]]
        )
        # what balances within an acceleration, or in the rate of a film, is much larger than what is left of it
        heavy = 1e3 * load_size(rotor) / np.diag(rotor.matrices()[0])
        scales = np.concatenate([np.full(size, np.abs(velocity).max()), heavy, [inputs["speed"]]])
        self._note("exchange", rates[: count + 1], wanted, scales)
        if felt is not None:
            if felt.rates.size:
                self._note("exchange", rates[count + 1 :], felt.rates, felt.rate_scales)
            ours = np.array(self.exchange.get(*(f"force[{i}]" for i in mounts)))
            self._note("force", ours, force, np.full(u.size, load_size(rotor)))
        self._partials(felt)
        left = felt is not None and any(felt.outside)
        self._outside += left
        return left

    def _partials(self, felt: Felt | None) -> None:
        """Derivatives of the journal's accelerations by its position and velocity."""
        rotor = self.rotor
        _, C, K = rotor.matrices()
        size = len(C)
        journal, none = slice(size // 2, size), np.zeros(len(rotor.mounts))
        axes = [("x", "y")[k] for k in rotor.axes]
        for what, linear, slopes in (
            ("", K, none if felt is None else felt.stiffness),
            ("_velocity", C, none if felt is None else felt.damping),
        ):
            wanted = linear[journal, journal] + rotor.bearings * (rotor.normals.T * slopes) @ rotor.normals
            wanted = wanted / rotor.journal_mass
            ours = [
                [-self.exchange.gradient(f"der(journal_velocity_{a})", f"journal{what}_{b}") for b in axes]
                for a in axes
            ]
            self._note("derivatives", np.array(ours), wanted, np.full(wanted.shape, np.abs(wanted).max()))

    def _note(self, name: str, ours: _Floats, wanted: _Floats, scales: _Floats) -> None:
        self._gaps[name] = max(self._gaps[name], difference(ours.ravel(), wanted.ravel(), scales.ravel()))

    def found(self) -> Verification:
        """Differences of the states compared so far; those of the run itself are not in it."""
        return Verification((), 0, self._outside, 0, tangents=0.0, flags=0, **self._gaps)
