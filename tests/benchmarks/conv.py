"""The reference operation "conv", and times as ratios to it.

conv is the smallest time of 101 `scipy.fft` rfft2 + multiply + irfft2 of a 257 x 257 float64 field zero-padded to
512 x 512 on one thread. It is taken before and after every benchmark: where the two differ by more than
`LARGEST_DRIFT` the machine was busy with something else, and no ratio is given; nor is one where the work took
that much longer by the wall than by the processor, which the smallest of 101 does not see.

It runs in a process that does nothing else. In that of the work it is 1.5 times faster or not, by what the work
has freed before: glibc then hands out kept memory to the transforms, and spares them a thousand page faults each.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from scipy import fft

LARGEST_DRIFT = 0.15  # of the smaller one; on a quiet machine they differ by 12 % at most


def reference() -> tuple[float, float]:
    """Wall and processor time of the reference operation [s], in a process of its own."""
    told = subprocess.run([sys.executable, __file__], capture_output=True, text=True, check=True)
    wall, cpu = told.stdout.split()
    return float(wall), float(cpu)


def convolution(runs: int = 101) -> tuple[float, float]:
    """Smallest wall and processor time of the reference operation [s], here and now."""
    field = np.random.default_rng(1).random((257, 257))
    kernel = fft.rfft2(np.random.default_rng(2).random((512, 512)))
    clocks = []
    for _ in range(runs):
        with Clock() as clock:
            fft.irfft2(fft.rfft2(field, (512, 512), workers=1) * kernel, (512, 512), workers=1)
        clocks.append(clock)
    return min(clock.wall for clock in clocks), min(clock.cpu for clock in clocks)


class Clock:
    """Wall and processor seconds, while it runs."""

    def __init__(self) -> None:
        self.wall = self.cpu = 0.0
        self._since: tuple[float, float] | None = None

    def __enter__(self) -> Clock:
        self._since = time.perf_counter(), time.process_time()
        return self

    def __exit__(self, *_: object) -> None:
        assert self._since is not None
        self.wall += time.perf_counter() - self._since[0]
        self.cpu += time.process_time() - self._since[1]


def median_seconds(work: Callable[[], object], repetitions: int) -> dict[str, float]:
    """Median wall and processor time of `work` in seconds, after one call that is not timed."""
    work()
    clocks = []
    for _ in range(repetitions):
        with Clock() as clock:
            work()
        clocks.append(clock)
    return {
        "seconds": statistics.median(clock.wall for clock in clocks),
        "cpu": statistics.median(clock.cpu for clock in clocks),
    }


class Bracket:
    """conv before and after what is timed: ``with Bracket() as bracket: ...``, then ``bracket.ratios(row)``."""

    def __init__(self, measure: Callable[[], tuple[float, float]] = reference) -> None:
        self._measure = measure
        self.before = self.after = self.cpu_before = self.cpu_after = float("nan")

    def __enter__(self) -> Bracket:
        self.before, self.cpu_before = self._measure()
        return self

    def __exit__(self, *_: object) -> None:
        self.after, self.cpu_after = self._measure()

    @property
    def drift(self) -> str | None:
        """Why no ratio is given at all, if none is."""
        drift = max(self.before, self.after) / min(self.before, self.after) - 1.0
        if drift <= LARGEST_DRIFT:
            return None
        return (
            f"conv {1e3 * self.before:.2f} ms before and {1e3 * self.after:.2f} ms after: {100 * drift:.0f} % "
            f"apart, more than {100 * LARGEST_DRIFT:.0f} %"
        )

    def ratios(self, row: dict[str, Any]) -> dict[str, Any]:
        """Give `row`, and every table in it, ``conv`` beside ``seconds`` and ``cpu_conv`` beside ``cpu``.

        The latter is over the processor time of conv, and always given. The former is None where conv drifted and
        where the work had to wait for the processor; ``refused`` says why.
        """
        refused = self.drift
        conv = None if refused else 0.5 * (self.before + self.after)
        cpu_conv = 0.5 * (self.cpu_before + self.cpu_after)
        for table in (row, *(value for value in row.values() if isinstance(value, dict))):
            if not isinstance(table.get("seconds"), float):
                continue
            wall, cpu = table["seconds"], table["cpu"]
            waited = wall > (1.0 + LARGEST_DRIFT) * cpu
            if waited and refused is None:
                refused = f"{wall:.3g} s for {cpu:.3g} s of work: the processor was shared"
            table["conv"] = wall / conv if conv and not waited else None
            table["cpu_conv"] = cpu / cpu_conv
        told = [[1e3 * self.before, 1e3 * self.after], [1e3 * self.cpu_before, 1e3 * self.cpu_after]]
        return row | {"conv_ms": told[0], "conv_cpu_ms": told[1], "refused": refused}


def circumstances() -> dict[str, Any]:
    """What a figure depends on beside the work: code, threads, and how busy the machine is."""
    folder = Path(__file__).parent
    told = subprocess.run(
        ["git", "describe", "--always", "--dirty"], cwd=folder, capture_output=True, text=True, check=False
    )
    return {
        "commit": told.stdout.strip() or "unknown",
        "date": time.strftime("%Y-%m-%d"),
        "cores": os.cpu_count(),
        "threads": {name: os.environ.get(name) for name in ("OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")},
        "load": os.getloadavg()[0],
    }


if __name__ == "__main__":
    print(*convolution())
