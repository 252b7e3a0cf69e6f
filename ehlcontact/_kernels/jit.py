"""The one numba decorator of the library.

Not ``fastmath=True``: it would fold away the tests for NaN and infinity that the drivers rely on.
"""

from numba import njit

jit = njit(cache=True, error_model="numpy", fastmath={"contract", "nsz"})
