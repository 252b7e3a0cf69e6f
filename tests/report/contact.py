"""A study computed a second time: its numbers from the study file and the stored histories, with numpy alone.

Nothing here knows the library but the film-memory element, which is driven by its own code.
"""

import json
import tomllib
from functools import cached_property
from types import SimpleNamespace

import h5py
import numpy as np
from scipy import stats

RECORDS = ("free", "harmonic", "rotor_band")
POWERS = {"K1": (1, 0), "K2": (2, 0), "K3": (3, 0), "C1": (0, 1)}  # of approach and rate
MODELS = {"cubic": ("K1", "K2", "K3", "C1"), "linear": ("K1", "C1")}


def elliptic(kappa):
    """Complete elliptic integrals K and E of the parameter 1 - kappa^2, by the arithmetic-geometric mean."""
    a, g, c, total, power = 1.0, kappa, np.sqrt(max(1.0 - kappa * kappa, 0.0)), 0.0, 0.5
    for _ in range(40):
        total += power * c * c
        a, g, c, power = 0.5 * (a + g), np.sqrt(a * g), 0.5 * (a - g), 2.0 * power
    K = np.pi / (2.0 * a)
    return K, K * (1.0 - total)


def shape(kappa):
    """Share S of the gap that opens along rolling."""
    K, E = elliptic(kappa)
    return (E - kappa**2 * K) / ((1.0 - kappa**2) * K)


def ratio_of_axes(rx, ry):
    """kappa < 1 by bisection: Rx/Ry = kappa^2 (1 - S)/S."""
    low, high = 1e-3, 1.0 - 1e-9
    for _ in range(200):
        kappa = 0.5 * (low + high)
        S = shape(kappa)
        low, high = (kappa, high) if kappa**2 * (1.0 - S) / S < rx / ry else (low, kappa)
    return kappa


def read(path):
    """Arrays and attributes of an HDF5 file of the library."""
    with h5py.File(path) as file:
        values = {name: file[name][...] for name in file}
        for name, text in file.attrs.items():
            text = text.decode() if isinstance(text, bytes) else str(text)
            try:
                values[name] = json.loads(text)
            except ValueError:
                values[name] = text
    return SimpleNamespace(**values)


