"""Files of references in ``extra/org.fmi-standard.fmi-ls-ref/`` of an FMU: writing and reading."""

from __future__ import annotations

import csv
import hashlib
import io
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from fmu.fmu_file import FmuFile
from fmu.model_description import default_experiment
from fmu.references.series import References, Trial
from fmu.spec import ModelSpec

_Floats = NDArray[np.float64]

FOLDER = "extra/org.fmi-standard.fmi-ls-ref"
MANIFEST, EXPERIMENTS = "fmi-ls-manifest.xml", "experiments.exp"
STEPS, POINTS = "co-simulation", "model exchange"  # names of the experiments
LAYER = "http://fmi-standard.org/fmi-ls-manifest"
PARAMETER_SET = "http://ssp-standard.org/SSP1/SystemStructureParameterValues"
TOLERANCE_NOTE = "io.github.ehlcontact.tolerance"  # type of the annotation
_MANIFEST_ATTRIBUTES = {
    "fmi-ls-name": "org.fmi-standard.fmi-ls-ref",
    "fmi-ls-version": "1.0.0-beta.1",
    "fmi-ls-description": "Layered Standard providing information on related files included in an FMU.",
}
# Role and type by the ending of a file.
_ROLES = {
    ".exp": ("experiment/smoke-test", "application/x-ma-hs-experiments", "Experiments with reference results"),
    ".ssv": ("parameter", "application/x-ssp-parameter-set", "Parameters of the co-simulation"),
    ".opt": ("configuration", "text/plain", "Times and tolerance as the FMI cross-check has them"),
    "_in.csv": ("other", "text/csv", "Reference inputs of the co-simulation"),
    "_ref.csv": ("result", "text/csv", "Reference results of the co-simulation"),
    "_me_in.csv": ("other", "text/csv", "Inputs and states for model exchange, row by row"),
    "_me_ref.csv": ("result", "text/csv", "Derivatives and outputs there"),
}


# ---- to files


def reference_files(references: References, spec: ModelSpec) -> dict[str, bytes]:
    """All files by path in the FMU; equal references give equal bytes."""
    name = spec.identifier
    files: dict[str, bytes] = {}
    root = ElementTree.Element("Experiments", name=f"Reference results of {spec.name}")
    if references.steps is not None:
        trial = references.steps
        step = float(trial.time[1] - trial.time[0])
        options = {"StartTime": trial.time[0], "StopTime": trial.time[-1], "StepSize": step}
        entry = _experiment(root, STEPS, references.about, name, bool(references.parameters))
        for key, value in options.items():
            entry.set(key[0].lower() + key[1:], repr(float(value)))
        lines = [f"{key},{float(value)!r}\n" for key, value in options.items()]
        tolerance = default_experiment(spec)["tolerance"]
        files[f"{name}_ref.opt"] = "".join([*lines, f"RelTol,{tolerance}\n"]).encode()
        files |= _tables(trial, name)
        if references.parameters:
            files[f"{name}.ssv"] = _parameters(references.parameters, spec)
    if references.points is not None:
        _experiment(root, POINTS, "Rows by themselves: inputs and states are set, the rest is read", f"{name}_me")
        files |= _tables(references.points, f"{name}_me")
    _annotate(root, repr(references.tolerance))
    files[EXPERIMENTS] = _xml(root)
    files[MANIFEST] = _manifest(files)
    return {f"{FOLDER}/{name}": content for name, content in files.items()}


def _experiment(
    root: ElementTree.Element, name: str, text: str, stem: str, parameters: bool = False
) -> ElementTree.Element:
    entry = ElementTree.SubElement(root, "Experiment", name=name, description=text)
    if parameters:
        ElementTree.SubElement(entry, "Parameters", source=f"{stem}.ssv")
    ElementTree.SubElement(entry, "Stimuli", source=f"{stem}_in.csv")
    ElementTree.SubElement(entry, "References", source=f"{stem}_ref.csv")
    return entry


def _tables(trial: Trial, stem: str) -> dict[str, bytes]:
    return {
        f"{stem}_{ending}.csv": _table(trial.time, columns)
        for ending, columns in (("in", trial.knowns), ("ref", trial.unknowns))
    }


def _table(time: _Floats, columns: Mapping[str, Any]) -> bytes:
    """CSV as fmpy reads and writes it; 15 digits, which is 5e-15 of a number at most."""
    lines = [",".join(f'"{name}"' for name in ("time", *columns))]
    for row in zip(time, *columns.values(), strict=True):
        lines.append(",".join(f"{float(value):.15g}" for value in row))
    return ("\n".join(lines) + "\n").encode()


def _parameters(values: Mapping[str, float], spec: ModelSpec) -> bytes:
    """Parameter set of SSP 1.0."""
    ElementTree.register_namespace("ssv", PARAMETER_SET)
    root = ElementTree.Element(f"{{{PARAMETER_SET}}}ParameterSet", version="1.0", name="reference")
    parent = ElementTree.SubElement(root, f"{{{PARAMETER_SET}}}Parameters")
    for name, value in values.items():
        entry = ElementTree.SubElement(parent, f"{{{PARAMETER_SET}}}Parameter", name=name)
        kind = spec[name].type
        ElementTree.SubElement(entry, f"{{{PARAMETER_SET}}}{kind}", value=repr(float(value)))
    return _xml(root)


