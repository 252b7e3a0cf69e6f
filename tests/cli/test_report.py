"""The report shows the numbers of `results.json`, and that holds the numbers of the stored films and histories."""

import json
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from page_numbers import blocks_of, is_shown, numbers_of, unknown_numbers
from tiny_study import STUDY

from ehlcontact import Lubricant, read, store
from ehlcontact.cli.study.forecast import DAMPING_OFF
from reduced_models import BallBearing, ContactRecord, fit
from reduced_models.rotor.result import RotorResult

# Two balls, another grid for the steady film, and a swing so wild that the run has not settled.
WILD = {
    "n = 32\nn_t": "n = 48\nn_t",
    'arrangement = "vertical"': 'arrangement = "vee"\nhalf_angle_deg = 20.0\nkick = 0.3',
    "stiffness = 5e7": "stiffness = 5e5",
    "damping = 10.0": "damping = 60.0",
    "unbalance = 8e-6": "unbalance = 4e-5",
}
# What a row of a table begins with, after the run it is of, and the key that its numbers stand under.
LABELS = {
    "full film": "full",
    "cubic of the rotor's band": "rotor_band",
    "film memory": "memory",
    "cubic of the contact's band": "harmonic",
    "cubic without damper": "undamped",
    "dry Hertz contact": "dry",
    "film memory under every ball": "memory",
    "dry Hertz contacts": "dry",
    "constant K and C, of the film at the speed": "constant",
    "constant K, dry, and C": "usual",
    "free vibration": "free",
    "harmonic, contact band": "harmonic",
    "harmonic, rotor band": "rotor_band",
}
RECORDS = ("free", "harmonic", "rotor_band")


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
def results(made):
    return json.loads((made[1] / "results.json").read_text())


@pytest.fixture(scope="module")
def films(made):
    """Stored results by the name of their stage."""
    return {name: read(made[1] / f"{name}.h5") for name in ("steady", *RECORDS)}


def derived(study, folder, results):
    """Numbers of the page that are quotients of numbers in the results."""
    point = results["operating_point"]
    peaks = list(results["rotor"]["resonance"].values())
    steps = [float(np.diff(load_times(folder / f"{name}.h5"))[0]) for name in ("rotor_full", "decay")]
    yield from (peak["amplitude"] / way["full"]["amplitude"] - 1.0 for way in peaks for peak in way.values())
    yield from (*steps, *(step / point["time_unit"] for step in steps))
    yield point["load"] * (point["time_unit"] / 2.56) ** 2 / point["dry_approach"]  # mass of the free vibration
    decay = results["rotor"]["decay"]
    yield abs(decay["half_step"]["full"]["decrement"] / decay["decrements"]["full"]["decrement"] - 1.0)
    modes = [one["hz"] for one in results["rotor"]["modes"]["full"] if one["vertical_share"] > 0.5]
    shaft = study["shaft"]
    yield from (2.0 * np.pi * hz * shaft["damping"] / shaft["stiffness"] for hz in modes)  # loss factor
    eccentricity = study["disc"][0]["unbalance"] / study["disc"][0]["mass"]
    yield from (eccentricity * peak["amplitude"] for way in peaks for peak in way.values())
    ways = results["in_time"]["resonance"].values()
    yield from (eccentricity * peak["amplitude"] for way in ways for peak in way.values())
    yield from (360.0 / 9.0 * k - 160.0 for k in range(9))  # degrees, places of the balls
    yield read(folder / "free.h5").mass
    yield from (1.25e-5, 1993.0)  # usual damper over stiffness, and the year of its source
    yield from numbers_of(DAMPING_OFF)  # what a coarse mesh does, in the warning of it


def load_times(path):
    import h5py

    with h5py.File(path) as file:
        return file["t"][:2]


def under(value, key, inside=False):
    """What stands under a key of a JSON value, or is of the record of that name."""
    if isinstance(value, dict):
        if inside or value.get("record") == key:
            yield value
        else:
            for name, entry in value.items():
                yield from under(entry, key, name == key)
    elif isinstance(value, list):
        if inside:
            yield value
        else:
            for entry in value:
                yield from under(entry, key)
    elif inside:
        yield value


