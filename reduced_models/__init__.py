"""Contact elements reduced from transient EHL, and rotors that run on them.

| module | is responsible for |
|---|---|
| records | histories of approach, rate and force, simulated or measured |
| least_squares | linear least squares by QR, singular columns by name |
| fit | records to element: quality, validity, root and tangent |
| law | the force law of the viscous elements and its extension, as compiled kernels |
| element | `LinearContact`, `CubicContact`, `load_element`, python-control export |
| element_file | the JSON file of an element |
| contact | the protocol every contact obeys; `ScaledContact` shows a dimensionless one in SI |
| oscillator | one mass on one element |
| jeffcott | rotor parameters, contact mounts, linear matrices |
| equilibrium | static equilibrium on contacts without memory |
| time_integration | generalised-alpha step condensed onto the journal |
| contact_forces | forces and slopes of all contacts in a step |
| rotor_simulation | the transient run: checks, Ctrl-C, failure |
| rotor_stepper | one step after the other, with the history so far |
| rotor_result | histories and status of a run |
| compare | full against reduced response |

Symbols and units: `ehlcontact.scaling`.
"""

from reduced_models.compare import Comparison as Comparison
from reduced_models.compare import SignalDifference as SignalDifference
from reduced_models.compare import compare as compare
from reduced_models.contact import Contact as Contact
from reduced_models.contact import ScaledContact as ScaledContact
from reduced_models.contact import TangentContact as TangentContact
from reduced_models.contact import has_tangents as has_tangents
from reduced_models.element import CubicContact as CubicContact
from reduced_models.element import LinearContact as LinearContact
from reduced_models.element import load_element as load_element
from reduced_models.fit import FitResult as FitResult
from reduced_models.fit import fit as fit
from reduced_models.jeffcott import ContactMount as ContactMount
from reduced_models.jeffcott import JeffcottRotor as JeffcottRotor
from reduced_models.jeffcott import RotorState as RotorState
from reduced_models.oscillator import OscillatorResult as OscillatorResult
from reduced_models.oscillator import simulate_oscillator as simulate_oscillator
from reduced_models.records import ContactRecord as ContactRecord
from reduced_models.rotor_result import RotorResult as RotorResult
from reduced_models.rotor_result import RotorStatus as RotorStatus
from reduced_models.rotor_simulation import simulate_rotor as simulate_rotor