class Recomputed:
    """Numbers of the study in `file`, from what its run has left in `folder`."""

    def __init__(self, file, folder):
        self.study = tomllib.loads(file.read_text())
        self.folder = folder
        self.steady = read(folder / "steady.h5")
        self.records = {name: read(folder / f"{name}.h5") for name in RECORDS}

    @cached_property
    def point(self):
        """Operating point and Hertz contact."""
        b, oil = self.study["bearing"], self.study["oil"]
        balls, D, dm = b["balls"], b["ball_diameter_mm"] * 1e-3, b["pitch_diameter_mm"] * 1e-3
        angles = 2.0 * np.pi * np.arange(balls) / balls
        load = b["radial_load"] / np.sum(np.maximum(np.cos(angles), 0.0) ** 2.5)
        rx = 1.0 / (2.0 / D + 2.0 / (dm - D))
        ry = 1.0 / (2.0 / D - 1.0 / (b["conformity"] * D))
        modulus = 2.06e11 / (1.0 - 0.3**2)
        kappa = ratio_of_axes(rx, ry)
        K, E = elliptic(kappa)
        R = 1.0 / (1.0 / rx + 1.0 / ry)
        a = np.cbrt(6.0 * kappa * E * load * R / (np.pi * modulus))
        omega = 2.0 * np.pi * b["speed_rpm"] / 60.0
        u_sum = omega * dm * (1.0 - (D / dm) ** 2) / 2.0
        U = oil["eta0"] * u_sum / (modulus * rx)
        length, time = a * a * K / (2.0 * R * E), 2.0 * a / u_sum
        return SimpleNamespace(
            load=load,
            radial_load=b["radial_load"],
            speed_rpm=b["speed_rpm"],
            u_sum=u_sum,
            eta0=oil["eta0"],
            alpha=oil["alpha"],
            M=load / (modulus * rx**2) * U**-0.75,
            L=oil["alpha"] * modulus * U**0.25,
            kappa=kappa,
            p_hertz=1.5 * load * kappa / (np.pi * a * a),
            a=a,
            b=a / kappa,
            dry_approach=length,
            time_unit=time,
            approach=self.steady.approach,
            approach_m=self.steady.approach * length,
            h_central_um=self.steady.h_central * length * 1e6,
            h_min_um=self.steady.h_min * length * 1e6,
            approach_error=self.steady.error["approach"],
            h_central_error=self.steady.error["h_central"],
            h_min_error=self.steady.error["h_min"],
            rotor_omega=omega * time,
            rx=rx,
            modulus=modulus,
        )

    @property
    def units(self):
        """SI value of one dimensionless stiffness, damping, work, and of each coefficient."""
        p = self.point
        rate = p.dry_approach / p.time_unit
        factors = {name: p.load / p.dry_approach**n / rate**m for name, (n, m) in POWERS.items()}
        return SimpleNamespace(
            stiffness=p.load / p.dry_approach,
            damping=p.load * p.time_unit / p.dry_approach,
            work=p.load * p.dry_approach,
            of=factors,
        )

    def window(self, name):
        """Samples of a record that are fitted: the last two thirds, of harmonic ones whole periods of them."""
        run, motion = self.records[name], self.records[name].motion
        end = run.T[-1]
        if motion["kind"] != "harmonic":
            return run.T >= end / 3.0
        period = 2.0 * np.pi / motion["Omega"]
        return run.T >= end - max(1, int(end / period * 2.0 / 3.0 + 1e-9)) * period - 1e-9 * end

    def fit(self, name, model):
        """Least squares of the samples in the window; the intervals with Student's distribution."""
        run, inside, names = self.records[name], self.window(name), MODELS[model]
        u, v, f = run.approach[inside], run.rate[inside], run.force[inside]
        A = np.column_stack([u**n * v**m for n, m in (POWERS[key] for key in names)])
        scale = np.linalg.norm(A, axis=0)
        values = np.linalg.lstsq(A / scale, f, rcond=None)[0] / scale
        miss = f - A @ values
        rho = np.array([miss[k:] @ miss[: miss.size - k] for k in range(1, miss.size)]) / (miss @ miss)
        positive = rho[: np.argmax(rho <= 0.0)] if np.any(rho <= 0.0) else rho
        independent = max(1.0, f.size / (1.0 + 2.0 * positive.sum()))
        inverse = np.linalg.inv((A / scale).T @ (A / scale)) / np.outer(scale, scale)
        errors = np.sqrt(np.diag(inverse) * (miss @ miss) / (f.size - len(names)) * f.size / independent)
        widths = stats.t.ppf(0.975, max(1.0, independent - len(names))) * errors
        found = dict(zip(names, values.tolist(), strict=True))
        spring = [found.get("K3", 0.0), found.get("K2", 0.0), found["K1"], -1.0]
        roots = np.roots(np.trim_zeros(spring, "f"))
        real = roots.real[np.abs(roots.imag) < 1e-9]
        root = float(real[np.argmin(np.abs(real - np.mean(u)))])
        return SimpleNamespace(
            parameters=found,
            errors=dict(zip(names, errors.tolist(), strict=True)),
            intervals={key: (found[key] - w, found[key] + w) for key, w in zip(names, widths, strict=True)},
            independent=independent,
            rms=np.sqrt(np.mean(miss**2)) / np.std(f),
            e_f=miss.sum() / f.sum(),
            root=root,
            tangent=np.polyval(np.polyder(spring), root),
            low=u.min(),
            high=u.max(),
            load=(f.min(), f.max()),
            rate=np.abs(v).max(),
        )

    def force(self, name, model, u, v):
        """Force of the fitted polynomial."""
        found = self.fit(name, model).parameters
        return sum(value * u ** POWERS[key][0] * v ** POWERS[key][1] for key, value in found.items())

    @cached_property
    def work(self):
        """Work of the last cycle in the rotor's band [J], of the film and of the elements that were fitted."""
        run = self.records["rotor_band"]
        period = 2.0 * np.pi / run.motion["Omega"]
        last = run.T >= run.T[-1] - period * (1.0 + 1e-9)
        u, v = run.approach[last], run.rate[last]
        forces = {"full": run.force[last]}
        forces |= {name: self.force(name, "cubic", u, v) for name in ("harmonic", "rotor_band")}
        forces["memory"] = self.memory_force("rotor_band")[last]
        mean = {name: 0.5 * (f[1:] + f[:-1]) for name, f in forces.items()}
        return {name: float(f @ np.diff(u)) * self.units.work for name, f in mean.items()}

    @cached_property
    def _memory(self):
        from reduced_models import load_element

        return load_element(self.folder / "elements" / "memory.json")

    def memory_force(self, name):
        """Force of the film-memory element along a record."""
        run = self.records[name]
        return self._memory.drive(run.T, run.approach, run.rate)

    def memory_rms(self, name):
        """RMS error of that over the spread of the force."""
        force = self.records[name].force
        return np.sqrt(np.mean((self.memory_force(name) - force) ** 2)) / np.std(force)

    def memory_impedance(self, omega):
        """Stiffness and damping of the element's filters, as docs and files say what they are."""
        p = json.loads((self.folder / "elements" / "memory.json").read_text())["parameters"]
        s = 1j * np.maximum(np.asarray(omega), 1e-9)
        viscous, inlet, fast, *chain = p["gains"]
        made = 1.0 / (1.0 + s / p["inlet_rate"])
        G = viscous + inlet * made + fast / (1.0 + s / p["fast_rate"])
        G = G + made * sum(g / (1.0 + s / p["lag_rate"]) ** k for k, g in enumerate(chain, start=1))
        Z = 1.0 / (2.0 / 3.0 + p["exponent"] * p["film"]) + 1.5 * s * G
        return Z.real, Z.imag / s.imag
