"""Benchmarks, as ratios to one reference operation timed in the same process.

Run with ``python tests/benchmarks/run.py [--only TEXT] [--json FILE]``. The reference, "conv", is one scipy.fft
rfft2 + multiply + irfft2 of a 257x257 float64 field zero-padded to 512x512 on one thread, the smallest of 101.
Everything is timed after JIT compilation, as the median of a few repetitions. Nothing here asserts a time.
"""

from __future__ import annotations

import argparse
import json
import statistics
import time
from collections.abc import Callable

import numpy as np
from scipy import fft

from ehlcontact import Domain, FreeVibration, MoesPoint, impedance, simulate, solve_steady
from ehlcontact.solver.balance import Balance
from ehlcontact.solver.deflection import make_deflection
from ehlcontact.solver.mesh import Mesh
from ehlcontact.solver.multigrid import Multigrid
from ehlcontact.transient.film import TransientFilm
from reduced_models import ContactRecord, fit

LOAD = Balance.of_load()
LARGEST_DIRECT = 512  # intervals: the direct sum takes 16 times as long with every doubling


def median_time(work: Callable[[], object], repetitions: int) -> float:
    """Median wall time of `work` in seconds, after one call that is not timed."""
    work()
    times = []
    for _ in range(repetitions):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def reference() -> float:
    """Time of the reference operation [s]."""
    field = np.random.default_rng(1).random((257, 257))
    kernel = fft.rfft2(np.random.default_rng(2).random((512, 512)))
    times = []
    for _ in range(101):
        start = time.perf_counter()
        fft.irfft2(fft.rfft2(field, (512, 512), workers=1) * kernel, (512, 512), workers=1)
        times.append(time.perf_counter() - start)
    return min(times)


def steady(n: int) -> tuple[float, dict[str, float]]:
    """Full multigrid and as many cycles as bring u within 1e-3 of its converged value on this grid."""
    point = MoesPoint(200, 10, 1)
    converged = solve_steady(point, n=n, tol=1e-6).approach
    multigrid = Multigrid(point, Mesh(n, Domain()))
    multigrid.full_multigrid(LOAD)
    cycles = 0
    while abs(multigrid.u - converged) > 1e-3:
        multigrid.cycle(LOAD)
        cycles += 1

    def work() -> None:
        fresh = Multigrid(point, Mesh(n, Domain()))
        fresh.full_multigrid(LOAD)
        for _ in range(cycles):
            fresh.cycle(LOAD)

    return median_time(work, 5), {"cycles": cycles, "error of u": abs(multigrid.u - converged)}


def transient_step(n: int) -> tuple[float, dict[str, float]]:
    """One step of free vibration with force and approach within 1e-4 of the fully converged step."""
    point = MoesPoint(200, 10, 0.5)
    omega_n = 5.13
    motion = FreeVibration(Omega_n=omega_n)
    dT = motion.default_step
    film = TransientFilm(point, Mesh(n, Domain()), 3e-3)
    film.start_steady(LOAD)
    u, rate, acceleration = film.u, motion.initial_rate, 0.0

    def step(tol: float, u: float, rate: float, acceleration: float) -> tuple[float, float]:
        film.tol = tol
        predictor = u + dT * rate + 0.25 * dT * dT * acceleration
        balance = Balance.newmark(omega_n, dT, 1.0, predictor)
        film.advance(dT, balance, predictor + 0.25 * dT * dT * acceleration)
        return film.u, film.level.force()

    for _ in range(20):  # into the record, where extrapolation has something to go by
        new, _ = step(3e-3, u, rate, acceleration)
        before = acceleration
        acceleration = 4.0 * (new - u - dT * rate - 0.25 * dT * dT * acceleration) / dT**2
        rate += 0.5 * dT * (before + acceleration)
        u = new
    state = film.save_state()
    exact = step(1e-8, u, rate, acceleration)
    tol, error = 1e-5, 0.0
    for trial in (3.0, 1.0, 3e-1, 1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5):
        film.restore_state(state)
        reached = step(trial, u, rate, acceleration)
        error = max(abs(a - b) for a, b in zip(reached, exact, strict=True))
        tol = trial
        if error < 1e-4:
            break

    def work() -> None:
        film.restore_state(state)
        step(tol, u, rate, acceleration)

    return median_time(work, 9), {"tol": tol, "error": error, "central film": film.level.central_film()}


