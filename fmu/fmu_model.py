"""`FmuModel`: what the export and the verification of an FMU take from an element or a rotor."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ehlcontact.errors import InputError
from fmu.bearing.comparison import bearing_references, compare_bearing
from fmu.bearing.model import BearingModel
from fmu.bearing.variables import bearing_spec
from fmu.comparison import compare_film, compare_spring
from fmu.contact_spec import contact_spec
from fmu.contact_variables import Element, Film
from fmu.controller.comparison import compare_controller, controller_references
from fmu.controller.model import SpeedController, controller_spec
from fmu.jeffcott.comparison import compare_jeffcott
from fmu.jeffcott.model import JeffcottModel
from fmu.jeffcott.references import jeffcott_references
from fmu.jeffcott.variables import jeffcott_spec
from fmu.lead import HELD_PARALLEL
from fmu.references.contact_references import contact_references
from fmu.references.series import References
from fmu.rotor.comparison import compare_rotor, rotor_references
from fmu.rotor.model import RotorModel
from fmu.rotor.variables import rotor_spec
from fmu.shaft.comparison import compare_shaft, shaft_references
from fmu.shaft.model import ShaftModel
from fmu.shaft.variables import shaft_spec
from fmu.spec import ModelSpec
from fmu.verification import Verification
from reduced_models import BallBearing, JeffcottRotor, Rotor

# what an FMU is made from
Source = Element | JeffcottModel | BearingModel | ShaftModel | SpeedController | RotorModel

WANTED = {  # in place of what these functions take
    JeffcottRotor: "JeffcottModel(rotor, contacts), of `fmu.jeffcott`: what export_jeffcott makes an FMU of",
    Rotor: "RotorModel(rotor, speeds_rpm), of `fmu.rotor`: what export_rotor makes an FMU of; "
    "or ShaftModel(rotor), of `fmu.shaft`, for export_shaft",
    BallBearing: "BearingModel(bearing, speeds_rpm), of `fmu.bearing`: what export_bearing makes an FMU of",
}


@dataclass(frozen=True, slots=True)
class FmuModel:
    """One model of an FMU.

    Attributes
    ----------
    spec : ModelSpec
        Variables, C sources and texts.
    elements : tuple of ContactElement
        Contacts that the FMU computes; none of a rotor alone.
    references : callable
        Reference inputs and results, computed in Python.
    compare : callable
        Comparison of two instances, for co-simulation and for model exchange, with the Python model.
    """

    spec: ModelSpec
    elements: tuple[Element, ...]
    references: Callable[[], References]
    compare: Callable[[Any, Any], Verification]


def fmu_model(source: Source, model_name: str | None = None, lead: float | None = None) -> FmuModel:
    """Model of the FMU of a contact element, a rotor, a bearing, a shaft or a speed controller.

    `lead` is the start value of `lead` or `force_lead`, by default that of the kind.

    Raises
    ------
    InputError
        Neither of them, a name that is empty, too long or not printable, or another lead.
    """
    for kind, allowed in WANTED.items():
        if isinstance(source, kind):
            raise InputError("element", type(source).__name__, allowed)
    if isinstance(source, JeffcottModel):
        spec, elements = jeffcott_spec(source, model_name, lead), source.elements
        compare: Any = compare_jeffcott
        references: Any = jeffcott_references
    elif isinstance(source, BearingModel):
        spec, elements = bearing_spec(source, model_name, lead), ()
        compare, references = compare_bearing, bearing_references
    elif isinstance(source, ShaftModel):
        spec, elements = shaft_spec(source, model_name, lead), ()
        compare, references = compare_shaft, shaft_references
    elif isinstance(source, RotorModel):
        spec, elements = rotor_spec(source, model_name, lead), ()
        compare, references = compare_rotor, rotor_references
    elif isinstance(source, SpeedController):
        spec, elements = controller_spec(source, model_name, lead), ()
        compare, references = compare_controller, controller_references
    else:
        spec, elements = contact_spec(source, model_name, HELD_PARALLEL if lead is None else lead), (source,)
        compare = compare_film if isinstance(source, Film) else compare_spring
        references = contact_references
    return FmuModel(
        spec,
        elements,
        references=lambda: references(source, spec),
        compare=lambda slave, exchange: compare(slave, exchange, source, spec),
    )
