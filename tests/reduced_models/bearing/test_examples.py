"""The examples about bearings, as far as they are cheap."""

import importlib.util
import warnings
from pathlib import Path

import numpy as np
import pytest

EXAMPLES = Path(__file__).parents[3] / "examples"


def example(name):
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_run_up_and_a_coast_down_enclose_the_critical_speeds(tmp_path):
    run_up = example("run_up")
    held = run_up.bearing()
    critical = run_up.critical_speeds(held)
    up, down = run_up.runs(held, 1.0)
    for k in (0, 1):
        rising, falling = run_up.peaks(up, down, k)
        assert falling < critical[k] < rising
        assert 0.5 * (rising + falling) == pytest.approx(critical[k], rel=0.015)
        speed, size = run_up.swing(up, k)
        assert size.max() > 10.0 * np.median(size[speed < 6000.0])
    run_up.picture(tmp_path / "run_up.png", up, down, critical)
    assert (tmp_path / "run_up.png").read_bytes().startswith(b"\x89PNG")


def test_ross_drop_in():
    """The issue: ROSS's own element has 202.7 Hz and 0.0316, films 224.8 and 0.0073."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pytest.importorskip("ross", reason="ROSS is not installed: pip install 'ehlcontact[ross]'")
    drop_in = example("ross_drop_in")
    held = drop_in.bearing()
    np.testing.assert_allclose(drop_in.first_mode(drop_in.on_films(held)), (224.8, 0.0068), rtol=0.01)
    np.testing.assert_allclose(drop_in.first_mode(drop_in.on_theirs()), (202.7, 0.0316), rtol=1e-3)
    run = drop_in.over_time(held, 0.02)
    alone = held.equilibrium((0.0, -drop_in.LOAD), speed_rpm=drop_in.RPM)
    np.testing.assert_allclose(run.ring[0, :, 1], alone.displacement[1], rtol=1e-3)
    np.testing.assert_allclose(run.ring[:, :, 1].mean(axis=0), alone.displacement[1], rtol=0.02)
