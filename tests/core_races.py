"""Contacts of the C core one by one: ``race_contact.h`` for Python."""

from ctypes import POINTER, Structure, byref, c_double, c_int, c_void_p

import numpy as np

from reduced_models.bearing.core_bearing import FILM, NUMBER, CoreBearing, RaceStructure, pointer
from reduced_models.bearing.freedoms import PLANAR
from reduced_models.elements.film_filters import DIRECT

FILTERS, STATE = 25, FILM.itemsize // NUMBER  # numbers of filters and states, chains left out


class SpeedRow(Structure):
    """Row of the tables, and weight of the next."""

    _fields_ = [("row", c_int), ("weight", c_double), ("slope", c_double)]


class RaceForce(Structure):
    """Force and its slopes."""

    _fields_ = [(name, c_double) for name in ("force", "stiffness", "damping", "by_film", "film", "lift")]


class _RaceStep(Structure):
    _fields_ = [
        ("race", POINTER(RaceStructure)), ("at", SpeedRow), ("transit", c_double), ("film", c_void_p),
        ("before", c_void_p), ("filters", c_void_p),
    ]  # fmt: skip


class CoreRace:
    """The inner contact of balls in C."""

    def __init__(self, balls):
        self._core, lags = CoreBearing(balls, PLANAR), balls.inner.gains.shape[2] - DIRECT
        self._race, self._library = self._core.structure.race[0], self._core.library
        self._library.race_gap.restype = self._library.race_cutoff.restype = c_double
        self._library.race_force.restype, self._library.speed_row.restype = RaceForce, SpeedRow
        self._library.race_accept.restype = c_double
        self.state, self._filters = np.zeros(STATE + lags), np.zeros(FILTERS + 3 * lags)

    def row(self, omega):
        """Row of the tables at a speed [rad/s], and weight of the next."""
        found = self._library.speed_row(self._core.address, c_double(omega))
        return found.row, found.weight

    def curve(self, u, row=(0, 0.0), k=0):
        """Dry compression g at an approach, its slope, and the interval, looked for from k on."""
        at, slope, lift = c_int(k), c_double(), c_double()
        given = byref(self._race), SpeedRow(*row), None, c_double(u)
        return self._library.race_gap(*given, byref(at), byref(slope), byref(lift)), slope.value, at.value

    def cutoff(self, u):
        """Share of its force that the film carries, and its slope."""
        slope = c_double()
        return self._library.race_cutoff(byref(self._race), c_double(u), byref(slope)), slope.value

    def prepare(self, transit, dt, row=(0, 0.0)):
        """Begin a step."""
        self._filters[:] = 0.0
        race = POINTER(RaceStructure)(self._race)
        self._step = _RaceStep(race, SpeedRow(*row), transit, None, pointer(self.state), pointer(self._filters))
        self._library.race_prepare(byref(self._step), c_double(dt))

    def force(self, u, v):
        """At its end."""
        return self._library.race_force(byref(self._step), c_double(u), c_double(v))

    def accept(self, u, v):
        """Move on to its end."""
        self._library.race_accept(byref(self._step), c_double(u), c_double(v), pointer(self.state))
