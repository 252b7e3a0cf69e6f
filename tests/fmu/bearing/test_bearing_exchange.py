"""Bearings in model exchange: equations beside Python, partial derivatives, events, solvers, states."""

import re
from ctypes import POINTER, c_double
from types import SimpleNamespace

import fmpy
import numpy as np
import pytest
from bearing_fmus import RPM, assert_states_start_as_declared
from exported import model_of
from fmpy.fmi1 import FMICallException
from fmpy.sundials import CVodeSolver
from scipy.integrate import solve_ivp

from fmu.bearing.continuous import state_points
from fmu.bearing.places import counted_from, rates_of
from fmu.bearing.references import knowns_of
from fmu.bearing.trial import START
from fmu.bearing.variables import FORCES, RATES, BallStates
from fmu.description_rules import findings
from fmu.driver import Exchange
from reduced_models import BearingMount, Rotor, simulate_rotor
from reduced_models.bearing.kinematics import RPM_TO_RAD_S

OMEGA = RPM * RPM_TO_RAD_S
LONG, SECONDS = pytest.mark.slow, pytest.mark.long
DEEP = 2e-6  # m of both approaches of a ball, from which the tables of both are within rounding of each other


def at_point(one, points, k):
    return knowns_of(one.model.directions, points.place[k], points.velocity[k], points.speed[k])


def forces_of(one):
    return [FORCES[name] for name in one.model.directions]


def states_of(one):
    return [variable.name for variable in model_of(one.model).spec.states]


def kind_of(name):
    return re.sub(r"\[\d+\]", "", name)


def approaches(one, states, place):
    """Of every ball and the inner race, and the outer race, shape (2, balls)."""
    bearing = one.model.bearing
    psi = states[0] + 2.0 * np.pi * np.arange(bearing.balls) / bearing.balls
    cos, sin = np.cos(psi), np.sin(psi)
    own = states[1 : 1 + len(BallStates.of(one.model).balls[0]) * bearing.balls].reshape(bearing.balls, -1).T
    if place.size == 2:
        return np.array([cos * place[0] + sin * place[1] - 0.5 * bearing.clearance - own[0], own[0]])
    g, at = one.model.motion().balls.grooves, counted_from(one.model)["place"][0]
    e, f = at / np.hypot(*at), np.array([-at[1], at[0]]) / np.hypot(*at)
    ball = at[:, None] + np.outer(e, own[0]) + np.outer(f, own[1])
    tilt = g.groove_circle * (sin * place[3] - cos * place[4])
    inner = np.array([g.radial + cos * place[0] + sin * place[1], g.axial + place[2] + tilt])
    return np.array([np.hypot(*(inner - ball)) - g.inner, np.hypot(*ball) - g.outer])


def indicators(model, count):
    found = np.zeros(count)
    model.raw.getEventIndicators(found.ctypes.data_as(POINTER(c_double)), count)
    return found


@pytest.mark.parametrize(
    ("name", "fmi"),
    [
        ("planar", 2),
        ("range", 3),
        ("dry", 2),
        ("five", 3),
        *(
            pytest.param(*case, marks=SECONDS)
            for case in (("five dry", 2), ("angular", 2), ("inner", 2), ("shared", 3), ("turning", 2))
        ),
    ],
)
def test_equations_are_those_of_python(made, name, fmi):
    """To rounding where balls carry load; elsewhere to the error of the cubics in Python.

    Both have ``bearing_rates``: what differs are tables, parameters and states that an FMU was made with.
    At contact angles little damps a ball across its contacts: rounding of the forces is over that damping.
    """
    one = made(name, fmi)
    assert findings(one.path) == ()
    names, points, model = states_of(one), state_points(one.model, 30, seed=5), one.exchange()
    kinds, pressed = np.array([kind_of(n) for n in names]), 0
    for k, states in enumerate(points.states):
        rates = model.place(states, **at_point(one, points, k))
        force = np.array(model.get(*forces_of(one)))
        assert np.abs(force - points.force[k]).max() < 1e-9 * np.abs(points.force[k]).max()
        error = np.abs(rates - points.rates[k])
        largest = np.array([np.abs(points.rates[k][kinds == kind]).max() for kind in kinds])
        assert np.all(error <= 2e-9 * largest)
        if "dry" in name:
            continue
        for ball, both in enumerate(approaches(one, states, points.place[k]).T, start=1):
            of_ball = np.array([n.startswith(f"ball[{ball}].") for n in names])
            if both.min() > DEEP:
                pressed += 1
                rounding = np.zeros(of_ball.sum())
                if len(one.model.directions) == 5:
                    load = max(model.get(f"ball[{ball}].load_inner", f"ball[{ball}].load_outer"))
                    rounding[:2] = np.finfo(float).eps * load / counted_from(one.model)["across"][0]
                assert np.all(error[of_ball] <= 1e-12 * largest[of_ball] + rounding)
                assert np.all(error[of_ball] <= 1e-11 * np.abs(points.rates[k][of_ball]))
    assert pressed > 20 or "dry" in name
    model.free()


