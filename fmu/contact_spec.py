"""Specification of the FMU of a contact element: name, description, variables and notes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict

from ehlcontact.errors import InputError
from fmu.contact_variables import Element, Film
from fmu.film_spec import film_parts
from fmu.lead import HELD_PARALLEL
from fmu.spec import ModelSpec
from fmu.spring_spec import spring_parts
from fmu.steps import default_step, step_advice
from reduced_models.elements.validity import frequency_text, text_of

LONGEST_NAME = 200  # characters of the name of a contact in the description of an FMU

_DIMENSIONLESS = "dimensionless: force in static loads, approach in dry Hertz approaches, time in 2a/u_sum"


def contact_spec(element: Element, model_name: str | None = None, lead: float = HELD_PARALLEL) -> ModelSpec:
    """Specification of a contact element's FMU.

    Units follow the element: SI, or "1" throughout for a dimensionless one. A linear element is the cubic one
    with K2 = K3 = 0, so both have the same variables. The approach of an element without memory starts in the
    middle of the validity interval, that of a film under its reference load; the rate starts at zero.

    Parameters
    ----------
    element : ContactElement
        Of any kind.
    model_name : str, optional
        Name of the model; the class of the element by default.
    lead : float
        Start value of the parameter `lead`, 0 to 2 communication steps.

    Raises
    ------
    InputError
        No contact element, a name that is empty, too long or not printable, or another lead.
    """
    if not isinstance(element, Element):
        raise InputError("element", type(element).__name__, "a contact element (linear, cubic, ..., wide)")
    name = checked_name(type(element).__name__ if model_name is None else model_name)
    parts = film_parts(element, lead) if isinstance(element, Film) else spring_parts(element, lead)
    system = "SI units" if element.units == "SI" else _DIMENSIONLESS
    return ModelSpec(
        name=name,
        description=f"{parts.pop('description')}; {system}{source_text([element])}",
        notes=_notes(element),
        step=default_step(element),
        time_unit="s" if element.units == "SI" else "1",
        **parts,
    )


def source_text(elements: Iterable[Element]) -> str:
    """Bearing, oil, load and speed of elements in words, where their source names them.

    A description is one line: characters that are not printable are left out.
    """
    given = (str((element.source or {}).get("contact") or "") for element in elements)
    texts = ("".join(filter(str.isprintable, " ".join(text.split())))[:LONGEST_NAME] for text in given)
    return "".join(f"; {text}" for text in dict.fromkeys(texts) if text)


def checked_name(name: object) -> str:
    """Check of a model name; returns it.

    Raises
    ------
    InputError
        Empty, too long or not printable.
    """
    if not isinstance(name, str) or not name.strip() or not name.isprintable() or len(name) > 100:
        raise InputError("model_name", name, "1 to 100 printable characters")
    return name


def _notes(element: Element) -> tuple[tuple[str, str], ...]:
    lines = [("Element", f"{type(element).__name__}, units: {element.units}")]
    if element.rate is not None:
        lines.append(("Largest rate of the data", repr(element.rate)))
    if element.omega_range is not None:
        lines.append(("Frequencies of the data", frequency_text(element.omega_range, element.units)))
    if element.load_range is not None:
        lines.append(("Forces of the data", text_of(element.load_range)))
    made = {name: value for name, value in asdict(element.design_point).items() if value is not None}
    for label, details in (("Made for", made), ("Fit", element.fit), ("Source", element.source)):
        if details:
            lines.append((label, _flat(details)))
    lines += [(label.capitalize(), f"{value}: {why}") for label, value, why in step_advice(element)]
    return tuple(lines)


def _flat(details: Mapping[str, object]) -> str:
    return "; ".join(f"{key}: {_plain(details[key])}" for key in sorted(details) if details[key] is not None)


def _plain(value: object) -> str:
    """A value as text: short numbers, entries of a container in brackets."""
    if isinstance(value, Mapping):
        return f"({', '.join(f'{key} {_plain(one)}' for key, one in value.items() if one is not None)})"
    if isinstance(value, list | tuple):
        return f"({', '.join(map(_plain, value))})"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
