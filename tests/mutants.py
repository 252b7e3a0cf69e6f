"""Mistakes that a developer could make, one at a time, and the test that sees each.

    python tests/mutants.py                                # all of mutants.toml: some ten minutes on two cores
    python tests/mutants.py --only oil-bar --only c-clip    # these
    python tests/mutants.py --jobs 4 --json out.json       # side by side, with a list for machines
    python tests/mutants.py --suite                        # a survivor meets the whole fast suite of its layer too

A mutant is a file, a text that stands in it once, another text, and the tests that should fail with it. Each is
made in a copy of the tree, which is thrown away; the checkout is only read. The tests must pass on the copy before
anything is changed in it. Compiled kernels know when their own file changes, but not when one that they call does:
a mutant in a file of kernels gets a cache of its own.

Ctrl-C ends the run with a table of what is known by then. The exit code is 0 if at least `ENOUGH` are caught.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import tomllib
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from queue import SimpleQueue

ROOT = Path(__file__).parents[1]
TABLE = Path(__file__).with_suffix(".toml")
ENOUGH = 0.95  # share that has to be caught
PATIENCE = 900.0  # seconds for the tests of one mutant: one that hangs is seen too
LEFT_OUT = shutil.ignore_patterns(".*", "__pycache__", "*.egg-info", "images", "shared")  # not in the copy
KERNELS = "ehlcontact.jit"  # who imports this holds compiled kernels
SUITES = {  # the fast tests of a layer, by the folder its files are in; the first that fits
    "ehlcontact/cli": "tests/cli",
    "ehlcontact": "tests/ehlcontact",
    "reduced_models": "tests/reduced_models",
    "fmu": "tests/fmu",
}


class MutantError(Exception):
    """The table does not fit the tree, or the tests fail without any mutant."""


@dataclass(frozen=True)
class Mutant:
    """One mistake: `old` becomes `new` in `file`, and one of `tests` (paths or node ids in tests/) should fail."""

    name: str
    file: str
    old: str
    new: str
    tests: tuple[str, ...]

    def made_in(self, tree: Path) -> str:
        """Text of the file with the mistake in it."""
        path = tree / self.file
        if not path.is_file():
            raise MutantError(f"{self.name}: there is no file {self.file}")
        text = path.read_text(encoding="utf-8")
        if (count := text.count(self.old)) != 1:
            raise MutantError(f"{self.name}: {self.old!r} stands {count} times in {self.file}, must be once")
        return text.replace(self.old, self.new)

    def paths(self, tree: Path) -> list[str]:
        """Its tests, from the root of the tree."""
        found = [f"tests/{test}" for test in self.tests]
        for test in found:
            if not (tree / test.partition("::")[0]).is_file():
                raise MutantError(f"{self.name}: there is no {test}")
        return found

    @property
    def suite(self) -> str:
        """All fast tests of its layer."""
        return next(tests for folder, tests in SUITES.items() if self.file.startswith(folder + "/"))

    def changes_a_kernel(self, tree: Path) -> bool:
        """Whether compiled code may depend on its file."""
        return self.file.endswith(".py") and KERNELS in (tree / self.file).read_text(encoding="utf-8")


@dataclass(frozen=True)
class Outcome:
    """What became of a mutant; `by` is the test that saw it, None of a survivor."""

    name: str
    file: str
    by: str | None
    seconds: float


class Tests:
    """Runs pytest in one copy of the tree, with a cache of compiled kernels that stays."""

    def __init__(self, tree: Path, stopped: threading.Event) -> None:
        self.tree, self._stopped = tree, stopped

    def first_failure(self, tests: Sequence[str], fresh_cache: bool = False) -> str | None:
        """The first of `tests` that fails, None if all pass."""
        with tempfile.TemporaryDirectory(dir=self.tree.parent, ignore_cleanup_errors=True) as fresh:
            cache = fresh if fresh_cache else str(self.tree.parent / f"cache-{self.tree.name}")
            return self._failure(tests, cache)

    def _failure(self, tests: Sequence[str], cache: str) -> str | None:
        options = ["-x", "-q", "-rfE", "--no-header", "--tb=no", "-p", "no:cacheprovider"]
        command = [sys.executable, "-m", "pytest", *options, *tests]
        environment = os.environ | {
            "PYTHONPATH": str(self.tree),
            "PYTHONDONTWRITEBYTECODE": "1",  # two mutants within a second may have the same size
            "NUMBA_CACHE_DIR": cache,
            "MPLBACKEND": "Agg",
            "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1",  # a second each time, and the tests need none
        }
        process = subprocess.Popen(
            command,
            cwd=self.tree,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,  # Ctrl-C is for us, who end it with all that it has started
        )
        end = time.monotonic() + PATIENCE
        while True:
            try:
                said, _ = process.communicate(timeout=0.5)
                break
            except subprocess.TimeoutExpired:
                if self._stopped.is_set() or time.monotonic() > end:
                    os.killpg(process.pid, signal.SIGKILL)
                    process.communicate()
                    return "time ran out"
        if process.returncode == 0:
            return None
        seen = re.search(r"^(?:FAILED|ERROR) (\S+)", said, flags=re.M)
        if process.returncode not in (1, 2) or seen is None:
            raise MutantError(f"pytest {' '.join(tests)} did not run:\n{said.strip()[-2000:]}")
        return seen[1].removeprefix("tests/")


def read_table(path: Path = TABLE) -> list[Mutant]:
    """All mutants."""
    rows = tomllib.loads(path.read_text(encoding="utf-8"))["mutant"]
    return [Mutant(**{**row, "tests": tuple(row["tests"])}) for row in rows]


def copy_tree(source: Path, target: Path) -> Path:
    """What the tests need of the tree; times are kept, so that compiled kernels stay valid."""
    return Path(shutil.copytree(source, target, ignore=LEFT_OUT))


@contextmanager
def mutated(tree: Path, mutant: Mutant) -> Iterator[None]:
    """The mutant in a copy of the tree, for as long as the context lasts."""
    path = tree / mutant.file
    content, times = path.read_bytes(), path.stat()
    try:
        path.write_text(mutant.made_in(tree), encoding="utf-8")
        yield
    finally:
        path.write_bytes(content)
        os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))


def tried(mutant: Mutant, tests: Tests, suite: bool) -> Outcome:
    """Make one mutant and see which test notices."""
    started = time.monotonic()
    fresh = mutant.changes_a_kernel(tests.tree)
    with mutated(tests.tree, mutant):
        by = tests.first_failure(mutant.paths(tests.tree), fresh)
        if by is None and suite:
            by = tests.first_failure([mutant.suite], fresh)
    return Outcome(mutant.name, mutant.file, by, round(time.monotonic() - started, 1))


def run(
    mutants: Sequence[Mutant],
    *,
    root: Path = ROOT,
    jobs: int = 1,
    suite: bool = False,
    tell: Callable[[str], None] = lambda line: None,
) -> list[Outcome]:
    """Try all mutants, in copies of the tree at `root`; after Ctrl-C those that were done.

    Raises
    ------
    MutantError
        A mutant that does not fit the tree, or tests that fail without one.
    """
    for mutant in mutants:  # all mistakes of the table at once, before an hour is spent
        mutant.made_in(root), mutant.paths(root)
    done: list[Outcome] = []
    stopped = threading.Event()
    free: SimpleQueue[Tests] = SimpleQueue()
    with (
        tempfile.TemporaryDirectory(prefix="mutants-", ignore_cleanup_errors=True) as folder,
        ThreadPoolExecutor(jobs) as pool,
    ):
        trees = [copy_tree(root, Path(folder) / f"tree{k}") for k in range(jobs)]
        started = time.monotonic()

        def sound(k: int) -> None:
            tests = Tests(trees[k], stopped)
            named = sorted({test for mutant in mutants[k::jobs] for test in mutant.paths(trees[k])})
            if named and (seen := tests.first_failure(named)) is not None and not stopped.is_set():
                raise MutantError(f"{seen} fails without any mutant")
            free.put(tests)

        def one(mutant: Mutant) -> Outcome:
            tests = free.get()
            try:
                return tried(mutant, tests, suite)
            finally:
                free.put(tests)

        try:
            tell(f"the tests of {len(mutants)} mutants, without any")
            list(pool.map(sound, range(jobs)))
            tell(f"pass in {time.monotonic() - started:.0f} s")
            started = time.monotonic()
            for future in as_completed([pool.submit(one, mutant) for mutant in mutants]):
                done.append(future.result())
                left = (time.monotonic() - started) / len(done) * (len(mutants) - len(done))
                tell(f"[{len(done)}/{len(mutants)}] {line_of(done[-1])}; {left / 60.0:.0f} min left")
        except KeyboardInterrupt:
            tell("interrupted: what is known so far")
        finally:
            stopped.set()
            pool.shutdown(cancel_futures=True)
    return sorted(done, key=lambda outcome: [mutant.name for mutant in mutants].index(outcome.name))


def line_of(outcome: Outcome) -> str:
    """One line about a mutant."""
    return f"{outcome.name}: {outcome.by or 'SURVIVED'} ({outcome.seconds:.0f} s)"


def table_of(outcomes: Sequence[Outcome]) -> str:
    """All outcomes, survivors last, and how many were caught."""
    caught = [outcome for outcome in outcomes if outcome.by is not None]
    rows = [(o.name, o.file, o.by or "SURVIVED") for o in sorted(outcomes, key=lambda o: o.by is None)]
    widths = [max((len(row[k]) for row in rows), default=0) for k in range(2)]
    lines = [f"{name:{widths[0]}}  {file:{widths[1]}}  {by}" for name, file, by in rows]
    return "\n".join([*lines, f"caught {len(caught)} of {len(outcomes)}"])


def enough(outcomes: Sequence[Outcome]) -> bool:
    """Whether at least `ENOUGH` of them were caught."""
    return sum(outcome.by is not None for outcome in outcomes) >= ENOUGH * len(outcomes) > 0.0


def main(arguments: Sequence[str] | None = None) -> int:
    """Command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--only", action="append", metavar="NAME", help="this mutant; may be repeated")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the outcomes here too")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="copies of the tree at work (2)")
    parser.add_argument("--suite", action="store_true", help="try survivors on all fast tests of their layer")
    asked = parser.parse_args(arguments)
    mutants = read_table()
    if unknown := set(asked.only or ()) - {mutant.name for mutant in mutants}:
        parser.error(f"no mutant is called {', '.join(sorted(unknown))}")
    mutants = [mutant for mutant in mutants if asked.only is None or mutant.name in asked.only]
    try:
        outcomes = run(
            mutants,
            jobs=max(1, min(asked.jobs, len(mutants))),
            suite=asked.suite,
            tell=lambda line: print(line, file=sys.stderr, flush=True),
        )
    except MutantError as error:
        print(f"mutants: {error}", file=sys.stderr)
        return 2
    if asked.json is not None:
        asked.json.write_text(json.dumps([asdict(outcome) for outcome in outcomes], indent=1) + "\n")
    print(table_of(outcomes))
    return 0 if enough(outcomes) and len(outcomes) == len(mutants) else 1


if __name__ == "__main__":
    sys.exit(main())
