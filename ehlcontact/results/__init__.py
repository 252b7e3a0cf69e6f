"""Results of films at rest and of linearised ones, and what all results share: units, tables, figures.

===================== =================================================================================
module                responsibility
===================== =================================================================================
``steady_result``     `SteadyResult`: the film at rest
``film_temperature``  `FilmTemperature`: temperatures of a heated film
``asperity_contact``  `AsperityContact`: load share of asperities beside a film
``capacitance``       `FilmCapacitance`: capacitance and field strength of a film
``response``          `Response`: force over frequency by small changes of a contact or a bearing
``traction``          `Traction`: traction of a film over the slide-to-roll ratio
``table``             `PointTable`, `QuantityTable`: units, dictionary, tables and figure of quantities
``picture``           pictures as data: panels of lines and bars, maps, load zones
``contact_map``       picture of a contact: maps of pressure and film, mid-planes, convergence
``drawing``           pictures drawn with matplotlib, which is imported where one is drawn
===================== =================================================================================
"""

from ehlcontact.results.response import Response
from ehlcontact.results.steady_result import SteadyResult
from ehlcontact.results.traction import Traction

__all__ = [
    "Response",
    "SteadyResult",
    "Traction",
]


def __dir__() -> list[str]:
    """Public names, without the modules that they are in."""
    return sorted(__all__)
