"""Studies of one point or of several: points, tasks, what is computed already, results over all points.

============== ======================================================================================
module         responsibility
============== ======================================================================================
``lists``      points of a study file, each a study of its own with a folder of its own
``scheduler``  tasks of all points: what is to do, what runs, what is done
``tasks``      what a worker does: solve a stage, finalise a point
``finalise``   elements, FMUs, rotors, results and report from the stages of a point
``kept``       what is computed, in one store by content
``lock``       one run at a time in a folder
``log``        ``run.log``
``numbers``    numbers of a point: units, meanings, columns and panels
``summary``    ``summary.json`` and ``summary.csv``: every point in numbers, with units and files
``page``       report over several points
============== ======================================================================================
"""
