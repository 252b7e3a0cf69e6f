"""`SupplyCondition`: change of answers of the atlas by a layer of oil, from the table of oil supply."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.checks import require_instance
from ehlcontact.errors import InputError
from ehlcontact.film_formulas import load_number
from ehlcontact.jit import plain
from ehlcontact.lubricant import density
from ehlcontact.point import MoesPoint, Point, moes_point, scales_of
from ehlcontact.store import read as read_file
from ehlcontact.supply import OilLayer, require_supply
from reduced_models.atlas.change import Change
from reduced_models.atlas.frequency_curve import over_frequency
from reduced_models.atlas.supply_table import (
    FAINT,
    LOW_OMEGA,
    NUMBERS,
    REFERENCE,
    SupplySurface,
    SupplyTable,
    share_of_layer,
)
from reduced_models.atlas.table import HEAD, LOW, Box

_Floats = NDArray[np.float64]

SHIPPED = Path(__file__).with_name("supply.h5")
# Elements follow C from here on: below, the oil ahead of a wide contact comes and goes with the motion, and C
# falls below zero. Errors count over its largest value.
SLOWEST, FAINT_GAIN = 0.1, 1.0
# Of the growth of the dry approach, what a light film may grow by: slopes of the cubics between loads are up to
# three times those from load to load, and the approach rises between them too.
MOST_GROWN = 0.25
THINNEST = 0.02  # r, below which films are thinner than any that were solved by a factor of ten


@cache
def supply_surface() -> SupplySurface:
    """The table that comes with the library, read once."""
    return SupplySurface(read_file(SHIPPED, SupplyTable, "table of oil supply"))


def supply_box() -> Box:
    """Ranges of the table."""
    return supply_surface().table.box


def require_uniform(supply: OilLayer) -> None:
    """Raise `InputError` unless it is a uniform `OilLayer`."""
    require_instance("supply", supply, OilLayer, "an OilLayer(h) or OilLayer(over_flooded=r)")
    if supply.y is not None:
        raise InputError("supply", "a profile over y", "a uniform layer, where answers come from the atlas")


def lightest_load(moes: MoesPoint) -> float:
    """Load, in units of the point's, from which on the table of supply has contacts of its kappa."""
    table = supply_surface().table
    return max(table.box.M[0], table.lightest / load_number(1.0, moes.kappa)) / moes.M


def heaviest_load(moes: MoesPoint) -> float:
    """Load, in units of the point's, up to which the table of supply has contacts of its L and kappa."""
    table = supply_surface().table
    most = min(table.box.M[1] / moes.M, (table.box.p_hertz / moes.p_hertz) ** 3)

    def spare(log_load: float) -> float:
        return float(np.log(_loaded(moes, np.exp(log_load)).inlet_width / table.narrowest))

    low, high = np.log(lightest_load(moes)), np.log(most)
    if low >= high or spare(high) >= 0.0:
        return float(most)
    return float(np.exp(scipy.optimize.brentq(spare, low, high))) if spare(low) > 0.0 else 0.0


def supplied_speeds(moes: MoesPoint) -> tuple[float, float]:
    """Speeds, over that of the point, at which the table of supply has its contact."""
    box, speed = supply_surface().table.box, -4.0 / 3.0
    most = (lightest_load(moes)) ** speed
    if moes.L == 0.0:
        return (box.M[1] / moes.M) ** speed, most
    slow, fast = ((L / moes.L) ** 4 for L in box.L)

    def spare(log_speed: float) -> float:
        U = float(np.exp(log_speed))
        return heaviest_load(replace(moes, M=moes.M * U**-0.75, L=moes.L * U**0.25)) - 1.0

    low = np.log(max(slow, (box.M[1] / moes.M) ** speed))
    if low < 0.0 and spare(low) < 0.0 <= spare(0.0):
        low = scipy.optimize.brentq(spare, low, 0.0)
    return float(np.exp(low)), min(most, fast)


