"""What every number of the library does: halved and doubled, each in a fresh process, against a set of probes.

    python tests/benchmarks/vary.py NAME ...               # prints; a NAME of many rooms as room:NAME
    python tests/benchmarks/vary.py --room ehlcontact.solver --json tests/benchmarks/numbers.json   # writes, too
    python tests/benchmarks/vary.py --all --json ...       # those that numbers.json does not know yet
    python tests/benchmarks/vary.py --check                # numbers without certificate, and stale ones
    python tests/benchmarks/vary.py --update               # follow constants that moved to another module
    python tests/benchmarks/vary.py --page                 # docs/numbers.md from numbers.json

A number is a module-level name in capitals whose value has a number in it. `numbers.json` holds one line for each:
its class, of what it is and why (at first the comment beside it), and, if it decides something, what half and
double do. The probes of its room are run with the constant rewritten before the module is executed, so that copies
of it in other modules and in compiled kernels change too. "Work" is the size of all fast transforms together: it
counts the sweeps of fine grids and, other than seconds, is the same on every run. Seconds are processor time.
"""

from __future__ import annotations

import argparse
import ast
import dataclasses
import importlib.machinery
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import tokenize
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, NamedTuple

ROOT = Path(__file__).parents[2]
TABLE = Path(__file__).with_name("numbers.json")
PAGE = ROOT / "docs" / "numbers.md"
PACKAGES = ("ehlcontact", "reduced_models", "fmu")
CLASSES = {
    "behaviour": "decides how, how far or how exactly something is computed; measured",
    "guard": "a cap that no sound input meets, or the range of inputs accepted; measured",
    "physics": "a law or a constant of nature, or of the paper's equations",
    "data": "published figures and cases that are reproduced",
    "exact": "arithmetic, indices and sizes of arrays: any other value would be wrong",
    "format": "versions and lengths of file formats",
    "look": "of pictures and texts",
}
MEASURED = ("behaviour", "guard")
LATER = "not probed: measured in the next run"  # of `--all` or `--room`


# ---------------------------------------------------------------------------------------------- what there is


class Number(NamedTuple):
    """A module-level constant of the library."""

    name: str
    module: str
    value: str  # as written
    comment: str

    @property
    def key(self) -> str:
        return f"{self.module}:{self.name}"


def numbers_of_library() -> list[Number]:
    """All of them, in the order of the files."""
    found = []
    for package in PACKAGES:
        for path in sorted((ROOT / package).rglob("*.py")):
            found += list(numbers_of(path))
    return found


def numbers_of(path: Path) -> Iterator[Number]:
    """Those of one file."""
    source = path.read_text(encoding="utf-8")
    lines, comments = source.splitlines(), _comments(source)
    module = ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")
    for node in ast.parse(source).body:
        for name, value in assigned(node):
            if has_number(value):
                yield Number(name, module, ast.unparse(value), _comment(node, lines, comments))


def assigned(node: ast.stmt) -> Iterator[tuple[str, ast.expr]]:
    """Names in capitals that a statement gives a value, and the values."""
    if isinstance(node, ast.Assign):
        pairs: list[tuple[ast.expr, ast.expr]] = []
        for target in node.targets:
            if not isinstance(target, ast.Tuple):
                pairs.append((target, node.value))
            elif isinstance(node.value, ast.Tuple):
                pairs += zip(target.elts, node.value.elts, strict=True)
            else:
                pairs += [(each, node.value) for each in target.elts]
    elif isinstance(node, ast.AnnAssign) and node.value is not None:
        pairs = [(node.target, node.value)]
    else:
        return
    for name, value in pairs:
        if isinstance(name, ast.Name) and re.fullmatch(r"_?[A-Z][A-Z0-9_]*", name.id):
            yield name.id, value


def has_number(value: ast.AST) -> bool:
    """Whether a number stands in an expression, other than as an index or in a function."""
    if isinstance(value, ast.Constant):
        return isinstance(value.value, int | float) and not isinstance(value.value, bool)
    if isinstance(value, ast.Subscript):
        return has_number(value.value)
    return not isinstance(value, ast.Lambda) and any(map(has_number, ast.iter_child_nodes(value)))


