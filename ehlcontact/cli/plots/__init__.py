"""Figures of the report; each function takes results and returns a matplotlib figure.

===============  ================================================================
module           shows
===============  ================================================================
``style``        fonts, colours, figure to embedded PNG
``film``         the steady film: maps, profiles, interferogram, convergence
``transient``    histories, the film wave, force against approach
``impedance``    stiffness and damping over frequency, and what the elements have of them
``rotor``        orbit, time response, spectrum
===============  ================================================================
"""

from ehlcontact.cli.plots.film import convergence as convergence
from ehlcontact.cli.plots.film import film_maps as film_maps
from ehlcontact.cli.plots.film import interferogram as interferogram
from ehlcontact.cli.plots.film import midplane as midplane
from ehlcontact.cli.plots.impedance import impedance as impedance
from ehlcontact.cli.plots.motion import film_wave as film_wave
from ehlcontact.cli.plots.motion import histories as histories
from ehlcontact.cli.plots.motion import loops as loops
from ehlcontact.cli.plots.rotor import orbit as orbit
from ehlcontact.cli.plots.rotor import response as response
from ehlcontact.cli.plots.rotor import spectrum as spectrum
from ehlcontact.cli.plots.style import embedded as embedded
from ehlcontact.cli.plots.style import styled as styled