@pytest.mark.parametrize(
    ("name", "fmi"),
    [
        ("planar", 2), ("range", 3), ("five", 2), pytest.param("shared", 3, marks=SECONDS),
        *(pytest.param(name, 2, marks=LONG) for name in ("angular", "inner", "turning")),
    ],
)  # fmt: skip
def test_partial_derivatives_are_those_of_differences(made, name, fmi):
    """At one point of three at least: tables have kinks, at which differences are of neither side."""
    one = made(name, fmi)
    spec, names, points, model = (
        model_of(one.model).spec,
        states_of(one),
        state_points(one.model, 3),
        one.exchange(),
    )
    outputs = [v.name for v in spec.outputs if v.type == "Real" and v.name != "cage_angle"]
    unknowns = [*outputs, *(f"der({n})" for n in names)]
    kinds, reference = np.array([kind_of(n) for n in unknowns]), [model.reference[n] for n in unknowns]
    finer = (
        0.1 if len(one.model.directions) == 5 else 1.0
    )  # what is across the contacts of a ball is little damped
    share = {"cage_angle": 1e-5, "ball.w": finer * 2e-4, "ball.a": 1e-6}
    sizes = {name: finer * (3e-8 if name.startswith("tilt") else 3e-10) for name in one.model.directions}
    sizes |= {RATES[name]: 1e-3 if name.startswith("tilt") else 1e-5 for name in one.model.directions}
    sizes |= {"speed": 1e-3 * points.speed[0]}
    of_ball = len(BallStates.of(one.model).balls[0])
    sizes |= {v.name: share.get(kind_of(v.name), 0.03) * v.nominal for v in spec.states}
    asked = list(sizes)[
        : 2 * len(one.model.directions) + 2 + of_ball
    ]  # inputs, cage, a ball; and a ball or the seat:
    asked.append(names[-1])
    off = np.full((len(asked), len(unknowns)), np.inf)  # over what is allowed, where it is least

    for at in range(3):

        def ask(known=None, step=0.0, at=at):
            inputs, states = at_point(one, points, at), points.states[at].copy()
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


@pytest.mark.parametrize(
    ("name", "fmi"),
    [("planar", 2), pytest.param("five", 3, marks=SECONDS), pytest.param("heavy five", 2, marks=SECONDS)],
)
def test_states_start_as_declared(made, name, fmi):
    one = made(name, fmi)
    assert_states_start_as_declared(one, len(states_of(one)))


