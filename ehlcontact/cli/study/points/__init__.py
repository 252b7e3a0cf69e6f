"""A study of one point or of several: what its lists stand for, what is finished of each, and all points together.

============  ======================================================================================
module        responsibility
============  ======================================================================================
``lists``     the points of a study file, each a study of its own with a folder of its own
``ledger``    what is finished: notes by content, and files that are what they were
``board``     what is to do for all points, how far it is, and what is noted of it
``closing``   what is made of a point's stages: elements, FMUs, rotors, results and report
``alone``     one run at a time in a folder
``cluster``   stages solved by a Dask cluster
``journal``   ``run.log``
``summary``   ``summary.json`` and ``summary.csv``: every point in numbers, with units and files
``page``      the report over several points
============  ======================================================================================
"""
