"""The rotor of a study on two whole bearings: planar ones in time, on several models; others linearised.

Planar bearings have films with memory under all balls, are dry, or are constant K and C. With an axial load, balls
are at contact angles: loads and films of all balls, K and C in five directions, vibrations of the rotor between.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ehlcontact.cli.study.shared_entries import tilt_of
from ehlcontact.cli.study.whole_bearing import bearing_or_pair, bearings_of, ring_load, whole_bearing
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.store import save
from reduced_models import (
    BallBearing,
    BearingSet,
    Disc,
    LinearBearing,
    Rotor,
    Shaft,
    Support,
    linearise,
    rotor_on_bearings,
)
from reduced_models.bearing.freedoms import FIVE
from reduced_models.rotor.campbell import Campbell
from reduced_models.rotor.compare_bearing_models import (
    BAND,
    CONSTANT,
    DRY,
    FILM,
    FREQUENCIES,
    USUAL,
    USUAL_DAMPING,
    BearingModels,
    campbell_or_reason,
    compare_bearing_models,
)

if TYPE_CHECKING:
    from ehlcontact.cli.study.schema import Study
    from reduced_models.bearing.coefficients import BearingCoefficients
    from reduced_models.bearing.equilibrium_result import BearingState
    from reduced_models.bearing.set_result import SetState
    from reduced_models.rotor.modes import RotorMode

NAMES = {
    FILM: "film memory under every ball",
    DRY: "dry Hertz contacts",
    CONSTANT: "constant K and C, of the film at the speed",
    USUAL: f"constant K, dry, and C = {USUAL_DAMPING:g} s K",
}
SPAN = 0.2  # m, of the bearings where none is given
MODES = 6  # that are listed: two each across the shaft, along it, and of its tilts
FOLLOWED = 3  # of them over the speed: of the rotor as a whole, across the shaft and along it


def whole_rotor(study: Study, bearing: BallBearing | LinearBearing) -> Rotor:
    """Rotor of the study on two such bearings, pressed down so that each carries the study's load."""
    r = study.rotor
    needed = 2.0 * study.bearing.radial_load - (r.disc_mass + r.journal_mass) * 9.81
    disc = Disc(position=0.5, mass=r.disc_mass, damping=r.disc_damping, unbalance=r.unbalance, load=(0.0, -needed))
    supports = [Support(position=at, bearing=bearing, journal_mass=0.5 * r.journal_mass) for at in (0.0, 1.0)]
    # of any length: a disc that is a point, in the middle, feels the stiffness alone
    shaft = Shaft.jeffcott(r.shaft_stiffness, 1.0, damping=r.shaft_damping)
    return rotor_on_bearings(shaft, discs=[disc], supports=supports)


def run_whole(study: Study, folder: Path) -> BearingModels | None:
    """Run the rotor on planar bearings where the study has [whole_bearing]; runs are left in the folder."""
    if "whole_bearing" not in study.model_fields_set or study.whole_bearing.axial_load is not None:
        return None
    return compare_bearing_models(
        lambda bearing: whole_rotor(study, bearing),
        whole_bearing(study, oil=True),
        whole_bearing(study, oil=False),
        load=study.bearing.radial_load,
        speed_rpm=study.bearing.speed_rpm,
        eccentricity=study.rotor.unbalance / study.rotor.disc_mass,
        steps=study.whole_bearing.steps_per_revolution,
        revolutions=study.whole_bearing.revolutions,
        keep=lambda name, run: save(run, folder / f"on_bearings_{name}.h5"),
    )


