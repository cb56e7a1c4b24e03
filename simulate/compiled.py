"""How the march is compiled.

Its functions get their arrays in named tuples and are put into one another. What a scheme and a law
have of their own is in these tuples, too: functions, for which the march is compiled anew. None
makes an array: without numba's counts of references (``_nrt``), hundreds of atomic operations in a
step of contact are gone.
"""

from collections.abc import Callable
from typing import Any

import numba
import numpy as np

from simulate.kernel_file import kernel

SUM_IN_ANY_ORDER = {"reassoc", "contract", "nsz"}  # vector sums; still IEEE for inf and nan

compiled = numba.njit(error_model="numpy", forceinline=True, _nrt=False)
compiled_sums = numba.njit(
    error_model="numpy", fastmath=SUM_IN_ANY_ORDER, forceinline=True, _nrt=False
)
# a function that runs long enough to have the machine's registers for itself
compiled_apart = numba.njit(error_model="numpy", fastmath=SUM_IN_ANY_ORDER, _nrt=False)


def records(shape: int | tuple[int, ...], of: np.dtype) -> np.recarray:
    """Zero records: the numbers of a strip or a rod lie side by side, under their names."""
    return np.zeros(shape, of).view(np.recarray)


def for_types_of(function: Any, *arguments: Any) -> Callable:
    """Return ``function`` compiled for arguments like these, in this process or another.

    It does not look at their types again in every call, which takes as long as a thousand steps.
    """
    if numba.config.DISABLE_JIT:  # NUMBA_DISABLE_JIT=1: the march in Python
        return function
    return kernel(function, tuple(numba.typeof(argument) for argument in arguments))
