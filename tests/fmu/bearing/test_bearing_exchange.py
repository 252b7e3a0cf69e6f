"""Planar bearings in model exchange: equations beside Python, partial derivatives, events, solvers, states."""

import re
from ctypes import POINTER, c_double
from types import SimpleNamespace

import fmpy
import numpy as np
import pytest
from bearing_fmus import RPM
from fmpy.fmi1 import FMICallException
from fmpy.sundials import CVodeSolver
from fmpy.validation import validate_fmu
from scipy.integrate import solve_ivp

from fmu.bearing.continuous import rates_in_time, state_points
from fmu.bearing.trial import START
from fmu.driver import Exchange
from fmu.fmu_model import fmu_model
from reduced_models import BearingMount, Rotor, simulate_rotor
from reduced_models.bearing.kinematics import RPM_TO_RAD_S

OMEGA = RPM * RPM_TO_RAD_S
DEEP = 2e-6  # m of both approaches of a ball, from which the tables of both are within rounding of each other


def at_point(points, k):
    x, y = points.place[k].tolist()
    velocity_x, velocity_y = points.velocity[k].tolist()
    return {"x": x, "y": y, "velocity_x": velocity_x, "velocity_y": velocity_y, "speed": float(points.speed[k])}


def states_of(one):
    return [variable.name for variable in fmu_model(one.model).spec.states]


def kind_of(name):
    return re.sub(r"\[\d+\]", "", name)


def deltas(one, angle, place):
    """By how much the rings come closer at every ball."""
    bearing = one.model.bearing
    psi = angle + 2.0 * np.pi * np.arange(bearing.balls) / bearing.balls
    return np.cos(psi) * place[0] + np.sin(psi) * place[1] - 0.5 * bearing.clearance


def indicators(model, count):
    found = np.zeros(count)
    model.raw.getEventIndicators(found.ctypes.data_as(POINTER(c_double)), count)
    return found


@pytest.mark.parametrize(("name", "fmi"), [("planar", 2), ("range", 3), ("dry", 2)])
def test_equations_are_those_of_python(made, name, fmi):
    """To rounding where balls carry load; elsewhere both have their own tables of one curve."""
    one = made(name, fmi)
    assert validate_fmu(str(one.path)) == []
    names, points, model = states_of(one), state_points(one.model, 30, seed=5), one.exchange()
    kinds, pressed = np.array([kind_of(n) for n in names]), 0
    for k, states in enumerate(points.states):
        rates = model.place(states, **at_point(points, k))
        force = np.array(model.get("force_x", "force_y"))
        assert np.abs(force - points.force[k]).max() < 1e-10 * np.abs(points.force[k]).max()
        error = np.abs(rates - points.rates[k])
        for kind in set(kinds):
            assert error[kinds == kind].max() <= 1e-8 * np.abs(points.rates[k][kinds == kind]).max()
        for ball in range(1, one.model.bearing.balls + 1):
            of_ball = np.array([n.startswith(f"ball[{ball}].") for n in names])
            if (
                of_ball.any()
                and DEEP < states[of_ball][0] < deltas(one, states[0], points.place[k])[ball - 1] - DEEP
            ):
                pressed += 1
                assert np.all(error[of_ball] <= 1e-12 * np.abs(points.rates[k][of_ball]))
    assert pressed > 20 or name == "dry"
    model.free()


