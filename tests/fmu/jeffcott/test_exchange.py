"""The FMU of a rotor in model exchange: a loop around it, events, all its partial derivatives."""

from ctypes import POINTER, c_double

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu
from scipy.integrate import solve_ivp

from fmu import export
from reduced_models import jeffcott_rotor, simulate_rotor

BALL, WEIGHT = 850.0, 2.3 * 9.81  # N
BODIES = {
    "disc_mass": 2.0,
    "journal_mass": 0.3,
    "shaft_stiffness": 2e8,
    "shaft_damping": 60.0,
    "disc_damping": 1.0,
}

pytestmark = pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")


def started(instance, name, fmi=2):
    """A model in continuous time, its states and what it is."""
    model = instance(name, fmi, exchange=True)
    names = [variable.variable.name[4:-1] for variable in model.description.derivatives]
    if fmi == 2:
        starts = {v.name: v.start for v in model.description.modelVariables}
    else:
        starts = {v.name: v.start for v in model.description.modelVariables if v.start is not None}
    model.start()
    return model, names, np.array([float(starts[name]) for name in names])


@pytest.mark.parametrize("name", [pytest.param("wide", marks=pytest.mark.long), "cubic"])
def test_a_loop_around_it_converges_to_co_simulation(instance, rotors, motion_of, name):
    """As tight as the loop is told to be, it comes to what ever shorter steps of `simulate_rotor` come to."""
    unit, _, x0 = started(instance, name)
    model, until = rotors[name], 1e-3
    ends = []
    for dt in (2e-6, 1e-6):
        run = simulate_rotor(model.running(), dt=dt, until=until, tolerance=1e-10)
        ends.append(motion_of(run)[-1])
        size = np.ptp(motion_of(run), axis=0)
    exact = ends[1] + (ends[1] - ends[0]) / 3.0
    gaps = []
    for rtol in (1e-4, 1e-6, 1e-9):
        atol = rtol * 1e-2 * np.append(size, np.ones(x0.size - size.size))
        found = solve_ivp(lambda _, x: unit.place(x), (0.0, until), x0, method="Radau", rtol=rtol, atol=atol)
        assert found.success
        gaps.append(np.max(np.abs(found.y[: size.size, -1] - exact) / size))
    assert gaps[1] <= 0.3 * gaps[0] and gaps[2] <= 1e-5
    step = np.max(np.abs(ends[1] - exact) / size)
    assert gaps[2] <= step  # nearer than the shorter steps themselves


