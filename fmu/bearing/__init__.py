"""Ball bearings as an FMU: force and moment on the inner ring, or the shaft of a set, under a given motion of it.

=======================  ========================================================================================
module                   responsibility
=======================  ========================================================================================
``model``                `BearingModel`: bearing, speeds, degrees of freedom; where the ring starts
``set_model``            `SetModel`: a set on a rigid shaft without mass
``tables``               C text of its tables: races, films over load, losses, speeds; where each bearing is
``capacitance_table``    capacitance of a contact as a polynomial of load, film and contact angle, and its C text
``variables``            its variables, constants and sources
``set_variables``        those of a set: of each bearing under its label, and forces on the shaft
``places``               from where places of balls at contact angles are counted, and their damping across
``continuous``           states of the bearing, and their rates in Python
``trial``                a run of the ring with lift-off, and its forces in Python
``references``           that run and states in model exchange, as references of the FMU
=======================  ========================================================================================
"""
