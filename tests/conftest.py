"""What several test folders share: every steady film is solved once per session; and disks that are full."""

import os
import signal
import subprocess
from functools import cache

import pytest

from ehlcontact import MoesPoint, solve_steady

# A shell starts what runs in the background with Ctrl-C ignored, and that is inherited: the programs under test,
# which are interrupted here, would not notice.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@cache
def _steady(M, L, kappa, n, laws):
    return solve_steady(MoesPoint(M, L, kappa, **dict(laws)), n=n)


@pytest.fixture(scope="session")
def steady():
    """``steady(M, L, kappa, n, viscosity=..., density=...)``: a solve on the default domain, cached."""
    return lambda M, L, kappa, n, **laws: _steady(M, L, kappa, n, tuple(sorted(laws.items())))


@pytest.fixture
def full_disk(tmp_path):
    """A folder on a disk of 16 kB, a file of ours already there."""
    folder = tmp_path / "small"
    folder.mkdir()
    if os.name != "posix" or os.geteuid() != 0:
        pytest.skip("only root may mount a disk of 16 kB")
    mount = ["mount", "-t", "tmpfs", "-o", "size=16k", "tmpfs", folder]
    done = subprocess.run(mount, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        pytest.skip(f"no disk of 16 kB can be mounted here: {done.stderr.strip()}")
    (folder / "kept.txt").write_text("kept")
    yield folder
    assert (folder / "kept.txt").read_text() == "kept"
    left = [path.name for path in folder.iterdir() if path.suffix == ".tmp"]
    subprocess.run(["umount", folder], check=True)
    assert left == []


@pytest.fixture
def no_room(monkeypatch):
    """``no_room()`` makes every later write of a file fail as on a full disk."""

    def write(*_):
        raise OSError(28, "No space left on device")

    return lambda: monkeypatch.setattr(os, "fsync", write)


@pytest.fixture(scope="session", autouse=True)
def own_cache(tmp_path_factory):
    """Libraries of FMUs are compiled by the tests, not found in the user's cache."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("EHLCONTACT_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield
