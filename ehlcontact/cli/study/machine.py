"""Bearings, pairs and rotor of a study, made of its entries; what is none is refused by the entry of the file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from math import radians
from typing import TYPE_CHECKING, Any, NamedTuple

from ehlcontact.cli.study.parts import Part
from ehlcontact.cli.study.shared_entries import pair_part
from ehlcontact.errors import InputError
from reduced_models import (
    BallBearing,
    BearingSet,
    Disc,
    LinearBearing,
    Rotor,
    Shaft,
    Support,
    grade_unbalance,
    rotor_on_bearings,
)
from reduced_models.bearing.catalogue import BY_DIMENSIONS, ROWS, USUAL_CONFORMITY, catalogue_row, designation_of
from reduced_models.bearing.clearance import clearance_limits
from reduced_models.bearing.grooves import LARGEST_PLAY
from reduced_models.bearing.operating_clearance import OperatingClearance, operating_clearance
from reduced_models.bearing.tolerances import IN_METRES

if TYPE_CHECKING:
    from ehlcontact.cli.study.schema import Study

ENTRIES = {  # of a support, where the library calls them otherwise
    "name": "bearing",
    "contact_angle": "contact_angle_deg",
    "arrangement": "pair",
    "spring": "pair_spring",
    "preload and spring": "pair_spring",
    "distance": "distance_mm",
    "offset": "offset_um",
    "position": "position_mm",
}
SIZES = {  # of lengths of entries, over those of the library
    "clearance": 1e6, "offset": 1e6, "cutoff_gap": 1e6, "position": 1e3, "distance": 1e3, "ball_diameter": 1e3,
    "pitch_diameter": 1e3, "length": 1e3, "diameter": 1e3, "width": 1e3, "bore": 1e3,
}  # fmt: skip
SIZES_OF_DISC = {
    "position": "position_mm", "diameter": "diameter_mm", "width": "width_mm", "bore": "bore_mm",
}  # fmt: skip
OF_A_PAIR = ("preload", "pair_spring", "distance_mm")
NEEDED = ("balls", "ball_diameter_mm", "pitch_diameter_mm")  # of a bearing without a name
OF_FITS = "shaft_temperature", "housing_temperature", "housing_material"
SEATS = "shaft", "inner", "outer", "housing"  # that have a temperature
CLEARANCE_DIGITS = 6  # of one in operation, as in scripts
SAME_PLACE = 1e-6  # of the shaft, within which two places are one


class Sizes(NamedTuple):
    """Dimensions of a bearing [m] and conformities of its inner and outer race."""

    balls: int
    ball_diameter: float
    pitch_diameter: float
    conformity: tuple[float, float]


def support_field(study: Study, k: int, key: str) -> str:
    """Name of an entry of a support: with the name of the support where there are several."""
    return f"support.{key}" if len(study.support) == 1 else f"support.{study.names[k]}.{key}"


@contextmanager
def called(prefix: str, names: Mapping[str, str] = ENTRIES) -> Iterator[None]:
    """Let an `InputError` of a part name the entry of the file, with its value in the unit of the entry."""
    try:
        yield
    except InputError as error:
        field, value = error.field, error.value
        if field.startswith(("support", "damper.", "disc.", "operation.", "oil", "surface", "shaft.")):
            raise
        size = SIZES.get(field)
        allowed = error.allowed
        if isinstance(value, list) and len(value) == 1:
            value = value[0]
        if size is not None and isinstance(value, float):
            value, unit = round(size * value, 9), "um" if size == 1e6 else "mm"
            allowed = f"{allowed} (given in {unit})"
        raise InputError(f"{prefix}{names.get(field, field)}", value, allowed) from None


def dimensions_of(study: Study, k: int) -> Sizes:
    """Dimensions of the bearing at a support, by its name or as they are given.

    Raises
    ------
    InputError
        No such name, dimensions beside a name that are not its own, or neither.
    """
    one, at = study.support[k], f"{support_field(study, k, '')}"
    usual = USUAL_CONFORMITY
    if one.bearing is not None:
        try:
            _, row = catalogue_row(one.bearing)
        except InputError as error:
            allowed = error.allowed.replace(BY_DIMENSIONS, "any other by its dimensions, balls = ...")
            raise InputError(f"{at}bearing", error.value, allowed) from None
        usual = row.conformity
        found = row.balls, row.ball_diameter, row.pitch_diameter
        for key, size, own in zip(NEEDED, (1, 1e3, 1e3), found, strict=True):
            known = round(size * own, 6)  # 7.94, not 7.940000000000001
            if getattr(one, key) not in (None, known):
                allowed = f"left out: bearing = {one.bearing!r} has {known:g}"
                raise InputError(f"{at}{key}", getattr(one, key), allowed)
    else:
        for key in NEEDED:
            if getattr(one, key) is None:
                allowed = 'given, or bearing = "6205" in place of all dimensions'
                raise InputError(f"{at}{key}", None, allowed)
        assert one.balls is not None and one.ball_diameter_mm is not None and one.pitch_diameter_mm is not None
        found = one.balls, one.ball_diameter_mm * 1e-3, one.pitch_diameter_mm * 1e-3
        if not one.pitch_diameter_mm > one.ball_diameter_mm:
            allowed = f"above {at}ball_diameter_mm = {one.ball_diameter_mm:g}"
            raise InputError(f"{at}pitch_diameter_mm", one.pitch_diameter_mm, allowed)
    for name in ("conformity_inner", "conformity_outer"):
        if one.conformity is not None and getattr(one, name) is not None:
            raise InputError(f"{at}{name}", getattr(one, name), f"left out where {at}conformity is given")
    both = one.conformity or usual
    return Sizes(*found, (one.conformity_inner or both, one.conformity_outer or both))


def bearing_part(study: Study, k: int, *, oil: bool = True, mounted: bool = True) -> Part:
    """The call that makes the bearing at a support, in oil or dry; of a pair one of both.

    Not `mounted`: as it is before mounting, without its fits and temperatures.

    Raises
    ------
    InputError
        As `dimensions_of`; a class of clearance of a bearing without a name.
    """
    one, rough, sizes = study.support[k], study.roughness, dimensions_of(study, k)
    given: dict[str, Any] = {
        "race_control": one.race_control or "outer",
        "turning": one.turning,
        "oil": study.lubricant if oil else None,
        "rq_ball": rough[0] if rough else None,
        "rq_race": rough[1] if rough else None,
        "youngs_modulus": one.youngs_modulus,
        "poisson_ratio": one.poisson_ratio,
    }
    for name in ("conformity_inner", "conformity_outer"):
        if (value := getattr(one, name) or one.conformity) is not None:
            given[name] = value
    for name in ("loss_factor", "ball_inertia", "dynamic_rating", "static_rating"):
        if (value := getattr(one, name)) is not None:
            given[name] = value
    if one.cutoff_gap_um is not None:
        given["cutoff_gap"] = one.cutoff_gap_um * 1e-6
    if one.contact_angle_deg is not None:
        given["contact_angle"] = radians(one.contact_angle_deg)
    operating = clearance_of(study, k) if mounted else None
    if operating is not None and is_angular(study, k):
        at = support_field(study, k, "")
        try:
            fitted = operating.of(_before_mounting(study, k))
        except InputError as error:
            name = next((name for name in ("shaft_fit", "housing_fit") if getattr(one, name)), "inner_temperature")
            raise InputError(f"{at}{name}", getattr(one, name), error.allowed) from None
        given["contact_angle"] = float(f"{fitted.contact_angle:.{CLEARANCE_DIGITS}g}")
    elif operating is not None:
        given["clearance"] = float(f"{operating.mean:.{CLEARANCE_DIGITS}g}")
    elif one.clearance is not None:
        given["clearance"] = one.clearance if isinstance(one.clearance, str) else one.clearance * 1e-6
    if one.bearing is not None:
        return Part(BallBearing, given, "catalogue", (one.bearing,))
    if isinstance(one.clearance, str):
        allowed = "a number [um]: classes are of bearings by their names, bearing = ..."
        raise InputError(support_field(study, k, "clearance"), one.clearance, allowed)
    lengths = {"ball_diameter": sizes.ball_diameter, "pitch_diameter": sizes.pitch_diameter}
    return Part(BallBearing, {"name": one.label, "balls": sizes.balls, **lengths, **given})


def clearance_of(study: Study, k: int) -> OperatingClearance | None:
    """Clearance of a bearing on its fits, warm and at the speed of the study; None without fits and temperatures.

    Raises
    ------
    InputError
        Entries of fits without them; a bearing without a name.
    """
    one, at = study.support[k], support_field(study, k, "")
    fits = one.shaft_fit, one.housing_fit
    warm = {part: value for part in SEATS if (value := getattr(one, f"{part}_temperature")) is not None}
    for name in OF_FITS:
        fit = f"{name.partition('_')[0]}_fit"
        if getattr(one, fit) is None and (value := getattr(one, name)) not in (None, "steel"):
            raise InputError(f"{at}{name}", value, f"left out without {at}{fit}")
    if fits == (None, None) and not warm:
        return None
    if one.bearing is None:
        name = _entry_of_fits(one, warm)
        allowed = "of a bearing by its name, which has a bore and an outside diameter"
        hint = "any other in Python: operating_clearance(...)"
        raise InputError(f"{at}{name}", getattr(one, name), f"{allowed}; {hint}")
    initial = one.clearance if one.clearance is None or isinstance(one.clearance, str) else one.clearance * 1e-6
    if is_angular(study, k):
        bearing = _before_mounting(study, k)
    else:
        named = designation_of(one.bearing)
        bearing = BallBearing.catalogue(named.name, turning=one.turning)
        initial = (named.clearance or "CN") if initial is None else initial
    try:
        return operating_clearance(
            bearing,
            fit=fits,
            initial=initial,
            shaft_bore=0.0 if study.shaft is None else study.shaft.bore_mm * 1e-3,
            housing_material=one.housing_material,
            temperatures=warm,
            speed_rpm=study.speed_rpm if one.turning == "inner" else 0.0,
        )
    except InputError as error:
        if error.field in ("bore", "outside") and error.value is None:
            name, what = ("shaft_fit", "bore") if error.field == "bore" else ("housing_fit", "outside diameter")
            name = name if getattr(one, name) else _entry_of_fits(one, warm)
            allowed = f"left out: the {what} of {one.bearing} is not known; in Python: operating_clearance(...)"
            raise InputError(f"{at}{name}", getattr(one, name), allowed) from None
        names = {"initial": "clearance", "fit": "shaft_fit" if error.value == one.shaft_fit else "housing_fit"}
        allowed = error.allowed.replace(IN_METRES, "")  # which no entry takes
        raise InputError(f"{at}{names.get(error.field, error.field)}", error.value, allowed) from None


def _entry_of_fits(one: Any, warm: Mapping[str, float]) -> str:
    """Entry that asks for a clearance in operation: a fit, else a temperature."""
    fit = next((name for name in ("shaft_fit", "housing_fit") if getattr(one, name)), None)
    return fit or f"{next(iter(warm))}_temperature"


def _before_mounting(study: Study, k: int) -> BallBearing:
    """The bearing at a support, dry, without its fits and temperatures."""
    with called(support_field(study, k, "")):
        found: BallBearing = bearing_part(study, k, oil=False, mounted=False).made()
        return found


def clearance_limits_of(study: Study, k: int) -> tuple[float, float] | None:
    """Limits within which the clearance of a bearing probably is [m]: of its class, or in operation.

    None where it is a number, of angular contact bearings and pairs.
    """
    one = study.support[k]
    if one.pair is not None or is_angular(study, k):
        return None
    if (operating := clearance_of(study, k)) is not None:
        low, high = operating.probable.tolist()
        return low, high
    name = None if one.bearing is None else designation_of(one.bearing)
    known = one.clearance if one.clearance is not None or name is None else name.clearance
    if name is None or not isinstance(known, str):
        return None
    return clearance_limits(known, ROWS[name.name].bore)


def is_angular(study: Study, k: int) -> bool:
    """Whether the bearing at a support is an angular contact bearing, by its name or by an angle that is given."""
    one = study.support[k]
    named = one.bearing is not None and catalogue_row(one.bearing)[1].contact_angle is not None
    return named or one.contact_angle_deg is not None


def bearing_of(study: Study, k: int, *, oil: bool = True) -> BallBearing:
    """The bearing at a support, with all its balls, in oil or dry; of a pair one of both.

    Raises
    ------
    InputError
        Balls that overlap, a clearance that is none, a race that the atlas does not have.
    """
    one, sizes, at = study.support[k], dimensions_of(study, k), support_field(study, k, "")
    part = bearing_part(study, k, oil=oil)
    try:
        with called(at):
            found: BallBearing = part.made()
            return found
    except InputError as error:
        if error.field == f"{at}clearance" and isinstance(one.clearance, float) and "left" not in error.allowed:
            most = 1e6 * LARGEST_PLAY * sizes.ball_diameter
            raise InputError(error.field, one.clearance, f"between {-most:.3g} and {most:.3g} um") from None
        if error.field.startswith(f"{at}conformity_") and one.conformity is not None:
            raise InputError(f"{at}conformity", error.value, error.allowed) from None
        raise


def carrier_of(study: Study, k: int, *, oil: bool = True) -> BallBearing | BearingSet:
    """What stands at a support: the bearing, or the pair.

    Raises
    ------
    InputError
        As `bearing_of`; bearings that are no pair.
    """
    bearing = bearing_of(study, k, oil=oil)
    part = set_part(study, k, bearing)
    if part is None:
        return bearing
    with called(support_field(study, k, "")):
        found: BearingSet = part.made()
        return found


def set_part(study: Study, k: int, bearing: BallBearing) -> Part | None:
    """The call that makes the pair of such a bearing at a support; None where a bearing alone stands there.

    Raises
    ------
    InputError
        Entries of a pair without one; bearings without a contact angle.
    """
    one, at = study.support[k], support_field(study, k, "")
    if one.pair is None:
        for name in OF_A_PAIR:
            if getattr(one, name) is not None:
                ring = f"; the force of a spring on the outer ring of a bearing is {at}spring"
                hint = "" if study.shaft is None or name == "distance_mm" else ring
                raise InputError(f"{at}{name}", getattr(one, name), f"left out without {at}pair{hint}")
        return None
    more = {"preload": one.preload, "spring": one.pair_spring, "distance_mm": one.distance_mm}
    operating = clearance_of(study, k)
    with called(at):
        if operating is None or one.pair_spring is not None or one.pair == "tandem":
            return pair_part(bearing, one.pair, **more)
        before: BearingSet = pair_part(_before_mounting(study, k), one.pair, **more).made()
        after, name = before.mounted(operating), before.name
        offsets = [float(f"{offset:.{CLEARANCE_DIGITS}g}") for offset in after.offsets]
        set_up = {"facings": after.facings, "positions": after.positions, "offsets": offsets}
        return Part(BearingSet, {"bearings": [bearing] * len(offsets), **set_up, "name": name})


def rotor_of(
    study: Study, *, oil: bool = True, carriers: Sequence[BallBearing | BearingSet | LinearBearing] = ()
) -> Rotor:
    """The rotor of the machine on its bearings, or on others.

    Raises
    ------
    InputError
        Parts that are none, at places where nothing can stand, or that contradict each other.
    """
    shaft, parts = (
        shaft_of(study),
        support_parts(study, carriers or [carrier_of(study, k, oil=oil) for k in range(len(study.support))]),
    )
    supports = []
    for k, part in enumerate(parts):
        with called(support_field(study, k, ""), ENTRIES | {"preload": "spring"}):
            supports.append(part.made())
    discs = [disc_of(study, k) for k in range(len(study.disc))]
    return rotor_on_bearings(shaft, discs=discs, supports=supports)


def support_parts(study: Study, carriers: Sequence[BallBearing | BearingSet | LinearBearing]) -> list[Part]:
    """The calls that make the supports of the machine with these bearings.

    Raises
    ------
    InputError
        As `places_of`.
    """
    from ehlcontact.cli.study.damper import damper_parts

    places = places_of(study)
    axial = _is_axial(study, carriers)
    middle = 0.5 * (min(places) + max(places))
    parts, dampers = [], damper_parts(study)
    for k, (one, carrier) in enumerate(zip(study.support, carriers, strict=True)):
        given: dict[str, Any] = {}
        if one.housing_stiffness is not None or one.housing_mass is not None:
            given = {name: getattr(one, name) for name in ("housing_stiffness", "housing_mass", "housing_damping")}
        if isinstance(carrier, BallBearing) and axial:
            given["facing"] = one.facing or ("+z" if places[k] > middle else "-z")
            given["offset"] = 1e-6 * (one.offset_um or 0.0) + pressed_by_fits(study, k)
            given["preload"] = one.spring
        if k in dampers:
            given["damper"] = dampers[k]
        own = {"position": places[k], "bearing": carrier, "journal_mass": one.journal_mass}
        parts.append(Part(Support, own | given))
    return parts


def pressed_by_fits(study: Study, k: int) -> float:
    """Offset [m] by which fits and warmth press an angular contact bearing alone; 0 on a spring, and of others."""
    operating = clearance_of(study, k) if is_angular(study, k) and study.support[k].spring is None else None
    if operating is None:
        return 0.0
    offset = operating.offset(_before_mounting(study, k))
    return float(f"{offset:.{CLEARANCE_DIGITS}g}")


def shaft_of(study: Study) -> Shaft:
    """The shaft of the machine.

    Raises
    ------
    InputError
        As `shaft_part`; what a `Shaft` refuses.
    """
    part = shaft_part(study)
    with called("shaft.", {"length": "length_mm", "diameter": "diameter_mm", "bore": "bore_mm"}):
        found: Shaft = part.made()
        return found


def shaft_part(study: Study) -> Part:
    """The call that makes the shaft of the machine.

    Raises
    ------
    InputError
        Neither a diameter nor a stiffness, or both.
    """
    given = study.shaft
    assert given is not None
    length = 1e-3 * given.length_mm
    if given.stiffness is not None:
        for name in ("diameter_mm", "bore_mm", "density", "youngs_modulus", "damping_time"):
            if name in given.model_fields_set:
                allowed = "left out where shaft.stiffness is given: such a shaft has no mass"
                raise InputError(f"shaft.{name}", getattr(given, name), allowed)
        return Part(Shaft, {"damping": given.damping}, "jeffcott", (given.stiffness, length))
    if given.diameter_mm is None:
        raise InputError("shaft.diameter_mm", None, "given, or shaft.stiffness of one without mass")
    if given.bore_mm >= given.diameter_mm:
        raise InputError("shaft.bore_mm", given.bore_mm, f"below shaft.diameter_mm = {given.diameter_mm:g}")
    if "damping" in given.model_fields_set:
        allowed = "left out where shaft.diameter_mm is given: such a shaft has a damping_time"
        raise InputError("shaft.damping", given.damping, allowed)
    lengths = {
        "length": length,
        "diameter": 1e-3 * given.diameter_mm,
        "bore": 1e-3 * given.bore_mm,
    }
    rest = {name: getattr(given, name) for name in ("density", "youngs_modulus", "damping_time")}
    return Part(Shaft, lengths | rest)


def disc_of(study: Study, k: int) -> Disc:
    """A disc of the machine.

    Raises
    ------
    InputError
        As `disc_part`; what a `Disc` refuses.
    """
    part = disc_part(study, k)
    with called(disc_field(study, k, ""), SIZES_OF_DISC):
        found: Disc = part.made()
        return found


def disc_field(study: Study, k: int, key: str) -> str:
    """Name of an entry of a disc, with its number where there are several."""
    return f"disc.{key}" if len(study.disc) == 1 else f"disc.{k + 1}.{key}"


def disc_part(study: Study, k: int) -> Part:
    """The call that makes a disc of the machine.

    Raises
    ------
    InputError
        Neither a size nor a mass, or both; a place beyond the shaft.
    """
    one, at = study.disc[k], disc_field(study, k, "")
    load = (0.0, -one.radial_load, one.axial_load) if one.axial_load else (0.0, -one.radial_load)
    more: dict[str, Any] = {"unbalance": one.unbalance, "damping": one.damping, "load": load}
    place, end = 1e-3 * one.position_mm, 1e3 * shaft_of(study).end
    if one.position_mm > end * (1.0 + SAME_PLACE):
        allowed = f"on the shaft: between 0 and {end:g} mm, its length"
        raise InputError(f"{at}position_mm", one.position_mm, allowed)
    if one.mass is not None:
        for name in ("diameter_mm", "width_mm", "bore_mm", "density"):
            if getattr(one, name) is not None:
                raise InputError(f"{at}{name}", getattr(one, name), f"left out where {at}mass is given")
        turns: dict[str, Any] = {
            name: getattr(one, name) or 0.0 for name in ("diametral_inertia", "polar_inertia")
        }
        return Part(Disc, _balanced(study, k, {"position": place, "mass": one.mass, **turns, **more}))
    for name in ("diametral_inertia", "polar_inertia"):
        if getattr(one, name) is not None:
            raise InputError(f"{at}{name}", getattr(one, name), f"left out without {at}mass")
    for name in ("diameter_mm", "width_mm"):
        if getattr(one, name) is None:
            raise InputError(f"{at}{name}", None, f"given, or {at}mass in place of its size")
    assert one.diameter_mm is not None and one.width_mm is not None
    bore = float(shaft_of(study).diameter[0]) if one.bore_mm is None else 1e-3 * one.bore_mm
    if 1e-3 * one.diameter_mm <= bore:
        if one.bore_mm is not None:
            raise InputError(f"{at}bore_mm", one.bore_mm, f"below {at}diameter_mm = {one.diameter_mm:g}")
        allowed = f"above {1e3 * bore:g} mm, the diameter of the shaft, which fills its bore"
        raise InputError(f"{at}diameter_mm", one.diameter_mm, allowed)
    density: dict[str, Any] = {} if one.density is None else {"density": one.density}
    lengths = {"diameter": 1e-3 * one.diameter_mm, "width": 1e-3 * one.width_mm, "bore": bore}
    return Part(
        Disc, _balanced(study, k, {"position": place, **lengths, **density, **more}, "cylinder"), "cylinder"
    )


def _balanced(study: Study, k: int, given: dict[str, Any], how: str = "") -> dict[str, Any]:
    """Arguments of a disc, with the unbalance of its balance grade where that is given."""
    one = study.disc[k]
    if one.balance_grade is None:
        if one.balance_speed_rpm is not None:
            allowed = f"left out without {disc_field(study, k, 'balance_grade')}"
            raise InputError(disc_field(study, k, "balance_speed_rpm"), one.balance_speed_rpm, allowed)
        return given
    if one.unbalance:
        allowed = f"left out where {disc_field(study, k, 'balance_grade')} is given"
        raise InputError(disc_field(study, k, "unbalance"), one.unbalance, allowed)
    with called(disc_field(study, k, ""), SIZES_OF_DISC):
        mass = float(Part(Disc, given, how).made().mass)
    return given | {"unbalance": grade_unbalance(one.balance_grade, mass, balance_speed(study, k))}


def balance_speed(study: Study, k: int) -> float:
    """Speed of the balance grade of a disc [rev/min]: a rotor has one unbalance, that of its highest speed."""
    return study.disc[k].balance_speed_rpm or study.highest_rpm


def places_of(study: Study) -> list[float]:
    """Positions of the supports [m].

    Raises
    ------
    InputError
        One that is missing, beyond the shaft, or where another is; a spring on a bearing that cannot slide; one
        bearing alone.
    """
    places: list[float] = []
    assert study.shaft is not None
    if len(study.support) == 1 and study.support[0].pair is None:
        allowed = 'at least 2 under a shaft, or one that is a pair: pair = "back-to-back"'
        raise InputError("number of [[support]]", 1, allowed)
    end, names = study.shaft.length_mm, study.names
    for k, one in enumerate(study.support):
        at = support_field(study, k, "")
        if one.position_mm is None:
            raise InputError(f"{at}position_mm", None, "given, with [shaft]")
        if one.position_mm > end * (1.0 + SAME_PLACE):
            raise InputError(
                f"{at}position_mm", one.position_mm, f"on the shaft: between 0 and {end:g} mm, its length"
            )
        for other, place in zip(names, places, strict=False):
            if abs(one.position_mm - 1e3 * place) <= SAME_PLACE * end:
                allowed = f"another place than that of support {other}: two bearings at one place are a pair = ..."
                raise InputError(f"{at}position_mm", one.position_mm, allowed)
        if one.turning != "inner":
            allowed = (
                '"inner", or left out, with [shaft], which turns: for a shaft that stands still, a bearing alone'
            )
            raise InputError(f"{at}turning", one.turning, allowed)
        _require_slides(one, at)
        places.append(1e-3 * one.position_mm)
    if study.shaft.stiffness is not None and (
        min(places) > SAME_PLACE * end or max(places) < (1.0 - SAME_PLACE) * 1e-3 * end
    ):
        allowed = "its whole length between the supports: a shaft given by its stiffness ends in its bearings"
        raise InputError("shaft.length_mm", end, allowed)
    springs = [one.spring for one in study.support if one.pair is None]
    if len(springs) == len(study.support) and None not in springs:
        k = len(springs) - 1
        allowed = "left out at one support at least: nothing holds a shaft whose outer rings all slide"
        raise InputError(support_field(study, k, "spring"), springs[k], allowed)
    return places


def _require_slides(one: Any, at: str) -> None:
    """Raise `InputError` for a spring on a bearing whose outer ring cannot slide."""
    if one.spring is None:
        return
    for name, why in (
        ("pair", "the pair is fixed along the shaft, or has a pair_spring of its own"),
        ("housing_stiffness", "its housing stands on springs, in which its ring is fixed"),
        ("offset_um", "it is pressed by an offset, for which its ring is fixed"),
    ):
        if getattr(one, name) is not None:
            allowed = f"left out where {at}{name} is given: this bearing cannot slide ({why})"
            raise InputError(f"{at}spring", one.spring, allowed)


def _is_axial(study: Study, carriers: Sequence[Any]) -> bool:
    """Whether the machine moves along its shaft: springs, offsets, facings, angles, pairs or axial loads."""
    for one, carrier in zip(study.support, carriers, strict=True):
        if isinstance(carrier, BearingSet) or getattr(carrier, "contact_angle", None) is not None:
            return True
        if one.spring is not None or one.offset_um or one.facing is not None:
            return True
    return any(disc.axial_load for disc in study.disc)
