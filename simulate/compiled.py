"""Compilation of the march with numba.

Compiled functions get their arrays in named tuples and are inlined into each other. These tuples
also hold the functions of the scheme and of the law; the march is compiled for each pair of them.
No compiled function allocates an array: numba's reference counts (``_nrt``), hundreds of atomic
operations in a step of contact, are switched off.
"""

from collections.abc import Callable
from typing import Any

import numba
import numpy as np

from simulate.kernel_file import kernel

FLAGS = "C_CONTIGUOUS", "F_CONTIGUOUS", "WRITEABLE", "ALIGNED"  # of which array types are made
_KERNELS: dict[Any, Callable] = {}  # by function and layout of its arguments
SUM_IN_ANY_ORDER = {"reassoc", "contract", "nsz"}  # vector sums; still IEEE for inf and nan

compiled = numba.njit(error_model="numpy", forceinline=True, _nrt=False)
compiled_sums = numba.njit(
    error_model="numpy", fastmath=SUM_IN_ANY_ORDER, forceinline=True, _nrt=False
)
# not inlined: a function that runs long enough to have the registers for itself
compiled_apart = numba.njit(error_model="numpy", fastmath=SUM_IN_ANY_ORDER, _nrt=False)


def records(shape: int | tuple[int, ...], of: np.dtype) -> np.recarray:
    """Records of zeros: the values of a strip or a rod lie next to each other in memory."""
    return np.zeros(shape, of).view(np.recarray)


def for_types_of(function: Any, *arguments: Any) -> Callable:
    """Return ``function`` compiled for the types of ``arguments``, from the cache if it is there.

    Calls of it skip numba's dispatch on types, which takes as long as a thousand steps. Each set of
    types is told from the ``layout`` of the arguments: ``numba.typeof`` takes as long again.
    """
    if numba.config.DISABLE_JIT:  # NUMBA_DISABLE_JIT=1: the march in Python
        return function
    known = function, layout(arguments)
    if known not in _KERNELS:
        types = tuple(numba.typeof(argument) for argument in arguments)
        _KERNELS[known] = kernel(function, types)
    return _KERNELS[known]


def layout(value: Any) -> Any:
    """What decides the type that numba gives to ``value``: equal for values of the same type.

    >>> layout((1.0, np.zeros(3))) == layout((2.0, np.zeros(5)))
    True
    >>> layout(np.zeros((4, 4))) == layout(np.zeros((4, 4)).T)
    False
    """
    if isinstance(value, tuple):
        return type(value), *map(layout, value)
    if isinstance(value, np.ndarray):
        return type(value), value.dtype, value.ndim, *(value.flags[name] for name in FLAGS)
    return value if callable(value) else type(value)
