"""Figures of the pages, made with plotly; functions take results and return a `plotly.graph_objects.Figure`.

Files of pictures are drawn with matplotlib: ``.plot()`` of the results, `ehlcontact.results.picture`.

================  ======================================================================================
module            shows, or does
================  ======================================================================================
``style``         colours, axes, grids of panels, sliders
``units``         what the axes show: SI or dimensionless
``maps``          a field over the contact's plane
``film``          the steady film: maps, fringes, mid-planes, convergence
``instants``      film and pressure at instants of a period, with a slider
``motion``        histories, the film wave, force against approach
``impedance``     stiffness and damping over frequency, and what the elements have of them
``rotor``         the rotor on its contacts: orbit, time response, spectrum, free decay, unbalance
``bearing``       the rotor on whole bearings: load zone, orbits, spectra, K and C, Campbell diagram
``defect``        force of a bearing with a spall, and the spectrum of its envelope
``oil_and_heat``  that bearing with heat and with a layer of oil: films around the ring, K and C
``points``        films, stiffness, damping and decay over the points of a study, in a file
``thinned``       fewer points and digits than the results have, and how many fewer
``finish``        legend, words under the pointer and places of panels, for wide and for narrow pages
``bundle``        plotly.js and the figures, packed into the page
================  ======================================================================================
"""
