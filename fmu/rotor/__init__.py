"""A rotor as an FMU: supports inside it, or outside, their forces being inputs then.

==============  ==============================================================================================
module          responsibility
==============  ==============================================================================================
``model``       `RotorModel`: a rotor, its supports inside and outside, where it starts
``parameters``  parameters of its matrices
``variables``   its variables and specification
``tables``      constants and C tables
``dampers``     squeeze film dampers inside
``laws``        supports inside, a C file for each that differs
``trial``       a run by the steps of `simulate_rotor`, with inputs as the FMU has them
``references``  that run and states along it, as references of the FMU
==============  ==============================================================================================
"""
