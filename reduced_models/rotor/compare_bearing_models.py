"""Comparison of bearing models under one rotor: film memory, dry, and constant stiffness and damping.

Results for each model: motion under unbalance, slowest modes, response over frequency. For the bearing with films
also its coefficients over frequency and over speed, and the Campbell diagram.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from math import pi
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.status import Status
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.coefficients import BearingCoefficients
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.elements.validity import OutsideValidityWarning
from reduced_models.rotor.bearing_set import BearingSet
from reduced_models.rotor.campbell import Campbell, campbell
from reduced_models.rotor.linear_bearing import LinearBearing
from reduced_models.rotor.linearise import LinearRotor, linearise
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.simulate import simulate_rotor

_Floats = NDArray[np.float64]
Mode = tuple[float, float]  # frequency [Hz], logarithmic decrement

# Damping over stiffness of a rolling bearing where it is not known [s]: Kraemer (Dynamics of Rotors and
# Foundations, 1993) gives 0.25e-5 to 2.5e-5, and ROSS's BallBearingElement has the middle.
USUAL_DAMPING = 1.25e-5
FILM, DRY, CONSTANT, USUAL = "memory", "dry", "constant", "usual"  # the models
SWEEP = (0.25, 3.0)  # over the speed: where the Campbell diagram begins and ends
MODES, SPEEDS = 4, 5  # of that diagram
OVER_SPEED = 9  # speeds of that sweep at which films, stiffness and damping are listed
BAND = (0.1, 100.0)  # over the frequency of the shaft: K and C of the bearing
FREQUENCIES = 31
# Of the response: from a share of the shaft's frequency to a multiple of the fastest mode of the table, so many
# frequencies, and as many again about that mode, close enough for decrements of 1e-3.
BEGIN, BEYOND, COARSE, CLOSE = 0.2, 2.0, 120, 81
NARROW = 0.04  # of the frequency of a mode: how far on either side they are close


@dataclass(frozen=True)
class ModelRun:
    """The rotor on one kind of bearing: its motion under unbalance, and its slowest vibrations.

    Attributes
    ----------
    t : ndarray, shape (k,)
        Of the turns that are shown [s].
    ring, disc : ndarray, shape (k, 2)
        Displacements of the left inner ring and of the disc [m].
    vertical, horizontal : (float, float) or None
        Slowest mode of each direction, where one oscillates.
    linear : LinearRotor
        The rotor about static equilibrium, films and balls as at its speed.
    """

    t: _Floats
    ring: _Floats
    disc: _Floats
    vertical: Mode | None
    horizontal: Mode | None
    linear: LinearRotor
    largest_load: float | None = None  # of any ball, in the whole run [N]

    def amplitudes_at(self, hz: tuple[float, ...]) -> _Floats:
        """Amplitudes of the disc's height at some frequencies, all fitted at once with a mean."""
        angles = 2.0 * pi * self.t[:, None] * np.array(hz)
        columns = np.hstack([np.ones((self.t.size, 1)), np.cos(angles), np.sin(angles)])
        parts = np.linalg.lstsq(columns, self.disc[:, 1], rcond=None)[0][1:]
        return np.hypot(parts[: len(hz)], parts[len(hz) :])

    def to_dict(self, speed_hz: float, passage_hz: float) -> dict[str, Any]:
        """All numbers, SI; swings from end to end, x and y."""
        once, _, passing, _ = self.amplitudes_at((speed_hz, 2.0 * speed_hz, passage_hz, 2.0 * passage_hz)).tolist()
        moving = self.largest_load is not None  # constant springs have neither balls nor a place of rest
        modes = {"vertical": self.vertical, "horizontal": self.horizontal}
        return {
            "deflection": -float(self.ring[:, 1].mean()) if moving else None,
            "ring_peak_to_peak": np.ptp(self.ring, axis=0).tolist(),
            "disc_peak_to_peak": np.ptp(self.disc, axis=0).tolist(),
            "at_speed": once,
            "at_ball_passage": passing if moving else None,
            "largest_load": self.largest_load,
            **{name: None if m is None else {"hz": m[0], "decrement": m[1]} for name, m in modes.items()},
        }


class AtSpeed(NamedTuple):
    """The bearing at one speed: in equilibrium under the load, a ball below, and K and C over the frequency."""

    state: BearingState
    small: BearingCoefficients

    def to_dict(self) -> dict[str, Any]:
        """Numbers in SI: force and film of every ball, inner and outer race, K and C along the load and across."""
        both = {"along": 1, "across": 0}
        return {
            "speed_rpm": self.state.speed_rpm,
            "force": self.state.force.tolist(),
            "h_min": None if self.state.h_min is None else self.state.h_min.tolist(),
            "hz": self.small.hz.tolist(),
            "stiffness": {name: self.small.stiffness[:, k, k].tolist() for name, k in both.items()},
            "damping": {name: self.small.damping[:, k, k].tolist() for name, k in both.items()},
        }


