"""`SetState`: a `BearingSet` in static equilibrium under a load, bearing by bearing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.capacitance import OIL
from ehlcontact.quantities import FORCE, LENGTH, SPEED, STIFFNESS, Quantity
from ehlcontact.results.picture import Picture
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.store import stored
from ehlcontact.summary import note_line
from reduced_models.bearing.capacitance import BearingCapacitance, joined
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.bearing.freedoms import FIVE, in_freedoms, load_words, place_words
from reduced_models.bearing.picture import set_picture
from reduced_models.life.system_life import SystemLife

_Floats = NDArray[np.float64]


@stored("state of a set of bearings")
@dataclass(frozen=True, eq=False, kw_only=True)
class SetState(QuantityTable):
    """A `BearingSet` in static equilibrium, in the frame of the shaft.

    Attributes
    ----------
    name : str
        Of the set.
    load : ndarray, shape (5,)
        Force and moment on the shaft at 0 [N], [N m], those that held displacements take included.
    speed_rpm : float
        Of the shaft [rev/min].
    displacement : ndarray, shape (5,)
        Of the shaft at 0 [m], [rad].
    stiffness : ndarray, shape (5, 5)
        Slope of the static load [N/m], [N], [N m]; the axial rigidity of a set is ``stiffness[2, 2]``.
    axial_forces : ndarray, shape (bearings,)
        Axial force that each bearing carries [N], along its facing; a preload without other load.
    facings : tuple of str
    bearings : tuple of BearingState
        Each as `BallBearing.equilibrium` gives it, in its own frame: z along its facing, moments about its plane.
    """

    name: str
    load: Annotated[_Floats, FORCE.over("axis")]
    speed_rpm: Annotated[float, SPEED]
    displacement: Annotated[_Floats, LENGTH.over("axis")]
    stiffness: Annotated[_Floats, STIFFNESS.over("axis by")]
    axial_forces: Annotated[_Floats, FORCE.over("bearing")]
    facings: tuple[str, ...]
    bearings: tuple[BearingState, ...]

    DISPLAY: ClassVar[Display] = Display(rows="bearing", labels={"axis": FIVE, "by": FIVE}, first=0)

    def __post_init__(self) -> None:
        for name in ("load", "displacement", "stiffness", "axial_forces"):
            array = np.array(getattr(self, name), dtype=np.float64)
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    def require_complete(self, **sizes: int) -> None:
        """Raise `ValueError` unless arrays fit the five degrees of freedom and the bearings."""
        super().require_complete(axis=len(FIVE), by=len(FIVE), bearing=len(self.bearings), **sizes)
        if len(self.facings) != len(self.bearings):
            raise ValueError(f"facings has {len(self.facings)} entries, not {len(self.bearings)}")

    def _quantities(self) -> Mapping[str, Quantity]:
        return in_freedoms(super()._quantities(), len(FIVE))

    def _summary_lines(self) -> list[str]:
        k = int(np.argmax([one.force[one.heaviest, 0] for one in self.bearings]))
        most = self.bearings[k]
        axial = 1e-6 * self.stiffness[2, 2]
        forces = ", ".join(f"{one:.4g}" for one in self.axial_forces.tolist())
        film = "no film: dry" if most.h_min is None else f"smallest film {1e6 * np.nanmin(most.h_min):.4g} µm"
        return [
            f"{self.name or 'set of bearings'}, load {load_words(self.load)} at {self.speed_rpm:.5g} rev/min",
            f"axial forces of bearings facing {', '.join(self.facings)}: {forces} N",
            f"shaft displaced by {place_words(self.displacement)}, axial stiffness {axial:.4g} N/µm",
            f"most loaded ball {most.force[most.heaviest, 0]:.4g} N in bearing {k}; {film}",
            *filter(None, [self.reservation, self.friction_note]),
            *note_line(self.outside_assumptions),
        ]

    @property
    def reservation(self) -> str:
        """Bearings that have lost their preload, in words; empty where all have a ball pressed between its races.

        The inner race of such a bearing touches none of its balls but for the film.
        """
        lost = [str(k) for k, bearing in enumerate(self.bearings) if not (bearing.approach[:, 0] > 0.0).any()]
        if not lost:
            return ""
        named = f"bearing {lost[0]} has" if len(lost) == 1 else f"bearings {', '.join(lost)} have"
        return f"{named} no preload left: only films and centrifugal force press the balls"

    @property
    def friction_note(self) -> str:
        """Friction of the first bearing whose balls may slip, in words; empty where none may."""
        notes = ((k, bearing.friction_note) for k, bearing in enumerate(self.bearings))
        return next((f"bearing {k}: {note}" for k, note in notes if note), "")

    @property
    def outside_assumptions(self) -> str:
        """Assumptions of films that do not hold in the first bearing where one does not; empty where all do."""
        return next((one.outside_assumptions for one in self.bearings if one.outside_assumptions), "")

    def life(self, **options: Any) -> SystemLife:
        """Rating life of each bearing and of all together; options and errors as of `BearingState.life`."""
        names = tuple(f"bearing {k}" for k in range(len(self.bearings)))
        return SystemLife(lives=tuple(one.life(**options) for one in self.bearings), names=names)

    def capacitance(self, permittivity: float = OIL, *, surroundings: float | None = None) -> BearingCapacitance:
        """Capacitance between shaft and housing: all balls of all bearings, as of `BearingState.capacitance`."""
        return joined(one.capacitance(permittivity, surroundings=surroundings) for one in self.bearings)

    def picture(self) -> Picture:
        """Load zones and contact angles, bearing by bearing."""
        return set_picture(self)

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        bearings = [one.to_dict() for one in self.bearings]
        return {"name": self.name, **super().to_dict(), "facings": list(self.facings), "bearings": bearings}
