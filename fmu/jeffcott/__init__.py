"""A Jeffcott rotor as an FMU, either with contact forces as inputs or with the contacts inside.

===================  ==========================================================================================
module               responsibility
===================  ==========================================================================================
``model``            `JeffcottModel`: what is exported, checked; where it starts
``variables``        its variables, constants and C text
``laws``             each contact law inside as one C file with names of its own
``reference_rotor``  the same in Python: a short run by the steps of `simulate_rotor`, its equations in a state
``comparison``       comparison of the FMU with the rotor in Python
``references``       reference inputs and results stored in the FMU
===================  ==========================================================================================
"""
