"""Small runs of every part of the library, and their figures: what `vary.py` holds against each other.

    python tests/benchmarks/probes.py OUT.json NAME ...      # without a name: all

A figure is named ``probe/case/quantity``. Quantities are statuses and other words, counts (``cycles``, ``steps``,
``factors``, ``krylov``, ``work``, ``n``, ...), ``seconds`` of processor time, and numbers.
"""

from __future__ import annotations

import importlib
import json
import pkgutil
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

Figures = dict[str, Any]
COUNTS = {"factors": 0, "krylov": 0, "work": 0.0}


def count_work() -> None:
    """Count factorisations, Krylov iterations and transforms, at their source in SciPy."""
    import scipy.fft
    import scipy.linalg
    import scipy.sparse.linalg as sparse

    def counted(function: Callable[..., Any], name: str, size: Callable[..., float]) -> Callable[..., Any]:
        def call(*args: Any, **options: Any) -> Any:
            COUNTS[name] += size(*args)
            return function(*args, **options)

        return call

    scipy.fft.rfft = counted(scipy.fft.rfft, "work", lambda x, *_: x.size)
    scipy.linalg.lu_factor = counted(scipy.linalg.lu_factor, "factors", lambda *_: 1)
    sparse.splu = counted(sparse.splu, "factors", lambda *_: 1)
    gcrotmk = sparse.gcrotmk

    def krylov(A: Any, b: Any, *args: Any, M: Any = None, **options: Any) -> Any:
        matvec = M.matvec

        def counting(x: Any) -> Any:
            COUNTS["krylov"] += 1
            return matvec(x)

        again = sparse.LinearOperator(M.shape, matvec=counting, dtype=M.dtype)
        return gcrotmk(A, b, *args, M=again, **options)

    sparse.gcrotmk = krylov


def home(name: str) -> Any:
    """A name of the library, wherever it lives."""
    for package in ("ehlcontact.solver", "ehlcontact", "reduced_models", "fmu"):
        parent = importlib.import_module(package)
        for module in pkgutil.walk_packages(parent.__path__, f"{package}."):
            if ".cli" in module.name or "__main__" in module.name:
                continue
            found = getattr(importlib.import_module(module.name), name, None)
            if found is not None:
                return found
    raise LookupError(f"the library has no {name}")


class Bench:
    """Runs cases and keeps their figures."""

    def __init__(self) -> None:
        self.figures: Figures = {}
        self.probe = ""

    def case(self, name: str, work: Callable[[], Figures], repeat: int = 1) -> None:
        """Run `work`; its figures, counts and least time are kept, or what it failed with."""
        seconds, figures = [], {}
        for _ in range(repeat):
            for key in COUNTS:
                COUNTS[key] = 0
            start = time.process_time()
            try:
                figures = work()
            except Exception as error:
                text = " ".join(str(error).split())
                figures = {"fails": f"{type(error).__name__}: {text[:110]}"}
            seconds.append(time.process_time() - start)
        figures |= {key: value for key, value in COUNTS.items() if value}
        figures["seconds"] = min(seconds)
        for key, value in figures.items():
            if isinstance(value, np.ndarray):
                value = value.tolist()
            elif isinstance(value, np.generic):
                value = value.item()
            self.figures[f"{self.probe}/{name}/{key}"] = value


# ---------------------------------------------------------------------------------------------- the film at rest

POINTS = {
    "paper": (200.0, 10.0, 0.5),
    "circle": (20.0, 10.0, 1.0),
    "6205": (2900.0, 19.0, 0.107),
    "light": (5.0, 12.0, 0.12),
    "lightest": (5.0, 2.0, 0.3),
    "thin": (3786.0, 5.9, 0.7),
    "isoviscous": (200.0, 0.0, 1.0),
    "along rolling": (50.0, 6.0, 2.0),
    "near": (12000.0, 8.0, 0.15),
    "wider": (6.0748, 2.7586, 0.08827),
}
# Two on meshes too coarse for them, on which single sweeps stagnate, and two on which less careful cycles did.
FALLBACKS = {
    "isoviscous": (1000.0, 0.0, 1.0),
    "side lobes": (300.0, 1.0, 3.0),
    "narrow": (7.7757, 22.771, 4.5862),
    "stiff": (164.43, 24.561, 1.3554),
}
COARSE = {"isoviscous": 64, "side lobes": 128}


def _point(name: str) -> Any:
    from ehlcontact import MoesPoint

    return MoesPoint(*POINTS[name])


def _film(result: Any) -> Figures:
    found = {name: getattr(result, name) for name in ("cycles", "n", "approach", "h_central", "h_min")}
    return {"status": str(result.status), "extent": result.domain.x_in, **found}


def steady(bench: Bench) -> None:
    """Steady films over the box, with first grid, domain and method left to the library."""
    from ehlcontact import Domain, solve_steady

    for name in POINTS:
        bench.case(name, lambda name=name: _film(solve_steady(_point(name), refine=False, throw=False)))
    given = {
        "pressed": ("paper", {"n": 64, "approach": 1.3}),
        "few nodes": ("paper", {"n": 32, "domain": Domain(-1.2, 1.2, 1.2)}),
        "unresolved": ("near", {"n": 32}),
        "sharp": ("circle", {"n": 64, "tol": 1e-9}),
    }
    for name, (point, options) in given.items():
        bench.case(name, lambda p=point, o=options: _film(solve_steady(_point(p), throw=False, **o)))


