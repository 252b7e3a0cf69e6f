"""A shaft with its discs and supports as a `Rotor`."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import as_column, require_instance
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from reduced_models.rotor.beam import matrices
from reduced_models.rotor.nodes import DIRECTIONS, PLANE
from reduced_models.rotor.parts import Disc, Shaft, Support
from reduced_models.rotor.rotor import Rotor, Unbalance
from reduced_models.rotor.supports import BearingMount

_Floats = NDArray[np.float64]

LEAST_SUPPORTS = 2  # planar bearings hold no tilt
SAME = 1e-6  # of the shaft's length: positions nearer than that are one


@takes(gravity="m/s2")
def rotor_on_bearings(
    shaft: Shaft,
    *,
    supports: Sequence[Support],
    discs: Sequence[Disc] = (),
    gravity: tuple[float, float] = (0.0, -9.81),
) -> Rotor:
    """Jeffcott's rotor and its relatives on ball bearings, which may differ: discs anywhere, beyond a bearing too.

    For `simulate_rotor`, at one speed or along a `SpeedProfile`, and for `linearise`, `campbell` and
    `unbalance_response`. Where discs and bearings are among the degrees of freedom, ``nodes`` of the rotor has:
    "disc" (or "disc 0", "disc 1", ...), "bearing 0", ..., "housing 0", ...; each with "x" and "y", and where it
    has inertia against tilting, "tilt_x" and "tilt_y", the angles about them.

    Parameters
    ----------
    shaft : Shaft
        Without mass: its nodes between discs and bearings are left out, which is exact.
    supports : sequence of Support
        At least two, at different places.
    discs : sequence of Disc
        None of a bare shaft with a mass of its own.
    gravity : (float, float)
        Acceleration [m/s2] along x and y; (0, 0) of a rotor that stands upright.

    Returns
    -------
    Rotor

    Raises
    ------
    InputError
        A position beside the shaft, supports at one place, or a journal without any mass.
    """
    require_instance("shaft", shaft, Shaft, "a Shaft")
    pull = as_column("gravity", gravity, size=2)
    if len(supports) < LEAST_SUPPORTS:
        raise InputError("number of supports", len(supports), f"at least {LEAST_SUPPORTS}")
    for k, disc in enumerate(discs):
        require_instance(f"discs[{k}]", disc, Disc, "a Disc")
    for k, support in enumerate(supports):
        require_instance(f"supports[{k}]", support, Support, "a Support")
    for name, parts in (("discs", [d.position for d in discs]), ("supports", [s.position for s in supports])):
        for k, position in enumerate(parts):
            if not -SAME * shaft.end <= position <= (1.0 + SAME) * shaft.end:
                raise InputError(f"{name}[{k}].position", position, f"between 0 and {shaft.end:g} m")
    return _Assembly(shaft, discs, supports, pull).rotor()


class _Assembly:
    """Matrices of all nodes, each with x, y and the turns about x and y; then housings."""

    def __init__(self, shaft: Shaft, discs: Sequence[Disc], supports: Sequence[Support], gravity: _Floats) -> None:
        self.shaft, self.discs, self.supports = shaft, discs, supports
        self.stations = _stations(
            shaft, [*(disc.position for disc in discs), *(support.position for support in supports)]
        )
        held = [self._at(support.position) for support in supports]
        for k, node in enumerate(held):
            if node in held[:k]:
                raise InputError(f"supports[{k}].position", supports[k].position, "that of no other support")
        housed = [k for k, support in enumerate(supports) if support.housing_mass is not None]
        nodes = 4 * self.stations.size
        self.housings = {k: nodes + 2 * i for i, k in enumerate(housed)}
        size = nodes + 2 * len(housed)
        self.M, self.C, self.K, self.G = np.zeros((4, size, size))
        self._add_shaft()
        self.load = np.zeros(size)
        for k, support in enumerate(supports):
            self._add_support(k, support)
        for disc in discs:
            self._add_disc(disc)
        for axis in (0, 1):
            self.load += self.M @ self._uniform(axis) * gravity[axis]

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
        M, C, K, G = (np.asarray(whole.T @ matrix @ whole) for matrix in (self.M, self.C, self.K, self.G))
        nodes = {name: self._named(new, at) for name, at in self._places().items()}
        return Rotor(
            mass=M,
            stiffness=0.5 * (K + K.T),
            damping=C,
            gyroscopic=G,
            load=whole.T @ self.load,
            mounts=tuple(self._mount(k, support, nodes) for k, support in enumerate(self.supports)),
            unbalances=tuple(
                Unbalance(x=new[at], y=new[at + 1], amount=disc.unbalance, phase=disc.phase)
                for disc, at in ((disc, self._at(disc.position)) for disc in self.discs)
                if disc.unbalance > 0.0
            ),
            nodes=nodes,
        )

    def _named(self, new: dict[int, int], at: int) -> dict[str, int]:
        """Degrees of freedom of the node whose first one is `at`; a housing does not tilt, nor a massless node."""
        count = len(PLANE) if at >= 4 * self.stations.size else len(DIRECTIONS)
        return {name: new[at + k] for k, name in enumerate(DIRECTIONS[:count]) if at + k in new}

    def _at(self, position: float) -> int:
        """First degree of freedom of the node there."""
        return 4 * int(np.argmin(np.abs(self.stations - position)))

    def _places(self) -> dict[str, int]:
        found = {f"bearing {k}": self._at(one.position) for k, one in enumerate(self.supports)}
        found |= {f"housing {k}": at for k, at in self.housings.items()}
        named = ["disc"] if len(self.discs) == 1 else [f"disc {k}" for k in range(len(self.discs))]
        return found | {name: self._at(disc.position) for name, disc in zip(named, self.discs, strict=True)}

    @staticmethod
    def _mount(k: int, support: Support, nodes: dict[str, dict[str, int]]) -> BearingMount:
        housing = nodes.get(f"housing {k}")
        pair = None if housing is None else (housing["x"], housing["y"])
        place = {name: nodes[f"bearing {k}"][name] for name in PLANE}
        return BearingMount(bearing=support.bearing, housing=pair, cage_angle=support.cage_angle, **place)

    def _add_shaft(self) -> None:
        for k, piece in enumerate(self.shaft.pieces(self.stations)):
            at = np.ix_(range(4 * k, 4 * k + 8), range(4 * k, 4 * k + 8))
            for whole, part in zip((self.M, self.K, self.G), matrices(piece), strict=True):
                whole[at] += part
        self.C += self.shaft.damping_time * self.K

    def _add_support(self, k: int, support: Support) -> None:
        at = self._at(support.position)
        self.M[[at, at + 1], [at, at + 1]] += support.journal_mass
        if k in self.housings:
            pair = [self.housings[k], self.housings[k] + 1]
            self.M[pair, pair] = support.housing_mass
            self.K[pair, pair], self.C[pair, pair] = support.housing_stiffness, support.housing_damping

    def _add_disc(self, disc: Disc) -> None:
        at = self._at(disc.position)
        places = list(range(at, at + 4))
        self.M[places, places] += [disc.mass, disc.mass, disc.diametral_inertia, disc.diametral_inertia]
        self.C[[at, at + 1], [at, at + 1]] += disc.damping
        self.G[at + 2, at + 3] += disc.polar_inertia
        self.G[at + 3, at + 2] -= disc.polar_inertia
        self.load[[at, at + 1]] += disc.load

    def _uniform(self, axis: int) -> _Floats:
        """Everything displaced by one along x or y."""
        moved = np.zeros(len(self.M))
        moved[axis : 4 * self.stations.size : 4] = 1.0
        moved[4 * self.stations.size + axis :: 2] = 1.0
        return moved


def _stations(shaft: Shaft, positions: Sequence[float]) -> _Floats:
    """Nodes: ends of sections, discs and supports, and between them as many as make the shaft's elements."""
    given = np.sort(np.concatenate([[0.0], np.cumsum(shaft.length), np.clip(positions, 0.0, shaft.end)]))
    fixed = given[np.concatenate([[True], np.diff(given) > SAME * shaft.end])]
    parts = [ceil(gap / shaft.end * shaft.elements - SAME) for gap in np.diff(fixed).tolist()]
    between = [np.linspace(a, b, n + 1)[:-1] for a, b, n in zip(fixed[:-1], fixed[1:], parts, strict=True)]
    return np.concatenate([*between, fixed[-1:]])
