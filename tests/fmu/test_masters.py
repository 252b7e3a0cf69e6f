"""A mass FMU that is not ours (pythonfmu) on the default FMU of a contact, under fmpy, libcosim and Ecos.

Needs the extra ``importers``. The table of masters and masses is in `examples/studies/masters.py`.
"""

import ctypes
import subprocess
import sys
import zipfile
from pathlib import Path
from runpy import run_path

import fmpy
import numpy as np
import pytest

from fmu import export_contact
from fmu.system.structure import Component, Connector, Wire, system_structure

STUDIES = Path(__file__).parents[2] / "examples" / "studies"
MASS = """
from pythonfmu import Fmi2Causality, Fmi2Slave, Real

class Mass(Fmi2Slave):
    def __init__(self, **more):
        super().__init__(**more)
        self.force, self.approach, self.rate = {load!r}, {start!r}, 0.0
        self.register_variable(Real("force", causality=Fmi2Causality.input))
        for name in ("approach", "rate"):
            self.register_variable(Real(name, causality=Fmi2Causality.output))

    def do_step(self, t, h):
        a = ({load!r} - self.force) / {mass!r}
        self.approach += h * (self.rate + 0.5 * h * a)
        self.rate += h * a
        return True
"""


@pytest.fixture(scope="module")
def study():
    sys.path.insert(0, str(STUDIES))  # it imports the other study
    try:
        return run_path(str(STUDIES / "masters.py"))
    finally:
        sys.path.remove(str(STUDIES))


@pytest.fixture(scope="module")
def loop(study, tmp_path_factory):
    return study["Loop"](study["contact"](), tmp_path_factory.mktemp("loop"))


@pytest.fixture(scope="module")
def reference(loop):
    return loop.reference()


@pytest.fixture(scope="module")
def fmus(study, loop, tmp_path_factory):
    """The mass and the contact, and a system of both for each step."""
    pytest.importorskip("pythonfmu")
    folder = tmp_path_factory.mktemp("masters")
    (folder / "mass.py").write_text(MASS.format(load=study["LOAD"], start=loop.start, mass=study["MASS"]))
    subprocess.run([sys.executable, "-m", "pythonfmu", "build", "-f", "mass.py"], cwd=folder, check=True)
    export_contact(loop.element, folder / "Contact.fmu")
    return folder


def connectors(kind):
    """Of the motion."""
    return Connector("approach", kind, "m"), Connector("rate", kind, "m/s")


def system(folder, loop, h):
    """The system archive of both at steps of h."""
    parts = [
        Component(
            "mass", "resources/Mass.fmu",
            (Connector("force", "input", "N"), *connectors("output")),
            starts={"force": float(loop.element.spring(loop.start))},
        ),
        Component(
            "contact", "resources/Contact.fmu",
            (*connectors("input"), Connector("force", "output", "N")),
            starts={"approach": loop.start, "rate": 0.0},
        ),
    ]  # fmt: skip
    motion = [Wire(("mass", name), ("contact", name)) for name in ("approach", "rate")]
    wires = [*motion, Wire(("contact", "force"), ("mass", "force"))]
    path = folder / f"system {h:g}.ssp"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr(
            "SystemStructure.ssd",
            system_structure("s", parts, wires, step=h, stop=1.0, description="mass on contact"),
        )
        for part in parts:
            archive.write(folder / Path(part.source).name, part.source)
    return path


def by_fmpy(folder, loop, h, count):
    units = []
    for name in ("Mass", "Contact"):
        description = fmpy.read_model_description(str(folder / f"{name}.fmu"), validate=False)
        place = fmpy.extract(str(folder / f"{name}.fmu"))
        unit = fmpy.instantiate_fmu(place, description, fmi_type="CoSimulation")
        units.append((unit, {v.name: v.valueReference for v in description.modelVariables}))
    (mass, of_mass), (contact, of_contact) = units
    motion = "approach", "rate"

    contact.setReal([of_contact[name] for name in motion], [loop.start, 0.0])
    for unit, _ in units:
        unit.setupExperiment(startTime=0.0)
        unit.enterInitializationMode()
        unit.exitInitializationMode()
    mass.setReal([of_mass["force"]], contact.getReal([of_contact["force"]]))
    rows = [loop.start]
    for k in range(count):
        for unit, _ in units:
            unit.doStep(k * h, h)
        got = contact.getReal([of_contact["force"]])
        contact.setReal([of_contact[name] for name in motion], mass.getReal([of_mass[name] for name in motion]))
        mass.setReal([of_mass["force"]], got)
        rows.append(mass.getReal([of_mass["approach"]])[0])
    return rows


def by_libcosim(folder, loop, h, count):
    pytest.importorskip("libcosimpy")
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver

    execution, observer = (
        CosimExecution.from_ssp_file(str(system(folder, loop, h))),
        CosimObserver.create_last_value(),
    )
    assert execution.add_observer(observer)
    mass = execution.slave_index_from_instance_name("mass")
    (approach,) = [v.reference for v in execution.slave_variables(mass) if v.name == b"approach"]
    rows = [loop.start]
    for _ in range(count):
        assert execution.step()
        rows.append(observer.last_real_values(mass, [approach])[0])
    return rows


def by_ecos(folder, loop, h, count):
    for library in (Path(sys.prefix) / "lib").glob("libtbb.so.12"):
        ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    try:
        from ecospy import EcosSimulation
    except (ImportError, OSError) as error:
        pytest.skip(f"no ecospy ({error})")
    rows = [loop.start]
    with EcosSimulation(ssp_path=str(system(folder, loop, h)), step_size=h) as simulation:
        simulation.init()
        for _ in range(count):
            simulation.step(1)
            rows.append(simulation.get_real("mass::approach"))
    return rows


@pytest.mark.parametrize("master", [by_fmpy, by_libcosim, by_ecos])
@pytest.mark.parametrize(("h", "allowed"), [(1e-6, 0.005), (1e-5, 0.005), (3e-5, 0.1)])
def test_a_mass_of_others_keeps_the_damping(fmus, loop, reference, master, h, allowed):
    approach = np.array(master(fmus, loop, h, round(loop.until / h)))
    found = loop.decrement(h * np.arange(approach.size), approach)
    assert found == pytest.approx(reference, rel=allowed)


def test_the_table_of_the_documentation(study, loop, reference):
    for case, lead in study["LEADS"].items():
        assert loop.run(*case, 1e-5, lead) == pytest.approx(reference, rel=0.005)
    assert loop.run("parallel", "exact", 1e-5, 1.0) < -4.0 * reference
