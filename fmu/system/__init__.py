"""A rotor and its contacts as one archive of System Structure and Parameterization (SSP 1.0).

=============  =====================================================================================
module         responsibility
=============  =====================================================================================
``structure``  components and wires to ``SystemStructure.ssd``
``export``     `export_system`: rotor and contacts in, archive out
``check``      `verify_system`: the schema, and a load step against `simulate_rotor`
``master``     a master for such archives, through fmpy
=============  =====================================================================================
"""
