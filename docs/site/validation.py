"""The page of validation: this library beside what others published, from numbers that were measured and kept.

    python tests/golden/regenerate.py validation   # solve everything anew: about a minute
    python docs/site/validation.py                 # docs/validation.md from it

What others published stands in the tests, which hold the library to it; here it is only read from there.
"""

from __future__ import annotations

import importlib.util
import inspect
import json
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "validation.md"
GOLDEN = ROOT / "tests" / "golden" / "golden.json"
FILMS = "tests/ehlcontact/test_literature.py"
BEARINGS = "tests/reduced_models/bearing/test_literature.py"
Row = dict[str, Any]


def module(path: str) -> ModuleType:
    """A file of the tests, with the neighbours that it imports."""
    spec = importlib.util.spec_from_file_location(Path(path).stem + "_data", ROOT / path)
    assert spec is not None and spec.loader is not None
    found = importlib.util.module_from_spec(spec)
    sys.path.insert(0, str(ROOT / "tests"))
    try:
        spec.loader.exec_module(found)
    finally:
        sys.path.pop(0)
    return found


def row(case: str, quantity: str, ours: float, theirs: float) -> Row:
    """One line of a table."""
    return {"case": case, "quantity": quantity, "ours": float(ours), "theirs": float(theirs)}


def solvers() -> list[Row]:
    """Steady films compared with converged films of other solvers.

    Three references: the approach at the paper's point, compared with the limit 0.8700 of an independently written
    solver; five points of *PINN-EHL-Reproducibility* (github.com/vachekivan495-design), converged on 769 x 769
    nodes, a steel ball on glass; and the limits of the program of Venner and Lubrecht, by Richardson extrapolation
    from 257 x 257 and 513 x 513 nodes.
    """
    from ehlcontact import Domain, Geometry, Grid, Lubricant, MoesPoint, OperatingPoint, solve_steady

    tests, rows = module(FILMS), []
    for n in (64, 128, 256):
        film = solve_steady(tests.POINT, grid=Grid(n=n))
        rows.append(row(f"M = 200, L = 10, kappa = 0.5, n = {n}", "approach", film.approach, 0.8700))
    steel_on_glass = Geometry(12.68e-3, 12.68e-3, 210e9, 0.3, 81e9, 0.208)
    for name, (alpha, u_mean, eta0, load, M, L, approach) in tests.PUBLIC.items():
        point = OperatingPoint(steel_on_glass, Lubricant(eta0, alpha), load, 2.0 * u_mean)
        film = solve_steady(point, grid=Grid(n=256, domain=Domain(-4.0, 2.0, 3.0)))
        rows.append(row(f"{name}: M = {M:.3g}, L = {L:.3g}, n = 256", "approach", film.approach, approach))
    for M, n in ((20, 64), (20, 128), (200, 128), (200, 256)):
        film = solve_steady(MoesPoint(M, 10, 1.0, **tests.BARUS), grid=Grid(n=n))
        unit = film.point.film_to_moes
        for name, ours, theirs in zip(
            ("central film", "smallest film"), (film.h_central, film.h_min), tests.VLC_LIMIT[M], strict=True
        ):
            rows.append(row(f"Barus, M = {M}, L = 10, circle, n = {n}", f"{name}, Moes", ours * unit, theirs))
    return rows


def formulas() -> list[Row]:
    """Steady films compared with published fits, each to solutions of its authors.

    The central film is compared with Nijenbanning, Venner and Moes, *Wear* 176 (1994) 217-229, which is for
    incompressible oil; the approach with Wijnant, thesis, Twente 1998. All solutions have n = 128.
    """
    from ehlcontact import Grid, MoesPoint, solve_steady
    from ehlcontact.film_formulas import nvm_central_film, wijnant_approach

    rows = []
    for M, L in ((20, 10), (58.07, 4.62), (200, 10)):
        film = solve_steady(MoesPoint(M, L, 1.0, density="incompressible"), grid=Grid(n=128))
        ours, theirs = film.h_central * film.point.film_to_moes, nvm_central_film(M, L, 1.0)
        rows.append(row(f"M = {M}, L = {L}, circle, incompressible", "central film, Moes", ours, theirs))
    for M, L, kappa in ((58.07, 4.62, 1.0), (200, 10, 1.0), (200, 10, 0.5)):
        film = solve_steady(MoesPoint(M, L, kappa), grid=Grid(n=128))
        rows.append(
            row(f"M = {M}, L = {L}, kappa = {kappa}", "approach", film.approach, wijnant_approach(M, L, kappa))
        )
    return rows


