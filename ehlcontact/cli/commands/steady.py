"""``ehlcontact steady``: the film under constant load."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar

import typer

from ehlcontact.cli import entries as e
from ehlcontact.cli import options as o
from ehlcontact.cli.contact import Contact, Surfaces
from ehlcontact.cli.numerals import numeral
from ehlcontact.cli.output import FAILED, complain
from ehlcontact.cli.progress import progress
from ehlcontact.solver.domain import Domain

if TYPE_CHECKING:
    from ehlcontact.results import SteadyResult


WAVELENGTH, REFRACTIVE_INDEX = 600e-9, 1.5  # of the light [m] and of the oil: fringes in the figure


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


@o.grouped
def steady(
    contact: Contact,
    surfaces: Surfaces,
    grid: o.Grid,
    solving: Solving,
    out: o.ResultOutput,
) -> None:
    """Solve the steady film of a contact, in SI for a ball of a bearing."""
    from ehlcontact.steady import solve_steady

    point, chosen = contact.solvable(), grid.chosen() | solving.model_dump()
    surfaces.check(contact)
    out.check()
    with progress("steady film") as update:
        result = solve_steady(
            point,
            **chosen,
            throw=False,
            callback=lambda cycle, residual: update(cycle, None, f"cycle {cycle}, residual {residual:.1e}"),
        )
    rough = () if result.scales is None else surfaces.rows(result.si.h_min)
    about = contact.about(point) | ({} if result.scales is None else surfaces.about(result.si.h_min))
    table = "steady film", [*contact.rows(point), *_rows(result), *rough]
    out.deliver({**result.to_dict(), **about}, table, save=result, figure=partial(_draw, result))
    if result.reservation:
        complain(f"warning: {result.reservation}")
    if not result.status.ok:
        kept = f"; partial result in {out.save}" if out.save else ""
        complain(f"{result.status}: {result.status.advice}{kept}")
        raise typer.Exit(FAILED)


def _draw(result: SteadyResult, path: Path) -> None:
    """Draw the contact, and its fringes where there is a unit of length."""
    from ehlcontact.film import film_of, interferogram

    fringes = [] if result.scales is None else [interferogram(film_of(result), WAVELENGTH, REFRACTIVE_INDEX)]
    result.plot(path, *fringes)


def _rows(result: SteadyResult) -> list[tuple[str, str, str]]:
    shares = ["", ""]
    if (error := result.error) is not None:
        shares = [f", ± {numeral(100.0 * e, 2)} % of it" for e in (error.h_central, error.h_min)]
    return [
        *(_dimensionless(result, *shares) if result.scales is None else _in_si(result, *shares)),
        ("pressure to come", f"{result.pressure_error:.1e}", "of the Hertz pressure, by further cycles"),
        ("residual", f"{result.residual:.1e}", "over the dry start's"),
        ("load balance", f"{result.load_residual:.1e}", "over the load"),
        ("cycles", f"{result.cycles}", ""),
        ("grid", f"n = {result.n}", f"on {o.domain_text(result.domain)}"),
        ("computed in", f"{numeral(result.seconds, 3)} s", ""),
        ("status", str(result.status), ""),
    ]


def _dimensionless(result: SteadyResult, central: str, smallest: str) -> list[tuple[str, str, str]]:
    approach = "" if result.error is None else f", ± {numeral(result.error.approach, 1)}"
    return [
        ("approach", f"{result.approach:.5f}", f"of the dry Hertz approach{approach}"),
        ("central film", f"{result.h_central:.5f}", f"of the dry Hertz approach{central}"),
        ("minimum film", f"{result.h_min:.5f}", f"of the dry Hertz approach{smallest}"),
        ("maximum pressure", f"{result.p_max:.4f}", "of the Hertz pressure"),
        (
            "moment of pressure",
            f"{result.moment:.5f}",
            f"of load times semi-axis a: the film's rolling resistance{_left_out(result)}",
        ),
    ]


def _in_si(result: SteadyResult, central: str, smallest: str) -> list[tuple[str, str, str]]:
    si = result.si
    approach = "" if si.error is None else f", ± {numeral(1e6 * si.error.approach, 1)} µm"
    return [
        ("approach", f"{numeral(1e6 * si.approach, 5)} µm", f"{result.approach:.5f} of the dry one{approach}"),
        ("central film", f"{numeral(1e6 * si.h_central)} µm", central.removeprefix(", ")),
        ("minimum film", f"{numeral(1e6 * si.h_min)} µm", smallest.removeprefix(", ")),
        ("maximum pressure", f"{numeral(1e-9 * si.p_max)} GPa", f"{numeral(result.p_max)} of the Hertz pressure"),
        (
            "moment of pressure",
            f"{numeral(1e3 * si.moment)} N mm",
            f"about the centre line: rolling resistance{_left_out(result)}",
        ),
    ]


def _left_out(result: SteadyResult) -> str:
    """Say that the region ends nearer to the contact than the default one: that costs moment."""
    if result.domain.x_in <= Domain().x_in:
        return ""
    full = " ".join(f"{bound:g}" for bound in Domain().as_tuple())
    return f", low for want of the oil before X = {result.domain.x_in:g} (with it: --domain {full})"
