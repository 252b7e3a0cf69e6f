"""Models of FMUs as tests keep them, and what `fmu.export` and `fmu.verify` take to make them."""

from functools import singledispatch
from typing import Any

from fmu import verify
from fmu.bearing.model import BearingModel
from fmu.jeffcott.model import JeffcottModel
from fmu.models import ALL, FmuModel, fmu_model
from fmu.rotor.model import RotorModel
from fmu.shaft.model import ShaftModel


@singledispatch
def given(model: Any) -> tuple[Any, dict[str, Any]]:
    """Model and keywords of `fmu.export`: an element is exported as it is."""
    return model, {}


@given.register
def _(model: BearingModel):
    return model.bearing, {"speeds_rpm": model.speeds_rpm, "load": model.load}


@given.register
def _(model: JeffcottModel):
    inside = {"outside": ALL} if model.contacts is None else {"contacts": model.contacts}
    return model.rotor, {**inside, "start": model.start}


@given.register
def _(model: ShaftModel):
    turning = {"speed_rpm": model.speed_rpm, "inertia": model.inertia}
    return model.rotor, {"outside": ALL, "start": model.start, **turning}


@given.register
def _(model: RotorModel):
    turning = {"speed_rpm": model.speed_rpm, "inertia": model.inertia}
    return model.rotor, {"speeds_rpm": model.speeds_rpm, **turning}


def model_of(model: Any) -> FmuModel:
    """The `FmuModel` of it."""
    source, keywords = given(model)
    return fmu_model(source, **keywords)


def verified(path: Any, model: Any) -> Any:
    """`fmu.verify` of an FMU that should be this model."""
    source, keywords = given(model)
    return verify(path, source, **keywords)
