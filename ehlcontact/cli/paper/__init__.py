"""``ehlcontact reproduce``: the tables and figures of Nonato and Cavalca (2010), ours beside theirs.

============  ========================================================================================
module        responsibility
============  ========================================================================================
``data``      what the paper printed: numbers of its tables and text, from the CSV files here
``runs``      its simulations, each kept in one file, so that an interrupted run resumes
``fits``      records and elements of the cases, and reduced models integrated over them
``tables``    Tables 1 to 6
``pictures``  what the figures show
``figures``   what each figure needs, shows and says, and the numbers beside it
``page``      one HTML page and one JSON document
============  ========================================================================================

Figures 1 (a sketch) and 3 (a measurement) hold no result of the paper.
"""
