"""FMI 3.0: the same models behind other calls, and what only this version has."""

import zipfile
from xml.etree import ElementTree

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu

from fmu import verify
from fmu.driver import Exchange, Slave

EXTRAPOLATED, END, MIDDLE = 1.0, 0.0, 0.5  # values of lead


@pytest.fixture(scope="module")
def folders3(fmus3, tmp_path_factory):
    folder = tmp_path_factory.mktemp("extracted3")
    return {name: fmpy.extract(str(path), unzipdir=str(folder / name)) for name, path in fmus3.items()}


@pytest.fixture
def made3(folders3):
    """Make instances of FMI 3.0: ``made3(Slave, "wide", lead)``."""
    made = []

    def make(kind, name, lead=None, **options):
        values = options.pop("values", {})
        unit = kind(folders3[name], fmpy.read_model_description(folders3[name]), [], **options)
        made.append(unit)
        if kind is Slave and lead is not None:
            unit.start(lead=lead, **values)
        elif kind is Exchange:
            unit.start()
        return unit

    yield make
    for unit in made:
        unit.free()


@pytest.mark.parametrize("kind", ["cubic", "polynomial", "power_si", "wide", "wide_si"])
def test_fmu_agrees_with_element(fmus3, elements, kind):
    assert validate_fmu(str(fmus3[kind])) == []
    found = verify(fmus3[kind], elements[kind])
    assert found.passes and found.findings == ()
    assert max(found.force, found.tangents, found.derivatives, found.exchange) <= 1e-12


def test_capabilities_are_those_tested_here(fmus3):
    """From the XML: fmpy 0.3.32 looks for directional derivatives under FMI 2's name."""
    with zipfile.ZipFile(fmus3["wide"]) as archive:
        root = ElementTree.fromstring(archive.read("modelDescription.xml"))
    both = {"canGetAndSetFMUState", "canSerializeFMUState", "providesDirectionalDerivatives"}
    both |= {"providesAdjointDerivatives"}
    slave = both | {"canHandleVariableCommunicationStepSize", "providesIntermediateUpdate", "hasEventMode"}
    wanted = {"ModelExchange": both, "CoSimulation": slave | {"mightReturnEarlyFromDoStep"}}
    for name, flags in wanted.items():
        assert {key for key, value in root.find(name).attrib.items() if value == "true"} == flags
    assert root.find("CoSimulation").get("maxOutputDerivativeOrder") == "1"


def test_archive_has_what_the_standard_wants(fmus3):
    with zipfile.ZipFile(fmus3["wide"]) as archive:
        names = set(archive.namelist())
    assert {"sources/buildDescription.xml", "terminalsAndIcons/terminalsAndIcons.xml"} <= names
    assert not any(name.startswith("sources/fmi3F") or name.startswith("sources/fmi3P") for name in names)
    assert "documentation/licenses/license.txt" in names


@pytest.mark.parametrize("kind", ["cubic", "wide_si"])
def test_both_versions_give_the_same_digits(made3, slave, kind, elements):
    old, new = slave(kind, lead=EXTRAPOLATED), made3(Slave, kind, EXTRAPOLATED)
    _, length, time = getattr(elements[kind], "_units", (1.0, 1.0, 1.0))
    for k in range(200):
        at = {"approach": (0.4 + 0.9 * np.cos(0.05 * k)) * length, "rate": -0.9 * np.sin(0.05 * k) * length / time}
        for unit in (old, new):
            unit.set(**at)
            unit.step(0.05 * time)
        assert old.get("force", "stiffness", "damping") == new.get("force", "stiffness", "damping")


@pytest.mark.parametrize("kind", ["polynomial", "wide_si"])
def test_adjoint_is_the_transposed_jacobian(made3, kind):
    unit = made3(Exchange, kind)
    states = [v.variable.name[4:-1] for v in unit.description.derivatives]
    x = 0.1 * np.sin(np.arange(len(states)))
    start = unit.get("approach")[0]
    unit.evaluate(x, approach=1.1 * start, rate=0.0)
    unknowns = [unit.reference[n] for n in ("force", "stiffness", "damping", *(f"der({s})" for s in states))]
    knowns = [unit.reference[n] for n in ("approach", "rate", *states)]
    jacobian = np.array([unit.raw.getDirectionalDerivative(unknowns, [known], [1.0]) for known in knowns])
    seed = np.cos(1.0 + np.arange(len(unknowns)))
    found = unit.raw.getAdjointDerivative(unknowns, knowns, seed, nSensitivity=len(knowns))
    assert np.allclose(found, jacobian @ seed, rtol=1e-12, atol=1e-14 * np.abs(jacobian).max())
    with pytest.raises(FMICallException):  # as fmpy would, with as many sensitivities as unknowns
        unit.raw.getAdjointDerivative(unknowns, knowns, seed, nSensitivity=len(knowns) + 1)
    with pytest.raises(FMICallException):
        unit.raw.getAdjointDerivative(unknowns, knowns, seed[:-1], nSensitivity=len(knowns))


