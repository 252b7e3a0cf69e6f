"""Full films in ball bearings of a rotor: coupling against elements, surfaces against heights, refinement."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from ehlcontact import Dent, Grid, Lubricant, MoesPoint, PrescribedApproach, TimeSteps, TransientContact, simulate
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.solver.lowest_film import beside_lowest
from ehlcontact.status import Status
from ehlcontact.transient import roughness
from reduced_models import (
    BallBearing,
    BallDiameter,
    BallWaviness,
    BearingMount,
    Indentation,
    RaceWaviness,
    Rotor,
    Spall,
    simulate_rotor,
)
from reduced_models.bearing import track_surface
from reduced_models.bearing.contact_heights import contact_height
from reduced_models.bearing.height_tables import track_radius
from reduced_models.bearing.track_surface import TrackSurface, tracks_at
from reduced_models.rotor import bearing_films
from reduced_models.rotor.bearing_films import FullFilm, simulate_full_films
from reduced_models.rotor.film_process import FilmAnswer

RPM, MASS, DAMPING, LOAD = 1800.0, 5.0, 2000.0, 500.0
AT = -pi / 2.0
PITCH = 0.6  # of a ball pitch, that the first ball is past the spall at the start: ball 8 comes to it


@pytest.fixture(scope="module")
def smooth():
    return BallBearing.catalogue("6205", clearance=5e-6, oil=Lubricant.iso_vg(68, temperature=50.0))


def block(bearing, **options):
    """A mass on the bearing, under its load."""
    mount = BearingMount(bearing=bearing, x=0, y=1, cage_angle=AT + PITCH * 2.0 * pi / bearing.balls)
    return Rotor(
        mass=np.diag([MASS, MASS]),
        damping=np.diag([DAMPING, DAMPING]),
        stiffness=np.zeros((2, 2)),
        load=(0.0, -LOAD),
        mounts=(mount,),
        **options,
    )


def passage(bearing):
    """Time at which ball 8 is at `AT`, and its speed along the outer track."""
    cage = bearing.orders.ftf_order * RPM * pi / 30.0
    return (1.0 - PITCH) * 2.0 * pi / bearing.balls / cage, cage * track_radius(bearing, "outer")


class Known:
    """An answer that is known: a Hertz spring, one step of which is straight up to rounding, in place of films."""

    def __init__(self, stiffer=1.0):
        self.stiffer, self.point, self.solves = stiffer, None, 0

    def open(self, number, point, grid, surface, largest_load):
        self.point = point
        return FilmAnswer(0.9, 1.0, 0.1, 0.05)

    def step(self, number, step, dT, approach):
        self.solves += 1
        return FilmAnswer(approach, max(1.0 + self.stiffer * (approach - 0.9), 0.0), 0.1, 0.05)


@pytest.fixture
def known(monkeypatch):
    """A spring in place of every film."""
    answer = Known()
    monkeypatch.setattr(bearing_films, "open_film", answer.open)
    monkeypatch.setattr(bearing_films, "step_film", answer.step)
    return answer


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_coupled_ball_balances_on_its_film(smooth, known, race):
    """Force over approach is that of the answer, and the motion that of a rotor on it; far stiffer ones too."""
    known.stiffer = 3.0
    spec = FullFilm(ball=8, race=race, between=(1e-4, 1e-3))
    rotor = block(smooth)
    start = rotor.equilibrium(RPM) + np.array([0.0, 1e-6]), np.zeros(2)
    run = simulate_full_films(rotor, [spec], speed_rpm=RPM, dt=1e-5, until=1.2e-3, start=start)
    film = run.films[0]
    scales = film.operating_point.scales
    assert film.t[0] == pytest.approx(1e-4)
    assert film.t[-1] == pytest.approx(1e-3)
    u = (film.approach + film.offset) / scales.length
    np.testing.assert_allclose(film.force / scales.force, 1.0 + 3.0 * (u - 0.9), atol=1.5e-3)
    assert np.ptp(film.force) > 0.05 * scales.force  # it moves
    assert film.solves[1:].mean() < 2.5
    # without it the contact would be softer: 1.5 of these units
    soft = simulate_full_films(
        rotor, [replace(spec, solved=False)], speed_rpm=RPM, dt=1e-5, until=1.2e-3, start=start
    )
    assert np.ptp(soft.films[0].force) < 0.9 * np.ptp(film.force)


def test_run_without_films_is_that_of_simulate_rotor(smooth):
    """The element that stays has its history; Newton's method in Python gives what the compiled one gives."""
    options = {"speed_rpm": RPM, "dt": 1e-5, "until": 1e-3, "tolerance": 1e-9}
    rotor = block(replace(smooth, features=[RaceWaviness(race="outer", waves=40, amplitude=1e-7)]))
    spec = FullFilm(ball=8, race="outer", between=(0.0, 1.0), solved=False)
    one = simulate_full_films(rotor, [spec], **options)
    other = simulate_rotor(rotor, **options)
    np.testing.assert_allclose(one.rotor.displacement, other.displacement, atol=1e-13)
    assert one.films[0].t.size == other.t.size
    assert np.ptp(one.films[0].force) > 1.0
    assert one.films[0].operating_point is None


