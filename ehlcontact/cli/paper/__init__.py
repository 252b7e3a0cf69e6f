"""``ehlcontact reproduce``: the tables and figures of Nonato and Cavalca (2010), ours beside theirs.

============  ========================================================================================
module        responsibility
============  ========================================================================================
``data``      what the paper printed: numbers of its tables and text, from the CSV files here
``runs``      its simulations, each kept in one file, so that an interrupted run resumes
``fits``      records and elements of the cases, and reduced models integrated over them
``order``     whether grids show the order in the mesh, and the limit that follows
``table``     what a table is, and which simulations each takes
``linear``    Tables 1 and 4
``removal``   Table 2
``cubic``     Tables 3, 5 and 6
``tables``    any of them by its number
``pictures``  its figures, made with plotly
``numbers``   what stands in numbers beside them
``figures``   what each figure needs, shows and says
``page``      one HTML page and one JSON document
============  ========================================================================================

Figures 1 (a sketch) and 3 (a measurement) hold no result of the paper.
"""
