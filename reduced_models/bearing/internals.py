"""Internal geometry of a `BallBearing` as the standards of rating life need it, with printed ratings."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ehlcontact.errors import InputError
from ehlcontact.hertz import hertz_contact
from reduced_models.bearing.catalogue import ROWS
from reduced_models.bearing.printed_ratings import NSK, RATINGS
from reduced_models.bearing.race import RACES
from reduced_models.bearing.skf_friction import boundary_diameters
from reduced_models.life.equivalent_load import LeastLoad
from reduced_models.life.internal_geometry import InternalGeometry
from reduced_models.life.load_ratings import GIVEN, dynamic_rating, require_rating, static_rating

if TYPE_CHECKING:
    from reduced_models.bearing.ball_bearing import BallBearing

LEAST_LOADS = {"60": 0.025, "62": 0.025, "63": 0.03, "64": 0.035}  # kr of SKF's least load, by series
SAME_SIZE = 1e-6  # of a length of the catalogue, for its ratings to be those of the bearing


def internals_of(bearing: BallBearing) -> InternalGeometry:
    """Balls, grooves and oil of a bearing; ratings as given, or printed where its balls are the catalogue's."""
    pressures = []
    for name in RACES:
        body = bearing.race(name).geometry
        pressures.append(hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced).pressure)
    printed = RATINGS[bearing.name] if _is_printed(bearing) else (None, None)
    (dynamic, of_dynamic), (static, of_static) = (
        (printed[k], "" if printed[k] is None else NSK) if own is None else (float(own), GIVEN)
        for k, own in enumerate((bearing.dynamic_rating, bearing.static_rating))
    )
    return InternalGeometry(
        name=bearing.name,
        balls=bearing.balls,
        ball_diameter=bearing.ball_diameter,
        pitch_diameter=bearing.pitch_diameter,
        conformity_inner=bearing.conformity_inner,
        conformity_outer=bearing.conformity_outer,
        contact_angle=0.0 if bearing.contact_angle is None else bearing.contact_angle,
        unit_pressures=(float(pressures[0]), float(pressures[1])),
        ball_density=bearing.density,
        kinematic_viscosity=None if bearing.oil is None else bearing.oil.kinematic_viscosity,
        flooded=bearing.supply is None,
        printed_dynamic=dynamic,
        printed_static=static,
        dynamic_source=of_dynamic,
        static_source=of_static,
        least_load=_least_load(bearing.name),
        ring_speeds=(bearing.ring_speeds.inner, bearing.ring_speeds.outer),
    )


def require_ratings(bearing: BallBearing) -> None:
    """Raise `InputError` for ratings of a bearing that are far from those of its balls, with the unit meant."""
    rows = (
        ("dynamic_rating", bearing.dynamic_rating, dynamic_rating),
        ("static_rating", bearing.static_rating, static_rating),
    )
    for field, value, of_geometry in rows:
        if value is not None:
            require_rating(field, value, of_geometry(bearing.tables.internals))


def _is_printed(bearing: BallBearing) -> bool:
    """Whether NSK's ratings are for the balls of a bearing: as in the catalogue, their angle too."""
    row = ROWS.get(bearing.name)
    if row is None or bearing.name not in RATINGS or row.balls != bearing.balls:
        return False
    lengths = (row.ball_diameter, bearing.ball_diameter), (row.pitch_diameter, bearing.pitch_diameter)
    angles = row.contact_angle or 0.0, bearing.contact_angle or 0.0
    return all(abs(own / printed - 1.0) < SAME_SIZE for printed, own in lengths) and (
        abs(angles[1] - angles[0]) < SAME_SIZE
    )


def _least_load(name: str) -> LeastLoad | None:
    try:
        series, bore, outside = boundary_diameters(name)
    except InputError:
        return None
    return LeastLoad(LEAST_LOADS[series], 0.5e-3 * (bore + outside))
