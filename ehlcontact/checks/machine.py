"""Number of threads, at most the cores of the machine."""

from __future__ import annotations

from ehlcontact.checks.inputs import require_integer
from ehlcontact.errors import InputError
from ehlcontact.process.threads import cores, threads_allowed


def require_threads(field: str, value: object) -> int:
    """Return `value`, by default as many threads as a solve takes by itself, or raise `InputError`.

    Refused is what is no whole number from 1 to the cores that this process may use.
    """
    if value is None:
        return threads_allowed()
    most = cores()
    allowed = f"a whole number from 1 to {most}, the cores that this process may use"
    threads = require_integer(field, value, allowed, 1)
    if threads > most:
        raise InputError(field, threads, allowed)
    return threads
