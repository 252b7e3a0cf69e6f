"""Transient film: motions, surface features, time integration, records and results.

================ ==========================================================================================
module           responsibility
================ ==========================================================================================
``bodies``       `Motion`, and bodies under a load, by Newmark's rule
``motion``       free vibration, harmonic load, ramp
``prescribed``   loads and approaches given by a table
``speed``        `SpeedHistory`: speed of the surfaces over time
``features``     surface features: `Dent`, `TransverseRidge`, `Waviness`
``roughness``    `Roughness`: rough surfaces, synthetic or measured
``heat_over_time`` temperatures of the film in time, and what oil and surfaces store
``effects_over_time`` effects of conditions over time, each with a state between steps
``carried_oil``  `CarriedOil`: oil on the surfaces beyond both ends of the region
``transient_film`` `TransientFilm`: one implicit step of the film
``record``       record of a run: an entry per step, whole fields at given times
``time_step``    length of a time step: default, error control; and how closely a step is solved
``settings``     groups of arguments of `simulate`, and the checked inputs of a run
``run``          film and motion advanced together, in fixed or in controlled steps
``checkpoint``   checkpoint file for a restart
``result``       `SimulationResult` and its `Instants`
``simulate``     `simulate`: from a motion to a result
``transient_contact`` `TransientContact`: the whole film as a force element
================ ==========================================================================================

Each module imports only those above it. The public names are those of `ehlcontact`.
"""
