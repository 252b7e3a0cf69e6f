"""Every block of Python in README, pages and tutorials runs, without a warning; every command line is one."""

import importlib.util
import re
import shlex
import sys
import warnings
from dataclasses import replace
from pathlib import Path
from zipfile import ZipFile

import matplotlib
import numpy as np
import pytest
from page_blocks import PAGES, ROOT, blocks, cases, commands, run

from ehlcontact import HarmonicLoad, TimeSteps, impedance, simulate, solve_steady
from ehlcontact.cli import main
from ehlcontact.cli.study.forecast import cautions
from ehlcontact.cli.study.schema import load_study
from reduced_models import Atlas, BearingMount, ContactRecord, OutsideValidityWarning, Rotor, fit, simulate_rotor

START = "docs/guide/start.md"
LONG = ["docs/notes/oil_supply.md", "docs/signals.md", "docs/traction.md"]
TUTORIALS = {name for name in PAGES if "tutorials" in name}


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.fixture(autouse=True)
def no_window(monkeypatch):
    """Pictures are drawn, and shown to nobody."""
    import matplotlib.pyplot as plt

    matplotlib.use("Agg")
    monkeypatch.setattr(plt, "show", lambda: plt.close("all"))


def test_pages_are_found():
    assert "README.md" in PAGES and "docs/assumptions.md" in PAGES
    assert {name.split("/")[-1] for name in TUTORIALS} == {
        "film.md",
        "disc.md",
        "bearing.md",
        "rotor.md",
        "spindle.md",
        "jump.md",
        "motor_currents.md",
        "integrator.md",
        "fmu.md",
    }
    assert len(blocks("README.md")) == 1 and len(blocks(START)) >= 4
    first = blocks("docs/tutorials/film.md")[0]
    assert first.line == 13 and first.code.startswith("from ehlcontact import")
    assert [block.needs for block in blocks("docs/tutorials/bearing.md")].count("ross") == 1


@pytest.mark.parametrize("page", cases(sorted(set(PAGES) - TUTORIALS - {"README.md", START}), LONG))
@pytest.mark.long
def test_page(page):
    run(page, {})


@pytest.fixture(scope="module")
def contact(tmp_path_factory):
    """What the blocks of the page of the start leave: a ball contact, its film, elements and FMU."""
    found, folder = {}, tmp_path_factory.mktemp("start")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        run(START, found)
    return found | {"folder": folder}


def test_blocks_of_python_control(contact):
    memory, loop = contact["memory"], contact["loop"]
    assert (loop.input_labels, loop.output_labels, loop.nstates) == (["u", "v"], ["F"], memory.state_count)
    tangent = memory.spring_tangent(memory.approach_at(1.0))
    assert contact["static_stiffness"] == pytest.approx(tangent, rel=1e-9)


@pytest.mark.parametrize(("name", "frequency"), [("point", {"hz": 50}), ("moes", {"Omega": 0.05})])
def test_film_and_coefficients_of_both_contacts(contact, name, frequency):
    """Film, K and C of both contacts, in the units of their points, are those of the comments."""
    lines = next(block.code for block in blocks(START) if f"solve_steady({name})" in block.code)
    film, small = solve_steady(contact[name]), impedance(contact[name], **frequency)
    for field, value in (
        ("film.h_central", film.h_central),
        ("film.h_min", film.h_min),
        ("stiffness", small.stiffness[0]),
        ("damping", small.damping[0]),
    ):
        said = re.search(rf"# .*{re.escape(field)}(?:\[0\])? ([\d.e-]+)", lines)
        assert float(said[1]) == pytest.approx(float(value), rel=0.006)


def test_the_bearing_of_the_readme():
    """Film, lambda, torque, K and C are those of its comments."""
    found, (block,) = {}, blocks("README.md")
    run("README.md", found)
    state, K, C = found["state"], found["K"], found["C"]
    for name, value in (
        ("state.h_min.min()", state.h_min.min()),
        ("state.lambda_ratio.min()", state.lambda_ratio.min()),
        ("state.rolling_torque", state.rolling_torque),
        ("K[1, 1]", K[1, 1]),
        ("C[1, 1]", C[1, 1]),
    ):
        said = re.search(rf"# .*{re.escape(name)} ([\d.e-]+)", block.code)
        assert float(said[1]) == pytest.approx(float(value), rel=0.005), name
    assert Path("load_zone.png").stat().st_size > 1000


def test_the_readme_is_a_screen():
    assert (ROOT / "README.md").stat().st_size <= 8192


