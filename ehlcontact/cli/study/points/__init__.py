"""Studies of one point or of several: points, tasks, what is computed already, results over all points.

============== ======================================================================================
module         responsibility
============== ======================================================================================
``lists``      points of a study file, each a study of its own with a folder of its own
``origin``     study files in the folder: whose results these are, and what changed since
``finalise``   elements, FMUs, rotors, results and report from the stages of a point
``kept``       what is computed, in one store by content
``folder``     of a run: its lock, and ``run.log``
``numbers``    numbers of a point: units, meanings, columns and panels
``picture``    films, stiffness, damping and decay over the points
``summary``    ``summary.json`` and ``summary.csv``: numbers of all points, with units and files; a page over them
============== ======================================================================================
"""
