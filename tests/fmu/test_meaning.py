"""What the inputs of a co-simulation step mean, and what that does to a loop."""

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from scipy.integrate import solve_ivp

from reduced_models import CubicContact

EXTRAPOLATED, END, HELD = 1, 2, 3
SLOW, SWING = 2.5, 0.4


def motion(T):
    """Approach and rate of u = 0.87 + 0.4 sin 2.5 T."""
    return 0.87 + SWING * np.sin(SLOW * T), SWING * SLOW * np.cos(SLOW * T)


@pytest.fixture(scope="module")
def exact(film):
    """Force of the continuous element along `motion`, as a function of time."""
    run = solve_ivp(
        lambda T, x: film.continuous(x, *motion(T))[1],
        (0.0, 8.0),
        np.zeros(film.state_count),
        method="DOP853",
        rtol=1e-10,
        atol=1e-12,
        dense_output=True,
    )
    return lambda T: np.array([film.continuous(run.sol(t), *motion(t))[0] for t in T])


@pytest.fixture(scope="module")
def film(elements):
    return elements["wide"]


def rms(unit, meaning, h, exact):
    """Error of the force over the spread of the force, the first transit left out."""
    n = round(8.0 / h)
    T, force = h * np.arange(1, n + 1), np.empty(n)
    for k in range(n):
        u, v = motion(T[k] if meaning == END else T[k] - h)
        force[k] = unit.force(u, v, h)
    after = T > 2.0
    wanted = exact(T[after])
    return float(np.sqrt(np.mean((force[after] - wanted) ** 2)) / np.std(wanted))


@pytest.mark.parametrize(("meaning", "order", "most"), [(END, 2, 1.5e-4), (EXTRAPOLATED, 2, 0.02), (HELD, 1, 0.3)])
def test_order_against_the_continuous_element(slave, exact, meaning, order, most):
    u, v = motion(0.0)
    errors = [
        rms(slave("wide", meaning=meaning, approach=u, rate=v), meaning, h, exact) for h in (0.1, 0.02, 0.01)
    ]
    assert errors[0] < most
    seen = np.log2(errors[1] / errors[2])
    assert order - 0.1 < seen < order + 0.6  # of what is extrapolated the approach is of order 3, the rate of 2


def usual_loop(unit, element, mass, load, h, periods, *, read_first=False, mass_after=False):
    """Damping of a mass on the FMU: set, step, get, and the mass goes on by the force it had, or that just got."""
    u0 = element.approach_at(load)
    w = np.sqrt(element.spring_tangent(u0) / mass)
    u, v, force, sizes = 0.999 * u0, 0.0, unit.get("force")[0], []
    for _ in range(int(periods * 2.0 * np.pi / w / h)):
        unit.set(approach=u, rate=v)
        if read_first:
            force = unit.get("force")[0]
        unit.step(h)
        if mass_after:
            force = unit.get("force")[0]
        v += h * (load - force) / mass
        u += h * v
        if not (read_first or mass_after):
            force = unit.get("force")[0]
        sizes.append(np.hypot(u - u0, v / w))
    sizes = np.array(sizes)
    return -2.0 * mass * np.polyfit(h * np.arange(sizes.size), np.log(sizes), 1)[0]


# A 6305 at 1 kN: K1 = 1.29e8 N/m and C1 = 44 N s/m about 7 um
BALL = CubicContact(1.29e8, 0.0, 0.0, 44.0, 5e-6, 9e-6, units="SI")


@pytest.fixture(scope="module")
def ball(tmp_path_factory):
    import fmpy

    from fmu import export_contact

    folder = tmp_path_factory.mktemp("ball")
    return fmpy.extract(str(export_contact(BALL, folder / "ball.fmu")), unzipdir=str(folder / "x"))


@pytest.fixture
def loop(ball, by_hand):
    """Damping of 10 kg in the usual loop: ``loop(meaning, h)``."""

    def run(meaning, h, **how):
        u = 0.999 * BALL.approach_at(900.0)
        unit = by_hand(ball, meaning=meaning, approach=u)
        try:
            return usual_loop(unit, BALL, 10.0, 900.0, h, 12.0, **how)
        finally:
            unit.raw.freeInstance()

    return run


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
def test_usual_loop_keeps_the_damping(loop):
    assert loop(EXTRAPOLATED, 1e-5) == pytest.approx(BALL.C1, rel=0.05)
    assert loop(EXTRAPOLATED, 1e-4) > 0.0  # stable
    late = -BALL.K1 * 1e-5 + BALL.C1  # a delay of one step takes K h off
    assert loop(HELD, 1e-5) == pytest.approx(late, rel=0.02)
    assert loop(END, 1e-5) == pytest.approx(late, rel=0.02)  # which asks for what comes after the step
    for meaning in (EXTRAPOLATED, HELD):
        assert loop(meaning, 1e-5, read_first=True) == pytest.approx(BALL.C1, rel=0.02)


@pytest.mark.parametrize("kind", ["cubic", "wide"])
@pytest.mark.parametrize("meaning", [EXTRAPOLATED, END, HELD])
def test_outputs_follow_what_is_set(slave, kind, meaning):
    """The force after a set is that of the inputs, before any step, and setting them back brings it back."""
    unit = slave(kind, meaning=meaning)
    unit.set(approach=0.9, rate=0.1)
    unit.step(0.01)
    unit.set(approach=0.9, rate=0.1)
    here = unit.get("force", "stiffness", "damping")
    h = 1e-6
    for name, slope in (("approach", here[1]), ("rate", here[2])):
        value = unit.get(name)[0]
        unit.set(**{name: value + h})
        assert unit.get("force")[0] - here[0] == pytest.approx(h * slope, rel=1e-4)
        unit.set(**{name: value})
    assert unit.get("force", "stiffness", "damping") == here


