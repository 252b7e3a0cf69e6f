"""Periodic answers of rotors: harmonic balance, shooting, stability.

| module | content |
|---|---|
| answer | `PeriodicAnswer`: one period of a rotor that repeats its motion |
| excitation | unbalances, passing balls, forces; what a branch follows |
| support_laws | forces of supports along a periodic motion |
| harmonic_balance | the equations of the harmonics, their derivatives and solution |
| branch | continuation along the arc length of a branch, with its folds |
| branch_result | `PeriodicBranch`: answers over a parameter |
| periodic | `periodic` and `periodic_answer` |
| step_map | one period of time steps as a map of the numbers of a rotor |
| krylov | linear equations and eigenvalues of such a map's derivative |
| shooting | `shoot`: a periodic answer as a fixed point of the map |
| energy_budget | `energy_budget`: energy that every part takes in a period |
| floquet | Floquet multipliers of answers, bifurcations between those of a branch |
| mean_bearing | mean bearings of time steps |
| bifurcation | bifurcation diagrams by runs, Poincare sections |
| picture | pictures of branches, multipliers, diagrams and sections |
"""