def accuracy(bench: Bench) -> None:
    """Errors that results state, and the grids that are chosen by them."""
    from ehlcontact import MoesPoint, solve_steady

    points = {name: MoesPoint(*POINTS[name]) for name in ("paper", "circle", "6205")}
    for name, point in (points | {"sides": MoesPoint(97.0, 10.56, 1.489)}).items():

        def solved(point: Any = point) -> Figures:
            film = solve_steady(point, throw=False)
            error = film.summary()["error"] or {}
            return _film(film) | {f"error of {k}": v for k, v in error.items()}

        bench.case(name, solved)


def fallbacks(bench: Bench) -> None:
    """Films on which cycles with single sweeps stagnate or crawl, so that more sweeps or Newton must finish."""
    from ehlcontact import MoesPoint, solve_steady

    for name, point in FALLBACKS.items():
        options = {"n": COARSE.get(name), "refine": False, "throw": False}
        bench.case(name, lambda p=point, o=options: _film(solve_steady(MoesPoint(*p), **o)))


def near_domain(bench: Bench) -> None:
    """A film so thin that oil far out makes no difference."""
    from ehlcontact import MoesPoint, solve_steady

    bench.case("very thin", lambda: _film(solve_steady(MoesPoint(20000, 11, 0.5), refine=False, throw=False)))


def thin_sides(bench: Bench) -> None:
    """A film whose side lobes set the mesh."""
    from ehlcontact import MoesPoint, solve_steady

    bench.case("thin sides", lambda: _film(solve_steady(MoesPoint(12834, 3.2, 1.09), refine=False, throw=False)))


def newton(bench: Bench) -> None:
    """The same by Newton."""
    from ehlcontact import solve_steady

    for name, options in {"paper": {"n": 64, "tol": 1e-8}, "6205": {"n": 128}, "thin": {}}.items():
        bench.case(
            name,
            lambda n=name, o=options: _film(
                solve_steady(_point(n), method="newton", refine=False, throw=False, **o)
            ),
        )


def impedances(bench: Bench) -> None:
    """K and C over frequency."""
    from ehlcontact import impedance

    omega = [0.0, 0.05, 0.4, 1.5, 4.0, 8.0, 16.0, 30.0]

    def figures(name: str) -> Figures:
        found = impedance(_point(name), Omega=omega)
        return {"n": found.n, "extent": found.domain.x_in, "K": found.stiffness, "C": found.damping}

    for name in ("paper", "light", "6205"):
        bench.case(name, lambda name=name: figures(name))


# ---------------------------------------------------------------------------------------------- the film in time


def _record(result: Any) -> Figures:
    shared = np.linspace(0.0, result.T[-1], 41)
    at = {name: np.interp(shared, result.T, getattr(result, name)) for name in ("approach", "force", "h_min")}
    return {
        "status": str(result.status),
        "n": result.n,
        "steps": int(result.T.size - 1),
        "cycles": float(np.sum(result.cycles)),
        "until": float(result.T[-1]),
        **at,
    }


def transient(bench: Bench) -> None:
    """Records of every kind of motion, in fixed and in controlled steps."""
    from ehlcontact import (
        FreeVibration,
        HarmonicLoad,
        PrescribedApproach,
        PrescribedLoad,
        RampLoad,
        simulate,
    )

    T = np.linspace(0.0, 1.0, 21)
    bent = np.where(T < 0.5, 1.0 + 0.4 * T, 1.2 - 0.1 * (T - 0.5))
    wave = PrescribedApproach(T, 0.88 + 0.05 * np.sin(np.pi * T) ** 2)
    pressed = PrescribedApproach(T, np.interp(T, [0.0, 0.1, 0.15, 1.0], [0.88, 0.88, 2.0, 2.0]))
    lifted = PrescribedApproach(T, np.interp(T, [0.0, 0.1, 0.15, 1.0], [0.88, 0.88, 0.1, 0.1]))

    def jump(X: Any, Y: Any, T: float) -> Any:
        return (0.02 if T > 0.2 else 0.0) * np.exp(-(X**2) - Y**2)

    parted = PrescribedApproach(T, 0.88 - 2.0 * T)
    cases = {
        "free": ("paper", FreeVibration(Omega_n=5.13), {"n": 32}),
        "free 6205": ("6205", FreeVibration(Omega_n=10.0), {"n": 64, "until": 0.15}),
        "free on the chosen grid": ("paper", FreeVibration(Omega_n=5.13), {"until": 0.05}),
        "harmonic": ("paper", HarmonicLoad(Omega=np.pi), {"n": 64, "until": 1.0}),
        "ramp": ("paper", RampLoad(1.5, 0.5, Omega_n=5.13), {"n": 32, "until": 1.0}),
        "approach": ("paper", wave, {"n": 32}),
        "controlled ramp": ("paper", RampLoad(1.5, 0.5, Omega_n=5.13), {"n": 32, "until": 1.5, "error": 1e-3}),
        "controlled approach": ("paper", wave, {"n": 32, "error": 1e-4, "snapshots": (0.3,)}),
        "controlled table": ("paper", PrescribedLoad(T, bent), {"n": 32, "error": 3e-4}),
        "controlled blow": ("paper", RampLoad(4.0, 0.02, Omega_n=5.13), {"n": 32, "until": 0.5, "error": 1e-2}),
        "controlled press": ("paper", pressed, {"n": 32, "error": 1e-2}),
        "controlled lift": ("paper", lifted, {"n": 32, "error": 1e-3}),
        "jump": ("paper", HarmonicLoad(Omega=np.pi), {"n": 32, "until": 0.5, "error": 1e-4, "surface": jump}),
        "controlled long": ("paper", HarmonicLoad(Omega=0.05), {"n": 32, "until": 60.0, "error": 1e-3}),
        "parted": ("paper", parted, {"n": 32}),
        "failing": ("paper", RampLoad(60.0, 0.3, Omega_n=5.13), {"n": 32, "until": 0.5}),
        "failing in controlled steps": (
            "paper",
            RampLoad(60.0, 0.3, Omega_n=5.13),
            {"n": 32, "until": 0.5, "error": 1e-2},
        ),
    }
    for name, (point, motion, options) in cases.items():
        bench.case(name, lambda p=point, m=motion, o=options: _record(simulate(_point(p), m, throw=False, **o)))