def cubics() -> list[Row]:
    """Cubics fitted to six motions at M = 200, L = 10, kappa = 0.5, compared by their identifiable quantities.

    Nonato and Cavalca, *J. Sound Vib.* 329 (2010) 4656-4671, Tables 3 and 5. The three stiffness coefficients of a
    cubic scatter from motion to motion. The approach at the static load and the tangent there do not scatter; the
    paper prints the damping with two digits. This library: n = 128, record and window by default.
    `ehlcontact reproduce` compares all tables and figures of the paper.
    """
    from ehlcontact import Grid, simulate
    from reduced_models import ContactRecord, fit

    tests, rows = module(FILMS), []
    for name, (motion, (k1, k2, k3, c1)) in tests.CUBICS.items():
        found = fit(ContactRecord.from_result(simulate(tests.POINT, motion, grid=Grid(n=128))), model="cubic")
        root, tangent = tests.oracles.spring_root_and_tangent(k1, k2, k3)
        for quantity, ours, theirs in (
            ("approach at load 1", found.root, root),
            ("tangent there", found.tangent, tangent),
            ("C1", found.parameters["C1"], c1),
        ):
            rows.append(row(f"Table {name}", quantity, ours, theirs))
    return rows


def bearings() -> list[Row]:
    """Dry bearings compared with Hertz' formulas and a textbook example.

    Bearings under 1 kN without clearance, conformities 0.52, E = 206.8 GPa, a ball under the load: the references
    were computed by Hertz' formulas, independently of this library. The 209 under 8900 N with 15 µm of clearance
    is the example of Harris, *Rolling Bearing Analysis*, ch. 7.
    """
    from reduced_models import BallBearing

    tests, rows = module(BEARINGS), []
    for name, (on, _, tangent, bpfo) in tests.TABLE.items():
        bearing = BallBearing.catalogue(name, youngs_modulus=2.068e11, **tests.SIZES.get(name, {}))
        slope = bearing.coefficients(tests.DOWN, hz=0.0).stiffness[0, 1, 1]
        rows.append(row(name, "deflection, µm", tests.deflections(bearing)[0] * 1e6, on))
        rows.append(row(name, "stiffness, N/µm", slope * 1e-6, tangent * 1e-6))
        rows.append(row(name, "balls passed per turn", bearing.orders.bpfo, bpfo))
    state = BallBearing.catalogue("209", clearance=15e-6).equilibrium((0.0, -8900.0))
    rows.append(row("209, Harris", "deflection, µm", -state.displacement[1] * 1e6, 60.4))
    for ball, theirs in enumerate((4527.0, 2840.0, 61.0)):
        rows.append(row("209, Harris", f"load of ball {ball}, N", state.force[ball, 0], theirs))
    return rows


def fmus() -> list[Row]:
    """Compiled models compared with their Python elements.

    Elements of the atlas at M = 200, L = 10, kappa = 0.5 were exported and compiled, and run by FMPy over the
    states of `fmu.verify`. The table has the largest difference in force, tangents, derivatives and states, each
    relative to its magnitude.
    """
    from ehlcontact import MoesPoint
    from fmu import export, verify
    from reduced_models import Atlas

    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for model in ("cubic", "memory", "wide"):
            options = {"Omega": 0.05} if model == "cubic" else {}
            element = Atlas().element(MoesPoint(200, 10, 0.5), model, **options)
            for fmi in (2, 3):
                path = export(element, Path(folder) / f"{model}{fmi}.fmu", fmi=fmi)
                found = verify(path, element)
                worst = max(found.force, found.tangents, found.derivatives, found.exchange)
                rows.append(row(f"{model}, FMI {fmi}", "largest difference", worst, 0.0))
    return rows


