"""`bearing_matrices`: stiffness and damping of a bearing or a set over speed and frequency, for other programs.

They are 6 x 6 in x, y, z and the rotations about x, y, z, about a point that is named; nothing resists the
rotation about the axis of the shaft. `BearingMatrices.about` moves them to any other point, as a rigid arm does.

**Signs.** F = K u + C du/dt is the change of the force *on the shaft* that holds the displacement u of the shaft
against the housing; the bearing pulls the shaft by -F. The shaft turns from x to y.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, as_numbers, parts, require_instance
from ehlcontact.checks.frequency import is_given, radians_per_second
from ehlcontact.checks.kinds import FILE
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError, warn_user
from ehlcontact.files import write_text
from ehlcontact.quantities import DAMPING, FORCE, HERTZ, LENGTH, SPEED, STIFFNESS
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.summary import counted, note_line, span
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.freedoms import FACINGS, PLANAR, bearing_load, facing_signs, load_words
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.elements.validity import OutsideValidityWarning
from reduced_models.rotor.bearing_set import BearingSet
from reduced_models.rotor.matrix_text import PROGRAMS, SIGNS, SIX, Placed, text_of

_Floats = NDArray[np.float64]

ROUNDING = 1e-12  # of the diagonal: couplings that are zero by symmetry
FAR = 10.0  # pitch diameters from the bearing, beyond which a point is no point of a machine


def rigid_arm(arm: _Floats) -> _Floats:
    """Motion of a point by that of another, shape (6, 6); `arm` [m] leads from the other to the point."""
    x, y, z = arm
    T = np.eye(6)
    T[:3, 3:] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
    return T


@dataclass(frozen=True, eq=False, kw_only=True)
class BearingMatrices(QuantityTable):
    """Stiffness and damping matrices of a bearing, or of a set, over m speeds and k frequencies.

    Attributes
    ----------
    name : str
    origin : str
        What `point` is measured from, in words.
    point : ndarray, shape (3,)
        About which the matrices are [m]: x, y, z from the origin.
    load : ndarray, shape (2,), (3,) or (5,)
        Force on the inner ring or the shaft [N], [N m], about the origin.
    speed_rpm : ndarray, shape (m,)
        Of the shaft.
    hz : ndarray, shape (m, k)
        Frequency of the vibration at each speed.
    stiffness, damping : ndarray, shape (m, k, 6, 6)
        In x, y, z and rotations about x, y, z: [N/m], [N], [N m]; [N s/m], [N s], [N m s].
    reach : float
        Ten pitch diameters [m]: points farther from the origin are warned of.
    reservations : tuple of str
        What does not hold, in words.
    """

    name: str
    origin: str
    point: Annotated[_Floats, LENGTH.over("way")]
    load: Annotated[_Floats, FORCE.over("component")]
    speed_rpm: Annotated[_Floats, SPEED.over("speed")]
    hz: Annotated[_Floats, HERTZ.over("speed frequency")]
    stiffness: Annotated[_Floats, STIFFNESS.over("speed frequency axis by")]
    damping: Annotated[_Floats, DAMPING.over("speed frequency axis by")]
    reach: float
    reservations: tuple[str, ...] = ()

    DISPLAY: ClassVar[Display] = Display(
        rows="speed frequency", panels=("stiffness", "damping"), labels={"axis": SIX, "by": SIX}
    )

    @property
    def planar(self) -> bool:
        """Whether only x and y are known: the load has two components, and all else is zero."""
        return self.load.size == len(PLANAR)

    @property
    def asymmetry(self) -> float:
        """Largest difference of an entry of K from its mirror, relative to the largest entry of its block."""
        blocks = [(slice(0, 3), slice(0, 3)), (slice(0, 3), slice(3, 6)), (slice(3, 6), slice(3, 6))]
        skew = np.abs(self.stiffness - np.swapaxes(self.stiffness, -1, -2))
        sizes = [(skew[..., a, b].max(), np.abs(self.stiffness[..., a, b]).max()) for a, b in blocks]
        return max((float(part / whole) for part, whole in sizes if whole > 0.0), default=0.0)

    def _summary_lines(self) -> list[str]:
        K = self.stiffness[..., [0, 1, 2], [0, 1, 2]]
        parts = [f"K_{way}{way} {span(K[..., n], 1e-6, 'N/µm')}" for n, way in enumerate("xyz") if K[..., n].any()]
        tilts = self.stiffness[..., [3, 4], [3, 4]]
        parts += [
            f"K_tilt_{way} {span(tilts[..., n], 1e-3, 'N m/mrad')}"
            for n, way in enumerate("xy")
            if tilts[..., n].any()
        ]
        return [
            f"{self.name}, load {load_words(self.load)}, about {self.point_words}",
            f"{counted(self.speed_rpm.size, 'speed')} ({span(self.speed_rpm, 1.0, 'rev/min')}),"
            f" {span(self.hz, 1.0, 'Hz')}",
            ", ".join(parts[:3]),
            *([", ".join(parts[3:])] if parts[3:] else []),
            *note_line("; ".join(self.reservations)),
        ]

    @property
    def point_words(self) -> str:
        """The point in words."""
        if not self.point.any():
            return self.origin
        x, y, z = (f"{1e3 * value + 0.0:.6g}" for value in self.point.tolist())
        return f"({x}, {y}, {z}) mm from {self.origin}"

    @takes(point="m")
    def about(self, point: ArrayLike) -> BearingMatrices:
        """The same bearing about another point, which a rigid arm joins to it.

        Parameters
        ----------
        point : (float, float, float)
            x, y, z from the origin [m].

        Returns
        -------
        BearingMatrices
            K' = T.T K T and C' = T.T C T, T the motion of the old point by that of the new. The arm's own rotation
            of a load (of the size load times arm, beside K) is left out, as linear programs leave it out.

        Warns
        -----
        OutsideValidityWarning
            A point farther away than ten pitch diameters.

        Raises
        ------
        InputError
        """
        new = as_column("point", point, size=3)
        distance = float(np.linalg.norm(new))
        if distance > self.reach:
            warn_user(
                f"point: {distance:.4g} m from {self.origin}, more than ten pitch diameters ({self.reach:.4g} m);"
                " points are in metres",
                OutsideValidityWarning,
            )
        T = rigid_arm(self.point - new)
        return replace(self, point=new, stiffness=T.T @ self.stiffness @ T, damping=T.T @ self.damping @ T)

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON, with what units and signs are."""
        return super().to_dict() | {
            "name": self.name,
            "reservations": list(self.reservations),
            "about": self.point_words,
            "rows_and_columns": list(SIX),
            "units": "SI: N/m, N and N m (rotations in rad); N s/m, N s and N m s",
            "signs": SIGNS,
        }

    @takes(speed_rpm="rev/min", hz="Hz")
    def text(
        self,
        program: str,
        *,
        speed_rpm: float | None = None,
        hz: float | None = None,
        node: int = 1,
        units: str = "m",
        shaft_along: str = "z",
    ) -> str:
        """The matrices as input of another program.

        Parameters
        ----------
        program : {"csv", "json", "ansys-combi214", "ansys-matrix27", "nastran-cbush", "nastran-dmig", "abaqus", \
"exudyn", "links"}
            ``csv`` and ``json`` have all speeds and frequencies in SI, ``ansys-combi214`` all speeds. ``links``
            has a row for each pair of degrees of freedom of the node, against the ground: node, degree of
            freedom, node, degree of freedom, k, c.
        speed_rpm : float, optional
            Of the table, for programs that take one; needed where the table has several.
        hz : float, optional
            Of the table, likewise.
        node : int
            Number of the node of the shaft. Numbers and names of elements, properties and matrices follow it, so
            that texts of several bearings go into one model.
        units : {"m", "mm"}
            N, m, rad, s; or N, mm, rad, s (masses in tonnes).
        shaft_along : {"z", "x", "y"}
            Axis of the other program along the shaft; x and y of the bearing are the next two in cyclic order.

        Returns
        -------
        str
            It opens with the frame, the units and the signs as comments.

        Raises
        ------
        InputError
        """
        placed = Placed.of(node, units, shaft_along)
        return text_of(self, program, speed_rpm, hz, placed)

    @takes(path=FILE)
    def write(self, path: str | Path, program: str | None = None, **options: Any) -> Path:
        """Write `text` to a file; a program that is left out follows from the ending .csv or .json.

        Parameters
        ----------
        path : str or Path
        program : str, optional
            As of `text`.
        **options
            As of `text`.

        Returns
        -------
        Path

        Raises
        ------
        InputError
        """
        file = Path(path)
        kind = file.suffix.lower().removeprefix(".") if program is None else program
        if program is None and kind not in ("csv", "json"):
            allowed = f"given, as the file does not end in .csv or .json: {', '.join(PROGRAMS)}"
            raise InputError("program", None, allowed)
        write_text(file, self.text(kind, **options))
        return file


