"""Transient elastohydrodynamic (EHL) rolling point contacts.

======================= ==================================================================================
module                  responsibility
======================= ==================================================================================
``scaling``             inputs (`MoesPoint`, `OperatingPoint`, `Geometry`) and all conventions
``lubricant``           `Lubricant`: Roelands, Barus, Dowson-Higginson
``hertz``               dry elliptic contact
``domain``              computed region
``resolution``          grid and region from the film to be expected
``grid``                levels: work arrays, film, residual, relaxation
``elastic, mlmi``       deflection: direct sum, fast transforms, multilevel multi-integration
``newton``              semismooth Newton on the coarsest grid, closed by load or motion
``multigrid``           full-approximation-scheme cycle and full multigrid
``linear_film``         the linearised film as an operator
``preconditioner``      its two-grid preconditioner
``linear_solve``        its flexible Krylov solution
``newton_krylov``       semismooth Newton on the finest grid
``lowest_film``         the smallest film between the nodes
``steady``              `solve_steady`
``motion, table``       what drives a transient contact
``transient``           implicit film steps
``history``             what a simulation records
``step_control``        error and length of a time step
``stepping``            film and motion advanced together
``checkpoint``          a run's file to go on from
``simulate``            `simulate`
``surface``             travelling features: `Dent`, `TransverseRidge`, `Waviness`
``linearised_contact``  impedance of many frequencies from a few solves
``impedance``           `impedance`: K and C over frequency from the linearised steady state
``full_contact``        `FullContact`: the whole film as a force element
``film``                the film to look at: `film_of`, `interferogram`, `film_history`, `film_wave`
``formulas``            published film and approach formulas, for comparison
``results, status``     frozen results, how a solve ended
``storage``             `save` and `load` (HDF5)
``errors``              `InputError`, `ConvergenceError`
``cli``                 the command line; stands above all packages
======================= ==================================================================================
"""

from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.film import (
    Film,
    FilmHistory,
    FilmWave,
    Interferogram,
    WaveTrack,
    film_history,
    film_of,
    film_wave,
    interferogram,
    track_wave,
)
from ehlcontact.impedance import impedance
from ehlcontact.lubricant import Lubricant
from ehlcontact.origin import __version__
from ehlcontact.point import Geometry, MoesPoint, OperatingPoint, Scales
from ehlcontact.results import ImpedanceResult, SteadyResult
from ehlcontact.solver.domain import Domain
from ehlcontact.status import Status
from ehlcontact.steady import solve_steady
from ehlcontact.storage import load, save
from ehlcontact.transient.full_contact import FullContact
from ehlcontact.transient.motion import FreeVibration, HarmonicLoad, RampLoad
from ehlcontact.transient.prescribed import PrescribedApproach, PrescribedLoad
from ehlcontact.transient.result import Instants, SimulationResult
from ehlcontact.transient.simulate import simulate
from ehlcontact.transient.surface import Dent, TransverseRidge, Waviness

__all__ = [
    "ConvergenceError",
    "Dent",
    "Domain",
    "Film",
    "FilmHistory",
    "FilmWave",
    "FreeVibration",
    "FullContact",
    "Geometry",
    "HarmonicLoad",
    "ImpedanceResult",
    "InputError",
    "Instants",
    "Interferogram",
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
    "WaveTrack",
    "Waviness",
    "__version__",
    "film_history",
    "film_of",
    "film_wave",
    "impedance",
    "interferogram",
    "load",
    "save",
    "simulate",
    "solve_steady",
    "track_wave",
]
