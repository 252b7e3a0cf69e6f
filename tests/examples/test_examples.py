"""The examples: short, importable without work, and what each of them shows is so."""

import ast
import re
import warnings
from functools import partial
from pathlib import Path

import atlas_stub
import numpy as np
import pytest
from programs import script

from reduced_models import OutsideValidityWarning
from reduced_models.atlas.build import build
from reduced_models.rotor.decay import log_decrement

FOLDER = Path(__file__).parents[2] / "examples"
SHORT = sorted(path.stem for path in FOLDER.glob("*.py"))
LONG = sorted(path.stem for path in (FOLDER / "studies").glob("*.py"))
MOST_ENTRIES, MOST_LINES = 20, 60  # of the folder; of code in a file
PNG = b"\x89PNG"


def example(name):
    """The module, imported anew; no picture of pyplot is left open by that."""
    return script(next(FOLDER.rglob(f"{name}.py")))


def documented(tree):
    """Lines of docstrings and imports."""
    kinds = (ast.Module, ast.FunctionDef, ast.ClassDef)
    nodes = [node for node in ast.walk(tree) if isinstance(node, ast.Import | ast.ImportFrom)]
    nodes += [node.body[0] for node in ast.walk(tree) if isinstance(node, kinds) and ast.get_docstring(node)]
    return {line for node in nodes for line in range(node.lineno, node.end_lineno + 1)}


def test_there_are_few():
    entries = [path for path in FOLDER.iterdir() if path.name != "__pycache__"]
    assert len(entries) <= MOST_ENTRIES
    wanted = {"paper", "five_lines", "ross_drop_in", "control_loop", "cosimulation", "full_against_reduced"}
    assert wanted | {"atlas_on_a_cluster", "run_up"} <= set(SHORT)


def test_they_are_short_and_say_what_one_learns():
    for name in SHORT:
        text = (FOLDER / f"{name}.py").read_text(encoding="utf-8")
        tree = ast.parse(text)
        said, left_out = ast.get_docstring(tree), documented(tree)
        lines = [k for k, line in enumerate(text.splitlines(), 1) if line.strip() and k not in left_out]
        assert len(lines) <= MOST_LINES, name
        assert "What one learns" in said.replace("\n", " "), name
        assert f"python examples/{name}.py [{name}.png]" in said


def test_nothing_is_done_at_import():
    """Only names are given at the top of a file; the work is in functions, and `main` calls them."""
    kinds = (ast.Import, ast.ImportFrom, ast.Assign, ast.AnnAssign, ast.FunctionDef, ast.ClassDef)
    for name in SHORT + LONG:
        tree = ast.parse(next(FOLDER.rglob(f"{name}.py")).read_text(encoding="utf-8"))
        others = [node for node in tree.body[1:] if not isinstance(node, kinds)]
        assert [ast.unparse(node.test) for node in others] == ["__name__ == '__main__'"], name
        functions = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
        assert "main" in functions and len(functions) > 1, name
        described = [node for node in tree.body if isinstance(node, ast.FunctionDef | ast.ClassDef)]
        assert all(ast.get_docstring(node) for node in described), name


@pytest.mark.parametrize("name", SHORT + LONG)
def test_it_has_a_test(name):
    """Picked up by itself: who adds an example is asked for what it shows."""
    tests = Path(__file__).parents[1]
    asked = [path.read_text(encoding="utf-8") for path in tests.rglob("test_*.py")]
    called = f'example("{name}")', f'{name}.py"'
    assert any(call in text for text in asked for call in called)


def test_every_one_has_its_row_and_picture():
    """In the table of the folder, which the gallery of the documentation shows; `docs/site/gallery.py` draws."""
    table = (FOLDER / "README.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| \[([\w./]+)\]\(\./([\w./]+)\) \|", table, flags=re.M)
    assert all(shown == target for shown, target in rows)
    scripts = {path.name for path in FOLDER.iterdir() if path.suffix in (".py", ".toml")}
    scripts |= {f"studies/{name}.py" for name in LONG}
    assert {target for _, target in rows} == scripts
    pictures = re.findall(r"!\[[^\]]+\]\(\.\./(docs/images/[\w./]+)\)", table)
    assert {f"docs/images/examples/{name}.png" for name in SHORT} <= set(pictures)
    assert all((FOLDER.parent / picture).read_bytes().startswith(PNG) for picture in pictures)


