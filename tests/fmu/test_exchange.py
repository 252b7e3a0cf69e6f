"""Model exchange: derivatives against differences, loops against scipy, events."""

from itertools import product

import fmpy
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fmu.driver import Exchange

OMEGA_N = 2.56  # a mass whose vibration parts a film


@pytest.fixture
def model(extracted):
    """Make started instances for model exchange: ``model("wide")``."""
    made = []

    def make(name):
        unit = Exchange(extracted[name], fmpy.read_model_description(extracted[name]), [])
        made.append(unit)
        unit.start()
        return unit

    yield make
    for unit in made:
        unit.free()


def states_of(element, scale=0.3):
    """Some states of a film in motion."""
    return scale * np.sin(1.0 + np.arange(element.state_count))


@pytest.mark.parametrize("kind", ["memory", "wide", "wide_si"])
def test_jacobian_of_a_film_against_differences(model, elements, kind):
    unit, element = model(kind), elements[kind]
    f, length, time = element._units
    names = [variable.variable.name for variable in unit.description.derivatives]
    states = [name[4:-1] for name in names]
    values = {
        "force": f,
        "stiffness": f / length,
        "damping": f / length * time,
        **dict.fromkeys(names, 1.0 / time),
    }
    knowns = {"approach": length, "rate": length / time, **dict.fromkeys(states, 1.0)}
    for u in (1.7, 0.9, 0.3, -0.2):
        x = states_of(element)

        def ask(known=None, step=0.0, u=u, x=x):
            at = {"approach": u * length, "rate": -0.2 * length / time, **dict(zip(states, x, strict=True))}
            if known is not None:
                at[known] += step
            unit.evaluate(np.array([at[s] for s in states]), approach=at["approach"], rate=at["rate"])
            return np.array(unit.get(*values))

        for known, size in knowns.items():
            h = 1e-6 * size
            difference = (ask(known, h) - ask(known, -h)) / (2.0 * h)
            ask()
            exact = unit.raw.getDirectionalDerivative(
                [unit.reference[name] for name in values], [unit.reference[known]], [1.0]
            )
            scale = np.array(list(values.values())) / size
            assert np.all(np.abs(exact - difference) <= 1e-6 * np.maximum(np.abs(exact), 10.0 * scale)), known


@pytest.mark.parametrize("kind", ["linear", "cubic", "cubic_si", "polynomial", "power", "power_si"])
def test_jacobian_by_inputs_and_parameters_against_differences(slave, elements, kind):
    unit, element = slave(kind), elements[kind]
    length = element.high - element.low
    force, stiffness, damping = element.step_tangents(1.0, element.high, 0.0)
    scales = np.array([force, stiffness, damping])
    places = element.low - 0.1 * length, element.low + 0.4 * length, element.high + 0.6 * length
    for u, share in product(places, (0.4, -2.0)):  # the latter is so fast that a damper would pull
        at = {"approach": u, "rate": share * force / damping}
        unit.set(**at)
        tuned = [v for v in element.parameters if element.parameters[v] != 0.0] + ["low", "high"]
        for known in (*at, *tuned):
            value = unit.get(known)[0]
            size = abs(value) or 1.0
            # third differences of a steep law are what a central difference leaves
            h, ends = 1e-5 * min(size, length if known in ("approach", "low", "high", "u0") else size), []
            exact = np.array(
                unit.raw.getDirectionalDerivative(
                    [unit.reference[name] for name in ("force", "stiffness", "damping")],
                    [unit.reference[known]],
                    [1.0],
                )
            )
            for sign in (1.0, -1.0):
                unit.set(**{known: value + sign * h})
                ends.append(np.array(unit.get("force", "stiffness", "damping")))
            unit.set(**{known: value})
            difference = (ends[0] - ends[1]) / (2.0 * h)
            assert np.all(np.abs(exact - difference) <= 1e-6 * np.maximum(np.abs(exact), scales / size)), known


def oscillate(rates, count, u0, rtol):
    """Approach of a unit load's mass, released at u0, at T = 4; `rates` gives force and d(states)/dT."""

    def right_side(T, y):
        force, film = rates(y[2:], y[0], y[1])
        return np.concatenate([[y[1], OMEGA_N**2 * (1.0 - force)], film])

    y0 = np.zeros(2 + count)
    y0[0] = u0
    run = solve_ivp(right_side, (0.0, 4.0), y0, method="Radau", rtol=rtol, atol=1e-3 * rtol)
    assert run.success
    return run.y


