"""Compiled kernels: numba and numpy only, plain arrays in, results written in place."""