def drawn(module, path, *arguments):
    """Whether `main` leaves a picture where it is told to."""
    module.main(str(path), *arguments)
    return path.read_bytes().startswith(PNG)


def test_five_lines(tmp_path, capsys):
    """Stiffness is that of the steel, at any frequency; damping is the oil's, and fades."""
    five = example("five_lines")
    state, shaken = five.five_lines()
    np.testing.assert_allclose(np.cos(state.angles + np.pi / 2.0) @ state.force.min(axis=1), 1000.0, rtol=1e-3)
    K, C = shaken.stiffness[:, 1, 1], shaken.damping[:, 1, 1]
    assert np.ptp(K) < 0.1 * K[0] and C[0] > 5.0 * C[-1]
    assert 1.0 < state.lambda_ratio.min() < 5.0
    assert drawn(five, tmp_path / "five.png")
    told = capsys.readouterr().out
    assert f"{state.h_min.min() * 1e9:.0f} nm" in told and f"{state.loaded} balls" in told


@pytest.mark.long
def test_paper(tmp_path, capsys):
    """Table 3 of the paper: where its cubic carries the load it has our tangent, and our damper."""
    paper = example("paper")
    _, found = paper.vibration(64)
    theirs = paper.TABLE_3
    assert found.tangent == pytest.approx(paper.tangent(*list(theirs.values())[:3]), rel=0.015)
    ours = [found.parameters[name] for name in ("K1", "K2", "K3")]
    assert paper.tangent(*ours) == pytest.approx(found.tangent, rel=1e-6)
    assert found.parameters["C1"] == pytest.approx(theirs["C1"], rel=0.08)
    assert paper.film(64).damping[0] > 6.0 * found.parameters["C1"]
    assert drawn(paper, tmp_path / "paper.png", 32)
    assert re.search(r"paper: .*tangent 1\.53", capsys.readouterr().out)


@pytest.fixture(scope="module")
def against():
    return example("full_against_reduced")


@pytest.mark.long
def test_the_element_with_a_memory_loses_what_the_film_does(against):
    """The cubic of another band does not, and says so; the dry contact loses nothing."""
    with pytest.warns(OutsideValidityWarning, match="for the band it was made in"):
        short, long = against.reduced(3.0), against.reduced(8.0)
    full, memory = (against.decrement(run) for run in (against.full(3.0, 64), short["memory"]))
    cubic, dry = (against.decrement(long[name]) for name in ("cubic", "dry"))
    assert memory == pytest.approx(full, rel=0.06)
    assert cubic < 0.25 * full
    assert abs(dry) < 0.02 * full


@pytest.mark.slow
def test_the_rotor_on_four_contacts_and_its_picture(against, tmp_path, capsys):
    with pytest.warns(OutsideValidityWarning):
        assert drawn(against, tmp_path / "against.png")
    told = dict(re.findall(r"^(\w+), decrement ([\d.-]+)$", capsys.readouterr().out, flags=re.M))
    assert list(told) == ["film", "memory", "cubic", "dry"]
    assert float(told["memory"]) == pytest.approx(float(told["film"]), rel=0.04)


