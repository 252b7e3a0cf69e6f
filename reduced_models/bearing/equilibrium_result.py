"""`BearingState`: a bearing in static equilibrium under a load, at a speed, ball by ball."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact.capacitance import OIL
from ehlcontact.errors import InputError
from ehlcontact.quantities import FORCE, LENGTH, MOMENT, NUMBER, RADIAN, SPEED, STIFFNESS, Quantity
from ehlcontact.results.picture import Picture
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.store import stored
from ehlcontact.summary import note_line
from reduced_models.bearing.capacitance import (
    BearingCapacitance,
    MeasuredFilm,
    capacitance_of,
    film_from_capacitance,
)
from reduced_models.bearing.freedoms import in_freedoms, labelled, load_words, place_words
from reduced_models.bearing.kinematics import INNER_TURNS, RPM_TO_RAD_S, DefectOrders, RingSpeeds
from reduced_models.bearing.picture import state_picture
from reduced_models.bearing.race import RACES
from reduced_models.life.bearing_life import BallLoads, BearingLife, life_of_bearing
from reduced_models.life.internal_geometry import InternalGeometry

_Floats = NDArray[np.float64]

OF_ANGLES = (
    "contact_angles",
    "spin_to_roll",
    "gyroscopic_friction",
    "orbit",
    "ball_rotation",
)  # those that a planar one does not have
OF_FILMS = (
    "h_central",
    "h_min",
    "lambda_ratio",
    "asperity_share",
    "moment",
)  # arrays that a dry bearing does not have
MOST_FRICTION = 0.05  # over the force of a contact: what oils in rolling contacts transmit
NOTICED = 1e-3  # load share of asperities, from which a summary says so


@stored("state of a ball bearing")
@dataclass(frozen=True, eq=False, kw_only=True)
class BearingState(QuantityTable):
    """A bearing in static equilibrium; arrays over the balls have two columns, inner and outer race.

    Attributes
    ----------
    name : str
        Of the bearing.
    load : ndarray, shape (2,) or (5,)
        Force on the inner ring [N]; under an axial load with moments [N m], also those that held tilts take.
    speed_rpm, cage_angle : float
        Of the shaft, or of one ring against the other [rev/min], of the first ball [rad].
    displacement : ndarray, shape (2,) or (5,)
        Of the inner ring [m], with tilts [rad] where the load has moments.
    stiffness : ndarray, shape (2, 2) or (5, 5)
        Slope of the static force [N/m], [N], [N m].
    angles : ndarray, shape (balls,)
        Of the balls [rad].
    force : ndarray, shape (balls, 2)
        Normal force [N]; at the outer race with the centrifugal force.
    approach : ndarray, shape (balls, 2)
        Mutual approach [m]; below 0 there is a gap.
    h_central, h_min : ndarray, shape (balls, 2), or None
        Central and smallest film [m]; None in a dry bearing.
    lambda_ratio : ndarray, shape (balls, 2), or None
        Smallest film over composite roughness; None where no roughness is given, or no film.
    asperity_share : ndarray, shape (balls, 2), or None
        Share of the load that typical asperities of that roughness carry, an estimate:
        `ehlcontact.Asperities.load_share`. It is not in forces and films.
    moment : ndarray, shape (balls, 2), or None
        Rolling resistance of every film: moment of its pressure about the centre line [N m]. Contacts lighter than
        the atlas knows have that of its lightest load, as long as their film carries.
    rolling_torque : float or None
        Torque on the inner ring [N m] that these moments take: `reduced_models.bearing.kinematics.rolling_torque`.
        The hydrodynamic rolling resistance alone. Not in it: sliding, spin and the slip within curved contacts;
        cage, seals and churned oil; hysteresis of the steel; that a hot or starved inlet resists less,
        but with `thermal` and `supply` of the bearing.
    skf_rolling, skf_sliding : float or None
        Moments of friction by SKF's published model, an empirical one [N m], in an oil bath of mineral oil:
        `reduced_models.bearing.skf_friction`. None in a dry bearing, and in one whose series has no constants
        there.
    outside_assumptions : str
        Assumptions of films that do not hold at the most loaded ball (`ehlcontact.assumptions`); empty where none.
    reservation : str
        Loads below those of the atlas, in words; empty where the most loaded contacts are inside.
    contact_angles : ndarray, shape (balls, 2), or None
        Of every contact [rad]; None, as all below, in a planar bearing, where they are 0.
    spin_to_roll : ndarray, shape (balls, 2), or None
        Angular speed of both surfaces against each other about their normal over that of rolling. Its friction is
        not in the forces.
    gyroscopic_friction : ndarray, shape (balls, 2), or None
        Friction across every contact that holds the gyroscopic moment of its ball, over the force of the contact.
        Whether a film transmits it is not checked; above 0.05 `friction_note` says so.
    orbit, ball_rotation : ndarray, shape (balls,), or None
        Angular speed of every ball about the shaft, and about its own axis as seen from the cage, over the speed
        of the shaft, or of one ring against the other. Balls of a bearing under combined load have different ones.
    internals : InternalGeometry or None
        Balls, grooves and printed ratings of the bearing, for `life`.
    """

    name: str
    load: Annotated[_Floats, FORCE.over("axis")]
    speed_rpm: Annotated[float, SPEED]
    cage_angle: Annotated[float, RADIAN]
    displacement: Annotated[_Floats, LENGTH.over("axis")]
    stiffness: Annotated[_Floats, STIFFNESS.over("axis by")]
    angles: Annotated[_Floats, RADIAN.over("ball")]
    force: Annotated[_Floats, FORCE.over("ball race")]
    approach: Annotated[_Floats, LENGTH.over("ball race")]
    h_central: Annotated[_Floats | None, LENGTH.over("ball race")] = None
    h_min: Annotated[_Floats | None, LENGTH.over("ball race")] = None
    lambda_ratio: Annotated[_Floats | None, NUMBER.over("ball race")] = None
    asperity_share: Annotated[_Floats | None, NUMBER.over("ball race")] = None
    moment: Annotated[_Floats | None, MOMENT.over("ball race")] = None
    rolling_torque: Annotated[float | None, MOMENT] = None
    skf_rolling: Annotated[float | None, MOMENT] = None
    skf_sliding: Annotated[float | None, MOMENT] = None
    outside_assumptions: str = ""
    reservation: str = ""
    contact_angles: Annotated[_Floats | None, RADIAN.over("ball race")] = None
    spin_to_roll: Annotated[_Floats | None, NUMBER.over("ball race")] = None
    gyroscopic_friction: Annotated[_Floats | None, NUMBER.over("ball race")] = None
    orbit: Annotated[_Floats | None, NUMBER.over("ball")] = None
    ball_rotation: Annotated[_Floats | None, NUMBER.over("ball")] = None
    internals: InternalGeometry | None = None

    DISPLAY: ClassVar[Display] = Display(
        rows="ball",
        labels={"race": ("inner", "outer"), "axis": ("x", "y"), "by": ("x", "y")},
        coordinates="angles",
        first=0,
    )

    def __post_init__(self) -> None:
        balls = np.asarray(self.angles).size
        freedoms = 5 if np.size(self.load) == 5 else 2
        sizes = {"ball": balls, "race": 2, "axis": freedoms, "by": freedoms}
        for name, quantity in self._declared().items():
            if not quantity.dims or (getattr(self, name) is None and name in (*OF_FILMS, *OF_ANGLES)):
                continue
            array = np.array(getattr(self, name), dtype=np.float64)
            wanted = tuple(sizes[dim] for dim in quantity.dims)
            if array.shape != wanted:
                raise InputError(f"shape of {name}", array.shape, str(wanted))
            array.setflags(write=False)
            object.__setattr__(self, name, array)

    def _quantities(self) -> Mapping[str, Quantity]:
        return in_freedoms(super()._quantities(), np.size(self.load))

    def _display(self) -> Display:
        return labelled(super()._display(), np.size(self.load))

    def _summary_lines(self) -> list[str]:
        k = self.heaviest
        lines = [
            f"{self.name or 'ball bearing'}, load {load_words(self.load)} at {self.speed_rpm:.5g} rev/min",
            f"{self.loaded} of {len(self.angles)} balls carry, the heaviest {self.force[k, 0]:.4g} N",
            f"ring displaced by {place_words(self.displacement)}",
        ]
        if self.contact_angles is not None:
            low, high = np.degrees([self.contact_angles[k].min(), self.contact_angles[k].max()])
            lines[1] += f" at {low:.4g} to {high:.4g} degrees"
            if self.largest_spin:
                lines.append(f"spin up to {self.largest_spin:.3g} of rolling; its friction is not in the forces")
        if self.h_min is not None:
            lines.append(f"smallest film there {1e6 * self.h_min[k].min():.4g} µm")
            lines[-1] += "" if self.lambda_ratio is None else f", lambda {self.lambda_ratio[k].min():.3g}"
            if self.asperity_share is not None and (share := self.asperity_share[k].max()) > NOTICED:
                lines[-1] += f", asperities carry about {100.0 * share:.2g} %"
        else:
            lines.append("no film: dry")
        torque = self.rolling_torque
        lines[-1] += "" if torque is None else f"; films resist rolling with {1e3 * torque:.4g} N mm"
        if self.friction_torque is not None:
            lines[2] += f"; friction {1e3 * self.friction_torque:.4g} N mm, its sliding part by SKF"
        return [
            *lines,
            *filter(None, [self.reservation, self.friction_note]),
            *note_line(self.outside_assumptions),
        ]

    @property
    def loaded(self) -> int:
        """How many balls are pressed by both rings, their approaches together above 0."""
        return int(np.count_nonzero((self.approach.sum(axis=1) > 0.0) & (self.force[:, 0] > 0.0)))

    @property
    def heaviest(self) -> int:
        """Index of the ball that carries most."""
        return int(np.argmax(self.force[:, 0]))

    @property
    def largest_spin(self) -> float | None:
        """Largest spin-to-roll ratio of the balls that carry, at either race; None in a planar bearing."""
        if self.spin_to_roll is None:
            return None
        return float(np.abs(self.spin_to_roll[self.force[:, 0] > 0.0]).max(initial=0.0))

    @property
    def largest_gyroscopic_friction(self) -> float | None:
        """Largest friction over force of the balls that carry, at either race; None in a planar bearing."""
        if self.gyroscopic_friction is None:
            return None
        return float(np.abs(self.gyroscopic_friction[self.force[:, 0] > 0.0]).max(initial=0.0))

    @property
    def friction_note(self) -> str:
        """Friction of balls that carry above what films may transmit, in words; else empty."""
        if self.gyroscopic_friction is None:
            return ""
        needed = (np.abs(self.gyroscopic_friction) * (self.force[:, :1] > 0.0)).max(axis=0)
        race = int(needed.argmax())
        if needed[race] <= MOST_FRICTION:
            return ""
        return (
            f"the {RACES[race]} race must hold the gyroscopic moment of a ball by friction of {needed[race]:.2g}"
            f" of the contact force: above {MOST_FRICTION:g} the ball may slip"
        )

    @property
    def orders(self) -> DefectOrders | None:
        """Defect frequencies per turn of the shaft at these contact angles; None in a planar or unloaded bearing.

        The cage turns as the mean of the balls, each with the weight of its load.
        """
        if self.orbit is None or self.ball_rotation is None or not self.force[:, 0].any():
            return None
        cage, rotation = (
            float(np.average(one, weights=self.force[:, 0])) for one in (self.orbit, self.ball_rotation)
        )
        return DefectOrders.at_speeds(len(self.angles), cage, rotation, self._rings)

    @property
    def _rings(self) -> RingSpeeds:
        return INNER_TURNS if self.internals is None else RingSpeeds(*self.internals.ring_speeds)

    @property
    def rolling_loss(self) -> float | None:
        """Power [W] that `rolling_torque` takes from the shaft."""
        return None if self.rolling_torque is None else self.rolling_torque * self.speed_rpm * RPM_TO_RAD_S

    @property
    def friction_torque(self) -> float | None:
        """Rolling torque of the films and the sliding part of SKF's model together [N m]; without seals.

        Above 5000 rev/min flooded films resist more than measured bearings do: `skf_torque`.
        """
        if self.rolling_torque is None or self.skf_sliding is None:
            return None
        return self.rolling_torque + self.skf_sliding

    @property
    def skf_torque(self) -> float | None:
        """Both parts of SKF's model together [N m], on which to rely above 5000 rev/min; without seals."""
        if self.skf_rolling is None or self.skf_sliding is None:
            return None
        return self.skf_rolling + self.skf_sliding

    @property
    def friction_loss(self) -> float | None:
        """Power [W] that `friction_torque` takes from the shaft."""
        return None if self.friction_torque is None else self.friction_torque * self.speed_rpm * RPM_TO_RAD_S

    def life(self, **options: Any) -> BearingLife:
        """Rating life by ISO/TS 16281 from the loads of the balls, the first ball where it stands.

        Parameters
        ----------
        **options
            ``contamination``, ``reliability``, ``dynamic_rating``, ``static_rating``, ``fatigue_limit``,
            ``kinematic_viscosity`` and ``viscosity_ratio`` of `reduced_models.life.bearing_life.life_of_bearing`.

        Raises
        ------
        InputError
            What `life_of_bearing` refuses.
        """
        ratio, tilts = self.lambda_ratio, self.displacement[3:]
        loads = BallLoads.at_rest(
            self.force,
            self.load,
            self.speed_rpm,
            None if ratio is None else float(ratio[self.heaviest].min()),
            float(np.hypot(*tilts)) if tilts.size else 0.0,
            self._rings,
        )
        return life_of_bearing(self.internals, loads, **options)

    def capacitance(self, permittivity: float = OIL, *, surroundings: float | None = None) -> BearingCapacitance:
        """Capacitance between the rings across the films of all balls (docs/capacitance.md).

        Parameters
        ----------
        permittivity : float
            Of the oil, relative: 2.0 to 2.5 of mineral and hydrocarbon oils.
        surroundings : float, optional
            Of what fills the gaps around the contacts: 1 for air; the oil by default.

        Raises
        ------
        InputError
            A permittivity below 1; a dry bearing, whose rings touch.
        """
        return capacitance_of(self, permittivity, surroundings)

    def film_from_capacitance(self, capacitance: float, **options: float) -> MeasuredFilm:
        """Films by a measured capacitance: one factor on all films of this state.

        Parameters
        ----------
        capacitance : float
            Of the bearing, less that of cables and housing [F].
        **options
            ``error`` of the capacitance [F]; ``permittivity`` (2.2), ``permittivity_error`` (0.1), and
            ``law_error``, of the capacitance of a film (0.06): together they make the interval.

        Raises
        ------
        InputError
            No capacitance of films 30 times thicker or thinner; picofarad in place of farad.
        """
        return film_from_capacitance(self, capacitance, **options)

    def picture(self) -> Picture:
        """Load zone and films, and with contact angles these and the spin."""
        return state_picture(self)

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        names = "outside_assumptions", "reservation", "friction_note"
        notes = {name: getattr(self, name) for name in names}
        return {"name": self.name, **super().to_dict(), **notes}
