"""`simulate_full_films`: a rotor in which some contacts of its ball bearings are full films, the others elements.

A full film replaces an element during a time interval, for example while a defect passes; the height of the defect
is the surface of the film. In every time step the equilibrium of the ball is solved with a force of the film that
is linear in the approach about the last film solve, with the slope of the last two solves. The film is solved
again, from the start of the step, until the position of the ball and the force of the film are consistent.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ehlcontact import Grid
from ehlcontact.checks import parts, require_choice, require_instance, require_integer, require_positive
from ehlcontact.checks.kinds import INDEX, Callback, Count, Object
from ehlcontact.checks.quantity import fields_take, takes
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.point import OperatingPoint, Scales
from ehlcontact.quantities import FORCE, LENGTH, NUMBER, TIME
from ehlcontact.results.table import Display, QuantityTable
from ehlcontact.status import Status
from ehlcontact.summary import Summary, span
from reduced_models.bearing.ball_bearing import BallBearing
from reduced_models.bearing.kinematics import RPM_TO_RAD_S
from reduced_models.bearing.race import RACES
from reduced_models.bearing.track_surface import TrackSurface, tracks_at
from reduced_models.rotor.film_process import FilmAnswer, Submit, close_film, film_places, open_film, step_film
from reduced_models.rotor.integrate_python import BallSteps, PythonSteps
from reduced_models.rotor.prepared_run import PreparedRun
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.rotor import Rotor
from reduced_models.rotor.simulate import TOLERANCE, integrate, steps_until

_Floats = NDArray[np.float64]

USUAL_GRID = Grid()
CLOSE = 1e-3  # of the load at its start: force that a film may miss where it stands beside its ball
MOST_SOLVES = 12  # of a film in a step: one or two
NOISE = 3e-4  # of that load: smaller changes of force give no slope, for films are solved to a third of it
SLOPES = 0.05, 20.0  # over the dry slope at that load
STEEP = 1.5  # film at the nodes beside the lowest one over its own, from which a history says so
MOST_EVALUATIONS = 30  # of the balance of a step


@fields_take(ball=INDEX, between=parts.TIMES, bearing=INDEX)
@dataclass(frozen=True, kw_only=True)
class FullFilm(Summary):
    """A contact of a ball bearing that is computed as a full film during a time interval.

    Parameters
    ----------
    ball : int
        From 0, which is the ball at the cage angle.
    race : {"inner", "outer"}
    between : (float, float)
        Start and end [s] of the interval in which the film is solved. It starts at rest under the force that the
        contact has at the start.
    bearing : int
        Among the ball bearings of the rotor.
    grid : Grid
    largest_load : float
        Largest expected force, over that at the start; it determines the computed region.
    solved : bool
        False keeps the element and records its history only, for comparison with a run on the full film.

    Raises
    ------
    InputError
        A value outside its range.
    """

    ball: int
    race: str
    between: tuple[float, float]
    bearing: int = 0
    grid: Grid = USUAL_GRID
    largest_load: float = 2.0
    solved: bool = True

    def __post_init__(self) -> None:
        require_integer("ball", self.ball, "a whole number >= 0", 0)
        require_integer("bearing", self.bearing, "a whole number >= 0", 0)
        require_choice("race", self.race, RACES)
        require_instance("grid", self.grid, Grid, "a Grid")
        require_positive("largest_load", self.largest_load)
        if np.shape(self.between) != (2,) or not 0.0 <= self.between[0] < self.between[1] < np.inf:
            raise InputError("between", self.between, "two times, 0 <= start < end [s]")

    @property
    def contact(self) -> int:
        """Number of its contact in the bearing."""
        return 2 * self.ball + RACES.index(self.race)

    def steps(self, dt: float) -> tuple[int, int]:
        """Numbers of the steps `dt` [s] at whose ends it starts and ends."""
        start, end = self.between
        return round(start / dt), round(end / dt)


@dataclass(frozen=True, eq=False)
class ContactHistory(QuantityTable):
    """A contact of a bearing while its film is solved; entry 0 is the start.

    Attributes
    ----------
    t : ndarray, shape (k,)
        Times [s].
    approach : ndarray, shape (k,)
        Of ball and race without features [m].
    force : ndarray, shape (k,)
        In N.
    h_central, h_min : ndarray, shape (k,)
        Film in the centre, and the smallest [m]; NaN of an element.
    solves : ndarray, shape (k,)
        How often the film was solved in the step.
    operating_point : OperatingPoint or None
        Of the contact at the start; None of an element.
    offset : float
        Approach of the full film over that of the element under the load of the start [m]: their difference at
        rest, which the run leaves out.
    reservation : str
        What the history leaves open, in words; else empty: where the grid does not show the film at rest, and a
        smallest film with too few nodes.
    """

    t: Annotated[_Floats, TIME.over("t")]
    approach: Annotated[_Floats, LENGTH.over("t")]
    force: Annotated[_Floats, FORCE.over("t")]
    h_central: Annotated[_Floats, LENGTH.over("t")]
    h_min: Annotated[_Floats, LENGTH.over("t")]
    solves: Annotated[NDArray[np.int64], NUMBER.over("t")]
    operating_point: OperatingPoint | None
    offset: float
    reservation: str = ""

    DISPLAY: ClassVar[Display] = Display(rows="t", panels=("force", "approach", "h_central h_min"), first=0)

    def _summary_lines(self) -> list[str]:
        if not self.t.size:  # of a run that ended before
            return ["not begun"]
        what = "element" if self.operating_point is None else f"full film, solved {self.solves.sum()} times"
        lines = [
            f"{what}, from {self.t[0]:.6g} to {self.t[-1]:.6g} s in {self.t.size - 1} steps",
            f"force {span(self.force, 1.0, 'N')}, approach {span(self.approach, 1e6, 'µm')}",
        ]
        film = [] if self.operating_point is None else [f"smallest film {1e6 * self.h_min.min():.3g} µm"]
        return [*lines, *film, *filter(None, [self.reservation])]

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON."""
        return super().to_dict() | {"reservation": self.reservation}


