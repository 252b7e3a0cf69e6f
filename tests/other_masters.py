"""System archives in the masters of others, of the extra ``importers``, and in ours through fmpy.

Each takes an archive, its step [s], how many steps, a component and names of its variables, and returns their
values, shape (count + 1, names), from the start on; libcosim has none there: shape (count, names).
"""

import ctypes
import importlib
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

from fmu.system.master import SystemRun
from fmu.system.structure import system_structure


def ecos():
    """The module of Ecos, on fmi4c; its library wants libtbb.so.12, of the system or of the package ``tbb``."""
    for library in (Path(sys.prefix) / "lib").glob("libtbb.so.12"):
        ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    try:
        return importlib.import_module("ecospy")
    except (ImportError, OSError) as error:
        pytest.skip(f"no ecospy ({error})")


def ecospy(path, step, count, component, names, parameter_set=None):
    with ecos().EcosSimulation(ssp_path=str(path), step_size=step) as simulation:
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


def built_by_pythonfmu(folder, name, text):
    """A class of pythonfmu in a file of that name, as an FMU of the folder."""
    (folder / f"{name}.py").write_text(text)
    subprocess.run([sys.executable, "-m", "pythonfmu", "build", "-f", f"{name}.py"], cwd=folder, check=True)


def archive(path, parts, wires, step):
    """A system archive of FMUs that lie beside it."""
    with zipfile.ZipFile(path, "w") as content:
        text = system_structure("s", parts, wires, step=step, stop=1.0, description="mass on a film")
        content.writestr("SystemStructure.ssd", text)
        for part in parts:
            content.write(path.parent / Path(part.source).name, part.source)
    return path


def ours(path, step, count, component, names):
    with SystemRun(Path(path).read_bytes()) as run:
        return run.run(step, count, [(component, name) for name in names])
