"""Processes that end with their parent."""

import signal
import subprocess
import sys
import time

from ehlcontact.process.workers import interrupts_held

CHILD = (
    "from ehlcontact.process.workers import end_when, stdin_closed\nend_when(stdin_closed)\nprint(1, flush=True)"
)
BUSY = "while True: pass"


def test_a_child_ends_when_the_other_end_of_its_stdin_is_closed():
    command = [sys.executable, "-c", f"{CHILD}\n{BUSY}"]
    child = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    assert child.stdout.readline() == b"1\n" and child.poll() is None
    child.stdin.close()
    assert child.wait(10) == 1
    child.stdout.close()


def test_a_child_ends_when_its_parent_is_killed():
    inner = [sys.executable, "-c", f"{CHILD}\n{BUSY}"]
    outer = (
        f"import subprocess\np = subprocess.Popen({inner!r}, stdin=subprocess.PIPE)\nprint(p.pid, flush=True)\n"
    )
    parent = subprocess.Popen([sys.executable, "-c", outer + BUSY], stdout=subprocess.PIPE, text=True)
    lines = {parent.stdout.readline().strip(), parent.stdout.readline().strip()}
    (pid,) = (int(line) for line in lines - {"1"})
    parent.kill()
    parent.communicate()
    until = time.monotonic() + 10.0
    while alive(pid):
        assert time.monotonic() < until
        time.sleep(0.02)


def alive(pid):
    try:
        with open(f"/proc/{pid}/stat") as stat:
            return stat.read().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_children_do_not_hear_of_ctrl_c():
    with interrupts_held():
        child = subprocess.Popen(
            [sys.executable, "-c", "import time; print(1, flush=True); time.sleep(60)"], stdout=subprocess.PIPE
        )
    assert child.stdout.readline() == b"1\n"
    child.send_signal(signal.SIGINT)
    time.sleep(0.2)
    assert child.poll() is None
    child.kill()
    child.communicate()
    assert signal.SIGINT not in signal.pthread_sigmask(signal.SIG_BLOCK, ())