@takes(load="N", speeds_rpm=parts.SPEEDS, tilt="rad")
def bearing_matrices(
    bearing: BallBearing | BearingSet,
    load: ArrayLike,
    speeds_rpm: ArrayLike,
    *,
    facing: str = FACINGS[0],
    tilt: ArrayLike | None = None,
    omega: ArrayLike | None = None,
    hz: ArrayLike | None = None,
    rpm: ArrayLike | None = None,
) -> BearingMatrices:
    """Stiffness and damping of a bearing or a set over speeds of the shaft and frequencies.

    They are means over a ball passage.

    Parameters
    ----------
    bearing : BallBearing or BearingSet
    load : tuple of 2, 3 or 5 float
        Force on the inner ring or the shaft [N], [N m]. Under two components matrices have x and y alone.
    speeds_rpm : float or sequence of float
        Speeds of the shaft, increasing; 0 is the dry bearing at rest.
    facing : {"+z", "-z"}
        Of a bearing on the shaft, in whose axes load and matrices are; a set has those of its bearings.
    tilt : (float, float), optional
        As of `BallBearing.equilibrium` [rad].
    omega, hz, rpm : float or sequence of float, optional
        Frequencies of the vibration, in one of these; by default the frequency of the shaft at each speed.

    Returns
    -------
    BearingMatrices
        About the middle of the bearing in the plane of its groove centres; of a set about its origin.

    Raises
    ------
    InputError
        As of `BallBearing.coefficients`.
    """
    require_instance("bearing", bearing, BallBearing | BearingSet, "a BallBearing or a BearingSet")
    signs = facing_signs(facing)
    if isinstance(bearing, BearingSet) and facing != FACINGS[0]:
        raise InputError("facing", facing, "left out of a set, whose bearings have facings")
    speeds = as_column("speeds_rpm", np.atleast_1d(as_numbers("speeds_rpm", speeds_rpm)), increasing=True)
    given = {"omega": omega, "hz": hz, "rpm": rpm}
    fixed = radians_per_second(None, **given) if is_given(**given) else None
    force = bearing_load(load)
    own_load = tuple(force * signs[: force.size])
    rows = []
    for speed in speeds.tolist():
        there = bearing if speed > 0.0 else bearing.dry
        w = np.array([speed * RPM_TO_RAD_S]) if fixed is None else fixed
        rows.append(there.coefficients(own_load, speed_rpm=speed, tilt=tilt, omega=w))
    planar = force.size == len(PLANAR)
    members = bearing.bearings if isinstance(bearing, BearingSet) else (bearing,)
    reservations = dict.fromkeys(
        words for row in rows for words in (row.reservation, row.outside_assumptions) if words
    )
    return BearingMatrices(
        name=bearing.name or ("bearing set" if isinstance(bearing, BearingSet) else "ball bearing"),
        origin="the origin of the set" if isinstance(bearing, BearingSet) else "the centre of the bearing",
        point=np.zeros(3),
        load=force,
        speed_rpm=speeds,
        hz=np.array([row.hz for row in rows]),
        stiffness=np.array([_six(row.stiffness, signs) for row in rows]),
        damping=np.array([_six(row.damping, signs) for row in rows]),
        reach=FAR * max(one.pitch_diameter for one in members),
        reservations=(*(["x and y alone: the load has two components"] if planar else []), *reservations),
    )


def _six(matrices: _Floats, signs: _Floats) -> _Floats:
    """Matrices, shape (k, n, n), in all six directions of the shaft: zero where there is none."""
    n = matrices.shape[-1]
    matrices = matrices * np.outer(signs[:n], signs[:n])
    whole = np.zeros((matrices.shape[0], 6, 6))
    size = np.sqrt(np.abs(np.einsum("kii->ki", matrices)))
    rounding = np.abs(matrices) <= ROUNDING * size[:, :, None] * size[:, None, :]
    whole[:, :n, :n] = np.where(rounding, 0.0, matrices)
    return whole