def _comments(source: str) -> dict[int, str]:
    """Comments by line."""
    tokens = tokenize.generate_tokens(iter(source.splitlines(keepends=True)).__next__)
    return {t.start[0]: t.string.lstrip("# ") for t in tokens if t.type == tokenize.COMMENT}


def _comment(node: ast.stmt, lines: list[str], comments: dict[int, str]) -> str:
    """What is said beside a statement, and above it."""
    above: list[str] = []
    row = node.lineno - 1
    while row in comments and lines[row - 1].startswith("#"):
        above.insert(0, comments[row])
        row -= 1
    beside = [comments[row] for row in range(node.lineno, (node.end_lineno or node.lineno) + 1) if row in comments]
    text = " ".join(above + [c for c in beside if not c.startswith(("fmt:", "noqa"))])
    return text


# ---------------------------------------------------------------------------------------------- another value


def scaled(value: Any, factor: float, only: int | None = None) -> Any:
    """`value` with all its numbers times `factor`, or entry number `only`.

    Whole numbers stay whole and at least 1, intervals of grids multiples of 16. A number between 0.9 and 1.5, or
    several such, is a margin about 1, and its distance from 1 is scaled; so are the margins of a domain beyond the
    Hertz ellipse.
    """
    import numpy as np

    if isinstance(value, bool | str) or value is None:
        return value
    if isinstance(value, int):
        return max(1, math.floor(value * factor + 0.5)) if value > 0 else value
    if isinstance(value, float):
        return 1.0 + (value - 1.0) * factor if _is_margin(value) else value * factor
    if isinstance(value, np.ndarray):
        return value * (factor if only is None else np.where(np.arange(len(value)) == only, factor, 1.0))
    if isinstance(value, dict):
        return {key: scaled(entry, factor) for key, entry in value.items()}
    if type(value).__name__ == "Domain":
        ends = [max(1.2, 1.0 + (abs(end) - 1.0) * factor) for end in value.as_tuple()]
        return type(value)(-ends[0], *ends[1:])
    if isinstance(value, tuple | list):
        if len(value) > 1 and all(isinstance(v, int) and v % 16 == 0 for v in value):
            return type(value)(max(16, round(v * factor / 16) * 16) for v in value)
        margins = all(isinstance(v, float) and _is_margin(v) for v in value)
        entries: list[Any] = [
            v * factor if isinstance(v, float) and not margins else scaled(v, factor) for v in value
        ]
        return type(value)(*entries) if hasattr(value, "_fields") else type(value)(entries)
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        changed = {f.name: scaled(getattr(value, f.name), factor) for f in dataclasses.fields(value)}
        return dataclasses.replace(value, **changed)
    raise TypeError(f"no half of {value!r}")


def _is_margin(value: float) -> bool:
    return 0.9 <= value <= 1.5 and value != 1.0


class Varied(importlib.machinery.SourceFileLoader):
    """Executes a module with one constant scaled where it is assigned; line numbers stay."""

    def __init__(self, module: str, path: str, name: str, how: str) -> None:
        super().__init__(module, path)
        self._constant, self._how = name, how

    def get_code(self, fullname: str) -> Any:
        path = self.get_filename(fullname)
        tree = ast.parse(self.get_data(path))
        body: list[ast.stmt] = []
        for node in tree.body:
            body.append(node)
            if self._constant in dict(assigned(node)):
                text = f"{self._constant} = __import__('vary').scaled({self._constant}, {self._how})"
                added = ast.parse(text).body[0]
                for part in ast.walk(added):
                    ast.copy_location(part, node)
                body.append(added)
        tree.body = body
        return compile(tree, path, "exec", dont_inherit=True)


class Finder:
    """Finds the module whose constant is varied."""

    def __init__(self, module: str, name: str, how: str) -> None:
        self._module, self._name, self._how = module, name, how

    def find_spec(self, fullname: str, path: Any = None, target: Any = None) -> Any:
        """As `importlib` asks for."""
        if fullname != self._module:
            return None
        spec = importlib.machinery.PathFinder.find_spec(fullname, path)
        assert spec is not None and spec.origin is not None
        spec.loader = Varied(fullname, spec.origin, self._name, self._how)
        return spec