class Section(NamedTuple):
    """A table of the page; the docstring of `measure` is its text."""

    title: str
    measure: Callable[[], list[Row]]
    held_by: str


SECTIONS = {
    "solvers": Section("Steady films of other solvers", solvers, FILMS),
    "formulas": Section("Published fits of films", formulas, FILMS),
    "cubics": Section("The paper's cubics", cubics, FILMS),
    "bearings": Section("Dry ball bearings", bearings, BEARINGS),
    "fmus": Section("FMUs and their elements", fmus, "tests/fmu/test_verify.py"),
}


def cells(found: Row) -> str:
    """A row as markdown; a difference of nothing has no share."""
    ours, theirs = found["ours"], found["theirs"]
    case = found["case"].replace(" = ", "\u00a0=\u00a0")  # broken between commas only
    if theirs == 0.0:
        return f"| {case} | {found['quantity']} | {ours:.1e} |"
    share = f"{100.0 * (ours / theirs - 1.0):+.2f}\u00a0%"
    return f"| {case} | {found['quantity']} | {ours:.5g} | {theirs:.5g} | {share} |"


def table(rows: list[Row]) -> str:
    """As markdown, with the largest difference below the table."""
    if all(r["theirs"] == 0.0 for r in rows):
        head, last = "| case | quantity | this library |\n|---|---|---|", ""
    else:
        head = "| case | quantity | this library | reference | difference |\n|---|---|---|---|---|"
        far = max(rows, key=lambda r: abs(r["ours"] / r["theirs"] - 1.0))
        off = 100.0 * (far["ours"] / far["theirs"] - 1.0)
        last = f"\n\nFarthest off: {far['quantity']} of {far['case']}, {off:+.2f} %."
    return "\n".join([head, *map(cells, rows)]) + last


def golden(values: dict[str, Any]) -> str:
    """The library's own numbers, which a test holds, so that no change of them goes unnoticed."""
    lines = ["| steady film, n = 64 | approach | central film | smallest film |", "|---|---|---|---|"]
    for name, film in values["steady"].items():
        lines.append(f"| {name} | {film['approach']:.6f} | {film['h_central']:.6f} | {film['h_min']:.6f} |")
    return "\n".join(lines)


HEAD = """\
# Validation

<!-- made by docs/site/validation.py: change that -->

This page compares results of this library (commit {version}) with published results.
`python tests/golden/regenerate.py validation` repeats all solves, `python docs/site/validation.py` rewrites this
page. The tests named below compare every version with these numbers, within the tolerances given there:
`pytest -m literature`. Grid convergence, range and cost of the solver are in [the solver](solver.md); bearings
compared with computed films are in [ball bearings](bearings.md).
"""
TAIL = """\
## Regression values of this library

These solutions are converged far below the discretisation error of their grid. Every run of the tests compares
new solutions with them (`tests/golden/test_golden.py`, films within 1e-6). A change of a value is noted under
*Numerics* in [changes](guide/changelog.md). Values are dimensionless; `python tests/golden/regenerate.py` writes
them.
"""


def page() -> str:
    """All of it."""
    stored = json.loads(GOLDEN.read_text(encoding="utf-8"))
    data = stored["validation"]
    parts = [HEAD.format(version=data["version"])]
    for name, section in SECTIONS.items():
        said = inspect.getdoc(section.measure)
        parts += [f"## {section.title}\n", f"{said}\n", table(data[name]) + "\n"]
        parts += [f"Tested by `{section.held_by}`.\n"]
    return "\n".join([*parts, TAIL, golden(stored)]) + "\n"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