@pytest.mark.parametrize("u0", [1.0, pytest.param(3.0, marks=pytest.mark.long)])
def test_mass_in_a_loop_converges_to_scipy(model, elements, u0):
    """The second one swings through lift-off; no event is looked for."""
    element, unit = elements["wide"], model("wide")

    def rates(x, u, v):
        return unit.evaluate(x, approach=u, rate=v)

    exact = oscillate(element.continuous, element.state_count, u0, 1e-10)
    assert (exact[0].min() < 0.0) == (u0 > 2.0)
    errors = [
        abs(oscillate(rates, element.state_count, u0, rtol)[0, -1] - exact[0, -1]) for rtol in (1e-4, 1e-6, 1e-9)
    ]
    assert errors[0] < 1e-2 and errors[1] < 1e-4 and errors[2] < 1e-6
    assert errors[2] < errors[1] < errors[0]


def test_rates_are_bounded_as_the_surfaces_part(model, elements):
    """Without bound they grow like 1/theta; down to a millionth of the load they are the element's."""
    element, unit = elements["memory"], model("memory")
    x = states_of(element, 1e-2)
    rest = np.abs(unit.evaluate(x, approach=1.0, rate=0.0)[1]).max()
    far = np.abs(unit.evaluate(x, approach=-30.0, rate=0.0)[1]).max()
    assert np.abs(element.continuous(x, -30.0, 0.0)[1]).max() > 1e3 * far
    assert far < 200.0 * rest
    u = element.approach_at(1e-5)
    assert np.allclose(unit.evaluate(x, approach=u, rate=0.1)[1], element.continuous(x, u, 0.1)[1], rtol=1e-12)


@pytest.mark.parametrize("kind", ["cubic", "wide"])
def test_event_at_lift_off(model, elements, kind):
    """The indicator changes its sign where the force ends; solvers are told to restart, states do not jump."""
    unit, element = model(kind), elements[kind]
    x = np.zeros(element.state_count)
    z = np.zeros(1)
    indicators, forces = [], []
    for u in np.linspace(1.2, -2.0, 50):
        forces.append(unit.evaluate(x, approach=u, rate=-300.0 if x.size else -3.0)[0])
        unit.raw.getEventIndicators(z.ctypes.data_as(pointer()), 1)
        indicators.append(z[0])
    # below zero where parted, not at it, or a solver that looks for a zero finds one everywhere behind the event
    assert np.array_equal(np.sign(indicators), np.where(np.array(forces) > 0.0, 1.0, -1.0))
    assert indicators[0] > 0.0 > indicators[-1]
    unit.raw.enterEventMode()
    needed, ended, nominals, values, timed, _ = unit.raw.newDiscreteStates()
    assert (needed, ended, nominals, values, timed) == (False, False, True, False, False)
    assert unit.raw.newDiscreteStates()[2] is False  # told once


def pointer():
    from ctypes import POINTER, c_double

    return POINTER(c_double)


@pytest.mark.parametrize("kind", ["memory", pytest.param("wide_si", marks=pytest.mark.long)])
def test_fmpy_solves_model_exchange(fmus, elements, kind):
    """fmpy's CVode on the film's states, the motion given; force against the continuous element."""
    element = elements[kind]
    _, length, time = element._units

    def motion(T):
        return (0.9 + 0.2 * np.sin(2.0 * T)) * length, 0.4 * np.cos(2.0 * T) * length / time

    T = np.linspace(0.0, 4.0, 4001)
    given = np.rec.fromarrays([T * time, *motion(T)], names="time,approach,rate")
    result = fmpy.simulate_fmu(
        str(fmus[kind]),
        fmi_type="ModelExchange",
        stop_time=4.0 * time,
        output_interval=0.01 * time,
        relative_tolerance=1e-8,
        input=np.asarray(given),
        output=["force"],
    )
    exact = solve_ivp(
        lambda t, x: element.copy().continuous(x, *motion(t))[1] * time,
        (0.0, 4.0),
        np.zeros(element.state_count),
        method="LSODA",  # the fastest filter is stiff
        rtol=1e-9,
        atol=1e-11,
        max_step=0.05,
        t_eval=[2.0, 4.0],
    )
    at = np.searchsorted(result["time"], np.array([2.0, 4.0]) * time * (1 - 1e-9))
    for k, n in enumerate(at):
        wanted = element.continuous(exact.y[:, k], *motion(exact.t[k]))[0]
        assert result["force"][n] == pytest.approx(wanted, rel=1e-5)
