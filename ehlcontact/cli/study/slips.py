"""What is wrong with a study file, in one line: the entry, what it may be, and what was probably meant."""

from __future__ import annotations

from difflib import get_close_matches
from pathlib import Path
from reprlib import repr as shortened
from typing import TYPE_CHECKING, Any

from ehlcontact.checks.box import INPUTS, Given
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
# Names from before frequencies carried their unit: omega is in rad/s now, so they are not taken silently.
RENAMED = {"free.omega_n": "Omega_n", "harmonic.omega": "Omega"}
# Where pydantic speaks of Python: what TOML calls it.
RANGE = ("greater_than", "greater_than_equal", "less_than", "less_than_equal")
LIST = "a list of three numbers"
PLAIN_WORDS = {
    "float_type": "a number (true or quoted text is none)",
    "model_type": "a section, written [{field}]",
    "tuple_type": LIST,
    "too_long": LIST,
}


def inputs_of(study: BaseModel) -> Given:
    """Entries of a study that set the operating point; an oil given by its grade has no eta0 of its own."""
    entries = {
        name: (getattr(getattr(study, section), key), quantity)
        for name, quantity in QUANTITIES.items()
        for section, key in [name.split(".")]
    }
    return {name: (value, quantity) for name, (value, quantity) in entries.items() if value is not None}


def first_error(path: Path, error: ValidationError, study: type[BaseModel]) -> InputError:
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
        value, allowed = None, "given"
    else:
        allowed = first["msg"].removeprefix("Input should be ").removeprefix("Value error, ")
        allowed = PLAIN_WORDS.get(first["type"], allowed).format(field=field)
        if field in QUANTITIES and first["type"] in RANGE:
            guess = QUANTITIES[field].slip(value)
            allowed += f" ({guess})" if guess else ""
    return InputError(f"{path}: {field}", _brief(value), allowed)


def _known_instead(study: type[BaseModel], loc: tuple[int | str, ...]) -> str:
    """The key that an unknown one resembles, the section it belongs to, or all keys of its own."""
    sections = {name: field.annotation for name, field in study.model_fields.items() if _keys(field.annotation)}
    key = str(loc[-1])
    own = list(study.model_fields) if len(loc) == 1 else _keys(sections[str(loc[0])])
    close = get_close_matches(key, own, 1)
    at_home = [name for name, model in sections.items() if key in _keys(model)]
    hint = f"{close[0]}? " if close else f"it belongs to [{at_home[0]}]; " if at_home else ""
    return f"{hint}known here: {', '.join(own)}"


def _keys(model: Any) -> list[str]:
    return list(getattr(model, "model_fields", ()))


def _brief(value: Any) -> Any:
    """A value that fits into a line."""
    return value if value is None or isinstance(value, bool | float) else _Shown(shortened(value))


class _Shown(str):
    """Text that stands for a value: shown without quotes of its own."""

    __slots__ = ()

    def __repr__(self) -> str:
        return str(self)