@pytest.mark.long
@pytest.mark.parametrize("race", ["inner", "outer"])
@pytest.mark.parametrize("psi", [pytest.param(0.3, marks=pytest.mark.long), 2.0])
def test_surface_is_what_the_height_tables_have(smooth, race, psi):
    """In the centre, of waves so long that a contact does not filter them; and it moves with both surfaces."""
    waves = [
        RaceWaviness(race="inner", waves=3, amplitude=2e-6, phase=0.4),
        RaceWaviness(race="outer", waves=5, amplitude=1e-6, phase=1.0),
        BallWaviness(ball=2, waves=2, amplitude=5e-7, phase=0.2),
    ]
    bearing = replace(smooth, features=[*waves, BallDiameter(ball=2, excess=1e-6)])
    point = bearing.race(race).point(200.0, RPM)
    s, omega, shaft = point.scales, RPM * pi / 30.0, 0.7
    rates = bearing.orders.ftf_order * omega * s.time, omega * s.time
    surface = TrackSurface(tracks_at(bearing, 2, race, (psi, shaft), rates), s.a, s.length)
    X, T = np.array([[0.0, 0.5]]), 0.8
    here = surface(X, np.zeros((1, 1)), T)[0]
    turned = shaft + rates[1] * T
    at = psi + rates[0] * T, (turned, bearing.orders.bsf_order * turned)
    table = contact_height(bearing.tables.heights, 2, ("inner", "outer").index(race), *at, 0.0)
    assert -here[0] * s.length + 5e-7 == pytest.approx(table, abs=1e-8)
    later = surface(X, np.zeros((1, 1)), T + 0.5)[0]
    assert later[1] == pytest.approx(here[0], abs=1e-6 / s.length * 1e-3)


def test_film_under_a_surface_is_that_of_simulate():
    """`TransientContact` and `simulate` with a dent that passes, at the same approach."""
    point, dent, grid = MoesPoint(200, 10, 0.5), Dent(depth=0.1, radius=1.0, kappa=0.5), Grid(n=32)
    contact = TransientContact(point, grid=grid, surface=dent)
    u, start = contact.static_approach, contact.save_state()
    held = PrescribedApproach([0.0, 1.0, 2.0, 3.0], [u] * 4)
    run = simulate(point, held, grid=grid, time=TimeSteps(until=3.0, dt=0.1, tol=3e-3), surface=dent)
    force = [contact.advance(0.1, u) for _ in range(30)]
    np.testing.assert_allclose(force, run.force[1:], rtol=2e-4)
    assert np.ptp(force) > 0.008
    contact.restore_state(start)
    assert contact.advance(0.1, u) == force[0]


BAD = (
    ({"race": "middle"}, "race = 'middle'"),
    ({"ball": -1}, "ball = -1"),
    ({"between": (2e-3, 1e-3)}, "between"),
    ({"between": (0.0, float("nan"))}, "between"),
    ({"between": 1e-3}, "between"),
    ({"between": (1.0, 2.0)}, r"films\[0\].between = .*at most 9e-05 s"),
    ({"between": (2e-5, 2.2e-5)}, r"films\[0\].between = .*at least a step long, 1e-05 s"),
    ({"largest_load": 0.0}, "largest_load = 0"),
    ({"ball": 9}, r"films\[0\].ball = 9: must be below 9"),
    ({"bearing": 1}, r"films\[0\].bearing = 1"),
    ({"ball": 4, "race": "inner"}, "times at which ball 4 carries more than"),
)


