"""Labelled synthetic records: simulated acceleration of a bearing with features, with a row of metadata.

The columns are those of the metadata table of the package bearing-datasets (version 0.3, layout 2), which converts
public measurements to one format: code for these reads synthetic records too. `make_records` keeps one file per
record, `write_dataset` makes of them the Parquet files that `bearing_datasets.open` reads.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, fields, replace
from functools import cached_property
from math import ceil, hypot
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import as_column, parts, require_integer
from ehlcontact.checks.kinds import DONE, FOLDER, NAME, Count, Object, Objects, Text
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.content_store import key_of
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.executors import executor_for, results_of
from ehlcontact.files import remove_leftovers
from ehlcontact.quantities import ACCELERATION, HERTZ
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.store import read, save, stored
from ehlcontact.summary import Summary
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.bearing.excitation import HIGHEST
from reduced_models.bearing.features import Indentation, Spall, usual_waviness
from reduced_models.bearing.height_tables import LEAST_STEPS, shortest_meeting
from reduced_models.bearing.kinematics import RPM_TO_HZ, DefectOrders
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.simulate import simulate_rotor
from reduced_models.rotor.supports import BearingMount
from reduced_models.signals.indicators import indicators
from reduced_models.signals.sampling import housing_acceleration, require_sampling
from reduced_models.signals.transfer_path import ModalPath

_Floats = NDArray[np.float64]

LEAD = 0.1  # s of a simulation before its record, in which the transient of the start decays
FINER, COARSEST = 4, 48_000.0  # least steps per sample and per s: a mass on its contacts swings at some kHz
TILT_INERTIA, TILT_STIFFNESS = 1e-3, 1e5  # kg m2, N m/rad: a stiff shaft holds the ring against tilts
MOST_WAVES = 1000  # around a race: as high as noise of the measurement of roundness
SUFFIX = ".h5"
MOST_SAMPLES = 1e8  # of a record: 400 MB
LONGEST_LABEL = 100  # letters: a part of a file name
LOCATION = "test_bearing"  # of bearing and sensor, in the words of bearing-datasets
PARTS = {"inner": "inner", "outer": "outer"}  # fault types; others are of a ball
BALL = "rolling_element"


@fields_take(
    bearing=Object(BallBearing, "a BallBearing"), path=Object(ModalPath, "a ModalPath"), load=parts.FORCE,
    speed_rpm=parts.SPEED, mass=parts.MASS, noise=parts.NOISE, waviness=parts.RIM,
    seconds=parts.SECONDS, rate=parts.RATE, label=Text(LONGEST_LABEL),
)  # fmt: skip
@dataclass(frozen=True, kw_only=True, eq=False)
class RecordCase(Summary):
    """Inputs of a synthetic record: a mass on a bearing with features, a transfer path to a sensor, noise.

    Parameters
    ----------
    bearing : BallBearing
        With its features.
    load : tuple of 2 or 3 float
        On the inner ring along x, y (and z) [N]; with three the bearing has five degrees of freedom, and a stiff
        shaft holds it against tilts.
    speed_rpm : float
        Of the shaft [rev/min].
    path : ModalPath
        From the force of the bearing along y to the sensor.
    label : str
        Of the fault, as the data set names it; letters, digits, ``-`` and ``_``.
    mass : float
        On the inner ring [kg].
    noise : float
        Root of the mean square of white Gaussian noise that is added [m/s2].
    waviness : float
        Height of one wave around a race [m], of which n waves have an n-th; 0 for smooth races. The record has
        waves up to half of its rate, beside the features of the bearing.
    seed : int
        Of noise and waviness.
    seconds, rate : float
        Length of the record [s], samples per s.

    Raises
    ------
    InputError
        A value out of its range, a speed of 0, a label that cannot be part of a file name, a rate that does not
        resolve ball passages or the modes of the path; a record shorter than a ball passage.
    """

    bearing: BallBearing
    load: tuple[float, ...]
    speed_rpm: float
    path: ModalPath
    label: str
    mass: float = 2.0
    noise: float = 0.0
    waviness: float = 1e-7
    seed: int = 0
    seconds: float = 10.0
    rate: float = 12_000.0

    def __post_init__(self) -> None:
        load = as_column("load", self.load, least=2)
        if load.size > 3:
            raise InputError("load", load.tolist(), "two or three forces [N]")
        object.__setattr__(self, "load", tuple(load.tolist()))
        if not self.label or not self.label.replace("-", "").replace("_", "").isalnum():
            raise InputError("label", self.label, "letters, digits, - and _")
        if self.seconds * self.rate > MOST_SAMPLES:
            allowed = f"at most {MOST_SAMPLES / self.rate:g} s at {self.rate:g} Hz, {MOST_SAMPLES:g} samples"
            raise InputError("seconds", self.seconds, allowed)
        most = HIGHEST * self.bearing.ball_diameter
        if self.waviness > most:
            allowed = f"at most {most:.3g} m, {HIGHEST:g} of the ball's diameter (given in um?)"
            raise InputError("waviness", self.waviness, allowed)
        require_integer("seed", self.seed, "a whole number >= 0", 0)
        require_sampling(self.bearing, self.speed_rpm, self.rate)
        passage = 1.0 / self.bearing.frequencies(self.speed_rpm).bpfo
        if self.seconds < passage:
            raise InputError(
                "seconds", self.seconds, f"at least {passage:.3g} s, a ball passage of the outer race"
            )
        highest = float(np.max(np.asarray(self.path.hz)))
        if highest > 0.5 * self.rate:
            allowed = f"at most {0.5 * self.rate:g} Hz, half the rate: a record of it has nothing of such a mode"
            raise InputError("path.hz", highest, allowed)

    def _summary_lines(self) -> list[str]:
        force = ", ".join(f"{value:.4g}" for value in self.load)
        name = self.bearing.name or "ball bearing"
        return [
            f"{self.label}: {name} under ({force}) N at {self.speed_rpm:.5g} rev/min",
            f"{self.seconds:g} s at {self.rate:g} Hz, noise of {self.noise:g} m/s2,"
            f" waviness of {1e6 * self.waviness:g} µm",
        ]

    def to_dict(self) -> dict[str, Any]:
        """Everything that the record depends on, ready for JSON."""
        path = {name: np.asarray(getattr(self.path, name)).tolist() for name in ("hz", "damping", "mass")}
        plain = ("load", "speed_rpm", "label", "mass", "noise", "waviness", "seed", "seconds", "rate")
        return {"bearing": self.bearing.to_dict(), "path": path} | {name: getattr(self, name) for name in plain}

    @property
    def recording_id(self) -> str:
        """Label and a hash of everything: records of one name are the same."""
        return f"{self.label}-{key_of(self.to_dict())}"

    @property
    def wavy_bearing(self) -> BallBearing:
        """The bearing with the waviness of its races."""
        if self.waviness == 0.0:
            return self.bearing
        met = (
            self.speed_rpm * RPM_TO_HZ * abs(self.bearing.ring_speeds.inner - self.bearing.orders.ftf_order)
        )  # Hz, of one wave of the inner race
        waves = min(int(0.5 * self.rate / met), MOST_WAVES)
        return replace(
            self.bearing,
            features=[*self.bearing.features, *usual_waviness(self.waviness, waves, self.seed)],
        )

    @property
    def steps_per_sample(self) -> int:
        """Steps of the simulation per sample.

        At least 4, 48 000 per s, and 3 while a ball meets its shortest feature.
        """
        force = float(self._at_rest.force.max())
        met = shortest_meeting(self.wavy_bearing, self.speed_rpm, force)
        needed = COARSEST if met is None else max(COARSEST, LEAST_STEPS / met[0])
        return max(FINER, ceil(needed / self.rate))

    @cached_property
    def _at_rest(self) -> BearingState:
        """Equilibrium without features, which depends on no angle of the cage."""
        return replace(self.bearing, features=()).equilibrium(self.load, speed_rpm=self.speed_rpm)

    def rotor(self) -> Rotor:
        """The mass on its bearing."""
        if len(self.load) == 2:
            mount = BearingMount(bearing=self.wavy_bearing, x=0, y=1)
            return Rotor(
                mass=self.mass * np.eye(2), stiffness=np.zeros((2, 2)), load=np.array(self.load), mounts=(mount,)
            )
        mass, held = [self.mass] * 3 + [TILT_INERTIA] * 2, [0.0] * 3 + [TILT_STIFFNESS] * 2
        mount = BearingMount(bearing=self.wavy_bearing, x=0, y=1, z=2, tilt_x=3, tilt_y=4)
        load = np.array([*self.load, 0.0, 0.0])
        return Rotor(mass=np.diag(mass), stiffness=np.diag(held), load=load, mounts=(mount,))

    def columns(self) -> dict[str, Any]:
        """Row of the metadata table, in the columns of bearing-datasets but for orders; own ones at its end."""
        b, faults = self.bearing, list(self.bearing.features)
        kinds = sorted({PARTS.get(str(getattr(fault, "race", None)), BALL) for fault in faults})
        defects = [fault for fault in faults if isinstance(fault, Spall | Indentation)]
        length = max((fault.length for fault in defects), default=0.0)
        orders = self._at_rest.orders or b.orders
        size = round(self.seconds * self.rate)
        words = "; ".join(f"length {1e3 * fault.length:g} mm, depth {1e6 * fault.depth:g} um" for fault in defects)
        graded = "not graded" if kinds else "none"
        return {
            "signal_id": f"{self.recording_id}/y", "recording_id": self.recording_id, "native_label": self.label,
            "channel": "y", "sensor_location": LOCATION, "fs": self.rate, "n_samples": size,
            "fault_type": "+".join(kinds) or "normal",
            "fault_location": "+".join([LOCATION] * len(kinds)) or "none",
            "sensor_at_fault": bool(kinds), "quantity": "acceleration", "unit": "m/s^2", "sensitivity": "none",
            "axis": "y", "sensor_mounting": "pedestal", "speed_rpm": self.speed_rpm, "speed_profile": "constant",
            "load": hypot(*self.load[:2]), "load_unit": "N",
            "fault_origin": "artificial" if kinds else "none", "fault_size_mm": 1e3 * length,
            "fault_severity": words or graded, "fault_severity_level": int(bool(kinds)),
            "bearing_id": key_of(b.to_dict()), "bearing_model": b.name or "ball bearing",
            **asdict(orders),
            "axial_load_n": self.load[2] if len(self.load) == 3 else 0.0, "clearance_um": 1e6 * b.clearance,
            "noise": self.noise, "waviness_um": 1e6 * self.waviness, "seed": self.seed,
        }  # fmt: skip


# Columns of bearing-datasets that have orders, where here a name without _order is in Hz
COLUMN_OF = {field.name: field.name.removesuffix("_order") for field in fields(DefectOrders)}
OWN_COLUMNS = {
    "axial_load_n": "axial load on the inner ring [N]",
    "clearance_um": "radial internal clearance [um]",
    "noise": "root of the mean square of the added white noise [m/s^2]",
    "waviness_um": "height of one wave around a race, of which n waves have an n-th [um]",
    "seed": "of noise and waviness",
}


@stored("vibration record")
@fields_take(rate=parts.RATE, columns=Object(dict, "a dict"))
@dataclass(frozen=True, eq=False, kw_only=True)
class VibrationRecord(QuantityTable):
    """A labelled signal.

    Attributes
    ----------
    signal : ndarray, shape (k,)
        Acceleration [m/s2], of single precision.
    rate : float
        Samples per s.
    columns : dict
        Metadata by column, as in bearing-datasets, without the name and files of a data set. Its ``bpfo``,
        ``bpfi``, ``bsf`` and ``ftf`` are orders, and are called ``bpfo_order`` and so on here.
    """

    signal: Annotated[NDArray[np.float32], ACCELERATION.over("sample")]
    rate: Annotated[float, HERTZ]
    columns: dict[str, Any]

    DISPLAY: ClassVar[Display] = Display(rows="sample", panels=("signal",), first=0)

    def __post_init__(self) -> None:
        signal = as_column("signal", self.signal).astype(np.float32)
        object.__setattr__(self, "signal", signal)
        if self.signal.ndim != 1 or self.signal.size != self.columns.get("n_samples"):
            raise InputError("signal", self.signal.shape, f"{self.columns.get('n_samples')} samples")

    def _summary_lines(self) -> list[str]:
        at, found = self.columns, indicators(self.signal, self.rate)
        features = f"rms {found.rms:.4g} m/s2, kurtosis {found.kurtosis:.4g}"
        if found.velocity_rms_mm_s is not None:
            features += f", velocity {found.velocity_rms_mm_s:.4g} mm/s rms"
        return [
            f"{at['fault_type']} ({at['native_label']}), {at['bearing_model']} at {at['speed_rpm']:.5g} rev/min",
            f"{self.signal.size} samples at {self.rate:g} Hz, {features}",
        ]


@takes(case=Object(RecordCase, "a RecordCase"))
def make_record(case: RecordCase) -> VibrationRecord:
    """Simulate a case and record it.

    Raises
    ------
    ConvergenceError
        The simulation found no equilibrium.
    InputError
        What the bearing refuses.
    """
    columns = case.columns()
    size = columns["n_samples"]
    dt = 1.0 / (case.steps_per_sample * case.rate)
    run = simulate_rotor(case.rotor(), speed_rpm=case.speed_rpm, dt=dt, until=LEAD + (size + 1) / case.rate)
    heard = housing_acceleration(run, case.path, case.rate)
    first = round(LEAD * case.rate)
    noise = case.noise * np.random.default_rng(case.seed).standard_normal(size)
    signal = (heard[first : first + size] + noise).astype(np.float32)
    return VibrationRecord(signal=signal, rate=case.rate, columns=columns)


@takes(
    cases=Objects(RecordCase, "a RecordCase"),
    folder=FOLDER,
    processes=Count(1, 1024),
    scheduler=NAME,
    progress=DONE,
)
def make_records(
    cases: Sequence[RecordCase],
    folder: str | Path,
    *,
    processes: int = 1,
    scheduler: str | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> list[Path]:
    """Files of all cases in their order, one each; whole ones that are in the folder already are kept.

    Parameters
    ----------
    cases : sequence of RecordCase
    folder : path
        Made if it does not exist. After an interruption the same call computes the missing and the damaged ones.
    processes : int
        Of this machine.
    scheduler : str, optional
        Address of a Dask scheduler, whose workers run the cases instead.
    progress : callable, optional
        Called with the numbers of records done and in all.

    Raises
    ------
    InputError
        The folder cannot be written to; no case.
    ConvergenceError
        Cases without equilibrium, the first of which is in the message; all others are made first.
    """
    folder, wanted = Path(folder), {case.recording_id: case for case in cases}
    if not wanted:
        raise InputError("cases", [], "at least one")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError("folder", str(folder), f"one that can be made ({error.strerror})") from None
    remove_leftovers(folder)
    missing = {name: case for name, case in wanted.items() if not _is_whole(folder / f"{name}{SUFFIX}")}
    failed, done = {}, len(wanted) - len(missing)
    if missing:
        with executor_for(processes, 1, scheduler=scheduler) as executor:
            for name, outcome in results_of(executor, _tried, missing):
                if isinstance(outcome, str):
                    failed[name] = outcome
                    continue
                save(outcome, folder / f"{name}{SUFFIX}", "folder")
                done += 1
                if progress is not None:
                    progress(done, len(wanted))
    if failed:
        name, reason = next(iter(failed.items()))
        raise ConvergenceError(f"{len(failed)} of {len(wanted)} records were not made, as {name}: {reason}", None)
    return [folder / f"{case.recording_id}{SUFFIX}" for case in cases]


def _is_whole(path: Path) -> bool:
    """Whether a record is there that can be read: not where a full disc or a copy has cut it."""
    try:
        return path.exists() and read(path, VibrationRecord) is not None
    except InputError:
        return False


def _tried(case: RecordCase) -> VibrationRecord | str:
    """The record, or why there is none."""
    try:
        return make_record(case)
    except ConvergenceError as error:
        return str(error)


@takes(records=Objects(VibrationRecord, "a VibrationRecord"), folder=FOLDER, title=NAME)
def write_dataset(records: Sequence[VibrationRecord], folder: str | Path, *, title: str = "") -> Path:
    """Write records as a data set that `bearing_datasets.open(name, root)` reads; the folder's name is its name.

    Parameters
    ----------
    records : sequence of VibrationRecord
    folder : path
        New or empty.
    title : str

    Raises
    ------
    InputError
        pyarrow is not installed; no record, or one twice; the folder is not empty.
    """
    import json

    names = [record.columns["signal_id"] for record in records]
    if not names or len(set(names)) < len(names):
        raise InputError("records", names[:3], "at least one, each of them once")
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError:
        raise InputError("pyarrow", None, "installed: pip install 'ehlcontact[records]'") from None
    folder = Path(folder)
    if folder.exists() and any(folder.iterdir()):
        raise InputError("folder", str(folder), "new or empty")
    (folder / "signals").mkdir(parents=True, exist_ok=True)
    file, rows = "part-float32.parquet", []
    kinds = pyarrow.schema({"signal_id": pyarrow.string(), "signal": pyarrow.list_(pyarrow.float32())})
    with parquet.ParquetWriter(folder / "signals" / file, kinds, compression="zstd") as writer:
        for k, record in enumerate(records):
            ends = pyarrow.array([0, record.signal.size], pyarrow.int32())
            signal = pyarrow.ListArray.from_arrays(ends, pyarrow.array(record.signal, pyarrow.float32()))
            writer.write_table(pyarrow.table([pyarrow.array([names[k]]), signal], schema=kinds))
            place = {"signal_file": file, "signal_row_group": k, "signal_row": 0}
            columns = {COLUMN_OF.get(name, name): value for name, value in record.columns.items()}
            rows.append({"dataset": folder.name, **columns, **place})
    parquet.write_table(pyarrow.Table.from_pylist(rows), folder / "metadata.parquet", compression="zstd")
    manifest = {
        "dataset": folder.name, "title": title, "license": "", "citation": "", "schema_version": 2,
        "n_recordings": len(rows), "n_signals": len(rows), "columns": OWN_COLUMNS,
    }  # fmt: skip
    (folder / "manifest.json").write_text(json.dumps(manifest, indent=1), encoding="utf-8")
    return folder
