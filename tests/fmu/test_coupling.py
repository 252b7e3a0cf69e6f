"""`examples/studies/coupling.py`: ways of coupling a mass to the FMU of a contact, and the limits of each."""

from pathlib import Path
from runpy import run_path

import numpy as np
import pytest

EXAMPLE = Path(__file__).parents[2] / "examples" / "studies" / "coupling.py"


@pytest.fixture(scope="module")
def example():
    return run_path(str(EXAMPLE))


@pytest.fixture(scope="module")
def bench(example, tmp_path_factory):
    return example["Bench"](example["contact"](), tmp_path_factory.mktemp("bench"))


@pytest.fixture(scope="module")
def runs(example, bench):
    return {part: bench.ways(part) for part in example["PARTS"]}


@pytest.fixture(scope="module")
def own(bench):
    return bench.controlled()


@pytest.mark.parametrize("part", [100, 20])
def test_a_force_half_a_step_late_grows_without_bound(example, bench, runs, part):
    """Stiffness times half the step is taken off the damping; where the surfaces part it goes on growing."""
    run = runs[part]["explicit, lead 1"]
    amplitude = bench.amplitude(run)
    assert amplitude[-1] > 10.0
    K, h, mass = float(bench.element.spring_tangent(bench.rest)), bench.period / part, example["MASS"]
    if part == 100:  # small at first, and as fast as that says
        early = (run.t < 3.0 * bench.period) & (amplitude < 3.0)
        rate = np.polyfit(run.t[early], np.log(amplitude[early]), 1)[0]
        Z = bench.element.impedance(omega=[bench.omega], load=example["LOAD"])
        C = float(Z.damping[0])
        assert -2.0 * mass * rate == pytest.approx(C - 0.5 * K * h, rel=0.05)


def test_the_default_is_for_steps_that_resolve_the_swing(bench, runs):
    """Within 1 % of the reference at a hundredth of the period; too small at a twentieth."""
    assert bench.left(runs[100]["explicit, lead 1.5"]) == pytest.approx(1.0, abs=0.01)
    assert 0.1 < bench.left(runs[20]["explicit, lead 1.5"]) < 0.7


@pytest.mark.parametrize("part", [100, 20])
@pytest.mark.parametrize("way", ["linearly implicit", "implicit"])
def test_implicit_ways_keep_the_amplitude(bench, runs, part, way):
    run = runs[part][way]
    assert run.t[-1] == pytest.approx(40.0 * bench.period)
    assert bench.left(run) == pytest.approx(1.0, abs=0.02)
    assert run.steps == 40 * part if way == "linearly implicit" else run.steps > 40 * part


@pytest.mark.long
def test_the_rollback_master_equals_the_python_oscillator(example, bench, own):
    """Within twice the tolerance of its steps, tightened or loosened."""
    for tolerance, run in ((example["TOLERANCE"], own), (1e-3, bench.controlled(1e-3))):
        off = np.abs(run.approach - bench.reference(run.t).approach).max() / bench.first_amplitude
        assert off < 10.0 * tolerance, tolerance
    assert bench.left(own) == pytest.approx(1.0, abs=1e-4)


@pytest.mark.long
def test_its_figure(example, bench, runs, own, tmp_path):
    figure = example["picture"](tmp_path / "coupling.png", bench, runs, own)
    assert (tmp_path / "coupling.png").stat().st_size > 10_000
    for part, panel, below in zip((100, 20), figure.axes[:2], figure.axes[2:], strict=True):
        assert panel.get_title() == f"step: 1/{part} of the period" and len(below.lines) == 6
        assert [line.get_label() for line in panel.lines[:4]] == list(runs[part])
        assert len(panel.lines) == 6
