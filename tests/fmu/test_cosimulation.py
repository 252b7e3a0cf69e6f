"""The FMU inside co-simulations: fmpy's own master, and masters written here."""

import dataclasses
import resource

import fmpy
import numpy as np
import pytest

from ehlcontact.errors import InputError
from fmu.references.contact_references import bounds, state_grid
from reduced_models import SpringContact
from reduced_models.elements.validity import OutsideValidityWarning
from reduced_models.rotor.oscillator import simulate_oscillator

OMEGA_N = 5.13  # free vibration, case 2 of Table 3


def outside(element, approach, rate, force):
    return bounds(element, approach, rate, force)["outside_validity"]


def signals(element, n=201):
    """Approach from lift-off to well above the interval and back, in one unit of time."""
    time = np.linspace(0.0, 1.0, n)
    middle, length = 0.5 * (element.low + element.high), element.high - element.low
    approach = middle + 4.0 * length * np.sin(2.0 * np.pi * time)
    rate = 40.0 * 8.0 * np.pi * length * np.cos(2.0 * np.pi * time)  # fast enough to part inside the interval
    rows = np.rec.fromarrays([time, approach, rate], names="time,approach,rate")
    return np.asarray(rows)


def test_fmpy_master_gives_the_elements_force(fmus, elements, kind):
    element = elements[kind]
    given = signals(element)
    if element.units == "SI":
        given["rate"] *= (
            element.force(element.high, 0.0) / element.damping(element.high, 0.0) / given["rate"].max()
        )
    result = fmpy.simulate_fmu(
        str(fmus[kind]),
        stop_time=1.0,
        output_interval=0.005,
        input=given,
        start_values={"lead": 0.0},
        output=["approach", "rate", "force", "stiffness", "damping", "outside_validity"],
    )
    u, v = result["approach"], result["rate"]
    expected = element.force(u, v)
    assert np.allclose(result["force"], expected, rtol=1e-12, atol=1e-15 * expected.max())
    assert np.allclose(result["stiffness"], element.stiffness(u, v), rtol=1e-12)
    assert np.allclose(result["damping"], element.damping(u, v), rtol=1e-12)
    assert np.array_equal(
        result["outside_validity"].astype(bool), bounds(element, u, v, expected)["outside_validity"]
    )
    # Inputs are held: that of time t is set before the step that ends at t + h, and every output lags by one step.
    assert np.allclose(u[1:], given["approach"][:-1], rtol=1e-12)
    assert expected.min() == 0.0 < expected.max()


def test_parameters_by_start_value_and_while_running(fmus, elements):
    element = elements["cubic"]
    result = fmpy.simulate_fmu(
        str(fmus["cubic"]), stop_time=0.01, start_values={"approach": 0.9, "K1": 0.7}, output=["force"]
    )
    expected = dataclasses.replace(element, K1=0.7).force(0.9, 0.0)
    assert np.allclose(result["force"], expected, rtol=1e-12)


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
def test_tunable_parameters_between_steps(slave, elements):
    element, unit = elements["cubic"], slave("cubic")
    changes = [{}, {"K1": 0.7}, {"C1": 0.05, "K3": -0.1}, {"low": 0.8, "high": 0.95}, {"K2": 0.6}]
    for change in changes:
        element = dataclasses.replace(element, **change)
        if change:
            unit.set(**change)
        for u in np.linspace(-0.5, 2.0, 41).tolist():
            for v in (-20.0, -1.0, 0.0, 2.0):
                assert unit.force(u, v) == pytest.approx(element.force(u, v), rel=1e-12, abs=1e-15)
                assert unit.get("stiffness")[0] == pytest.approx(element.stiffness(u, v), rel=1e-12, abs=1e-12)
                here = (np.array([value]) for value in (u, v, element.force(u, v)))
                assert unit.outside() == bool(outside(element, *here)[0])


def random_element(random):
    """Any cubic element that the library accepts, over ten decades of stiffness and length."""
    while True:
        stiffness, length = 10.0 ** random.uniform(-2.0, 8.0), 10.0 ** random.uniform(-6.0, 1.0)
        low = random.uniform(-0.2, 1.0)
        K1, K2, K3 = random.normal(size=3) * stiffness / length ** np.arange(3)
        ends = low * length, (low + random.uniform(0.05, 1.0)) * length
        try:
            return SpringContact.cubic(abs(K1), K2, K3, random.uniform(0.0, 1.0) * stiffness, *ends)
        except InputError:
            continue


def test_any_element_by_tunable_parameters(slave):
    random, unit = np.random.default_rng(2), slave("cubic")
    for _ in range(20):
        element = random_element(random)
        unit.set(**element.parameters, low=element.low, high=element.high)
        u, v = state_grid(element)
        found = []
        for a, b in zip(u[::3].tolist(), v[::3].tolist(), strict=True):
            unit.force(a, b)
            found.append(unit.get("force", "stiffness", "damping"))
        for k, function in enumerate((element.force, element.stiffness, element.damping)):
            floor = 1e-15 * abs(function(element.high, 0.0))
            assert np.allclose(np.array(found)[:, k], function(u[::3], v[::3]), rtol=1e-12, atol=floor)


