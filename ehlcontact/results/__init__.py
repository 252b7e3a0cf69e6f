"""Frozen results of one instant, and every result in SI; arrays are read-only. Those of a run are in `transient`.

============= =================================================================================
module        responsibility
============= =================================================================================
``steady``    `SteadyResult`: the film at rest
``impedance`` `ImpedanceResult`: stiffness and damping over frequency
``si``        what their ``.si`` gives: every quantity in SI
``layout``    what their quantities are: as xarray, as pandas, as a figure
``contact_map`` pressure and film of a contact as a figure
``picture``   plain figures; matplotlib is imported where one is drawn
============= =================================================================================
"""

from ehlcontact.results.impedance import ImpedanceResult
from ehlcontact.results.si import ImpedanceSI, SteadySI, require_scales
from ehlcontact.results.steady import SteadyResult

__all__ = [
    "ImpedanceResult",
    "ImpedanceSI",
    "SteadyResult",
    "SteadySI",
    "require_scales",
]


def __dir__() -> list[str]:
    """Public names, without the rooms that they are in."""
    return sorted(__all__)