def _manifest(files: Mapping[str, bytes]) -> bytes:
    """Manifest: name, purpose and checksum of every file."""
    ElementTree.register_namespace("fmi-ls", LAYER)
    root = ElementTree.Element(
        "fmiReferences", {f"{{{LAYER}}}{key}": text for key, text in _MANIFEST_ATTRIBUTES.items()}
    )
    for name in sorted(files):
        ending = max((ending for ending in _ROLES if name.endswith(ending)), key=len)
        role, kind, text = _ROLES[ending]
        ElementTree.SubElement(
            root, "Related", type=kind, source=name, role=role, description=text, checksum=_digest(files[name])
        )
    return _xml(root)


def _digest(content: bytes) -> str:
    return hashlib.sha3_256(content).hexdigest()  # default of the layered standard


def _annotate(root: ElementTree.Element, text: str) -> None:
    note = ElementTree.SubElement(ElementTree.SubElement(root, "Annotations"), "Annotation", type=TOLERANCE_NOTE)
    note.text = text


def _xml(root: ElementTree.Element) -> bytes:
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="UTF-8", xml_declaration=True)


# ---- from files


def read_references(file: FmuFile) -> References:
    """References inside an opened FMU.

    Raises
    ------
    InputError
        There are none, or they cannot be read.
    """
    folder = Path(file.folder, FOLDER)
    if not (folder / EXPERIMENTS).is_file():
        raise InputError(
            "path", str(file.path), f"an FMU with reference results in {FOLDER}, as ehlcontact exports them"
        )
    try:
        root = ElementTree.parse(folder / EXPERIMENTS).getroot()
        found = {entry.get("name"): entry for entry in root.iter("Experiment")}
        known = {variable.name: variable for variable in file.description.modelVariables}
        trials = {name: _trial(entry, folder, known) for name, entry in found.items()}
        steps = found.get(STEPS)
        source = None if steps is None else steps.find("Parameters")
        values = {} if source is None else _read_parameters(_inside(folder, source), known)
        tolerance = _tolerance(root)
    except (OSError, ValueError, KeyError, IndexError, ElementTree.ParseError) as error:
        reason = " ".join(str(error).split())
        raise InputError("path", str(file.path), f"an FMU with readable reference results ({reason})") from None
    return References(trials.get(STEPS), trials.get(POINTS), values, tolerance)


def _tolerance(root: ElementTree.Element) -> float:
    for note in root.iter("Annotation"):
        if note.get("type") == TOLERANCE_NOTE:
            value = float(note.text or "")
            if not 0.0 < value < 1.0:
                raise ValueError(f"tolerance {value!r}")
            return value
    raise ValueError("no tolerance")


def _trial(entry: ElementTree.Element, folder: Path, known: Mapping[str, Any]) -> Trial:
    tables = []
    for part in ("Stimuli", "References"):
        source = entry.find(part)
        if source is None:
            raise ValueError(f"no {part}")
        tables.append(_read_table(_inside(folder, source), known))
    (time, knowns), (same, unknowns) = tables
    if not np.array_equal(time, same) or not np.all(np.diff(time) > 0.0) or not unknowns:
        raise ValueError("times that do not increase, or are not the same in both tables, or no results")
    return Trial(time, knowns, unknowns)


def _inside(folder: Path, entry: ElementTree.Element) -> Path:
    """The file that an entry names; nothing outside the folder."""
    return folder / Path(entry.get("source", "")).name


def _read_table(path: Path, known: Mapping[str, Any]) -> tuple[_Floats, dict[str, _Floats]]:
    rows = list(csv.reader(io.StringIO(path.read_text(encoding="utf-8"))))
    names = rows[0]
    if names[0] != "time" or len(set(names)) < len(names) or len(rows) < 3:
        raise ValueError(f"{path.name}: no column of times, two of one name, or fewer than two rows")
    for name in names[1:]:
        if name not in known:
            raise ValueError(f"{path.name}: no variable {name} in the FMU")
    values = np.array([_numbers(row, names, f"{path.name}, row {k}") for k, row in enumerate(rows[1:], start=2)])
    return values[:, 0], {name: values[:, k] for k, name in enumerate(names[1:], start=1)}


def _numbers(row: list[str], names: list[str], where: str) -> list[float]:
    """A row of a table, all of it finite numbers."""
    if len(row) != len(names):
        raise ValueError(f"{where}: {len(row)} entries, there must be {len(names)}")
    found = []
    for name, text in zip(names, row, strict=True):
        try:
            number = float(text)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            raise ValueError(f"{where}: {name} is {text!r}, must be a finite number")
        found.append(number)
    return found


def _read_parameters(path: Path, known: Mapping[str, Any]) -> dict[str, float]:
    values = {}
    for entry in ElementTree.parse(path).getroot().iter(f"{{{PARAMETER_SET}}}Parameter"):
        name, value = entry.get("name", ""), entry[0].get("value", "")
        if name not in known:
            raise KeyError(name)
        values[name] = float(value)
    return values


def changed_files(unpacked: str | Path) -> tuple[str, ...]:
    """Findings: files of the manifest that are missing or have another checksum."""
    folder, found = Path(unpacked, FOLDER), []
    try:
        root = ElementTree.parse(folder / MANIFEST).getroot()
    except (OSError, ElementTree.ParseError) as error:
        return (f"{MANIFEST}: {' '.join(str(error).split())}",)
    for entry in root.iter("Related"):
        path, wanted = _inside(folder, entry), entry.get("checksum")
        if not path.is_file():
            found.append(f"{path.name}: in the manifest, but not in the FMU")
        elif wanted is not None and _digest(path.read_bytes()) != wanted:
            found.append(f"{path.name}: not the file whose checksum the manifest has")
    return tuple(found)