def test_from_a_contact_to_an_fmu(contact):
    """The damper is that of the film at the speed of the shaft; the FMU has band, speed and oil."""
    point, si, text = contact["point"], contact["si"], PAGES[START].read_text(encoding="utf-8")
    assert pytest.approx(Atlas().at(point).impedance(rpm=3000).damping, rel=1e-6) == si.C1
    assert si.is_valid(si.approach_at(486.0), rpm=3000) and not si.is_valid(si.approach_at(486.0), hz=25e3)
    assert si.design_point.u_sum == pytest.approx(point.u_sum)
    said = float(re.search(r"its damper: (\d+) N s/m", text)[1])
    assert said == pytest.approx(si.C1, abs=0.5)
    free = Atlas().element(point, "cubic", hz=1.5**0.5 * 2.56 / (2 * np.pi * point.scales.time))
    assert 5.0 < si.C1 / free.C1 < 7.0
    low, high = (w / (2.0 * np.pi) for w in si.omega_range)
    with ZipFile(contact["folder"] / "contact.fmu") as archive:
        described = archive.read("modelDescription.xml").decode()
        page = archive.read("documentation/index.html").decode()
    assert f'description="Damping coefficient, for motion of {low:.4g} to {high:.4g} Hz"' in described
    assert f"{low:.4g} to {high:.4g} Hz" in page and "437.4 to 534.6" in page
    assert f"u_sum: {point.u_sum:.6g}" in page and "eta0: 0.037" in page


@pytest.mark.slow
def test_the_film_has_the_damping_of_the_cubic(contact):
    """From the linearised film, and from a simulated record, on grids that a study is not warned of."""
    point, si = contact["point"], contact["si"]
    film = impedance(point, rpm=3000)
    assert pytest.approx(float(film.damping[0]), rel=0.03) == si.C1
    assert pytest.approx(float(film.stiffness[0]), rel=0.01) == si.spring_tangent(si.approach_at(486.0))
    motion = HarmonicLoad.at(point, rpm=3000, amplitude=0.1)
    record = simulate(point, motion, time=TimeSteps(periods=2, steps_per_period=40))
    fitted = fit(ContactRecord.from_result(record), model="cubic").element
    assert pytest.approx(float(film.damping[0]), rel=0.03) == fitted.C1
    study = load_study(ROOT / "examples" / "deep_groove_6205.toml")
    assert record.n == study.contact.n_transient and cautions(study) == []


@pytest.mark.filterwarnings("ignore::UserWarning")  # what ROSS brings says at import, where ROSS is
def test_an_error_tells_its_page_and_line():
    with pytest.raises((NameError, ImportError)) as failed:
        run("docs/tutorials/bearing.md", {}, have={"ross"}, only="ross")
    last = failed.traceback[-1]
    assert "bearing.md" in str(last.path)
    (block,) = (block for block in blocks("docs/tutorials/bearing.md") if block.needs)
    assert block.line <= last.lineno + 1 < block.line + block.code.count("\n")


@pytest.mark.long
def test_tutorial_of_the_ball_on_a_disc(capsys):
    """Ratios to measured films as its text says; films over viscosity and coefficient likewise."""
    found = {}
    run("docs/tutorials/disc.md", found)
    ratio = found["ratio"]
    assert np.median(ratio) == pytest.approx(0.975, abs=0.005)
    assert np.sum(np.abs(ratio - 1.0) < 0.07) == 8
    np.testing.assert_allclose(1.0 - 1.0 / ratio[:2], [0.15, 0.08], atol=0.006)
    assert np.median(found["formula"] / found["measured"]) == pytest.approx(1.011, abs=0.001)
    oil, usual = found["oil"], found["films"][4].h_central
    for change, more in (("eta0", 0.07), ("alpha", 0.06)):
        found["oil"] = replace(oil, **{change: 1.1 * getattr(oil, change)})
        assert found["film"](found["speed"][4]).h_central / usual - 1.0 == pytest.approx(more, abs=0.005)


@pytest.mark.long
def test_tutorial_of_the_film(capsys):
    """What its text says of the answers is so."""
    found = {}
    run("docs/tutorials/film.md", found)
    assert found["film"].status.ok
    middle = found["film"].h[:, 0]
    contact = np.abs(found["film"].x) < found["point"].scales.a
    assert found["film"].h_min < middle[contact].min() * 1.001 and found["C"][0] > 5.0 * found["C"][-1]
    assert abs(found["answer"].h_central - found["film"].h_central) < 2.0 * found["bar"]
    assert "isothermal" in capsys.readouterr().out


