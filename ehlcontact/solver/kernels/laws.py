"""Lubricant laws at P = p/p_h, each with its derivative; `law` is an `ehlcontact.lubricant.FluidLaw`."""

import math

from ehlcontact.jit import jit_node


@jit_node
def density(P, law):
    """Density over ambient density, Dowson-Higginson or 1, and its derivative."""
    if law.compressible:
        inverse = 1.0 / (law.d + P)
        return (law.d + 1.34 * P) * inverse, 0.34 * law.d * inverse * inverse
    return 1.0, 0.0


@jit_node
def log_viscosity(P, law):
    """Logarithm of viscosity over eta0, Roelands or Barus, and its derivative."""
    if law.roelands:
        base = 1.0 + law.s * P
        power = math.exp(law.z * math.log(base))
        return law.q * (power - 1.0), law.q * law.z * law.s * power / base
    return law.alpha_bar * P, law.alpha_bar