def surfaces(bench: Bench) -> None:
    """Features that pass through the contact, one of them too small for the grid, one not even in Y."""
    from ehlcontact import Dent, HarmonicLoad, Roughness, Waviness, simulate

    cases = {
        "dent": Dent(0.05, 0.8, speed=1.2),
        "waves": Waviness(0.01, 0.8),
        "short waves": Waviness(0.01, 0.25),
        "shorter waves": Waviness(0.01, 0.12),
        "small dent": Dent(0.01, 0.1, start=0.0),
        "aslant": lambda X, Y, T: 0.01 * np.sin(2.0 * X + Y),
        "faint": Waviness(1.2e-9, 0.12),
        "rough": Roughness.synthetic(0.01, 2.0, 0.8, kappa=0.5, start=0.0),
        "rougher": Roughness.synthetic(0.01, 2.0, 0.5, kappa=0.5, start=0.0),
    }
    for name, surface in cases.items():
        bench.case(
            name,
            lambda s=surface: _record(
                simulate(_point("paper"), HarmonicLoad(Omega=np.pi), n=64, until=0.3, surface=s, throw=False)
            ),
        )


def full_contact(bench: Bench) -> None:
    """The film as a force element."""
    from ehlcontact import ConvergenceError, FullContact

    def figures() -> Figures:
        contact = FullContact(_point("paper"))
        forces = [contact.advance(0.05, 0.88 + 0.02 * k) for k in range(6)]
        forces += [contact.advance(0.3, 0.7), contact.advance(0.1, 0.3)]
        try:
            contact.advance(1e-3, 4.0)
        except ConvergenceError as error:
            return {"status": str(error)[:40], "force": forces, "n": contact.n}
        return {"status": "advanced", "force": forces, "n": contact.n}

    bench.case("full contact", figures)


def wave(bench: Bench) -> None:
    """Speed of a film wave."""
    from ehlcontact import HarmonicLoad, film_wave, simulate, track_wave

    result = simulate(_point("paper"), HarmonicLoad(Omega=np.pi), n=64, until=4.0)
    coarse = simulate(_point("paper"), HarmonicLoad(Omega=np.pi), n=32, until=4.0, dT=0.2)

    def figures(run: Any, start: float, end: float) -> Figures:
        track = track_wave(film_wave(run), start, end)
        return {"speed": track.speed, "spread": track.spread}

    bench.case("fine steps", lambda: figures(result, -0.6, 0.6))
    bench.case("coarse steps", lambda: figures(coarse, -0.6, 0.6))


def lowest(bench: Bench) -> None:
    """The smallest film between nodes, of two films, and its time."""
    from ehlcontact import solve_steady

    find = home("lowest_film")
    for name, n in (("paper", 64), ("6205", 128), ("thin", 256)):
        H = np.ascontiguousarray(solve_steady(_point(name), n=n, throw=False).H.T)
        bench.case(name, lambda H=H: {"h_min": find(H)[0], "place": list(find(H)[1:])}, 20)


def deflections(bench: Bench) -> None:
    """Multilevel and transformed sums against the direct one."""
    make = home("deflection")
    make = getattr(make, "deflection", make)
    for nx, ny, kappa in ((64, 48, 0.5), (128, 64, 1.0), (256, 128, 0.3), (64, 64, 1.0)):
        hx, hy = 6.0 / nx, 3.0 / ny
        X, Y = np.linspace(-4.5, 1.5, nx + 1), np.linspace(0.0, 3.0, ny + 1)[:, None]
        P = np.sqrt(np.maximum(0.0, 1.0 - X**2 - Y**2))
        exact = make(nx, ny, hx, hy, kappa, engine="fft")(P)

        def figures(engine: str, shape: Any = (nx, ny, hx, hy, kappa), P: Any = P, exact: Any = exact) -> Figures:
            tool = make(*shape, engine=engine)
            start = time.process_time()
            for _ in range(10):
                W = tool(P)
            return {"error": float(np.abs(W - exact).max()), "seconds of ten": time.process_time() - start}

        for engine in ("fft", "mlmi"):
            bench.case(f"{engine} {nx} x {ny}", lambda e=engine, f=figures: f(e), 3)


