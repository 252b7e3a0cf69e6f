"""The page of validation is what its script makes of the stored numbers, which `tests/golden` compares."""

import json
import re

import pytest
from page_blocks import ROOT
from programs import script


@pytest.fixture(scope="module")
def validation():
    return script("docs/site/validation.py")


@pytest.fixture(scope="module")
def data(validation):
    return json.loads(validation.GOLDEN.read_text(encoding="utf-8"))["validation"]


def test_page_is_made_from_the_measured(validation):
    """`python docs/site/validation.py` makes it."""
    assert validation.PAGE.read_text(encoding="utf-8") == validation.page()


def test_every_section_has_its_test(validation):
    for section in validation.SECTIONS.values():
        assert (validation.ROOT / section.held_by).is_file()
        assert len(section.measure.__doc__.splitlines()) > 2


def test_published_numbers_are_those_of_the_tests(validation, data):
    """They stand once: what a test is changed to is seen here."""
    tests = validation.module(validation.FILMS)
    tables = [r for k in range(1, 7) for r in data[f"table {k}"]]
    found = {(r["case"], r["quantity"]): r["theirs"] for r in tables}
    cases = {f"Table {name.replace('.', ', case ')}": printed for name, (_, printed) in tests.CUBICS.items()}
    for case, (k1, k2, k3, c1) in (cases | {"Table 6": tests.RAMP_CUBIC}).items():
        root, tangent = tests.oracles.spring_root_and_tangent(k1, k2, k3)
        assert [found[case, name] for name in ("K1", "K2", "K3", "C1")] == [k1, k2, k3, c1]
        assert found[case, "approach at load 1"] == pytest.approx(root, rel=1e-12)
        assert found[case, "tangent there"] == pytest.approx(tangent, rel=1e-12)
    for name, (_, (k1, c1)) in tests.LINEAR.items():
        case = f"Table {name.replace('.', ', case ')}"
        assert found[case, "K1"] == k1 and c1 in (None, found[case, "C1"])
    approaches = {row[-1] for row in tests.PUBLIC.values()} | {0.8700}
    assert approaches == {r["theirs"] for r in data["solvers"] if r["quantity"] == "approach"}


def test_differences_are_of_the_right_sign(validation):
    row = {"case": "a", "quantity": "b", "ours": 1.1, "theirs": 1.0}
    assert "+10.00\u00a0%" in validation.cells(row)
    assert validation.table([row, row | {"case": "c", "ours": 0.8}]).endswith("Farthest off: b of c, -20.00 %.")
    assert validation.cells(row | {"theirs": 0.0}) == "| a | b | 1.1e+00 |"
    assert validation.cells(row | {"reason": "mesh"}).endswith("+10.00\u00a0% | mesh |")
    assert "30 times" in validation.cells(row | {"ours": 30.0})


def test_every_difference_from_the_paper_has_a_reason(data):
    for section in (*(f"table {k}" for k in range(1, 7)), "figures"):
        assert data[section] and all(row["reason"] for row in data[section])
    unexplained = [(r["case"], r["quantity"]) for r in data["table 1"] if r["reason"] == "not explained"]
    assert ("Table 1, case 3", "C1") in unexplained and len(unexplained) == 4


def test_the_page_for_users_has_the_largest_differences(data):
    """Each number of its table is the largest difference of the rows that it stands for, rounded."""
    text = (ROOT / "docs" / "validation.md").read_text(encoding="utf-8")
    told = {
        cells[1]: re.findall(r"[\d.]+(?= %)", cells[2])
        for cells in re.findall(r"^\| (.*) \| (.*) \| (.*) \|$", text, re.M)
    }

    def largest(sections, quantity, case=""):
        rows = [r for name in sections for r in data[name] if case in r["case"] and quantity in r["quantity"]]
        return 100.0 * max(abs(r["ours"] / r["theirs"] - 1.0) for r in rows)

    cubics, harris = ("table 3", "table 5", "table 6"), ("deflection", "load of ball")
    dry = [r for r in data["bearings"] if "Harris" not in r["case"]]
    expected = {
        "central film, Barus oil": [largest(["solvers"], "central film")],
        "smallest film": [largest(["solvers"], "smallest film"), largest(["solvers"], "smallest film", "n = 256")],
        "approach": [largest(["formulas"], "approach")],
        "central film, incompressible": [largest(["formulas"], "central film")],
        "cubics: approach at the load, tangent, C1": [
            largest(cubics, name) for name in ("approach", "tangent", "C1")
        ],
        "deflection, stiffness": [
            100.0 * max(abs(r["ours"] / r["theirs"] - 1.0) for r in dry if name in r["quantity"])
            for name in ("deflection", "stiffness")
        ],
        "deflection and ball loads of a 209": [max(largest(["bearings"], name, "Harris") for name in harris)],
    }
    for what, values in expected.items():
        rounded = [f"{x:.{len(said.partition('.')[2])}f}" for x, said in zip(values, told[what], strict=True)]
        assert told[what] == rounded, what
    assert max(r["ours"] for r in data["fmus"]) == pytest.approx(2.4e-14, rel=0.02)
