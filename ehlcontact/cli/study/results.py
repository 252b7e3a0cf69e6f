"""Results of a study in numbers: ``results.json``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import Any

import numpy as np

from ehlcontact.assumptions import Assumptions, assumptions
from ehlcontact.cli.study.defect import StudyDefect
from ehlcontact.cli.study.differences import RotorFindings
from ehlcontact.cli.study.machine import carrier_of, clearance_of
from ehlcontact.cli.study.periodic import StudyBranch
from ehlcontact.cli.study.points.folder import versions
from ehlcontact.cli.study.reduction import (
    CONTACTS,
    FULL,
    RECORDS,
    ROTOR_BAND,
    Reduction,
)
from ehlcontact.cli.study.rotor import stiffness_and_damping
from ehlcontact.cli.study.schema import Study
from ehlcontact.film_formulas import film_scatter
from ehlcontact.results import SteadyResult
from ehlcontact.transient.result import SimulationResult
from reduced_models.bearing.coefficients import BearingCoefficients
from reduced_models.bearing.oil_and_heat import OilAndHeat
from reduced_models.bearing.operating_clearance import OperatingClearance
from reduced_models.margins.result import Uncertainty
from reduced_models.rotor.bearing_set import BearingSet
from reduced_models.rotor.compare_bearing_models import BearingModels
from reduced_models.rotor.machine_state import MachineState
from reduced_models.rotor.machine_tiles import Tile


@dataclass(frozen=True)
class Findings:
    """Results of all stages and what was made of them."""

    study: Study
    machine: MachineState | str  # or why there is none
    over_frequency: Mapping[str, BearingCoefficients]  # K and C of the bearings, by the name of the support
    whole: BearingModels | None  # where the machine is run in time on models of its bearings
    oil_and_heat: Mapping[
        str, OilAndHeat | str
    ]  # with a layer of oil or heat, by the support; or why there is none
    defects: tuple[StudyDefect, ...]
    contact: ContactFindings | None
    rotors: RotorFindings | None  # on full films
    exports: Mapping[str, Any]  # files of [export], as of `write_exports`
    seconds: Mapping[str, float]  # wall time by stage
    uncertainty: Uncertainty | None = None  # of a study with [uncertain]
    periodic: StudyBranch | None = None  # of a study with [periodic]

    @cached_property
    def tiles(self) -> tuple[Tile, ...]:
        """Tiles of the machine, with intervals of their numbers first in their notes; none without a machine.

        The last one is of periodic answers.
        """
        last = () if self.periodic is None else (self.periodic.tile,)
        return (*self._of_machine, *last)

    @property
    def _of_machine(self) -> tuple[Tile, ...]:
        if isinstance(self.machine, str):
            return ()
        found = self.uncertainty
        if found is None:
            return tuple(self.machine.tiles())
        between = {tile: found.between(found.alike(tile.number)) for tile in self.machine.tiles()}
        return tuple(
            tile._replace(note="; ".join(filter(None, (words, tile.note)))) for tile, words in between.items()
        )

    @cached_property
    def clearances(self) -> dict[str, OperatingClearance]:
        """Clearance in operation of the bearings with fits, by the support."""
        every = ((name, clearance_of(self.study, k)) for k, name in enumerate(self.study.names))
        return {name: one for name, one in every if one is not None}

    @cached_property
    def preloads(self) -> dict[str, tuple[float, float]]:
        """Preload of pairs on fits, before mounting and mounted, warm and unloaded [N]; by the support."""
        found = {}
        for k, name in enumerate(self.study.names):
            one = self.study.support[k]
            if name in self.clearances and one.pair not in (None, "tandem"):
                pair = carrier_of(self.study, k, oil=False)
                assert isinstance(pair, BearingSet)
                found[name] = one.pair_spring or one.preload or 0.0, pair.preload
        return found

    def to_dict(self) -> dict[str, Any]:
        """Numbers of ``results.json``."""
        machine = self.machine
        return {
            "machine": None if isinstance(machine, str) else machine.to_dict(),
            "no_machine": machine if isinstance(machine, str) else None,
            "uncertainty": None if self.uncertainty is None else self.uncertainty.to_dict(),
            "over_frequency": {
                name: {"hz": one.hz, "stiffness": one.stiffness, "damping": one.damping}
                for name, one in self.over_frequency.items()
            },
            "clearances": {
                name: one.to_dict()
                | dict(zip(("preload_before_mounting", "preload"), self.preloads.get(name, ()), strict=False))
                for name, one in self.clearances.items()
            },
            "periodic": None if self.periodic is None else self.periodic.to_dict(),
            "in_time": None if self.whole is None else self.whole.to_dict(),
            "oil_and_heat": {
                name: one if isinstance(one, str) else one.to_dict() for name, one in self.oil_and_heat.items()
            },
            "defects": [one.to_dict() for one in self.defects],
            **({} if self.contact is None else self.contact.to_dict()),
            **({} if self.rotors is None else {"rotor": self.rotors.to_dict()}),
            "export": self.exports,
            "seconds": self.seconds,
            "versions": versions(),
        }


@dataclass(frozen=True)
class ContactFindings:
    """The contact of the most loaded ball: film, motions, elements and FMUs; and the rotor on full films."""

    study: Study
    steady: SteadyResult
    simulations: Mapping[str, SimulationResult]
    reduction: Reduction
    rotors: RotorFindings | None
    fmu: Mapping[str, Any]  # of the cubic of the rotor's band
    film_fmu: Mapping[str, Any] | None  # of the element with a film memory, where there is one

    @property
    def operating_point(self) -> dict[str, Any]:
        """Numbers of the contact, SI unless the name has a unit; errors of films over the films, or None."""
        error = self.steady.error_estimate
        moes, scales, oil = self.study.point.moes, self.study.point.scales, self.study.point.lubricant
        return {
            "M": moes.M,
            "L": moes.L,
            "kappa": moes.kappa,
            "load": scales.force,
            "radial_load": self.study.radial_load,
            "u_sum": self.study.point.u_sum,
            "eta0": oil.eta0,
            "alpha": oil.alpha,
            "p_hertz": scales.pressure,
            "a": scales.a,
            "b": scales.b,
            "dry_approach": scales.length,
            "time_unit": scales.time,
            "approach": self.steady.approach,
            "h_central_um": self.steady.h_central * 1e6,
            "h_min_um": self.steady.h_min * 1e6,
            "approach_error": None if error is None else error.approach,
            "h_central_error": None if error is None else error.h_central_relative,
            "h_min_error": None if error is None else error.h_min_relative,
            "h_oil_scatter": self.oil_scatter,
            "rotor_omega": self.study.rotor_omega,
        }

    @property
    def oil_scatter(self) -> float | None:
        """Relative scatter of the film by that of the oil; None where the oil has none."""
        oil, moes = self.study.point.lubricant, self.study.point.moes
        if not (oil.eta0_scatter or oil.alpha_scatter):
            return None
        return film_scatter(moes.M, moes.L, moes.kappa, oil.eta0_scatter or 0.0, oil.alpha_scatter or 0.0)

    @property
    def fmus(self) -> list[Mapping[str, Any]]:
        """Entries of `to_dict` about the FMUs of the study."""
        return [entry for entry in (self.fmu, self.film_fmu) if entry is not None]

    @property
    def assumptions(self) -> Assumptions:
        """Assumptions and how far they hold; vibration is that of the journal on full contacts."""
        known: dict[str, Any] = {"film": self.steady, "roughness": self.study.roughness}
        if self.rotors is not None:
            runs = (self.rotors.unbalance.full, self.rotors.decay.runs[FULL])
            velocity = np.concatenate([np.linalg.norm(run.journal_velocity, axis=1) for run in runs])
            known["vibration"] = float(velocity.max())
        return assumptions(self.study.point, **known)

    @property
    def cycle_work(self) -> dict[str, float]:
        """Work taken up in the last cycle of the rotor-band record [J]: by the film, and by the elements."""
        run = self.simulations["rotor_band"]
        period = self.study.rotor_motion.period * run.point.scales.time
        last = run.t >= run.t[-1] - period * (1.0 + 1e-9)
        u, rate = run.approach[last], run.rate[last]
        forces = {"full": run.force[last]}
        for (record, model), found in self.reduction.fits.items():
            if model == "cubic" and record != "free":
                forces[record] = np.asarray(found.element.force(u, rate))
        memory = self.reduction.memory
        if not isinstance(memory, str):
            forces["memory"] = memory.element.drive(run.t, run.approach, run.rate)[last]
        return {name: float(np.trapezoid(force, u)) for name, force in forces.items()}

    @property
    def fits(self) -> list[dict[str, Any]]:
        """One row per record and model, in SI; refused ones with the reason."""
        rows: list[dict[str, Any]] = []
        for (record, _), found in self.reduction.fits.items():
            rows.append({"record": record, **found.to_dict()})
        for (record, model), reason in self.reduction.refused.items():
            rows.append({"record": record, "model": model, "refused": reason})
        return sorted(rows, key=lambda row: (list(RECORDS).index(row["record"]), row["model"]))

    @property
    def memory(self) -> dict[str, Any]:
        """The film-memory element and the impedance it was fitted to, or why there is none."""
        found, response = self.reduction.memory, self.reduction.impedance
        if isinstance(found, str):
            return {"refused": found, "impedance": response.to_dict()}
        return found.to_dict() | {"impedance": response.to_dict()}

    @property
    def at_rotor_speed(self) -> dict[str, float]:
        """Stiffness [N/m] and damping [N s/m] of one contact at the rotor's frequency, by its impedance."""
        K, C = stiffness_and_damping(self.reduction.impedance, 2.0 * pi * self.study.rotor_hz)
        return {"stiffness": K, "damping": C}

    @property
    def at_kicked_mode(self) -> dict[str, float] | None:
        """Stiffness and damping at the frequency of the mode that is kicked, of a rotor on full films."""
        if self.rotors is None:
            return None
        omega = self.rotors.decay.mode.omega
        K, C = stiffness_and_damping(self.reduction.impedance, omega)
        return {"omega": omega, "stiffness": K, "damping": C}

    @property
    def damper_of_fit(self) -> dict[str, Any]:
        """The chosen element's damper and its 95 % interval [N s/m]."""
        interval = self.reduction.fits[ROTOR_BAND].intervals["C1"]
        return {"damping": self.reduction.chosen.C1, "interval": list(interval)}

    @property
    def rotor_loop(self) -> dict[str, float]:
        """Over the load, in the rotor's band: largest force of the cubic's damper, and the cubic's rms misfit."""
        found, run = self.reduction.fits[ROTOR_BAND], self.simulations[ROTOR_BAND[0]]
        start, end = found.window[0]
        fitted = (run.t >= start * (1.0 - 1e-12)) & (run.t <= end * (1.0 + 1e-12))  # but for rounding
        load = run.static_load
        return {
            "damper": found.parameters["C1"] * float(np.abs(run.rate[fitted]).max()) / load,
            "misfit": found.rms * float(np.std(run.force[fitted])) / load,
        }

    @property
    def spectrum_resolution(self) -> float | None:
        """Distance of the lines of the spectrum of the rotor on full films [Hz]."""
        films = self.study.full_films
        if self.rotors is None or films is None:
            return None
        first = self.rotors.unbalance.settling[FULL].settled_from
        return self.study.rotor_hz / (1 if first is None else films.revolutions - first)

    @property
    def warnings(self) -> list[str]:
        """Warnings of elements outside their validity box, each once per run, with the contacts concerned."""
        said: dict[str, list[str]] = {}
        if self.rotors is None:
            return []
        for when, events in (("unbalance", self.rotors.unbalance.events), ("kick", self.rotors.decay.events)):
            for name, contacts in events.items():
                for number, one in enumerate(contacts):
                    for text in one.warnings:
                        said.setdefault(f"{when}, {CONTACTS[name]}: {text}", []).append(str(number))
        return [f"{text} (contact {', '.join(numbers)})" for text, numbers in said.items()]

    @property
    def thinnest(self) -> dict[str, float]:
        """Where the film is lowest, in semi-axes, on the upper half."""
        film, s = self.steady, self.study.point.scales
        i, j = np.unravel_index(int(np.argmin(film.h)), film.h.shape)
        return {"X": float(film.x[i]) / s.a, "Y": float(film.y[j]) / s.b}

    def to_dict(self) -> dict[str, Any]:
        """Numbers of the contact in ``results.json``."""
        keys = ("static_approach", "steps", "seconds")
        return {
            "operating_point": self.operating_point,
            "assumptions": self.assumptions.to_dict(),
            "steady": self.steady.to_dict(),
            "simulations": {
                name: {key: getattr(run, key) for key in keys}
                | {
                    "n": run.n,
                    "domain": list(run.domain.as_tuple()),
                    "motion": run.motion.to_dict(),
                    "force_range": [float(run.force.min()), float(run.force.max())],
                    "largest_load_residual": float(np.abs(run.load_residuals).max()),
                }
                for name, run in self.simulations.items()
            },
            "fits": self.fits,
            "memory": self.memory,
            "fmu": self.fmu,
            "film_fmu": self.film_fmu,
            "cycle_work": self.cycle_work,
            "at_rotor_speed": self.at_rotor_speed,
            "at_kicked_mode": self.at_kicked_mode,
            "damper_of_fit": self.damper_of_fit,
            "rotor_loop": self.rotor_loop,
            "spectrum_resolution": self.spectrum_resolution,
            "warnings": self.warnings,
        }
