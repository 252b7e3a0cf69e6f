"""Export of a shaft, its bearings and the torque of its motor as a system archive (SSP)."""

from __future__ import annotations

import os
import tempfile
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ehlcontact.checks import require_instance, require_positive
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.files import write_bytes
from fmu.archive import pack
from fmu.bearing.export import export_bearing
from fmu.bearing.variables import FORCES, RATES
from fmu.binaries import choose, this_machine
from fmu.binaries.libraries import Progress
from fmu.contact_spec import checked_name
from fmu.controller.export import export_controller
from fmu.controller.model import SpeedController
from fmu.export import free_target
from fmu.lead import CONTACT, HELD_PARALLEL, force_lead_for
from fmu.shaft.export import export_shaft
from fmu.shaft.model import ShaftModel
from fmu.steps import FAST_STEP, round_down
from fmu.system.check import STEPS, SystemVerification, schema_findings
from fmu.system.export import connectors
from fmu.system.master import SystemRun
from fmu.system.structure import Component, Wire, system_structure
from fmu.verify import VerificationError
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.motion import motion_of
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.simulate import simulate_rotor
from reduced_models.rotor.speed_profile import SpeedProfile

NAME = "drive"
BORNE = 0.1  # of a vibration's stiffness: what bearings must have of it, for it to limit the step
ALLOWED = 0.02  # deviation of the rings in the check, over what they move
STANDING = 0.1  # of the largest displacement: counted as motion, for films of tables are 0.03 % off
STOP = 1.0  # s, of the default experiment


