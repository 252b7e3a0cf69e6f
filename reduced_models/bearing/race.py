"""`Race`: contact of a ball with one race: geometry, oil, films and element from the atlas at a speed.

Tables for the C core are in `race_table`, forces in time steps in ``race_contact.c``.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from math import ceil, cos, inf, log10, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ehlcontact import Geometry, Lubricant, OperatingPoint, assumptions
from ehlcontact.asperities import Asperities
from ehlcontact.assumptions import Assumptions
from ehlcontact.assumptions.judge import ROUGHEST
from ehlcontact.checks import require_nonnegative
from ehlcontact.checks.admissible_range import CONFORMITY, LIMITS
from ehlcontact.conditions import FLOODED, Conditions
from ehlcontact.errors import InputError
from ehlcontact.hertz import hertz_contact, radius_ratio
from reduced_models.atlas.answer import AtlasAnswer
from reduced_models.atlas.atlas import Atlas
from reduced_models.atlas.heat import ellipses, fastest
from reduced_models.atlas.supply import heaviest_load, supply_box
from reduced_models.bearing.bearing_conditions import conditions_of
from reduced_models.bearing.kinematics import RPM_TO_RAD_S, speed_sum_per_omega
from reduced_models.bearing.ring import STEEPEST, RingEquilibrium
from reduced_models.elements.film_contact import FilmContact

_Floats = NDArray[np.float64]

RACES = ("inner", "outer")
INSIDE = 1e-9  # relative, that points asked for keep from the ends of the atlas: those are rounded
PER_DECADE = 7.0  # loads that elements go through
NEAR = 1e-3  # of a step in ln F, within which one is left out beside an end: nothing may jump where that happens
FILMS = "h_central", "h_min", "moment"
POWER_OF_SPEED = 4.0  # L is the fourth root of a speed
SOME_SPEED = 1000.0  # rev/min, at which an oil is tried


@lru_cache(maxsize=4)
def shared_atlas(path: str | None) -> Atlas:
    """The atlas of a file, or the shipped one, read once."""
    return Atlas(path)


def require_roughness(name: str, rq: float | None) -> None:
    """Raise `InputError` for a roughness [m] below 0 or beyond any rolling surface; None is none given."""
    if rq is not None and require_nonnegative(name, rq) > ROUGHEST:
        raise InputError(name, rq, f"from 0 to {ROUGHEST:g} m (given in um?)")


@dataclass(frozen=True)
class Race:
    """Contact of a ball with one race.

    Parameters
    ----------
    name : {"inner", "outer"}
    geometry : Geometry
    ball_diameter : float
        In m.
    conformity : float
        Groove radius over ball diameter.
    oil : Lubricant or None
        None is dry.
    speed_sum : float
        Sum of the surface speeds over the angular speed of the shaft [m].
    atlas : str or None
        File of another atlas than the shipped one.
    conditions : Conditions
        Layer ahead of the contact, and heat of its film.
    """

    name: str
    geometry: Geometry
    ball_diameter: float
    conformity: float
    oil: Lubricant | None
    speed_sum: float
    atlas: str | None = None
    conditions: Conditions = FLOODED

    @cached_property
    def kn(self) -> float:
        """Force over approach^1.5 of the dry contact [N/m^1.5]."""
        body = self.geometry
        return float(hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced).approach ** -1.5)

    def point(self, load: float, speed_rpm: float) -> OperatingPoint:
        """Operating point of the contact under a load [N] at a speed of the shaft."""
        assert self.oil is not None
        return OperatingPoint(self.geometry, self.oil, load, self.speed_sum * speed_rpm * RPM_TO_RAD_S)

    def _unit_point(self, speed_rpm: float) -> OperatingPoint:
        """Operating point under 1 N, that of the last speed kept."""
        if speed_rpm not in self._last_unit_point:
            self._last_unit_point.clear()
            self._last_unit_point[speed_rpm] = self.point(1.0, speed_rpm)
        return self._last_unit_point[speed_rpm]

    @cached_property
    def _last_unit_point(self) -> dict[float, OperatingPoint]:
        return {}

    @property
    def highest_speed(self) -> float:
        """Speed of the shaft [rev/min] up to which the atlas reaches, with its tables of supply and heat."""
        return self.end[0]

    @property
    def end(self) -> tuple[float, str]:
        """That speed, and the table that ends there."""
        unit = self.point(1.0, 1.0)
        boxes = {"the atlas": shared_atlas(self.atlas).box}
        if self.conditions.supply is not None:
            boxes["the table of oil supply"] = supply_box()
        ends = [((box.L[1] / unit.moes.L) ** POWER_OF_SPEED, table) for table, box in boxes.items()]
        if self.conditions.heat is not None:
            ends.append((fastest(unit, self.conditions.heat), "the table of heat"))
        most, table = min(ends)
        return float(most * (1.0 - INSIDE)), table

    def loads(self, speed_rpm: float) -> tuple[float, float]:
        """Range of loads [N] of the atlas at this speed."""
        box, unit = shared_atlas(self.atlas).box, self._unit_point(speed_rpm).moes
        highest = min(box.M[1] / unit.M, (box.p_hertz / unit.p_hertz) ** 3)
        return box.M[0] / unit.M * (1.0 + INSIDE), highest * (1.0 - INSIDE)

    def heaviest(self, speed_rpm: float) -> tuple[float, str]:
        """Largest load [N] of a ball, and what ends there: the atlas at this speed, or elastic steel where dry."""
        if self.oil is not None:
            heaviest = self.loads(speed_rpm)[1]
            if self.conditions.supply is not None:
                supplied = heaviest_load(self._unit_point(speed_rpm).moes)
                if supplied < heaviest:
                    return supplied, "the end of the table of oil supply at this speed"
            return heaviest, "the end of the atlas at this speed"
        body = self.geometry
        unit = hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced).pressure
        most = f"{1e-9 * LIMITS.p_hertz:g} GPa, beyond which no steel stays elastic"
        return float((LIMITS.p_hertz / unit) ** 3), most

    def require_bearable(self, force: float, speed_rpm: float, field: str, value: object) -> None:
        """Raise `InputError`, of a field and its value, for a `force` [N] that the contact does not bear."""
        highest, end = self.heaviest(speed_rpm)
        if force > highest:
            allowed = f"such that a ball carries at most {highest:.4g} N on the {self.name} race, {end}"
            raise InputError(field, value, f"{allowed} (here {force:.4g} N)")

    def element(self, speed_rpm: float) -> FilmContact:
        """Contact element for all loads of the atlas at this speed, in SI.

        It goes through the same loads in N at every speed, but for its ends: so K and C change smoothly with it.
        Its inlet does not saturate: so the contacts of a bearing have it (``race_contact.c``).
        """
        low, high = self.loads(speed_rpm)
        first, last = PER_DECADE * log10(low) + NEAR, PER_DECADE * log10(high) - NEAR
        inside = 10.0 ** (np.arange(ceil(first), ceil(last)) / PER_DECADE)
        loads = np.concatenate([[low], inside, [high]])
        reference = float(np.sqrt(low * high))
        with self._films_named(speed_rpm):
            return shared_atlas(self.atlas).wide(
                self.point(reference, speed_rpm), loads / reference, saturating=False, **self.conditions.keywords
            )

    @contextmanager
    def _films_named(self, speed_rpm: float) -> Iterator[None]:
        """Let an `InputError` of approaches under a layer of oil, which nobody gave, name layer and contact."""
        try:
            yield
        except InputError as error:
            supply = self.conditions.supply
            if supply is None or not error.field.startswith("approach"):
                raise
            h, r = supply.h, supply.over_flooded
            layer = f"{r:.4g} flooded films" if h is None else f"{1e6 * h:.4g} µm"
            allowed = (
                f"another layer, or left out: on the {self.name} race at {speed_rpm:.4g} rev/min no element "
                f"can be made of the films under it; a thicker one helps, or one over the flooded film "
                f"(OilLayer(over_flooded=), layer_ratio in a file): {error}"
            )
            raise InputError("supply", layer, allowed) from error

    def answer(self, load: float, speed_rpm: float) -> AtlasAnswer:
        """Of the atlas for the contact under a load [N] at this speed."""
        at = self.point(load, speed_rpm)
        return shared_atlas(self.atlas).at(at, **self.conditions.keywords)

    def films(self, speed_rpm: float, load: _Floats, gap: _Floats) -> tuple[_Floats, _Floats, _Floats]:
        """Central and smallest film [m], and moment of the pressure [N m], under loads [N] at this speed.

        Below the lightest load that the atlas has, the bodies are as good as rigid: both films are the `gap`, and
        the moment is that of the lightest load: of rigid surfaces in a flooded inlet it hardly depends on load,
        for pressures grow as fast as what they press on shrinks.
        """
        lightest = self.loads(speed_rpm)[0]
        central, smallest, moment = self._answers(np.maximum(load, lightest), speed_rpm)
        rigid = load < lightest
        return np.where(rigid, gap, central), np.where(rigid, gap, smallest), moment

    def _answers(self, load: _Floats, speed_rpm: float) -> tuple[_Floats, _Floats, _Floats]:
        """Films and moment of the atlas under loads [N]; flooded and isothermal ones all at once."""
        if self.conditions != FLOODED:
            answers = [self.answer(one, speed_rpm) for one in load.tolist()]
            return tuple(np.array([getattr(one, name) for one in answers]) for name in FILMS)  # type: ignore[return-value]
        unit = self._unit_point(speed_rpm)  # M is as the load, approach and semi-axes as its powers 2/3 and 1/3
        moes, scales = unit.moes, unit.scales
        found = shared_atlas(self.atlas).over(load * moes.M, moes.L, moes.kappa, alpha=moes.alpha, eta0=moes.eta0)
        length, moment = scales.length * load ** (2.0 / 3.0), scales.moment * load ** (4.0 / 3.0)
        return length * found.h_central, length * found.h_min, moment * found.moment

    def at_angle(self, pitch_diameter: float, contact_angle: float, speed_sum: float) -> Race:
        """The contact of one ball at its own angle [rad] and sum of surface speeds over that of the shaft [m].

        An unloaded ball may stand at any angle: beyond `STEEPEST` it has the radii of that angle.
        """
        body = self.geometry
        material = {"e1": body.e1, "e2": body.e2, "nu1": body.nu1, "nu2": body.nu2}
        cone = pitch_diameter / cos(min(abs(contact_angle), STEEPEST))
        own = Geometry.ball_bearing(self.ball_diameter, cone, self.conformity, self.name, **material)
        return replace(self, geometry=own, speed_sum=speed_sum)

    def require_in_atlas(self) -> None:
        """Raise `InputError` for a conformity whose ellipse, or an oil, that the atlas does not have."""
        low, high = shared_atlas(self.atlas).box.kappa
        if self.conditions.heat is not None:
            low, high = max(low, ellipses()[0]), min(high, ellipses()[1])
        if not low <= self.geometry.kappa <= high:
            ends = [_conformity(self, kappa) for kappa in (low, high)]
            least, most = f"at least {ends[0]:.4f}", f"between {ends[0]:.4f} and {ends[1]:.4f}"
            between = most if ends[1] <= CONFORMITY.limits[1] else least
            table = "the atlas" if self.conditions.heat is None else "the table of heat"
            allowed = f"{between}: its ellipse, a/b = {self.geometry.kappa:.4g}, lies outside {table}"
            raise InputError(f"conformity_{self.name}", self.conformity, f"{allowed} ({low:g} to {high:g})")
        self.element(min(self.highest_speed, SOME_SPEED))  # raises where the oil is none of the atlas


def race_of(bearing: Any, name: str) -> Race:
    """Contact of a `BallBearing` with one race; errors name that race's conformity."""
    conformity = getattr(bearing, f"conformity_{name}")
    material = {"e1": bearing.youngs_modulus, "e2": bearing.youngs_modulus}
    material |= {"nu1": bearing.poisson_ratio, "nu2": bearing.poisson_ratio}
    cosine = 1.0 if bearing.contact_angle is None else cos(bearing.contact_angle)
    try:
        cone = bearing.pitch_diameter / cosine  # at a contact angle, radii are those of a cone
        body = Geometry.ball_bearing(bearing.ball_diameter, cone, conformity, name, **material)
    except InputError as error:
        own = {"conformity": f"conformity_{name}", "e1": "youngs_modulus", "nu1": "poisson_ratio"}
        raise InputError(own.get(error.field, error.field), error.value, error.allowed) from None
    speed_sum = speed_sum_per_omega(bearing.pitch_diameter, bearing.gamma * cosine)
    return Race(
        name=name,
        geometry=body,
        ball_diameter=bearing.ball_diameter,
        conformity=conformity,
        oil=bearing.oil,
        speed_sum=speed_sum,
        atlas=bearing.atlas,
        conditions=conditions_of(bearing),
    )