# ---------------------------------------------------------------------------------------------- elements


def _records() -> tuple[Any, Any]:
    from ehlcontact import FreeVibration, HarmonicLoad, simulate
    from reduced_models import ContactRecord

    free = simulate(_point("paper"), FreeVibration(Omega_n=5.13), n=32)
    harmonic = simulate(_point("paper"), HarmonicLoad(Omega=2.0 * np.pi), n=32)
    return ContactRecord.from_result(free), ContactRecord.from_result(harmonic)


def _fit(result: Any) -> Figures:
    found = {"parameters": list(result.parameters.values()), "rms": result.rms, "root": result.root}
    return found | {"tangent": result.tangent, "condition": result.condition}


def fits(bench: Bench) -> None:
    """Memoryless models fitted to records, sound ones and hopeless ones."""
    from reduced_models import ContactRecord, fit, sensitivity

    both = _records()
    free = both[0]
    for model in ("linear", "cubic", "polynomial", "power"):
        bench.case(model, lambda m=model: _fit(fit(list(both), model=m)), 2)
        bench.case(f"{model} of one", lambda m=model: _fit(fit(free, model=m)))
    bench.case("sensitivity", lambda: {"warnings": int(sensitivity(list(both)).warning is not None)})
    bench.case("all of a cubic", lambda: dict(_leaves("", fit(free).to_dict())))

    def made(T: Any, u: Any, v: Any, f: Any, model: str) -> Figures:
        return _fit(fit(ContactRecord(T, u, v, f), model=model))

    T = np.linspace(0.0, 3.0, 200)
    u, v = 0.9 + 0.05 * np.sin(6.0 * T), 0.3 * np.cos(6.0 * T)
    bench.case("undamped power", lambda: made(T, u, v, np.maximum(u + 0.1, 0.0) ** 1.5, "power"))
    bench.case("line as power", lambda: made(T, u, v, 2.0 * u - 0.8 + 0.01 * v, "power"))
    bench.case("steep power", lambda: made(T, u, v, (u + 0.05) ** 6.0 + 0.01 * v, "power"))
    bench.case("one rate", lambda: made(T, 0.9 + 0.05 * T, np.full(200, 0.05), 0.8 + 0.06 * T, "cubic"))
    bench.case("rates a little off", lambda: made(T, u, 1.05 * v, u**1.5 + 0.01 * v, "cubic"))
    bench.case("rates off", lambda: made(T, u, 1.15 * v, u**1.5 + 0.01 * v, "cubic"))
    bench.case("five samples", lambda: made(T[:5], u[:5], v[:5], u[:5] ** 1.5 + 0.01 * v[:5], "linear"))


def memory_fits(bench: Bench) -> None:
    """Film memories fitted to an impedance and a record."""
    from ehlcontact import impedance
    from reduced_models import fit_memory

    response = impedance(_point("paper"), Omega=[0.0, *np.geomspace(0.03, 60.0, 14)], n=32)
    free = _records()[0]

    def figures(found: Any) -> Figures:
        element = found.element
        return {
            "lags": len(element.gains) - 3,
            "C error": float(np.sqrt(np.mean(found.damping_error**2))),
            "K error": float(np.sqrt(np.mean(found.stiffness_error**2))),
            "record error": list(found.record_rms),
            "tangent": found.tangent,
            "root": found.root,
            "rates": [element.lag_rate, element.inlet_rate, element.fast_rate],
            "gains": list(element.gains),
        }

    bench.case("6 lags", lambda: figures(fit_memory(response, [free], lags=6)))
    bench.case("16 lags", lambda: figures(fit_memory(response, lags=16)))
    bench.case("chosen", lambda: figures(fit_memory(response)))
    bench.case("solved for", lambda: figures(fit_memory(None, [free], lags=6)))


def wide(bench: Bench) -> None:
    """A wide-range element from solves."""
    from reduced_models import wide_range_from_solves

    def figures() -> Figures:
        found = wide_range_from_solves(_point("paper"), n=64)
        loads = np.array([0.05, 0.5, 1.0, 2.0])
        return {
            "approach": [found.approach_at(load) for load in loads],
            "tangent": [found.spring_tangent(found.approach_at(load)) for load in loads],
            "C": found.impedance(Omega=[0.05, 1.0, 10.0]).imag / np.array([0.05, 1.0, 10.0]),
        }

    bench.case("from solves", figures)


def _at(model: str) -> dict[str, float]:
    """Frequency of an element of the atlas that is asked for one."""
    return {"Omega": 2.0 * np.pi} if model == "cubic" else {}


