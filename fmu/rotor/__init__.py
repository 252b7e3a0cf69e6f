"""A Jeffcott rotor as an FMU: alone, its contacts outside, or closed with them.

===================  ==========================================================================================
module               responsibility
===================  ==========================================================================================
``model``            `RotorModel`: what is exported, checked; where it starts
``variables``        its variables, constants and C text
``laws``             each contact law inside as one C file with names of its own
``export``           `export_rotor`: rotor in, FMU file out
``reference_rotor``  the rotor in Python: a short run by the steps of `simulate_rotor`, its equations in a state
``comparison``       the FMU beside that
``references``       that inside the FMU
===================  ==========================================================================================
"""
