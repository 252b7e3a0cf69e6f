"""The page of ``ehlcontact explore``: one file that computes in the browser, from the atlas inside it.

Its JavaScript in ``templates/explore`` repeats the Python formulas; tests compare both. This module puts in the
atlas, oils, bearings, ranges of inputs and the constants of its rules.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, fields
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from ehlcontact import __version__
from ehlcontact.assumptions import film, judge
from ehlcontact.assumptions.film import LEAST_LAMBDA, MIXED_LAMBDA
from ehlcontact.checks.admissible_range import INPUTS, Quantity
from ehlcontact.lubricant import MineralOil, oil
from ehlcontact.lubricant.oil import GRADES
from ehlcontact.lubricant.oil_laws import ROELANDS_LOG, ROELANDS_P0
from reduced_models import BallBearing
from reduced_models.atlas import film as atlas_film
from reduced_models.atlas import frequency_curve
from reduced_models.atlas.surface import Surface, shipped
from reduced_models.bearing import coefficients, grooves, kinematics, race, ring, ring_statics
from reduced_models.bearing.catalogue import DEEP_GROOVE
from reduced_models.elements import film_curve, film_response
from reduced_models.rotor.compare_bearing_models import USUAL_DAMPING

# In the order in which they are joined: each stands on those before it; the last two are about the page itself.
SCRIPTS = ("numbers", "hertz", "oil", "atlas", "race", "bearing", "assumptions", "plot", "page")
COMPUTING = SCRIPTS[:7]
UNITS = {"ball_diameter": "mm", "pitch_diameter": "mm", "eta0": "mPa s", "alpha": "1/GPa"}  # others as in Python
# Numbers of the library's own rules, by the modules that have them
RULES: Mapping[Any, tuple[str, ...]] = {
    frequency_curve: ("SPLINE_SHARE",),
    atlas_film: ("THICKEST",),
    race: ("INSIDE", "PER_DECADE", "NEAR"),
    film_curve: ("DECADE", "RIGID_SLOPE"),
    film_response: ("DRY", "LEAST_VISCOUS", "SMALL_OMEGA"),
    grooves: ("LARGEST_PLAY",),
    ring_statics: ("POSITIONS",),
    ring: ("SEATED",),
    kinematics: ("LEAST_SLIP",),
    coefficients: ("TINY_OMEGA",),
    judge: ("CONDUCTIVITY",),
    film: ("LEAST_HEATING_FACTOR", "EYRING_STRESS", "LARGEST_STRESS"),
    oil: ("TYPICAL_SLOPE", "TYPICAL_DENSITY", "LEAST_SLOPE"),
}
OF_INPUTS = ("ball_diameter", "pitch_diameter", "conformity", "speed_rpm", "eta0", "alpha")


def script(names: Iterable[str] = SCRIPTS) -> str:
    """JavaScript of the page, or some of its files joined, and the data first that all of it reads."""
    folder = files("ehlcontact.cli") / "templates" / "explore"
    data = json.dumps(page_data(), allow_nan=False, separators=(",", ":")).replace("</", "<\\/")
    parts = [(folder / f"{name}.js").read_text(encoding="utf-8") for name in names]
    return "\n".join([f"const DATA = {data};", *parts])


def write_explorer(path: Path) -> Path:
    """Write the page.

    Raises
    ------
    InputError
        The file cannot be written.
    """
    from ehlcontact.cli.page import write_page

    content: dict[str, Any] = {"script": script(), "version": __version__, "ratio": USUAL_DAMPING}
    content |= {"index": oil.USUAL_INDEX, "density": oil.USUAL_DENSITY_15}  # as in `Lubricant.iso_vg`
    return write_page(path, "explore/page.html.j2", {}, **content)


def page_data() -> dict[str, Any]:
    """Atlas, oils, bearings and ranges of inputs; arrays in base64."""
    return {
        "version": __version__,
        "atlas": _atlas(shipped("film")),
        "oil": _oils(),
        "catalogue": {name: row._asdict() for name, row in DEEP_GROOVE.items()},
        "quantities": {name: _quantity(_in_units(name)) for name in OF_INPUTS},
        "rules": {name: getattr(module, name) for module, names in RULES.items() for name in names},
        "lambda": {"smooth": LEAST_LAMBDA, "mixed": MIXED_LAMBDA},
    }


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
    numbers |= {"shift": oil.WALTHER_SHIFT, "density_15": oil.USUAL_DENSITY_15}
    numbers |= {"roelands_p0": ROELANDS_P0, "roelands_log": ROELANDS_LOG}
    return {"walther_slopes": walther, **numbers}


def _in_units(name: str) -> Quantity:
    return INPUTS[name].in_unit(UNITS[name]) if name in UNITS else INPUTS[name]


def _quantity(quantity: Quantity) -> dict[str, Any]:
    return {**quantity._asdict(), "others": dict(quantity.others), "definitions": dict(quantity.definitions)}


def _base64(array: ArrayLike, kind: type[np.generic] = np.float64) -> str:
    little = np.ascontiguousarray(array, np.dtype(kind).newbyteorder("<"))
    return base64.b64encode(little.tobytes()).decode("ascii")
