"""What is wrong with a study file, in one line: the entry, what it may be, and what was probably meant."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from reprlib import repr as shortened
from typing import TYPE_CHECKING, Any, get_args

from ehlcontact.checks.admissible_range import INPUTS, Given, Quantity
from ehlcontact.errors import InputError

if TYPE_CHECKING:
    from pydantic import BaseModel, ValidationError

# Entries whose values set the operating point, in the units of the file.
QUANTITIES = {
    "bearing.ball_diameter_mm": INPUTS["ball_diameter"].in_unit("mm"),
    "bearing.pitch_diameter_mm": INPUTS["pitch_diameter"].in_unit("mm"),
    "bearing.conformity": INPUTS["conformity"],
    "bearing.youngs_modulus": INPUTS["e1"],
    "bearing.radial_load": INPUTS["load"],
    "bearing.speed_rpm": INPUTS["speed_rpm"],
    "oil.eta0": INPUTS["eta0"],
    "oil.alpha": INPUTS["alpha"],
}
# Those of the rotor: from a watch's balance to a power station's turbine.
ROTOR = {
    "rotor.disc_mass": Quantity("kg", (1e-6, 1e6), (1e-3, 1e5), {"g": 1e-3, "t": 1e3}),
    "rotor.journal_mass": Quantity("kg", (1e-6, 1e6), (1e-3, 1e5), {"g": 1e-3, "t": 1e3}),
    "rotor.shaft_stiffness": Quantity("N/m", (1.0, 1e13), (1e4, 1e10), {"N/mm": 1e3, "N/um": 1e6}),
    "rotor.unbalance": Quantity("kg m", (1e-15, 1e4), (1e-8, 1e-3), {"kg mm": 1e-3, "g mm": 1e-6}),
}
SIZED = {**QUANTITIES, **ROTOR}
# What a name of the catalogue gives.
DIMENSIONS = ("bearing.balls", "bearing.ball_diameter_mm", "bearing.pitch_diameter_mm", "bearing.conformity")
BY_NAME = ', or catalogue = "6205" in place of all dimensions'
# Names from before frequencies carried their unit: omega is in rad/s now, so they are not taken silently.
RENAMED = {"free.omega_n": "Omega_n", "harmonic.omega": "Omega"}
# Where pydantic speaks of Python: what TOML calls it.
RANGE = ("greater_than", "greater_than_equal", "less_than", "less_than_equal", "multiple_of")
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


def inputs_of(study: BaseModel, quantities: Mapping[str, Quantity] = QUANTITIES) -> Given:
    """Entries of a study that set its operating point; an oil given by its grade has no eta0 of its own."""
    entries = {
        name: (getattr(getattr(study, section), key), quantity)
        for name, quantity in quantities.items()
        for section, key in [name.split(".")]
    }
    return {name: (value, quantity) for name, (value, quantity) in entries.items() if value is not None}


def first_error(error: ValidationError, study: type[BaseModel]) -> InputError:
    """The first error of a file; a key that is not known before one that is missing, for they may be one slip."""
    errors = error.errors(include_url=False, include_context=False)
    first = next((e for e in errors if e["type"] == "extra_forbidden"), errors[0])
    loc, value = first["loc"], first["input"]
    field = ".".join(str(part) for part in loc) or "study"
    if field in RENAMED:
        allowed = f"given as {RENAMED[field]} (dimensionless, the same number) or as hz"
    elif first["type"] == "extra_forbidden":
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
        if first["type"] in RANGE:
            allowed = range_of(study, field) or allowed
            guess = SIZED[field].slip(value) if field in SIZED else ""
            allowed += f" ({guess})" if guess else ""
    return InputError(field, _brief(value), allowed)


def in_other_kind(
    error: InputError, document: Mapping[str, Any], sections: tuple[str, ...], command: str
) -> InputError:
    """An error of a file that has sections of the other kind of file: told which command reads that kind."""
    if not any(name in document for name in sections):
        return error
    allowed = f"{error.allowed}; or is this a file for `ehlcontact {command}`?"
    return InputError(error.field, error.value, allowed)


def range_of(study: type[BaseModel], field: str) -> str:
    """All that an entry may be, not only the end that it went beyond; empty where the schema does not say."""
    if field in SIZED:
        ends = SIZED[field].limits
        return f"between {ends[0]:g} and {ends[1]:g} {SIZED[field].unit}".rstrip()
    section, _, key = field.partition(".")
    entry = getattr(study.model_fields[section].annotation, "model_fields", {}).get(key)
    bounds: dict[str, Any] = {}
    for rule in _rules(entry):
        bounds |= {
            end: getattr(rule, end) for end in ("ge", "gt", "le", "lt", "multiple_of") if hasattr(rule, end)
        }
    low, high = bounds.get("ge", bounds.get("gt")), bounds.get("le", bounds.get("lt"))
    kind = f"a multiple of {bounds['multiple_of']} " if "multiple_of" in bounds else ""
    if low is None:
        return ""
    if high is None:
        return f"a finite number {'>' if 'gt' in bounds else '>='} {low:g}"
    return f"above {low:g} and below {high:g}" if "gt" in bounds else f"{kind}between {low:g} and {high:g}"


def _rules(entry: Any) -> Iterator[Any]:
    """Rules of an entry of the schema, also of one that may be left out."""
    yield from getattr(entry, "metadata", ())
    for choice in get_args(getattr(entry, "annotation", None)):
        for rule in get_args(choice)[1:]:
            yield from getattr(rule, "metadata", (rule,))


def _known_instead(study: type[BaseModel], loc: tuple[int | str, ...]) -> str:
    """The key that an unknown one resembles, the section it belongs to, or all keys of its own."""
    sections = {name: field.annotation for name, field in study.model_fields.items() if _keys(field.annotation)}
    key = str(loc[-1])
    own = list(study.model_fields) if len(loc) == 1 else _keys(sections[str(loc[0])])
    close = get_close_matches(key, own, 1) or [name for name in own if key in name.split("_")]
    at_home = [name for name, model in sections.items() if key in _keys(model)]
    hint = f"{close[0]}? " if close else f"it belongs to [{at_home[0]}]; " if at_home else ""
    return f"{hint}known here: {', '.join(own)}"


def _keys(model: Any) -> list[str]:
    return list(getattr(model, "model_fields", ()))


def broken_line(text: str, error: Exception) -> str:
    """Why it is no TOML, and the line that the parser points to."""
    if isinstance(error, RecursionError):
        return "nested too deeply"
    if isinstance(error, UnicodeDecodeError):
        return "text in UTF-8, which this is not"
    reason = str(error)
    found = re.search(r"at line (\d+)", reason)
    lines = text.splitlines()
    line = lines[int(found[1]) - 1].strip() if found and int(found[1]) <= len(lines) else ""
    return f"{reason}: {shortened(line)}" if line else reason


def _brief(value: Any) -> Any:
    """A value that fits into a line."""
    return value if value is None or isinstance(value, bool | float) else _Shown(shortened(value))


class _Shown(str):
    """Text that stands for a value: shown without quotes of its own."""

    __slots__ = ()

    def __repr__(self) -> str:
        return str(self)
