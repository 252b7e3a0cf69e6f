"""Ctrl-C while the command line is being imported: one line and exit code 130.

The imports take a second, most of it before any code of the command line runs, and some packages suppress what is
raised while they are imported. So `ehlcontact` imports this module first, and this module imports next to nothing.
"""

import _signal  # built in: `signal` would import 10 ms of others, unguarded
import os
import sys
from itertools import pairwise

PROGRAM = "ehlcontact"
INTERRUPTED = 130  # exit code of a program that Ctrl-C ended, as shells have it: 128 + SIGINT
NOTHING_COMPUTED = f"{PROGRAM}: interrupted before anything was computed\n"


def exit_on_interrupt() -> None:
    """Until `restore_interrupt`, Ctrl-C ends this process if it is the command line.

    Programs of others that import the library keep their own ways.
    """
    if _is_program() and _signal.getsignal(_signal.SIGINT) is _signal.default_int_handler:
        try:
            _signal.signal(_signal.SIGINT, _leave)
        except ValueError:  # not in the main thread, to which Ctrl-C does not come: nothing to guard
            pass


def restore_interrupt() -> None:
    """Ctrl-C raises `KeyboardInterrupt` again."""
    if _signal.getsignal(_signal.SIGINT) is _leave:
        _signal.signal(_signal.SIGINT, _signal.default_int_handler)


def _is_program() -> bool:
    """Whether this process was started as ``ehlcontact`` or ``python -m ehlcontact.cli``."""
    given = sys.orig_argv
    started = os.path.splitext(os.path.basename(sys.argv[0]))[0]
    return started == PROGRAM or ("-m", f"{PROGRAM}.cli") in pairwise(given)


def _leave(*_: object) -> None:
    try:
        os.write(2, NOTHING_COMPUTED.encode())
    except OSError:  # stderr is closed or full: the exit code tells it all the same
        pass
    os._exit(INTERRUPTED)


exit_on_interrupt()  # here and not in the package, whose imports are what takes so long