@pytest.mark.long
def test_cosimulation(tmp_path, capsys, monkeypatch):
    """The default lead keeps the damping, the better the finer the step; half a step less makes it grow."""
    mass = example("cosimulation")
    off = []
    for parts in (50, 100):
        omega, t, found = mass.runs(parts, 8.0)
        lost = [log_decrement(t, moved, omega=omega).decrement for moved in found.values()]
        assert lost[0] > 0.0 > lost[2]
        off.append(abs(lost[1] / lost[0] - 1.0))
    assert off[1] < 0.05 and off[1] < 0.5 * off[0]
    element = mass.contact()
    K = element.spring_tangent(element.approach_at(mass.LOAD))
    late = log_decrement(t, found["Python"], omega=omega).decrement - 0.5 * np.pi * K * t[1] / (mass.MASS * omega)
    assert lost[2] == pytest.approx(late, rel=0.1)  # stiffness times half the step, off the damping
    monkeypatch.setattr(mass, "runs", lambda parts: (omega, t, found))
    assert drawn(mass, tmp_path / "cosimulation.png")
    assert "lead 1: decrement -" in capsys.readouterr().out


def test_atlas_on_a_cluster(tmp_path, monkeypatch):
    """With a stand-in for the solver: what the cluster makes is what one process makes."""
    distributed = pytest.importorskip("distributed")
    in_threads = partial(distributed.LocalCluster, processes=False, protocol="tcp")
    monkeypatch.setattr(distributed, "LocalCluster", in_threads)  # or workers import all anew
    built = example("atlas_on_a_cluster")
    mine = built.build(tmp_path, solve=atlas_stub.solve)
    kept = len(list((tmp_path / "work").iterdir()))
    (tmp_path / "alone").mkdir()
    files = [tmp_path / "alone" / name for name in ("small.h5", "work")]
    build("film", *files, {"draws": built.DRAWS, "light_draws": built.LIGHT}, solve=atlas_stub.solve)
    assert files[0].read_bytes() == (tmp_path / "small.h5").read_bytes()
    assert kept > 20
    films = built.films(mine)
    for (h, bar), point in zip(films, built.POINTS, strict=True):
        assert h == pytest.approx(point.expected_film, abs=2.0 * bar)


@pytest.mark.slow
def test_a_small_atlas_of_solved_contacts(tmp_path, capsys):
    """Its error bars hold: the shipped one, which has hundreds of contacts, lies within."""
    pytest.importorskip("distributed")
    built = example("atlas_on_a_cluster")
    assert drawn(built, tmp_path / "cluster.png")
    rows = re.findall(r"([\d.]+) \+- ([\d.]+) +([\d.]+) \+- ([\d.]+)", capsys.readouterr().out)
    assert len(rows) == len(built.POINTS)
    for h, bar, theirs, narrow in np.array(rows, dtype=float):
        assert abs(h - theirs) < 2.0 * bar and narrow < bar


@pytest.mark.long
def test_a_run_up_and_a_coast_down_enclose_the_critical_speeds(tmp_path):
    up_and_down = example("run_up")
    line = up_and_down.rotor()
    crossings = up_and_down.critical_speeds(line)
    assert len(crossings) == 2 and np.ptp(crossings) < 0.02 * crossings[0]
    runs = up_and_down.runs(line, 1.0)
    rising, falling = (up_and_down.most(runs[way], crossings) for way in ("up", "down"))
    assert falling < min(crossings) and max(crossings) < rising
    assert 0.5 * (rising + falling) == pytest.approx(np.mean(crossings), rel=0.015)
    speed, size = up_and_down.amplitude(runs["up"])
    assert size.max() > 10.0 * np.median(size[speed < 6000.0])
    assert drawn(up_and_down, tmp_path / "run_up.png", 0.05)