@pytest.mark.parametrize(
    ("name", "states"), [("range", ("w",)), ("five", ("w", "a")), pytest.param("shared", ("w", "a"), marks=LONG)]
)
def test_states_at_the_start_follow_from_the_inputs(made, name, states):
    """Read, and differentiated, in initialization mode; a place set before is not one of rest."""
    one, h = made(name, 3), 1e-9
    place = one.model.place + (0.0 if "a" in states else np.array([0.0, -1e-6]))
    given = knowns_of(one.model.directions, place, 0.0 * place, 0.9 * one.model.speeds[-1] * RPM_TO_RAD_S)
    unknowns = [*forces_of(one), *(f"ball[{k}].{state}" for k in (1, 2) for state in states), "cage_angle"]

    def begun(known, by):
        model = Exchange(one.folder, one.description, [])
        model.set(cage_angle_start=START, **given | {known: given[known] + by})
        model.raw.enterInitializationMode()
        return model

    for known in one.model.directions:
        step, found = (100.0 * h if known.startswith("tilt") else h), []
        for by in (-step, step):
            model = begun(known, by)
            found.append(np.array(model.get(*unknowns)))
            model.free()
        model = begun(known, 0.0)
        references = [model.reference[n] for n in unknowns]
        exact = model.raw.getDirectionalDerivative(references, [model.reference[known]], [1.0])
        difference = (found[1] - found[0]) / (2.0 * step)
        for part in np.split(np.arange(len(unknowns)), [len(forces_of(one))]):  # forces, then places
            size = np.abs(difference[part]).max()
            assert np.array(exact)[part] == pytest.approx(difference[part], rel=1e-5, abs=1e-6 * size)
        model.raw.exitInitializationMode()
        values = np.array(model.get(*states_of(one)))
        _, pushed = rates_of(one.model).at(given["speed"], values, place, 0.0 * place)
        assert model.get(*forces_of(one)) == pytest.approx(-pushed, rel=1e-9, abs=1e-6)
        model.free()


@pytest.mark.parametrize(
    ("name", "contacts"),
    [("planar", ("inner", "outer")), ("range", ("inner",)), ("dry", ("inner",)), ("five", ("inner",))],
)
def test_events_are_where_contacts_lift_off(made, name, contacts):
    one = made(name)
    model, points, balls = one.exchange(), state_points(one.model, 30, seed=5), one.model.bearing.balls
    seen, parted = set(), re.compile(r"ball\[[13579]\].s_(inner|outer)")
    apart = [parted.fullmatch(name) is not None for name in states_of(one)]
    for k, states in enumerate(points.states):
        states = np.where(apart, -2e-5, states)
        model.place(states, **at_point(one, points, k) | {"y": -2e-6 * k})
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


@pytest.mark.parametrize("name", ["planar", "five"])
def test_saved_states_bring_back_rates_to_the_bit(made, name):
    one = made(name)
    points, model, other = state_points(one.model, 3), one.exchange(), one.exchange()
    rates = model.place(points.states[1], **at_point(one, points, 1))
    kept = model.raw.getFMUState()
    content = model.raw.serializeFMUState(kept)
    model.place(points.states[2], **at_point(one, points, 2))
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
@pytest.mark.parametrize("name", ["planar", "five"])
def test_bad_inputs_are_told_and_leave_a_usable_instance(made, name, wrong, words):
    one, messages = made(name), []
    points = state_points(one.model, 2)
    model = Exchange(one.folder, one.description, messages, loggingOn=True)
    model.start(cage_angle_start=START)
    rates = model.place(points.states[1], **at_point(one, points, 1))
    for bad in (
        {"inputs": wrong},
        {"states": np.full(rates.size, np.nan)},
        {"states": np.full(rates.size, 1e280)},
    ):
        with pytest.raises(FMICallException):
            model.place(bad.get("states", points.states[1]), **bad.get("inputs", {}))
        assert words in messages[-1] or "states" in bad
        again = model.place(points.states[1], **at_point(one, points, 1))
        assert again.tobytes() == rates.tobytes()
    model.free()


@pytest.mark.parametrize(("name", "dry"), [("range", "dry"), ("five", "five dry")])
def test_a_bearing_without_its_film_is_the_dry_one(made, name, dry):
    where = {"x": 3e-6, "y": -1.1e-5, "speed": OMEGA} | ({"z": 8e-5, "tilt_y": 1e-4} if name == "five" else {})
    oil, without = made(name).exchange(film=0.0, **where), made(dry).exchange(**where)
    forces = forces_of(made(name))
    assert oil.get(*forces) == pytest.approx(without.get(*forces), rel=1e-12)
    known = [oil.reference["y"]]
    for model in (oil, without):
        h, found = 1e-10, []
        for y in (where["y"] - h, where["y"] + h):
            model.set(y=y)
            found.append(model.get("force_y")[0])
        model.set(y=where["y"])
        exact = model.raw.getDirectionalDerivative([model.reference["force_y"]], known, [1.0])[0]
        assert exact == pytest.approx((found[1] - found[0]) / (2.0 * h), rel=1e-6)
        model.free()


