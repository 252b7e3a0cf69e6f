"""Everything a study found, in numbers."""

from __future__ import annotations

import platform
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version as distribution_version
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact.assumptions import Assumptions, assumptions
from ehlcontact.cli.study.reduction import RECORDS, Reduction, export_fmu, reduce_records, save_elements
from ehlcontact.cli.study.rotor import RotorComparison, compare_rotors
from ehlcontact.cli.study.schema import Study
from ehlcontact.errors import InputError
from ehlcontact.origin import __version__
from ehlcontact.results import SteadyResult
from ehlcontact.storage import load
from ehlcontact.transient.result import SimulationResult

LIBRARIES = ("numpy", "scipy", "numba", "fmpy", "h5py")


@dataclass(frozen=True)
class Findings:
    """Results of all stages and what was made of them."""

    study: Study
    steady: SteadyResult
    simulations: Mapping[str, SimulationResult]
    reduction: Reduction
    rotors: RotorComparison
    fmu: Mapping[str, Any]
    seconds: Mapping[str, float]  # wall time by stage

    @property
    def operating_point(self) -> dict[str, float]:
        """Numbers of the contact, SI unless the name has a unit."""
        moes, scales, oil = self.study.point.moes, self.study.point.scales, self.study.lubricant
        return {
            "M": moes.M,
            "L": moes.L,
            "kappa": moes.kappa,
            "load": scales.force,
            "radial_load": self.study.bearing.radial_load,
            "u_sum": self.study.point.u_sum,
            "eta0": oil.eta0,
            "alpha": oil.alpha,
            "p_hertz": scales.pressure,
            "a": scales.a,
            "b": scales.b,
            "dry_approach": scales.length,
            "time_unit": scales.time,
            "approach": self.steady.approach,
            "approach_m": self.steady.approach * scales.length,
            "h_central_um": self.steady.h_central * scales.length * 1e6,
            "h_min_um": self.steady.h_min * scales.length * 1e6,
            "rotor_omega": self.study.rotor_omega,
        }

    @property
    def assumptions(self) -> Assumptions:
        """What was assumed, and how far it holds; vibration is that of the journal on full contacts."""
        velocity = np.linalg.norm(self.rotors.full.journal_velocity, axis=1)
        return assumptions(
            self.study.point,
            film=self.steady,
            roughness=self.study.roughness,
            vibration=float(velocity.max()),
        )

    @property
    def cycle_work(self) -> dict[str, float]:
        """Work taken up in the last cycle of the rotor-band record [J]: by the film, and by the elements."""
        run, scales = self.simulations["rotor_band"], self.study.point.scales
        last = run.T >= run.T[-1] - self.study.rotor_motion.period * (1.0 + 1e-9)
        u, rate = run.approach[last], run.rate[last]
        forces = {"full": run.force[last]}
        for (record, model), found in self.reduction.fits.items():
            if model == "cubic" and record != "free":
                forces[record] = np.asarray(found.element.force(u, rate))
        memory = self.reduction.memory
        if not isinstance(memory, str):
            forces["memory"] = memory.element.drive(run.T, run.approach, run.rate)[last]
        unit = scales.force * scales.length
        return {name: float(np.trapezoid(force, u)) * unit for name, force in forces.items()}

    @property
    def versions(self) -> dict[str, str]:
        """Software the numbers come from."""
        found = {name: distribution_version(name) for name in LIBRARIES}
        return {"ehlcontact": __version__, "python": platform.python_version(), **found, "platform": sys.platform}

    @property
    def fits(self) -> list[dict[str, Any]]:
        """One row per record and model, refused ones with the reason."""
        rows: list[dict[str, Any]] = []
        for (record, model), found in self.reduction.fits.items():
            si = self.reduction.element_si(record, model)
            rows.append({"record": record, "si": si.parameters, **found.to_dict()})
        for (record, model), reason in self.reduction.refused.items():
            rows.append({"record": record, "model": model, "refused": reason})
        return sorted(rows, key=lambda row: (list(RECORDS).index(row["record"]), row["model"]))

    @property
    def memory(self) -> dict[str, Any]:
        """The film-memory element and the impedance it was fitted to, or why there is none."""
        found, response = self.reduction.memory, self.reduction.impedance
        if isinstance(found, str) or response is None:
            return {"refused": found}
        return found.to_dict() | {"impedance": response.summary()}

    @property
    def answer(self) -> str:
        """What the study found, in one paragraph."""
        point, s = self.operating_point, self.study
        chosen = self.reduction.chosen
        found = self.reduction.fits["rotor_band", "cubic"]
        c = self.rotors.whole["rotor_band"]
        displacement, force = 100.0 * (c.displacement or 0.0), 100.0 * (c.force or 0.0)
        k = float(chosen.stiffness(chosen.approach_at(point["load"]), 0.0))
        lesson = ""
        one = self.rotors.whole.get("memory")
        if one is not None:
            lesson = (
                f" One film-memory element, fitted to the impedance and all records at once, has "
                f"{100.0 * (one.displacement or 0.0):.2f} % and {100.0 * (one.force or 0.0):.2f} %, and holds in "
                f"every band."
            )
        wrong = self.reduction.fits.get(("harmonic", "cubic"))
        if wrong is not None and wrong.parameters["C1"] > 0.0:
            ratio = found.parameters["C1"] / wrong.parameters["C1"]
            lesson += (
                f" Fitted at Omega = {s.harmonic_motion.Omega:.3g}, the contact's own band, the cubic has a "
                f"damping {ratio:.1f} times smaller: an element is good for the band it was fitted in."
            )
        return (
            f"The most loaded ball of this {s.bearing.name} presses {point['load']:.0f} N on the {s.bearing.race} "
            f"race (M = {point['M']:.0f}, L = {point['L']:.1f}, kappa = {point['kappa']:.3f}, "
            f"{point['p_hertz'] * 1e-9:.2f} GPa) and rolls on an oil film of {point['h_central_um']:.3f} um, "
            f"{point['h_min_um']:.3f} um at its thinnest. For the rotor at {s.bearing.speed_rpm:.0f} rpm "
            f"the contact is a spring of {k * 1e-6:.1f} N/um with a damper of {chosen.C1:.0f} N s/m: with this "
            f"cubic element in place of the film, displacements differ by {displacement:.2f} % and contact "
            f"forces by {force:.2f} % of their dynamic amplitude (rms).{lesson}"
        )

    def to_dict(self) -> dict[str, Any]:
        """Content of ``results.json``."""
        keys = ("static_approach", "steps", "seconds")
        return {
            "status": "converged",
            "title": self.study.title,
            "answer": self.answer,
            "operating_point": self.operating_point,
            "assumptions": self.assumptions.to_dict(),
            "steady": self.steady.summary(),
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
            "cycle_work": self.cycle_work,
            "rotor": self.rotors.to_dict(),
            "seconds": self.seconds,
            "versions": self.versions,
        }


def evaluate(study: Study, folder: Path, ledger: Mapping[str, Mapping[str, Any]]) -> Findings:
    """Reduce, export and compare what the stages left in the folder; files are written on the way."""
    started = time.perf_counter()
    steady = load(folder / "steady.h5")
    simulations = {name: load(folder / f"{name}.h5") for name in RECORDS}
    if not isinstance(steady, SteadyResult):
        raise InputError("file", str(folder / "steady.h5"), "a steady film")
    histories = {name: run for name, run in simulations.items() if isinstance(run, SimulationResult)}
    scales = study.point.scales
    assumed = assumptions(study.point, film=steady, roughness=study.roughness).short()
    reduction = reduce_records(histories, scales, assumed)
    save_elements(reduction, folder)
    exported = export_fmu(reduction.chosen, folder / "contact.fmu")
    rotors = compare_rotors(study, reduction.rotor_elements, folder)
    seconds = {name: float(note["seconds"]) for name, note in ledger.items()}
    seconds["elements, FMU, reduced rotors"] = time.perf_counter() - started
    return Findings(study, steady, histories, reduction, rotors, exported, seconds)
