"""A rotor and its supports as the parts of a system; its default step, and its check."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import inf, pi, sqrt
from typing import Any, Self

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.checks import require_instance
from ehlcontact.errors import ConvergenceError, InputError
from fmu.bearing.variables import FORCES, RATES
from fmu.lead import force_lead_for
from fmu.rotor.model import ALL, RotorModel, Station
from fmu.steps import ADDED_DAMPING, ALLOWED_DAMPING, FAST_STEP, damping_at, round_down
from fmu.system.check import STEPS, SystemVerification, schema_findings
from fmu.system.master import SystemRun
from fmu.verify import VerificationError
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.motion import motion_of
from reduced_models.rotor.nodes import PLANE
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.simulate import simulate_rotor
from reduced_models.rotor.speed_profile import SpeedProfile

_Floats = NDArray[np.float64]

REVOLUTIONS = 10.0  # of the default experiment
STANDING = 0.1  # s of it, where nothing turns
BORNE = 0.1  # of a vibration's stiffness: what supports must have of it, for it to limit the step
LOAD_STEP = 0.1  # of the static load, along it and across: in the check of a rotor on contacts
LEAST_MOTION = 0.1  # of the largest motion at a support: counted as its way, for films of tables are 0.03 % off
TOLERANCE = 1e-9  # of the balance of forces in the run beside the system
ON_CONTACTS, ON_BALLS = 0.01, 0.02  # deviation of the motions at the supports that passes, over their way


@dataclass(frozen=True, slots=True)
class Part:
    """A component.

    Attributes
    ----------
    name : str
        Of the component.
    source : str
        Name of its FMU, which equal components share.
    model : object
        What the FMU is made from.
    keywords : mapping
        Of its `fmu_model`.
    starts : mapping of str to float
        Values of its inputs and parameters at the start.
    motions, forces : sequence of (str, str)
        Wires from the rotor to it, and from it to the rotor: output and input.
    """

    name: str
    source: str
    model: Any
    keywords: Mapping[str, Any]
    starts: Mapping[str, float] = field(default_factory=dict)
    motions: tuple[tuple[str, str], ...] = ()
    forces: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class RotorSystem:
    """A rotor with all supports outside, and the speeds [rev/min] of the tables of its ball bearings."""

    made: RotorModel
    speeds_rpm: Any = None

    @classmethod
    def of(cls, rotor: Rotor, speeds_rpm: Any = None, **keywords: Any) -> Self:
        """Rotor and speeds, checked; keywords as of `RotorModel`."""
        require_instance("rotor", rotor, Rotor, "a Rotor")
        if rotor.ball_bearings and speeds_rpm is None:
            raise InputError("speeds_rpm", None, "given: the speed, or lowest and highest one, of the bearings")
        if not rotor.ball_bearings and speeds_rpm is not None:
            raise InputError("speeds_rpm", speeds_rpm, "left out: the rotor has no ball bearing")
        if not (rotor.contacts or rotor.ball_bearings):
            allowed = "one at least: dampers stay inside a rotor"
            raise InputError("rotor.mounts", "no contact or ball bearing", allowed)
        for i, mount in enumerate(rotor.contacts):
            if mount.contact is None:
                raise InputError(f"contacts[{i}]", None, "one per mount: see Rotor.on")
        return cls(RotorModel(rotor, ALL, **keywords), speeds_rpm)

    @property
    def name(self) -> str:
        """Of the system, where none is given."""
        return f"rotor on {self._supports}"

    @property
    def description(self) -> str:
        """Of the system, in a sentence."""
        return f"A rotor on {self._supports}, in SI units; values are passed on after each step"

    @property
    def _supports(self) -> str:
        kinds = {"contacts": self.made.rotor.contacts, "ball bearings": self.made.bearings_out}
        return " and ".join(kind for kind, supports in kinds.items() if supports)

    @property
    def stop(self) -> float:
        """End of the default experiment [s]."""
        omega = self.made.speed * RPM_TO_RAD_S
        return float(f"{REVOLUTIONS * 2.0 * pi / omega if omega > 0.0 else STANDING:.6g}")

    def parts(self, lead: float) -> tuple[Part, ...]:
        """Rotor and supports, whose FMUs have this lead."""
        model = self.made
        supports: list[Part] = []
        starts: dict[str, float] = {}
        for station in model.out:
            part = self._contact(station, lead) if station.is_contact else self._bearing(station, lead, supports)
            names = [taken for _, taken in part.forces][: len(station.mount.directions)]
            starts |= dict(zip(names, model.force(station).tolist(), strict=True))
            supports.append(part)
        settings = {"outside": ALL, "lead": force_lead_for(lead), "speed_rpm": model.speed}
        settings |= {"inertia": model.inertia, "start": model.start}
        return (Part("rotor", "rotor", model.rotor, settings, starts), *supports)

    def _contact(self, station: Station, lead: float) -> Part:
        name, motion = _component(station), self._motion(station)
        return Part(
            name,
            name,
            station.mount.contact,
            {"lead": lead},
            dict(zip(("approach", "rate"), (float(one[0]) for one in motion), strict=True)),
            tuple((f"{station.label}.{k}", k) for k in ("approach", "rate")),
            (("force", f"{station.label}.force"),),
        )

    def _bearing(self, station: Station, lead: float, others: list[Part]) -> Part:
        model, mount, name = self.made, station.mount, _component(station)
        keywords = {"speeds_rpm": self.speeds_rpm, "directions": mount.directions, "lead": lead}
        place, velocity = (dict(zip(mount.directions, one.tolist(), strict=True)) for one in self._motion(station))
        rates = {RATES[k]: rate for k, rate in velocity.items()}
        alike = [one.source for one in others if one.model is mount.bearing and one.keywords == keywords]
        turns = model.inertia is not None
        return Part(
            name,
            alike[0] if alike else name,
            mount.ball_bearing,
            keywords,
            {**place, **rates, "speed": model.speed * RPM_TO_RAD_S, "cage_angle_start": mount.cage_angle},
            (*((f"{station.label}.{k}", k) for k in (*place, *rates)), *((("speed", "speed"),) if turns else ())),
            tuple(
                (k, f"{station.label}.{k}")
                for k in [*(FORCES[k] for k in mount.directions), *(["rolling_torque"] if turns else [])]
            ),
        )

    def _motion(self, station: Station) -> tuple[_Floats, _Floats]:
        """Motions and rates of a support at the start, shape (directions,) each."""
        q, v = self.made.motion
        rows = station.mount.rows(self.made.rotor.size)
        return rows @ q + station.shift, rows @ v

    def default_step(self) -> float:
        """A step [s] for the fastest vibration of which the supports bear a share: 1, 2 or 5 times a power of ten.

        At most a tenth of 1/w. Contacts extrapolate the motion of the rotor, which adds about 2.4 K h (w h)^4 to
        their damping: at most 5 % of it; and h resolves how fast their dampers alone would stop the rotor. Such a
        loop is stable up to w h = 0.57.
        """
        rotor = self.made.rotor
        borne, times = np.zeros((2, *rotor.mass.shape)), []
        for station in self.made.out:
            rows = station.mount.rows(rotor.size)
            stiffness, damping = self._slopes(station)
            borne += station.count * np.array([rows.T @ part @ rows for part in (stiffness, damping)])
            if station.is_contact and damping[0, 0] > 0.0:
                times.append(float(damping[0, 0] / stiffness[0, 0]))
        M, C, K = rotor.matrices(0.0)
        inertia, held = 0.5 * (M + M.T), 0.5 * (borne[0] + borne[0].T)
        squares, vectors = scipy.linalg.eigh(0.5 * (K + K.T) + held, inertia)
        share = np.einsum("ik,ij,jk->k", vectors, held, vectors) / np.maximum(squares, 1.0)
        w = sqrt(float(squares[share > BORNE].max(initial=0.0)))
        longest = [FAST_STEP / w] if w > 0.0 else []
        if times and w > 0.0:
            longest.append((ALLOWED_DAMPING / ADDED_DAMPING * min(times) / w**4) ** 0.2)
        if borne[1].any():
            dampers = scipy.linalg.eigvalsh(0.5 * (C + C.T) + borne[1], inertia)
            longest.append(FAST_STEP / float(dampers[-1]))
        return round_down(min(longest, default=1e-5))

    def _slopes(self, station: Station) -> tuple[_Floats, _Floats]:
        """Stiffness of a support at the start, and of a contact its damping, shape (directions, directions)."""
        mount, ring = station.mount, self._motion(station)[0]
        if station.is_contact:
            element, approach = mount.contact, float(ring[0])
            force = float(element.spring(approach))
            damping = damping_at(element, force) if force > 0.0 else 0.0
            return np.array([[float(element.spring_tangent(approach))]]), np.array([[damping]])
        balls = motion_of(mount.ball_bearing, [self.made.speed], mount.directions)
        balls.rest(self.made.speed * RPM_TO_RAD_S, mount.cage_angle, ring)
        return balls.forces(ring, np.zeros(len(ring)))[1], np.zeros((len(ring), len(ring)))

    def require_verified(self, content: bytes, step: float, *, serial: bool) -> SystemVerification:
        """Check of an archive; raises `VerificationError` where it does not run, or is not the rotor."""
        verification = self.verify(content, step, serial=serial)
        if not verification.passes:
            off = f"the motion at the supports is {verification.deviation:.2g} of its way off"
            off += f", allowed {verification.allowed:g}, at steps of {step:g} s"
            reason = "; ".join(verification.findings) or off
            raise VerificationError(f"the system is not what it was made from: {reason}")
        return verification

    def verify(self, content: bytes, step: float, *, serial: bool = False) -> SystemVerification:
        """Hold an archive against the schema, and run it beside `simulate_rotor`, 400 steps at the speed it has.

        On contacts alone a force comes at the start, a tenth of the static load along it and across. Compared are
        the motions at all supports. `serial`: the rotor steps first, then its supports.

        Raises
        ------
        VerificationError
            It does not run.
        """
        model = self.made
        watched = [
            ("rotor", f"{station.label}.{name or 'approach'}")
            for station in model.out
            for name in station.mount.directions
        ]
        findings, push = schema_findings(content), self._push()
        forces = {f"{node}.force_{name}": force for (node, name), force in push.items()}
        try:
            with SystemRun(content, {"rotor": forces}, serial=serial) as run:
                ours = run.run(step, STEPS, [*watched, ("rotor", "speed")])
        except Exception as error:  # fmpy raises bare Exception among others, also for a call that an FMU refuses
            raise VerificationError(f"the system does not run at steps of {step:g} s: {error}") from None
        arms = np.concatenate([_arms(station) for station in model.out])
        theirs = arms * self._simulated(step, ours[:, -1], push)
        sizes = np.maximum(np.ptp(theirs, axis=0), LEAST_MOTION * np.abs(theirs).max())
        deviation = float((np.abs(arms * ours[:, :-1] - theirs).max(axis=0) / sizes).max())
        allowed = ON_BALLS if model.bearings_out else ON_CONTACTS
        return SystemVerification(findings, deviation if np.isfinite(deviation) else inf, step, allowed)

    def _simulated(self, step: float, omega: _Floats, push: Mapping[tuple[str, str], float]) -> _Floats:
        """Motions at all supports by `simulate_rotor` at speeds [rad/s] of the ends of the steps."""
        model, rotor = self.made, self.made.rotor
        load = rotor.load.copy()
        for (node, name), force in push.items():
            load[rotor.nodes[node][name]] += force
        times = np.asarray(step * np.arange(STEPS + 1), np.float64)
        speeds = np.asarray(np.maximum(omega, 0.0) / RPM_TO_RAD_S, np.float64)
        contacts = [mount.contact.copy() for mount in rotor.contacts]
        for contact, approach in zip(contacts, rotor.approaches(model.motion[0]).tolist(), strict=True):
            contact.rest(approach)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of leaving a box, or overloaded balls: no matter of this comparison
            try:
                run = simulate_rotor(
                    replace(rotor, load=load).on(contacts),
                    speed_rpm=SpeedProfile(times, speeds),
                    dt=step,
                    until=STEPS * step,
                    start=model.motion,
                    tolerance=TOLERANCE,
                )
            except (ConvergenceError, InputError) as error:
                reason = f"the rotor itself does not run at steps of {step:g} s: {error}"
                raise VerificationError(reason) from None
        rows = np.concatenate([station.mount.rows(rotor.size) for station in model.out])
        shift = np.concatenate([station.shift for station in model.out])
        return np.asarray(run.displacement[: STEPS + 1] @ rows.T + shift)

    def _push(self) -> dict[tuple[str, str], float]:
        """Force [N] by node and direction that comes at the start, on the heaviest node away from the supports."""
        rotor = self.made.rotor
        if self.made.bearings_out or not rotor.nodes:
            return {}
        load = {k: sum(float(rotor.load[at[k]]) for at in rotor.nodes.values() if k in at) for k in PLANE}
        along = {"x": load["x"] - load["y"], "y": load["x"] + load["y"]}
        held = {place for mount in rotor.mounts for end in mount.ends for place in end}
        masses = {node: max(rotor.mass[at, at] for at in places.values()) for node, places in rotor.nodes.items()}
        node = max(masses, key=lambda node: (held.isdisjoint(rotor.nodes[node].values()), masses[node]))
        return {(node, k): LOAD_STEP * along[k] for k in PLANE if k in rotor.nodes[node]}


def _arms(station: Station) -> list[float]:
    """What motions of a support are multiplied with: tilts count at the radius of the balls."""
    if station.is_contact:
        return [1.0]
    radius = 0.5 * station.mount.ball_bearing.pitch_diameter
    return [radius if name.startswith("tilt") else 1.0 for name in station.mount.directions]


def _component(station: Station) -> str:
    """Name of the component: contact_1 of contact[1]."""
    return station.label.replace("[", "_").rstrip("]")
