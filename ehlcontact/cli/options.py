"""Options of subcommands in groups: pydantic models whose fields are declared as those of study files are."""

from __future__ import annotations

import functools
import inspect
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from copy import copy
from pathlib import Path
from types import MappingProxyType, NoneType
from typing import (
    Annotated,
    Any,
    ClassVar,
    Literal,
    NamedTuple,
    TypeVar,
    Union,
    get_args,
    get_origin,
    get_type_hints,
)

import typer
from pydantic import ValidationError, create_model
from pydantic.fields import FieldInfo
from typer.models import ParameterInfo

from ehlcontact.checks.machine import require_threads
from ehlcontact.cli.entries import Intervals, Section, allowed_of, meaning, meaning_of, options_of
from ehlcontact.cli.output import check_apart, check_json, deliver, save_to, show_table, write_json, write_to
from ehlcontact.cli.rows import Row
from ehlcontact.cli.study.schema import oil_grade
from ehlcontact.cli.study.schema_errors import first_error
from ehlcontact.errors import InputError
from ehlcontact.files import require_writable
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.grid import Grid as SolverGrid

HDF5 = (".h5", ".hdf5")
PICTURES = (".png", ".svg", ".pdf")
Table = tuple[str, list[Row]]  # title; rows of quantity, value and unit


class Options(Section):
    """A group of options: a field has a `typer.Option` in its metadata, and help from its declaration."""

    panel: ClassVar[str | None] = None  # heading in the help
    ENTRIES: ClassVar[dict[str, str]] = {}  # of a study that its fields set, by the field

    def entries(self) -> dict[str, Any]:
        """Values that are given, by entry as "operation.speed_rpm"."""
        found = {entry: getattr(self, name) for name, entry in self.ENTRIES.items()}
        return {
            entry: AS_TEXT[entry].read(value) if entry in AS_TEXT else value
            for entry, value in found.items()
            if value not in (None, [])
        }

    def by_option(self, *names: str) -> dict[str, Any]:
        """Values that are given, by option as "--speed-rpm"; of some fields, or of all."""
        found = {name: getattr(self, name) for name in names or type(self).model_fields}
        return {option_of(type(self), name): value for name, value in found.items() if value not in (None, [])}


Group = TypeVar("Group", bound=Options)


def grouped(command: Callable[..., None]) -> Callable[..., None]:
    """Let a command take groups of options: a parameter of a class of `Options` becomes its fields for typer."""
    parameters = inspect.signature(command, eval_str=True).parameters.values()
    groups: dict[str, type[Options]] = {
        p.name: p.annotation
        for p in parameters
        if isinstance(p.annotation, type) and issubclass(p.annotation, Options)
    }
    shown: list[inspect.Parameter] = []
    for parameter in parameters:
        group = groups.get(parameter.name)
        shown += [parameter.replace(kind=parameter.KEYWORD_ONLY)] if group is None else _parameters(group)

    @functools.wraps(command)
    def ungrouped(**given: Any) -> None:
        made = {
            name: group_of(group, {field: given.pop(field) for field in group.model_fields})
            for name, group in groups.items()
        }
        command(**made, **given)

    ungrouped.__signature__ = inspect.Signature(shown)  # type: ignore[attr-defined]
    ungrouped.__annotations__ = {parameter.name: parameter.annotation for parameter in shown}
    return ungrouped


class AsText(NamedTuple):
    """An entry that a command line gives as text."""

    metavar: str
    help: str
    read: Callable[[str], Any]