def elements(bench: Bench) -> None:
    """Forces, tangents, statics and steps of elements by hand and from the atlas."""
    from reduced_models import Atlas, CubicContact, PowerLawContact

    box = {"low": 0.75, "high": 1.0, "rate": 0.6}
    atlas = Atlas()
    made = {
        "cubic": lambda: CubicContact(0.624, 0.75, -0.174, 0.013, **box),
        "power": lambda: PowerLawContact(0.9, 1.6, 0.12, 0.03, 0.014, **box),
        "memory": lambda: atlas.element(_point("paper"), "memory"),
        "wide": lambda: atlas.element(_point("paper"), "wide"),
        "wide 6205": lambda: atlas.element(_point("6205"), "wide"),
        "wide light": lambda: atlas.element(_point("lightest"), "wide"),
    }

    def figures(contact: Any, amplitude: float) -> Figures:
        low, high = contact.low, contact.high
        u = np.linspace(low - 0.6 * (high - low), high + 0.6 * (high - low), 41)
        loads = [0.01, 0.6, 1.0, 1.4, 5.0]
        contact.rest(0.5 * (low + high))
        steps = []
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            for k in range(60):
                at = 0.5 * (low + high) + amplitude * (high - low) * np.sin(0.3 * k)
                rate = amplitude * (high - low) * 0.3 / 0.05 * np.cos(0.3 * k)
                steps.append(contact.advance(0.05, at, rate))
        return {
            "spring": np.asarray(contact.spring(u)),
            "approach": [contact.approach_at(load) for load in loads],
            "force": steps,
            "warnings": len(told),
        }

    for name, make in made.items():
        for amplitude in (0.52, 0.7):
            bench.case(f"{name}, {amplitude:g}", lambda m=make, a=amplitude: figures(m(), a), 2)


def gains(bench: Bench) -> None:
    """Gains of film memories fitted to impedances, and the test that they dissipate."""
    fit_gains, rates_of = home("fit_gains"), home("FilterRates")
    omega = np.array([0.0, *np.geomspace(0.03, 60.0, 20)])

    def figures(lags: int, dip: float) -> Figures:
        rates = rates_of(lags, lags / 1.6, 8.0, 40.0)
        C = (
            0.02
            * (0.1 + 1.0 / (1.0 + (omega / 3.0) ** 2))
            * (1.0 - dip * np.exp(-((np.log(omega + 0.01) - 1.0) ** 2)))
        )
        K = 1.2 + 0.02 * omega**2 / (1.0 + omega**2 / 9.0) * 0.2
        found = fit_gains(rates, omega, K, C, 1.2)
        return {"gains": found.gains, "C": found.damping, "K": found.stiffness}

    def passive(lags: int) -> Figures:
        rates, generator = rates_of(lags, lags / 1.6, 8.0, 40.0), np.random.default_rng(3)
        rows = (
            generator.random((400, 3 + lags))
            * np.r_[0.05, -0.03, 0.1, np.full(lags, 0.02) * generator.choice([-1.0, 1.0], lags)]
        )
        return {
            "answers": float(sum(rates.passive(row) for row in rows)),
            "least": rates.least_dissipation(rows[0]),
        }

    for lags, dip in ((6, 0.0), (14, 0.9), (14, 0.999)):
        bench.case(f"{lags} lags, dip {dip:g}", lambda a=lags, d=dip: figures(a, d), 2)
    bench.case("passive", lambda: passive(14))
    bench.case("40 lags", lambda: {"lags": rates_of(40, 20.0, 8.0, 40.0).lags})


# ---------------------------------------------------------------------------------------------- the atlas

ATLAS_POINTS = {
    "paper": (200.0, 10.0, 0.5),
    "6205": (2900.0, 19.0, 0.107),
    "light": (7.0, 3.0, 0.3),
    "heavy": (9000.0, 16.0, 0.1),
    "isoviscous": (300.0, 0.0, 0.9),
    "corner": (27000.0, 2.0, 0.1),
}


def atlas(bench: Bench) -> None:
    """Answers and elements of the shipped atlas."""
    from dataclasses import replace

    from ehlcontact import MoesPoint
    from reduced_models import Atlas

    def answer(point: Any) -> Figures:
        found, figures = Atlas().at(point), {}
        for name, value in ((name, getattr(found, name)) for name in found.__dataclass_fields__):
            for part, entry in value.items() if name == "error" else [("", value)]:
                if isinstance(entry, float | np.ndarray):
                    kind = "error bar of" if name == "error" else name
                    figures[f"{kind} {part}".strip()] = np.asarray(entry, float).ravel().tolist()
        return figures

    def element(point: Any, model: str) -> Figures:
        found = Atlas().element(point, model, **_at(model))
        u = np.linspace(found.low, found.high, 9)
        return {
            "spring": np.asarray(found.spring(u)),
            "ends": [found.low, found.high],
            "tangent": found.spring_tangent(0.5 * (found.low + found.high)),
        }

    for name, numbers in ATLAS_POINTS.items():
        point = MoesPoint(*numbers)
        bench.case(name, lambda p=point: answer(p))
        for model in ("wide", "memory", "cubic"):
            bench.case(f"{model} {name}", lambda p=point, m=model: element(p, m))
    for name, oil in {
        "thinner oil": {"eta0": 0.01},
        "other alpha": {"alpha": 1.5e-8},
        "water": {"eta0": 0.0015},
    }.items():
        bench.case(name, lambda o=oil: answer(replace(MoesPoint(*ATLAS_POINTS["paper"]), **o)))


