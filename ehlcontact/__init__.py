"""Transient elastohydrodynamic (EHL) rolling point contacts.

===================  ==================================================================================
module               responsibility
===================  ==================================================================================
``scaling``          inputs (`MoesPoint`, `OperatingPoint`, `Geometry`) and all conventions
``lubricant``        `Lubricant`: Roelands, Barus, Dowson-Higginson
``hertz``            dry elliptic contact
``domain``           computed region
``grid``             levels: work arrays, film, residual, relaxation
``elastic, mlmi``    deflection: direct sum, fast transforms, multilevel multi-integration
``newton``           semismooth Newton on the coarsest grid, closed by load or motion
``multigrid``        full-approximation-scheme cycle and full multigrid
``steady``           `solve_steady`
``motion``           what drives a transient contact
``transient``        implicit film steps
``simulate``         `simulate`
``surface``          travelling features: dent, ridge, waviness
``impedance``        `impedance`: K and C over frequency from the linearised steady state
``full_contact``     `FullContact`: the whole film as a force element
``formulas``         published film and approach formulas, for comparison
``results, status``  frozen results, how a solve ended
``storage``          `save` and `load` (HDF5)
``cli``              the command line; stands above all packages
===================  ==================================================================================
"""

from ehlcontact.domain import Domain
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.full_contact import FullContact
from ehlcontact.impedance import ImpedanceResult, impedance
from ehlcontact.lubricant import Lubricant
from ehlcontact.motion import FreeVibration, HarmonicLoad, PrescribedApproach, PrescribedLoad, RampLoad
from ehlcontact.results import SimulationResult, SteadyResult
from ehlcontact.scaling import Geometry, MoesPoint, OperatingPoint, Scales
from ehlcontact.simulate import simulate
from ehlcontact.status import Status
from ehlcontact.steady import solve_steady
from ehlcontact.storage import load, save
from ehlcontact.surface import Dent, TransverseRidge, Waviness
from ehlcontact.version import __version__

__all__ = [
    "ConvergenceError",
    "Dent",
    "Domain",
    "FreeVibration",
    "FullContact",
    "Geometry",
    "HarmonicLoad",
    "ImpedanceResult",
    "InputError",
    "Lubricant",
    "MoesPoint",
    "OperatingPoint",
    "PrescribedApproach",
    "PrescribedLoad",
    "RampLoad",
    "Scales",
    "SimulationResult",
    "Status",
    "SteadyResult",
    "TransverseRidge",
    "Waviness",
    "__version__",
    "impedance",
    "load",
    "save",
    "simulate",
    "solve_steady",
]
