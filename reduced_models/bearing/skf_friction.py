"""Moment of friction of a deep-groove ball bearing by the published model of SKF: an empirical model.

Friction from the computed films, `bearing_friction`, is in `reduced_models.bearing.sliding`.

Formulas and constants are those of SKF, Rolling Bearings (catalogue), chapter "Friction": rolling and sliding
frictional moment, tables of the variables G_rr and G_sl and of the constants R and S. They were fitted to measured
bearings, and are in mm, N, rev/min, mm2/s and N mm. Drag of an oil bath and seals are not included.
"""

from __future__ import annotations

from math import exp, radians, sin, sqrt
from typing import Any, NamedTuple

from ehlcontact.checks import parts, require_nonnegative, require_positive
from ehlcontact.checks.kinds import NAME
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from reduced_models.life.load_ratings import static_rating

# R1, R2, S1, S2 by series
CONSTANTS = {
    "60": (4.1e-7, 1.7, 3.73e-3, 14.6),
    "62": (3.9e-7, 1.7, 3.23e-3, 36.5),
    "63": (3.7e-7, 1.7, 2.84e-3, 92.8),
    "64": (3.6e-7, 1.7, 2.43e-3, 198.0),
}
BORES = (10, 12, 15, 17, *range(20, 65, 5))  # mm, by the last two digits of a name
# outside diameters at these bores [mm]: ISO 15, as catalogues print them; 64 begins at 17 mm
OUTSIDE: dict[str, tuple[int, ...]] = {
    "60": (26, 28, 32, 35, 42, 47, 55, 62, 68, 75, 80, 90, 95),
    "62": (30, 32, 35, 40, 47, 52, 62, 72, 80, 85, 90, 100, 110),
    "63": (35, 37, 42, 47, 52, 62, 72, 80, 90, 100, 110, 120, 130),
    "64": (0, 0, 0, 62, 72, 80, 90, 100, 110, 120, 130, 140, 150),
}
OIL_BATH, GREASE = 3e-8, 6e-8  # K_rs of replenishment
DEEP_GROOVE = 3.1  # K_Z
MU_BOUNDARY = 0.12  # 0.15 in the catalogue's edition 10000; of no influence where films are full
MU_MINERAL = 0.05  # full film of mineral oil; 0.04 of synthetic oil


class SkfFriction(NamedTuple):
    """Moments of friction by SKF's model, an empirical one [N m]."""

    rolling: float
    sliding: float

    @property
    def total(self) -> float:
        """Both together."""
        return self.rolling + self.sliding


def boundary_diameters(name: str) -> tuple[str, int, int]:
    """Series, bore and outside diameter [mm] of a deep-groove bearing by its name, as "6205".

    Raises
    ------
    InputError
        Not one of the series 60, 62, 63, 64 with a bore of 10 to 60 mm.
    """
    series, size = name[:2], name[2:4]
    known = len(name) == 4 and name.isdigit() and series in CONSTANTS and int(size) < len(BORES)
    if not known or not OUTSIDE[series][int(size)]:
        allowed = "a deep-groove bearing of the series 60, 62, 63 or 64, bore 10 (64: 17) to 60 mm, as 6205"
        raise InputError("name", name, f"{allowed}: SKF's constants of others are not in the library")
    return series, BORES[int(size)], OUTSIDE[series][int(size)]


@takes(
    name=NAME, radial=parts.FORCE, axial=parts.FORCE, speed_rpm=parts.SPEED_OR_NONE,
    kinematic_viscosity=parts.VISCOSITY, static_rating=parts.PRELOAD, replenishment=parts.SHARE,
    mu_boundary=parts.SHARE, mu_film=parts.SHARE,
)  # fmt: skip
def skf_friction(
    name: str,
    *,
    radial: float,
    axial: float = 0.0,
    speed_rpm: float,
    kinematic_viscosity: float,
    static_rating: float | None = None,
    replenishment: float = OIL_BATH,
    mu_boundary: float = MU_BOUNDARY,
    mu_film: float = MU_MINERAL,
) -> SkfFriction:
    """Moment of friction of a deep-groove ball bearing by SKF's published model.

    Parameters
    ----------
    name : str
        Of the catalogue: series 60, 62, 63, 64.
    radial, axial : float
        Load [N]; the axial one in either direction.
    speed_rpm : float
        Of the shaft [rev/min].
    kinematic_viscosity : float
        Of the oil or the base oil of the grease where the bearing is [m2/s].
    static_rating : float, optional
        Basic static load rating C0 [N]; required where there is an axial load.
    replenishment : float
        K_rs: 3e-8 in an oil bath at low level or an oil jet, 6e-8 in grease or oil-air.
    mu_boundary, mu_film : float
        Coefficients of sliding friction without film and with a full one.

    Raises
    ------
    InputError
        A series without constants, or an argument out of range.
    """
    series, bore, outside = boundary_diameters(name)
    r1, r2, s1, s2 = CONSTANTS[series]
    radial, axial = require_nonnegative("radial", radial), abs(axial)
    n = require_nonnegative("speed_rpm", speed_rpm)
    nu = 1e6 * require_positive("kinematic_viscosity", kinematic_viscosity)
    dm = 0.5 * (bore + outside)
    if axial > 0.0:
        if static_rating is None:
            raise InputError("static_rating", None, "the basic static load rating C0 [N], for an axial load")
        angle = 24.6 * (axial / require_positive("static_rating", static_rating)) ** 0.24  # degrees
        if angle > 90.0:
            raise InputError("axial", axial, f"a load that the bearing carries, C0 is {static_rating:.4g} N")
        slope = sin(radians(angle))
        g_rolling = r1 * dm**1.96 * (radial + r2 * axial / slope) ** 0.54
        g_sliding = s1 * dm**-0.145 * (radial**5 + s2 * dm**1.5 * axial**4 / slope) ** (1.0 / 3.0)
    else:
        g_rolling = r1 * dm**1.96 * radial**0.54
        g_sliding = s1 * dm**-0.26 * radial ** (5.0 / 3.0)
    inlet_heat = 1.0 / (1.0 + 1.84e-9 * (n * dm) ** 1.28 * nu**0.64)  # phi_ish of SKF
    # replenishment and starvation, phi_rs of SKF
    supply = exp(-replenishment * nu * n * (bore + outside) * sqrt(DEEP_GROOVE / (2.0 * (outside - bore))))
    boundary = exp(-2.6e-8 * (n * nu) ** 1.4 * dm)
    mu = boundary * mu_boundary + (1.0 - boundary) * mu_film
    return SkfFriction(1e-3 * inlet_heat * supply * g_rolling * (nu * n) ** 0.6, 1e-3 * g_sliding * mu)


def friction_under(bearing: Any, load: Any, speed_rpm: float) -> dict[str, Any]:
    """SKF's moments for a `BallBearing` in oil, by the names of `BearingState`; none if it has no constants."""
    if bearing.oil is None or bearing.contact_angle is not None:
        return {}
    try:
        found = skf_friction(
            bearing.name,
            radial=float((load[0] ** 2 + load[1] ** 2) ** 0.5),
            axial=float(load[2]) if len(load) > 2 else 0.0,
            speed_rpm=speed_rpm,
            kinematic_viscosity=bearing.oil.kinematic_viscosity,
            static_rating=static_rating(bearing.tables.internals),
        )
    except InputError:
        return {}
    return {"skf_rolling": found.rolling, "skf_sliding": found.sliding}