@dataclass(frozen=True)
class BearingModels:
    """A rotor on several models of its bearings, by the names of the models."""

    bearing: BallBearing
    state: BearingState  # under the radial load, a ball below
    dry_deflection: float  # under that load, without films [m]
    ran: Mapping[str, ModelRun]
    failed: Mapping[str, str]  # on which it could not be run, and why
    said: tuple[str, ...]  # warnings
    over_frequency: BearingCoefficients
    over_speed: tuple[AtSpeed, ...]  # rising, the study's among them
    constants: Mapping[str, tuple[float, float]]  # K and C along the load of those that are constant
    diagram: Campbell | str  # or why there is none
    response_hz: _Floats
    responses: Mapping[str, _Floats]  # of the disc over its eccentricity, x and y, shape (k, 2)
    speed_rpm: float

    @property
    def passage_hz(self) -> float:
        """Frequency of the balls' passage."""
        return self.bearing.frequencies(self.speed_rpm).bpfo

    @property
    def rows(self) -> dict[str, dict[str, Any]]:
        """Numbers of the runs."""
        return {name: run.to_dict(self.speed_rpm / 60.0, self.passage_hz) for name, run in self.ran.items()}

    @property
    def balls(self) -> list[dict[str, Any]]:
        """Every ball in static equilibrium under the load, inner and outer race; films in m."""
        state = self.state
        films = np.full_like(state.force, np.nan) if state.h_min is None else state.h_min
        degrees = np.degrees(state.angles - state.cage_angle)
        return [
            {"degrees": float(angle), "force": force.tolist(), "h_min": film.tolist()}
            for angle, force, film in zip(degrees, state.force, films, strict=True)
        ]

    def to_dict(self) -> dict[str, Any]:
        """All numbers, SI."""
        diagram = None if isinstance(self.diagram, str) else self.diagram
        return {
            "bearing": self.bearing.to_dict(),
            "speed_rpm": self.speed_rpm,
            "ball_passage_hz": self.passage_hz,
            "deflection": -float(self.state.displacement[1]),
            "dry_deflection": self.dry_deflection,
            "balls": self.balls,
            "runs": self.rows,
            "failed": dict(self.failed),
            "warnings": list(self.said),
            "constants": {name: {"stiffness": k, "damping": c} for name, (k, c) in self.constants.items()},
            "critical_speeds_rpm": None if diagram is None else [c.speed_rpm for c in diagram.critical_speeds()],
            "no_diagram": self.diagram if isinstance(self.diagram, str) else None,
            "resonance": self.resonance,
            "over_speed": [one.to_dict() for one in self.over_speed],
        }

    @property
    def resonance(self) -> dict[str, dict[str, dict[str, float]]]:
        """Highest points of the responses, by direction."""
        ways = "horizontal", "vertical"
        return {name: {way: self._highest(name, k) for k, way in enumerate(ways)} for name in self.responses}

    def _highest(self, name: str, k: int) -> dict[str, float]:
        """Largest response of the disc over its eccentricity along one direction, and where."""
        size = self.responses[name][:, k]
        return {"amplitude": float(size.max()), "hz": float(self.response_hz[np.argmax(size)])}


