"""`RotorResult`: histories of a rotor run."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks import require_integer, require_positive
from ehlcontact.checks.kinds import INDEX
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.quantities import FORCE, LENGTH, NUMBER, RATE, SPEED, TIME
from ehlcontact.results.drawing import draw
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.status import Status
from ehlcontact.store import stored
from ehlcontact.summary import counted, span
from reduced_models.life.bearing_life import life_of_bearing
from reduced_models.life.history import BearingHistory
from reduced_models.life.system_life import SystemLife
from reduced_models.rotor.nodes import LENGTHS, PLANE, ByNode
from reduced_models.rotor.picture import run_picture

_Floats = NDArray[np.float64]

KINDS = ("histories", "orbit", "spectrum", "waterfall")  # of figures
FEWEST = 16  # steps of a run for its paths and spectra
ORDERS_SHOWN = 20.0  # multiples of the speed, to which spectra go
MIXED = "m, or rad where it turns"


@stored("run of a rotor")
@dataclass(frozen=True, eq=False, kw_only=True)
class RotorResult(QuantityTable, ByNode):
    """Histories of a rotor run in SI; entry 0 is the start.

    A support has a column for each of its directions: a contact one, the approach; a bearing x and y of the inner
    ring against the outer one, or x, y, z, tilt_x and tilt_y [rad], [N m], in its own frame. Contacts
    come first, then bearings, in the order of the rotor's supports.

    Attributes
    ----------
    t, speed_rpm : ndarray, shape (k,)
        Times [s], speed of the shaft [rev/min].
    displacement, velocity : ndarray, shape (k, N)
        Of the rotor's degrees of freedom [m], [m/s], or rad where they turn.
    approach, rate : ndarray, shape (k, columns)
        Motion of every support [m], [m/s].
    force : ndarray, shape (k, columns)
        On one contact; of the inner rings on the balls, or on the bearing where it is linear [N].
    iterations : ndarray, shape (k,)
        Evaluations of every support in the step.
    largest_load : ndarray, shape (ball bearings, 2)
        Largest force that any ball had, on the inner and on the outer race [N].
    status : Status
    reservation : str
        What the run leaves open, in words; else empty: steps that are long for a feature of a bearing.
    columns : tuple of str
        Names of the columns, as "contact 0" or "bearing 0 x".
    names : tuple of str
        Names of degrees of freedom, as "disc x".
    places : ndarray, shape (len(names),)
        Those degrees of freedom.
    ball_bearings : tuple of BearingHistory
        Of every ball bearing: mean loads of its balls over the run, and its geometry, for `life`.
    dampers : tuple of str
        Names of squeeze film dampers among the columns, which are no rings of bearings.
    """

    t: Annotated[_Floats, TIME.over("t")]
    speed_rpm: Annotated[_Floats, SPEED.over("t")]
    displacement: Annotated[_Floats, LENGTH.over("t dof")]
    velocity: Annotated[_Floats, RATE.over("t dof")]
    approach: Annotated[_Floats, LENGTH.over("t support")]
    rate: Annotated[_Floats, RATE.over("t support")]
    force: Annotated[_Floats, FORCE.over("t support")]
    iterations: Annotated[NDArray[np.int64], NUMBER.over("t")]
    largest_load: Annotated[_Floats, FORCE.over("bearing race")]
    status: Status
    columns: tuple[str, ...]
    names: tuple[str, ...] = ()
    places: NDArray[np.int64] = None  # type: ignore[assignment]
    reservation: str = ""
    ball_bearings: tuple[BearingHistory, ...] = ()
    dampers: tuple[str, ...] = ()

    DISPLAY: ClassVar[Display] = Display(
        rows="t", panels=("displacement", "approach", "force"), labels={"race": ("inner", "outer")}, first=0
    )

    def __post_init__(self) -> None:
        if self.places is None:
            object.__setattr__(self, "places", np.zeros(0, np.int64))
        for values in vars(self).values():
            if isinstance(values, np.ndarray):
                values.setflags(write=False)

    def _display(self) -> Display:
        dofs = [f"q{k}" for k in range(self.displacement.shape[1])]
        for name, place in reversed(list(zip(self.names, self.places.tolist(), strict=True))):
            dofs[place] = name
        return replace(self.DISPLAY, labels={**self.DISPLAY.labels, "dof": tuple(dofs), "support": self.columns})

    def _unit(self, name: str) -> str:
        lengths = {place for at in self.nodes.values() for name, place in at.items() if name in LENGTHS}
        mixed = {"displacement": MIXED, "velocity": f"{MIXED}, per s"}
        if lengths == set(range(self.displacement.shape[1])):
            mixed = {}
        if any(column.endswith(" tilt_x") for column in self.columns):
            mixed |= {"approach": MIXED, "rate": f"{MIXED}, per s", "force": "N, or N m where it turns"}
        return mixed.get(name) or super()._unit(name)

    def _summary_lines(self) -> list[str]:
        nodes = f"nodes {', '.join(self.nodes)}" if self.names else "nodes without names"
        pushing = [k for k, name in enumerate(self.columns) if " tilt_" not in name]
        lines = [
            f"{self.status} after {counted(len(self.t) - 1, 'step')} to {self.t[-1]:.4g} s, "
            f"{span(self.speed_rpm)} rev/min",
            f"{self.displacement.shape[1]} degrees of freedom, {nodes}",
            f"forces {span(self.force[:, pushing], 1.0, 'N')} of {', '.join(self.columns[k] for k in pushing)}",
        ]
        if self.largest_load.size:
            far = 1e6 * float(np.hypot(*np.moveaxis(self.ring, -1, 0)[:2]).max())
            along = f" and {1e6 * np.abs(self.ring[..., 2]).max():.4g} µm along" if self.ring.shape[2] > 2 else ""
            most = self.largest_load.max()
            lines.append(f"rings within {far:.4g} µm of the centre{along}, largest force on a ball {most:.4g} N")
        return [*lines, *filter(None, [self.reservation])]

    def node(self, name: str) -> _Floats:
        """Displacements x, y of a node, shape (k, 2) [m]; 0 along a direction in which it does not move."""
        return self._node(self.displacement, name)

    def node_velocity(self, name: str) -> _Floats:
        """Velocities x, y of a node, shape (k, 2) [m/s]."""
        return self._node(self.velocity, name)

    @property
    def disc(self) -> _Floats:
        """Displacements of the node "disc", shape (k, 2) [m]."""
        return self.node("disc")

    @property
    def journal(self) -> _Floats:
        """Displacements of the node "journal", shape (k, 2) [m]."""
        return self.node("journal")

    @property
    def disc_velocity(self) -> _Floats:
        """Velocities of the node "disc", shape (k, 2) [m/s]."""
        return self.node_velocity("disc")

    @property
    def journal_velocity(self) -> _Floats:
        """Velocities of the node "journal", shape (k, 2) [m/s]."""
        return self.node_velocity("journal")

    @property
    def ring(self) -> _Floats:
        """Inner rings of the bearings against the outer ones, shape (k, bearings, n) [m], [rad]; n = 2 or 5."""
        return self._of_bearings(self.approach)

    @property
    def ring_force(self) -> _Floats:
        """Force of the inner rings on the bearings, shape (k, bearings, n) [N], [N m]."""
        return self._of_bearings(self.force)

    def _of_bearings(self, values: _Floats) -> _Floats:
        at = self._places_of_bearings()
        directions = min(map(len, at.values()), default=len(PLANE))  # planar ones beside others: x and y of all
        places = np.array([columns[:directions] for columns in at.values()], int).reshape(-1, directions)
        return np.asarray(values[:, places])

    def _places_of_bearings(self) -> dict[str, list[int]]:
        """Places among the columns by the name of the bearing."""
        at: dict[str, list[int]] = {}
        for k, name in enumerate(self.columns):
            support = name.rpartition(" ")[0]
            if not (name.startswith("contact ") or support in self.dampers):
                at.setdefault(support, []).append(k)
        return at

    @takes()
    def life(self, *, rotating_load: bool = False, **options: Any) -> SystemLife:
        """Rating life of every ball bearing from the loads of its balls over the run, and of all together.

        Loads are means over the turns of the shaft of the whole run, with the exponents of ISO/TS 16281: a run
        should have many ball passages, and no start that does not belong to it.

        Parameters
        ----------
        rotating_load : bool
            Whether the load turns with the shaft, as that of an unbalance: the inner race stands still against it.
        **options
            As of `BearingState.life`.

        Raises
        ------
        InputError
            A run without ball bearings; what `BearingState.life` refuses.
        """
        if not self.ball_bearings:
            raise InputError("run", "without ball bearings", "one of a rotor on ball bearings")
        places, lives = self._places_of_bearings(), []
        for one, largest in zip(self.ball_bearings, self.largest_load, strict=True):
            force = self.force[:, places[one.name]]
            loads = one.loads(force, self.speed_rpm, largest, rotating=rotating_load)
            lives.append(life_of_bearing(one.internals, loads, **options))
        return SystemLife(lives=tuple(lives), names=tuple(one.name for one in self.ball_bearings))

    @takes(first=INDEX, last=INDEX)
    def part(self, first: int, last: int | None = None, *, keep_time: bool = True) -> Self:
        """Samples `first` to `last` of the run, both included; with ``keep_time=False`` their time starts at 0."""
        if first >= self.t.size:
            raise InputError("first", first, f"at most {self.t.size - 1}, the last sample of the run")
        end, along_time = None if last is None else last + 1, set(self._declared()) - {"largest_load"}
        cut = {name: getattr(self, name)[first:end].copy() for name in along_time}
        if not keep_time:
            cut["t"] = cut["t"] - cut["t"][0]
        return replace(self, **cut)

    def plot(
        self,
        path: str | os.PathLike[str] | None = None,
        *,
        kind: str | None = None,
        most_hz: float | None = None,
        node: str | tuple[int, int] | None = None,
    ) -> Any:
        """Matplotlib figure; into a file too where a path is given.

        Parameters
        ----------
        path : path, optional
            The ending gives the format.
        kind : {"histories", "orbit", "spectrum", "waterfall"}, optional
            Displacements, approaches and forces over time; paths over the last turns; amplitudes over frequency,
            of the second half of the run; such amplitudes of y piece by piece, over the speed or, where that is
            constant, the time. By default histories, or orbits of the rings of ball bearings.
        most_hz : float, optional
            End of the frequencies shown; by default 20 times the highest speed, as far as the steps resolve it and
            a waterfall shows anything there.
        node : str or (int, int), optional
            What is shown in place of the rings: the name of a node, as "disc", or its degrees of freedom x, y.

        Raises
        ------
        InputError
            Another kind, a run of fewer than 16 steps, a node that is not there, or the file cannot be written.
        """
        kind = ("orbit" if self.largest_load.size or node else "histories") if kind is None else kind
        if kind not in KINDS:
            raise InputError("kind", kind, f"one of {', '.join(KINDS)}")
        if kind == "histories":
            return super().plot(path)
        if self.t.size <= FEWEST:
            raise InputError("steps of the run", self.t.size - 1, f"at least {FEWEST}, for a figure")
        highest, per_second = 0.5 / float(self.t[1] - self.t[0]), float(np.abs(self.speed_rpm).max()) / 60.0
        if most_hz is not None:
            most_hz = min(require_positive("most_hz", most_hz), highest)
        usual = min(ORDERS_SHOWN * per_second, highest) if per_second > 0.0 else highest
        return draw(run_picture(self, kind, (most_hz, usual), self._shown(node)), path)

    def _shown(self, node: str | tuple[int, int] | None) -> list[tuple[str, _Floats]]:
        """Motions x, y of what a figure shows, with their titles."""
        if node is None:
            ring = self.ring
            shown = [
                (f"inner ring of {name}", ring[:, b, :2]) for b, name in enumerate(self._places_of_bearings())
            ]
            for name in self.dampers:
                places = [self.columns.index(f"{name} {way}") for way in PLANE]
                shown.append((f"journal of {name}", self.approach[:, places]))
            if not shown:
                raise InputError("node", None, "given for a rotor without bearings")
            return shown
        named = {name: tuple(at.get(k, -1) for k in "xy") for name, at in self.nodes.items()}
        if isinstance(node, str) and node in named:
            return [(node, self.node(node))]
        pair, most = node if isinstance(node, list | tuple) else (), self.displacement.shape[1] - 1
        if len(pair) != 2 or not all(0 <= require_integer("node", at, "whole numbers", 0) <= most for at in pair):
            known = f"one of {', '.join(named)}, or " if named else ""
            raise InputError("node", node, f"{known}two degrees of freedom from 0 to {most}")
        titles = {at: name for name, at in named.items()}
        return [(titles.get(pair, f"degrees of freedom {pair[0]}, {pair[1]}"), self.displacement[:, list(pair)])]
