"""The command line `ehlcontact`, above all three packages; nothing imports it.

=============  =======================================================================================
room           responsibility
=============  =======================================================================================
``app``        the program: subcommands, errors to one line and an exit code
``options``    options that subcommands share, in groups, and the inputs they stand for
``output``     consoles, tables, JSON, progress, checks of where results go
``page``       HTML pages that need no other file, from ``templates/``
``commands/``  one subcommand each
``plots/``     every picture
``study/``     the study behind ``run``
``paper/``     the paper's tables and figures behind ``reproduce``
=============  =======================================================================================

Exit codes: 0 success; 1 not converged or interrupted, with what was reached saved; 2 bad input.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import NoReturn


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Run the program on `arguments` (the process's own if not given) and exit."""
    try:
        from ehlcontact.cli.app import execute

        raise SystemExit(execute(arguments))
    except KeyboardInterrupt:  # while the program was still being imported
        sys.stderr.write("ehlcontact: interrupted before anything was computed\n")
        raise SystemExit(1) from None