def test_ross_drop_in(tmp_path):
    """ROSS's own element has 202.7 Hz and 0.0316, films 224.5 and 0.00675 in both versions of ROSS."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pytest.importorskip("ross", reason="ROSS is not installed: pip install 'ehlcontact[ross]'")
    drop_in = example("ross_drop_in")
    held = drop_in.bearing()
    np.testing.assert_allclose(drop_in.first_mode(drop_in.on_films(held)), (224.48, 0.00675), rtol=5e-3)
    np.testing.assert_allclose(drop_in.first_mode(drop_in.on_theirs()), (202.7, 0.0316), rtol=1e-3)
    run = drop_in.over_time(held, 0.02)
    alone = held.equilibrium((0.0, -drop_in.LOAD), speed_rpm=drop_in.RPM)
    np.testing.assert_allclose(run.ring[0, :, 1], alone.displacement[1], rtol=1e-3)
    np.testing.assert_allclose(run.ring[:, :, 1].mean(axis=0), alone.displacement[1], rtol=0.02)
    assert drawn(drop_in, tmp_path / "ross.png", 0.01)


@pytest.mark.long
# scipy's BDF subtracts room it has not written yet, in its first steps: a warning where that holds an infinity.
@pytest.mark.filterwarnings("ignore:invalid value encountered in subtract:RuntimeWarning:scipy")
def test_a_control_loop(tmp_path):
    """Must-show of issue 12: linearised by differences within 1e-4, Bode is the impedance; the damper damps."""
    control = pytest.importorskip("control")
    loop = example("control_loop")
    line = loop.rotor()
    held = line.mounts[0].bearing
    exact, moving = loop.linear(line), loop.nonlinear(line)
    found = control.linearize(moving, np.zeros(moving.nstates), np.zeros(2), eps=1e-5)
    omega = np.geomspace(30.0, 1e5, 9)
    one, other = (control.frequency_response(system, omega).frdata for system in (found, exact))
    worst = np.abs(one - other).max(axis=(0, 1)) / np.abs(other).max(axis=(0, 1))
    assert worst.max() < 1e-4
    # force on the disc over the ring's place is what shaft and masses pass on, less what the ring pushes back with
    load = (0.0, -9.81 * (loop.JOURNAL + loop.DISC))
    c = held.coefficients(load, speed_rpm=loop.RPM, cage_angle=line.mounts[0].cage_angle, omega=omega)
    for k, w in enumerate(omega):
        disc, ring = other[:2, :, k], other[2:, :, k]
        pushed = loop.SHAFT * (disc - ring) + loop.JOURNAL * w * w * ring
        Z = c.stiffness[k] + 1j * w * c.damping[k]
        np.testing.assert_allclose(pushed @ np.linalg.inv(ring), Z, rtol=0.0, atol=1e-6 * abs(Z).max())
    alone, damped = loop.first_mode(exact), loop.first_mode(loop.damped(exact))
    assert damped[1] > 10.0 * alone[1] and abs(damped[0] - alone[0]) < 0.2 * alone[0]
    t = np.linspace(0.0, 0.005, 101)
    after = [loop.blown(loop.damped(system), loop.damped(exact), t) for system in (exact, moving)]
    np.testing.assert_allclose(after[1], after[0], rtol=0.0, atol=0.03 * np.abs(after[0]).max())
    assert drawn(loop, tmp_path / "loop.png", 0.001)


@pytest.mark.long
def test_a_preloaded_motor(tmp_path):
    found = example("preloaded_motor").main(str(tmp_path / "motor.png"))
    assert (tmp_path / "motor.png").read_bytes().startswith(PNG)
    axial, bending = zip(*found["modes"], strict=True)
    assert axial[2].decrement > 6.0 * bending[2].decrement
    assert np.all(np.diff([one.decrement for one in bending]) < 0.0)
    assert np.all(np.diff([one.hz for one in axial]) > 0.0)
    z = found["run"].displacement[:, found["rotor"].nodes["shaft"]["z"]]
    decay = log_decrement(found["run"].t, z, omega=axial[2].omega)
    assert decay.decrement == pytest.approx(axial[2].decrement, rel=0.05)
    assert np.degrees(found["state"].contact_angles.min()) > 10.0


@pytest.mark.long
def test_a_rotor_on_bearing_fmus(tmp_path):
    """A step of w h = 0.1 at the fastest mode gives the run in one; four times that does not."""
    found = example("rotor_on_bearing_fmus").main(str(tmp_path / "rotor.png"))
    assert (tmp_path / "rotor.png").read_bytes().startswith(PNG)
    short, middle, long = found["gaps"].values()
    assert short.max() < 0.03 < middle.max() < long.max()
    assert np.ptp(found["wanted"].displacement[:, 2]) > 2e-7


def test_a_rotor_in_exudyn(tmp_path):
    """Of another program: steps of w h = 0.1 give the run in one."""
    pytest.importorskip("exudyn")
    found = example("rotor_in_exudyn").main(str(tmp_path / "rotor.png"))
    assert (tmp_path / "rotor.png").read_bytes().startswith(PNG)
    assert found["gap"].max() < 0.03
    assert np.ptp(found["wanted"].displacement[:, 4]) > 1e-6


@pytest.mark.long
def test_orders_of_defects(tmp_path):
    """Clearances of the issue for 9.6 degrees; damping of films falls with preload (Mitsuya et al., 1998)."""
    module = example("orders_of_defects")
    found = module.main(str(tmp_path / "orders.png"))
    assert (tmp_path / "orders.png").read_bytes().startswith(PNG)
    at = dict(zip(module.AXIAL, found["curves"][0.0], strict=True))
    for axial, clearance in ((5.0, 7.9e-6), (15.0, 6.8e-6), (30.0, 5.6e-6)):
        assert at[axial] == pytest.approx(clearance, abs=0.06e-6)
        assert module.angle(at[axial], axial, 0.0) == pytest.approx(9.6, abs=0.02)
    np.testing.assert_allclose(found["curves"][10.0], found["curves"][0.0], atol=0.05e-6)
    for ratio in found["ratios"].values():
        assert np.all(np.diff(ratio) < 0.0)
    assert found["ratios"]["axial"][0] == pytest.approx(0.0128, abs=5e-4)
    assert found["ratios"]["radial"][-1] == pytest.approx(0.0140, abs=5e-4)
    for preload, losses in found["losses"].items():  # near twice the damping ratio that is missing
        missing = 2.0 * (np.array(module.MEASURED) - module.damping_ratio(preload, 2))
        np.testing.assert_allclose(losses, missing, rtol=0.15)
        assert 0.012 < losses[0] < losses[-1] < 0.06


def test_lines_of_motor_bearing_defects_are_a_sum_of_cosines():
    """The signal of whole periods is the plain sum of its lines."""
    study, rng = example("motor_bearing_defects"), np.random.default_rng(3)
    defect, j, k = 470.0 / study.TURNS, np.array([1, 5, -3, 14]), np.array([0, 1, 20, -2])
    at = study.Lines(j * defect + k, rng.normal(size=(4, 5)) + 1j * rng.normal(size=(4, 5)), defect)
    rpm, path = 1800.0, study.ModalPath(hz=2400.0, damping=0.02, mass=2.0)
    found = study.acceleration(at, rpm, path)
    t, wanted = np.arange(found.size) / study.RATE, 0.0
    for order, force in zip(at.order, at.force[:, 1], strict=True):
        hz = order * rpm / 60.0
        wanted = wanted + (path.response(hz) * force * np.exp(2j * np.pi * hz * t)).real
    np.testing.assert_allclose(found, wanted, atol=1e-9 * np.abs(wanted).max())


@pytest.mark.slow  # a fit of 285 spectra
def test_motor_bearing_defects(tmp_path):
    """What a fit to one record gives of five others, and how many of the comparisons come out."""
    found = example("motor_bearing_defects").main(str(tmp_path / "defects.png"))
    assert (tmp_path / "defects.png").read_bytes().startswith(PNG)
    met = {(row.file, row.what): row.met for row in found["rows"]}
    assert all(met[file, "A2/A1"] for file in ("105", "106", "107", "130", "144", "169"))
    assert all(met[file, "A3/A1"] for file in ("105", "106", "107", "130"))
    assert not met["169", "order"] and not met["130", "A1 - 1 turn"] and not met["130/144", "6 over 3 o'clock"]
    spans = [(curve.low, curve.high) for curve in found["curves"].values()]
    assert np.all(np.max([low for low, _ in spans], axis=0) < np.min([high for _, high in spans], axis=0))
