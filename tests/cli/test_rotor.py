"""The rotor of a study: its numbers computed a second time from the stored runs, sentences of the headline."""

import html
import shutil
from dataclasses import replace
from math import pi
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import curve_fit
from tiny_study import SMALL

from ehlcontact import read
from ehlcontact.cli.study import headline
from ehlcontact.cli.study.differences import compare_rotors
from ehlcontact.cli.study.points.finalise import evaluate
from ehlcontact.cli.study.reduction import CONTACTS, LOOKS
from ehlcontact.cli.study.rotor import film_response, frequencies
from ehlcontact.cli.study.schema import load_study
from ehlcontact.errors import ConvergenceError
from ehlcontact.summary import WIDTH
from reduced_models.rotor import model_pictures as pictures
from reduced_models.rotor.events import ContactEvents
from reduced_models.rotor.result import RotorResult
from reduced_models.rotor.settling import Settling


@pytest.fixture(scope="module")
def found(finished, tmp_path_factory):
    """What was found, put together again from the stages; in a copy, as it writes runs on whole bearings."""
    folder = shutil.copytree(finished[1], tmp_path_factory.mktemp("found") / "out")
    return evaluate(load_study(finished[0]), folder, {})


def stored(folder, name):
    run = read(folder / f"{name}.h5", RotorResult)
    return {key: getattr(run, key) for key in ("t", "journal", "force", "disc")}


def test_all_contacts_are_compared(results):
    rotor = results["rotor"]
    names = ["rotor_band", "memory", "harmonic", "undamped", "dry"]
    assert list(rotor["settled"]) == names and list(rotor["whole"]) == names
    for part in ("settling", "events"):
        assert list(rotor[part]) == ["full", *names], part
    assert list(rotor["decay"]["decrements"]) == ["full", *names] == list(rotor["modes"])
    assert list(rotor["resonance"]["y"]) == ["full", *names]


def test_decrements_by_another_fit(finished, results):
    """scipy's curve_fit of the stored heights."""
    run, told = stored(finished[1], "decay"), results["rotor"]["decay"]["decrements"]["full"]
    period = 1.0 / told["hz"]
    fitted = run["t"] >= run["t"][-1] - told["periods"] * period - 1e-12
    t, y = run["t"][fitted], 1e9 * run["journal"][fitted, 1]

    def decaying(t, mean, size, delta, omega, phase):
        return mean + size * np.exp(-delta * omega * t / (2 * pi)) * np.cos(omega * t + phase)

    start = (y.mean(), np.ptp(y) / 2, 0.02, 2 * pi / period, -pi / 2)
    best, _ = curve_fit(decaying, t - t[0], y, start)
    assert told["decrement"] == pytest.approx(best[2], rel=1e-4)
    assert told["hz"] == pytest.approx(best[3] / (2 * pi), rel=1e-6)
    low, high = told["interval"]
    assert low < best[2] < high < 2.0 * best[2]


def test_decrements_and_the_linear_rotor_agree(results):
    """The film decides this decay: a tenth of it is left without damper, and the linear rotors say the same."""
    rotor = results["rotor"]
    told = rotor["decay"]["decrements"]
    for name, fitted in told.items():
        mode = min(rotor["modes"][name], key=lambda m: abs(m["hz"] - fitted["hz"]))
        assert mode["vertical_share"] == 1.0
        assert fitted["hz"] == pytest.approx(mode["hz"], rel=0.02), name
        assert fitted["decrement"] == pytest.approx(mode["decrement"], rel=0.1, abs=1e-3), name
    for name in ("undamped", "dry"):
        off = told[name]["decrement"] / told["full"]["decrement"] - 1.0
        assert rotor["decay"]["off_full"][name] == pytest.approx(off) and off < -0.2
    assert rotor["decay"]["film_decides"] is True
    assert abs(rotor["decay"]["off_full"]["rotor_band"]) < 0.1
    half = rotor["decay"]["half_step"]["full"]["decrement"]
    assert half == pytest.approx(told["full"]["decrement"], rel=0.05) and half != told["full"]["decrement"]


def test_resonance_follows_from_the_decrement(results):
    """Of one lightly damped mode: the highest point falls as its decrement rises."""
    rotor = results["rotor"]
    peaks = {name: peak["amplitude"] for name, peak in rotor["resonance"]["y"].items()}
    slowest = {name: min(modes, key=lambda m: m["hz"])["decrement"] for name, modes in rotor["modes"].items()}
    for name in ("undamped", "dry", "harmonic"):
        assert peaks[name] * slowest[name] == pytest.approx(peaks["full"] * slowest["full"], rel=0.1)