@pytest.mark.parametrize(("name", "fmi"), [("planar", 2), ("range", 3)])
def test_partial_derivatives_are_those_of_differences(made, name, fmi):
    """At one point of three at least: tables have kinks, at which differences are of neither side."""
    one = made(name, fmi)
    spec, names, points, model = (
        fmu_model(one.model).spec,
        states_of(one),
        state_points(one.model, 3),
        one.exchange(),
    )
    outputs = [v.name for v in spec.outputs if v.type == "Real" and v.name != "cage_angle"]
    unknowns = [*outputs, *(f"der({n})" for n in names)]
    kinds, reference = np.array([kind_of(n) for n in unknowns]), [model.reference[n] for n in unknowns]
    share = {"cage_angle": 1e-5, "ball.w": 2e-4}
    sizes = {"x": 3e-10, "y": 3e-10, "velocity_x": 1e-5, "velocity_y": 1e-5, "speed": 1e-3 * OMEGA}
    sizes |= {v.name: share.get(kind_of(v.name), 0.03) * v.nominal for v in spec.states}
    asked = [*list(sizes)[: 5 + 1 + 34], names[-1]]  # inputs, cage, a ball, and a ball or the seat
    off = np.full((len(asked), len(unknowns)), np.inf)  # over what is allowed, where it is least

    for at in range(3):

        def ask(known=None, step=0.0, at=at):
            inputs, states = at_point(points, at), points.states[at].copy()
            if known in inputs:
                inputs[known] += step
            elif known is not None:
                states[names.index(known)] += step
            model.place(states, **inputs)
            return np.array(model.get(*unknowns))

        here = ask()
        largest = np.array([np.abs(here[kinds == kind]).max() for kind in kinds])
        for k, known in enumerate(asked):
            h = sizes[known]
            half, whole = ask(known, h / 2) - ask(known, -h / 2), ask(known, h) - ask(known, -h)
            difference = (8.0 * half - whole) / (6.0 * h)
            ask()
            exact = np.array(model.raw.getDirectionalDerivative(reference, [model.reference[known]], [1.0]))
            allowed = 1e-6 * np.abs(exact) + 1e-12 * largest / h + 1e-300
            off[k] = np.minimum(off[k], np.abs(exact - difference) / allowed)
            if fmi == 3:
                weights, backwards = np.cos(np.arange(exact.size)).tolist(), model.raw.getAdjointDerivative
                (found,) = backwards(reference, [model.reference[known]], weights, nSensitivity=1)
                assert found == pytest.approx(exact @ weights, rel=1e-12)
    k, j = np.unravel_index(off.argmax(), off.shape)
    assert off.max() <= 1.0, (unknowns[j], asked[k])
    model.free()


def test_states_at_the_start_follow_from_the_inputs(made):
    """Read, and differentiated, in initialization mode; a place set before is not one of rest."""
    one = made("range", 3)
    given = {"x": 0.0, "y": -9e-6, "velocity_x": 0.0, "velocity_y": 0.0, "speed": 0.9 * OMEGA}
    unknowns, h = ["force_y", "ball[1].w", "ball[2].w", "cage_angle"], 1e-9

    def begun(y):
        model = Exchange(one.folder, one.description, [])
        model.set(cage_angle_start=START, **given | {"y": y})
        model.raw.enterInitializationMode()
        return model

    found = []
    for y in (given["y"] - h, given["y"] + h):
        model = begun(y)
        found.append(np.array(model.get(*unknowns)))
        model.free()
    model = begun(given["y"])
    references = [model.reference[n] for n in unknowns]
    exact = model.raw.getDirectionalDerivative(references, [model.reference["y"]], [1.0])
    assert exact == pytest.approx((found[1] - found[0]) / (2.0 * h), rel=1e-6)
    model.raw.exitInitializationMode()
    states, place = np.array(model.get(*states_of(one))), np.array([0.0, given["y"]])
    _, force = rates_in_time(one.model.motion(), states, place, np.zeros(2), given["speed"])
    assert model.get("force_x", "force_y") == pytest.approx(force, rel=1e-9, abs=1e-6)
    model.free()


@pytest.mark.parametrize(
    ("name", "contacts"), [("planar", ("inner", "outer")), ("range", ("inner",)), ("dry", ("inner",))]
)
def test_events_are_where_contacts_lift_off(made, name, contacts):
    one = made(name)
    model, points, balls = one.exchange(), state_points(one.model, 30, seed=5), one.model.bearing.balls
    seen, parted = set(), re.compile(r"ball\[[13579]\].s_(inner|outer)")
    for k, states in enumerate(points.states):
        states = np.where([parted.fullmatch(n) is not None for n in states_of(one)], -2e-5, states)
        model.place(states, **at_point(points, k) | {"y": -2e-6 * k})
        loads = np.array(model.get(*(f"ball[{b}].load_{race}" for b in range(1, balls + 1) for race in contacts)))
        signs = np.sign(indicators(model, loads.size))
        assert np.array_equal(signs, np.where(loads > 0.0, 1.0, -1.0))
        seen |= set(signs)
    assert seen == {1.0, -1.0}  # some balls carry load, some none
    model.raw.enterEventMode()
    needed, ended, nominals, values, timed, _ = model.raw.newDiscreteStates()
    assert (needed, ended, nominals, values, timed) == (False, False, True, False, False)
    assert model.raw.newDiscreteStates()[2] is False  # told once
    model.free()