@pytest.mark.parametrize(("values", "message"), BAD)
def test_bad_films(smooth, values, message):
    with pytest.raises(InputError, match=message):
        films = [FullFilm(**{"ball": 8, "race": "outer", "between": (0.0, 1e-3)} | values)]
        simulate_full_films(block(smooth), films, speed_rpm=RPM, dt=1e-5, until=1e-4)


def test_films_that_no_run_can_have(smooth, known):
    film = FullFilm(ball=8, race="outer", between=(0.0, 1e-3))
    options = {"speed_rpm": RPM, "dt": 1e-5, "until": 1e-4}
    with pytest.raises(InputError, match="a contact that no other film has"):
        simulate_full_films(block(smooth), [film, film], **options)
    with pytest.raises(InputError, match="one with oil"):  # of one alone, too
        simulate_full_films(block(replace(smooth, oil=None)), film, **options)
    with pytest.raises(InputError, match=r"films = .*at least one"):
        simulate_full_films(block(smooth), [], **options)
    with pytest.raises(InputError, match="films = 3: must be a FullFilm"):
        simulate_full_films(block(smooth), 3, **options)
    with pytest.raises(InputError, match="one without heat: full films are isothermal"):
        simulate_full_films(block(replace(smooth, thermal=True)), [film], **options)
    with pytest.raises(InputError, match="processes"):
        simulate_full_films(block(smooth), [film], processes=0, **options)


@pytest.mark.long
def test_waves_that_the_grid_does_not_show_are_refused(smooth):
    """Four nodes of the grid to a wave, as of a rough surface in `simulate`."""
    film = FullFilm(ball=8, race="outer", between=(0.0, 1e-3), grid=Grid(n=48))
    wavy = block(replace(smooth, features=[RaceWaviness(race="outer", waves=4000, amplitude=1e-8)]))
    with pytest.raises(InputError, match=r"waves = 4000: must be at most .* 4 nodes to a wave: raise n"):
        simulate_full_films(wavy, [film], speed_rpm=RPM, dt=1e-5, until=1e-4)
    assert track_surface.FEWEST_NODES == roughness.FEWEST_NODES
    point = smooth.race("outer").point(200.0, RPM)
    tracks = tracks_at(wavy.mounts[0].bearing, 8, "outer", (0.0, 0.0), (1.0, 1.0))
    surface = TrackSurface(tracks, point.scales.a, point.scales.length)
    wave = 2.0 * pi * tracks[0].radius / 4000 / point.scales.a
    surface.require_resolved(0.2499 * wave)
    with pytest.raises(InputError, match="at most 3998 in a"):
        surface.require_resolved(0.2501 * wave)


@pytest.mark.parametrize(("beside", "noted"), [(3.5, True), (1.2, False)])
def test_smallest_film_of_a_node_is_named(smooth, known, monkeypatch, beside, noted):
    """Judged at the smallest film of the run, not elsewhere; with the doubt of the film at rest."""

    def step(number, step, dT, approach):
        lowest = step == 30
        found = known.step(number, step, dT, approach)
        return found._replace(h_min=0.01 if lowest else 0.05, beside_h_min=beside if lowest else 9.0)

    monkeypatch.setattr(bearing_films, "step_film", step)
    film = FullFilm(ball=8, race="outer", between=(0.0, 1e-3))
    found = simulate_full_films(block(smooth), [film], speed_rpm=RPM, dt=1e-5, until=1e-3).films[0]
    assert ("one node beside it, film is 3.5 times as thick" in str(found)) == noted
    assert bool(found.to_dict()["reservation"]) == noted


def test_film_beside_the_lowest_node():
    H = np.array([[3.0, 2.0, 4.0, 5.0], [3.0, 1.0, 4.0, 5.0]])
    assert beside_lowest(H) == 3.5
    assert beside_lowest(-H) == np.inf