@pytest.mark.parametrize("kind", ["cubic", "memory"])
def test_step_must_start_where_the_fmu_is(slave, kind):
    unit = slave(kind)
    unit.step(0.1)
    before = unit.raw.serializeFMUState(unit.raw.getFMUState())
    for time in (0.0, 0.05, 0.2, float("nan")):
        with pytest.raises(FMICallException):
            unit.raw.doStep(currentCommunicationPoint=time, communicationStepSize=0.1)
    assert any("present time" in message for _, _, message in unit.log)
    assert unit.raw.serializeFMUState(unit.raw.getFMUState()) == before
    unit.raw.doStep(currentCommunicationPoint=0.1 * (1 + 1e-15), communicationStepSize=0.1)  # as masters add up


def test_derivatives_of_inputs_make_the_motion_exact(slave, film):
    """A motion of constant acceleration: with its derivatives the first step is as good as one by its end."""
    u, v, a, h = 0.9, -0.5, 3.0, 1e-3  # short, so that it is not cut inside
    end = u + v * h + 0.5 * a * h * h, v + a * h
    told, ended = slave("wide", meaning=EXTRAPOLATED, approach=u, rate=v), slave("wide", approach=u, rate=v)
    references = [told.reference["approach"], told.reference["approach"], told.reference["rate"]]
    told.raw.setRealInputDerivatives(references, [1, 2, 1], [v, a, a])
    told.step(h)
    assert told.get("force")[0] == pytest.approx(ended.force(*end, h), rel=1e-12)
    told.set(approach=end[0], rate=end[1])
    told.step(h)  # for which they are not told: the last change of the rate says the same
    assert told.get("force")[0] == pytest.approx(
        ended.force(u + 2 * h * v + 2 * a * h * h, v + 2 * a * h, h), rel=1e-12
    )
    with pytest.raises(FMICallException):
        ended.raw.setRealInputDerivatives(references[:1], [1], [v])  # which says what the end is itself
    with pytest.raises(FMICallException):
        told.raw.setRealInputDerivatives(references[:1], [3], [v])


@pytest.mark.parametrize("to", [0.85, 0.95])
def test_a_jump_of_the_approach_does_not_go_on(slave, elements, to):
    unit = slave("cubic", meaning=EXTRAPOLATED, approach=0.9, rate=0.0)
    unit.step(0.01)
    assert unit.force(to, 0.0, 0.01) == pytest.approx(float(elements["cubic"].force(to, 0.0)), rel=1e-12)


@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0])
def test_a_master_that_goes_on_by_the_new_rate_is_foreseen(slave, elements, ratio):
    """Symplectic Euler under a constant acceleration, steps unequal: the force is that of where it will be."""
    u, v, a, h = 0.9, 0.3, -2.0, 0.01
    unit = slave("cubic", meaning=EXTRAPOLATED, approach=u, rate=v)
    unit.step(h)
    v += a * h
    u += v * h
    force = unit.force(u, v, ratio * h)
    v += a * ratio * h
    u += v * ratio * h
    assert force == pytest.approx(float(elements["cubic"].force(u, v)), rel=1e-12)


@pytest.mark.parametrize("a", [0.0, 5.0])
def test_derivatives_of_outputs_in_time(slave, a):
    unit = slave("wide", meaning=EXTRAPOLATED, approach=0.9, rate=0.2)
    references = [unit.reference["approach"], unit.reference["rate"]]
    forces = []
    for k in range(3):
        t = 1e-4 * k
        unit.set(approach=0.9 + 0.2 * t + 0.5 * a * t * t, rate=0.2 + a * t)
        unit.raw.setRealInputDerivatives([references[1]], [1], [a])
        unit.step(1e-4)
        forces.append(unit.get("force")[0])
        if k == 1:
            slope = unit.raw.getRealOutputDerivatives([unit.reference["force"]], [1])[0]
    assert slope == pytest.approx((forces[2] - forces[0]) / 2e-4, rel=1e-4)


@pytest.mark.parametrize("h", [0.5, 2.0])
def test_long_steps_are_cut_inside(slave, film, h):
    """Approach and rate fall by what is extrapolated; steps of a thousandth give the same force."""
    u, v = 1.5, -0.9 / h
    coarse = slave("wide", meaning=EXTRAPOLATED, approach=u, rate=v)
    coarse.step(h)
    T = np.linspace(0.0, h, 2001)
    fine = film.drive(T, u + v * T, np.full(T.size, v))[-1]
    whole = film.drive(T[[0, -1]], u + v * T[[0, -1]], np.full(2, v))[-1]
    assert coarse.get("force")[0] == pytest.approx(fine, rel=3e-4)
    assert abs(whole - fine) > abs(coarse.get("force")[0] - fine)


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
def test_a_mass_that_comes_after_the_fmu_wants_held_inputs(loop):
    """As the README says: the force just got, in the same step, is one of that step's start only when held."""
    assert loop(HELD, 1e-5, mass_after=True) == pytest.approx(BALL.C1, rel=0.02)
    early = BALL.C1 + BALL.K1 * 1e-5
    assert loop(EXTRAPOLATED, 1e-5, mass_after=True) == pytest.approx(early, rel=0.02)