@dataclass(frozen=True, eq=False)
class FullFilmRun:
    """`rotor`: run of a rotor; `films`: histories of its full films, in the order in which they were given."""

    rotor: RotorResult
    films: tuple[ContactHistory, ...]

    @property
    def status(self) -> Status:
        """Status of the run."""
        return self.rotor.status


@takes(
    rotor=Object(Rotor, "a Rotor"),
    dt=parts.STEP,
    until=parts.SECONDS,
    processes=Count(1, 1000),
    rho_inf=parts.SHARE,
    callback=Callback("step, steps"),
)
def simulate_full_films(
    rotor: Rotor,
    films: FullFilm | Sequence[FullFilm],
    *,
    speed_rpm: float,
    dt: float,
    until: float,
    start: Any = "static",
    tolerance: float | None = None,
    rho_inf: float = 0.8,
    processes: int = 1,
    callback: Callable[[int, int], object] | None = None,
) -> FullFilmRun:
    """Integrate a rotor on planar ball bearings of which chosen contacts are full films.

    All else is as in `simulate_rotor`. A film is carried by a node per step or less where ``dt`` is at most the
    mesh over the speed of the surfaces; it is solved once or twice per step.

    Parameters
    ----------
    rotor : Rotor
    films : FullFilm or sequence of FullFilm
        At least one.
    speed_rpm : float
        Of the shaft [rev/min], constant.
    dt, until, start, tolerance, rho_inf, callback
        As of `simulate_rotor`.
    processes : int
        Largest number of processes that solve films in parallel; with 1, films are solved in this process.

    Raises
    ------
    InputError
        As `simulate_rotor`; a ball, a race or a bearing that does not exist, a contact given twice, bearings with
        axial motion, without oil, with an oil supply or with heat, a surface that the grid does not resolve, as
        waves with fewer than four nodes; no film, or one that is solved in no step of the run.
    ConvergenceError
        No equilibrium was found in a step, or a film was not solved; ``result`` is the `FullFilmRun` up to then.
    """
    require_instance("rotor", rotor, Rotor, "a Rotor")
    require_integer("processes", processes, "a whole number >= 1", 1)
    films = [films] if isinstance(films, FullFilm) else films
    require_instance("films", films, Sequence, "a FullFilm, or a sequence of them")
    if not films:
        raise InputError("films", films, "at least one FullFilm; simulate_rotor runs without")
    _require_there(rotor, films)
    _require_times(films, dt, steps_until(dt, until))
    run = PreparedRun(rotor, require_positive("speed_rpm", speed_rpm), dt, steps_until(dt, until), start, rho_inf)
    with film_places(len(films), processes) as places:
        running = [_RunningFilm(run, one, place) for one, place in zip(films, places, strict=True)]
        supports = [
            FilmSteps(run, b, [film for film in running if film.spec.bearing == b]) for b in range(len(run.balls))
        ]
        integrator = PythonSteps(run, TOLERANCE if tolerance is None else tolerance, MOST_EVALUATIONS, supports)
        try:
            result = integrate(run, integrator, callback)
        except ConvergenceError as error:
            raise ConvergenceError(str(error), FullFilmRun(error.result, _histories(running))) from error
        finally:
            for film in running:
                film.close()
    return FullFilmRun(result, _histories(running))