@pytest.mark.parametrize(
    ("name", "own"), [("planar", "ball[1].v"), ("five", "ball[1].a"), ("five", "seat_tilt_x[2]")]
)
def test_states_in_steps_move_by_their_rates(made, name, own):
    """In co-simulation they are read, and their derivatives; steps have no partial derivatives."""
    one = made(name)
    place = dict(zip(one.model.directions, one.model.place.tolist(), strict=True))
    place["y"] = -1.3e-5 if name == "planar" else place["y"]
    slave, h = one.started(**place | {"x": 0.0}, speed=OMEGA), 1e-7
    names = ["cage_angle", "ball[1].w", own, "ball[1].s_inner", "ball[1].q_outer[1]", "seat_y[3]"]
    for k in range(1, 400):
        t = k * h
        slave.set(y=place["y"] + 1e-6 * np.sin(4e3 * t) ** 2, velocity_y=4e-3 * np.sin(8e3 * t))
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


class Body:
    """A rigid body on the bearing; its states, over nominal values: place, velocity, those of the FMU."""

    def __init__(self, one, rotor, start):
        self.states, names, n = states_of(one), one.model.directions, start.size
        self.n, self.inverse, self.load = n, np.linalg.inv(rotor.mass), rotor.load
        self.damping = rotor.gyroscopic * one.model.speeds[-1] * RPM_TO_RAD_S
        sizes = [v.nominal for v in model_of(one.model).spec.states]
        steep = np.where([name.startswith("tilt") for name in names], 100.0, 1.0)
        self.scale = np.concatenate([1e-6 * steep, 1e-3 * steep, sizes])
        self.inputs = [*names, *(RATES[name] for name in names)]
        still = dict(zip(names, start.tolist(), strict=True))
        self.model = one.exchange(**still, speed=float(one.model.speeds[-1] * RPM_TO_RAD_S))
        self.start = np.concatenate([start, np.zeros(n), self.model.get(*self.states)]) / self.scale
        self.forces = forces_of(one)
        self.knowns = [self.model.reference[name] for name in (*self.inputs, *self.states)]
        unknowns = (*self.forces, *(f"der({name})" for name in self.states))
        self.unknowns = [self.model.reference[name] for name in unknowns]

    def rates(self, t, z):
        z, n = z * self.scale, self.n
        rates = self.model.place(z[2 * n :], **dict(zip(self.inputs, z[: 2 * n].tolist(), strict=True)))
        force = np.array(self.model.get(*self.forces)) + self.load - self.damping @ z[n : 2 * n]
        return np.concatenate([z[n : 2 * n], self.inverse @ force, rates]) / self.scale

    def jacobian(self, t, z):
        self.rates(t, z)
        n, found = self.n, np.zeros((z.size, z.size))
        found[:n, n : 2 * n], found[n : 2 * n, n : 2 * n] = np.eye(n), -self.inverse @ self.damping
        for j, known in enumerate(self.knowns):
            column = np.array(self.model.raw.getDirectionalDerivative(self.unknowns, [known], [1.0]))
            found[n : 2 * n, j] += self.inverse @ column[:n]
            found[2 * n :, j] = column[n:]
        return found * self.scale / self.scale[:, None]