def rough_surfaces(bearing: Any, force: _Floats, h_central: _Floats, h_min: _Floats) -> dict[str, Any]:
    """Lambda ratios of films of a `BallBearing`, and load shares of typical asperities; none without roughness."""
    if not bearing.roughness:
        return {}
    rough, share = Asperities(bearing.roughness), np.zeros_like(force)
    for column, name in enumerate(RACES):
        body, carry = bearing.race(name).geometry, force[:, column] > 0.0
        unit = 2.0 / 3.0 * hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced).pressure
        mean = unit * np.cbrt(force[carry, column])
        share[carry, column] = rough.load_share(h_central[carry, column], mean, body.e_reduced)
    return {"lambda_ratio": h_min / bearing.roughness, "asperity_share": share}


def races_at_angles(bearing: Any, name: str, angles: _Floats, speed_sums: _Floats) -> list[Race]:
    """Contacts of balls of a `BallBearing` with one race, at their own angles [rad] and speed sums [m]."""
    nominal, made = bearing.race(name), {}
    if bearing.contact_angle is None:  # balls of a radial load all run at an angle of 0
        made = {
            (0.0, speed): nominal for speed in speed_sums.tolist() if abs(speed / nominal.speed_sum - 1.0) < INSIDE
        }
    keys = list(zip(angles.tolist(), speed_sums.tolist(), strict=True))
    for key in keys:
        if key not in made:
            made[key] = nominal.at_angle(bearing.pitch_diameter, *key)
    return [made[key] for key in keys]


