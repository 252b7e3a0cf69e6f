"""Export of a contact element, a ball bearing or a rotor as an FMU file: model, files, verification, archive."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from ehlcontact.binaries import choose, this_machine
from ehlcontact.binaries.libraries import Progress
from ehlcontact.checks.kinds import FILE, PROGRESS
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.files import require_writable, write_bytes
from fmu.archive import fmu_files, pack
from fmu.models import Exported, FmuModel, fmu_model
from fmu.rotor.model import RotorModel
from fmu.sources import FMI_FILES
from fmu.verification import Verification
from fmu.verify import require_finite, require_verified


@takes(path=FILE, progress=PROGRESS)
def export(
    model: Exported,
    path: str | os.PathLike[str],
    *,
    speeds_rpm: Any = None,
    outside: str | Iterable[str] = (),
    speed_rpm: float | None = None,
    inertia: float | None = None,
    start: Any = None,
    load: Any = None,
    mass: Any = None,
    directions: Sequence[str] | None = None,
    permittivity: float | None = None,
    lead: float | None = None,
    model_name: str | None = None,
    fmi: int = 2,
    platforms: str | Iterable[str] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> Path:
    """Write a contact, a ball bearing, a set of them or a rotor as an FMU, once it is verified against it.

    A contact has the inputs `approach` and `rate`, and the output `force` with its tangents `stiffness` and
    `damping`. Coefficients of elements without memory, and their interval, are tunable parameters that start at
    the element's values; those of a film memory are constants, for others could put energy into a vibration. Units
    are the element's: SI, or "1" for a dimensionless element. An element over the speed has the input `u_sum` too,
    sum of both surface speeds, with the highest speed of its tables as bound; above it films are those of that
    speed, which is logged once. It is for co-simulation alone, and starts at the speed of its reference.

    A ball bearing has the inputs displacement and velocity of the inner ring against the outer one, `x`, `y` and,
    with five degrees of freedom, `z`, `tilt_x`, `tilt_y`; `velocity_x`, ..., `tilt_rate_y`; and the `speed` of the
    shaft [rad/s]. Outputs are the forces on the inner ring, `force_x`, ..., `moment_y`, the largest loads of a
    ball, the smallest film and lambda, the rolling torque and the angle of the cage. `clearance`, `offset` (axial
    preload), `cage_angle_start` and `film` (0: dry) can be set before initialization.

    A rotor has the inputs `unbalance`, `speed` (or, with `inertia`, the `torque` of its motor), and forces on its
    nodes; outputs are the motions of these and of the supports. Supports are inside: the FMU then solves their
    forces in every step, by the steps of `simulate_rotor` and Newton's method. The forces of those that are
    `outside` are inputs, named and directed as in the FMU of a contact or a bearing, and the motions there
    outputs. Squeeze film dampers are inside, with their forces and eccentricity ratios as outputs; a step that
    would end in contact there is refused. Contacts are elements of any kind, in SI; their films start at rest, and
    of those outside the FMU starts with the static force. Masses, stiffness and dampers can be set before
    initialization.

    A `BearingSet` has the inputs of a bearing, here the motion of its rigid shaft at 0, and the forces there as
    outputs; what each bearing has is under its label, ``bearing[1].smallest_film``. Outer rings on a spring are
    moved from outside too: `outer_ring.z` and `outer_ring.velocity_z` are inputs, `outer_ring.force_z`, with the
    force of the spring, an output. With `mass` a set is a rotor, ``set.rotor(load, mass=mass)``: forces and
    moments at 0 are inputs, `shaft.force_x`, ..., `shaft.moment_y`, beside the load; the motion there, `shaft.x`,
    ..., is an output.

    Reference inputs and results of the model are inside, for `verify_references`. The same model, name, library
    version and compiler give the same bytes. ``docs/notes/coupling.md`` has all variables.

    Parameters
    ----------
    model : ContactElement, BallBearing, BearingSet or Rotor
    path : path-like
        File to write, ending in ``.fmu``.
    speeds_rpm : float or (float, float), optional
        Of a bearing or set, and of a rotor with ball bearings inside: speed of the shaft [rev/min], or lowest and
        highest one. Tables of the films are made for these and some between; below the lowest films are those of
        the lowest, down to standstill.
    outside : sequence of str or "all"
        Of a rotor: names of the supports whose forces are inputs, as in `RotorResult.columns`: "contact 0",
        ..., names of ball bearings ("bearing 0", ... where they have none). Variables of an FMU count from 1:
        those of "contact 0" are ``contact[1]``, those of the first ball bearing ``bearing[1]``.
    speed_rpm : float, optional
        Of a rotor or set: speed at the start [rev/min]; by default that of the rotor, the highest of `speeds_rpm`,
        or 0.
    inertia : float, optional
        Of a rotor or set: polar moment of inertia [kg m2] of all that turns; the speed then follows from the
        torque of the motor and those of the bearings. By default the speed is an input.
    start : optional
        Of a rotor: where it starts, displacements and velocities, shape (N,) each; by default in static
        equilibrium or, where all contacts are outside and without an element, with these at their offsets.
    load : float or sequence of float, optional
        Of a bearing: force on the inner ring [N], [N m], as of `BallBearing.equilibrium`, under which it starts at
        rest; by default the ring starts in the middle. Of a set: load on the shaft at 0, shape (5,), under
        which it starts, with `mass` a constant one; by default none.
    mass : array_like, optional
        Of a set that moves by itself: mass of what moves with the shaft, as of `BearingSet.rotor`, shape (5, 5)
        [kg], [kg m2], or (6, 6) with that of the outer rings on a spring.
    directions : sequence of str, optional
        Of a bearing: displacements of its ring, the others are held, as of `BearingModel`; by default those that
        its load needs.
    permittivity : float, optional
        Of the oil, relative, some 2.2; of a bearing, a set, and a rotor with ball bearings inside. Each bearing
        with oil then has the output `capacitance` between its rings [F], and the FMU 3 to 5 kB more.
    lead : float, optional
        Start value of `lead` of a contact or bearing, 0 to 2 communication steps, by default 1.5; or of
        `force_lead` of a rotor, 0 to 1, by default 1/2 with supports outside and 0 without. What is right depends
        on what the force is given to: 1.5 for a mass that holds the force over its step while master and FMU step
        in parallel, which is what most co-simulation tools do, 1 if it advances by symplectic Euler; 0.5 and 0 for
        the same where the FMU is given the motion of the end of the step (serial masters). A wrong value costs the
        damping C as much as stiffness times step times the difference: ``docs/notes/coupling.md``.
    model_name : str, optional
        Name of the model; the kind of the model, as CubicContact, by default.
    fmi : int
        FMI version, 2 or 3.
    platforms : str or iterable of str, optional
        For which the FMU has binaries: ``x86_64-linux``, ``x86_64-windows``, ``x86_64-darwin``,
        ``aarch64-darwin`` (in FMI 3 ``aarch64-linux`` as well), or ``all``; also by the names of FMI 2,
        ``linux64``, ``win64`` and ``darwin64``, which is both Macs. This machine's by default.
    overwrite : bool
        Whether a file of that name may be replaced.
    progress : callable, optional
        Called with (libraries compiled, libraries in all).

    Returns
    -------
    Path
        The file.

    Elements warn here where the speed of a rotor lies outside their band, or they were made for another contact;
    bearings under an oil supply where their elements leave out damping below zero.

    Raises
    ------
    InputError
        Another kind of model or FMI version, a keyword that the model does not take, supports neither inside nor
        named in `outside`, a rotor that its supports do not hold, a name that is not printable, an unknown
        platform, a file that is there already or cannot be written.
    ConvergenceError
        The bearings do not hold the load.
    BuildError
        No C compiler, or one that failed.
    VerificationError
        The FMU differs from the model; nothing is written.

    Notes
    -----
    This machine's binary is compiled by the system's ``cc``, or by ``ziglang`` where there is none or the result
    would need a glibc newer than 2.17; all others by ``ziglang``, the first one for Windows in two minutes. As
    many are compiled at a time as there are processors.
    ``EHLCONTACT_CC`` names another compiler for this machine. Libraries are kept in the user's cache folder, or in
    ``EHLCONTACT_CACHE``, by their sources, flags and compiler.
    """
    require_version(fmi)
    made = fmu_model(
        model,
        speeds_rpm=speeds_rpm,
        outside=outside,
        speed_rpm=speed_rpm,
        inertia=inertia,
        start=start,
        load=load,
        mass=mass,
        directions=directions,
        permittivity=permittivity,
        lead=lead,
        model_name=model_name,
    )
    if isinstance(made.source, RotorModel):
        made.source.rotor.check_contacts(made.source.speed)
    return export_model(made, path, fmi=fmi, platforms=platforms, overwrite=overwrite, progress=progress)[0]


def require_version(fmi: object) -> None:
    """Raise `InputError` for another FMI version than 2 or 3."""
    if isinstance(fmi, bool) or fmi not in FMI_FILES:
        raise InputError("fmi", fmi, "2 or 3")


@takes(path=FILE, progress=PROGRESS)
def export_model(
    model: FmuModel,
    path: str | os.PathLike[str],
    *,
    fmi: int = 2,
    platforms: str | Iterable[str] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> tuple[Path, Verification | None]:
    """Write a model as an FMU; returns file and verification (None if this machine cannot run the FMU)."""
    require_version(fmi)
    require_finite(model)
    wanted = choose(platforms, fmi)
    target = free_target(path, overwrite)  # before compiling
    references = model.references()
    files = fmu_files(model.spec, wanted, fmi, progress, references)
    verification = None
    own = this_machine()
    if own is not None and own.folder(fmi) is not None:
        # An FMU for other machines is verified by this one's binary of the same sources.
        runnable = files if own in wanted else fmu_files(model.spec, (own,), fmi, references=references)
        verification = require_verified(pack(runnable), model)
    free_target(path, overwrite)  # still
    return write_bytes(target, pack(files)), verification


def free_target(path: str | os.PathLike[str], overwrite: bool, suffix: str = ".fmu") -> Path:
    """Path of a file to write; raises `InputError` if it cannot be written or exists."""
    target = Path(path)
    require_writable("path", target, (suffix,))
    if target.exists() and not overwrite:
        raise InputError("path", str(path), "a new file, or replaced with overwrite=True")
    return target