def _number_or_text(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text.strip()


AS_TEXT = {  # by the entry
    "oil.iso_vg": AsText(
        "GRADE",
        'ISO grade of a mineral oil, as "ISO VG 68".',
        lambda text: oil_grade(text, "--oil", "its --nu40 and --nu100"),
    ),
    "support.clearance": AsText(
        "UM|CLASS",
        "Radial internal clearance, um, below 0 a preload; or C2, CN, C3, C4: the middle of that class.",
        _number_or_text,
    ),
    "operation.contamination": AsText(
        "FACTOR|CLASS",
        'For the modified rating life: e_C of ISO 281, 1 is clean; or a class, as "normal cleanliness".',
        _number_or_text,
    ),
}


def with_entries(
    entries: Mapping[str, FieldInfo], panels: Mapping[str, str]
) -> Callable[[type[Group]], type[Group]]:
    """Let a group have an option for each entry of a study, but those that it declares itself.

    Type, range and meaning are those of the schema, the name that of `ehlcontact.cli.entries.options_of`: an entry
    that is added to the schema is an option of the group at once.

    Parameters
    ----------
    entries : mapping
        As of `ehlcontact.cli.entries.entries_of`.
    panels : mapping
        Headings in the help, by the section.
    """

    def decorate(group: type[Group]) -> type[Group]:
        by_field, fields = dict[str, str](), dict[str, Any]()
        for entry, field in entries.items():
            names = options_of(entry)
            own = names[0].removeprefix("--").replace("-", "_")
            by_field[own] = entry
            if own not in group.model_fields:
                fields[own] = (_option(entry, field, names, panels[entry.partition(".")[0]]), None)
        made = create_model(group.__name__, __base__=group, __module__=group.__module__, **fields)
        made.__doc__, made.ENTRIES = group.__doc__, by_field
        return made

    return decorate


def _option(entry: str, field: FieldInfo, names: Sequence[str], panel: str) -> Any:
    """Type of an option that sets an entry; None where it is not given."""
    if entry in AS_TEXT:
        metavar, words, _ = AS_TEXT[entry]
        return Annotated[str | None, typer.Option(*names, metavar=metavar, help=words, rich_help_panel=panel)]
    shown, told = typer.Option(*names, rich_help_panel=panel), meaning(meaning_of(field))
    kinds = [part for part in get_args(field.annotation) if part is not NoneType]
    if kinds and get_origin(kinds[0]) is tuple:  # of any number of values
        return Annotated[list[get_args(kinds[0])[0]] | None, shown, told]  # type: ignore[misc]
    own: Any = Annotated[(field.annotation, *field.metadata)] if field.metadata else field.annotation
    return Annotated[own | None, shown, told]


def group_of(group: type[Options], values: Mapping[str, Any]) -> Options:
    """The group with values that are checked.

    Raises
    ------
    InputError
        A value that its declaration does not allow, by the name of its field.
    """
    try:
        return group.model_validate(values)
    except ValidationError as error:
        found = first_error(error, group)
        name = found.field.partition(".")[0]
        choices = _choices(get_type_hints(group)[name])
        allowed = f"one of {', '.join(choices)}" if choices else found.allowed
        raise InputError(name, found.value, allowed) from None


def option_of(group: type[Options], name: str) -> str:
    """The option of a field, by the first of its names."""
    info = next(rule for rule in group.model_fields[name].metadata if isinstance(rule, ParameterInfo))
    return next(one for one in (info.default, *(info.param_decls or ())) if isinstance(one, str))


def _parameters(group: type[Options]) -> Iterator[inspect.Parameter]:
    """The fields of a group as parameters of a command."""
    kinds = get_type_hints(group)
    for name, field in group.model_fields.items():
        option = copy(next(rule for rule in field.metadata if isinstance(rule, ParameterInfo)))
        if option.help is None:
            words = "; ".join(part for part in (meaning_of(field), allowed_of(field)) if part).replace('"', "")
            option.help = f"{words[0].upper()}{words[1:]}."
        option.rich_help_panel = option.rich_help_panel or group.panel
        default = inspect.Parameter.empty if field.is_required() else field.default
        kind: Any = Annotated[_without_choices(kinds[name]), option]
        yield inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=kind)


def _choices(kind: Any) -> tuple[str, ...]:
    """Values of a `Literal`, also of one that may be left out."""
    found = (get_args(one) for one in (kind, *get_args(kind)) if get_origin(one) is Literal)
    return next(found, ())


def _without_choices(kind: Any) -> Any:
    """The type with text in place of a `Literal`: its values are checked by pydantic, not by the parser."""
    if get_origin(kind) is Literal:
        return str
    return Union[tuple(map(_without_choices, get_args(kind)))] if _choices(kind) else kind  # noqa: UP007


@contextmanager
def called(**options: str) -> Iterator[None]:
    """Let an `InputError` of the block name the option where the library has a name of its own."""
    try:
        yield
    except InputError as error:
        raise InputError(options.get(error.field, error.field), error.value, error.allowed) from None


