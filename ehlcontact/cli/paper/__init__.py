"""``ehlcontact reproduce``: the tables and figures of Nonato and Cavalca (2010), ours beside theirs.

===============  =====================================================================================
module           responsibility
===============  =====================================================================================
``data``         what the paper printed: numbers of its tables, from the two CSV files here
``cases``        its simulations: point, motion, domain
``runs``         the simulations, each kept in one file, so that an interrupted run resumes
``fits``         records and elements of the cases, and reduced models integrated over them
``tables``       Tables 1 to 6
``film_figures``     Figures 2, 4, 6, 7, 12: the film
``response_figures`` Figures 5, 8 to 11, 13 to 15, 17 to 19: histories of full and reduced contact
``spring_figure``    Figure 16: polynomials outside the fitted interval
``figures``      what each figure needs, shows and says
``page``         one HTML page and one JSON document
===============  =====================================================================================

Figures 1 (a sketch) and 3 (a measurement) hold no result of the paper.
"""
