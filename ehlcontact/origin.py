"""Where numbers come from: the contact, the mesh it was solved on, and the library that did it.

Results are such origins (they inherit its fields); elements and the atlas keep what `source_of` makes of one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np

from ehlcontact.assumptions import assumptions
from ehlcontact.errors import InputError
from ehlcontact.point import MoesPoint, Scales
from ehlcontact.solver.domain import Domain
from ehlcontact.version import __version__


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Origin:
    """The part that all results have in common.

    Attributes
    ----------
    point : MoesPoint
        The contact, dimensionless.
    scales : Scales or None
        Its units in SI; None for a dimensionless point.
    domain : Domain
        Computed region.
    n : int
        Intervals along X.
    seconds : float
        That it took.
    version : str
        Of the library.
    """

    point: MoesPoint
    scales: Scales | None
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
        return source_of(self.point, self.scales, self.n, self.domain.as_tuple(), motion)


def require_shapes(record: Any, shapes: Mapping[str, tuple[int, ...]]) -> None:
    """Raise `ValueError` naming the first array of another shape."""
    for name, shape in shapes.items():
        if (found := getattr(record, name).shape) != shape:
            raise ValueError(f"{name} has the shape {found}, not {shape}")


def freeze(record: Any) -> None:
    """Make the arrays of a dataclass read-only."""
    for f in fields(record):
        value = getattr(record, f.name)
        if isinstance(value, np.ndarray):
            value.setflags(write=False)


def source_of(
    point: MoesPoint | None,
    scales: Scales | None,
    n: Any,
    domain: Any,
    motion: Any = None,
) -> dict[str, Any]:
    """Provenance of an element, ready for JSON; `n`, `domain`, `motion` may be lists where there are several.

    Of a contact that is known, ``assumptions`` says how far what was assumed holds: with the film to be expected,
    a typical mineral oil, and no roughness.
    """
    found = {
        "point": None if point is None else point.to_dict(),
        "scales": None if scales is None else asdict(scales),
        "n": n,
        "domain": list(domain) if isinstance(domain, tuple) else domain,
        "motion": dict(motion) if isinstance(motion, Mapping) else motion,
        "version": __version__,
    }
    if point is not None:
        found["assumptions"] = assumptions(point, scales=scales, domain=_region(domain)).short()
    return found


def _region(domain: Any) -> Domain | None:
    """The region of `source_of`; the one with the shortest inlet where there are several."""
    regions = [domain] if isinstance(domain, tuple) else domain
    try:
        return max((Domain(*r) for r in regions or ()), key=lambda region: region.x_in, default=None)
    except (InputError, TypeError):  # of a record from elsewhere
        return None
