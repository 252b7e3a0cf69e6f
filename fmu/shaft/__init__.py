"""A shaft as an FMU: forces of its bearings and the torque of its motor in, motions at the bearings out.

===================  ==========================================================================================
module               responsibility
===================  ==========================================================================================
``model``            `ShaftModel`: a `Rotor` whose ball bearings are outside; its modes, where it starts
``variables``        its variables, constants and tables
``reference_shaft``  the step of the FMU in Python, by matrix exponentials
``comparison``       comparison of the FMU with that; references stored in the FMU
===================  ==========================================================================================
"""
