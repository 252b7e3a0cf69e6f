"""Capacitance of bearings: balls in series and parallel, voltage, films from a measurement."""

import numpy as np
import pytest

from ehlcontact import Grid, InputError, Lubricant, solve_steady
from reduced_models import BallBearing, BearingSet, Disc, Shaft, Support, rotor_on_bearings, simulate_rotor
from reduced_models.bearing.equilibrium_result import BearingState
from reduced_models.rotor.capacitance_run import capacitance_of_run

OIL = Lubricant.iso_vg(68, temperature=50.0)


@pytest.fixture(scope="module")
def bearing() -> BallBearing:
    return BallBearing.catalogue("6205", oil=OIL, clearance=10e-6)


@pytest.fixture(scope="module")
def state(bearing: BallBearing) -> BearingState:
    return bearing.equilibrium((0.0, -1000.0), speed_rpm=3000.0)


class TestBearing:
    def test_series_and_parallel(self, state: BearingState) -> None:
        found = state.capacitance()
        series = 1.0 / (1.0 / found.contact[:, 0] + 1.0 / found.contact[:, 1])
        assert found.ball == pytest.approx(series, rel=1e-12)
        assert found.total == pytest.approx(series.sum(), rel=1e-12)
        assert found.least < found.total < found.largest
        assert found.ball.argmax() == state.heaviest

    def test_voltage_of_both_films(self, state: BearingState) -> None:
        found = state.capacitance()
        across = found.voltage(10.0)
        assert across.sum(axis=1) == pytest.approx(np.full(9, 10.0), rel=1e-12)
        assert found.field_strength(10.0) == pytest.approx(1e-6 * (across / found.h_min).max())

    def test_a_contact_against_its_solved_film(self, bearing: BallBearing, state: BearingState) -> None:
        k = state.heaviest
        point = bearing.race("inner").point(float(state.force[k, 0]), 3000.0)
        solved = solve_steady(point, grid=Grid(64)).capacitance(reach=0.5 * bearing.ball_diameter)
        assert state.capacitance().contact[k, 0] == pytest.approx(solved.total, rel=0.08)

    def test_a_light_contact_against_its_solved_film(self) -> None:
        """Its film carries it before the dry bodies would touch: it has the capacitance of its load."""
        bearing = BallBearing.catalogue("6205", oil=OIL, clearance="C3")
        state = bearing.equilibrium((0.0, -20.0, 20.0), speed_rpm=3000.0)
        assert state.contact_angles is not None
        k = int(state.force[:, 1].argmin())
        assert state.force[k, 1] > 0.0 > state.approach[k, 1]
        own = bearing.race("outer")
        race = own.at_angle(bearing.pitch_diameter, float(state.contact_angles[k, 1]), own.speed_sum)
        film = solve_steady(race.point(float(state.force[k, 1]), 3000.0), grid=Grid(64))
        solved = film.capacitance(reach=0.5 * bearing.ball_diameter)
        assert state.capacitance().contact[k, 1] == pytest.approx(solved.total, rel=0.1)

    def test_more_load_and_less_speed_have_more(self, bearing: BallBearing, state: BearingState) -> None:
        slow = bearing.equilibrium((0.0, -1000.0), speed_rpm=1000.0).capacitance()
        heavy = bearing.equilibrium((0.0, -2000.0), speed_rpm=3000.0).capacitance()
        assert min(slow.total, heavy.total) > state.capacitance().total

    def test_at_contact_angles_and_in_a_pair(self) -> None:
        spindle = BallBearing.catalogue("7205", oil=OIL)
        pair = BearingSet.pair(spindle, "back to back", preload=200.0)
        state = pair.equilibrium((0.0, -100.0, 0.0), speed_rpm=6000.0)
        found, each = state.capacitance(), [one.capacitance() for one in state.bearings]
        assert found.total == pytest.approx(sum(one.total for one in each), rel=1e-12)
        assert found.field_strength(1.0) == max(one.field_strength(1.0) for one in each)
        assert found.ball.size == 26


class TestMeasured:
    def test_there_and_back(self, state: BearingState) -> None:
        found = state.film_from_capacitance(state.capacitance().total, error=1e-12)
        assert found.ratio == pytest.approx(1.0, rel=1e-6)
        assert found.low < 1.0 < found.high
        assert "times the computed ones, between" in str(found)
        assert state.film_from_capacitance(1.3 * state.capacitance().total).ratio < 0.75

    @pytest.mark.parametrize(
        ("capacitance", "given", "words"),
        [
            (76.0, {}, "in pF"),
            (1e-13, {}, "between"),
            (76e-12, {"error": 80e-12}, "below the capacitance"),
            (76e-12, {"permittivity": 0.5}, "permittivity"),
            (-1.0, {}, "capacitance"),
        ],
    )
    def test_refused(self, state: BearingState, capacitance: float, given: dict[str, float], words: str) -> None:
        with pytest.raises(InputError, match=words):
            state.film_from_capacitance(capacitance, **given)

    def test_a_dry_bearing(self, bearing: BallBearing) -> None:
        with pytest.raises(InputError, match="rings touch"):
            bearing.dry.equilibrium((0.0, -1000.0)).capacitance()


class TestRuns:
    def test_a_run_begins_as_the_bearing_at_rest(self, bearing: BallBearing) -> None:
        shaft = Shaft(length=0.2, diameter=0.025)
        disc = Disc.cylinder(position=0.1, diameter=0.15, width=0.2, bore=0.025, unbalance=1e-4)
        supports = [Support(position=place, bearing=bearing) for place in (0.02, 0.18)]
        rotor = rotor_on_bearings(shaft, discs=[disc], supports=supports)
        run = simulate_rotor(rotor, speed_rpm=3000.0, dt=5e-5, until=5e-3)
        found = capacitance_of_run(rotor, run, 1, every=50)
        rest = bearing.equilibrium(tuple(run.force[0, 2:4]), speed_rpm=3000.0, cage_angle=-0.5 * np.pi)
        assert found.t == pytest.approx([0.0, 2.5e-3, 5e-3])
        assert found.capacitance[0] == pytest.approx(rest.capacitance().total, rel=1e-6)
        assert found.capacitance[-1] != found.capacitance[0]
        named = capacitance_of_run(rotor, run, found.name, every=100)
        assert named.capacitance[0] == found.capacitance[0] and named.name == "bearing 1"
        with pytest.raises(InputError, match="bearing 0, bearing 1"):
            capacitance_of_run(rotor, run, "left")
        with pytest.raises(InputError, match="below 2"):
            capacitance_of_run(rotor, run, 2)
        with pytest.raises(InputError, match="every"):
            capacitance_of_run(rotor, run, every=0)
