"""Response of a rotor on ball bearings to its unbalances, over the speed."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.results.layout import Layout, Tabled
from ehlcontact.store import stored
from ehlcontact.summary import Summary, span
from reduced_models.rotor.linearise import linearise
from reduced_models.rotor.rotor import Rotor

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]


@stored("unbalance response")
@dataclass(frozen=True, eq=False, kw_only=True)
class UnbalanceResponse(Summary, Tabled):
    """Amplitudes over the speed, about rest: q(t) = cosine cos(w t) + sine sin(w t), the shaft's angle being w t.

    They are linear in the unbalance, however large; what a ring does that moves as far as its balls are pressed in
    by the load is for `simulate_on_bearings`.

    Attributes
    ----------
    speed_rpm : ndarray, shape (k,)
        In rev/min.
    cosine, sine : ndarray, shape (k, N)
        Of all degrees of freedom [m], or rad where they turn.
    nodes : ndarray, shape (n, 2)
        Degrees of freedom x, y of the nodes with bearings and unbalances.
    names : tuple of str
        Of those nodes, "" where the rotor has none.
    """

    speed_rpm: _Floats
    cosine: _Floats
    sine: _Floats
    nodes: NDArray[np.int64]
    names: tuple[str, ...] = ()

    LAYOUT: ClassVar[Layout] = Layout(
        rows="speed_rpm",
        panels=(),
        quantities={
            "speed_rpm": ("rev/min", "speed_rpm"),
            "major": ("m", "speed_rpm node"),
            "cosine": ("m, or rad where it turns", "speed_rpm dof"),
            "sine": ("m, or rad where it turns", "speed_rpm dof"),
        },
        first=0,
    )

    def _layout(self) -> Layout:
        return replace(self.LAYOUT, labels={"node": tuple(map(self._name, range(len(self.nodes))))})

    def _name(self, node: int) -> str:
        return next(iter(self.names[node : node + 1]), "") or f"node {node}"

    def to_pandas(self) -> Any:
        """``pandas.DataFrame`` over the speed: half axis, cosine and sine of x and y of each node, in m.

        Of the other degrees of freedom nothing here says which of them turn: they are in `to_xarray`.

        Raises
        ------
        InputError
            pandas is not installed.
        """
        frame = super().to_pandas()
        table = frame[[head for head in frame.columns if head.startswith("major")]].copy()
        for node, places in enumerate(self.nodes.tolist()):
            of = self._name(node).replace(" ", "_")
            for axis, k in zip("xy", places, strict=True):
                table[f"cosine_{of}_{axis} [m]"] = self.cosine[:, k]
                table[f"sine_{of}_{axis} [m]"] = self.sine[:, k]
        table.attrs.update(frame.attrs)
        return table

    def _summary_lines(self) -> list[str]:
        largest = np.unravel_index(int(np.argmax(self.major)), self.major.shape)
        name = self._name(int(largest[1]))
        return [
            f"{len(self.nodes)} nodes at {self.speed_rpm.size} speeds, {span(self.speed_rpm)} rev/min",
            f"largest orbit: {name}, half axis {1e6 * self.major[largest]:.4g} µm "
            f"at {self.speed_rpm[largest[0]]:.5g} rev/min",
        ]

    @property
    def amplitude(self) -> _Complex:
        """Complex amplitudes, shape (k, N): q(t) = Re(amplitude exp(i w t))."""
        return np.asarray(self.cosine - 1j * self.sine)

    @property
    def major(self) -> _Floats:
        """Larger half axis of the orbits of the nodes, shape (k, n) [m]."""
        x, y = self.amplitude[:, self.nodes[:, 0]], self.amplitude[:, self.nodes[:, 1]]
        return np.asarray(0.5 * (np.abs(x + 1j * y) + np.abs(x - 1j * y)))  # forward and backward circle

    def peaks(self, node: int = 0) -> _Floats:
        """Speeds [rev/min] at which the orbit of a node is larger than at the speeds beside."""
        if not 0 <= node < len(self.nodes):
            raise InputError("node", node, f"from 0 to {len(self.nodes) - 1}")
        size = self.major[:, node]
        top = (size[1:-1] > size[:-2]) & (size[1:-1] > size[2:])
        return self.speed_rpm[1:-1][top]

    def plot(self, path: str | os.PathLike[str] | None = None) -> Any:
        """Matplotlib figure; into a file too where a path is given.

        Raises
        ------
        InputError
            The file cannot be written.
        """
        from reduced_models.rotor.picture import draw_unbalance

        return draw_unbalance(self, path)


@takes(speeds_rpm="rev/min")
def unbalance_response(rotor: Rotor, speeds_rpm: ArrayLike, *, passage: bool = True) -> UnbalanceResponse:
    """Steady response of a rotor on ball bearings to its unbalances, at increasing speeds, films those of each.

    Nothing is known between the speeds: a peak is as wide as decrement/pi of its speed, for films and steel often
    less than a thousandth, so set speeds that close about those of `Campbell.critical_speeds`.

    Parameters
    ----------
    rotor : Rotor
    speeds_rpm : array_like, shape (k,)
        In rev/min, > 0.
    passage : bool
        Bearings as means over a ball passage, as in `linearise`.

    Raises
    ------
    InputError
        A rotor without unbalance, a speed that a bearing does not take.
    """
    speeds = as_column("speeds_rpm", speeds_rpm, increasing=True)
    if not rotor.unbalances:
        raise InputError("unbalances", (), "at least one Unbalance")
    if speeds[0] <= 0.0:
        raise InputError("speeds_rpm[0]", float(speeds[0]), "> 0")
    found = [linearise(rotor, s, passage=passage).unbalance_response(rpm=s)[0] for s in speeds.tolist()]
    places = list(dict.fromkeys([(m.x, m.y) for m in rotor.mounts] + [(u.x, u.y) for u in rotor.unbalances]))
    known = {pair: name for name, pair in rotor.nodes.items()}
    q, names = np.array(found), tuple(known.get(pair, "") for pair in places)
    return UnbalanceResponse(
        speed_rpm=speeds, cosine=q.real.copy(), sine=-q.imag, nodes=np.array(places, np.int64), names=names
    )