def _require_there(rotor: Rotor, films: Sequence[FullFilm]) -> None:
    """Raise `InputError` for films that the rotor cannot have."""
    mounts, taken = rotor.ball_bearings, set()
    for i, film in enumerate(films):
        field = f"films[{i}]"
        require_instance(field, film, FullFilm, "a FullFilm")
        if film.bearing >= len(mounts):
            raise InputError(
                f"{field}.bearing", film.bearing, f"below {len(mounts)}, the ball bearings of the rotor"
            )
        mount = mounts[film.bearing]
        if film.ball >= mount.ball_bearing.balls:
            raise InputError(
                f"{field}.ball", film.ball, f"below {mount.ball_bearing.balls}, the balls of the bearing"
            )
        if mount.z is not None:
            raise InputError(f"{field}.bearing", film.bearing, "one without axial motion and tilts")
        if mount.ball_bearing.oil is None:
            raise InputError(f"{field}.bearing", film.bearing, "one with oil")
        if mount.ball_bearing.supply is not None:
            raise InputError(f"{field}.bearing", film.bearing, "one without an oil supply: full films are flooded")
        if mount.ball_bearing.thermal is not None:
            raise InputError(f"{field}.bearing", film.bearing, "one without heat: full films are isothermal")
        if (film.bearing, film.contact) in taken:
            raise InputError(field, f"{film.race} race, ball {film.ball}", "a contact that no other film has")
        taken.add((film.bearing, film.contact))


def _require_times(films: Sequence[FullFilm], dt: float, steps: int) -> None:
    """Raise `InputError` for films that are solved in no step of a run."""
    for i, film in enumerate(films):
        first, last = film.steps(dt)
        if first >= steps:
            allowed = f"a start of at most {(steps - 1) * dt:g} s, where the last step of the run begins"
            raise InputError(f"films[{i}].between", film.between, allowed)
        if first == last:
            raise InputError(f"films[{i}].between", film.between, f"at least a step long, {dt:g} s")


class FilmSteps(BallSteps):
    """Steps of one ball bearing with full films."""

    def __init__(self, run: PreparedRun, b: int, films: Sequence[_RunningFilm]) -> None:
        super().__init__(run.balls[b], run.dt, run.contacts.gain, run.shift[run.ball_directions[b]])
        self._films, self._step = films, 0

    def begin(self, omega: float) -> None:
        """Begin a step at whose end the shaft turns at `omega` [rad/s]."""
        for film in self._films:
            film.begin(self._step)
        self._step += 1
        super().begin(omega)

    def at(self, r: _Floats, rate: _Floats) -> tuple[_Floats, _Floats]:
        """Forces at the end of the step, and their slopes, with films that belong to the places of their balls."""
        for _ in range(MOST_SOLVES):
            found = super().at(r, rate)
            away = [film for film in self._films if film.is_away]
            if not away:
                return found
            for film in away:
                film.solve()
            for film in away:
                film.take()
        raise ConvergenceError(f"full film and ball found no common place in {MOST_SOLVES} solves", None)

    def expected(self, r: _Floats, rate: _Floats) -> _Floats:
        """Slopes to be expected there."""
        return super().at(r, rate)[1]

    def accept(self, r: _Floats, rate: _Floats) -> None:
        """Move to the end of the step."""
        super().accept(r, rate)
        for film in self._films:
            film.keep(self._step)