def install() -> None:
    """Vary what the environment says; called when Python starts, in worker processes too."""
    key, _, how = os.environ.get("VARY_NUMBER", "").rpartition("=")
    if key:
        module, name = key.split(":")
        sys.meta_path.insert(0, Finder(module, name, how))


def frozen_into(module: str) -> set[str]:
    """Modules with kernels that import `module`, directly or through others, and itself if it has some."""
    imports: dict[str, set[str]] = {}
    kernels = set()
    for package in PACKAGES:
        for path in (ROOT / package).rglob("*.py"):
            name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
            source = path.read_text(encoding="utf-8")
            if re.search(r"^@\w*jit", source, re.M):
                kernels.add(name)
            seen = imports.setdefault(name, set())
            for node in ast.walk(ast.parse(source)):
                if isinstance(node, ast.ImportFrom) and node.module:
                    seen |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    reached, new = set(), {module}
    while new:
        reached |= new
        new = {name for name, seen in imports.items() if seen & new} - reached
    return reached & kernels


# ---------------------------------------------------------------------------------------------- measuring


class Failed(Exception):
    """A run that gave no figures."""


MESH = ("steady", "accuracy", "near_domain", "thin_sides", "impedances", "transient", "full_contact")
# Probes by the beginning of a module's name; the longest that fits counts.
ROOMS: dict[str, tuple[str, ...]] = {
    "ehlcontact": ("steady", "impedances", "transient"),
    "ehlcontact.steady": ("steady", "fallbacks", "transient"),
    "ehlcontact.status": ("steady", "fallbacks", "transient", "full_contact"),
    "ehlcontact.film_wave": ("wave",),
    "ehlcontact.film.waves": ("wave",),
    "ehlcontact.impedance": ("impedances",),
    "ehlcontact.solver": ("steady", "fallbacks", "transient"),
    "ehlcontact.solver.accuracy": ("accuracy",),
    "ehlcontact.solver.deflection": ("deflections", "steady", "transient"),
    "ehlcontact.solver.deflection.mlmi": ("deflections",),
    "ehlcontact.solver.domain": ("steady", "impedances", "transient"),
    "ehlcontact.solver.kernels.mlmi": ("deflections",),
    "ehlcontact.solver.kernels.lowest": ("lowest", "steady"),
    "ehlcontact.solver.estimate": ("accuracy",),
    "ehlcontact.solver.linear": ("newton", "fallbacks", "impedances"),
    "ehlcontact.solver.linearised_contact": ("impedances",),
    "ehlcontact.solver.lowest_film": ("lowest", "steady"),
    "ehlcontact.solver.mesh": MESH,
    "ehlcontact.solver.newton": ("newton", "fallbacks"),
    "ehlcontact.solver.preconditioner": ("newton", "fallbacks", "impedances"),
    "ehlcontact.solver.resolution": MESH,
    "ehlcontact.transient": ("transient", "full_contact"),
    "ehlcontact.transient.full_contact": ("full_contact",),
    "ehlcontact.transient.surface": ("surfaces",),
    "ehlcontact.transient.roughness": ("surfaces",),
    "ehlcontact.cli.study": ("study",),
    "ehlcontact.cli.study.runner": (),
    "reduced_models": ("elements", "fits", "memory_fits", "wide", "gains", "atlas", "rotor"),
    "reduced_models.elements": ("elements", "fits", "gains", "atlas", "rotor"),
    "reduced_models.elements.film_response": ("gains", "memory_fits"),
    "reduced_models.fitting": ("fits",),
    "reduced_models.fitting.memory": ("memory_fits",),
    "reduced_models.fitting.wide": ("wide",),
    "reduced_models.atlas": ("atlas", "atlas_surface", "atlas_samples", "atlas_build", "atlas_gains"),
    "reduced_models.atlas.atlas": ("atlas", "elements"),
    "reduced_models.atlas.elements": ("atlas", "elements"),
    "reduced_models.atlas.surface": ("atlas", "atlas_surface"),
    "reduced_models.atlas.assemble": ("atlas_gains",),
    "reduced_models.atlas.sample": ("atlas_samples",),
    "reduced_models.atlas.solve": ("atlas_samples", "atlas_build"),
    "reduced_models.atlas.build": ("atlas_samples",),
    "reduced_models.atlas.workers": (),
    "reduced_models.rotor": ("rotor",),
    "reduced_models.rotor.equilibrium": ("rotor", "bearing"),
    "reduced_models.bearing": ("bearing",),
    "fmu": ("exported",),
    "fmu.binaries": (),
}


