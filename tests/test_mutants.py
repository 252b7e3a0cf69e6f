"""The runner of mutants on a tree of its own, its table against this tree, and, slow, what the tests are worth."""

import ast
import re
import threading
from dataclasses import replace
from pathlib import Path

import mutants
import pytest
from mutants import Mutant, MutantError, Outcome

ROOMS = (
    "ehlcontact/lubricant",
    "ehlcontact/hertz.py",
    "ehlcontact/formulas.py",
    "ehlcontact/solver/kernels",
    "ehlcontact/transient",
    "ehlcontact/impedance.py",
    "ehlcontact/assumptions",
    "ehlcontact/checks",
    "ehlcontact/files",
    "reduced_models/fitting",
    "reduced_models/elements",
    "reduced_models/atlas",
    "reduced_models/rotor",
    "ehlcontact/cli/plots",
    "ehlcontact/cli/study",
    "ehlcontact/cli/templates",
    "ehlcontact/cli/paper",
    "fmu/binaries",
    "fmu/gate.py",
    "fmu/spec.py",
    "fmu/spring.py",
    "fmu/c_headers.py",
    "fmu/comparison.py",
    "fmu/verify.py",
    "fmu/gate.py",
    "fmu/export.py",
    "fmu/binaries",
    "fmu/csrc/core",
    "fmu/csrc/models",
    "fmu/csrc/glue2",
    "fmu/csrc/glue3",
)
OF_THE_ISSUE = {  # those that once survived
    "si-tangent-column",
    "caption-in-khz",
    "spectrum-amplitude",
    "work-per-cycle",
    "oil-bar",
    "correlation-sum",
}
HALF = Mutant("half", "fmu/sums.py", "(a + b) / 2", "(a + b) / 3", ("fmu/test_sums.py",))
NOBODY_LOOKS = Mutant("order", "fmu/sums.py", "a + b", "b + a", ("fmu/test_sums.py",))


@pytest.fixture
def tree(tmp_path):
    """A library of one function, and its test."""
    root = tmp_path / "checkout"
    (root / "fmu").mkdir(parents=True)
    (root / "fmu" / "__init__.py").touch()  # else an installed package of that name would be found
    (root / "fmu" / "sums.py").write_text("def mean(a, b):\n    return (a + b) / 2\n")
    (root / "tests" / "fmu").mkdir(parents=True)
    (root / "tests" / "fmu" / "test_sums.py").write_text(
        "from fmu.sums import mean\n\n\ndef test_mean():\n    assert mean(1.0, 3.0) == 2.0\n"
    )
    return root


def state(root):
    return {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in root.rglob("*") if path.is_file()}


def test_one_is_caught_and_one_survives(tree):
    """In the order of the table, whoever was first; and nobody has touched the checkout."""
    before, told = state(tree), []
    outcomes = mutants.run([NOBODY_LOOKS, HALF], root=tree, jobs=2, suite=True, tell=told.append)
    assert [(o.name, o.by) for o in outcomes] == [("order", None), ("half", "fmu/test_sums.py::test_mean")]
    assert state(tree) == before
    assert len(told) == 4 and any("[2/2]" in line and "0 min left" in line for line in told)
    table = mutants.table_of(outcomes).splitlines()
    assert table[0].split() == ["half", "fmu/sums.py", "fmu/test_sums.py::test_mean"]
    assert table[1].split() == ["order", "fmu/sums.py", "SURVIVED"] and table[2] == "caught 1 of 2"
    assert not mutants.enough(outcomes) and mutants.enough(outcomes[1:]) and not mutants.enough([])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"old": "a + c"}, ("half", "'a + c'", "0 times", "fmu/sums.py")),
        ({"old": "a"}, ("half", "times", "must be once")),
        ({"file": "fmu/products.py"}, ("half", "no file fmu/products.py")),
        ({"tests": ("fmu/test_products.py",)}, ("half", "no tests/fmu/test_products.py")),
        ({"tests": ("fmu/test_sums.py::test_median",)}, ("did not run", "test_median")),
    ],
)
def test_a_table_that_does_not_fit_is_told(tree, change, words):
    with pytest.raises(MutantError) as told:
        mutants.run([replace(HALF, **change)], root=tree)
    assert all(word in str(told.value) for word in words)


