"""Dents through a contact, rolling and sliding: what they do to the film, and that fine grids carry them."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from argument_groups import grouped

from ehlcontact import Dent, Domain, Grid, MoesPoint, PrescribedLoad, Roughness, simulate, solve_steady

MOURIER = MoesPoint(63.78, 5.788, 1.0)
NEAR = Domain(-2.5, 1.5, 2.0)
DEPTH, RADIUS = 0.107, 0.1887  # 160 nm and 1.2 x 21.5 um at Mourier's point, as they slid


def steady_load(until):
    return PrescribedLoad(np.linspace(0.0, until, 4), np.ones(4))


def passing(speed, start, until, n=128, **options):
    surface = Dent(DEPTH, RADIUS, start, speed=speed)
    settings = {"n": n, "domain": NEAR, "until": until, "dt": 4.0 / n, "surface": surface, "threads": 1}
    return simulate(MOURIER, steady_load(until), **grouped(**settings | options))


class Passage:
    """Film along the middle less the smooth one, over the central film, around a dent."""

    def __init__(self, run, surface):
        self.X, self.surface = run.X, surface
        self.change = (run.h_midplane - run.h_midplane[0]) / run.h_central[0]
        self.T = run.T

    def at(self, T):
        """The change at time T, where the dent is, and the places within the contact but outside the dent."""
        k = int(np.argmin(np.abs(self.T - T)))
        centre = self.surface.start + self.surface.speed * self.T[k]
        contact = np.abs(self.X) < 0.85
        return self.change[k], centre, contact


def crest(X, change, where):
    """Largest change in a stretch, and its place by a parabola."""
    k = np.flatnonzero(where)[np.argmax(change[where])]
    below, top, above = change[k - 1 : k + 2]
    return top, X[k] + 0.5 * (X[1] - X[0]) * (below - above) / (below - 2.0 * top + above)


@pytest.fixture(scope="module")
def passages():
    cases = {"rolling": (1.0, -1.5, 1.5), "slower": (0.5, -1.375, 2.25), "faster": (1.5, -1.75, 1.25)}
    found = {}
    for name, (speed, start, until) in cases.items():
        run = passing(speed, start, until)
        assert run.status.ok
        found[name] = Passage(run, Dent(DEPTH, RADIUS, start, speed=speed))
    return found


def test_a_rolling_dent_is_carried_as_it_is(passages):
    """Dent and film go together: the same change, at the same place of the surface, and nothing elsewhere."""
    passage = passages["rolling"]
    X, (now, centre, contact), (before, centre_before, _) = passage.X, passage.at(1.5), passage.at(1.25)
    assert now[np.abs(X - centre) < 0.15].max() == pytest.approx(
        before[np.abs(X - centre_before) < 0.15].max(), rel=0.02
    )
    around = np.abs(X - centre) < 0.5  # ahead of it the film is thinner, and stays so
    shifted = np.roll(before, round(0.25 / (X[1] - X[0])))
    assert np.abs(now - shifted)[around].max() < 0.02
    assert np.abs(now[contact & ~around]).max() < 0.01


def test_what_a_dent_does_in_the_inlet_runs_with_the_oil(passages):
    """A dent on the slower surface lets more oil in, which runs ahead of it at dX/dT = 1 (Mourier et al. 2006)."""
    passage, crests = passages["slower"], []
    for T in (1.75, 2.25):
        change, centre, contact = passage.at(T)
        height, place = crest(passage.X, change, contact & (passage.X > centre + 0.3))
        crests.append(place)
        assert height > 0.2
    assert np.abs(change[contact & (passage.X < centre - 0.4)]).max() < 0.02  # behind it the film is smooth
    assert crests[1] - crests[0] == pytest.approx(0.5, abs=0.05)


def test_on_the_faster_surface_it_stays_behind(passages):
    passage = passages["faster"]
    change, centre, contact = passage.at(1.25)
    assert crest(passage.X, change, contact & (passage.X < centre - 0.3))[0] > 0.1
    assert np.abs(change[contact & (passage.X > centre + 0.4)]).max() < 0.02


def test_example_draws_both_passages(tmp_path, capsys):
    """The oil that ran ahead is told and drawn; M and L are those of the rolling dimple in `dimple.py`."""
    path = Path(__file__).parents[3] / "examples" / "studies" / "fine_features.py"
    spec = importlib.util.spec_from_file_location("fine_features", path)
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    assert example.BALL_ON_DISC.moes.M == pytest.approx(MOURIER.M, rel=1e-3)
    assert example.BALL_ON_DISC.moes.L == pytest.approx(MOURIER.L, rel=1e-3)
    runs = {name: example.roll(speed, start, 64) for name, (speed, start) in example.SPEEDS.items()}
    for name, run in runs.items():
        assert run.snapshot_T.size == len(example.PLACES)
        example.report_dent(name, *example.SPEEDS[name], run)
    ahead = [
        float(line.split("at most ")[1].split(" nm")[0]) for line in capsys.readouterr().out.splitlines()[1::2]
    ]
    assert ahead[1] > 1.2 * ahead[0]
    example.draw_dents(runs, tmp_path / "dents.png")
    assert (tmp_path / "dents.png").stat().st_size > 20_000


@pytest.mark.slow
@pytest.mark.literature
def test_film_ahead_of_the_sliding_dimple_of_mourier():
    """They compute a crest of 1.30 of the smooth 212 nm, and 1.36 in the dimple, 0.27 before the centre."""
    passage = Passage(passing(0.5, -1.375, 2.25, n=512), Dent(DEPTH, RADIUS, -1.375, speed=0.5))
    change, centre, contact = passage.at(2.2)
    assert centre == pytest.approx(-0.2755, abs=0.01)
    assert 1.0 + change[np.abs(passage.X - centre) < 0.2].max() == pytest.approx(1.36, rel=0.04)
    assert 1.0 + change[contact & (passage.X > centre + 0.3)].max() == pytest.approx(1.30, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("case", ["dent", "roughness"])
def test_steps_on_a_grid_of_a_thousand(case):
    """Every step converges within two cycles of the tolerance's, and one more as tight changes the film little."""
    point = MOURIER if case == "dent" else MoesPoint(200.0, 10.0, 1.0)
    film = solve_steady(point, grid=Grid(n=128, domain=NEAR)).h_central
    surfaces = {
        "dent": Dent(DEPTH, RADIUS, -0.9, speed=0.5),
        "roughness": Roughness.synthetic(
            0.1 * film, 0.5, 8.0 * 4.0 / 1024, length=4.0, width=2.0, seed=1, start=-0.3
        ),
    }
    mesh = 4.0 / 1024
    settings = {"n": 1024, "domain": NEAR, "until": 8 * mesh, "dt": mesh, "surface": surfaces[case]}
    runs = [simulate(point, steady_load(1.0), **grouped(tol=tol, **settings)) for tol in (3e-3, 1e-5)]
    assert all(run.status.ok for run in runs)
    assert runs[0].cycles[1:].max() <= 3
    inside = np.abs(runs[0].X) < 0.9
    gap = np.abs(runs[0].h_midplane[-1] - runs[1].h_midplane[-1])[inside].max()
    assert gap < 2e-3 * film
