"""`support_state`: a ball bearing, or a set of them, under its load at a speed, in the numbers of a designer.

Film and lambda of the worst contact, largest ball load with its Hertz pressure and contact angle, stiffness and
damping at the frequency of the shaft, friction, and what does not hold. All of it is computed elsewhere.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf, sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.assumptions import Assumptions, assumptions
from ehlcontact.capacitance import OIL
from ehlcontact.checks import parts, require_instance
from ehlcontact.checks.kinds import NAME
from ehlcontact.checks.quantity import takes
from ehlcontact.film_formulas import film_scatter
from ehlcontact.hertz import hertz_contact
from ehlcontact.summary import Summary
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.capacitance import BearingCapacitance
from reduced_models.bearing.coefficients import BearingCoefficients
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.race import RACES
from reduced_models.bearing.set_result import SetState
from reduced_models.bearing.sliding import USUAL_LAW, BearingFriction, friction_at, race_at
from reduced_models.rotor.bearing_set import BearingSet

_Floats = NDArray[np.float64]

OUTER = RACES.index("outer")
ABOVE_MEASURED = "flooded films resist more than measured bearings do at this speed"
RELY_ON_SKF = 5000.0  # rev/min above which flooded films resist more than measured bearings do: docs/bearings.md


class Contact(NamedTuple):
    """One contact of a support: bearing (of a set), ball, and column of the race."""

    bearing: int
    ball: int
    race: int

    @property
    def race_name(self) -> str:
        """Inner or outer."""
        return RACES[self.race]


@dataclass(frozen=True, eq=False, kw_only=True)
class SupportState(Summary):
    """A bearing, or a set of them, under its load at a speed of the shaft.

    Attributes
    ----------
    name : str
    position : float or None
        Along the shaft [m].
    bearing : BallBearing or BearingSet
    state : BearingState or SetState
    coefficients : BearingCoefficients
        At the frequency of the shaft, means over a ball passage.
    friction : tuple of BearingFriction
        Of each bearing, by films and a traction law, with heat of the inlets where the oil has its data; empty
        where it is dry.
    assumptions : Assumptions or None
        Worst of those at its most loaded contacts; None where it is dry.
    permittivity : float
        Of the oil, for its capacitance.
    """

    name: str
    position: float | None
    bearing: BallBearing | BearingSet
    state: BearingState | SetState
    coefficients: BearingCoefficients
    friction: tuple[BearingFriction, ...]
    assumptions: Assumptions | None
    permittivity: float = OIL

    def _summary_lines(self) -> list[str]:
        lines = [f"{self.label}, {self.ball_load:.4g} N on a ball, {1e-9 * self.p_hertz:.3g} GPa"]
        if self.h_min is not None:
            ratio = "" if self.lambda_ratio is None else f", lambda {self.lambda_ratio:.3g}"
            lines.append(f"smallest film {1e6 * self.h_min:.3g} µm{ratio}, friction {self.torque or 0.0:.3g} N m")
        return lines

    @property
    def label(self) -> str:
        """Name of the support and of its bearing."""
        kinds = dict.fromkeys(bearing.name for bearing, _ in self.bearings if bearing.name)
        own = self.bearing.name or " and ".join(kinds)
        return self.name if not own or own in self.name else f"{self.name} {own}".strip()

    @property
    def bearings(self) -> tuple[tuple[BallBearing, BearingState], ...]:
        """Each bearing with its state."""
        if isinstance(self.bearing, BearingSet) and isinstance(self.state, SetState):
            return tuple(zip(self.bearing.bearings, self.state.bearings, strict=True))
        assert isinstance(self.bearing, BallBearing)
        assert isinstance(self.state, BearingState)
        return ((self.bearing, self.state),)

    @property
    def worst_contact(self) -> Contact | None:
        """Contact with the smallest film; None where it is dry."""
        found = (
            (float(film), Contact(k, *place))
            for k, (_, state) in enumerate(self.bearings)
            if state.h_min is not None
            for place, film in np.ndenumerate(state.h_min)
            if state.force[place] > 0.0
        )
        return min(found, default=(inf, None), key=lambda one: one[0])[1]

    @property
    def h_min(self) -> float | None:
        """Smallest film of all contacts [m]; None where it is dry."""
        return self._at_worst("h_min")

    @property
    def lambda_ratio(self) -> float | None:
        """That film over the composite roughness; None where no roughness is given."""
        return self._at_worst("lambda_ratio")

    def _at_worst(self, name: str) -> float | None:
        worst = self.worst_contact
        values = None if worst is None else getattr(self.bearings[worst.bearing][1], name)
        return None if worst is None or values is None else float(values[worst.ball, worst.race])

    @property
    def film_errors(self) -> dict[str, float]:
        """Relative uncertainty of that film by its cause: atlas, and oil where its scatter is known."""
        worst = self.worst_contact
        if worst is None:
            return {}
        bearing, state = self.bearings[worst.bearing]
        race, oil = race_at(bearing, state, worst.ball, worst.race), bearing.oil
        load = max(float(state.force[worst.ball, worst.race]), race.loads(state.speed_rpm)[0])
        answer, moes = race.answer(load, state.speed_rpm), race.point(load, state.speed_rpm).moes
        errors = {"atlas": float(answer.error_bars["h_min"] / answer.h_min)}
        if oil is not None and (oil.eta0_scatter or oil.alpha_scatter):
            scatter = oil.eta0_scatter or 0.0, oil.alpha_scatter or 0.0
            errors["oil"] = film_scatter(moes.M, moes.L, moes.kappa, *scatter)
        return errors

    @property
    def heaviest_ball(self) -> Contact:
        """Contact of the most loaded ball with the inner race."""
        heaviest = [float(state.force[state.heaviest, 0]) for _, state in self.bearings]
        k = int(np.argmax(heaviest))
        return Contact(k, self.bearings[k][1].heaviest, 0)

    @property
    def ball_load(self) -> float:
        """Of the most loaded ball at the inner race [N]; centrifugal force adds to it at the outer one."""
        k, ball, race = self.heaviest_ball
        return float(self.bearings[k][1].force[ball, race])

    @property
    def outer_load(self) -> float:
        """Of the ball that presses most on the outer race [N]."""
        return max(float(state.force[:, OUTER].max()) for _, state in self.bearings)

    @property
    def p_hertz(self) -> float:
        """Largest Hertz pressure of all contacts [Pa]."""
        most = 0.0
        for bearing, state in self.bearings:
            for name, force in zip(RACES, state.force.max(axis=0).tolist(), strict=True):
                body = bearing.race(name).geometry
                unit = hertz_contact(1.0, body.radius_x, body.radius_y, body.e_reduced).pressure
                most = max(most, float(unit * np.cbrt(force)))
        return most

    @property
    def contact_angles(self) -> tuple[float, float] | None:
        """Of the most loaded ball at inner and outer race [rad]; None in a planar bearing."""
        k, ball, _ = self.heaviest_ball
        angles = self.bearings[k][1].contact_angles
        return None if angles is None else (float(angles[ball, 0]), float(angles[ball, 1]))

    @property
    def stiffness(self) -> _Floats:
        """Of small vibrations at the frequency of the shaft, shape (2, 2) or (5, 5) [N/m], [N], [N m]."""
        return np.asarray(self.coefficients.stiffness[0])

    @property
    def damping(self) -> _Floats:
        """Damping likewise [N s/m], [N s], [N m s]."""
        return np.asarray(self.coefficients.damping[0])

    @property
    def film_torque(self) -> float | None:
        """Torque by which the films resist rolling, flooded and isothermal unless the bearing has more [N m]."""
        return self._sum("rolling_torque")

    @property
    def skf_torque(self) -> float | None:
        """Moment of friction by SKF's model [N m]; None where the bearing has no constants there."""
        return self._sum("skf_torque")

    def _sum(self, name: str) -> float | None:
        values = [getattr(state, name) for _, state in self.bearings]
        return None if None in values else float(sum(values))

    @property
    def relies_on_skf(self) -> bool:
        """Whether `torque` is that of SKF's model: above 5000 rev/min, where it has the bearing."""
        return self.state.speed_rpm > RELY_ON_SKF and self.skf_torque is not None

    @property
    def torque(self) -> float | None:
        """Moment of friction on which to rely [N m], without seals; None where the bearing is dry.

        Up to 5000 rev/min films and sliding by a traction law, above by SKF's model where it has the bearing.
        """
        return self.skf_torque if self.relies_on_skf else self.flooded_torque

    @property
    def flooded_torque(self) -> float | None:
        """Moment of friction by films and sliding by a traction law [N m]; None where the bearing is dry."""
        return sum(one.total for one in self.friction) if self.friction else None

    @property
    def loss(self) -> float | None:
        """Power that `torque` takes from the shaft [W]."""
        return None if self.torque is None else self.torque * self.state.speed_rpm * RPM_TO_RAD_S

    @property
    def reservations(self) -> tuple[str, ...]:
        """What does not hold, a text with its number each."""
        broken = () if self.assumptions is None else self.assumptions.out_of_range
        said = [f"{one.name}: {one.verdict.split(';')[0]}" for one in broken]
        said += [self.state.reservation if isinstance(self.state, SetState) else ""]
        said += [self.state.friction_note, self.coefficients.beyond_data]
        said += [self.coefficients.damping_left_out, self.coefficients.held_feed]
        return tuple(f"{self.label}: {text}" for text in said if text)

    @property
    def capacitance(self) -> float | None:
        """Between shaft and housing [F]; None where it is dry."""
        return None if self.capacitance_range is None else self.capacitance_range[0]

    @property
    def capacitance_range(self) -> tuple[float, float, float] | None:
        """That, the least and the largest by where oil stands around the contacts [F]; None where it is dry."""
        rows = [(one.total, one.least, one.largest) for one in self._films]
        return (sum(r[0] for r in rows), sum(r[1] for r in rows), sum(r[2] for r in rows)) if rows else None

    @property
    def field_per_volt(self) -> float | None:
        """Largest field in a film [V/um] for 1 V between shaft and housing; None where it is dry."""
        return max(one.field_strength(1.0) for one in self._films) if self._films else None

    @cached_property
    def _films(self) -> tuple[BearingCapacitance, ...]:
        dry = any(state.h_min is None for _, state in self.bearings)
        return () if dry else tuple(state.capacitance(self.permittivity) for _, state in self.bearings)

    def to_dict(self) -> dict[str, Any]:
        """All numbers, SI, ready for JSON."""
        worst = self.worst_contact
        return {
            "name": self.name,
            "position": self.position,
            "bearing": self.bearing.to_dict(),
            "h_min": self.h_min,
            "lambda_ratio": self.lambda_ratio,
            "film_errors": self.film_errors,
            "worst_contact": None if worst is None else worst._asdict() | {"race": worst.race_name},
            "ball_load": self.ball_load,
            "p_hertz": self.p_hertz,
            "contact_angles": self.contact_angles,
            "stiffness": self.stiffness.tolist(),
            "damping": self.damping.tolist(),
            "torque": self.torque,
            "loss": self.loss,
            "film_torque": self.film_torque,
            "skf_torque": self.skf_torque,
            "sliding_torque": sum(one.sliding for one in self.friction) if self.friction else None,
            "inlet_heat": [one.inlet_heat for one in self.friction],
            "permittivity": self.permittivity,
            "capacitance": self.capacitance,
            "capacitance_range": None if self.capacitance_range is None else list(self.capacitance_range[1:]),
            "field_per_volt": self.field_per_volt,
            "state": self.state.to_dict(),
            "reservations": list(self.reservations),
        }