def compare_bearing_models(
    rotor_on: Callable[[BallBearing | LinearBearing], Rotor],
    wet: BallBearing,
    dry: BallBearing,
    *,
    load: float,
    speed_rpm: float,
    eccentricity: float,
    steps: int,
    revolutions: int,
    keep: Callable[[str, RotorResult], object],
) -> BearingModels:
    """Run a rotor with two alike bearings on every model of them.

    Parameters
    ----------
    rotor_on : callable
        The rotor on bearings; its nodes are "bearing 0" and "disc" among others.
    wet, dry : BallBearing
        The bearing with films and without.
    load : float
        Of each bearing, downwards [N].
    speed_rpm : float
    eccentricity : float
        Of the unbalance [m].
    steps, revolutions : int
        Steps in a revolution, and revolutions that are run; the second half is shown.
    keep : callable
        Takes the name and the run of every model with balls.

    Raises
    ------
    KeyboardInterrupt
        A run was interrupted.
    InputError, ConvergenceError
        Of the bearings in static equilibrium. A run that does not converge is left out, and stands in ``failed``.
    """
    weight, turn = (0.0, -load), 60.0 / speed_rpm
    times = turn / steps, turn * revolutions, turn * (revolutions // 2)
    ran: dict[str, ModelRun] = {}
    failed: dict[str, str] = {}
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", OutsideValidityWarning)
        for name, bearing in ((FILM, wet), (DRY, dry)):
            try:
                ran[name] = _run(rotor_on(bearing), speed_rpm, times, partial(keep, name))
            except ConvergenceError as error:
                failed[name] = str(error)
    film, hertz = (one.coefficients(weight, speed_rpm=speed_rpm, rpm=speed_rpm) for one in (wet, dry))
    constant = {
        CONSTANT: (film.stiffness[0], film.damping[0]),
        USUAL: (hertz.stiffness[0], USUAL_DAMPING * hertz.stiffness[0]),
    }
    ran |= {name: _linear(rotor_on(LinearBearing(*pair)), speed_rpm, times) for name, pair in constant.items()}
    hz = speed_rpm / 60.0 * np.geomspace(*BAND, FREQUENCIES)
    rotor = rotor_on(wet)
    grid, disc = _response_grid(speed_rpm / 60.0, ran), list(rotor.nodes["disc"].values())
    return BearingModels(
        bearing=wet,
        state=wet.equilibrium(weight, speed_rpm=speed_rpm),
        dry_deflection=-float(dry.equilibrium(weight, speed_rpm=speed_rpm).displacement[1]),
        ran=ran,
        failed=failed,
        said=tuple(dict.fromkeys(str(one.message) for one in said)),
        over_frequency=wet.coefficients(weight, speed_rpm=speed_rpm, hz=hz),
        over_speed=_over_speed(wet, weight, speed_rpm, hz),
        constants={name: (float(K[1, 1]), float(C[1, 1])) for name, (K, C) in constant.items()},
        diagram=campbell_or_reason(rotor, wet, speed_rpm),
        response_hz=grid,
        responses={
            name: np.abs(one.linear.unbalance_response(hz=grid).amplitude[:, disc]) / eccentricity
            for name, one in ran.items()
        },
        speed_rpm=speed_rpm,
    )


def _run(
    rotor: Rotor, rpm: float, times: tuple[float, float, float], keep: Callable[[RotorResult], object]
) -> ModelRun:
    """Time steps from the orbit of the linearised rotor on, so that little has to settle."""
    dt, until, begin = times
    linear = linearise(rotor, rpm)
    run = simulate_rotor(rotor, speed_rpm=rpm, dt=dt, until=until, start=linear.orbit())
    if run.status is Status.INTERRUPTED:
        raise KeyboardInterrupt
    keep(run)
    seen = run.t >= begin - 0.5 * dt
    return ModelRun(
        t=run.t[seen],
        ring=run.ring[seen, 0],
        disc=run.disc[seen],
        **_slowest(linear),
        linear=linear,
        largest_load=float(run.largest_load.max()),
    )


def _linear(rotor: Rotor, rpm: float, times: tuple[float, float, float]) -> ModelRun:
    """The settled rotor on bearings of constant stiffness and damping."""
    dt, until, begin = times
    linear = linearise(rotor, rpm)
    t: _Floats = np.asarray(np.arange(round(begin / dt), round(until / dt) + 1) * dt, np.float64)
    q = linear.motion(t)
    ring, disc = (q[:, list(rotor.nodes[node].values())] for node in ("bearing 0", "disc"))
    return ModelRun(t, ring, disc, **_slowest(linear), linear=linear)


def _slowest(linear: LinearRotor) -> dict[str, Any]:
    """Frequency and decrement of the slowest mode of each direction."""
    modes = linear.slowest()
    ways = {"vertical": modes.get("y"), "horizontal": modes.get("x")}
    return {way: None if mode is None else (mode.hz, mode.decrement) for way, mode in ways.items()}


def _response_grid(speed_hz: float, ran: Mapping[str, ModelRun]) -> _Floats:
    """Frequencies [Hz] that show all modes of the table."""
    modes = [mode[0] for run in ran.values() for mode in (run.vertical, run.horizontal) if mode is not None]
    wide = np.geomspace(BEGIN * speed_hz, BEYOND * max([speed_hz, *modes]), COARSE)
    near = [hz * (1.0 + NARROW * np.linspace(-1.0, 1.0, CLOSE) ** 3) for hz in modes]
    return np.unique(np.concatenate([wide, *near]))


def _over_speed(bearing: BallBearing, weight: tuple[float, float], rpm: float, hz: _Floats) -> tuple[AtSpeed, ...]:
    """At the speeds of the Campbell diagram and some between them, as far as the atlas has films."""
    sweep = np.linspace(SWEEP[0] * rpm, min(SWEEP[1] * rpm, bearing.highest_speed), OVER_SPEED)
    answers = []
    for speed in np.unique(np.append(sweep[np.abs(sweep - rpm) > 1e-6 * rpm], rpm)).tolist():
        try:
            state = bearing.equilibrium(weight, speed_rpm=speed)
            answers.append(AtSpeed(state, bearing.coefficients(weight, speed_rpm=speed, hz=hz)))
        except (ConvergenceError, InputError):  # slower, the atlas has no films under such loads
            continue
    return tuple(answers)


def campbell_or_reason(
    rotor: Rotor, bearing: BallBearing | BearingSet, rpm: float, count: int = MODES
) -> Campbell | str:
    """The slowest modes over the speed, as far as the bearing has films; or why there are none."""
    high = min(SWEEP[1] * rpm, bearing.highest_speed)
    try:
        return campbell(rotor, np.linspace(SWEEP[0] * rpm, high, SPEEDS), count=count)
    except (ConvergenceError, InputError) as error:
        return str(error)
