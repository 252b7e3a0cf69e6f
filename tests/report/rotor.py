"""The rotor of a study looked at a second time: its stored runs, and its linear model, with numpy.

The runs on elements are no files: they are made anew from the stored elements, by the library, and only looked at.
"""

import dataclasses
from functools import cached_property
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import interpolate, optimize, stats

from report.contact import Recomputed, read

CONTACTS = {
    "full": "full film",
    "rotor_band": "cubic of the rotor's band",
    "memory": "film memory",
    "harmonic": "cubic of the contact's band",
    "undamped": "cubic without damper",
    "dry": "dry Hertz contact",
}
SAMPLED, PROJECTED = 2e-3, 0.03  # shares of a resonance, and of the width of an interval
LOST, SETTLED, MARGIN, OCTAVE = 0.01, 0.01, 0.05, 2.0  # as the page and the elements' warnings say


class RecomputedRotor:
    """Numbers of the rotor of the study in `file`, from what its run has left in `folder`."""

    def __init__(self, file, folder, results):
        from ehlcontact.cli.study.schema import load_study

        self.contact, self.folder, self.results = Recomputed(file, folder), folder, results
        self.library = load_study(file)
        self.rotor = self.library.rotor.model_dump()  # what a study leaves out has defaults
        names = ("rotor_full", "rotor_half_step", "decay", "decay_half_step")
        self.stored = {name: read(folder / f"{name}.h5") for name in names}

    @property
    def hz(self):
        """Frequency of the speed."""
        return self.contact.study["bearing"]["speed_rpm"] / 60.0

    @cached_property
    def elements(self):
        """SI elements by name, without the full film."""
        from reduced_models import PowerLawContact, load_element

        files = {"rotor_band": "rotor_band_cubic_si", "memory": "memory_si", "harmonic": "harmonic_cubic_si"}
        found = {name: load_element(self.folder / "elements" / f"{file}.json") for name, file in files.items()}
        p = self.contact.point
        stiff, ends = p.load / p.dry_approach**1.5, (1e-3 * p.dry_approach, 10.0 * p.dry_approach)
        dry = PowerLawContact(stiff, 1.5, 0.0, 0.0, 0.0, *ends, units="SI")
        return found | {"undamped": dataclasses.replace(found["rotor_band"], C1=0.0), "dry": dry}

    @cached_property
    def runs(self):
        """Runs under unbalance and after the kick by contact, and those with half the step: (whole, half)."""
        from ehlcontact.cli.study.kick import kicked_mode, run_decay_reduced
        from ehlcontact.cli.study.response import film_response
        from ehlcontact.cli.study.rotor import run_reduced

        study, response = self.library, film_response(self.library)
        mode = kicked_mode(study, response)
        turning = {name: run_reduced(study, one, 0) for name, one in self.elements.items()}
        decaying = {name: run_decay_reduced(study, one, mode, response, 0) for name, one in self.elements.items()}
        chosen = self.elements["rotor_band"]
        return SimpleNamespace(
            turning={"full": self.stored["rotor_full"], **turning},
            decaying={"full": self.stored["decay"], **decaying},
            turning_half={"full": self.stored["rotor_half_step"], "rotor_band": run_reduced(study, chosen, 1)},
            decaying_half={"full": self.stored["decay_half_step"]},
        )

    # ---- runs

    def changes(self, name):
        """Change of each revolution from the one before, over the spread, of the signal that changes most."""
        run = self.runs.turning[name]
        signals = np.hstack([run.disc, run.journal, run.force])
        steps = round(1.0 / self.hz / run.t[1])
        turns = [signals[1 + k * steps : 1 + (k + 1) * steps] for k in range((len(signals) - 1) // steps)]
        moving = turns[0].std(axis=0) > 1e-9 * np.abs(signals).max(axis=0)
        differ = ((now, np.sqrt(((now - before) ** 2).mean(axis=0))) for before, now in pairwise(turns))
        return [float((change[moving] / now.std(axis=0)[moving]).max()) for now, change in differ]

    @property
    def settled_from(self):
        """Revolution from which on the run on full films has settled, None if it ends otherwise."""
        small = [change <= SETTLED for change in self.changes("full")]
        return next((k for k in range(len(small)) if all(small[k:])), None)

    def differences(self, one, other, begin=0.0):
        """Displacement, the same about its mean, force, the same: rms over standard deviation, largest signal."""
        shared = (one.t >= begin - 1e-9) & (one.t <= other.t[-1] + 1e-9)
        t, found = one.t[shared], []
        for names in (("disc", "journal"), ("force",)):
            pairs = [
                (getattr(one, name)[shared, k], np.interp(t, other.t, getattr(other, name)[:, k]))
                for name in names
                for k in range(getattr(one, name).shape[1])
            ]
            moving = [(a, b) for a, b in pairs if np.ptp(a) > 2e-12 * np.abs(a).max()]
            found.append(max(np.sqrt(np.mean((b - a) ** 2)) / a.std() for a, b in moving))
            found.append(max((b - a).std() / a.std() for a, b in moving))
        return found

    def against_full(self, name):
        """Differences of a run from that on full films, where that has settled, else all of it."""
        begin = 0.0 if self.settled_from is None else self.settled_from / self.hz
        return self.differences(self.runs.turning["full"], self.runs.turning[name], begin)

    def decrement(self, run):
        """A decay fitted by one damped vibration and a mean, by all five numbers at once."""
        period = 2.0 * np.pi / self.mode("full").omega
        part = run.t >= period * (1.0 - 1e-9)
        t, y = run.t[part] - run.t[part][0], run.journal[part, 1] / run.journal[part, 1].std()

        def vibration(t, decrement, omega, cosine, sine, mean):
            envelope = np.exp(-decrement * omega * t / (2.0 * np.pi))
            return envelope * (cosine * np.cos(omega * t) + sine * np.sin(omega * t)) + mean

        start, exact = [0.02, 2.0 * np.pi / period, 1.0, 0.0, y.mean()], dict.fromkeys(("xtol", "ftol"), 1e-14)
        found, covariance = optimize.curve_fit(vibration, t, y, start, **exact)
        left = y - vibration(t, *found)
        r = max(float(left[1:] @ left[:-1] / (left @ left)), 0.0)
        fewer = (1.0 + r) / (1.0 - r)
        half = stats.t.ppf(0.975, (t.size - 5) / fewer) * np.sqrt(covariance[0, 0] * fewer)
        return SimpleNamespace(
            decrement=found[0],
            interval=(found[0] - half, found[0] + half),
            hz=found[1] / (2.0 * np.pi),
            misfit=np.sqrt(np.mean(left**2)),
            periods=t[-1] * found[1] / (2.0 * np.pi),
        )

    def interval(self, name):
        """Interval of a decrement in the results, which is of a projection: its width is held to ours."""
        low, high = self.results["rotor"]["decay"]["decrements"][name]["interval"]
        ours = self.decrement(self.runs.decaying[name]).interval
        assert high - low == pytest.approx(ours[1] - ours[0], rel=PROJECTED)
        return low, high

    def events(self, name, run):
        """Of each contact: loads, lift-offs, impacts, share lost; shares outside approach, rate, load, omega."""
        box = None if name == "full" else self.elements[name].validity.to_dict()
        found = []
        for u, v, f in zip(run.approach.T, run.rate.T, run.force.T, strict=True):
            lost = f < LOST * self.contact.point.load
            turns = np.diff(lost.astype(int))
            outside = [None] * 4 if box is None else self._outside(box, u, v, f)
            counts = [int((turns == 1).sum()), int((turns == -1).sum()), float(lost.mean())]
            found.append([float(f.min()), float(f.max()), *counts, *outside])
        return found

    @staticmethod
    def _outside(box, u, v, f):
        def share(values, low, high):
            slack = MARGIN * (high - low)
            return float(np.mean((values < low - slack) | (values > high + slack)))

        found = [share(u, box["low"], box["high"])]
        found.append(None if box["rate"] is None else share(np.abs(v), 0.0, box["rate"]))
        found.append(None if box["load"] is None else share(f, *box["load"]))
        if box["omega"] is None:
            return [*found, None]
        low, high = box["omega"]
        return [*found, float(not low / OCTAVE <= v.std() / u.std() <= high * OCTAVE)]

    def warned(self, name, run, k):
        """Numbers of what an element has to say about contact `k` of a run: what lies outside, and its bounds."""
        u, v, f = run.approach[:, k], run.rate[:, k], run.force[:, k]
        box, said = self.elements[name].validity.to_dict(), []

        def worst(values, low, high):
            least, most, slack = values.min(), values.max(), MARGIN * (high - low)
            if low - slack <= least and most <= high + slack:
                return []
            return [most if most - high > low - least else least, low, high]

        said += worst(u, box["low"], box["high"])
        if box["rate"] is not None and np.abs(v).max() > (1.0 + MARGIN) * box["rate"]:
            said += [np.abs(v).max(), box["rate"]]
        if box["load"] is not None:
            said += worst(f, *box["load"])
        if box["omega"] is not None and self._outside(box, u, v, f)[3]:
            said += [omega / (2.0 * np.pi) for omega in (v.std() / u.std(), *sorted(set(box["omega"])))]
        return said

    # ---- linear

    def impedance(self, name, omega):
        """Stiffness [N/m] and damping [N s/m] of one contact about rest at the angular frequency."""
        contact, p = self.contact, self.contact.point
        own = omega * p.time_unit
        if name == "dry":
            return 1.5 * p.load / p.dry_approach, 0.0
        if name in ("full", "memory"):
            data = self.results["memory"]["impedance"]
            if name == "memory":
                K, C = contact.memory_impedance([own])
            else:
                within = np.clip([own], data["Omega"][0], data["Omega"][-1])
                K, C = (
                    interpolate.PchipInterpolator(data["Omega"], data[part])(within)
                    for part in ("stiffness", "damping")
                )
            return float(K[0]) * contact.units.stiffness, float(C[0]) * contact.units.damping
        found = contact.fit("harmonic" if name == "harmonic" else "rotor_band", "cubic")
        damping = 0.0 if name == "undamped" else found.parameters["C1"] * contact.units.damping
        return found.tangent * contact.units.stiffness, damping

    @property
    def directions(self):
        """Those that move."""
        return "xy" if self.rotor["arrangement"] == "vee" else "y"

    @cached_property
    def matrices(self):
        """Mass, damping, stiffness, and directions of the contacts; of the disc, then of the journal."""
        r, one = self.rotor, np.eye(len(self.directions))
        couple = np.array([[1.0, -1.0], [-1.0, 1.0]])
        M = np.kron(np.diag([r["disc_mass"], r["journal_mass"]]), one)
        ground = np.diag([r["disc_damping"], 0.0])
        C = np.kron(r["shaft_damping"] * couple + ground, one)
        K = np.kron(r["shaft_stiffness"] * couple, one)
        normals = np.array([[-1.0]])
        if self.directions == "xy":
            tilt = np.radians(r["half_angle_deg"])
            normals = np.array([[-np.sin(tilt), -np.cos(tilt)], [np.sin(tilt), -np.cos(tilt)]])
        carried = 2.0 * normals.T @ normals  # two bearings
        return M, C, K, np.kron(np.diag([0.0, 1.0]), carried)

    def modes(self, name):
        """Vibrations on a contact, slowest first, each with the impedance at its own frequency."""
        found = []
        for guess in self._eigen(name, 2.0 * np.pi * self.hz)[0]:
            s = guess
            for _ in range(60):
                values, vectors = self._eigen(name, s.imag)
                k = np.argmin(np.abs(values - s))
                s = values[k]
            shape = vectors[: len(vectors) // 2, k]
            stiff = self.impedance(name, s.imag)[0]
            bent = [np.real(shape.conj() @ part @ shape) for part in (stiff * self.matrices[3], self.matrices[2])]
            up = np.abs(shape[len(self.directions) - 1 :: len(self.directions)]) ** 2
            found.append(
                SimpleNamespace(
                    omega=s.imag,
                    hz=s.imag / (2.0 * np.pi),
                    decrement=-2.0 * np.pi * s.real / s.imag,
                    contact_share=bent[0] / sum(bent),
                    vertical=up.sum() / (np.abs(shape) ** 2).sum() > 0.5,
                )
            )
        return sorted(found, key=lambda mode: mode.omega)

    def _eigen(self, name, omega):
        M, C, K, both = self.matrices
        stiffness, damping = self.impedance(name, omega)
        size = len(M)
        A = np.zeros((2 * size, 2 * size))
        A[:size, size:] = np.eye(size)
        A[size:, :size] = -np.linalg.solve(M, K + stiffness * both)
        A[size:, size:] = -np.linalg.solve(M, C + damping * both)
        values, vectors = np.linalg.eig(A)
        keep = values.imag > 1e-9 * np.abs(values)
        return values[keep], vectors[:, keep]

    def mode(self, name):
        """The slowest vibration up and down on the full film; on another contact, the one next to it."""
        vertical = [mode for mode in self.modes(name) if mode.vertical]
        if name == "full":
            return vertical[0]
        return min(vertical, key=lambda mode: abs(mode.omega - self.mode("full").omega))

    def amplitude(self, name, direction, hz):
        """Of the disc over the eccentricity, where the unbalance turns at `hz` and the film does not."""
        M, C, K, both = self.matrices
        omega, turning = 2.0 * np.pi * hz, np.zeros(len(M), dtype=complex)
        turning[: len(self.directions)] = [
            self.rotor["disc_mass"] * {"x": 1.0, "y": -1j}[d] for d in self.directions
        ]
        stiffness, damping = self.impedance(name, omega)
        dynamic = K + 1j * omega * C - omega**2 * M + (stiffness + 1j * omega * damping) * both
        return abs(np.linalg.solve(dynamic, omega**2 * turning)[self.directions.index(direction)])

    def peak(self, name, direction):
        """Largest amplitude near the slowest mode of a direction, and where: at a frequency of the results.

        They are samples; so they are held to the largest of all, which they may miss by `SAMPLED`.
        """
        mode = next(mode for mode in self.modes(name) if mode.vertical == (direction == "y"))
        width = abs(mode.decrement) * mode.hz / np.pi
        hz = self.results["rotor"]["resonance"][direction][name]["hz"]
        largest = optimize.minimize_scalar(
            lambda at: -self.amplitude(name, direction, at), bounds=(mode.hz - width, mode.hz + width)
        )
        found = self.amplitude(name, direction, hz)
        assert found == pytest.approx(-largest.fun, rel=SAMPLED)
        return SimpleNamespace(amplitude=found, hz=hz)
