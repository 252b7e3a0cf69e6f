"""A real study that is interrupted again and again: Ctrl-C and kill -9 at ten random moments, the same summary."""

import json
import random
import signal
import subprocess
import time

import pytest
from programs import begin
from tiny_study import ALONE, CONTACT

MOMENTS, SEED = 10, 2026
JOBS = ("--jobs", "2")


def lasting(folder):
    """Summary and table but for what may differ between two runs, and the results but for times and paths."""
    found = json.loads((folder / "summary.json").read_text())
    del found["run"]
    results = [json.loads((folder / point["files"]["results"]).read_text()) for point in found["points"]]
    for one in results:
        timeless(one)
    return found, (folder / "summary.csv").read_bytes(), results


def timeless(value):
    """Take out how long things took, wherever it stands."""
    if isinstance(value, dict):
        value.pop("seconds", None)
        for inner in value.values():
            timeless(inner)
    elif isinstance(value, list):
        for inner in value:
            timeless(inner)


@pytest.mark.slow
def test_interrupted_at_ten_random_moments_it_gives_the_same_bit_for_bit(tmp_path):
    study = tmp_path / "two.toml"
    study.write_text((ALONE + CONTACT).replace("speed_rpm = 3000.0", "speed_rpm = [3000.0, 4000.0]"))
    # the first compiles: last digits may differ from kernels of the cache
    first = begin("run", study, "-o", tmp_path / "warm", *JOBS)
    first.communicate()
    started = time.monotonic()
    whole = begin("run", study, "-o", tmp_path / "whole", *JOBS)
    whole.communicate()
    took = time.monotonic() - started
    assert first.returncode == whole.returncode == 0
    expected = lasting(tmp_path / "whole")

    rng, folder, ends = random.Random(SEED), tmp_path / "out", []
    while len(ends) < MOMENTS:
        blow = rng.choice([signal.SIGINT, signal.SIGKILL])
        process = begin("run", study, "-o", folder, *JOBS)
        try:  # so soon that the study is rarely done before the tenth
            _, said = process.communicate(timeout=rng.uniform(0.0, 0.3) * took)
        except subprocess.TimeoutExpired:
            process.send_signal(blow)
            _, said = process.communicate(timeout=60)
        ends.append(process.returncode)
        assert process.returncode in (0, 130, -signal.SIGKILL, -signal.SIGINT) and "Traceback" not in said
    assert {130, -signal.SIGKILL} <= set(ends)
    last = begin("run", study, "-o", folder, *JOBS)
    last.communicate()
    assert last.returncode == 0
    assert lasting(folder) == expected
    assert not list(folder.rglob("*.tmp"))
