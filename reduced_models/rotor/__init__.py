"""Rotors on contacts, full films and ball bearings, in SI; and a single mass on one element, in its units.

| module | is responsible for |
|---|---|
| rotor | `Rotor`: any linear rotor on bearings, by its matrices |
| parts | `Shaft`, `Disc`, `Support`: what such a rotor is made of |
| beam | matrices of a piece of shaft |
| assembly | `rotor_on_bearings`: all of it as one `Rotor` |
| speed_profile | `SpeedProfile`: the speed of a shaft over time, and the forces that turn with it |
| integrate | compiled: generalised-alpha steps of rotor, bearings and balls |
| run | `simulate_on_bearings`: such a rotor over time, speed constant or not |
| linearise | `linearise`: a rotor about rest at a speed |
| modes | its damped vibrations, exact with film memory |
| campbell | `campbell`: modes over the speed, critical speeds |
| unbalance | `unbalance_response`: amplitudes over the speed |
| picture | figures: orbits, spectra, waterfalls, Campbell diagram, unbalance response |
| control | python-control: `rotor_to_control`, and the state space of a linearised rotor |
| ross | rotors of ROSS on our bearings: `from_ross`, `RossCallback` |
| contact | the protocol every contact obeys; `ScaledContact` shows a dimensionless one in SI; all as one force |
| jeffcott | `JeffcottRotor`: parameters, mounts, linear matrices, states at rest |
| equilibrium | contacts with a static law as springs on a journal |
| step | one generalised-alpha step after the other, condensed onto the journal |
| simulate | `simulate_rotor`: checks, Ctrl-C, failure; `RotorResult` |
| oscillator | `simulate_oscillator`: one mass on one element |
| compare | `compare`: full against reduced response |
| baselines | contacts without a film: dry, undamped, and linearised at one load |
| linear | `LinearRotor`: modes and unbalance response with an impedance in every contact |
| decay | `log_decrement`: of a free decay, by a fit |
| settled | `settling`: whether a response has settled; runs that go on until it has |
| events | `contact_events`: lift-off, impacts, load range, time outside validity |
"""