@takes(load="N", speed_rpm=parts.SPEED_OR_NONE, tilt="rad", name=NAME, position=parts.PLACE)
def support_state(
    bearing: BallBearing | BearingSet,
    load: ArrayLike,
    speed_rpm: float,
    *,
    tilt: ArrayLike | None = None,
    name: str = "",
    position: float | None = None,
) -> SupportState:
    """State of a bearing, or of a set of them, under a load that is known.

    Parameters
    ----------
    bearing : BallBearing or BearingSet
    load : tuple of 2, 3 or 5 float
        Force on the inner ring [N], [N m], as in `BallBearing.equilibrium`.
    speed_rpm : float
        Of the shaft [rev/min]; 0 of a dry bearing.
    tilt : (float, float), optional
        About x and y, of the ring under (Fx, Fy, Fz) [rad].
    name : str
    position : float, optional
        Along the shaft [m].

    Raises
    ------
    InputError
        A speed of 0 of a bearing in oil; what `equilibrium` of the bearing refuses.
    """
    require_instance("bearing", bearing, BallBearing | BearingSet, "a BallBearing or a BearingSet")
    speed = bearing.speed(speed_rpm)
    state = bearing.equilibrium(load, speed_rpm=speed, tilt=tilt)
    coefficients = bearing.coefficients(load, speed_rpm=speed, tilt=tilt, rpm=speed)
    return support_of(name, position, bearing, state, coefficients)


