"""Law of a rod as the kernel calls it: compiled into the kernel, or through pointers.

The kernel is compiled anew for each law that is compiled into it, and is then the fastest. Through
pointers one kernel serves all laws whose parameters are numbers, at some 1.6 times its time.
"""

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numba
import numpy as np
from numba import float64
from numba.core.types import Type, UniTuple
from numba.np.unsafe.ndarray import to_fixed_tuple

from simulate.contact.compiled import compiled
from simulate.scene.law import Law

OF_ARRAY = float64[::1], float64, float64  # parameters, and two strains


class RodLaw(NamedTuple):
    """Law of a rod as the kernel calls it."""

    parameters: Any  # Pa; through pointers an array
    stress: Any  # compiled: of parameters, eps and eps_p
    plastic_work: Any  # compiled: of parameters, and eps_p before and after


@cache
def _compiled(function: Callable) -> Callable:
    """One compiled function for each: the kernel is compiled anew for another."""
    return compiled(function)


def rod_law(law: type[Law], parameters: Any, by_pointers: bool = False) -> RodLaw:
    """Formulas of a law, to be compiled into the kernel; ``parameters`` as its ``stress`` reads.

    ``by_pointers``: compiled, for a kernel that calls them; parameters are then numbers.

    Raises
    ------
    numba.core.errors.NumbaError
        Where they cannot be compiled for calls.
    """
    # plain Python needs no pointers
    if not by_pointers or numba.config.DISABLE_JIT:  # pyright: ignore[reportPrivateImportUsage, reportAttributeAccessIssue]
        return RodLaw(parameters, _compiled(law.stress), _compiled(law.plastic_work))
    values, named = np.array(parameters, float), type(parameters)
    work = _pointer(law.plastic_work, named, float64)
    return RodLaw(values, _pointer(law.stress, named, UniTuple(float64, 3)), work)


@cache
def _pointer(function: Callable, named: type, returned: Type) -> Any:
    """Pointer to a ``function`` of parameters in an array; ``named``: their named tuple."""
    formula, count = compiled(function), len(named._fields)

    @numba.cfunc(returned(*OF_ARRAY), error_model="numpy", _nrt=False)  # pyright: ignore[reportCallIssue]
    def of_array(parameters, one, other):
        """The function, of parameters in an array."""
        return formula(named(*to_fixed_tuple(parameters, count)), one, other)  # pyright: ignore[reportCallIssue]

    return of_array
