"""The kinds of contact element, and how a file finds its class."""

from __future__ import annotations

import os

from ehlcontact.errors import InputError
from reduced_models.elements.base import ContactElement
from reduced_models.elements.file import read_document
from reduced_models.elements.memory import FilmMemoryContact
from reduced_models.elements.polynomial import CubicContact, LinearContact, PolynomialContact
from reduced_models.elements.power import PowerLawContact
from reduced_models.elements.wide import WideRangeContact

__all__ = [
    "KINDS",
    "ContactElement",
    "CubicContact",
    "FilmMemoryContact",
    "LinearContact",
    "PolynomialContact",
    "PowerLawContact",
    "WideRangeContact",
    "load_element",
]

# A new kind of element is entered here, and nowhere else for its files to be read.
KINDS: dict[str, type[ContactElement]] = {
    element.kind: element
    for element in (
        LinearContact,
        CubicContact,
        PolynomialContact,
        PowerLawContact,
        FilmMemoryContact,
        WideRangeContact,
    )
}


def load_element(path: str | os.PathLike[str]) -> ContactElement:
    """Read an element file into the class that wrote it.

    Raises
    ------
    InputError
        Missing, truncated or foreign file, newer version, unknown kind; the message names the file.
    """
    document = read_document(path)
    if document["kind"] not in KINDS:
        raise InputError(str(path), f"kind {document['kind']!r}", "of kind " + " or ".join(KINDS))
    return KINDS[document["kind"]].from_document(str(path), document)
