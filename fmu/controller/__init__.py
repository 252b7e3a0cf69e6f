"""A speed controller as an FMU: speed of a shaft and its set point in, torque of the motor out.

==============  ========================================================================================
module          responsibility
==============  ========================================================================================
``model``       `SpeedController`: its gains and limit, its torque over time, variables of its FMU
``comparison``  comparison of the FMU with the torque in Python; references stored in the FMU
``export``      `export_controller`: controller in, FMU file out
==============  ========================================================================================
"""
