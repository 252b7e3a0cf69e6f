"""``ehlcontact steady``: the film under constant load."""

from __future__ import annotations

from functools import partial
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar

import numpy as np
import typer

from ehlcontact.cli import entries as e
from ehlcontact.cli import options as o
from ehlcontact.cli.contact import Contact, ContactAnswer, FilmConditions, Mixed, Surfaces
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import FAILED, complain
from ehlcontact.cli.progress import progress
from ehlcontact.cli.rows import Row, heat_rows, quantity_rows, run_rows, share_text, thinning_rows
from ehlcontact.point import OperatingPoint
from ehlcontact.results.contact_map import VIEW
from ehlcontact.solver.domain import Domain
from ehlcontact.summary import film_unit

if TYPE_CHECKING:
    from ehlcontact.results import SteadyResult, Traction


WAVELENGTH, REFRACTIVE_INDEX = 600e-9, 1.5  # of the light [m] and of the oil: fringes in the figure
POINTS = 401  # of them along and across: a grid's own would show false ones


class Solving(o.Options):
    """How it is solved, and how far."""

    panel: ClassVar[str | None] = "Solver"
    method: Annotated[
        str,
        typer.Option(
            "--method",
            help="automatic, multigrid or newton: V cycles, Newton steps, or cycles and Newton where they fail.",
        ),
    ] = "automatic"
    tol: Annotated[
        e.Positive,
        typer.Option("--tol", help="Largest change of the pressure still to come, over the Hertz pressure."),
    ] = 1e-5
    refine: Annotated[
        bool,
        typer.Option(
            "--refine/--no-refine",
            help="Without --n: a finer grid where the errors estimated are above 0.2 % of the dry approach, "
            "1 % of the central and 3 % of the smallest film.",
        ),
    ] = True
    budget: Annotated[
        e.Positive,
        typer.Option(
            "--budget",
            help="Without --n: time of one core, s, that all grids and methods tried may be expected to take.",
        ),
    ] = 60.0


@o.grouped
def steady(
    contact: Contact,
    conditions: FilmConditions,
    surfaces: Surfaces,
    mixed: Mixed,
    grid: o.Grid,
    solving: Solving,
    out: o.ResultOutput,
) -> None:
    """Solve the steady film of a contact, in SI for a ball of a bearing."""
    from ehlcontact.steady import solve_steady

    chosen = grid.chosen() | solving.model_dump() | conditions.chosen(contact, traction=True)
    point = contact.solvable()
    surfaces.check(contact)
    chosen |= {"asperities": mixed.chosen(surfaces)}
    out.check()
    with progress("steady film") as update:
        result = solve_steady(
            point,
            **chosen,
            throw=False,
            callback=lambda cycle, residual: update(cycle, None, f"cycle {cycle}, residual {residual:.1e}"),
        )
    traction = conditions.traction(result)
    answer = ContactAnswer(contact, point, result, result, surfaces, result.h_min)
    answer.deliver(
        out,
        "steady film",
        [*_rows(result), *_traction_rows(traction)],
        judged=result.status.ok,
        more=None if traction is None else {"traction": traction.to_dict()},
        save=result,
        figure=partial(_draw, result, traction),
    )
    if not result.status.ok:
        kept = f"; partial result in {out.save}" if out.save else ""
        complain(f"{result.status}: {result.status.advice}{kept}")
        raise typer.Exit(FAILED)


def _draw(result: SteadyResult, traction: Traction | None, path: Path) -> None:
    """Draw the contact, its fringes where there is a unit of length, and its shear stress where it slides."""
    from ehlcontact.film import film_of, interferogram
    from ehlcontact.film.plane import interpolated
    from ehlcontact.results.drawing import draw
    from ehlcontact.results.picture import Picture
    from ehlcontact.summary import contact_text

    panels = result.panels()
    if isinstance(result.point, OperatingPoint):
        film, s = film_of(result), result.point.scales
        ends = (s.a * VIEW[0], s.a * VIEW[1]), (-s.b * VIEW[2], s.b * VIEW[2])
        x, y = (
            np.linspace(max(first, at[0]), min(last, at[-1]), POINTS)
            for (first, last), at in zip(ends, (film.x, film.y), strict=True)
        )
        panels += interferogram(interpolated(film, x, y), WAVELENGTH, REFRACTIVE_INDEX).panels()
    if traction is not None:
        panels.append(traction.map())
    draw(Picture(panels, f"steady film: {contact_text(result.point)}"), path)


def _rows(result: SteadyResult) -> list[Row]:
    error, to_come = result.error_estimate, result.dimensionless.pressure_error
    central, smallest = (
        ("", "") if error is None else map(share_text, (error.h_central_relative, error.h_min_relative))
    )
    remarks = {"approach": "", "h_central": central, "h_min": smallest, "p_max": "", "moment": _left_out(result)}
    return [
        *quantity_rows(result, remarks, None if error is None else {"approach": error.approach}),
        ("pressure to come", f"{to_come:.1e}", "of the Hertz pressure, by further cycles"),
        ("residual", f"{result.residual:.1e}", "over the dry start's"),
        ("load balance", f"{result.load_residual:.1e}", "over the load"),
        ("cycles", f"{result.cycles}", ""),
        *_supply_rows(result),
        *thinning_rows(result),
        *heat_rows(result),
        *_asperity_rows(result),
        *run_rows(result),
    ]


def _supply_rows(result: SteadyResult) -> list[Row]:
    """Layer of oil that arrives, and where the film begins to be full."""
    if result.layer is None:
        return []
    assert result.front is not None
    size, unit = film_unit(result.point)
    front = f"full from x/a = {result.front / result.point.scales.a:.3g} on"
    return [("layer of oil", f"{numeral(size * result.layer[0])} {unit}", front)]


def _asperity_rows(result: SteadyResult) -> list[Row]:
    """Load share of the asperities, and what they make of the film."""
    found = result.asperities
    if found is None:
        return []
    film = f"their central film is {found.film_share:.4g} of that between smooth surfaces"
    return [("load on asperities", f"{100.0 * found.load_share:.3g} %", film)]


def _traction_rows(found: Traction | None) -> list[Row]:
    """Traction and the power that it takes."""
    if found is None:
        return []
    coefficient, force, power = (float(one[0]) for one in (found.coefficient, found.force, found.power))
    most = f", at most {numeral(found.limit, 3)}" if isfinite(found.limit) else ""
    stress = numeral(1e-6 * float(found.mean_stress[0]), 3)
    beside = f"over the load{most}, at a slide-to-roll ratio of {found.slide_roll[0]:g}"
    return [
        ("traction", f"{numeral(coefficient, 3)}", beside),
        ("traction force", f"{numeral(force, 3)} N", f"mean shear stress {stress} MPa"),
        ("power of sliding", f"{numeral(power, 3)} W", ""),
    ]


def _left_out(result: SteadyResult) -> str:
    """Say that the region ends nearer to the contact than the default one: that costs moment."""
    if result.domain.x_in <= Domain().x_in:
        return ""
    full = " ".join(f"{bound:g}" for bound in Domain().as_tuple())
    return f"low for want of the oil before X = {result.domain.x_in:g} (with it: --domain {full})"
