"""Work and estimated time of a study, from its file alone: nothing is solved here."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy

from ehlcontact.checks.admissible_range import MEASURED
from ehlcontact.cli.study.damper import too_long
from ehlcontact.cli.study.loads import defect_field, place_of, ring_load, spall_in
from ehlcontact.cli.study.machine import bearing_of
from ehlcontact.cli.study.periodic import Branch, branches_of
from ehlcontact.cli.study.points.kept import STORE, Kept, stage_key
from ehlcontact.cli.study.rotor import build_rotor
from ehlcontact.cli.study.schema import Study
from ehlcontact.cli.study.shared_entries import supply_and_heat, supply_words
from ehlcontact.cli.study.stages import Stage, stages_of
from ehlcontact.cli.study.uncertain import Batch, batches_of
from ehlcontact.jit import is_kept
from ehlcontact.solver.compiled_beside import solver_is_kept
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.grid import Grid
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.mesh_choice import FINENESS, LARGEST_MESH, Purpose, mesh_for
from reduced_models.bearing.catalogue import designation_of
from reduced_models.elements.film_law import film_drive, films

CONV = 2.3e-3  # seconds of one when those studies were run
REST = 10.0 / CONV  # fits, impedance, FMU, reduced rotors and report, of either study
# Convolutions of the machine in time on models of its bearings: its diagram, and each of its steps.
MODELS, MODEL_STEP = 470.0, 0.016
MACHINE = 600.0  # of the state of the machine, a bearing
CONDITION = 260.0  # of oil supply and heat, from tables; where contacts are solved some thousands
COMPILED_FILMS, COMPILED_ELEMENTS = 20_000.0, 2_000.0  # convolutions of compiling the solver, and elements
REFERENCE_RUNS = 15  # convolutions timed, of which the fastest counts
# What too coarse a mesh does, measured against finer grids: the 6205 at n = 64, and solver/mesh_choice.py.
FILM_TOO_THIN = "it comes out a fifth too thin, or negative"
DAMPING_OFF = "damping is 12 to 16 % off at 0.6 of that, a few at a third"


@dataclass(frozen=True)
class Plan:
    """Work and estimated time of one stage."""

    stage: Stage
    mesh: Mesh
    contacts: int
    steps: int  # 0: one steady film
    step: float | None  # dimensionless time; None where it follows from the film
    seconds: float  # estimated
    kept: bool  # finished in the folder already

    def to_dict(self) -> dict[str, Any]:
        """All of it in numbers."""
        return {
            "name": self.stage.name,
            "title": self.stage.title,
            "n": self.mesh.n,
            "nodes": round(self.mesh.nodes),
            "contacts": self.contacts,
            "steps": self.steps,
            "step": self.step,
            "seconds": self.seconds,
            "kept": self.kept,
        }


@dataclass(frozen=True)
class Forecast:
    """Work and estimated time of a study."""

    study: Study
    folder: Path
    jobs: int
    conv: float  # seconds of one convolution here and now
    plans: tuple[Plan, ...]
    compiling: float  # seconds of kernels that are not kept compiled
    closed: bool  # results and report are there, of this study
    samples: float  # seconds of samples of uncertain entries that are not kept
    branch: float  # seconds of the branch of periodic answers, where it is not kept
    films: str  # oil supply and heat of the bearing, in words; empty of flooded isothermal ones
    warnings: tuple[str, ...]

    @property
    def seconds(self) -> float:
        """Estimate of the whole: stages side by side, longest first as the runner takes them, then the rest."""
        loads = [self.branch, *[0.0] * (self.jobs - 1)]
        for plan in self.plans:
            if not plan.kept:
                loads[int(np.argmin(loads))] += plan.seconds
        return max(loads) + self.samples / self.jobs + self.compiling + self.closing

    @property
    def work(self) -> float:
        """Seconds of one processor: what points of one study share among them, without `compiling`."""
        stages = sum(plan.seconds for plan in self.plans if not plan.kept)
        return stages + self.samples + self.branch + self.closing

    @property
    def closing(self) -> float:
        """Seconds of what is made of all stages."""
        return 0.0 if self.closed else closing_cost(self.study) * self.conv

    @property
    def operating_point(self) -> dict[str, Any] | None:
        """Contact of the most loaded ball, and its units in SI; None of a study without [contact]."""
        study = self.study
        if study.contact is None:
            return None
        point = study.point
        m, s = point.moes, point.scales
        return {
            "M": m.M,
            "L": m.L,
            "kappa": m.kappa,
            "p_hertz": s.pressure,
            "ball_load": study.ball_load,
            "u_sum": point.u_sum,
            "a": s.a,
            "b": s.b,
            "length": s.length,
            "time": s.time,
            "h_central_expected": m.expected_film * s.length,
            "inlet_width": m.inlet_width,
            "rotor_omega": study.rotor_omega,
        }

    def to_dict(self) -> dict[str, Any]:
        """Everything, in SI units."""
        return {
            "title": self.study.title,
            "operating_point": self.operating_point,
            "domain": None if self.study.contact is None else self.study.domain.as_tuple(),
            "folder": str(self.folder),
            "stages": [plan.to_dict() for plan in self.plans],
            "samples_seconds": self.samples,
            "branch_seconds": self.branch,
            "films": self.films,
            "jobs": self.jobs,
            "compiling_seconds": self.compiling,
            "closing_seconds": self.closing,
            "seconds": self.seconds,
            "warnings": list(self.warnings),
        }


def forecast(study: Study, folder: Path, jobs: int, root: Path | None = None) -> Forecast:
    """Estimate a study, less what its folder holds already.

    Parameters
    ----------
    study : Study
    folder : Path
        Of its results; it need not exist.
    jobs : int
        Computations side by side.
    root : Path, optional
        Folder of all points of the study, by default `folder`.
    """
    conv, root = convolution_seconds(), folder if root is None else root
    store = Kept(root) if (root / STORE).is_dir() else None
    plans = []
    for stage in stages_of(study):
        estimate = conv * stage_cost(stage, study)
        kept = store is not None and store.get(stage_key(stage, study)) is not None
        plans.append(Plan(stage, _mesh(stage, study), *_steps(stage, study), estimate, kept))
    tasks: list[Batch | Branch] = [*batches_of(study), *branches_of(study)]
    lacking = [task for task in tasks if store is None or store.get(stage_key(task, study)) is None]
    samples, branch = (
        conv * sum(task.cost(study) for task in lacking if isinstance(task, kind)) for kind in (Batch, Branch)
    )
    closed = (
        store is not None and all(p.kept for p in plans) and not lacking and store.final(study, folder) is not None
    )
    compiling = conv * compiling_cost(study, any(not plan.kept for plan in plans), not closed)
    about = films_words(study), tuple(cautions(study))
    return Forecast(study, folder, jobs, conv, tuple(plans), compiling, closed, samples, branch, *about)


def films_words(study: Study) -> str:
    """Films of the bearing beside flooded isothermal ones, in words; empty where none are asked for."""
    supply, thermal = supply_and_heat(study.operation, "operation", study.lubricant)
    conditions = (
        "" if thermal is None else "with heat (thermal)",
        "" if supply is None else f"under a layer of oil, {supply_words(supply)}",
    )
    return " and ".join(filter(None, conditions))


def stage_cost(stage: Stage | Branch | Batch, study: Study) -> float:
    """Estimated cost of a stage, in convolutions."""
    if not isinstance(stage, Stage):
        return stage.cost(study)
    contacts, steps, _ = _steps(stage, study)
    return float(stage.cost * max(1, steps) * contacts * _mesh(stage, study).nodes * 1e-3)


def closing_cost(study: Study) -> float:
    """Likewise of what is made of all stages: fits, FMUs, reduced rotors, rotors on whole bearings, report."""
    rest = REST * (study.contact is not None) + MACHINE * len(study.support) + oil_and_heat_cost(study)
    models = study.in_time
    return rest + (
        0.0 if models is None else MODELS + MODEL_STEP * models.revolutions * models.steps_per_revolution
    )


def compiling_cost(study: Study, solved: bool, rest: bool) -> float:
    """Likewise of the compilation of kernels that are not kept: of stages that solve films, and of what follows.

    What follows needs the film law of bearings in oil, and the force over time that elements are fitted by.
    Processes side by side compile each kernel once, and wait for each other.
    """
    needed = [films] * (study.oil is not None) + [film_drive] * (study.contact is not None)
    cost = COMPILED_FILMS if solved and not solver_is_kept() else 0.0
    return cost + (COMPILED_ELEMENTS if rest and not all(map(is_kept, needed)) else 0.0)


def oil_and_heat_cost(study: Study) -> float:
    """Likewise of the bearings with heat and with a layer of oil, where they are asked for."""
    asked = study.operation
    heat, layer = asked.thermal, asked.layer_um is not None or asked.layer_ratio is not None
    return len(study.support) * CONDITION * (1 + heat) * (1 + layer) if heat or layer else 0.0


def convolution_seconds() -> float:
    """Seconds of the reference convolution on this machine, as in tests/benchmarks/run.py but from fewer runs."""
    field, kernel = np.ones((257, 257)), np.ones((512, 257), dtype=complex)
    times = []
    for _ in range(REFERENCE_RUNS):
        start = time.perf_counter()
        scipy.fft.irfft2(scipy.fft.rfft2(field, (512, 512), workers=1) * kernel, (512, 512), workers=1)
        times.append(time.perf_counter() - start)
    return min(times)


def _mesh(stage: Stage, study: Study) -> Mesh:
    assert study.contact is not None
    n = study.contact.n if stage.steps is None else study.contact.n_transient
    return Mesh(n, study.domain, study.point.moes.kappa)


def _steps(stage: Stage, study: Study) -> tuple[int, int, float | None]:
    """Contacts, steps and their dimensionless length, None where the film decides it; a steady film has none."""
    if stage.steps is None:
        return 1, 0, None
    steps = stage.steps(study)
    contacts = len(build_rotor(study).mounts) if steps.on_rotor else 1
    return contacts, steps.number, None if steps.period is None else steps.period / steps.per_period


def cautions(study: Study) -> list[str]:
    """Warnings about grids and numbers that the study will run with, but not accurately."""
    contact = [] if study.contact is None else [*_coarse(study), *_outside(study)]
    return [*contact, *discs_without_inertia(study), *too_long(study), *_deep_spall(study)]


def discs_without_inertia(study: Study) -> list[str]:
    """Warnings of discs that are points by their entries, which a rotor core is not."""
    if study.shaft is None or study.shaft.stiffness is not None:
        return []
    names = ["disc" if len(study.disc) == 1 else f"disc.{k + 1}" for k in range(len(study.disc))]
    return [
        f"{name} has a mass and no diametral_inertia: a point; modes that tilt it are higher than those of a disc"
        for name, disc in zip(names, study.disc, strict=True)
        if disc.mass is not None and not disc.diametral_inertia
    ]


def seals_left_out(study: Study) -> list[str]:
    """What seals and shields in the names of bearings add to the torque, which is in no model here."""
    said = [designation_of(one.bearing).without_friction for one in study.support if one.bearing is not None]
    return list(dict.fromkeys(filter(None, said)))


def _deep_spall(study: Study) -> list[str]:
    """Warnings of spalls over which the most loaded ball loses its load, by the dry bearing at rest."""
    found = []
    for k in range(len(study.defect)):
        spall = spall_in(study, k)
        place = place_of(study, study.defect[k], defect_field(study, k, "support"))
        approach = bearing_of(study, place, oil=False).equilibrium(ring_load(study, place)).approach
        pressed = float(approach.sum(axis=-1).max())
        if spall.depth >= pressed:
            found.append(
                f"{defect_field(study, k, 'spall')} is {1e6 * spall.depth:.3g} um deep, the balls are pressed by"
                f" {1e6 * pressed:.3g} um at most: "
                "they lose their load over it, and the linear forces of the report mean nothing; its orders hold. "
                "simulate_rotor computes the force (docs/defects.md)"
            )
    return found


def _coarse(study: Study) -> list[str]:
    """Warnings of grids too coarse for the inlet, and of a region too small."""
    point, domain, found, settings = study.point.moes, study.domain, [], study.contact
    assert settings is not None
    for key, n, purpose, why in (
        ("n", settings.n, Purpose.FILM, FILM_TOO_THIN),
        ("n_transient", settings.n_transient, Purpose.RUN, DAMPING_OFF),
    ):
        size = Mesh(n, domain, point.kappa).size
        wanted = min(FINENESS[purpose].share * point.inlet_width, LARGEST_MESH)
        if size > wanted * (1.0 + 1e-9):
            better = mesh_for(point, purpose, grid=Grid(domain=domain)).n
            advice = (
                f"{key} = {better}" if better > n else "the library chooses none finer: it would take too long"
            )
            found.append(
                f"contact.{key} = {n}: a mesh of {size:.2g} semi-axes is too coarse for the inlet of this film, "
                f"{point.inlet_width:.2g} wide ({why}); {advice}"
            )
    wide = Domain.for_point(point, study.largest_load)
    if wide.x_in < domain.x_in or wide.y_max > domain.y_max or wide.x_out > domain.x_out:
        bounds = ", ".join(f"{x:.3g}" for x in wide.as_tuple())
        found.append(f"contact.domain = {list(domain.as_tuple())}: this load wants [{bounds}] or more")
    return found


def _outside(study: Study) -> list[str]:
    """Warnings of numbers beyond those that the solver was measured at."""
    m, found = study.point.moes, []
    for name in ("M", "L", "kappa"):
        low, high = getattr(MEASURED, name)
        if not low <= getattr(m, name) <= high:
            found.append(f"{name} = {getattr(m, name):.4g}: the solver is measured between {low:g} and {high:g}")
    if m.p_hertz > MEASURED.p_hertz:
        found.append(f"Hertz pressure {m.p_hertz * 1e-9:.2f} GPa: the solver is measured up to 3.5 GPa")
    return found
