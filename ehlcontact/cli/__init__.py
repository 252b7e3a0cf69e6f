"""The command line `ehlcontact`: one module per subcommand, above all three packages.

=================  ===================================================================================
module             responsibility
=================  ===================================================================================
``app``            the program: subcommands, errors to one line and an exit code
``options``        operating-point options shared by the subcommands
``output``         consoles, tables, JSON, progress, checks of where results go
``steady`` ...     one subcommand each: ``steady``, ``simulate``, ``impedance``, ``fit``, ``element``, ``export``,
                   ``run``, ``atlas``
``figure_file``    ``--figure``: pictures of one result, drawn by ``figures_film`` and ``figures_transient``
``study``          the study behind ``run``: schema, stages, report, figures
``reproduce``      the paper's tables and figures beside ours
=================  ===================================================================================

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
