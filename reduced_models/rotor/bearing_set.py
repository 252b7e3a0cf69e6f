"""`BearingSet`: ball bearings beside each other on one shaft, as preloaded pairs of spindles.

The shaft and the rings are rigid, the outer rings stand still but for those on a spring. z runs along the shaft.
Seen with z to the right, the contact lines of a bearing that faces "+z" meet the axis on its left. So a pair is

| arrangement | facings | contact lines | clamped |
|---|---|---|---|
| back to back (O) | "+z", "-z" | diverge towards the axis: stiff against tilting | by its inner rings |
| face to face (X) | "-z", "+z" | converge towards the axis | by its outer rings |
| tandem | "+z", "+z" | parallel: both carry axial load in +z | by the load, or another bearing |

A set is a rigid `Rotor` of five degrees of freedom on its bearings. Outer rings on a spring have a sixth one,
their displacement along the shaft, and the force of the spring is a load on it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from math import inf, pi, sin
from typing import Any, Self

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ehlcontact.assumptions import Assumptions
from ehlcontact.checks import (
    as_column,
    parts,
    require_choice,
    require_instance,
    require_integer,
    require_names,
    require_positive,
)
from ehlcontact.checks.frequency import by_name, radians_per_second
from ehlcontact.checks.kinds import ENTRIES, NAME, Count, Objects
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import InputError
from ehlcontact.store import stored
from ehlcontact.summary import Summary
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.coefficients import BearingCoefficients, stiffness_and_damping
from reduced_models.bearing.equilibrium import angle_of, direction_of
from reduced_models.bearing.freedoms import FACINGS, FIVE, bearing_load, facing_signs, held_tilt, require_offset
from reduced_models.bearing.operating_clearance import OperatingClearance
from reduced_models.bearing.race import assumptions_under, beyond_data
from reduced_models.bearing.ring import RingEquilibrium, groove_distance, require_seated
from reduced_models.bearing.ring_statics import cage_angles, require_in_grooves, state_of
from reduced_models.bearing.ross_bearing import bearing_element
from reduced_models.bearing.set_result import SetState
from reduced_models.bearing.solved_balls import require_frequencies
from reduced_models.rotor.equilibrium import StaticBearing, StaticRotor
from reduced_models.rotor.linearise import LinearRotor, linear_bearing
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.supports import BearingMount

_Floats = NDArray[np.float64]

ARRANGEMENTS = {"back to back": FACINGS, "face to face": FACINGS[::-1], "tandem": (FACINGS[0], FACINGS[0])}
# Distance of bearings side by side over their ball diameter: widths of spindle bearings are 1.6 to 1.9 of them
SIDE_BY_SIDE = 1.8
FADED = 0.01  # forces of a bearing with films over those of the most loaded one, below which it is unloaded
X, Y, Z, TILT_X, TILT_Y, OUTER_RING = range(len(FIVE) + 1)  # degrees of freedom of a set as a rotor
NAMES = (*FIVE, "z of the outer rings on the spring")
VERTICAL = -0.5 * pi  # rad, of the first ball where no load says where it stands


@stored("set of ball bearings")
@fields_take(
    bearings=Objects(BallBearing, "a BallBearing"), facings=Objects(str, "+z or -z"), positions=parts.SET_PLACE,
    offsets=parts.OFFSET, spring=parts.PRELOAD, name=NAME,
)  # fmt: skip
@dataclass(frozen=True, kw_only=True)
class BearingSet(Summary):
    """Ball bearings on one rigid shaft. SI units; axes of the shaft as in `BallBearing`.

    `pair` and `tandem` make the usual ones; `preloaded`, `grown` and `mounted` change the offsets of any.

    Parameters
    ----------
    bearings : sequence of BallBearing
        At least two, which may differ.
    facings : sequence of {"+z", "-z"}
        Direction in which the inner ring of each is pressed against its outer ring, and the shaft carried.
    positions : sequence of float
        Of the planes of their groove centres along the shaft [m]; loads and moments are those at 0.
    offsets : sequence of float, optional
        Displacement of each inner ring along its facing beside that of the shaft [m], by ground rings, spacers or
        the growth of the shaft: positive ones press. By default 0, where angular contact bearings just touch.
    spring : float
        Force [N] of a spring that presses the outer rings of all bearings of one facing, which slide along the
        shaft, against their balls; it is the same at any displacement.
    sprung : {"+z", "-z"}, optional
        That facing; by default none without a spring, and with one that of the last bearing.
    may_lift_off : bool
        Whether a load may unload a bearing of a set that offsets preload. By default that is an error, which says
        the load where it begins.
    name : str

    Raises
    ------
    InputError
        No such set; an offset in µm, a position in mm, or two bearings at one place.
    """

    bearings: Sequence[BallBearing]
    facings: Sequence[str]
    positions: Sequence[float]
    offsets: Sequence[float] = ()
    spring: float = 0.0
    sprung: str | None = None
    may_lift_off: bool = False
    name: str = ""

    def __post_init__(self) -> None:
        bearings = tuple(self.bearings)
        require_integer("number of bearings", len(bearings), "at least 2", 2)
        for name in ("positions", "offsets"):
            object.__setattr__(self, name, tuple(as_column(name, getattr(self, name), least=0).tolist()))
        offsets = self.offsets or (0.0,) * len(bearings)
        kept = {"bearings": bearings, "facings": self.facings, "positions": self.positions, "offsets": offsets}
        for name, values in kept.items():
            if len(values) != len(bearings):
                raise InputError(name, f"{len(values)} of them", f"one for each of {len(bearings)} bearings")
            object.__setattr__(self, name, tuple(values))
        if len(set(self.positions)) < len(bearings):
            raise InputError("positions", self.positions, "different places [m]")
        for k, bearing in enumerate(bearings):
            if bearing.ring_speeds != bearings[0].ring_speeds:
                allowed = f"{bearings[0].turning!r}, as of the first bearing: they are on one shaft"
                raise InputError(f"bearings[{k}].turning", bearing.turning, allowed)
            facing_signs(self.facings[k])
            require_offset(f"offsets[{k}]", offsets[k], bearing.ball_diameter)
        if self.sprung is None and self.spring > 0.0:
            object.__setattr__(self, "sprung", self.facings[-1])
        if self.sprung is not None:
            require_choice("sprung", self.sprung, FACINGS)
            if self.sprung not in self.facings or set(self.facings) == {self.sprung}:
                allowed = "the facing of some of the bearings, not of all: the others hold the shaft"
                raise InputError("sprung", self.sprung, allowed)
            for k, offset in enumerate(offsets):
                if self.facings[k] == self.sprung and offset != 0.0:
                    raise InputError(f"offsets[{k}]", offset, "0 of a bearing on the spring, which takes it up")

    @classmethod
    @takes(distance=parts.DISTANCE, preload=parts.PRELOAD, offset=parts.OFFSET, spring=parts.PRELOAD)
    def pair(
        cls,
        bearing: BallBearing,
        arrangement: str = "back to back",
        *,
        other: BallBearing | None = None,
        distance: float | None = None,
        preload: float | None = None,
        offset: float | None = None,
        spring: float | None = None,
        **options: Any,
    ) -> Self:
        """Two bearings, their planes at equal distances from 0.

        Parameters
        ----------
        bearing : BallBearing
            The first along z.
        arrangement : {"back to back", "face to face", "tandem"}
        other : BallBearing, optional
            The second one; by default like the first.
        distance : float, optional
            Of their planes [m]; by default 1.8 times the mean ball diameter, about that of bearings side by side.
        preload : float, optional
            Axial force between both [N], set by offsets at mounting: see `preloaded`.
        offset : float, optional
            By which both inner rings are pressed together [m], half of it by each.
        spring : float, optional
            Force on the outer ring of the second bearing [N], which slides along the shaft.
        **options
            ``may_lift_off`` and ``name`` of the class.

        Raises
        ------
        InputError
            No such arrangement; two kinds of preload; bearings in tandem, which cannot preload each other.
        """
        require_choice("arrangement", arrangement, tuple(ARRANGEMENTS))
        require_instance("bearing", bearing, BallBearing, "a BallBearing")
        preloads = {"preload": preload, "offset": offset, "spring": spring}
        preloads = {name: value for name, value in preloads.items() if value is not None}
        if len(preloads) > 1:
            raise InputError(
                " and ".join(preloads), list(preloads.values()), f"{' or '.join(preloads)}, not together"
            )
        if preloads and arrangement == "tandem":
            name, value = next(iter(preloads.items()))
            raise InputError(name, value, "left out: bearings in tandem do not press each other")
        both = bearing, bearing if other is None else other
        require_instance("other", both[1], BallBearing, "a BallBearing")
        if distance is None:
            distance = SIDE_BY_SIDE * 0.5 * (both[0].ball_diameter + both[1].ball_diameter)
        _require_apart(distance, *both)
        apart, half = 0.5 * distance, 0.5 * (0.0 if offset is None else offset)
        pair = cls(
            bearings=both,
            facings=ARRANGEMENTS[arrangement],
            positions=(-apart, apart),
            offsets=(half, half),
            spring=0.0 if spring is None else require_positive("spring", spring),
            **options,
        )
        return pair if preload is None else pair.preloaded(preload)

    @classmethod
    @takes(count=Count(2, 100), distance=parts.DISTANCE)
    def tandem(
        cls, bearing: BallBearing, count: int = 2, *, distance: float | None = None, **options: Any
    ) -> Self:
        """Equal bearings that all face "+z", about 0.

        Parameters
        ----------
        bearing : BallBearing
        count : int
            At least 2.
        distance : float, optional
            Of two neighbours [m]; as of `pair`.
        **options
            ``name`` of the class.
        """
        require_instance("bearing", bearing, BallBearing, "a BallBearing")
        require_integer("count", count, "a whole number >= 2", 2)
        step = SIDE_BY_SIDE * bearing.ball_diameter if distance is None else distance
        _require_apart(step, bearing, bearing)
        positions = (step * (np.arange(count) - 0.5 * (count - 1))).tolist()
        return cls(bearings=(bearing,) * count, facings=(FACINGS[0],) * count, positions=positions, **options)

    @takes(preload=parts.PRELOAD)
    def preloaded(self, preload: float) -> Self:
        """The set with the offsets with which bearings of both facings press each other.

        Parameters
        ----------
        preload : float
            Axial force [N] that all bearings of either facing carry together without outer load, at mounting: at
            rest and without films, as catalogues state it. Centrifugal force and films change it at speed:
            ``equilibrium((0, 0, 0), speed_rpm=...).axial_forces``.

        Raises
        ------
        InputError
            Bearings that all face one way, or are on a spring; a preload that drives balls out of their grooves.
        """
        require_positive("preload", preload)
        if self.sprung is not None:
            raise InputError("preload", preload, "left out: the spring preloads this set")
        if len(set(self.facings)) == 1:
            allowed = f"left out: all bearings face {self.facings[0]}, so that they do not press each other"
            raise InputError("preload", preload, allowed)
        offsets = {facing: self._pressed_by(preload, facing) for facing in FACINGS}
        return replace(self, offsets=tuple(offsets[facing] for facing in self.facings))

    def _pressed_by(self, preload: float, facing: str) -> float:
        """Displacement [m] along their facing by which an axial force presses all bearings of one facing."""
        dry = [bearing.dry for bearing, own in zip(self.bearings, self.facings, strict=True) if own == facing]
        mounts = [BearingMount(bearing=one, x=X, y=Y, z=Z, tilt_x=TILT_X, tilt_y=TILT_Y) for one in dry]
        load = np.eye(len(FIVE))[Z] * preload
        static = StaticRotor(mounts, load, np.zeros((len(FIVE), len(FIVE))), 0.0, {TILT_X: 0.0, TILT_Y: 0.0})
        q, _ = static.search()
        try:
            for bearing, at in zip(dry, static.bearings(q), strict=True):
                require_in_grooves(bearing, at.balls, load[: Z + 1], 0.0)
        except InputError as error:
            raise InputError("preload", preload, error.allowed) from None
        return float(q[Z])

    @takes(growth=parts.OFFSET)
    def grown(self, growth: float) -> Self:
        """The set with a shaft that has become longer than its housing, or with a longer spacer inside.

        Parameters
        ----------
        growth : float
            Longer distance of the first and the last inner ring than of their outer rings [m], evenly along the
            shaft. It unloads pairs back to back and presses those face to face.

        Raises
        ------
        InputError
            A growth that leaves play in a preloaded set; it says how much does.
        """
        places = np.array(self.positions)
        share = (places - 0.5 * (places.min() + places.max())) / np.ptp(places)  # of the growth, along z
        share *= [0.0 if facing == self.sprung else facing_signs(facing)[Z] for facing in self.facings]
        longer = replace(self, offsets=tuple((np.array(self.offsets) + growth * share).tolist()))
        if self._interference > 0.0 >= longer._interference and not self.may_lift_off:
            most = self._interference * growth / (self._interference - longer._interference)
            allowed = f"{'below' if growth > 0.0 else 'above'} {most:.4g} m, where the set has lost its preload"
            raise InputError("growth", growth, allowed)
        return longer

    @takes()
    def mounted(self, clearance: OperatingClearance) -> Self:
        """The set with its angular contact bearings on their seats, warm and turning.

        Its bearings have the contact angles of the mean clearance then. Fits and warmth that take clearance press
        bearings of opposite facings further; a spring takes that up.

        Parameters
        ----------
        clearance : OperatingClearance
            Of every one of the bearings, as `operating_clearance` has it.

        Raises
        ------
        InputError
            A deep-groove bearing; no play left.
        """
        require_instance("clearance", clearance, OperatingClearance, "an OperatingClearance")
        pressed = [0.0 if self.sprung is not None else clearance.offset(bearing) for bearing in self.bearings]
        offsets = [own + more for own, more in zip(self.offsets, pressed, strict=True)]
        return replace(self, bearings=[clearance.of(bearing) for bearing in self.bearings], offsets=offsets)

    @property
    def preload(self) -> float:
        """Axial force [N] by which bearings of opposite facings press each other: unloaded, at rest, dry."""
        if self._interference <= 0.0:
            return 0.0
        forces = self.dry.equilibrium((0.0, 0.0, 0.0)).axial_forces.tolist()
        return float(sum(force for force, own in zip(forces, self.facings, strict=True) if own == self.facings[0]))

    @property
    def dry(self) -> Self:
        """The set without oil: what it is while the shaft stands still."""
        return replace(self, bearings=[bearing.dry for bearing in self.bearings])

    @takes(load="N", speed_rpm="rev/min", cage_angle="rad", tilt="rad")
    def equilibrium(
        self,
        load: ArrayLike,
        *,
        speed_rpm: float = 0.0,
        cage_angle: float | None = None,
        tilt: ArrayLike | None = None,
    ) -> SetState:
        """State in static equilibrium under a load on the shaft, at 0.

        Parameters
        ----------
        load : tuple of 2, 3 or 5 float
            (Fx, Fy) [N], axial motion and tilts held at 0; (Fx, Fy, Fz), tilts held; or (Fx, Fy, Fz, Mx, My) [N],
            [N m]. (0, 0, 0) of a preloaded set.
        speed_rpm : float
            Speed of the shaft [rev/min], for the films and the inertia of the balls; 0 for dry bearings only.
        cage_angle : float, optional
            Angle of the first ball of each bearing from the x axis [rad]; by default it stands under the load.
        tilt : (float, float), optional
            About x and y, of the shaft under (Fx, Fy, Fz) [rad]; by default 0.

        Raises
        ------
        InputError
            A load that nothing carries or that unloads a bearing of a preloaded set; one that a bearing does not
            take, as of `BallBearing.equilibrium`.
        """
        force, speed = bearing_load(load), self.speed(speed_rpm)
        angle = direction_of(force) if cage_angle is None else angle_of(cage_angle)
        rest = self._at_rest(force, speed, [angle] * len(self.bearings), held_tilt(tilt, force.size))
        rows = zip(self.bearings, rest.bearings, strict=True)
        return SetState(
            name=self.name,
            load=rest.load,
            speed_rpm=speed,
            displacement=rest.displacement,
            stiffness=rest.stiffness,
            axial_forces=np.array([balls.load[Z] for balls in rest.bearings]),
            facings=tuple(self.facings),
            bearings=tuple(state_of(bearing, balls, speed, angle) for bearing, balls in rows),
        )

    @takes(load="N", speed_rpm="rev/min", cage_angle="rad", tilt="rad")
    @by_name(2)
    def coefficients(
        self,
        load: ArrayLike,
        *,
        speed_rpm: float = 0.0,
        cage_angle: float | None = None,
        tilt: ArrayLike | None = None,
        omega: ArrayLike | None = None,
        hz: ArrayLike | None = None,
        rpm: ArrayLike | None = None,
    ) -> BearingCoefficients:
        """Stiffness and damping of a small vibration of the shaft about static equilibrium under a load.

        Outer rings on the spring follow without inertia.

        Parameters
        ----------
        load : tuple of 2, 3 or 5 float
            As of `equilibrium`; matrices are those of all five degrees of freedom.
        speed_rpm : float
            Speed of the shaft [rev/min].
        cage_angle : float, optional
            Of the first ball of each bearing [rad]; by default means over a ball passage of all at once.
        tilt : (float, float), optional
            As of `equilibrium`.
        omega, hz, rpm : float or sequence of float
            Frequency of the vibration, in exactly one of these.

        Returns
        -------
        BearingCoefficients
        """
        force, speed = bearing_load(load), self.speed(speed_rpm)
        w = radians_per_second(None, omega=omega, hz=hz, rpm=rpm)
        cages = list(zip(*(cage_angles(bearing, force, cage_angle) for bearing in self.bearings), strict=True))
        held = held_tilt(tilt, force.size)
        rests = [self._at_rest(force, speed, angles, held) for angles in cages]
        full = np.mean([rest.load for rest in rests], axis=0)
        by_bearing = list(zip(*(rest.bearings for rest in rests), strict=True))
        rows = list(zip(self.bearings, by_bearing, strict=True))
        linear = self._linear(full, speed, cage_angle is None, rows, signed=False)
        judged = [assumptions_under(bearing, speed, own) for bearing, own in rows if bearing.oil is not None]
        outside = Assumptions.worst_of(judged).headline if judged else ""
        signed = None
        if any(bearing.supply is not None for bearing in self.bearings):
            solved = self._linear(full, speed, cage_angle is None, rows, signed=True)
            for bearing, balls in zip(self.bearings, solved.balls, strict=True):
                if bearing.supply is not None:
                    require_frequencies(balls, w)
            signed = _coefficients(solved, w)[1]
        left_out = "; ".join(f"bearing {k}: {words}" for k, words in enumerate(linear.damping_left_out) if words)
        beyond = [beyond_data(bearing, speed, own, w) for bearing, own in rows]
        words = "; ".join(f"bearing {k}: {said}" for k, said in enumerate(beyond) if said)
        notes = outside, signed, left_out, "", words
        return BearingCoefficients.of(full, speed, cage_angle, w, _coefficients(linear, w), rests, *notes)

    def _linear(
        self,
        load: _Floats,
        speed: float,
        passage: bool,
        rows: Sequence[tuple[BallBearing, Sequence[RingEquilibrium]]],
        *,
        signed: bool,
    ) -> LinearRotor:
        """The set as a rotor about equilibrium, from the balls of every bearing at all positions of the cage."""
        parts = [linear_bearing(bearing, speed, places, signed) for bearing, places in rows]
        return LinearRotor(
            rotor=self.rotor(load),
            speed_rpm=speed,
            passage=passage,
            rest=np.zeros(self._size),
            loads=np.array([np.mean([balls.load for balls in places], axis=0) for _, places in rows]),
            contacts=(),
            balls=tuple(balls for balls, _ in parts),
            damping_left_out=tuple(words for _, words in parts),
            signed_damping=signed,
        )

    @takes(load="N", speeds_rpm="rev/min")
    @by_name(2)
    def to_ross(
        self,
        node: int,
        *,
        speeds_rpm: ArrayLike,
        load: ArrayLike,
        omega: ArrayLike | None = None,
        hz: ArrayLike | None = None,
        rpm: ArrayLike | None = None,
        **options: Any,
    ) -> Any:
        """Stiffness and damping of the shaft at 0 as a plain ``ross.BearingElement``, as `BallBearing.to_ross`.

        Stiffness against tilts, large for bearings that are apart, has no place in ROSS and is left out:
        `reduced_models.rotor.from_ross` has all of it.
        """
        frequency = {"omega": omega, "hz": hz, "rpm": rpm}
        return bearing_element(self, node, speeds_rpm, load, frequency, **options)

    @takes(speed_rpm="rev/min")
    def lift_off(self, direction: str, *, speed_rpm: float = 0.0) -> float:
        """Axial load [N] in a direction, "+z" or "-z", which unloads a bearing that faces the other way.

        2 sqrt(2) times the preload of an equal pair if the contact angle were constant. 0 where there is play;
        infinite where no bearing faces the other way, or none that can leave its balls. The force of films only
        fades: a bearing counts as unloaded when its balls carry 1 % of those of the most loaded bearing.
        """
        require_choice("direction", direction, FACINGS)
        speed, sign = self.speed(speed_rpm), facing_signs(direction)[Z]
        balls = [support for _, support in self._static(np.zeros(len(FIVE)), speed).mounted]
        signs = [sign * facing_signs(facing)[Z] for facing in self.facings]
        held = [k for k, facing in enumerate(self.facings) if facing != self.sprung]

        def press(along: float) -> None:
            """Move the shaft in the direction [m]."""
            for k in held:
                balls[k].press(np.eye(len(FIVE))[Z] * signs[k] * along)

        def margin(along: float, k: int) -> float:
            press(along)
            return _margin(balls, k)

        def leaves(k: int) -> float:
            first = 0.0 if self.sprung is None else self.offsets[k] - balls[k].ring.longest
            if margin(first, k) <= 0.0:
                return 0.0
            far = self.offsets[k]  # its ring at 0
            while margin(far, k) > 0.0:
                if self.bearings[k].contact_angle is None or far > balls[k].ring.balls.grooves.radial:
                    return inf  # radially preloaded, or pressed on the other side
                far += balls[k].ring.longest
            return float(scipy.optimize.brentq(margin, first, far, args=(k,), xtol=1e-15))

        along = min((leaves(k) for k in held if signs[k] < 0.0), default=inf)
        if along == inf or (along <= 0.0 and self.sprung is None):
            return along
        press(along)
        spring = self.spring if self.sprung == direction else 0.0
        return float(spring + sum(signs[k] * balls[k].ring.load[Z] for k in held))

    @takes(load="N", cage_angle="rad")
    def rotor(
        self,
        load: ArrayLike = (0.0, 0.0, 0.0, 0.0, 0.0),
        *,
        mass: ArrayLike | None = None,
        cage_angle: float = VERTICAL,
    ) -> Rotor:
        """The set as a rigid rotor, for runs and modes.

        Its degrees of freedom are x, y, z, tilt_x and tilt_y of the shaft at 0 (node "shaft"), and z of outer
        rings that slide under a spring (node "outer ring").

        Parameters
        ----------
        load : tuple of 5 float
            (Fx, Fy, Fz, Mx, My) on the shaft at 0 [N], [N m].
        mass : array_like, shape (N, N), optional
            Of the shaft, and of outer rings on the spring [kg], [kg m2]; by default 1 in every direction, which
            changes neither statics nor impedances.
        cage_angle : float
            Of the first ball of each bearing at the start [rad].
        """
        return self._rotor(as_column("load", load, size=len(FIVE)), [cage_angle] * len(self.bearings), mass)

    @property
    def highest_speed(self) -> float:
        """Speed [rev/min] up to which the atlas has films for all of them; infinite where they are dry."""
        return min(bearing.highest_speed for bearing in self.bearings)

    def speed(self, speed_rpm: float) -> float:
        """The speed [rev/min] where all bearings can run at it; raises `InputError` where not."""
        for bearing in self.bearings:
            speed = bearing.speed(speed_rpm)
        return speed

    @property
    def is_preloaded(self) -> bool:
        """Whether offsets or a spring press the bearings without a load."""
        return self._interference > 0.0

    @property
    def _interference(self) -> float:
        """Displacement [m] by which the rings of opposite bearings are pressed together; below 0 there is play.

        Infinite where a radial preload presses a bearing anyhow, or a spring.
        """
        if self.sprung is not None:
            return inf if self.spring > 0.0 else -inf
        most = dict.fromkeys(FACINGS, -inf)
        for bearing, facing, offset in zip(self.bearings, self.facings, self.offsets, strict=True):
            grooves = groove_distance(bearing.ball_diameter, bearing.conformity_inner, bearing.conformity_outer)
            touches = 0.0 if bearing.contact_angle is not None else grooves * sin(bearing.free_angle)
            pressed = inf if bearing.contact_angle is None and bearing.clearance < 0.0 else offset - touches
            most[facing] = max(most[facing], pressed)
        return sum(most.values()) if -inf not in most.values() else -inf

    @property
    def _size(self) -> int:
        """Number of degrees of freedom of the rotor."""
        return len(FIVE) + (self.sprung is not None)

    def _rotor(self, load: _Floats, angles: Sequence[float], mass: ArrayLike | None = None) -> Rotor:
        """The rotor under a load on the shaft, shape (5,), the first ball of each bearing at its angle."""
        rows = zip(self.bearings, self.facings, self.offsets, self.positions, angles, strict=True)
        mounts = tuple(
            BearingMount(
                bearing=bearing,
                x=X,
                y=Y,
                z=Z,
                tilt_x=TILT_X,
                tilt_y=TILT_Y,
                housing=(None, None, OUTER_RING) if facing == self.sprung else None,
                cage_angle=angle,
                facing=facing,
                offset=offset,
                arm=position,
                name=f"bearing {k}",
            )
            for k, (bearing, facing, offset, position, angle) in enumerate(rows)
        )
        nodes = {"shaft": {name: place for place, name in enumerate(FIVE)}}
        full = np.zeros(self._size)
        full[: load.size] = load
        if self.sprung is not None:
            full[OUTER_RING] = -facing_signs(self.sprung)[Z] * self.spring
            nodes["outer ring"] = {"z": OUTER_RING}
        return Rotor(
            mass=np.eye(self._size) if mass is None else mass,  # type: ignore[arg-type]
            stiffness=np.zeros((self._size, self._size)),
            mounts=mounts,
            load=full,
            nodes=nodes,
        )

    def _static(
        self,
        load: _Floats,
        speed: float,
        angles: Sequence[float] | None = None,
        held: Mapping[int, float] | None = None,
    ) -> StaticRotor:
        rotor = self._rotor(load, [VERTICAL] * len(self.bearings) if angles is None else angles)
        return StaticRotor(rotor.mounts, rotor.load, rotor.stiffness, speed, held)

    def _at_rest(self, load: _Floats, speed: float, angles: Sequence[float], tilt: _Floats) -> _SetAtRest:
        """Shaft in equilibrium; raises `InputError` for a load that the set does not take."""
        if load.size > Z:
            self._require_carried(load)
        displacements = np.array([0.0, 0.0, 0.0, *tilt])
        held = dict(enumerate(displacements.tolist()[load.size :], load.size))
        static = self._static(load, speed, angles, held)
        q, share = static.search()
        if share < 1.0:
            allowed = "one under which friction holds the gyroscopic moment of all balls at this speed"
            raise InputError("load", load.tolist(), f"{allowed} (found to {share:.2g} of it)")
        slopes, free = static.slopes(q), static.free
        circle = float(np.mean([support.ring.balls.grooves.groove_circle for _, support in static.mounted]))
        unit = np.array([1.0, 1.0, 1.0, 1.0 / circle, 1.0 / circle, 1.0])[free]  # of lengths, over displacements
        require_seated(slopes[np.ix_(free, free)] * np.outer(unit, unit), load, [NAMES[k] for k in free])
        bearings = static.bearings(q)
        for k, (bearing, at) in enumerate(zip(self.bearings, bearings, strict=True)):
            try:
                require_in_grooves(bearing, at.balls, load, speed)
            except InputError as error:
                raise InputError(error.field, error.value, f"{error.allowed}, in bearing {k}") from None
        self._require_loaded([support for _, support in static.mounted], load, speed)
        full = np.append(load, static.carried(q)[load.size : len(FIVE)])
        return _SetAtRest(q[: len(FIVE)], full, _ring_following(slopes), bearings)

    def _require_carried(self, load: _Floats) -> None:
        """Raise `InputError` for an axial load that nothing carries."""
        for sign, facing in zip((1.0, -1.0), FACINGS, strict=True):
            rows = zip(self.bearings, self.facings, strict=True)
            if any(
                own != self.sprung and (bearing.contact_angle is None or own == facing) for bearing, own in rows
            ):
                continue
            most = self.spring if self.sprung == facing else 0.0
            if sign * load[Z] >= most:
                carried = f"the spring carries {most:g} N" if most > 0.0 else "no bearing carries axial load"
                side = "below" if sign > 0.0 else "above"
                allowed = f"one with Fz {side} {sign * most + 0.0:g} N: {carried} in {facing}"
                raise InputError("load", load.tolist(), allowed)

    def _require_loaded(self, balls: Sequence[StaticBearing], load: _Floats, speed: float) -> None:
        """Raise `InputError` where a load has unloaded a bearing of a set that offsets preload."""
        if self.may_lift_off or self.sprung is not None or not self.is_preloaded:
            return
        for k, facing in enumerate(self.facings):
            if _margin(balls, k) > 0.0:
                continue
            away = FACINGS[1 - FACINGS.index(facing)]
            begins = self.lift_off(away, speed_rpm=speed)
            allowed = (
                f"one that leaves no bearing of the preloaded set unloaded, here bearing {k}: "
                f"an axial load alone does so from {begins:.4g} N in {away} on (or may_lift_off=True)"
            )
            raise InputError("load", load.tolist(), allowed)

    def _summary_lines(self) -> list[str]:
        names = [
            bearing.name or f"{bearing.balls} balls of {1e3 * bearing.ball_diameter:.4g} mm"
            for bearing in self.bearings
        ]
        kinds = ", ".join(dict.fromkeys(names))
        offsets = ", ".join(f"{1e6 * one:.4g}" for one in self.offsets)
        spring = (
            f"; spring of {self.spring:.4g} N on those facing {self.sprung}" if self.sprung is not None else ""
        )
        return [
            f"{self.name or 'set'} of {len(self.bearings)} bearings, {kinds}",
            f"facing {', '.join(self.facings)} at {', '.join(f'{1e3 * one:.4g}' for one in self.positions)} mm",
            f"offsets {offsets} µm{spring}",
        ]

    def to_dict(self) -> dict[str, Any]:
        """All arguments, ready for JSON."""
        entries = {f.name: getattr(self, f.name) for f in fields(self) if f.init}
        entries |= {name: list(entries[name]) for name in ("facings", "positions", "offsets")}
        return entries | {"bearings": [bearing.to_dict() for bearing in self.bearings]}

    @classmethod
    @takes(entries=ENTRIES)
    def from_dict(cls, entries: Mapping[str, Any]) -> Self:
        """Rebuild a set from `to_dict`; raises `InputError` for entries that are missing, unknown or wrong."""
        require_names(entries, [f.name for f in fields(cls) if f.init])
        require_instance("bearings", entries["bearings"], list, "a list of objects")
        return cls(**{**entries, "bearings": [BallBearing.from_dict(bearing) for bearing in entries["bearings"]]})


@dataclass(frozen=True, eq=False)
class _SetAtRest:
    """The shaft of a set in static equilibrium, and its bearings."""

    displacement: _Floats  # (5,) of the shaft [m], [rad]
    load: _Floats  # (5,) [N], [N m], reactions of what is held included
    stiffness: _Floats  # (5, 5)
    bearings: list[RingEquilibrium]  # each in its own frame


def _margin(balls: Sequence[StaticBearing], k: int) -> float:
    """Above 0 while bearing k carries: approach of its most pressed ball [m], or force beyond a share [N]."""
    if balls[k].bearing.oil is None:
        return balls[k].closest
    return balls[k].ring.carried() - FADED * max(bearing.ring.carried() for bearing in balls)


def _ring_following(matrix: NDArray[Any]) -> NDArray[Any]:
    """Matrices over the five degrees of freedom of the shaft, outer rings on a spring following without force."""
    shaft = matrix[..., :OUTER_RING, :OUTER_RING]
    if matrix.shape[-1] == len(FIVE) or not matrix[..., OUTER_RING, OUTER_RING].any():  # fixed, or not pressed
        return shaft
    columns, row = matrix[..., :OUTER_RING, OUTER_RING:], matrix[..., OUTER_RING:, :OUTER_RING]
    return shaft - columns @ row / matrix[..., OUTER_RING:, OUTER_RING:]


def _coefficients(linear: LinearRotor, omega: _Floats) -> tuple[_Floats, _Floats]:
    """Stiffness and damping of the shaft, shape (k, 5, 5), at angular frequencies [rad/s], shape (k,)."""

    def impedance(s: NDArray[np.complex128]) -> NDArray[np.complex128]:
        rows = zip(linear.rotor.mounts, linear.balls, strict=True)
        parts = [(mount.rows(linear.rotor.size), balls.impedance(s)) for mount, balls in rows]
        return _ring_following(np.sum([move.T @ Z @ move for move, Z in parts], axis=0))

    return stiffness_and_damping(impedance, omega)


def _require_apart(distance: float, one: BallBearing, other: BallBearing) -> None:
    """Raise `InputError` for planes of balls that are nearer than balls beside each other."""
    least = 0.5 * (one.ball_diameter + other.ball_diameter)
    if distance < least:
        raise InputError("distance", distance, f"at least {least:g} m, balls beside each other")
