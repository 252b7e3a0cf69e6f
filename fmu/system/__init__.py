"""A rotor and its supports, each an FMU, as one archive.

Of System Structure and Parameterization (SSP) 1.0:

===============  ===================================================================================
module           responsibility
===============  ===================================================================================
``structure``    components and wires to ``SystemStructure.ssd``
``export``       `export_system`: rotor in, archive out
``parts``        `RotorSystem`: a rotor and its supports as parts; default step; check against `simulate_rotor`
``check``        result of the check, and the schema of the standard
``master``       a master for such archives, through fmpy
===============  ===================================================================================
"""
