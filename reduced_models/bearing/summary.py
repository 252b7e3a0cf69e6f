"""Summary of a ball bearing for the prompt and notebooks."""

from __future__ import annotations

from ehlcontact import Lubricant
from ehlcontact.summary import Summary


class BearingSummary(Summary):
    """Base of `BallBearing`: its summary."""

    name: str
    balls: int
    ball_diameter: float
    pitch_diameter: float
    conformity_inner: float
    conformity_outer: float
    clearance: float
    loss_factor: float
    oil: Lubricant | None

    def _summary_lines(self) -> list[str]:
        play = 1e6 * self.clearance
        lines = [
            f"{self.name or 'ball bearing'}, {self.balls} balls of {1e3 * self.ball_diameter:.4g} mm "
            f"on {1e3 * self.pitch_diameter:.4g} mm",
            f"conformity {self.conformity_inner:.4g} and {self.conformity_outer:.4g}, clearance {play:.4g} µm",
            "dry"
            if self.oil is None
            else f"oil of {self.oil.eta0:.4g} Pa s, alpha {1e9 * self.oil.alpha:.4g} 1/GPa, flooded",
        ]
        return [*lines, f"loss factor {self.loss_factor:.3g}"] if self.loss_factor else lines
