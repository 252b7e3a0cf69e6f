"""A shaft with its discs and supports as a `Rotor`."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import as_column, parts, require_flag
from ehlcontact.checks.kinds import Object, Objects
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from reduced_models.bearing.freedoms import facing_signs
from reduced_models.rotor.beam import matrices
from reduced_models.rotor.bearing_set import BearingSet
from reduced_models.rotor.nodes import DIRECTIONS, LENGTHS, PLANE
from reduced_models.rotor.parts import Disc, Shaft, Support
from reduced_models.rotor.rotor import Rotor, Unbalance
from reduced_models.rotor.supports import BearingMount

_Floats = NDArray[np.float64]

LEAST_SUPPORTS = 2  # planar bearings hold no tilt
SAME = 1e-6  # of the shaft's length: positions nearer than that are one


@takes(
    shaft=Object(Shaft, "a Shaft"),
    supports=Objects(Support, "a Support"),
    discs=Objects(Disc, "a Disc"),
    gravity=parts.GRAVITY,
)
def rotor_on_bearings(
    shaft: Shaft,
    *,
    supports: Sequence[Support],
    discs: Sequence[Disc] = (),
    gravity: tuple[float, ...] = (0.0, -9.81),
    axial: bool | None = None,
) -> Rotor:
    """Jeffcott's rotor and its relatives on ball bearings, which may differ: discs anywhere, beyond a bearing too.

    For `simulate_rotor`, at one speed or along a `SpeedProfile`, and for `linearise`, `campbell` and
    `unbalance_response`. Where discs and bearings are among the degrees of freedom, ``nodes`` of the rotor has:
    "disc" (or "disc 0", "disc 1", ...), "bearing 0", ..., "housing 0", ...; each with "x" and "y", and where it
    has inertia against tilting, "tilt_x" and "tilt_y", the angles about them.

    With axial motion ball bearings have five degrees of freedom: contact angles, axial forces and moments. The
    shaft, which is rigid along itself, has one displacement along z, that of the node "shaft"; housings, and outer
    rings that are free along the shaft ("outer ring 0", ...), have their own.

    Parameters
    ----------
    shaft : Shaft
        Without mass: its nodes between discs and bearings are left out, which is exact.
    supports : sequence of Support
        At least two, at different places; or one with a `BearingSet`, which holds tilts too: its bearings are
        so many of the rotor's mounts.
    discs : sequence of Disc
        None of a bare shaft with a mass of its own.
    gravity : (float, float) or (float, float, float)
        Acceleration [m/s2] along x, y and z; (0, 0, -9.81) of a rotor that stands upright.
    axial : bool, optional
        Axial motion; by default where an angular contact bearing, a facing, offset or preload of a support, or a
        load along z needs it.

    Returns
    -------
    Rotor

    Raises
    ------
    InputError
        A position beside the shaft, supports at one place, or a journal without any mass.
    """
    pull = np.zeros(3)
    pull[: np.size(gravity)] = as_column("gravity", gravity, size=3 if np.size(gravity) == 3 else 2)
    least = 1 if any(isinstance(support.bearing, BearingSet) for support in supports) else LEAST_SUPPORTS
    if len(supports) < least:
        raise InputError("number of supports", len(supports), f"at least {LEAST_SUPPORTS}, or one BearingSet")
    for name, places in (("discs", [d.position for d in discs]), ("supports", [s.position for s in supports])):
        for k, position in enumerate(places):
            if not -SAME * shaft.end <= position <= (1.0 + SAME) * shaft.end:
                raise InputError(f"{name}[{k}].position", position, f"between 0 and {shaft.end:g} m")
    needed = pull[2] != 0.0 or any(one.needs_axial for one in supports) or any(any(d.load[2:]) for d in discs)
    if axial is not None:
        require_flag("axial", axial)
        if needed and not axial:
            raise InputError("axial", axial, "True: a bearing or a load needs axial motion")
    if (needed or axial) and shaft.density == 0.0:
        raise InputError("shaft.density", 0.0, "> 0 with axial motion: bearings hold tilts, which need inertia")
    springs = [one.preload for one in supports]
    if None not in springs and not any(one.preload_stiffness for one in supports):
        allowed = "left out at one support at least: nothing holds a shaft whose outer rings are all free along it"
        raise InputError("preload", springs, allowed)
    return _Assembly(shaft, discs, supports, pull, needed if axial is None else axial).rotor()


class _Assembly:
    """Matrices of all nodes, each with x, y and the turns about x and y; then of housings, outer rings and z."""

    def __init__(
        self, shaft: Shaft, discs: Sequence[Disc], supports: Sequence[Support], gravity: _Floats, axial: bool
    ) -> None:
        self.shaft, self.discs, self.supports = shaft, discs, supports
        self.stations = shaft_stations(
            shaft, [*(disc.position for disc in discs), *(support.position for support in supports)]
        )
        held = [self._at(support.position) for support in supports]
        for k, node in enumerate(held):
            if node in held[:k]:
                raise InputError(f"supports[{k}].position", supports[k].position, "that of no other support")
        size = 4 * self.stations.size
        self.housings: dict[int, dict[str, int]] = {}
        self.outer_rings: dict[int, int] = {}
        for k, support in enumerate(supports):
            if support.housing_mass is not None:
                self.housings[k] = {name: size + i for i, name in enumerate(LENGTHS if axial else PLANE)}
                size += len(self.housings[k])
            elif support.spring is not None:
                self.outer_rings[k] = size
                size += 1
        self.z = size if axial else None
        size += axial
        self.M, self.K, self.G = np.zeros((3, size, size))
        self.damping: dict[str, _Floats] = {}  # by what damps
        self._add_shaft()
        self.load = np.zeros(size)
        for k, support in enumerate(supports):
            self._add_support(k, support)
        for name, disc in zip(self._disc_names(), discs, strict=True):
            self._add_disc(name, disc)
        for axis, pull in zip(LENGTHS, gravity.tolist(), strict=True):
            self.load += self.M @ self._uniform(axis) * pull

    def rotor(self) -> Rotor:
        """Without the degrees of freedom that have no mass."""
        kept = np.flatnonzero(np.diag(self.M) > 0.0)
        new = {int(old): k for k, old in enumerate(kept)}
        for k, support in enumerate(self.supports):
            if self._at(support.position) not in new:
                raise InputError(f"supports[{k}].journal_mass", 0.0, "> 0 on a shaft without mass")
        left = np.setdiff1d(np.arange(len(self.M)), kept)
        follow = -np.linalg.solve(self.K[np.ix_(left, left)], self.K[np.ix_(left, kept)])
        whole = np.zeros((len(self.M), kept.size))
        whole[kept], whole[left] = np.eye(kept.size), follow
        C = np.sum(list(self.damping.values()), axis=0)
        M, C, K, G = (np.asarray(whole.T @ matrix @ whole) for matrix in (self.M, C, self.K, self.G))
        by_part = {name: np.asarray(whole.T @ part @ whole) for name, part in self.damping.items()}
        if self.z is not None and self.shaft.density == 0.0:
            raise InputError(
                "shaft.density", 0.0, "> 0 with axial motion: bearings hold tilts, which need inertia"
            )
        nodes = self._nodes(new)
        return Rotor(
            mass=M,
            stiffness=0.5 * (K + K.T),
            damping=C,
            damping_by_part=by_part,
            gyroscopic=G,
            load=whole.T @ self.load,
            mounts=tuple(
                mount for k, support in enumerate(self.supports) for mount in self._mounts(k, support, nodes)
            ),
            unbalances=tuple(
                Unbalance(x=new[at], y=new[at + 1], amount=disc.unbalance, phase=disc.phase)
                for disc, at in ((disc, self._at(disc.position)) for disc in self.discs)
                if disc.unbalance > 0.0
            ),
            nodes=nodes,
        )

    def _at(self, position: float) -> int:
        """First degree of freedom of the node there."""
        return 4 * int(np.argmin(np.abs(self.stations - position)))

    def _disc_names(self) -> list[str]:
        """Of their nodes."""
        return ["disc"] if len(self.discs) == 1 else [f"disc {k}" for k in range(len(self.discs))]

    def _nodes(self, new: dict[int, int]) -> dict[str, dict[str, int]]:
        """Degrees of freedom by name; a node without inertia against tilting has no tilts."""
        places = {f"bearing {k}": self._at(support.position) for k, support in enumerate(self.supports)}
        discs = {name: self._at(disc.position) for name, disc in zip(self._disc_names(), self.discs, strict=True)}

        def on_shaft(at: int) -> dict[str, int]:
            return {name: new[at + k] for k, name in enumerate(DIRECTIONS) if at + k in new}

        nodes = {name: on_shaft(at) for name, at in places.items()}
        nodes |= {f"housing {k}": {name: new[at] for name, at in own.items()} for k, own in self.housings.items()}
        nodes |= {f"outer ring {k}": {"z": new[at]} for k, at in self.outer_rings.items()}
        nodes |= {name: on_shaft(at) for name, at in discs.items()}
        return nodes if self.z is None else nodes | {"shaft": {"z": new[self.z]}}

    def _mounts(self, k: int, support: Support, nodes: dict[str, dict[str, int]]) -> list[BearingMount]:
        node, housing = nodes[f"bearing {k}"], nodes.get(f"housing {k}")
        fixed: tuple[int | None, ...] | None = None if housing is None else tuple(housing.values())
        free = (None, None, nodes[f"outer ring {k}"]["z"]) if k in self.outer_rings else None
        axial = {} if self.z is None else {**nodes["shaft"], **node}
        mounts = [
            BearingMount(
                bearing=seat.bearing,
                x=node["x"],
                y=node["y"],
                z=axial.get("z"),
                tilt_x=axial.get("tilt_x"),
                tilt_y=axial.get("tilt_y"),
                housing=free if seat.slides else fixed,
                cage_angle=support.cage_angle,
                facing=seat.facing,
                offset=seat.offset,
                arm=seat.arm,
                name=f"bearing {k}" if len(support.seats) == 1 else f"bearing {j} of support {k}",
            )
            for j, seat in enumerate(support.seats)
        ]
        if support.damper is not None and housing is not None:
            mounts.append(BearingMount(bearing=support.damper, x=housing["x"], y=housing["y"], name=f"damper {k}"))
        return mounts

    def _add_shaft(self) -> None:
        for k, element in enumerate(self.shaft.shaft_elements(self.stations)):
            if self.z is not None:
                self.M[self.z, self.z] += element.mass
            places = np.ix_(range(4 * k, 4 * k + 8), range(4 * k, 4 * k + 8))
            for whole, part in zip((self.M, self.K, self.G), matrices(element), strict=True):
                whole[places] += part
        self.damping["shaft"] = self.shaft.damping_time * self.K

    def _add_support(self, k: int, support: Support) -> None:
        first = self._at(support.position)
        self.M[[first, first + 1], [first, first + 1]] += support.journal_mass
        if self.z is not None:
            self.M[self.z, self.z] += support.journal_mass
        if k in self.housings:
            places = list(self.housings[k].values())
            self.M[places, places] = support.housing_mass
            damping = self.damping.setdefault(f"housing {k}", np.zeros_like(self.M))
            for whole, values in ((self.K, support.housing_stiffness), (damping, support.housing_damping)):
                whole[places, places] = np.append(values, values[0])[: len(places)]  # z of two: as x
        if k in self.outer_rings:
            place = self.outer_rings[k]
            self.M[place, place], self.K[place, place] = support.ring_mass, support.preload_stiffness
            facing = next(seat.facing for seat in support.seats if seat.slides)
            self.load[place] -= facing_signs(facing)[2] * support.spring

    def _add_disc(self, name: str, disc: Disc) -> None:
        first = self._at(disc.position)
        places = list(range(first, first + 4))
        self.M[places, places] += [disc.mass, disc.mass, disc.diametral_inertia, disc.diametral_inertia]
        self.damping[name] = np.zeros_like(self.M)
        self.damping[name][[first, first + 1], [first, first + 1]] = disc.damping
        self.G[first + 2, first + 3] += disc.polar_inertia
        self.G[first + 3, first + 2] -= disc.polar_inertia
        self.load[[first, first + 1]] += disc.load[:2]
        if self.z is not None:
            self.M[self.z, self.z] += disc.mass
            self.load[self.z] += sum(disc.load[2:])

    def _uniform(self, axis: str) -> _Floats:
        """Everything displaced by one along an axis."""
        moved = np.zeros(len(self.M))
        if axis in PLANE:
            moved[PLANE.index(axis) : 4 * self.stations.size : 4] = 1.0
        elif self.z is not None:
            moved[self.z] = 1.0
        moved[[own[axis] for own in self.housings.values() if axis in own]] = 1.0
        if axis == "z":
            moved[list(self.outer_rings.values())] = 1.0
        return moved


def shaft_stations(shaft: Shaft, positions: Sequence[float]) -> _Floats:
    """Nodes: ends of sections, discs and supports, and between them as many as make the shaft's elements."""
    marks = np.sort(np.concatenate([[0.0], np.cumsum(shaft.length), np.clip(positions, 0.0, shaft.end)]))
    fixed = marks[np.concatenate([[True], np.diff(marks) > SAME * shaft.end])]
    parts = [ceil(gap / shaft.end * shaft.elements - SAME) for gap in np.diff(fixed).tolist()]
    between = [np.linspace(a, b, n + 1)[:-1] for a, b, n in zip(fixed[:-1], fixed[1:], parts, strict=True)]
    return np.concatenate([*between, fixed[-1:]])
