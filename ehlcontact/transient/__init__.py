"""One film through time.

================ ==========================================================================================
module           responsibility
================ ==========================================================================================
``bodies``       what a motion is: `Motion`, and bodies under a load, by Newmark's rule
``motion``       free vibration, harmonic load, ramp
``prescribed``   loads and approaches given by a table
``surface``      what travels through: `Dent`, `TransverseRidge`, `Waviness`
``roughness``    `Roughness`: likewise, made or measured
``film``         `TransientFilm`: one implicit step of the film
``record``       record of a run: an entry per step, whole fields at given times
``time_step``    length of a time step: default, error control; and how closely a step is solved
``settings``     what a run is asked for, checked and with its defaults
``run``          film and motion advanced together, in fixed or in controlled steps
``checkpoint``   a run's file to go on from
``result``       `SimulationResult` and its `Instants`
``simulate``     `simulate`: all of these, from a motion to a result
``full_contact`` `FullContact`: the whole film as a force element
================ ==========================================================================================

From top to bottom each imports only what stands above it. What users need of it is public in `ehlcontact`.
"""
