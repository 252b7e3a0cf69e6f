"""Origin of results and elements: contact, mesh, and version of the library.

Results inherit the fields of `Origin`; elements and the atlas keep a dictionary, made by `source_of`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np

from ehlcontact.assumptions import assumptions
from ehlcontact.errors import InputError
from ehlcontact.point import OperatingPoint, Point
from ehlcontact.solver.domain import Domain
from ehlcontact.version import __version__


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Origin:
    """Fields that all results have.

    Attributes
    ----------
    point : MoesPoint or OperatingPoint
        The contact, whose units are those of the result.
    domain : Domain
        Computed region, in semi-axes.
    n : int
        Intervals along X.
    seconds : float
        Wall time of the solve.
    version : str
        Of the library.
    """

    point: Point
    domain: Domain
    n: int
    seconds: float
    version: str = __version__

    def __post_init__(self) -> None:
        freeze(self)

    def origin_dict(self) -> dict[str, Any]:
        """Contact, mesh, library and time taken, ready for JSON."""
        return {
            "seconds": self.seconds,
            "n": self.n,
            "domain": list(self.domain.as_tuple()),
            "point": self.point.to_dict(),
            "version": self.version,
        }

    def source(self, motion: Any = None) -> dict[str, Any]:
        """What an element made from this result keeps as its ``source``."""
        return source_of(self.point, self.n, self.domain.as_tuple(), motion)


def freeze(record: Any) -> None:
    """Make the arrays of a dataclass read-only."""
    for f in fields(record):
        value = getattr(record, f.name)
        if isinstance(value, np.ndarray):
            value.setflags(write=False)


def source_of(
    point: Point | None,
    n: Any,
    domain: Any,
    motion: Any = None,
) -> dict[str, Any]:
    """Provenance of an element, ready for JSON; `n`, `domain`, `motion` may be lists where there are several.

    With a point, ``assumptions`` has how far each assumption holds, for the expected film, a typical mineral oil
    and no roughness.
    """
    found = {
        "point": None if point is None else point.moes.to_dict(),
        "scales": asdict(point.scales) if isinstance(point, OperatingPoint) else None,
        "n": n,
        "domain": list(domain) if isinstance(domain, tuple) else domain,
        "motion": dict(motion) if isinstance(motion, Mapping) else motion,
        "version": __version__,
    }
    if point is not None:
        found["assumptions"] = assumptions(point, domain=_region(domain)).short()
    return found


def _region(domain: Any) -> Domain | None:
    """The region of `source_of`; the one with the shortest inlet where there are several."""
    regions = [domain] if isinstance(domain, tuple) else domain
    try:
        return max((Domain(*r) for r in regions or ()), key=lambda region: region.x_in, default=None)
    except (InputError, TypeError):  # of a record from elsewhere
        return None
