"""Every kernel of the elements, compiled and as plain Python."""

import copy

import numba
import numpy as np
import pytest

from reduced_models import FilmContact, SpringContact
from reduced_models.elements import film_filters, film_law, jet, spring_law

BOX = {"low": 0.75, "high": 1.0}
POLYNOMIAL = SpringContact.polynomial(0.806, 0.004, 0.346, 0.002, 0.054, -0.001, 0.010, rate=1.2, **BOX).law
VISCOUS = SpringContact.polynomial(0.806, 0.004, 0.346, 0.0, 0.054, 0.0, 0.0, **BOX).law
POWER = SpringContact.power(0.95, 1.7, 0.15, -0.05, 0.013, **BOX).law
FILM = FilmContact.wide(
    (0.1, 1.0, 3.0), (0.15, 0.95, 2.04), (0.3, 2.0), ((0.02, 0.01, 0.05, 0.2, 0.1), (0.01, 0.0, 0.03, 0.1, 0.05)),
    inlet_saturation=0.2, lag_rate=2.5, inlet_rate=20.0, fast_rate=60.0,
).law  # fmt: skip
A, B, C = jet.Jet(2.0, 0.3, -0.7), jet.Jet(1.5, -0.2, 0.4), jet.Jet(0.8, 0.1, 0.9)
POINTS = np.array([-0.3, 0.4, 0.74, 0.8, 0.99, 1.3])
STATE = np.array([0.9, 0.1, 0.85, 0.02, -0.01, 0.03, 0.01])
POISSON, SHARE = np.full(7, 0.3), np.array([1.0, 0.9, 0.7, 0.5, 0.3, 0.1, 0.05])

CASES = {
    jet: {
        "plus": [(A, B)],
        "minus": [(A, B)],
        "half": [(0.3, A)],
        "times": [(A, B)],
        "over": [(A, B)],
        "root": [(A,)],
        "through": [(0.7, 1.3, A)],
        "through3": [(0.7, 1.3, A, 0.2, B, -0.4, C)],
    },
    spring_law: {
        "inside": [(0.9, law) for law in (POLYNOMIAL, POWER)],
        "hertz": [(0.3, 1.2), (-0.1, 1.2)],
        "fade": [(u, 0.75, 0.2) for u in POINTS],
        "saturate": [(u, 0.75, 1.0, 0.1) for u in POINTS],
        "spring": [(u, law) for law in (POLYNOMIAL, POWER) for u in POINTS],
        **{
            name: [(u, v, law) for law in (POLYNOMIAL, VISCOUS, POWER) for u in POINTS for v in (-9.0, 0.3, 2.0)]
            for name in ("damper", "contact")
        },
        "fill_contact": [(POINTS, POINTS[::-1].copy(), law, np.zeros((3, 6))) for law in (POLYNOMIAL, POWER)],
        "fill_parts": [(POINTS, law, np.zeros((2, 6))) for law in (POLYNOMIAL, POWER)],
    },
    film_filters: {
        "lag_moments": [(mu, few) for mu in (0.0, 0.1, 2.0) for few in (0.5, 3.0)],
        "poisson_shares": [(mu, 4, few, np.zeros(5), np.zeros(5)) for mu in (0.1, 2.0, 9.0) for few in (0.5, 4.0)],
        "chain_moments": [(j, 2.5, SHARE) for j in (1, 3)],
        "pass_on": [(STATE[5:], POISSON, np.ones(2))],
        "filter_rates": [(FILM, 0.14, 0.9, 0.2, STATE[3:], np.zeros(4))],
    },
    film_law: {
        "interval": [(POINTS, x) for x in (-1.0, -0.3, 0.5, 1.3, 2.0)],
        "_film": [(x, FILM) for x in (-9.0, -1.0, 0.3, 4.0)],
        "static": [(u, FILM) for u in (-1e9, -3.0, 0.0, 0.9, 5.0)],
        "_one_lag": [(0.1, 0.2, A, B, rate, C) for rate in (0.3, 3.0)],
        "film_entering": [(s, 0.2, rim) for s in (0.3, -0.3) for rim in (0.0, 1.0)],
        "_entering": [(A, FILM), (B, FILM)],
        "_with_rim": [(A, B, C, jet.Jet(0.8, 0.1, 0.0), B)],
        "_between": [(x, FILM) for x in (-9.0, 0.3, 4.0)],
        "_weighed": [(3, A, FILM, (0, 1, 0.3, 0.7), 0.6)],
        "film_step": [(FILM, STATE, np.zeros(7), dt, u, 0.3) for dt in (0.01, 1.0) for u in (-3.0, 0.8, 2.5)],
        "film_rest": [(FILM, 0.8, np.zeros(7))],
        "film_drive": [(FILM, np.linspace(0.0, 1.0, 6), POINTS, 0.1 * POINTS, np.zeros(6))],
        "_gain": [(1, FILM, (0, 1, 0.3, 0.7))],
        "_made": [(x, FILM) for x in (-9.0, 0.3, 4.0)],
        "film_made": [(0.3, FILM)],
        "_film_of_states": [(FILM, (0, 1, 0.3, 0.7), 0.3, STATE[3:])],
        "film_rates": [(FILM, STATE[3:], 0.9, 0.2, np.zeros(4))],
        "film_rate": [(FILM, STATE[3:], 0.9, 1.1)],
        "static_forces": [(FILM, POINTS, np.zeros(6))],
        "films": [(FILM, POINTS, np.zeros(6), np.zeros(6))],
    },
}
KERNELS = [pytest.param(module, name, id=name) for module, cases in CASES.items() for name in cases]


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="kernels are plain Python already")
def test_no_kernel_is_left_out():
    for module, cases in CASES.items():
        kernels = {
            name
            for name, value in vars(module).items()
            if hasattr(value, "py_func") and value.__module__ == module.__name__
        }
        assert kernels == set(cases)


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="kernels are plain Python already")
@pytest.mark.parametrize(("module", "name"), KERNELS)
def test_compiled_and_plain_are_twins(module, name):
    kernel = getattr(module, name)
    for arguments in CASES[module][name]:
        ours, theirs = copy.deepcopy(arguments), copy.deepcopy(arguments)
        compiled, plain = kernel(*ours), kernel.py_func(*theirs)
        np.testing.assert_allclose(np.array(compiled, float), np.array(plain, float), rtol=1e-13, atol=1e-300)
        for a, b in zip(ours, theirs, strict=True):  # what it wrote
            if isinstance(a, np.ndarray):
                np.testing.assert_allclose(a, b, rtol=1e-13, atol=1e-300)


def test_interval_is_that_of_numpy():
    for size in range(5):
        knots = POINTS[:size]
        for x in [-9.0, *POINTS, *(POINTS + 1e-3)]:
            assert film_law.interval(knots, x) == np.searchsorted(knots, x) - 1
