"""Contact elements reduced from transient EHL, and rotors that run on them.

| module | is responsible for |
|---|---|
| records | histories of approach, rate and force, simulated or measured |
| least_squares | linear least squares by QR, singular columns by name |
| power_fit | variable projection for the power law |
| estimators | the models that `fit` knows |
| uncertainty | intervals of coefficients where residuals hang together |
| fit, fit_result | records to element: quality, validity, root and tangent |
| sensitivity | which terms of the seven-term polynomial the records need |
| element | the kinds of element, `load_element` |
| element_base | what every element carries: validity box, quality, source, units, file |
| element_file | the JSON file of an element |
| validity | the warning for leaving the box |
| memoryless | elements without memory: forces, tangents, python-control export |
| ends | how springs and dampers go on outside the box |
| viscous, viscous_law | `LinearContact`, `CubicContact`, and their law as compiled kernels |
| polynomial, polynomial_law | `PolynomialContact`, likewise |
| power, power_law | `PowerLawContact`, likewise |
| film_law, film_curve, film_filters | a dry spring on a film that remembers: kernels, statics, impedance |
| film_ode | the film law in continuous time |
| film_contact | what the elements with a film memory have in common |
| memory, memory_target, memory_fit | `FilmMemoryContact`, and its joint fit to impedance and records |
| wide, wide_build | `WideRangeContact`, and its building from solves |
| atlas | `Atlas`: answers with error bars and elements, from contacts solved beforehand; its build |
| contact | the protocol every contact obeys; `ScaledContact` shows a dimensionless one in SI |
| oscillator | one mass on one element |
| jeffcott | rotor parameters, contact mounts, linear matrices |
| equilibrium | static equilibrium on contacts that know their statics |
| time_integration | generalised-alpha step condensed onto the journal |
| contact_forces | forces and slopes of all contacts in a step |
| rotor_simulation | the transient run: checks, Ctrl-C, failure |
| rotor_stepper | one step after the other, with the history so far |
| rotor_result | histories and status of a run |
| compare | full against reduced response |

Symbols and units: `ehlcontact.point`.
"""

from reduced_models.atlas.atlas import Atlas as Atlas
from reduced_models.atlas.atlas import AtlasAnswer as AtlasAnswer
from reduced_models.elements.kinds import ContactElement as ContactElement
from reduced_models.elements.kinds import CubicContact as CubicContact
from reduced_models.elements.kinds import FilmMemoryContact as FilmMemoryContact
from reduced_models.elements.kinds import LinearContact as LinearContact
from reduced_models.elements.kinds import PolynomialContact as PolynomialContact
from reduced_models.elements.kinds import PowerLawContact as PowerLawContact
from reduced_models.elements.kinds import WideRangeContact as WideRangeContact
from reduced_models.elements.kinds import load_element as load_element
from reduced_models.elements.validity import OutsideValidityWarning as OutsideValidityWarning
from reduced_models.fitting.fit import FitResult as FitResult
from reduced_models.fitting.fit import fit as fit
from reduced_models.fitting.memory import MemoryFit as MemoryFit
from reduced_models.fitting.memory import fit_memory as fit_memory
from reduced_models.fitting.records import ContactRecord as ContactRecord
from reduced_models.fitting.result import ElementFit as ElementFit
from reduced_models.fitting.sensitivity import Sensitivity as Sensitivity
from reduced_models.fitting.sensitivity import SensitivityRow as SensitivityRow
from reduced_models.fitting.sensitivity import sensitivity as sensitivity
from reduced_models.fitting.wide import wide_range_contact as wide_range_contact
from reduced_models.fitting.wide import wide_range_from_solves as wide_range_from_solves
from reduced_models.rotor.compare import Comparison as Comparison
from reduced_models.rotor.compare import SignalDifference as SignalDifference
from reduced_models.rotor.compare import compare as compare
from reduced_models.rotor.contact import Contact as Contact
from reduced_models.rotor.contact import ScaledContact as ScaledContact
from reduced_models.rotor.contact import TangentContact as TangentContact
from reduced_models.rotor.contact import has_tangents as has_tangents
from reduced_models.rotor.jeffcott import ContactMount as ContactMount
from reduced_models.rotor.jeffcott import JeffcottRotor as JeffcottRotor
from reduced_models.rotor.jeffcott import RotorState as RotorState
from reduced_models.rotor.oscillator import OscillatorResult as OscillatorResult
from reduced_models.rotor.oscillator import simulate_oscillator as simulate_oscillator
from reduced_models.rotor.result import RotorResult as RotorResult
from reduced_models.rotor.result import RotorStatus as RotorStatus
from reduced_models.rotor.simulate import simulate_rotor as simulate_rotor
