"""`BallBearing`: a deep-groove or angular contact ball bearing, a film under every ball on both races."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from math import degrees, hypot, inf
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact import Lubricant
from ehlcontact.checks import (
    parts,
    require_choice,
    require_finite,
    require_instance,
    require_integer,
    require_names,
    require_nonnegative,
)
from ehlcontact.checks.frequency import by_name, radians_per_second
from ehlcontact.checks.kinds import ENTRIES, FILE, NAME
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import InputError
from ehlcontact.heat import Heat
from ehlcontact.store import stored
from ehlcontact.summary import Summary
from ehlcontact.supply import OilLayer
from reduced_models.bearing.bearing_conditions import condition_lines, conditions_of, require_oil, require_speed
from reduced_models.bearing.bearing_tables import BearingTables
from reduced_models.bearing.catalogue import ROWS, USUAL_CONFORMITY, designation_of
from reduced_models.bearing.clearance import clearance_of_class
from reduced_models.bearing.coefficients import BearingCoefficients
from reduced_models.bearing.contact_angles import CONTROLS
from reduced_models.bearing.equilibrium import angle_of, direction_of
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.bearing.excitation import (
    FILTERS,
    BearingExcitation,
    FeaturedBalls,
    excitation_of,
    require_features,
    turns_of,
    with_cage_slip,
)
from reduced_models.bearing.features import Feature, feature_entries, features_from
from reduced_models.bearing.fed_layer import layer_from
from reduced_models.bearing.freedoms import PLANAR, held_tilt
from reduced_models.bearing.grooves import angle_without_load, require_contact_angle, require_room, table_cosine
from reduced_models.bearing.height_tables import require_features_fit
from reduced_models.bearing.internals import require_ratings
from reduced_models.bearing.kinematics import INNER_TURNS, DefectFrequencies, DefectOrders, RingSpeeds
from reduced_models.bearing.loss import require_loss_factor
from reduced_models.bearing.oil_feedback import with_held_feed
from reduced_models.bearing.race import (
    RACES,
    Race,
    assumptions_under,
    beyond_data,
    require_roughness,
)
from reduced_models.bearing.ring_statics import (
    cage_angles,
    equilibrium_under,
    linear_balls,
    require_load,
    state_of,
)
from reduced_models.bearing.solved_balls import damping_left_out, signed_damping
from reduced_models.elements.film_contact import FilmContact

_Floats = NDArray[np.float64]

SUPPLIES = ("h", "over_flooded", "fed")  # units of an oil supply that is the same at all balls, and its feed


@stored("ball bearing")
@fields_take(
    ball_diameter=parts.BALL_DIAMETER, pitch_diameter=parts.PITCH_DIAMETER, clearance="m",
    rq_ball="m", rq_race="m", cutoff_gap=parts.GAP, youngs_modulus=parts.MODULUS, density=parts.DENSITY,
    contact_angle="rad", shoulder_inner=parts.SHAFT_DIAMETER, shoulder_outer=parts.SHAFT_DIAMETER, name=NAME,
    atlas=FILE, dynamic_rating=parts.RATING, static_rating=parts.RATING,
)  # fmt: skip
@dataclass(frozen=True, kw_only=True)
class BallBearing(Summary):
    """Ball bearing. SI units; x and y across the shaft, y upwards, z along it.

    Every ball has a contact with either race, each with a film and its memory; both carry the ball in series, the
    outer one its centrifugal force too. Rings are rigid, balls roll without slip at the centres of their contacts
    and, unless it is asked for, do not vibrate on their contacts themselves (for a 6205 that begins near 30 kHz).

    Speeds are those of one ring against the other: of the shaft in an outer ring that stands still, or with
    `turning` of a wheel or a sheave on a shaft that stands still.

    The inner ring has five degrees of freedom (`reduced_models.bearing.freedoms`). Under a load (Fx, Fy) its axial
    motion and its tilts are held: a planar bearing with contact angles of 0, the one of rotors without axial
    motion and of planar FMUs. Under (Fx, Fy, Fz) or with moments every ball has its own contact angles on both
    races.

    Parameters
    ----------
    balls : int
        At least 3.
    ball_diameter, pitch_diameter : float
        In m.
    conformity_inner, conformity_outer : float
        Groove radius over ball diameter, 0.501 to 0.7; other definitions of it (1.04 or 0.9615 for 0.52) are
        refused with the value meant.
    clearance : float
        Radial internal clearance, the play across the bearing [m]; below 0 it is preloaded by so much. An angular
        contact bearing has it from its contact angle.
    contact_angle : float, optional
        Of an angular contact bearing whose balls just touch both races [rad]; it carries axial load in +z. By
        default a deep-groove bearing, whose angle follows from its clearance: `free_angle`.
    race_control : {"outer", "inner", "shared", "harris"}
        What the axis of a ball follows at contact angles, and which race holds its gyroscopic moment: no spin at
        the outer race, which centrifugal force makes hold at the speeds where it matters; none at the inner race;
        a share of both by their moments of friction; or the first with the direction of the gyroscopic moment that
        published tables have (`reduced_models.bearing.contact_angles`).
    shoulder_inner, shoulder_outer : float, optional
        Diameters of the shoulders beside the grooves [m], as catalogues have them: loads under which a contact
        ellipse reaches over one are refused (`reduced_models.bearing.shoulders`).
    oil : Lubricant, optional
        Of the films, which are those of the atlas. None is dry: Hertz contacts without film or damping.
    rq_ball, rq_race : float, optional
        Roughness Rq [m], for the lambda ratio.
    cutoff_gap : float, optional
        Gap [m] beyond which the film of an unloaded ball carries nothing. By default it is flooded there too, and
        its force falls slowly, like gap^-1/2.
    youngs_modulus, poisson_ratio, density : float
        Of balls and rings [Pa], [-], of balls [kg/m3].
    loss_factor : float
        Of rings and fits, for vibrations of 5 Hz to 5 kHz: what else than films damps, in linear answers and in
        time alike. It needs a measurement, and is nothing to hide a gap behind. See `reduced_models.bearing.loss`.
    ball_inertia : bool
        Balls have inertia towards the rings: in linear answers, and in runs whose steps are short enough for it.
    name : str
    atlas : str, optional
        File of an atlas; by default the one that comes with the library.
    thermal : Heat or True, optional
        Films heat up (docs/heat.md), with the data of the oil where it is of a grade; True is ``Heat()``. The
        temperature of the inlets is an input, that of the oil. By default films are isothermal.
    features : sequence of RaceWaviness, BallWaviness, BallDiameter, Spall and Indentation
        Of races and balls: they turn with the ring, the cage and the balls, and change equilibria and runs. What
        is linear about static equilibrium, as coefficients and modes, is that of the smooth bearing.
    supply : OilLayer, optional
        Oil that the surfaces carry to every contact (docs/oil_supply.md): one layer ``OilLayer(h)`` [m] on all
        tracks, as that of an `OilBalance`, or ``OilLayer(over_flooded=r)`` times what each flooded film lets
        through, r over the isothermal film with `thermal` too. By default contacts are flooded. Under the layer
        that a feed keeps, ``OilBalance(...).lasting_supply``, `coefficients` hold the feed, not the layer.
    dynamic_rating, static_rating : float, optional
        Load ratings C and C0 as the maker prints them [N], for the rating life in place of those of the catalogue
        or the geometry.
    turning : {"inner", "outer"} or (float, float)
        The ring that turns; or the speeds of the inner and the outer ring, of which the ratio counts: (12000.0,
        -9000.0) of two spools. Loads stand still. ``speed_rpm`` is the speed of one ring against the other, here
        21 000 rev/min, and what is said per turn of the shaft is per turn of that.

    Attributes
    ----------
    tables : BearingTables
        What is computed once from these inputs.

    Raises
    ------
    InputError
        What is no ball bearing: balls that overlap, a conformity of a half or less; a conformity or an oil that
        the atlas does not have; ratings far from those of its balls; oil supply of a dry bearing, or one that the
        table of it does not have; heat of a dry bearing, of sliding, or of an oil without its data.
    """

    balls: int
    ball_diameter: float
    pitch_diameter: float
    conformity_inner: float = USUAL_CONFORMITY
    conformity_outer: float = USUAL_CONFORMITY
    clearance: float = 0.0
    oil: Lubricant | None = None
    rq_ball: float | None = None
    rq_race: float | None = None
    cutoff_gap: float | None = None
    youngs_modulus: float = 2.06e11
    poisson_ratio: float = 0.3
    density: float = 7800.0
    loss_factor: float = 0.0
    ball_inertia: bool = False
    name: str = ""
    atlas: str | None = None
    contact_angle: float | None = None
    race_control: str = "outer"
    shoulder_inner: float | None = None
    shoulder_outer: float | None = None
    thermal: Any = None
    features: Sequence[Feature] = ()
    supply: OilLayer | None = None
    dynamic_rating: float | None = None
    static_rating: float | None = None
    turning: str | Sequence[float] = "inner"
    tables: BearingTables = field(init=False, repr=False, compare=False)

    def _summary_lines(self) -> list[str]:
        play = 1e6 * self.clearance
        angle = self.contact_angle
        grooves = f"clearance {play:.4g} µm" if angle is None else f"contact angle {degrees(angle):.4g} degrees"
        lines = [
            f"{self.name or 'ball bearing'}, {self.balls} balls of {1e3 * self.ball_diameter:.4g} mm "
            f"on {1e3 * self.pitch_diameter:.4g} mm",
            f"conformity {self.conformity_inner:.4g} and {self.conformity_outer:.4g}, {grooves}",
            *condition_lines(self),
        ]
        if self.ring_speeds != INNER_TURNS:
            lines.append(f"turning: {self.turning}")
        lines += [f"loss factor {self.loss_factor:.3g}"] if self.loss_factor else []
        return [*lines, f"features: {', '.join(map(str, self.features))}"] if self.features else lines

    def __post_init__(self) -> None:
        require_integer("balls", self.balls, "a whole number >= 3", 3)
        require_oil(self.oil)
        object.__setattr__(self, "thermal", conditions_of(self).heat)
        for name, rq in (("rq_ball", self.rq_ball), ("rq_race", self.rq_race)):
            require_roughness(name, rq)
        require_loss_factor(self.loss_factor)
        require_choice("race_control", self.race_control, CONTROLS)
        _ = self.ring_speeds  # refused where they are none
        if not isinstance(self.turning, str):
            object.__setattr__(self, "turning", tuple(self.turning))
        if self.contact_angle is not None:
            require_contact_angle(self.contact_angle)
        object.__setattr__(self, "tables", BearingTables(self))
        require_room(self)
        given = require_features(self.features, self.balls, self.ball_diameter) if self.features else []
        object.__setattr__(self, "features", tuple(given))
        require_features_fit(self)
        require_ratings(self)
        _ = self.tables.shoulders  # refused where they are no shoulders of these grooves
        if self.oil is not None:
            for race in self.tables.races.values():
                race.require_in_atlas()

    @classmethod
    def catalogue(cls, name: str, **changes: Any) -> Self:
        """Bearing by its name, as ``BallBearing.catalogue("6205", oil=Lubricant.iso_vg(68, temperature=50.0))``.

        `reduced_models.bearing.catalogue` has the table, and where each row is from; its `designation_of` what the
        suffixes of a name mean.

        Parameters
        ----------
        name : str
            As people type it, "6205-2RS" or "SKF 6205/C3": a clearance class in the name of a deep-groove bearing
            is the one of the bearing where no clearance is given; the other suffixes change nothing.
        **changes
            Any other argument of the bearing, or another value than that of the table. ``clearance`` may be a
            class, "C2", "CN", "C3" or "C4": the middle of its limits at the bore, before mounting.

        Raises
        ------
        InputError
            A name that is not in the table; it names the nearest. A class of clearance that is none, or is not the
            one in the name, or a bearing whose bore is not known.
        """
        read = designation_of(name)
        known, row = read.name, ROWS[read.name]
        if read.clearance is not None and row.contact_angle is None and changes.get("contact_angle") is None:
            wished = changes.setdefault("clearance", read.clearance)
            if isinstance(wished, str) and wished.strip().upper() != read.clearance:
                allowed = f"{read.clearance}, the class in the name {read.given}, or a number"
                raise InputError("clearance", wished, allowed)
        if isinstance(changes.get("clearance"), str):
            changes["clearance"] = clearance_of_class(changes["clearance"], row.bore)
        dimensions = {"balls": row.balls, "ball_diameter": row.ball_diameter, "pitch_diameter": row.pitch_diameter}
        grooves = {"conformity_inner": row.conformity, "conformity_outer": row.conformity}
        angle = {} if row.contact_angle is None else {"contact_angle": row.contact_angle}
        return cls(**{"name": known, **dimensions, **grooves, **angle, **changes})

    @property
    def gamma(self) -> float:
        """Ball over pitch diameter."""
        return self.ball_diameter / self.pitch_diameter

    @property
    def ring_speeds(self) -> RingSpeeds:
        """Speeds of both rings over the speed of one against the other."""
        return RingSpeeds.of(self.turning)

    @property
    def free_angle(self) -> float:
        """Contact angle with the balls just touching both races [rad]: 0 without clearance."""
        return angle_without_load(self)

    @property
    def orders(self) -> DefectOrders:
        """Defect frequencies per turn of the shaft; of deep-groove bearings under radial load.

        `orders_under` has those at the contact angles of a load.
        """
        return DefectOrders.of(self.balls, self.gamma, table_cosine(self), self.ring_speeds)

    @takes(load="N", axial=parts.FORCE, speed_rpm="rev/min")
    def orders_under(
        self, load: ArrayLike, *, axial: float = 0.0, speed_rpm: float = 0.0, slip: float = 0.0
    ) -> DefectOrders:
        """Defect frequencies per turn of the shaft at the contact angles under a load, with slip of the cage.

        Parameters
        ----------
        load : float or tuple of 2, 3 or 5 float
            Radial load, in -y; or a force on the inner ring as in `equilibrium` [N], [N m].
        axial : float
            Axial load in +z beside a radial one [N].
        speed_rpm : float
            As in `equilibrium` [rev/min].
        slip : float
            By which share the cage turns slower than with balls that roll (0.01 for 1 %), as `cage_slip` gives it.

        Raises
        ------
        InputError
            An axial load beside a force that has one; a slip that is no share; what `equilibrium` refuses.
        """
        force = (0.0, -require_finite("load", load)) if np.ndim(load) == 0 else load
        if axial:
            if np.size(force) != len(PLANAR):
                raise InputError("axial", axial, "left out beside a load that has an axial part")
            force = (*force, require_finite("axial", axial))  # type: ignore[misc]
        found = self.equilibrium(force, speed_rpm=speed_rpm).orders or self.orders
        return found.with_slip(slip, self.ring_speeds)

    @takes(speed_rpm=parts.SPEED_OR_NONE)
    def frequencies(self, speed_rpm: float) -> DefectFrequencies:
        """Defect frequencies [Hz] at a speed of the shaft [rev/min]."""
        return self.orders.at(require_nonnegative("speed_rpm", speed_rpm))

    @property
    def roughness(self) -> float | None:
        """Composite roughness of ball and race [m]; None where none is given."""
        given = [rq for rq in (self.rq_ball, self.rq_race) if rq is not None]
        return hypot(*given) if given else None

    @property
    def highest_speed(self) -> float:
        """Speed [rev/min] up to which the atlas and its tables have films for it; infinite where it is dry."""
        return inf if self.oil is None else self.tables.end[0]

    @property
    def dry(self) -> BallBearing:
        """The bearing without oil, as it is while the shaft stands still: without rolling there is no film."""
        return self if self.oil is None else self.tables.dry

    def race(self, name: str) -> Race:
        """The contact with the "inner" or the "outer" race."""
        if name not in RACES:
            raise InputError("race", name, f"one of {', '.join(RACES)}")
        return self.tables.races[name]

    @takes(speed_rpm="rev/min")
    def element(self, race: str, speed_rpm: float) -> FilmContact:
        """Element of a ball's contact with one race [SI], for all loads that the atlas has at this speed."""
        contact, speed = self.race(race), self.speed(speed_rpm)
        if self.oil is None:
            raise InputError("oil", None, "given, for a film")
        return self.tables.element(contact.name, speed)

    @takes(load="N", speed_rpm="rev/min", cage_angle="rad", shaft_angle=parts.ANY, tilt="rad")
    def equilibrium(
        self,
        load: ArrayLike,
        *,
        speed_rpm: float = 0.0,
        cage_angle: float | None = None,
        shaft_angle: float = 0.0,
        tilt: ArrayLike | None = None,
    ) -> BearingState:
        """State in static equilibrium under a load on the shaft.

        Parameters
        ----------
        load : tuple of 2, 3 or 5 float
            Force on the inner ring: (Fx, Fy) [N], axial motion and tilts held; (Fx, Fy, Fz), tilts held; or
            (Fx, Fy, Fz, Mx, My) [N], [N m].
        speed_rpm : float
            Speed of the shaft [rev/min], for the films and the inertia of the balls; 0 for a dry bearing only.
        cage_angle : float, optional
            Angle of the first ball from the x axis [rad]; by default it stands under the load.
        shaft_angle : float
            By which the inner ring and, rolling, the balls have turned [rad]: where their features are.
        tilt : (float, float), optional
            About x and y, of the ring under (Fx, Fy, Fz) [rad]: misalignment; by default 0.

        Raises
        ------
        InputError
            A load that does not seat the bearing, drives balls out of their grooves or is beyond the atlas; a
            speed beyond it.
        """
        force, speed = require_load(self, load), self.speed(speed_rpm)
        angle = direction_of(force) if cage_angle is None else angle_of(cage_angle)
        held, turned = held_tilt(tilt, force.size), angle_of(shaft_angle, "shaft_angle") if self.features else None
        return state_of(self, equilibrium_under(self, force, speed, angle, held, turned), speed, angle)

    @takes(load="N", speed_rpm="rev/min", cage_angle="rad")
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
        """Stiffness and damping of a small vibration about static equilibrium under a load.

        Parameters
        ----------
        load : tuple of 2, 3 or 5 float
            Force on the inner ring [N], [N m]; as in `equilibrium`. Beyond two components matrices are those of
            all five degrees of freedom, tilts included where the load holds them.
        speed_rpm : float
            Speed of the shaft [rev/min].
        cage_angle : float, optional
            Of the first ball [rad]; by default the mean over a ball passage is given.
        tilt : (float, float), optional
            As in `equilibrium` [rad].
        omega, hz, rpm : float or sequence of float
            Frequency of the vibration, in exactly one of these.

        Returns
        -------
        BearingCoefficients
        """
        force, speed = require_load(self, load), self.speed(speed_rpm)
        w, held = radians_per_second(None, omega=omega, hz=hz, rpm=rpm), held_tilt(tilt, force.size)
        places = [equilibrium_under(self, force, speed, at, held) for at in cage_angles(self, force, cage_angle)]
        balls = linear_balls(self, speed, places)
        full = np.mean([at.load for at in places], axis=0)
        outside = "" if self.oil is None else assumptions_under(self, speed, places).headline
        left_out = damping_left_out(self, speed, np.array([at.force for at in places]))
        K, C = balls.coefficients(w)
        signed = signed_damping(self, speed, balls, places, w)
        stiffer, damped, feed = with_held_feed(self, speed, balls, places, w)
        signed = signed if signed is None else signed + damped
        notes = outside, signed, left_out, feed, beyond_data(self, speed, places, w)
        return BearingCoefficients.of(full, speed, cage_angle, w, (K + stiffer, C), places, *notes)

    @takes(load="N", speed_rpm="rev/min", cage_angle="rad")
    def excitation(
        self,
        features: Sequence[Feature],
        load: ArrayLike,
        *,
        speed_rpm: float = 0.0,
        cage_angle: float = 0.0,
        contact_filter: str = "film",
        slip: float = 0.0,
    ) -> BearingExcitation:
        """Forces by which features of balls and races excite the bearing, linear in their heights, as lines.

        The ring is held where the load puts it. `reduced_models.bearing.excitation` has the equations.

        Parameters
        ----------
        features : sequence of RaceWaviness, BallWaviness, BallDiameter, Spall and Indentation
        load : tuple of 2, 3 or 5 float
            As in `coefficients` [N], [N m].
        speed_rpm : float
            Speed of the shaft [rev/min].
        cage_angle : float
            Of the first ball with the shaft at 0 [rad]; for phases.
        contact_filter : {"film", "dry", "none"}
            How short waves are filtered by the length of a contact: with its film, by `atlas.contact_filter`
            (dry bearings have none); as dry contacts do, sin(k)/k; or not, as the bare height under their middle.
        slip : float
            As in `orders_under`; it moves the lines, while films are those of balls that roll.

        Raises
        ------
        InputError
            No feature, one of a ball that there is not, one too high for the bearing; a slip that is no share;
            what `equilibrium` refuses.
        """
        own = require_features(features, self.balls, self.ball_diameter)
        require_choice("contact_filter", contact_filter, FILTERS)
        force, speed, cage_angle = require_load(self, load), self.speed(speed_rpm), angle_of(cage_angle)
        cages = cage_angles(self, force, None)
        places = [equilibrium_under(self, force, speed, at) for at in cages]
        small = linear_balls(self, speed, places)
        forces, approach, rotations = (
            np.array([getattr(at, name) for at in places]) for name in ("force", "approach", "ball_rotation")
        )
        full, turns = np.mean([at.load for at in places], axis=0), turns_of(places)
        cage, rotation = with_cage_slip(self, *turns, slip)
        rotations = rotations * (self.ring_speeds.sense * rotation / turns[1])
        balls = FeaturedBalls(self, small, forces, cages[0], speed, cage, rotations, contact_filter)
        return excitation_of(balls, full, float(approach.sum(axis=-1).max()), own, cage_angle)

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
        """Stiffness and damping as a plain ``ross.BearingElement``, means over a ball passage.

        Parameters
        ----------
        node : int
        speeds_rpm : float or sequence of float
            Speeds of the shaft [rev/min], increasing. Beyond their ends the element holds the values of the ends
            and warns once; read from a file of ROSS it extrapolates instead. At 0 it is that of the dry bearing.
            From four speeds on the splines of ROSS 2 meet damping within 1 N s/m rms only, those of ROSS 3 go
            through all points.
        load : float or tuple of 2, 3 or 5 float
            Force on the inner ring [N], [N m], as in `coefficients`; a number is a weight, in -y. With an axial
            force the element has kzz and czz too. Stiffness against tilts, and the coupling of x and y with z and
            with tilts, have no place in ROSS and are left out; `coefficients` has them.
        omega, hz, rpm : float or sequence of float, optional
            Frequency of the whirl, the vibration. One frequency makes tables over the speed only. In ROSS 3
            several, increasing, are the second axis of the tables: by default 0, and 41 from 1 Hz to 10 kHz.
            ROSS 2 has no such axis; there the default is the frequency of the shaft at each speed.
        **options
            Of ``ross.BearingElement``, as ``tag`` or ``n_link``; ``kzz=0.0, czz=0.0`` where its outer ring slides.

        Raises
        ------
        InputError
            ROSS is not installed; a load or a speed that the bearing does not take; several frequencies in ROSS 2.
        """
        from reduced_models.bearing.ross_bearing import bearing_element

        frequency = {"omega": omega, "hz": hz, "rpm": rpm}
        return bearing_element(self, node, speeds_rpm, load, frequency, **options)

    def speed(self, speed_rpm: float) -> float:
        """The speed [rev/min] where the bearing can run at it; raises `InputError` where not."""
        return require_speed(self, speed_rpm)

    def to_dict(self) -> dict[str, Any]:
        """All arguments, ready for JSON."""
        return {f.name: getattr(self, f.name) for f in fields(self) if f.init} | {
            "oil": None if self.oil is None else asdict(self.oil),
            "supply": None if self.supply is None else self.supply.to_dict(),
            "thermal": None if self.thermal is None else self.thermal.to_dict(),
            "features": feature_entries(tuple(self.features)),
        }

    @classmethod
    @takes(entries=ENTRIES)
    def from_dict(cls, entries: Mapping[str, Any]) -> Self:
        """Rebuild a bearing from `to_dict`; raises `InputError` for entries that are missing, unknown or wrong."""
        require_names(entries, [f.name for f in fields(cls) if f.init])
        oil, supply, thermal = (entries[name] for name in ("oil", "supply", "thermal"))
        for name, value in (("oil", oil), ("supply", supply), ("thermal", thermal)):
            require_instance(name, value, dict | None, "an object, or null")
        given: dict[str, Any] = {"features": features_from(entries["features"])}
        if oil is not None:
            require_names(oil, [f.name for f in fields(Lubricant)], "oil.")
            given["oil"] = Lubricant(**oil)
        if supply is not None:
            require_names({**dict.fromkeys(SUPPLIES), **supply}, SUPPLIES, "supply.")
            given["supply"] = layer_from(supply)
        if thermal is not None:
            require_names(thermal, [f.name for f in fields(Heat)], "thermal.")
            given["thermal"] = Heat.from_dict(thermal)
        return cls(**{**entries, **given})