def test_every_number_of_the_page_is_one_of_the_results(made, results):
    """Rows of a contact, a bearing or a record show numbers of that one."""
    study = tomllib.loads(made[0].read_text())
    more = [*derived(study, made[1], results)]
    everything = [*numbers_of(results), *numbers_of(study), *more]
    met, wrong = set(), []
    for block in blocks_of((made[1] / "report.html").read_text()):
        label = block.split(" | ")[0].removeprefix("unbalance: ").removeprefix("kick: ").split(" = ")[0]
        known = everything
        if " | " in block and label.removesuffix(" against full film") in LABELS:
            key = LABELS[label.removesuffix(" against full film")]
            met.add(key)
            known = [*numbers_of([*under(results, key)]), *more, 1.0, 2.0, 1.25e-5]
        wrong += [f"{text} in {block}" for text in unknown_numbers(block, known)]
    assert wrong == []
    assert met == set(LABELS.values())


def test_numbers_of_one_row_are_not_taken_for_those_of_another(results):
    """The check above sees a row with the numbers of another contact."""
    full, dry = (results["rotor"]["decay"]["decrements"][name] for name in ("full", "dry"))
    row = f"dry Hertz contact | {full['hz']:.5g} | {full['decrement']:.3g}"
    assert unknown_numbers(row, [*numbers_of(dry)]) and not unknown_numbers(row, [*numbers_of(full)])


@pytest.mark.parametrize(
    ("shown", "value", "same"),
    [
        *(("0.19", value, True) for value in (0.1897, 0.18951)),
        *(("10", 9.745, True), ("25", 24.99, True), ("1e+03", 1026.8, True), ("0", 0.0, True)),
        *(("-1.975", -1.97481, True), ("8.3e-05", 8.298e-05, True), ("150", 146.0, True)),
        *(("0.19", 0.1965, False), ("0.5", 0.52, False), ("8.3e-05", 8.464e-05, False), ("3", 0.0, False)),
        *(("48.7", 4.87, False), ("144", 145.0, False), ("1.975", -1.975, False), ("0", 0.3, False)),
    ],
)
def test_rounded_numbers_are_recognised(shown, value, same):
    assert is_shown(shown, value) is same


# ---- results.json against what the stages stored


def test_films_and_records(films, results):
    film, found, point = films["steady"], results["steady"], results["operating_point"]
    assert found["p_max"] == film.p.max() and found["cycles"] == film.residuals.size - 1
    assert found["h_min"] <= film.h.min() and film.h.min() < 1.02 * found["h_min"]
    before, last = film.pressure_changes[-2:]
    assert last * (last / before) <= found["pressure_error"] <= 1e-5 * point["p_hertz"]
    for name in ("approach", "h_central", "h_min"):
        unit = "" if name == "approach" else "_um"
        size = 1.0 if name == "approach" else 1e6
        assert point[name + unit] == pytest.approx(getattr(film, name) * size)
        of_film = "" if name == "approach" else "_relative"
        assert point[f"{name}_error"] == getattr(film.error_estimate, name + of_film)
    for name in RECORDS:
        row, run = results["simulations"][name], films[name]
        assert row["static_approach"] == run.static_approach and row["steps"] == run.t.size - 1
        assert row["force_range"] == [run.force.min(), run.force.max()]
        assert row["largest_load_residual"] == np.abs(run.load_residuals).max()


def test_fits(films, results):
    """Each row is the fit of its record, in SI."""
    for row in results["fits"]:
        if "refused" in row:
            continue
        again = fit(ContactRecord.from_result(films[row["record"]]), row["model"])
        for name in ("rms", "root", "tangent", "e_f"):
            assert row[name] == pytest.approx(getattr(again, name), rel=1e-9)
            assert again.element.units == "SI"
        assert row["parameters"] == pytest.approx(again.parameters)


