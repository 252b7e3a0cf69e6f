"""A rotor and its contacts as one archive of System Structure and Parameterization (SSP 1.0).

=============  =====================================================================================
module         responsibility
=============  =====================================================================================
``structure``  components and wires to ``SystemStructure.ssd``
``export``     `export_system`: rotor and contacts in, archive out
``check``      nothing unverified is written: the schema, and a load step beside `simulate_rotor`
``master``     the plainest master for such archives, through fmpy
=============  =====================================================================================
"""
