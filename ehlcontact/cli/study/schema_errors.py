"""Errors of study files and options in one line: the entry, its allowed range, and what was probably meant."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from reprlib import repr as shortened
from typing import TYPE_CHECKING, Any

from ehlcontact.checks.admissible_range import Given
from ehlcontact.cli.entries import allowed_of, field_of, keys_of, quantity_of
from ehlcontact.errors import InputError

if TYPE_CHECKING:
    from pydantic import BaseModel, ValidationError

# What a name of the catalogue gives.
DIMENSIONS = ("bearing.balls", "bearing.ball_diameter_mm", "bearing.pitch_diameter_mm", "bearing.conformity")
BY_NAME = ', or catalogue = "6205" in place of all dimensions'
# Where pydantic speaks of Python: what TOML calls it.
RANGE = ("limits", "greater_than", "greater_than_equal", "less_than", "less_than_equal", "multiple_of")
LIST = "a list of three numbers"
SEVERAL = ("bearing.speed_rpm", "bearing.radial_load")  # may be lists, which other commands do not take
PLAIN_WORDS = {
    "float_type": "a number (true or quoted text is none)",
    "int_type": "a whole number (9, not 9.0, true or quoted text)",
    "string_type": "text in quotes",
    "model_type": "a section, written [{field}]",
    "tuple_type": LIST,
    "list_type": "a list of numbers, as [1000, 3000]",
    "too_long": LIST,
}


def inputs_of(study: BaseModel) -> Given:
    """Entries that set the operating point and have a unit; an oil given by its grade has no eta0 of its own."""
    found = {}
    for name in ("bearing", "oil"):
        section = getattr(study, name)
        for key, field in keys_of(type(section)).items():
            quantity, value = quantity_of(field), getattr(section, key)
            if quantity is not None and value is not None:
                found[f"{name}.{key}"] = value, quantity
    return found


def first_error(error: ValidationError, study: type[BaseModel]) -> InputError:
    """The first error of a file; a key that is not known before one that is missing, for they may be one slip."""
    errors = error.errors(include_url=False, include_context=False)
    first = next((e for e in errors if e["type"] == "extra_forbidden"), errors[0])
    value = first["input"]
    # of an entry of several types, pydantic names the type that was tried
    loc = tuple(part for part in first["loc"] if part not in ("float", "str"))
    field = ".".join(str(part) for part in loc) or "study"
    if first["type"] == "extra_forbidden":
        allowed = "left out; " + _known_instead(study, loc)
    elif first["type"] == "missing" and isinstance(loc[-1], int):
        field, allowed = ".".join(str(part) for part in loc[:-1]), LIST
    elif first["type"] == "missing":
        value, allowed = None, "given" + (BY_NAME if field in DIMENSIONS else "")
    elif isinstance(value, list) and field in SEVERAL:
        allowed = "one number here; a list is for `ehlcontact run` and `validate`"
    else:
        allowed = first["msg"].removeprefix("Input should be ").removeprefix("Value error, ")
        allowed = PLAIN_WORDS.get(first["type"], allowed).format(field=field)
        declared = field_of(study, field)
        ends, quantity = allowed_of(declared), quantity_of(declared)
        if first["type"] in RANGE:
            guess = "" if quantity is None else quantity.slip(value)
            allowed = (ends or allowed) + (f" ({guess})" if guess else "")
        elif first["type"] == "finite_number" and ends:
            allowed = ends if ends.startswith(allowed) else f"{allowed}, {ends}"
    return InputError(field, _brief(value), allowed)


def in_other_kind(
    error: InputError, document: Mapping[str, Any], sections: tuple[str, ...], command: str
) -> InputError:
    """The error, with the command for the other kind of file where the file has sections of that kind."""
    if not any(name in document for name in sections):
        return error
    allowed = f"{error.allowed}; or is this a file for `ehlcontact {command}`?"
    return InputError(error.field, error.value, allowed)


def _known_instead(study: type[BaseModel], loc: tuple[int | str, ...]) -> str:
    """The key that an unknown one resembles, the section it belongs to, or all keys of its own."""
    sections = {name: field.annotation for name, field in study.model_fields.items() if keys_of(field.annotation)}
    key = str(loc[-1])
    own = list(study.model_fields) if len(loc) == 1 else list(keys_of(sections[str(loc[0])]))
    close = get_close_matches(key, own, 1) or [name for name in own if key in name.split("_")]
    at_home = [name for name, model in sections.items() if key in keys_of(model)]
    hint = f"{close[0]}? " if close else f"it belongs to [{at_home[0]}]; " if at_home else ""
    return f"{hint}known here: {', '.join(own)}"


def _brief(value: Any) -> Any:
    """A value that fits into a line."""
    return value if value is None or isinstance(value, bool | float) else _Shown(shortened(value))


class _Shown(str):
    """Text that stands for a value: shown without quotes of its own."""

    __slots__ = ()

    def __repr__(self) -> str:
        return str(self)
