"""The study behind ``ehlcontact run``: a bearing and its oil in, elements, FMU, rotor and report out.

=============  =====================================================================================
module         responsibility
=============  =====================================================================================
``schema``     the study file: what may stand in it, and errors in one line
``slips``      those errors, and guesses at what was meant
``forecast``   what a study will do, and its cost, without doing it
``stages``     the long computations, each a function of the study that leaves one file
``worker``     one stage in its own process
``runner``     stages side by side, with progress, resume and Ctrl-C
``reduction``  fits, element files, FMU
``rotor``      the rotor on full contacts and on elements: runs, their file, differences
``results``    everything in numbers: ``results.json``
``report``     ``report.html``
=============  =====================================================================================
"""