def test_film_that_is_not_solved_ends_the_run(smooth, known, monkeypatch):
    """With the steps before it."""

    def fail(number, step, dT, approach):
        if step > 20:
            raise ConvergenceError("EHL step unresolved", None)
        return known.step(number, step, dT, approach)

    monkeypatch.setattr(bearing_films, "step_film", fail)
    film = FullFilm(ball=8, race="outer", between=(0.0, 1e-3))
    with pytest.raises(ConvergenceError, match="EHL step unresolved") as caught:
        simulate_full_films(block(smooth), [film], speed_rpm=RPM, dt=1e-5, until=1e-3)
    found = caught.value.result
    assert found.rotor.status is Status.FAILED
    assert found.rotor.t.size == found.films[0].t.size == 21


def spall_passage(smooth, dt, processes=1, films=("outer",), n=128, depth=2e-6):
    """Full and reduced run of ball 8 over a spall under the load."""
    bearing = replace(smooth, features=[Spall(race="outer", angle=AT, length=5e-4, depth=depth, edge=1e-4)])
    middle, speed = passage(bearing)
    between = middle - 9e-4 / speed, middle + 9e-4 / speed
    specs = [FullFilm(ball=8, race=race, between=between, grid=Grid(n=n)) for race in films]
    options = {"speed_rpm": RPM, "dt": dt, "until": between[1] + 1e-4}
    full = simulate_full_films(block(bearing), specs, processes=processes, **options)
    reduced = simulate_full_films(block(bearing), [replace(one, solved=False) for one in specs], **options)
    return full, reduced


@pytest.mark.slow
def test_passage_of_a_spall(smooth, monkeypatch):
    """Full beside reduced answer, and the full one with half the step, and with a closer coupling."""
    full, reduced = spall_passage(smooth, 5.4e-6)
    film, element = full.films[0], reduced.films[0]
    swing, off = np.ptp(film.force), film.force - element.force
    assert swing > 80.0
    assert np.abs(off).max() < 0.03 * swing
    assert np.abs(full.rotor.displacement - reduced.rotor.displacement).max() < 0.002 * 1.2e-5
    fine, _ = spall_passage(smooth, 2.7e-6)
    there = np.interp(film.t, fine.films[0].t, fine.films[0].force)
    assert np.abs(there - film.force).max() < 0.02 * swing
    monkeypatch.setattr(bearing_films, "CLOSE", 1e-4)
    closer, _ = spall_passage(smooth, 5.4e-6)
    assert np.abs(closer.films[0].force - film.force).max() < 0.005 * swing


@pytest.mark.slow
def test_processes_give_the_same(smooth):
    """Both contacts of a ball, in this process and in two of their own."""
    one, _ = spall_passage(smooth, 1e-5, films=("outer", "inner"), n=96, depth=5e-7)
    two, _ = spall_passage(smooth, 1e-5, processes=2, films=("outer", "inner"), n=96, depth=5e-7)
    for mine, other in zip(one.films, two.films, strict=True):
        np.testing.assert_array_equal(mine.force, other.force)
    np.testing.assert_array_equal(one.rotor.displacement, two.rotor.displacement)


@pytest.mark.slow
def test_dent_on_a_ball_passes_the_inner_race(smooth):
    """A feature of a ball meets a race when the tables say so."""
    dent = Indentation(ball=8, angle=0.0, length=6e-4, depth=1.5e-6)
    bearing = replace(smooth, features=[dent])
    spin = bearing.orders.bsf_order * RPM * pi / 30.0
    meets = 2.0 * pi / spin
    film = FullFilm(ball=8, race="inner", between=(meets - 4e-4, meets + 4e-4), grid=Grid(n=96))
    rotor = block(bearing)
    rotor = replace(rotor, mounts=(replace(rotor.mounts[0], cage_angle=AT + 2.0 * pi / 9.0 * 0.35),))
    options = {"speed_rpm": RPM, "dt": 5e-6, "until": meets + 4e-4}
    full, reduced = (
        simulate_full_films(rotor, [replace(film, solved=s)], **options).films[0] for s in (True, False)
    )
    lowest = [float(one.t[np.argmin(one.force)]) for one in (full, reduced)]
    assert lowest[0] == pytest.approx(lowest[1], abs=2e-5)
    assert np.ptp(full.force) == pytest.approx(np.ptp(reduced.force), rel=0.2)
