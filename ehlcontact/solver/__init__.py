"""Steady or momentary film of one contact: mesh, equations, multigrid and Newton.

================ ==========================================================================================
module           responsibility
================ ==========================================================================================
``mesh``         `Mesh`: intervals, region, refinement across; its nodes and the memory that a solve takes
``mesh_choice``  `mesh_for`, `remedy`: region and fineness of a film, and the mesh to try after a failure
``attempts``     `attempts`: meshes and methods for a steady film, in the order in which they are tried
``grid_rules``   conditions on ellipse ratio, inlet width and load; coarsest grid and load of coarse levels
``grid``         `Grid`: intervals, region and engine of the deflection, as a user gives them
``domain``       `Domain`: the computed region
``level``        `Level`: arrays and equations on one mesh; the hierarchy of levels
``deflection/``  elastic deflection: fast Fourier transforms, multi-integration, direct sum
``kernels/``     compiled kernels: Reynolds residual, derivatives, relaxation, grid transfer
``lowest_film``  smallest film between the nodes
``error_estimate``  `ErrorEstimate`: estimated discretisation error of a film
``error_grids``  solutions on coarser grids, for the error estimate
``balance``      `Balance`: load balance, prescribed approach, or Newmark's step of the motion
``coarse_newton``  Newton with dense elasticity on the coarsest grid
``compiled_beside``  kernels that a second process compiles beside the first solve on a machine
``multigrid``    full-approximation-scheme cycle and full multigrid
``acceleration`` Anderson acceleration of V cycles
``linear``       linearised film: operator, preconditioner, Krylov solution
``linearised_contact``  derivatives of a contact at its steady film; responses over frequency
``effects``      `Effect`: what conditions make of a film, any of them beside the others; cycles with them
``mixed_film``   pressure of asperities that carry part of the load beside a film
``linear_heat``  linearised film with temperatures that follow a vibration
``linear_fronts``  its fronts of full film, where oil runs short
``passing_layer``  a layer that passes a linearised film: force, and what is left behind
``film_thinning`` shear thinning of a film by sliding
``film_heat``    temperatures of a film: energy equation
``followed_viscosity``  viscosity that follows heat and sliding, in cycles and in vibrations
``newton``       Newton steps on the finest grid
``iterate``      iteration of cycles or Newton steps until convergence or failure
================ ==========================================================================================
"""
