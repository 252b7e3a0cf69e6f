"""``deflection=`` of every solve: the same film by each engine, and one line for an engine that is none."""

import numpy as np
import pytest

from ehlcontact import (
    FreeVibration,
    FullContact,
    Grid,
    InputError,
    MoesPoint,
    TimeSteps,
    impedance,
    simulate,
    solve_steady,
)

POINT = MoesPoint(200, 10, 0.5)
# by the direct sum to the tolerance of the solves, by multi-integration below the error of these grids
ENGINES = [("direct", 1e-7), ("mlmi", 1e-3)]


def film(engine):
    return solve_steady(POINT, grid=Grid(n=64, deflection=engine), tol=1e-9).H


def run(engine):
    return simulate(
        POINT, FreeVibration(Omega_n=5.13), grid=Grid(n=32, deflection=engine), time=TimeSteps(until=0.2, tol=1e-6)
    ).force


def response(engine):
    return impedance(POINT, Omega=[0.0, 3.0], grid=Grid(n=32, deflection=engine)).stiffness


def contact(engine):
    full = FullContact(POINT, grid=Grid(n=32, deflection=engine), tol=1e-6)
    return np.array([full.advance(0.1, 0.9), full.advance(0.1, 0.88)])


@pytest.mark.parametrize("solve", [film, run, response, contact])
@pytest.mark.parametrize(("engine", "error"), ENGINES)
def test_engines_find_the_same(solve, engine, error):
    expected, got = solve("fft"), solve(engine)
    np.testing.assert_allclose(got, expected, rtol=error, atol=error)
    assert (got != expected).any()


@pytest.mark.parametrize("solve", [film, run, response, contact])
def test_unknown_engine(solve):
    with pytest.raises(InputError, match=r"deflection = 'FFT': must be one of fft, mlmi, direct"):
        solve("FFT")
