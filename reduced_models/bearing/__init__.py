"""Ball bearings made of EHL contacts: a film with its memory under every ball, on both races.

| room | is responsible for |
|---|---|
| ball_bearing | `BallBearing`: dimensions, checks, and what can be asked of it |
| catalogue | dimensions by name, with their sources |
| kinematics | cage, balls and defect frequencies |
| race | one contact and its law at a speed; the one place that asks the atlas |
| law | compiled: static curve of a race, tabulated over approach and speed, and its gains |
| contact | compiled: one contact over a step, its filters once, its force as often as asked |
| balls | compiled: all balls, two contacts in series on each, as one force with tangents |
| loss | loss factor of rings and fits: filters of the force, in time and over frequency |
| statics | where the ring stands under a load |
| linear | stiffness and damping over frequency |
| motion | a bearing in the time domain: steps, tangents, prescribed motion |
| rotor | `MatrixRotor`: any linear rotor on bearings, at rest |
| course | `SpeedCourse`: the speed of a shaft over time, and the forces that turn with it |
| loop | compiled: generalised-alpha steps of rotor, bearings and balls |
| run | `simulate_on_bearings`: such a rotor over time, speed constant or not |
| state | `BearingState`: a bearing at rest, ball by ball; its file |
| ross | bearings in rotors of ROSS, and its rotors on bearings: `from_ross`, `RossCallback` |
| picture | figures |
| summary | summary of a bearing for the prompt |
| file | JSON of bearings and states |
"""
