"""Rotors on contacts, full films and bearings, in SI; and a single mass on one element, in its units.

| module | is responsible for |
|---|---|
| rotor | `Rotor`: matrices, supports, loads; `Unbalance`, `Parameter` |
| supports | `ContactMount`, `BearingMount`: what a rotor stands on |
| linear_bearing | `LinearBearing`: a bearing as stiffness and damping |
| squeeze_film_damper | `SqueezeFilmDamper`: a journal in a film of oil, and its spring |
| contact_protocol | what a contact of a rotor has: a step and a state; tangents besides |
| jeffcott | `jeffcott_rotor`: such a rotor by its parameters |
| parts | `Shaft`, `Disc`, `Support`: what a rotor on bearings is made of |
| beam | rotating shaft element: its matrices |
| bearing_matrices | `bearing_matrices`: stiffness and damping about any point, for other programs |
| capacitance_run | capacitance of a ball bearing over a run of its rotor |
| matrix_text | these as input of other programs, with frame, units and signs |
| bearing_set | `BearingSet`: pairs and other sets of ball bearings on one rigid shaft, their preload and growth |
| assembly | `rotor_on_bearings`: such a rotor by its parts |
| nodes | degrees of freedom by node and direction |
| equilibrium | static equilibrium of a rotor on its supports |
| speed_profile | `SpeedProfile`: the speed of a shaft over time, and the forces that turn with it |
| core_rotor | `CoreRotor`: a rotor as the C core has it, its steps condensed onto its supports |
| contact_steps | forces and tangent stiffness of all contacts in a step |
| prepared_run | a rotor, its supports and their start as the arrays of a run |
| integrate_compiled | steps of a rotor on ball bearings and dampers, in C |
| integrate_python | Newton loop of the same steps in Python, for other supports |
| simulate | `simulate_rotor`: a rotor over time, from the rotor by arrays and steps to the result |
| result | `RotorResult`: histories of a run |
| linear_contact | a contact about static equilibrium: an element as a state space, any other by its impedance |
| linear_system | a rotor on linear supports as one system of first order; modes on elements |
| linearise | `linearise`: a rotor about static equilibrium at a speed, `LinearRotor` |
| modes | `RotorMode`: damped vibrations, exact with film memory |
| loss_parts | parts of a linear rotor that take energy: what each takes, the rotor without it |
| part_shares | amounts by these parts as shares, in words and as a picture |
| damping_budget | `DampingBudget`: who damps what, damping ratios of modes by these parts |
| campbell | `campbell`: modes over the speed, critical speeds |
| support_state | `support_state`: a bearing or a set under its load, in the numbers of a designer |
| machine_state | `machine_state`: such a rotor at a speed: supports, modes, critical speeds, limits of the data |
| machine_numbers | it in single numbers, as tables and samples have it |
| machine_tiles | its answer in a few numbers |
| unbalance | `unbalance_response`: amplitudes under the unbalances over shaft speed |
| unbalance_result | `UnbalanceResponse`: its result |
| control | python-control: `rotor_to_control`, and the state space of a `LinearRotor` |
| ross_rotor | import from ROSS: `from_ross`; bearings as its force callback: `RossCallback` |
| picture | pictures of runs, Campbell diagrams, unbalance responses and damping budgets |
| model_pictures | pictures of one rotor on several models of its contacts or bearings |
| oscillator | `simulate_oscillator`: one mass on one element |
| compare | `compare`: full against reduced response |
| baselines | contacts without a film: dry, undamped, and linearised at one load |
| decay | `log_decrement`: of a free decay, by a fit |
| free_decay | a rotor after an initial velocity in the shape of a mode |
| resonance | responses of several linear rotors to unbalance, and their highest points |
| full_films | a rotor with the whole film in every contact, from near its settled motion on |
| bearing_films | `simulate_full_films`: chosen contacts of ball bearings as full films, the others elements |
| film_process | such films in this process or in others |
| compare_bearing_models | one rotor on several models of its ball bearings |
| settling | whether a run has reached steady state; runs that go on until it has |
| events | `contact_events`: lift-off, impacts, load range, time outside validity |
"""