def probes_of(module: str) -> tuple[str, ...]:
    """Probes of the room that a module is in."""
    return ROOMS[max((room for room in ROOMS if f"{module}.".startswith(room)), key=len)]


def run(probes: tuple[str, ...], key: str = "", how: str = "1.0", limit: float = 900.0) -> dict[str, Any]:
    """Figures of `probes` in a fresh process, one constant scaled by `how`: the arguments of `scaled`."""
    base = Path(os.environ.get("NUMBA_CACHE_DIR", ROOT / "tests" / "benchmarks" / ".numba"))
    with tempfile.TemporaryDirectory(prefix="vary") as folder:
        here = Path(folder)
        (here / "sitecustomize.py").write_text("import vary\nvary.install()\n")
        (here / "vary.py").write_bytes(Path(__file__).read_bytes())
        (here / "probes.py").write_bytes(Path(__file__).with_name("probes.py").read_bytes())
        environment = os.environ | {
            "PYTHONPATH": f"{here}{os.pathsep}{ROOT}",
            "VARY_NUMBER": f"{key}={how}" if key else "",
            "VARY_ROOT": str(ROOT),
            "MPLBACKEND": "Agg",
            "NUMBA_CACHE_DIR": str(base),
            **dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "NUMBA_NUM_THREADS"), "1"),
        }
        stale = frozen_into(key.split(":")[0]) if key else set()
        if stale:
            cache = here / "numba"
            heads = {tuple(name.split(".")[-2:]) for name in stale}

            def left_out(directory: str, names: list[str]) -> list[str]:
                parent = Path(directory).name.rpartition("_")[0]
                return [name for name in names if (parent, name.split(".")[0]) in heads]

            if base.exists():
                shutil.copytree(base, cache, ignore=left_out)
            environment["NUMBA_CACHE_DIR"] = str(cache)
        out = here / "figures.json"
        command = [sys.executable, "-W", "ignore", str(here / "probes.py"), str(out), *probes]
        try:
            done = subprocess.run(
                command, env=environment, capture_output=True, text=True, timeout=limit, cwd=ROOT
            )
        except subprocess.TimeoutExpired:
            raise Failed(f"does not end within {limit:.0f} s") from None
        if not out.exists():
            raise Failed((done.stderr.strip().splitlines() or ["no output"])[-1])
        return dict(json.loads(out.read_text()))


# ---------------------------------------------------------------------------------------------- in words

COUNTS = {  # and the share of change that is worth telling
    "cycles": 0.02, "steps": 0.02, "iterations": 0.02, "krylov": 0.05, "factors": 0.1, "work": 0.03,
    "warnings": 0.0, "points": 0.0, "answers": 0.0, "frequencies": 0.0,
}  # fmt: skip
CHOICES = ("n", "extent", "lags", "n of the film")
TIMES = ("seconds", "seconds of ten")
# Relative changes of numbers: by rounding, and within what a run is solved to.
ROUNDING = 1e-9
SMALL = dict.fromkeys(("steady", "fallbacks", "near_domain", "thin_sides"), 1e-4)
SMALL |= dict.fromkeys(("transient", "full_contact", "surfaces"), 3e-3)
NOTHING = "nothing measured changes"
Cases = dict[str, tuple[dict[str, Any], dict[str, Any]]]