def assumptions_under(bearing: Any, speed_rpm: float, places: Sequence[RingEquilibrium]) -> Assumptions:
    """Worst of the assumptions at the heaviest contacts of a `BallBearing` in oil with each race."""
    rough = (bearing.roughness / sqrt(2.0),) * 2 if bearing.roughness else None
    found = []
    for race, force in _heaviest_contacts(bearing, places):
        load = max(force, race.loads(speed_rpm)[0])
        point, film = race.point(load, speed_rpm), race.answer(load, speed_rpm)
        found.append(assumptions(point, film=film, roughness=rough))
    return Assumptions.worst_of(found)


def beyond_data(
    bearing: Any, speed_rpm: float, places: Sequence[RingEquilibrium], omega: _Floats | None = None
) -> str:
    """What films of a `BallBearing` at rest, or at frequencies [rad/s], go beyond the atlas, in words; else empty.

    The most loaded contacts with each race count, the lighter ones hardly matter.
    """
    if bearing.oil is None:
        return ""
    found, highest = [], np.inf
    for name, (race, force) in zip(RACES, _heaviest_contacts(bearing, places), strict=True):
        lightest = race.loads(speed_rpm)[0]
        if force < lightest:
            found.append(f"{force:.3g} N on the {name} race, the atlas begins at {lightest:.3g} N")
        if omega is not None:
            highest = min(highest, float(race.answer(max(force, lightest), speed_rpm).omega[-1]))
    said = [f"no ball carries more than {' and '.join(found)}"] if found else []
    if omega is not None and omega.max() > highest:
        hz = highest / (2.0 * np.pi)
        said.append(f"the atlas ends at {hz:.3g} Hz, K and C above it are those of the elements")
    return "; ".join(said)