def export_drive(
    rotor: Rotor,
    path: str | os.PathLike[str],
    *,
    inertia: float,
    speeds_rpm: Any,
    speed_rpm: float = 0.0,
    torque: float = 0.0,
    controller: SpeedController | None = None,
    start: Any = None,
    fmi: int = 2,
    model_name: str = NAME,
    step: float | None = None,
    lead: float = HELD_PARALLEL,
    platforms: str | Iterable[str] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> Path:
    """Write a rotor, its ball bearings and the torque of its motor as a system archive (SSP 1.0), ready to run.

    Component ``shaft`` is the FMU of `export_shaft`, ``bearing_1`` and so on are those of `export_bearing`:
    motions of the rings and the speed go from the shaft to the bearings, forces and rolling torques back. The
    input `torque` of the shaft is free: it starts at `torque`, and a motor, or a controller, may be wired to it.
    With `controller` the FMU of `export_controller` is the component ``controller``: the speed goes from the shaft
    to it and the torque back, and its input `speed_set_point` is free.

    Nothing is written that is not verified: each FMU against what it was made from, the description against the
    schema of the standard, and a run of the whole against `simulate_rotor` with the speed of that run.

    Parameters
    ----------
    rotor : Rotor
        On ball bearings, and linear ones, which stay in the shaft.
    path : path-like
        File to write, ending in ``.ssp``.
    inertia : float
        Polar moment of inertia of all that turns [kg m2].
    speeds_rpm : float or (float, float)
        Speed [rev/min], or lowest and highest one, of the tables of the bearings.
    speed_rpm : float
        At the start; the rotor then is at rest under its load, or where `start` puts it, as in `export_shaft`.
    torque : float
        Of the motor, at the start [N m]; with a controller its integral part.
    controller : SpeedController, optional
        Of the speed; its `speed_rpm` is the set point at the start.
    step : float, optional
        Of the default experiment [s]. By default a tenth of 1/w, 1, 2 or 5 times a power of ten, for the fastest
        vibration w of the shaft on its bearings.
    fmi, model_name, lead, platforms, overwrite, progress
        As of `export_system`.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        What `ShaftModel` and `export_bearing` refuse.
    BuildError
        No C compiler, or one that failed.
    VerificationError
        The system differs from the rotor, or `step` is too long for it; nothing is written.
    """
    require_positive("inertia", inertia)
    return export_verified_drive(
        ShaftModel(rotor, speed_rpm, inertia, torque, start),
        path,
        speeds_rpm=speeds_rpm,
        controller=controller,
        fmi=fmi,
        model_name=model_name,
        step=step,
        lead=lead,
        platforms=platforms,
        overwrite=overwrite,
        progress=progress,
    )[0]


def export_verified_drive(
    model: ShaftModel,
    path: str | os.PathLike[str],
    *,
    speeds_rpm: Any,
    controller: SpeedController | None = None,
    fmi: int = 2,
    model_name: str = NAME,
    step: float | None = None,
    lead: float = HELD_PARALLEL,
    platforms: str | Iterable[str] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> tuple[Path, SystemVerification | None]:
    """As `export_drive`, of a shaft with inertia; returns what was found too.

    None was found where this machine can run no such FMU.
    """
    checked_name(model_name)
    names = [one.name for one in choose(platforms, fmi)]
    target = free_target(path, overwrite, ".ssp")
    step = default_drive_step(model) if step is None else require_positive("step", step)
    if controller is not None:
        require_instance("controller", controller, SpeedController, "a SpeedController")
    drive = _Drive(model, speeds_rpm, model_name, step, CONTACT.check(lead), fmi, controller)
    content = drive.archive(names, progress)
    own = this_machine()
    found = None
    if own is not None and own.folder(fmi) is not None:
        # A system for other machines is verified by this one's binaries of the same sources.
        found = verify_drive(content if own.name in names else drive.archive([own.name], None), drive)
    free_target(path, overwrite, ".ssp")  # still
    return write_bytes(target, content), found


def default_drive_step(model: ShaftModel) -> float:
    """A step [s] for the fastest vibration of which the bearings bear a share."""
    size = model.rotor.size
    borne = np.zeros((size, size))
    for mount in model.stations:
        balls = motion_of(mount.ball_bearing, [model.speed_rpm], mount.directions)
        rows = mount.rows(size)
        ring = rows @ model.motion[0] + mount.shift
        balls.rest(model.speed_rpm * RPM_TO_RAD_S, mount.cage_angle, ring)
        _, stiffness, _ = balls.forces(ring, np.zeros(len(ring)))
        borne += rows.T @ stiffness @ rows
    shapes = model.modes.shapes
    of_bearings = shapes.T @ (0.5 * (borne + borne.T)) @ shapes
    squares, vectors = np.linalg.eigh(np.diag(model.modes.stiffness) + of_bearings)
    share = np.einsum("ik,ij,jk->k", vectors, of_bearings, vectors) / np.maximum(squares, 1.0)
    fastest = float(squares[share > BORNE].max(initial=0.0))
    return round_down(FAST_STEP / np.sqrt(fastest)) if fastest > 0.0 else 1e-5


@dataclass(frozen=True, slots=True)
class _Drive:
    """What goes into an archive."""

    model: ShaftModel
    speeds_rpm: Any
    name: str
    step: float
    lead: float
    fmi: int
    controller: SpeedController | None

    def archive(self, platforms: list[str], progress: Progress | None) -> bytes:
        """All of it, its FMUs verified one by one; equal bearings share one."""
        model = self.model
        with tempfile.TemporaryDirectory(prefix="ehlcontact-drive-", ignore_cleanup_errors=True) as folder:
            shaft = export_shaft(
                model.rotor,
                Path(folder, "shaft.fmu"),
                speed_rpm=model.speed_rpm,
                inertia=model.inertia,
                torque=model.torque,
                start=model.start,
                fmi=self.fmi,
                model_name="shaft",
                force_lead=force_lead_for(self.lead),
                platforms=platforms,
                progress=progress,
            )
            files = [shaft]
            for b, mount in enumerate(model.stations):
                same = [
                    files[1 + k]
                    for k, other in enumerate(model.stations[:b])
                    if other.bearing is mount.bearing and other.directions == mount.directions
                ]
                files.append(
                    same[0]
                    if same
                    else export_bearing(
                        mount.ball_bearing,
                        Path(folder, f"bearing_{b + 1}.fmu"),
                        speeds_rpm=self.speeds_rpm,
                        freedoms=len(mount.directions),
                        fmi=self.fmi,
                        model_name=f"bearing_{b + 1}",
                        lead=self.lead,
                        platforms=platforms,
                        progress=progress,
                    )
                )
            if self.controller is not None:
                files.append(
                    export_controller(
                        self.controller,
                        Path(folder, "controller.fmu"),
                        fmi=self.fmi,
                        model_name="controller",
                        platforms=platforms,
                        progress=progress,
                    )
                )
            content = {f"resources/{file.name}": file.read_bytes() for file in files}
            return pack(content | {"SystemStructure.ssd": self._description(files)})

    def _description(self, files: list[Path]) -> bytes:
        model = self.model
        q, v = model.motion
        omega = model.speed_rpm * RPM_TO_RAD_S
        starts: dict[str, float] = {"torque": model.torque}
        components, wires = [], []
        for b, (mount, force) in enumerate(zip(model.stations, model.forces, strict=True), start=1):
            ports = connectors(files[b])
            there = {port.name for port in ports}
            rows, part = mount.rows(model.rotor.size), f"bearing_{b}"
            ring = dict(zip(mount.directions, (rows @ q + mount.shift).tolist(), strict=True))
            rates = {RATES[k]: one for k, one in zip(mount.directions, (rows @ v).tolist(), strict=True)}
            starts |= {
                f"bearing[{b}].{FORCES[k]}": one for k, one in zip(mount.directions, force.tolist(), strict=True)
            }
            components.append(
                Component(
                    part,
                    f"resources/{files[b].name}",
                    ports,
                    {**ring, **rates, "speed": omega, "cage_angle_start": mount.cage_angle},
                )
            )
            wires += [Wire(("shaft", f"bearing[{b}].{k}"), (part, k)) for k in (*ring, *rates)]
            wires.append(Wire(("shaft", "speed"), (part, "speed")))
            back = [*(FORCES[k] for k in mount.directions), *({"rolling_torque"} & there)]
            wires += [Wire((part, k), ("shaft", f"bearing[{b}].{k}")) for k in back]
        if self.controller is not None:
            wanted = self.controller.speed_rpm * RPM_TO_RAD_S
            values = {"speed_set_point": wanted, "speed": omega, "integral_start": model.torque}
            ports = connectors(files[-1])
            components.append(Component("controller", f"resources/{files[-1].name}", ports, values))
            wires += [Wire(("shaft", "speed"), ("controller", "speed"))]
            wires += [Wire(("controller", "torque"), ("shaft", "torque"))]
            starts["torque"] = float(self.controller.torque([0.0], [omega], start=model.torque)[0])
        shaft = Component("shaft", "resources/shaft.fmu", connectors(files[0]), starts)
        text = "A shaft in its bearings under the torque of a motor, in SI units"
        return system_structure(
            self.name, [shaft, *components], wires, step=self.step, stop=STOP, description=text
        )


def verify_drive(content: bytes, drive: _Drive) -> SystemVerification:
    """Hold an archive against the schema, and run it beside `simulate_rotor`, 400 steps at the speed it has.

    Raises
    ------
    VerificationError
        It does not run, or the rings of the bearings are elsewhere.
    """
    model, step = drive.model, drive.step
    findings = schema_findings(content)
    watched = [
        *(("shaft", f"bearing[{b}].{k}") for b, m in enumerate(model.stations, start=1) for k in m.directions),
        ("shaft", "speed"),
    ]
    try:
        with SystemRun(content, serial=drive.lead < 1.0) as run:
            ours = run.run(step, STEPS, watched)
    except Exception as error:  # fmpy raises bare Exception among others, also for a call that an FMU refuses
        raise VerificationError(f"the system does not run at steps of {step:g} s: {error}") from None
    times = np.asarray(step * np.arange(STEPS + 1), np.float64)
    profile = SpeedProfile(times, np.asarray(np.maximum(ours[:, -1], 0.0) / RPM_TO_RAD_S, np.float64))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of overloaded balls, no matter of this comparison
        try:
            found = simulate_rotor(model.rotor, speed_rpm=profile, dt=step, until=STEPS * step, start=model.motion)
        except (ConvergenceError, InputError) as error:
            raise VerificationError(f"the rotor itself does not run at steps of {step:g} s: {error}") from None
    # tilts count at the radius of the balls
    arms = np.concatenate(
        [
            np.repeat([1.0, 0.5 * m.ball_bearing.pitch_diameter], [3, 2])[: len(m.directions)]
            for m in model.stations
        ]
    )
    theirs = arms * found.ring[: STEPS + 1].reshape(STEPS + 1, -1)
    sizes = np.maximum(np.ptp(theirs, axis=0), STANDING * np.abs(theirs).max())
    deviation = float((np.abs(arms * ours[:, :-1] - theirs).max(axis=0) / sizes).max())
    checked = SystemVerification(findings, deviation, step)
    if findings or not deviation <= ALLOWED:
        off = f"the rings are {deviation:.2g} of their way off, allowed {ALLOWED:g}, at steps of {step:g} s"
        raise VerificationError(f"the system is not what it was made from: {'; '.join(findings) or off}")
    return checked
