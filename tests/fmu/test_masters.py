"""A mass FMU that is not ours (pythonfmu) on the default FMU of a contact, under fmpy, libcosim and Ecos.

Needs the extra ``importers``. The table of masters and masses is in `examples/studies/masters.py`.
"""

import sys
from pathlib import Path
from runpy import run_path

import numpy as np
import pytest
from other_masters import archive, built_by_pythonfmu, ecospy, libcosimpy, ours

from fmu import export
from fmu.system.structure import Component, Connector, Wire

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
    text = MASS.format(load=study["LOAD"], start=loop.start, mass=study["MASS"])
    built_by_pythonfmu(folder, "mass", text)
    export(loop.element, folder / "Contact.fmu")
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
    return archive(folder / f"system {h:g}.ssp", parts, wires, h)


@pytest.mark.parametrize("master", [ours, libcosimpy, ecospy])
@pytest.mark.parametrize(("h", "allowed"), [(1e-6, 0.005), (1e-5, 0.005), (3e-5, 0.1)])
def test_a_mass_of_others_keeps_the_damping(fmus, loop, reference, master, h, allowed):
    found = master(system(fmus, loop, h), h, round(loop.until / h), "mass", ["approach"])
    approach = np.append(loop.start, found)[-1 - round(loop.until / h) :]
    found = loop.decrement(h * np.arange(approach.size), approach)
    assert found == pytest.approx(reference, rel=allowed)


@pytest.mark.long
def test_the_table_of_the_documentation(study, loop, reference):
    for case, lead in study["LEADS"].items():
        assert loop.run(*case, 1e-5, lead) == pytest.approx(reference, rel=0.005)
    assert loop.run("parallel", "exact", 1e-5, 1.0) < -4.0 * reference
