"""``ehlcontact element``: a contact element from the atlas, without a solve."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ehlcontact.checks import require_choice
from ehlcontact.cli import options as o
from ehlcontact.cli.contact import Contact, Surfaces, frequency
from ehlcontact.cli.numerals import numeral
from ehlcontact.errors import InputError

if TYPE_CHECKING:
    from reduced_models import AtlasAnswer


class Kind(o.Options):
    """Which element, and for which frequency."""

    model: Annotated[str, typer.Option("--model", help="wide, memory or cubic.")] = "wide"
    Omega: Annotated[
        float | None,
        typer.Option(
            "--Omega",
            "--omega",
            help="Of a cubic, which needs it: the dimensionless angular frequency (unit of time 2a/u_sum) "
            "that its damper is for. Both names mean the same: neither is in rad/s.",
        ),
    ] = None
    hz: Annotated[
        float | None,
        typer.Option("--hz", show_default="that of the shaft", help="The same in Hz, of a bearing's contact."),
    ] = None
    atlas: Annotated[
        Path | None,
        typer.Option("--atlas", metavar="FILE", help="An atlas; the library's own by default."),
    ] = None


@o.grouped
def element(contact: Contact, surfaces: Surfaces, kind: Kind, out: o.ElementOutput) -> None:
    """Take a contact element from the atlas, in SI for a bearing: any load, any frequency, or one of each."""
    from reduced_models.atlas.atlas import MODELS, Atlas

    require_choice("--model", kind.model, MODELS)
    point = contact.point()
    named = kind.model == "cubic" or kind.Omega is not None or kind.hz is not None
    at = frequency(contact, kind.Omega, kind.hz) if named else {}
    if at is None:
        raise InputError("--Omega", None, "given with --model cubic: a damper without memory is for one frequency")
    surfaces.check(contact)
    out.check(kind.atlas)
    table = Atlas(kind.atlas)
    with contact.called():
        answer, made = table.at(point), table.element(point, kind.model, **at)
    if said := contact.said:
        made = replace(made, source={**(made.source or {}), "contact": said})
    rough = () if surfaces.rq is None else surfaces.rows(answer.si.h_min)
    about = {} if surfaces.rq is None else surfaces.about(answer.si.h_min)
    shown = (
        f"{kind.model} element from the atlas, version {table.metadata['version']}",
        [
            *contact.rows(point),
            *(_dimensionless(answer) if contact.rpm is None else _in_si(answer, contact.rpm)),
            *rough,
            *_damper(made),
            *_valid(made),
        ],
    )
    out.deliver({**made.to_dict(), **contact.about(point), **about}, shown, save=made)


def _dimensionless(answer: AtlasAnswer) -> list[tuple[str, str, str]]:
    error = answer.error
    tangent = f"± {numeral(error['stiffness'][0], 1)} dimensionless, as C: time in 2a/u_sum"
    return [
        ("approach", f"{answer.approach:.5f}", f"± {numeral(error['approach'], 1)} of the dry Hertz approach"),
        ("central film", f"{answer.h_central:.5f}", f"± {numeral(error['h_central'], 1)} likewise"),
        ("minimum film", f"{answer.h_min:.5f}", f"± {numeral(error['h_min'], 1)} likewise"),
        ("moment of pressure", f"{answer.moment:.5f}", f"± {numeral(error['moment'], 1)} of load times a"),
        ("static tangent", f"{answer.stiffness[0]:.4f}", tangent),
        *(
            (f"C at Ω = {numeral(w, 3)}", f"{c:.5f}", f"± {numeral(bar, 1)}")
            for w, c, bar in zip(answer.Omega, answer.damping, error["damping"], strict=True)
            if w in (0.05, 1.0) or abs(w - 6.2832) < 1e-3
        ),
    ]


def _in_si(answer: AtlasAnswer, rpm: float) -> list[tuple[str, str, str]]:
    si, shaft = answer.si, answer.impedance(rpm=rpm).si
    C, bar = float(shaft.damping[0]), float(shaft.error["damping"][0])

    def row(name: str, value: float, bar: float, size: float, unit: str, of: str = "") -> tuple[str, str, str]:
        return name, f"{numeral(size * value)} {unit}", f"± {numeral(size * bar, 1)} {unit}{of}"

    return [
        row("approach", si.approach, si.error["approach"], 1e6, "µm"),
        row("central film", si.h_central, si.error["h_central"], 1e6, "µm"),
        row("minimum film", si.h_min, si.error["h_min"], 1e6, "µm"),
        row("moment of pressure", si.moment, si.error["moment"], 1e3, "N mm", ": the film's rolling resistance"),
        row("static tangent", si.stiffness[0], si.error["stiffness"][0], 1e-6, "N/µm"),
        row(f"C at {numeral(rpm / 60.0)} Hz", C, bar, 1.0, "N s/m", ": the shaft's own frequency"),
        *(
            row(f"C at {numeral(hz, 3)} Hz", c, bar, 1.0, "N s/m", f"; Ω = {numeral(w, 3)}")
            for w, hz, c, bar in zip(answer.Omega, si.hz, si.damping, si.error["damping"], strict=True)
            if w in (0.05, 1.0) or abs(w - 6.2832) < 1e-3
        ),
    ]


def _damper(made: Any) -> list[tuple[str, str, str]]:
    """The one damping of a cubic, and the band it is for."""
    from reduced_models.elements.validity import MARGIN, frequency_text

    if not hasattr(made, "C1"):
        return []
    damper = f"{numeral(made.C1)} N s/m" if made.units == "SI" else f"{made.C1:.5f}"
    return [("damper C1", damper, f"within {MARGIN:.0%} for {frequency_text(made.omega_range, made.units)}")]


def _valid(made: Any) -> list[tuple[str, str, str]]:
    """Where it holds."""
    from reduced_models.elements.validity import text_of

    si = made.units == "SI"
    load = "" if made.load_range is None else f"load {text_of(made.load_range)}{' N' if si else ''}"
    ends = [f"{numeral(1e6 * end)} µm" if si else f"{end:.4f}" for end in (made.low, made.high)]
    return [("valid approach", " .. ".join(ends), load)]
