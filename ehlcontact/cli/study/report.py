"""One HTML page that holds the whole study, figures included."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from matplotlib.figure import Figure

from ehlcontact.cli import plots as figures
from ehlcontact.cli.output import write_text
from ehlcontact.cli.study.reduction import MEMORY, RECORDS
from ehlcontact.cli.study.results import Findings

TITLES = RECORDS | {MEMORY: "all bands, with film memory"}
TEMPLATE = "report.html.j2"


def write_report(found: Findings, path: Path) -> Path:
    """Draw the figures and write the page; no other file is needed to read it."""
    environment = Environment(
        loader=PackageLoader("ehlcontact.cli.study"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["sig"] = significant
    with figures.styled():
        images = {name: figures.embedded(draw()) for name, draw in drawings(found).items()}
    page = environment.get_template(TEMPLATE).render(
        found=found, op=found.operating_point, scales=found.study.point.scales, titles=TITLES, images=images
    )
    write_text(path, page)
    return path


def drawings(found: Findings) -> dict[str, Callable[[], Figure]]:
    """The figures by name, not drawn yet."""
    scales, fits, rotors = found.study.point.scales, found.reduction.fits, found.rotors
    cubic = {name: fits[name, "cubic"] for name in found.simulations if (name, "cubic") in fits}
    reduced = rotors.reduced["rotor_band"]
    free = found.simulations["free"]
    return {
        "film_maps": lambda: figures.film_maps(found.steady, scales),
        "midplane": lambda: figures.midplane(found.steady, scales),
        "interferogram": lambda: figures.interferogram(found.steady, scales),
        "convergence": lambda: figures.convergence(found.steady),
        "free": lambda: figures.histories(free, cubic.get("free"), scales),
        "film_wave": lambda: figures.film_wave(found.simulations["harmonic"], scales),
        "loops": lambda: figures.loops(found.simulations, cubic, RECORDS, scales),
        "impedance": lambda: figures.impedance(found.reduction, found.study.rotor_omega),
        "orbit": lambda: figures.orbit(rotors.full, reduced),
        "response": lambda: figures.response(rotors.full, rotors.reduced),
        "spectrum": lambda: figures.spectrum(rotors.full, reduced),
    }


def significant(value: Any, digits: int = 4) -> str:
    """The number with so many significant digits, a dash for none."""
    return "-" if value is None else f"{value:.{digits}g}"
