"""Events in the contacts of a run: lift-off, impacts, range of loads, time outside the validity of elements."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from types import NoneType
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehlcontact.checks import as_column, parts, require_positive
from ehlcontact.checks.kinds import Object, Objects
from ehlcontact.checks.quantity import takes
from ehlcontact.summary import Summary
from reduced_models.elements.base import ContactElement
from reduced_models.elements.validity import MARGIN, OCTAVE, Band, OutsideValidityWarning, Validity, frequency_of
from reduced_models.rotor.result import RotorResult

_Floats = NDArray[np.float64]

LOST = 0.01  # share of the load at rest below which a contact counts as lost: a film never lets go quite


@dataclass(frozen=True)
class ContactEvents(Summary):
    """One contact over one run. Shares are of the samples of the run, which are evenly spaced.

    Attributes
    ----------
    lift_offs, impacts : int
        Times that it was lost, and regained.
    lost_share : float
        Of the samples, without contact.
    load_range : (float, float)
        Smallest and largest force [N].
    outside_approach, outside_rate, outside_load : float or None
        Share outside the element's validity box; None where it has no such bound.
    outside_omega : float or None
        Whether the frequency of the whole run is outside, 1, or inside, 0; None where the box has no bound.
    warnings : tuple of str
        Of the element.
    """

    FIELD_UNITS: ClassVar[Mapping[str, str]] = {"load_range": "N"}

    lift_offs: int
    impacts: int
    lost_share: float
    load_range: Band
    outside_approach: float | None
    outside_rate: float | None
    outside_load: float | None
    outside_omega: float | None
    warnings: tuple[str, ...] = ()

    @property
    def outside(self) -> float:
        """Largest of the shares outside; 0 where there is no box."""
        known = (self.outside_approach, self.outside_rate, self.outside_load, self.outside_omega)
        return max((share for share in known if share is not None), default=0.0)

    def to_dict(self) -> dict[str, Any]:
        """All of it, ready for JSON."""
        return asdict(self) | {"load_range": list(self.load_range), "warnings": list(self.warnings)}


def lift_offs(force: ArrayLike, load: float) -> tuple[int, int, float]:
    """Times that a contact was lost, times that it was regained, and the share of samples without it.

    Parameters
    ----------
    force : array_like, shape (N,)
    load : float
        At rest; below a hundredth of it the contact counts as lost.
    """
    lost = as_column("force", force, least=1) < LOST * require_positive("load", load)
    turns = np.diff(lost.astype(np.int8))
    return int(np.count_nonzero(turns == 1)), int(np.count_nonzero(turns == -1)), float(lost.mean())


@takes(
    result=Object(RotorResult, "a RotorResult"),
    load=parts.PRELOAD,
    elements=Objects((ContactElement, NoneType), "a contact element, or None"),
)
def contact_events(
    result: RotorResult, load: float, elements: Sequence[ContactElement | None] | None = None
) -> tuple[ContactEvents, ...]:
    """Look at every contact of a run.

    Parameters
    ----------
    result : RotorResult
    load : float
        Of a contact in static equilibrium [N].
    elements : sequence, optional
        What the contacts were, for their validity boxes, in SI; None where it was a full film, which has no box.
        They are not changed. As in their warnings, a twentieth of the intervals of approach and load and of the
        largest rate, and an octave of frequency, go unmentioned.
    """
    by_contact = []
    for i, force in enumerate(result.force.T):
        off, on, share = lift_offs(force, load)
        u, v = result.approach[:, i], result.rate[:, i]
        element = None if elements is None else elements[i]
        outside: dict[str, float | None] = dict.fromkeys(("approach", "rate", "load", "omega"))
        said: tuple[str, ...] = ()
        if element is not None:
            outside = outside_shares(element.validity, u, v, force)
            said = _said(element, u, v, force)
        shares = {f"outside_{name}": value for name, value in outside.items()}
        loads = (float(force.min()), float(force.max()))
        by_contact.append(ContactEvents(off, on, share, loads, warnings=said, **shares))
    return tuple(by_contact)


def outside_shares(box: Validity, approach: _Floats, rate: _Floats, force: _Floats) -> dict[str, float | None]:
    """Share of samples outside the bounds of a box on approach, rate, load and omega; None where it has none."""
    omega = frequency_of(approach, rate)
    shares: dict[str, float | None] = {
        "approach": _beyond(approach, box.approach),
        "rate": None if box.rate is None else _beyond(np.abs(rate), (0.0, box.rate)),
        "load": None if box.load is None else _beyond(force, box.load),
        "omega": None,
    }
    if box.omega is not None and omega is not None:
        shares["omega"] = float(not box.omega[0] / OCTAVE <= omega <= box.omega[1] * OCTAVE)
    return shares


def _beyond(values: _Floats, band: Band) -> float:
    slack = MARGIN * (band[1] - band[0])
    return float(np.mean((values < band[0] - slack) | (values > band[1] + slack)))


def _said(element: ContactElement, approach: _Floats, rate: _Floats, force: _Floats) -> tuple[str, ...]:
    """Warnings of a copy of the element about this motion: the one that ran may have warned already."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", OutsideValidityWarning)
        element.copy().warn_outside(approach, rate, force=force, omega=frequency_of(approach, rate))
    return tuple(str(warning.message) for warning in caught)
