"""Options that several subcommands share, in groups, and the inputs they stand for."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import MISSING, dataclass, fields, is_dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, get_type_hints

import typer

from ehlcontact.checks.machine import require_threads
from ehlcontact.cli.output import (
    check_apart,
    check_file,
    check_json,
    deliver,
    save_to,
    show_table,
    write_json,
    write_to,
)
from ehlcontact.errors import InputError
from ehlcontact.solver.domain import Domain, check_intervals
from ehlcontact.solver.grid import Grid as SolverGrid

_GRID, _FILES = "Discretisation", "Results"
Drawing = Callable[[Any, Path], object]  # a result into a file
HDF5 = (".h5", ".hdf5")
PICTURES = (".png", ".svg", ".pdf")


def grouped(command: Callable[..., None]) -> Callable[..., None]:
    """Let a command take groups of options: a parameter that is a dataclass becomes its fields for typer."""
    parameters = inspect.signature(command, eval_str=True).parameters.values()
    groups: dict[str, Any] = {p.name: p.annotation for p in parameters if is_dataclass(p.annotation)}
    shown: list[inspect.Parameter] = []
    for parameter in parameters:
        group = groups.get(parameter.name)
        shown += [parameter.replace(kind=parameter.KEYWORD_ONLY)] if group is None else _options(group)

    @functools.wraps(command)
    def ungrouped(**given: Any) -> None:
        made = {
            name: group(**{field.name: given.pop(field.name) for field in fields(group)})
            for name, group in groups.items()
        }
        command(**made, **given)

    ungrouped.__signature__ = inspect.Signature(shown)  # type: ignore[attr-defined]
    ungrouped.__annotations__ = {parameter.name: parameter.annotation for parameter in shown}
    return ungrouped


def _options(group: Any) -> Iterator[inspect.Parameter]:
    """The fields of a group as parameters of a command."""
    kinds = get_type_hints(group, include_extras=True)
    for field in fields(group):
        default = inspect.Parameter.empty if field.default is MISSING else field.default
        yield inspect.Parameter(
            field.name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=kinds[field.name]
        )


@contextmanager
def called(**options: str) -> Iterator[None]:
    """Let an `InputError` of the block name the option where the library has a name of its own."""
    try:
        yield
    except InputError as error:
        raise InputError(options.get(error.field, error.field), error.value, error.allowed) from None


Intervals = Annotated[int, typer.Option("--n", help="Intervals along X, a multiple of 16.", rich_help_panel=_GRID)]
JsonTo = Annotated[
    str | None,
    typer.Option(
        "--json",
        metavar="FILE",
        help="Write the result as JSON; - is stdout, with nothing else there.",
        rich_help_panel=_FILES,
    ),
]
FigureTo = Annotated[
    Path | None,
    typer.Option("--figure", metavar="FILE", help="Draw the result as PNG, SVG or PDF.", rich_help_panel=_FILES),
]


@dataclass(frozen=True, kw_only=True)
class Grid:
    """Where and how finely the film is solved, and by how many threads."""

    n: Annotated[
        int | None,
        typer.Option(
            "--n",
            show_default="what the film needs",
            help="Intervals along X, a multiple of 16.",
            rich_help_panel=_GRID,
        ),
    ] = None
    domain: Annotated[
        tuple[float, float, float] | None,
        typer.Option(
            "--domain",
            metavar="XA XB YMAX",
            help="Computed region [[XA, XB] x [-YMAX, YMAX]] in Hertz semi-axes; "
            "-4.5 1.5 3 unless the load rises.",
            rich_help_panel=_GRID,
        ),
    ] = None
    threads: Annotated[
        int | None,
        typer.Option(
            "--threads",
            show_default="all cores",
            help="Threads that share the work; the result is the same for any number.",
            rich_help_panel=_GRID,
        ),
    ] = None

    def chosen(self) -> dict[str, Any]:
        """Check the options; ``grid`` and ``threads`` for a solver."""
        if self.n is not None:
            check_intervals(self.n)
        require_threads("threads", self.threads)
        with called(x_in="--domain XA", x_out="--domain XB", y_max="--domain YMAX"):
            domain = None if self.domain is None else Domain(*self.domain)
        return {"grid": SolverGrid(self.n, domain), "threads": self.threads}


@dataclass(frozen=True, kw_only=True)
class Files:
    """Where the result goes."""

    save: Annotated[
        Path | None,
        typer.Option("--save", metavar="FILE", help="Save the result as HDF5.", rich_help_panel=_FILES),
    ] = None
    figure: FigureTo = None
    json_to: JsonTo = None

    def check(self, beside: Mapping[str, Path | None] = MappingProxyType({}), read: Path | None = None) -> None:
        """Make sure, before a long solve, that all of them can be written, and that none replaces another.

        Parameters
        ----------
        beside : mapping
            Further options and the files that they have written.
        read : Path, optional
            A file that the command reads.
        """
        check_file("--save", self.save, HDF5)
        check_file("--figure", self.figure, PICTURES)
        check_json(self.json_to)
        own = {"--save": self.save, "--figure": self.figure, "--json": self.json_to}
        check_apart({**beside, **own}, (read,))

    def deliver(
        self,
        result: Any,
        title: str,
        rows: list[tuple[str, str, str]],
        draw: Drawing | None,
        about: Mapping[str, Any] = MappingProxyType({}),
    ) -> None:
        """Save, draw (if there is anything), write and show the result, each whatever becomes of the others.

        `about` is what else its JSON says.

        Raises
        ------
        InputError
            One of the files could not be written.
        """

        def figure(path: Path) -> None:
            if draw is not None:
                draw(result, path)

        deliver(
            lambda: save_to("--save", self.save, result),
            lambda: write_to("--figure", self.figure, figure),
            lambda: write_json({**result.to_dict(), **about}, self.json_to),
            lambda: show_table(title, rows, self.json_to),
        )


def domain_text(domain: Domain) -> str:
    """The region in words."""
    return f"[{domain.x_in:g}, {domain.x_out:g}] x [-{domain.y_max:g}, {domain.y_max:g}] Hertz semi-axes"
