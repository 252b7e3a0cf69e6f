"""A rotor and its supports, each an FMU, as one archive.

Of System Structure and Parameterization (SSP) 1.0:

===============  ===================================================================================
module           responsibility
===============  ===================================================================================
``structure``    components and wires to ``SystemStructure.ssd``
``export``       `export_system`: rotor in, archive out
``part``         `Part`: a component, its FMU and its wires to the rotor
``on_contacts``  a Jeffcott rotor and its contacts as parts; default step
``on_bearings``  a rotor and its ball bearings as parts; default step; check against `simulate_rotor`
``check``        `verify_system`: the schema, and a load step against `simulate_rotor`
``master``       a master for such archives, through fmpy
===============  ===================================================================================
"""
