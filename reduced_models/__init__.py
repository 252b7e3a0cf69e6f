"""Contact elements reduced from transient EHL, and rotors that run on them.

| package | is responsible for |
|---|---|
| core | the C core, compiled once and loaded: balls, races, films, rotor steps |
| csrc | its sources, which FMUs have too |
| elements | the elements: law, validity, units |
| fitting | elements from data: `ContactRecord`, `fit`, `fit_memory`, `sensitivity` |
| atlas | elements without a solve: `Atlas`, from contacts solved beforehand, with error bars |
| life | rating life of ball bearings by the standards, from the loads of all balls |
| bearing | ball bearings of such contacts: `BallBearing` |
| rotor | rotors on contacts, full films and ball bearings: equilibrium, motion over time, responses |
| periodic_motion | motions of rotors that repeat themselves: harmonic balance, shooting, stability, bifurcations |
| margins | samples of machines with uncertain inputs: `uncertainty`, `spread` |
| signals | acceleration of nodes and housings, its spectra and features; a namespace of its own |

Public names are those that a user calls, constructs or catches; classes that are only returned and tools of a
special field stay in their modules, by which the reference names them. Symbols and units: `ehlcontact.point`.
"""

from inspect import ismodule as _ismodule

from reduced_models import signals as signals
from reduced_models.atlas.atlas import Atlas as Atlas
from reduced_models.bearing.ball_bearing import BallBearing as BallBearing
from reduced_models.bearing.features import BallDiameter as BallDiameter
from reduced_models.bearing.features import BallWaviness as BallWaviness
from reduced_models.bearing.features import Indentation as Indentation
from reduced_models.bearing.features import RaceWaviness as RaceWaviness
from reduced_models.bearing.features import Spall as Spall
from reduced_models.bearing.motion import BearingMotion as BearingMotion
from reduced_models.bearing.oil_balance import OilBalance as OilBalance
from reduced_models.bearing.operating_clearance import operating_clearance as operating_clearance
from reduced_models.bearing.rated_geometry import geometry_from_ratings as geometry_from_ratings
from reduced_models.elements.film_contact import FilmContact as FilmContact
from reduced_models.elements.spring import SpringContact as SpringContact
from reduced_models.elements.validity import OutsideValidityWarning as OutsideValidityWarning
from reduced_models.fitting.fit import fit as fit
from reduced_models.fitting.memory_fit import fit_memory as fit_memory
from reduced_models.fitting.records import ContactRecord as ContactRecord
from reduced_models.life.system_life import life_of_spectrum as life_of_spectrum
from reduced_models.margins.sampling import uncertainty as uncertainty
from reduced_models.margins.spread import spread as spread
from reduced_models.periodic_motion.excitation import PeriodicForce as PeriodicForce
from reduced_models.periodic_motion.periodic import periodic as periodic
from reduced_models.periodic_motion.periodic import periodic_answer as periodic_answer
from reduced_models.periodic_motion.shooting import shoot as shoot
from reduced_models.rotor.assembly import rotor_on_bearings as rotor_on_bearings
from reduced_models.rotor.bearing_matrices import bearing_matrices as bearing_matrices
from reduced_models.rotor.bearing_set import BearingSet as BearingSet
from reduced_models.rotor.campbell import campbell as campbell
from reduced_models.rotor.compare import compare as compare
from reduced_models.rotor.control import rotor_to_control as rotor_to_control
from reduced_models.rotor.jeffcott import jeffcott_rotor as jeffcott_rotor
from reduced_models.rotor.linear_bearing import LinearBearing as LinearBearing
from reduced_models.rotor.linearise import linearise as linearise
from reduced_models.rotor.machine_state import machine_state as machine_state
from reduced_models.rotor.oscillator import simulate_oscillator as simulate_oscillator
from reduced_models.rotor.parts import Disc as Disc
from reduced_models.rotor.parts import Shaft as Shaft
from reduced_models.rotor.parts import Support as Support
from reduced_models.rotor.ross_rotor import from_ross as from_ross
from reduced_models.rotor.rotor import Rotor as Rotor
from reduced_models.rotor.rotor import Unbalance as Unbalance
from reduced_models.rotor.simulate import simulate_rotor as simulate_rotor
from reduced_models.rotor.speed_profile import SpeedProfile as SpeedProfile
from reduced_models.rotor.squeeze_film_damper import SqueezeFilmDamper as SqueezeFilmDamper
from reduced_models.rotor.supports import BearingMount as BearingMount
from reduced_models.rotor.supports import ContactMount as ContactMount
from reduced_models.rotor.unbalance import grade_unbalance as grade_unbalance
from reduced_models.rotor.unbalance import unbalance_response as unbalance_response


def __dir__() -> list[str]:
    """Public names, without the modules that they are in."""
    return sorted(name for name, value in globals().items() if name[0] != "_" and not _ismodule(value))
