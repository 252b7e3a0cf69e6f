"""Rules of FMI for a model description, as fmpy has them, with names of variables that are checked fast."""

from __future__ import annotations

import re
from pathlib import Path
from zipfile import ZipFile

# The grammar of FMI 2.0.4 (section 2.2.9) and FMI 3.0.2 (2.4.7.5.1). fmpy's parser of it takes 3 ms a name.
_QUOTED = r"'(?:[A-Za-z_0-9!#$%&()*+,./:;<>=?@\[\]^{}|~ -]|\\['\"?\\abfnrtv])+'"
_PART = rf"(?:[A-Za-z_][A-Za-z_0-9]*|{_QUOTED})(?:\[[0-9]+(?:,[0-9]+)*\])?"
_NAME = re.compile(rf"{_PART}(?:\.{_PART})*|der\({_PART}(?:\.{_PART})*(?:,[0-9]+)?\)")


def findings(path: Path) -> tuple[str, ...]:
    """What an FMU, or its folder, has that FMI does not allow: `fmpy.validation.validate_fmu`, with fast names."""
    from fmpy import read_model_description
    from fmpy.model_description import ValidationError

    found = []
    if path.is_file():
        with ZipFile(path) as archive:
            found += [f"the path {name!r} has a backslash" for name in archive.namelist() if "\\" in name]
    try:
        described = read_model_description(str(path), validate=True, validate_model_structure=True)
    except ValidationError as error:
        return (*found, *error.problems)
    except Exception as error:
        return (*found, str(error))
    names = [one.name for one in described.modelVariables]
    if described.variableNamingConvention == "structured":
        found += [
            f"the name {name!r} is none of a structured variable" for name in names if not is_structured(name)
        ]
    return tuple(found)


def is_structured(name: str) -> bool:
    """Whether FMI allows a name where the naming convention is "structured"."""
    return _NAME.fullmatch(name) is not None
