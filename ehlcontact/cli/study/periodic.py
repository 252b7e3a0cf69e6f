"""Periodic answers of a study with [periodic]: the branch as a task of a run, its words, numbers and table."""

from __future__ import annotations

import csv
import io
import time
import warnings
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.study.machine import clearance_of, disc_of, rotor_of
from ehlcontact.cli.study.stages import Answer, reporting
from ehlcontact.content_store import key_of
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.files import write_text
from ehlcontact.results.picture import Picture
from ehlcontact.status import Status
from ehlcontact.store import content_of, read
from reduced_models.periodic_motion.branch_result import PeriodicBranch
from reduced_models.periodic_motion.excitation import UNBALANCE
from reduced_models.periodic_motion.periodic import LEAST_SAMPLES, TOO_FEW, TooFewHarmonicsWarning, periodic
from reduced_models.rotor.machine_tiles import Tile

if TYPE_CHECKING:
    from ehlcontact.cli.study.schema import Study

SECTION, TABLE = "periodic", "periodic.csv"
# Sections that it depends on
OF_MACHINE = "operation", "oil", "surface", "shaft", "disc", "support", "damper", SECTION
ANSWERS = 150  # of a branch, about
COST, COST_OF_STABILITY = 0.3, 1.0  # of a sample of an answer, a bearing, in convolutions
MULTIPLIERS, STEPS = 2, 96  # of an answer; time steps of its period, at least
NOTHING = 1e-12  # m, motion that is rounding
PLANE = "xy"


def require_periodic(study: Study) -> None:
    """Raise `InputError` for a branch that is none, or of what does not excite the machine."""
    asked = study.periodic
    if asked is None:
        return
    if asked.to_rpm == asked.from_rpm:
        raise InputError("periodic.to_rpm", asked.to_rpm, "another speed than periodic.from_rpm")
    if asked.samples_per_period < (least := LEAST_SAMPLES * asked.harmonics):
        allowed = f"at least {least}, {LEAST_SAMPLES} times periodic.harmonics"
        raise InputError("periodic.samples_per_period", asked.samples_per_period, allowed)
    if asked.excitation == UNBALANCE and not any(disc_of(study, k).unbalance for k in range(len(study.disc))):
        allowed = "with a disc that has an unbalance: disc.unbalance or disc.balance_grade; or 'passage'"
        raise InputError("periodic.excitation", asked.excitation, allowed)


@dataclass(frozen=True)
class Branch:
    """The branch of a study, a task of a run."""

    name = SECTION
    title = "periodic answers"

    def cost(self, study: Study) -> float:
        """Estimated, in convolutions."""
        asked = study.periodic
        assert asked is not None
        each = COST + asked.stability * COST_OF_STABILITY
        return each * ANSWERS * asked.samples_per_period * len(study.support)

    def key(self, study: Study) -> str:
        """Hash of what it computes: of the speed of the study that alone by which the machine is another one."""
        document = study.model_dump(mode="json", exclude_none=True, include=set(OF_MACHINE))
        document["operation"].pop("speed_rpm")
        return key_of([SECTION, document, *_by_speed(study)])

    def file(self, folder: Path) -> Path:
        """Where it stands."""
        return folder / f"{SECTION}.h5"

    def partial(self, folder: Path) -> Path:
        """Where a branch stands that was interrupted."""
        return folder / f"{SECTION}.partial.h5"


def _by_speed(study: Study) -> list[list[float]]:
    """What the speed of a study changes of its machine: bearings on fits, and discs of a balance grade."""
    mounted = [clearance_of(study, k) for k in range(len(study.support))]
    fits = [] if all(one is None for one in mounted) else [study.speed_rpm]
    return [fits, [disc_of(study, k).unbalance for k in range(len(study.disc))]]


def branches_of(study: Study) -> tuple[Branch, ...]:
    """The branch of a study; none without [periodic]."""
    return () if study.periodic is None else (Branch(),)


def settings_of(study: Study) -> dict[str, Any]:
    """Arguments of `periodic`, beside the rotor."""
    asked = study.periodic
    assert asked is not None
    return {
        "between": (asked.from_rpm, asked.to_rpm),
        "excitation": asked.excitation,
        "harmonics": asked.harmonics,
        "samples": asked.samples_per_period,
    }