def test_settled_from_the_stored_run(finished, results):
    run, steps = stored(finished[1], "rotor_full"), 20
    told = results["rotor"]["settling"]["full"]
    assert run["t"].size == 2 * steps + 1 and len(told["changes"]) == 1
    changes = []
    for values in (run["disc"][:, 1], run["journal"][:, 1], run["force"][:, 0]):
        before, now = values[1 : steps + 1], values[steps + 1 :]
        changes.append(np.sqrt(np.mean((now - before) ** 2)) / np.std(now))
    assert told["changes"][0] == pytest.approx(max(changes)) and told["settled"] == (max(changes) <= 0.01)
    assert results["spectrum_resolution"] == pytest.approx(50.0 / 2.0)


def test_differences_from_the_stored_run(finished, results, found):
    """Over the standard deviation of the full signal, the largest of each kind; the step check covers the run."""
    full = stored(finished[1], "rotor_full")
    dry = found.rotors.unbalance.reduced["dry"]
    told = results["rotor"]["whole"]["dry"]
    error = dry.force[:, 0] - full["force"][:, 0]
    assert told["force"] == pytest.approx(np.sqrt(np.mean(error**2)) / np.std(full["force"][:, 0]))
    assert told["force_vibration"] == pytest.approx(np.std(error) / np.std(full["force"][:, 0]))
    for name in ("disc", "journal"):
        share = np.std(getattr(dry, name)[:, 1] - full[name][:, 1]) / np.std(full[name][:, 1])
        assert share <= told["displacement_vibration"] * (1 + 1e-9)
    assert told["signals"]["journal_y"]["vibration_over_std"] == pytest.approx(share)

    half = stored(finished[1], "rotor_half_step")
    assert half["t"][-1] == pytest.approx(full["t"][-1])
    change = half["force"][::2, 0] - full["force"][:, 0]
    step = results["rotor"]["step_full"]
    assert step["t_end"] == pytest.approx(0.04) and step["t_start"] == 0.0
    assert step["force"] == pytest.approx(np.sqrt(np.mean(change**2)) / np.std(full["force"][:, 0]))


def test_the_step_check_is_of_the_signal_that_changes_most(finished, found):
    full, half = (stored(finished[1], name) for name in ("rotor_full", "rotor_half_step"))
    signals = ((run["disc"][:, 1], run["journal"][:, 1], run["force"][:, 0]) for run in (full, half))
    changes = [np.sqrt(np.mean((b[::2] - a) ** 2)) / np.std(a) for a, b in zip(*signals, strict=True)]
    assert found.rotors.unbalance.step_share == pytest.approx(max(changes)) and min(changes) < 0.9 * max(changes)


def test_loads_from_the_stored_runs(finished, results):
    for name, file in (("events", "rotor_full"), ("decay", "decay")):
        events = results["rotor"][name] if name == "events" else results["rotor"]["decay"]["events"]
        force = stored(finished[1], file)["force"][:, 0]
        (contact,) = events["full"]
        assert contact["load_range"] == [force.min(), force.max()] and contact["lift_offs"] == 0


def test_damper_of_the_headline_is_the_impedances(finished, results):
    """Solved once more at that frequency alone; beside it the fit with the interval of its own file."""
    study = load_study(finished[0])
    scales = study.point.scales
    omega = 50.0 * 2.0 * pi
    response = film_response(study)
    at = int(np.argmin(np.abs(response.omega - omega)))
    assert response.omega[at] == pytest.approx(omega)
    assert min(frequencies(study)[1:]) == pytest.approx(0.5 * omega * scales.time)
    told = results["at_rotor_speed"]
    assert told["damping"] == pytest.approx(response.damping[at], rel=1e-6)
    assert told["stiffness"] == pytest.approx(response.stiffness[at], rel=1e-6)

    si = read(finished[1] / "elements" / "rotor_band_cubic.json")
    fit = next(row for row in results["fits"] if row["record"] == "rotor_band" and row["model"] == "cubic")
    assert results["damper_of_fit"]["damping"] == si.C1
    assert results["damper_of_fit"]["interval"] == fit["intervals"]["C1"]