def test_saved_states_bring_back_rates_to_the_bit(made):
    one = made("planar")
    points, model, other = state_points(one.model, 3), one.exchange(), one.exchange()
    rates = model.place(points.states[1], **at_point(points, 1))
    kept = model.raw.getFMUState()
    content = model.raw.serializeFMUState(kept)
    model.place(points.states[2], **at_point(points, 2))
    model.raw.setFMUState(kept)
    read = other.raw.deserializeFMUState(content)
    other.raw.setFMUState(read)
    for unit in (model, other):
        assert unit.place(points.states[1]).tobytes() == rates.tobytes()
    slave = one.started()
    with pytest.raises(FMICallException):  # a state of the other kind of instance
        slave.raw.setFMUState(slave.raw.deserializeFMUState(content))
    model.raw.freeFMUState(kept)
    other.raw.freeFMUState(read)
    for unit in (model, other, slave):
        unit.free()


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"y": np.nan}, "must be finite"),
        ({"y": 0.5}, "farther from the outer one"),
        ({"speed": -1.0}, "speed must be"),
    ],
)
def test_bad_inputs_are_told_and_leave_a_usable_instance(made, wrong, words):
    one, messages = made("planar"), []
    points = state_points(one.model, 2)
    model = Exchange(one.folder, one.description, messages, loggingOn=True)
    model.start(cage_angle_start=START)
    rates = model.place(points.states[1], **at_point(points, 1))
    for bad in (
        {"inputs": wrong},
        {"states": np.full(rates.size, np.nan)},
        {"states": np.full(rates.size, 1e280)},
    ):
        with pytest.raises(FMICallException):
            model.place(bad.get("states", points.states[1]), **bad.get("inputs", {}))
        assert words in messages[-1] or "states" in bad
        again = model.place(points.states[1], **at_point(points, 1))
        assert again.tobytes() == rates.tobytes()
    model.free()


def test_a_bearing_without_its_film_is_the_dry_one(made):
    oil, dry = made("range").exchange(film=0.0), made("dry").exchange()
    where = {"x": 3e-6, "y": -1.1e-5, "speed": OMEGA}
    for model in (oil, dry):
        model.set(**where)
    assert oil.get("force_x", "force_y") == pytest.approx(dry.get("force_x", "force_y"), rel=1e-12)
    known = [oil.reference["y"]]
    for model in (oil, dry):
        h, found = 1e-10, []
        for y in (where["y"] - h, where["y"] + h):
            model.set(y=y)
            found.append(model.get("force_y")[0])
        model.set(y=where["y"])
        exact = model.raw.getDirectionalDerivative([model.reference["force_y"]], known, [1.0])[0]
        assert exact == pytest.approx((found[1] - found[0]) / (2.0 * h), rel=1e-6)
        model.free()


def test_states_in_steps_move_by_their_rates(made):
    """In co-simulation they are read, and their derivatives; steps have no partial derivatives."""
    one = made("planar")
    slave, h = one.started(x=0.0, y=-1.3e-5, speed=OMEGA), 1e-7
    names = ["cage_angle", "ball[1].w", "ball[1].v", "ball[1].s_inner", "ball[1].q_outer[1]", "seat_y[3]"]
    for k in range(1, 400):
        t = k * h
        slave.set(y=-1.3e-5 + 1e-6 * np.sin(4e3 * t) ** 2, velocity_y=4e-3 * np.sin(8e3 * t))
        slave.step(h)
        if k == 397:
            before = np.array(slave.get(*names))
        if k == 398:
            rates = np.array(slave.get(*(f"der({n})" for n in names)))
    mean = (np.array(slave.get(*names)) - before) / (2.0 * h)
    assert rates == pytest.approx(mean, rel=2e-3)
    with pytest.raises(FMICallException):
        slave.gradient("force_y", "y")
    slave.free()


class Mass:
    """A mass on the bearing; its states, over nominal values: place, velocity, those of the FMU."""

    def __init__(self, one, mass, start):
        self.names, self.mass = states_of(one), mass
        sizes = [v.nominal for v in fmu_model(one.model).spec.states]
        self.scale = np.concatenate([[1e-6] * 2, [1e-3] * 2, sizes])
        self.model = one.exchange(x=start[0], y=start[1], speed=OMEGA)
        self.start = np.concatenate([start, np.zeros(2), self.model.get(*self.names)]) / self.scale
        self.knowns = [self.model.reference[n] for n in ("x", "y", "velocity_x", "velocity_y", *self.names)]
        self.unknowns = [
            self.model.reference[n] for n in ("force_x", "force_y", *(f"der({n})" for n in self.names))
        ]

    def rates(self, t, z):
        z = z * self.scale
        rates = self.model.place(z[4:], x=z[0], y=z[1], velocity_x=z[2], velocity_y=z[3])
        force = np.array(self.model.get("force_x", "force_y")) + np.array([0.0, -500.0])
        return np.concatenate([z[2:4], force / self.mass, rates]) / self.scale

    def jacobian(self, t, z):
        self.rates(t, z)
        found = np.zeros((z.size, z.size))
        found[:2, 2:4] = np.eye(2)
        for j, known in enumerate(self.knowns):
            column = np.array(self.model.raw.getDirectionalDerivative(self.unknowns, [known], [1.0]))
            found[2:4, j], found[4:, j] = column[:2] / self.mass, column[2:]
        return found * self.scale / self.scale[:, None]


