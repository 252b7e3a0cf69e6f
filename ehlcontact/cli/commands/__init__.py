"""Subcommands: each reads its options, calls the library, prints a table, and writes what was asked for.

=============  ==================================================================
module         what it does
=============  ==================================================================
``steady``     the film under constant load
``simulate``   a motion drives the transient contact
``impedance``  stiffness and damping over frequency
``fit``        simulated histories to a contact element
``element``    a contact element from the atlas, without a solve
``export``     an element file to an FMU
``init``       a commented study file to begin with
``verify``     an FMU against the reference results inside it
``validate``   what a study will do, and its cost, without doing it
``run``        a study file to elements, FMU, rotor comparison and report
``reproduce``  the paper's tables and figures, ours beside them
``bearing``    a ball bearing: loads, films, stiffness and damping over speed
``explore``    a page that answers for ball bearings in a browser
``atlas``      building the atlas
=============  ==================================================================

What a subcommand needs of the library is imported when it runs, so that ``--help`` comes at once.
"""
