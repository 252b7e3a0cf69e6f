"""Inputs of study files and of the command line: type, unit, range and meaning of each, declared once.

An alias is the type of an entry of a file and of the option that sets the same quantity. Its metadata are
pydantic's bounds and a description; and `Physical` for what has a unit, or `Allowed` for a range that the library
checks. Messages, the file that ``ehlcontact init`` writes and ``--help`` are made of them.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from math import pi
from typing import Annotated, Any, Literal, NamedTuple, get_args, get_origin

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, GetCoreSchemaHandler
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, PydanticCustomError
from pydantic_core.core_schema import no_info_after_validator_function

from ehlcontact.capacitance import LARGEST as MOST_PERMITTIVE
from ehlcontact.checks import parts
from ehlcontact.checks.admissible_range import INPUTS, Quantity
from ehlcontact.lubricant.oil import DENSITIES, GRADES, INDICES, KINEMATIC, TEMPERATURES
from ehlcontact.transient.motion import FASTEST, SLOWEST


class Section(BaseModel):
    """A section of a file, or a group of options: unknown keys are refused."""

    # strict: in a study `true` is no length of 1 mm, and "7.94" no number. A whole number is a number still.
    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


@dataclass(frozen=True, eq=False)  # by identity: a quantity holds a mapping, and metadata of a type are hashed
class Physical:
    """The physical quantity that an input is: its limits are checked; other units show in messages."""

    quantity: Quantity

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        """Schema of the type itself, and then the limits."""
        return no_info_after_validator_function(self._within, handler(source))

    def _within(self, value: float) -> float:
        low, high = self.quantity.limits
        size = abs(value) if self.quantity.signed else value
        if not (low <= size <= high or (self.quantity.zero and value == 0.0)):
            raise PydanticCustomError("limits", "outside its limits")
        return value


class Allowed(NamedTuple):
    """Range of an input that the library checks, in words."""

    text: str


def _between(ends: tuple[float, float], unit: str) -> Allowed:
    return Allowed(f"between {ends[0]:g} and {ends[1]:g} {unit}")


def _from(least: float, quantity: Quantity) -> Quantity:
    """A length of a machine in mm, from `least` on."""
    found = quantity.in_unit("mm")
    return found._replace(limits=(least, found.limits[1]))


def meaning(text: str) -> Any:
    """Description of an input, for its alias."""
    return Field(description=text)


def _shown(text: str) -> str:
    if not text.isprintable():
        raise PydanticCustomError("printable", "text without control characters")
    return text


Text = Annotated[str, AfterValidator(_shown)]  # heads reports and tables, which a terminal may show
Finite = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[Finite, Field(gt=0.0)]
NotNegative = Annotated[Finite, Field(ge=0.0)]
Whole = Annotated[int, Field(strict=True)]
Share = Annotated[Finite, Field(gt=0.0, lt=1.0)]
CageSlip = Annotated[Finite, Field(gt=-50.0, lt=100.0)]  # percent

# The bearing.
Catalogue = Annotated[str, meaning("name of a ball bearing in the library's catalogue, as 6205")]
Balls = Annotated[Whole, Field(ge=3, le=200, description="number of balls")]
BallDiameter = Annotated[Positive, Physical(INPUTS["ball_diameter"].in_unit("mm")), meaning("diameter of a ball")]
PitchDiameter = Annotated[
    Positive, Physical(INPUTS["pitch_diameter"].in_unit("mm")), meaning("circle through the centres of the balls")
]
Conformity = Annotated[Finite, Physical(INPUTS["conformity"]), meaning("groove radius over ball diameter")]
Race = Annotated[Literal["inner", "outer"], meaning("race of the contact")]
YoungsModulus = Annotated[Positive, Physical(INPUTS["e1"]), meaning("Young's modulus of balls and rings")]
PoissonRatio = Annotated[Finite, Field(ge=0.0, le=0.5, description="Poisson's ratio of balls and rings")]
Clearance = Annotated[
    Finite,
    Physical(Quantity("um", (0.01, 1e5), (0.1, 2e3), {"m": 1e6, "mm": 1e3}, zero=True, signed=True)),
    meaning("radial internal clearance; below 0 the bearing is preloaded"),
]
Offset = Annotated[
    Finite,
    Physical(Quantity("um", (0.1, 1e4), (0.5, 500.0), {"m": 1e6, "mm": 1e3}, zero=True, signed=True)),
    meaning("of a ground ring or spacer that presses the bearing"),
]
Gap = Annotated[
    Positive,
    Physical(Quantity("um", (0.1, 1e4), (1.0, 1e3), {"m": 1e6, "mm": 1e3})),
    meaning("beyond which the film of an unloaded ball is gone"),
]
ContactAngle = Annotated[
    Positive,
    Physical(Quantity("degrees", (1.0, 45.0), (5.0, 45.0), {"rad": 180.0 / pi})),
    meaning("free contact angle of an angular contact bearing"),
]
RaceControl = Annotated[
    Literal["outer", "inner", "shared", "harris"], meaning("race that holds the gyroscopic moment of the balls")
]
Turning = Annotated[Literal["inner", "outer"], meaning("ring that turns")]
AxialLoad = Annotated[
    Finite,
    Physical(Quantity("N", (-1e8, 1e8), (0.1, 1e6), {"kN": 1e3})),
    meaning("axial load on the bearing; an angular contact bearing carries it in +z"),
]
Moment = Annotated[
    Finite, Physical(Quantity("N m", (-1e7, 1e7), (1e-3, 1e5), {"N mm": 1e-3, "kN m": 1e3})), meaning("moment")
]
Tilt = Annotated[
    Finite,
    Physical(Quantity("mrad", (-100.0, 100.0), (0.01, 20.0), {"degrees": 1e3 * pi / 180.0})),
    meaning("tilt at which the inner ring is held"),
]
Load = Annotated[Positive, Physical(INPUTS["load"]), meaning("radial load on the bearing")]
LoadOrNone = Annotated[NotNegative, Physical(INPUTS["load"]._replace(zero=True))]
MatrixProgram = Literal[
    "csv", "json", "ansys-combi214", "ansys-matrix27", "nastran-cbush", "nastran-dmig", "abaqus", "exudyn", "links"
]
Arrangement = Annotated[
    Literal["back-to-back", "face-to-face", "tandem"],
    meaning("two such bearings on one shaft, in this arrangement"),
]
Preload = Annotated[
    Positive, Physical(INPUTS["load"]), meaning("axial force between both at mounting, at rest and without films")
]
Spring = Annotated[
    Positive,
    Physical(INPUTS["load"]),
    meaning("force of a spring on the outer ring of the second one, in its place"),
]
Rating = Annotated[Positive, Physical(parts.RATING)]
RingSpring = Annotated[NotNegative, Physical(parts.PRELOAD)]
Distance = Annotated[
    Positive,
    Physical(Quantity("mm", (1.0, 1e4), (2.0, 5e3), {"m": 1e3, "inches": 25.4})),
    meaning("distance of the planes of two bearings"),
]
Speed = Annotated[Positive, Physical(INPUTS["speed_rpm"]), meaning("speed of the shaft")]
SpeedOrRest = Annotated[NotNegative, Physical(INPUTS["speed_rpm"]._replace(zero=True))]

# Shaft and discs, in mm. What is smaller than any on ball bearings, whose bores begin at .5 mm, is a length in m.
Length = Annotated[Positive, Physical(_from(2.0, parts.SHAFT_LENGTH))]
Diameter = Annotated[Positive, Physical(_from(0.5, parts.SHAFT_DIAMETER))]
Width = Annotated[Positive, Physical(_from(0.1, parts.SHAFT_DIAMETER))]
Bore = Annotated[NotNegative, Physical(_from(0.1, parts.BORE))]
Position = Annotated[NotNegative, Physical(_from(0.5, parts.PLACE._replace(zero=True, signed=False)))]
Density = Annotated[Positive, Physical(parts.DENSITY), meaning("kg/m3")]
Inertia = Annotated[NotNegative, Physical(parts.INERTIA)]
Force = Annotated[Finite, Physical(parts.FORCE._replace(limits=(-1e8, 1e8)))]

# Squeeze film dampers.
FilmLand = Annotated[Positive, Physical(_from(0.1, parts.FILM_LAND))]
RadialClearance = Annotated[Positive, Physical(parts.CLEARANCE.in_unit("um"))]

# A ball on a disc, whose materials are known by name: Young's modulus [Pa], Poisson's ratio.
FLATS = {"steel": (2.06e11, 0.3), "glass": (7.0e10, 0.21)}
Flat = Annotated[Literal["steel", "glass"], meaning("material of the disc; the ball is of steel")]
Entrainment = Annotated[
    Positive, Physical(INPUTS["entrainment_speed"]), meaning("mean of the surface speeds of ball and disc")
]

# The oil in the inlet of the contact.
Eta0 = Annotated[Positive, Physical(INPUTS["eta0"]), meaning("viscosity at ambient pressure")]
Alpha = Annotated[Positive, Physical(INPUTS["alpha"]), meaning("pressure-viscosity coefficient")]
Grade = Annotated[
    Whole, Allowed(", ".join(map(str, GRADES))), meaning("ISO VG grade of a mineral oil: mm2/s at 40 C")
]
Nu40 = Annotated[Positive, Physical(KINEMATIC), meaning("kinematic viscosity at 40 C, of a data sheet")]
Nu100 = Annotated[Positive, Physical(KINEMATIC), meaning("kinematic viscosity at 100 C, of a data sheet")]
Temperature = Annotated[Finite, _between(TEMPERATURES, "C"), meaning("temperature of the oil in the inlet")]
RingTemperature = Annotated[Finite, Physical(parts.TEMPERATURE), meaning("temperature of a part of the machine")]
ViscosityIndex = Annotated[Finite, _between(INDICES, ""), meaning("viscosity index of the grade; 95 if left out")]
Density15 = Annotated[Finite, _between(DENSITIES, "kg/m3"), meaning("density at 15 C; 875 if left out")]
ViscosityLaw = Annotated[Literal["roelands", "barus"], meaning("law of viscosity over pressure")]
DensityLaw = Annotated[Literal["dowson-higginson", "incompressible"], meaning("law of density over pressure")]

# Rating life.
Contamination = Annotated[Finite, Allowed("above 0 and at most 1")]
Reliability = Annotated[Finite, Field(ge=90.0, le=99.95)]

# Voltage across bearings.
Voltage = Annotated[Positive, Physical(Quantity("V", (1e-6, 1e5), (1e-3, 1e3), {"mV": 1e-3, "kV": 1e3}))]
Permittivity = Annotated[Finite, Field(ge=1.0, le=MOST_PERMITTIVE)]
Breakdown = Annotated[
    Positive, Physical(Quantity("V/um", (0.1, 1e4), (1.0, 500.0), {"V/m": 1e-6, "kV/mm": 1.0, "MV/m": 1.0}))
]

# Surfaces, grids and motions.
Roughness = Annotated[
    Finite, Physical(Quantity("um", (1e-3, 100.0), (1e-3, 10.0), {"m": 1e6, "mm": 1e3, "nm": 1e-3}))
]
OilThickness = Annotated[
    Positive,
    Physical(Quantity("um", (1e-6, 1e3), (1e-3, 500.0), {"m": 1e6, "mm": 1e3, "nm": 1e-3})),
    meaning("layer of oil on both surfaces together ahead of the contact"),
]
LayerRatio = Annotated[
    Positive,
    Field(le=1e6),
    meaning("that layer over what the flooded isothermal film of the contact lets through"),
]
BearingLayerRatio = Annotated[  # as tables of oil supply have it: THINNEST of `reduced_models.atlas`
    Finite,
    Field(ge=0.02, le=1e6),
    meaning("that layer over what the flooded isothermal film of each contact lets through"),
]
Intervals = Annotated[Whole, Field(ge=16, le=2048, multiple_of=16)]
Frequency = Annotated[Finite, Field(ge=SLOWEST, le=FASTEST)]  # dimensionless
Hertz = Annotated[NotNegative, Field(le=1e9)]  # of a vibration in Hz: films forget in a millionth of a second
Steps = Annotated[Whole, Field(ge=20, le=2000, description="time steps in each of them")]
Periods = Annotated[Finite, Field(ge=1.0, le=100.0, description="periods that are computed")]

# The rotor: from a watch's balance to a power station's turbine.
Mass = Annotated[Positive, Physical(Quantity("kg", (1e-6, 1e6), (1e-3, 1e5), {"g": 1e-3, "t": 1e3}))]
Stiffness = Annotated[Positive, Physical(Quantity("N/m", (1.0, 1e13), (1e4, 1e10), {"N/mm": 1e3, "N/um": 1e6}))]
Unbalance = Annotated[
    Positive, Physical(Quantity("kg m", (1e-15, 1e4), (1e-8, 1e-3), {"kg mm": 1e-3, "g mm": 1e-6}))
]


# Options of entries that are not their keys without the unit; the first of several is for messages.
OPTIONS = {
    "operation.radial_load": "--load --radial",
    "operation.axial_load": "--axial",
    "oil.iso_vg": "--oil",
    "oil.temperature": "--temp",
    "support.bearing": "--bearing",
    "support.pair_spring": "--spring",
    "support.distance_mm": "--distance-mm",
    "disc.unbalance": "--unbalance",
}
UNITS = ("_mm", "_um", "_deg", "_mrad")  # at the end of keys
WITH_SECTION = ("shaft", "disc")  # options of their entries begin with the name of the section


def options_of(entry: str) -> tuple[str, ...]:
    """Options that set an entry, ``section.key``, of commands that have one for it."""
    if entry in OPTIONS:
        return tuple(OPTIONS[entry].split())
    section, _, key = entry.rpartition(".")
    for unit in UNITS:
        key = key.removesuffix(unit)
    name = f"{section}_{key}" if section in WITH_SECTION else key
    return (f"--{name.replace('_', '-')}",)


def in_options(text: str, entries: Iterable[str]) -> str:
    """The text with options in place of the entries that they set."""
    for entry in sorted(entries, key=len, reverse=True):
        text = text.replace(entry, options_of(entry)[0])
    return text


def entries_of(
    model: type[BaseModel], sections: Iterable[str], left_out: Collection[str] = ()
) -> dict[str, FieldInfo]:
    """Entries of some sections of a file, by ``section.key``, but those that are left out."""
    return {
        f"{section}.{key}": field
        for section in sections
        for key, field in keys_of(model.model_fields[section].annotation).items()
        if f"{section}.{key}" not in left_out
    }


def field_of(model: type[BaseModel], entry: str) -> FieldInfo | None:
    """The declaration of an entry, ``section.key`` or ``name.0`` of a list; None if there is none.

    Numbers and names of tables that a file has several of are passed over, as in ``support.left.balls``.
    """
    fields, field, several = model.model_fields, None, False
    for part in entry.split("."):
        if part in fields:
            field = fields[part]
            fields, several = keys_of(field.annotation), is_several(field.annotation)
        elif field is None or (fields and not several):
            return None
    return field


def section_of(kind: Any) -> Any:
    """The model of a section, also of one that may be left out or stand several times; None of what is none."""
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        return kind
    found = (section_of(one) for one in get_args(kind))
    return next((one for one in found if one is not None), None)


def is_several(kind: Any) -> bool:
    """Whether a file has several tables of that section, each written [[name]]."""
    return get_origin(kind) is tuple and section_of(kind) is not None


def keys_of(section: Any) -> dict[str, FieldInfo]:
    """Entries of a section; none of what is not one."""
    return getattr(section_of(section), "model_fields", {})


def rules_of(field: FieldInfo | None) -> Iterator[Any]:
    """Metadata of an entry, also of one that may be left out."""
    yield from getattr(field, "metadata", ())
    for choice in _parts(getattr(field, "annotation", None)):
        for rule in get_args(choice)[1:] if get_origin(choice) is Annotated else ():
            yield rule
            yield from getattr(rule, "metadata", ())


def _parts(kind: Any) -> Iterator[Any]:
    """Types that a type is made of, as of a list that may be left out."""
    for part in get_args(kind):
        yield part
        if get_origin(part) not in (Annotated, Literal):
            yield from _parts(part)


def quantity_of(field: FieldInfo | None) -> Quantity | None:
    """The physical quantity that an entry is, with its limits and unit."""
    return next((rule.quantity for rule in rules_of(field) if isinstance(rule, Physical)), None)


def meaning_of(field: FieldInfo) -> str:
    """What an entry is, in words."""
    own = (rule.description for rule in (field, *rules_of(field)) if getattr(rule, "description", None))
    return next(own, "")


def allowed_of(field: FieldInfo | None) -> str:
    """All that an entry may be; empty where it takes any number or text."""
    if (quantity := quantity_of(field)) is not None:
        ends = quantity.limits
        sign = ", or as much below 0" if quantity.signed else ""
        zero = "0, or " if quantity.zero else ""
        return f"{zero}between {ends[0]:g} and {ends[1]:g} {quantity.unit}".rstrip() + sign
    if words := next((rule.text for rule in rules_of(field) if isinstance(rule, Allowed)), ""):
        return words.rstrip()
    kind = getattr(field, "annotation", None)
    for choice in (kind, *get_args(kind), *(part for one in get_args(kind) for part in get_args(one))):
        if get_origin(choice) is Literal:
            return " or ".join(json.dumps(name) for name in get_args(choice))
    names = ("ge", "gt", "le", "lt", "multiple_of")
    bounds = {name: getattr(rule, name) for rule in rules_of(field) for name in names if hasattr(rule, name)}
    low, high = bounds.get("ge", bounds.get("gt")), bounds.get("le", bounds.get("lt"))
    multiple = f"a multiple of {bounds['multiple_of']} " if "multiple_of" in bounds else ""
    if low is None:
        return ""
    if high is None:
        return f"a finite number {'>' if 'gt' in bounds else '>='} {low:g}"
    return f"above {low:g} and below {high:g}" if "gt" in bounds else f"{multiple}between {low:g} and {high:g}"