@pytest.mark.parametrize("kind", ["cubic", "wide"])
def test_event_mode_at_lift_off(made3, elements, kind):
    """Early return stops where the force ends, without it the step is whole; forces do not jump at an event."""
    u0, v0 = 0.9, -3.0 if kind == "cubic" else -30.0
    ends = {}
    for early in (True, False):
        unit = made3(Slave, kind, EXTRAPOLATED, eventModeUsed=True, earlyReturnAllowed=early,
                     values={"approach": u0, "rate": v0})  # fmt: skip
        unit.raw.updateDiscreteStates()
        unit.raw.enterStepMode()
        needed, ended, returned, until = unit.step(2.0)
        assert needed and not ended and returned is early
        assert (until < 2.0) == early
        ends[early] = until
        if early:
            before = unit.get("force")
            unit.raw.enterEventMode()
            needed, ended, nominals, values, timed, _ = unit.raw.updateDiscreteStates()
            assert not (needed or ended or values or timed)
            assert bool(nominals) == (kind == "wide")  # there are no states to restart else
            unit.raw.enterStepMode()
            assert unit.get("force") == before
            unit.set(approach=u0 + v0 * until)
            assert not unit.step(0.1)[0]
    assert ends[False] == 2.0
    fine = made3(Slave, kind, EXTRAPOLATED, values={"approach": u0, "rate": v0})
    z = fine.reference["contact_indicator"]
    fine.raw.doStep(0.0, ends[True] * (1.0 - 1e-4))
    assert fine.raw.getFloat64([z])[0] > 0.0
    with pytest.raises(FMICallException):  # made without
        fine.raw.enterEventMode()


@pytest.mark.parametrize("lead", [END, MIDDLE])
def test_only_an_extrapolated_step_returns_early(made3, lead):
    """Of the others no motion within the step is known."""
    unit = made3(Slave, "cubic", lead, eventModeUsed=True, earlyReturnAllowed=True, values={"approach": 0.9})
    unit.raw.updateDiscreteStates()
    unit.raw.enterStepMode()
    unit.set(approach=-0.5)
    assert unit.step(0.1) == (True, False, False, 0.1)
    assert unit.get("force", "time") == [0.0, 0.1]


def test_intermediate_update_may_read_and_nothing_else(made3):
    seen, failed = [], []

    def update(environment, time, set_requested, get_allowed, finished, can_return, requested, until):
        seen.append(
            (time, set_requested, get_allowed, finished, can_return, unit.get("force")[0], unit.get("time")[0])
        )
        try:
            unit.set(approach=0.5)
        except FMICallException:
            failed.append(True)

    unit = made3(Slave, "wide", intermediateUpdate=update)
    unit.start(lead=END)
    for _ in range(3):
        unit.set(approach=0.9)
        unit.step(0.1)
        assert unit.get("approach") == [0.9]
    assert len(failed) == 3
    for k, (time, set_requested, get_allowed, finished, can_return, force, at) in enumerate(seen):
        assert time == at == pytest.approx(0.1 * (k + 1))
        assert (set_requested, get_allowed, finished, can_return) == (False, True, True, False)
        assert force > 0.0


def test_derivatives_of_outputs_and_states_saved(made3):
    unit = made3(Slave, "wide", EXTRAPOLATED, values={"approach": 0.9, "rate": 0.1})
    unit.step(0.01)
    slope = unit.raw.getOutputDerivatives([unit.reference["force"]], [1])[0]
    assert slope == pytest.approx(
        unit.gradient("force", "approach") * 0.1
        + sum(
            unit.gradient("force", s) * unit.get(f"der({s})")[0]
            for s in ("s", "y", *(f"q[{k}]" for k in range(1, 9)))
        ),
        rel=1e-9,
    )
    state = unit.raw.getFMUState()
    blob = unit.raw.serializeFMUState(state)
    unit.step(0.01)
    first = unit.get("force", "time")
    other = made3(Slave, "wide", END)
    other.raw.setFMUState(other.raw.deserializeFMUState(blob))
    other.time = 0.01
    other.step(0.01)
    assert other.get("force", "time") == first
    exchange = made3(Exchange, "wide")
    with pytest.raises(FMICallException):
        exchange.raw.deserializeFMUState(blob)
    with pytest.raises(FMICallException):
        exchange.raw.setFMUState(state)
    for bad in (blob[:-1], b"", blob[:40] + b"\xff" + blob[41:]):
        with pytest.raises(FMICallException):
            unit.raw.deserializeFMUState(bad)


@pytest.mark.parametrize("fmi_type", ["CoSimulation", "ModelExchange"])
@pytest.mark.parametrize("kind", ["cubic", "wide"])
def test_fmpy_simulates_it(fmus3, elements, kind, fmi_type):
    T = np.linspace(0.0, 1.0, 1001)
    given = np.rec.fromarrays(
        [T, 0.9 + 0.02 * np.sin(2.0 * T), 0.04 * np.cos(2.0 * T)], names="time,approach,rate"
    )
    result = fmpy.simulate_fmu(
        str(fmus3[kind]), fmi_type=fmi_type, stop_time=1.0, output_interval=1e-3, input=np.asarray(given),
        output=["force"],
    )  # fmt: skip
    element = elements[kind]
    if element.state_count:
        wanted = element.drive(T, given["approach"], given["rate"])
    else:
        wanted = element.force(given["approach"], given["rate"])
    got = np.interp(T[1:], result["time"], result["force"])
    assert np.allclose(got[50:], wanted[51:], rtol=2e-4)
