"""What tables of all recipes have in common: sample, build, file, interpolation; each recipe's own is beside."""

import json
from dataclasses import asdict, replace

import atlas_stub
import numpy as np
import pytest

from ehlcontact import ConvergenceError, InputError, __version__, read, save
from ehlcontact.cli.app import execute
from reduced_models.atlas.build import assemble, build
from reduced_models.atlas.recipe import entry_of
from reduced_models.atlas.surface import Surface, opened, shipped, shipped_file
from reduced_models.atlas.table import RECIPES, Table, recipe_named

ENOUGH = {"film": (24, 24), "supply": (48,), "heat": (64,), "waves": (40,)}  # draws of a small table
SIZE = {"film": 520_000, "supply": 56_500, "heat": 24_000, "waves": 22_000}  # bytes of the files of the library
POINTS = {"film": 500, "supply": 90, "heat": 140, "waves": 70}

pytestmark = pytest.mark.parametrize("recipe", RECIPES)


def small(recipe, seed=3):
    """Table of a small sample of the stand-in."""
    return assemble(recipe, atlas_stub.entries(recipe, *ENOUGH[recipe], seed), {"command": "c", "version": "0"})


def test_more_draws_add_to_the_fewer(recipe):
    kind, (first, *others) = recipe_named(recipe), ENOUGH[recipe]
    few, many = kind.sample(first, *others, 3), kind.sample(2 * first, *others, 3)
    assert few.items() <= many.items() and len(many) > len(few)
    assert few.items() != kind.sample(first, *others, 4).items()


def test_built_by_the_command_from_solved_points(recipe, tmp_path, capsys):
    """Nothing is left to solve, so the table comes at once; its own command is inside."""
    work, output, kind = tmp_path / "work", tmp_path / "t.h5", recipe_named(recipe)
    atlas_stub.prefill(recipe, work, *ENOUGH[recipe], 5)
    names = dict(zip([name for name in kind.numbers if name != "seed"], ENOUGH[recipe], strict=True))
    numbers = [f"--{name.replace('_', '-')} {value}" for name, value in names.items()]
    options = ["--recipe", recipe, *" ".join(numbers).split(), "--seed", "5"]
    assert execute(["atlas", "build", *options, "-o", str(output), "--work", str(work), "--json", "-"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["command"] == f"ehlcontact atlas build --recipe {recipe} {' '.join(numbers)} --seed 5"
    table, wanted = read(output, Table), small(recipe, seed=5)
    assert len(table.points) == document["points"] >= 20
    np.testing.assert_array_equal(table.points, wanted.points)
    for name, column in table.columns.items():
        assert column.dtype == np.float32
        np.testing.assert_allclose(column, wanted[name], rtol=1e-3 if recipe == "supply" else 1e-6, atol=1e-7)
    assert opened(output, recipe).table.metadata == table.metadata


def test_too_few_points_make_no_table(recipe, tmp_path):
    things = recipe_named(recipe).things
    with pytest.raises(InputError, match=rf"^{things} = .*at least 20; draws = 4 .*have too few"):
        build(
            recipe,
            tmp_path / "t.h5",
            tmp_path / "work",
            {"draws": 4, **({"light_draws": 4} if recipe == "film" else {})},
        )
    entries = [entry | {"status": "stagnated"} for entry in atlas_stub.entries(recipe, *ENOUGH[recipe], 3)]
    with pytest.raises(InputError, match=rf"^converged {things} = 0: must be at least 20 \(more draws\)"):
        assemble(recipe, entries, {})
    with pytest.raises(InputError, match=rf"^dots = 4: must be left out with recipe '{recipe}'"):
        build(recipe, tmp_path / "t.h5", tmp_path / "work", {"dots": 4})
    assert not list(tmp_path.iterdir())


def test_points_that_do_not_converge_are_left_out(recipe):
    entries = atlas_stub.entries(recipe, *ENOUGH[recipe], 3)
    good = sum(entry["status"] == "converged" for entry in entries)
    last = next(entry for entry in reversed(entries) if entry["status"] == "converged")
    table = assemble(
        recipe, [entry for entry in entries if entry is not last] + [last | {"status": "diverged"}], {}
    )
    assert len(table.points) == table.metadata["points"] == good - 1
    assert table.metadata["left_out"]["diverged"] == 1
    assert sum(table.metadata["left_out"].values()) == len(entries) - good + 1


def test_a_failed_solve_has_a_status(recipe):
    @entry_of
    def fail(_):
        raise ConvergenceError(recipe, None)

    assert fail(None)["status"] == "unknown"


def test_surface_goes_through_its_points(recipe):
    """Answers at the points of a table are those that its smooth variables are turned back to."""
    table, kind = small(recipe), recipe_named(recipe)
    places = table.points
    if recipe == "supply":
        places = np.column_stack([places, np.full(len(places), table["ratios"][4])])
    unit = kind.unit(table, places)
    smooth = kind.smooth(table, unit)
    wanted, _ = kind.values(table, places, unit, smooth, np.zeros_like(kind.sizes(smooth)))
    values, bars = Surface(table).at(places)
    np.testing.assert_allclose(values, wanted, rtol=1e-7, atol=1e-9)
    assert bars.shape == values.shape and np.all(bars >= 0.0) and (bars.max() > 0.0)


def test_shipped_file_is_small_and_says_how_it_was_made(recipe):
    table, kind = shipped(recipe).table, recipe_named(recipe)
    assert shipped_file(recipe).stat().st_size < SIZE[recipe]
    about = table.metadata
    assert about["command"].startswith(f"ehlcontact atlas build --recipe {recipe} --draws")
    assert about["version"] == __version__ and about["points"] == len(table.points) > POINTS[recipe]
    assert about["interpolation"] == json.loads(json.dumps(asdict(kind.interpolation)))
    assert sum(about["meshes"].values()) == about["points"]
    assert kind.box is None or table.box == kind.box
    json.dumps(about, allow_nan=False)
    for name, array in table.columns.items():
        np.testing.assert_array_equal(table.rounded().columns[name], array)


def test_damaged_tables_are_refused(recipe, tmp_path):
    table, path = shipped(recipe).table, tmp_path / "t.h5"
    arrays = table.axes | table.columns
    for name in arrays:
        for wrong in (arrays[name][..., :-1], arrays[name] * np.nan):
            part = "axes" if name in table.axes else "columns"
            save(replace(table, **{part: getattr(table, part) | {name: wrong}}), path)
            with pytest.raises(InputError, match="complete file of a table of an atlas"):
                opened(path, recipe)
    for name in table.columns:
        columns = {other: array for other, array in table.columns.items() if other != name}
        save(replace(table, columns=columns), path)
        with pytest.raises(InputError, match="complete file of a table of an atlas"):
            opened(path, recipe)
    for changed in (replace(table, points=table.points[:-1]), replace(table, recipe="sofa")):
        save(changed, path)
        with pytest.raises(InputError, match="complete file of a table of an atlas"):
            opened(path, recipe)


def test_a_table_of_another_recipe_is_named(recipe):
    other = "supply" if recipe == "film" else "film"
    with pytest.raises(InputError, match=f"a table of an atlas of recipe '{other}', not '{recipe}'"):
        opened(shipped_file(recipe), other)
