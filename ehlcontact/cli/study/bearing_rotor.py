"""The rotor of a study on two whole bearings: films with memory under all balls, dry, and constant K and C."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ehlcontact.cli.study.whole_bearing import whole_bearing
from ehlcontact.store import save
from reduced_models import BallBearing, Disc, LinearBearing, Rotor, Shaft, Support, rotor_on_bearings
from reduced_models.rotor.compare_bearing_models import (
    CONSTANT,
    DRY,
    FILM,
    USUAL,
    USUAL_DAMPING,
    BearingModels,
    compare_bearing_models,
)

if TYPE_CHECKING:
    from ehlcontact.cli.study.schema import Study

NAMES = {
    FILM: "film memory under every ball",
    DRY: "dry Hertz contacts",
    CONSTANT: "constant K and C, of the film at the speed",
    USUAL: f"constant K, dry, and C = {USUAL_DAMPING:g} s K",
}


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
