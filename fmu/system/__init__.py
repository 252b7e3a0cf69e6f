"""A rotor and its contacts, or a shaft and its bearings, as one archive.

Of System Structure and Parameterization (SSP) 1.0:

=============  =====================================================================================
module         responsibility
=============  =====================================================================================
``structure``  components and wires to ``SystemStructure.ssd``
``export``     `export_system`: rotor and contacts in, archive out
``drive``      `export_drive`: a shaft, its bearings and the torque of its motor
``check``      `verify_system`: the schema, and a load step against `simulate_rotor`
``master``     a master for such archives, through fmpy
=============  =====================================================================================
"""