def fitted_element() -> tuple[float, dict[str, float]]:
    """A cubic element from nothing: steady state, 2.5 periods of free vibration, fit."""
    point = MoesPoint(200, 10, 0.5)
    outcome: dict[str, float] = {}

    def work() -> None:
        record = ContactRecord.from_result(simulate(point, FreeVibration(Omega_n=5.13), n=64))
        result = fit(record, model="cubic")
        outcome.update(root=result.root or np.nan, tangent=result.tangent or np.nan, **result.parameters)

    return median_time(work, 3), outcome


def impedance_of_twelve() -> tuple[float, dict[str, float]]:
    """Impedance at twelve frequencies."""
    omega = np.concatenate([[0.0], np.geomspace(0.05, 30.0, 11)])
    point = MoesPoint(200, 10, 0.5)
    return median_time(lambda: impedance(point, Omega=omega), 3), {"n": impedance(point, Omega=omega).n}


def deflection(engine: str, n: int) -> tuple[float, dict[str, float]]:
    """One deflection of a film's pressure, steep where it cavitates; its largest error against fast transforms."""
    kappa, hx = 0.5, 6.0 / n
    X, Y = np.linspace(-4.5, 1.5, n + 1), np.linspace(0.0, 3.0, n // 2 + 1)[:, None]
    inlet = np.exp(-3.0 * np.maximum(-X - 0.9, 0.0)) * np.exp(-3.0 * np.maximum(Y - 0.9, 0.0))
    P = np.maximum(np.sqrt(np.maximum(1.0 - X**2 - Y**2, 0.0)), 0.05 * inlet * (X < 0.9))
    P[:, [0, -1]] = 0.0
    P[-1] = 0.0
    chosen, exact = (make_deflection(n, n // 2, hx, hx, kappa, name) for name in (engine, "fft"))
    W = exact(P)
    return median_time(lambda: chosen(P), 5), {"error": float(np.abs(chosen(P) - W).max())}


def main() -> None:
    """Run all benchmarks and print them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="run those whose names hold this text")
    parser.add_argument("--json", help="write the figures to this file")
    arguments = parser.parse_args()
    conv = reference()
    print(f"conv = {conv * 1e3:.2f} ms")
    rows = {}
    benchmarks: list[tuple[str, Callable[[], tuple[float, dict[str, float]]]]] = [
        *((f"steady {n}", lambda n=n: steady(n)) for n in (128, 256, 512)),
        *((f"transient step {n}", lambda n=n: transient_step(n)) for n in (128, 256)),
        ("fitted cubic element", fitted_element),
        ("impedance, 12 frequencies", impedance_of_twelve),
        *(
            (f"deflection {engine} {n}", lambda engine=engine, n=n: deflection(engine, n))
            for n in (128, 256, 512, 1024, 2048)
            for engine in ("fft", "mlmi", "direct")
            if engine != "direct" or n <= LARGEST_DIRECT
        ),
    ]
    for name, benchmark in benchmarks:
        if arguments.only not in name:
            continue
        seconds, details = benchmark()
        rows[name] = {"conv": seconds / conv, "seconds": seconds, **details}
        shown = ", ".join(f"{key} {value:.4g}" for key, value in details.items())
        print(f"{name:28s} {seconds / conv:8.1f} conv   {seconds:8.3f} s   {shown}", flush=True)
    if arguments.json:
        with open(arguments.json, "w", encoding="utf-8") as file:
            json.dump({"conv_seconds": conv, "benchmarks": rows}, file, indent=1)


if __name__ == "__main__":
    main()
