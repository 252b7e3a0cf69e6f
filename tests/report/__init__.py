"""A report computed a second time.

================== ================================================================================================
room               responsibility
================== ================================================================================================
``page``           text of a page, and the numbers in it that nobody has claimed
``contact``        operating point, fits, work and memory from the study and the stored histories, with numpy
``rotor``          runs, decays, events and linear model of the rotor, likewise
``contact_claims`` which number of the page is which of ``contact``
``rotor_claims``   which is which of ``rotor``
``whole``          the rotor on whole bearings, likewise
``whole_claims``   which is which of ``whole``
================== ================================================================================================
"""
