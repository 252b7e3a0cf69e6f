"""What can be exported, the keywords that each kind takes, and the `FmuModel` of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Any, TypedDict, Unpack

import numpy as np

from ehlcontact.checks import shown
from ehlcontact.errors import InputError
from fmu.bearing.model import BearingModel
from fmu.bearing.references import bearing_references, bearing_trials
from fmu.bearing.set_model import SetModel
from fmu.bearing.set_variables import set_spec
from fmu.bearing.variables import bearing_spec
from fmu.contact_spec import contact_spec
from fmu.contact_variables import Element
from fmu.lead import HELD_PARALLEL
from fmu.references.contact_references import contact_references, contact_trials
from fmu.references.series import References
from fmu.rotor.model import RotorModel
from fmu.rotor.references import rotor_references
from fmu.rotor.variables import rotor_spec
from fmu.spec import ModelSpec
from reduced_models import BallBearing, BearingSet, Rotor
from reduced_models.bearing.freedoms import FIVE

Exported = Element | BallBearing | BearingSet | Rotor


class Keywords(TypedDict, total=False):
    """Keywords of `export` that decide what is exported; `verify` takes them too."""

    model_name: str | None
    lead: float | None
    speeds_rpm: Any
    outside: str | Iterable[str]
    speed_rpm: float | None
    inertia: float | None
    start: Any
    load: Any
    mass: Any
    directions: Sequence[str] | None
    permittivity: float | None


_EVERY = {"model_name", "lead"}
_ROTOR = {"speeds_rpm", "outside", "speed_rpm", "inertia", "start", "permittivity"}
_TAKEN: tuple[tuple[Any, str, set[str]], ...] = (
    (Element, "a contact element", set()),
    (BallBearing, "a ball bearing", {"speeds_rpm", "load", "directions", "permittivity"}),
    (Rotor, "a Rotor", _ROTOR),
    (BearingSet, "a BearingSet without mass=", {"speeds_rpm", "load", "mass", "permittivity"}),
)
_MASSIVE: tuple[Any, str, set[str]] = BearingSet, "a BearingSet with mass=", _ROTOR | {"load", "mass"}


@dataclass(frozen=True, slots=True)
class FmuModel:
    """One model of an FMU.

    Attributes
    ----------
    source : object
        What it is made from.
    spec : ModelSpec
        Variables, C sources and texts.
    elements : tuple of ContactElement
        Contacts that the FMU computes.
    references : callable
        Inputs and results in Python, for the files in the FMU.
    trials : callable
        Those on which the FMU is compared.
    """

    source: Any
    spec: ModelSpec
    elements: tuple[Element, ...]
    references: Callable[[], References]
    trials: Callable[[], References]


def fmu_model(model: Exported, **keywords: Unpack[Keywords]) -> FmuModel:
    """Model of the FMU of a contact element, of ball bearings or a rotor, with the keywords of `export`.

    Raises
    ------
    InputError
        Another kind of model, a keyword that it does not take, or what its kind refuses.
    """
    given: dict[str, Any] = {name: value for name, value in keywords.items() if _is_given(value)}
    _require_taken(model, given)
    model_name, lead = given.pop("model_name", None), given.pop("lead", None)
    if isinstance(model, Element):
        if model.kind == "speed":
            model = replace(model)  # at the speed of its reference
        spec = contact_spec(model, model_name, HELD_PARALLEL if lead is None else lead)
        written, compared = (partial(make, model, spec) for make in (contact_references, contact_trials))
        return FmuModel(model, spec, (model,), written, compared)
    if isinstance(model, BearingSet) and "mass" in given:
        model = model.rotor(given.pop("load", np.zeros(len(FIVE))), mass=given.pop("mass"))
    if isinstance(model, Rotor):
        rotor = RotorModel(model, **given)
        spec = rotor_spec(rotor, model_name, lead)
        trials = cache(partial(rotor_references, rotor, spec))
        return FmuModel(rotor, spec, rotor.elements, trials, trials)
    moved: BearingModel | SetModel
    speeds_rpm = given.pop("speeds_rpm", None)
    if isinstance(model, BearingSet):
        moved = SetModel(model, speeds_rpm, **given)
        spec = set_spec(moved, model_name, lead)
    else:
        moved = BearingModel(model, speeds_rpm, **given)
        spec = bearing_spec(moved, model_name, lead)
    trials = cache(partial(bearing_trials, moved, spec))
    return FmuModel(moved, spec, (), lambda: bearing_references(trials()), trials)


def _is_given(value: Any) -> bool:
    return value is not None and not (isinstance(value, tuple | list) and len(value) == 0)


def _require_taken(model: object, given: dict[str, Any]) -> None:
    """Raise `InputError` for a model of another kind, or a keyword that it does not take."""
    massive = isinstance(model, BearingSet) and "mass" in given
    for kind, words, taken in (_MASSIVE, *_TAKEN) if massive else _TAKEN:
        if isinstance(model, kind):
            for name in given.keys() - taken - _EVERY:
                raise InputError(name, given[name], f"left out for {words}")
            return
    allowed = "a contact element (linear, cubic, ..., speed), BallBearing, BearingSet or Rotor"
    raise InputError("model", shown(model), allowed)
