"""The command line `ehlcontact`, above all three packages; nothing imports it.

=============  =======================================================================================
module         responsibility
=============  =======================================================================================
``app``        the program: subcommands, errors to one line and an exit code
``entries``    type, unit, range and meaning of every input of files and options
``contact``    options of a point: a ball of a bearing in SI, or M, L and kappa
``options``    groups of options, and where results go
``output``     tables, JSON, messages, checks of where results go, streams
``usage``      what is wrong with a command line, in one line; examples
``numerals``   numbers for people: figures, exponents, characters of units
``rows``       rows of tables: quantities of results in units that people use
``progress``   how far a computation is: bars on a terminal, now and then a line elsewhere
``page``       HTML pages that need no other file, from ``templates/``
``explorer``   the page of ``explore``: its data, and JavaScript from ``templates/explore/``
``commands/``  one subcommand each
``plots/``     every picture
``orders``     ``--measured-order`` of ``bearing``: contact angle and clearance of an order
``spall``      ``--spall`` of ``bearing``: lines of force of a defect
``starter``    the study file that ``init`` writes
``toml``       TOML read and written
``study/``     the study behind ``run``
``paper/``     the paper's tables and figures behind ``reproduce``
=============  =======================================================================================

Exit codes: 0 success; 1 not converged, with what was reached saved; 2 bad input, or no room for the output; 130
interrupted, by Ctrl-C or a signal that ends a run, with what was reached saved: the last line says what resumes.
"""

from __future__ import annotations

import gc
import os
import signal
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import NoReturn

from ehlcontact.process.early_interrupt import INTERRUPTED, NOTHING_COMPUTED, restore_interrupt


@contextmanager
def nothing_collected() -> Iterator[None]:
    """What is imported stays: to look for garbage in it takes a tenth of the start."""
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Run the program on `arguments` (the process's own if not given) and exit."""
    # Pictures go to files: a backend that shows them, as a notebook sets it for its own kernel, may not be there,
    # and then matplotlib cannot even be imported.
    os.environ["MPLBACKEND"] = "Agg"
    try:
        with nothing_collected():
            from ehlcontact.cli.app import execute

        restore_interrupt()
        code = execute(arguments)
        if arguments is None:  # all is said and done: what is left, the end of Python, is no longer interrupted
            signal.signal(signal.SIGINT, signal.SIG_IGN)
    except KeyboardInterrupt:  # between one guard and the next
        sys.stderr.write(NOTHING_COMPUTED)
        code = INTERRUPTED
    raise SystemExit(code)