def test_numbers_of_the_sentences(finished, results):
    """The numbers of the page's paragraphs are those of the results."""
    answer, decay = html.unescape((finished[1] / "report.html").read_text()), results["rotor"]["decay"]
    for name in ("full", "rotor_band", "undamped", "dry"):
        assert f"{decay['decrements'][name]['decrement']:.3g}" in answer
    assert f"damper of {results['at_rotor_speed']['damping']:.3g} N s/m" in answer
    low, high = results["damper_of_fit"]["interval"]
    sure = f"95 %: {low:.3g} to {high:.3g}" if low > 0.0 else "not determined by the fit"
    assert f"N s/m ({sure})" in answer
    assert "The film decides it" in answer and "Not settled" not in answer and "loses contact" not in answer


def test_a_damper_that_the_fit_does_not_determine_says_so():
    told = SimpleNamespace(
        at_rotor_speed={"stiffness": 1e8, "damping": 60.0},
        damper_of_fit={"damping": 53.8, "interval": [-17.5, 125.0]},
        study=SimpleNamespace(rotor_hz=50.0),
    )
    assert headline.damper(told).endswith("53.8 N s/m (not determined by the fit).")
    told.damper_of_fit["interval"] = [17.5, 90.0]
    assert headline.damper(told).endswith("53.8 N s/m (95 %: 17.5 to 90).")


def test_warnings_are_shown(finished, results):
    """The cubic of the rotor's band is kicked outside its frequency: told in headline, results and page."""
    page = html.unescape((finished[1] / "report.html").read_text())
    told = results["warnings"]
    assert any(line.startswith("kick, cubic of the rotor's band: SpringContact (cubic) used") for line in told)
    assert all(line in page for line in told)

    outside = results["rotor"]["decay"]["events"]["rotor_band"][0]["outside_omega"]
    assert outside == 1.0
    said = "after the kick the cubic of the rotor's band is outside its frequency for 100 % of the time"
    assert page.index('id="reduced"') < page.index(said)  # a note of that section, no alarm of the page


def test_a_run_ends_with_the_tiles(results):
    """Operating line, a line for every tile and what does not hold: no more than a screen."""
    first, *lines = results["answer"].splitlines()
    assert first == results["operating_line"]
    tiles = results["machine"]["tiles"]
    assert [line.split(" (")[0] for line in lines[: len(tiles)]] == [
        f"{tile['name']} {tile['value']} {tile['unit']}".rstrip() for tile in tiles
    ]
    assert max(len(line) for line in lines[: len(tiles)]) <= WIDTH
    rest = [line.split(":")[0] for line in lines[len(tiles) :]]
    assert set(rest) <= {"critical", "does not hold"}
    assert len(results["answer"].split()) < 190


def test_verdict_says_what_stands_for_the_film(results):
    """By the nearest element's decrement, and by that without the film."""
    decay = results["rotor"]["decay"]
    full = decay["decrements"]["full"]["decrement"]
    off = {name: abs(one["decrement"] / full - 1.0) for name, one in decay["decrements"].items()}
    best = min(("rotor_band", "memory"), key=lambda name: off[name])
    assert f"decrement is {100.0 * off[best]:.2g} % off" in results["verdict"]
    assert ("stands for the full film" in results["verdict"]) is (off[best] <= headline.STANDS_FOR)
    assert results["verdict"].endswith("the film decides the damping.")


def fake(**changes):
    """As much of the findings as a sentence looks at."""
    quiet = ContactEvents(0, 0, 0.0, (30.0, 40.0), 0.0, 0.0, 0.0, 0.0)
    events = {"full": (quiet,), "rotor_band": (quiet,)}
    settled = Settling((0.001,), 0.01)
    unbalance = {"events": events, "settling": {"full": settled}, "step_share": 0.001}
    decay = {"events": events, "step_share": 0.001}
    rotors = SimpleNamespace(
        unbalance=SimpleNamespace(**unbalance | changes.get("unbalance", {})),
        decay=SimpleNamespace(**decay | changes.get("decay", {})),
        failed=changes.get("failed", {}),
    )
    return SimpleNamespace(rotors=rotors)


def test_sentences_without_a_finding_are_empty():
    for sentence in (headline.unsettled, headline.step_check, headline.contact_events, headline.failures):
        assert sentence(fake()) == ""


def test_lift_off_is_in_the_headline():
    bounced = ContactEvents(3, 2, 0.18, (0.0, 90.0), None, None, None, None)
    told = headline.contact_events(fake(unbalance={"events": {"full": (bounced,)}}))
    assert (
        "under unbalance the full film loses contact" in told
        and "3 lift-offs, 2 impacts, 18 % of the time" in told
    )
    outside = replace(bounced, lost_share=0.0, outside_load=0.25)
    told = headline.contact_events(fake(decay={"events": {"rotor_band": (outside,)}}))
    assert told == "Note: after the kick the cubic of the rotor's band is outside its load for 25 % of the time."


