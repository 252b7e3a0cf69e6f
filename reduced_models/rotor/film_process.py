"""Full films that follow the contacts of a run, each in this process or in a worker of an executor.

`open_film`, `step_film` and `close_film` run where the film is, which keeps it by its number between calls.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

from ehlcontact import Grid, MoesPoint, TransientContact
from ehlcontact.errors import ConvergenceError
from ehlcontact.executors import ProcessExecutor
from reduced_models.bearing.track_surface import TrackSurface

SHARES = (1, 2, 4, 8)  # of a time step, tried one after another where a film is not solved


class FilmAnswer(NamedTuple):
    """A full film at the end of a step, in Moes units."""

    approach: float
    force: float
    h_central: float
    h_min: float
    beside_h_min: float = 1.0  # of `TransientContact`
    doubt: str = ""  # about its grid at rest


@dataclass
class _Following:
    """A film, the step it is in, and its state and approach at the start of that step."""

    contact: TransientContact
    approach: float
    step: int = 0
    start: Any = None
    start_approach: float = 0.0


_films: dict[int, _Following] = {}  # of this process


def open_film(number: int, point: MoesPoint, grid: Grid, surface: TrackSurface, largest_load: float) -> FilmAnswer:
    """A film at rest under the load of its point; raises `InputError` for waves too short for its grid."""
    contact = TransientContact(point, grid=grid, surface=surface, largest_load=largest_load)
    surface.require_resolved((contact.domain.x_out - contact.domain.x_in) / contact.n)
    _films[number] = _Following(contact, contact.static_approach)
    return _answer(_films[number])


def step_film(number: int, step: int, dT: float, approach: float) -> FilmAnswer:
    """The film after a `step` of length dT that leads to an approach, always from the start of that step."""
    film = _films[number]
    if step != film.step:
        film.step, film.start, film.start_approach = step, film.contact.save_state(), film.approach
    for shares in SHARES:
        film.contact.restore_state(film.start)
        try:
            for i in range(1, shares + 1):
                moved = (approach - film.start_approach) * i / shares
                film.contact.advance(dT / shares, film.start_approach + moved)
        except ConvergenceError:
            if shares == SHARES[-1]:
                raise
        else:
            break
    film.approach = approach
    return _answer(film)


def close_film(number: int) -> None:
    """Forget a film."""
    _films.pop(number, None)


def _answer(film: _Following) -> FilmAnswer:
    contact = film.contact
    films = contact.h_central, contact.h_min, contact.beside_h_min
    return FilmAnswer(film.approach, contact.force, *films, contact.reservation)


class Submit(Protocol):
    """Call a function here or elsewhere."""

    def __call__(self, function: Callable[..., Any], /, *args: Any) -> Future[Any]:
        """Future of its result."""


@contextmanager
def film_places(films: int, processes: int) -> Iterator[list[Submit]]:
    """For every film how to call a function where it is; with one process, or one film, that is here."""
    with ExitStack() as stack:
        count = min(films, processes)
        if count < 2:
            yield [_here] * films
            return
        places: list[Executor] = [stack.enter_context(ProcessExecutor(1, threads=1)) for _ in range(count)]
        yield [places[i % count].submit for i in range(films)]


def _here(function: Callable[..., Any], /, *args: Any) -> Future[Any]:
    future: Future[Any] = Future()
    try:
        future.set_result(function(*args))
    except Exception as error:
        future.set_exception(error)
    return future
