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

from ehlcontact.cli.study.figures.film import convergence as convergence
from ehlcontact.cli.study.figures.film import film_maps as film_maps
from ehlcontact.cli.study.figures.film import interferogram as interferogram
from ehlcontact.cli.study.figures.film import midplane as midplane
from ehlcontact.cli.study.figures.impedance import impedance as impedance
from ehlcontact.cli.study.figures.rotor import orbit as orbit
from ehlcontact.cli.study.figures.rotor import response as response
from ehlcontact.cli.study.figures.rotor import spectrum as spectrum
from ehlcontact.cli.study.figures.style import embedded as embedded
from ehlcontact.cli.study.figures.style import styled as styled
from ehlcontact.cli.study.figures.transient import film_wave as film_wave
from ehlcontact.cli.study.figures.transient import histories as histories
from ehlcontact.cli.study.figures.transient import loops as loops