@pytest.mark.long
def test_tutorial_of_the_rotor():
    """Whirl and damping at its critical speeds, the peaks beside them, and the run-up, as its text says."""
    found = {}
    run("docs/tutorials/rotor.md", found)
    tilt, across, along = found["critical"]
    assert tilt.whirl < -0.99 and abs(across.whirl) < 0.02 and abs(along.whirl) < 0.02
    bare = found["films_only"].critical_speeds()[-2:]
    for one, without in zip((across, along), bare, strict=True):
        assert one.decrement / without.decrement == pytest.approx(12.0, abs=0.5)
        assert 1.02 < one.speed_rpm / without.speed_rpm < 1.05
        near = np.abs(found["at"] / one.speed_rpm - 1.0) < 0.02
        assert found["orbit"][near].max() == pytest.approx(5.5e-6, rel=0.05)
    seconds = 20 * 60.0 / along.speed_rpm
    assert seconds == pytest.approx(0.08, abs=0.005) and 2500.0 * seconds == pytest.approx(210.0, abs=5.0)
    amplitude, rpm = found["amplitude"], found["rpm"]
    assert across.speed_rpm < rpm[amplitude.argmax()] < along.speed_rpm and amplitude.max() < found["orbit"].max()
    # beyond the last one the amplitude goes up and down
    later = amplitude[rpm > along.speed_rpm]
    assert np.sum((np.diff(later)[:-1] > 0.0) & (np.diff(later)[1:] < 0.0)) > 2


@pytest.mark.slow
def test_tutorial_of_the_spindle(capsys):
    """Preload and its growth with the speed, the mode along the shaft, and the run-up, as its text says."""
    found = {}
    run("docs/tutorials/spindle.md", found)
    preload, forces = found["preload"], [state.axial_forces[0] for state in found["alone"]]
    assert preload == pytest.approx(443.0, abs=1.0) and 2.9 < found["lifts"] / preload < 3.2
    assert np.all(np.diff(forces) > 0.0) and forces[0] > preload
    stiff, soft = found["stiff"], found["soft"]
    assert stiff[1] == pytest.approx(stiff[0], rel=0.02) and soft[1] < 0.85 * soft[0]
    assert found["front"].h_min.min() < found["back"].h_min.min()
    backward, forward = found["diagram"].whirl[-1, :2]
    assert backward < -0.9 and forward > 0.9
    force, run_up = found["force"], found["run"]
    np.testing.assert_allclose(force[-1, 1] - force[-1, 0], 60.0, atol=1.0)
    last = run_up.node("disc")[-100:, 0]
    assert 0.5 * np.ptp(last) == pytest.approx(found["orbit"][-1], rel=0.05)


@pytest.mark.long
def test_tutorial_of_a_jump(capsys):
    """Folds, an unstable answer between two stable ones, runs that jump beyond the folds, what removes them."""
    found = {}
    run("docs/tutorials/jump.md", found)
    low, high = found["low"], found["high"]
    assert (low, high) == pytest.approx((9161.0, 9328.0), rel=1e-3)
    assert [one.stable for one in found["answers"]] == [True, False, True]
    assert high < found["jump"](*found["up"]) < 1.015 * high
    assert 0.985 * low < found["jump"](*found["down"]) < low
    folds = {name: one.fold_values for name, one in found["found"].items()}
    assert not folds["unbalance / 2"].size and not folds["dampers 9 mm long"].size
    preloaded = folds["bearings preloaded by 8 µm"]
    np.testing.assert_allclose(sorted(preloaded), (low, high), rtol=1e-2)


@pytest.mark.long
def test_tutorial_of_motor_currents(capsys):
    """Growth of films and fall of capacitances with the speed, loose balls, and films of a measurement."""
    found = {}
    run("docs/tutorials/motor_currents.md", found)
    for t in found["temperatures"]:
        films, pico = found["film"][t], found["pico"][t]
        assert 7.5 < films[-1] / films[0] < 8.6 and 0.2 < pico[-1] / pico[0] < 0.45
    assert np.ptp(found["pressed"].capacitance) < 0.01 * found["pressed"].capacitance.mean()
    assert np.ptp(found["loose"].capacitance) > 0.2 * found["loose"].capacitance.mean()
    measured = found["measured"]
    assert measured.low < measured.ratio < measured.high and 1.4 < measured.ratio < 1.7
    assert "V/µm at 300 rev/min" in capsys.readouterr().out


