"""Figures of the pages: pictures of `ehlcontact.results.picture` drawn with plotly.

===========  ======================================================================================
module       shows, or does
===========  ======================================================================================
``render``   a picture as a `plotly.graph_objects.Figure`
``style``    fonts, axes, grids
``thinned``  fewer points and digits than the results have, and how many fewer
``finish``   legend, words under the pointer and places of panels, for wide and for narrow pages
``bundle``   plotly.js and the figures, packed into the page
===========  ======================================================================================
"""
