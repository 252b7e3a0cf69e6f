"""Contacts without a film, for comparison with elements: dry, undamped, and linearised at one load.

Whoever shows an element in a rotor shows these beside it. Where they do as well, the film decides nothing there.
"""

from __future__ import annotations

import math
from dataclasses import replace

from ehlcontact.checks import parts, require_instance, require_nonnegative, require_positive
from ehlcontact.checks.quantity import takes
from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from reduced_models.elements.base import ContactElement
from reduced_models.elements.spring import SpringContact

# Approaches, over that of the static load, between which a Hertz law is written down. Beyond, elements go on as
# the same law, so that the ends decide nothing.
SPAN = (1e-3, 10.0)
DAMPERS = ("C1", "C2", "C3", "B4")  # coefficients that act on the rate, of all elements without memory


def dry_contact(scales: Scales) -> SpringContact:
    """Hertz contact of the same bodies without oil, f = K u^(3/2) in SI: no film, no damper.

    Parameters
    ----------
    scales : Scales
        Of the operating point: the approach of its load is ``scales.length``.
    """
    require_instance("scales", scales, Scales, "the Scales of an operating point")
    low, high = (share * scales.length for share in SPAN)
    factor = scales.force / scales.length**1.5
    return SpringContact.power(K=factor, n=1.5, u0=0.0, F0=0.0, C1=0.0, low=low, high=high, units="SI")


def without_damper(element: ContactElement) -> ContactElement:
    """Copy of an element without memory that has lost its damper and kept its spring.

    Raises
    ------
    InputError
        An element with a memory: its damping is no coefficient of its own.
    """
    require_instance("element", element, ContactElement, "a contact element")
    if element.state_count:
        raise InputError("element", type(element).__name__, "without memory, to lose its damper")
    lost = {name: 0.0 for name in DAMPERS if name in element.parameter_names}
    return replace(element, **lost, fit=None)  # type: ignore[arg-type]


@takes(load="N", approach=parts.APPROACH, stiffness="N/m", damping="N s/m")
def local_contact(load: float, approach: float, stiffness: float, damping: float) -> SpringContact:
    """Contact with a given load, stiffness and damping at one approach, and the curvature of a Hertz contact.

    For a first motion, before there is an element: from a steady film and its impedance.

    Parameters
    ----------
    load : float
        Static force [N].
    approach : float
        Where it is carried [m].
    stiffness, damping : float
        Of small vibrations about it [N/m], [N s/m].
    """
    require_positive("load", load)
    require_positive("stiffness", stiffness)
    if not math.isfinite(approach):
        raise InputError("approach", approach, "finite")
    reach = 1.5 * load / stiffness
    low, high = (share * reach for share in SPAN)
    shift = reach - approach
    return SpringContact.power(
        K=load / reach**1.5,
        n=1.5,
        u0=shift,
        F0=0.0,
        C1=require_nonnegative("damping", damping),
        low=low - shift,
        high=high - shift,
        units="SI",
    )
