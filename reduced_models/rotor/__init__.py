"""A rotor on contacts, full films or elements, in SI; a single mass on one element, in its units.

| module | is responsible for |
|---|---|
| contact | the protocol every contact obeys; `ScaledContact` shows a dimensionless one in SI; all as one force |
| jeffcott | `JeffcottRotor`: parameters, mounts, linear matrices, states at rest |
| equilibrium | where contacts that know their statics carry a load |
| step | one generalised-alpha step after the other, condensed onto the journal |
| simulate | `simulate_rotor`: checks, Ctrl-C, failure; `RotorResult` |
| oscillator | `simulate_oscillator`: one mass on one element |
| compare | `compare`: full against reduced response |
| baselines | what there is without an element: dry, undamped, and linearised at one load |
| linear | `LinearRotor`: modes and unbalance response with an impedance in every contact |
| decay | `log_decrement`: of a free decay, by a fit |
| settled | `settling`: whether a response has settled; runs that go on until it has |
| events | `contact_events`: lift-off, impacts, load range, time outside validity |
"""
