"""Ball bearings made of EHL contacts: a film with its memory under every ball, on both races.

| module | is responsible for |
|---|---|
| ball_bearing | `BallBearing`: inputs, and what can be asked of it |
| grooves | checks of dimensions; grooves, balls and race control for the C core |
| bearing_conditions | oil, supply and heat: which go together; speeds of films |
| bearing_tables | `BearingTables`: races, elements, tables and heights, made once |
| catalogue | dimensions by name, with their sources |
| printed_ratings | load ratings C and C0 of the catalogue's bearings, as NSK prints them |
| ball_sets | balls that fit load ratings: the search of `geometry_from_ratings` |
| rated_geometry | `geometry_from_ratings`: balls estimated from printed load ratings, with intervals |
| designation | names as makers print them: maker, suffixes, other kinds of bearings |
| clearance | radial clearance by class and bore |
| tolerances | classes of seats, tolerances of rings, outside diameters by series |
| seats | rings on shafts and in housings: pressed, warm, turning; materials |
| operating_clearance | `operating_clearance`: clearance on its seats, warm and turning |
| freedoms | degrees of freedom of the ring: names, units, loads |
| core_bearing | `CoreBearing`: a bearing as the C core has it, views of its state |
| contact_angles | `Grooves`; the law of contact angles, rolling and race control, which the C core has |
| ball | `Balls`: tables, grooves and inertia of a bearing; the law of a ball, which the C core has |
| internals | a bearing as the standards of rating life need it |
| ring | the inner ring on its balls in static equilibrium: `StaticRing`, `ring_equilibrium` |
| ring_statics | loads that a bearing takes, its ring in equilibrium, the state for users |
| shoulders | shoulders of the grooves, and contact ellipses that reach over them |
| kinematics | cage, balls and defect frequencies |
| measured_order | contact angle and clearance from a measured defect order |
| race | one contact: geometry, oil, element at a speed; the only module that imports the atlas |
| race_table | load over deflection of a race and its memory gains, tabulated over approach and speed |
| loss | loss factor of rings and fits: filters of the force, in time and over frequency |
| equilibrium | springs under a load |
| linear_balls | all balls about static equilibrium: impedance at complex frequencies |
| coefficients | `BearingCoefficients`: response over frequency, stiffness and damping |
| solved_balls | small motion with the impedance of solved contacts, under an oil supply |
| features | inputs: waviness and defects of races and balls, balls of another diameter |
| height_tables | heights of features, filtered by the contact, as tables over the angle and the load |
| elastic_heights | heights of spalls and dents, from elastic contacts over them |
| film_heights | these tables filtered by the film, for runs of bearings in oil |
| contact_heights | heights of contacts, looked up in these tables by the C core |
| track_surface | `TrackSurface`: features that pass a contact, as the surface of a full film |
| excitation | forces of features on a fixed ring, as spectral lines over orders of the shaft |
| ball_states | balls and films about static equilibrium as matrices of first order |
| linear_reduction | a linear bearing with few states: balanced residualisation, with the bound of its error |
| continuous_time | `BearingRates`: derivatives of the states of balls and films, by the C core |
| motion | a bearing in the time domain: steps, tangents, prescribed motion |
| equilibrium_result | `BearingState`: a bearing in static equilibrium, ball by ball |
| set_result | `SetState`: a `BearingSet` in static equilibrium, bearing by bearing |
| oil_balance | `OilBalance`: oil on the tracks over time: layer, side flow, feed and replenishment |
| fed_layer | `FedLayer`: the layer that a feed keeps; what a contact takes off a layer |
| oil_feedback | layers that follow the passes of the balls before, in K and C of a bearing with a held feed |
| ross_bearing | export to ROSS: bearings as elements of a ROSS rotor |
| capacitance | `BearingCapacitance`: films as capacitors, voltage across them, films from a measurement |
| sliding | `bearing_friction`: sliding moment of the contacts by a traction law |
| table_bars | error bars of films, K and C under these conditions, from the tables of the atlas |
| oil_and_heat | a bearing with heat and with a layer of oil, beside flooded isothermal films |
| cage_slip | slip of the cage under a drag |
| skf_friction | moment of friction by SKF's published model |
| picture | load zones, films, contact angles, stiffness and damping as pictures |
"""
