"""Comparison figures against their definitions."""

import json
from dataclasses import replace

import numpy as np
import pytest

from ehlcontact.errors import InputError
from reduced_models import compare, jeffcott_rotor, simulate_rotor

BODY = {"disc_mass": 20.0, "journal_mass": 1.0, "shaft_stiffness": 2e7, "shaft_damping": 200.0}


@pytest.fixture
def run(cubic, scales):
    rotor = jeffcott_rotor(bearings=1, **BODY, unbalance=1e-4, speed_rpm=6000.0, load=(0.0, -800.0))
    return simulate_rotor(rotor.on([cubic.to_si(scales)]), dt=5e-5, until=0.02)


def test_a_run_equals_itself(run):
    same = compare(run, run)
    assert same.displacement == 0.0 and same.force == 0.0 and same.samples == run.t.size
    assert same.signals["disc_x"].rms_over_amplitude is None


def test_figures_follow_their_definitions(run):
    other = replace(run, force=run.force + 3.0, displacement=run.displacement * [1.0, 1.01])
    result = compare(run, other, discard=0.005)
    kept = run.t >= 0.005 - 1e-12
    force = run.force[kept, 0]
    signal = result.signals["force_0"]
    assert signal.rms == pytest.approx(3.0) and signal.maximum == pytest.approx(3.0)
    assert signal.amplitude == pytest.approx(np.ptp(force) / 2) and signal.std == pytest.approx(np.std(force))
    assert signal.offset == pytest.approx(3.0) and signal.vibration_over_std == pytest.approx(0.0, abs=1e-9)
    assert result.force == pytest.approx(3.0 / np.std(force))
    assert result.force_vibration == pytest.approx(0.0, abs=1e-9)
    assert signal.rms_over_std == pytest.approx(3.0 / np.std(force))
    journal = run.journal[kept, 1]
    assert result.displacement == pytest.approx(np.sqrt(np.mean((0.01 * journal) ** 2)) / np.std(journal))
    assert result.displacement_vibration == pytest.approx(0.01)
    assert result.samples == np.count_nonzero(kept) and result.t_start == pytest.approx(0.005)
    document = json.loads(json.dumps(result.to_dict()))
    assert set(document["signals"]) == {
        "disc_x", "disc_y", "journal_x", "journal_y", "approach_0", "force_0"
    }  # fmt: skip


def test_other_times_are_interpolated_and_the_overlap_counts(run):
    coarse = replace(
        run,
        **{n: getattr(run, n)[:301:2] for n in ("t", "displacement", "approach", "force")},
    )
    result = compare(run, coarse)
    assert result.t_end == pytest.approx(run.t[300]) and result.samples == 301
    assert result.force < 1e-2


def test_bad_comparisons(run):
    with pytest.raises(InputError, match="discard"):
        compare(run, run, discard=0.02)
    with pytest.raises(InputError, match="discard"):
        compare(run, run, discard=-1.0)
    with pytest.raises(InputError, match="contacts"):
        compare(run, replace(run, force=np.zeros((run.t.size, 2))))