@pytest.mark.parametrize(
    ("name", "fmi"),
    [
        ("wide in y", 2),
        ("mixed", 3),
        *(pytest.param(name, 2, marks=pytest.mark.slow) for name in ("alone", "mixed", "alone in y")),
    ],
)
def test_every_partial_derivative_against_differences(instance, rotors, name, fmi):
    unit, states, x0 = started(instance, name, fmi)
    model = rotors[name]
    description = unit.description
    inputs = [v.name for v in description.modelVariables if v.causality == "input"]
    outputs = [v.variable.name for v in description.outputs if v.variable.type in ("Real", "Float64")]
    derivatives = [v.variable.name for v in description.derivatives]
    unknowns = [*outputs, *derivatives]
    load = float(np.abs(model.rotor.load).sum())
    x0 = x0 + 1e-2 * np.sin(np.arange(x0.size)) * np.where(x0 != 0.0, np.abs(x0), 0.0)
    count = 2 * model.rotor.size
    x0[count // 2 : count] = 1e-3
    x0[count] = 0.7  # angle
    x0[count + 1 :] = 0.02 * np.cos(np.arange(x0.size - count - 1))
    sizes = dict(
        zip(states, [1e-6] * (count // 2) + [1e-2] * (count // 2) + [1.0] * (x0.size - count), strict=True)
    )
    turning = {"unbalance[1]": 1e-4, "speed": 1e2, "angular_acceleration": 1e4}
    sizes |= dict.fromkeys(inputs, load) | turning
    base = dict(zip(states, x0, strict=True)) | dict.fromkeys(inputs, 0.1 * load)
    base |= {"unbalance[1]": 3e-5, "speed": 700.0, "angular_acceleration": 3e4}

    def ask(values):
        rates = unit.place(np.array([values[n] for n in states]), **{n: values[n] for n in inputs})
        return np.concatenate([unit.get(*outputs), rates])

    scale = np.abs(ask(base)) + 1e-9
    for known, size in sizes.items():
        h = 1e-5 * size
        ends = [ask(base | {known: base[known] + sign * h}) for sign in (1.0, -1.0)]
        difference = (ends[0] - ends[1]) / (2.0 * h)
        ask(base)
        references = [unit.reference[n] for n in unknowns], [unit.reference[known]]
        exact = np.array(unit.raw.getDirectionalDerivative(*references, [1.0]))
        wrong = np.abs(exact - difference) * size > 1e-6 * np.maximum(np.abs(exact) * size, scale)
        assert not wrong.any(), (known, [n for n, w in zip(unknowns, wrong, strict=True) if w])
        declared = {
            v.variable.name: [d.name for d in v.dependencies]
            for v in (*description.outputs, *description.derivatives)
        }
        if known in (*states, *inputs):
            for n, value in zip(unknowns, exact, strict=True):
                assert value == 0.0 or known in declared[n], (n, known)


@pytest.mark.parametrize(("name", "fmi"), [("alone", 2), ("mixed", 2), ("mixed", 3)])
def test_fmpy_finds_nothing_wrong(unit, name, fmi):
    assert validate_fmu(str(unit(name, fmi).path)) == []


def test_adjoint_is_the_transpose(instance, rotors):
    unit, states, x0 = started(instance, "mixed", 3)
    unit.place(x0)
    unknowns = [unit.reference[v.variable.name] for v in unit.description.derivatives]
    knowns = [unit.reference[name] for name in (*states, "disc.force_x", "unbalance[1]")]
    columns = np.array([unit.raw.getDirectionalDerivative(unknowns, [known], [1.0]) for known in knowns]).T
    rows = np.array(
        [
            unit.raw.getAdjointDerivative(unknowns, knowns, list(seed), len(knowns))
            for seed in np.eye(len(unknowns))
        ]
    )
    assert rows == pytest.approx(columns, rel=1e-14)


@pytest.mark.parametrize("fmi", [2, 3])
def test_one_event_indicator_for_each_contact(instance, rotors, fmi):
    """Above zero while they push; the one that is left tells of it, and none of a rotor alone."""
    unit, states, x0 = started(instance, "cubic", fmi)
    found = np.zeros(2)
    get = unit.raw.getEventIndicators

    def indicators(x):
        unit.place(x)
        get(found.ctypes.data_as(POINTER(c_double)), found.size)
        return found.copy(), np.array(unit.get("contact[1].force", "contact[2].force"))

    pushing, force = indicators(x0)
    assert (pushing > 0.0).all() and pushing == pytest.approx(force)
    aside = x0.copy()
    aside[states.index("journal.x")] += 5e-5
    pushing, force = indicators(aside)
    assert sorted(np.sign(pushing)) == [-1.0, 1.0] and (np.sign(pushing) == np.where(force > 0.0, 1.0, -1.0)).all()
    alone, _, _ = started(instance, "alone", fmi)
    assert alone.description.numberOfEventIndicators == 0 if fmi == 2 else not alone.description.eventIndicators


@pytest.mark.long
def test_the_tolerance_that_it_proposes_keeps_the_orbit(elements, tmp_path):
    """An orbit of some 30 nm by fmpy, which takes the tolerance of the FMU; a hundred times that would not do."""
    rotor = jeffcott_rotor(bearings=1, load=(0.0, WEIGHT - BALL), unbalance=2e-6, speed_rpm=8000.0, **BODIES)
    path = export(rotor.on([elements["wide_si"]]), tmp_path / "x.fmu")
    asked = {"stop_time": 0.005, "output": ["journal.y"], "output_interval": 2e-5}

    def journal(**more):
        found = fmpy.simulate_fmu(str(path), **asked, **more)
        return np.interp(np.arange(0.001, 0.005, 2e-5), found["time"], found["journal.y"])

    exact = journal(fmi_type="CoSimulation")
    gaps = [
        np.max(np.abs(journal(fmi_type="ModelExchange", **more) - exact)) / np.ptp(exact)
        for more in ({}, {"relative_tolerance": 1e-6})
    ]
    assert gaps[0] < 3e-3 and gaps[1] > 10.0 * gaps[0]
