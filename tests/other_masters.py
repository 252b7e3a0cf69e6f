"""System archives in the masters of others, of the extra ``importers``, and in ours through fmpy.

Each takes an archive, its step [s], how many steps, a component and names of its variables, and returns their
values, shape (count + 1, names), from the start on; libcosim has none there: shape (count, names).
"""

import ctypes
import sys
from pathlib import Path

import numpy as np
import pytest

from fmu.system.master import SystemRun


def ecospy(path, step, count, component, names, parameter_set=None):
    for library in (Path(sys.prefix) / "lib").glob("libtbb.so.12"):
        ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    try:
        from ecospy import EcosSimulation
    except (ImportError, OSError) as error:
        pytest.skip(f"no ecospy ({error})")
    with EcosSimulation(ssp_path=str(path), step_size=step) as simulation:
        assert simulation.init(parameter_set=parameter_set)
        rows = [[simulation.get_real(f"{component}::{name}") for name in names]]
        for _ in range(count):
            simulation.step()
            rows.append([simulation.get_real(f"{component}::{name}") for name in names])
        simulation.terminate()
    return np.array(rows)


def libcosimpy(path, step, count, component, names):
    pytest.importorskip("libcosimpy")
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver

    execution = CosimExecution.from_ssp_file(str(path), round(step * 1e9))
    observer = CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    slave = execution.slave_index_from_instance_name(component)
    known = {variable.name.decode(): variable.reference for variable in execution.slave_variables(slave)}
    rows = []
    for _ in range(count):
        assert execution.step()
        rows.append(observer.last_real_values(slave, [known[name] for name in names]))
    return np.array(rows)


def ours(path, step, count, component, names):
    with SystemRun(Path(path).read_bytes()) as run:
        return run.run(step, count, [(component, name) for name in names])