@pytest.mark.long
def test_tutorial_of_the_integrator(capsys):
    """Damping of every element in a loop, beside that of the impedance; the warning; the whole film."""
    found = {}
    run("docs/tutorials/integrator.md", found)
    film, decrement = found["film"], found["decrement"]
    small = film.impedance(hz=1000.0)
    exact = np.pi * float(small.damping[0]) / np.sqrt(found["mass"] * float(small.stiffness[0]))
    assert decrement(found["solved"].y[0]) == pytest.approx(exact, rel=0.003)
    assert decrement(found["moved"]) == pytest.approx(exact, rel=0.003)
    right = decrement(found["on"](found["right"]))
    with pytest.warns(OutsideValidityWarning):
        wrong = decrement(found["on"](found["wrong"]))
    assert right == pytest.approx(exact, rel=0.02) and 5.0 < right / wrong < 7.0
    (told,) = found["told"]
    assert "(fitted 12280 to 13770 Hz)" in str(told.message)
    assert found["off"] < 0.005
    # the library's own steps at rho_inf = 1 are those of average acceleration
    path, mount = found["path"], BearingMount(bearing=found["bearing"], x=0, y=1)
    rotor = Rotor(mass=5.0 * np.eye(2), stiffness=np.zeros((2, 2)), load=found["weight"], mounts=(mount,))
    begun = (found["low"], np.zeros(2))
    own = simulate_rotor(rotor, speed_rpm=3000, dt=found["dt"], until=found["t"][-1], start=begun, rho_inf=1.0)
    swing = np.ptp(path[:, 1])
    np.testing.assert_allclose(own.displacement[: path.shape[0]], path, rtol=0.0, atol=1e-5 * swing)


def test_tutorial_of_the_bearing():
    """Damping falls with the speed, stiffness is that of the steel; frequency matters as much."""
    found = {}
    run("docs/tutorials/bearing.md", found)
    assert np.all(np.diff(found["C"][:, 1, 1]) < 0.0)
    assert np.ptp(found["K"][:, 1, 1]) < 0.05 * found["K"][0, 1, 1]
    low, *_, high = found["shaken"].damping[:, 1, 1]
    assert low / high > found["C"][0, 1, 1] / found["C"][-1, 1, 1]


def test_tutorial_of_the_bearing_in_ross(capsys):
    """The lines that the site shows without running them."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pytest.importorskip("ross", reason="ROSS is not installed: pip install 'ehlcontact[ross]'")
        found = {}
        run("docs/tutorials/bearing.md", found, have={"ross"})
    omega = found["speeds"][5] * np.pi / 30.0
    np.testing.assert_allclose(found["held"][0].K(omega)[:2, :2], found["K"][5], rtol=1e-6, atol=1.0)
    assert 150.0 < found["modal"].wn[0] / (2.0 * np.pi) < 300.0
    assert np.all(found["modal"].log_dec[:2] > 0.0)


@pytest.mark.parametrize("master", ["ecospy", "libcosimpy"])
def test_a_system_archive_in_other_masters(master):
    """The lines of the page on coupling that load an archive, of the small study's rotor."""
    if importlib.util.find_spec(master) is None:
        pytest.skip(f"{master} is not installed: pip install 'ehlcontact[importers]'")
    if master == "ecospy" and not list((Path(sys.prefix) / "lib").glob("libtbb.so.12")):
        pytest.skip("no libtbb.so.12 beside ecospy: pip install tbb, in a virtual environment")
    with pytest.raises(SystemExit) as stop:
        main(["export", str(ROOT / "examples" / "small_study.toml"), "-o", "rotor.ssp"])
    assert not stop.value.code
    found = {}
    run("docs/coupling.md", found, have={master}, only=master)
    if master == "ecospy":
        assert -1e-5 < found["height"] < 0.0  # the journal has come some micrometres down into its contacts
    else:
        status = found["execution"].status()
        assert status.error_code == 0 and status.current_time > 1000 * 100  # ns, in its own step


@pytest.mark.long
def test_tutorial_of_the_fmu():
    """The FMU is its element, and the difference is that of the loop: it falls with the step."""
    shares = {}
    for step in ("2e-6", "1e-6"):
        found = {}
        run("docs/tutorials/fmu.md", found, put={"2e-6, 0.02": f"{step}, 0.005"})
        shares[step] = found["share"]
    assert shares["1e-6"] < 0.6 * shares["2e-6"] < 0.02


@pytest.mark.parametrize("page", sorted(PAGES))
def test_command_lines(page, capsys):
    """With --help behind it a line is read, option by option, and nothing is computed."""
    for line in commands(page):
        arguments = shlex.split(line)[1:]
        with pytest.raises(SystemExit) as stop:
            main([*arguments, "--help"])
        assert not stop.value.code, (line, capsys.readouterr().err)
        assert all((ROOT / word).exists() for word in arguments if word.startswith("examples/"))


def test_a_command_line_with_a_slip_is_seen(capsys):
    assert "ehlcontact reproduce --table 3" in commands(START)
    with pytest.raises(SystemExit) as stop:
        main(["steady", "--M", "200", "--kapa", "0.5", "--help"])
    assert stop.value.code == 2 and "kapa" in capsys.readouterr().err
