"""Subcommands whose names are fixed (design.md, section 6) but which are not built yet."""

from __future__ import annotations

import typer

from ehlcontact.cli.output import USAGE, complain

NAMES = ("element",)


def register(app: typer.Typer) -> None:
    """Add them hidden: they answer when called, and are not listed."""
    settings = {"ignore_unknown_options": True, "allow_extra_args": True, "help_option_names": []}
    for name in NAMES:
        app.command(name, hidden=True, context_settings=settings)(refuse)


def refuse(context: typer.Context) -> None:
    """Not built yet."""
    complain(f"{context.info_name}: not built yet in this version; see ehlcontact --help for what is")
    raise typer.Exit(USAGE)
