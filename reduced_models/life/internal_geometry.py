"""`InternalGeometry`: what the standards of rating life need of a ball bearing."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos

from reduced_models.life.equivalent_load import LeastLoad

CERAMIC = 5000.0  # kg/m3, below which balls are no steel: silicon nitride has 3200


@dataclass(frozen=True, kw_only=True)
class InternalGeometry:
    """Balls, grooves and printed ratings of a bearing; SI.

    Attributes
    ----------
    name : str
    balls : int
    ball_diameter, pitch_diameter : float
        In m.
    conformity_inner, conformity_outer : float
        Groove radius over ball diameter.
    contact_angle : float
        Nominal one [rad]; 0 of a deep-groove bearing.
    unit_pressures : (float, float)
        Hertz pressure under 1 N at the inner and the outer race [Pa].
    ball_density : float
        In kg/m3.
    kinematic_viscosity : float or None
        Of the oil at the temperature of the bearing [m2/s]; None of a dry bearing.
    flooded : bool
        Whether films have all the oil that they take.
    printed_dynamic, printed_static : float or None
        C and C0 that are given or of a catalogue [N]; None where they follow from the geometry.
    dynamic_source, static_source : str
        Where they are from.
    least_load : LeastLoad or None
        Constants of SKF's least load; None where the catalogue has none.
    ring_speeds : (float, float)
        Of the inner and the outer ring, over the speed of one against the other.
    """

    name: str
    balls: int
    ball_diameter: float
    pitch_diameter: float
    conformity_inner: float
    conformity_outer: float
    contact_angle: float
    unit_pressures: tuple[float, float]
    ball_density: float
    kinematic_viscosity: float | None = None
    flooded: bool = True
    printed_dynamic: float | None = None
    printed_static: float | None = None
    dynamic_source: str = ""
    static_source: str = ""
    least_load: LeastLoad | None = None
    ring_speeds: tuple[float, float] = (1.0, 0.0)

    @property
    def gamma(self) -> float:
        """Ball diameter times the cosine of the contact angle over the pitch diameter."""
        return self.ball_diameter * cos(self.contact_angle) / self.pitch_diameter

    @property
    def is_hybrid(self) -> bool:
        """Whether its balls are ceramic."""
        return self.ball_density < CERAMIC
