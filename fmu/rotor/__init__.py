"""A rotor with its ball bearings as one FMU: forces at its nodes, unbalances and speed in, motions and loads out.

===================  ==========================================================================================
module               responsibility
===================  ==========================================================================================
``model``            `RotorModel`: a `Rotor` on ball bearings, the speeds of the tables, where it starts
``variables``        its variables, constants and tables, and the bearings inside
``trial``            a run by the steps of `simulate_rotor`, with inputs as the FMU has them
``comparison``       comparison of the FMU with that; references stored in the FMU
===================  ==========================================================================================
"""