class SupplyCondition:
    """A uniform layer ahead of the contacts at a point, the same in m under all loads, or in flooded
    isothermal films.

    Loads lighter than those of the table have the change of its lightest at the same r. Heavier ones are refused,
    unless lighter ones are asked for beside them: then they have the change of its heaviest, so that an element
    has all loads that the atlas has.

    Parameters
    ----------
    point : MoesPoint or OperatingPoint
        The loads of `change` are in units of its load.
    supply : OilLayer

    Raises
    ------
    InputError
        A profile over y; metres at a point without metres; an L or kappa outside the table.
    """

    name = "supply"

    def __init__(self, point: Point, supply: OilLayer) -> None:
        require_uniform(supply)
        self.moes, self.scales, self.supply = moes_point(point), scales_of(point), supply
        require_supply(supply, self.moes, self.scales)
        box = supply_surface().table.box
        for name in ("L", "kappa"):
            low, high = getattr(box, name)
            if not low <= getattr(self.moes, name) <= high:
                allowed = f"between {low:g} and {high:g}, the box of the table of oil supply"
                raise InputError(name, getattr(self.moes, name), allowed)
        self._heaviest = heaviest_load(self.moes)

    @property
    def omega(self) -> _Floats:
        """Frequencies of the table."""
        return supply_surface().table.omega

    def ratio(self, loads: _Floats, h_central: _Floats, isothermal: _Floats) -> _Floats:
        """The layer over what the flooded films [dry approaches of their loads] let through.

        A given r is over the `isothermal` ones: it stands for the same oil where heat leaves thinner films.
        """
        if self.supply.over_flooded is not None:
            return float(self.supply.over_flooded) * (isothermal / h_central)
        squeezed = [float(plain(density)(1.0, _loaded(self.moes, load).law)[0]) for load in loads.tolist()]
        layer = self.supply.unit(self.moes, self.scales, np.nan) * float(self.supply.at(0.0))
        return np.asarray(layer / (loads ** (2.0 / 3.0) * h_central * squeezed))

    def change(self, loads: _Floats, values: _Floats, Omega: _Floats, isothermal: _Floats | None = None) -> Change:
        """Change of the flooded `values`, shape (n, 5 + 2 k) with K and C at `Omega`, under `loads`.

        Where they are films with heat, `isothermal` are the central ones without it, shape (n,).
        """
        ratio = self.ratio(loads, values[:, 1], values[:, 1] if isothermal is None else isothermal)
        self._require_inside(loads, ratio)
        surface, k = supply_surface(), Omega.size
        found, half = surface.at(self._rows(loads), ratio), NUMBERS + surface.table.omega.size
        nodes = surface.table.omega
        along = over_frequency(nodes, np.minimum(Omega, nodes[-1]), LOW_OMEGA)
        film, lobe, approach, moment = found.rows[:, :NUMBERS].T
        share = share_of_layer(ratio, np.full(loads.size, self.moes.kappa)) * np.exp(film)
        K, C = np.exp(found.rows[:, NUMBERS:half] @ along), found.rows[:, half:] @ along
        flooded = values[:, HEAD + k :] / values[:, [LOW]]
        unit = np.maximum(flooded, FAINT)
        bars = np.hstack(
            [
                found.bars[:, :NUMBERS],
                *(found.bars[:, part] @ np.abs(along) for part in (slice(NUMBERS, half), slice(half, None))),
            ]
        )
        damping, b_damping = unit * np.sinh(C), unit * np.cosh(C) * bars[:, NUMBERS + k :]
        low = int(np.searchsorted(Omega, REFERENCE))
        head = [1.0 - approach, share, share * np.exp(lobe), damping[:, low], 1.0 + moment]
        b_film, b_lobe, b_approach, b_moment = bars[:, :NUMBERS].T
        b_head = [b_approach, share * b_film, head[2] * np.hypot(b_film, b_lobe), b_damping[:, low], b_moment]
        head[0] = head[0] * np.minimum(ratio / surface.table.ratios[0], 1.0)
        return Change(
            np.column_stack([*head, K, damping]),
            np.column_stack([*b_head, K * bars[:, NUMBERS : NUMBERS + k], b_damping]),
        )

    def approaches(self, loads: _Floats, flooded: _Floats, values: _Floats) -> _Floats:
        """Approaches of changed `values` under increasing loads, which rise under one layer in m.

        Dry approach less approach is the central film and what the surfaces deflect less than dry ones at their
        centre. Under one layer the film falls with a light load, to the layer at most as that goes to zero, and
        the other part grows at most as it does `flooded`. What loads lighter than the table's borrow from its
        lightest is off by up to a tenth, more than the approach rises. It is raised by the least that keeps this.
        """
        if self.supply.over_flooded is not None:
            return values[:, 0]
        unit = loads ** (2.0 / 3.0)
        film, full = (1.0 - values[:, 0]) * unit, flooded[:, 1] * unit
        other = np.minimum(np.diff((1.0 - flooded[:, 0]) * unit - full), MOST_GROWN * np.diff(unit))
        may_grow = np.append(0.0, np.cumsum(np.maximum(np.diff(full), 0.0) + other))
        least = np.maximum.accumulate((film - may_grow)[::-1])[::-1] + may_grow
        raised = (least > film) & (loads < lightest_load(self.moes))
        return np.where(raised, 1.0 - least / unit, values[:, 0])

    def _rows(self, loads: _Floats) -> _Floats:
        """M, L and kappa at which the table is read."""
        M = np.clip(loads, lightest_load(self.moes), self._heaviest) * self.moes.M
        return np.column_stack([M, np.full(loads.size, self.moes.L), np.full(loads.size, self.moes.kappa)])

    def _require_inside(self, loads: _Floats, ratio: _Floats) -> None:
        if loads.min() > self._heaviest:
            most = self._heaviest * self.moes.M
            allowed = f"at most {most:.4g}, where the table of oil supply ends at these L and kappa"
            raise InputError("M", self.moes.M * float(loads.min()), allowed)
        # of lighter loads, which hardly deform, the thinnest layer is a film, not a dry contact
        thinnest = float(ratio[loads >= lightest_load(self.moes)].min(initial=np.inf))
        if thinnest < THINNEST:
            allowed = (
                f"at least {THINNEST:g} flooded films everywhere (under a layer like that the contact is dry)"
            )
            raise InputError("supply", f"{thinnest:.2g} flooded films", allowed)

    def noted(self, flooded: float, film: float) -> dict[str, Any]:
        """r, for which the flooded isothermal central film is needed."""
        isothermal = np.array([flooded])
        return {"over_flooded": float(self.ratio(np.ones(1), isothermal, isothermal)[0])}

    def to_dict(self) -> dict[str, Any]:
        """Its inputs, ready for JSON."""
        return self.supply.to_dict()


def _loaded(moes: MoesPoint, load: float) -> MoesPoint:
    """The point under another load, in units of its own."""
    return replace(moes, M=moes.M * float(load))