def test_film_memory_and_work_of_a_cycle(made, films, results):
    """Errors of the element against impedance and records; loop areas of the last cycle in the rotor's band."""
    found, data = results["memory"], results["memory"]["impedance"]
    element = read(made[1] / "elements" / "memory.json")
    own = element.impedance(omega=data["omega"])
    assert found["stiffness_error_max"] == pytest.approx(
        np.abs(own.stiffness / data["stiffness"] - 1.0).max(), rel=1e-4
    )
    damping = own.damping[1:] / data["damping"][1:] - 1.0
    assert found["damping_error_max"] >= np.abs(damping).max() * (1.0 - 1e-4)
    films = {name: films[name] for name in RECORDS}
    forces = {name: element.drive(run.t, run.approach, run.rate) for name, run in films.items()}
    misses = [np.sqrt(np.mean((forces[n] - films[n].force) ** 2)) / films[n].force.std() for n in RECORDS]
    assert found["record_rms"] == pytest.approx(misses, rel=1e-6)

    run = films["rotor_band"]
    last = run.t >= run.t[-1] - 1.0 / run.hz * (1.0 + 1e-9)
    moved = {"full": run.force[last], "memory": forces["rotor_band"][last]}
    for name in set(results["cycle_work"]) - set(moved):
        cubic = read(made[1] / "elements" / f"{name}_cubic.json")
        moved[name] = cubic.force(run.approach[last], run.rate[last])
    for name, force in moved.items():
        work = float(0.5 * (force[1:] + force[:-1]) @ np.diff(run.approach[last]))
        assert results["cycle_work"][name] == pytest.approx(work, rel=1e-6, abs=0.0)


def test_whole_bearings(made, results):
    """Swings and lines of the stored runs' second half, loads and films at rest, ball passage."""
    found, study = results["in_time"], tomllib.loads(made[0].read_text())
    bearing, asked, rpm, weight = study["support"][0], study["in_time"], study["operation"]["speed_rpm"], 20.0
    hz = rpm / 60.0
    ratio = bearing["ball_diameter_mm"] / bearing["pitch_diameter_mm"]
    passage = 0.5 * bearing["balls"] * hz * (1.0 - ratio)
    assert found["ball_passage_hz"] == pytest.approx(passage, rel=1e-9) and found["failed"] == {}
    for name in ("memory", "dry"):
        run, row = store.read(made[1] / f"on_bearings_{name}.h5", RotorResult), found["runs"][name]
        first = asked["revolutions"] // 2 * asked["steps_per_revolution"]
        t, ring, disc = run.t[first:], run.ring[first:, 0], run.displacement[first:, 2:4]
        waves = np.exp(2j * np.pi * t[:, None] * np.array([hz, 2.0 * hz, passage, 2.0 * passage]))
        terms = np.hstack([np.ones((t.size, 1)), waves.real, waves.imag])
        parts = np.linalg.lstsq(terms, disc[:, 1], rcond=None)[0][1:]
        size = np.hypot(parts[:4], parts[4:])
        assert row["ring_peak_to_peak"] == pytest.approx(np.ptp(ring, axis=0), rel=1e-9)
        assert row["disc_peak_to_peak"] == pytest.approx(np.ptp(disc, axis=0), rel=1e-9)
        assert (row["at_speed"], row["at_ball_passage"]) == pytest.approx((size[0], size[2]), rel=1e-5)
        assert row["deflection"] == pytest.approx(-ring[:, 1].mean(), rel=1e-9)
        assert row["largest_load"] == run.largest_load.max()
    angles = np.radians([ball["degrees"] for ball in found["balls"]])
    carried = np.cos(angles) @ [ball["force"][0] for ball in found["balls"]]
    assert carried == pytest.approx(weight)

    sizes = {
        "ball_diameter": 1e-3 * bearing["ball_diameter_mm"],
        "pitch_diameter": 1e-3 * bearing["pitch_diameter_mm"],
    }
    grooves = dict.fromkeys(("conformity_inner", "conformity_outer"), bearing["conformity"])
    dry = BallBearing(balls=bearing["balls"], **sizes, **grooves, clearance=1e-6 * bearing["clearance"])
    wet = replace(dry, oil=Lubricant(study["oil"]["eta0"], study["oil"]["alpha"]))
    load, speed = (0.0, -weight), rpm
    state = wet.equilibrium(load, speed_rpm=speed)
    for name in ("force", "h_min"):
        np.testing.assert_allclose([ball[name] for ball in found["balls"]], getattr(state, name), rtol=1e-9)
    K, C = (
        getattr(wet.coefficients(load, speed_rpm=speed, rpm=speed), name)[0, 1, 1]
        for name in ("stiffness", "damping")
    )
    usual = dry.coefficients(load, speed_rpm=speed, rpm=speed).stiffness[0, 1, 1]
    for name, pair in {"constant": (K, C), "usual": (usual, 1.25e-5 * usual)}.items():
        assert tuple(found["constants"][name].values()) == pytest.approx(pair)
