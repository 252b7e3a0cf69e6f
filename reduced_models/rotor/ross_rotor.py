"""Import of ROSS rotors (`from_ross`), and bearings as force callback in ROSS time integration (`RossCallback`).

ROSS: https://ross.readthedocs.io, 2.3 to 3.1.

Both have SI units, x and y across the shaft, y upwards, z along it, and a rotor that turns from x to y. ROSS
counts nodes, of six degrees of freedom each (x, y, z, turns about them), and has speeds in rad/s. The first five
are those of a bearing with axial motion and tilts.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, require_flag, require_instance, require_integer, shown
from ehlcontact.checks.frequency import is_given, one, radians_per_second
from ehlcontact.errors import InputError
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.freedoms import FACINGS, FIVE, PLANAR
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.motion import BearingMotion
from reduced_models.bearing.ross_bearing import (
    ELEMENT,
    WHIRL,
    has_whirl_axis,
    hold_ends,
    import_ross,
    name_of,
    ross_entries,
)
from reduced_models.rotor.bearing_set import BearingSet
from reduced_models.rotor.linearise import linearise
from reduced_models.rotor.nodes import DIRECTIONS, LENGTHS, PLANE
from reduced_models.rotor.parts import Support
from reduced_models.rotor.rotor import Rotor, Unbalance
from reduced_models.rotor.supports import BearingMount

_Floats = NDArray[np.float64]

# Degrees of freedom of a node of ROSS by their number, without torsion
ON_SHAFT = {4: DIRECTIONS, 6: FIVE}
UNCOUPLED = 1e-9  # entries that tie bending to the rest, over the largest: below is rounding
SAME_STEP = 1e-6  # relative: lengths of steps as differences of times
GRAVITY = 9.80665  # m/s2, standard gravity


def from_ross(
    rotor: Any,
    bearings: Mapping[int, BallBearing | BearingSet],
    *,
    facings: Mapping[int, str] | None = None,
    offsets: Mapping[int, float] | None = None,
    axial: bool | None = None,
    speed_rpm: float | None = None,
    loads: Mapping[int, ArrayLike] | None = None,
    unbalances: Mapping[int, Any] | None = None,
    gravity: bool = True,
    replace: bool = False,
    omega: float | None = None,
    hz: float | None = None,
    rpm: float | None = None,
) -> Rotor:
    """Rotor of ROSS on ball bearings, for `simulate_rotor` and `linearise`: its bending, or axial motion too.

    Degrees of freedom 4 n to 4 n + 3 of the result are x, y and the turns about them of node n of the shaft; with
    axial motion 5 n to 5 n + 4 are x, y, z and the turns about x and y. Then come those of nodes beside the shaft,
    which do not turn. Torsion is left out, and what ROSS has for a changing speed beside the gyroscopic matrix
    (`Ksdt`).

    Parameters
    ----------
    rotor : ross.Rotor
        Seals and other bearing elements of it stay, as they are at `speed_rpm` and, in ROSS 3, at the frequency of
        the whirl. Damping of its modes (ROSS 3) stays the matrix that it has there.
    bearings : mapping of int to BallBearing or BearingSet
        By node. The outer ring stands still, or moves with the node that a replaced element was linked to.
        Bearings of a set have the arms of their positions in it.
    facings : mapping of int to {"+z", "-z"}, optional
        By node, the direction in which the inner ring is pressed against the outer one, as of `Support`; by
        default "+z". A set has its own.
    offsets : mapping of int to float, optional
        By node, displacement of the inner ring along its facing beside that of the shaft [m], as of
        `Support`.
    axial : bool, optional
        Bearings with axial motion and tilts: five degrees of freedom. By default where an angular contact
        bearing, a set, a facing, an offset, or a load along z needs it.
    speed_rpm : float, optional
        Of the shaft [rev/min]; only needed where an element that stays changes with it.
    loads : mapping of int to tuple of float, optional
        Constant forces (Fx, Fy) [N] by node, beside the weight; with axial motion also (Fx, Fy, Fz), and on the
        shaft (Fx, Fy, Fz, Mx, My) [N], [N m].
    unbalances : mapping of int to float or (float, float), optional
        Mass times eccentricity [kg m], and phase [rad], by node.
    gravity : bool
        Whether the rotor has weight, in -y.
    replace : bool
        Whether bearing elements at those nodes make place.
    omega, hz, rpm : float, optional
        Frequency of the whirl, for tables of ROSS 3 over it; by default that of the shaft.

    Raises
    ------
    InputError
        ROSS is not installed; a node that is not there, or taken; a rotor whose bending is coupled to its torsion;
        a set on a spring.
    """
    ross = import_ross()
    supports = _supports(bearings, facings, offsets)
    nodes = _nodes(ross, rotor, supports, replace)
    five = _is_axial(rotor, supports, loads, axial)
    empty = {node: ross.BearingElement(n=node, kxx=0.0, cxx=0.0, n_link=linked) for node, linked in nodes.items()}
    bare = _rebuilt(ross, rotor, empty)  # with elements that hold nothing, so that all nodes stay
    point = _operating_point(ross, bare, speed_rpm, {"omega": omega, "hz": hz, "rpm": rpm})
    dofs = without_torsion(bare, five)
    M, C, G, K = _uncoupled((bare.M(*point), bare.C(*point), bare.G(), bare.K(*point)), dofs)
    upward = np.searchsorted(dofs, [_first(bare, node) + 1 for node in range(_count(bare))])
    load = np.asarray(-GRAVITY * M[:, upward].sum(axis=1) if gravity else np.zeros(dofs.size))

    def places(name: str, node: int) -> list[int]:
        _require_node(bare, name, node)
        own = [_first(bare, node) + k for k in _of_node(bare, node, five)]
        return [int(place) for place in np.searchsorted(dofs, own)]

    for node, force in (loads or {}).items():
        there = places("loads", node)
        sizes = [size for size in (2, 3, 5) if size <= (len(there) if five else len(PLANAR))]
        size = np.size(force)
        load[there[:size]] += as_column(f"loads[{node}]", force, size=size if size in sizes else sizes[-1])
    heavy = []
    for node, entry in (unbalances or {}).items():
        x, y = places("unbalances", node)[:2]
        amount, phase = entry if isinstance(entry, tuple | list) and len(entry) == 2 else (entry, 0.0)
        heavy.append(Unbalance(x=x, y=y, amount=amount, phase=phase))
    mounts: list[BearingMount] = []
    for node, linked in nodes.items():
        held: dict[str, Any] = dict(zip(FIVE if five else PLANE, places("bearings", node), strict=False))
        if linked is not None:
            held["housing"] = tuple(places("n_link", linked)[: len(LENGTHS if five else PLANE)])
        mounts += [
            BearingMount(bearing=seat.bearing, facing=seat.facing, offset=seat.offset, arm=seat.arm, **held)
            for seat in supports[node].seats
        ]
    return Rotor(
        mass=M, damping=C, gyroscopic=G, stiffness=K, load=load, mounts=tuple(mounts), unbalances=tuple(heavy)
    )


def _operating_point(
    ross: Any, rotor: Any, speed_rpm: float | None, frequency: Mapping[str, float | None]
) -> tuple[float, ...]:
    """Arguments of `rotor.K` [rad/s]: the speed in ROSS 2, frequency of the whirl and speed in ROSS 3."""
    w = (speed_rpm or 0.0) * RPM_TO_RAD_S
    both = has_whirl_axis(ross)
    if is_given(**frequency) and not both:
        name = name_of(frequency)
        raise InputError(name, frequency[name], "left out: before ROSS 3 tables are over the speed only")
    axes = ("speed", "frequency") if both else ("frequency",)
    for element in rotor.bearing_elements:
        tabled = [axis for axis in axes if getattr(element, axis, None) is not None]
        if speed_rpm is None and tabled and not (tabled == ["frequency"] and is_given(**frequency)):
            raise InputError("speed_rpm", None, f"given: the element at node {element.n} changes with it")
    if not both:
        return (w,)
    return (one(name_of(frequency), radians_per_second(None, **frequency)) if is_given(**frequency) else w), w


class RossCallback:
    """Ball bearings with film memory in ROSS's own Newmark steps: what `add_to_RHS` takes.

    ROSS evaluates such a force once per step, with the state at its start, so that only what a linear bearing
    leaves may stand there: `rotor` has the bearings' stiffness and damping about rest, and a call returns the rest
    of their force. ROSS starts from zeros, so displacements are counted from the equilibrium under weight and
    `loads`; in the forces given to ROSS is only what comes beside them, as unbalance::

        force = RossCallback(rotor, {1: bearing, 5: bearing}, speed_rpm=3000)
        found = force.rotor.run_time_response(force.speed, F, t, method="newmark", add_to_RHS=force)
        displacement = force.rest + found.yout

    So `weight=True`, which ROSS 2.3 ignores and ROSS 3 adds, would count the weight twice. Elements that stay have
    their coefficients at the speed of the shaft, and in ROSS 3 at its frequency. Steps have one length.
    `simulate_rotor` does the same with forces at the end of the step.

    Stiffness and damping are means over a ball passage: in ROSS 3 as tables over the frequency of the whirl, in
    ROSS 2 at the frequency of the shaft. What elements have no place for, tilts and their coupling with
    displacements, is in the matrices `K0` and `C0` of `rotor`, at the frequency of the shaft: all its analyses
    have it, its file does not.

    Parameters
    ----------
    rotor, bearings, facings, offsets, axial, speed_rpm, loads, gravity, replace
        As in `from_ross`.
    omega, hz, rpm : float, optional
        Frequency for stiffness and damping of the bearings in `rotor`: a frequency response at it has all five
        degrees of freedom exactly.

    Attributes
    ----------
    rotor : ross.Rotor
        With a `ross.BearingElement` in place of every bearing or set.
    speed : float
        Of the shaft [rad/s].
    rest : ndarray, shape (ndof,)
        Displacements in static equilibrium [m], [rad].
    """

    def __init__(
        self,
        rotor: Any,
        bearings: Mapping[int, BallBearing | BearingSet],
        *,
        speed_rpm: float,
        facings: Mapping[int, str] | None = None,
        offsets: Mapping[int, float] | None = None,
        axial: bool | None = None,
        loads: Mapping[int, ArrayLike] | None = None,
        gravity: bool = True,
        replace: bool = False,
        omega: float | None = None,
        hz: float | None = None,
        rpm: float | None = None,
    ) -> None:
        ross = import_ross()
        arranged: dict[str, Any] = {"facings": facings, "offsets": offsets}
        ours = from_ross(
            rotor, bearings, axial=axial, speed_rpm=speed_rpm, loads=loads, gravity=gravity, replace=replace,
            **arranged,
        )  # fmt: skip
        nodes = _nodes(ross, rotor, _supports(bearings, **arranged), replace)
        self.speed = speed_rpm * RPM_TO_RAD_S
        self._ours, self._rpm = ours, speed_rpm
        frequency = {"omega": omega, "hz": hz, "rpm": rpm}
        given = is_given(**frequency)
        own = one(name_of(frequency), radians_per_second(None, **frequency)) if given else self.speed
        tabled = has_whirl_axis(ross) and not given
        whirl = np.unique(np.append(WHIRL, own)) if tabled else np.array([own])
        here = int(np.searchsorted(whirl, own))
        at = linearise(ours, speed_rpm)
        linear = [balls.coefficients(whirl) for balls in at.balls]
        self._linear = [(K[here], C[here]) for K, C in linear]
        whole = dict(zip(nodes, _by_node(ours, linear), strict=True))
        axis = {"frequency": whirl} if tabled else {}
        elements = {
            node: ross.BearingElement(n=node, n_link=linked, **ross_entries(*whole[node]), **axis)
            for node, linked in nodes.items()
        }
        for node, element in elements.items():
            hold_ends(element, axis, "speed", f"bearing at node {node}")
        self.rotor = _rebuilt(ross, rotor, elements)
        if self.rotor.rated_w is None:
            self.rotor.rated_w = self.speed  # that of `run_level1`
        for node, linked in nodes.items():
            _add_couplings(self.rotor, node, linked, *(part[here] for part in whole[node]))
        five = len(ours.ball_bearings[0].directions) == len(FIVE)
        dofs = without_torsion(self.rotor, five)
        rows = np.concatenate([mount.rows(ours.size) for mount in ours.ball_bearings])
        self._rings = np.zeros((len(rows), self.rotor.ndof))
        self._rings[:, dofs] = rows
        self._shift = np.concatenate([mount.shift for mount in ours.ball_bearings])
        self.rest = np.zeros(self.rotor.ndof)
        self.rest[dofs] = at.rest
        self._motions: list[BearingMotion] = []
        self._still: list[_Floats] = []
        self._forces: list[_Floats] = []
        self._step, self._dt = 0, 0.0

    @property
    def force(self) -> _Floats:
        """Force of the rings on the balls in every step so far, shape (steps, bearings, n) [N], [N m].

        n is 2, or 5 with axial motion, in the frame of each bearing; those of a set follow each other.
        """
        return np.array(self._forces)

    def __call__(
        self,
        step: int,
        time_step: float,
        disp_resp: _Floats,
        velc_resp: _Floats,
        accl_resp: _Floats | None = None,
        **_: Any,
    ) -> _Floats:
        """Forces of the bearings beyond those of their linear elements, shape (ndof,) [N].

        Raises
        ------
        InputError
            A step of another length.
        ConvergenceError
            A ball finds no balance.
        """
        if not self._motions or step < self._step:
            self._begin(step, float(time_step))
        elif step > self._step:
            for motion in self._motions:
                motion.accept()
            self._step = step
            self._forces.append(self._forces[-1])
        if abs(time_step - self._dt) > SAME_STEP * self._dt:
            raise InputError("time_step", float(time_step), f"{self._dt:g} s, as the first: films need even steps")
        away, rate = self._rings @ disp_resp, self._rings @ velc_resp
        held, beyond = self._held, np.zeros(away.size)
        pushed = np.zeros((len(self._motions), away.size // len(self._motions)))
        for b, (motion, still, (k, c)) in enumerate(zip(self._motions, self._still, self._linear, strict=True)):
            i = self._ours.ball_columns[b]
            pushed[b] = motion.forces(held[i] + away[i], rate[i])[0]
            beyond[i] = pushed[b] - still - k @ away[i] - c @ rate[i]
        self._forces[-1] = pushed
        return np.asarray(-self._rings.T @ beyond)

    @property
    def _held(self) -> _Floats:
        """Displacements of all inner rings in static equilibrium."""
        return np.asarray(self._rings @ self.rest + self._shift)

    def _begin(self, step: int, dt: float) -> None:
        self._step, self._dt, self._forces = step, dt, [np.zeros(0)]
        self._motions = [
            BearingMotion(m.ball_bearing, self._rpm, dt, m.cage_angle, m.directions)
            for m in self._ours.ball_bearings
        ]
        held = zip(self._motions, self._ours.ball_columns, strict=True)
        self._still = [motion.rest(self._held[at]) for motion, at in held]


def without_torsion(rotor: Any, axial: bool) -> NDArray[np.int64]:
    """Indices of x, y (, z) and the turns about x and y, node by node, among all degrees of freedom of a rotor."""
    return np.concatenate(
        [_first(rotor, node) + np.array(_of_node(rotor, node, axial)) for node in range(_count(rotor))]
    )


def _of_node(rotor: Any, node: int, axial: bool) -> list[int]:
    """Indices of those of a node, counted from its x; nodes beside the shaft do not turn."""
    names = ON_SHAFT[int(rotor.number_dof)]
    wanted: tuple[str, ...] = FIVE if axial else DIRECTIONS
    if node >= len(rotor.nodes):
        wanted = LENGTHS if axial else PLANE
    return [names.index(name) for name in wanted]


def _count(rotor: Any) -> int:
    """Number of nodes: those of the shaft, then masses that bearings are linked to, which do not turn."""
    per_node, shaft = int(rotor.number_dof), len(rotor.nodes)
    return shaft + 2 * (int(rotor.ndof) - per_node * shaft) // per_node


def _first(rotor: Any, node: int) -> int:
    """Index of the x of a node, among all degrees of freedom."""
    per_node, shaft = int(rotor.number_dof), len(rotor.nodes)
    return per_node * min(node, shaft) + per_node // 2 * max(node - shaft, 0)


def _uncoupled(matrices: tuple[_Floats, ...], dofs: NDArray[np.int64]) -> list[_Floats]:
    """Rows and columns of `dofs`; they must hang together with no others."""
    others = np.setdiff1d(np.arange(len(matrices[0])), dofs)
    for matrix in matrices:
        ties = np.abs(np.concatenate([matrix[np.ix_(dofs, others)], matrix[np.ix_(others, dofs)].T]))
        if ties.max(initial=0.0) > UNCOUPLED * np.abs(matrix).max():
            raise InputError("rotor", "one whose bending is coupled to torsion", "one without gears or the like")
    return [np.asarray(matrix[np.ix_(dofs, dofs)], np.float64) for matrix in matrices]


def _require_node(rotor: Any, name: str, node: Any) -> None:
    allowed = f"a node of the rotor, 0 to {_count(rotor) - 1}"
    if require_integer(f"node of {name}", node, allowed, 0) >= _count(rotor):
        raise InputError(f"node of {name}", node, allowed)


def _supports(
    bearings: Mapping[int, BallBearing | BearingSet],
    facings: Mapping[int, str] | None,
    offsets: Mapping[int, float] | None,
) -> dict[int, Support]:
    """Bearings by node, with what `Support` checks of them; its position counts nothing here."""
    if not isinstance(bearings, Mapping) or not bearings:
        raise InputError("bearings", bearings, "{node: BallBearing}, at least one")
    for name, entries in (("facings", facings), ("offsets", offsets)):
        for node in entries or {}:
            if node not in bearings:
                raise InputError(f"node of {name}", node, f"one with a bearing: {', '.join(map(str, bearings))}")
    supports = {}
    for node, bearing in bearings.items():
        if not isinstance(bearing, BearingSet):
            require_instance(f"bearings[{node}]", bearing, BallBearing, "a BallBearing or BearingSet")
        facing, offset = (facings or {}).get(node, FACINGS[0]), (offsets or {}).get(node, 0.0)
        supports[node] = Support(position=0.0, bearing=bearing, facing=facing, offset=offset)
        if supports[node].spring is not None:
            allowed = "one of offsets; an outer ring on a spring is a point mass: a node with an element to it"
            raise InputError(f"bearings[{node}]", "a set on a spring", allowed)
    return supports


def _is_axial(
    rotor: Any, supports: Mapping[int, Support], loads: Mapping[int, ArrayLike] | None, axial: bool | None
) -> bool:
    """Whether bearings have five degrees of freedom."""
    needed = any(support.needs_axial for support in supports.values())
    needed = needed or any(np.size(force) > len(PLANAR) for force in (loads or {}).values())
    if axial is not None:
        require_flag("axial", axial)
        if needed and not axial:
            raise InputError("axial", axial, "True: a bearing or a load needs axial motion")
    five = bool(needed if axial is None else axial)
    if five and ON_SHAFT[int(rotor.number_dof)] != FIVE:
        raise InputError("rotor", "nodes without axial motion", "one with six degrees of freedom at a node")
    return five


def _by_node(ours: Rotor, linear: Sequence[tuple[_Floats, _Floats]]) -> list[tuple[_Floats, _Floats]]:
    """Stiffness and damping of all bearings of a node in its own degrees of freedom, shapes (k, n, n)."""
    by_place: dict[Any, tuple[_Floats, _Floats]] = {}
    for mount, (k, c) in zip(ours.ball_bearings, linear, strict=True):
        shaft = mount.ends[0]
        rows = mount.rows(ours.size)[:, np.array(shaft, np.int64)]
        K, C = by_place.get(shaft, (np.zeros((1, len(shaft), len(shaft))),) * 2)
        by_place[shaft] = K + rows.T @ k @ rows, C + rows.T @ c @ rows
    return list(by_place.values())


def _add_couplings(rotor: Any, node: int, linked: int | None, K: _Floats, C: _Floats) -> None:
    """Add to `K0` and `C0` of a rotor of ROSS what its elements have no place for at a node, of shape (n, n)."""
    for name, matrix in (("K0", K), ("C0", C)):
        n = len(matrix)
        rows = np.zeros((n, rotor.ndof))
        rows[range(n), _first(rotor, node) + np.arange(n)] = 1.0
        if linked is not None:
            lengths = min(n, len(LENGTHS))
            rows[range(lengths), _first(rotor, linked) + np.arange(lengths)] = -1.0
        beyond = matrix.copy()
        for place in ELEMENT:
            axes = tuple(FIVE.index(axis) for axis in place)
            if max(axes) < n:
                beyond[axes] = 0.0
        setattr(rotor, name, getattr(rotor, name) + rows.T @ beyond @ rows)


def _nodes(ross: Any, rotor: Any, supports: Mapping[int, Support], replace: bool) -> dict[int, int | None]:
    """Nodes of the bearings, and what those that they replace were linked to."""
    if type(rotor) is not ross.Rotor:
        raise InputError("rotor", shown(rotor), "a ross.Rotor, one shaft")
    linked_nodes: dict[int, int | None] = {}
    for node in supports:
        _require_node(rotor, "bearings", node)
        there = _at(rotor, node)
        if there and not replace:
            allowed = f"free: a {type(there[0]).__name__} is there; replace=True puts the bearing in its place"
            raise InputError("node of bearings", node, allowed)
        linked_nodes[int(node)] = next((e.n_link for e in there if e.n_link is not None), None)
    return linked_nodes


def _at(rotor: Any, node: int) -> list[Any]:
    """Bearing elements at a node; seals, which ROSS derives from them, are none."""
    elements = [e for e in rotor.bearing_elements if e.n == node]
    return [e for e in elements if "SealElement" not in [kind.__name__ for kind in type(e).__mro__]]


def _rebuilt(ross: Any, rotor: Any, elements: Mapping[int, Any]) -> Any:
    """The rotor with these elements in place of those at their nodes."""
    gone = {id(e) for node in elements for e in _at(rotor, node)}
    kept = [e for e in rotor.bearing_elements if id(e) not in gone]
    for k, element in enumerate(elements.values()):
        element.tag = f"EHL {k}"
    names = ("min_w", "max_w", "rated_w", "motor_element", "alpha", "beta")  # the last three from ROSS 3 on
    options = {name: getattr(rotor, name) for name in names if hasattr(rotor, name)}
    parts = rotor.shaft_elements, rotor.disk_elements, [*kept, *elements.values()], rotor.point_mass_elements
    rebuilt = ross.Rotor(*parts, **options, tag=rotor.tag)
    # Damping of modes (ROSS 3, as a complex matrix) is of those with the bearings that the rotor has.
    rebuilt.C0 = rotor.C0.real.copy()
    return rebuilt
