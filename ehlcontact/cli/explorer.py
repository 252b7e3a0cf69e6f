"""The page of ``ehlcontact explore``: one file that computes in the browser, atlas and C core inside.

Balls between their races, equilibrium, stiffness and damping are those of ``reduced_models/csrc``, compiled to
WebAssembly with ``templates/explore/bearing.c``; JavaScript there reads the atlas as `reduced_models.atlas` does.
This module puts in both, oils, bearings, ranges of inputs and the constants of its rules.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import asdict, fields
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from ehlcontact import __version__
from ehlcontact.assumptions import film, judge
from ehlcontact.assumptions.film import LEAST_LAMBDA, MIXED_LAMBDA
from ehlcontact.binaries import build_module
from ehlcontact.checks.admissible_range import INPUTS, Quantity
from ehlcontact.errors import InputError
from ehlcontact.lubricant import MineralOil, oil
from ehlcontact.lubricant.oil import GRADES
from ehlcontact.lubricant.oil_laws import ROELANDS_LOG, ROELANDS_P0
from reduced_models import BallBearing
from reduced_models.atlas import film as atlas_film
from reduced_models.atlas import frequency_curve
from reduced_models.atlas.surface import Surface, shipped
from reduced_models.bearing import (
    designation,
    equilibrium_result,
    grooves,
    kinematics,
    race,
    ring,
    ring_statics,
    skf_friction,
)
from reduced_models.bearing.catalogue import DEEP_GROOVE, ROWS, Row
from reduced_models.bearing.clearance import CLASSES, clearance_of_class
from reduced_models.bearing.printed_ratings import RATINGS
from reduced_models.bearing.sliding import USUAL_LAW
from reduced_models.core import CSRC
from reduced_models.elements import film_curve, film_response
from reduced_models.life import bearing_life, life_modification, load_ratings
from reduced_models.rotor.compare_bearing_models import USUAL_DAMPING
from reduced_models.rotor.support_state import ABOVE_MEASURED, RELY_ON_SKF

# In the order in which they are joined: each stands on those before it; the last two are about the page itself.
SCRIPTS = (
    "numbers", "core", "hertz", "oil", "atlas", "race", "designation", "bearing", "life", "assumptions", "plot",
    "page",
)  # fmt: skip
COMPUTING = SCRIPTS[:10]
GLUE = "bearing.c"  # functions of the page on the C core
UNITS = {"ball_diameter": "mm", "pitch_diameter": "mm", "eta0": "mPa s", "alpha": "1/GPa"}  # others as in Python
# Numbers of the library's own rules, by the modules that have them
RULES: Mapping[Any, tuple[str, ...]] = {
    frequency_curve: ("SPLINE_SHARE",),
    atlas_film: ("THICKEST",),
    race: ("INSIDE", "PER_DECADE", "NEAR"),
    film_curve: ("DECADE", "RIGID_SLOPE"),
    film_response: ("DRY", "LEAST_VISCOUS"),
    grooves: ("LARGEST_PLAY",),
    ring_statics: ("POSITIONS",),
    ring: ("SEATED", "CARRIES", "STEEPEST"),
    kinematics: ("LEAST_SLIP",),
    equilibrium_result: ("MOST_FRICTION",),
    judge: ("CONDUCTIVITY",),
    film: ("LEAST_HEATING_FACTOR", "EYRING_STRESS", "LARGEST_STRESS"),
    oil: ("TYPICAL_SLOPE", "TYPICAL_DENSITY", "LEAST_SLOPE"),
    load_ratings: ("MATERIAL", "RATING_CONSTANT", "REDUCTION", "RATED_GROOVE", "LARGE_BALL", "LARGE_FACTOR"),
    bearing_life: ("TURNING", "STANDING", "RACE_POWER", "SLOPE", "PER_HOUR"),
    life_modification: ("SLOW", "FILM_POWER"),
}
OF_INPUTS = ("ball_diameter", "pitch_diameter", "conformity", "speed_rpm", "eta0", "alpha")


def script(names: Iterable[str] = SCRIPTS) -> str:
    """JavaScript of the page, or some of its files joined, and the data first that all of it reads."""
    data = json.dumps(page_data(), allow_nan=False, separators=(",", ":")).replace("</", "<\\/")
    parts = [_template(f"{name}.js").read_text(encoding="utf-8") for name in names]
    return "\n".join([f"const DATA = {data};", *parts])


def write_explorer(path: Path) -> Path:
    """Write the page.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    from ehlcontact.cli.page import write_page

    content: dict[str, Any] = {
        "script": script(),
        "version": __version__,
        "ratio": USUAL_DAMPING,
        "rely": int(RELY_ON_SKF),
    }
    content |= {"index": oil.USUAL_INDEX, "density": oil.USUAL_DENSITY_15}  # as in `Lubricant.iso_vg`
    return write_page(path, "explore/page.html.j2", {}, **content)


