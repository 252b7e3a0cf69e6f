"""Figures of a page that one can zoom into, point at and run through time, beside their static pictures.

A figure is drawn once, by matplotlib; its scene is the same figure taken apart into panels, traces and marks, in
the words of plotly.js, which draws it again in the browser. So both show the same, and a new figure needs nothing
here.

=============  ======================================================================================
module         responsibility
=============  ======================================================================================
``scene``      a matplotlib figure as a scene: its panels and their axes
``lines``      its lines and bars as traces
``areas``      its maps, fields of colour and notes
``thinned``    fewer points and digits than the results have, and how many fewer
``instants``   the scene of film and pressure through time
``bundle``     plotly.js and the scenes, packed into the page
=============  ======================================================================================
"""