def support_of(
    name: str,
    position: float | None,
    bearing: BallBearing | BearingSet,
    state: BearingState | SetState,
    coefficients: BearingCoefficients,
) -> SupportState:
    """A support in a state that is known, with friction and assumptions of its films."""
    bearings = bearing.bearings if isinstance(bearing, BearingSet) else (bearing,)
    rows = list(zip(bearings, states_of(state), strict=True))
    wet = all(one.oil is not None for one in bearings)
    friction = [
        friction_at(one, own, USUAL_LAW, heat=one.oil is not None and one.oil.temperature_slope is not None)
        for one, own in rows
        if wet
    ]
    judged = [_assumptions(one, own) for one, own in rows if one.oil is not None]
    return SupportState(
        name=name,
        position=position,
        bearing=bearing,
        state=state,
        coefficients=coefficients,
        friction=tuple(friction),
        assumptions=Assumptions.worst_of(judged) if judged else None,
    )


def states_of(state: BearingState | SetState) -> tuple[BearingState, ...]:
    """The bearing of a state, or all of a set."""
    return state.bearings if isinstance(state, SetState) else (state,)


def _assumptions(bearing: BallBearing, state: BearingState) -> Assumptions:
    """Worst of the assumptions at the heaviest contacts of a bearing in oil with each race."""
    rough = (bearing.roughness / sqrt(2.0),) * 2 if bearing.roughness else None
    judged = []
    for column in range(len(RACES)):
        ball = int(np.argmax(state.force[:, column]))
        race = race_at(bearing, state, ball, column)
        load = max(float(state.force[ball, column]), race.loads(state.speed_rpm)[0])
        film = race.answer(load, state.speed_rpm)
        judged.append(assumptions(race.point(load, state.speed_rpm), film=film, roughness=rough))
    return Assumptions.worst_of(judged)
