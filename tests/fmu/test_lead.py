"""Lead of the force in co-simulation, and what it does to the damping of a mass."""

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from scipy.integrate import solve_ivp

from reduced_models import SpringContact

EXTRAPOLATED, END, DEFAULT = 1.0, 0.0, 1.5
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


def rms(unit, lead, h, exact):
    """Error of the force over the spread of the force, the first transit left out."""
    n = round(8.0 / h)
    given = h * np.arange(n) + (h if lead < 1.0 else 0.0)  # the times of the inputs
    force = np.array([unit.force(*motion(t), h) for t in given])
    after = (given > 2.0) & (given < 8.0 - 2.0 * h)
    wanted = exact(given[after] + lead * h)
    return float(np.sqrt(np.mean((force[after] - wanted) ** 2)) / np.std(wanted))


@pytest.mark.parametrize(
    ("lead", "order", "most"), [(END, 2, 1.5e-4), (0.5, 2, 0.01), (EXTRAPOLATED, 3, 0.02), (DEFAULT, 3, 0.05)]
)
def test_order_against_the_continuous_element(slave, exact, lead, order, most):
    u, v = motion(0.0)
    errors = [rms(slave("wide", lead=lead, approach=u, rate=v), lead, h, exact) for h in (0.1, 0.02, 0.01)]
    assert errors[0] < most
    seen = np.log2(errors[1] / errors[2])
    assert order - 0.3 < seen < order + 0.6


def through_a_step(u, v, a, h, mass):
    """A mass with a force that is held: exactly, or by symplectic Euler."""
    return (u + h * v + 0.5 * h * h * a if mass == "exact" else u + h * (v + h * a)), v + h * a


def damping(unit, element, mass, load, h, periods, kind, *, serial, read_first=False):
    """Damping of a mass on the FMU; in a serial loop the mass goes first, in a parallel one beside the FMU."""
    u0 = element.approach_at(load)
    w = np.sqrt(element.spring_tangent(u0) / mass)
    u, v, force, sizes = 0.999 * u0, 0.0, unit.get("force")[0], []
    for _ in range(int(periods * 2.0 * np.pi / w / h)):
        before = u, v
        if read_first:
            unit.set(approach=u, rate=v)
            force = unit.get("force")[0]
        u, v = through_a_step(u, v, (load - force) / mass, h, kind)
        unit.set(**dict(zip(("approach", "rate"), (u, v) if serial else before, strict=True)))
        unit.step(h)
        force = unit.get("force")[0]
        sizes.append(np.hypot(u - u0, v / w))
    sizes = np.array(sizes)
    return -2.0 * mass * np.polyfit(h * np.arange(sizes.size), np.log(sizes), 1)[0]


# A 6305 at 1 kN: K1 = 1.29e8 N/m and C1 = 44 N s/m about 7 um
BALL = SpringContact.cubic(1.29e8, 0.0, 0.0, 44.0, 5e-6, 9e-6, units="SI")


@pytest.fixture(scope="module")
def ball(tmp_path_factory):
    import fmpy

    from fmu import export

    folder = tmp_path_factory.mktemp("ball")
    return fmpy.extract(str(export(BALL, folder / "ball.fmu")), unzipdir=str(folder / "x"))


@pytest.fixture
def loop(ball, by_hand):
    """Damping of 10 kg on the FMU: ``loop(lead, h, kind, serial=...)``."""

    def run(lead, h, kind, **how):
        u = 0.999 * BALL.approach_at(900.0)
        unit = by_hand(ball, lead=lead, approach=u)
        try:
            return damping(unit, BALL, 10.0, 900.0, h, 12.0, kind, **how)
        finally:
            unit.raw.freeInstance()

    return run


LEADS = {("exact", False): 1.5, ("symplectic", False): 1.0, ("exact", True): 0.5, ("symplectic", True): 0.0}


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
@pytest.mark.parametrize(("kind", "serial"), LEADS)
@pytest.mark.parametrize(("h", "allowed"), [(3e-6, 0.01), (1e-5, 0.02), (3e-5, 0.25)])
def test_the_documented_lead_keeps_the_damping(loop, kind, serial, h, allowed):
    lead = LEADS[kind, serial]
    assert loop(lead, h, kind, serial=serial) == pytest.approx(BALL.C1, rel=allowed)


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
@pytest.mark.parametrize(("kind", "serial"), LEADS)
def test_half_a_step_of_lead_is_half_a_step_of_stiffness(loop, kind, serial):
    """Too much adds K h/2 to the damping, too little takes it off: the measure that a wrong lead must show in."""
    h, lead = 1e-6, LEADS[kind, serial]
    for other in {0.0, 0.5} if serial else {1.0, 1.5}:
        wanted = BALL.C1 + BALL.K1 * h * (other - lead)
        assert loop(other, h, kind, serial=serial) == pytest.approx(wanted, abs=0.05 * BALL.C1)


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
def test_a_force_read_before_the_step_has_no_delay(loop):
    for lead in (END, EXTRAPOLATED, DEFAULT):
        assert loop(lead, 1e-5, "symplectic", serial=False, read_first=True) == pytest.approx(BALL.C1, rel=0.02)


@pytest.mark.parametrize("kind", ["cubic", "wide"])
@pytest.mark.parametrize("lead", [END, 0.5, EXTRAPOLATED, DEFAULT])
def test_outputs_follow_what_is_set(slave, kind, lead):
    """The force after a set is that of the inputs, before any step, and setting them back brings it back."""
    unit = slave(kind, lead=lead)
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
    told, ended = slave("wide", lead=EXTRAPOLATED, approach=u, rate=v), slave("wide", approach=u, rate=v)
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
    unit = slave("cubic", lead=EXTRAPOLATED, approach=0.9, rate=0.0)
    unit.step(0.01)
    assert unit.force(to, 0.0, 0.01) == pytest.approx(float(elements["cubic"].force(to, 0.0)), rel=1e-12)


@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0])
def test_a_master_that_goes_on_by_the_new_rate_is_foreseen(slave, elements, ratio):
    """Symplectic Euler under a constant acceleration, steps unequal: the force is that of where it will be."""
    u, v, a, h = 0.9, 0.3, -2.0, 0.01
    unit = slave("cubic", lead=EXTRAPOLATED, approach=u, rate=v)
    unit.step(h)
    v += a * h
    u += v * h
    force = unit.force(u, v, ratio * h)
    v += a * ratio * h
    u += v * ratio * h
    assert force == pytest.approx(float(elements["cubic"].force(u, v)), rel=1e-12)


@pytest.mark.parametrize("a", [0.0, 5.0])
def test_derivatives_of_outputs_in_time(slave, a):
    unit = slave("wide", lead=EXTRAPOLATED, approach=0.9, rate=0.2)
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


@pytest.mark.filterwarnings("ignore:.*used outside")
@pytest.mark.parametrize("h", [0.5, 2.0])
def test_long_steps_are_cut_inside(slave, film, h):
    """Approach and rate fall by what is extrapolated; steps of a thousandth give the same force."""
    u, v = 1.5, -0.9 / h
    coarse = slave("wide", lead=EXTRAPOLATED, approach=u, rate=v)
    coarse.step(h)
    T = np.linspace(0.0, h, 2001)
    fine = film.drive(T, u + v * T, np.full(T.size, v))[-1]
    whole = film.drive(T[[0, -1]], u + v * T[[0, -1]], np.full(2, v))[-1]
    assert coarse.get("force")[0] == pytest.approx(fine, rel=3e-4)
    assert abs(whole - fine) > abs(coarse.get("force")[0] - fine)