def solve_branch(key: str, study: Study) -> Answer:
    """Follow the branch of a study, on this machine or on a cluster; `key` is for the reports.

    A branch that ends before its range does is an answer: it says why. An interrupted one returns what it has.
    """
    started = time.perf_counter()
    asked, branch, status, message = study.periodic, None, Status.FAILED, ""
    assert asked is not None
    parts = 1.0 + asked.stability
    try:
        with reporting() as update, warnings.catch_warnings():
            warnings.simplefilter("ignore", TooFewHarmonicsWarning)  # `reservations` has it
            branch = periodic(
                rotor_of(study), callback=lambda share, _: update(min(share, 1.0), parts), **settings_of(study)
            )
            if asked.stability and branch.status is not Status.INTERRUPTED:
                branch = branch.with_multipliers(
                    MULTIPLIERS,
                    steps=max(STEPS, asked.harmonics * LEAST_SAMPLES),
                    callback=lambda made, answers: update(1.0 + made / answers, parts),
                )
        status = Status.INTERRUPTED if branch.status is Status.INTERRUPTED else Status.CONVERGED
        message = status.advice
    except (ConvergenceError, InputError) as error:
        message = str(error)
    except KeyboardInterrupt:
        status, message = Status.INTERRUPTED, "stopped before anything could be kept"
    content = None if branch is None else content_of(branch)
    return Answer({"status": str(status), "message": message, "seconds": time.perf_counter() - started}, content)


class Several(NamedTuple):
    """A range of speeds with several answers."""

    low: float  # [rev/min]
    high: float
    answers: int  # in its middle
    stable: int | None  # of them; None where that was not computed

    @property
    def words(self) -> str:
        """How many, and where."""
        count = f"{_count(self.answers)} answers"
        if self.stable is not None:
            rest = self.answers - self.stable
            beside = f" and {_count(rest, 'an')} unstable one{'s' if rest > 1 else ''}" if rest else ""
            count = f"{_count(self.stable)} stable answer{'' if self.stable == 1 else 's'}{beside}"
        return f"{count} between {_rpm(self.low)} and {_rpm(self.high)} rev/min"


