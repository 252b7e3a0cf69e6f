"""Bad input of the public functions: one `InputError` that names the field, whatever was given."""

import numpy as np
import pytest

from ehlcontact import (
    ConvergenceError,
    Domain,
    FreeVibration,
    FullContact,
    Geometry,
    HarmonicLoad,
    InputError,
    MoesPoint,
    PrescribedLoad,
    simulate,
    solve_steady,
)
from ehlcontact.impedance import impedance
from ehlcontact.solver.domain import check_intervals

POINT = MoesPoint(200, 10, 0.5)
LIGHT_SIDE = Domain(-12.0, 2.5, 3.0)


@pytest.mark.parametrize("n", ["x", float("nan"), float("inf"), [16], 32.0, True, 0, -16, 100, 4096])
def test_intervals(n):
    for call in (check_intervals, lambda n: solve_steady(POINT, n=n), lambda n: FullContact(POINT, n=n)):
        with pytest.raises(InputError, match=r"^n = "):
            call(n)
    with pytest.raises(InputError, match=r"^n = "):
        impedance(POINT, Omega=[1.0], n=n)


def test_intervals_of_numpy():
    assert check_intervals(np.int64(32)) == 32


@pytest.mark.parametrize(
    ("field", "call"),
    [
        ("Omega", lambda: HarmonicLoad(Omega="3.14")),
        ("Omega_n", lambda: FreeVibration(Omega_n="5")),
        ("nu1", lambda: Geometry(1.0, 1.0, nu1="0.3")),
        ("conformity", lambda: Geometry.ball_bearing(8e-3, 39e-3, "0.52")),
        ("M", lambda: MoesPoint(np.bool_(True), 10, 1.0)),
        ("T", lambda: PrescribedLoad(["a"] * 4, [1.0] * 4)),
        ("values", lambda: PrescribedLoad([0.0, 1.0, 2.0, 3.0], ["a"] * 4)),
        ("tol", lambda: simulate(POINT, FreeVibration(Omega_n=5.0), tol="1e-3")),
        ("domain", lambda: solve_steady(POINT, domain=(-4.5, 1.5, 3.0))),
        ("motion", lambda: simulate(POINT, 1)),
        ("max_cycles", lambda: solve_steady(POINT, max_cycles=-1)),
        ("max_cycles", lambda: solve_steady(POINT, max_cycles="a")),
        ("snapshots", lambda: simulate(POINT, FreeVibration(Omega_n=5.0), until=1.0, snapshots=(1.5,))),
        ("Omega", lambda: impedance(POINT, Omega=[])),
        ("Omega", lambda: impedance(POINT, Omega=[-1.0])),
    ],
)
def test_field_is_named(field, call):
    with pytest.raises(InputError, match=rf"^{field} = ") as caught:
        call()
    assert "\n" not in str(caught.value)


def test_pressure_at_the_side_border_is_told():
    """M = 5 at kappa = 0.12 floods this domain to its sides."""
    result = solve_steady(MoesPoint(5, 5, 0.12), n=64, domain=LIGHT_SIDE, throw=False)
    assert str(result.status) == "out_of_domain"
    assert "wider" in result.status.advice


def test_light_load_gets_room():
    """The default region of the same contact is wide enough, and the film carries it far apart."""
    result = solve_steady(MoesPoint(5, 5, 0.12), n=64)
    assert result.approach < -5.0
    assert result.domain.x_in < -8.0


def test_film_below_the_grid_is_told():
    """Residuals below tolerance, but surfaces that overlap: no result to rely on."""
    with pytest.raises(ConvergenceError, match="raise n") as caught:
        solve_steady(MoesPoint(200, 10, 1.0), n=16)
    assert str(caught.value.result.status) == "unresolved"
    assert caught.value.result.h_min < 0.0


def test_interrupted_steady_solve_keeps_what_it_has():
    def stop(cycle, residual):
        if cycle == 2:
            raise KeyboardInterrupt

    result = solve_steady(POINT, n=32, callback=stop)
    assert str(result.status) == "interrupted" and result.cycles == 2
