"""One film-memory element against full EHL: free vibration, harmonic load, chirp and load step at one point.

Run ``python examples/studies/one_element_for_all.py [--n 64] [--out DIR]``: prints the table of force errors
beside those of viscous cubics and writes ``one_element_for_all.png`` and ``memory_element.json``. About a minute
with n = 64, four with n = 128.
"""

from __future__ import annotations

import argparse
from math import pi
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact import (
    Domain,
    FreeVibration,
    Grid,
    HarmonicLoad,
    MoesPoint,
    PrescribedLoad,
    impedance,
    save,
    simulate,
)
from ehlcontact.results import Response
from reduced_models import ContactRecord, fit_memory
from reduced_models.fitting.least_squares import linear_fit
from reduced_models.fitting.result import MemoryFit

POINT = MoesPoint(200.0, 10.0, 0.5)
DOMAIN = Domain()  # one region for all: damping depends on it
OMEGAS = np.concatenate([[0.0], np.geomspace(0.02, 100.0, 40)])
NAMES = {pi / 4: "pi/4", pi: "pi", 2 * pi: "2 pi", 4 * pi: "4 pi"}


def chirp(until: float = 24.0, low: float = 0.2, high: float = 4.0 * pi) -> PrescribedLoad:
    """Load that vibrates by 10 % while its frequency rises exponentially."""
    T = np.linspace(0.0, until, 2401)
    ratio = np.log(high / low) / until
    return PrescribedLoad(T, 1.0 + 0.1 * np.sin(low * np.expm1(ratio * T) / ratio))


def load_step(until: float = 6.0) -> PrescribedLoad:
    """Load that rises smoothly from 1 to 1.3 within 0.3, a sixth of the time in which the film crosses."""
    T = np.linspace(0.0, until, 601)
    s = np.clip((T - 0.5) / 0.3, 0.0, 1.0)
    return PrescribedLoad(T, 1.0 + 0.3 * s * s * (3.0 - 2.0 * s))


def fitted_motions() -> dict[str, Any]:
    """Motions that the element is fitted to."""
    free = {f"free, Omega_n {w}": FreeVibration(Omega_n=w) for w in (2.56, 5.13, 10.26)}
    omegas = (0.05, 0.3, pi / 4, pi, 2 * pi, 4 * pi)
    return free | {f"harmonic, {NAMES.get(w, w)}": HarmonicLoad(Omega=w) for w in omegas}


def record(motion: Any, n: int) -> ContactRecord:
    """Record of a full simulation."""
    return ContactRecord.from_result(simulate(POINT, motion, grid=Grid(n=n, domain=DOMAIN)))


def relative_error(force: np.ndarray, of: ContactRecord) -> float:
    """RMS error of the force over its standard deviation, whole record."""
    return float(np.sqrt(np.mean((force - of.force) ** 2)) / np.std(of.force))


class Cubic:
    """Least-squares K1 u + K2 u^2 + K3 u^3 + C1 u' of whole records, taken even where C1 < 0 makes no element."""

    def __init__(self, *records: ContactRecord) -> None:
        u, v, f = (np.concatenate([getattr(r, key) for r in records]) for key in ("approach", "rate", "force"))
        columns = {"K1": u, "K2": u**2, "K3": u**3, "C1": v}
        self.coefficients = linear_fit(columns, f).values

    def force(self, r: ContactRecord) -> np.ndarray:
        """Force along a record."""
        u = r.approach
        return np.column_stack([u, u**2, u**3, r.rate]) @ self.coefficients

    def tangent(self, u: float) -> float:
        """Slope of the spring."""
        K1, K2, K3, _ = self.coefficients
        return float(K1 + 2.0 * K2 * u + 3.0 * K3 * u * u)

    @property
    def damping(self) -> float:
        """C1."""
        return float(self.coefficients[3])


def table(result: MemoryFit, seen: dict[str, ContactRecord], unseen: dict[str, ContactRecord]) -> list[tuple]:
    """Rows (name, memory, own cubic, one cubic) of relative errors."""
    one = Cubic(*seen.values())
    rows = []
    for name, r in (seen | unseen).items():
        memory = result.element.drive(r.t, r.approach, r.rate)
        errors = (memory, Cubic(r).force(r), one.force(r))
        rows.append((name, *(relative_error(force, r) for force in errors)))
    return rows


