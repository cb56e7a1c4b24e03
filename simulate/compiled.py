"""How the march is compiled.

Its functions get their arrays in named tuples and are put into one another, so that what a scene
does not have leaves no trace. None of them makes an array: without numba's counts of references
(``_nrt``), hundreds of atomic operations in a step of contact are gone.
"""

import numba

SUM_IN_ANY_ORDER = {"reassoc", "contract", "nsz"}  # vector sums; still IEEE for inf and nan

compiled = numba.njit(error_model="numpy", forceinline=True, _nrt=False)
compiled_sums = numba.njit(
    error_model="numpy", fastmath=SUM_IN_ANY_ORDER, forceinline=True, _nrt=False
)
inlined = numba.njit(inline="always")  # a law's formulas: written into the function that uses them