def by_scipy(loop, until):
    """Places at eleven times, shape (11, 2), by Radau with the Jacobian of the FMU."""
    t = np.linspace(0.0, until, 11)
    run = solve_ivp(
        loop.rates, (0.0, until), loop.start, method="Radau", rtol=1e-6, atol=1e-6, jac=loop.jacobian, t_eval=t
    )
    assert run.success
    return run.y[:2].T * 1e-6


def by_cvode(loop, until):
    """The same by CVODE as fmpy has it, which looks for events and makes a Jacobian of its own."""
    z, count = loop.start.copy(), loop.model.description.numberOfEventIndicators

    def entries(pointer, n):
        return np.ctypeslib.as_array(pointer, (n,))

    def get(pointer, n):
        entries(pointer, n)[:] = z

    def put(pointer, n):
        z[:] = entries(pointer, n)

    def rates(pointer, n):
        entries(pointer, n)[:] = loop.rates(0.0, z)

    def events(pointer, n):
        loop.rates(0.0, z)
        entries(pointer, n)[:] = indicators(loop.model, n)

    def nominals(pointer, n):
        entries(pointer, n)[:] = 1.0

    solver = CVodeSolver(
        z.size, count, get, put, rates, events, nominals, lambda t: None, SimpleNamespace(apply=lambda t: None),
        0.0, relativeTolerance=1e-7, maxNumSteps=100_000,
    )  # fmt: skip
    t, found = 0.0, [z[:2].copy()]
    for k in range(1, 11):
        while t < k * until / 10 * (1.0 - 1e-12):
            event, _, t = solver.step(t, k * until / 10)
            if event:
                solver.reset(t)
        found.append(z[:2].copy())
    return np.array(found) * 1e-6


def on_bearing(one, mass, start, until, dt):
    mount = BearingMount(bearing=one.model.bearing, x=0, y=1, cage_angle=START)
    rotor = Rotor(mass=mass * np.eye(2), stiffness=np.zeros((2, 2)), mounts=(mount,), load=np.array([0.0, -500.0]))
    run = simulate_rotor(rotor, speed_rpm=RPM, dt=dt, until=until, start=(start, np.zeros(2)))
    return run.displacement[:: round(until / 10 / dt)][:11]


LONG = pytest.mark.slow


@pytest.mark.parametrize(
    ("name", "solve", "until"),
    [
        ("lossy", by_cvode, 4e-5),
        *(
            pytest.param(name, solve, 4e-4, marks=LONG)
            for name in ("lossy", "range")
            for solve in (by_scipy, by_cvode)
        ),
    ],
)
def test_a_mass_in_model_exchange_is_the_run_of_a_rotor(made, name, solve, until):
    """The run in steps converges to it with second order."""
    one = made(name)
    start = one.model.place + np.array([1e-6, 1e-6])
    loop = Mass(one, 5.0, start)
    exact = solve(loop, until)
    loop.model.free()
    size = np.ptp(exact, axis=0).max()
    errors = [np.abs(on_bearing(one, 5.0, start, until, dt) - exact).max() / size for dt in (2e-6, 1e-6, 5e-7)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.2)
    assert errors[2] < 1e-6


def test_fmpy_runs_model_exchange(made):
    """The ring stands still while balls go round, beside steps of co-simulation."""
    one, until, steps = made("range"), 1e-3, 200
    given = dict(zip(("x", "y"), one.model.place.tolist(), strict=True)) | {"speed": OMEGA}
    result = fmpy.simulate_fmu(
        str(one.path), fmi_type="ModelExchange", stop_time=until, output_interval=until / 10,
        relative_tolerance=1e-7, output=["force_x", "force_y", "cage_angle"],
        start_values={"cage_angle_start": START} | given,
    )  # fmt: skip
    slave = one.started(**given)
    for _ in range(steps):
        slave.step(until / steps)
    wanted = slave.get("force_x", "force_y", "cage_angle")
    slave.free()
    assert list(result[-1])[1:] == pytest.approx(wanted, rel=1e-5, abs=1e-5)
