"""Errors of study files and options in one line: the entry, its allowed range, and what was probably meant."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from reprlib import repr as shortened
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from ehlcontact.checks.admissible_range import Given
from ehlcontact.cli.entries import allowed_of, field_of, is_several, keys_of, quantity_of, section_of
from ehlcontact.cli.toml import number_in_text
from ehlcontact.errors import InputError

if TYPE_CHECKING:
    from pydantic import BaseModel, ValidationError

# Sections of another kind of file, and what stands for each in a study.
REPLACED = {
    "bearing": "[[support]] for the bearing, [operation] for its load and speed, [contact] for the race",
    "rotor": "[shaft], [[disc]] and [[support]], or [full_films] for a rotor on computed films",
    "whole_bearing": "[[support]] for clearance, angle and pair, [operation] for loads, layer and heat, [in_time],"
    " [[defect]]",
    "solver": "[contact] for n, n_transient and domain",
    "free": "[contact.free]",
    "harmonic": "[contact.harmonic]",
    "check": "half_step in [full_films]",
    "pair": "pair, preload and distance_mm in [[support]]",
}
# Where pydantic speaks of Python: what TOML calls it.
RANGE = ("limits", "greater_than", "greater_than_equal", "less_than", "less_than_equal", "multiple_of")
ONE = ("float_type", "int_type", "string_type", "literal_error", "bool_type")  # of what is one value
LIST = "a list of three numbers"
PLAIN_WORDS = {
    "float_type": "a number (true or quoted text is none)",
    "int_type": "a whole number (9, not 9.0, true or quoted text)",
    "string_type": "text in quotes",
    "model_type": "a section, written [{field}]",
    "dict_type": "a section, written [{field}]",
    "tuple_type": LIST,
    "list_type": "a list of numbers, as [1000, 3000]",
    "too_long": LIST,
}


def names_of(given: Sequence[str | None]) -> tuple[str, ...]:
    """Names of supports: their own; left and right of two; else by their number."""
    usual = ("left", "right") if len(given) == len(("left", "right")) else [str(k + 1) for k in range(len(given))]
    return tuple(name or word for name, word in zip(given, usual, strict=True))


def require_sections(document: Mapping[str, Any]) -> None:
    """Raise `InputError` for a file with sections that are none of a study, with what stands in their place."""
    if found := [name for name in REPLACED if name in document]:
        places = "; ".join(f"{REPLACED[name]} in place of [{name}]" for name in found)
        raise InputError(", ".join(found), _Shown("..."), f"left out: {places}")


def inputs_of(sections: Mapping[str, BaseModel | None]) -> Given:
    """Entries that have a unit, by their names; an oil given by its grade has no eta0 of its own.

    Parameters
    ----------
    sections : mapping
        Sections by what their entries' names begin with.
    """
    found = {}
    for name, section in sections.items():
        for key, field in keys_of(type(section)).items():
            quantity, value = quantity_of(field), getattr(section, key)
            if quantity is not None and isinstance(value, float | int):  # a clearance may be a class
                found[f"{name}.{key}"] = value, quantity
    return found


def first_error(
    error: ValidationError, study: type[BaseModel], document: Mapping[str, Any] = MappingProxyType({})
) -> InputError:
    """The first error of a file; a key that is not known before one that is missing, for they may be one slip.

    Tables that the file has several of are told by their names, or by their numbers.
    """
    errors = error.errors(include_url=False, include_context=False)
    first = next((e for e in errors if e["type"] == "extra_forbidden"), errors[0])
    value = first["input"]
    # of an entry of several types, pydantic names the type that was tried
    loc = tuple(part for part in first["loc"] if not str(part).startswith(("float", "str", "function-")))
    field = entry_name(loc, study, document)
    if first["type"] == "extra_forbidden":
        allowed = "left out; " + _known_instead(study, loc)
    elif first["type"] == "missing" and isinstance(loc[-1], int):
        field, allowed = ".".join(str(part) for part in loc[:-1]), LIST
    elif first["type"] == "missing":
        value, allowed = None, "given"
    elif first["type"] in ("tuple_type", "too_short") and is_several(
        getattr(field_of(study, field), "annotation", None)
    ):
        allowed = f"a section, written [[{field}]]"
    elif isinstance(value, list) and "." in field and isinstance(loc[-1], str) and first["type"] in ONE:
        allowed = "one value here; a list is for `ehlcontact run` and `validate`"
    else:
        allowed = first["msg"].removeprefix("Input should be ").removeprefix("Value error, ")
        allowed = PLAIN_WORDS.get(first["type"], allowed).format(field=field)
        declared = field_of(study, field)
        ends, quantity = allowed_of(declared), quantity_of(declared)
        if first["type"] in RANGE:
            guess = "" if quantity is None else quantity.slip(value)
            allowed = (ends or allowed) + (f" ({guess})" if guess else "")
        elif isinstance(value, str) and (number := number_in_text(value)):
            allowed = f"{allowed.partition(' (')[0]} ({number})"
        elif first["type"] == "finite_number" and ends:
            allowed = ends if ends.startswith(allowed) else f"{allowed}, {ends}"
    return InputError(field, brief(value), allowed)


def entry_name(loc: tuple[int | str, ...], study: type[BaseModel], document: Mapping[str, Any]) -> str:
    """Name of an entry in the file: a table of several by its own name, or by its number; the only one without."""
    parts = [str(part) for part in loc]
    if len(loc) > 1 and isinstance(loc[1], int) and is_several(study.model_fields[str(loc[0])].annotation):
        tables = document.get(str(loc[0]), [])
        if loc[0] == "support":
            given = [one.get("name") if isinstance(one, Mapping) else None for one in tables]
            words = names_of([name if isinstance(name, str) else None for name in given])
        else:
            words = tuple(str(k + 1) for k in range(len(tables)))
        parts[1:2] = [] if len(tables) == 1 else [words[loc[1]]]
    return ".".join(parts) or "study"


def _known_instead(study: type[BaseModel], loc: tuple[int | str, ...]) -> str:
    """The key that an unknown one resembles, the section it belongs to, or all keys of its own."""
    sections = _sections(study)
    key, *above = str(loc[-1]), *(str(part) for part in loc[:-1] if not isinstance(part, int))
    own = list(keys_of(sections[".".join(above)] if above else study))
    close = get_close_matches(key, own, 1) or [name for name in own if key in name.split("_")]
    at_home = [name for name, model in sections.items() if key in keys_of(model)]
    hint = f"{close[0]}? " if close else f"it belongs to {_head(study, at_home[0])}; " if at_home else ""
    return f"{hint}known here: {', '.join(own)}"


def _sections(model: type[BaseModel], above: str = "") -> dict[str, Any]:
    """Sections of a model, and those in them, by their names in the file."""
    found: dict[str, Any] = {}
    for name, field in model.model_fields.items():
        if (section := section_of(field.annotation)) is not None:
            found |= {f"{above}{name}": section} | _sections(section, f"{above}{name}.")
    return found


def _head(study: type[BaseModel], name: str) -> str:
    """A section as a file has it."""
    several = is_several(study.model_fields[name.partition(".")[0]].annotation)
    return f"[[{name}]]" if several else f"[{name}]"


def brief(value: Any) -> Any:
    """A value that fits into a line."""
    return value if value is None or isinstance(value, bool | float) else _Shown(shortened(value))


class _Shown(str):
    """Text that stands for a value: shown without quotes of its own."""

    __slots__ = ()

    def __repr__(self) -> str:
        return str(self)
