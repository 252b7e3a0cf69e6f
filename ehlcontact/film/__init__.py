"""Film maps, mid-planes, fringes and film waves of results: what an optical rig shows.

============= =====================================================================================
module        responsibility
============= =====================================================================================
``plane``     one instant: `film_of` the whole plane, mid-planes, horseshoe, `interferogram`
``over_time`` `film_history`; `film_wave`, which travels with the surfaces, and `track_wave`
``pictures``  coloured fringes; a film through a period, with a slider
============= =====================================================================================
"""

from ehlcontact.film.over_time import film_history, track_wave
from ehlcontact.film.plane import film_of, interferogram

__all__ = [
    "film_history",
    "film_of",
    "interferogram",
    "track_wave",
]


def __dir__() -> list[str]:
    """Public names, without the modules that they are in."""
    return sorted(__all__)
