"""`OilBalance`: oil on the tracks of a bearing, with loss to the sides, replenishment and feed.

A first model, with one unknown for the oil on the tracks and one for the oil beside them:

    dm/dt = -L(m) + s/tau + q,    ds/dt = R L(m) - s/tau.

m is the layer on both surfaces together ahead of every contact, s the oil that was pressed aside and will return,
as a layer. Both races and the balls have one narrow track each, of length ``l = pi ((dm - D) + (dm + D) + Z D)``
together; balls mix what is on them, so that m is the same everywhere. Each surface has m/2, so all contacts
together take

    L = 2 u/l sum_k m x_k(m),    x_k^3 = (1 - h/(h_ff r))^3 + (1 - (1 + S m^2)^(-1/2))^3

off it: x is the share that leaves the track in a pass, ahead of a starved film (`film_formulas.film_of_layer`,
thick layers) and by side flow (`ehlcontact.side_flow`, thin ones). The exponent 3 is fitted to films of a
circle, within 7 %; in wide contacts one part is large where the other is small.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from math import inf, pi
from typing import Annotated, Any, ClassVar

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, parts, require_between, require_instance
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.film_formulas import film_of_layer, layer_sharpness
from ehlcontact.jit import plain
from ehlcontact.lubricant import density
from ehlcontact.quantities import LENGTH, NUMBER, TIME
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.side_flow import side_flow
from ehlcontact.summary import Summary
from ehlcontact.supply import OilLayer
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.bearing.fed_layer import FedLayer, lost_share, require_return
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.race import RACES

_Floats = NDArray[np.float64]

THICKEST, THINNEST = 1e3, 1e-6  # flooded films, between which a layer in balance is looked for
ACCURACY = 1e-8  # relative, of layers over time


@fields_take(load=parts.FORCE, speed_rpm=parts.SPEED, feed=parts.FEED, returned=parts.SHARE, sharpness=parts.ANY)
@dataclass(frozen=True, kw_only=True, eq=False)
class OilBalance(Summary):
    """Balance of the oil on the tracks of a ball bearing under a radial load at a speed. SI units.

    Parameters
    ----------
    bearing : BallBearing
        In oil.
    load : tuple of 2 float
        Force on the inner ring (Fx, Fy) [N], as in `BallBearing.equilibrium`.
    speed_rpm : float
        Of the shaft [rev/min].
    feed : float
        Fresh oil that reaches the tracks of races and balls together [m3/s]; 0 when it is cut off.
    returned : float
        R, the share of the oil pressed aside that returns to the tracks, from 0 to 1.
    return_time : float
        tau, time constant of the return [s].
    sharpness : float, optional
        g of the film over its layer (`ehlcontact.film_formulas`), by default that of each contact's ellipse.

    Attributes
    ----------
    state : BearingState
        Loads and flooded films of all balls.

    Raises
    ------
    InputError
        A dry bearing; an axial load; a number outside its range.
    """

    bearing: BallBearing
    load: Any
    speed_rpm: float
    feed: float = 0.0
    returned: float = 0.0
    return_time: float = inf
    sharpness: float | None = None
    state: BearingState = field(init=False, repr=False)

    def __post_init__(self) -> None:
        require_instance("bearing", self.bearing, BallBearing, "a BallBearing")
        if self.bearing.oil is None:
            raise InputError("oil", None, "given to the bearing: a dry one has no oil balance")
        if self.bearing.supply is not None:
            raise InputError("supply", "given to the bearing", "left out: the balance finds it (`lasting_supply`)")
        if np.shape(self.load) != (2,):
            raise InputError("load", self.load, "(Fx, Fy): the balance is for radial loads")
        require_between("feed", self.feed, 0.0, 1.0)
        require_return(self.returned, self.return_time, self.sharpness)
        object.__setattr__(self, "state", self.bearing.equilibrium(self.load, speed_rpm=self.speed_rpm))

    @cached_property
    def _contacts(self) -> _Floats:
        """Layer that the flooded film lets through [m], g and growth of every contact under load, shape (3, k)."""
        assert self.state.h_central is not None
        found = []
        for (k, column), force in np.ndenumerate(self.state.force):
            race = self.bearing.race(RACES[column])
            if force >= race.loads(self.speed_rpm)[0]:
                point = race.point(float(force), self.speed_rpm)
                moes = point.moes
                layer = float(plain(density)(1.0, moes.law)[0]) * float(self.state.h_central[k, column])
                g = layer_sharpness(moes.kappa) if self.sharpness is None else self.sharpness
                found.append((layer, g, side_flow(point) * layer * layer))
        return np.array(found).T

    @property
    def track_length(self) -> float:
        """Of the tracks of both races and all balls together [m]."""
        one = self.bearing
        return pi * (2.0 * one.pitch_diameter + one.balls * one.ball_diameter)

    @property
    def track_width(self) -> float:
        """2 b of the heaviest contact with the inner race [m], on which the feed is spread."""
        force = float(self.state.force[self.state.heaviest, 0])
        return 2.0 * self.bearing.race("inner").point(force, self.speed_rpm).scales.b

    @property
    def flooded(self) -> _Floats:
        """Flooded central films of the most loaded ball [m], at inner and outer race."""
        assert self.state.h_central is not None
        return np.array(self.state.h_central[self.state.heaviest])

    @property
    def full_layer(self) -> float:
        """Layer that the flooded film of the most loaded ball at the inner race lets through [m]."""
        return float(self.flooded[0]) * self._compression("inner")

    def _compression(self, race: str) -> float:
        force = float(self.state.force[self.state.heaviest, RACES.index(race)])
        law = self.bearing.race(race).point(force, self.speed_rpm).moes.law
        return float(plain(density)(1.0, law)[0])

    @takes(layer=parts.LAYER._replace(zero=True))
    def films(self, layer: ArrayLike) -> _Floats:
        """Central films of the most loaded ball [m], shape (..., 2): at inner and outer race under a layer [m]."""
        found = []
        for column, race in enumerate(RACES):
            full = self._compression(race) * float(self.flooded[column])
            kappa = self.bearing.race(race).geometry.kappa
            g = layer_sharpness(kappa) if self.sharpness is None else self.sharpness
            found.append(self.flooded[column] * film_of_layer(np.asarray(layer, dtype=float) / full, g))
        return np.stack(found, axis=-1)

    @takes(layer=parts.LAYER)
    def loss_rate(self, layer: float) -> float:
        """L: rate at which all contacts together thin a layer [m/s]."""
        passes = self.bearing.race("inner").speed_sum * self.speed_rpm * RPM_TO_RAD_S / self.track_length
        full, sharpness, growth = self._contacts
        return float(passes * layer * lost_share(layer / full, sharpness, growth).sum())

    @takes(layer=parts.LAYER)
    def feed_for(self, layer: float) -> float:
        """Feed that keeps a layer [m] for good [m3/s]."""
        lost = (1.0 - self.returned) * self.loss_rate(layer)
        return 0.5 * lost * self.track_length * self.track_width

    @property
    def lasting_layer(self) -> float:
        """Layer that the feed keeps for good [m]; 0 without any.

        Raises
        ------
        InputError
            All oil pressed aside returns, and the feed floods the tracks; or a feed outside the range of layers.
        """
        if self.feed == 0.0:
            return 0.0
        ends = THINNEST * self.full_layer, THICKEST * self.full_layer
        low, high = (self.feed_for(end) for end in ends)
        if not low <= self.feed <= high:
            raise InputError("feed", self.feed, f"from {low:.3g} to {high:.3g} m3/s, which keep a layer")
        return float(scipy.optimize.brentq(lambda layer: self.feed_for(layer) - self.feed, *ends, rtol=ACCURACY))

    @property
    def lasting_supply(self) -> FedLayer:
        """That layer as the ``supply`` of a `BallBearing`, whose `coefficients` then hold the feed, not the layer.

        Raises
        ------
        InputError
            No feed; else as `lasting_layer`.
        """
        if self.feed == 0.0:
            raise InputError("feed", 0.0, "> 0: without any no layer lasts")
        time = self.return_time if self.returned else inf
        return FedLayer(h=self.lasting_layer, returned=self.returned, return_time=time, sharpness=self.sharpness)

    def history(self, layer: OilLayer, t: ArrayLike) -> OilHistory:
        """Layer and films over time.

        Parameters
        ----------
        layer : OilLayer
            Uniform, at the first time: `h` in m, or `over_flooded` as times `full_layer`.
        t : array_like
            Times [s], increasing.
        """
        require_instance("layer", layer, OilLayer, "an OilLayer(h)")
        if layer.y is not None or layer.H is not None:
            raise InputError("layer", "a profile or H", "a uniform layer, h or over_flooded")
        times = as_column("t", t, increasing=True)
        start = layer.h if layer.h is not None else layer.over_flooded * self.full_layer
        fresh = 2.0 * self.feed / (self.track_length * self.track_width)

        def rates(_: float, y: _Floats) -> list[float]:
            lost = self.loss_rate(y[0]) if y[0] > 0.0 else 0.0
            back = y[1] / self.return_time
            return [back - lost + fresh, self.returned * lost - back]

        run = scipy.integrate.solve_ivp(
            rates,
            (times[0], times[-1]),
            [start, 0.0],
            method="LSODA",
            t_eval=times,
            rtol=ACCURACY,
            atol=ACCURACY * THINNEST * start,
        )
        if not run.success:
            raise ConvergenceError(f"balance of the oil: {run.message}", run)
        films = self.films(run.y[0])
        return OilHistory(
            name=self.bearing.name,
            t=times,
            layer=run.y[0],
            aside=run.y[1],
            h_central=films,
            share=films / self.flooded,
        )

    def _summary_lines(self) -> list[str]:
        feed = "no feed" if self.feed == 0.0 else f"feed of {3.6e12 * self.feed:.4g} mm3/h"
        back = f", {100.0 * self.returned:.3g} % of the oil aside returns in {self.return_time:.3g} s"
        half = self.full_layer / self.loss_rate(self.full_layer)
        return [
            f"{self.bearing.name or 'ball bearing'} at {self.speed_rpm:.5g} rev/min, {feed}"
            + (back if self.returned else ""),
            f"flooded films of the most loaded ball"
            f" {1e6 * self.flooded[0]:.4g} and {1e6 * self.flooded[1]:.4g} µm",
            f"a layer of {1e6 * self.full_layer:.4g} µm is lost at first with a time constant of {half:.3g} s",
        ]


@dataclass(frozen=True, eq=False, kw_only=True)
class OilHistory(QuantityTable):
    """Layer on the tracks of a bearing and central films of its most loaded ball over time.

    Attributes
    ----------
    name : str
        Of the bearing.
    t : ndarray, shape (times,)
        In s.
    layer, aside : ndarray, shape (times,)
        m, the layer ahead of every contact, and s, the oil pressed aside that will return, as a layer [m].
    h_central : ndarray, shape (times, 2)
        At inner and outer race [m].
    share : ndarray, shape (times, 2)
        The same over the flooded films.
    """

    name: str
    t: Annotated[_Floats, TIME.over("t")]
    layer: Annotated[_Floats, LENGTH.over("t")]
    aside: Annotated[_Floats, LENGTH.over("t")]
    h_central: Annotated[_Floats, LENGTH.over("t race")]
    share: Annotated[_Floats, NUMBER.over("t race")]

    DISPLAY: ClassVar[Display] = Display(rows="t", panels=("share",), labels={"race": RACES}, logs="x")

    def _summary_lines(self) -> list[str]:
        last = self.share[-1]
        return [
            f"{self.name or 'ball bearing'} over {self.t[-1] - self.t[0]:.4g} s",
            f"layer from {1e6 * self.layer[0]:.4g} to {1e6 * self.layer[-1]:.4g} µm",
            f"film at the end {100.0 * last[0]:.3g} and {100.0 * last[1]:.3g} % of the flooded ones",
        ]