def in_words(before: dict[str, Any], after: dict[str, Any], most: int = 3) -> str:
    """What differs between two sets of figures, probe by probe, in one line; `most` numbers of each."""
    told, little = [], []
    for probe in dict.fromkeys(key.split("/")[0] for key in before):
        cases: Cases = {}
        for side, figures in enumerate((before, after)):
            for key, value in figures.items():
                its, case, name = key.split("/", 2)
                if its == probe and (side == 0 or case in cases):
                    cases.setdefault(case, ({}, {}))[side][name] = value
        parts = [*_statuses(cases), *_choices(cases), *_counts(cases, 1.0), *_times(cases)]
        parts += list(_numbers(cases, SMALL.get(probe, 1e-5)))[:most]
        name = probe.replace("_", " ")
        if parts:
            told.append(f"{name}: {', '.join(parts)}")
        elif parts := [*_counts(cases, 0.0), *_numbers(cases, ROUNDING)]:
            little.append(f"{name} {', '.join(parts[:2])}")
    return "; ".join(told) or (f"hardly anything: {'; '.join(little)}" if little else NOTHING)


def _statuses(cases: Cases) -> Iterator[str]:
    new: dict[str, list[str]] = {}
    for case, (old, now) in cases.items():
        if "fails" in now and _wordly(now["fails"]) != _wordly(old.get("fails", "")):
            new.setdefault(f"`{_start(now['fails'])}`", []).append(case)
        elif "fails" in old and "fails" not in now:
            new.setdefault("no longer refused", []).append(case)
        elif old.get("status") != now.get("status"):
            new.setdefault(f"`{now.get('status')}`", []).append(case)
    for what, where in new.items():
        yield f"{_some(where)} {what}"


def _choices(cases: Cases) -> Iterator[str]:
    for name in CHOICES:
        new: dict[str, list[str]] = {}
        for case, (old, now) in cases.items():
            if name in old and name in now and old[name] != now[name]:
                new.setdefault(f"{name} {old[name]:g} -> {now[name]:g}", []).append(case)
        for what, where in list(new.items())[:3]:
            yield f"{_some(where)} {what}"


def _counts(cases: Cases, strict: float) -> Iterator[str]:
    """Counts that change in sum by their share of `COUNTS`, or much in one case; all with `strict` = 0."""
    for name, share in COUNTS.items():
        pairs = {case: (old[name], now[name]) for case, (old, now) in cases.items() if name in old and name in now}
        changed = {case: pair for case, pair in pairs.items() if pair[0] != pair[1]}
        if not changed:
            continue
        old, now = (sum(pair[side] for pair in pairs.values()) for side in (0, 1))
        case = max(changed, key=lambda case: abs(math.log((changed[case][1] + 1e-9) / (changed[case][0] + 1e-9))))
        one = abs(changed[case][1] / max(changed[case][0], 1e-9) - 1.0)
        if abs(now / max(old, 1e-9) - 1.0) >= strict * share or (one > 0.25 and share < 0.05):
            text = f"{name} {_change(old, now)}"
            yield text if len(pairs) == 1 or one < 0.05 else f"{text} ({case} {_change(*changed[case])})"


def _times(cases: Cases) -> Iterator[str]:
    for name in TIMES:
        sound = [pair for pair in cases.values() if all(name in side and "fails" not in side for side in pair)]
        pairs = [(old[name], now[name]) for old, now in sound]
        old, now = (sum(pair[side] for pair in pairs) for side in (0, 1))
        if pairs and max(old, now) > 1.3 * min(old, now) and (abs(now - old) > 0.25 or name != "seconds"):
            yield f"time {_change(old, now)}"


def _numbers(cases: Cases, least: float) -> Iterator[str]:
    """The numbers that change most, relative to the largest of their kind in the case."""
    import numpy as np

    worst: dict[str, tuple[float, str, str]] = {}
    for case, (old, now) in cases.items():
        for name in (old.keys() & now.keys()) - {*COUNTS, *CHOICES, *TIMES, "status", "fails"}:
            if old[name] is None or now[name] is None:
                continue
            a, b = (np.atleast_1d(np.array(side[name], dtype=float)).ravel() for side in (old, now))
            change = math.inf
            if a.shape == b.shape:
                change = float(np.max(np.abs(b - a), initial=0.0) / max(np.max(np.abs(a), initial=0.0), 1e-300))
            if not change <= max(least, worst.get(name, (0.0,))[0]):
                sign = ("+" if b[0] > a[0] else "-") if a.size == b.size == 1 else "by "
                worst[name] = (change, case, sign)
    for name, (change, case, sign) in sorted(worst.items(), key=lambda item: (-item[1][0], item[0])):
        where = f" ({case})" if len(cases) > 1 else ""
        yield f"{name} {_size(change, sign)}{where}"


