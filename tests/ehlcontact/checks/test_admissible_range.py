"""The gate before any solve: points outside the box, and inputs that betray a unit, end in one line at once."""

import time
from dataclasses import replace
from math import pi

import pytest

from ehlcontact import (
    FreeVibration,
    Geometry,
    InputError,
    Lubricant,
    MoesPoint,
    OperatingPoint,
    PrescribedApproach,
    PrescribedLoad,
    RampLoad,
    TransientContact,
    impedance,
    simulate,
    solve_steady,
)
from ehlcontact.checks.admissible_range import INPUTS, LIMITS, MEASURED
from ehlcontact.point import require_solvable

AT_ONCE = 2.0  # seconds; a thousandth of it is usual
OIL = Lubricant(0.0367, 2e-8)
BEARING = dict(ball_diameter=7.94e-3, pitch_diameter=39.04e-3, conformity=0.52, speed_rpm=3000.0, load=487.0)
GOOD = MoesPoint(200.0, 10.0, 0.5)
SOLVERS = {
    "solve_steady": solve_steady,
    "simulate": lambda point: simulate(point, FreeVibration(Omega_n=5.13)),
    "impedance": lambda point: impedance(point, Omega=[1.0]),
    "TransientContact": TransientContact,
}


def refusal(call, *arguments):
    """The one line that a call ends in, at once."""
    started = time.perf_counter()
    with pytest.raises(InputError) as caught:
        call(*arguments)
    assert time.perf_counter() - started < AT_ONCE
    assert len(str(caught.value).splitlines()) == 1
    return str(caught.value)


def bearing(oil=OIL, **changes):
    return OperatingPoint.ball_bearing(oil, **(BEARING | changes))


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (dict(M=1e9), ("M = 1000000000.0", "between 0.1 and 60000, what the", "L = 10")),
        (dict(M=1e-9), ("M = 1e-09", "between 0.1 and")),
        (dict(L=1e9), ("L = 1000000000.0", "between 0 and 40, what the")),
        (dict(kappa=12.0), ("kappa = 12.0", "between 0.04 and 8, what the")),
        (dict(kappa=0.011), ("kappa = 0.011", "between")),
        (dict(M=30000.0, L=25.0, kappa=0.9), ("Hertz pressure in GPa", "at most 5")),
        (dict(alpha=20.0), ("alpha = 20.0", "between 1e-10 and 1e-06 1/Pa (in 1/GPa? then 2e-08 1/Pa")),
        (dict(alpha=0.02), ("alpha = 0.02", "in 1/MPa? then 2e-08 1/Pa")),
        (dict(eta0=36.7), ("eta0 = 36.7", "in mPa s? then 0.0367 Pa s")),
        (dict(eta0=1e-4), ("ln(eta/eta0) at the Hertz pressure", "at most 120")),
        (dict(eta0=6.4e-5, viscosity="barus"), ("eta0 = 6.4e-05", "between 0.0001 and 5 Pa s")),
    ],
)
def test_dimensionless_points(solver, changes, words):
    line = refusal(lambda: SOLVERS[solver](replace(GOOD, **changes)))
    assert all(word in line for word in words), line


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Lubricant(20.0, 2e-8), ("eta0 = 20", "between 0.0001 and 5 Pa s (in mPa s? then 0.02 Pa s)")),
        (lambda: MoesPoint(200, 10, 0.5, eta0=20.0), ("eta0 = 20", "in mPa s? then 0.02 Pa s")),
        (lambda: bearing(Lubricant(36.7, 2e-8)), ("eta0 = 36.7", "in mPa s? then 0.0367 Pa s")),
        (lambda: bearing(Lubricant(4.29e-5, 2e-8, "barus")), ("eta0 = 4.29e-05", "in m2/s? then 0.03732 Pa s")),
        (lambda: solve_steady(bearing(Lubricant(5.0, 2e-8))), ("L = 64.45", "eta0 = 5 in mPa s? then 0.005 Pa s")),
        (lambda: bearing(Lubricant(0.0367, 20.0)), ("alpha = 20.0", "in 1/GPa?")),
        (lambda: bearing(Lubricant(0.0367, 0.02)), ("alpha = 0.02", "in 1/MPa?")),
        (lambda: bearing(ball_diameter=7.94), ("ball_diameter = 7.94", "in mm? then 0.00794 m")),
        (lambda: bearing(ball_diameter=7.94e-6), ("ball_diameter = 7.94e-06", "between 0.0001 and 0.5 m")),
        (lambda: bearing(pitch_diameter=39.04), ("pitch_diameter = 39.04", "in mm? then 0.03904 m")),
        (lambda: bearing(ball_diameter=7.94, pitch_diameter=39.04), ("ball_diameter = 7.94", "in mm?")),
        (lambda: bearing(conformity=52.0), ("conformity = 52.0", "in %? then 0.52")),
        (lambda: bearing(conformity=1.04), ("conformity = 1.04", "as groove radius over ball radius? then 0.52")),
        (lambda: bearing(conformity=0.9615), ("= 0.9615", "as ball radius over groove radius? then 0.52")),
        (lambda: bearing(conformity=1.923), ("= 1.923", "as ball diameter over groove radius? then 0.52")),
        (lambda: bearing(conformity=0.500001), ("conformity = 0.500001", "between 0.501 and 0.7")),
        (lambda: bearing(e1=206.0, e2=206.0), ("e1 = 206.0", "in GPa? then 2.06e+11 Pa")),
        (lambda: bearing(e2=2.06e5), ("e2 = 206000.0", "in MPa? then 2.06e+11 Pa")),
        (lambda: solve_steady(bearing(load=487e3)), ("M = ", "20.1 GPa")),
        (lambda: solve_steady(bearing(load=4.87e-6)), ("M = ", "between 0.1")),
        (lambda: bearing(load=4.87e9), ("load = 4870000000.0", "between 1e-06 and 1e+08 N")),
        (lambda: bearing(speed_rpm=3e9), ("speed_rpm = 3000000000.0", "rev/min")),
        (lambda: solve_steady(bearing(speed_rpm=0.02)), ("M = ", "L = ")),
        (lambda: OperatingPoint(Geometry(3.16, 103.0), OIL, 487.0, 3.0), ("radius_x = 3.16", "in mm?")),
        (lambda: OperatingPoint(Geometry(1e-300, 1e300), OIL, 487.0, 3.0), ("radius_x = 1e-300", "m")),
        (
            lambda: OperatingPoint(Geometry(3e-3, 0.1), OIL, 487.0, 3000.0),
            ("u_sum = 3000.0", "in mm/s? then 3 m/s"),
        ),
        (lambda: OperatingPoint(Geometry(3e-3, 0.1), OIL, 487.0, 1e-300), ("u_sum = 1e-300", "m/s")),
        (lambda: OperatingPoint(Geometry(3e-3, 0.1), OIL, 1e300, 3.0), ("load = 1e+300", "N")),
    ],
)
def test_points_in_si(make, words):
    line = refusal(make)
    assert all(word in line for word in words), line


