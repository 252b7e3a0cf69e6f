"""Compiled kernels: numba and numpy only, plain arrays in, results written in place.

============= ============================================================================================
module        responsibility
============= ============================================================================================
``reynolds``  the discrete Reynolds equation: Poiseuille coefficient and its mean, operator, residual
``linearise`` its derivatives; the dense Jacobian
``relax``     hybrid line relaxation of the whole level
``flanks``    line relaxation along the steep flanks of the pressure
``supply``    partly filled nodes: the flow that the surfaces carry through them
``heat``      sweeps of the energy equation of a film
``cavitation``  passes along the cavitation boundary
``fronts``    passes along the fronts of full film behind partly filled nodes
``transfer``  from grid to grid
``fourier``   the deflection by fast Fourier transforms
``mlmi``      the direct sum of the deflection, and one coarsening of multi-integration
============= ============================================================================================

The laws of the oil that they call stand in `ehlcontact.lubricant`.
"""
