"""One film at one instant: its mesh, its equations, and the ways to solve them.

================ ==========================================================================================
room             responsibility
================ ==========================================================================================
``mesh``         `mesh_for`, `remedy`: which region and grid a film needs, what to try after a failure
``regime``       what ellipse ratio, inlet width and load decide: named conditions, coarse levels
``domain``       `Domain`: the computed region
``grid``         `Grid`: intervals, region and engine of the deflection, as a user gives them
``memory``       what a grid takes, told before it is tried
``level``        `Level`: the arrays of one mesh and the equations on it; a hierarchy of them
``deflection/``  the elastic deflection: fast transforms, multi-integration, direct sum
``kernels/``     the equations node by node, compiled: Reynolds residual, derivatives, relaxation, transfer
``lowest_film``  the smallest film between the nodes
``accuracy``     `ErrorEstimate`: how far a film may be from that of an endless fine mesh
``estimate``     that of a film solved, from grids of half and a quarter of its intervals
``balance``      `Balance`: the equation that closes a solve: load, approach, or Newmark's step of the motion
``coarse``       Newton with dense elasticity, on the coarsest grid
``multigrid``    full-approximation-scheme cycle and full multigrid
``acceleration`` V cycles, combined with the last ones where they fall slowly
``linear``       the linearised film: operator, preconditioner, Krylov solution
``newton``       one Newton step on the finest grid
``iterate``      the only driver loop: cycles or Newton steps until settled; how they ended
================ ==========================================================================================
"""
