"""Every number of a report and of its results, computed a second time from the study and the stored histories."""

import json

import numpy as np
import pytest
from report import contact_claims, rotor_claims, whole_claims
from report.contact import MODELS, RECORDS, Recomputed
from report.page import PageNumbers
from report.rotor import RecomputedRotor
from report.whole import RecomputedWhole
from tiny_study import STUDY

from ehlcontact.cli.study.forecast import cautions
from ehlcontact.cli.study.schema import load_study

# Two balls, another grid for the steady film, and a swing so wild that the run has not settled.
WILD = {
    "n = 32\nn_t": "n = 48\nn_t",
    'arrangement = "vertical"': 'arrangement = "vee"\nhalf_angle_deg = 20.0\nkick = 0.3',
    "shaft_stiffness = 5e7": "shaft_stiffness = 5e5",
    "shaft_damping = 10.0": "shaft_damping = 60.0",
    "unbalance = 8e-6": "unbalance = 4e-5",
}


@pytest.fixture(scope="module", params=["tiny", pytest.param("wild", marks=pytest.mark.slow)])
def made(request, tmp_path_factory):
    """A study file and the folder of its finished run."""
    from ehlcontact.cli import main

    if request.param == "tiny":
        return request.getfixturevalue("finished")
    root = tmp_path_factory.mktemp("report")
    text = STUDY
    for old, new in WILD.items():
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    (root / "study.toml").write_text(text)
    with pytest.raises(SystemExit) as stop:
        main(["run", str(root / "study.toml"), "-o", str(root / "out")])
    assert not stop.value.code
    return root / "study.toml", root / "out"


@pytest.fixture(scope="module")
def again(made):
    return Recomputed(*made)


@pytest.fixture(scope="module")
def rotor(made, results):
    return RecomputedRotor(*made, results)


@pytest.fixture(scope="module")
def whole(made):
    return RecomputedWhole(*made)


@pytest.fixture(scope="module")
def results(made):
    return json.loads((made[1] / "results.json").read_text())


@pytest.fixture(scope="module")
def refused(results):
    """Why a record and a model have no element, by both; the damper of such a fit is negative."""
    return {(row["record"], row["model"]): row["refused"] for row in results["fits"] if "refused" in row}


def test_operating_point_in_the_results(again, results):
    for name, value in results["operating_point"].items():
        assert value == pytest.approx(getattr(again.point, name), rel=1e-9), name


@pytest.mark.parametrize("record", RECORDS)
@pytest.mark.parametrize("model", MODELS)
def test_fits_in_the_results(again, results, refused, record, model):
    ours = again.fit(record, model)
    if (record, model) in refused:
        assert ours.parameters["C1"] < 0.0
        return
    (row,) = (row for row in results["fits"] if (row["record"], row["model"]) == (record, model))
    for name, value in ours.parameters.items():
        assert row["parameters"][name] == pytest.approx(value, rel=1e-6)
        assert row["si"][name] == pytest.approx(value * again.units.of[name], rel=1e-6)
        assert row["std_errors"][name] == pytest.approx(ours.errors[name], rel=1e-4)
        assert row["intervals"][name] == pytest.approx(ours.intervals[name], rel=1e-4)
    for name in ("rms", "root", "tangent"):
        assert row[name] == pytest.approx(getattr(ours, name), rel=1e-6)
    assert row["e_f"] == pytest.approx(ours.e_f, abs=1e-9)
    assert row["independent_samples"] == pytest.approx(ours.independent, rel=1e-4)
    valid = row["valid"]
    assert (valid["low"], valid["high"], valid["rate"]) == (ours.low, ours.high, ours.rate)
    assert tuple(valid["load"]) == ours.load


def test_work_of_a_cycle_in_the_results(again, results):
    assert results["cycle_work"] == pytest.approx(again.work, rel=1e-6)


def test_memory_in_the_results(again, results):
    found, data = results["memory"], results["memory"]["impedance"]
    K, C = again.memory_impedance(data["Omega"])
    assert found["stiffness_error_max"] == pytest.approx(np.abs(K / data["stiffness"] - 1.0).max(), rel=1e-4)
    assert found["damping_error_max"] == pytest.approx(np.abs(C / data["damping"] - 1.0).max(), rel=1e-4)
    assert found["record_rms"] == pytest.approx([again.memory_rms(name) for name in RECORDS], rel=1e-6)


