"""A rotor and its ball bearings as the parts of a system; its default step, and its check."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import scipy

from ehlcontact.errors import ConvergenceError, InputError
from fmu.bearing.variables import FORCES, RATES
from fmu.lead import force_lead_for
from fmu.rotor.model import ALL, RotorModel
from fmu.steps import FAST_STEP, round_down
from fmu.system.check import STEPS, SystemVerification, schema_findings
from fmu.system.master import SystemRun
from fmu.system.part import Part
from fmu.verify import VerificationError
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.motion import motion_of
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.simulate import simulate_rotor
from reduced_models.rotor.speed_profile import SpeedProfile

BORNE = 0.1  # of a vibration's stiffness: what bearings must have of it, for it to limit the step
ALLOWED = 0.02  # deviation of the rings in the check, over what they move
STANDING = 0.1  # of the largest displacement: counted as motion, for films of tables are 0.03 % off


def mounts_of(model: RotorModel) -> list[Any]:
    """Mounts of its ball bearings."""
    return [station.mount for station in model.bearings_out]


@dataclass(frozen=True, slots=True)
class RotorOnBearings:
    """A rotor between ball bearings, and the speeds [rev/min] of their tables."""

    made: RotorModel
    speeds_rpm: Any
    name = "rotor on bearings"
    description = "A rotor in its ball bearings, in SI units; values are passed on after each step"
    stop = 1.0  # s, end of the default experiment

    @classmethod
    def of(cls, rotor: Rotor, speeds_rpm: Any = None, **keywords: Any) -> Self:
        """Rotor and speeds, checked."""
        if speeds_rpm is None:
            raise InputError("speeds_rpm", None, "given: the speed, or lowest and highest one, of the bearings")
        return cls(RotorModel(rotor, ALL, **keywords), speeds_rpm)

    def parts(self, lead: float) -> tuple[Part, ...]:
        """Rotor and bearings, whose FMUs have this lead."""
        model = self.made
        q, v = model.motion
        omega = model.speed * RPM_TO_RAD_S
        starts: dict[str, float] = {}
        bearings: list[Part] = []
        mounts = [station.mount for station in model.bearings_out]
        for b, station in enumerate(model.bearings_out, start=1):
            mount, force = station.mount, model.force(station)
            rows, names = mount.rows(model.rotor.size), mount.directions
            ring = dict(zip(names, (rows @ q + mount.shift).tolist(), strict=True))
            rates = {RATES[k]: rate for k, rate in zip(names, (rows @ v).tolist(), strict=True)}
            starts |= {f"bearing[{b}].{FORCES[k]}": f for k, f in zip(names, force.tolist(), strict=True)}
            same = [
                bearings[k].source
                for k, other in enumerate(mounts[: b - 1])
                if other.bearing is mount.bearing and other.directions == names
            ]
            back = [FORCES[k] for k in names] + ["rolling_torque"] * (model.inertia is not None)
            bearings.append(
                Part(
                    f"bearing_{b}",
                    same[0] if same else f"bearing_{b}",
                    mount.ball_bearing,
                    {"speeds_rpm": self.speeds_rpm, "directions": names, "lead": lead},
                    {**ring, **rates, "speed": omega, "cage_angle_start": mount.cage_angle},
                    (*((f"bearing[{b}].{k}", k) for k in (*ring, *rates)), *self._speed),
                    tuple((k, f"bearing[{b}].{k}") for k in back),
                )
            )
        settings = {"outside": ALL, "lead": force_lead_for(lead), "speed_rpm": model.speed}
        settings |= {"inertia": model.inertia, "start": model.start}
        return (Part("rotor", "rotor", model.rotor, settings, starts), *bearings)

    @property
    def _speed(self) -> tuple[tuple[str, str], ...]:
        """Wire of the speed to a bearing, where it is an output of the rotor."""
        return () if self.made.inertia is None else (("speed", "speed"),)

    def default_step(self) -> float:
        """A step [s] for the fastest vibration of which the bearings bear a share."""
        model = self.made
        size = model.rotor.size
        borne = np.zeros((size, size))
        for mount in mounts_of(model):
            balls = motion_of(mount.ball_bearing, [model.speed], mount.directions)
            rows = mount.rows(size)
            ring = rows @ model.motion[0] + mount.shift
            balls.rest(model.speed * RPM_TO_RAD_S, mount.cage_angle, ring)
            _, stiffness, _ = balls.forces(ring, np.zeros(len(ring)))
            borne += rows.T @ stiffness @ rows
        M, _, K = model.rotor.matrices(0.0)
        of_bearings = 0.5 * (borne + borne.T)
        squares, vectors = scipy.linalg.eigh(0.5 * (K + K.T) + of_bearings, 0.5 * (M + M.T))
        share = np.einsum("ik,ij,jk->k", vectors, of_bearings, vectors) / np.maximum(squares, 1.0)
        fastest = float(squares[share > BORNE].max(initial=0.0))
        return round_down(FAST_STEP / np.sqrt(fastest)) if fastest > 0.0 else 1e-5

    def require_verified(self, content: bytes, step: float, *, serial: bool) -> SystemVerification:
        """Hold an archive against the schema, and run it beside `simulate_rotor`, 400 steps at the speed it has.

        Raises
        ------
        VerificationError
            It does not run, or the rings of the bearings are elsewhere.
        """
        model = self.made
        findings = schema_findings(content)
        watched = [
            ("rotor", f"bearing[{b}].{k}") for b, m in enumerate(mounts_of(model), start=1) for k in m.directions
        ]
        turning = [("rotor", "speed")]
        try:
            with SystemRun(content, serial=serial) as run:
                ours = run.run(step, STEPS, [*watched, *turning])
        except Exception as error:  # fmpy raises bare Exception among others, also for a call that an FMU refuses
            raise VerificationError(f"the system does not run at steps of {step:g} s: {error}") from None
        times = np.asarray(step * np.arange(STEPS + 1), np.float64)
        profile = SpeedProfile(times, np.asarray(np.maximum(ours[:, -1], 0.0) / RPM_TO_RAD_S, np.float64))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of overloaded balls, no matter of this comparison
            try:
                wanted = simulate_rotor(
                    model.rotor, speed_rpm=profile, dt=step, until=STEPS * step, start=model.motion
                )
            except (ConvergenceError, InputError) as error:
                reason = f"the rotor itself does not run at steps of {step:g} s: {error}"
                raise VerificationError(reason) from None
        # tilts count at the radius of the balls
        arms = np.concatenate(
            [
                np.repeat([1.0, 0.5 * m.ball_bearing.pitch_diameter], [3, 2])[: len(m.directions)]
                for m in mounts_of(model)
            ]
        )
        theirs = arms * wanted.ring[: STEPS + 1].reshape(STEPS + 1, -1)
        sizes = np.maximum(np.ptp(theirs, axis=0), STANDING * np.abs(theirs).max())
        deviation = float((np.abs(arms * ours[:, :-1] - theirs).max(axis=0) / sizes).max())
        verification = SystemVerification(findings, deviation, step)
        if findings or not deviation <= ALLOWED:
            off = f"the rings are {deviation:.2g} of their way off, allowed {ALLOWED:g}, at steps of {step:g} s"
            raise VerificationError(f"the system is not what it was made from: {'; '.join(findings) or off}")
        return verification
