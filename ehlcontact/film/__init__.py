"""Film maps, mid-planes, fringes and film waves of results: what an optical rig shows.

============= =====================================================================================
module        responsibility
============= =====================================================================================
``plane``     one instant: `film_of` the whole plane, mid-planes, horseshoe, `interferogram`
``over_time`` `film_history`; `film_wave`, which travels with the surfaces, and `track_wave`
============= =====================================================================================
"""

from ehlcontact.film.over_time import FilmHistory, FilmWave, WaveTrack, film_history, film_wave, track_wave
from ehlcontact.film.plane import Film, Interferogram, film_of, interferogram

__all__ = [
    "Film",
    "FilmHistory",
    "FilmWave",
    "Interferogram",
    "WaveTrack",
    "film_history",
    "film_of",
    "film_wave",
    "interferogram",
    "track_wave",
]


def __dir__() -> list[str]:
    """Public names, without the modules that they are in."""
    return sorted(__all__)
