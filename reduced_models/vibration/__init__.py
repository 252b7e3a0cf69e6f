"""Linear answers of rotors on ball bearings, film memory included.

| room | is responsible for |
|---|---|
| balls | impedance of a bearing at complex frequencies, at one angle of the cage or mean over a ball passage |
| linearised | `linearise`: a rotor about rest at a speed; responses at a frequency, stability |
| mode | `WhirlMode`: damped vibrations, exact with the memory |
| campbell | `campbell`: modes over the speed, critical speeds |
| unbalance | `unbalance_response`: amplitudes over the speed |
| states | the same rotor as matrices of first order, films as states |
| rates | compiled: balls and films in continuous time |
| block | python-control: `rotor_to_control`, and the state space of a `LinearisedRotor` |
"""
