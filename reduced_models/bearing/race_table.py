"""Load over deflection of one ball on one race, and gains of its film memory, as tables in SI; a row per speed.

Cells between nodes are those of ``race_table.c``; the force at the end of a time step is computed from all in
``race_contact.c``. The law is that of
`reduced_models.elements.film_law` without its reference load, in N and m:

    F = k_n (g(u) + m)_+^(3/2),    g = (F_s/k_n)^(2/3) = u + h_s

with the stiffness k_n of the dry Hertz contact, the static force F_s and film h_s, and the film m that past motion
has added. The time scale of the contact is tau = 2a/u_sum; its semi-axis a = contact_length_factor/2 sqrt(g) grows
with the load. Elements find g(u) by Newton's method; here it is tabulated as
cubics between equidistant approaches from node to node of the static curve, so that its kinks stay where they are.

In a flooded inlet the film force of an unloaded ball falls as slowly as h^-1/2. A `cutoff_gap` h ends it: the film
carries all of F up to a gap of h/2, and nothing beyond h.
"""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from ctypes import c_double, c_int, c_void_p
from itertools import pairwise
from math import ceil, inf, log, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ehlcontact.errors import InputError
from ehlcontact.point import Scales
from reduced_models import core
from reduced_models.elements.film_contact import FilmContact
from reduced_models.elements.film_filters import DIRECT
from reduced_models.elements.film_law import LEAST_MADE, films

_Floats = NDArray[np.float64]

CELLS = 128  # cubics between two nodes: g within 1e-9 of Newton's method in gaps, 1e-10 where surfaces meet
WIDEST_GAP = 4e-3  # [m] to which the table goes; beyond, g falls as it should but its slope is not matched
SPACING = 0.35  # of ln F, at most, between nodes: a film in a wide gap doubles
OVERLOAD = 64.0  # times the load of the last node, to which the table goes
ALIKE = 1e-6  # of ln F: nodes of two speeds closer than this are one


class RaceForceTable(NamedTuple):
    """Static curve over the approach and gains of the film memory over the load, one row for each speed."""

    kn: float  # N/m^1.5, dry
    log_kn: float
    contact_length_factor: float  # 2a over sqrt(g) [m^0.5]
    x: _Floats  # (n,) ln F_s at the nodes, increasing; none for a dry contact
    u: _Floats  # (speeds, n) approach at the nodes [m]
    cells: _Floats  # (speeds, n - 1, CELLS, 4) coefficients of g between them
    gains: _Floats  # (speeds, n, DIRECT + lags)
    film_made: _Floats  # (speeds, n) film G that a unit of the inlet's state lets into the chain
    lag_rate: float
    inlet_rate: float
    fast_rate: float
    cutoff_gap: float  # gap [m] beyond which a film carries nothing; inf: no such gap


class FilmLawStructure(ctypes.Structure):
    """`FilmLaw` of ``film_law.h``."""

    _fields_ = [
        ("nodes", c_int), ("rows", c_int), ("lags", c_int),
        ("x", c_void_p), ("y", c_void_p), ("slope", c_void_p), ("u", c_void_p),
        ("gain_x", c_void_p), ("gains", c_void_p),
        ("lag_rate", c_double), ("inlet_rate", c_double), ("fast_rate", c_double),
        ("inlet_saturation", c_double), ("rim", c_double),
    ]  # fmt: skip


def tabulate_dry_race(kn: float) -> RaceForceTable:
    """Table of a dry Hertz contact: no nodes, no gains."""
    none = np.zeros((1, 0))
    return RaceForceTable(
        kn=kn,
        log_kn=log(kn),
        contact_length_factor=0.0,
        x=none[0],
        u=none,
        cells=np.zeros((1, 0, CELLS, 4)),
        gains=np.zeros((1, 0, DIRECT)),
        film_made=none,
        lag_rate=1.0,
        inlet_rate=1.0,
        fast_rate=1.0,
        cutoff_gap=inf,
    )


def tabulate_race(elements: Sequence[FilmContact], cutoff_gap: float = inf) -> RaceForceTable:
    """Table of one contact from its elements in SI, one for each speed; their reference loads may differ.

    Raises
    ------
    InputError
        An element whose inlet saturates.
    """
    for element in elements:
        if element.inlet_saturation != 0.0:
            allowed = "0 in a bearing, whose filters are worked out once per step"
            raise InputError("inlet_saturation", element.inlet_saturation, allowed)
    nodes = np.unique(np.concatenate([element.law.x + log(scales_of(element).force) for element in elements]))
    x = _lengthened(nodes[np.append(True, np.diff(nodes) > ALIKE)], elements)
    rows = [_rows(element, x) for element in elements]
    gains = np.array([row[2] for row in rows])
    scales, law = scales_of(elements[0]), elements[0].law
    kn = scales.force / scales.length**1.5
    return RaceForceTable(
        kn=kn,
        log_kn=log(kn),
        contact_length_factor=2.0 * scales.a / sqrt(scales.length),
        x=x,
        u=np.array([row[0] for row in rows]),
        cells=np.array([row[1] for row in rows]),
        gains=gains,
        film_made=np.abs(gains[:, :, DIRECT:]).sum(axis=2) + LEAST_MADE,
        lag_rate=law.lag_rate,
        inlet_rate=law.inlet_rate,
        fast_rate=law.fast_rate,
        cutoff_gap=cutoff_gap,
    )


def scales_of(element: FilmContact) -> Scales:
    """Units of an element, which here is always one in SI."""
    assert element.scales is not None
    return element.scales


def _lengthened(x: _Floats, elements: Sequence[FilmContact]) -> _Floats:
    """Nodes of ln F with others between them, and beyond: down to the widest gap, up to the overload."""
    lowest, highest = x[0], x[-1] + log(OVERLOAD)
    while min(_film(element, np.array([lowest]))[0] for element in elements) < WIDEST_GAP:
        lowest -= SPACING
    ends = np.concatenate([[lowest], x, [highest]])
    parts = [np.linspace(a, b, ceil((b - a) / SPACING) + 1)[:-1] for a, b in pairwise(ends.tolist()) if b > a]
    return np.append(np.concatenate(parts), highest)


def _film(element: FilmContact, x: _Floats) -> _Floats:
    """Film h_s [m] at loads e^x [N]."""
    h, slope = np.empty((2, x.size))
    films(element.law, x - log(scales_of(element).force), h, slope)
    return h * scales_of(element).length


def _rows(element: FilmContact, x: _Floats) -> tuple[_Floats, _Floats, _Floats]:
    """Approaches, cells and gains of one speed at the nodes `x`."""
    law, length = element.law, scales_of(element).length
    own = x - log(scales_of(element).force)
    curve = [np.ascontiguousarray(part, np.float64) for part in (law.x, law.y, law.slope, law.u)]
    structure = FilmLawStructure(curve[0].size, 0, 0, *(part.ctypes.data for part in curve))
    u, cells = np.empty(own.size), np.empty((own.size - 1, CELLS, 4))
    core.library().race_cells(
        ctypes.byref(structure), c_int(own.size), *(c_void_p(part.ctypes.data) for part in (own, u, cells))
    )
    return u * length, cells * length, element.gains_at(own).T