@dataclass(frozen=True)
class BearingAtAngles:
    """A bearing or a pair under radial and axial load, and the rotor on it and on another bearing."""

    bearing: BallBearing
    pair: BearingSet | None
    state: BearingState | SetState  # a ball right under the load
    dry: BearingState | SetState  # likewise, without films
    over_frequency: BearingCoefficients  # K and C, 5 x 5, means over a ball passage
    at_speed: BearingCoefficients  # the same at the frequency of the shaft
    span: float  # of both bearings [m]
    modes: tuple[RotorMode, ...]
    no_modes: str  # why there are none, or empty
    diagram: Campbell | str  # or why there is none

    @property
    def bearings(self) -> dict[str, BearingState]:
        """State of the bearing, or of both of a pair, by its title."""
        return bearings_of(self.state)

    @property
    def frequencies(self) -> list[Mapping[str, float]]:
        """Defect frequencies at the contact angles [Hz], by name; of every bearing."""
        return [
            asdict((one.orders or self.bearing.orders).at(self.state.speed_rpm)) for one in self.bearings.values()
        ]

    @staticmethod
    def balls(state: BearingState) -> list[tuple[Any, ...]]:
        """Of every ball: place from the load [degrees], forces [N], contact angles [degrees], films [m]."""
        films = np.full_like(state.force, np.nan) if state.h_min is None else state.h_min
        assert state.contact_angles is not None
        at, angles = np.degrees(state.angles - state.cage_angle), np.degrees(state.contact_angles)
        return list(zip(at.tolist(), state.force.tolist(), angles.tolist(), films.tolist(), strict=True))

    def to_dict(self) -> dict[str, Any]:
        """All numbers, SI; K and C in x, y, z and tilts about x and y."""
        diagram = None if isinstance(self.diagram, str) else self.diagram
        return {
            "bearing": self.bearing.to_dict(),
            "span": self.span,
            "state": self.state.to_dict(),
            "dry_displacement": self.dry.displacement.tolist(),
            "pair": None if self.pair is None else self.pair.to_dict(),
            "frequencies_hz": self.frequencies[0] if self.pair is None else self.frequencies,
            "freedoms": list(FIVE),
            "at_speed": _matrices(self.at_speed),
            "over_frequency": _matrices(self.over_frequency),
            "modes": [mode.to_dict() | {"axial_share": mode.axial_share} for mode in self.modes],
            "no_modes": self.no_modes or None,
            "critical_speeds_rpm": None if diagram is None else [c.speed_rpm for c in diagram.critical_speeds()],
            "no_diagram": self.diagram if isinstance(self.diagram, str) else None,
        }


def _matrices(found: BearingCoefficients) -> dict[str, Any]:
    return {"hz": found.hz.tolist(), "stiffness": found.stiffness.tolist(), "damping": found.damping.tolist()}


def run_at_angles(study: Study) -> BearingAtAngles | None:
    """The bearing at contact angles where the study has [whole_bearing] with an axial load."""
    if "whole_bearing" not in study.model_fields_set or study.whole_bearing.axial_load is None:
        return None
    wet, dry = (bearing_or_pair(study, oil=oil) for oil in (True, False))
    load, speed = ring_load(study), study.bearing.speed_rpm
    under: dict[str, Any] = {"speed_rpm": speed, "tilt": tilt_of(study.whole_bearing)}
    span = SPAN if study.whole_bearing.span_mm is None else 1e-3 * study.whole_bearing.span_mm
    rotor = rotor_between(study, wet, span)
    modes: tuple[RotorMode, ...] = ()
    reason = ""
    try:
        modes = linearise(rotor, speed).modes(MODES)
    except (ConvergenceError, InputError) as error:
        reason = str(error)
    return BearingAtAngles(
        bearing=whole_bearing(study, oil=True),
        pair=wet if isinstance(wet, BearingSet) else None,
        state=wet.equilibrium(load, **under),
        dry=dry.equilibrium(load, **under),
        over_frequency=wet.coefficients(load, hz=speed / 60.0 * np.geomspace(*BAND, FREQUENCIES), **under),
        at_speed=wet.coefficients(load, rpm=speed, **under),
        span=span,
        modes=modes,
        no_modes=reason,
        diagram=campbell_or_reason(rotor, wet, speed, FOLLOWED),
    )


def rotor_between(study: Study, bearing: BallBearing | BearingSet, span: float) -> Rotor:
    """Rotor of the study on two such bearings face to face, a spring on the outer ring of the right one.

    The shaft has the mass of the journals, evenly along it; each bearing carries the radial and the axial load. A
    pair holds the shaft on the left, and the spring pulls the shaft in +z.
    """
    r = study.rotor
    plain = Shaft.jeffcott(r.shaft_stiffness, span, damping=r.shaft_damping)
    volume = 0.25 * pi * float(plain.diameter[0]) ** 2 * span
    shaft = replace(plain, density=r.journal_mass / volume, elements=2)
    pressed = 2.0 * study.bearing.radial_load - (r.disc_mass + r.journal_mass) * 9.81
    disc = Disc(
        position=0.5 * span, mass=r.disc_mass, damping=r.disc_damping, unbalance=r.unbalance, load=(0.0, -pressed)
    )
    spring = study.whole_bearing.axial_load
    if isinstance(bearing, BearingSet):
        left = Support(position=0.0, bearing=bearing)
        right = Support(position=span, bearing=bearing.bearings[0], facing="-z", preload=spring)
    else:
        left = Support(position=0.0, bearing=bearing, facing="-z")
        right = Support(position=span, bearing=bearing, facing="+z", preload=spring)
    supports = [left, right]
    return rotor_on_bearings(shaft, discs=[disc], supports=supports, axial=True)