def beyond_loads(bearing: Any, name: str, speed_rpm: float, largest: _Floats) -> tuple[list[str], list[str]]:
    """Where balls of a `BallBearing` carried more, and where all carried less, than the atlas has, in words.

    Parameters
    ----------
    bearing : BallBearing
    name : str
        Of the bearing.
    speed_rpm : float
        Of the shaft [rev/min].
    largest : ndarray, shape (2,)
        Largest force on a ball at the inner and the outer race [N].
    """
    heavy: list[str] = []
    light: list[str] = []
    if bearing.oil is None:
        return heavy, light
    for race, load in zip(RACES, largest.tolist(), strict=True):
        least, most = bearing.race(race).loads(speed_rpm)
        if load > most:
            heavy.append(f"a ball of {name} carried {load:.4g} N on the {race} race (atlas up to {most:.4g} N)")
        elif load < least:
            light.append(
                f"no ball of {name} carried more than {load:.3g} N on the {race} race (atlas from {least:.3g} N)"
            )
    return heavy, light


def _heaviest_contacts(bearing: Any, places: Sequence[RingEquilibrium]) -> Iterator[tuple[Race, float]]:
    """The most loaded contact with each race at its angle, and its force [N]."""
    for column, name in enumerate(RACES):
        at = max(places, key=lambda one: float(one.force[:, column].max()))
        k = int(np.argmax(at.force[:, column]))
        race = races_at_angles(bearing, name, at.angles[k : k + 1, column], at.speed_sum[k : k + 1, column])[0]
        yield race, float(at.force[k, column])