def test_tests_that_fail_anyway_are_told(tree):
    (tree / "fmu" / "sums.py").write_text("def mean(a, b):\n    return 0 * (a + b) / 2\n")
    with pytest.raises(MutantError, match="test_mean fails without any mutant"):
        mutants.run([HALF], root=tree)


def test_what_does_not_end_is_seen(tree, monkeypatch):
    endless = replace(HALF, old="return (a", new="while True:\n        pass\n    return (a")
    tests = mutants.Tests(mutants.copy_tree(tree, tree.parent / "copy"), threading.Event())
    monkeypatch.setattr(mutants, "PATIENCE", 2.0)
    assert mutants.tried(endless, tests, suite=False).by == "time ran out"


def test_ctrl_c_keeps_what_is_known(tree):
    def press(line):
        if line.startswith("[1/2]"):
            raise KeyboardInterrupt

    outcomes = mutants.run([HALF, NOBODY_LOOKS], root=tree, tell=press)
    assert [outcome.name for outcome in outcomes] == ["half"]


def test_names_and_outcomes_on_the_command_line(capsys, monkeypatch, tmp_path):
    found = [Outcome("oil-bar", "reduced_models/atlas/atlas.py", "test", 1.0)]
    monkeypatch.setattr(mutants, "run", lambda chosen, **_: found if len(chosen) == 1 else [])
    assert mutants.main(["--only", "oil-bar", "--json", str(tmp_path / "out.json")]) == 0
    assert '"by": "test"' in (tmp_path / "out.json").read_text()
    assert capsys.readouterr().out.endswith("caught 1 of 1\n")
    assert mutants.main([]) == 1  # interrupted before the first
    with pytest.raises(SystemExit) as stop:
        mutants.main(["--only", "unheard-of"])
    assert stop.value.code == 2


def test_the_table_fits_the_tree():
    """Every text stands there once, every mutant of Python is other code, and every test has its name."""
    table = mutants.read_table()
    assert len({mutant.name for mutant in table}) == len(table) >= 40
    assert {mutant.name for mutant in table} >= OF_THE_ISSUE
    assert [room for room in ROOMS if not any(mutant.file.startswith(room) for mutant in table)] == []
    for mutant in table:
        path, changed = mutants.ROOT / mutant.file, mutant.made_in(mutants.ROOT)
        if path.suffix == ".py":
            assert ast.dump(ast.parse(changed)) != ast.dump(ast.parse(path.read_text())), mutant.name
        for test in mutant.paths(mutants.ROOT):
            file, _, name = test.partition("::")
            assert re.search(rf"^def {name or 'test'}", (mutants.ROOT / file).read_text(), flags=re.M), test


def test_files_of_kernels_are_told():
    table = {mutant.name: mutant for mutant in mutants.read_table()}
    assert table["squeeze-sign"].changes_a_kernel(mutants.ROOT)
    assert table["density-slope"].changes_a_kernel(mutants.ROOT)
    assert not table["oil-bar"].changes_a_kernel(mutants.ROOT)
    assert not table["c-clip"].changes_a_kernel(mutants.ROOT)
    assert {mutant.suite for mutant in table.values()} <= {str(Path(folder)) for folder in mutants.SUITES.values()}


@pytest.mark.slow
def test_nearly_all_are_caught():
    """Some ten minutes."""
    outcomes = mutants.run(mutants.read_table(), jobs=2)
    assert mutants.enough(outcomes), mutants.table_of(outcomes)
    survived = {outcome.name for outcome in outcomes if outcome.by is None}
    assert not survived & OF_THE_ISSUE