@pytest.mark.parametrize(
    "call",
    [
        lambda: simulate(GOOD, RampLoad(1e4, 1.0, Omega_n=2.4)),
        lambda: simulate(GOOD, PrescribedLoad([0.0, 1.0, 2.0, 3.0], [1.0, 1.0, 1e4, 1.0])),
        lambda: simulate(GOOD, PrescribedApproach([0.0, 1.0, 2.0, 3.0], [1.0, 1.0, 1e3, 1.0])),
        lambda: TransientContact(GOOD, largest_load=1e4),
        lambda: solve_steady(GOOD, approach=1e3),
    ],
)
def test_the_largest_load_counts(call):
    assert "under the largest load" in refusal(call)


def test_formulas_take_points_outside():
    """Only solvers refuse: a Hertz pressure or a film by formula is nobody's harm."""
    far = MoesPoint(1e6, 100.0, 0.02)
    assert far.p_hertz > LIMITS.p_hertz and far.expected_film > 0.0
    with pytest.raises(InputError, match="M = "):
        require_solvable(far)


def test_the_measured_box_passes():
    """Corners of docs/notes/solver.md whose Hertz pressure is within, and those of the atlas with its margin."""
    for M in (*MEASURED.M, 0.95, 33000.0):
        for L in (*MEASURED.L, 0.002, 31.0):
            for kappa in (*MEASURED.kappa, 0.0432, 1.06):
                point = MoesPoint(M, L, kappa)
                if point.p_hertz < 4.25e9:
                    assert require_solvable(point) is point


def test_limits_are_wider_than_what_was_measured():
    for name in ("M", "L", "kappa"):
        (low, high), (least, most) = getattr(LIMITS, name), getattr(MEASURED, name)
        assert low <= least and high > most
    assert LIMITS.p_hertz > MEASURED.p_hertz


@pytest.mark.parametrize("name", INPUTS)
def test_a_guess_lies_where_values_usually_are(name):
    """Every slip of unit is told of, from the middle of the usual range, where it leads out of it."""
    quantity = INPUTS[name]
    (low, high), (least, most) = quantity.usual, quantity.limits
    assert least <= low < high <= most
    middle = (low * high) ** 0.5
    assert quantity.slip(middle) == ""
    for size in quantity.others.values():
        given = middle / size
        if not low <= given <= high:
            assert quantity.slip(given).startswith("in ") and f" {quantity.unit}".rstrip() in quantity.slip(given)
    for value in (0.0, 1e300, -1.0):
        assert quantity.slip(value) == ""


def test_quantity_in_another_unit():
    ball = INPUTS["ball_diameter"].in_unit("mm")
    assert ball.limits == pytest.approx((0.1, 500.0)) and ball.slip(0.00794) == "in m? then 7.94 mm"
    assert ball.slip(7.94) == "" and ball.slip(0.3125) == "in inches? then 7.938 mm"
    assert INPUTS["speed_rpm"].slip(10.0 * pi) == ""


def test_no_limit_ends_in_a_traceback():
    """Far beyond what numbers can be computed of."""
    for changes in (dict(M=1e300), dict(M=1e-300), dict(L=1e300), dict(M=1e300, L=1e300), dict(alpha=1e300)):
        refusal(lambda changes=changes: solve_steady(replace(GOOD, **changes)))