def by_scipy(loop, until):
    """Places at eleven times, shape (11, n), by Radau with the Jacobian of the FMU."""
    t = np.linspace(0.0, until, 11)
    run = solve_ivp(
        loop.rates, (0.0, until), loop.start, method="Radau", rtol=1e-6, atol=1e-6, jac=loop.jacobian, t_eval=t
    )
    assert run.success
    return run.y[: loop.n].T * loop.scale[: loop.n]


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
        0.0, relativeTolerance=1e-8, maxNumSteps=100_000,
    )  # fmt: skip
    t, found = 0.0, [z[: loop.n].copy()]
    for k in range(1, 11):
        while t < k * until / 10 * (1.0 - 1e-12):
            event, _, t = solver.step(t, k * until / 10)
            if event:
                solver.reset(t)
        found.append(z[: loop.n].copy())
    return np.array(found) * loop.scale[: loop.n]


def rotor_on(one):
    """A body on the bearing under its load; with tilts it has gyroscopic moments."""
    n, ends = len(one.model.directions), dict(zip(("x", "y", "z", "tilt_x", "tilt_y"), range(5), strict=True))
    mount = BearingMount(
        bearing=one.model.bearing, cage_angle=START, **{name: ends[name] for name in one.model.directions}
    )
    gyroscopic, load = np.zeros((n, n)), np.zeros(n)
    if n == 2:
        load[1] = -500.0
    else:
        gyroscopic[3, 4], gyroscopic[4, 3] = 4e-3, -4e-3
        load[:3] = one.model.load
    mass = np.diag([5.0, 5.0, 5.0, 2e-3, 2e-3][:n])
    return Rotor(mass=mass, stiffness=np.zeros((n, n)), mounts=(mount,), load=load, gyroscopic=gyroscopic)


def in_steps(one, rotor, start, until, dt):
    run = simulate_rotor(
        rotor, speed_rpm=float(one.model.speeds[-1]), dt=dt, until=until, start=(start, 0.0 * start)
    )
    return run.displacement[:: round(until / 10 / dt)][:11]


@pytest.mark.parametrize(
    ("name", "solve", "until", "within"),
    [
        pytest.param("lossy", by_cvode, 4e-5, 1e-6, marks=SECONDS),
        # of a motion that has hardly begun
        pytest.param("five", by_cvode, 1e-4, 2e-6, marks=SECONDS),
        *(
            pytest.param(name, solve, until, within, marks=LONG)
            for names, solve, until, within in (
                (("lossy", "range"), by_scipy, 4e-4, 1e-6),
                (("five", "shared"), by_scipy, 1e-4, 2e-6),
                (("lossy", "range", "five", "angular", "inner", "shared"), by_cvode, 4e-4, 1e-6),
            )
            for name in names
        ),
    ],
)
def test_a_body_in_model_exchange_is_the_run_of_a_rotor(made, name, solve, until, within):
    """The run in steps converges to it with second order."""
    one = made(name)
    rotor, start = rotor_on(one), one.model.place.copy()
    start[:2] += 1e-6
    loop = Body(one, rotor, start)
    exact = solve(loop, until)
    loop.model.free()
    size = np.ptp(exact, axis=0)
    size[:3], size[3:] = size[:3].max(), size[3:].max(initial=0.0)
    errors = [(np.abs(in_steps(one, rotor, start, until, dt) - exact) / size).max() for dt in (2e-6, 1e-6, 5e-7)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.2)
    assert errors[2] < within


@pytest.mark.long
@pytest.mark.parametrize("name", ["range", "five"])
def test_fmpy_runs_model_exchange(made, name):
    """The ring stands still while balls go round, beside steps of co-simulation."""
    one, until, steps = made(name), 1e-3, 200
    outputs = [*forces_of(one), "cage_angle"]
    given = dict(zip(one.model.directions, one.model.place.tolist(), strict=True)) | {"speed": OMEGA}
    result = fmpy.simulate_fmu(
        str(one.path), fmi_type="ModelExchange", stop_time=until, output_interval=until / 10,
        relative_tolerance=1e-7, output=outputs,
        start_values={"cage_angle_start": START} | given,
    )  # fmt: skip
    slave = one.started(**given)
    for _ in range(steps):
        slave.step(until / steps)
    wanted = slave.get(*outputs)
    slave.free()
    assert list(result[-1])[1:] == pytest.approx(wanted, rel=1e-5, abs=1e-5)