def test_what_is_not_settled_is_in_the_headline():
    told = headline.unsettled(fake(unbalance={"settling": {"full": Settling((0.2, 0.07), 0.01)}}))
    assert told.startswith("Not settled") and "full film (7 %)" in told


def test_a_coarse_grid_is_in_the_headline(tmp_path):
    """A heavy load on the mesh of a light one converges, with a film far too thin."""
    text = SMALL
    (tmp_path / "heavy.toml").write_text(text.replace("radial_load = 70.0", "radial_load = 3000.0"))
    assert "radial_load = 70.0" in text
    told = headline.mesh_warnings(SimpleNamespace(study=load_study(tmp_path / "heavy.toml")))
    assert told.startswith("Less sure than it looks: contact.n = 64: a mesh of ") and "too coarse" in told
    (tmp_path / "light.toml").write_text(text)
    assert headline.mesh_warnings(SimpleNamespace(study=load_study(tmp_path / "light.toml"))) == ""


def test_a_long_step_is_in_the_headline():
    told = headline.step_check(fake(unbalance={"step_share": 0.08}))
    assert "run with unbalance by 8 %" in told and "decrement" not in told
    assert "the decrement by 3 %" in headline.step_check(fake(decay={"step_share": 0.03}))


def test_a_contact_that_the_rotor_does_not_run_on(finished, found, monkeypatch):
    """It is left out and told; the others are there, and the pictures too."""
    from ehlcontact.cli.study import differences

    real = differences.run_reduced

    def failing(study, element, halvings):
        if element.kind == "power":
            raise ConvergenceError("force imbalance 3 N", None)
        return real(study, element, halvings)

    monkeypatch.setattr(differences, "run_reduced", failing)
    elements = found.contact.reduction.rotor_elements
    rotors = compare_rotors(found.study, found.contact.reduction.impedance, elements, finished[1])
    assert rotors.failed == {"dry": "force imbalance 3 N"} and "dry" not in rotors.unbalance.reduced
    assert "dry Hertz contact (force imbalance 3 N)" in headline.failures(SimpleNamespace(rotors=rotors))
    assert rotors.decay.film_decides
    runs = {"full": rotors.unbalance.full, **rotors.unbalance.reduced}
    picture = pictures.settled_spectra(runs, rotors.unbalance.settling["full"], LOOKS, CONTACTS)
    assert all(line.y.max() > 0.0 for panel in picture.panels for line in panel.lines)


def test_pictures_show_what_is_settled(finished, found):
    """The heavy part of an orbit is the settled one, or the last revolution where there is none."""
    run = read(finished[1] / "rotor_full.h5", RotorResult)
    settled, is_settled = pictures.settled_part(run, Settling((0.001,), 0.01))
    assert is_settled and settled.t.size == 41
    last, is_settled = pictures.settled_part(run, Settling((0.5,), 0.01))
    assert not is_settled and last.t.size == 21 and last.t[-1] == run.t[-1]
    runs, drawn = {"full": run, "dry": run, "rotor_band": run}, ("full", "rotor_band")
    grey = pictures.time_response(runs, "full", drawn, Settling((0.5,), 0.01), LOOKS, CONTACTS)
    assert [band.text for panel in grey.panels for band in panel.bands] == ["not settled", "", "", ""]
    assert [len(panel.lines) for panel in grey.panels] == [2, 2, 2, 2]


def test_bode_picture_has_amplitude_and_phase(found):
    responses = found.rotors.resonances
    picture = pictures.bode(responses, LOOKS, CONTACTS)
    curve, phase = (line.y for panel in picture.panels for line in panel.lines if line.name == "full film")
    assert curve.max() == pytest.approx(responses.peaks["y"]["full"].amplitude)
    assert phase[0] == pytest.approx(0.0, abs=5.0) and phase[-1] == pytest.approx(-180.0, abs=5.0)


def test_the_impedance_reaches_down_to_the_rotor(finished, results):
    omega = results["memory"]["impedance"]["omega"]
    run = read(finished[1] / "rotor_band.h5")
    assert omega[0] == 0.0 and omega[1] <= 0.5 * run.omega * (1 + 1e-9) and any(np.isclose(omega, run.omega))
    assert run.motion.Omega == pytest.approx(results["operating_point"]["rotor_omega"])
