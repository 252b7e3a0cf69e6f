"""Transient elastohydrodynamic (EHL) rolling point contacts.

================= ==========================================================================================
module            responsibility
================= ==========================================================================================
``point``         inputs (`MoesPoint`, `OperatingPoint`, `Geometry`) and all conventions
``lubricant/``    `Lubricant`, from its numbers or its grade; the laws of viscosity, density and traction
``hertz``         dry elliptic contact
``capacitance``   capacitance of gaps with oil: of dry contacts that a film separates, of spheres
``dry_contact``   `ElasticContact`: dry contact over heights along its track
``film_formulas``  published film and approach formulas: grids are chosen from them, results compared with them
``solver/``       film at one instant: mesh, equations, multigrid, Newton
``steady``        `solve_steady`
``supply``        `OilLayer`: the oil that the surfaces carry to a contact
``asperities``    `Asperities`: rough surfaces that carry part of the load
``heat``          `Heat`: what the heating of a film needs of oil and surfaces
``conditions``    `Conditions`: supply, heat, sliding and asperities as one; which of them go together
``traction``      `traction_curve`: traction over the slide-to-roll ratio
``side_flow``     `oil_passes`: films pass after pass of a track; closed form of thin layers
``shear_thinning`` `ShearThinning`: shear thinning of a film by sliding
``response``      `response`: force over frequency by changes of approach or speed, or by waves; two plain names
``linearised_film``  steady films to linearise, on the finest and on coarser meshes
``transient/``    film through time: motions, surfaces, `simulate`, `TransientContact`
``assumptions/``  assumptions of every solve, each with the number that shows whether it holds
``quantities``    units, scales and dimensions of quantities, declared once in the annotations of results
``results/``      results of films at rest and of linearised ones; units, tables and figures of all results
``origin``        contact, mesh and version that a result or an element comes from
``version``       of the distribution
``film/``         films for display: maps, mid-planes, fringes, film waves; a namespace of its own
``store``         `save` and `read`: one file header, one way back, for every class
``binaries/``     C compilers of this machine and for others; compiled libraries, kept
``content_store`` `ContentStore`: what is computed, found by the hash of its inputs
``files``         files written in one move; texts of any origin
``executors``     executors of `concurrent.futures`: worker processes, or a Dask cluster
``process/``      worker processes, Ctrl-C, threads
``checks/``       checks of inputs, and the admissible ranges of operating points
``errors``        `InputError`, `ConvergenceError`
``status``        how a solve or a run ended, with advice
``summary``       `Summary`: what results and elements show at the prompt and in notebooks
``jit``           the numba decorators of the library
``kernel_cache``  compiled kernels on disk: checked before they are used, or done without
``lanes``         eight neighbouring numbers at a time, for kernels
``elementary``    exponential and logarithm, likewise
``cli/``          the command line; stands above all packages
================= ==========================================================================================

Public names are those that a user calls, constructs or catches; classes that are only returned (`point.Scales`)
and tools of a special field (`side_flow.oil_passes`) stay in their modules, by which the reference names them.
"""

from ehlcontact import process as process  # first: from here on Ctrl-C ends the command line in one line
from ehlcontact.asperities import Asperities
from ehlcontact.assumptions import assumptions
from ehlcontact.errors import ConvergenceError, InputError
from ehlcontact.heat import Heat
from ehlcontact.lubricant import Lubricant
from ehlcontact.point import Geometry, MoesPoint, OperatingPoint
from ehlcontact.response import Waves, excitation, impedance, response
from ehlcontact.shear_thinning import ShearThinning
from ehlcontact.solver.domain import Domain
from ehlcontact.solver.grid import Grid
from ehlcontact.steady import solve_steady
from ehlcontact.store import read, save
from ehlcontact.supply import OilLayer
from ehlcontact.transient.features import Dent, TransverseRidge, Waviness
from ehlcontact.transient.motion import FreeVibration, HarmonicLoad, RampLoad
from ehlcontact.transient.prescribed import PrescribedApproach, PrescribedLoad
from ehlcontact.transient.roughness import Roughness
from ehlcontact.transient.settings import KeepSettings, RunSettings, TimeSteps
from ehlcontact.transient.simulate import simulate
from ehlcontact.transient.speed import SpeedHistory
from ehlcontact.transient.transient_contact import TransientContact
from ehlcontact.version import __version__

__all__ = [
    "Asperities",
    "ConvergenceError",
    "Dent",
    "Domain",
    "FreeVibration",
    "Geometry",
    "Grid",
    "HarmonicLoad",
    "Heat",
    "InputError",
    "KeepSettings",
    "Lubricant",
    "MoesPoint",
    "OilLayer",
    "OperatingPoint",
    "PrescribedApproach",
    "PrescribedLoad",
    "RampLoad",
    "Roughness",
    "RunSettings",
    "ShearThinning",
    "SpeedHistory",
    "TimeSteps",
    "TransientContact",
    "TransverseRidge",
    "Waves",
    "Waviness",
    "__version__",
    "assumptions",
    "excitation",
    "impedance",
    "read",
    "response",
    "save",
    "simulate",
    "solve_steady",
]


def __dir__() -> list[str]:
    """Public names, without the rooms that were imported on the way."""
    return sorted(__all__)
