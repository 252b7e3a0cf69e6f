"""CasADi on our FMUs for model exchange: rates, exact Jacobians, and its own integrator in a loop.

It is of the extra ``importers``; CI installs it where it can be had.
"""

import fmpy
import numpy as np
import pytest
from bearing_fmus import MODELS, RPM
from scipy.integrate import solve_ivp

from fmu import export
from reduced_models.bearing.kinematics import RPM_TO_RAD_S

casadi = pytest.importorskip("casadi")
OMEGA_N, END = 2.56, 4.0  # of a mass whose vibration parts the film, in units of 2a/u_sum
OUTPUTS = ["force", "stiffness", "damping"]


@pytest.fixture(params=[2, 3])
def block(request, elements, tmp_path):
    """``block("wide")``: (x, u) -> (ode, y) of an FMU, of either version."""

    def make(kind):
        path = export(elements[kind], tmp_path / "x.fmu", fmi=request.param)
        model = casadi.DaeBuilder(kind, str(fmpy.extract(str(path), unzipdir=str(tmp_path / "x"))))
        model.set_y(OUTPUTS)  # CasADi asks for all outputs as real numbers, and the others are Boolean
        assert model.u() == ["approach", "rate"]
        return model.create("f", ["x", "u"], ["ode", "y"])

    return make


def plain(matrix):
    return np.array(matrix)


@pytest.mark.parametrize("kind", ["memory", "wide"])
def test_rates_and_jacobian(block, elements, kind):
    f, element = block(kind), elements[kind]
    jacobian = f.factory("J", ["x", "u"], ["jac:ode:x", "jac:ode:u", "jac:y:x", "jac:y:u"])
    x, u = 0.3 * np.sin(1.0 + np.arange(element.state_count)), np.array([0.9, 0.1])

    def answer(x, u):
        force, rates = element.continuous(x, *u)
        return np.append(rates, force)

    rates, outputs = map(plain, f(x, u))
    assert np.append(rates, outputs[0]) == pytest.approx(answer(x, u), rel=1e-12, abs=1e-12)
    ode_x, ode_u, y_x, y_u = map(plain, jacobian(x, u))
    exact = np.block([[ode_x, ode_u], [y_x[:1], y_u[:1]]])
    z, h = np.append(x, u), 1e-6
    for k, column in enumerate(exact.T):
        ahead, back = (np.split(z + s * h * np.eye(z.size)[k], [x.size]) for s in (1.0, -1.0))
        difference = (answer(*ahead) - answer(*back)) / (2.0 * h)
        assert column == pytest.approx(difference, rel=1e-6, abs=1e-5)
    assert plain(y_u)[0] == pytest.approx(outputs[1:, 0], rel=1e-12)


def test_a_mass_in_a_loop_by_its_own_integrator(block, elements):
    f, element = block("wide"), elements["wide"]
    count = element.state_count
    motion, film = casadi.MX.sym("motion", 2), casadi.MX.sym("film", count)
    rates, outputs = f(film, motion)
    ode = casadi.vertcat(motion[1], OMEGA_N**2 * (1.0 - outputs[0]), rates)
    problem = {"x": casadi.vertcat(motion, film), "ode": ode}
    start = np.zeros(2 + count)
    start[0] = element.approach_at(1.3)
    options = {"abstol": 1e-10, "reltol": 1e-9, "max_num_steps": 100_000}
    found = plain(casadi.integrator("I", "cvodes", problem, 0.0, END, options)(x0=start)["xf"])[:, 0]

    def right_side(_, z):
        force, rates = element.continuous(z[2:], z[0], z[1])
        return np.concatenate([[z[1], OMEGA_N**2 * (1.0 - force)], rates])

    run = solve_ivp(right_side, (0.0, END), start, method="Radau", rtol=1e-9, atol=1e-11)
    assert found == pytest.approx(run.y[:, -1], abs=1e-6)


@pytest.mark.parametrize(
    ("name", "loads"),
    [("lossy", (0.0, 500.0)), pytest.param("five", (0.0, 500.0, -200.0), marks=pytest.mark.long)],
)
def test_a_bearing_starts_in_equilibrium(tmp_path, name, loads):
    """In FMI 2: of FMI 3 CasADi wants lists of all dependencies."""
    model, path = MODELS[name](), tmp_path / "x.fmu"
    export(model.bearing, path, speeds_rpm=model.speeds_rpm, load=model.load, directions=model.directions)
    block = casadi.DaeBuilder(name, str(fmpy.extract(str(path), unzipdir=str(tmp_path / "x"))))
    forces = [f"force_{k}" for k in "xyz"[: len(loads)]]
    block.set_y(forces)
    states, inputs = block.x(), block.u()
    x, u = np.array(block.start(states)), np.array(block.start(inputs))
    pushed = plain(block.create("f", ["x", "u"], ["y"])(x, u))
    assert u[inputs.index("speed")] == RPM * RPM_TO_RAD_S
    # the ring holds its load, but for a little that films add as their balls come under other loads
    assert pushed[:, 0] == pytest.approx(loads, abs=1e-4 * np.abs(loads).max())


@pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
@pytest.mark.parametrize("fmi", [2, 3])
def test_equations_of_a_rotor_and_their_jacobian(unit, instance, fmi):
    one = unit("wide", fmi)
    outputs = ["journal.x", "contact[1].force", "contact[2].approach"]
    block = casadi.DaeBuilder("rotor", str(one.folder))
    block.set_y(outputs)
    f = block.create("f", ["x", "u"], ["ode", "y"])
    model = instance("wide", fmi, exchange=True)
    model.start()
    states = [v.variable.name[4:-1] for v in model.description.derivatives]
    assert block.x() == states
    starts = {v.name: v.start for v in model.description.modelVariables}
    x = np.array([float(starts[name]) for name in states])
    u = np.array([10.0 * k for k in range(len(block.u()))])
    rates = model.place(x, **dict(zip(block.u(), u, strict=True)))
    ode, y = (np.array(part)[:, 0] for part in f(x, u))
    assert ode == pytest.approx(rates, rel=1e-13, abs=1e-300) and y == pytest.approx(
        model.get(*outputs), rel=1e-13
    )
    jacobian = f.factory("J", ["x", "u"], ["jac:ode:x", "jac:y:x"])
    ode_x, y_x = (np.array(part) for part in jacobian(x, u))
    rows = [model.reference[f"der({name})"] for name in states], [model.reference[name] for name in outputs]
    for k, name in enumerate(states):
        for found, references in ((ode_x, rows[0]), (y_x, rows[1])):
            column = np.array(model.raw.getDirectionalDerivative(references, [model.reference[name]], [1.0]))
            rounding = 1e-14 * np.abs(column).max()  # of what cancels between the two sides of the vee
            assert found[:, k] == pytest.approx(column, rel=1e-12, abs=rounding), name