def test_derivative_along_a_direction(slave):
    unit = slave("cubic")
    unit.set(approach=0.5, rate=0.7)
    unit.step()
    knowns, unknowns = ["approach", "rate"], ["force", "stiffness", "damping"]
    seed = [0.3, -1.7]
    along = unit.raw.getDirectionalDerivative(
        [unit.reference[name] for name in unknowns], [unit.reference[name] for name in knowns], seed
    )
    parts = [[unit.gradient(unknown, known) for known in knowns] for unknown in unknowns]
    assert np.allclose(along, np.array(parts) @ seed, rtol=1e-14)
    assert along[0] == pytest.approx(np.dot(unit.get("stiffness", "damping"), seed), rel=1e-14)


def runge_kutta(force, T, u, v):
    """Classical fourth-order steps of u'' = Omega_n^2 (1 - F(u, u'))."""
    history = [u]

    def slope(t, h, y):
        return np.array([y[1], OMEGA_N**2 * (1.0 - force(t, h, float(y[0]), float(y[1])))])

    y = np.array([u, v])
    for t, h in zip(T[:-1].tolist(), np.diff(T).tolist(), strict=True):
        k1 = slope(t, h, y)
        k2 = slope(t, h, y + 0.5 * h * k1)
        k3 = slope(t, h, y + 0.5 * h * k2)
        k4 = slope(t, h, y + h * k3)
        y = y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        history.append(y[0])
    return np.array(history)


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
def test_oscillator_on_the_fmu_follows_the_python_one(slave, rollback, elements):
    unit, element = slave("cubic"), elements["cubic"]
    T = np.linspace(0.0, 3.0, 1201)

    def trial_step(t, h, u, v):
        with rollback(unit):  # always the same step of the FMU's own time
            return unit.force(u, v, h)

    u0 = 1.2  # swings out of the interval on both sides
    ours = runge_kutta(trial_step, T, u0, 0.0)
    assert ours.min() < element.low < element.high < ours.max()
    twin = runge_kutta(lambda t, h, u, v: element.force(u, v), T, u0, 0.0)
    assert np.max(np.abs(ours - twin)) <= 1e-12
    with pytest.warns(OutsideValidityWarning, match="approach"):
        python = simulate_oscillator(element.copy(), T, Omega_n=OMEGA_N, u0=u0, method="DOP853", rtol=1e-10)
    assert np.max(np.abs(ours - python.approach)) <= 1e-6


def implicit(unit, rollback, n, until=2.0):
    """Trapezoidal steps; Newton on the FMU's directional derivatives, with rollback in each iteration."""
    h = until / n
    u, v = 1.0, 0.0
    a = OMEGA_N**2 * (1.0 - unit.force(u, v, h))
    for _ in range(n):
        new = v
        for _ in range(20):
            at = u + 0.5 * h * (v + new)
            with rollback(unit):
                residual = new - v - 0.5 * h * (a + OMEGA_N**2 * (1.0 - unit.force(at, new, h)))
                tangent = unit.gradient("force", "approach") * 0.5 * h + unit.gradient("force", "rate")
            change = residual / (1.0 + 0.5 * h * OMEGA_N**2 * tangent)
            new -= change
            if abs(change) <= 1e-13 * (1.0 + abs(new)):
                break
        else:
            raise AssertionError("Newton did not converge")
        u += 0.5 * h * (v + new)
        v = new
        a = OMEGA_N**2 * (1.0 - unit.force(u, v, h))
    return u


def test_implicit_master_with_rollback_is_second_order(slave, rollback, elements):
    unit = slave("cubic")
    python = simulate_oscillator(
        elements["cubic"], [0.0, 2.0], Omega_n=OMEGA_N, u0=1.0, method="DOP853", rtol=1e-11
    ).approach[-1]
    errors = [abs(implicit(unit, rollback, n) - python) for n in (400, 800)]
    assert errors[1] < 1e-4
    assert 3.5 < errors[0] / errors[1] < 4.5


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
def test_interleaved_instances_do_not_know_of_each_other(slave, elements):
    first, second, si = slave("cubic"), slave("cubic"), slave("cubic_si")
    second.set(K1=0.9, C1=0.1)
    other = dataclasses.replace(elements["cubic"], K1=0.9, C1=0.1)
    for n in range(200):
        u, v = 0.9 + 0.4 * np.sin(0.3 * n), 3.0 * np.cos(0.7 * n)
        forces = first.force(u, v), second.force(u + 0.01, -v), si.force(1.2e-5, 0.0)
        expected = (
            elements["cubic"].force(u, v),
            other.force(u + 0.01, -v),
            elements["cubic_si"].force(1.2e-5, 0.0),
        )
        assert forces == pytest.approx(expected, rel=1e-12, abs=1e-15)


def test_many_instances(extracted, instantiated):
    """Two hundred come and go without the process growing by more than 1 MB."""
    description = fmpy.read_model_description(extracted["cubic"])

    def cycle(count):
        for _ in range(count):
            instantiated(extracted["cubic"], description, lambda *arguments: None).freeInstance()

    cycle(20)  # what loaders and allocators keep for good
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    cycle(200)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 1024