def _size(change: float, sign: str) -> str:
    if not change < math.inf:
        return "has another length"
    if change >= 10.0:
        return f"by a factor of {change:.0f}" if change < 1e4 else "wholly"
    if change >= 0.1:
        return f"{sign}{100.0 * change:.0f} %"
    return f"{sign}{100.0 * change:.2g} %" if change >= 1e-3 else f"{sign}{change:.0e}"


def _change(old: float, now: float) -> str:
    """A change in per cent, or from what to what."""
    if old <= 0.0 or now <= 0.0 or not 0.33 < now / old < 3.0:
        return f"{old:.3g} -> {now:.3g}"
    per_cent = 100.0 * (now / old - 1.0)
    return f"{per_cent:+.0f} %" if abs(per_cent) > 0.5 else f"{per_cent:+.1g} %"


def _wordly(text: str) -> str:
    """A message without its numbers."""
    return re.sub(r"-?\d[\d.e+-]*", "#", text)


def _start(text: str, most: int = 64) -> str:
    return text if len(text) <= most else text[:most].rsplit(" ", 1)[0] + " ..."


def _some(names: list[str]) -> str:
    return ", ".join(names[:3]) + (f" and {len(names) - 3} more" if len(names) > 3 else "")


# ---------------------------------------------------------------------------------------------- the table


def read_table(path: Path = TABLE) -> list[dict[str, str]]:
    """Entries of numbers.json."""
    return list(json.loads(path.read_text(encoding="utf-8"))["numbers"]) if path.exists() else []


def write_table(entries: list[dict[str, str]], path: Path = TABLE) -> None:
    """One line per number, in the order of the library."""
    order = {number.key: i for i, number in enumerate(numbers_of_library())}
    entries.sort(key=lambda entry: order.get(key_of(entry), len(order)))
    rows = ",\n".join(json.dumps(entry, ensure_ascii=False) for entry in entries)
    about = json.dumps({"classes": CLASSES})[1:-1]
    text = f'{{{about},\n"numbers": [\n{rows}\n]}}\n'
    path.with_suffix(".new").write_text(text, encoding="utf-8")
    path.with_suffix(".new").replace(path)


def key_of(entry: dict[str, str]) -> str:
    """Module and name."""
    return f"{entry['module']}:{entry['name']}"


def measure(number: Number, keep: Path | None, known: dict[str, dict[str, Any]]) -> dict[str, str]:
    """Sentences on half and double."""
    probes = probes_of(number.module)
    if not probes:
        return dict.fromkeys(("half", "double"), "not probed: it acts where a process dies or hangs")
    # A process that compiles kernels rounds otherwise than one that finds them compiled: hold like against like.
    compiled = number.key if frozen_into(number.module) else ""
    label = f"{'+'.join(probes)} {number.module if compiled else ''}".strip()
    if label not in known:
        known[label] = _kept(keep, f"{label} as it is", probes, compiled, "1.0")
    base = known[label]
    limit = 60.0 + 8.0 * sum(v for k, v in base.items() if k.endswith("/seconds"))

    def sentence(word: str, how: str, most: int = 3) -> str:
        try:
            return in_words(base, _kept(keep, f"{number.key} {word}", probes, number.key, how, limit), most)
        except Failed as failure:
            return f"fails: {failure}"

    found = {}
    for word, factor in (("half", 0.5), ("double", 2.0)):
        if number.value == "1" and word == "half":
            found[word] = "no smaller one"
            continue
        found[word] = sentence(word, str(factor))
        if number.value.startswith("np.array(") and found[word].startswith((NOTHING, "hardly")):
            parts = [sentence(f"{word} of {i}", f"{factor}, {i}", 1) for i in range(number.value.count(",") + 1)]
            found[word] = f"all together: {found[word]}; " + "; ".join(
                f"entry {i}: {p}" for i, p in enumerate(parts)
            )
    return found


