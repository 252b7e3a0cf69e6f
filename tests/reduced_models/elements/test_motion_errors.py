"""Stated errors of wide-range elements by kind of motion, against the stored full solves."""

import importlib.util
import json
from pathlib import Path

import pytest

from reduced_models import Atlas
from reduced_models.elements.motion_errors import ERRORS, WITHIN

GOLDEN = Path(__file__).parents[2] / "golden"
SPEC = importlib.util.spec_from_file_location("motions", GOLDEN / "motions.py")
motions = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(motions)
STORED = json.loads((GOLDEN / "golden.json").read_text(encoding="utf-8"))["motions"]


@pytest.mark.filterwarnings("ignore:WideRangeContact used outside")
@pytest.mark.parametrize("case", motions.CASES)
def test_stated_errors_are_those_of_the_solves(case):
    point, kind = case.split(", ")
    rms, _ = motions.errors(case, STORED[case]["force"])
    stated = Atlas().element(motions.POINTS[point], "wide").motion_errors[kind]
    assert rms == pytest.approx(stated, rel=0.1, abs=1e-3)


def test_kinds_are_those_of_the_solves(memory):
    assert tuple(ERRORS) == motions.KINDS
    element = Atlas().element(motions.POINTS["middle"], "wide")
    assert element.rms == element.motion_errors[WITHIN]
    assert "impact" in repr(element) and memory.rms is None