def _shipped_table() -> Any:
    from reduced_models import Atlas

    return next(part for part in vars(Atlas()).values() if hasattr(part, "h_central"))


def atlas_surface(bench: Bench) -> None:
    """The shipped table interpolated anew: what each point is answered when it is left out."""
    table = _shipped_table()
    films, to_smooth, from_smooth, judge = home("films"), home("to_smooth"), home("from_smooth"), home("judge")

    def figures() -> Figures:
        by, film = table.interpolation, films(table.points)
        smooth = to_smooth(film, table.answers, by)
        errors, factor = judge(table.points, table.answers, by)
        truth, _ = from_smooth(film, smooth, by)
        found, _ = from_smooth(film, smooth + errors, by)
        off = np.abs(found - truth) / np.maximum(np.abs(truth), 1e-12)
        k = (smooth.shape[1] - 5) // 2
        off[:, 5 + k :] = np.abs(found - truth)[:, 5 + k :] / truth[:, [3]]
        columns = {"film": off[:, 1], "h_min": off[:, 2], "K": off[:, 5 : 5 + k], "C": off[:, 5 + k :]}
        parts = {f"left-out error of {name}, median": float(np.median(part)) for name, part in columns.items()}
        parts |= {
            f"left-out error of {name}, 95 %": float(np.quantile(part, 0.95)) for name, part in columns.items()
        }
        return parts | {"error bar over local error": float(np.median(factor))}

    bench.case("table", figures)


def atlas_samples(bench: Bench) -> None:
    """Which points a build would solve, and on which meshes."""
    from collections import Counter

    from ehlcontact import InputError, Purpose, mesh_for

    sample, build = home("sample_points"), home("build_atlas")
    draws = [default for default in build.__defaults__ if isinstance(default, int)]
    seed = (build.__kwdefaults__ or {}).get("seed", 4)

    def intervals(point: Any) -> int:
        try:
            return mesh_for(point, Purpose.TABLE).n
        except InputError:  # too thin a film
            return 0

    def samples() -> Figures:
        points = sample(*draws, seed)
        numbers = np.array([[p.M, p.L, p.kappa, p.p_hertz] for p in points.values()])
        meshes = Counter(intervals(p) for p in points.values())
        found: Figures = {
            "points": len(points),
            "median M": float(np.median(numbers[:, 0])),
            "median L": float(np.median(numbers[:, 1])),
            "largest pressure": float(numbers[:, 3].max()),
            "mean intervals": float(np.mean([n for n in meshes.elements() if n])),
        }
        return found | {f"points on {n} intervals": count for n, count in sorted(meshes.items())}

    bench.case("samples", samples)


def atlas_build(bench: Bench) -> None:
    """What some points of a build take."""
    from ehlcontact import MoesPoint

    solve_point = home("solve_point")

    def solved(point: Any) -> Figures:
        entry = solve_point(point)
        film = entry.get("film") or {}
        return {
            "status": entry["status"],
            "n": entry.get("n", 0),
            "frequencies": len(entry.get("stiffness", ())),
            "K": entry.get("stiffness", [0.0])[:1] + entry.get("stiffness", [0.0])[-1:],
            "C": entry.get("damping", [0.0])[1:2] + entry.get("damping", [0.0])[-1:],
            "h_min": film.get("h_min", entry.get("h_min", 0.0)),
            "n of the film": film.get("n", 0),
            "both domains": "close" in entry,
        }

    for name, point in {"light": (4.6, 3.0, 0.9), "thin": (900.0, 8.0, 0.6)}.items():
        bench.case(name, lambda p=point: solved(MoesPoint(*p)))


def atlas_gains(bench: Bench) -> None:
    """Film memories of all points of the shipped table, fitted anew."""
    table = _shipped_table()
    smooth_gains, rates = home("smooth_gains"), sys.modules[home("smooth_gains").__module__].RATES

    def figures() -> Figures:
        some = slice(None, None, 8)
        K, C = table.stiffness[some], table.damping[some]
        made = np.array([smooth_gains(table.omega, k, c) for k, c in zip(K, C, strict=True)]) * C[:, [1]]
        basis = rates.basis(table.omega) * 1.5
        off = np.abs(made @ basis.real.T / C - 1.0)[:, table.omega <= 32.0]
        stiff = np.abs((K[:, [0]] - table.omega * (made @ basis.imag.T)) / K - 1.0)[:, table.omega <= 32.0]
        rough = np.abs(np.diff(made, axis=0)).mean() / made.mean()
        return {
            "C error, median": float(np.median(off)),
            "C error, 95 %": float(np.quantile(off, 0.95)),
            "K error, 95 %": float(np.quantile(stiff, 0.95)),
            "roughness of gains": float(rough),
        }

    bench.case("gains", figures)


# ---------------------------------------------------------------------------------------------- what runs on them


