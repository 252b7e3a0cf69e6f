"""Lubricant laws at P = p/p_h; `law` is an `ehlcontact.lubricant.FluidLaw`."""

import math

from ehlcontact._kernels.jit import jit


@jit
def density(P, law):
    """Density over ambient density: Dowson-Higginson or 1."""
    if law.compressible:
        return (law.d + 1.34 * P) / (law.d + P)
    return 1.0


@jit
def log_viscosity(P, law):
    """Logarithm of viscosity over eta0: Roelands or Barus."""
    if law.roelands:
        return law.q * (math.exp(law.z * math.log(1.0 + law.s * P)) - 1.0)
    return law.alpha_bar * P


@jit
def log_viscosity_slope(P, law):
    """Derivative of `log_viscosity` with respect to P."""
    if law.roelands:
        return law.q * law.z * law.s * math.exp((law.z - 1.0) * math.log(1.0 + law.s * P))
    return law.alpha_bar


@jit
def density_slope(P, law):
    """Derivative of `density` with respect to P."""
    if law.compressible:
        return 0.34 * law.d / ((law.d + P) * (law.d + P))
    return 0.0
