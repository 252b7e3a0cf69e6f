"""`UnbalanceResponse`: amplitudes over the speed, result of `unbalance.unbalance_response`."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Annotated, Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from ehlcontact.checks.kinds import INDEX
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.quantities import LENGTH, SPEED, Quantity
from ehlcontact.results.picture import Picture
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.store import stored
from ehlcontact.summary import counted, span
from reduced_models.rotor.picture import unbalance_picture
from reduced_models.rotor.rotor import Rotor

_Floats = NDArray[np.float64]
_Complex = NDArray[np.complex128]

MIXED = Quantity("m, or rad where it turns")


@stored("unbalance response")
@dataclass(frozen=True, eq=False, kw_only=True)
class UnbalanceResponse(QuantityTable):
    """Response to unbalance over shaft speed: q(t) = cosine cos(w t) + sine sin(w t) about static equilibrium.

    The angle of the shaft is w t. Amplitudes are linear in the unbalance, however large. For amplitudes comparable
    to the static ball deflection use `simulate_rotor`.

    Attributes
    ----------
    speed_rpm : ndarray, shape (k,)
        Of the shaft [rev/min].
    cosine, sine : ndarray, shape (k, N)
        Of all degrees of freedom [m], or rad where they turn.
    nodes : ndarray, shape (n, 2)
        Degrees of freedom x, y of the nodes with supports and unbalances; -1: it does not move that way.
    names : tuple of str
        Of those nodes, "" where the rotor has none.
    """

    speed_rpm: Annotated[_Floats, SPEED.over("speed_rpm")]
    cosine: Annotated[_Floats, MIXED.over("speed_rpm dof")]
    sine: Annotated[_Floats, MIXED.over("speed_rpm dof")]
    nodes: NDArray[np.int64]
    names: tuple[str, ...] = field(default=())

    DISPLAY: ClassVar[Display] = Display(rows="speed_rpm", first=0)

    def _display(self) -> Display:
        return replace(self.DISPLAY, labels={"node": tuple(map(self._name, range(len(self.nodes))))})

    def _name(self, node: int) -> str:
        return next(iter(self.names[node : node + 1]), "") or f"node {node}"

    def to_pandas(self) -> Any:
        """``pandas.DataFrame`` over the speed: semi-major axis, cosine and sine of x and y of each node, in m.

        Other degrees of freedom, some of which are angles, are in `to_xarray`.

        Raises
        ------
        InputError
            pandas is not installed.
        """
        frame = super().to_pandas()
        table = frame[[head for head in frame.columns if head.startswith("major")]].copy()
        for node, places in enumerate(self.nodes.tolist()):
            of = self._name(node).replace(" ", "_")
            for axis, k in ((axis, k) for axis, k in zip("xy", places, strict=True) if k >= 0):
                table[f"cosine_{of}_{axis} [m]"] = self.cosine[:, k]
                table[f"sine_{of}_{axis} [m]"] = self.sine[:, k]
        table.attrs.update(frame.attrs)
        return table

    def _summary_lines(self) -> list[str]:
        largest = np.unravel_index(int(np.argmax(self.major)), self.major.shape)
        name = self._name(int(largest[1]))
        return [
            f"{counted(len(self.nodes), 'node')} at {counted(self.speed_rpm.size, 'speed')}, "
            f"{span(self.speed_rpm)} rev/min",
            f"largest orbit: {name}, semi-major axis {1e6 * self.major[largest]:.4g} µm "
            f"at {self.speed_rpm[largest[0]]:.5g} rev/min",
        ]

    @classmethod
    def of(cls, rotor: Rotor, speeds_rpm: _Floats, amplitude: _Complex) -> Self:
        """From complex amplitudes, shape (k, N)."""
        pairs = [*(mount.ends[0][:2] for mount in rotor.mounts), *((u.x, u.y) for u in rotor.unbalances)]
        places = list(dict.fromkeys((-1 if x is None else x, -1 if y is None else y) for x, y in pairs))
        known = {(at.get("x", -1), at.get("y", -1)): name for name, at in rotor.nodes.items()}
        return cls(
            speed_rpm=speeds_rpm,
            cosine=amplitude.real.copy(),
            sine=-amplitude.imag,
            nodes=np.array(places, np.int64),
            names=tuple(known.get(pair, "") for pair in places),
        )

    @property
    def amplitude(self) -> _Complex:
        """Complex amplitudes, shape (k, N): q(t) = Re(amplitude exp(i w t))."""
        return np.asarray(self.cosine - 1j * self.sine)

    @property
    def major(self) -> Annotated[_Floats, LENGTH.over("speed_rpm node")]:
        """Semi-major axes of the orbits of the nodes, shape (k, n) [m]."""
        moving = np.column_stack([self.amplitude, np.zeros(len(self.speed_rpm))])  # -1: does not move that way
        x, y = moving[:, self.nodes[:, 0]], moving[:, self.nodes[:, 1]]
        return np.asarray(0.5 * (np.abs(x + 1j * y) + np.abs(x - 1j * y)))  # forward and backward circle

    @takes(node=INDEX)
    def peaks(self, node: int = 0) -> _Floats:
        """Speeds [rev/min] at which the orbit of a node is larger than at both neighbouring speeds."""
        if not 0 <= node < len(self.nodes):
            raise InputError("node", node, f"from 0 to {len(self.nodes) - 1}")
        size = self.major[:, node]
        top = (size[1:-1] > size[:-2]) & (size[1:-1] > size[2:])
        return self.speed_rpm[1:-1][top]

    def picture(self) -> Picture:
        """Largest displacement of every node over the speed, and phases of x."""
        return unbalance_picture(self)
