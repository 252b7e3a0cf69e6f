"""Surface features over time: dents, ridges, waves, and the film over them."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from argument_groups import grouped
from programs import script

from ehlcontact import (
    ConvergenceError,
    Dent,
    Domain,
    Geometry,
    Grid,
    HarmonicLoad,
    InputError,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    PrescribedLoad,
    Roughness,
    TimeSteps,
    TransientContact,
    TransverseRidge,
    Waviness,
    simulate,
    solve_steady,
)
from ehlcontact.transient.features import surface_height, surface_step

X, Y = np.linspace(-2.0, 1.0, 31), np.linspace(0.0, 1.0, 5)
SI = OperatingPoint(Geometry(3e-3, 60e-3), Lubricant(0.05, 2e-8), 200.0, 5.0)


def test_dent_and_its_rim():
    dent = Dent(2.0, 0.3, -1.0, kappa=0.5, speed=1.0)
    assert dent(np.array(-0.5), np.array(0.0), 0.5) == pytest.approx(2.0)
    # physical metric: y = Y b = Y a/kappa
    assert dent(np.array(-1.0), np.array(0.05), 0.0) == pytest.approx(dent(np.array(-0.9), np.array(0.0), 0.0))
    r = np.linspace(0.0, 0.6, 601)
    height = dent(r - 1.0, 0.0 * r, 0.0)
    assert height[r > 0.3001].max() < 0.0  # a rim stands out beyond the radius
    assert height.min() == pytest.approx(-0.0173 * 2.0, abs=2e-4) and r[height.argmin()] == pytest.approx(
        0.36, abs=2e-3
    )


@pytest.mark.parametrize(
    ("make", "same"),
    [
        (lambda at: Dent.at(SI, 1e-7, 5e-5, **at), lambda s: Dent(1e-7 / s.length, 5e-5 / s.a, kappa=s.a / s.b)),
        (
            lambda at: TransverseRidge.at(SI, 2e-7, 8e-5, **at),
            lambda s: TransverseRidge(2e-7 / s.length, 8e-5 / s.a),
        ),
        (lambda at: Waviness.at(SI, 1e-8, 9e-5, **at), lambda s: Waviness(1e-8 / s.length, 9e-5 / s.a)),
    ],
    ids=["dent", "ridge", "waviness"],
)
def test_features_in_metres_belong_to_a_point(make, same):
    made, plain = make({"speed": 0.6}), replace(same(SI.scales), speed=0.6)
    assert (made, repr(made), made.made_at, plain.made_at) == (plain, repr(plain), SI, None)
    assert make({"start": -3.0 * SI.scales.a}).start == pytest.approx(-3.0, rel=1e-14, abs=0.0)
    for point in (replace(SI, load=150.0), replace(SI, load=150.0).moes):
        with pytest.raises(InputError, match=rf"^surface = 'made at another .*{type(made).__name__}\.at\(point"):
            simulate(point, HarmonicLoad(Omega=3.0), surface=made)
        with pytest.raises(InputError, match=r"^surface = 'made at another"):
            TransientContact(point, surface=made)
    for point in (SI, replace(SI), SI.moes):
        made.require_point("surface", point)
    with pytest.raises(InputError, match=rf"^point = 'MoesPoint.*takes {type(made).__name__}\("):
        type(made).at(SI.moes, 1e-7, 1e-4)
    for wrong in ((1e-7, -1e-4), (float("nan"), 1e-4)):
        with pytest.raises(InputError, match=r"^(depth|radius|height|width|amplitude|wavelength) = .*must be"):
            type(made).at(SI, *wrong)


@pytest.mark.parametrize(
    ("feature", "slip"),
    [
        (Dent(1.0, 0.4, -1.0, speed=1.0), 0.0),
        (Dent(1.0, 0.4, -1.0, speed=0.6), 0.4),
        (TransverseRidge(0.3, 0.8, -1.0, speed=1.5), -0.5),
        (Waviness(0.2, 0.7, 0.5, speed=1.0), 0.0),
    ],
)
def test_course_over_a_step(feature, slip):
    """Heights at both ends and before; film that moves at 1 sees the slope times the slip."""
    step = surface_step(feature, X, Y, 0.5, 0.1, 0.15)
    for height, T in ((step.height, 0.5), (step.at_start, 0.4), (step.at_previous_start, 0.25)):
        np.testing.assert_allclose(height, surface_height(feature, X, Y, T), atol=1e-14)
    ahead, behind = (surface_height(feature, X + d, Y, 0.5) for d in (1e-5, -1e-5))
    np.testing.assert_allclose(step.rate, slip * (ahead - behind) / 2e-5, atol=1e-5)


def test_rest_before_the_start():
    """Features rest for T <= 0, so the first step knows no earlier course."""
    dent = Dent(1.0, 0.4, -1.0)
    step = surface_step(dent, X, Y, 0.1, 0.1, 0.0)
    np.testing.assert_array_equal(step.at_start, surface_height(dent, X, Y, 0.0))
    np.testing.assert_array_equal(step.at_previous_start, step.at_start)
    assert surface_step(None, X, Y, 0.1, 0.1, 0.0) is None


def test_surface_that_cannot_be_used():
    with pytest.raises(InputError, match="returning shape"):
        surface_height(lambda X, Y, T: np.zeros(7), X, Y, 0.0)
    with pytest.raises(InputError, match="finite everywhere"):
        surface_height(lambda X, Y, T: np.nan * (X + Y), X, Y, 0.0)


def carry(depth, part):
    """Simulation of a dent that moves into the centre, in steps of `part` of a mesh size."""
    mesh = 6.0 / 64
    start = -20 * mesh
    return simulate(
        MoesPoint(58.07, 4.62, 1.0),
        PrescribedLoad(np.linspace(0.0, -start, 4), np.ones(4)),
        grid=Grid(n=64),
        time=TimeSteps(until=-start, dt=part * mesh),
        surface=Dent(depth, 0.3, start),
    )


@pytest.mark.parametrize(("depth", "largest"), [(0.1, 0.01), (1.0, 0.04)], ids=["as the film", "of ten films"])
def test_film_round_a_carried_dent(depth, largest):
    """The pocket arrives nearly as deep as made, its rim stays open, and halved steps hardly change the film.

    Plain differences of so steep a gap leave a source at the rim: halved steps then change the film by 2.4 % and
    18 % rms of the central film, and deeper dents eat it up.
    """
    run, finer = carry(depth, 1.0), carry(depth, 0.5)
    central = run.h_central[0]
    contact = np.abs(run.x) < 0.9
    outside = contact & (np.abs(run.x) > 0.36)
    for each in (run, finer):
        film = each.h_midplane[-1]
        assert 0.75 * depth < film[contact].max() - central < depth  # the bodies bulge a little into it
        assert run.x[contact][film[contact].argmax()] == pytest.approx(0.0, abs=1e-9)
        assert film[outside].min() > 0.3 * central
    change = (run.h_midplane[-1] - finer.h_midplane[-1])[outside]
    assert np.sqrt(np.mean(change**2)) < largest * central


def test_surface_must_be_even_in_y():
    with pytest.raises(InputError, match=r"^surface = .*even in Y"):
        simulate(
            MoesPoint(200, 10, 0.5),
            HarmonicLoad(Omega=3.0),
            grid=Grid(n=16),
            time=TimeSteps(until=0.1),
            surface=lambda X, Y, T: 0.01 * Y + 0.0 * X,
        )


@pytest.mark.parametrize(
    ("wavelength", "refused"), [(0.8, False), (0.4, True), (0.2, True), (0.1, True), (0.0942, True)]
)
def test_waviness_shorter_than_the_mesh_is_refused(wavelength, refused):
    """The mesh is 0.1875: 0.8 is four nodes to a wave, 0.4 two."""
    grid, wave = np.linspace(-4.5, 1.5, 33), Waviness(0.01, wavelength, start=0.0)
    if refused:
        with pytest.raises(InputError, match=r"^surface = .*between nodes.*mesh is 0\.188 along X: raise n"):
            surface_step(wave, grid, Y, 0.5, 0.1, 0.1)
    else:
        surface_step(wave, grid, Y, 0.5, 0.1, 0.1)


def test_dent_that_leaves_the_grid_is_resolved():
    """Its tail alone looks rough there; and a ridge narrower than the mesh does not hide on a node."""
    grid = np.linspace(-4.5, 1.5, 65)
    for T in np.arange(0.0, 12.0, 0.02):
        surface_step(Dent(0.03, 0.6, kappa=0.5), grid, Y, T, 0.02, 0.02)
    with pytest.raises(InputError, match="between nodes"):
        surface_step(TransverseRidge(0.01, 0.05, start=grid[40]), grid, Y, 0.0, 0.1, 0.1)


def test_step_of_a_surface_is_not_taken_for_a_short_wave():
    step = surface_step(lambda X, Y, T: 0.01 * (X > 0.23) + 0.0 * Y, X, Y, 0.5, 0.1, 0.1)
    assert step is not None
    np.testing.assert_array_equal(step.height, np.broadcast_to(0.01 * (X > 0.23), (Y.size, X.size)))


def test_surface_that_closes_the_gap_is_named():
    ridge = TransverseRidge(3.0, 0.4, start=0.0)
    with pytest.raises(ConvergenceError, match="surface stands out by 3"):
        simulate(
            MoesPoint(200, 10, 0.5),
            HarmonicLoad(Omega=3.0),
            grid=Grid(n=32),
            time=TimeSteps(until=0.1),
            surface=ridge,
        )


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
        self.X, self.surface = run.x, surface
        self.change = (run.h_midplane - run.h_midplane[0]) / run.h_central[0]
        self.T = run.t

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


@pytest.mark.long
def test_example_draws_both_passages(tmp_path, capsys):
    """The oil that ran ahead is told and drawn; M and L are those of the rolling dimple in `dimple.py`."""
    example = script("examples/studies/fine_features.py")
    assert example.BALL_ON_DISC.moes.M == pytest.approx(MOURIER.M, rel=1e-3)
    assert example.BALL_ON_DISC.moes.L == pytest.approx(MOURIER.L, rel=1e-3)
    runs = {name: example.roll(speed, start, 64) for name, (speed, start) in example.SPEEDS.items()}
    for name, run in runs.items():
        assert run.snapshot_t.size == len(example.PLACES)
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
    inside = np.abs(runs[0].x) < 0.9
    gap = np.abs(runs[0].h_midplane[-1] - runs[1].h_midplane[-1])[inside].max()
    assert gap < 2e-3 * film


@pytest.fixture(scope="module")
def dimple():
    return script("examples/studies/dimple.py")


def test_published_curves(dimple):
    for kind in ("simulation", "experiment"):
        curves = dimple.published(kind)
        assert len(curves) == 5 and all(x.size == gap.size > 15 for x, gap in curves)
        centres = [dimple.dimple_centre(curve) for curve in curves]
        assert centres[0] < -dimple.POINT.scales.a * 1e6  # not in the contact yet
        assert all(earlier < later for earlier, later in pairwise(centres))


def test_operating_point(dimple):
    """As Mourier et al. give it: Hertz radius 136.5 um at 15 N, M = 63.8, L = 5.79."""
    assert dimple.POINT.scales.a == pytest.approx(136.5e-6, rel=3e-3)
    assert dimple.POINT.moes.M == pytest.approx(63.8, rel=1e-3)
    assert dimple.POINT.moes.L == pytest.approx(5.79, rel=1e-3)


@pytest.mark.slow
def test_smooth_film(dimple):
    """212 nm in the centre and 119 nm at the least, within 1 %."""
    steady = solve_steady(dimple.POINT, grid=Grid(n=256))
    assert steady.h_central * 1e9 == pytest.approx(212.0, rel=0.01)
    assert steady.h_min * 1e9 == pytest.approx(119.0, rel=0.01)


@pytest.mark.slow
def test_gaps_they_computed(dimple, capsys):
    """Outside the dimple within 6 % of the central film, rms, everywhere and within the Hertz circle."""
    theirs = dimple.published("simulation")
    run = dimple.roll(dimple.dent(dimple.SHALLOW), [dimple.dimple_centre(curve) for curve in theirs])
    ours = dimple.gaps(run)
    everywhere, within = dimple.report("", ours, theirs, 212.0)
    assert everywhere < 0.06
    assert within < 0.06
    # and the dimple is as high, wide and placed as theirs, whose plots end at about 355 nm
    for mine, his in zip(ours[1:], theirs[1:], strict=True):
        assert dimple.dimple_centre(mine) == pytest.approx(dimple.dimple_centre(his), abs=3.0)
        inside = np.abs(mine[0] - dimple.dimple_centre(mine)) < 15.0
        assert 340.0 < mine[1][inside].max() < 400.0


@pytest.mark.slow
def test_gaps_they_measured(dimple, capsys):
    """The dimple thirty films deep gets through; without the rim of the formula it is nearer to the measured."""
    theirs = dimple.published("experiment")
    centres = [dimple.dimple_centre(curve) for curve in theirs]
    differences, least = [], []
    for surface in (dimple.dent(dimple.DEEP), dimple.without_rim(dimple.dent(dimple.DEEP))):
        run = dimple.roll(surface, centres)
        assert run.status.ok
        differences.append(dimple.report("", dimple.gaps(run), theirs, 212.0)[0])
        least.append(run.h_min.min() * dimple.POINT.scales.length * 1e9)
    assert differences[0] < 0.15 and differences[1] < 0.1
    assert 20.0 < least[0] < 0.8 * least[1]


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"depth": 0.2, "radius": 3e-5}, r"depth = 0\.2.*in µm"),
        ({"depth": 2e-7, "radius": 30.0}, r"radius = 30\.0.*in µm"),
        ({"depth": 2e-7, "radius": 3e-5, "start": -10.0}, r"start = -10\.0.*in µm"),
    ],
)
def test_micrometres_are_told_from_metres(given, words):
    with pytest.raises(InputError, match=words):
        Dent.at(SI, **given)
