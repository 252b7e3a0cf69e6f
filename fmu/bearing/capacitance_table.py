"""Capacitance of the contacts of a bearing as C text: what lies outside the contact ellipse, as a polynomial.

Of a contact under the load F with the central film h at the contact angle alpha

    C = plate F^(2/3)/h + exp(sum_n c_n T_i(x) T_j(y) T_k(z)),

x from the logarithm of h, y from ln(1 + approach/h) over that under the largest load, z from cos(alpha), each
from -1 to 1, T the polynomials of Chebyshev. It is within 3e-5 of `contact_capacitance`; films beyond the table
count as those at its ends.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from fmu.bearing.model import BearingModel
from fmu.c_headers import c_double, c_table
from reduced_models.bearing.capacitance import contact_capacitance
from reduced_models.bearing.race import RACES
from reduced_models.bearing.ring import STEEPEST

_Floats = NDArray[np.float64]
_Places = NDArray[np.int64]

NODES = 16, 24, 5  # of films, of approaches, of contact angles
NEGLIGIBLE = 1e-6  # coefficient that is left out
UNIT = 2.0**-24  # to which coefficients are rounded: digits are in the binaries of five platforms
THINNEST, THICKEST = 3e-9, 0.03  # films [m]; over the ball diameter


@dataclass(frozen=True, eq=False)
class CapacitanceTable:
    """Polynomial of the contacts with one race.

    Attributes
    ----------
    first, last : float
        Logarithms of the thinnest and of the thickest film [m].
    approach, plate : float
        Of the dry contact under 1 N [m]; capacitance of its ellipse times its film under 1 N [F m].
    largest_load : float
        In N.
    flattest, steepest : float
        Cosines of the contact angles at z = 1 and z = -1; of balls that keep one angle both are its cosine.
    powers : ndarray, shape (n, 3)
        Degrees i, j, k of every term.
    coefficients : ndarray, shape (n,)
    """

    first: float
    last: float
    approach: float
    plate: float
    largest_load: float
    flattest: float
    steepest: float
    powers: _Places
    coefficients: _Floats

    @classmethod
    def of(cls, model: BearingModel, race: int) -> CapacitanceTable:
        """Of a bearing with oil and a permittivity."""
        assert model.permittivity is not None
        own, nominal, e = model.bearing.tables.internals, model.bearing.race(RACES[race]), model.permittivity
        largest = max(nominal.heaviest(speed)[0] for speed in model.speeds.tolist())
        ends = log(THINNEST), log(THICKEST * own.ball_diameter)
        span = (1.0, float(np.cos(STEEPEST))) if model.angular else (1.0, 1.0)
        approach = float(nominal.kn ** (-2.0 / 3.0))
        plate = contact_capacitance(own, np.ones(2), np.ones(2), np.zeros(2), e, e).hertz_zone[race]
        empty = np.zeros((0, 3), np.int64)
        table = cls(*ends, approach, float(plate), largest, *span, empty, np.zeros(0))
        nodes = [_nodes(count) for count in (*NODES[:2], NODES[2] if model.angular else 1)]
        load, film, cosine = table._contacts(*np.meshgrid(*nodes, indexing="ij"))
        both = np.stack([np.stack([value, value], axis=-1) for value in (load, film, np.arccos(cosine))])
        parts = contact_capacitance(own, both[0], both[1], both[2], e, e)
        terms = np.log((parts.track + parts.surroundings)[..., race])
        for axis, places in enumerate(nodes):
            inverse = np.linalg.inv(chebyshev.chebvander(places, places.size - 1))
            terms = np.moveaxis(np.tensordot(inverse, terms, (1, axis)), 0, axis)
        powers = np.argwhere(np.abs(terms) > NEGLIGIBLE)
        values = UNIT * np.rint(terms[tuple(powers.T)] / UNIT)
        return cls(*ends, approach, float(plate), largest, *span, powers, values)

    def at(self, load: _Floats, film: _Floats, cosine: _Floats) -> _Floats:
        """Capacitance [F] under loads [N] with films [m] at cosines of contact angles, as the core in C has it."""
        h = np.clip(film, np.exp(self.first), np.exp(self.last))
        pressed = np.minimum(load, self.largest_load) ** (2.0 / 3.0)
        x = 2.0 * (np.log(h) - self.first) / (self.last - self.first) - 1.0
        y = 2.0 * np.log1p(self.approach * pressed / h) / self._largest(h) - 1.0
        z = np.zeros_like(x)
        if self.flattest > self.steepest:
            middle, half = 0.5 * (self.flattest + self.steepest), 0.5 * (self.flattest - self.steepest)
            z = np.clip((cosine - middle) / half, -1.0, 1.0)
        dense = np.zeros(NODES)
        dense[tuple(self.powers.T)] = self.coefficients
        return np.asarray(self.plate * pressed / h + np.exp(chebyshev.chebval3d(x, y, z, dense)))

    def _contacts(self, x: _Floats, y: _Floats, z: _Floats) -> tuple[_Floats, _Floats, _Floats]:
        """Load, film and cosine of the contact angle at places of the polynomial."""
        h = np.exp(self.first + 0.5 * (x + 1.0) * (self.last - self.first))
        load = (np.expm1(0.5 * (y + 1.0) * self._largest(h)) * h / self.approach) ** 1.5
        cosine = 0.5 * (self.flattest + self.steepest) + 0.5 * (self.flattest - self.steepest) * z
        return load, h, cosine

    def _largest(self, film: _Floats) -> _Floats:
        """Logarithm of 1 + approach/film under the largest load."""
        return np.asarray(np.log1p(self.approach * self.largest_load ** (2.0 / 3.0) / film))


def _nodes(count: int) -> _Floats:
    """Of Chebyshev's polynomial of this degree."""
    return np.asarray(np.cos(np.pi * (np.arange(count) + 0.5) / count))


def capacitance_tables(model: BearingModel, name: str) -> tuple[list[str], str]:
    """C definitions of the tables of both races, and of the `CapacitanceTable` of each, as members of an array."""
    lines, members = [], []
    for race, label in enumerate(RACES):
        table = CapacitanceTable.of(model, race)
        numbers = {
            "first": table.first,
            "last": table.last,
            "approach": table.approach,
            "plate": table.plate,
            "largest_load": table.largest_load,
            "flattest": table.flattest,
            "steepest": table.steepest,
        }
        powers = ", ".join(map(str, table.powers.ravel().tolist()))
        lines.append(f"static const unsigned char {name}_{label}_powers[] = {{{powers}}};")
        lines.append(c_table(f"{name}_{label}_terms", table.coefficients))
        fields = [
            ".of = capacitance_of_contact",
            f".terms = {table.coefficients.size}",
            *(f".{k} = {c_double(v)}" for k, v in numbers.items()),
        ]
        fields += [f".power = {name}_{label}_powers", f".coefficient = {name}_{label}_terms"]
        members.append("{" + ", ".join(fields) + "}")
    return lines, "{" + ",\n    ".join(members) + "}"