@dataclass(frozen=True)
class StudyBranch:
    """The branch of a study, with the names of its machine."""

    branch: PeriodicBranch
    nodes: dict[str, dict[str, int]]  # discs and supports, by their names in the study

    @property
    def shown(self) -> dict[str, dict[str, int]]:
        """Nodes of the picture and of the largest motion: discs, or supports of a shaft without any."""
        discs = {name: at for name, at in self.nodes.items() if name.startswith("disc")}
        return discs or self.nodes

    @property
    def several(self) -> list[Several]:
        """Ranges of speeds with several answers."""
        value, known = self.branch.value, [answer.stable for answer in self.branch.answers]
        found = []
        for low, high in self.branch.multiple():
            off = value - 0.5 * (low + high)
            passed = np.flatnonzero(np.diff(np.sign(off))).tolist()
            near = [k if abs(off[k]) <= abs(off[k + 1]) else k + 1 for k in passed]
            stable = None if None in known else sum(bool(known[k]) for k in near)
            found.append(Several(low, high, len(passed), stable))
        return found

    @property
    def largest(self) -> tuple[float, float, str]:
        """Largest motion of what is shown, peak to peak [m], its speed [rev/min] and whose it is."""
        sizes = self.branch.peak_to_peak
        at = {name: sizes[:, [at[axis] for axis in PLANE if axis in at]] for name, at in self.shown.items()}
        name = max(at, key=lambda one: float(at[one].max()))
        return float(at[name].max()), float(self.branch.value[int(at[name].max(axis=1).argmax())]), name

    @property
    def answer(self) -> str:
        """How many answers there are, and where, in a sentence without its end."""
        ends = f"{_rpm(self.branch.value.min())} to {_rpm(self.branch.value.max())} rev/min"
        return "; ".join(one.words for one in self.several) or f"one answer at every speed from {ends}"

    @property
    def largest_words(self) -> str:
        """The largest motion in words."""
        size, speed, name = self.largest
        return f"largest {numeral(1e6 * size, 3)} µm peak to peak ({name}) at {_rpm(speed)} rev/min"

    @property
    def reservations(self) -> list[str]:
        """Why the branch ended early, and that harmonics are too few."""
        branch, said = self.branch, []
        if branch.reservation:
            end = _rpm(branch.answers[-1].value)
            said.append(f"periodic answers: {branch.reservation}; the last one is at {end} rev/min")
        left = max(answer.residual for answer in branch.answers)
        if left > TOO_FEW and self.largest[0] > NOTHING:
            said.append(
                "periodic answers: harmonics that are left out move the rotor by "
                f"{numeral(left, 2)} of those kept: take more periodic.harmonics"
            )
        return said

    @property
    def tile(self) -> Tile:
        """The answer in a number."""
        name, several = f"answers to {self.branch.answers[0].excitation}", self.several
        if not several:
            span = f"{_rpm(self.branch.value.min())} to {_rpm(self.branch.value.max())} rev/min"
            return Tile(name, "1", "at every speed", f"{span}; {self.largest_words}")
        most = max(several, key=lambda one: one.answers)
        count, kind = (most.answers, "") if most.stable is None else (most.stable, "stable ")
        unit = f"between {_rpm(most.low)} and {_rpm(most.high)} rev/min"
        rest = [one.words for one in several if one is not most]
        return Tile(f"{kind}{name}", str(count), unit, "; ".join([*rest, self.largest_words]))

    def picture(self) -> Picture:
        """Amplitude of the discs over the speed, and the largest multiplier."""
        first, *rest = self.branch.answers
        names = tuple(f"{node} {axis}" for node, at in self.shown.items() for axis in PLANE if axis in at)
        places = np.array([at[axis] for at in self.shown.values() for axis in PLANE if axis in at])
        run = replace(first.run, names=names, places=places)
        return replace(self.branch, answers=(replace(first, run=run), *rest)).picture()

    def table(self) -> str:
        """Content of ``periodic.csv``: a row for each answer, in the order of the branch."""
        stream = io.StringIO()
        writer = csv.writer(stream, lineterminator="\n")
        columns = {f"{name} {axis}": at[axis] for name, at in self.nodes.items() for axis in PLANE if axis in at}
        heads = (f"{name} peak to peak [um]" for name in columns)
        writer.writerow(["speed [rev/min]", *heads, "stable", "largest multiplier [-]", "fold", "residual [-]"])
        folds = set(self.branch.folds)
        for k, answer in enumerate(self.branch.answers):
            sizes = 1e6 * answer.peak_to_peak[list(columns.values())]
            found = answer.multipliers
            multiplier = "" if found is None else repr(float(np.abs(found).max(initial=0.0)))
            stable = "" if answer.stable is None else int(answer.stable)
            row = [repr(answer.value), *map(repr, sizes.tolist()), stable, multiplier, int(k in folds)]
            writer.writerow([*row, repr(float(answer.residual))])
        return stream.getvalue()

    def to_dict(self) -> dict[str, Any]:
        """Numbers of ``results.json``."""
        branch, (size, speed, name) = self.branch, self.largest
        known = all(answer.multipliers is not None for answer in branch.answers)
        return {
            "excitation": branch.answers[0].excitation,
            "answer": self.answer,
            "status": str(branch.status),
            "reservations": self.reservations,
            "answers": len(branch.answers),
            "speeds_rpm": [float(branch.value.min()), float(branch.value.max())],
            "last_rpm": branch.answers[-1].value,
            "folds_rpm": branch.fold_values.tolist(),
            "bifurcations": [{"kind": one.kind, "speed_rpm": one.value} for one in branch.bifurcations()]
            if known
            else None,
            "several": [one._asdict() for one in self.several],
            "largest": {"peak_to_peak": size, "speed_rpm": speed, "of": name},
            "residual": max(float(answer.residual) for answer in branch.answers),
            "file": TABLE,
        }


def _count(number: int, single: str = "one") -> str:
    return {0: "no", 1: single, 2: "two", 3: "three", 4: "four", 5: "five"}.get(number, str(number))


def branch_of(study: Study, folder: Path) -> StudyBranch | None:
    """The branch that its task left in the folder; its table is written. None without [periodic]."""
    if study.periodic is None:
        return None
    branch = read(Branch().file(folder), PeriodicBranch)
    nodes = {}
    for name, at in branch.answers[0].run.nodes.items():
        kind, _, number = name.partition(" ")
        if kind == "disc":
            nodes[f"disc {int(number) + 1}" if number else name] = at
        elif kind == "bearing":
            nodes[study.names[int(number)]] = at
    found = StudyBranch(branch, nodes)
    write_text(folder / TABLE, found.table(), "file")
    return found


def _rpm(speed: float) -> str:
    return f"{speed:.0f}"