def _kept(
    keep: Path | None, label: str, probes: tuple[str, ...], key: str, how: str, limit: float = 900.0
) -> dict[str, Any]:
    """Figures from the folder `keep`, or measured and put there."""
    if keep is None:
        return run(probes, key, how, limit)
    keep.mkdir(parents=True, exist_ok=True)
    path = keep / f"{label}.json"
    if not path.exists():
        try:
            figures = run(probes, key, how, limit)
        except Failed as failure:
            figures = {"failed": str(failure)}
        path.write_text(json.dumps(figures))
    figures = dict(json.loads(path.read_text()))
    if "failed" in figures:
        raise Failed(figures["failed"])
    return figures


def main() -> None:
    """Do what the arguments ask for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="numbers to vary, as NAME or module:NAME")
    parser.add_argument("--all", action="store_true", help="all that decide something and have no sentence yet")
    parser.add_argument("--room", help="those of the modules whose names begin so")
    parser.add_argument("--jobs", type=int, default=1, help="numbers varied side by side")
    parser.add_argument(
        "--json", type=Path, metavar="FILE", help="write the sentences into this table as they come"
    )
    parser.add_argument("--keep", type=Path, metavar="DIR", help="keep all figures here, and use those kept")
    parser.add_argument("--check", action="store_true", help="name the numbers without certificate")
    parser.add_argument("--update", action="store_true", help="follow numbers to other modules, drop those gone")
    parser.add_argument("--page", action="store_true", help="write docs/numbers.md")
    arguments = parser.parse_args()
    if arguments.update:
        update(arguments.json or TABLE)
    if arguments.page:
        PAGE.write_text(page(), encoding="utf-8")
    if arguments.check:
        found = faults()
        print("\n".join(found) or "every number has its certificate")
        raise SystemExit(bool(found))
    if not (arguments.names or arguments.all or arguments.room):
        return
    wanted = _wanted(arguments.names, arguments.room, arguments.json)
    known: dict[str, dict[str, Any]] = {}
    lock = threading.Lock()

    def certify(number: Number) -> None:
        sentences = measure(number, arguments.keep, known)
        with lock:
            print(f"{number.key} = {number.value}", *(f"\n    {k}: {v}" for k, v in sentences.items()), flush=True)
            if arguments.json:
                record(number, sentences, arguments.json)

    with ThreadPoolExecutor(arguments.jobs) as pool:
        list(pool.map(certify, wanted))


def _wanted(names: list[str], room: str | None, table: Path | None) -> list[Number]:
    """Numbers asked for; of `--all` and `--room` those that decide something, and that `table` does not know."""
    everything = numbers_of_library()
    if names:
        found = [number for name in names for number in everything if name in (number.name, number.key)]
        missing = [name for name in names if not any(name in (n.name, n.key) for n in everything)]
        if missing:
            raise SystemExit(f"the library has no number {', '.join(missing)}")
        return found
    entries = {key_of(entry): entry for entry in read_table(table or TABLE)}
    wanted = []
    for number in everything:
        entry = entries.get(number.key, {"class": "behaviour"})
        done = table is not None and entry.get("value") == number.value and "double" in entry
        done = done and not entry["double"].startswith(LATER)
        if entry["class"] in MEASURED and not done and number.module.startswith(room or ""):
            wanted.append(number)
    return wanted


def record(number: Number, sentences: dict[str, str], path: Path) -> None:
    """Enter or renew one line of the table."""
    entries = read_table(path)
    entry = next((e for e in entries if key_of(e) == number.key), None)
    if entry is None:
        entry = {
            "name": number.name,
            "module": number.module,
            "value": "",
            "class": "behaviour",
            "of": number.comment,
        }
        entries.append(entry)
    entry |= {"value": number.value, **sentences}
    write_table(entries, path)


def update(path: Path) -> None:
    """Follow numbers that moved with name and value; drop those that are gone."""
    entries, numbers = read_table(path), numbers_of_library()
    keys = {number.key for number in numbers}
    free = [number for number in numbers if number.key not in {key_of(entry) for entry in entries}]
    kept = []
    for entry in entries:
        if key_of(entry) not in keys:
            moved = [n for n in free if n.name == entry["name"] and n.value == entry["value"]]
            if not moved:
                print(f"gone: {key_of(entry)} = {entry['value']}")
                continue
            print(f"moved: {key_of(entry)} -> {moved[0].module}")
            entry["module"] = moved[0].module
            free.remove(moved[0])
        kept.append(entry)
    write_table(kept, path)


def faults() -> list[str]:
    """What is wrong with the table, one line each; each says what to do."""
    entries = read_table()
    known = {key_of(entry): entry for entry in entries}
    numbers = numbers_of_library()
    tool, table = "python tests/benchmarks/vary.py", TABLE.relative_to(ROOT)
    found = []
    for number in numbers:
        entry = known.pop(number.key, None)
        if entry is None:
            found.append(
                f"{number.key} = {number.value} has no line in numbers.json: if it only moved, `{tool} --update`; "
                f"if it decides something, say of what it is beside it and `{tool} {number.key} --json {table}`; "
                "else enter it there with its class and reason"
            )
        elif entry["class"] not in CLASSES or not entry.get("of"):
            found.append(f"{number.key} has no class, or does not say of what it is")
        elif entry["value"] != number.value:
            found.append(
                f"{number.key} is {number.value}, its certificate is of {entry['value']}: measure it again"
            )
        elif entry["class"] in MEASURED and not (entry.get("half") and entry.get("double")):
            found.append(f"{number.key} is not measured: `{tool} {number.key} --json {table}`")
    found += [f"{key} is in numbers.json and no longer in the library: `{tool} --update`" for key in known]
    return found


INTRODUCTION = """\
Every number at module level, by room: of what it is and why, and what half and double of it do. Made by
`python tests/benchmarks/vary.py --page` from `tests/benchmarks/numbers.json`; a number is measured again with
`python tests/benchmarks/vary.py NAME --json tests/benchmarks/numbers.json`.

