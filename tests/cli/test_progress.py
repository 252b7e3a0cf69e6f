"""Progress where stderr is no terminal: now and then a line, with the time left."""

import io
import time

import pytest
from numba import njit
from rich.console import Console

from ehlcontact import kernel_cache
from ehlcontact.cli import progress
from ehlcontact.cli.progress import COMPILING, ONCE, Bars, Lines, duration

WRITE_DUE = Lines.write_due  # before the fixture of this folder takes it away


@pytest.fixture
def clock(monkeypatch):
    """``clock(seconds)`` moves the time on, and has the lines told that are due."""

    class Clock:
        now = 1000.0

        def __call__(self, lines, seconds):
            self.now += seconds
            WRITE_DUE(lines, self.now)

    clock = Clock()
    monkeypatch.setattr(progress.time, "monotonic", lambda: clock.now)
    monkeypatch.setattr(Lines, "last", clock.now)
    return clock


def test_what_is_done_soon_needs_no_line(clock, capsys):
    lines = Lines()
    task = lines.add("film")
    for k in range(9):
        lines.update(task, k, 10)
        clock(lines, 1.0)
    lines.end(task)
    assert capsys.readouterr() == ("", "")


def test_a_line_every_ten_seconds_and_ten_per_cent(clock, capsys):
    lines = Lines()
    task = lines.add("film")
    for k in range(1, 201):  # 50 s for the one half, 500 s for the other
        lines.update(task, k, 200)
        clock(lines, 0.5 if k <= 100 else 5.0)
    said = capsys.readouterr()
    told = said.err.splitlines()
    assert said.out == ""
    assert told[0] == "film: 10 %, about 90 s left"
    assert len(told) == 13


def test_a_run_that_goes_on_from_a_file_is_judged_by_what_it_does_now(clock, capsys):
    lines = Lines()
    task = lines.add("film")
    lines.update(task, 80, 100)
    clock(lines, 10.0)
    lines.update(task, 91, 100)
    clock(lines, 1.0)
    assert capsys.readouterr().err.splitlines() == ["film: 80 %"]
    lines.update(task, 92, 100)
    clock(lines, 9.0)
    assert capsys.readouterr().err == "film: 92 %\n"  # 12 per cent in 11 s, so 7 s more: it takes longer
    lines.update(task, 96, 100)
    clock(lines, 1.0)
    clock(lines, 60.0)
    assert capsys.readouterr().err == "film: 96 %\n"


def test_the_time_left_is_that_of_jobs_that_are_done(clock, capsys):
    """None after the first, which compiles; then by what is done when it was done, less the time since."""
    lines = Lines()
    task = lines.add("film")
    for done, seconds in ((0, 30.0), (1, 12.0), (2, 12.0), (3, 12.0)):
        lines.update(task, done, 8)
        clock(lines, seconds)
    assert capsys.readouterr().err.splitlines() == [
        "film: 0 %",
        "film: 12 %",
        "film: 25 %, about 2 min left",  # 42 s for two of eight, so 126 s, of which 12 are over
        "film: 38 %, about 78 s left",  # 54 s for three
    ]


def test_lines_of_a_task_without_known_end(clock, capsys):
    lines = Lines()
    task = lines.add("steady film")
    for second in range(200):
        lines.update(task, second, None, f"cycle {second}")
        clock(lines, 1.0)
    told = capsys.readouterr().err.splitlines()
    assert told == [
        f"steady film: {t}, cycle {k}"
        for t, k in (("10 s so far", 9), ("70 s so far", 69), ("2 min so far", 129), ("3 min so far", 189))
    ]


def test_many_short_tasks_have_as_few_lines_as_a_long_one(clock, capsys):
    for k in range(40):
        lines = Lines()
        task = lines.add(f"case {k}")
        lines.update(task, 0, 10)
        clock(lines, 3.0)
        lines.update(task, 9, 10)
        clock(lines, 0.5)
        lines.end(task)
    told = capsys.readouterr().err.splitlines()
    assert 10 <= len(told) <= 14 and all(line.startswith("case ") for line in told)


def test_ended_tasks_write_their_last_line_and_no_more(clock, capsys):
    lines = Lines()
    running = lines.add("now")
    clock(lines, 10.0)
    lines.end(running, "now: done, 10.0 s")
    clock(lines, 100.0)
    assert capsys.readouterr().err.splitlines() == ["now: 10 s so far", "now: done, 10.0 s"]


def test_the_thread_writes_and_ends(monkeypatch):
    said = []  # reading stderr while the thread writes may lose the line
    monkeypatch.setattr(Lines, "write_due", WRITE_DUE)
    monkeypatch.setattr(progress, "to_stderr", said.append)
    monkeypatch.setattr(progress, "SPACING", 0.0)
    monkeypatch.setattr(progress, "TICK", 0.01)
    others = progress.threading.enumerate()
    with progress.progress("film") as update:
        update(1, 4)
        thread = next(t for t in progress.threading.enumerate() if "_watch" in t.name and t not in others)
        while not said:
            time.sleep(0.01)
    assert said[0].startswith("film: ") and not thread.is_alive()


@pytest.fixture
def kept(monkeypatch):
    """Compiled code can be kept."""
    monkeypatch.setattr(kernel_cache, "is_keeping", lambda: True)


def test_compilation_is_shown_until_the_next_progress(kept, clock, capsys):
    lines = Lines()
    task = lines.add("film")
    lines.compiling(task)
    clock(lines, 10.0)
    lines.update(task, 1, 10)
    clock(lines, 10.0)
    for share in (3, 5):
        lines.update(task, share, 10)
        clock(lines, 10.0)
        lines.compiling(task)
    clock(lines, 60.0)
    assert capsys.readouterr().err.splitlines() == [
        f"film: 10 s so far, {COMPILING}{ONCE}",
        "film: 30 %",
        "film: 50 %, about 15 s left",
        f"film: 2 min so far, {COMPILING}{ONCE}",
    ]


def test_only_the_first_compilation_is_shown(monkeypatch):
    kernel, told = njit(lambda x: x + 1.0), []
    monkeypatch.setattr(Lines, "compiling", lambda self, task: told.append(task.description))
    for _ in range(2):
        with progress.progress("film"):
            assert kernel(1.0) == 2.0
    assert told == ["film"]
    kernel(1)  # compiled for whole numbers, when nobody asks
    assert told == ["film"]


def test_bars_show_it_at_once(kept, monkeypatch):
    """Later runs compile again where nothing can be kept."""
    bars = Bars(Console(file=io.StringIO()))
    task = bars.add("film")
    (shown,) = bars._bars.tasks
    bars.compiling(task)
    assert shown.fields["note"] == COMPILING + ONCE
    monkeypatch.setattr(kernel_cache, "is_keeping", lambda: False)
    bars.compiling(task)
    assert shown.fields["note"] == COMPILING
    bars.update(task, 1, 4, "cycle 1")
    assert shown.fields["note"] == "cycle 1"


def test_durations():
    assert [duration(t) for t in (0.2, 25.4, 99.0, 100.0, 3500.0, 4200.0)] == [
        *("0 s", "25 s", "99 s", "2 min", "58 min", "1 h 10 min"),
    ]