def picture(path: Path, Z: Response, result: MemoryFit, seen: dict[str, ContactRecord]) -> None:
    """Stiffness and damping over frequency, and force-approach loops of the harmonic records."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    w = np.geomspace(0.02, 100.0, 400)
    element = result.element.impedance(Omega=w)
    figure, axes = plt.subplots(2, 3, figsize=(12.5, 7.0), layout="constrained")
    full = {"color": "black", "marker": "o", "markersize": 3.0, "linestyle": "none", "label": "full EHL"}
    for ax, ours, theirs, label in (
        (axes[0, 0], Z.stiffness, element.stiffness, "stiffness K"),
        (axes[0, 1], Z.damping, element.damping, "damping C"),
    ):
        ax.semilogx(Z.omega[1:], ours[1:], **full)
        ax.semilogx(w, theirs, color="tab:blue", label="film memory, one element")
        ax.set(xlabel="Omega", ylabel=label, xlim=(0.02, 100.0))
    for i, r in enumerate(r for name, r in seen.items() if name.startswith("harmonic")):
        own = Cubic(r)
        for ax, value in ((axes[0, 0], own.tangent(Z.film.approach)), (axes[0, 1], own.damping)):
            ax.plot(r.motion["Omega"], value, "x", color="tab:red", label=None if i else "own viscous cubics")
    axes[0, 1].set_yscale("log")
    axes[0, 0].legend()
    loops = ("harmonic, 0.05", "harmonic, pi/4", "harmonic, pi", "harmonic, 4 pi")
    one = Cubic(*seen.values())
    for ax, name in zip((axes[0, 2], *axes[1]), loops, strict=True):
        r = seen[name]
        period = 2.0 * pi / r.motion["Omega"]  # type: ignore[index]
        last = r.t >= r.t[-1] - period - 1e-9
        memory = result.element.drive(r.t, r.approach, r.rate)
        line = Z.stiffness[0] * (r.approach - Z.film.approach) + 1.0  # what all loops have in common
        for force, style in (
            (r.force, {"color": "black", "linewidth": 3.0, "label": "full EHL"}),
            (memory, {"color": "tab:blue", "label": "film memory"}),
            (one.force(r), {"color": "tab:red", "linestyle": "--", "label": "one cubic for all"}),
        ):
            ax.plot(r.approach[last], (force - line)[last], **style)
        ax.set(title=name, xlabel="approach u", ylabel="force - static tangent")
    axes[0, 2].legend()
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main() -> None:
    """Simulate, fit, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--n", type=int, default=64, help="intervals along X")
    parser.add_argument("--out", type=Path, default=Path())
    arguments = parser.parse_args()
    n = arguments.n
    Z = impedance(POINT, Omega=OMEGAS, grid=Grid(n=n, domain=DOMAIN))
    seen = {name: record(motion, n) for name, motion in fitted_motions().items()}
    unseen = {"chirp (not fitted)": record(chirp(), n), "load step (not fitted)": record(load_step(), n)}
    result = fit_memory(Z, list(seen.values()))
    print(f"M = 200, L = 10, kappa = 0.5, n = {n}: force error / spread [%]")
    print(f"{'':24} {'memory':>8} {'own cubic':>10} {'one cubic':>10}")
    for name, *errors in table(result, seen, unseen):
        print(f"{name:24} {100 * errors[0]:8.2f} {100 * errors[1]:10.2f} {100 * errors[2]:10.2f}")
    band = Z.omega <= 30.5
    print(f"{result.element.lags} lags; cross-validation {result.validation}")
    print(f"C within {100 * np.abs(result.damping_error[band]).max():.1f} %, ", end="")
    print(f"K within {100 * np.abs(result.stiffness_error[band]).max():.2f} % for Omega up to 30")
    C = np.interp(0.05, Z.omega, Z.damping)
    cubic = Cubic(*seen.values()).damping
    ours = float(result.element.impedance(Omega=0.05).damping[0])
    print(f"C(0.05): full {C:.4f}, film memory {ours:.4f}, one viscous cubic {cubic:.4f}")
    arguments.out.mkdir(parents=True, exist_ok=True)
    save(result.element, arguments.out / "memory_element.json")
    picture(arguments.out / "one_element_for_all.png", Z, result, seen)


if __name__ == "__main__":
    main()
