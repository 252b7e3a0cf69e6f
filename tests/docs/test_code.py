"""Every block of Python in README, pages and tutorials runs, without a warning; every command line is one."""

import importlib.util
import shlex
import sys
import warnings
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from page_blocks import PAGES, ROOT, blocks, commands, run

from ehlcontact.cli import main

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
    assert {name.split("/")[-1] for name in TUTORIALS} == {"film.md", "bearing.md", "fmu.md"}
    assert len(blocks("README.md")) >= 4
    first = blocks("docs/tutorials/film.md")[0]
    assert first.line == 13 and first.code.startswith("from ehlcontact import")
    assert [block.needs for block in blocks("docs/tutorials/bearing.md")].count("ross") == 1


@pytest.mark.parametrize("page", sorted(set(PAGES) - TUTORIALS))
def test_page(page, tmp_path):
    found = {}
    run(page, found)
    if page == "README.md":  # what it says of the blocks of python-control
        memory, loop = found["memory"], found["loop"]
        assert (loop.input_labels, loop.output_labels, loop.nstates) == (["u", "v"], ["F"], memory.state_count)
        tangent = memory.spring_tangent(memory.approach_at(1.0))
        assert found["static_stiffness"] == pytest.approx(tangent, rel=1e-9)


@pytest.mark.filterwarnings("ignore::UserWarning")  # what ROSS brings says at import, where ROSS is
def test_an_error_tells_its_page_and_line():
    with pytest.raises((NameError, ImportError)) as failed:
        run("docs/tutorials/bearing.md", {}, have={"ross"}, only="ross")
    last = failed.traceback[-1]
    assert "bearing.md" in str(last.path)
    (block,) = (block for block in blocks("docs/tutorials/bearing.md") if block.needs)
    assert block.line <= last.lineno + 1 < block.line + block.code.count("\n")


def test_tutorial_of_the_film(capsys):
    """What its text says of the answers is so."""
    found = {}
    run("docs/tutorials/film.md", found)
    assert found["film"].status.ok
    middle = found["si"].h[:, 0]
    contact = np.abs(found["si"].x) < found["film"].scales.a
    assert found["si"].h_min < middle[contact].min() * 1.001 and found["C"][0] > 5.0 * found["C"][-1]
    assert abs(found["answer"].si.h_central - found["si"].h_central) < 2.0 * found["bar"]
    assert "isothermal" in capsys.readouterr().out


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


def test_tutorial_of_the_fmu():
    """The FMU is its element, and the difference is that of the loop: it falls with the step."""
    shares = {}
    for step in ("2e-6", "1e-6"):
        found = {}
        run("docs/tutorials/fmu.md", found, put={"2e-6, 0.02": f"{step}, 0.005"})
        shares[step] = found["share"]
    assert shares["1e-6"] < 0.6 * shares["2e-6"] < 0.02


@pytest.mark.parametrize("page", ["README.md", *sorted(PAGES)][1:])
def test_command_lines(page, capsys):
    """With --help behind it a line is read, option by option, and nothing is computed."""
    for line in commands(page):
        arguments = shlex.split(line)[1:]
        with pytest.raises(SystemExit) as stop:
            main([*arguments, "--help"])
        assert not stop.value.code, (line, capsys.readouterr().err)


def test_a_command_line_with_a_slip_is_seen(capsys):
    assert "ehlcontact reproduce --table 3" in commands("README.md")
    with pytest.raises(SystemExit) as stop:
        main(["steady", "--M", "200", "--kapa", "0.5", "--help"])
    assert stop.value.code == 2 and "kapa" in capsys.readouterr().err
