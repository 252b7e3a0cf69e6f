"""Every picture of the program; functions take results and return a matplotlib figure.

=============  ======================================================================================
module         shows
=============  ======================================================================================
``style``      fonts, colours, figures embedded in a page or written to a file
``units``      what the axes show: SI or dimensionless
``maps``       a field over the contact's plane
``fringes``    pseudo-interferograms
``film``       the steady film: maps, mid-planes, convergence
``instants``   film and pressure at instants of a period
``motion``     histories, the film wave, force against approach
``impedance``  stiffness and damping over frequency, and what the elements have of them
``rotor``      the rotor under its unbalance: orbit, time response, spectrum
``vibration``  the rotor's own vibrations: free decay, and unbalance over frequency
``bearing``    a ball bearing: load zone, films, stiffness and damping over speed
``points``     films, stiffness, damping and decay over speeds and loads
``whole``      the rotor on whole bearings: load zone, orbits, spectra, K and C over frequency, Campbell diagram
``paper``      histories, approaches and springs as the paper shows them
``live``       any of them in a browser: to zoom into, to point at, to run through time
=============  ======================================================================================
"""