Compared are the probes of its room (`tests/benchmarks/probes.py`): steady films over the box of rolling
bearings, impedances, records of every motion, fits, atlas answers, rotors. In brackets stands the case that
changed most; "work" is the size of all fast transforms together, `extent` the inlet end of the grid. Changes
are relative to the largest of their kind, and told where they exceed what the runs are solved to (1e-4 of a
steady film, 3e-3 of a record, 1e-5 of the rest); smaller ones are "hardly anything". `fallbacks` are films on
which cycles with single sweeps stagnate, or did: which way they end, and after how many cycles, is chance;
`cautious` and `last resort` were two of them, solved by earlier versions. A number between 0.9 and 1.5 is a
margin about 1: its distance from 1 is halved and doubled."""


def page() -> str:
    """docs/numbers.md."""
    entries = read_table()
    lines = [
        "# Numbers",
        "",
        INTRODUCTION,
    ]
    rooms: dict[str, list[dict[str, str]]] = {}
    for entry in entries:
        if entry["class"] in MEASURED:
            rooms.setdefault(entry["module"], []).append(entry)
    for module, numbers in rooms.items():
        lines += [
            "",
            f"## {module}",
            "",
            "| number | value | of what, why | half | double |",
            "|---|---|---|---|---|",
        ]
        for entry in numbers:
            cells = [f"`{entry['name']}`", f"`{entry['value']}`", *(entry[k] for k in ("of", "half", "double"))]
            lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    lines += [
        "",
        "## Numbers that decide nothing",
        "",
        "| number | module | class | reason |",
        "|---|---|---|---|",
    ]
    for entry in entries:
        if entry["class"] not in MEASURED:
            cells = [f"`{entry['name']}`", entry["module"], entry["class"], entry["of"]]
            lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
