"""Other programs that load FMUs, on the closed rotor: the same motion as by fmpy, the same Jacobian.

They are of the extra ``importers``; CI installs it where it can be had.
"""

import ctypes
import sys
from pathlib import Path

import numpy as np
import pytest

pytestmark = pytest.mark.filterwarnings("ignore::reduced_models.OutsideValidityWarning")
STEP, STEPS = 1e-5, 200
NAMES = ("journal_x", "journal_y", "disc_x", "disc_y", "force[1]")


def by_fmpy(instance, fmi):
    slave = instance("wide", fmi)
    slave.start()
    for _ in range(STEPS):
        slave.step(STEP)
    return slave.get(*NAMES)


def by_libcosimpy(path):
    """Open Simulation Platform, on the FMI library of Modelon."""
    pytest.importorskip("libcosimpy")
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    execution = CosimExecution.from_step_size(round(STEP * 1e9))  # nanoseconds
    slave = execution.add_local_slave(CosimLocalSlave(fmu_path=str(path), instance_name="rotor"))
    observer = CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    known = {variable.name.decode(): variable.reference for variable in execution.slave_variables(slave)}
    for _ in range(STEPS):
        assert execution.step()
    return observer.last_real_values(slave, [known[name] for name in NAMES])


def by_ecospy(path):
    """Ecos, on fmi4c; its library wants libtbb.so.12, of the system or of the package ``tbb``."""
    for library in (Path(sys.prefix) / "lib").glob("libtbb.so.12"):
        ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    try:
        from ecospy import EcosSimulation, EcosSimulationStructure
    except (ImportError, OSError) as error:
        pytest.skip(f"no ecospy ({error})")
    structure = EcosSimulationStructure()
    structure.add_model("rotor", str(path))
    with EcosSimulation(structure=structure, step_size=STEP) as simulation:
        simulation.init()
        for _ in range(STEPS):
            simulation.step()
        found = [simulation.get_real(f"rotor::{name}") for name in NAMES]
        simulation.terminate()
    return found


@pytest.mark.parametrize(("importer", "fmi"), [(by_libcosimpy, 2), (by_ecospy, 2), (by_ecospy, 3)])
def test_the_same_motion_as_by_fmpy(unit, instance, importer, fmi):
    """To the last bits of what each makes of the time."""
    found = importer(unit("wide", fmi).path)
    assert found == pytest.approx(by_fmpy(instance, fmi), rel=1e-9, abs=1e-16)


@pytest.mark.parametrize("fmi", [2, 3])
def test_casadi_has_its_equations_and_their_jacobian(unit, instance, fmi):
    casadi = pytest.importorskip("casadi")
    one = unit("wide", fmi)
    outputs = ["journal_x", "force[1]", "approach[2]"]
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
