"""What is free: on the machine, and within control groups of either version."""

import pytest

from ehlcontact.process import free_memory as memory


@pytest.fixture
def machine(tmp_path, monkeypatch):
    """A machine with 8 GB free; `write` makes files of its control groups."""
    (tmp_path / "meminfo").write_text(
        "MemTotal:       16000000 kB\nMemAvailable:    8000000 kB\nHugePages_Total:  0\n"
    )
    (tmp_path / "cgroup").write_text("")
    files = [(tmp_path / f"v{2 - k}", *names) for k, (_, *names) in enumerate(memory.GROUP_FILES)]
    monkeypatch.setattr(memory, "MEMINFO", tmp_path / "meminfo")
    monkeypatch.setattr(memory, "GROUPS", tmp_path / "cgroup")
    monkeypatch.setattr(memory, "GROUP_FILES", tuple(files))

    def write(path, **texts):
        folder = tmp_path / path
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in texts.items():
            (folder / name.replace("__", ".")).write_text(text)

    return write


def test_of_the_machine(machine):
    assert memory.available_bytes() == 8_192_000_000.0


@pytest.mark.parametrize("folder", ["v2", "v2/user", "v2/user/session"])
def test_group_of_version_2(machine, folder):
    """The limit of any group above counts."""
    machine(".", cgroup="0::/user/session\n")
    stat = "anon 100\ninactive_file 500000000\n"
    machine(folder, memory__max="3000000000\n", memory__current="1000000000\n", memory__stat=stat)
    assert memory.available_bytes() == 2.5e9


def test_group_of_version_1(machine):
    machine(".", cgroup="9:name=systemd:/else\n4:cpu,memory:/job\n0::/\n")
    stat = "cache 7\ntotal_inactive_file 0\n"
    numbers = {"memory__limit_in_bytes": "3000000000\n", "memory__usage_in_bytes": "1000000000\n"}
    machine("v1/job", **numbers, memory__stat=stat)
    assert memory.available_bytes() == 2e9


def test_no_limit(machine):
    machine("v2", memory__max="max\n", memory__current="1000000000\n", memory__stat="inactive_file 0\n")
    assert memory.available_bytes() == 8_192_000_000.0


def test_more_used_than_allowed(machine):
    machine("v2", memory__max="1000\n", memory__current="2000\n", memory__stat="inactive_file 0\n")
    assert memory.available_bytes() == 0.0


def test_of_a_machine_that_tells_no_more_than_its_size(machine, tmp_path):
    machine(".", meminfo="nonsense")
    found = memory.available_bytes()
    assert found is None or found > 1e8


def test_of_this_machine():
    found = memory.available_bytes()
    assert found is None or found > 1e7
