"""The rotor on whole bearings looked at a second time: stored runs with numpy, and two masses on an impedance.

Both bearings are alike and the disc stands in the middle: its slowest vibrations are those of disc and journals.
"""

import tomllib
from functools import cached_property

import numpy as np
from scipy import optimize

NAMES = {
    "memory": "film memory under every ball",
    "dry": "dry Hertz contacts",
    "constant": "constant K and C, of the film at the speed",
    "usual": "constant K, dry, and C = 1.25e-05 s K",
}
WAYS = {"horizontal": 0, "vertical": 1}


class RecomputedWhole:
    """Numbers of the study in `file` on whole bearings, from what its run has left in `folder`."""

    def __init__(self, file, folder):
        from reduced_models import BallBearing, BearingRun

        self.study = tomllib.loads(file.read_text())
        b, o = self.study["bearing"], self.study["oil"]
        self.asked = {"revolutions": 30, "steps_per_revolution": 500, "clearance_um": 0.0} | self.study[
            "whole_bearing"
        ]
        shape = {
            "balls": b["balls"],
            "ball_diameter": 1e-3 * b["ball_diameter_mm"],
            "pitch_diameter": 1e-3 * b["pitch_diameter_mm"],
            "conformity_inner": b["conformity"],
            "conformity_outer": self.asked.get("conformity_other", b["conformity"]),
            "clearance": 1e-6 * self.asked["clearance_um"],
        }
        from ehlcontact import Lubricant

        self.wet = BallBearing(**shape, oil=Lubricant(o["eta0"], o["alpha"]))
        self.dry = BallBearing(**shape)
        self.rpm, self.load = b["speed_rpm"], (0.0, -b["radial_load"])
        self.hz = self.rpm / 60.0
        self.runs = {name: BearingRun.read(folder / f"on_bearings_{name}.h5") for name in ("memory", "dry")}

    @property
    def passage(self):
        """Hertz: balls times half of the shaft, less what they roll."""
        b = self.study["bearing"]
        return 0.5 * b["balls"] * self.hz * (1.0 - b["ball_diameter_mm"] / b["pitch_diameter_mm"])

    @cached_property
    def state(self):
        return self.wet.equilibrium(self.load, speed_rpm=self.rpm)

    @property
    def dry_deflection(self):
        return -self.dry.equilibrium(self.load, speed_rpm=self.rpm).displacement[1]

    @cached_property
    def constants(self):
        """Diagonals of K and C."""
        film, dry = (one.coefficients(self.load, speed_rpm=self.rpm, rpm=self.rpm) for one in (self.wet, self.dry))
        k, c, own = (np.diag(m[0]) for m in (film.stiffness, film.damping, dry.stiffness))
        return {"constant": (k, c), "usual": (own, 1.25e-5 * own)}

    def impedance(self, name, k, s):
        """Of one bearing along direction k at complex s near the imaginary axis: to first order off it."""
        if name in self.constants:
            K, C = self.constants[name]
            return K[k] + s * C[k]
        held = {"memory": self.wet, "dry": self.dry}[name]
        w = s.imag * np.array([1.0, 1.0 - 1e-4, 1.0 + 1e-4])
        found = held.coefficients(self.load, speed_rpm=self.rpm, omega=w)
        Z = found.stiffness[:, k, k] + 1j * w * found.damping[:, k, k]
        return Z[0] + s.real * (Z[2] - Z[1]) / (1j * (w[2] - w[1]))

    def matrix(self, name, k, s):
        """Dynamic stiffness of disc and journals."""
        r = self.study["rotor"]
        shaft = r["shaft_stiffness"] + s * r["shaft_damping"]
        disc = s * s * r["disc_mass"] + s * r["disc_damping"]
        journals = s * s * r["journal_mass"] + 2.0 * self.impedance(name, k, s)
        return np.array([[disc + shaft, -shaft], [-shaft, journals + shaft]])

    def mode(self, name, way):
        """Frequency and decrement of the slowest vibration along a direction."""
        k, r = WAYS[way], self.study["rotor"]
        held = 2.0 * self.impedance(name, k, 2j * np.pi * self.hz).real
        K = np.array([[1.0, -1.0], [-1.0, 1.0]]) * r["shaft_stiffness"] + np.diag([0.0, held])
        w = np.sqrt(np.linalg.eigvals(K / np.array([[r["disc_mass"]], [r["journal_mass"]]])).min())
        scale = abs(np.linalg.det(K))

        def left(x):
            value = np.linalg.det(self.matrix(name, k, w * complex(x[0], x[1]))) / scale
            return [value.real, value.imag]

        x = optimize.fsolve(left, [-0.01, 1.0], xtol=1e-9)
        return w * x[1] / (2.0 * np.pi), -2.0 * np.pi * x[0] / x[1]

    def highest(self, name, way):
        """Frequency and height of the response to unbalance over the eccentricity."""
        k, near = WAYS[way], self.mode(name, way)
        m = self.study["rotor"]["disc_mass"]

        def less(hz):
            w = 2.0 * np.pi * hz
            return -abs(np.linalg.solve(self.matrix(name, k, 1j * w), [m * w * w, 0.0])[0])

        width = near[0] * max(near[1], 1e-3)
        top = optimize.minimize_scalar(less, bounds=(near[0] - width, near[0] + width), method="bounded")
        return top.x, -top.fun

    def shown(self, name):
        """Times, ring and disc of the second half of the turns; constant springs from their own response."""
        dt = 1.0 / self.hz / self.asked["steps_per_revolution"]
        first = self.asked["revolutions"] // 2 * self.asked["steps_per_revolution"]
        if name in self.runs:
            run = self.runs[name]
            return run.t[first:], run.ring[first:, 0], run.displacement[first:, 2:4]
        t = dt * np.arange(first, self.asked["revolutions"] * self.asked["steps_per_revolution"] + 1)
        w, r = 2.0 * np.pi * self.hz, self.study["rotor"]
        force = np.array([1.0, -1j]) * r["unbalance"] * w * w
        both = [np.linalg.solve(self.matrix(name, k, 1j * w), [force[k], 0.0]) for k in (0, 1)]
        disc, ring = (np.real(np.exp(1j * w * t)[:, None] * [one[i] for one in both]) for i in (0, 1))
        return t, ring, disc

    def row(self, name):
        """Numbers of the table, SI."""
        t, ring, disc = self.shown(name)
        lines = np.array([self.hz, 2.0 * self.hz, self.passage, 2.0 * self.passage])
        waves = np.exp(2j * np.pi * t[:, None] * lines)
        found = np.linalg.lstsq(np.hstack([np.ones((t.size, 1)), waves.real, waves.imag]), disc[:, 1], rcond=None)[
            0
        ]
        size = np.abs(found[1:5] - 1j * found[5:])
        moving = name in self.runs
        return {
            "ring": np.ptp(ring, axis=0),
            "disc": np.ptp(disc, axis=0),
            "once": size[0],
            "passing": size[2] if moving else None,
            "load": self.runs[name].largest_load.max() if moving else None,
            "vertical": self.mode(name, "vertical"),
            "horizontal": self.mode(name, "horizontal"),
        }