def page_data() -> dict[str, Any]:
    """Atlas, oils, bearings and ranges of inputs; arrays in base64."""
    return {
        "version": __version__,
        "atlas": _atlas(shipped("film")),
        "oil": _oils(),
        "catalogue": {
            name: row._asdict() | {"classes": _classes(row), "ratings": RATINGS.get(name)}
            for name, row in ROWS.items()
        },
        "classes": CLASSES,
        "designations": _designations(),
        "quantities": {name: _quantity(_in_units(name)) for name in OF_INPUTS},
        "rules": {name: getattr(module, name) for module, names in RULES.items() for name in names}
        | {"TRACTION": USUAL_LAW.coefficient, "RELY_ON_SKF": RELY_ON_SKF, "ABOVE_MEASURED": ABOVE_MEASURED},
        "skf": _skf(),
        "core": base64.b64encode(core_module()).decode("ascii"),
        "lambda": {"smooth": LEAST_LAMBDA, "mixed": MIXED_LAMBDA},
    }


def core_module() -> bytes:
    """The C core with the functions of the page, as WebAssembly; compiled once for every version of the sources.

    Raises
    ------
    BuildError
        No zig to compile it.
    """
    sources = {path.name: path.read_bytes() for path in sorted(CSRC.glob("*.[ch]"))}
    sources[GLUE] = _template(GLUE).read_bytes()
    return build_module(sources, [name for name in sources if name.endswith(".c")], "bearing")


def _template(name: str) -> Traversable:
    return files("ehlcontact.cli") / "templates" / "explore" / name


def _atlas(surface: Surface) -> dict[str, Any]:
    table, meta = surface.table, surface.table.metadata
    coefficients, lobe = surface.coefficients
    arrays = {"omega": table["omega"], "points": table.points, "factor": table["factor"], "lobe": lobe}
    arrays |= {"coefficients": coefficients, "slopes": _spline_slopes(np.arcsinh(table["omega"]))}
    steel = {f.name: f.default for f in fields(BallBearing)}
    return {
        **{name: _base64(array) for name, array in arrays.items()},
        "left_out": _base64(table["left_out"], np.float32),  # as in the file of the atlas
        "usual_reach": surface.usual_reach,
        "box": table.box.to_dict(),
        "interpolation": asdict(table.interpolation),
        "oil": meta["oil"],
        "rates": meta["rates"],
        "alpha": meta["alpha"],
        "eta0": meta["eta0"],
        "highest_omega": meta["highest_omega"],
        "steel": {name: steel[name] for name in ("youngs_modulus", "poisson_ratio", "density")},
        "quantities": {name: _quantity(INPUTS[name]) for name in ("alpha", "eta0")},
    }


def _spline_slopes(x: np.ndarray) -> np.ndarray:
    """Matrix from values to slopes at the nodes, shape (k, k): as `FrequencyCurve` of the atlas."""
    return np.asarray(
        scipy.interpolate.CubicSpline(x, np.eye(x.size), bc_type=((1, np.zeros(x.size)), "not-a-knot"))(x, 1)
    )


def _oils() -> dict[str, Any]:
    walther = {grade: MineralOil.of_grade(grade, 40.0).walther_slope for grade in GRADES}
    names = ("TEMPERATURES", "THINNEST", "EXPANSION", "KELVIN", "GOLD_S", "GOLD_T", "GOLD_PRESSURE")
    numbers = {name.lower(): getattr(oil, name) for name in names}
    numbers |= {"shift": oil.WALTHER_SHIFT, "density_15": oil.USUAL_DENSITY_15, "usual_density": oil.USUAL_DENSITY}
    numbers |= {"roelands_p0": ROELANDS_P0, "roelands_log": ROELANDS_LOG}
    return {"walther_slopes": walther, **numbers}


def _classes(row: Row) -> dict[str, float]:
    """Clearance of each class [m]; of bearings that have none, nothing."""
    if row.contact_angle is not None or row.bore is None:
        return {}
    return {name: clearance_of_class(name, row.bore) for name in CLASSES}


def _designations() -> dict[str, Any]:
    """Regular expressions and words by which names of bearings are read."""
    names = "TOKEN", "GAP", "SUFFIXES", "KINDS", "MAKERS", "NOT_READ", "NOT_IN_TORQUE"
    tables = {name.lower(): getattr(designation, name) for name in names}
    return tables | {"maker": designation.MAKER.pattern, "readings": designation.readings(ROWS)}


def _skf() -> dict[str, Any]:
    """Numbers of SKF's model of friction; constants and boundary diameters of the bearings that have some."""
    numbers = {
        "K_rs": skf_friction.OIL_BATH,
        "K_Z": skf_friction.DEEP_GROOVE,
    }
    numbers |= {"mu_boundary": skf_friction.MU_BOUNDARY, "mu_film": skf_friction.MU_MINERAL}
    numbers |= {"pressure": load_ratings.RATED_PRESSURE, "stribeck": load_ratings.STRIBECK}
    known = {}
    for name in DEEP_GROOVE:
        with suppress(InputError):
            series, bore, outside = skf_friction.boundary_diameters(name)
            known[name] = {"series": skf_friction.CONSTANTS[series], "bore": bore, "outside": outside}
    return {**numbers, "constants": known}


def _in_units(name: str) -> Quantity:
    return INPUTS[name].in_unit(UNITS[name]) if name in UNITS else INPUTS[name]


def _quantity(quantity: Quantity) -> dict[str, Any]:
    return {**quantity._asdict(), "others": dict(quantity.others), "definitions": dict(quantity.definitions)}


def _base64(array: ArrayLike, kind: type[np.generic] = np.float64) -> str:
    little = np.ascontiguousarray(array, np.dtype(kind).newbyteorder("<"))
    return base64.b64encode(little.tobytes()).decode("ascii")
