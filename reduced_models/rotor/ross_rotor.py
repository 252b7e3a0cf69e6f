"""Rotors of ROSS on our bearings, and our bearings in its time steps: https://ross.readthedocs.io, 2.3 to 3.1.

Both have SI units, x and y across the shaft, y upwards, and a rotor that turns from x to y. ROSS counts nodes, of
six degrees of freedom each (x, y, z, turns about them), and has speeds in rad/s.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.constants import g

from ehlcontact.checks import as_column, require_instance, require_integer
from ehlcontact.checks.frequency import is_given, one, radians_per_second
from ehlcontact.errors import InputError
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.kinematics import RADIANS
from reduced_models.bearing.motion import BearingMotion
from reduced_models.bearing.ross_bearing import has_whirl_axis, import_ross, name_of, ross_entries
from reduced_models.rotor.rotor import Rotor, Unbalance
from reduced_models.rotor.supports import BearingMount

_Floats = NDArray[np.float64]

LATERAL = {
    4: (0, 1, 2, 3),
    6: (0, 1, 3, 4),
}  # of the degrees of freedom of a node, by their number: x, y, two turns
UNCOUPLED = 1e-9  # entries that tie bending to the rest, over the largest: below is rounding
SAME_STEP = 1e-6  # relative: lengths of steps as differences of times


def from_ross(
    rotor: Any,
    bearings: Mapping[int, BallBearing],
    *,
    speed_rpm: float | None = None,
    loads: Mapping[int, ArrayLike] | None = None,
    unbalances: Mapping[int, Any] | None = None,
    gravity: bool = True,
    replace: bool = False,
    omega: float | None = None,
    hz: float | None = None,
    rpm: float | None = None,
) -> Rotor:
    """Bending of a rotor of ROSS on ball bearings, for `simulate_rotor`.

    Degrees of freedom 4 n to 4 n + 3 of the result are x, y and the turns about them of node n of the shaft. What
    ROSS has for a changing speed beside the gyroscopic matrix (`Ksdt`) is left out.

    Parameters
    ----------
    rotor : ross.Rotor
        Seals and other bearing elements of it stay, as they are at `speed_rpm` and, in ROSS 3, at the frequency of
        the whirl. Damping of its modes (ROSS 3) stays the matrix that it has there.
    bearings : mapping of int to BallBearing
        By node. The outer ring stands still, or moves with the node that a replaced element was linked to.
    speed_rpm : float, optional
        Of the shaft [rev/min]; only needed where an element that stays changes with it.
    loads : mapping of int to (float, float), optional
        Constant forces (Fx, Fy) [N] by node, beside the weight.
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
        ROSS is not installed; a node that is not there, or taken; a rotor whose bending is coupled to its torsion.
    """
    ross = import_ross()
    nodes = _nodes(ross, rotor, bearings, replace)
    empty = {node: ross.BearingElement(n=node, kxx=0.0, cxx=0.0, n_link=linked) for node, linked in nodes.items()}
    bare = _rebuilt(ross, rotor, empty)  # with elements that hold nothing, so that all nodes stay
    at = _operating_point(ross, bare, speed_rpm, {"omega": omega, "hz": hz, "rpm": rpm})
    dofs = bending(bare)
    M, C, G, K = _lateral((bare.M(*at), bare.C(*at), bare.G(), bare.K(*at)), dofs)
    upward = np.searchsorted(dofs, [_first(bare, node) + 1 for node in range(_count(bare))])
    load = np.asarray(-g * M[:, upward].sum(axis=1) if gravity else np.zeros(dofs.size))

    def pair(name: str, node: int) -> tuple[int, int]:
        _require_node(bare, name, node)
        x = int(np.searchsorted(dofs, _first(bare, node)))
        return x, x + 1

    for node, force in (loads or {}).items():
        load[list(pair("loads", node))] += as_column(f"loads[{node}]", force, size=2)
    heavy = []
    for node, given in (unbalances or {}).items():
        x, y = pair("unbalances", node)
        amount, phase = given if isinstance(given, tuple | list) and len(given) == 2 else (given, 0.0)
        heavy.append(Unbalance(x=x, y=y, amount=amount, phase=phase))
    mounts = []
    for node, linked in nodes.items():
        x, y = pair("bearings", node)
        housing = None if linked is None else pair("n_link", linked)
        mounts.append(BearingMount(bearing=bearings[node], x=x, y=y, housing=housing))
    return Rotor(
        mass=M, damping=C, gyroscopic=G, stiffness=K, load=load, mounts=tuple(mounts), unbalances=tuple(heavy)
    )


def _operating_point(
    ross: Any, rotor: Any, speed_rpm: float | None, frequency: Mapping[str, float | None]
) -> tuple[float, ...]:
    """What `rotor.K` takes [rad/s]: the speed in ROSS 2, frequency of the whirl and speed in ROSS 3."""
    w = (speed_rpm or 0.0) * RADIANS
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

    Parameters
    ----------
    rotor, bearings, speed_rpm, loads, gravity, replace
        As in `from_ross`.

    Attributes
    ----------
    rotor : ross.Rotor
        With a `ross.BearingElement` in place of every bearing.
    speed : float
        Of the shaft [rad/s].
    rest : ndarray, shape (ndof,)
        Displacements at rest [m], [rad].
    """

    def __init__(
        self,
        rotor: Any,
        bearings: Mapping[int, BallBearing],
        *,
        speed_rpm: float,
        loads: Mapping[int, ArrayLike] | None = None,
        gravity: bool = True,
        replace: bool = False,
    ) -> None:
        ross = import_ross()
        ours = from_ross(rotor, bearings, speed_rpm=speed_rpm, loads=loads, gravity=gravity, replace=replace)
        nodes = _nodes(ross, rotor, bearings, replace)
        self.speed = speed_rpm * RADIANS
        self._ours, self._rpm = ours, speed_rpm
        rest = ours.equilibrium(speed_rpm)
        reaction = ours.load - ours.stiffness @ rest
        self._linear, elements = [], {}
        for mount, (node, linked) in zip(ours.ball_bearings, nodes.items(), strict=True):
            force = reaction[[mount.x, mount.y]]
            found = mount.ball_bearing.coefficients(force, speed_rpm=speed_rpm, rpm=speed_rpm)
            elements[node] = ross.BearingElement(
                n=node, n_link=linked, **ross_entries(found.stiffness, found.damping)
            )
            self._linear.append((found.stiffness[0], found.damping[0]))
        self.rotor = _rebuilt(ross, rotor, elements)
        self._rings = _rings_in(self.rotor, nodes)
        self.rest = np.zeros(self.rotor.ndof)
        self.rest[bending(self.rotor)] = rest
        self._motions: list[BearingMotion] = []
        self._still: list[_Floats] = []
        self._forces: list[_Floats] = []
        self._step, self._dt = 0, 0.0

    @property
    def force(self) -> _Floats:
        """Force of the rings on the balls in every step so far, shape (steps, bearings, 2) [N]."""
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
        """What the bearings push beyond their linear elements, shape (ndof,) [N].

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
        held, beyond = self._rings @ self.rest, np.zeros(away.size)
        pushed = np.zeros((len(self._motions), 2))
        for b, (motion, still, (k, c)) in enumerate(zip(self._motions, self._still, self._linear, strict=True)):
            i = slice(2 * b, 2 * b + 2)
            pushed[b] = motion.forces(held[i] + away[i], rate[i])[0]
            beyond[i] = pushed[b] - still - k @ away[i] - c @ rate[i]
        self._forces[-1] = pushed
        return np.asarray(-self._rings.T @ beyond)

    def _begin(self, step: int, dt: float) -> None:
        held = self._rings @ self.rest
        self._step, self._dt, self._forces = step, dt, [np.zeros(0)]
        self._motions = [
            BearingMotion(m.ball_bearing, self._rpm, dt, m.cage_angle) for m in self._ours.ball_bearings
        ]
        self._still = [motion.rest(held[2 * b : 2 * b + 2]) for b, motion in enumerate(self._motions)]


def bending(rotor: Any) -> NDArray[np.int64]:
    """Indices of x, y and the turns about them, node by node, among all degrees of freedom of a rotor of ROSS."""
    on_shaft = LATERAL[int(rotor.number_dof)]
    return np.concatenate(
        [
            _first(rotor, node) + np.array(on_shaft if node < len(rotor.nodes) else on_shaft[:2])
            for node in range(_count(rotor))
        ]
    )


def _count(rotor: Any) -> int:
    """Number of nodes: those of the shaft, then masses that bearings are linked to, which do not turn."""
    per_node, shaft = int(rotor.number_dof), len(rotor.nodes)
    return shaft + 2 * (int(rotor.ndof) - per_node * shaft) // per_node


def _first(rotor: Any, node: int) -> int:
    """Index of the x of a node, among all degrees of freedom."""
    per_node, shaft = int(rotor.number_dof), len(rotor.nodes)
    return per_node * min(node, shaft) + per_node // 2 * max(node - shaft, 0)


def _lateral(matrices: tuple[_Floats, ...], dofs: NDArray[np.int64]) -> list[_Floats]:
    """The rows and columns of bending; they must hang together with no others."""
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


def _nodes(ross: Any, rotor: Any, bearings: Mapping[int, BallBearing], replace: bool) -> dict[int, int | None]:
    """Nodes of the bearings, and what those that they replace were linked to."""
    if type(rotor) is not ross.Rotor:
        raise InputError("rotor", type(rotor).__name__, "a ross.Rotor, one shaft")
    if not isinstance(bearings, Mapping) or not bearings:
        raise InputError("bearings", bearings, "{node: BallBearing}, at least one")
    found: dict[int, int | None] = {}
    for node, bearing in bearings.items():
        _require_node(rotor, "bearings", node)
        require_instance(f"bearings[{node}]", bearing, BallBearing, "a BallBearing")
        there = _at(rotor, node)
        if there and not replace:
            allowed = f"free: a {type(there[0]).__name__} is there; replace=True puts the bearing in its place"
            raise InputError("node of bearings", node, allowed)
        found[int(node)] = next((e.n_link for e in there if e.n_link is not None), None)
    return found


def _at(rotor: Any, node: int) -> list[Any]:
    """Bearing elements at a node; seals, which ROSS derives from them, are none."""
    found = [e for e in rotor.bearing_elements if e.n == node]
    return [e for e in found if "SealElement" not in [kind.__name__ for kind in type(e).__mro__]]


def _rebuilt(ross: Any, rotor: Any, elements: Mapping[int, Any]) -> Any:
    """The rotor with these elements in place of those at their nodes."""
    gone = {id(e) for node in elements for e in _at(rotor, node)}
    kept = [e for e in rotor.bearing_elements if id(e) not in gone]
    for k, element in enumerate(elements.values()):
        element.tag = f"EHL {k}"
    names = ("min_w", "max_w", "rated_w", "motor_element", "alpha", "beta")  # the last three from ROSS 3 on
    options = {name: getattr(rotor, name) for name in names if hasattr(rotor, name)}
    parts = rotor.shaft_elements, rotor.disk_elements, [*kept, *elements.values()], rotor.point_mass_elements
    found = ross.Rotor(*parts, **options, tag=rotor.tag)
    # Damping of modes (ROSS 3, as a complex matrix) is of those with the bearings that the rotor has.
    found.C0 = rotor.C0.real.copy()
    return found


def _rings_in(rotor: Any, nodes: Mapping[int, int | None]) -> _Floats:
    """Displacements of the inner rings against the outer ones from all of a rotor's, (2 bearings, ndof)."""
    rows = np.zeros((2 * len(nodes), rotor.ndof))
    for b, (node, linked) in enumerate(nodes.items()):
        for j in (0, 1):
            rows[2 * b + j, _first(rotor, node) + j] = 1.0
            if linked is not None:
                rows[2 * b + j, _first(rotor, linked) + j] = -1.0
    return rows