class Grid(Options):
    """Where and how finely the film is solved, and by how many threads."""

    panel: ClassVar[str | None] = "Discretisation"
    n: Annotated[
        Intervals | None,
        typer.Option("--n", show_default="what the film needs", help="Intervals along X, a multiple of 16."),
    ] = None
    domain: Annotated[
        tuple[float, float, float] | None,
        typer.Option(
            "--domain",
            metavar="XA XB YMAX",
            help="Computed region [[XA, XB] x [-YMAX, YMAX]] in Hertz semi-axes; "
            "-4.5 1.5 3 unless the load rises.",
        ),
    ] = None
    threads: Annotated[
        int | None,
        typer.Option(
            "--threads",
            show_default="all cores",
            help="Threads that share the work; the result is the same for any number.",
        ),
    ] = None

    def chosen(self) -> dict[str, Any]:
        """``grid`` and ``threads`` for a solver."""
        require_threads("threads", self.threads)
        with called(x_in="--domain XA", x_out="--domain XB", y_max="--domain YMAX"):
            domain = None if self.domain is None else Domain(*self.domain)
        return {"grid": SolverGrid(self.n, domain), "threads": self.threads}


class StudyOptions(Options):
    """A study, where its results go, and how much of the machine it takes."""

    study_file: Annotated[Path, typer.Argument(metavar="STUDY.toml", help="The study; see examples/.")]
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", metavar="DIR", help="Folder of the results; results/STUDY by default."),
    ] = None
    jobs: Annotated[int, typer.Option("--jobs", min=1, max=16, help="Computations side by side.")] = 2

    @property
    def folder(self) -> Path:
        """Folder of the results."""
        return Path("results") / self.study_file.stem if self.output is None else self.output

    @property
    def side_by_side(self) -> int:
        """Computations side by side on this machine."""
        return min(self.jobs, os.cpu_count() or 1)


class Endings(NamedTuple):
    """What the name of a file that is written may end in."""

    names: tuple[str, ...]


class Output(Options):
    """Where the result of a command goes: JSON, and what a class below adds."""

    panel: ClassVar[str | None] = "Results"
    json_to: Annotated[
        str | None,
        typer.Option(
            "--json", metavar="FILE", help="Write the result as JSON; - is stdout, with nothing else there."
        ),
    ] = None

    def check(
        self, *read: Path | None, beside: Mapping[str, tuple[Path | None, tuple[str, ...]]] = MappingProxyType({})
    ) -> None:
        """Make sure, before a long solve, that all files can be written, and that none replaces another.

        Parameters
        ----------
        *read : Path or None
            Files that the command reads.
        beside : mapping
            Further options, the files that they have written, and what their names may end in.
        """
        own = {
            f"--{name}": (
                getattr(self, name),
                next(rule.names for rule in field.metadata if isinstance(rule, Endings)),
            )
            for name, field in type(self).model_fields.items()
            if name != "json_to"
        }
        for option, (path, endings) in {**beside, **own}.items():
            if path is not None:
                require_writable(option, path, endings)
        check_json(self.json_to)
        check_apart({name: path for name, (path, _) in {**beside, **own}.items()} | {"--json": self.json_to}, read)

    def deliver(
        self,
        document: Mapping[str, Any],
        *shown: Table | Callable[[], object],
        save: Any = None,
        figure: Callable[[Path], object] | None = None,
    ) -> None:
        """Write and show the result, each part whatever becomes of the others.

        Parameters
        ----------
        document : mapping
            The JSON.
        *shown : tuple of str and list, or callable
            Title and rows of a table; or what shows something else.
        save : object, optional
            Result or element for the file of ``--save``.
        figure : callable, optional
            What draws the figure of ``--figure`` into a file.

        Raises
        ------
        InputError
            One of the files could not be written.
        """
        deliver(
            lambda: save_to("--save", getattr(self, "save", None), save),
            lambda: write_to("--figure", getattr(self, "figure", None), figure),
            lambda: write_json(document, self.json_to),
            *(part if callable(part) else functools.partial(show_table, *part, self.json_to) for part in shown),
        )


Save = Annotated[
    Path | None, typer.Option("--save", metavar="FILE", help="Save the result as HDF5."), Endings(HDF5)
]
SaveElement = Annotated[
    Path | None, typer.Option("--save", metavar="FILE", help="Save the element as JSON."), Endings((".json",))
]
FigureTo = Annotated[
    Path | None,
    typer.Option("--figure", metavar="FILE", help="Draw the result as PNG, SVG or PDF."),
    Endings(PICTURES),
]


class ElementOutput(Output):
    """JSON, and a file of the element."""

    save: SaveElement = None


class FigureOutput(Output):
    """JSON, and a picture."""

    figure: FigureTo = None


class ResultOutput(Output):
    """JSON, a picture, and a file of the result."""

    save: Save = None
    figure: FigureTo = None