def rotor(bench: Bench) -> None:
    """Rotors and oscillators on elements and on the full film."""
    from ehlcontact import FullContact, Lubricant, OperatingPoint
    from reduced_models import Atlas, JeffcottRotor, ScaledContact, simulate_oscillator, simulate_rotor

    bearing = OperatingPoint.ball_bearing(
        Lubricant(0.0367, 2.0e-8),
        ball_diameter=7.94e-3,
        pitch_diameter=39.04e-3,
        conformity=0.52,
        speed_rpm=3000.0,
        load=300.0,
    )
    body = {"disc_mass": 3.0, "journal_mass": 0.2, "shaft_stiffness": 2e6, "unbalance": 2e-5, "speed_rpm": 3000.0}
    upright = JeffcottRotor.vertical(load=(0.0, -268.0), **body)
    vee = JeffcottRotor.vee(half_angle=0.35, bearings=1, load=(0.0, -500.0), **body)
    table = Atlas()

    def figures(run: Any) -> Figures:
        found: Figures = {"status": str(run.status), "steps": int(run.t.size - 1)}
        for name in ("disc", "journal", "approach", "force"):
            found[name] = np.ravel(getattr(run, name)[:: max(1, run.t.size // 20)])
        iterations = getattr(run, "iterations", None)
        return found if iterations is None else found | {"iterations": int(np.sum(iterations))}

    def on(rotor: Any, model: str, count: int, **options: Any) -> Figures:
        contacts = [table.element(bearing, model, **_at(model)) for _ in range(count)]
        return figures(simulate_rotor(rotor, contacts, dt=2e-4, until=0.02, **options))

    for model in ("wide", "memory", "cubic"):
        bench.case(f"upright, {model}", lambda m=model: on(upright, m, 1), 2)
        bench.case(f"vee, {model}", lambda m=model: on(vee, m, 2), 2)

    def full() -> Figures:
        film = FullContact(bearing, n=64)
        start = upright.state_at([film.static_approach * bearing.scales.length])
        contact = ScaledContact(film, bearing.scales)
        run = simulate_rotor(upright, [contact], dt=2e-4, until=0.004, start=start, tolerance=1e-4)
        return figures(run)

    bench.case("upright, full film", full)

    def equilibrium(load: float) -> Figures:
        heavy = JeffcottRotor.vee(half_angle=0.35, bearings=1, load=(0.0, -load), **body)
        contacts = [table.element(bearing, "wide") for _ in range(2)]
        return figures(simulate_rotor(heavy, contacts, dt=2e-4, until=4e-4))

    for load in (5.0, 500.0, 5000.0):
        bench.case(f"vee at rest, {load:g} N", lambda w=load: equilibrium(w))

    def lifted() -> Figures:
        free = JeffcottRotor.vertical(load=(0.0, 268.0), **body)
        return figures(simulate_rotor(free, [table.element(bearing, "wide")], dt=2e-4, until=4e-4))

    bench.case("pulled off", lifted)

    def swing() -> Figures:
        found = simulate_oscillator(
            table.element(_point("paper"), "wide"), np.linspace(0.0, 1.0, 21), Omega_n=5.13, load=1.05, u0=0.87
        )
        return {"approach": found.approach, "force": found.force}

    bench.case("oscillator", swing)


def bearing(bench: Bench) -> None:
    """Ball bearings at rest, vibrating, and moved."""
    from ehlcontact import Lubricant
    from reduced_models import BallBearing, BearingMotion, BearingMount, MatrixRotor, SpeedCourse, Unbalance
    from reduced_models import simulate_on_bearings as simulate

    oil = Lubricant.iso_vg(68, temperature=50.0)
    films = {
        "film": BallBearing.catalogue("6205", oil=oil),
        "play": BallBearing.catalogue("6205", oil=oil, clearance=2e-5, film_limit=5e-6),
        "preload": BallBearing.catalogue("6010", oil=oil, clearance=-1e-5),
    }

    def at_rest(made: Any, rpm: float, angle: float | None) -> Figures:
        state = made.equilibrium((300.0, -1000.0), speed_rpm=rpm, cage_angle=angle)
        found: Figures = {"displacement": state.displacement, "force": np.ravel(state.force)}
        return found | {"stiffness": np.ravel(state.stiffness)}

    def vibrating(made: Any) -> Figures:
        found = made.coefficients((0.0, -1000.0), speed_rpm=3000.0, hz=[10.0, 5000.0])
        return {"stiffness": np.ravel(found.stiffness), "damping": np.ravel(found.damping), "swing": found.swing}

    def moved(made: Any, speeds: list[float], dt: float) -> Figures:
        run = BearingMotion(made.kernel(speeds), 3000.0, dt)
        run.rest((1e-6, -1.2e-5))
        w, t = 2e3, dt * np.arange(1, round(4e-3 / dt) + 1)
        q = np.column_stack([1e-6 + 2e-6 * np.sin(w * t) ** 2, -1.2e-5 + 4e-6 * np.sin(0.7 * w * t) ** 2])
        v = np.column_stack([2e-6 * w * np.sin(2.0 * w * t), 2.8e-6 * w * np.sin(1.4 * w * t)])
        force, balls = run.drive(q, v)
        return {"force": np.ravel(force[:: len(t) // 20]), "balls": np.ravel(balls[:: len(t) // 5])}

    for name, made in films.items():
        for rpm in (500.0, 3000.0, 7000.0):
            bench.case(f"{name} at rest, {rpm:g}", lambda b=made, n=rpm: at_rest(b, n, None))
        bench.case(f"{name} turned", lambda b=made: at_rest(b, 3000.0, 1.0), 2)
        bench.case(f"{name} vibrating", lambda b=made: vibrating(b), 2)
        for dt in (1e-6, 2e-5):
            bench.case(f"{name} moved, {dt:g}", lambda b=made, h=dt: moved(b, [3000.0], h), 2)

    def turning(speeds: list[float], until: float) -> Figures:
        """A disc that tilts, on one bearing."""
        G, K = np.zeros((4, 4)), np.zeros((4, 4))
        G[2, 3], G[3, 2] = 0.02, -0.02
        K[2, 2] = K[3, 3] = 2e4
        K[0, 3] = K[3, 0] = 1e4
        K[0, 0] = 1e5
        rotor = MatrixRotor(
            mass=np.diag([3.0, 3.0, 0.01, 0.01]),
            stiffness=K,
            gyroscopic=G,
            load=np.array([0.0, -500.0, 0.0, 0.0]),
            mounts=(BearingMount(bearing=films["film"], x=0, y=1),),
            unbalances=(Unbalance(x=0, y=1, amount=2e-4),),
        )
        course = SpeedCourse(np.array([0.0, until]), np.array(speeds))
        run = simulate(rotor, speed_rpm=course, dt=2e-5, until=until)
        found: Figures = {"status": str(run.status), "iterations": int(run.iterations.sum())}
        return found | {"tilt": run.displacement[::50, 2], "force": np.ravel(run.force[::50])}

    bench.case("steady rotor", lambda: turning([3000.0, 3000.0], 0.04), 2)
    bench.case("run-up", lambda: turning([2000.0, 8000.0], 0.1), 2)
    bench.case("between speeds", lambda: moved(films["film"], [2500.0, 3500.0], 2e-5), 2)
    dry = BallBearing.catalogue("6205", clearance=2e-5)
    bench.case("dry", lambda: at_rest(dry, 0.0, None), 2)
    bench.case("dry, spinning", lambda: at_rest(dry, 9000.0, None), 2)


def study(bench: Bench) -> None:
    """The small study of the examples."""
    from ehlcontact.cli.app import execute

    def figures() -> Figures:
        with tempfile.TemporaryDirectory() as folder:
            code = execute(["run", "examples/small_study.toml", "--output", folder, "--jobs", "1"])
            pages = list(Path(folder).rglob("results.json"))
            found = json.loads(pages[0].read_text()) if pages else {}
        return {"status": f"exit code {code}"} | dict(_leaves("", found))

    bench.case("small study", figures)


def _leaves(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict):
        for key, entry in value.items():
            if not any(word in key for word in ("second", "version", "time", "platform", "started")):
                yield from _leaves(f"{name} {key}".strip(), entry)
    elif isinstance(value, list | tuple):
        for i, entry in enumerate(value):
            yield from _leaves(f"{name} {i}", entry)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield name, value


def exported(bench: Bench) -> None:
    """An FMU of a cubic element, verified."""
    from fmu.export import export_contact
    from fmu.verify import verify
    from reduced_models import CubicContact

    cubic = CubicContact(6.24e7, 7.5e12, -1.74e17, 1300.0, low=7.5e-6, high=1e-5, rate=0.006, units="SI")

    def figures() -> Figures:
        with tempfile.TemporaryDirectory() as folder:
            path = export_contact(cubic, Path(folder) / "contact.fmu")
            path = path if path is not None else Path(folder) / "contact.fmu"
            found = verify(path, cubic)
        return {"status": "passes" if found.passes else "fails", "force": found.force, "tangents": found.tangents}

    bench.case("cubic", figures)


def warm_up() -> None:
    """Load, or compile, what most probes need, so that it is not in the time of the first."""
    from ehlcontact import FreeVibration, MoesPoint, simulate, solve_steady

    solve_steady(MoesPoint(200.0, 10.0, 0.5), n=32, throw=False)
    simulate(MoesPoint(200.0, 10.0, 0.5), FreeVibration(Omega_n=5.13), n=32, until=0.1, throw=False)


PROBES: dict[str, Callable[[Bench], None]] = {
    function.__name__: function
    for function in (
        steady,
        accuracy,
        fallbacks,
        near_domain,
        thin_sides,
        newton,
        impedances,
        transient,
        surfaces,
        full_contact,
        wave,
        lowest,
        deflections,
        fits,
        memory_fits,
        wide,
        elements,
        gains,
        atlas,
        atlas_surface,
        atlas_samples,
        atlas_build,
        atlas_gains,
        rotor,
        bearing,
        study,
        exported,
    )
}


def main() -> None:
    """Run the probes named and write their figures."""
    out, *names = sys.argv[1:]
    warnings.simplefilter("ignore")
    count_work()
    with suppress(Exception):
        warm_up()
    bench = Bench()
    for name in names or PROBES:
        bench.probe = name
        start = time.process_time()
        try:
            PROBES[name](bench)
        except Exception as error:
            text = " ".join(str(error).split())
            bench.figures[f"{name}/all/fails"] = f"{type(error).__name__}: {text[:110]}"
        print(f"{name}: {time.process_time() - start:.1f} s", flush=True)
    Path(out).write_text(json.dumps(bench.figures))


if __name__ == "__main__":
    main()
