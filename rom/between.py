"""Error of the polynomial K(Omega) between its speeds, and the speeds that keep it small.

The error of a polynomial through n places x = (Omega / Omega_m)^2 is c_n w(x), with w the product
of the distances to the places. K is smooth: c_n falls by about the same factor with each further
place. Leaving out two speeds, and one, shows c_(n-2) and c_(n-1) at those left out, and so c_n.
On blades whose f1 rises by 30 to 120 %, with 4 to 8 speeds, the estimate was 0.15 to 8 times the
error, in nine of ten cases from a quarter of it to twice.
"""

from collections.abc import Iterator
from itertools import combinations, islice
from math import isinf

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from fem.matrices import Constants, Matrices, Prestressed
from geometry.base import Say, silent
from geometry.blade import EnrichedBasis, PaperBasis
from rom.basis import project
from rom.full_model import MODES
from rom.model import RomError
from rom.modes import ShiftInvert
from rom.polynomial import evaluate, interpolate
from rom.speeds import node_polynomial, places_between

FURTHER = 4  # modes of the range beyond those that are compared
SAFETY = 5.0  # times the estimate must be within the tolerance, so that the check is met
MOST = 12  # speeds; the powers of Omega^2 then lose eight digits of sixteen


def error_between(
    M: NDArray[np.float64], K: NDArray[np.float64], speeds: NDArray[np.float64]
) -> float:
    """Estimate of the largest relative error of the first frequencies of K(Omega) over its range.

    Parameters
    ----------
    M, K : (n, n) and (speeds, n, n), kg and N/m, in one basis
    speeds : ascending from rest, rad/s

    Returns
    -------
    nan if there are fewer than four speeds: two cannot be left out between their ends.
    """
    between = range(1, len(speeds) - 1)
    if len(between) < 2:
        return np.nan
    x = (speeds / speeds[-1]) ** 2
    one, two = (
        max(_coefficient(M, K, x, list(out)) for out in combinations(between, count))
        for count in (1, 2)
    )
    return one**2 / two * float(node_polynomial(x, places_between(x)).max()) if two > 0 else 0.0


def _coefficient(M: NDArray, K: NDArray, x: NDArray, out: list[int]) -> float:
    """Largest error of a frequency at the places ``out`` of a polynomial without them, over w."""
    kept = np.delete(x, out)
    polynomial = interpolate(np.delete(K, out, axis=0), np.sqrt(kept))
    errors = [
        abs(_frequencies(evaluate(polynomial, np.sqrt(x[j])), M) / _frequencies(K[j], M) - 1).max()
        / abs(x[j] - kept).prod()
        for j in out
    ]
    return float(max(errors))


def _frequencies(K: NDArray, M: NDArray) -> NDArray:
    """First frequencies, rad/s; 0 for those that are not real."""
    values = eigh(K, M, eigvals_only=True, subset_by_index=[0, min(MODES, len(M)) - 1])
    return np.sqrt(np.maximum(values, 0))


def resolved(
    fom: Constants,
    states: Iterator[Prestressed],
    speeds: list[float],
    basis: EnrichedBasis | PaperBasis,
    say: Say = silent,
) -> Matrices:
    """Matrices at ``speeds``, and at further ones until K(Omega) meets the tolerance of ``basis``.

    Parameters
    ----------
    states : at the ``speeds``, from which it takes each when the state is asked for
    speeds : ascending, rad/s; each further one is appended: where w is largest (Leja's points)
    say : called with each further speed and its reason

    Raises
    ------
    RomError
        When ``MOST`` speeds are not enough.
    """
    chosen = list(islice(states, len(speeds)))
    if isinf(basis.tolerance_percent):
        return Matrices.of(fom, chosen)
    # modes at an inner speed stand for those of the whole range
    T = ShiftInvert(chosen[-2].K, fom.M).modes(MODES + FURTHER).Phi
    M = project(fom.M, T)
    # nan, of three speeds, is not small enough either
    while not (error := _error(M, T, chosen)) <= basis.tolerance_percent / 100 / SAFETY:
        through = f"frequencies of K(Omega) through {len(chosen)} speeds"
        shown = f"{through} err by some {100 * error:.2g} %"
        if len(chosen) == MOST:
            raise RomError(
                f"{shown}, for basis.tolerance_percent {basis.tolerance_percent:g} too much: lower "
                f"the highest speed, or allow more"
            )
        speeds.append(_next(speeds))
        say(f"{shown}: one more, {speeds[-1]:.6g} rad/s")
        chosen = sorted([*chosen, next(states)], key=lambda state: state.speed)
    return Matrices.of(fom, chosen)


def _error(M: NDArray, T: NDArray, states: list[Prestressed]) -> float:
    """Error between the speeds of ascending ``states``, in the basis T."""
    K = np.array([project(state.K, T) for state in states])
    return error_between(M, K, np.array([state.speed for state in states]))


def _next(speeds: list[float]) -> float:
    """The speed at which w is largest."""
    x = (np.sort(speeds) / max(speeds)) ** 2
    places = places_between(x)
    return float(max(speeds) * np.sqrt(places[node_polynomial(x, places).argmax()]))
