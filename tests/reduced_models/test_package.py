"""What the package promises as a whole."""

import ast
import importlib
from pathlib import Path

import pytest

import reduced_models

FOLDER = Path(reduced_models.__file__).parent
ROOMS = sorted(path.parent.name for path in FOLDER.glob("*/__init__.py"))
# What `ehlcontact` shows, and its ground floor.
ALLOWED = {
    "ehlcontact",
    *(
        f"ehlcontact.{name}"
        for name in ("checks", "errors", "files", "formulas", "hertz", "jit", "origin", "point")
    ),
}


def listed(module):
    """First column of the table in a docstring."""
    rows = [line.split("|")[1] for line in module.__doc__.splitlines() if line.startswith("| ")]
    return {name.strip() for row in rows for name in row.split(",")}


def test_public_names_are_there():
    for name in (
        "ContactRecord", "fit", "fit_memory", "sensitivity", "FitResult", "MemoryFit", "ElementFit",
        "LinearContact", "CubicContact", "PolynomialContact", "PowerLawContact", "FilmMemoryContact",
        "WideRangeContact", "wide_range_contact", "wide_range_from_solves",
        "load_element", "ContactElement", "OutsideValidityWarning",
        "JeffcottRotor", "ContactMount", "RotorState", "RotorResult", "RotorStatus", "simulate_rotor", "compare",
        "simulate_oscillator", "ScaledContact", "Atlas", "AtlasAnswer",
    ):  # fmt: skip
        assert hasattr(reduced_models, name)


def test_the_table_lists_every_room():
    assert set(ROOMS) == listed(reduced_models) - {"room"}
    assert {path.name for path in FOLDER.glob("*.py")} == {"__init__.py"}


@pytest.mark.parametrize("room", ROOMS)
def test_every_room_opens_with_a_table_of_its_files(room):
    files = {path.stem for path in (FOLDER / room).glob("*.py")} - {"__init__"}
    assert files == listed(importlib.import_module(f"reduced_models.{room}")) - {"module"}


@pytest.mark.parametrize("room", ROOMS)
def test_only_public_names_of_ehlcontact_are_used(room):
    for path in (FOLDER / room).glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(("ehlcontact", "fmu")):
                assert node.module in ALLOWED, path.name
