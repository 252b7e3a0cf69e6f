"""Texts of `BearingMatrices` for other programs: tables, and input of finite-element and multibody programs.

Each opens with a picture of the frame, the units, the signs and what the matrices are about, as comments of the
program.

Sources of the formats: Ansys Mechanical APDL element reference (COMBI214: real constants K11, K22, K12, K21, C11,
C22, C12, C21, tables over OMEGS; MATRIX27: C1 to C78 are the upper triangle, row by row); NX and MSC Nastran quick
reference guides (CBUSH, PBUSH, DMIG); Abaqus keywords reference (*MATRIX INPUT, *MATRIX ASSEMBLE); Exudyn manual
(RigidBodySpringDamper).
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_choice, require_integer
from ehlcontact.errors import InputError, warn_user
from reduced_models.bearing.freedoms import FIVE, load_words
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.elements.validity import OutsideValidityWarning

if TYPE_CHECKING:
    from reduced_models.rotor.bearing_matrices import BearingMatrices

_Floats = NDArray[np.float64]

SIX = (*FIVE, "tilt_z")
AXES = {"z": (0, 1, 2), "x": (2, 0, 1), "y": (1, 2, 0)}  # shaft along: x, y, z of the bearing, of X, Y, Z there
LENGTHS = {"m": 1.0, "mm": 1e3}  # in a metre
ELSEWHERE = ("UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ")
SIGNS = "F = K u + C du/dt is the force on the shaft that holds its displacement u against the housing"
SPELLED = str.maketrans({"µ": "u", "±": "+-", "°": "deg"})  # of comments
DMIG_NODES = 10**6  # distinct ones in names of at most 8 characters
NOTED = 1e-3  # of K, unsymmetric: what a symmetric element leaves out is warned of


@dataclass(frozen=True)
class Placed:
    """A bearing in the model of another program: node of the shaft, unit of length, axis along the shaft."""

    node: int
    units: str
    shaft_along: str

    @classmethod
    def of(cls, node: int, units: str, shaft_along: str) -> Placed:
        """Checked.

        Raises
        ------
        InputError
        """
        number = require_integer("node", node, "the number of a node, a whole number from 1 to 99 999 999", 1)
        if number > 99_999_999:
            raise InputError("node", node, "the number of a node, a whole number from 1 to 99 999 999")
        require_choice("units", units, tuple(LENGTHS))
        require_choice("shaft_along", shaft_along, tuple(AXES))
        return cls(number, units, shaft_along)

    def matrices(self, matrices: _Floats) -> _Floats:
        """In the axes and units of the program, shape (..., 6, 6)."""
        order = AXES[self.shaft_along]
        rows = [*order, *(3 + place for place in order)]
        size = np.repeat([1.0 / LENGTHS[self.units], 1.0], 3)  # of a displacement and a rotation of 1
        scale = np.outer(size, size) * LENGTHS[self.units]  # in N: F = K u
        return np.asarray(matrices[..., rows, :][..., rows], float) * scale

    @property
    def unit_words(self) -> str:
        """Units in words."""
        u = self.units
        return f"N, {u}, rad, s: K in N/{u}, N, N {u}; C in N s/{u}, N s, N {u} s"

    def frame(self) -> list[str]:
        """Picture of the axes, seen along the shaft, as lines."""
        across = [axis for axis, place in zip("XYZ", AXES[self.shaft_along], strict=True) if place != 2]
        first, second = sorted(across, key=lambda axis: AXES[self.shaft_along]["XYZ".index(axis)])
        along = self.shaft_along.upper()
        return [
            f"  {second}  (y of the bearing: upwards)",
            "  |",
            f"  |   the shaft turns from {first} to {second}",
            "  |",
            f"  o------ {first}  (x of the bearing)",
            f"  o: {along}, along the shaft, points at you (z of the bearing)",
        ]


class Values(NamedTuple):
    """One speed and frequency in the axes and units of a program: K and C, shape (6, 6)."""

    speed_rpm: float
    hz: float
    K: _Floats
    C: _Floats


def text_of(
    table: BearingMatrices, program: str, speed_rpm: float | None, hz: float | None, placed: Placed
) -> str:
    """See `BearingMatrices.text`."""
    require_choice("program", program, tuple(PROGRAMS))
    if program in WHOLE:
        for name, value in (("speed_rpm", speed_rpm), ("hz", hz)):
            if value is not None:
                raise InputError(name, value, f"left out: {program} has all of the table")
        return WHOLE[program](table)
    if program == "ansys-combi214":
        if speed_rpm is not None:
            raise InputError("speed_rpm", speed_rpm, "left out: ansys-combi214 has all speeds of the table")
        return _combi214(table, hz, placed)
    m = chosen("speed_rpm", speed_rpm, table.speed_rpm.tolist(), "rev/min")
    k = chosen("hz", hz, table.hz[m].tolist(), "Hz")
    values = Values(
        float(table.speed_rpm[m]),
        float(table.hz[m, k]),
        placed.matrices(table.stiffness[m, k]),
        placed.matrices(table.damping[m, k]),
    )
    mark, lines = SINGLE[program]
    of = f"at {values.speed_rpm:.6g} rev/min of the shaft, for vibration at {values.hz:.6g} Hz"
    return _joined(_commented(mark, _head(table, placed, of)), lines(table, values, placed))


def chosen(name: str, value: float | None, values: Sequence[float], unit: str) -> int:
    """Index of a value in a table; raises `InputError` for another, and for none where there are several."""
    listed = ", ".join(f"{one:.6g}" for one in values)
    if value is None:
        if len(values) == 1:
            return 0
        raise InputError(name, None, f"given, as the program takes one: {listed} {unit}")
    near = np.flatnonzero(np.isclose(values, value, rtol=1e-6, atol=1e-9))
    if not near.size:
        raise InputError(name, value, f"in the table: {listed} {unit}")
    return int(near[0])


def _head(table: BearingMatrices, placed: Placed, of: str) -> list[str]:
    return [
        f"{table.name}, load {load_words(table.load)} at {table.origin}, {of}".rstrip(", "),
        f"about {table.point_words}; means over a ball passage",
        *placed.frame(),
        f"units: {placed.unit_words}",
        f"signs: {SIGNS}",
        *(f"note: {words}" for words in table.reservations),
    ]


def _commented(mark: str, lines: Sequence[str]) -> list[str]:
    """Comments in ASCII, which is all that readers of input decks take."""
    plain = (line.translate(SPELLED).encode("ascii", "replace").decode() for line in lines)
    return [f"{mark} {line}".rstrip() for line in plain]


def _joined(*parts: Sequence[str]) -> str:
    return "\n".join(line for part in parts for line in part) + "\n"


def _entries(matrix: _Floats) -> Iterator[tuple[int, int, float]]:
    for row, column in zip(*np.nonzero(matrix), strict=True):
        yield int(row), int(column), float(matrix[row, column])


def _csv(table: BearingMatrices) -> str:
    units = {0: ("N/m", "N s/m"), 1: ("N", "N s"), 2: ("N m", "N m s")}  # by the number of rotations
    head = ["speed_rpm [rev/min]", "frequency [Hz]"]
    for n, letter in enumerate("KC"):
        head += [
            f"{letter}_{row}_{column} [{units[(i > 2) + (j > 2)][n]}]"
            for i, row in enumerate(SIX)
            for j, column in enumerate(SIX)
        ]
    rows = [
        ",".join(
            repr(float(value) + 0.0)
            for value in (speed, table.hz[m, k], *table.stiffness[m, k].ravel(), *table.damping[m, k].ravel())
        )
        for m, speed in enumerate(table.speed_rpm.tolist())
        for k in range(table.hz.shape[1])
    ]
    return _joined(_commented("#", _head(table, Placed(1, "m", "z"), "")), [",".join(head), *rows])


def _json(table: BearingMatrices) -> str:
    return json.dumps(table.to_dict(), indent=1) + "\n"


def _combi214(table: BearingMatrices, hz: float | None, placed: Placed) -> str:
    columns = [0 if row.size == 1 and hz is None else chosen("hz", hz, row.tolist(), "Hz") for row in table.hz]
    K, C = (
        placed.matrices(np.array([whole[m, k] for m, k in enumerate(columns)]))
        for whole in (table.stiffness, table.damping)
    )
    plane, (a, b) = {"z": (0, (0, 1)), "x": (1, (1, 2)), "y": (2, (0, 2))}[placed.shaft_along]
    places = {"11": (a, a), "22": (b, b), "12": (a, b), "21": (b, a)}
    names = [
        (letter + place, M[:, i, j]) for letter, M in (("K", K), ("C", C)) for place, (i, j) in places.items()
    ]
    speeds = table.speed_rpm * RPM_TO_RAD_S
    several = speeds.size > 1
    own = 2 * placed.node - 1
    if several:
        names = [(f"{name}_{placed.node}", values) for name, values in names]
    lines = [f"ET,{own},COMBI214", f"KEYOPT,{own},2,{plane}   ! plane {'XYZ'[a]}{'XYZ'[b]}"]
    for name, values in names if several else ():
        lines.append(f"*DIM,{name},TABLE,{speeds.size},1,1,OMEGS")
        lines += [
            f"{name}({n},0) = {speed!r} $ {name}({n},1) = {float(value)!r}"
            for n, (speed, value) in enumerate(zip(speeds.tolist(), values, strict=True), 1)
        ]
    shown = [f"%{name}%" if several else repr(float(values[0])) for name, values in names]
    lines += [
        f"R,{own},{','.join(shown[:6])}",
        f"RMORE,{','.join(shown[6:])}",
        f"! TYPE,{own} $ REAL,{own} $ E,{placed.node},<node of the housing>",
    ]
    of = "frequency of the vibration "
    of += "that of the shaft" if hz is None and several else f"{table.hz[0, columns[0]]:.6g} Hz"
    left = [
        "COMBI214 has two directions across the shaft; axial motion and tilts are left out"
        + (": OMEGS is the speed in rad/s" if several else f": {table.speed_rpm[0]:.6g} rev/min")
    ]
    return _joined(_commented("!", [*_head(table, placed, of), *left]), lines)


def _matrix27(table: BearingMatrices, values: Values, placed: Placed) -> list[str]:
    """C1 to C78, row by row: rows of node I first; node J is the housing."""
    if table.asymmetry > NOTED:
        warn_user(
            f"ansys-matrix27: {table.asymmetry:.2g} of K is not symmetric and left out; nastran-dmig and"
            " abaqus have it",
            OutsideValidityWarning,
        )
    lines = [f"! left out: what is not symmetric, {table.asymmetry:.2g} of K"]
    first = 2 * placed.node - 1
    for kind, (name, key, matrix) in enumerate((("stiffness", 4, values.K), ("damping", 5, values.C)), first):
        half = 0.5 * (matrix + matrix.T)
        upper = np.block([[half, -half], [-half, half]])[np.triu_indices(12)] + 0.0
        lines += [f"ET,{kind},MATRIX27   ! {name}", f"KEYOPT,{kind},2,0 $ KEYOPT,{kind},3,{key}"]
        for start in range(0, 78, 6):
            command = f"R,{kind}" if start == 0 else "RMORE"
            lines.append(",".join([command, *(repr(float(one)) for one in upper[start : start + 6])]))
        lines.append(f"! TYPE,{kind} $ REAL,{kind} $ E,{placed.node},<node of the housing, at the same place>")
    return lines


def _large(value: float) -> str:
    return f"{value:16.9E}".replace("E", "D") if value else f"{'0.0':>16}"


def _cbush(table: BearingMatrices, values: Values, placed: Placed) -> list[str]:
    lines = ["$ CBUSH has the diagonals alone: couplings between directions are left out; nastran-dmig has them"]
    lines += [
        f"CBUSH*  {placed.node:16d}{placed.node:16d}{placed.node:16d}",
        f"*       {'':48s}{0:16d}",
    ]  # to the ground, basic axes
    rows = [("K", np.diag(values.K)), ("B", np.diag(values.C))]
    fields = [field for letter, row in rows for field in (f"{letter:<16s}", *map(_large, row.tolist()), " " * 16)]
    fields = [f"{placed.node:16d}", *fields[:-1]]  # the flag of B opens a line: a field stays blank before it
    for start in range(0, len(fields), 4):
        line = "".join(fields[start : start + 4])
        lines.append(("PBUSH*  " if start == 0 else "*       ") + line)
    return lines


def _dmig(table: BearingMatrices, values: Values, placed: Placed) -> list[str]:
    stiffness, damping = (f"{letter}B{placed.node % DMIG_NODES}" for letter in "KB")
    lines = [f"$ in the case control section:  K2PP = {stiffness}  $  B2PP = {damping}"]
    for name, matrix in ((stiffness, values.K), (damping, values.C)):
        lines.append(f"DMIG    {name:<8s}{0:8d}{1:8d}{2:8d}{0:8d}")  # square, real in double precision
        for column in range(6):
            rows = [(row, value) for row, at, value in _entries(matrix) if at == column]
            if rows:
                lines.append(f"DMIG*   {name:<16s}{placed.node:16d}{column + 1:16d}")
            lines += [f"*       {placed.node:16d}{row + 1:16d}{_large(value)}" for row, value in rows]
    return lines


def _abaqus(table: BearingMatrices, values: Values, placed: Placed) -> list[str]:
    lines, stiffness, damping = [], f"K_BEARING_{placed.node}", f"C_BEARING_{placed.node}"
    for name, matrix in ((stiffness, values.K), (damping, values.C)):
        lines.append(f"*MATRIX INPUT, NAME={name}, TYPE=UNSYMMETRIC")
        lines += [f"{placed.node}, {i + 1}, {placed.node}, {j + 1}, {value!r}" for i, j, value in _entries(matrix)]
    return [*lines, f"*MATRIX ASSEMBLE, STIFFNESS={stiffness}, VISCOUS DAMPING={damping}"]


def _exudyn(table: BearingMatrices, values: Values, placed: Placed) -> list[str]:
    arrays = []
    for name, matrix in (("stiffness", values.K), ("damping", values.C)):
        rows = [f"    [{', '.join(map(repr, row))}]," for row in (matrix + 0.0).tolist()]
        arrays += [f"{name} = np.array([", *rows, "])"]
    return [
        "import numpy as np",
        "from exudyn.itemInterface import RigidBodySpringDamper",
        "",
        *arrays,
        "",
        "",
        "def bearing(housing_marker, shaft_marker):",
        '    """Pass to `mbs.AddObject`: markers of rigid bodies at the point, their axes along those above."""',
        "    return RigidBodySpringDamper(",
        "        markerNumbers=[housing_marker, shaft_marker], stiffness=stiffness, damping=damping",
        "    )",
    ]


def _links(table: BearingMatrices, values: Values, placed: Placed) -> list[str]:
    both = {(i, j) for matrix in (values.K, values.C) for i, j, _ in _entries(matrix)}
    n = placed.node
    rows = [
        f"{n} {ELSEWHERE[i]} {n} {ELSEWHERE[j]} {float(values.K[i, j])!r} {float(values.C[i, j])!r}"
        for i, j in sorted(both)
    ]
    return ["# node dof node dof k c: force on the first for motion of the second, against the ground", *rows]


WHOLE: dict[str, Callable[[BearingMatrices], str]] = {"csv": _csv, "json": _json}
SINGLE: dict[str, tuple[str, Callable[[BearingMatrices, Values, Placed], list[str]]]] = {
    "ansys-matrix27": ("!", _matrix27),
    "nastran-cbush": ("$", _cbush),
    "nastran-dmig": ("$", _dmig),
    "abaqus": ("**", _abaqus),
    "exudyn": ("#", _exudyn),
    "links": ("#", _links),
}
ENDINGS = {  # of files, by program
    "csv": "csv", "json": "json", "ansys-combi214": "mac", "ansys-matrix27": "mac", "nastran-cbush": "bdf",
    "nastran-dmig": "bdf", "abaqus": "inp", "exudyn": "py", "links": "txt",
}  # fmt: skip
PROGRAMS: tuple[Any, ...] = (*WHOLE, "ansys-combi214", *SINGLE)
