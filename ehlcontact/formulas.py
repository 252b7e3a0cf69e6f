"""Published fits for film and approach.

Regions and grids are chosen from them (`solver.mesh`, through the properties of a `MoesPoint`), the atlas
interpolates what its contacts have over them, and tests compare; what a solver converges to on its grid does not
depend on them. They take plain numbers: the inputs stand above this module.
"""

from __future__ import annotations

from math import exp, log

from ehlcontact.hertz import radius_ratio


def load_number(M: float, kappa: float) -> float:
    """N = sqrt(Rx/Ry) M, which tells thick films from thin ones at any kappa; Wijnant, thesis, Twente 1998."""
    return radius_ratio(kappa) ** 0.5 * M


def nvm_central_film(M: float, L: float, kappa: float) -> float:
    """Central film in Moes units, incompressible.

    Nijenbanning, Venner and Moes, Wear 176 (1994) 217-229, with lambda = Rx/Ry.
    """
    lam = radius_ratio(kappa)
    shape = 1.0 + 0.006 * log(lam) + 0.63 * lam ** (4.0 / 7.0)
    h_ri = 145.0 * (1.0 + 0.796 * lam ** (14.0 / 15.0)) ** (-15.0 / 7.0) / (lam * M * M)
    h_ei = 3.18 * shape ** (-14.0 / 25.0) * lam ** (-1.0 / 15.0) * M ** (-2.0 / 15.0)
    h_00 = 1.8 / lam
    s = 1.5 * (1.0 + exp(-1.2 * h_ei / h_ri))
    isoviscous = (h_ri**1.5 + (h_ei**-4 + h_00**-4) ** (-3.0 / 8.0)) ** (2.0 / 3.0)
    if L == 0.0:
        return isoviscous
    h_rp = 1.29 * (1.0 + 0.691 * lam) ** (-2.0 / 3.0) * L ** (2.0 / 3.0)
    h_ep = 1.48 * shape ** (-7.0 / 20.0) * lam ** (-1.0 / 24.0) * M ** (-1.0 / 12.0) * L**0.75
    piezoviscous = (h_rp**-8 + h_ep**-8) ** (-1.0 / 8.0)
    return (isoviscous**s + piezoviscous**s) ** (1.0 / s)


def wijnant_approach(M: float, L: float, kappa: float) -> float:
    """Approach over dry approach: ``1 - p N^q`` with N = sqrt(Rx/Ry) M; Wijnant, thesis, Twente 1998."""
    N = load_number(M, kappa)
    p = ((4.0 - 0.2 * L) ** 7 + (3.5 + 0.1 * L) ** 7) ** (1.0 / 7.0)
    return 1.0 - p * N ** -(0.6 + 0.6 * (L + 3.0) ** -0.5)