def test_rotor_in_the_results(rotor, results):
    """Differences, settling, decays and events, to all their digits."""
    found, runs = results["rotor"], rotor.runs
    names = ("displacement", "displacement_vibration", "force", "force_vibration")
    for name in list(runs.turning)[1:]:
        whole = rotor.differences(runs.turning["full"], runs.turning[name])
        assert [found["whole"][name][key] for key in names] == pytest.approx(whole, rel=1e-6)
        assert found["settling"][name]["changes"] == pytest.approx(rotor.changes(name), rel=1e-6)
    for name, run in runs.decaying.items():
        ours, theirs = rotor.decrement(run), found["decay"]["decrements"][name]
        for key in ("decrement", "hz", "misfit", "periods"):
            assert theirs[key] == pytest.approx(getattr(ours, key), rel=1e-4)
        assert sum(rotor.interval(name)) == pytest.approx(2.0 * ours.decrement, rel=1e-4)
        modes = [mode["decrement"] for mode in found["modes"][name] if mode["vertical_share"] > 0.5]
        assert modes[0] == pytest.approx(rotor.mode(name).decrement, rel=1e-4)
    for part, kind in ((found, runs.turning), (found["decay"], runs.decaying)):
        for name, run in kind.items():
            for theirs, ours in zip(part["events"][name], rotor.events(name, run), strict=True):
                assert theirs["load_range"] == pytest.approx(ours[:2], rel=1e-9)
                assert [theirs[key] for key in ("lift_offs", "impacts", "lost_share")] == ours[2:5]


def test_whole_bearings_in_the_results(whole, results):
    """Runs, modes, films and critical speeds."""
    found = results["whole_bearing"]
    assert found["ball_passage_hz"] == pytest.approx(whole.passage, rel=1e-9)
    assert found["failed"] == {} and found["no_diagram"] is None
    speeds = [60.0 * whole.mode("memory", way)[0] for way in ("vertical", "horizontal")]
    met = sorted(speed for speed in speeds if 0.25 * whole.rpm < speed < 3.0 * whole.rpm)
    assert found["critical_speeds_rpm"] == pytest.approx(met, rel=0.05)  # films of those speeds are not these
    for name, theirs in found["runs"].items():
        ours = whole.row(name)
        for key, other in (("ring_swing", "ring"), ("disc_swing", "disc"), ("at_speed", "once")):
            assert theirs[key] == pytest.approx(ours[other], rel=1e-6)
        assert theirs["largest_load"] == ours["load"]
        if ours["passing"] is None:
            assert theirs["at_ball_passage"] is None and theirs["deflection"] is None
        else:
            assert theirs["at_ball_passage"] == pytest.approx(ours["passing"], rel=1e-5)
            assert theirs["deflection"] == pytest.approx(-whole.shown(name)[1][:, 1].mean(), rel=1e-9)
        for way in ("vertical", "horizontal"):
            hz, decrement = ours[way]
            assert theirs[way]["hz"] == pytest.approx(hz, rel=1e-6)
            assert theirs[way]["decrement"] == pytest.approx(decrement, rel=1e-4)
    for k, ball in enumerate(found["balls"]):
        assert ball["degrees"] == pytest.approx(k * 40.0)
        assert ball["force"] == pytest.approx(whole.state.force[k], rel=1e-9)
        assert ball["h_min"] == pytest.approx(whole.state.h_min[k], rel=1e-9)
    carried = sum(ball["force"][0] * np.cos(np.radians(ball["degrees"])) for ball in found["balls"])
    assert carried == pytest.approx(whole.study["bearing"]["radial_load"])
    for name, pair in found["constants"].items():
        assert (pair["stiffness"], pair["damping"]) == pytest.approx([c[1] for c in whole.constants[name]])


def test_films_and_records_in_the_results(again, results):
    film, found = again.steady, results["steady"]
    assert found["p_max"] == film.P.max() and found["cycles"] == film.residuals.size - 1
    assert found["h_min"] <= film.H.min() and film.H.min() < 1.02 * found["h_min"]
    assert found["residual"] == film.residuals[-1] / film.dry_residual
    before, last = film.pressure_changes[-2:]
    assert found["pressure_error"] <= 1e-5 and found["pressure_error"] >= last * (last / before)
    for name, run in again.records.items():
        row = results["simulations"][name]
        assert row["static_approach"] == run.static_approach and row["steps"] == run.T.size - 1
        assert row["force_range"] == [run.force.min(), run.force.max()]
        assert row["largest_load_residual"] == np.abs(run.load_residuals).max()


def test_every_number_of_the_page(made, again, rotor, whole, results, refused):
    """Whoever adds a number to the page says in one of the `claims` how it is computed."""
    page = PageNumbers((made[1] / "report.html").read_text())
    contact_claims.claim_operating_point(page, again)
    contact_claims.claim_assumptions(page, again, rotor, results)
    contact_claims.claim_captions(page, again, rotor)
    contact_claims.claim_fits(page, again, refused)
    contact_claims.claim_memory_and_work(page, again, results)
    contact_claims.claim_fmus(page, made[1])
    contact_claims.claim_origin(page, results)
    rotor_claims.claim_headline(page, rotor)
    whole_claims.claim_headline(page, whole)
    for told in cautions(load_study(made[1] / "study.toml")):  # `validate` has tests of its own
        page.claim(told)
    rotor_claims.claim_rotor(page, rotor)
    rotor_claims.claim_decay(page, rotor)
    rotor_claims.claim_unbalance(page, rotor)
    rotor_claims.claim_events(page, rotor)
    whole_claims.claim_table(page, whole, results)
    assert page.left == [], "\n".join(page.left)