def films_under(bearing: Any, speed_rpm: float, at: RingEquilibrium) -> dict[str, Any]:
    """Films of all balls of a `BallBearing` at rest, and what they resist, by the names of `BearingState`.

    Each has the angle, curvature and entrainment speed of its contact.

    Raises
    ------
    InputError
        A speed or a force beyond the atlas at these angles.
    """
    h_central, h_min, moment, radius = contact_films(bearing, speed_rpm, at.load, at.balls)
    # power m u/Rx of every film over the speed of the shaft, u = u_sum/2
    torque = float((0.5 * at.speed_sum * moment / radius).sum())
    found: dict[str, Any] = {"h_central": h_central, "h_min": h_min, "moment": moment, "rolling_torque": torque}
    found["outside_assumptions"] = assumptions_under(bearing, speed_rpm, [at]).headline
    found["reservation"] = beyond_data(bearing, speed_rpm, [at])
    return found | rough_surfaces(bearing, at.force, h_central, h_min)


def contact_films(
    bearing: Any, speed_rpm: float, ring_load: _Floats, balls: NDArray[np.void]
) -> tuple[_Floats, _Floats, _Floats, _Floats]:
    """Films of balls of a `BallBearing` at rest, records `AT_REST` of shape (n,): of one ring, or of many.

    Parameters
    ----------
    bearing : BallBearing
    speed_rpm : float
        Of the shaft [rev/min].
    ring_load : ndarray
        Load [N] that an error names.
    balls : ndarray, shape (n,)

    Returns
    -------
    h_central, h_min, moment, radius_x : ndarray, shape (n, 2)
        Films [m], what they resist [N m], radii of relative curvature along rolling [m].

    Raises
    ------
    InputError
        A speed or a force beyond the atlas at these angles.
    """
    h_central, h_min, moment, radius = np.zeros((4, balls.size, len(RACES)))
    for column, name in enumerate(RACES):
        nominal = bearing.race(name)
        races = races_at_angles(bearing, name, balls["angle"][:, column], balls["speed_sum"][:, column])
        members: dict[int, list[int]] = {}
        for k, race in enumerate(races):
            members.setdefault(id(race), []).append(k)
        for own in members.values():
            race, load = races[own[0]], balls["load"][own, column]
            highest, table = race.end
            if race is not nominal and speed_rpm > highest:
                angle = balls["angle"][own[0], column]
                allowed = f"at most {highest:.5g}, where {table} ends at a contact angle of {angle:.3g} rad"
                raise InputError("speed_rpm", speed_rpm, allowed)
            race.require_bearable(float(load.max()), speed_rpm, "load", ring_load.tolist())
            gap = (load / nominal.kn) ** (2.0 / 3.0) - balls["approach"][own, column]
            h_central[own, column], h_min[own, column], moment[own, column] = race.films(speed_rpm, load, gap)
            radius[own, column] = race.geometry.radius_x
            if bearing.cutoff_gap is not None:
                moment[own, column] *= load / (nominal.kn * balls["compression"][own, column] ** 1.5)
    return h_central, h_min, moment, radius


def _conformity(race: Race, kappa: float) -> float:
    """Conformity at which this contact has the ellipse ratio `kappa`; infinite where none is so wide."""
    closeness = 2.0 - race.ball_diameter * radius_ratio(kappa) / race.geometry.radius_x
    return 1.0 / closeness if closeness > 0.0 else inf
