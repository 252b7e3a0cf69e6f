"""Heights H of spalls and dents, from elastic contacts over them.

The force f of a dry elastic contact over a height h(x) at fixed approach (`ehlcontact.dry_contact`), over that of
smooth surfaces, gives the height H of the same force: (d + H)/d = f^(2/3) with the compression d. What H is off to
first order in h, by the cells of the contact, is known: there H is the mean of h over the contact. Where nothing
touches, H is the height at which the bodies would just touch.

A strip of independent springs (`height_tables`) has the same answer where heights are small, and loses too much
load beside the edge of a deep pit: elastic bodies bulge into it, and its edges are pressed harder.
"""

from __future__ import annotations

from math import ceil, sqrt

import numpy as np
import scipy
from numpy.typing import NDArray

from ehlcontact.dry_contact import ALONG, ElasticContact

_Floats = NDArray[np.float64]

PER_AXIS = 6.0  # places per semi-axis at which contacts are solved; between them H is interpolated
MOST_PLACES = 240  # of one load that are solved
EVEN = 1e-3  # of the largest height: a contact over less has the height in its middle
SHALLOW = 0.3  # heights over the approach, up to which H is corrected for the cells in full


class Track:
    """Heights around a track at equal places, for elastic contacts with a body on it.

    Parameters
    ----------
    profile : ndarray, shape (places,)
        Heights, positive out of the surface [m].
    spacing : float
        Of the places along the track [m].
    strip, radius : float
        a^2/(2 d) of the contact at its compressions d, and reduced radius along the track [m].
    contact : ElasticContact
    """

    def __init__(
        self, profile: _Floats, spacing: float, strip: float, radius: float, contact: ElasticContact
    ) -> None:
        self._spacing, self._strip, self._contact = spacing, strip, contact
        self._highest, self._even = max(float(profile.max()), 0.0), EVEN * float(np.ptp(profile))
        self._sums = np.append(0.0, np.cumsum(profile)) * spacing
        self.touch = highest_touch(profile, spacing, radius, float(np.ptp(profile)))

    def heights(self, approach: float, known: _Floats, near: NDArray[np.bool_]) -> _Floats:
        """H at the compression `approach` d [m]; `known` where nothing is `near`, and where the track is even."""
        raised = approach + self._highest  # of the highest place: no contact reaches beyond the cells
        if raised <= 0.0:
            return np.where(near, self.touch, known)
        known = np.where(near & (known <= -approach), np.minimum(self.touch, -approach), known)
        a = sqrt(2.0 * self._strip * raised)
        at = np.arange(0, known.size, max(int(a / (PER_AXIS * self._spacing)), 1))
        profile = np.zeros((at.size, ALONG))
        profile[near[at]] = self._means(at[near[at]], a * self._contact.edges)
        uneven = np.ptp(profile, axis=1) > self._even
        few = np.flatnonzero(uneven)[:: ceil(max(uneven.sum(), 1) / MOST_PLACES)]
        found = known[at]
        found[few] = self._solved(at[few], a, profile[few], raised) - approach
        kept = np.union1d(np.flatnonzero(~uneven), few)
        x = np.append(at[kept], at[kept[0]] + known.size)
        curve = scipy.interpolate.PchipInterpolator(x, np.append(found[kept], found[kept[0]]))
        beside = np.interp(np.arange(known.size), at, uneven) > 0.0
        return np.where(beside, curve(np.arange(known.size)), known)

    def _solved(self, at: NDArray[np.int64], a: float, profile: _Floats, raised: float) -> _Floats:
        """Approach of smooth surfaces with the force of contacts in the middle of these places [m]."""
        lower, contact = profile - self._highest, self._contact
        force = contact.force(lower / raised)
        mean = self._means(at, np.array([-a, a]))[:, 0] - self._highest
        off = (mean - lower @ contact.first_order) * np.minimum(SHALLOW * raised / np.ptp(lower, axis=1), 1.0)
        lost = np.minimum(self.touch[at] + raised - self._highest, 0.0)
        pressed = np.minimum(raised * force ** (2.0 / 3.0) + off, raised)  # no lower surface carries more
        return np.where(force > 0.0, pressed, lost)

    def _means(self, at: NDArray[np.int64], cells: _Floats) -> _Floats:
        """Mean heights over cells with these m + 1 edges beside the middle of places, (n, m) [m]."""
        edges = (at[:, None] + 0.5) * self._spacing + cells
        around = (self._sums.size - 1) * self._spacing
        turns, rest = np.divmod(edges, around)
        sums = turns * self._sums[-1] + np.interp(rest, self._spacing * np.arange(self._sums.size), self._sums)
        return np.asarray(np.diff(sums, axis=1) / np.diff(cells))


def highest_touch(profile: _Floats, spacing: float, radius: float, depth: float) -> _Floats:
    """Height at which a parabola of this radius, without load, touches a periodic profile, at all places [m]."""
    reach = min(ceil(sqrt(2.0 * radius * depth) / spacing), profile.size // 2)
    found = profile.copy()
    for m in range(-reach, reach + 1):
        np.maximum(found, np.roll(profile, -m) - (m * spacing) ** 2 / (2.0 * radius), out=found)
    return found