class _RunningFilm:
    """One film in a run: before, in and after the time in which it is solved."""

    def __init__(self, run: PreparedRun, spec: FullFilm, submit: Submit) -> None:
        motion, mount = run.balls[spec.bearing], run.rotor.ball_bearings[spec.bearing]
        self.spec, self._run, self._motion, self._submit = spec, run, motion, submit
        self._bearing: BallBearing = mount.ball_bearing
        self._first, self._last = spec.steps(run.dt)
        self._given = motion.full_films[spec.ball, RACES.index(spec.race)]
        self._rows: list[tuple[float, ...]] = []
        self._point: OperatingPoint | None = None
        self._scales: Scales
        self._offset, self._load = 0.0, 0.0
        self._step = self._solves = 0
        self._doubt = ""
        self._trend, self._before = 0.0, (0.0, 0.0)
        self._answer: FilmAnswer
        self._pending: Any = None

    def begin(self, step: int) -> None:
        """Begin the step after number `step`; the film starts or ends with it."""
        self._step, self._solves = step + 1, 0
        if step == self._first:
            if self.spec.solved:
                self._open(step)
            self._record(step, 0)
        elif step == self._last:
            self.close()
        if self._active:
            force, slope, approach = self._model
            last_force, last_approach = self._before
            trend = force - last_force - slope * (approach - last_approach)
            self._before = force, approach
            self._given["force"] = force + trend

    @property
    def is_away(self) -> bool:
        """Whether the film has to be solved where the ball is."""
        if not self._active:
            return False
        off = abs(self._approach() - self._given["approach"]) * self._given["slope"]
        return bool(self._solves == 0 or off > CLOSE * self._load)

    def solve(self) -> None:
        """Begin to solve the film where the ball is."""
        s = self._scales
        at = (self._approach() + self._offset) / s.length
        self._pending = self._submit(step_film, id(self), self._step, self._run.dt / s.time, at)

    def take(self) -> None:
        """Give the ball the film that was solved."""
        answer, s = self._pending.result(), self._scales
        _, slope, _ = self._model
        if self._solves:
            moved = (answer.approach - self._answer.approach) * s.length
            change = (answer.force - self._answer.force) * s.force
            if abs(slope * moved) > NOISE * self._load:
                least, most = (share * 1.5 * s.stiffness for share in SLOPES)
                slope = min(max(change / moved, least), most)
        self._answer, self._solves = answer, self._solves + 1
        self._give(answer.force * s.force, slope, answer.approach * s.length - self._offset)

    def keep(self, step: int) -> None:
        """Record the end of a step."""
        if self._first < step <= self._last:
            self._record(step, self._solves)

    def close(self) -> None:
        """Put the element back."""
        if self._active:
            self._given["slope"] = 0.0
            self._submit(close_film, id(self))

    def history(self) -> ContactHistory:
        """History of the film."""
        t, approach, force, h_central, h_min, beside, solves = np.array(self._rows).reshape(-1, 7).T
        counts, steep = solves.astype(np.int64), ""
        if self._point is not None and (most := float(beside[np.argmin(h_min)])) > STEEP:
            steep = f"the smallest film may be off by far: one node beside it, film is {most:.2g} times as thick"
        doubt = "; ".join(filter(None, [self._doubt, steep]))
        return ContactHistory(t, approach, force, h_central, h_min, counts, self._point, self._offset, doubt)

    @property
    def _active(self) -> bool:
        return bool(self._given["slope"] > 0.0)

    @property
    def _model(self) -> tuple[float, float, float]:
        """Force of the film, its slope, and the approach where it was solved."""
        return tuple(self._given.tolist())

    def _give(self, force: float, slope: float, approach: float) -> None:
        self._given["force"], self._given["slope"], self._given["approach"] = force, slope, approach

    def _approach(self) -> float:
        """Approach of ball and race, features left out, where `forces` was called last [m]."""
        return self._motion.approach(self.spec.ball, self.spec.race)

    def _open(self, step: int) -> None:
        """Start the film under the force that the contact has, at the end of a step."""
        spec, bearing, run = self.spec, self._bearing, self._run
        k, omega = spec.ball, float(run.omega[step])
        rpm = omega / RPM_TO_RAD_S
        force, race = float(self._motion.loads[k, RACES.index(spec.race)]), bearing.race(spec.race)
        lightest = race.loads(rpm)[0]
        if not force > lightest:
            allowed = f"times at which ball {k} carries more than {lightest:.3g} N on the {spec.race} race"
            raise InputError("between", spec.between, allowed)
        self._point, self._load = race.point(force, rpm), force
        self._scales = s = self._point.scales
        angles = self._motion.angle + 2.0 * np.pi * k / bearing.balls, float(run.angle[step])
        rates = self._motion.cage * omega * s.time, omega * s.time
        surface = TrackSurface(tracks_at(bearing, k, spec.race, angles, rates), s.a, s.length)
        task = self._submit(open_film, id(self), self._point.moes, spec.grid, surface, spec.largest_load)
        self._answer = task.result()
        self._doubt = self._answer.doubt
        here = self._approach()
        self._offset = self._answer.approach * s.length - here
        self._give(force, 1.5 * s.stiffness, here)
        self._before = force, here

    def _record(self, step: int, solves: int) -> None:
        k, column = self.spec.ball, RACES.index(self.spec.race)
        film = (np.nan, np.nan, np.nan)
        if self._active:
            answer, unit = self._answer, self._scales.length
            film = answer.h_central * unit, answer.h_min * unit, answer.beside_h_min
        self._rows.append(
            (self._run.t[step], self._approach(), float(self._motion.loads[k, column]), *film, solves)
        )


def _histories(running: Sequence[_RunningFilm]) -> tuple[ContactHistory, ...]:
    return tuple(film.history() for film in running)
