"""The library's own numbers must not move unnoticed.

Tighter than any discretisation error, looser than rounding across machines. If a change is meant:
``python tests/golden/regenerate.py``, and a line under "Numerics" in CHANGELOG.md.
"""

import pytest
from programs import script

golden = script("tests/golden/regenerate.py")
STORED = golden.stored()
# The seven terms are hardly identifiable: rounding of the record is seen through their condition.
LOOSE = {("fit", "polynomial"): 1e-2, ("fit", "memory"): 1e-2}
SLOW = {("validation", name) for name in golden.validation.SECTIONS if name not in ("bearings", "formulas")}
SLOW |= {("motions", name) for name in golden.motions.CASES}


def leaves(value, name=""):
    """Numbers and words in nested tables and lists, by their place."""
    if isinstance(value, dict | list):
        for key, entry in value.items() if isinstance(value, dict) else enumerate(value):
            yield from leaves(entry, f"{name}.{key}")
    else:
        yield name, value


def test_every_case_is_stored():
    assert {group: set(names) for group, (names, *_) in golden.GROUPS.items()} == {
        group: set(cases) - {"version"} for group, cases in STORED.items()
    }


@pytest.mark.parametrize(
    ("group", "name"),
    [
        pytest.param(group, name, marks=pytest.mark.slow if (group, name) in SLOW else ())
        for group, (names, *_) in golden.GROUPS.items()
        for name in names
    ],
)
def test_numbers_are_those_stored(group, name):
    _, make, rel, least = golden.GROUPS[group]
    found, expected = dict(leaves(make(name))), dict(leaves(STORED[group][name]))
    assert found.keys() == expected.keys()
    for place, value in expected.items():
        rel = 1e-3 if "damping" in place and group == "impedance" else LOOSE.get((group, name), rel)
        same = pytest.approx(value, rel=rel, abs=least) if isinstance(value, float) else value
        assert type(found[place]) is type(value) and found[place] == same, place
