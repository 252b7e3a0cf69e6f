"""Memory that is still available to this process."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

MEMINFO = Path("/proc/meminfo")
GROUPS = Path("/proc/self/cgroup")
# Limit, use, and what of it a file cache gives back: of control groups of version 2 and of version 1.
GROUP_FILES = (
    (Path("/sys/fs/cgroup"), "memory.max", "memory.current", "inactive_file"),
    (Path("/sys/fs/cgroup/memory"), "memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"),
)


def available_bytes() -> float | None:
    """Bytes that are free on the machine and within the limits of our control groups; None where unknown.

    Where a machine does not report its free memory, all of its memory counts.
    """
    known = [*_of_machine(), *_of_groups()]
    return min(known, default=None)


def _of_machine() -> Iterator[float]:
    with suppress(OSError, ValueError, IndexError):
        lines = dict(line.split(":", 1) for line in MEMINFO.read_text().splitlines())
        if "MemAvailable" in lines:
            yield 1024.0 * float(lines["MemAvailable"].split()[0])
            return
    with suppress(AttributeError, OSError, ValueError):  # no sysconf on Windows
        yield float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES")


def _of_groups() -> Iterator[float]:
    """What the control groups above this process leave; in a container the outermost is mounted as the root."""
    paths = {Path("/")}
    with suppress(OSError):
        for line in GROUPS.read_text().splitlines():
            number, controllers, own = line.split(":", 2)
            if number == "0" or "memory" in controllers.split(","):
                paths |= {Path(own), *Path(own).parents}
    for root, most, used, cached in GROUP_FILES:
        for path in paths:
            with suppress(OSError, ValueError):  # no such group, or "max"
                folder = root / path.relative_to("/")
                limit, use = (float((folder / name).read_text()) for name in (most, used))
                stat = dict(line.split() for line in (folder / "memory.stat").read_text().splitlines())
                yield max(0.0, limit - use + float(stat.get(cached, 0.0)))
