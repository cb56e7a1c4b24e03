"""Compilation of the kernel with numba.

Compiled functions get their arrays in named tuples and are inlined into each other. These tuples
also hold the functions of the scheme and of the law; the kernel is compiled for each pair of them.
No compiled function allocates an array: numba's reference counts (``_nrt``), hundreds of atomic
operations in a step of contact, are switched off.
"""

from collections.abc import Callable
from functools import cached_property, partial
from typing import Any

import numba
import numpy as np
from numba.core.registry import CPUDispatcher

from simulate.contact.kernel_file import kernel

FLAGS = "C_CONTIGUOUS", "F_CONTIGUOUS", "WRITEABLE", "ALIGNED"  # of which array types are made
_KERNELS: dict[Any, Callable] = {}  # by function and layout of its arguments
# an index, or none yet: a function that takes a literal 0 is compiled again, for the literal
FIRST = np.int64(0)
SUM_IN_ANY_ORDER = {"reassoc", "contract", "nsz"}  # vector sums; still IEEE for inf and nan

OPTIONS = {"nopython": True, "error_model": "numpy", "_nrt": False}
WRAPPERS = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}  # for calls from Python and C


class Inner(CPUDispatcher):
    """A function that compiled ones call: it has no wrappers, a third of the time to compile.

    Called from Python, it is compiled once more, with them.
    """

    @cached_property
    def outer(self) -> CPUDispatcher:
        """The function with its wrappers."""
        options = {key: self.targetoptions[key] for key in self.targetoptions.keys() - WRAPPERS}
        return CPUDispatcher(self.py_func, targetoptions=options)

    def __call__(self, *arguments: Any) -> Any:
        """Call it from Python."""
        return self.outer(*arguments)


def decorator(dispatcher: type[CPUDispatcher], **options: Any) -> Callable[[Callable], Callable]:
    """Decorator that compiles with ``options``; NUMBA_DISABLE_JIT=1: plain Python."""
    if numba.config.DISABLE_JIT:  # pyright: ignore[reportPrivateImportUsage, reportAttributeAccessIssue]
        return lambda function: function
    return partial(dispatcher, targetoptions=OPTIONS | options)


compiled = decorator(Inner, forceinline=True, **WRAPPERS)
compiled_sums = decorator(Inner, forceinline=True, fastmath=SUM_IN_ANY_ORDER, **WRAPPERS)
# not inlined: a function that runs long enough to have the registers for itself
compiled_not_inlined = decorator(Inner, fastmath=SUM_IN_ANY_ORDER, **WRAPPERS)
compiled_kernel = decorator(CPUDispatcher)  # called from Python


def records(shape: int | tuple[int, ...], dtype: np.dtype) -> np.recarray:
    """Records of zeros: the values of a strip or a rod lie next to each other in memory."""
    return np.zeros(shape, dtype).view(np.recarray)


def for_types_of(function: Any, *arguments: Any) -> Callable:
    """Return ``function`` compiled for the types of ``arguments``, from the cache if it is there.

    Calls of it skip numba's dispatch on types, which takes as long as a thousand steps. Each set of
    types is known by the ``layout`` of the arguments: ``numba.typeof`` takes as long again.
    """
    if not isinstance(function, CPUDispatcher):  # plain Python
        return function
    key = function, layout(arguments)
    if key not in _KERNELS:
        types = tuple(numba.typeof(argument) for argument in arguments)
        _KERNELS[key] = kernel(function, types)
    return _KERNELS[key]


def layout(value: Any) -> Any:
    """Key of the type that numba gives to ``value``: equal for values of the same type.

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
