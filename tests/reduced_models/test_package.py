"""What the package promises as a whole."""

import ast
from pathlib import Path

import reduced_models

FOLDER = Path(reduced_models.__file__).parent


def test_public_names_are_there_and_the_table_lists_every_module():
    for name in (
        "ContactRecord", "fit", "sensitivity",
        "LinearContact", "CubicContact", "PolynomialContact", "PowerLawContact",
        "load_element", "ContactElement", "OutsideValidityWarning",
        "JeffcottRotor", "simulate_rotor", "compare", "ScaledContact", "Atlas",
    ):  # fmt: skip
        assert hasattr(reduced_models, name)
    modules = {path.stem for path in FOLDER.glob("*.py")} - {"__init__"}
    rows = [line.split("|")[1] for line in reduced_models.__doc__.splitlines() if line.startswith("| ")]
    listed = {name.strip() for row in rows for name in row.split(",")}
    assert modules <= listed


def test_only_the_shared_parts_of_ehlcontact_are_used():
    # The first: its public face. The build of the atlas alone chooses meshes and reaches into the solver.
    allowed = {"ehlcontact", "ehlcontact.errors", "ehlcontact.point", "ehlcontact.hertz", "ehlcontact.formulas"}
    builders = {f"atlas_{name}" for name in ("sample", "solve", "build", "assemble")}
    for path in FOLDER.glob("*.py"):
        if path.stem in builders:
            continue
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(("ehlcontact", "fmu")):
                assert node.module in allowed, path.name
