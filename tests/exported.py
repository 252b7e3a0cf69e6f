"""Models of FMUs as tests keep them, and what `fmu.export` and `fmu.verify` take to make them."""

from dataclasses import dataclass, field
from functools import cached_property, singledispatch
from typing import Any

from fmu import verify
from fmu.bearing.model import BearingModel
from fmu.bearing.set_model import SetModel
from fmu.models import FmuModel, fmu_model
from fmu.rotor.model import RotorModel
from reduced_models import Rotor, jeffcott_rotor


@dataclass(frozen=True, eq=False)
class Jeffcott:
    """A Jeffcott rotor with contacts inside, or outside where there are none; settings of `jeffcott_rotor`."""

    settings: dict[str, Any]
    contacts: Any = None
    start: Any = None

    @cached_property
    def rotor(self) -> Rotor:
        rotor = jeffcott_rotor(**self.settings)
        return rotor if self.contacts is None else rotor.on(self.contacts)

    @cached_property
    def model(self) -> RotorModel:
        return RotorModel(self.rotor, () if self.contacts else "all", start=self.start)

    def changed(self, **changes: Any) -> "Jeffcott":
        """With other settings, its start left out."""
        return Jeffcott(self.settings | changes, self.contacts)

    def running(self) -> Rotor:
        """The rotor on contacts of its own."""
        return self.rotor.on([element.copy() for element in self.elements])

    @property
    def elements(self) -> tuple[Any, ...]:
        return self.model.elements

    @property
    def inner_step(self) -> float:
        return self.model.inner_step

    @property
    def state(self) -> tuple[Any, Any]:
        """Where it starts."""
        return self.model.motion


@dataclass(frozen=True, eq=False)
class OfRotor:
    """A rotor and the keywords of its export."""

    rotor: Rotor
    keywords: dict[str, Any] = field(default_factory=dict)

    @cached_property
    def model(self) -> RotorModel:
        return RotorModel(self.rotor, **self.keywords)


@singledispatch
def given(model: Any) -> tuple[Any, dict[str, Any]]:
    """Model and keywords of `fmu.export`: an element is exported as it is."""
    return model, {}


@given.register
def _(model: BearingModel):
    return model.bearing, {"speeds_rpm": model.speeds_rpm, "load": model.load}


@given.register
def _(model: SetModel):
    return model.bearings, {"speeds_rpm": model.speeds_rpm, "load": model.load}


@given.register
def _(model: Jeffcott):
    return model.rotor, {"outside": "all" if model.contacts is None else (), "start": model.start}


@given.register
def _(model: OfRotor):
    return model.rotor, dict(model.keywords)


def model_of(model: Any) -> FmuModel:
    """The `FmuModel` of it."""
    source, keywords = given(model)
    return fmu_model(source, **keywords)


def verified(path: Any, model: Any) -> Any:
    """`fmu.verify` of an FMU that should be this model."""
    source, keywords = given(model)
    return verify(path, source, **keywords)
