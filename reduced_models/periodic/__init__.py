"""Periodic answers of rotors: harmonic balance, shooting, stability.

| module | content |
|---|---|
| answer | `PeriodicAnswer`: one period of a rotor that repeats its motion |
| step_map | one period of time steps as a map of the numbers of a rotor |
| krylov | linear equations and eigenvalues of such a map's derivative |
| shooting | `shoot`: a periodic answer as a fixed point of the map |
| floquet | Floquet multipliers of answers, bifurcations between those of a branch |
"""
