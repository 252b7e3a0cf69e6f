"""The numba decorators of the library.

Not ``fastmath=True``: it would fold away the tests for NaN and infinity that the drivers rely on.
"""

from functools import partial
from typing import Any

from numba import njit

# Elements: no fused multiply-adds, for the same force must come out whatever a kernel was inlined into (and in C).
jit_exact: Any = partial(njit, cache=True, error_model="numpy")
jit: Any = partial(jit_exact, fastmath={"contract", "nsz"}, nogil=True)  # threads share the lines of a grid
jit_node: Any = partial(jit, forceinline=True)  # for one node: a call with a dozen arrays costs more than the work
# Likewise, with the bits of jit_exact; and without numba's counting of references, five times the work of a kernel
# that is handed a dozen arrays in tuples: such a kernel must not make arrays.
jit_exact_node: Any = partial(jit_exact, forceinline=True, _nrt=False)
jit_exact_loop: Any = partial(jit_exact, _nrt=False)  # the same for a loop over such
