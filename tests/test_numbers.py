"""Every number at module level has a birth certificate in `tests/benchmarks/numbers.json`; see docs/numbers.md."""

import importlib.util
from pathlib import Path

import pytest

FOLDER = Path(__file__).parent / "benchmarks"


@pytest.fixture(scope="module")
def vary():
    spec = importlib.util.spec_from_file_location("vary", FOLDER / "vary.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_numbers_are_found(vary):
    numbers = {number.name: number for number in vary.numbers_of_library()}
    assert len(numbers) > 100
    assert numbers["FORCE_FACTOR"].value == "1.5 / np.pi"
    assert "theta" in numbers["SWITCH"].comment


def test_every_number_has_its_certificate(vary):
    """What to do is said in the line of each number that has none."""
    assert "\n".join(vary.faults()) == ""


def test_page_is_made_from_the_table(vary):
    """`python tests/benchmarks/vary.py --page` makes it."""
    assert vary.PAGE.read_text(encoding="utf-8") == vary.page()


@pytest.mark.parametrize(
    ("value", "half", "double"),
    [
        (3.0, 1.5, 6.0),
        (5, 3, 10),
        (1, 1, 2),
        (-2.0, -1.0, -4.0),
        ((0.5, (4, 6)), (0.25, (2, 3)), (1.0, (8, 12))),
        ((80, 96), (32, 48), (160, 192)),
        (
            {"a": 2.0, "b": "cubic", "c": True},
            {"a": 1.0, "b": "cubic", "c": True},
            {"a": 4.0, "b": "cubic", "c": True},
        ),
    ],
)
def test_half_and_double(vary, value, half, double):
    assert vary.scaled(value, 0.5) == half
    assert vary.scaled(value, 2.0) == double
    assert vary.scaled(value, 1.0) == value


def test_sentences(vary):
    """Statuses, chosen grids, counts and numbers, in this order; what is within the tolerance is no change."""
    case = {"status": "converged", "n": 128, "cycles": 6, "h_min": 0.02, "seconds": 0.05}
    before = {f"steady/paper/{name}": value for name, value in case.items()}

    def after(**changed):
        return vary.in_words(before, {f"steady/paper/{name}": value for name, value in (case | changed).items()})

    assert after() == "nothing measured changes"
    assert after(h_min=0.02 * (1.0 + 1e-6)) == "hardly anything: steady h_min +1e-06"
    assert after(status="diverged", n=256, cycles=9, h_min=0.021) == (
        "steady: paper `diverged`, paper n 128 -> 256, cycles +50 %, h_min +5 %"
    )
